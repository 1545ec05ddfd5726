"""Speed and acceleration of the tool point, where the program asks for a limit of them."""

from __future__ import annotations

import numpy as np

from ._balls import Array, Ball, Indices
from ._chain import tool_point
from ._findings import Finding, Verdict
from ._jets import constant, differentiated, largest, polynomial_jets, product
from ._motion_file import MotionFile
from ._search import prove_below

SHARE_SLACK = 1e-6


def check_tool_rates(motion: MotionFile, verdict: Verdict) -> None:
    """Prove the limits at the tool of every piece that has one; in a corner both legs' count."""
    if motion.chain is None:
        return
    for order, name in ((1, "speed"), (2, "acceleration")):
        limits = np.array([_limit(motion, int(path), name) for path in motion.path_of])
        pieces = np.flatnonzero(np.isfinite(limits) & motion.paths[motion.path_of, 1:].any((1, 2)))
        if len(pieces) == 0:
            continue
        before = len(verdict.findings)
        rates = _Rates(motion, pieces, order, limits[pieces])
        worst = prove_below(rates.bounds, np.full(len(pieces), 1.0 + SHARE_SLACK))
        for item in np.flatnonzero(~worst.proven):
            piece = int(pieces[item])
            time = motion.starts[piece] + worst.at[item] * motion.durations[piece]
            verdict.findings.append(
                Finding(
                    f"the {name} at the tool is above what was asked for",
                    piece=piece,
                    move=int(motion.moves[piece]),
                    time=float(time),
                    value=float(worst.bound[item] * limits[piece]),
                    limit=float(limits[piece]),
                )
            )
        verdict.prove(
            f"{name} at the tool, % of what was asked for",
            f"{100 * worst.bound.max():.4f}",
            "100",
            before,
        )


def _legs_of(motion: MotionFile, path: int) -> list[int]:
    stretch = motion.stretches[path]
    if stretch.corner is not None:
        leg = motion.corners[stretch.corner].leg
        return [leg, leg + 1]
    return [] if stretch.leg is None else [stretch.leg]


def scales_of(motion: MotionFile) -> Array:
    """Share of the joints' limits that each piece may use, (k,)."""
    of_path = [
        min((motion.legs[leg].scale for leg in _legs_of(motion, i)), default=1.0)
        for i in range(len(motion.paths))
    ]
    scales: Array = np.array(of_path)[motion.path_of]
    return scales


def _limit(motion: MotionFile, path: int, name: str) -> float:
    wishes = [getattr(motion.legs[leg], name) for leg in _legs_of(motion, path)]
    return min((w for w in wishes if w is not None), default=np.inf)


class _Rates:
    def __init__(self, motion: MotionFile, pieces: Indices, order: int, limits: Array) -> None:
        self._motion = motion
        self._pieces = pieces
        self._order = order
        self._limits = limits

    def bounds(self, items: Indices, middle: Array, half: Array) -> tuple[Array, Array]:
        """Bound the rate over intervals of x, as a share of its limit."""
        motion = self._motion
        pieces = self._pieces[items]
        timing = np.moveaxis(motion.timing[pieces], 0, -1)[:, None, :]
        u = polynomial_jets(Ball.exact(timing), middle, half)
        rows = np.moveaxis(np.tile(motion.paths[motion.path_of[pieces]], (2, 1, 1)), 0, -1)
        q = constant(Ball.exact(rows[5]))
        for k in range(4, -1, -1):
            q = product(q, u) + constant(Ball.exact(rows[k]))
        tools = np.array(
            [motion.legs[_legs_of(motion, int(p))[0]].tool for p in motion.path_of[pieces]]
        )
        rate = np.tile(1.0 / (half * motion.durations[pieces]), 2)
        bound, reached = np.empty(len(items)), np.empty(len(items))
        for number in np.unique(tools):
            chosen = np.flatnonzero(tools == number)
            columns = np.concatenate([chosen, chosen + len(items)])
            jets = tool_point(motion.chain, motion.tools[number], q[..., columns])  # type: ignore[arg-type]
            for _ in range(self._order):
                jets = differentiated(jets, rate[columns])
            bound[chosen], reached[chosen] = largest(jets)
        limits = self._limits[items]
        return bound / limits, reached / limits
