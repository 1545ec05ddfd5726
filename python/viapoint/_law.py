"""What the functions of `viapoint.profile` return: one axis or several as functions of time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple, TypeVar

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, numbers_of
from .errors import BadArgumentError, MotionError

AxisLaw = _core.profile.AxisLaw
Made = TypeVar("Made")


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
    """One polynomial of a law: the sum of ``coefficients[k] * (t - start)**k``."""

    start: float
    end: float
    coefficients: Vector


class Law:
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

        Parameters
        ----------
        derivative : int
            0 for q, 1 for qd, 2 for qdd, 3 for qddd.

        Raises
        ------
        BadArgumentError
            Another derivative.
        """
        rows = np.array([axis.extremes(derivative) for axis in self._axes])
        low, low_time, high, high_time = (rows[:, k].reshape(self.shape) for k in range(4))
        return Extremes(low, low_time, high, high_time)

    def parts(self, axis: int = 0) -> list[Part]:
        """Return the polynomials of one axis, in order of time."""
        return [
            Part(start, end, np.array(coefficients))
            for start, end, coefficients in self._axes[axis].parts()
        ]

    def __repr__(self) -> str:
        """Name the kind, the axes and the time."""
        return (
            f"<{type(self).__name__} of {len(self._axes)} axes, {self.start:g} to {self.end:g} s>"
        )


class Trapezoid(Law):
    """A law with a ramp, a cruise and a ramp of velocity.

    Attributes
    ----------
    velocity : ndarray, () or (n,)
        Of the linear part, signed [1/s].
    acceleration : ndarray, () or (n,)
        Of the first blend, signed [1/s²].
    blend_time : ndarray, () or (n,)
        Of each of the two blends [s].
    """

    def __init__(self, axes: Sequence[_core.profile.Trapezoid], shape: tuple[int, ...]) -> None:
        super().__init__([axis.law for axis in axes], shape)
        self.velocity = np.array([axis.velocity for axis in axes]).reshape(shape)
        self.acceleration = np.array([axis.acceleration for axis in axes]).reshape(shape)
        self.blend_time = np.array([axis.blend_time for axis in axes]).reshape(shape)


class BlendedLines(Law):
    """Linear segments with a parabolic blend at each of k points.

    Attributes
    ----------
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

    def __init__(self, axes: Sequence[_core.profile.BlendedLines], shape: tuple[int, ...]) -> None:
        super().__init__([axis.law for axis in axes], shape)

        def table(columns: list[list[float]]) -> Vector:
            rows = np.array(columns).T
            return rows.reshape(rows.shape[:1] + shape)

        self.durations = np.array(axes[0].durations)
        self.blend_acceleration = table([axis.blend_acceleration for axis in axes])
        self.blend_time = table([axis.blend_time for axis in axes])
        self.linear_velocity = table([axis.linear_velocity for axis in axes])
        self.linear_time = table([axis.linear_time for axis in axes])


def for_each_axis(shape: tuple[int, ...], make: Callable[[int], Made]) -> list[Made]:
    """Call ``make(axis)`` for every axis; a refusal says which axis it is about.

    Raises
    ------
    MotionError
        As raised by `make`, with ``joint`` set where there are several axes.
    """
    made = []
    for axis in range(shape[0] if shape else 1):
        try:
            made.append(make(axis))
        except MotionError as error:
            if not shape:
                raise
            raise type(error)(
                f"axis {axis}: {error.message}",
                ways_out=error.ways_out,
                joint=axis,
                value=error.value,
                limit=error.limit,
            ) from None
    return made


def boundary_values(**values: ArrayLike) -> tuple[tuple[int, ...], dict[str, Vector]]:
    """Bring boundary values to one shape, () or (n,), and return it with them, each (n,).

    Raises
    ------
    BadArgumentError
        Shapes that do not go together, more than one dimension, no axis, NaN.
    """
    arrays = {name: numbers_of(value, name) for name, value in values.items()}
    for name, array in arrays.items():
        if array.ndim > 1 or array.size == 0:
            raise BadArgumentError(f"{name} has the shape {array.shape}; it must be () or (n,).")
    try:
        together = np.broadcast_arrays(*arrays.values())
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise BadArgumentError(
            f"the shapes {shapes} do not go together; give every value once, or once an axis."
        ) from None
    return together[0].shape, {
        name: np.atleast_1d(array) for name, array in zip(arrays, together, strict=True)
    }


def point_columns(points: ArrayLike, name: str = "points") -> tuple[tuple[int, ...], Vector]:
    """Return the shape of one point, () or (n,), and the points as (k, n).

    Raises
    ------
    BadArgumentError
        Not (k,) or (k, n) finite numbers.
    """
    array = numbers_of(points, name)
    if array.ndim not in (1, 2) or array.size == 0:
        raise BadArgumentError(f"{name} has the shape {array.shape}; it must be (k,) or (k, n).")
    shape: tuple[int, ...] = array.shape[1:]
    return shape, array.reshape(array.shape[0], -1)


def values_by_axis(value: ArrayLike, name: str, shape: tuple[int, ...], rows: int) -> list[Vector]:
    """Return for each axis what the core takes: (1,), or (rows,).

    Raises
    ------
    BadArgumentError
        Neither one value, nor one an axis, nor one an axis and row.
    """
    array = numbers_of(value, name)
    axes = shape[0] if shape else 1
    if array.ndim == 0:
        return [array.reshape(1)] * axes
    if array.shape == (rows, *shape):
        return list(array.reshape(rows, axes).T)
    if shape and array.shape == shape:
        return list(array.reshape(axes, 1))
    allowed = "(), " + (f"{shape} or " if shape else "") + f"{(rows, *shape)}"
    raise BadArgumentError(f"{name} has the shape {array.shape}; it must be {allowed}.")
