"""What every builder asks of its arguments: type, shape, finiteness and range, at once."""

from __future__ import annotations

import math
import numbers
import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from . import _core
from .errors import BadArgumentError, FileError, NotARotationError

Vector: TypeAlias = npt.NDArray[np.float64]
ArrayLike: TypeAlias = npt.ArrayLike

NOTEWORTHY_CORRECTION = 1e-6
"""A pose changed by less than this in every element was exact but for its last digits."""


def numbers_of(value: ArrayLike, name: str) -> Vector:
    """Return `value` as an array of finite floats, of any shape.

    Raises
    ------
    BadArgumentError
        Not numbers, or NaN or infinity among them; the message names `name` and the value.
    """
    try:
        raw = np.asarray(value)
        if raw.dtype.kind not in "iuf":
            raise TypeError
        with np.errstate(over="ignore"):  # wider floats may be infinite as doubles
            array = raw.astype(np.float64)
    except (TypeError, ValueError):
        raise BadArgumentError(f"{name} is {_short(value)}; it must hold numbers only.") from None
    if not np.isfinite(array).all():
        where = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
        place = f"{name}[{', '.join(map(str, where))}]" if where else name
        raise BadArgumentError(f"{place} is {array[where]}; every value must be finite.")
    return array


def vector(value: ArrayLike, name: str, size: int, meaning: str = "one value a joint") -> Vector:
    """Return `value` as (size,) finite floats.

    Raises
    ------
    BadArgumentError
        Another shape, NaN, infinity or no numbers.
    """
    array = numbers_of(value, name)
    if array.shape != (size,):
        raise BadArgumentError(
            f"{name} has the shape {array.shape}; it must be ({size},): {meaning}."
        )
    return array


def pose(value: ArrayLike, name: str) -> tuple[Vector, float]:
    """Return a (4, 4) pose with an exact rotation, and the largest element that was changed.

    Raises
    ------
    BadArgumentError
        Another shape, NaN, or a bottom row that is not 0 0 0 1.
    NotARotationError
        Farther from a rotation than rounding to two decimals can bring it.
    """
    array = numbers_of(value, name)
    if array.shape != (4, 4):
        raise BadArgumentError(f"{name} has the shape {array.shape}; a pose is (4, 4).")
    try:
        matrix, correction = _core.checked_pose(array)
    except NotARotationError as error:
        raise NotARotationError(f"{name}: {error.message}", ways_out=error.ways_out) from None
    except BadArgumentError as error:
        raise BadArgumentError(f"{name}: {error.message}", ways_out=error.ways_out) from None
    return matrix, float(correction)


def number(
    value: object,
    name: str,
    unit: str = "",
    *,
    above: float = -math.inf,
    least: float = -math.inf,
    most: float = math.inf,
) -> float:
    """Return `value` as a finite float in its range: > above, >= least, <= most.

    Raises
    ------
    BadArgumentError
        No number, NaN, infinity, or out of range; the message gives the range and the unit.
    """
    of_unit = f" {unit}" if unit else ""
    allowed = []
    if above > -math.inf:
        allowed.append(f"above {shown(above)}{of_unit}")
    if least > -math.inf:
        allowed.append(f"at least {shown(least)}{of_unit}")
    if most < math.inf:
        allowed.append(f"at most {shown(most)}{of_unit}")
    what = "it must be a finite number" + (", " + " and ".join(allowed) if allowed else "")
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, numbers.Real):
        raise BadArgumentError(f"{name} is {_short(value)}; {what}.")
    try:
        result = float(value)
    except OverflowError:  # an integer of hundreds of digits
        raise BadArgumentError(f"{name} is {_short(value)}{of_unit}; {what}.") from None
    if not math.isfinite(result) or result <= above or result < least or result > most:
        raise BadArgumentError(f"{name} is {shown(result)}{of_unit}; {what}.")
    return result


def shown(value: float) -> str:
    """Return the shortest text that reads back to `value`: what differs never looks alike."""
    return repr(float(value)).removesuffix(".0")


def integer(value: object, name: str, least: int, most: int) -> int:
    """Return `value` as an int in [least, most].

    Raises
    ------
    BadArgumentError
        Not an integer, or out of range.
    """
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, numbers.Integral):
        raise BadArgumentError(
            f"{name} is {_short(value)}; it must be an integer from {least} to {most}."
        )
    if not least <= int(value) <= most:
        raise BadArgumentError(f"{name} is {_short(value)}; it must be from {least} to {most}.")
    return int(value)


def choice(value: object, name: str, allowed: tuple[str, ...]) -> str:
    """Return `value`, one of the allowed words.

    Raises
    ------
    BadArgumentError
        Another word; the message lists the allowed ones.
    """
    if isinstance(value, str) and value in allowed:
        return value
    words = ", ".join(f'"{word}"' for word in allowed)
    raise BadArgumentError(f"{name} is {_short(value)}; it must be one of {words}.")


def file_name(path: object) -> str:
    """Return the name of a file.

    Raises
    ------
    BadArgumentError
        Neither text nor a path of text.
    """
    name = os.fspath(path) if isinstance(path, os.PathLike) else path
    if not isinstance(name, str):
        raise BadArgumentError(f"path is {_short(path)}; it must be the name of a file.")
    return name


@contextmanager
def writing(path: str | os.PathLike[str]) -> Iterator[None]:
    """Name the file in what the system says against writing it.

    Raises
    ------
    FileError
        With the path and the system's reason.
    """
    name = file_name(path)
    if "\0" in name:
        raise FileError(
            f"{name!r} cannot be written: the name of a file cannot hold a NUL character.",
            file=name.replace("\0", "\\0"),
            ways_out=["Give the name without it."],
        )
    try:
        yield
    except OSError as error:
        raise FileError(
            f"{name} cannot be written: {error.strerror or error}.",
            file=name,
            ways_out=["Give a file in a folder that exists and may be written to."],
        ) from error


def _short(value: object) -> str:
    try:
        text = repr(value)
    except ValueError:  # Python does not write integers of thousands of digits
        text = f"a {type(value).__name__} too long to write"
    return text if len(text) <= 60 else text[:57] + "..."
