"""How the laws of one axis are laid over several: shapes in, one call an axis, refusals by axis."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np

from ._arguments import ArrayLike, Vector, numbers_of
from .errors import BadArgumentError, MotionError

Made = TypeVar("Made")


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


def one_an_axis(value: ArrayLike, name: str, shape: tuple[int, ...]) -> Vector:
    """Return one value an axis, (n,) or (1,), from one for all or one each.

    Raises
    ------
    BadArgumentError
        Another shape, or values that are not finite.
    """
    array = numbers_of(value, name)
    if array.shape not in ((), shape):
        allowed = f"() or {shape}" if shape else "()"
        raise BadArgumentError(f"{name} has the shape {array.shape}; it must be {allowed}.")
    return np.broadcast_to(array, shape or (1,))
