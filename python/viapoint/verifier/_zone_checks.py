"""Rounded corners: within the radius, or both ways within a distance of the legs."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Literal

import numpy as np

from ._balls import Array, Ball, Indices
from ._chain import Chain, tool_point, tool_rotation
from ._deviation_checks import place_on
from ._file_parts import Corner
from ._findings import Finding, Verdict
from ._jets import constant, largest, polynomial_jets
from ._merged_checks import extent_of
from ._motion_file import MotionFile
from ._search import prove_below

SHARE_SLACK = 1e-6
"""Of a zone, relative: rounding of what the planner proved just within it."""
SAMPLES = 129
"""Of a path, among which the nearest to a point is looked for."""
PLACE_COUNTS = 1e-6
"""What a metre counts beside a unit quaternion where the nearest orientation is looked for."""


def check_zones(motion: MotionFile, verdict: Verdict) -> None:
    """Prove what every rounded corner claims to use of its zone."""
    rounded = [k for k, c in enumerate(motion.corners) if not c.stopped]
    for kind, name in (
        ("radius", "corners by radius"),
        ("deviation", "corners by deviation"),
        ("joint_deviation", "corners by joint deviation"),
    ):
        corners = [k for k in rounded if motion.corners[k].kind == kind]
        if not corners:
            continue
        if kind != "joint_deviation" and motion.chain is None:
            verdict.findings.append(Finding("a zone at the tool of an arm without a chain"))
            continue
        before = len(verdict.findings)
        check = _RadiusCheck if kind == "radius" else _DeviationCheck
        space: Space = "joints" if kind == "joint_deviation" else "tool"
        worst = check(motion, corners, space).judge(verdict)
        verdict.prove(name, f"{worst:.6f} of their size", "1, and as claimed", before)
        turning = [k for k in corners if motion.corners[k].angle is not None]
        if not turning:
            continue
        if motion.chain is None:
            verdict.findings.append(Finding("a zone's angle for an arm without a chain"))
            continue
        before = len(verdict.findings)
        worst = check(motion, turning, "turn").judge(verdict)
        verdict.prove(f"{name}, angle", f"{worst:.6f} of theirs", "1, and as claimed", before)


def _pairs(motion: MotionFile, corners: list[int]) -> tuple[list[int], list[int], list[bool]]:
    """Paths to look at, the corner of each, and whether it is one of the legs (cut off)."""
    paths: list[int] = []
    owners: list[int] = []
    cut: list[bool] = []
    run = range(int(motion.path_of[-1]) + 1)
    blends: dict[int, list[int]] = {}
    for i in run:
        if (corner := motion.stretches[i].corner) is not None:
            blends.setdefault(corner, []).append(i)
    for k in corners:
        corner_ = motion.corners[k]
        blend = blends.get(k, [])
        legs = [*corner_.before, *corner_.after]
        paths += [*blend, *legs]
        owners += [k] * (len(blend) + len(legs))
        cut += [False] * len(blend) + [True] * len(legs)
    return paths, owners, cut


Space = Literal["joints", "tool", "turn"]
"""Where distances are taken: of the joints, of tool points, or of the tool's unit quaternions."""


def quaternion_distance(angle: Array) -> Array:
    """Distance of two unit quaternions, of one sign, that are an angle apart."""
    result: Array = 2.0 * np.sin(0.25 * angle)
    return result


class _Check(ABC):
    what = ""
    what_turns = ""

    def __init__(self, motion: MotionFile, corners: list[int], space: Space) -> None:
        self.motion = motion
        self.space = space
        paths, owners, cut = _pairs(motion, corners)
        self.paths = np.array(paths, dtype=np.intp)
        self.owners = np.array(owners, dtype=np.intp)
        self.cut = np.array(cut, dtype=bool)

    def judge(self, verdict: Verdict) -> float:
        """Add what is wrong; return the worst share of a zone that is proven."""
        zones: list[Corner] = [self.motion.corners[k] for k in self.owners]
        claimed = np.array([c.used_angle if self.space == "turn" else c.used for c in zones])
        asked = np.array([c.angle or 0.0 if self.space == "turn" else c.asked for c in zones])
        # What merging has used of the zones of its legs is not there for the corner.
        slack = SHARE_SLACK * claimed + 1e-12
        claimed = np.maximum(claimed - self._merged(zones), 0.0)
        sizes, whole = claimed, asked
        if self.space == "turn":
            sizes, whole = quaternion_distance(claimed), quaternion_distance(asked)
            slack = 0.5 * slack
        used = sizes + slack
        worst = prove_below(self.bounds, used, parts=4)
        reached = worst.bound
        if self.space == "turn":
            reached = 4.0 * np.arcsin(np.minimum(0.5 * reached, 1.0))
        for item in np.flatnonzero(~worst.proven):
            verdict.findings.append(
                Finding(
                    f"{self.what_turns if self.space == 'turn' else self.what} "
                    f"(corner {self.owners[item]})",
                    value=float(reached[item]),
                    limit=float(claimed[item]),
                    **place_on(self.motion, int(self.paths[item]), float(worst.at[item])),
                )
            )
        return float((worst.bound / np.maximum(whole, 1e-300)).max())

    def _merged(self, zones: list[Corner]) -> Array:
        """Return what merging has used of each zone, where that counts from the legs as told."""
        if isinstance(self, _RadiusCheck):
            return np.zeros(len(zones))
        extents = [extent_of(leg) for leg in self.motion.legs]
        used = [e.turn if self.space == "turn" else e.distance for e in extents]
        return np.array([max(used[zone.leg], used[zone.leg + 1]) for zone in zones])

    @abstractmethod
    def bounds(self, items: Indices, middle: Array, half: Array) -> tuple[Array, Array]:
        """Bound what the zone limits: each kind of zone in its own way."""

    def points(self, paths: Indices, middle: Array, half: Array, tool: Array) -> Ball:
        """Jets of what is compared."""
        rows = np.moveaxis(self.motion.paths[paths], 0, -1)
        joints = polynomial_jets(Ball.exact(rows), middle, half)
        if self.space == "joints" or self.motion.chain is None:
            return joints
        return compared(self.motion.chain, tool, joints, self.space)

    def tools(self, items: Indices) -> Indices:
        """Tool of each item."""
        legs = [self.motion.corners[k].leg for k in self.owners[items]]
        return np.array([self.motion.legs[leg].tool for leg in legs], dtype=np.intp)


class _RadiusCheck(_Check):
    what = "the path leaves the zone"
    what_turns = "the tool turns out of the zone's angle"

    def bounds(self, items: Indices, middle: Array, half: Array) -> tuple[Array, Array]:
        """Distance from the corner's point."""
        bound, reached = np.empty(len(items)), np.empty(len(items))
        tools = self.tools(items)
        for number in np.unique(tools):
            chosen = np.flatnonzero(tools == number)
            of = items[chosen]
            tool = self.motion.tools[number]
            there = self.points(self.paths[of], middle[chosen], half[chosen], tool)
            last = np.array([self.motion.corners[k].before[-1] for k in self.owners[of]])
            # The corner's own point: the end of what is cut off the leg before.
            end = self.points(last, np.ones(len(of)), np.zeros(len(of)), tool)[0][..., : len(of)]
            corner = Ball(np.tile(end.mid, 2), np.tile(end.rad, 2))
            bound[chosen], reached[chosen] = largest(there - constant(corner))
        return bound, reached


class _DeviationCheck(_Check):
    what = "path and legs are farther apart than claimed"
    what_turns = "the tool is turned farther from the legs than claimed"

    def __init__(self, motion: MotionFile, corners: list[int], space: Space) -> None:
        super().__init__(motion, corners, space)
        u = np.linspace(0.0, 1.0, SAMPLES)
        powers = np.vander(u, 6, increasing=True)
        q = np.einsum("sk,mkn->msn", powers, motion.paths[self.paths])
        self.lines = q
        if space != "joints" and motion.chain is not None:
            tools = self.tools(np.arange(len(self.paths)))
            self.lines = np.stack(
                [
                    paired_by(motion.chain, motion.tools[t], row, space)
                    for t, row in zip(tools, q, strict=True)
                ]
            )
        self.of_corner = {
            k: (
                np.flatnonzero((self.owners == k) & ~self.cut),
                np.flatnonzero((self.owners == k) & self.cut),
            )
            for k in corners
        }

    def bounds(self, items: Indices, middle: Array, half: Array) -> tuple[Array, Array]:
        """Bound the distance from near points of the others: so that of the nearest, too."""
        bound, reached = np.empty(len(items)), np.zeros(len(items))
        tools = self.tools(items)
        target, place, width = self._near(items, middle, half)
        for number in np.unique(tools):
            chosen = np.flatnonzero(tools == number)
            of = items[chosen]
            tool = self.motion.tools[number]
            here = self.points(self.paths[of], middle[chosen], half[chosen], tool)
            there = self.points(self.paths[target[chosen]], place[chosen], width[chosen], tool)
            # What is reached is from one near point, no less than from the nearest: no refutation.
            bound[chosen], _ = largest(here - there)
        return bound, reached

    def _near(self, items: Indices, middle: Array, half: Array) -> tuple[Indices, Array, Array]:
        """For each interval another path, and the interval of it that goes along with it."""
        target = np.empty(len(items), dtype=np.intp)
        place, width = np.empty(len(items)), np.empty(len(items))
        for i, (item, m, h) in enumerate(zip(items, middle, half, strict=True)):
            blend, legs = self.of_corner[int(self.owners[item])]
            others = blend if self.cut[item] else legs
            points = self._at(item, np.array([m - h, m, m + h]))
            distances, places = _project(points[1], self.lines[others])
            nearest = int(np.argmin(distances))
            target[i] = others[nearest]
            line = self.lines[target[i]][None]
            # From there, since somewhere else on a bent line may be as near to one of the ends.
            low, high = (float(_project(points[k], line, places[nearest])[1][0]) for k in (0, 2))
            place[i], width[i] = 0.5 * (low + high), 0.5 * (high - low)
        return target, place, width

    def _at(self, item: int, u: Array) -> Array:
        """Points in plain rounding."""
        q: Array = np.vander(u, 6, increasing=True) @ self.motion.paths[self.paths[item]]
        if self.space == "joints" or self.motion.chain is None:
            return q
        tool = self.motion.tools[int(self.tools(np.array([item]))[0])]
        return paired_by(self.motion.chain, tool, q, self.space)


def compared(chain: Chain, tool: Array, joints: Ball, space: Space) -> Ball:
    """Jets of the tool point, or of the tool's unit quaternion, whose sign goes with the joints."""
    if space == "turn":
        return tool_rotation(chain, tool, joints)
    return tool_point(chain, tool, joints)


def paired_by(chain: Chain, tool: Array, q: Array, space: Space) -> Array:
    """Return that by which the nearest places of paths with joints (k, n) are found, (k, 3 or 7).

    Orientations that are the same all along have no nearest: there the tool's place decides.
    """
    points = points_at(chain, tool, q, space)
    if space != "turn":
        return points
    return np.hstack([points, PLACE_COUNTS * points_at(chain, tool, q)])


def points_at(chain: Chain, tool: Array, q: Array, space: Space = "tool") -> Array:
    """Return what is compared of joints (k, n), in plain rounding, (k, 3) or (k, 4)."""
    jets = polynomial_jets(Ball.exact(q.T[None]), np.zeros(len(q)), np.zeros(len(q)))
    points: Array = compared(chain, tool, jets, space).mid[0, :, : len(q)].T
    return points


def _project(point: Array, lines: Array, start: float | None = None) -> tuple[Array, Array]:
    """Distance of a point from sampled curves (m, k, d), and where on each, 0 to 1, it is nearest.

    The square of the distance is taken for a parabola about the nearest sample, or about the one
    that is reached downhill from `start`, which makes the place good to the third order in their
    spacing.
    """
    square = np.sum((lines - point) ** 2, axis=2)
    rows, last = np.arange(len(lines)), lines.shape[1] - 1
    if start is None:
        best = square.argmin(axis=1)
    else:
        best = np.array([_downhill(row, round(start * last)) for row in square])
    middle = np.clip(best, 1, last - 1)
    left, here, right = (square[rows, middle + k] for k in (-1, 0, 1))
    bend = left - 2.0 * here + right
    slope = 0.5 * (right - left)
    off = np.divide(-slope, bend, out=np.zeros_like(bend), where=bend > 0.0)
    off = np.where(bend > 0.0, np.clip(off, -1.0, 1.0), best - middle)
    least = here + off * (slope + 0.5 * off * bend)
    return np.sqrt(np.maximum(least, 0.0)), (middle + off) / last


def _downhill(values: Array, start: int) -> int:
    """Return the index of the least value that is reached from `start` without going up."""
    for step in (-1, 1):
        at = start
        while 0 <= at + step < len(values) and values[at + step] < values[at]:
            at += step
        if at != start:
            return at
    return start
