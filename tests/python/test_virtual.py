"""Scripts under ``viapoint check``: the arm in virtual time behaves like the real one."""

import time

import numpy as np
import pytest

import viapoint as vp
from viapoint import _core, _session, errors


class _Virtual(_session.Session):
    virtual = True


@pytest.fixture(autouse=True)
def in_virtual_time():
    with _session.use(_Virtual()):
        yield


@pytest.fixture
def motion(puma, abc):
    return vp.Program(puma, start=abc["A"], scale=0.2).movej(abc["B"]).plan()


@pytest.fixture
def arm(motion):
    with vp.connect("sim://puma560", start=motion.start) as connected:
        yield connected


def polled(condition, looks=200):
    """Tell whether the condition comes true when looked at again and again."""
    return any(condition() for _ in range(looks))


def test_a_run_ends_where_it_should_without_waiting(arm, motion):
    begin = time.monotonic()
    job = arm.run(motion)
    assert time.monotonic() - begin < 0.5 * motion.duration
    assert job.state == "finished"
    np.testing.assert_allclose(arm.joints, motion.end, atol=1e-9)
    np.testing.assert_array_equal(job.log.q, vp.simulate(motion).q)


def test_a_script_that_polls_gets_to_the_end(arm, motion):
    job = arm.run(motion, wait=False)
    assert job.state == "running"
    assert polled(lambda: job.ended)


def test_pause_rests_on_the_path_and_resume_goes_on(arm, motion):
    job = arm.run(motion, wait=False)
    assert polled(lambda: job.nominal_time > 0.3 * motion.duration)
    job.pause()
    assert polled(lambda: job.state == "paused")
    rests = arm.joints
    assert job.wait(0.01) is False
    np.testing.assert_array_equal(arm.joints, rests)
    assert np.abs(rests - motion.end).max() > 0.05
    job.resume()
    assert job.wait() is True
    assert job.state == "finished"
    states = [vp.RunLog.STATES[s] for s in job.log.state]
    assert [s for i, s in enumerate(states) if i == 0 or states[i - 1] != s] == [
        "running",
        "pausing",
        "paused",
        "running",
        "finished",
    ]


def test_stop_ends_on_the_path(arm, motion):
    job = arm.run(motion, wait=False)
    job.stop()
    assert job.wait()
    assert job.state == "stopped"
    np.testing.assert_array_equal(arm.joints, job.log.q[-1])
    assert np.abs(arm.joints - motion.end).max() > 0.05


def test_an_override_slows_the_rest_of_the_run(arm, motion):
    job = arm.run(motion, wait=False)
    arm.override = 0.5
    job.wait()
    assert job.report.wall_time > 1.5 * motion.duration


@pytest.mark.parametrize("rest", [lambda a, j: j.pause(), lambda a, j: setattr(a, "override", 0.0)])
def test_leaving_the_block_at_rest_stops(motion, rest):
    with vp.connect("sim://puma560", start=motion.start) as arm:
        job = arm.run(motion, wait=False)
        rest(arm, job)
    assert job.state == "stopped"


def test_a_paused_run_keeps_the_arm_busy(arm, motion):
    job = arm.run(motion, wait=False)
    job.pause()
    with pytest.raises(errors.BusyError):
        arm.run(motion)
    assert arm.busy


def test_what_the_drive_would_refuse_is_refused(arm, motion):
    arm.run(motion)
    with pytest.raises(errors.NotAtStartError):
        arm.run(motion)


def test_a_closed_arm_refuses(motion):
    arm = vp.connect("sim://puma560", start=motion.start)
    arm.close()
    for use in (lambda: arm.run(motion), lambda: arm.joints, lambda: arm.override):
        with pytest.raises(errors.DriveFaultError, match="no longer connected"):
            use()


@pytest.mark.parametrize("cycle", [0.0, 5e-5, 2.0, "fast"])
def test_a_bad_cycle_is_refused(cycle):
    with pytest.raises(errors.BadArgumentError, match="cycle"):
        vp.connect("sim://puma560", cycle=cycle)


@pytest.mark.parametrize("processor", [-1, 4096, 0.5, "all"])
def test_a_bad_processor_is_refused_as_on_the_clock(processor):
    with pytest.raises(errors.BadArgumentError, match="processor") as in_virtual_time:
        vp.connect("sim://puma560", processor=processor)
    with (
        _session.use(_session.Session()),
        pytest.raises(errors.BadArgumentError, match="processor") as on_the_clock,
    ):
        vp.connect("sim://puma560", processor=processor)
    assert in_virtual_time.value.message == on_the_clock.value.message


def test_a_script_that_jogs_until_a_limit_is_met_comes_to_its_end():
    with vp.connect("sim://two_link") as arm:
        limit = arm.robot.limits.position_max[0]
        for _ in range(1000):
            arm.jog([1.0, 0.0])
            if arm.jog_block:
                break
        assert arm.jog_block == "joint 1 is at its position limit"
        assert abs(arm.setpoint[0] - limit) < 1e-9
        arm.jog([-1.0, 0.0])
        assert arm.jogging
        with pytest.raises(errors.BusyError, match="jogged"):
            arm.run(vp.Program(arm.robot, start=arm.setpoint).movej([0.1, 0.1]))
        assert polled(lambda: not arm.jogging)
        assert arm.setpoint[0] < limit - 0.1
        job = arm.run(vp.Program(arm.robot, start=arm.setpoint).movej([0.1, 0.1]))
        assert job.state == "finished"
        arm.jog([0.0, 0.5])
        assert polled(lambda: not arm.jogging)
        assert arm.setpoint[0] == pytest.approx(0.1, abs=1e-12)
        assert arm.setpoint[1] > 0.15


def test_a_jog_beyond_the_velocity_limit_is_refused_as_on_an_arm(arm):
    with pytest.raises(errors.VelocityLimitError, match="joint 1"):
        arm.jog([1e9] * 6)


def test_a_jog_in_virtual_time_needs_a_start_and_a_cycle(puma):
    for start, cycle in (([0.0] * 6, 0.0), ([np.nan] * 6, 0.002)):
        with pytest.raises(errors.BadArgumentError):
            _core.VirtualLoop(
                puma._core,
                _core.SimulatedSetup(start),
                cycle=cycle,
                silent_cycles=0,
                tool_speed=np.inf,
                box_min=[-np.inf] * 3,
                box_max=[np.inf] * 3,
            )


def test_the_guard_holds_an_arm_in_virtual_time(motion):
    with vp.connect("sim://puma560", start=motion.start, tool_speed=0.05) as arm:
        with pytest.raises(errors.DriveFaultError, match="tool was told to move too fast"):
            arm.run(motion)
        assert "on its path" in arm.fault
        with pytest.raises(errors.DriveFaultError):
            arm.jog([0.0] * 6)


def test_a_jog_in_a_pause_says_what_keeps_it():
    with vp.connect("sim://two_link") as arm:
        job = arm.run(vp.Program(arm.robot, start=[0.0, 0.0]).movej([0.5, 0.5]), wait=False)
        job.pause()
        assert polled(lambda: job.state == "paused")
        for _ in range(1000):
            arm.jog([1.0, 0.0])
            if arm.jog_block:
                break
        assert arm.jog_block == "joint 1 is at its position limit"
        assert polled(lambda: not arm.jogging)
        job.resume()
        assert job.wait()
        assert job.state == "finished"
