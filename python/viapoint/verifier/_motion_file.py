"""What a motion file says, read strictly. The format is told in docs/motion_files.md."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ._balls import Array
from ._chain import Chain
from ._file_parts import (
    KINDS,
    MOST_STEPS,
    TOOL_RATES,
    Corner,
    Leg,
    Limits,
    Stretch,
    chain_in,
    corner_in,
    leg_in,
    limits_in,
    paths_in,
    require_pose,
)
from ._strict_json import (
    MotionFileError,
    array,
    integer,
    items,
    load,
    members,
    number,
    refuse,
    text,
    truth,
)

SHORTEST = 1e-30
"""Of a piece [s]: timing may leave slivers of rounding."""
FORMAT = "viapoint motion"
VERSION = 1
OUTPUT_TIME = 2.0
"""An output changes at most so long before or after the arm passes its place [s]."""


@dataclass(frozen=True)
class MotionFile:
    """All of a file, by the names of its keys."""

    name: str
    timed: bool
    robot: str
    fingerprint: str
    limits: Limits
    chain: Chain | None
    tools: Array
    position_tolerance: float
    angle_tolerance: float
    legs: tuple[Leg, ...]
    corners: tuple[Corner, ...]
    stretches: tuple[Stretch, ...]
    paths: Array  # (m, 6, n)
    path_of: Array  # (k,) of int
    durations: Array
    timing: Array
    moves: Array
    certificate: dict[str, Any]

    @property
    def joints(self) -> int:
        """Number of joints."""
        return len(self.limits.position_min)

    @property
    def starts(self) -> Array:
        """Time at which each piece begins, and the end of the motion, (k + 1,) [s]."""
        return np.concatenate([[0.0], np.cumsum(self.durations)])


def read(data: bytes) -> MotionFile:
    """Read and check what can be checked without mathematics.

    Raises
    ------
    MotionFileError
        By the place and what was expected there.
    """
    document = load(data)
    if document.get("format") != FORMAT:
        raise MotionFileError(f'the key "format" must be "{FORMAT}"')
    if integer(document.get("version"), "version", 0, MOST_STEPS) != VERSION:
        raise MotionFileError(f"the version is {document['version']}; this reads {VERSION}")
    members(
        document,
        "the file",
        "format version viapoint name kind robot tools tolerance legs corners paths pieces "
        "certificate",
    )
    text(document["viapoint"], "viapoint")
    kind = text(document["kind"], "kind", ("planned", "timed"))
    robot = members(document["robot"], "robot", "name fingerprint limits chain")
    limits = limits_in(robot["limits"])
    n = len(limits.position_min)
    chain = None if robot["chain"] is None else chain_in(robot["chain"], n)
    tools = array(document["tools"], "tools", (-1, 4, 4))
    for i, tool in enumerate(tools):
        require_pose(tool, f"tools[{i}]")
    if len(tools) == 0:
        refuse("tools", "it must hold the robot's own tool")
    tolerance = members(document["tolerance"], "tolerance", "position angle")
    legs = tuple(
        leg_in(leg, f"legs[{i}]", n, len(tools))
        for i, leg in enumerate(items(document["legs"], "legs"))
    )
    corner_list = items(document["corners"], "corners")
    if kind == "timed" and (legs or corner_list):
        refuse("kind", "a timed motion has neither legs nor corners")
    stretches, paths = paths_in(document["paths"], n, len(legs), len(corner_list))
    corners = tuple(
        corner_in(c, f"corners[{i}]", len(legs), len(paths)) for i, c in enumerate(corner_list)
    )
    pieces = [
        members(p, f"pieces[{i}]", "path move duration timing", "outputs wait")
        for i, p in enumerate(items(document["pieces"], "pieces"))
    ]
    if not pieces:
        refuse("pieces", "it must hold one piece or more")
    for i, piece in enumerate(pieces):
        for k, change in enumerate(items(piece.get("outputs", []), f"pieces[{i}].outputs")):
            place = f"pieces[{i}].outputs[{k}]"
            told = items(change, place)
            if len(told) not in (2, 3):
                refuse(place, "it must hold an output, its value, and its time if it has one")
            integer(told[0], place, 0, 64)
            truth(told[1], place)
            if len(told) == 3 and abs(number(told[2], place)) > OUTPUT_TIME:
                refuse(place, f"its time must lie within {OUTPUT_TIME} s of the place")
        if "wait" in piece:
            place = f"pieces[{i}].wait"
            told = items(piece["wait"], place)
            if len(told) != 3:
                refuse(place, "it must hold an input, its value, and a time-out or null")
            integer(told[0], place, 0, 64)
            truth(told[1], place)
            if told[2] is not None and number(told[2], place) <= 0.0:
                refuse(place, "its time-out must be above 0")
            path = integer(piece["path"], f"pieces[{i}].path", 0, len(paths))
            if paths[path, 1:].any():
                refuse(place, "a piece that waits must rest")
    return MotionFile(
        name=text(document["name"], "name"),
        timed=kind == "timed",
        robot=text(robot["name"], "robot.name"),
        fingerprint=text(robot["fingerprint"], "robot.fingerprint"),
        limits=limits,
        chain=chain,
        tools=tools,
        position_tolerance=number(tolerance["position"], "tolerance.position", 0.0),
        angle_tolerance=number(tolerance["angle"], "tolerance.angle", 0.0),
        legs=legs,
        corners=corners,
        stretches=stretches,
        paths=paths,
        path_of=np.array(
            [integer(p["path"], f"pieces[{i}].path", 0, len(paths)) for i, p in enumerate(pieces)]
        ),
        durations=np.array(
            [number(p["duration"], f"pieces[{i}].duration", SHORTEST) for i, p in enumerate(pieces)]
        ),
        timing=np.stack(
            [array(p["timing"], f"pieces[{i}].timing", (6,)) for i, p in enumerate(pieces)]
        ),
        moves=np.array(
            [integer(p["move"], f"pieces[{i}].move", 0, MOST_STEPS) for i, p in enumerate(pieces)]
        ),
        certificate=_certificate(document["certificate"], n),
    )


def _certificate(value: object, n: int) -> dict[str, Any]:
    worst = [*KINDS]
    plain = ["path_deviation", "angle_deviation", "zone_deviation", "manipulability", "duration"]
    keys = [*worst, "tool", "position_min", "position_max", *plain, "rules"]
    given = members(value, "certificate", " ".join(keys))
    result: dict[str, Any] = {key: number(given[key], f"certificate.{key}", 0.0) for key in plain}
    for key in worst:
        place = f"certificate.{key}"
        rows = [
            members(r, f"{place}[{i}]", "value share time move")
            for i, r in enumerate(items(given[key], place))
        ]
        if len(rows) != n:
            refuse(place, f"it must hold {n} entries, and holds {len(rows)}")
        for i, row in enumerate(rows):
            integer(row["move"], f"{place}[{i}].move", 0, MOST_STEPS)
        result[key] = {
            name: np.array(
                [number(r[name], f"{place}[{i}].{name}", 0.0) for i, r in enumerate(rows)]
            )
            for name in ("value", "share", "time")
        }
    tool = members(given["tool"], "certificate.tool", " ".join(TOOL_RATES))
    result["tool"] = {}
    for key in TOOL_RATES:
        place = f"certificate.tool.{key}"
        row = members(tool[key], place, "value share time move")
        integer(row["move"], f"{place}.move", 0, MOST_STEPS)
        result["tool"][key] = {
            name: number(row[name], f"{place}.{name}", 0.0) for name in ("value", "share", "time")
        }
    for key in ("position_min", "position_max"):
        result[key] = array(given[key], f"certificate.{key}", (n,))
    result["rules"] = [
        _rule(rule, f"certificate.rules[{i}]", n)
        for i, rule in enumerate(items(given["rules"], "certificate.rules"))
    ]
    return result


def _rule(value: object, place: str, n: int) -> dict[str, Any]:
    given = members(value, place, "from to kind share", "joint")
    kind = text(given["kind"], f"{place}.kind", (*KINDS, "rest", "other"))
    joint = given.get("joint")
    if kind in KINDS:
        integer(joint, f"{place}.joint", 0, n)
    for key in ("from", "to", "share"):
        number(given[key], f"{place}.{key}", 0.0)
    return given
