"""JSON read without overlooking anything: what is not expected is an error that names its place."""

from __future__ import annotations

import json
import math
import re
from hashlib import sha256
from typing import Any, NoReturn

import numpy as np

from ._balls import Array

SEAL = re.compile(rb',\n"sha256": "([0-9a-f]{64})"\n}\n\Z')
LARGEST = 1e12
"""Of any number in a file: lengths, angles, times and rates are far below."""


class MotionFileError(ValueError):
    """A motion file that cannot be read: cut short, damaged, or with something unknown in it."""


def load(data: bytes) -> dict[str, Any]:
    """Check the seal of a file and parse it.

    Raises
    ------
    MotionFileError
        By what is wrong.
    """
    seal = SEAL.search(data)
    if seal is None:
        raise MotionFileError(
            'it is cut short, or never was sealed: it does not end in the key "sha256"'
        )
    if sha256(data[: seal.start()]).hexdigest().encode() != seal[1]:
        raise MotionFileError("its content does not match its seal: a byte of it was changed")
    try:
        document = json.loads(data, object_pairs_hook=_members, parse_constant=_refuse_constant)
    except json.JSONDecodeError as error:
        raise MotionFileError(f"it is no JSON: {error.msg} in line {error.lineno}") from None
    except UnicodeDecodeError:
        raise MotionFileError("it is no UTF-8 text") from None
    except RecursionError:
        raise MotionFileError("it is nested too deeply") from None
    except MotionFileError:
        raise
    except ValueError as error:  # an integer of more digits than Python takes
        raise MotionFileError(str(error)) from None
    if not isinstance(document, dict):
        raise MotionFileError("it holds no object")
    del document["sha256"]
    return document


def seal(text: str) -> bytes:
    """Close the text of an object, all but its last brace, with the seal."""
    data = text.encode()
    return data + b',\n"sha256": "' + sha256(data).hexdigest().encode() + b'"\n}\n'


def refuse(place: str, reason: str) -> NoReturn:
    """Raise the error of a place."""
    raise MotionFileError(f"{place}: {reason}")


def members(value: object, place: str, keys: str, optional: str = "") -> dict[str, Any]:
    """Require an object of just these keys."""
    if not isinstance(value, dict):
        refuse(place, f"it must be an object with {keys}")
    required = keys.split()
    known = [*required, *optional.split()]
    for key in value:
        if key not in known:
            refuse(place, f'unknown key "{key}"; known are {", ".join(known)}')
    for key in required:
        if key not in value:
            refuse(place, f'the key "{key}" is missing')
    return value


def items(value: object, place: str) -> list[Any]:
    """Require a list."""
    if not isinstance(value, list):
        refuse(place, "it must be a list")
    return value


def number(value: object, place: str, low: float = -LARGEST, high: float = LARGEST) -> float:
    """Require a finite number within a range."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        refuse(place, f"{value!r} is no number")
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not low <= result <= high:
        refuse(place, f"{result:.6g} is not within {low:.6g} to {high:.6g}")
    return result


def optional_number(value: object, place: str, low: float = -LARGEST) -> float | None:
    """Require a number or null."""
    return None if value is None else number(value, place, low)


def integer(value: object, place: str, low: int, high: int) -> int:
    """Require an integer, low <= it < high."""
    if isinstance(value, bool) or not isinstance(value, int):
        refuse(place, f"{value!r} is no integer")
    if not low <= value < high:
        refuse(place, f"{value} is not within {low} to {high - 1}")
    return value


def text(value: object, place: str, choices: tuple[str, ...] = ()) -> str:
    """Require text, one of the choices where there are any."""
    if not isinstance(value, str):
        refuse(place, f"{value!r} is no text")
    if choices and value not in choices:
        refuse(place, f'"{value}" is none of {", ".join(choices)}')
    return value


def truth(value: object, place: str) -> bool:
    """Require true or false."""
    if not isinstance(value, bool):
        refuse(place, f"{value!r} is neither true nor false")
    return value


def array(value: object, place: str, shape: tuple[int, ...]) -> Array:
    """Require nested lists of finite numbers of this shape; -1 stands for any length, 0 too."""
    if not shape:
        return np.array(number(value, place))
    rows = items(value, place)
    if shape[0] >= 0 and len(rows) != shape[0]:
        refuse(place, f"it must hold {shape[0]} values, and holds {len(rows)}")
    if len(shape) == 1:
        return np.array([number(v, f"{place}[{i}]") for i, v in enumerate(rows)], dtype=np.float64)
    if not rows:
        return np.empty((0, *(max(n, 0) for n in shape[1:])))
    return np.stack([array(row, f"{place}[{i}]", shape[1:]) for i, row in enumerate(rows)])


def _members(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    result = dict(pairs)
    if len(result) != len(pairs):
        keys = [key for key, _ in pairs]
        twice = next(key for key in keys if keys.count(key) > 1)
        raise MotionFileError(f'the key "{twice}" is there twice in one object')
    return result


def _refuse_constant(name: str) -> NoReturn:
    raise MotionFileError(f"{name} is no number of a motion file")
