"""Curves of the tool over a parameter s, as a motion file holds them, and their jets."""

from __future__ import annotations

from dataclasses import dataclass
from math import factorial

import numpy as np

from ._balls import ROUNDING, WIDER, Array, Ball, Indices, join
from ._chain import apply, column, quaternion
from ._jets import (
    ORDER,
    constant,
    differentiated,
    over_interval,
    product,
    sine_cosine_jets,
    split_jets,
)
from ._strict_json import MotionFileError

SERIES_TERMS = 16
LARGEST_TURN = 10.0
"""|φ|² that the series of an orientation spline holds for: beyond π² by little [rad²]."""


@dataclass(frozen=True)
class Line:
    """p = start + direction s."""

    start: Array
    direction: Array

    def breaks(self) -> Array:
        """Nowhere."""
        return np.empty(0)

    def jets(self, s: Ball, span: Indices) -> Ball:
        """Of the point, (p + 1, 3, N)."""
        del span
        return constant(Ball.exact(self.start[:, None])) + _times(self.direction, s)


@dataclass(frozen=True)
class Helix:
    """p = centre + cos θ radial + sin θ tangential + θ travel, with θ = rate s."""

    center: Array
    radial: Array
    tangential: Array
    travel: Array
    rate: float

    def breaks(self) -> Array:
        """Nowhere."""
        return np.empty(0)

    def jets(self, s: Ball, span: Indices) -> Ball:
        """Of the point, (p + 1, 3, N)."""
        del span
        angle = s.scaled(self.rate)
        sines, cosines = sine_cosine_jets(angle)
        round_about = _times(self.radial, cosines) + _times(self.tangential, sines)
        there = constant(Ball.exact(self.center[:, None])) + _times(self.travel, angle)
        return there + round_about


@dataclass(frozen=True)
class Quintics:
    """A chain of quintics: in span k Σ coefficients[k, j] ((s - start_k) / length_k)^j."""

    lengths: Array
    coefficients: Array

    @property
    def starts(self) -> Array:
        """Where each span begins, and where the last ends, (m + 1,)."""
        return np.concatenate([[0.0], np.cumsum(self.lengths)])

    def breaks(self) -> Array:
        """Where span meets span."""
        return self.starts[1:-1]

    def jets(self, s: Ball, span: Indices) -> Ball:
        """Of the point, (p + 1, d, N), each interval by the polynomial of its span."""
        both = np.tile(span, 2)
        start = constant(Ball.exact(self.starts[both][None]))
        # One rounding of the division, and those of the sum that is the start.
        u = (s - start) * Ball(1.0 / self.lengths[both], ROUNDING / self.lengths[both])
        u = Ball(u.mid, u.rad)
        u.rad[0] += ROUNDING * len(self.lengths) * self.starts[-1] / self.lengths[both]
        rows = np.moveaxis(self.coefficients[both], 0, -1)  # (6, d, 2 N)
        value = constant(Ball.exact(rows[5]))
        for k in range(4, -1, -1):
            value = product(value, u) + constant(Ball.exact(rows[k]))
        return value


@dataclass(frozen=True)
class SteadyTurn:
    """R = exp(rate s) start, the rate in the base frame."""

    start: Array
    rate: Array

    def breaks(self) -> Array:
        """Nowhere."""
        return np.empty(0)

    def jets(self, s: Ball, span: Indices) -> Ball:
        """Of the unit quaternion, (p + 1, 4, N)."""
        del span
        size = float(np.linalg.norm(self.rate))
        turn = column(quaternion(self.start))
        if size == 0.0:
            return constant(turn)
        axis = np.concatenate([[0.0], self.rate / size])
        sines, cosines = sine_cosine_jets(s.scaled(0.5 * size))
        sines = Ball(sines.mid, sines.rad + ROUNDING * np.abs(sines.mid))
        one = constant(Ball.exact(np.array([1.0, 0.0, 0.0, 0.0])[:, None]))
        return _right(product(cosines, one) + _times(axis, sines), turn[:, 0])


@dataclass(frozen=True)
class TurnSpline:
    """R = exp(φ(s)) base in every span, φ a chain of quintics."""

    vectors: Quintics
    bases: Array

    def breaks(self) -> Array:
        """Where span meets span."""
        return self.vectors.breaks()

    def jets(self, s: Ball, span: Indices) -> Ball:
        """Of the unit quaternion, (p + 1, 4, N)."""
        phi = self.vectors.jets(s, span)
        square = product(phi, phi)
        x = Ball(square.mid.sum(axis=1, keepdims=True), square.rad.sum(axis=1, keepdims=True))
        x = Ball(x.mid, (x.rad + ROUNDING * np.abs(square.mid).sum(1, keepdims=True)) * WIDER)
        # cos(√x/2) = Σ (-x/4)^k / (2k)!,  sin(√x/2)/√x = ½ Σ (-x/4)^k / (2k+1)!.
        cosine, sine = _series(x, 0), _series(x, 1).scaled(0.5)
        vector = product(sine, phi)
        turn = Ball(
            np.concatenate([np.broadcast_to(cosine.mid, x.mid.shape), vector.mid], axis=1),
            np.concatenate([np.broadcast_to(cosine.rad, x.mid.shape), vector.rad], axis=1),
        )
        both = np.tile(span, 2)
        out = Ball(np.empty_like(turn.mid), np.empty_like(turn.rad))
        for k in np.unique(both):
            chosen = both == k
            part = _right(turn[..., chosen], quaternion(self.bases[k]))
            out.mid[..., chosen], out.rad[..., chosen] = part.mid, part.rad
        return out


Position = Line | Helix | Quintics
Orientation = SteadyTurn | TurnSpline


def parameter_jets(start: Array, end: Array, middle: Array, half: Array) -> Ball:
    """Jets of s = start + u (end - start), u = middle + half t, (p + 1, 1, 2 N)."""
    mid = np.zeros((ORDER + 1, 1, len(start)))
    rad = np.zeros_like(mid)
    mid[0, 0] = start + middle * (end - start)
    mid[1, 0] = half * (end - start)
    size = np.abs(start) + np.abs(end)
    rad[0, 0], rad[1, 0] = ROUNDING * size, ROUNDING * size * half
    at_middle = Ball(mid, rad)
    over = over_interval(at_middle)
    return Ball(np.concatenate([mid, over.mid], axis=-1), np.concatenate([rad, over.rad], axis=-1))


def relative_turn(curve: Ball, tool: Ball) -> Ball:
    """Vector part of the quaternion from curve to tool, (p + 1, 3, N): sin(angle / 2) in size."""
    w, v = curve[:, :1], curve[:, 1:]
    a, b = tool[:, :1], tool[:, 1:]
    cross = _crossed(v, b)
    return product(w, b) - product(a, v) - cross


def angular_velocity(turn: Ball, rate: Array) -> Ball:
    """Jets of 2 (dQ/dt) Q*, base frame, (p, 3, N), from those of unit quaternions Q."""
    w, v = turn[:-1, :1], turn[:-1, 1:]
    slope = differentiated(turn, rate)
    a, b = slope[:, :1], slope[:, 1:]
    return (product(w, b) - product(a, v) - _crossed(b, v)).scaled(2.0)


def half_axis_off(curve: Ball, tool: Ball) -> Ball:
    """Half of what the z axes of two rotations differ by, (p + 1, 3, N), from their quaternions."""
    return (_z_axis(tool) - _z_axis(curve)).scaled(0.5)


def _z_axis(turn: Ball) -> Ball:
    w, x, y, z = (turn[:, i : i + 1] for i in range(4))
    rows = (
        (product(x, z) + product(w, y)).scaled(2.0),
        (product(y, z) - product(w, x)).scaled(2.0),
        constant(Ball.exact(np.ones((1, 1)))) - (product(x, x) + product(y, y)).scaled(2.0),
    )
    return join(list(rows), axis=1)


def _crossed(a: Ball, b: Ball) -> Ball:
    rows = []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        rows.append(
            product(a[:, j : j + 1], b[:, k : k + 1]) - product(a[:, k : k + 1], b[:, j : j + 1])
        )
    return Ball(
        np.concatenate([r.mid for r in rows], axis=1), np.concatenate([r.rad for r in rows], axis=1)
    )


def _times(vector: Array, scalar: Ball) -> Ball:
    mid = vector[:, None] * scalar.mid
    return Ball(mid, (np.abs(vector)[:, None] * scalar.rad + ROUNDING * np.abs(mid)) * WIDER)


def _right(turn: Ball, q: Ball) -> Ball:
    """Quaternion product with a fixed ball on the right of jets, by the conjugate of both."""
    flip = np.array([1.0, -1.0, -1.0, -1.0])
    conjugate = Ball(turn.mid * flip[:, None], turn.rad)
    product_ = apply(Ball(q.mid * flip, q.rad), conjugate)
    return Ball(product_.mid * flip[:, None], product_.rad)


def _series(x: Ball, odd: int) -> Ball:
    """Σ (-x/4)^k / (2k + odd)! for 0 <= x <= LARGEST_TURN."""
    at_middle, over = split_jets(x)
    if not (np.all(at_middle.size[0] <= LARGEST_TURN) and np.all(over.size[0] <= 4 * LARGEST_TURN)):
        raise MotionFileError("an orientation spline turns by more than half a turn in one span")
    y = x.scaled(-0.25)
    value = constant(Ball.exact(np.full((1, x.mid.shape[-1]), 1.0)))
    value = Ball(value.mid / factorial(2 * SERIES_TERMS + odd), value.rad)
    for k in range(SERIES_TERMS - 1, -1, -1):
        term = 1.0 / factorial(2 * k + odd)
        value = product(value, y) + constant(Ball(np.full((1, 1), term), np.full((1, 1), 1e-17)))
    # The terms left out: coefficients of y^k below 20^k in size, and 20^17 / 34! is below 1e-16.
    return Ball(value.mid, value.rad + 1e-15)
