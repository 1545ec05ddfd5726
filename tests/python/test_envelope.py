"""The polygon that position and coupled limits leave two joints."""

from __future__ import annotations

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors


def coupled(rows: list[list[float]], lower: list[float], upper: list[float]) -> vp.Robot:
    return vp.joint_robot(
        3,
        velocity=1,
        acceleration=1,
        jerk=1,
        position_min=[-1, -2, -3],
        position_max=[1, 2, 3],
        coupling=rows or None,
        lower=lower,
        upper=upper,
    )


def inside(polygon: np.ndarray, point: np.ndarray) -> bool:
    edges = np.roll(polygon, -1, axis=0) - polygon
    to = point - polygon
    return bool((edges[:, 0] * to[:, 1] - edges[:, 1] * to[:, 0] >= 0).all())


def area(polygon: np.ndarray) -> float:
    x, y = polygon.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def test_without_coupled_limits_it_is_the_rectangle():
    polygon = coupled([], [], []).joint_envelope(0, 1)
    np.testing.assert_array_equal(polygon, [[-1, -2], [1, -2], [1, 2], [-1, 2]])


def test_a_coupled_limit_cuts_corners_off():
    polygon = coupled([[1, 1, 0]], [-2], [2]).joint_envelope(0, 1)
    assert area(polygon) == pytest.approx(8 - 2 * 0.5)


def test_it_holds_just_the_joints_that_the_limits_allow():
    generator = np.random.default_rng(1)
    for _ in range(200):
        rows = generator.normal(size=(2, 3))
        robot = coupled(rows.tolist(), [-1.5, -1.0], [1.0, 2.0])
        at = generator.uniform(-0.3, 0.3, 3)
        polygon = robot.joint_envelope(0, 2, at=at)
        for _ in range(50):
            point = generator.uniform([-1, -3], [1, 3])
            q = np.array([point[0], at[1], point[1]])
            allowed = robot.limits.contains(q)
            assert (len(polygon) > 2 and inside(polygon, point)) == allowed


def test_nothing_is_left_where_the_others_take_it_all():
    robot = coupled([[0, 0.1, 1]], [-1], [1])
    assert robot.joint_envelope(0, 1, at=[0, 0, 3]).shape == (0, 2)


def test_what_is_no_pair_of_joints_is_refused():
    robot = coupled([], [], [])
    with pytest.raises(errors.BadArgumentError, match="two joints"):
        robot.joint_envelope(1, 1)
    with pytest.raises(errors.BadArgumentError, match="first"):
        robot.joint_envelope(3, 1)
    free = vp.joint_robot(2, velocity=1, acceleration=1, jerk=1)
    with pytest.raises(errors.BadArgumentError, match="no position limits"):
        free.joint_envelope(0, 1)
