"""What `connect` and `run` refuse before anything moves."""

from __future__ import annotations

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors


def test_an_arm_that_is_elsewhere_refuses_with_the_way_out(short):
    with vp.connect("sim://puma560") as arm:
        with pytest.raises(errors.NotAtStartError) as caught:
            arm.run(short)
        np.testing.assert_array_equal(arm.joints, np.zeros(6))
    assert caught.value.ways_out


def test_the_start_may_stand_in_the_url():
    with vp.connect("sim://scara?start=0.1,0.2,0.1,-0.3") as arm:
        np.testing.assert_allclose(arm.joints, [0.1, 0.2, 0.1, -0.3])


@pytest.mark.parametrize(
    ("url", "arguments", "says"),
    [
        ("puma560", {}, "sim://"),
        ("tcp://host", {}, "tcp://<host>"),
        ("sim://", {}, "sim://"),
        ("sim://puma560?begin=0", {}, "start"),
        ("sim://puma560?start=0,x", {}, "start"),
        ("sim://puma560?start=0,1", {}, "start"),
        ("sim://puma560", {"start": [1, 2]}, "start"),
        ("sim://puma560", {"cycle": 0.0}, "cycle"),
        ("sim://puma560", {"cycle": "fast"}, "cycle"),
        (3, {}, "url is 3"),
        ("sim://puma560", {"robot": "puma560"}, "robot is 'puma560'"),
    ],
)
def test_a_bad_connection_is_refused(url, arguments, says):
    with pytest.raises(errors.BadArgumentError, match=says):
        vp.connect(url, **arguments)


def test_a_start_outside_the_limits_is_refused():
    with pytest.raises(errors.JointLimitError, match="start: joint 2 is at 9") as caught:
        vp.connect("sim://puma560", start=[0, 9, 0, 0, 0, 0])
    assert caught.value.joint == 1
    assert caught.value.ways_out


def test_a_start_that_breaks_a_coupled_limit_is_refused():
    robot = vp.joint_robot(
        2, velocity=1, acceleration=1, jerk=1, coupling=[[1, 1]], lower=[-1], upper=[1]
    )
    with pytest.raises(errors.CouplingLimitError, match="start"):
        vp.connect("sim://two", robot=robot, start=[0.8, 0.8])


def test_a_connection_to_an_unknown_robot_is_refused():
    with pytest.raises(errors.BadRobotError, match="puma561"):
        vp.connect("sim://puma561")


def test_a_program_for_other_limits_is_refused(puma, abc):
    slow = puma.with_limits(velocity=0.5)
    program = vp.Program(slow, start=abc["A"]).movej(abc["A"] + 0.05)
    with (
        vp.connect("sim://puma560", start=abc["A"]) as arm,
        pytest.raises(errors.BadArgumentError, match="robot"),
    ):
        arm.run(program)
    with vp.connect("sim://puma560", start=abc["A"], robot=slow) as arm:
        assert arm.run(program).state == "finished"


def test_what_is_no_program_is_refused():
    with (
        vp.connect("sim://puma560") as arm,
        pytest.raises(errors.BadArgumentError, match="program"),
    ):
        arm.run("p.json")
