"""Joints along poses, without a jump."""

from __future__ import annotations

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors

HOME = np.array([0.1, 0.7, 0.1, 0.2, 0.9, -0.3])


def line(robot: vp.Robot, q: np.ndarray, way: list[float], count: int = 100) -> np.ndarray:
    poses = np.repeat(robot.fk(q)[None], count, axis=0)
    poses[:, :3, 3] += np.linspace(0, 1, count)[:, None] * way
    return poses


def test_a_line_is_followed_within_the_largest_step():
    robot = vp.load_robot("puma560")
    poses = line(robot, HOME, [0.0, 0.2, 0.1])
    q = robot.ik_path(poses, HOME)
    assert q.shape == (100, 6)
    np.testing.assert_allclose(robot.fk(q), poses, atol=2e-9)
    assert np.abs(np.diff(q, axis=0)).max() < 0.2
    np.testing.assert_allclose(q[0], HOME, atol=1e-8)
    with pytest.raises(errors.BranchChangeError, match="jump") as caught:
        robot.ik_path(poses, HOME, largest_step=1e-4)
    assert 0 < caught.value.share < 0.1


def test_what_cannot_be_followed_says_where():
    robot = vp.load_robot("puma560")
    with pytest.raises(errors.UnreachableError, match="pose 1") as caught:
        robot.ik_path(line(robot, HOME, [5.0, 0.0, 0.0], 11), HOME)
    assert caught.value.share == pytest.approx(0.1)


def test_arguments_are_checked():
    robot = vp.load_robot("puma560")
    with pytest.raises(errors.BadArgumentError, match="poses"):
        robot.ik_path(np.eye(4), HOME)
    with pytest.raises(errors.BadArgumentError, match="largest_step"):
        robot.ik_path(line(robot, HOME, [0, 0, 0]), HOME, largest_step=0)
    with pytest.raises(errors.BadArgumentError, match="no pose"):
        robot.ik_path(np.zeros((0, 4, 4)), HOME)
    joints = vp.joint_robot(2, velocity=1, acceleration=1, jerk=1)
    with pytest.raises(errors.UncontrolledError):
        joints.ik_path(np.zeros((1, 4, 4)), [0, 0])
