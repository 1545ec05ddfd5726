"""Dexterity along a motion and over all orientations."""

from __future__ import annotations

import numpy as np
import pytest

import viapoint as vp
from viapoint import deg, errors
from viapoint._rotations import even_rotations

HOME = deg * [0, 45, 0, 0, 60, 0]


def test_the_least_dexterity_is_found_between_the_samples():
    robot = vp.load_robot("puma560")
    over = deg * [0, 45, 0, 0, -40, 0]  # on the way joint 5 is straight
    motion = vp.Program(robot, start=HOME).movej(over).plan()
    found = motion.least_dexterity()
    assert found.yoshikawa.value < 1e-6
    assert found.isotropy.value < 1e-6
    assert found.yoshikawa.move == 0
    q = motion.at([found.yoshikawa.time]).q[0]
    assert abs(q[4]) < 1e-5
    for name in ("yoshikawa", "asada", "isotropy", "least"):
        sampled = min(getattr(robot.dexterity(q), name) for q in motion.sample(0.01).q)
        assert getattr(found, name).value <= sampled
    with pytest.raises(errors.BadArgumentError, match="dt"):
        motion.least_dexterity(0)


def test_the_least_dexterity_is_of_the_tool_that_moves():
    robot = vp.load_robot("puma560")
    tool = np.eye(4)
    tool[:3, 3] = [0.3, 0.0, 0.2]
    end = np.add(HOME, [0.5, 0, 0, 0, 0, 0])
    motion = vp.Program(robot, start=HOME, tool=tool).movej(end).plan()
    whole = robot.with_tool(tool)
    expected = min(whole.dexterity(q).asada for q in motion.sample(0.002).q)
    assert motion.least_dexterity().asada.value == pytest.approx(expected, rel=1e-3)


def test_joints_without_kinematics_have_no_dexterity():
    robot = vp.joint_robot(2, velocity=1, acceleration=1, jerk=1)
    motion = vp.Program(robot, start=[0, 0]).movej([1, 1]).plan()
    with pytest.raises(errors.UncontrolledError):
        motion.least_dexterity()


def test_rotations_are_even_over_all_there_are():
    rotations = even_rotations(2000)
    np.testing.assert_allclose(
        rotations @ rotations.transpose(0, 2, 1), [np.eye(3)] * 2000, atol=1e-12
    )
    np.testing.assert_allclose(np.linalg.det(rotations), 1.0)
    np.testing.assert_allclose(rotations.mean(axis=0), np.zeros((3, 3)), atol=0.01)
    # No rotation is far from all of them.
    generator = np.random.default_rng(1)
    for _ in range(200):
        q, _ = np.linalg.qr(generator.normal(size=(3, 3)))
        q *= np.sign(np.linalg.det(q))
        traces = np.einsum("kij,ij->k", rotations, q)
        assert np.degrees(np.arccos(np.clip((traces.max() - 1) / 2, -1, 1))) < 25


def test_the_dexterity_share_tells_the_middle_from_the_rim():
    robot = vp.load_robot("ur5e")
    limits = robot.limits
    assert limits.position_max[5] > np.pi  # every joint turns once around and more
    middle, rim, out = robot.dexterity_share([[0.4, 0.2, 0.3], [0.8, 0.3, 0.2], [3, 0, 0]])
    assert middle > 0.9
    assert 0 < rim < middle
    assert out == 0
    with pytest.raises(errors.BadArgumentError, match="positions"):
        robot.dexterity_share([0.4, 0.2, 0.3])
