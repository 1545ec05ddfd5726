"""Robots through the Python face, against the golden numbers."""

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors

BUILT_IN = ["iiwa14", "panda", "puma560", "rpp", "scara", "two_link", "ur5e"]


@pytest.mark.parametrize("name", BUILT_IN)
def test_built_in_robots_load_and_agree_with_their_own_inverse(name):
    robot = vp.load_robot(name)
    limits = robot.limits
    assert limits.velocity.shape == (robot.joints,)
    generator = np.random.default_rng(7)
    for trial in range(20):
        low = np.maximum(limits.position_min, -3.0)
        high = np.minimum(limits.position_max, 3.0)
        q = low + (high - low) * generator.uniform(0.1, 0.9, robot.joints)
        found = robot.ik(robot.fk(q), near=q)
        np.testing.assert_allclose(robot.fk(found), robot.fk(q), atol=1e-8, err_msg=f"{trial}")
        assert limits.contains(found, 1e-12)
        for each in robot.ik_all(robot.fk(q)):
            assert limits.contains(each, 1e-12)


@pytest.mark.parametrize("key", ["A", "B", "C"])
def test_puma_forward_kinematics_is_the_textbooks(golden, puma, abc, key):
    """Textbook §3: fk of the printed joints."""
    np.testing.assert_allclose(puma.fk(abc[key]), golden["puma560"]["fk_of_joints"][key], atol=1e-9)


def test_puma_limits_are_the_textbooks(golden, puma):
    limits = np.radians(golden["puma560"]["limits_deg"])
    np.testing.assert_allclose(puma.limits.position_max, limits)
    np.testing.assert_allclose(puma.limits.position_min, -limits)


@pytest.mark.parametrize("key", ["A", "B", "C"])
def test_puma_inverse_finds_the_printed_branch(puma, abc, key):
    np.testing.assert_allclose(puma.ik(puma.fk(abc[key]), near=abc[key]), abc[key], atol=1e-9)


def test_the_printed_pose_b_is_projected_and_said(golden, puma, abc):
    """Textbook §3: the inverse of the projected B differs from the printed joints by 0.85°."""
    with pytest.warns(errors.PoseCorrectedWarning, match="nearest"):
        q = puma.ik(golden["puma560"]["poses_m"]["B"], near=abc["B"])
    differs = np.degrees(np.abs(q - abc["B"]))
    assert differs[[3, 5]] == pytest.approx([0.85, 0.85], abs=0.05)


def test_the_printed_pose_c_is_refused(golden, puma):
    with pytest.raises(errors.NotARotationError, match=r"columns 2 and 3 are 59\.9°"):
        puma.ik(golden["puma560"]["poses_m"]["C_as_printed"])


def test_out_of_reach_says_so(puma):
    pose = np.eye(4)
    pose[:3, 3] = [5.0, 0.0, 0.0]
    with pytest.raises(errors.UnreachableError) as caught:
        puma.ik(pose)
    assert isinstance(caught.value, errors.PoseError)


def test_near_may_lie_outside_the_limits(puma, abc):
    far = abc["A"] + 10.0
    found = puma.ik(puma.fk(abc["A"]), near=far)
    assert puma.limits.contains(found)


def test_two_link_branches_are_the_textbooks(golden):
    """Textbook §5: from (3, 0) to (2, 2)."""
    arm = vp.load_robot("two_link")
    found = np.degrees(arm.ik_all(position=[2.0, 2.0, 0.0]))
    expected = golden["two_link_1_2_from_3_0_to_2_2"]["ik_goal_deg"]
    np.testing.assert_allclose(sorted(found.tolist()), sorted(expected), atol=1e-9)


def test_a_batch_of_joints_gives_a_batch_of_poses(puma, abc):
    rows = np.array([abc["A"], abc["B"], abc["C"]])
    poses = puma.fk(rows)
    assert poses.shape == (3, 4, 4)
    for q, pose in zip(rows, poses, strict=True):
        np.testing.assert_allclose(pose, puma.fk(q), atol=1e-12)


def test_the_jacobian_is_the_derivative_of_the_pose(puma, abc):
    q, step = abc["B"], 1e-6
    jacobian = puma.jacobian(q)
    for joint in range(6):
        delta = np.zeros(6)
        delta[joint] = step
        slope = (puma.fk(q + delta)[:3, 3] - puma.fk(q - delta)[:3, 3]) / (2 * step)
        np.testing.assert_allclose(jacobian[:3, joint], slope, atol=1e-8)
    determinant = np.linalg.det(jacobian @ jacobian.T)
    assert puma.manipulability(q) == pytest.approx(np.sqrt(determinant), rel=1e-9)


def test_the_wrist_singularity_is_named(puma, abc):
    q = abc["C"].copy()
    q[4] = 0.0
    near = puma.singularity(q)
    assert near.name == "wrist"
    assert near.distance == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("q", [[0] * 5, np.zeros((2, 5)), [np.nan] * 6, "q", None])
def test_bad_joints_are_refused(puma, q):
    with pytest.raises(errors.BadArgumentError, match="q"):
        puma.fk(q)


def test_neither_pose_nor_position_and_both_are_refused(puma):
    with pytest.raises(errors.BadArgumentError, match="Neither"):
        puma.ik()
    with pytest.raises(errors.BadArgumentError, match="Both"):
        puma.ik(np.eye(4), position=[0, 0, 0])


def test_with_limits_changes_only_what_is_given(puma):
    slow = puma.with_limits(velocity=0.5, jerk=np.full(6, 3.0))
    np.testing.assert_array_equal(slow.limits.velocity, np.full(6, 0.5))
    np.testing.assert_array_equal(slow.limits.jerk, np.full(6, 3.0))
    np.testing.assert_array_equal(slow.limits.acceleration, puma.limits.acceleration)
    assert slow.fingerprint != puma.fingerprint


@pytest.mark.parametrize("velocity", [0.0, -1.0, [1, 1, 1, 1, 1, 0]])
def test_limits_of_zero_are_refused(puma, velocity):
    with pytest.raises(errors.BadLimitsError):
        puma.with_limits(velocity=velocity)


def test_swapped_limits_are_refused(puma):
    with pytest.raises(errors.BadLimitsError):
        puma.with_limits(position_min=1.0, position_max=-1.0)


def test_joint_robot_moves_in_joints_and_has_no_pose():
    arm = vp.joint_robot(3, velocity=1.0, acceleration=5.0, jerk=[50, 50, 50])
    assert not arm.has_kinematics
    assert np.isinf(arm.limits.position_max).all()
    motion = vp.Program(arm, start=[0, 0, 0]).movej([1, 2, 3]).plan()
    np.testing.assert_allclose(motion.end, [1, 2, 3], atol=1e-12)
    with pytest.raises(errors.UncontrolledError):
        arm.fk([0, 0, 0])
    with pytest.raises(errors.UncontrolledError):
        _ = motion.sample(0.1).pose


@pytest.mark.parametrize("n", [0, 17, 2.0, True])
def test_joint_robot_refuses_a_bad_number_of_joints(n):
    with pytest.raises(errors.BadArgumentError, match="n is"):
        vp.joint_robot(n, velocity=1.0, acceleration=1.0, jerk=1.0)


def test_a_missing_robot_names_itself():
    with pytest.raises(errors.BadRobotError, match="puma561"):
        vp.load_robot("puma561")


def test_a_damaged_robot_file_names_file_and_place(tmp_path):
    path = tmp_path / "bad.yaml"
    path.write_text("name: bad\njoints: [1, 2\n", encoding="utf-8")
    with pytest.raises(errors.BadRobotError) as caught:
        vp.load_robot(path)
    assert str(path) in str(caught.value)


def test_limits_are_copies(puma):
    puma.limits.velocity[:] = 0.0
    assert (puma.limits.velocity > 0).all()


@pytest.mark.parametrize("name", [None, 3, ["puma560"]])
def test_a_robot_that_is_no_name_is_refused(name):
    with pytest.raises(errors.BadArgumentError, match="name_or_path"):
        vp.load_robot(name)


@pytest.mark.parametrize("name", BUILT_IN)
def test_a_saved_robot_is_the_same(name, tmp_path):
    robot = vp.load_robot(name).with_limits(velocity=0.123456789)
    robot.save(tmp_path / "own.yaml")
    again = vp.load_robot(tmp_path / "own.yaml")
    assert again.fingerprint == robot.fingerprint
    q = 0.1 * np.arange(1, robot.joints + 1)
    np.testing.assert_array_equal(again.fk(q), robot.fk(q))


def test_a_saved_robot_without_kinematics_is_the_same(tmp_path):
    robot = vp.joint_robot(
        2, velocity=1, acceleration=[2, 3], jerk=9, position_max=2.5,
        coupling=[[1, -1]], lower=[-1], upper=[2],
    )  # fmt: skip
    robot.save(tmp_path / "own.yaml")
    assert vp.load_robot(tmp_path / "own.yaml").fingerprint == robot.fingerprint


def test_a_robot_is_saved_as_yaml_only(puma, tmp_path):
    with pytest.raises(errors.BadArgumentError, match="yaml"):
        puma.save(tmp_path / "own.txt")
    with pytest.raises(errors.FileError, match="no_such_folder"):
        puma.save(tmp_path / "no_such_folder" / "own.yaml")


def test_infinite_position_limits_are_none():
    arguments = {"velocity": 1, "acceleration": 1, "jerk": 1}
    robot = vp.joint_robot(2, position_min=-np.inf, position_max=[1, np.inf], **arguments)
    assert robot.limits.position_min.tolist() == [-np.inf, -np.inf]
    assert robot.limits.position_max.tolist() == [1, np.inf]
    with pytest.raises(errors.BadArgumentError, match="position_min"):
        vp.joint_robot(2, position_min=np.inf, **arguments)
