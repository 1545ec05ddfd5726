"""Which joints an arm may have together."""

from __future__ import annotations

import numpy as np

from . import _core
from ._arguments import Vector
from .errors import BadArgumentError


def joint_envelope(limits: _core.JointLimits, first: int, second: int, at: Vector) -> Vector:
    """Clip the rectangle of two joints' limits by every coupled limit (Sutherland & Hodgman 1974).

    Returns
    -------
    ndarray, (k, 2)
        Corners of the convex polygon, in turn; (0, 2) where the others leave nothing.
    """
    pair = [first, second]
    low, high = limits.position_min[pair], limits.position_max[pair]
    if not (np.isfinite(low).all() and np.isfinite(high).all()):
        raise BadArgumentError(
            f"Joint {first + 1} or {second + 1} has no position limits, so it has no envelope.",
            ways_out=["Give limits: robot.with_limits(position_min=…, position_max=…)."],
        )
    corners = np.array([low, [high[0], low[1]], high, [low[0], high[1]]])
    others = np.array(at)
    others[pair] = 0.0
    for row, lower, upper in zip(
        limits.coupling, limits.coupling_lower, limits.coupling_upper, strict=True
    ):
        rest = float(row @ others)
        corners = _clip(corners, row[pair], upper - rest)
        corners = _clip(corners, -row[pair], rest - lower)
    return corners


def _clip(corners: Vector, normal: Vector, bound: float) -> Vector:
    """Keep the part of a convex polygon where normal @ corner <= bound."""
    kept: list[Vector] = []
    over = corners @ normal - bound
    for k, corner in enumerate(corners):
        before, value = over[k - 1], over[k]
        if (before > 0.0) != (value > 0.0):
            share = before / (before - value)
            kept.append(corners[k - 1] + share * (corner - corners[k - 1]))
        if value <= 0.0:
            kept.append(corner)
    return np.array(kept).reshape(-1, 2)
