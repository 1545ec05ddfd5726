"""Hold-to-run on a connected arm."""

import time

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors


@pytest.fixture
def robot():
    return vp.joint_robot(
        2,
        velocity=[1.0, 2.0],
        acceleration=[5.0, 10.0],
        jerk=[50.0, 100.0],
        position_min=[-1.0, -1.0],
        position_max=[1.0, 0.05],
    )


@pytest.fixture
def arm(robot):
    with vp.connect("sim://joints", robot=robot) as arm:
        yield arm


def until_rest(arm):
    end = time.monotonic() + 20.0
    while arm.jogging:
        assert time.monotonic() < end
        time.sleep(0.005)
    return arm.setpoint


def test_jog_moves_until_the_calls_stop(arm):
    arm.jog([0.2, 0.0])
    assert arm.jogging
    first = until_rest(arm)
    # A quarter of a second at 0.2 rad/s at most, and the way to stop.
    assert 0.01 < first[0] < 0.07
    assert first[1] == 0.0
    assert np.array_equal(arm.setpoint, first)
    arm.jog([0.2, 0.0])
    time.sleep(0.1)
    arm.jog([0.2, 0.0])
    assert until_rest(arm)[0] > first[0] + 0.02


def test_zero_velocity_ends_the_jog(arm):
    arm.jog([1.0, 0.0])
    time.sleep(0.02)
    arm.jog([0.0, 0.0])
    until_rest(arm)
    assert not arm.jogging


def test_jog_stops_at_the_position_limit_and_says_so(arm):
    for _ in range(40):
        arm.jog([0.0, 0.5])
        time.sleep(0.02)
        if arm.jog_block:
            break
    assert arm.jog_block == "joint 2 is at its position limit"
    assert until_rest(arm)[1] == 0.05
    arm.jog([0.0, -0.5])
    assert until_rest(arm)[1] < 0.05


def test_program_starts_where_the_jog_ended(arm, robot):
    arm.jog([0.3, -0.3])
    rest = until_rest(arm)
    job = arm.run(vp.Program(robot, start=rest).movej([0.2, 0.0]))
    assert job.state == "finished"
    assert arm.setpoint == pytest.approx([0.2, 0.0])


def test_runs_and_jogs_exclude_each_other(arm, robot):
    program = vp.Program(robot, start=[0.0, 0.0]).movej([0.5, 0.0])
    job = arm.run(program, wait=False)
    job.pause()
    with pytest.raises(errors.BusyError):
        arm.jog([0.1, 0.0])
    job.stop()
    job.wait()
    start = arm.setpoint
    arm.jog([0.1, 0.0])
    with pytest.raises(errors.BusyError, match="jogged"):
        arm.run(vp.Program(robot, start=start).movej([0.5, 0.0]))
    until_rest(arm)


def test_wrong_velocities_are_refused(arm):
    with pytest.raises(errors.VelocityLimitError) as caught:
        arm.jog([0.0, 2.1])
    assert caught.value.joint == 1
    assert caught.value.limit == 2.0
    for wrong in ([0.1], [0.1, np.nan], [0.1, np.inf], "fast"):
        with pytest.raises(errors.BadArgumentError):
            arm.jog(wrong)
    assert not arm.jogging


def held(velocity, seconds):
    return [(0.1 * i, velocity) for i in range(round(10 * seconds))]


def test_jog_in_virtual_time_keeps_every_limit_and_ends_250_ms_after_the_last_call(robot):
    s = vp.simulate_jog(robot, [0.0, 0.0], held([0.5, -0.5], 1.0))
    assert s.t[1] == 0.002
    assert np.array_equal(s.qd[250], [0.5, -0.5])
    assert np.all(s.qd[-1] == 0.0)
    # The last call at 0.9 s counts until 1.15 s; stopping from 0.5 rad/s at 5 rad/s² takes 0.2 s.
    assert 1.15 < s.t[-1] < 1.4
    for rate, limit in ((s.qd, [1.0, 2.0]), (s.qdd, [5.0, 10.0]), (s.qddd, [50.0, 100.0])):
        assert np.all(np.abs(rate) <= np.array(limit) * (1.0 + 1e-12))


def test_jog_in_virtual_time_stops_at_the_position_limit(robot):
    s = vp.simulate_jog(robot, [0.0, 0.0], held([0.0, 0.5], 2.0))
    assert s.q[-1, 1] == 0.05
    assert s.q[:, 1].max() <= 0.05 + 1e-12
    assert np.all(s.q[:, 0] == 0.0)


def test_jog_in_virtual_time_is_what_the_loop_does(robot):
    arm = vp.connect("sim://joints", robot=robot)
    with arm:
        arm.jog([0.2, 0.0])
        rest = until_rest(arm)
    s = vp.simulate_jog(robot, [0.0, 0.0], [(0.0, [0.2, 0.0])])
    assert np.array_equal(s.q[-1], rest)


def test_jog_in_virtual_time_without_a_call_rests(robot):
    s = vp.simulate_jog(robot, [0.1, 0.0], [])
    assert len(s) == 1
    assert np.array_equal(s.q[0], [0.1, 0.0])


def test_wrong_calls_of_a_jog_in_virtual_time_are_refused(robot):
    with pytest.raises(errors.VelocityLimitError) as caught:
        vp.simulate_jog(robot, [0.0, 0.0], [(0.0, [0.0, 2.1])])
    assert caught.value.joint == 1
    for calls in ([(0.0,)], [0.0], [(-1.0, [0.1, 0.0])], [(0.0, [0.1])], [(1e9, [0.1, 0.0])]):
        with pytest.raises(errors.BadArgumentError):
            vp.simulate_jog(robot, [0.0, 0.0], calls)
    with pytest.raises(errors.BadArgumentError):
        vp.simulate_jog(robot, [0.0, np.nan], [])


def test_disconnecting_brings_the_jog_to_rest(robot):
    with vp.connect("sim://joints", robot=robot) as arm:
        arm.jog([1.0, 0.0])
        time.sleep(0.05)
    with pytest.raises(errors.DriveFaultError):
        arm.jog([0.1, 0.0])
