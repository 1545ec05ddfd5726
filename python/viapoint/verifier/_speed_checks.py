"""Rates of the tool, linear and angular, where the program asks for a limit of them."""

from __future__ import annotations

import numpy as np

from ._balls import Array, Ball, Indices
from ._chain import tool_point, tool_rotation
from ._curves import angular_velocity
from ._file_parts import TOOL_RATES
from ._findings import Finding, Verdict
from ._jets import constant, differentiated, largest, polynomial_jets, product
from ._motion_file import MotionFile
from ._search import prove_below

SHARE_SLACK = 1e-6
CLAIM_SLACK = 1e-8
"""Of a claimed share below what is reached."""


def check_tool_rates(motion: MotionFile, verdict: Verdict) -> None:
    """Prove the limits at the tool of every piece that has one; in a corner both legs' count."""
    if motion.chain is None:
        return
    for name in TOOL_RATES:
        limits = np.array([_limit(motion, int(path), name) for path in motion.path_of])
        pieces = np.flatnonzero(np.isfinite(limits) & motion.paths[motion.path_of, 1:].any((1, 2)))
        if len(pieces) == 0:
            continue
        before = len(verdict.findings)
        rates = _Rates(motion, pieces, name, limits[pieces])
        worst = prove_below(rates.bounds, np.full(len(pieces), 1.0 + SHARE_SLACK))
        what = name.replace("_", " ")
        for item in np.flatnonzero(~worst.proven):
            piece = int(pieces[item])
            time = motion.starts[piece] + worst.at[item] * motion.durations[piece]
            verdict.findings.append(
                Finding(
                    f"the {what} of the tool is above what was asked for",
                    piece=piece,
                    move=int(motion.moves[piece]),
                    time=float(time),
                    value=float(worst.bound[item] * limits[piece]),
                    limit=float(limits[piece]),
                )
            )
        claim, reached = motion.certificate["tool"][name]["share"], float(worst.reached.max())
        if claim < reached * (1.0 - CLAIM_SLACK):
            verdict.findings.append(
                Finding(
                    f"the certificate claims less {what} of the tool than is reached, in shares",
                    value=claim,
                    limit=reached,
                )
            )
        verdict.prove(
            f"{what} of the tool, % of what was asked for",
            f"{100 * worst.bound.max():.4f}",
            "100, and as claimed",
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
    def __init__(self, motion: MotionFile, pieces: Indices, name: str, limits: Array) -> None:
        if motion.chain is None:
            raise ValueError("no chain")
        self._motion = motion
        self._chain = motion.chain
        self._pieces = pieces
        self._angular = name.startswith("angular")
        self._order = 2 if name.endswith("acceleration") else 1
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
            tool = motion.tools[number]
            if self._angular:
                turn = tool_rotation(self._chain, tool, q[..., columns])
                jets = angular_velocity(turn, rate[columns])
            else:
                jets = differentiated(tool_point(self._chain, tool, q[..., columns]), rate[columns])
            if self._order == 2:
                jets = differentiated(jets, rate[columns])
            bound[chosen], reached[chosen] = largest(jets)
        limits = self._limits[items]
        return bound / limits, reached / limits
