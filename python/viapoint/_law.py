"""What the functions of `viapoint.profile` return: one axis or several as functions of time."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, integer, number, numbers_of
from ._drawn import Drawn
from .errors import BadArgumentError

AxisLaw = _core.profile.AxisLaw


class State(NamedTuple):
    """Position and its derivatives, all of one shape [rad or m, per s, s², s³]."""

    q: Vector
    qd: Vector
    qdd: Vector
    qddd: Vector


class Extremes(NamedTuple):
    """Smallest and largest value of a quantity over a law, and when; shape () or (n,)."""

    low: Vector
    low_time: Vector
    high: Vector
    high_time: Vector


class Part(NamedTuple):
    """One polynomial of a law: the sum of ``coefficients[k] * (t - start)**k``.

    There are six coefficients, or more where the degree is above five.
    """

    start: float
    end: float
    coefficients: Vector


class Law(Drawn):
    """The course of one axis, or of n axes at once, over time.

    Attributes
    ----------
    start, end, duration : float
        [s]
    shape : tuple of int
        ``()`` for one axis given as a plain number, ``(n,)`` for axes given as arrays.
    """

    def __init__(self, axes: Sequence[AxisLaw], shape: tuple[int, ...]) -> None:
        self._axes = tuple(axes)
        self.shape = shape
        self.start = self._axes[0].start
        self.end = self._axes[0].end

    @property
    def duration(self) -> float:
        """From start to end [s]."""
        return self.end - self.start

    def at(self, t: ArrayLike) -> State:
        """Position and derivatives at one time or at many.

        Parameters
        ----------
        t : float or array_like, (k,)
            Times in ``[start, end]`` [s]; where two parts meet, the later one counts.

        Returns
        -------
        State
            Each field of shape ``shape`` for one time, ``(k, *shape)`` for many.

        Raises
        ------
        BadArgumentError
            A time outside the law, NaN, or an array of more than one dimension.
        """
        times = numbers_of(t, "t")
        if times.ndim > 1:
            raise BadArgumentError(f"t has the shape {times.shape}; it must be () or (k,).")
        rows = np.stack([axis.sample(np.atleast_1d(times)) for axis in self._axes], axis=1)
        q, qd, qdd, qddd = (rows[..., k].reshape(times.shape + self.shape) for k in range(4))
        return State(q, qd, qdd, qddd)

    def extremes(self, derivative: int = 0) -> Extremes:
        """Smallest and largest value over the whole law, found exactly and not on samples.

        They lie at the ends of the law's polynomials and at the real roots of the next derivative
        inside them.

        Parameters
        ----------
        derivative : int
            0 for q, 1 for qd, 2 for qdd, 3 for qddd.

        Raises
        ------
        BadArgumentError
            Another derivative.
        """
        order = integer(derivative, "derivative", 0, 3)
        rows = np.array([axis.extremes(order) for axis in self._axes])
        low, low_time, high, high_time = (rows[:, k].reshape(self.shape) for k in range(4))
        return Extremes(low, low_time, high, high_time)

    def starting_at(self, t0: float) -> Law:
        """Return the same course begun at another time.

        Parameters
        ----------
        t0 : float
            When it begins [s].

        Raises
        ------
        BadArgumentError
            NaN or infinity, or a time so far from 0 that a clock of doubles cannot tell the law's
            parts apart.
        """
        later = number(t0, "t0", "s") - self.start
        return Law([axis.delayed(later) for axis in self._axes], self.shape)

    def parts(self, axis: int = 0) -> list[Part]:
        """Return the polynomials of one axis, in order of time.

        Raises
        ------
        BadArgumentError
            No such axis.
        """
        index = integer(axis, "axis", 0, len(self._axes) - 1)
        return [
            Part(start, end, _without_high_zeros(np.array(coefficients)))
            for start, end, coefficients in self._axes[index].parts()
        ]

    def __repr__(self) -> str:
        """Name the kind, the axes and the time."""
        return (
            f"<{type(self).__name__} of {len(self._axes)} axes, {self.start:g} to {self.end:g} s>"
        )


def _without_high_zeros(coefficients: Vector) -> Vector:
    """Keep at least the six of a quintic, so that the parts of a law stack."""
    top = int(np.flatnonzero(coefficients)[-1]) if coefficients.any() else 0
    return coefficients[: max(6, top + 1)]


class Trapezoid(Law):
    """A law with a ramp, a cruise and a ramp of velocity.

    Attributes
    ----------
    velocity : ndarray, () or (n,)
        Of the linear part, signed [1/s].
    acceleration : ndarray, () or (n,)
        Of the first blend, signed [1/s²].
    blend_time : ndarray, () or (n,)
        Of each of the two blends [s]; 0 for an axis that does not move.
    """

    def __init__(
        self,
        axes: Sequence[AxisLaw],
        shape: tuple[int, ...],
        numbers: Sequence[tuple[float, float, float]],
    ) -> None:
        super().__init__(axes, shape)
        velocity, acceleration, blend_time = np.array(numbers).T
        self.velocity = velocity.reshape(shape)
        self.acceleration = acceleration.reshape(shape)
        self.blend_time = blend_time.reshape(shape)


class BlendedLines(Law):
    """Linear segments with a parabolic blend at each of k points.

    Where points are gone through, each of them counts as its two pseudo via points.

    Attributes
    ----------
    points : ndarray, (k,) or (k, n)
        That the lines aim at.
    point_times : ndarray, (k,)
        [s]
    durations : ndarray, (k - 1,)
        From point to point [s].
    blend_acceleration : ndarray, (k,) or (k, n)
        Signed; 0 where there is nothing to blend [1/s²].
    blend_time : ndarray, (k,) or (k, n)
        [s]
    linear_velocity : ndarray, (k - 1,) or (k - 1, n)
        Signed [1/s].
    linear_time : ndarray, (k - 1,) or (k - 1, n)
        [s]
    """

    def __init__(
        self,
        axes: Sequence[_core.profile.BlendedLines],
        shape: tuple[int, ...],
        points: Vector,
    ) -> None:
        super().__init__([axis.law for axis in axes], shape)

        def table(columns: list[list[float]]) -> Vector:
            rows = np.array(columns).T
            return rows.reshape(rows.shape[:1] + shape)

        self.points = points
        self.durations = np.array(axes[0].durations)
        self.point_times = np.concatenate([[0.0], np.cumsum(self.durations)])
        self.blend_acceleration = table([axis.blend_acceleration for axis in axes])
        self.blend_time = table([axis.blend_time for axis in axes])
        self.linear_velocity = table([axis.linear_velocity for axis in axes])
        self.linear_time = table([axis.linear_time for axis in axes])
