"""Builders refuse bad arguments at once, by the argument's name, its value and what is allowed."""

import json
import math

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors

Q = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]


@pytest.fixture
def program(puma):
    return vp.Program(puma, start=Q)


@pytest.mark.parametrize(
    ("target", "says"),
    [
        ([1.0, 2.0], r"target has the shape \(2,\); it must be \(6,\)"),
        (np.zeros((3, 3)), r"target has the shape \(3, 3\); a pose is \(4, 4\)"),
        (np.zeros((2, 4, 4)), r"target has the shape \(2, 4, 4\)"),
        ([*Q[:5], math.nan], r"target\[5\] is nan; every value must be finite"),
        ([*Q[:5], math.inf], r"target\[5\] is inf"),
        ("home", r"target is 'home'; it must hold numbers only"),
        ([1, 2, "x", 4, 5, 6], "target is"),
        ([[1, 2], [3]], "target is"),
        ([True] * 6, "it must hold numbers only"),
        ([1j] * 6, "it must hold numbers only"),
        (None, "Neither target nor position is given"),
        (0.5, r"target has the shape \(\)"),
    ],
)
@pytest.mark.parametrize("move", ["movej", "movel"])
def test_a_bad_target_is_refused(program, move, target, says):
    with pytest.raises(errors.BadArgumentError, match=says):
        getattr(program, move)(target)
    assert len(program) == 0


def test_target_and_position_together_are_refused(program):
    with pytest.raises(errors.BadArgumentError, match="Both target and position"):
        program.movel(np.eye(4), position=[0, 0, 0])


@pytest.mark.parametrize("position", [[0, 0], [0, 0, math.nan], [[0, 0, 0]], "here"])
def test_a_bad_position_is_refused(program, position):
    with pytest.raises(errors.BadArgumentError, match="position"):
        program.movej(position=position)


def test_pose_that_is_no_rotation_is_refused_by_its_worst_columns(program, golden):
    with pytest.raises(errors.NotARotationError, match=r"target: .*columns 2 and 3 are 59\.9°"):
        program.movel(golden["puma560"]["poses_m"]["C_as_printed"])
    assert len(program) == 0


def test_a_reflection_is_refused(program):
    with pytest.raises(errors.NotARotationError):
        program.movel(np.diag([1.0, 1.0, -1.0, 1.0]))


def test_a_bad_bottom_row_is_refused(program):
    pose = np.eye(4)
    pose[3] = [0, 0, 1, 1]
    with pytest.raises(errors.MotionError, match="target"):
        program.movel(pose)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"speed": 0.0}, "speed is 0 m/s; .*above 0 m/s"),
        ({"speed": -1}, "speed is -1 m/s"),
        ({"speed": math.nan}, "speed is nan m/s"),
        ({"speed": "fast"}, "speed is 'fast'"),
        ({"speed": True}, "speed is True"),
        ({"acceleration": math.inf}, "acceleration is inf"),
        ({"scale": 1.5}, "scale is 1.5; .*at most 1"),
        ({"scale": 0}, "scale is 0; .*above 0"),
        ({"zone": -0.01}, "zone is -0.01 m; .*above 0"),
        ({"zone": math.nan}, "zone is nan"),
        ({"zone": "round"}, "zone is 'round'; it must be a number .*\"fine\""),
        ({"orientation": "tool"}, 'orientation is \'tool\'; .*"least", "wrist", "fixed"'),
    ],
)
def test_a_bad_wish_is_refused(program, arguments, says):
    with pytest.raises(errors.BadArgumentError, match=says):
        program.movel(np.eye(4), **arguments)
    assert len(program) == 0


@pytest.mark.parametrize("make", [vp.radius, vp.deviation, vp.joint_deviation])
@pytest.mark.parametrize("size", [0, -1, math.nan, math.inf, "2", None])
def test_a_zone_of_no_size_is_refused(make, size):
    with pytest.raises(errors.BadArgumentError, match=make.__name__):
        make(size)


def test_a_number_as_zone_means_its_radius(puma):
    one = vp.Program(puma, start=Q).movej(np.zeros(6), zone=0.02).movej(Q)
    other = vp.Program(puma, start=Q).movej(np.zeros(6), zone=vp.radius(0.02)).movej(Q)
    assert _without_source(one) == _without_source(other)
    fine = vp.Program(puma, start=Q).movej(np.zeros(6)).movej(Q)
    assert _without_source(one) != _without_source(fine)


def _without_source(program):
    document = json.loads(program._core.to_json())
    for step in document["steps"]:
        del step["source"]
    return document


@pytest.mark.parametrize("seconds", [-0.1, math.nan, "1", None, True])
def test_a_bad_wait_is_refused(program, seconds):
    with pytest.raises(errors.BadArgumentError, match="seconds"):
        program.wait(seconds)


@pytest.mark.parametrize("index", [-1, 64, 1.0, "3", True])
def test_a_bad_output_is_refused(program, index):
    with pytest.raises(errors.BadArgumentError, match="index"):
        program.set_do(index, True)


@pytest.mark.parametrize("value", [1, 0, "on", None])
def test_an_output_value_that_is_no_bool_is_refused(program, value):
    with pytest.raises(errors.BadArgumentError, match="value"):
        program.set_do(3, value)


@pytest.mark.parametrize(
    ("points", "arguments", "says"),
    [
        ([Q], {}, r"points\[0\] is"),
        (5, {}, "points is 5"),
        ("AB", {}, "points is 'AB'"),
        ([(Q, 0.0), ([1, 2], 0.5)], {}, r"points\[1\]\[0\]"),
        ([(Q, 0.0), (Q, -0.5)], {}, r"points\[1\]\[1\] is -0.5 s"),
        ([(Q, 0.0), (Q, 0.5)], {"t_acc": 0}, "t_acc is 0 s"),
        ([(Q, 0.0), (Q, 0.5)], {"space": "tool"}, "space is 'tool'"),
    ],
)
def test_a_bad_timed_program_is_refused(program, points, arguments, says):
    with pytest.raises(errors.BadArgumentError, match=says):
        program.timed(points, **arguments)


@pytest.mark.parametrize("start", [[0.0] * 5, [math.nan] * 6, None, "home"])
def test_a_bad_start_is_refused(puma, start):
    with pytest.raises(errors.BadArgumentError, match="start"):
        vp.Program(puma, start=start)


def test_a_robot_that_is_a_name_is_refused_with_the_way_out():
    with pytest.raises(errors.BadArgumentError, match="load_robot"):
        vp.Program("puma560", start=Q)


def test_a_bad_default_is_refused_where_it_is_given(puma):
    with pytest.raises(errors.BadArgumentError, match="scale is 2"):
        vp.Program(puma, start=Q, scale=2)


def test_builders_chain(puma):
    program = vp.Program(puma, start=Q).movej(np.zeros(6)).wait(0.1).set_do(1, True)
    assert len(program) == 3
