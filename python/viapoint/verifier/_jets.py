"""Taylor coefficients with a proven error, and a bound of a function over an interval from them.

A jet holds f_0 … f_p of f(t) = Σ f_k t^k, as balls, along its first axis. At the middle of an
interval |t| <= 1 all but the last are sharp; with balls that hold the coefficients about *every*
point of the interval, the last bounds the remainder (Moore 1966, §11; Taylor's theorem):
f(t) lies in Σ_{k<p} f_k t^k + F_p t^p.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from math import comb

import numpy as np

from ._balls import (
    ROUNDING,
    TINY,
    WIDER,
    Array,
    Ball,
    join,
    norm_bound,
    norm_reached,
    sine_cosine,
)

ORDER = 6
"""p: remainders shrink with the seventh power of an interval's width, about."""


def polynomial_jets(coefficients: Ball, middle: Array, half: Array) -> Ball:
    """Jets of polynomials of u, with u = middle + half t.

    Parameters
    ----------
    coefficients : Ball, (6, n, N)
        Of u^k, for N intervals.
    middle, half : (N,)
        Of each interval; a negative half runs it backwards.

    Returns
    -------
    Ball, (ORDER + 1, n, 2 N)
        At the middles, then over the whole intervals.
    """
    degree = len(coefficients.mid) - 1
    shape = (ORDER + 1, *coefficients.mid.shape[1:])
    mid, rad = np.zeros(shape), np.zeros(shape)
    size = np.abs(coefficients.mid)
    reach, width = np.abs(middle), np.abs(half)
    for j in range(min(degree, ORDER) + 1):
        scale = half**j
        for k in range(j, degree + 1):
            mid[j] += comb(k, j) * coefficients.mid[k] * middle ** (k - j) * scale
            rad[j] += (
                comb(k, j)
                * (coefficients.rad[k] + 2.0 * ROUNDING * size[k])
                * reach ** (k - j)
                * width**j
            )
    at_middle = Ball(mid, rad * WIDER + TINY)
    return join([at_middle, over_interval(at_middle)], axis=-1)


def over_interval(jets: Ball) -> Ball:
    """Hold the coefficients of polynomials about every |t| <= 1, from those about 0."""
    wide = jets.rad.copy()
    size = jets.size
    for j in range(len(jets.mid)):
        for k in range(j + 1, len(jets.mid)):
            wide[j] += comb(k, j) * size[k]
    return Ball(jets.mid, wide * WIDER)


def constant(values: Ball) -> Ball:
    """Jets of what does not change."""
    mid = np.zeros((ORDER + 1, *values.mid.shape))
    rad = np.zeros_like(mid)
    mid[0], rad[0] = values.mid, values.rad
    return Ball(mid, rad)


def _convolved(a: Array, b: Array) -> Array:
    shape = np.broadcast_shapes(a.shape, b.shape)
    out = np.zeros(shape)
    for i in range(len(a)):
        out[i:] += a[i] * b[: len(a) - i]
    return out


def product(a: Ball, b: Ball) -> Ball:
    """Multiply jets; what follows the first axis is broadcast."""
    size = np.abs(b.mid)
    rad = _convolved(np.abs(a.mid), b.rad + ROUNDING * size) + _convolved(a.rad, size + b.rad)
    return Ball(_convolved(a.mid, b.mid), rad * WIDER + TINY)


def sine_cosine_jets(angle: Ball) -> tuple[Ball, Ball]:
    """Sine and cosine of jets: s' = c a', c' = -s a', coefficient by coefficient."""
    sines, cosines = sine_cosine(angle[0])
    mid = np.zeros((2, *angle.mid.shape))
    rad = np.zeros_like(mid)
    mid[:, 0], rad[:, 0] = (sines.mid, cosines.mid), (sines.rad, cosines.rad)
    slope = np.arange(ORDER + 1.0).reshape(-1, *[1] * (angle.mid.ndim - 1))
    for k in range(1, ORDER + 1):
        # Σ_j (j / k) a_j times the other function's coefficient k - j, j from 1 to k.
        a = slope[1 : k + 1] * angle.mid[1 : k + 1] / k
        wide = slope[1 : k + 1] * angle.rad[1 : k + 1] / k
        other, blur = mid[::-1, :k][:, ::-1], rad[::-1, :k][:, ::-1]
        size = np.abs(other)
        mid[:, k] = np.sum(a * other, axis=1)
        mid[1, k] *= -1.0
        spread = np.abs(a) * (blur + ROUNDING * size) + wide * (size + blur)
        rad[:, k] = np.sum(spread, axis=1) * WIDER + TINY
    return Ball(mid[0], rad[0]), Ball(mid[1], rad[1])


def linear(matrix: Array, vectors: Ball) -> Ball:
    """Multiply vectors along the second axis by an exact matrix."""
    size = np.abs(matrix)
    mid = np.einsum("ij,kj...->ki...", matrix, vectors.mid)
    rad = np.einsum("ij,kj...->ki...", size, vectors.rad + ROUNDING * np.abs(vectors.mid))
    return Ball(mid, rad * WIDER + TINY)


@lru_cache
def _control_matrix(degree: int) -> Array:
    """From coefficients of t^k to control points on [-1, 1] (Bernstein form)."""
    exact = [[Fraction(0)] * (degree + 1) for _ in range(degree + 1)]
    for k in range(degree + 1):
        # t = 2 x - 1 in powers of x, then each power by its control points.
        for j in range(k + 1):
            weight = comb(k, j) * 2**j * (-1) ** (k - j)
            for i in range(j, degree + 1):
                exact[i][k] += Fraction(weight * comb(i, j), comb(degree, j))
    return np.array([[float(entry) for entry in row] for row in exact])


def split_jets(jets: Ball) -> tuple[Ball, Ball]:
    """Part what polynomial_jets joined: at the middles, and over the intervals."""
    count = jets.mid.shape[-1] // 2
    return jets[..., :count], jets[..., count:]


def differentiated(jets: Ball, rate: Array) -> Ball:
    """Jets of the derivative, one order shorter; `rate` (N,) is dt by what it is taken by."""
    factor = np.arange(1.0, len(jets.mid))[:, None, None] * rate
    mid = jets.mid[1:] * factor
    return Ball(mid, (jets.rad[1:] * np.abs(factor) + ROUNDING * np.abs(mid)) * WIDER)


def largest(jets: Ball) -> tuple[Array, Array]:
    """Bound the norm of vectors over |t| <= 1, and tell what it reaches.

    A norm is convex: the control points of the polynomial below the last order hold it.

    Parameters
    ----------
    jets : Ball, (order + 1, d, 2 N)
        At the middles, then over the intervals.

    Returns
    -------
    tuple of ndarray, (N,) each
        Never passed, and reached for certain (in the middle).
    """
    at_middle, over = split_jets(jets)
    order = len(jets.mid) - 1
    matrix = _control_matrix(order - 1)
    mid = np.einsum("ik,k...->i...", matrix, at_middle.mid[:order])
    size = at_middle.rad[:order] + ROUNDING * np.abs(at_middle.mid[:order])
    points = Ball(mid, np.einsum("ik,k...->i...", np.abs(matrix), size) * WIDER)
    bound = (norm_bound(points, axis=1).max(axis=0) + norm_bound(over[order], axis=0)) * WIDER
    return bound, norm_reached(at_middle[0], axis=0)
