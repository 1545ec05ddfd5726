"""Joints over the time of a piece as one polynomial, and the proven largest value of polynomials.

A piece runs q(u(x)), a quintic in a quintic, x = time / duration in [0, 1]. Composed in powers of
x, differentiated, and brought into Bernstein form, whose control points hold it (Farin 2002, §5).
Halved where the largest is open, until bound and value agree.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from math import comb

import numpy as np

from ._balls import ROUNDING, TINY, WIDER, Array, Ball, Indices

DEGREE = 25
DEEPEST = 40
MOST_OPEN = 64
"""Parts for each polynomial that may be open at a time; those of a motion need a handful."""


def composed(path: Array, timing: Array) -> Ball:
    """Joints in powers of x.

    Parameters
    ----------
    path : ndarray, (k, 6, n)
        Of u^j for each of k pieces.
    timing : ndarray, (k, 6)
        Of x^j.

    Returns
    -------
    Ball, (k, n, 26)
    """
    coefficients = np.moveaxis(path, 1, -1)  # (k, n, 6)
    begin = timing[:, None, 0]
    shifted = []
    for j in range(6):
        mid = np.zeros(coefficients.shape[:2])
        size = np.zeros_like(mid)
        for k in range(j, 6):
            weight = comb(k, j) * begin ** (k - j)
            mid += weight * coefficients[..., k]
            size += np.abs(weight * coefficients[..., k])
        shifted.append(Ball(mid, ROUNDING * size * WIDER))
    rest = timing[:, None, :].copy()
    rest[..., 0] = 0.0
    size = np.abs(rest)
    mid = np.zeros((*coefficients.shape[:2], DEGREE + 1))
    rad = np.zeros_like(mid)
    mid[..., 0], rad[..., 0] = shifted[5].mid, shifted[5].rad
    for j in range(4, -1, -1):
        blurred = rad + ROUNDING * np.abs(mid)
        mid, rad = _times(mid, rest), _times(blurred, size) * WIDER + TINY
        mid[..., 0] += shifted[j].mid
        rad[..., 0] += shifted[j].rad
    return Ball(mid, rad)


def _times(a: Array, b: Array) -> Array:
    out = np.zeros_like(a)
    for j in range(1, 6):
        out[..., j:] += a[..., : DEGREE + 1 - j] * b[..., j : j + 1]
    return out


def derivative(polynomial: Ball, duration: Array) -> Ball:
    """By time, in powers of x. `duration` (k,) of the pieces along the first axis."""
    factor = np.arange(1.0, DEGREE + 1.0) / duration.reshape(-1, *[1] * (polynomial.mid.ndim - 1))
    mid = np.zeros_like(polynomial.mid)
    rad = np.zeros_like(mid)
    mid[..., :-1] = polynomial.mid[..., 1:] * factor
    rad[..., :-1] = polynomial.rad[..., 1:] * factor * WIDER + ROUNDING * np.abs(mid[..., :-1])
    return Ball(mid, rad)


def at_ends(polynomial: Ball) -> tuple[Ball, Ball]:
    """Values at x = 0 and x = 1."""
    mid = polynomial.mid.sum(axis=-1)
    size = np.abs(polynomial.mid).sum(axis=-1)
    rad = (polynomial.rad.sum(axis=-1) + ROUNDING * size) * WIDER
    return polynomial[..., 0], Ball(mid, rad)


def control_points(polynomial: Ball) -> tuple[Array, Array]:
    """Bernstein coefficients (..., 26), and what any of them may be off by, (...)."""
    points = polynomial.mid @ _bernstein().T
    size = np.abs(polynomial.mid).sum(axis=-1)
    off = (polynomial.rad.sum(axis=-1) + ROUNDING * size) * WIDER
    return points, off


@lru_cache
def _bernstein() -> Array:
    n = DEGREE
    return np.array([[comb(i, k) / comb(n, k) for k in range(n + 1)] for i in range(n + 1)])


@lru_cache
def _halves() -> tuple[Array, Array]:
    """De Casteljau at 1/2, as matrices."""
    n = DEGREE
    lower = np.array([[comb(i, j) / 2.0**i for j in range(n + 1)] for i in range(n + 1)])
    return lower, lower[::-1, ::-1].copy()


@dataclass
class Peaks:
    """The largest value of groups of polynomials, gathered call by call.

    Attributes
    ----------
    reached, bound : ndarray, (g,)
        A value that is taken for certain, and one that is never passed.
    row, x : ndarray, (g,)
        Where it is reached: the number of the polynomial's piece, and x within it.
    """

    groups: int
    gap: float
    reached: Array = field(init=False)
    bound: Array = field(init=False)
    row: Indices = field(init=False)
    x: Array = field(init=False)

    def __post_init__(self) -> None:
        """Begin with nothing."""
        self.reached = np.full(self.groups, -np.inf)
        self.bound = np.full(self.groups, -np.inf)
        self.row = np.zeros(self.groups, dtype=np.intp)
        self.x = np.zeros(self.groups)

    def raise_to(self, points: Array, off: Array, group: Indices, row: Indices) -> None:
        """Take polynomials in.

        Parameters
        ----------
        points : ndarray, (m, 26)
            Bernstein coefficients.
        off : ndarray, (m,)
            What they may be off by.
        group, row : ndarray, (m,)
            Which group each belongs to, and the number to tell it by.
        """
        begin, width = np.zeros(len(points)), 1.0
        most = MOST_OPEN * (len(points) + 16)
        for depth in range(DEEPEST + 1):
            self._look(points[:, 0] - off, begin, group, row)
            self._look(points[:, -1] - off, begin + width, group, row)
            hull = points.max(axis=1) + off
            decided = hull <= self.reached[group] + self.gap
            # Values far out of scale never come within the gap: work on them has an end.
            if depth == DEEPEST or len(points) > most:
                decided[:] = True
            np.maximum.at(self.bound, group[decided], hull[decided])
            keep = ~decided
            if not keep.any():
                break
            points, off, group, row = points[keep], off[keep], group[keep], row[keep]
            begin, width = begin[keep], 0.5 * width
            off = np.tile((off + ROUNDING * np.abs(points).max(axis=1)) * WIDER, 2)
            lower, upper = _halves()
            points = np.concatenate([points @ lower.T, points @ upper.T])
            begin = np.concatenate([begin, begin + width])
            group, row = np.tile(group, 2), np.tile(row, 2)

    def _look(self, values: Array, x: Array, group: Indices, row: Indices) -> None:
        best = self.reached.copy()
        np.maximum.at(best, group, values)
        better = np.flatnonzero((values >= best[group]) & (values > self.reached[group]))
        self.reached = best
        self.row[group[better]] = row[better]
        self.x[group[better]] = x[better]
