"""Point files that are damaged, of another robot, or not to be written: named and left alone."""

import json

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors


def test_a_missing_file_without_a_robot_is_refused(point_file):
    with pytest.raises(errors.FileError, match="no point file"):
        vp.PointList(point_file)


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
def test_what_would_be_ignored_or_misread_is_named(points, point_file, damage, said):
    point_file.write_text(DAMAGES[damage](point_file.read_text(encoding="utf-8")), encoding="utf-8")
    with pytest.raises(errors.BadProgramError, match=said) as caught:
        vp.PointList(point_file)
    assert caught.value.ways_out


def test_a_name_that_is_no_text_is_refused_and_nothing_is_lost(points, point_file, abc):
    with pytest.raises(errors.BadArgumentError, match="surrogate"):
        points.record("\ud800", abc["A"])
    assert list(vp.PointList(point_file)) == ["A", "B", "C"]


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


def test_a_point_outside_the_limits_in_the_file_can_be_taught_anew(points, point_file, abc):
    text = with_first(point_file.read_text(encoding="utf-8"), q=[99.0, 0, 0, 0, 0, 0])
    point_file.write_text(text, encoding="utf-8")
    again = vp.PointList(point_file)
    with pytest.raises(errors.JointLimitError, match='point "A": joint 1 is at 99'):
        again.program()
    again.record("A", abc["A"])
    assert again.program().check() is not None


@pytest.mark.parametrize("content", [b"\xff\xfe{}", b"[" * 100_000])
def test_a_file_that_is_no_text_or_too_deep_is_named(point_file, content):
    point_file.write_bytes(content)
    with pytest.raises(errors.BadProgramError, match=r"points\.json"):
        vp.PointList(point_file)
    assert point_file.read_bytes() == content


@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_file_is_named_and_left_alone(points, point_file, puma, abc, damage):
    point_file.write_text(DAMAGES[damage](point_file.read_text(encoding="utf-8")), encoding="utf-8")
    before = point_file.read_bytes()
    for attempt in (
        lambda: vp.PointList(point_file),
        lambda: vp.PointList(point_file, puma),
        lambda: points.record("D", abc["A"]),
    ):
        with pytest.raises(errors.BadProgramError) as caught:
            attempt()
        assert str(point_file) in str(caught.value)
        assert point_file.read_bytes() == before
    assert "D" not in points


def test_points_of_another_robot_are_refused(points, point_file):
    with pytest.raises(errors.BadProgramError, match="puma560"):
        vp.PointList(point_file, vp.load_robot("ur5e"))


def test_a_file_that_cannot_be_written_keeps_the_list_as_it_was(tmp_path, puma, abc):
    points = vp.PointList(tmp_path / "no_such_folder" / "p.json", puma)
    with pytest.raises(errors.FileError, match="no_such_folder"):
        points.record("A", abc["A"])
    assert len(points) == 0
