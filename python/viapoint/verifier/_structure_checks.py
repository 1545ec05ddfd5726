"""Whether the parts of a file belong together: the robot, whole legs, corners between them."""

from __future__ import annotations

import struct

import numpy as np

from ._balls import Array
from ._findings import Finding, Verdict
from ._motion_file import MotionFile

MEET = 1e-9
"""Largest gap between stretches of a leg, by its length."""
WHOLE = 1e-8
"""Share of a path that rounding may leave out at its ends."""


def check_structure(motion: MotionFile, verdict: Verdict) -> bool:
    """Find what is missing, doubled or out of order.

    Returns
    -------
    fits : bool
        The parts belong together, so that the other checks have what to look at.
    """
    before = len(verdict.findings)
    wrong = [*_wrong_order(motion), *([] if motion.timed else _wrong_legs(motion))]
    verdict.findings += [Finding(what) for what in [*_wrong_robot(motion), *wrong]]
    verdict.prove("legs, corners and robot", "whole", "each leg from end to end", before)
    return not wrong


def fingerprint(motion: MotionFile) -> str:
    """FNV-1a of chain, tool and limits, as viapoint prints it (Fowler, Noll & Vo 1991)."""
    values: list[float] = []

    def add(matrix: Array) -> None:
        block = matrix if matrix.ndim == 2 else matrix[:, None]
        values.extend(map(float, block.shape))
        values.extend(block.T.ravel().tolist())

    tool = motion.tools[0]
    if motion.chain is not None:
        for slides, before, axis in zip(
            motion.chain.prismatic, motion.chain.before, motion.chain.axis, strict=True
        ):
            values.append(1.0 if slides else 0.0)
            add(before)
            add(axis)
    add(tool)
    limits = motion.limits
    for vector in (limits.position_min, limits.position_max, *limits.rates):
        add(vector)
    add(limits.coupling)
    add(limits.coupling_lower)
    add(limits.coupling_upper)
    found = 0xCBF29CE484222325
    for byte in struct.pack(f"<{len(values)}d", *values):
        found = ((found ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return f"{found:016x}"


def _wrong_robot(motion: MotionFile) -> list[str]:
    found = fingerprint(motion)
    if found == motion.fingerprint:
        return []
    return [
        f"the robot's fingerprint is {motion.fingerprint}, its chain, tool and limits have {found}"
    ]


def _wrong_order(motion: MotionFile) -> list[str]:
    steps = np.diff(motion.path_of)
    wrong = []
    if motion.path_of[0] != 0 or np.any((steps != 0) & (steps != 1)):
        wrong.append("the pieces do not run path after path")
    cut_off = [p for c in motion.corners for p in (*c.before, *c.after)]
    if sorted([*range(motion.path_of[-1] + 1), *cut_off]) != list(range(len(motion.paths))):
        wrong.append("a path is neither run nor cut off by one corner")
    return wrong or _wrong_ends(motion)


def _wrong_ends(motion: MotionFile) -> list[str]:
    wrong = []
    for p in [] if motion.timed else range(motion.path_of[-1] + 1):
        pieces = np.flatnonzero(motion.path_of == p)
        if not motion.paths[p, 1:].any():
            continue  # a rest
        begin, end = motion.timing[pieces[0], 0], motion.timing[pieces[-1]].sum()
        if abs(begin) > WHOLE or abs(end - 1.0) > WHOLE:
            wrong.append(f"path {p} is not run from its beginning to its end")
    return wrong


def _wrong_legs(motion: MotionFile) -> list[str]:
    wrong = []
    covered: list[list[tuple[float, float]]] = [[] for _ in motion.legs]
    for i, stretch in enumerate(motion.stretches):
        if stretch.leg is not None:
            covered[stretch.leg].append((stretch.start, stretch.end))
        elif stretch.corner is None and motion.paths[i, 1:].any():
            wrong.append(f"path {i} moves the arm and belongs to no leg and no corner")
    for i, (leg, stretches) in enumerate(zip(motion.legs, covered, strict=True)):
        end = 0.0
        for start, stop in sorted(stretches):
            if abs(start - end) > MEET * leg.length:
                break
            end = stop
        else:
            if abs(end - leg.length) <= MEET * leg.length:
                continue
        wrong.append(f"leg {i} (move {leg.move}) is not run from its beginning to its end")
    return wrong + _wrong_sequence(motion) + _wrong_corners(motion)


def _wrong_sequence(motion: MotionFile) -> list[str]:
    """Legs in order, each forwards; a corner after the leg it ends and before the next."""
    at = (-1.0, -1.0)
    for i in range(motion.path_of[-1] + 1):
        stretch = motion.stretches[i]
        if stretch.leg is not None:
            here = (float(stretch.leg), stretch.start)
        elif stretch.corner is not None:
            here = (motion.corners[stretch.corner].leg + 0.5, 0.0)
        else:
            continue
        if here < at:
            return [f"path {i} runs before one that comes after it on its leg"]
        at = here
    return []


def _ends_its_leg(motion: MotionFile, leg: int, end: float) -> bool:
    length = motion.legs[leg].length
    return abs(end - length) <= MEET * length


def _wrong_corners(motion: MotionFile) -> list[str]:
    wrong = []
    run = {s.corner for s in motion.stretches if s.corner is not None}
    for k, corner in enumerate(motion.corners):
        if corner.stopped:
            if k in run or corner.before or corner.after:
                wrong.append(f"corner {k} is a stop and has paths")
            continue
        ends = [motion.stretches[p] for p in corner.before]
        begins = [motion.stretches[p] for p in corner.after]
        whole = (
            k in run
            and all(s.leg == corner.leg for s in ends)
            and all(s.leg == corner.leg + 1 for s in begins)
            and bool(ends)
            and bool(begins)
            and _ends_its_leg(motion, corner.leg, ends[-1].end)
        )
        if not whole:
            wrong.append(f"corner {k} lacks a path, or cuts off what is no part of its legs")
        elif corner.used > corner.asked * (1.0 + 1e-9):
            wrong.append(f"corner {k} claims to use more than its zone")
        elif motion.legs[corner.leg].tool != motion.legs[corner.leg + 1].tool:
            wrong.append(f"corner {k} lies between legs of different tools")
    return wrong
