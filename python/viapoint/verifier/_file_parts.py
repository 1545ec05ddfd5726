"""The parts of a motion file and how each is read: robot, legs, corners and paths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ._balls import Array
from ._chain import Chain
from ._curves import Helix, Line, Orientation, Position, Quintics, SteadyTurn, TurnSpline
from ._strict_json import (
    array,
    integer,
    items,
    members,
    number,
    optional_number,
    refuse,
    text,
    truth,
)

MOST_JOINTS = 16
MOST_STEPS = 10**9
ROTATION_SLACK = 1e-9
TOOL_RATES = ("speed", "acceleration", "angular_speed", "angular_acceleration")
HOLDS = ("joints", "pose", "axis", "position", "wrist")
TURNING = ("pose", "axis")
"""Those that hold the orientation, or its z axis."""
KINDS = ("velocity", "acceleration", "jerk")


@dataclass(frozen=True)
class Limits:
    """Of every joint (n,); positions may be infinite. lower <= C q <= upper."""

    position_min: Array
    position_max: Array
    rates: Array  # (3, n): velocity, acceleration, jerk
    coupling: Array
    coupling_lower: Array
    coupling_upper: Array


@dataclass(frozen=True)
class MergedPoint:
    """A point as it was told, whose corner is none since a straight leg passes it so near."""

    move: int
    at: Array
    """Joints (n,), or the tool point (3,) [m]."""
    rotation: Array | None
    """Of the tool, (3, 3), where the leg holds it."""
    kind: str
    asked: float
    used: float
    angle: float | None
    used_angle: float


@dataclass(frozen=True)
class Leg:
    """What is asked of one move."""

    move: int
    line: int | None
    tool: int
    hold: str
    joints: Quintics | None
    position: Position | None
    orientation: Orientation | None
    length: float
    speed: float | None
    acceleration: float | None
    angular_speed: float | None
    angular_acceleration: float | None
    scale: float
    merged: tuple[MergedPoint, ...] = ()


@dataclass(frozen=True)
class Corner:
    """What became of a zone; `before` and `after` are the stretches that it cuts off."""

    leg: int
    kind: str
    asked: float
    stopped: bool
    used: float
    cut: float
    before: tuple[int, ...]
    after: tuple[int, ...]
    angle: float | None = None
    """Bound of the tool's orientation besides [rad], and what is claimed to be used of it."""
    used_angle: float = 0.0


@dataclass(frozen=True)
class Stretch:
    """Whom a path belongs to: a leg between two places of its s, a corner, or nobody (rest)."""

    leg: int | None
    corner: int | None
    start: float
    end: float


def limits_in(value: object) -> Limits:
    """Read the limits of all joints."""
    keys = "position_min position_max velocity acceleration jerk coupling coupling_lower"
    given = members(value, "robot.limits", f"{keys} coupling_upper")
    rates = [array(given[kind], f"robot.limits.{kind}", (-1,)) for kind in KINDS]
    n = len(rates[0])
    if not 1 <= n <= MOST_JOINTS or any(len(rate) != n for rate in rates):
        refuse("robot.limits", f"it must hold one value for each of 1 to {MOST_JOINTS} joints")
    if any(np.any(rate <= 0.0) for rate in rates):
        refuse("robot.limits", "rates must be above zero")
    coupling = array(given["coupling"], "robot.limits.coupling", (-1, n))
    rows = len(coupling)
    limits = Limits(
        _bounds(given["position_min"], "robot.limits.position_min", n, -np.inf),
        _bounds(given["position_max"], "robot.limits.position_max", n, np.inf),
        np.stack(rates),
        coupling.reshape(rows, n),
        _bounds(given["coupling_lower"], "robot.limits.coupling_lower", rows, -np.inf),
        _bounds(given["coupling_upper"], "robot.limits.coupling_upper", rows, np.inf),
    )
    if np.any(limits.position_min >= limits.position_max):
        refuse("robot.limits", "position_min must be below position_max")
    return limits


def _bounds(value: object, place: str, count: int, missing: float) -> Array:
    """Numbers, null where there is no bound."""
    rows = items(value, place)
    if len(rows) != count:
        refuse(place, f"it must hold {count} values, and holds {len(rows)}")
    return np.array(
        [missing if v is None else number(v, f"{place}[{i}]") for i, v in enumerate(rows)]
    )


def chain_in(value: object, n: int) -> Chain:
    """Read the chain of an arm of n joints."""
    rows = items(value, "robot.chain")
    if len(rows) != n:
        refuse("robot.chain", f"it must hold {n} joints, and holds {len(rows)}")
    prismatic, before, axis = [], [], []
    for i, row in enumerate(rows):
        place = f"robot.chain[{i}]"
        joint = members(row, place, "type before axis")
        kind = text(joint["type"], f"{place}.type", ("revolute", "prismatic"))
        prismatic.append(kind == "prismatic")
        before.append(array(joint["before"], f"{place}.before", (4, 4)))
        require_pose(before[-1], f"{place}.before")
        axis.append(array(joint["axis"], f"{place}.axis", (3,)))
        if abs(np.linalg.norm(axis[-1]) - 1.0) > ROTATION_SLACK:
            refuse(f"{place}.axis", "it must be of unit length")
    return Chain(np.array(prismatic), np.stack(before), np.stack(axis))


def require_pose(pose: Array, place: str) -> None:
    """Refuse a matrix that is no pose."""
    turn = pose[:3, :3]
    off = np.abs(turn @ turn.T - np.eye(3)).max()
    if off > ROTATION_SLACK or np.linalg.det(turn) < 0.0 or np.any(pose[3] != [0, 0, 0, 1]):
        refuse(place, "it is no pose: a rotation, a place, and 0 0 0 1")


def leg_in(value: object, place: str, n: int, tools: int) -> Leg:
    """Read one leg."""
    given = members(
        value,
        place,
        "move tool hold length",
        "joints position orientation scale file line merged " + " ".join(TOOL_RATES),
    )
    hold = text(given["hold"], f"{place}.hold", HOLDS)
    joints: Quintics | None = None
    position: Position | None = None
    orientation: Orientation | None = None
    length = number(given["length"], f"{place}.length", 1e-12)
    if hold == "joints":
        joints = _quintics(given.get("joints"), f"{place}.joints", n)
        _require_length(joints, length, place)
    else:
        position = _position(given.get("position"), f"{place}.position")
        if isinstance(position, Quintics):
            _require_length(position, length, place)
    if hold in TURNING:
        orientation = _orientation(given.get("orientation"), f"{place}.orientation")
        if isinstance(orientation, TurnSpline):
            _require_length(orientation.vectors, length, place)
    if "file" in given:
        text(given["file"], f"{place}.file")
    scale = number(given.get("scale", 1.0), f"{place}.scale", 1e-9, 1.0)
    return Leg(
        move=integer(given["move"], f"{place}.move", 0, MOST_STEPS),
        line=integer(given["line"], f"{place}.line", 1, MOST_STEPS) if "line" in given else None,
        tool=integer(given["tool"], f"{place}.tool", 0, tools),
        hold=hold,
        joints=joints,
        position=position,
        orientation=orientation,
        length=length,
        **{name: optional_number(given.get(name), f"{place}.{name}", 1e-9) for name in TOOL_RATES},
        scale=scale,
        merged=tuple(
            _merged_in(point, f"{place}.merged[{i}]", hold, n)
            for i, point in enumerate(items(given.get("merged", []), f"{place}.merged"))
        ),
    )


def _merged_in(value: object, place: str, hold: str, n: int) -> MergedPoint:
    keys = "move at kind asked used" + (" rotation" if hold == "pose" else "")
    given = members(value, place, keys, "file line angle used_angle")
    if "file" in given:
        text(given["file"], f"{place}.file")
        integer(given.get("line"), f"{place}.line", 1, MOST_STEPS)
    rotation = None
    if "rotation" in given:
        rotation = array(given["rotation"], f"{place}.rotation", (3, 3))
        if np.abs(rotation @ rotation.T - np.eye(3)).max() > ROTATION_SLACK:
            refuse(f"{place}.rotation", "it is no rotation")
    kinds = ("joint_deviation",) if hold == "joints" else ("radius", "deviation")
    return MergedPoint(
        move=integer(given["move"], f"{place}.move", 0, MOST_STEPS),
        at=array(given["at"], f"{place}.at", (n if hold == "joints" else 3,)),
        rotation=rotation,
        kind=text(given["kind"], f"{place}.kind", kinds),
        asked=number(given["asked"], f"{place}.asked", 0.0),
        used=number(given["used"], f"{place}.used", 0.0),
        **_angle_in(given, place),
    )


def _angle_in(given: dict[str, Any], place: str) -> dict[str, Any]:
    """Read what a zone allows the tool's orientation, and what is said to be used of it."""
    return {
        "angle": number(given["angle"], f"{place}.angle", 0.0, np.pi) if "angle" in given else None,
        "used_angle": number(given.get("used_angle", 0.0), f"{place}.used_angle", 0.0, np.pi),
    }


def _require_length(chain: Quintics, length: float, place: str) -> None:
    if abs(chain.lengths.sum() - length) > 1e-9 * max(length, 1.0):
        refuse(place, f"its curve is {chain.lengths.sum():.9g} long, its length says {length:.9g}")


def _quintics(value: object, place: str, dimension: int) -> Quintics:
    given = members(value, place, "lengths coefficients")
    lengths = array(given["lengths"], f"{place}.lengths", (-1,))
    if len(lengths) == 0 or np.any(lengths <= 0.0):
        refuse(f"{place}.lengths", "it must hold one length or more, all above zero")
    shape = (len(lengths), 6, dimension)
    return Quintics(lengths, array(given["coefficients"], f"{place}.coefficients", shape))


def _position(value: object, place: str) -> Position:
    if isinstance(value, dict) and "direction" in value:
        given = members(value, place, "from direction")
        return Line(
            array(given["from"], f"{place}.from", (3,)),
            array(given["direction"], f"{place}.direction", (3,)),
        )
    if isinstance(value, dict) and "center" in value:
        given = members(value, place, "center radial tangential travel rate")
        center, radial, tangential, travel = (
            array(given[key], f"{place}.{key}", (3,))
            for key in ("center", "radial", "tangential", "travel")
        )
        return Helix(center, radial, tangential, travel, number(given["rate"], f"{place}.rate"))
    return _quintics(value, place, 3)


def _orientation(value: object, place: str) -> Orientation:
    if isinstance(value, dict) and "from" in value:
        given = members(value, place, "from rate")
        start = array(given["from"], f"{place}.from", (3, 3))
        if np.abs(start @ start.T - np.eye(3)).max() > ROTATION_SLACK:
            refuse(f"{place}.from", "it is no rotation")
        return SteadyTurn(start, array(given["rate"], f"{place}.rate", (3,)))
    given = members(value, place, "lengths coefficients bases")
    vectors = _quintics(
        {"lengths": given["lengths"], "coefficients": given["coefficients"]}, place, 3
    )
    bases = array(given["bases"], f"{place}.bases", (len(vectors.lengths), 3, 3))
    if np.abs(bases @ np.moveaxis(bases, 1, 2) - np.eye(3)).max() > ROTATION_SLACK:
        refuse(f"{place}.bases", "one of them is no rotation")
    return TurnSpline(vectors, bases)


def corner_in(value: object, place: str, legs: int, paths: int) -> Corner:
    """Read one corner."""
    keys = "leg kind asked stopped used cut reason before after"
    given = members(value, place, keys, "angle used_angle")
    text(given["reason"], f"{place}.reason")
    leg = integer(given["leg"], f"{place}.leg", 0, legs)
    cuts = []
    for key in ("before", "after"):
        rows = items(given[key], f"{place}.{key}")
        cuts.append(tuple(integer(p, f"{place}.{key}", 0, paths) for p in rows))
    stopped = truth(given["stopped"], f"{place}.stopped")
    if not stopped and leg + 1 >= legs:
        refuse(place, "no leg follows the one that it rounds the end of")
    return Corner(
        leg=leg,
        kind=text(given["kind"], f"{place}.kind", ("radius", "deviation", "joint_deviation")),
        asked=number(given["asked"], f"{place}.asked", 0.0),
        stopped=stopped,
        used=number(given["used"], f"{place}.used", 0.0),
        cut=number(given["cut"], f"{place}.cut", 0.0),
        before=cuts[0],
        after=cuts[1],
        **_angle_in(given, place),
    )


def paths_in(value: object, n: int, legs: int, corners: int) -> tuple[tuple[Stretch, ...], Array]:
    """Read all paths, and whom they belong to."""
    stretches, coefficients = [], []
    for i, row in enumerate(items(value, "paths")):
        place = f"paths[{i}]"
        given = members(row, place, "coefficients", "leg from to corner")
        leg = corner = None
        start = end = 0.0
        if "leg" in given:
            leg = integer(given["leg"], f"{place}.leg", 0, legs)
            start = number(given.get("from"), f"{place}.from")
            end = number(given.get("to"), f"{place}.to", start)
        elif "corner" in given:
            corner = integer(given["corner"], f"{place}.corner", 0, corners)
        stretches.append(Stretch(leg, corner, start, end))
        coefficients.append(array(given["coefficients"], f"{place}.coefficients", (6, n)))
    if not coefficients:
        refuse("paths", "it must hold one path or more")
    return tuple(stretches), np.stack(coefficients)
