"""Writes a motion with its proof and all that it takes to prove it anew (docs/motion_files.md)."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arguments import Vector, file_name
from ._ruling import KINDS, Rule, rules_of
from ._stretches import Stretch, stretches_of
from .errors import EmptyProgramError
from .verifier import FORMAT, TOOL_RATES, VERSION, seal

if TYPE_CHECKING:
    from ._motion import Motion


def save_motion(motion: Motion, path: str | os.PathLike[str]) -> None:
    """Write the file aside and rename it: a reader finds the old one or the new one."""
    _core.write_file_atomically(file_name(path), motion_text(motion).decode())


def motion_text(motion: Motion) -> bytes:
    """Return what the file holds, sealed."""
    if not motion.pieces:
        raise EmptyProgramError(
            "The motion has no duration, so no pieces.",
            ways_out=["Add a move or a wait to the program."],
        )
    writer = _Writer(motion)
    lines = []
    for key, value in writer.document().items():
        name = json.dumps(key)
        if isinstance(value, list) and value and isinstance(value[0], dict):
            rows = ",\n ".join(_compact(row) for row in value)
            lines.append(f"{name}: [\n {rows}]")
        else:
            lines.append(f"{name}: {_compact(value)}")
    return seal("{\n" + ",\n".join(lines))


def motion_rules(motion: Motion) -> list[Rule]:
    """Tell which limit rules when, as the file does."""
    rows = json.loads(motion_text(motion))["certificate"]["rules"]
    return [
        Rule(row["from"], row["to"], row["kind"], row.get("joint"), row["share"]) for row in rows
    ]


class _Writer:
    def __init__(self, motion: Motion) -> None:
        self._motion = motion
        self._steps = json.loads(motion._told.to_json())["steps"]
        self._pieces = _core.MotionPieces(motion._core)
        self._legs = _core.wanted_legs(motion.robot._core, motion._told)
        self._leg_of = {leg.move: i for i, leg in enumerate(self._legs)}
        self._tools: list[Vector] = []

    def document(self) -> dict[str, Any]:
        motion = self._motion
        chain = _core.chain_of(motion.robot._core)
        self._tools.append(np.asarray(chain["tool"]))
        corners = [corner for corner in motion.corners if corner.move in self._leg_of]
        rounded = {self._leg_of[c.move]: k for k, c in enumerate(corners) if not c.stopped}
        path_of = self._pieces.path_of
        firsts = np.searchsorted(path_of, np.arange(path_of[-1] + 1))
        moves = self._pieces.moves
        found, cuts = stretches_of(
            np.asarray(self._pieces.coefficients),
            [moves[int(k)] for k in firsts],
            self._legs,
            rounded,
        )
        corner_rows = []
        stretches = list(found)
        for k, corner in enumerate(corners):
            before, after = cuts.get(k, ([], []))
            numbers = list(range(len(stretches), len(stretches) + len(before) + len(after)))
            stretches += [*before, *after]
            corner_rows.append(
                {
                    "leg": self._leg_of[corner.move],
                    "kind": corner.kind,
                    "asked": corner.asked,
                    "stopped": corner.stopped,
                    "used": corner.used,
                    "cut": corner.cut,
                    "reason": corner.reason,
                    "before": numbers[: len(before)],
                    "after": numbers[len(before) :],
                    **_angle(corner),
                }
            )
        timed = any("timed" in step for step in self._steps)
        legs = [self._leg(leg) for leg in self._legs]
        return {
            "format": FORMAT,
            "version": VERSION,
            "viapoint": _core.__version__,
            "name": motion.program.name,
            "kind": "timed" if timed else "planned",
            "robot": self._robot(chain),
            "tools": [tool.tolist() for tool in self._tools],
            "tolerance": self._tolerance(),
            "legs": legs,
            "corners": corner_rows,
            "paths": [_path(stretch) for stretch in stretches],
            "pieces": self._piece_rows(),
            "certificate": self._certificate(found, corner_rows),
        }

    def _robot(self, chain: dict[str, Any]) -> dict[str, Any]:
        robot = self._motion.robot
        limits = robot.limits
        joints = [
            {
                "type": "prismatic" if slides else "revolute",
                "before": before.tolist(),
                "axis": axis[:, 0].tolist(),
            }
            for slides, before, axis in zip(
                chain["prismatic"], chain["before"], chain["axis"], strict=True
            )
        ]
        return {
            "name": robot.name,
            "fingerprint": robot.fingerprint,
            "limits": {
                "position_min": _bounds(limits.position_min),
                "position_max": _bounds(limits.position_max),
                "velocity": limits.velocity.tolist(),
                "acceleration": limits.acceleration.tolist(),
                "jerk": limits.jerk.tolist(),
                "coupling": np.asarray(limits.coupling).tolist(),
                "coupling_lower": _bounds(limits.coupling_lower),
                "coupling_upper": _bounds(limits.coupling_upper),
            },
            "chain": joints if robot.has_kinematics else None,
        }

    def _tolerance(self) -> dict[str, float]:
        tolerance = json.loads(self._motion._told.to_json()).get("tolerance", {})
        return {
            "position": tolerance.get("position", _core.POSITION_TOLERANCE),
            "angle": tolerance.get("angle", _core.ANGLE_TOLERANCE),
        }

    def _leg(self, leg: _core.WantedLeg) -> dict[str, Any]:
        path = leg.path
        row: dict[str, Any] = {"move": leg.move, "tool": self._tool_number(np.asarray(leg.tool))}
        row |= self._source(leg.move)
        row["length"] = float(np.asarray(path["lengths"]).sum())
        if leg.on_curve:
            row["hold"] = leg.hold
            row["position"] = _plain(leg.position)
            if leg.hold in ("pose", "axis"):
                row["orientation"] = _plain(leg.orientation)
            row |= {k: v for k in TOOL_RATES if (v := getattr(leg, k)) is not None}
        else:
            row["hold"] = "joints"
            row["joints"] = _plain(path)
        if leg.scale is not None:
            row["scale"] = leg.scale
        if leg.merged:
            row["merged"] = [
                self._merged(point, at, rotation if row["hold"] == "pose" else None)
                for point, at, rotation in leg.merged
            ]
        return row

    def _merged(self, point: _core.Corner, at: Vector, rotation: Vector | None) -> dict[str, Any]:
        row = {"move": point.move, **self._source(point.move), "at": at.tolist()}
        if rotation is not None:
            row["rotation"] = rotation.tolist()
        row |= {"kind": point.kind, "asked": point.asked, "used": point.used}
        return row | _angle(point)

    def _source(self, move: int) -> dict[str, Any]:
        """Tell the line of the script where it is known."""
        source = self._steps[move].get("source", {})
        if source.get("line", 0) > 0:
            return {"file": source.get("file", ""), "line": source["line"]}
        return {}

    def _tool_number(self, tool: Vector) -> int:
        for i, known in enumerate(self._tools):
            if np.array_equal(known, tool):
                return i
        self._tools.append(tool)
        return len(self._tools) - 1

    def _piece_rows(self) -> list[dict[str, Any]]:
        pieces = self._pieces
        rows: list[dict[str, Any]] = [
            {"path": path, "move": move, "duration": duration, "timing": timing}
            for path, move, duration, timing in zip(
                pieces.path_of,
                pieces.moves,
                np.asarray(pieces.durations).tolist(),
                np.asarray(pieces.timing).tolist(),
                strict=True,
            )
        ]
        for piece, output, on, seconds in pieces.outputs:
            told = [output, on, seconds] if seconds else [output, on]
            rows[piece].setdefault("outputs", []).append(told)
        for piece, number, on, timeout in pieces.waits:
            rows[piece]["wait"] = [number, on, timeout]
        return rows

    def _certificate(self, found: list[Stretch], corners: list[dict[str, Any]]) -> dict[str, Any]:
        proof = self._motion.certificate
        scale_of = [1.0 if leg.scale is None else leg.scale for leg in self._legs]
        of_path = []
        for stretch in found:
            legs = [] if stretch.leg is None else [stretch.leg]
            if stretch.corner is not None:
                first = corners[stretch.corner]["leg"]
                legs = [first, first + 1]
            of_path.append(min((scale_of[leg] for leg in legs), default=1.0))
        scales = np.array(of_path)[self._pieces.path_of]
        starts = np.concatenate([[0.0], np.cumsum(np.asarray(self._pieces.durations))])
        worst = {kind: [_extremum(extremum) for extremum in getattr(proof, kind)] for kind in KINDS}
        rules = [
            {"from": r.start, "to": r.end, "kind": r.kind, "share": r.share}
            | ({} if r.joint is None else {"joint": r.joint})
            for r in rules_of(self._motion, starts, scales)
        ]
        return {
            **worst,
            "tool": {name: _extremum(getattr(proof.tool, name)) for name in TOOL_RATES},
            "position_min": proof.position_min.tolist(),
            "position_max": proof.position_max.tolist(),
            "path_deviation": proof.path_deviation,
            "angle_deviation": proof.angle_deviation,
            "zone_deviation": proof.zone_deviation,
            "manipulability": proof.manipulability,
            "duration": self._motion.duration,
            "rules": rules,
        }


def _extremum(worst: _core.Extremum) -> dict[str, Any]:
    return {"value": worst.value, "share": worst.share, "time": worst.time, "move": worst.move}


def _path(stretch: Stretch) -> dict[str, Any]:
    row: dict[str, Any] = {}
    if stretch.leg is not None:
        row = {"leg": stretch.leg, "from": stretch.start, "to": stretch.end}
    elif stretch.corner is not None:
        row = {"corner": stretch.corner}
    row["coefficients"] = stretch.coefficients.tolist()
    return row


def _plain(columns: dict[str, Any]) -> dict[str, Any]:
    row = {key: np.asarray(values).tolist() for key, values in columns.items()}
    if "center" in row:
        row["rate"] = row["rate"][0]
    return row


def _bounds(values: Vector) -> list[float | None]:
    return [float(v) if np.isfinite(v) else None for v in values]


def _compact(value: object) -> str:
    return json.dumps(value, allow_nan=False, separators=(", ", ": "))


def _angle(corner: _core.Corner) -> dict[str, float]:
    """Tell what a zone allows the tool's orientation, where it bounds it."""
    if corner.asked_angle is None:
        return {}
    return {"angle": corner.asked_angle, "used_angle": corner.used_angle}
