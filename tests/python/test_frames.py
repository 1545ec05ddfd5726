"""Tools and frames found by touching, and programs and points told in them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import viapoint as vp
from viapoint import deg, errors, mm

HOME = deg * [0, 45, 0, 0, 60, 0]


@pytest.fixture(scope="module")
def puma() -> vp.Robot:
    return vp.load_robot("puma560")


def rotation(axis: list[float], angle: float) -> np.ndarray:
    x, y, z = np.asarray(axis) / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def pose(position: list[float], axis: list[float] = (0, 0, 1), angle: float = 0.0) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :3] = rotation(axis, angle)
    matrix[:3, 3] = position
    return matrix


TOOL = pose([0.03, -0.02, 0.14], [1, 1, 0], 0.4)


def touches(robot: vp.Robot, tilt: float = 0.5, noise: float = 0.0, seed: int = 1) -> np.ndarray:
    """Joints that hold the point of TOOL on one place, tilted all around."""
    generator = np.random.default_rng(seed)
    arm = robot.with_tool(TOOL)
    here = arm.fk(HOME)
    rows = []
    for about in (0.0, 1.2, 2.5, 3.8, 5.0):
        there = here.copy()
        there[:3, :3] = here[:3, :3] @ rotation([np.cos(about), np.sin(about), 0], tilt)
        there[:3, 3] += generator.normal(0.0, noise, 3) if noise else 0.0
        rows.append(arm.ik(there, near=HOME))
    return np.array(rows)


def along(robot: vp.Robot, q: np.ndarray, axis: int) -> np.ndarray:
    """Joints after a move of TOOL along its own axis."""
    arm = robot.with_tool(TOOL)
    there = arm.fk(q)
    there[:3, 3] += 0.05 * there[:3, axis]
    return arm.ik(there, near=q)


@pytest.mark.parametrize("own_tool", [np.eye(4), pose([0.1, 0.2, 0.3], [0, 1, 0], 1.0)])
def test_a_planted_tool_is_found_whatever_tool_the_robot_has(puma: vp.Robot, own_tool: np.ndarray):
    q = touches(puma)
    robot = puma.with_tool(own_tool)
    point = vp.frames.four_point(robot, q)
    np.testing.assert_allclose(point.tcp, TOOL[:3, 3], atol=1e-9)
    np.testing.assert_allclose(point.pose[:3, :3], np.eye(3))
    assert point.fit.largest < 1e-9
    found = vp.frames.six_point(robot, q, along(puma, q[-1], 0), along(puma, q[-1], 2))
    np.testing.assert_allclose(found.pose, TOOL, atol=1e-8)
    np.testing.assert_allclose(
        robot.with_tool(found.pose).fk(HOME), puma.fk(HOME) @ TOOL, atol=1e-8
    )


def test_noise_is_told_in_the_residuals_and_the_uncertainty(puma: vp.Robot):
    noise = 0.1 * mm
    worst = 0.0
    for seed in range(100):
        found = vp.frames.four_point(puma, touches(puma, noise=noise, seed=seed))
        error = np.linalg.norm(found.tcp - TOOL[:3, 3])
        worst = max(worst, error / (found.sensitivity * noise))
        assert 0 < found.fit.rms < 4 * noise
    assert 1 < worst < 5


def test_orientations_too_much_alike_are_refused_with_what_to_do(puma: vp.Robot):
    with pytest.raises(errors.DegeneratePointsError, match="too much alike") as caught:
        vp.frames.four_point(puma, touches(puma, tilt=0.02))
    assert "30°" in caught.value.ways_out[0]
    turned = np.array([np.add(HOME, [0, 0, 0, 0, 0, turn]) for turn in (0, 0.5, 1.0, 1.5)])
    with pytest.raises(errors.DegeneratePointsError, match="parallel"):
        vp.frames.four_point(puma, turned)
    with pytest.raises(errors.BadArgumentError, match="at least 4"):
        vp.frames.four_point(puma, touches(puma)[:3])
    with pytest.raises(errors.BadArgumentError, match="joints"):
        vp.frames.four_point(puma, HOME)


def test_three_points_make_a_frame_by_positions_and_by_joints(puma: vp.Robot):
    table = pose([0.5, 0.1, 0.0], [0.1, 0.2, 1], 0.6)
    places = [table @ [x, y, 0, 1] for x, y in ((0, 0), (0.2, 0), (0.05, 0.2))]
    by_position = vp.frames.three_points(*(place[:3] for place in places), name="table")
    np.testing.assert_allclose(by_position.pose, table, atol=1e-12)
    joints = [puma.ik(position=place[:3], near=HOME) for place in places]
    by_joints = vp.frames.three_points(*joints, robot=puma)
    np.testing.assert_allclose(by_joints.pose, table, atol=1e-8)
    assert by_position.name == "table"
    assert "table" in repr(by_position)
    with pytest.raises(errors.DegeneratePointsError, match="one line"):
        vp.frames.three_points([0, 0, 0], [0.1, 0, 0], [0.3, 0.001, 0])


def test_a_frame_tells_places_both_ways():
    frame = vp.frames.Frame(pose([0.5, 0.1, 0.2], [1, 2, 3], 1.0))
    there = pose([0.1, 0.2, 0.3], [0, 1, 0], 0.3)
    np.testing.assert_allclose(frame.to_base(there), frame.pose @ there)
    np.testing.assert_allclose(frame.from_base(frame.to_base(there)), there, atol=1e-15)
    np.testing.assert_allclose(frame.to_base([0, 0, 0]), [0.5, 0.1, 0.2])
    assert frame.from_base(np.zeros((4, 3))).shape == (4, 3)
    with pytest.raises(errors.BadArgumentError, match="shape"):
        frame.to_base([1, 2])


def test_known_points_place_a_frame_and_the_arm(puma: vp.Robot):
    base = pose([1.0, -2.0, 0.5], [0, 0, 1], 2.0)
    placed = puma.with_base(base)
    np.testing.assert_allclose(placed.base, base)
    np.testing.assert_allclose(placed.fk(HOME), base @ puma.fk(HOME), atol=1e-12)
    assert placed.ik_family == puma.ik_family
    joints = np.array([HOME, HOME + 0.2, HOME - 0.2, np.add(HOME, [0.3, 0, 0.1, 0, 0, 0])])
    known = placed.fk(joints)[:, :3, 3]
    for robot in (puma, placed):  # where it was thought to stand does not count
        found = vp.frames.place_base(robot, known, joints)
        np.testing.assert_allclose(found.pose, base, atol=1e-9)
        assert found.fit.rms < 1e-9
    frame = vp.frames.known_points(puma.fk(joints)[:, :3, 3], known)
    np.testing.assert_allclose(frame.pose, base, atol=1e-9)
    of_joints = vp.frames.known_points(puma.fk(joints)[:, :3, 3], joints, robot=placed)
    np.testing.assert_allclose(of_joints.pose, base, atol=1e-9)


def test_base_and_tool_survive_a_file(puma: vp.Robot, tmp_path: Path):
    robot = puma.with_tool(TOOL).with_base(pose([1, 2, 3], [1, 1, 1], 1.0))
    robot.save(tmp_path / "cell.yaml")
    again = vp.load_robot(tmp_path / "cell.yaml")
    assert again.fingerprint == robot.fingerprint != puma.fingerprint
    np.testing.assert_array_equal(again.base, robot.base)
    np.testing.assert_array_equal(again.tool, robot.tool)
    assert puma.with_base(np.eye(4)).fingerprint == puma.fingerprint


def in_a_frame(robot: vp.Robot, table: vp.frames.Frame) -> vp.Program:
    start = robot.with_tool(TOOL).fk(HOME)
    there = start.copy()
    there[:3, 3] += [0.05, 0.15, 0.1]
    gripper = vp.frames.Tool(TOOL, "gripper")
    program = vp.Program(robot, start=HOME, frame=table, tool=gripper, zone=20 * mm)
    program.movel(table.from_base(there)).set_tool().set_frame()
    there[:3, 3] += [0, -0.1, 0]
    return program.movej(there, zone="fine")


def test_samples_are_of_the_tool_that_moves(puma: vp.Robot):
    table = vp.frames.Frame(pose([0.4, 0.1, 0.0], [0, 0, 1], 0.5), "table")
    program = in_a_frame(puma, table)
    motion = program.plan()
    samples = motion.sample()
    np.testing.assert_allclose(samples.pose[0], puma.fk(HOME) @ TOOL, atol=1e-9)
    np.testing.assert_allclose(samples.pose[-1], puma.fk(samples.q[-1]), atol=1e-9)
    line = samples.move == 2
    way = samples.pose[line][:, :3, 3] - samples.pose[0][:3, 3]
    direction = np.array([0.05, 0.15, 0.1]) / np.linalg.norm([0.05, 0.15, 0.1])
    assert np.linalg.norm(np.cross(way, direction), axis=1).max() < 5e-5
    rates = np.linalg.norm(np.cross(samples.twist[line][:, :3], direction), axis=1)
    assert rates.max() < 1e-3
    run = vp.simulate(motion)
    np.testing.assert_allclose(run.pose[0], samples.pose[0], atol=1e-9)
    assert [corner.stopped for corner in motion.corners] == [True]
    assert "tool changes" in str(motion.report)


def test_frames_and_tools_survive_a_program_file(puma: vp.Robot, tmp_path: Path):
    table = vp.frames.Frame(pose([0.4, 0.1, 0.0], [0, 0, 1], 0.5), "table")
    program = in_a_frame(puma, table)
    program.save(tmp_path / "p.json")
    text = (tmp_path / "p.json").read_text()
    assert '"set_frame":{"name":"table"' in text
    assert '"set_tool":{}' in text
    again = vp.Program.load(tmp_path / "p.json").plan()
    assert again.duration == program.plan().duration


def test_what_is_no_frame_and_no_tool_is_refused(puma: vp.Robot):
    program = vp.Program(puma, start=HOME)
    with pytest.raises(errors.BadArgumentError, match="must be a Frame"):
        program.set_frame(vp.frames.Tool(TOOL))
    with pytest.raises(errors.BadArgumentError, match="must be a Tool"):
        program.set_tool(vp.frames.Frame(TOOL))
    with pytest.raises(errors.BadArgumentError, match="a pose is"):
        program.set_frame([1, 2, 3])
    joints = vp.joint_robot(2, velocity=1, acceleration=1, jerk=1)
    with pytest.raises(errors.UncontrolledError):
        joints.with_tool(TOOL)
    with pytest.raises(errors.UncontrolledError):
        joints.with_base(TOOL)


def test_points_taught_in_a_frame_go_with_it(puma: vp.Robot, tmp_path: Path):
    table = vp.frames.Frame(pose([0.5, 0.0, 0.1], [0, 0, 1], 0.3), "table")
    points = vp.PointList(tmp_path / "points.json", puma)
    with vp.connect("sim://puma560", start=HOME) as arm:
        arm.teach("at home", points)
        arm.teach("on the table", points, frame=table)
    points.record("above", np.add(HOME, [0, 0.1, 0, 0, 0.1, 0]), frame=table)
    points = vp.PointList(tmp_path / "points.json")
    kept = points.frame("above")
    assert kept is not None
    assert kept.name == "table"
    np.testing.assert_array_equal(kept.pose, table.pose)
    assert points.frame("at home") is None
    moved = vp.frames.Frame(pose([0.45, 0.05, 0.1], [0, 0, 1], 0.5), "table")
    np.testing.assert_array_equal(points.joints_in("at home", [moved]), HOME)
    np.testing.assert_array_equal(points.joints_in("above", [table]), points["above"])
    now = puma.fk(points.joints_in("above", [moved]))
    then = puma.fk(points["above"])
    np.testing.assert_allclose(moved.from_base(now), table.from_base(then), atol=1e-9)
    end = points.program(kind="lin", frames=[moved]).plan().sample().q[-1]
    np.testing.assert_allclose(puma.fk(end), now, atol=1e-8)
    far = vp.frames.Frame(pose([3.0, 0.0, 0.1]), "table")
    with pytest.raises(errors.UnreachableError, match='"on the table" in the frame "table"'):
        points.program(frames=[far])
    with pytest.raises(errors.BadArgumentError, match="has a name"):
        points.record("no", HOME, frame=vp.frames.Frame(np.eye(4)))


def test_a_point_file_with_a_damaged_frame_is_refused(puma: vp.Robot, tmp_path: Path):
    path = tmp_path / "points.json"
    points = vp.PointList(path, puma)
    points.record("a", HOME, frame=vp.frames.Frame(np.eye(4), "table"))
    path.write_text(path.read_text().replace('"pose"', '"pos"'))
    with pytest.raises(errors.BadProgramError, match="frame"):
        vp.PointList(path)
