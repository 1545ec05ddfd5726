"""A script drives a controller in another process with the words of the one in its own."""

import contextlib
import os
import re
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

import viapoint as vp
from viapoint import _core, _session
from viapoint._remote import RemoteLoop
from viapoint._wire import message
from viapoint.errors import (
    BadArgumentError,
    BusyError,
    DriveFaultError,
    NotAtStartError,
    NotInControlError,
    StoppedError,
    UnconnectedError,
    VelocityLimitError,
)

DOCUMENT = Path(__file__).parents[2] / "docs" / "controller.md"


def until(holds):
    deadline = time.monotonic() + 60
    while not holds():
        assert time.monotonic() < deadline
        time.sleep(0.005)


def slow(arm):
    """A move of many seconds from where the arm rests."""
    return vp.Program(arm.robot, start=arm.setpoint, scale=0.02).movej(arm.setpoint + 0.3)


@pytest.fixture
def url(serve, abc):
    return serve(start=list(abc["A"])).url


def test_an_arm_is_of_the_kind_that_its_url_says_and_keeps_its_words_in_virtual_time(url):
    with vp.connect("sim://two_link") as arm:
        assert isinstance(arm, vp.LocalArm)
    with vp.connect(url) as arm:
        assert isinstance(arm, vp.RemoteArm)
        assert arm.operator.endswith(f"process {os.getpid()}")
        assert arm.job is None
    virtual = _session.Session()
    virtual.virtual = True
    with _session.use(virtual), vp.connect(url) as arm:
        assert isinstance(arm, vp.RemoteArm)
        assert (arm.operator, arm.control_loss, arm.job) == ("", "", None)
        job = arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.1))
        assert arm.job is job
    with vp.connect(url, watch=True) as arm:
        assert arm.job is None  # nothing ran there


def test_runs_stay_readable_while_the_script_has_hold_of_them(url, abc):
    with vp.connect(url) as arm:
        goals = [abc["A"] + 0.02 * k for k in range(1, 6)]
        jobs = [arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(q)) for q in goals]
        assert [job.state for job in jobs] == ["finished"] * 5
        dropped = arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(abc["A"]), wait=False)
    for job, q in zip(jobs, goals, strict=True):  # the arm is closed, too
        np.testing.assert_allclose(job.log.q[-1], q, atol=1e-12)
        assert job.report.cycles == len(job.log)
    assert dropped.state == "finished"
    assert len(dropped.log) == dropped.report.cycles


def test_a_run_whose_answer_was_lost_is_stopped_with_the_arm(url, monkeypatch):
    call = RemoteLoop.call

    def interrupted(loop, method, *args, **options):
        answer = call(loop, method, *args, **options)
        if method == "Run":
            raise KeyboardInterrupt
        return answer

    monkeypatch.setattr(RemoteLoop, "call", interrupted)
    with pytest.raises(KeyboardInterrupt), vp.connect(url) as arm:
        arm.run(slow(arm))
    with vp.connect(url) as arm:
        assert arm.job.state == "stopped"


def test_a_run_has_the_setpoints_of_one_in_this_process(url, puma, abc):
    program = vp.Program(puma, start=abc["A"], name="two moves")
    program.movej(abc["B"], zone=0.05).set_do(3, True).movej(abc["C"]).wait(0.05)
    with vp.connect("sim://puma560", start=abc["A"]) as arm:
        here = arm.run(program)
    with vp.connect(url) as arm:
        assert arm.robot.fingerprint == puma.fingerprint
        there = arm.run(program)
        assert there.state == "finished"
        np.testing.assert_array_equal(arm.setpoint, abc["C"])
        log, report = there.log, there.report
        assert there.duration == here.duration
    for name in ("cycle", "nominal_time", "rate", "move", "outputs", "q", "qd", "qdd", "qddd"):
        np.testing.assert_array_equal(getattr(log, name), getattr(here.log, name), err_msg=name)
    assert report.cycles == len(log)
    assert log.robot.fingerprint == puma.fingerprint


def test_pause_resume_step_backward_and_stop(url):
    with vp.connect(url) as arm:
        arm.override = 0.5
        assert arm.override == 0.5
        job = arm.run(slow(arm), wait=False)
        assert arm.busy
        assert arm.job is job
        until(lambda: job.nominal_time > 0.2)
        job.pause()
        until(lambda: job.state == "paused")
        here = job.nominal_time
        job.backward()
        until(lambda: job.nominal_time < here)
        job.resume()
        until(lambda: job.nominal_time > here)
        with pytest.raises(BusyError, match="under way"):
            arm.run(slow(arm))
        job.step()
        assert not job.wait(0.01)
        job.stop()
        assert job.wait(60)
        assert job.state == "stopped"
        assert "paused" in repr(job) or "stopped" in repr(job)


def test_a_run_that_another_thread_stops_raises_where_it_is_waited_for(url):
    def stop():
        until(lambda: arm.busy)
        arm.job.stop()

    with vp.connect(url) as arm:
        program = slow(arm)
        threading.Thread(target=stop, daemon=True).start()
        with pytest.raises(StoppedError):
            arm.run(program)


def test_motions_that_two_threads_send_at_once_are_not_mixed_up(url, monkeypatch):
    with vp.connect(url) as arm:
        small, large = (
            vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + way).plan()
            for way in (0.01, 0.02)
        )
        loop = arm._remote
        call, started = loop.call, []

        def slowly(method, *told, **options):
            answer = call(method, *told, **options)
            if method == "AddPieces":
                time.sleep(0.2)
            return answer

        def run(motion):
            with contextlib.suppress(BusyError, NotAtStartError):  # the other was quicker
                started.append((motion, loop.run(motion._core)))

        monkeypatch.setattr(loop, "call", slowly)
        threads = [threading.Thread(target=run, args=(motion,)) for motion in (small, large)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        ((motion, execution),) = started
        assert execution.duration == motion.duration


def test_who_asks_for_control_cannot_act_on_the_terminals_of_others(url):
    with vp.connect(url, watch=True) as arm:
        name = "a\x1b[31m\x9b2J\x7f\u00e9"
        request = message("TakeControlRequest", name=name, version=vp.__version__)
        arm._remote.call("TakeControl", request, "Control")
        assert arm.operator == "a?[31m??2J?\u00e9"


def test_a_jog_moves_the_arm_for_as_long_as_it_is_called(url):
    with vp.connect(url) as arm:
        start = arm.setpoint
        velocity = np.array([0.5, 0, 0, 0, 0, 0])

        def moved():
            arm.jog(velocity)
            return arm.setpoint[0] > start[0] + 0.05

        until(moved)
        arm.jog(np.zeros(6))
        until(lambda: not arm.jogging)
        assert arm.jog_block == ""
        with pytest.raises(VelocityLimitError):
            arm.jog(np.full(6, 100.0))


def test_what_is_refused_says_what_it_says_in_one_process(url, puma, abc):
    elsewhere = vp.Program(puma, start=abc["B"]).movej(abc["C"])
    other = vp.load_robot("ur5e")
    with vp.connect(url) as arm:
        with pytest.raises(NotAtStartError) as refusal:
            arm.run(elsewhere)
        assert refusal.value.joint is not None
        assert refusal.value.ways_out
        with pytest.raises(BadArgumentError, match="for the robot"):
            arm.run(vp.Program(other, start=[0] * 6).movej([0.1] * 6))
        timed = vp.Program(puma, start=abc["A"]).timed([(abc["C"], 0.1)], t_acc=0.05)
        with pytest.raises(vp.MotionError):
            arm.run(timed)
        assert arm.job is None
        with pytest.raises(BadArgumentError):
            arm.override = 2.0
    with pytest.raises(DriveFaultError, match="no longer connected"):
        arm.jog(np.zeros(6))


def test_the_log_of_every_run_is_written_into_the_folder_of_logs(serve, tmp_path):
    logs = tmp_path / "logs"
    logs.mkdir()
    served = serve(logs=str(logs))
    with vp.connect(served.url) as arm:
        for _ in range(2):
            job = arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.02))
        job.log.save(tmp_path / "here.csv")
    assert served.end() == 0
    first, second = sorted(logs.iterdir(), key=lambda path: path.name.partition("-")[2])
    assert first.name.endswith("-run1.csv")
    assert second.read_bytes() == (tmp_path / "here.csv").read_bytes()


def test_no_log_of_quick_runs_is_left_out(serve, tmp_path):
    logs = tmp_path / "logs"
    logs.mkdir()
    served = serve(logs=str(logs))
    with vp.connect(served.url) as arm:
        there = arm.setpoint + 1e-6
        ways = [
            vp.Program(arm.robot, start=begin).movej(end).plan()._core
            for begin, end in ((arm.setpoint, there), (there, arm.setpoint))
        ]
        for k in range(20):
            assert arm._remote.run(ways[k % 2]).wait(60)
    assert served.end() == 0
    assert {f.stem.partition("-")[2] for f in logs.iterdir()} == {f"run{k + 1}" for k in range(20)}


def test_one_has_control_and_any_number_watch(url):
    with vp.connect(url) as arm:
        assert f"process {os.getpid()}" in arm.operator
        with pytest.raises(NotInControlError, match="has control"):
            vp.connect(url)
        job = arm.run(slow(arm), wait=False)
        with vp.connect(url, watch=True) as other, vp.connect(url, watch=True) as third:
            until(lambda: other.job.nominal_time > 0.0)
            assert third.job.state == "running"
            assert len(third.job.log) > 0
            assert other.operator == arm.operator
            for command in (other.job.stop, other.job.pause, lambda: other.run(slow(other))):
                with pytest.raises(NotInControlError):
                    command()
            with pytest.raises(NotInControlError):
                other.override = 0.1
            with pytest.raises(BadArgumentError, match="Another program"):
                _ = other.job.motion
        assert job.state == "running"
        job.stop()
    with vp.connect(url) as arm:
        assert arm.job.state == "stopped"
        assert "gave up control" in arm.control_loss


def test_a_watcher_that_is_interrupted_stops_nothing(url, monkeypatch):
    def interrupt(timeout):
        raise KeyboardInterrupt

    with vp.connect(url) as arm, vp.connect(url, watch=True) as other:
        job = arm.run(slow(arm), wait=False)
        found = other.job
        monkeypatch.setattr(found._execution, "wait", interrupt)
        with pytest.raises(KeyboardInterrupt):
            found.wait()
        assert job.state == "running"
        job.stop()


def test_leaving_the_block_on_an_error_stops_the_run(url):
    def fail(arm):
        arm.run(slow(arm), wait=False)
        raise KeyError

    with pytest.raises(KeyError), vp.connect(url) as arm:
        fail(arm)
    with vp.connect(url, watch=True) as arm:
        assert arm.job.state == "stopped"


def test_a_released_drive_is_enabled_for_the_next_connection(url):
    with vp.connect(url) as arm:
        job = arm.run(slow(arm), wait=False)
        job.stop(category=1)
        job.wait()
        with pytest.raises(DriveFaultError, match="released"):
            arm.run(slow(arm))
    with vp.connect(url) as arm:
        arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.02))


@pytest.mark.parametrize(
    ("url", "options", "says"),
    [
        ("tcp://", {}, "tcp://<host>:<port>"),
        ("tcp://127.0.0.1", {}, "tcp://<host>:<port>"),
        ("tcp://127.0.0.1:x", {}, "tcp://<host>:<port>"),
        ("tcp://127.0.0.1:7420/arm", {}, "tcp://<host>:<port>"),
        ("tcp://127.0.0.1:7420", {"start": [0] * 6}, "start is for an arm of this process"),
        ("tcp://127.0.0.1:7420", {"tool_speed": 0.25}, "tool_speed is for an arm of this process"),
        ("tcp://127.0.0.1:7420", {"cycle": 0.001}, "cycle is for an arm of this process"),
        ("sim://puma560", {"watch": True}, "for a controller"),
    ],
)
def test_what_cannot_be_connected_to_is_refused(url, options, says):
    with pytest.raises(BadArgumentError, match=says):
        vp.connect(url, **options)


def test_no_controller_is_said(serve):
    served = serve()
    assert served.end() == 0
    with pytest.raises(UnconnectedError, match=f"127.0.0.1:{served.port}"):
        vp.connect(served.url)


def test_another_robot_than_the_controllers_is_refused(url):
    with pytest.raises(BadArgumentError, match='is "puma560"'):
        vp.connect(url, robot=vp.load_robot("ur5e"))
    with vp.connect(url):  # and leaves control free
        pass


def test_a_check_reads_where_the_arm_stands_and_moves_nothing(url, tmp_path, abc):
    script = tmp_path / "job.py"
    script.write_text(
        f"""
import viapoint as vp
with vp.connect("{url}") as arm:
    arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.1))
""",
        encoding="utf-8",
    )
    command = [sys.executable, "-m", "viapoint.cli", "check", str(script)]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    with vp.connect(url, watch=True) as arm:
        assert arm.job is None
        np.testing.assert_array_equal(arm.setpoint, abc["A"])


def scripts():
    text = DOCUMENT.read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```", text, re.MULTILINE | re.DOTALL)


@pytest.mark.parametrize("script", [s for s in scripts() if "tls" not in s])
def test_the_scripts_of_the_document_run(serve, script, tmp_path):
    port = serve().port
    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", script.replace(":7420", f":{port}")],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("watch", [False, True])
def test_a_script_of_another_version_is_refused_with_both_named(url, monkeypatch, watch):
    there = vp.__version__
    monkeypatch.setattr(_core, "__version__", "7.3.1")
    with pytest.raises(
        UnconnectedError, match=rf"viapoint {re.escape(there)}, this script 7\.3\.1"
    ):
        vp.connect(url, watch=watch)
    patch = ".".join([*there.split(".")[:2], "99"])  # the last number may differ
    monkeypatch.setattr(_core, "__version__", patch)
    with vp.connect(url, watch=watch) as arm:
        assert arm.operator or watch


def test_the_controller_refuses_a_script_of_another_version_by_itself(url, monkeypatch):
    from viapoint import _remote

    monkeypatch.setattr(_remote, "_require_same_version", lambda there: None)
    monkeypatch.setattr(_core, "__version__", "7.3.1")
    with pytest.raises(BadArgumentError, match=r"has viapoint 7\.3\.1, the controller 0\."):
        vp.connect(url)
    with vp.connect(url, watch=True) as arm:
        assert arm.operator == ""
