"""Teach and playback: no point is ever lost, no damaged file overwritten."""

import json
import subprocess
import sys

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors


@pytest.fixture
def file(tmp_path):
    return tmp_path / "points.json"


@pytest.fixture
def points(file, puma, abc):
    taught = vp.PointList(file, puma)
    for key in "ABC":
        taught.record(key, abc[key])
    return taught


def test_points_read_back_to_the_last_bit(points, file, abc):
    again = vp.PointList(file)
    assert again.robot.name == "puma560"
    assert list(again) == ["A", "B", "C"]
    for key in "ABC":
        np.testing.assert_array_equal(again[key], abc[key])


def test_every_record_is_on_disk_when_it_returns(file, puma, abc):
    points = vp.PointList(file, puma)
    assert not file.exists()
    for count, key in enumerate("ABC", start=1):
        points.record(key, abc[key])
        assert len(vp.PointList(file)) == count
        # Nothing is left lying about but what the next one waits at.
        assert {p.name for p in file.parent.iterdir()} == {"points.json", ".points.json.lock"}


def test_a_known_name_is_replaced_in_its_place(points, file, abc):
    points.record("B", abc["B"] + 0.1)
    again = vp.PointList(file)
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


def test_a_touch_up_tells_how_far_the_point_moves(points, file, abc):
    q = abc["B"] + [0.01, 0, 0, 0, 0, 0.002]
    change = points.touch_up("B", q)
    np.testing.assert_array_equal(vp.PointList(file)["B"], q)
    assert list(vp.PointList(file)) == ["A", "B", "C"]
    np.testing.assert_allclose(change.joints, [0.01, 0, 0, 0, 0, 0.002], atol=1e-15)
    before, now = points.robot.fk(abc["B"]), points.robot.fk(q)
    assert change.moved == pytest.approx(np.linalg.norm(now[:3, 3] - before[:3, 3]))
    cosine = 0.5 * (np.trace(now[:3, :3] @ before[:3, :3].T) - 1.0)
    assert change.turned == pytest.approx(np.arccos(cosine), rel=1e-6)
    assert f"{1e3 * change.moved:.3f} mm" in str(change)
    assert points.touch_up("B", q).moved == 0.0
    with pytest.raises(errors.BadArgumentError, match="no point"):
        points.touch_up("D", q)


def test_a_touch_up_without_kinematics_tells_the_joints(file):
    robot = vp.joint_robot(2, velocity=1, acceleration=5, jerk=50)
    points = vp.PointList(file, robot)
    points.record("A", [0.0, 0.0])
    change = points.touch_up("A", [0.1, -0.2])
    assert change.moved is None
    assert "0.2" in str(change)


def test_remove_takes_a_point_out_of_the_file(points, file):
    points.remove("B")
    assert list(vp.PointList(file)) == ["A", "C"]
    with pytest.raises(errors.BadArgumentError, match='no point "B"'):
        points.remove("B")


def test_two_lists_on_one_file_lose_nothing(points, file, abc):
    other = vp.PointList(file)
    points.record("D", abc["A"])
    other.record("E", abc["A"])
    assert list(vp.PointList(file)) == ["A", "B", "C", "D", "E"]


TEACH = """
import sys, viapoint as vp
points = vp.PointList(sys.argv[1], vp.load_robot("puma560"))
for i in range(100):
    points.record(f"{sys.argv[2]} {i}", [0.01 * i, 0, 0, 0, 0, 0])
"""


def test_two_processes_that_teach_at_once_lose_nothing(file):
    processes = [
        subprocess.Popen([sys.executable, "-c", TEACH, str(file), name]) for name in ("x", "y")
    ]
    assert [process.wait(timeout=120) for process in processes] == [0, 0]
    assert set(vp.PointList(file)) == {f"{name} {i}" for name in "xy" for i in range(100)}


def test_a_point_outside_the_limits_is_not_recorded(points, file):
    before = file.read_bytes()
    with pytest.raises(errors.JointLimitError, match='point "D": joint 2') as caught:
        points.record("D", [0, 9, 0, 0, 0, 0])
    assert caught.value.joint == 1
    assert file.read_bytes() == before


def test_points_of_different_sizes_are_found_without_a_robot(points, file):
    document = json.loads(file.read_text(encoding="utf-8"))
    document["points"][1]["q"].pop()
    file.write_text(json.dumps(document), encoding="utf-8")
    with pytest.raises(errors.BadProgramError, match=r"points\[1\]"):
        vp.PointList(file)


def test_points_taught_with_other_limits_are_played_with_a_warning(points, file, puma):
    slow = puma.with_limits(velocity=0.5)
    other = vp.PointList(file, slow)
    with pytest.warns(errors.OtherRobotWarning, match=f"puma560.*{puma.fingerprint}"):
        other.program()


def test_a_point_outside_other_limits_is_refused_by_name(points, file, puma):
    narrow = puma.with_limits(position_max=[3, 1, 4, 3, 2, 4])
    other = vp.PointList(file, narrow)
    with (
        pytest.warns(errors.OtherRobotWarning),
        pytest.raises(errors.JointLimitError, match='point "A": joint 2'),
    ):
        other.program()


def test_a_file_without_a_fingerprint_is_played(points, file):
    document = json.loads(file.read_text(encoding="utf-8"))
    del document["robot_fingerprint"]
    file.write_text(json.dumps(document), encoding="utf-8")
    assert len(vp.PointList(file).program()) == 2


def test_the_arm_teaches_where_it_stands(file, puma, abc):
    points = vp.PointList(file, puma)
    with vp.connect("sim://puma560", start=abc["B"]) as arm:
        np.testing.assert_array_equal(arm.teach("here", points), abc["B"])
    np.testing.assert_array_equal(vp.PointList(file)["here"], abc["B"])


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


def test_playback_in_lines_is_straight(file, puma, abc):
    points = vp.PointList(file, puma)
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


def test_playing_back_too_few_points_is_refused(file, puma, abc):
    points = vp.PointList(file, puma)
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
def test_bad_joints_are_refused_and_nothing_is_lost(points, file, q):
    before = file.read_bytes()
    with pytest.raises(errors.BadArgumentError, match="q"):
        points.record("D", q)
    assert file.read_bytes() == before
    assert "D" not in points


def test_a_missing_file_without_a_robot_is_refused(file):
    with pytest.raises(errors.FileError, match="no point file"):
        vp.PointList(file)


DAMAGES = {
    "truncated": lambda text: text[: len(text) // 2],
    "empty": lambda text: "",
    "no JSON": lambda text: "points: A",
    "other format": lambda text: text.replace("viapoint points", "something else"),
    "newer version": lambda text: text.replace('"version": 1', '"version": 2'),
    "no robot": lambda text: text.replace('"robot"', '"arm"'),
    "no list": lambda text: json.dumps({**json.loads(text), "points": {}}),
    "no joints": lambda text: text.replace('"q"', '"joints"'),
    "text for joints": lambda text: json.dumps(
        {**json.loads(text), "points": [{"name": "A", "q": ["a"] * 6}]}
    ),
    "NaN": lambda text: json.dumps(
        {**json.loads(text), "points": [{"name": "A", "q": [float("nan")] * 6}]}
    ),
    "twice": lambda text: text.replace('"name": "B"', '"name": "A"'),
    "a list": lambda text: "[]",
    "version 1.0": lambda text: text.replace('"version": 1', '"version": 1.0'),
    "version true": lambda text: text.replace('"version": 1', '"version": true'),
    "points twice": lambda text: text.replace('"points":', '"points": [], "points":'),
    "joints twice": lambda text: text.replace('"q":', '"q": [0, 0, 0, 0, 0, 0], "q":', 1),
    "unknown key": lambda text: text.replace('"points":', '"foo": 1, "points":'),
    "unknown key of a point": lambda text: text.replace('"q":', '"speed": 1, "q":', 1),
    "unknown key of a frame": lambda text: with_first(
        text, frame={"name": "t", "pose": np.eye(4).tolist(), "unit": "mm"}
    ),
    "a frame without a name": lambda text: with_first(
        text, frame={"name": "", "pose": np.eye(4).tolist()}
    ),
    "true in a frame": lambda text: with_first(
        text, frame={"name": "t", "pose": [[True, 0, 0, 0], *np.eye(4).tolist()[1:]]}
    ),
    "true for a number": lambda text: with_first(text, q=[True, 0, 0, 0, 0, 0.5]),
    "a number of 5000 digits": lambda text: with_first(text, q=[7, 0, 0, 0, 0, 0]).replace(
        "[7,", "[" + "7" * 5000 + ","
    ),
    "half a surrogate pair": lambda text: text.replace('"name": "A"', '"name": "\\ud800"'),
}


def with_first(text, **members):
    document = json.loads(text)
    document["points"][0].update(members)
    return json.dumps(document)


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        ("points twice", 'the key "points" is there twice'),
        ("unknown key", 'unknown key "foo"; known are format, version'),
        ("unknown key of a point", r'points\[0\]: unknown key "speed"; known are name, q, frame'),
        ("a frame without a name", r"points\[0\]\.frame: name is ''"),
        ("unknown key of a frame", r'points\[0\]\.frame: unknown key "unit"'),
        ("true for a number", r"points\[0\]: q must hold numbers only"),
        ("a number of 5000 digits", "digits"),
    ],
)
def test_what_would_be_ignored_or_misread_is_named(points, file, damage, said):
    file.write_text(DAMAGES[damage](file.read_text(encoding="utf-8")), encoding="utf-8")
    with pytest.raises(errors.BadProgramError, match=said) as caught:
        vp.PointList(file)
    assert caught.value.ways_out


def test_a_name_that_is_no_text_is_refused_and_nothing_is_lost(points, file, abc):
    with pytest.raises(errors.BadArgumentError, match="surrogate"):
        points.record("\ud800", abc["A"])
    assert list(vp.PointList(file)) == ["A", "B", "C"]


def test_a_file_name_with_a_nul_is_refused(tmp_path, puma, abc):
    precious = tmp_path / "a"
    precious.write_text("precious", encoding="utf-8")
    other = str(precious) + "\0b.json"
    program = vp.Program(puma, start=abc["A"]).movej(abc["B"])
    for attempt in (
        lambda: vp.PointList(other, puma).record("A", abc["A"]),
        lambda: program.save(other),
        lambda: vp.Program.load(other),
        lambda: vp.load_robot(other.replace("json", "yaml")),
        lambda: puma.save(other.replace("json", "yaml")),
    ):
        with pytest.raises(errors.FileError, match="NUL"):
            attempt()
    assert precious.read_text(encoding="utf-8") == "precious"


def test_a_point_outside_the_limits_in_the_file_can_be_taught_anew(points, file, abc):
    text = with_first(file.read_text(encoding="utf-8"), q=[99.0, 0, 0, 0, 0, 0])
    file.write_text(text, encoding="utf-8")
    again = vp.PointList(file)
    with pytest.raises(errors.JointLimitError, match='point "A": joint 1 is at 99'):
        again.program()
    again.record("A", abc["A"])
    assert again.program().check() is not None


@pytest.mark.parametrize("content", [b"\xff\xfe{}", b"[" * 100_000])
def test_a_file_that_is_no_text_or_too_deep_is_named(file, content):
    file.write_bytes(content)
    with pytest.raises(errors.BadProgramError, match=r"points\.json"):
        vp.PointList(file)
    assert file.read_bytes() == content


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_file_is_named_and_left_alone(points, file, puma, abc, damage):
    file.write_text(DAMAGES[damage](file.read_text(encoding="utf-8")), encoding="utf-8")
    before = file.read_bytes()
    for attempt in (
        lambda: vp.PointList(file),
        lambda: vp.PointList(file, puma),
        lambda: points.record("D", abc["A"]),
    ):
        with pytest.raises(errors.BadProgramError) as caught:
            attempt()
        assert str(file) in str(caught.value)
        assert file.read_bytes() == before
    assert "D" not in points


def test_points_of_another_robot_are_refused(points, file):
    with pytest.raises(errors.BadProgramError, match="puma560"):
        vp.PointList(file, vp.load_robot("ur5e"))


def test_a_file_that_cannot_be_written_keeps_the_list_as_it_was(tmp_path, puma, abc):
    points = vp.PointList(tmp_path / "no_such_folder" / "p.json", puma)
    with pytest.raises(errors.FileError, match="no_such_folder"):
        points.record("A", abc["A"])
    assert len(points) == 0
