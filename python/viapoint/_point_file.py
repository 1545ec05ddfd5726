"""The file of taught points: what it holds, read without overlooking anything."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from . import _core
from ._arguments import Vector, vector
from ._robot import Robot
from .errors import BadArgumentError, BadProgramError, MotionError, PoseError
from .frames import Frame

FORMAT = "viapoint points"
VERSION = 1

_MEMBERS = ("format", "version", "robot", "robot_fingerprint", "points")
_POINT_MEMBERS = ("name", "q", "frame")
_FRAME_MEMBERS = ("name", "pose")


@dataclass(frozen=True)
class TaughtPoint:
    """Joints as they were taught, and the frame they were taught in as it stood then."""

    q: Vector
    frame: Frame | None = None

    def json(self) -> dict[str, Any]:
        """Return what the file holds of it."""
        entry: dict[str, Any] = {"q": self.q.tolist()}
        if self.frame is not None:
            entry["frame"] = {"name": self.frame.name, "pose": self.frame.pose.tolist()}
        return entry


def read_points(path: Path, robot: Robot | None) -> tuple[str, str, dict[str, TaughtPoint]]:
    """Read and check a point file: the robot's name and fingerprint, and the points.

    Raises
    ------
    BadProgramError
        The file is damaged, says what would be ignored, or holds points of another robot.
    FileError
        It cannot be read.
    """
    try:
        document = json.loads(_core.read_file(str(path)), object_pairs_hook=_members)
    except json.JSONDecodeError as error:
        raise _damaged(path, f"it is no JSON: {error.msg}", error.lineno) from None
    except UnicodeDecodeError:
        raise _damaged(path, "it is no UTF-8 text") from None
    except RecursionError:
        raise _damaged(path, "it is nested too deeply") from None
    except ValueError as error:
        # A member that is there twice, or an integer of more digits than Python takes.
        raise _damaged(path, str(error)) from None
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise _damaged(path, f'the key "format" must be "{FORMAT}"')
    version = document.get("version")
    if type(version) is not int or version != VERSION:  # neither true nor 1.0
        raise _damaged(path, f'the key "version" must be the integer {VERSION}')
    _require_known(path, document, "", _MEMBERS)
    name = document.get("robot")
    if not isinstance(name, str):
        raise _damaged(path, 'the key "robot" must be a name')
    if robot is not None and robot.name != name:
        raise _damaged(path, f'it holds points of the robot "{name}", not of "{robot.name}"')
    fingerprint = document.get("robot_fingerprint", "")
    if not isinstance(fingerprint, str):
        raise _damaged(path, 'the key "robot_fingerprint" must be text')
    entries = document.get("points")
    if not isinstance(entries, list):
        raise _damaged(path, 'the key "points" must be a list')
    joints = robot.joints if robot is not None else None
    points: dict[str, TaughtPoint] = {}
    for i, entry in enumerate(entries):
        if not isinstance(entry, dict) or not isinstance(entry.get("name"), str):
            raise _damaged(path, f'points[{i}] must have a "name" and "q"')
        _require_known(path, entry, f"points[{i}]: ", _POINT_MEMBERS)
        if not is_text(entry["name"]):
            raise _damaged(path, f"points[{i}] has the name {entry['name']!r}, which is no text")
        if entry["name"] in points:
            raise _damaged(path, f'points[{i}] has the name "{entry["name"]}" a second time')
        try:
            if not _only_numbers(entry["q"]):
                raise _damaged(path, f"points[{i}]: q must hold numbers only")
            joints = len(entry["q"]) if joints is None else joints
            q = vector(entry["q"], f"points[{i}].q", joints)
        except (BadArgumentError, KeyError, TypeError) as error:
            reason = error.message if isinstance(error, BadArgumentError) else '"q" is missing'
            raise _damaged(path, f"points[{i}]: {reason}") from None
        try:
            points[entry["name"]] = TaughtPoint(q, _frame_in(path, entry, f"points[{i}].frame: "))
        except (PoseError, BadArgumentError, KeyError, TypeError) as error:
            reason = (
                error.message
                if isinstance(error, MotionError)
                else '"frame" must have a "name" and a "pose"'
            )
            raise _damaged(path, f"points[{i}]: {reason}") from None
    return name, fingerprint, points


def _frame_in(path: Path, entry: dict[str, Any], place: str) -> Frame | None:
    frame = entry.get("frame")
    if frame is None:
        return None
    if isinstance(frame, dict):
        _require_known(path, frame, place, _FRAME_MEMBERS)
    if not _only_numbers(frame["pose"]):
        raise _damaged(path, f"{place}pose must hold numbers only")
    name = frame["name"]
    if not isinstance(name, str) or not name or not is_text(name):
        raise _damaged(path, f"{place}name is {name!r}, which is no name")
    return Frame(frame["pose"], name)


def _members(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    """Make an object of its members, none of which may be there twice: one would be ignored."""
    members = dict(pairs)
    if len(members) != len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise ValueError(f"the key {json.dumps(twice)} is there twice in one object")
    return members


def _require_known(path: Path, value: dict[str, Any], place: str, known: tuple[str, ...]) -> None:
    for key in value:
        if key not in known:
            words = ", ".join(known)
            raise _damaged(path, f"{place}unknown key {json.dumps(key)}; known are {words}")


def _only_numbers(value: object) -> bool:
    """Tell whether lists hold nothing else; true and false are no numbers in a file."""
    if isinstance(value, list):
        return all(_only_numbers(item) for item in value)
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def is_text(text: str) -> bool:
    """Tell whether it can be written as UTF-8."""
    try:
        text.encode()
    except UnicodeEncodeError:
        return False
    return True


def _damaged(path: Path, reason: str, line: int | None = None) -> BadProgramError:
    return BadProgramError(
        f"The point file cannot be read: {reason}.",
        file=str(path),
        line=line,
        ways_out=["Mend the file by hand or move it away; it was left as it is."],
    )
