"""Configurations, redundancy, batches, dexterity and reach, as Python has them."""

from __future__ import annotations

import numpy as np
import pytest

import viapoint as vp


def random_joints(robot: vp.Robot, count: int, seed: int = 1) -> np.ndarray:
    generator = np.random.default_rng(seed)
    limits = robot.limits
    return generator.uniform(limits.position_min, limits.position_max, (count, robot.joints))


@pytest.fixture(scope="module", params=["puma560", "ur5e", "scara", "panda", "iiwa14"])
def robot(request: pytest.FixtureRequest) -> vp.Robot:
    return vp.load_robot(request.param)


def test_batches_are_what_single_calls_are(robot: vp.Robot):
    q = random_joints(robot, 50)
    poses = robot.fk_batch(q)
    np.testing.assert_allclose(poses, [robot.fk(row) for row in q], atol=1e-12)
    found = robot.ik_batch(poses, near=q)
    np.testing.assert_allclose(found, q, atol=1e-6)
    to_one = robot.ik_batch(poses, near=q[0])
    np.testing.assert_array_equal(to_one, [robot.ik(pose, near=q[0]) for pose in poses])


def test_quick_calls_answer_as_converted_ones(robot: vp.Robot):
    for q in random_joints(robot, 20, seed=2):
        pose = robot.fk(q)
        np.testing.assert_array_equal(
            robot.ik(pose, near=q), robot.ik(pose.tolist(), near=q.tolist())
        )
        transposed = np.asfortranarray(pose)  # not in rows: converted
        np.testing.assert_array_equal(robot.ik(pose, near=q), robot.ik(transposed, near=q))
        np.testing.assert_array_equal(
            robot.ik_all(pose, near=q), robot.ik_all(pose.tolist(), near=q.tolist())
        )


def test_a_configuration_finds_its_joints_again():
    for name in ("puma560", "ur5e", "scara"):
        robot = vp.load_robot(name)
        for q in random_joints(robot, 20, seed=3):
            config = robot.configuration(q)
            found = robot.ik(robot.fk(q), config=config)
            np.testing.assert_allclose(found, q, atol=1e-6)
            assert robot.configuration(found).fits(config)


def test_ik_all_keeps_the_wish():
    robot = vp.load_robot("ur5e")
    pose = robot.fk([0.3, -1.2, 1.4, -0.9, 1.1, 0.4])
    rows = robot.ik_all(pose, config=vp.Configuration(elbow="up", wrist="flip"))
    assert 0 < len(rows) < len(robot.ik_all(pose))
    for row in rows:
        config = robot.configuration(row)
        assert (config.elbow, config.wrist) == ("up", "flip")
        assert config.shoulder in ("front", "back")
        assert len(config.turns) == 6


def test_words_that_are_none_are_refused(puma: vp.Robot):
    with pytest.raises(vp.errors.BadArgumentError, match='"up", "down" or None'):
        vp.Configuration(elbow="left")
    with pytest.raises(vp.errors.BadArgumentError, match="must be a Configuration"):
        puma.ik(np.eye(4), config="up")


def test_a_configuration_that_is_not_there_is_refused(puma: vp.Robot, abc: dict[str, np.ndarray]):
    with pytest.raises(vp.errors.OutsideLimitsError, match="there are: "):
        puma.ik(puma.fk(abc["A"]), config=vp.Configuration(turns=[3, 0, 0, 0, 0, 0]))


def test_redundancy_is_named_and_kept():
    robot = vp.load_robot("iiwa14")
    assert robot.redundancy == "arm angle"
    q = random_joints(robot, 1, seed=4)[0]
    for row in robot.ik_all(robot.fk(q), redundancy=robot.redundancy_of(q)):
        assert robot.redundancy_of(row) == pytest.approx(robot.redundancy_of(q), abs=1e-6)
    assert vp.load_robot("puma560").redundancy is None
    with pytest.raises(vp.errors.UncontrolledError):
        vp.load_robot("puma560").redundancy_of(np.zeros(6))


def test_batches_say_which_pose_is_out_of_reach(puma: vp.Robot, abc: dict[str, np.ndarray]):
    poses = np.array([puma.fk(abc["A"]), puma.fk(abc["B"])])
    poses[1, 0, 3] += 5.0
    with pytest.raises(vp.errors.UnreachableError, match=r"poses\[1\]"):
        puma.ik_batch(poses)
    found = puma.ik_batch(poses, near=abc["A"], unreachable="nan")
    np.testing.assert_allclose(found[0], abc["A"], atol=1e-9)
    assert np.isnan(found[1]).all()


def test_dexterity_is_lost_at_a_straight_wrist(puma: vp.Robot):
    straight = puma.dexterity([0.3, -0.4, 0.5, 0.6, 0.0, 0.2])
    assert straight.yoshikawa < 1e-12
    assert straight.condition > 1e12
    bent = puma.dexterity([0.3, -0.4, 0.5, 0.6, 0.9, 0.2])
    assert 0.0 < bent.asada < 1.0
    assert bent.isotropy == pytest.approx(1.0 / bent.condition)
    np.testing.assert_allclose(bent.linear.axes.T @ bent.linear.axes, np.eye(3), atol=1e-12)
    assert list(bent.linear.lengths) == sorted(bent.linear.lengths, reverse=True)


def test_reach_of_two_links_is_a_ring():
    found = vp.load_robot("two_link").reach([1.0, 2.0, 0.0])
    np.testing.assert_allclose(found, [[1.0, 3.0]], atol=1e-8)


def test_reach_with_an_orientation(puma: vp.Robot):
    down = np.diag([1.0, -1.0, -1.0])
    found = puma.reach([1.0, 0.0, 0.0], start=[0.0, 0.0, -0.3], rotation=down)
    assert (found[:, 0] <= found[:, 1]).all()
    far = np.eye(4)
    far[:3, :3] = down
    far[:3, 3] = [found[-1, 1] - 1e-6, 0.0, -0.3]
    puma.ik(far)
    far[0, 3] += 1e-5
    with pytest.raises(vp.MotionError):
        puma.ik(far)


def test_the_workspace_is_sampled_within_the_limits(robot: vp.Robot):
    points, q = robot.workspace(500, seed=5)
    assert points.shape == (500, 3)
    assert all(robot.limits.contains(row) for row in q)
    np.testing.assert_array_equal(points, robot.workspace(500, seed=5)[0])
