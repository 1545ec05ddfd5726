"""Teach and playback: no point is ever lost."""

import json
import subprocess
import sys

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors


def test_points_read_back_to_the_last_bit(points, point_file, abc):
    again = vp.PointList(point_file)
    assert again.robot.name == "puma560"
    assert list(again) == ["A", "B", "C"]
    for key in "ABC":
        np.testing.assert_array_equal(again[key], abc[key])


def test_every_record_is_on_disk_when_it_returns(point_file, puma, abc):
    points = vp.PointList(point_file, puma)
    assert not point_file.exists()
    for count, key in enumerate("ABC", start=1):
        points.record(key, abc[key])
        assert len(vp.PointList(point_file)) == count
        # Nothing is left lying about but what the next one waits at.
        assert {p.name for p in point_file.parent.iterdir()} == {"points.json", ".points.json.lock"}


def test_a_known_name_is_replaced_in_its_place(points, point_file, abc):
    points.record("B", abc["B"] + 0.1)
    again = vp.PointList(point_file)
    assert list(again) == ["A", "B", "C"]
    np.testing.assert_array_equal(again["B"], abc["B"] + 0.1)


def test_a_point_tells_its_pose_and_branch(points, puma, abc):
    np.testing.assert_array_equal(points.pose("B"), puma.fk(abc["B"]))
    assert points.branch("B").fits(puma.configuration(abc["B"]))
    with pytest.raises(errors.BadArgumentError, match="has no point"):
        points.branch("none")


@pytest.mark.parametrize("name", ["puma560", "ur5e", "panda"])
def test_a_point_keeps_its_branch_wherever_its_frame_goes(name, tmp_path):
    """The nearest solution may stand otherwise: then the arm would swing over between points."""
    homes = {
        "puma560": [10, -50, 60, 10, 45, 5],
        "ur5e": [0, -90, 90, -90, -90, 0],
        "panda": [0, -45, 0, -135, 0, 90, 45],
    }
    robot = vp.load_robot(name)
    points = vp.PointList(tmp_path / "points.json", robot)
    rng = np.random.default_rng(3)
    limits = robot.limits
    went = swung = 0
    refused = []
    for _ in range(60):
        q = np.radians(homes[name]) + rng.uniform(-0.6, 0.6, robot.joints)
        q = np.clip(q, limits.position_min, limits.position_max)
        there = np.eye(4)
        there[:3, 3] = rng.uniform(-0.4, 0.4, 3)
        points.record("p", q, frame=vp.frames.Frame(np.eye(4), "table"))
        stood = points.branch("p")
        try:
            found = points.joints_in("p", [vp.frames.Frame(there, "table")])
        except (errors.UnreachableError, errors.OutsideLimitsError) as error:
            refused.append(error.message)
            continue
        now = robot.configuration(found)
        assert (now.shoulder, now.elbow, now.wrist) == (stood.shoulder, stood.elbow, stood.wrist)
        np.testing.assert_allclose(robot.fk(found), there @ robot.fk(q), atol=1e-8)
        nearest = robot.configuration(robot.ik(there @ robot.fk(q), near=q))
        swung += (nearest.shoulder, nearest.elbow, nearest.wrist) != (
            *(stood.shoulder, stood.elbow, stood.wrist),
        )
        went += 1
    assert went > 15
    assert all('point "p" in the frame "table"' in said for said in refused)
    if name == "puma560":
        assert swung > 0
        assert len(refused) > 0


def test_a_touch_up_tells_how_far_the_point_moves(points, point_file, abc):
    q = abc["B"] + [0.01, 0, 0, 0, 0, 0.002]
    change = points.touch_up("B", q)
    np.testing.assert_array_equal(vp.PointList(point_file)["B"], q)
    assert list(vp.PointList(point_file)) == ["A", "B", "C"]
    np.testing.assert_allclose(change.joints, [0.01, 0, 0, 0, 0, 0.002], atol=1e-15)
    before, now = points.robot.fk(abc["B"]), points.robot.fk(q)
    assert change.moved == pytest.approx(np.linalg.norm(now[:3, 3] - before[:3, 3]))
    cosine = 0.5 * (np.trace(now[:3, :3] @ before[:3, :3].T) - 1.0)
    assert change.turned == pytest.approx(np.arccos(cosine), rel=1e-6)
    assert f"{1e3 * change.moved:.3f} mm" in str(change)
    assert points.touch_up("B", q).moved == 0.0
    with pytest.raises(errors.BadArgumentError, match="no point"):
        points.touch_up("D", q)


def test_a_touch_up_without_kinematics_tells_the_joints(point_file):
    robot = vp.joint_robot(2, velocity=1, acceleration=5, jerk=50)
    points = vp.PointList(point_file, robot)
    points.record("A", [0.0, 0.0])
    change = points.touch_up("A", [0.1, -0.2])
    assert change.moved is None
    assert "0.2" in str(change)


def test_remove_takes_a_point_out_of_the_file(points, point_file):
    points.remove("B")
    assert list(vp.PointList(point_file)) == ["A", "C"]
    with pytest.raises(errors.BadArgumentError, match='no point "B"'):
        points.remove("B")


def test_two_lists_on_one_file_lose_nothing(points, point_file, abc):
    other = vp.PointList(point_file)
    points.record("D", abc["A"])
    other.record("E", abc["A"])
    assert list(vp.PointList(point_file)) == ["A", "B", "C", "D", "E"]


TEACH = """
import sys, viapoint as vp
points = vp.PointList(sys.argv[1], vp.load_robot("puma560"))
for i in range(100):
    points.record(f"{sys.argv[2]} {i}", [0.01 * i, 0, 0, 0, 0, 0])
"""


def test_two_processes_that_teach_at_once_lose_nothing(point_file):
    processes = [
        subprocess.Popen([sys.executable, "-c", TEACH, str(point_file), name])
        for name in ("x", "y")
    ]
    assert [process.wait(timeout=120) for process in processes] == [0, 0]
    assert set(vp.PointList(point_file)) == {f"{name} {i}" for name in "xy" for i in range(100)}


def test_a_point_outside_the_limits_is_not_recorded(points, point_file):
    before = point_file.read_bytes()
    with pytest.raises(errors.JointLimitError, match='point "D": joint 2') as caught:
        points.record("D", [0, 9, 0, 0, 0, 0])
    assert caught.value.joint == 1
    assert point_file.read_bytes() == before


def test_points_of_different_sizes_are_found_without_a_robot(points, point_file):
    document = json.loads(point_file.read_text(encoding="utf-8"))
    document["points"][1]["q"].pop()
    point_file.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(errors.BadProgramError, match=r"points\[1\]"):
        vp.PointList(point_file)


def test_points_taught_with_other_limits_are_played_with_a_warning(points, point_file, puma):
    slow = puma.with_limits(velocity=0.5)
    other = vp.PointList(point_file, slow)
    with pytest.warns(errors.OtherRobotWarning, match=f"puma560.*{puma.fingerprint}"):
        other.program()


def test_a_point_outside_other_limits_is_refused_by_name(points, point_file, puma):
    narrow = puma.with_limits(position_max=[3, 1, 4, 3, 2, 4])
    other = vp.PointList(point_file, narrow)
    with (
        pytest.warns(errors.OtherRobotWarning),
        pytest.raises(errors.JointLimitError, match='point "A": joint 2'),
    ):
        other.program()


def test_a_file_without_a_fingerprint_is_played(points, point_file):
    document = json.loads(point_file.read_text(encoding="utf-8"))
    del document["robot_fingerprint"]
    point_file.write_text(json.dumps(document), encoding="utf-8")
    assert len(vp.PointList(point_file).program()) == 2


def test_the_arm_teaches_where_it_stands(point_file, puma, abc):
    points = vp.PointList(point_file, puma)
    with vp.connect("sim://puma560", start=abc["B"]) as arm:
        np.testing.assert_array_equal(arm.teach("here", points), abc["B"])
    np.testing.assert_array_equal(vp.PointList(point_file)["here"], abc["B"])


def test_playback_passes_every_point(points, abc):
    motion = points.program(kind="ptp").plan()
    samples = motion.sample(0.0005)
    for key in "ABC":
        assert np.abs(samples.q - abc[key]).max(axis=1).min() < 1e-6
    np.testing.assert_allclose(motion.end, abc["C"], atol=1e-12)


def test_playback_from_elsewhere_goes_to_the_first_point(points, abc, puma):
    home = abc["A"] + 0.1
    program = points.program(kind="ptp", start=home)
    assert len(program) == 3
    motion = program.plan()
    np.testing.assert_allclose(motion.start, home, atol=1e-12)
    assert np.abs(motion.sample(0.001).q - abc["A"]).max(axis=1).min() < 1e-9


def test_playback_in_lines_is_straight(point_file, puma, abc):
    points = vp.PointList(point_file, puma)
    q = abc["A"]
    pose = puma.fk(q)
    points.record("one", q)
    for name, offset in (("two", [0.1, 0.0, 0.1]), ("three", [0.1, 0.1, 0.1])):
        goal = pose.copy()
        goal[:3, 3] += offset
        q = puma.ik(goal, near=q)
        points.record(name, q)
    motion = points.program(kind="lin", speed=0.2).plan()
    path = motion.sample(0.002).pose[:, :3, 3] - pose[:3, 3]
    first = path[path[:, 1] < 1e-6]
    np.testing.assert_allclose(first[:, 0], first[:, 2], atol=1e-4)


def test_playing_back_too_few_points_is_refused(point_file, puma, abc):
    points = vp.PointList(point_file, puma)
    with pytest.raises(errors.EmptyProgramError, match="0 points"):
        points.program()
    points.record("A", abc["A"])
    with pytest.raises(errors.EmptyProgramError, match="1 points"):
        points.program()
    assert len(points.program(start=abc["B"])) == 1


@pytest.mark.parametrize("kind", ["spline", "", None, 3])
def test_an_unknown_kind_of_playback_is_refused(points, kind):
    with pytest.raises(errors.BadArgumentError, match="kind"):
        points.program(kind=kind)


@pytest.mark.parametrize("name", ["", "  ", None, 3])
def test_a_point_needs_a_name(points, abc, name):
    with pytest.raises(errors.BadArgumentError, match="name"):
        points.record(name, abc["A"])


@pytest.mark.parametrize("q", [[1, 2], [np.nan] * 6, "here"])
def test_bad_joints_are_refused_and_nothing_is_lost(points, point_file, q):
    before = point_file.read_bytes()
    with pytest.raises(errors.BadArgumentError, match="q"):
        points.record("D", q)
    assert point_file.read_bytes() == before
    assert "D" not in points
