"""Step, backward, stop categories, a jog in a pause, and the guard: on the arm, and simulated."""

from __future__ import annotations

import time

import numpy as np
import pytest

import viapoint as vp
from viapoint import _session, errors


def wait_for(condition, seconds=5.0):
    """Wait until the condition holds; fail with a reason instead of for ever."""
    end = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < end, "the condition never came true"
        time.sleep(0.002)


@pytest.fixture
def motion(puma, abc):
    """From A to B, stop, and on to C."""
    return vp.Program(puma, start=abc["A"]).movej(abc["B"]).movej(abc["C"]).plan()


def assert_within(samples, robot):
    """Differences of the samples stay within the limits."""
    limits = robot.limits
    for values, limit in (
        (samples.q, limits.velocity),
        (samples.qd, limits.acceleration),
        (samples.qdd, limits.jerk),
    ):
        rate = np.abs(np.diff(values, axis=0)).max(axis=0) / 0.002
        assert (rate <= limit * (1 + 1e-6)).all()


def test_a_step_ends_at_the_taught_point_and_resume_goes_on(motion, abc):
    samples = vp.simulate(motion, [(0.0, "step"), (4.0, "resume")])
    assert_within(samples, motion.robot)
    rests = np.abs(samples.t - 3.9).argmin()
    np.testing.assert_allclose(samples.q[rests], abc["B"], atol=1e-9)
    np.testing.assert_allclose(samples.q[-1], abc["C"], atol=1e-9)


def test_a_way_back_may_be_stopped_by_the_override(motion, abc):
    samples = vp.simulate(
        motion, [(1.0, "backward"), (1.2, "override", 0.0), (1.6, "override", 1.0)]
    )
    np.testing.assert_allclose(samples.q[-1], motion.sample(0.002).q[0], atol=1e-9)


def test_backward_goes_back_along_the_path_to_its_start(motion, abc):
    samples = vp.simulate(motion, [(1.0, "backward")])
    assert_within(samples, motion.robot)
    np.testing.assert_array_equal(samples.q[-1], samples.q[0])
    path = motion.sample(2e-4).q
    for q in samples.q[::10]:
        assert np.abs(path - q).max(axis=1).min() < 2e-3


def test_a_jog_in_a_pause_is_taken_back_before_the_motion_goes_on(motion, abc):
    away = [0.3, 0.0, 0.0, 0.0, 0.0, -0.3]
    commands = [(0.5, "pause"), *((1.5 + 0.1 * k, "jog", away) for k in range(5)), (3.0, "resume")]
    samples = vp.simulate(motion, commands)
    assert_within(samples, motion.robot)
    at = {t: samples.q[np.abs(samples.t - t).argmin()] for t in (1.4, 2.9)}
    moved = at[2.9] - at[1.4]
    assert moved[0] > 0.05
    assert moved[5] < -0.05
    assert np.abs(samples.q - at[1.4]).max(axis=1)[samples.t > 3.0].min() == 0.0
    np.testing.assert_allclose(samples.q[-1], abc["C"], atol=1e-9)


@pytest.mark.parametrize(
    "command", [(0.1, "step", 1.0), (0.1, "jog"), (0.1, "jog", [0.1]), (0.1, "back")]
)
def test_a_bad_command_is_refused(motion, command):
    with pytest.raises(errors.BadArgumentError):
        vp.simulate(motion, [command])


def test_a_jog_beyond_a_limit_is_refused(motion):
    with pytest.raises(errors.VelocityLimitError):
        vp.simulate(motion, [(0.1, "jog", [100.0, 0, 0, 0, 0, 0])])


class _Virtual(_session.Session):
    virtual = True


@pytest.mark.parametrize("virtual", [False, True])
def test_an_arm_steps_is_jogged_in_the_pause_and_runs_to_its_end(motion, abc, virtual):
    with (
        _session.use(_Virtual() if virtual else _session.Session()),
        vp.connect("sim://puma560", start=abc["A"]) as arm,
    ):
        job = arm.run(motion, wait=False)
        job.step()
        wait_for(lambda: job.state == "paused")
        np.testing.assert_allclose(arm.setpoint, abc["B"], atol=1e-9)
        arm.jog([0.1] * 6)
        wait_for(lambda: not arm.jogging)
        assert np.abs(arm.setpoint - abc["B"]).max() > 1e-3
        job.resume()
        assert job.wait(10.0)
        assert job.state == "finished"
        np.testing.assert_allclose(job.log.q[-1], abc["C"], atol=1e-9)
        assert {"jogging", "returning"} <= {job.log.STATES[k] for k in job.log.state}


@pytest.mark.parametrize("virtual", [False, True])
def test_a_stop_of_category_1_releases_the_drive(motion, abc, virtual):
    with (
        _session.use(_Virtual() if virtual else _session.Session()),
        vp.connect("sim://puma560", start=abc["A"]) as arm,
    ):
        job = arm.run(motion, wait=False)
        wait_for(lambda: job.nominal_time > 0.05)
        for category in (0, 3, "2", True):
            with pytest.raises(errors.BadArgumentError, match="category"):
                job.stop(category=category)
        job.stop(category=1)
        assert job.wait(10.0)
        assert job.state == "stopped"
        assert arm.fault == ""
        with pytest.raises(errors.DriveFaultError, match="category 1"):
            arm.run(motion)
        with pytest.raises(errors.DriveFaultError, match="category 1"):
            arm.jog([0.1] * 6)


def test_the_guard_stops_a_tool_that_is_too_fast_on_its_path(motion, abc):
    with vp.connect("sim://puma560", start=abc["A"], tool_speed=0.25) as arm:
        with pytest.raises(errors.DriveFaultError, match="tool was told to move too fast"):
            arm.run(motion)
        assert "on its path" in arm.fault
        path = motion.sample(2e-4).q
        assert np.abs(path - arm.setpoint).max(axis=1).min() < 2e-3
        with pytest.raises(errors.DriveFaultError):
            arm.run(motion)


def test_the_guard_lets_a_slow_tool_pass(puma, abc):
    slow = vp.Program(puma, start=abc["A"], scale=0.02).movej(abc["A"] + 0.02)
    with vp.connect(
        "sim://puma560", start=abc["A"], tool_speed=0.25, workspace=([-2] * 3, [2] * 3)
    ) as arm:
        assert arm.run(slow).state == "finished"


def test_the_guards_limits_are_checked():
    box = ([-1.0, -1.0, 0.0], [1.0, 1.0, 0.0])
    for arguments in ({"tool_speed": -1.0}, {"workspace": box}, {"workspace": 3}):
        with pytest.raises(errors.BadArgumentError):
            vp.connect("sim://puma560", **arguments)
    two = vp.joint_robot(2, velocity=1.0, acceleration=5.0, jerk=50.0)
    with pytest.raises(errors.BadArgumentError, match="no kinematics"):
        vp.connect("sim://two", robot=two, tool_speed=0.25)
