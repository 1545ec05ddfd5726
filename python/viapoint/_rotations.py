"""Rotations spread evenly over all there are."""

from __future__ import annotations

import numpy as np

from ._arguments import Vector

_PHI = np.sqrt(2.0)
_PSI = 1.533751168755204288118041
"""The root of psi^4 = psi + 4 (Alexa 2022)."""


def even_rotations(count: int) -> Vector:
    """Return `count` rotation matrices, (count, 3, 3), by super-Fibonacci spirals (Alexa 2022)."""
    s = np.arange(count) + 0.5
    t = s / count
    inner, outer = np.sqrt(t), np.sqrt(1.0 - t)
    a, b = 2.0 * np.pi * s / _PHI, 2.0 * np.pi * s / _PSI
    x, y, z, w = inner * np.sin(a), inner * np.cos(a), outer * np.sin(b), outer * np.cos(b)
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    rotations: Vector = np.moveaxis(np.array(rows), -1, 0)
    return rotations
