"""The file of a playback: sealed, and read without overlooking anything."""

from __future__ import annotations

import json
import os
import warnings
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from ._arguments import file_name
from ._playback import Playback, Stage
from ._robot import Robot, load_robot, require_robot
from .errors import BadProgramError, FileError, OtherRobotWarning
from .verifier import MotionFileError, seal
from .verifier._strict_json import (
    array,
    integer,
    items,
    load,
    members,
    number,
    optional_number,
    refuse,
    text,
)

FORMAT = "viapoint recording"
VERSION = 1
_SECONDS = ("before", "moving", "after")
_DEVIATIONS = ("position", "angle")
_TOLERANCES = ("tolerance", "angle_tolerance", "joint_tolerance")


def playback_text(playback: Playback) -> bytes:
    """Return what the file holds, sealed."""
    document: dict[str, Any] = {
        "format": FORMAT,
        "version": VERSION,
        "robot": playback.robot.name,
        "robot_fingerprint": playback.robot.fingerprint,
        **{name: getattr(playback, name) for name in _TOLERANCES},
    }
    lines = [f"{json.dumps(key)}: {json.dumps(value)}" for key, value in document.items()]
    rows = [json.dumps(_row(stage), allow_nan=False) for stage in playback.stages]
    lines.append('"stages": [\n ' + ",\n ".join(rows) + "]")
    return seal("{\n" + ",\n".join(lines))


def _row(stage: Stage) -> dict[str, Any]:
    numbers = {name: getattr(stage, name) for name in (*_SECONDS, *_DEVIATIONS)}
    return {"outputs": stage.outputs, **numbers, "control": stage.control.tolist()}


def load_recording(path: str | os.PathLike[str], robot: Robot | None = None) -> Playback:
    """Read a fitted recording that `Playback.save` wrote.

    Parameters
    ----------
    path : str or path
        The file.
    robot : Robot, optional
        The arm; by default the built-in one that the file names.

    Raises
    ------
    FileError
        It cannot be read.
    BadProgramError
        It is damaged, or of a robot of another name.

    Warns
    -----
    OtherRobotWarning
        It was recorded with other limits, another tool or another chain; what is proven of its
        deviation at the tool then is not.
    """
    name = file_name(path)
    if robot is not None:
        require_robot(robot)
    try:
        document = load(Path(name).read_bytes())
        playback, fingerprint = _playback_in(document, robot)
    except OSError as error:
        raise FileError(f"{name} cannot be read: {error.strerror or error}.", file=name) from error
    except MotionFileError as error:
        raise BadProgramError(
            f"The recording cannot be read: {error}.",
            file=name,
            ways_out=["Save it again: recording.fit(…).save(path)."],
        ) from None
    if fingerprint != playback.robot.fingerprint:
        warnings.warn(
            f'{name} was recorded with another "{playback.robot.name}" (fingerprint '
            f"{fingerprint}, now {playback.robot.fingerprint}): limits, tool or chain differ.",
            OtherRobotWarning,
            stacklevel=2,
        )
    return playback


def _playback_in(document: dict[str, Any], robot: Robot | None) -> tuple[Playback, str]:
    if document.get("format") != FORMAT:
        raise MotionFileError(f'the key "format" must be "{FORMAT}"')
    if integer(document.get("version"), "version", 0, 10**9) != VERSION:
        raise MotionFileError(f"the version is {document['version']}; this reads {VERSION}")
    keys = ("format", "version", "robot", "robot_fingerprint", *_TOLERANCES, "stages")
    members(document, "the file", " ".join(keys))
    name = text(document["robot"], "robot")
    if robot is not None and robot.name != name:
        refuse("robot", f'it was recorded with "{name}", not with "{robot.name}"')
    arm = load_robot(name) if robot is None else robot
    stages = tuple(
        _stage(row, f"stages[{i}]", arm.joints)
        for i, row in enumerate(items(document["stages"], "stages"))
    )
    if not any(stage.moves for stage in stages):
        refuse("stages", "none of them moves the arm")
    for before, after in pairwise(stages):
        if not np.array_equal(before.control[-1], after.control[0]):
            refuse("stages", "one does not begin where the one before it ends")
    told = {key: optional_number(document[key], key, 1e-12) for key in _TOLERANCES}
    playback = Playback(
        arm, stages, told["tolerance"], told["angle_tolerance"], told["joint_tolerance"]
    )
    return playback, text(document["robot_fingerprint"], "robot_fingerprint")


def _stage(value: object, place: str, joints: int) -> Stage:
    given = members(value, place, " ".join(("outputs", *_SECONDS, *_DEVIATIONS, "control")))
    control = array(given["control"], f"{place}.control", (-1, joints)).reshape(-1, joints)
    if len(control) != 1 and len(control) < 4:
        refuse(f"{place}.control", "a rest has one control point, a way four or more")
    numbers = {key: number(given[key], f"{place}.{key}", 0.0) for key in (*_SECONDS, *_DEVIATIONS)}
    return Stage(
        control=control, outputs=integer(given["outputs"], f"{place}.outputs", 0, 2**64), **numbers
    )
