"""The real 2 ms loop on the simulated drive: run, wait, stop, pause, override, Ctrl-C."""

from __future__ import annotations

import inspect
import os
import signal
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors
from viapoint._connect import _LocalOptions


def wait_for(condition, seconds=5.0):
    """Wait until the condition holds; fail with a reason instead of for ever."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "the condition never came true"
        time.sleep(0.002)


def assert_measured(arm, joints):
    """The arm was told `joints`, and measures them a cycle later."""
    np.testing.assert_allclose(arm.setpoint, joints, atol=1e-9)
    wait_for(lambda: np.abs(arm.joints - joints).max() < 1e-9)


def assert_on_path(log, motion, tolerance=2e-3):
    """Every tenth setpoint is a point of the planned path, wherever it is in time."""
    path = motion.sample(2e-4).q
    for q in log.q[::10]:
        assert np.abs(path - q).max(axis=1).min() < tolerance


@pytest.fixture
def long(puma, abc):
    """About 1.6 s from A over B to C."""
    program = vp.Program(puma, start=abc["A"], name="long")
    return program.movej(abc["B"], zone=vp.joint_deviation(0.05)).movej(abc["C"]).plan()


def test_a_run_takes_its_duration_within_one_cycle_and_ends_at_the_goal(short):
    motion = short.plan()
    with vp.connect("sim://puma560", start=short.start) as arm:
        job = arm.run(motion)
        assert_measured(arm, motion.end)
        np.testing.assert_allclose(arm.pose, arm.robot.fk(motion.end), atol=1e-8)
    assert job.state == "finished"
    assert job.ended
    log, report = job.log, job.report
    assert report.cycles == len(log)
    assert (len(log) - 1) * 0.002 == pytest.approx(motion.duration, abs=0.002 + 1e-9)
    np.testing.assert_allclose(log.q[-1], motion.end, atol=1e-9)


def test_the_stamps_are_the_monotonic_clocks(short):
    before = time.clock_gettime_ns(time.CLOCK_MONOTONIC)
    with vp.connect("sim://puma560", start=short.start) as arm:
        job = arm.run(short)
    after = time.clock_gettime_ns(time.CLOCK_MONOTONIC)
    stamps = job.log.stamp
    assert before <= stamps[0] < stamps[-1] <= after
    # What was due is exact; when the machine woke the loop varies with its load, and a cycle it
    # slept through is left out.
    cycles, odd = np.divmod(np.diff(stamps - job.log.latency), 2_000_000)
    assert not odd.any()
    assert (cycles >= 1).all()
    assert cycles.sum() == len(stamps) - 1 + job.report.missed_cycles


def test_the_executed_setpoints_are_the_simulated_ones_to_the_last_bit(short):
    with vp.connect("sim://puma560", start=short.start) as arm:
        log = arm.run(short).log
    simulated = vp.simulate(short)
    for name in ("q", "qd", "qdd", "qddd"):
        np.testing.assert_array_equal(getattr(log, name), getattr(simulated, name))


def test_one_program_after_the_other_from_where_the_arm_stands(puma, abc):
    with vp.connect("sim://puma560", start=abc["A"]) as arm:
        arm.run(vp.Program(puma, start=arm.setpoint).movej(abc["A"] + 0.1))
        job = arm.run(vp.Program(puma, start=arm.setpoint).movej(abc["A"]))
        assert job.log.cycle[0] == 0
        assert_measured(arm, abc["A"])


def test_a_second_run_meanwhile_is_refused(long):
    with vp.connect("sim://puma560", start=long.start) as arm:
        job = arm.run(long, wait=False)
        with pytest.raises(errors.BusyError):
            arm.run(long)
        assert arm.busy
        job.stop()
        assert job.wait(5.0)
        assert not arm.busy


def test_wait_returns_false_at_its_timeout(long):
    with vp.connect("sim://puma560", start=long.start) as arm:
        job = arm.run(long, wait=False)
        begin = time.monotonic()
        assert job.wait(0.1) is False
        assert 0.09 < time.monotonic() - begin < 1.0
        assert job.state == "running"
        assert 0.0 < job.nominal_time < job.duration
        assert job.wait() is True


@pytest.mark.parametrize("timeout", [-1, np.nan, np.inf, "long"])
def test_a_bad_timeout_is_refused_and_the_run_goes_on(short, timeout):
    with vp.connect("sim://puma560", start=short.start) as arm:
        job = arm.run(short, wait=False)
        with pytest.raises(errors.BadArgumentError, match="timeout"):
            job.wait(timeout)
    assert job.state == "finished"


def test_stop_comes_to_rest_on_the_path(long):
    with vp.connect("sim://puma560", start=long.start) as arm:
        job = arm.run(long, wait=False)
        wait_for(lambda: job.nominal_time > 0.4)
        job.stop()
        assert job.wait(5.0)
        assert job.state == "stopped"
        log = job.log
        np.testing.assert_array_equal(arm.setpoint, log.q[-1])
        assert_measured(arm, log.q[-1])
    np.testing.assert_allclose(log.qd[-1], 0.0, atol=1e-9)
    assert np.abs(log.q[-1] - long.end).max() > 0.05
    assert_on_path(log, long)
    limits = long.robot.limits
    assert (np.abs(log.qdd) <= limits.acceleration * (1 + 1e-6)).all()
    assert (np.abs(log.qddd) <= limits.jerk * (1 + 1e-6)).all()


def test_run_raises_when_another_thread_stops_it(long):
    import threading

    with vp.connect("sim://puma560", start=long.start) as arm:

        def stop():
            wait_for(lambda: arm.busy)
            time.sleep(0.2)
            arm._jobs[-1].stop()

        thread = threading.Thread(target=stop)
        thread.start()
        with pytest.raises(errors.StoppedError) as caught:
            arm.run(long)
        thread.join()
    assert 0 < caught.value.time < long.duration


def test_pause_rests_and_resume_finishes_at_the_goal(long):
    with vp.connect("sim://puma560", start=long.start) as arm:
        job = arm.run(long, wait=False)
        wait_for(lambda: job.nominal_time > 0.3)
        job.pause()
        wait_for(lambda: job.state == "paused")
        rests = arm.setpoint
        time.sleep(0.1)
        np.testing.assert_array_equal(arm.setpoint, rests)
        assert_measured(arm, rests)
        job.resume()
        assert job.wait(10.0)
        assert job.state == "finished"
        assert_measured(arm, long.end)
    assert_on_path(job.log, long)
    assert "paused" in {vp.RunLog.STATES[s] for s in job.log.state}


def test_leaving_the_block_while_paused_stops(long):
    with vp.connect("sim://puma560", start=long.start) as arm:
        job = arm.run(long, wait=False)
        job.pause()
        wait_for(lambda: job.state == "paused")
    assert job.state == "stopped"


def test_leaving_the_block_right_after_pausing_stops(long):
    with vp.connect("sim://puma560", start=long.start) as arm:
        job = arm.run(long, wait=False)
        job.pause()
    assert job.state == "stopped"


def test_leaving_the_block_at_an_override_of_zero_stops(long):
    with vp.connect("sim://puma560", start=long.start) as arm:
        job = arm.run(long, wait=False)
        arm.override = 0.0
    assert job.state == "stopped"


def test_leaving_the_block_waits_for_the_run(short):
    with vp.connect("sim://puma560", start=short.start) as arm:
        job = arm.run(short, wait=False)
    assert job.state == "finished"


def test_override_slows_on_the_path(long):
    with vp.connect("sim://puma560", start=long.start) as arm:
        assert arm.override == 1.0
        job = arm.run(long, wait=False)
        wait_for(lambda: job.nominal_time > 0.3)
        arm.override = 0.4
        assert arm.override == 0.4
        job.wait()
    log = job.log
    assert job.state == "finished"
    assert log.rate.min() < 0.41
    assert len(log) * 0.002 > long.duration + 0.3
    assert_on_path(log, long)
    np.testing.assert_allclose(log.q[-1], long.end, atol=1e-9)


@pytest.mark.parametrize("share", [-0.1, 1.1, np.nan, "half", None])
def test_a_bad_override_is_refused(share):
    with (
        vp.connect("sim://puma560") as arm,
        pytest.raises(errors.BadArgumentError, match="override"),
    ):
        arm.override = share


def test_an_exception_in_the_block_brings_the_arm_to_rest_on_its_path(long):
    def interrupted():
        with vp.connect("sim://puma560", start=long.start) as arm:
            jobs.append(arm.run(long, wait=False))
            wait_for(lambda: jobs[0].nominal_time > 0.3)
            raise ZeroDivisionError

    jobs = []
    with pytest.raises(ZeroDivisionError):
        interrupted()
    log = jobs[0].log
    assert jobs[0].state == "stopped"
    np.testing.assert_allclose(log.qd[-1], 0.0, atol=1e-9)
    assert_on_path(log, long)


def test_a_closed_arm_refuses(short):
    arm = vp.connect("sim://puma560", start=short.start)
    arm.close()
    arm.close()
    with pytest.raises(errors.DriveFaultError, match="no longer connected"):
        arm.run(short)


def test_the_loop_stays_on_the_processor_that_it_is_given(short):
    (least, *_) = sorted(os.sched_getaffinity(0))
    before = set(Path("/proc/self/task").iterdir())
    with vp.connect("sim://puma560", start=short.start, processor=least) as arm:
        begun = set(Path("/proc/self/task").iterdir()) - before
        kept = [os.sched_getaffinity(int(task.name)) == {least} for task in begun]
        assert any(kept)
        assert not any("processor" in line and "kept" in line for line in arm.shortcomings)


def test_a_type_checker_knows_every_option_of_an_arm_of_this_process():
    told = set(inspect.signature(vp.connect).parameters)
    assert set(_LocalOptions.__annotations__) == told - {"url", "start", "watch", "tls"}


def test_latencies_are_measured(short):
    with vp.connect("sim://puma560", start=short.start) as arm:
        job = arm.run(short)
        assert isinstance(arm.shortcomings, list)
    report = job.report
    assert 0 <= report.latency_p50 <= report.latency_p99 <= report.latency_max
    assert 0 < report.compute_p50 <= report.compute_max
    assert report.wall_time > 0
    assert report.missed_cycles >= report.overruns
    assert report.lost_records == 0


SCRIPT = """
    import sys
    import numpy as np
    import viapoint as vp

    robot = vp.load_robot("puma560")
    start = np.array({start})
    motion = vp.Program(robot, start=start, scale=0.25).movej(start + [1.5, -1, 0, 1, -1, 2]).plan()
    jobs = []
    try:
        with vp.connect("sim://puma560", start=start) as arm:
            job = arm.run(motion, wait=False)
            jobs.append(job)
            print("running", flush=True)
            {body}
    except KeyboardInterrupt:
        log = jobs[0].log
        path = motion.sample(2e-4).q
        miss = max(np.abs(path - q).max(axis=1).min() for q in log.q[::10])
        at_end = np.abs(log.q[-1] - motion.end).max()
        print(jobs[0].state, np.abs(log.qd[-1]).max(), miss, at_end, flush=True)
        raise
"""


@pytest.mark.parametrize("body", ["job.wait()", "import time; time.sleep(30)"])
def test_ctrl_c_brings_the_arm_to_rest_on_its_path_and_goes_on_up(abc, body, tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        textwrap.dedent(SCRIPT).format(start=abc["A"].tolist(), body=body), encoding="utf-8"
    )
    process = subprocess.Popen(
        [sys.executable, str(script)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        env=os.environ.copy(),
    )
    assert process.stdout is not None
    assert process.stdout.readline().strip() == "running"
    time.sleep(0.6)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=30)
    assert process.returncode in (-signal.SIGINT, 130), err
    assert "KeyboardInterrupt" in err
    state, speed, miss, from_end = out.split()
    assert state == "stopped"
    assert float(speed) < 1e-9
    assert float(miss) < 2e-3
    assert float(from_end) > 0.05
