"""Points that were merged into one straight leg: how far that leg is from those as they were told.

A leg that was made of several replaces the straight lines between its points. Both go forward
together, so the distance of the leg from those lines, both ways, is the largest of a point: the
distance from a line is convex.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ._balls import Array
from ._chain import cross_matrix
from ._curves import Line, Quintics, SteadyTurn
from ._file_parts import Corner, Leg
from ._findings import Finding, Verdict
from ._motion_file import MotionFile

SLACK = 1e-9
"""Of a distance or an angle that is claimed, relative: rounding."""
ROUNDING = 1e-12
"""The same, absolute [m, rad]."""
PARTS = 16
"""Of the way between two points, in each of which the turn is bounded."""


@dataclass(frozen=True)
class MergedExtent:
    """The largest distance of a leg from the points as told [m, rad], and the largest turn."""

    distance: float = 0.0
    turn: float = 0.0


def extent_of(leg: Leg) -> MergedExtent:
    """Return what merging has used of the zones of a leg and at its ends."""
    straight = _Straight.of(leg)
    if straight is None or not leg.merged:
        return MergedExtent()
    return MergedExtent(float(straight.distances.max()), float(straight.turns().max()))


def check_merged(motion: MotionFile, verdict: Verdict) -> None:
    """Prove that legs made of several keep the zones of the points that they pass by."""
    merged = [(k, leg) for k, leg in enumerate(motion.legs) if leg.merged]
    if not merged:
        return
    before = len(verdict.findings)
    worst = 0.0
    moves = {-1: -1} | {k: leg.move for k, leg in enumerate(motion.legs)}
    for k, leg in merged:
        numbers = [moves[k - 1], *(point.move for point in leg.merged), leg.move]
        straight = _Straight.of(leg)
        wrong = ""
        if any(b <= a for a, b in pairwise(numbers)):
            wrong = "merged points are not of the moves before their leg"
        elif straight is None:
            wrong = "points are merged into a leg that is no straight line"
        elif not straight.goes_forward():
            wrong = "merged points do not go forward along their leg"
        if wrong or straight is None:
            verdict.findings.append(Finding(wrong, move=leg.move))
            continue
        ends = [_end_of(motion, k - 1), _end_of(motion, k)]
        worst = max(worst, _judge(straight, ends, verdict))
    verdict.prove("merged points", f"{worst:.6f} of their zones", "1, and as claimed", before)


def _end_of(motion: MotionFile, leg: int) -> Corner | None:
    """Return the zone at the end of a leg, where it has one."""
    return next((corner for corner in motion.corners if corner.leg == leg), None)


def _judge(straight: _Straight, ends: list[Corner | None], verdict: Verdict) -> float:
    """Add what a leg breaks; return the largest share of a zone that it uses."""
    leg = straight.leg
    farthest = float(straight.distances.max())
    turns = straight.turns()
    worst = 0.0

    def require(what: str, value: float, limit: float, move: int) -> None:
        if not value <= limit * (1.0 + SLACK) + ROUNDING:
            verdict.findings.append(Finding(what, move=move, value=value, limit=limit))

    for point, distance, turn in zip(
        leg.merged, straight.distances, straight.turns_at_points(), strict=True
    ):
        require("a merged point is farther from its leg", float(distance), point.used, point.move)
        require("merging leaves a point's zone", farthest, point.asked, point.move)
        worst = max(worst, farthest / max(point.asked, 1e-300))
        if point.angle is None:
            continue
        require("the tool is turned farther at a point", float(turn), point.used_angle, point.move)
        require("merging turns out of a zone's angle", float(turns.max()), point.angle, point.move)
        worst = max(worst, float(turns.max()) / max(point.angle, 1e-300))
    if farthest > ROUNDING:
        gap = straight.first_gap(ends)
        if gap is not None:
            verdict.findings.append(
                Finding(
                    "a merged leg is beyond the radius of every point near it",
                    move=leg.move,
                    value=gap,
                    limit=straight.length,
                )
            )
    return worst


class _Straight:
    """A leg from one point to another, and the points beside it."""

    def __init__(self, leg: Leg, start: Array, way: Array) -> None:
        self.leg = leg
        self.length = float(np.linalg.norm(way))
        points = np.reshape([point.at for point in leg.merged], (-1, len(way)))
        self.shares: Array = (points - start) @ way / (way @ way)
        beside = points - start - self.shares[:, None] * way
        self.distances: Array = np.linalg.norm(beside, axis=1)

    @classmethod
    def of(cls, leg: Leg) -> _Straight | None:
        """Return the line of a leg; nothing where it is none."""
        if leg.hold == "joints":
            joints = leg.joints
            if not isinstance(joints, Quintics) or np.any(joints.coefficients[:, 2:]):
                return None
            rows = joints.coefficients
            if len(rows) != 1:
                return None
            return cls(leg, rows[0, 0], rows[0, 1])
        if not isinstance(leg.position, Line):
            return None
        if leg.hold == "pose" and not isinstance(leg.orientation, SteadyTurn):
            return None
        return cls(leg, leg.position.start, leg.length * leg.position.direction)

    def goes_forward(self) -> bool:
        """Tell whether the points lie one after the other."""
        stations = np.concatenate([[0.0], self.shares, [1.0]])
        return bool(np.all(np.diff(stations) > 0.0))

    def turns_at_points(self) -> Array:
        """Return the angle of the tool on the leg from that at each point, (m,) [rad]."""
        turn = self.leg.orientation
        rotations = [point.rotation for point in self.leg.merged]
        if not isinstance(turn, SteadyTurn):
            return np.zeros(len(rotations))
        return np.array(
            [
                0.0 if told is None else _angle(_turned(turn, share * self.leg.length), told)
                for share, told in zip(self.shares, rotations, strict=True)
            ]
        )

    def turns(self) -> Array:
        """Bound that angle between neighbours, ends included, (m + 1,) [rad].

        In the middle of each of many parts it is looked at; within a part both turn on by half of
        their ways at most.
        """
        turn = self.leg.orientation
        count = len(self.leg.merged) + 1
        if not isinstance(turn, SteadyTurn):
            return np.zeros(count)
        stations = np.concatenate([[0.0], self.shares, [1.0]]) * self.leg.length
        points = [point.rotation for point in self.leg.merged]
        told = [
            _turned(turn, 0.0),
            *(np.eye(3) if point is None else point for point in points),
            _turned(turn, self.leg.length),
        ]
        rate = float(np.linalg.norm(turn.rate))
        bounds = np.zeros(count)
        for k in range(count):
            # From one orientation as told to the next, both rotation matrices in the base frame.
            way = _rotation_vector(told[k + 1] @ told[k].T)
            step = (float(np.linalg.norm(way)) + rate * (stations[k + 1] - stations[k])) / PARTS
            if step == 0.0:
                bounds[k] = _angle(_turned(turn, stations[k]), told[k])
                continue
            for part in (np.arange(PARTS) + 0.5) / PARTS:
                here = _turned(turn, stations[k] + part * (stations[k + 1] - stations[k]))
                there = _exponential(part * way) @ told[k]
                bounds[k] = max(bounds[k], _angle(here, there) + 0.5 * step)
        return bounds

    def first_gap(self, ends: list[Corner | None]) -> float | None:
        """Find where the leg is first beyond every zone, from its start [m or rad]; None: nowhere.

        A radius holds the path within a ball about its point; a deviation holds as far as the legs
        beside its point went.
        """
        stations = np.concatenate([[0.0], self.shares, [1.0]]) * self.length
        covered = []
        for k, point in enumerate(self.leg.merged, start=1):
            if point.kind == "radius":
                off = self.distances[k - 1]
                half = float(np.sqrt(max(point.asked**2 - off**2, 0.0)))
                covered.append((stations[k] - half, stations[k] + half))
            else:
                covered.append((float(stations[k - 1]), float(stations[k + 1])))
        for end, station in zip(ends, (0.0, self.length), strict=True):
            if end is not None and end.kind == "radius":
                covered.append((station - end.asked, station + end.asked))
        reached = 0.0
        for low, high in sorted(covered):
            if low > reached + SLACK * self.length:
                break
            reached = max(reached, high)
        return None if reached >= self.length * (1.0 - SLACK) else reached


def _exponential(vector: Array) -> Array:
    """Rotate by a vector (Rodrigues)."""
    angle = float(np.linalg.norm(vector))
    if angle == 0.0:
        return np.eye(3)
    cross = cross_matrix(vector / angle)
    turn: Array = np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross)
    return turn


def _rotation_vector(turn: Array) -> Array:
    """Return the vector of a rotation by less than half a turn."""
    sine = 0.5 * np.array(
        [turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0], turn[1, 0] - turn[0, 1]]
    )
    size = float(np.linalg.norm(sine))
    if size == 0.0:
        return np.zeros(3)
    vector: Array = sine * (np.arctan2(size, 0.5 * (np.trace(turn) - 1.0)) / size)
    return vector


def _turned(turn: SteadyTurn, s: float) -> Array:
    result: Array = _exponential(turn.rate * s) @ turn.start
    return result


def _angle(one: Array, other: Array) -> float:
    """Return the angle between rotations: |A - B| = 2 √2 sin(angle / 2) (Frobenius)."""
    return float(2.0 * np.arcsin(min(np.linalg.norm(one - other) / np.sqrt(8.0), 1.0)))
