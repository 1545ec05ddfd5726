"""How far the tool is from the curve that it was told to follow, and the joints from theirs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from ._balls import Array, Ball, Indices
from ._chain import Chain, tool_point, tool_rotation
from ._curves import Quintics, TurnSpline, half_axis_off, parameter_jets, relative_turn
from ._file_parts import TURNING, Leg
from ._findings import Finding, Verdict
from ._jets import largest, polynomial_jets
from ._motion_file import MotionFile
from ._search import Bounds, Worst, prove_below

JOINT_SLACK = 1e-8
"""Of joints from their line or spline, a rounding of its parts [rad, m]."""
Offsets = Callable[[Leg, Indices, Ball, Array], Ball]
"""Of a leg, columns, s and its middles: jets of what is to be small."""
CLAIM_SLACK = 1e-9
"""Of a claimed deviation below the truth [m, rad]."""


def check_deviation(motion: MotionFile, verdict: Verdict) -> None:
    """Prove that every path of a leg follows what the leg asks for."""
    on_legs = [i for i, s in enumerate(motion.stretches) if s.leg is not None]
    joints = [i for i in on_legs if _leg(motion, i).hold == "joints"]
    curves = [i for i in on_legs if _leg(motion, i).hold != "joints"]
    turns = [i for i in curves if _leg(motion, i).hold in TURNING]
    _check_joints(motion, joints, verdict)
    if motion.chain is None:
        if curves:
            verdict.findings.append(Finding("a tool curve for an arm without a chain"))
        return
    along = Along(motion, motion.chain, curves)
    distance = _Quantity(
        "path_deviation", "the tool leaves its curve", "distance from the curve [mm]"
    )
    _check_curves(motion, along, along.positions, distance, motion.position_tolerance, verdict)
    along = Along(motion, motion.chain, turns)
    angle = _Quantity("angle_deviation", "the tool turns away", "angle from the curve [mrad]")
    _check_curves(motion, along, along.angles, angle, motion.angle_tolerance, verdict)


@dataclass(frozen=True)
class _Quantity:
    """What a tool curve is held to: its claim, and what is said of it."""

    claim: str
    broken: str
    proven: str


def _check_curves(
    motion: MotionFile,
    along: Along,
    bounds: Bounds,
    quantity: _Quantity,
    tolerance: float,
    verdict: Verdict,
) -> None:
    before = len(verdict.findings)
    worst = prove_below(bounds, np.full(len(along.paths), tolerance), along.breaks())
    _judge(motion, along.paths, worst, quantity.broken, tolerance, verdict)
    _judge_claim(motion, quantity.claim, worst, tolerance, verdict)
    if along.paths:
        verdict.prove(
            quantity.proven,
            f"{1e3 * worst.bound.max():.5f}",
            f"{1e3 * tolerance:.5f} and as claimed",
            before,
        )


def _leg(motion: MotionFile, path: int) -> Leg:
    number = motion.stretches[path].leg
    if number is None:
        raise ValueError("a path of no leg")
    return motion.legs[number]


class Along:
    """Paths beside the curves of their legs."""

    def __init__(self, motion: MotionFile, chain: Chain, paths: list[int]) -> None:
        self.paths = paths
        self._motion = motion
        self._chain = chain
        self._paths = np.array(paths, dtype=np.intp)
        self._legs = np.array([motion.stretches[p].leg for p in paths], dtype=np.intp)
        self._start = np.array([motion.stretches[p].start for p in paths])
        self._end = np.array([motion.stretches[p].end for p in paths])

    def breaks(self) -> list[Array]:
        """Where a path has to be cut because a curve's polynomial changes."""
        result = []
        for leg, start, end in zip(self._legs, self._start, self._end, strict=True):
            s = _breaks_of(self._motion.legs[leg])
            inside = s[(s > start) & (s < end)]
            result.append((inside - start) / max(end - start, 1e-300))
        return result

    def joints(self, items: Indices, middle: Array, half: Array) -> Ball:
        """Jets of the joints."""
        rows = np.moveaxis(self._motion.paths[self._paths[items]], 0, -1)
        return polynomial_jets(Ball.exact(rows), middle, half)

    def positions(self, items: Indices, middle: Array, half: Array) -> tuple[Array, Array]:
        """Bound of the distance from the curve."""
        q = self.joints(items, middle, half)

        def off(leg: Leg, columns: Indices, s: Ball, s_middle: Array) -> Ball:
            if leg.position is None:
                raise ValueError("no curve")
            tool = self._motion.tools[leg.tool]
            curve = leg.position.jets(s, _span(leg.position, s_middle))
            return tool_point(self._chain, tool, q[..., columns]) - curve

        return self.by_leg(items, middle, half, off)

    def angles(self, items: Indices, middle: Array, half: Array) -> tuple[Array, Array]:
        """Bound of the angle from the curve."""
        q = self.joints(items, middle, half)

        def off(leg: Leg, columns: Indices, s: Ball, s_middle: Array) -> Ball:
            if leg.orientation is None:
                raise ValueError("no curve")
            spline = leg.orientation
            span = _span(spline.vectors if isinstance(spline, TurnSpline) else None, s_middle)
            curve = spline.jets(s, span)
            tool = self._motion.tools[leg.tool]
            turn = tool_rotation(self._chain, tool, q[..., columns])
            return half_axis_off(curve, turn) if leg.hold == "axis" else relative_turn(curve, turn)

        bound, reached = self.by_leg(items, middle, half, off)
        # The vector part of a unit quaternion is the sine of half its angle, as long as half of
        # what unit vectors of that angle are apart.
        return (
            2.0 * np.arcsin(np.minimum(bound, 1.0)) * (1.0 + 1e-12),
            2.0 * np.arcsin(np.minimum(reached, 1.0)) * (1.0 - 1e-12),
        )

    def by_leg(
        self, items: Indices, middle: Array, half: Array, off: Offsets
    ) -> tuple[Array, Array]:
        bound, reached = np.empty(len(items)), np.empty(len(items))
        legs = self._legs[items]
        for number in np.unique(legs):
            chosen = np.flatnonzero(legs == number)
            of = items[chosen]
            s = parameter_jets(self._start[of], self._end[of], middle[chosen], half[chosen])
            s_middle = self._start[of] + middle[chosen] * (self._end[of] - self._start[of])
            columns = np.concatenate([chosen, chosen + len(items)])
            jets = off(self._motion.legs[number], columns, s, s_middle)
            bound[chosen], reached[chosen] = largest(jets)
        return bound, reached


def _breaks_of(leg: Leg) -> Array:
    parts = [c.breaks() for c in (leg.joints, leg.position, leg.orientation) if c is not None]
    return np.unique(np.concatenate(parts)) if parts else np.empty(0)


def _span(curve: object, s: Array) -> Indices:
    """Which quintic of a chain holds the middle of each interval."""
    if not isinstance(curve, Quintics):
        return np.zeros(len(s), dtype=np.intp)
    found = np.searchsorted(curve.starts, s, side="right") - 1
    return np.clip(found, 0, len(curve.lengths) - 1)


def _check_joints(motion: MotionFile, paths: list[int], verdict: Verdict) -> None:
    """Joint lines and splines: the run polynomials are theirs to rounding."""
    before = len(verdict.findings)
    if not paths:
        return
    chain = Chain(np.zeros(0), np.zeros((0, 4, 4)), np.zeros((0, 3)))
    along = Along(motion, chain, paths)

    def bounds(items: Indices, middle: Array, half: Array) -> tuple[Array, Array]:
        q = along.joints(items, middle, half)

        def off(leg: Leg, columns: Indices, s: Ball, s_middle: Array) -> Ball:
            if leg.joints is None:
                raise ValueError("no joints")
            return q[..., columns] - leg.joints.jets(s, _span(leg.joints, s_middle))

        return along.by_leg(items, middle, half, off)

    worst = prove_below(bounds, np.full(len(paths), JOINT_SLACK), along.breaks(), parts=1)
    _judge(motion, paths, worst, "the joints leave their line or spline", JOINT_SLACK, verdict)
    verdict.prove(
        "joints from their line or spline", f"{worst.bound.max():.1e}", f"{JOINT_SLACK:.0e}", before
    )


def _judge(
    motion: MotionFile, paths: list[int], worst: Worst, what: str, limit: float, verdict: Verdict
) -> None:
    for item in np.flatnonzero(~worst.proven):
        verdict.findings.append(
            Finding(
                what,
                value=float(worst.bound[item]),
                limit=limit,
                **place_on(motion, paths[item], float(worst.at[item])),
            )
        )


def place_on(motion: MotionFile, path: int, u: float) -> dict[str, Any]:
    """Piece, move and time at which a path is at u; the move alone where it never runs."""
    stretch = motion.stretches[path]
    pieces = np.flatnonzero(motion.path_of == path)
    for piece in pieces:
        x = np.linspace(0.0, 1.0, 65)
        run = np.vander(x, 6, increasing=True) @ motion.timing[piece]
        if run.min() - 1e-9 <= u <= run.max() + 1e-9:
            at = x[np.argmin(np.abs(run - u))]
            time = motion.starts[piece] + at * motion.durations[piece]
            return {"piece": int(piece), "move": int(motion.moves[piece]), "time": float(time)}
    leg = stretch.leg if stretch.leg is not None else motion.corners[stretch.corner or 0].leg
    return {"move": motion.legs[leg].move}


def _judge_claim(
    motion: MotionFile, name: str, worst: Worst, tolerance: float, verdict: Verdict
) -> None:
    claim = float(motion.certificate[name])
    reached = float(worst.reached.max(initial=0.0))
    if claim < reached - CLAIM_SLACK:
        verdict.findings.append(
            Finding(
                f"the certificate's {name} is below what is reached", value=claim, limit=reached
            )
        )
    elif claim > tolerance * (1.0 + 1e-9):
        verdict.findings.append(
            Finding(
                f"the certificate's {name} is beyond the tolerance", value=claim, limit=tolerance
            )
        )
