"""Numbers with a proven error: a middle and a radius that holds the truth, in arrays.

Rounding is counted by the standard model (Higham 2002, §3.1): a sum of at most 60 products is off
by at most 64 ε of the sum of their sizes. Radii are themselves rounded, so each is widened by more
than their rounding can be. Middle and radius: Rump (1999).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]

ROUNDING = 64 * 2.0**-53
"""Of a sum of at most 60 products, by the sum of their sizes."""
WIDER = 1.0 + 1e-12
"""Rounding of radii: of sums of up to thousands of positive terms."""
TINY = 1e-290
"""Above what underflow can lose anywhere."""
FUNCTION = 64 * 2.0**-53
"""Absolute error of sine and cosine, of which numpy's are exact to 4 units in the last place."""


@dataclass(frozen=True)
class Ball:
    """Every true value lies within `rad` of `mid`; both of one shape."""

    mid: Array
    rad: Array

    @classmethod
    def exact(cls, values: npt.ArrayLike) -> Ball:
        """Numbers that are what they are."""
        mid = np.asarray(values, dtype=np.float64)
        return cls(mid, np.zeros_like(mid))

    def __add__(self, other: Ball) -> Ball:
        """Sum, element by element."""
        mid = self.mid + other.mid
        return Ball(mid, (self.rad + other.rad + ROUNDING * np.abs(mid)) * WIDER)

    def __sub__(self, other: Ball) -> Ball:
        """Difference, element by element."""
        return self + Ball(-other.mid, other.rad)

    def __mul__(self, other: Ball) -> Ball:
        """Product, element by element."""
        mid = self.mid * other.mid
        size = np.abs(self.mid)
        rad = (size + self.rad) * other.rad + self.rad * np.abs(other.mid)
        return Ball(mid, (rad + ROUNDING * np.abs(mid)) * WIDER + TINY)

    def __getitem__(self, key: Any) -> Ball:  # noqa: ANN401  # what numpy takes
        """Part of the arrays."""
        return Ball(self.mid[key], self.rad[key])

    def scaled(self, factor: npt.ArrayLike) -> Ball:
        """Multiply by an exact number."""
        return self * Ball.exact(np.broadcast_to(factor, self.mid.shape))

    @property
    def size(self) -> Array:
        """Upper bound of the magnitude."""
        bound: Array = (np.abs(self.mid) + self.rad) * WIDER
        return bound

    @property
    def least(self) -> Array:
        """Lower bound of the magnitude."""
        bound: Array = np.maximum(np.abs(self.mid) * (2.0 - WIDER) - self.rad * WIDER, 0.0)
        return bound


def stack(balls: list[Ball], axis: int) -> Ball:
    """Join along a new axis."""
    return Ball(
        np.stack([b.mid for b in balls], axis=axis), np.stack([b.rad for b in balls], axis=axis)
    )


def join(balls: list[Ball], axis: int) -> Ball:
    """Join along an axis that is there."""
    return Ball(
        np.concatenate([b.mid for b in balls], axis=axis),
        np.concatenate([b.rad for b in balls], axis=axis),
    )


def sine_cosine(angle: Ball) -> tuple[Ball, Ball]:
    """Sine and cosine; neither changes faster than its angle."""
    rad = (np.minimum(angle.rad, 2.0) + FUNCTION) * WIDER
    return Ball(np.sin(angle.mid), rad), Ball(np.cos(angle.mid), rad)


def norm_bound(vectors: Ball, axis: int) -> Array:
    """Upper bound of the Euclidean norm along an axis."""
    bound: Array = np.sqrt(np.sum(vectors.size**2, axis=axis)) * WIDER
    return bound


def norm_reached(vectors: Ball, axis: int) -> Array:
    """Lower bound of the Euclidean norm along an axis."""
    bound: Array = np.sqrt(np.sum(vectors.least**2, axis=axis)) * (2.0 - WIDER)
    return bound
