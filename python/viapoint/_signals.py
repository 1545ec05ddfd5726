"""Digital inputs and outputs as a script names them: by number, on or off."""

from __future__ import annotations

from typing import Literal

from ._arguments import integer
from .errors import BadArgumentError

SIGNALS = 64
"""So many inputs an arm has, and so many outputs: one a bit of a word."""


def signal(index: object, name: str = "index") -> int:
    """Return the number of an input or output.

    Raises
    ------
    BadArgumentError
        Another number, by `name`.
    """
    return integer(index, name, 0, SIGNALS - 1)


def on_or_off(value: object, kind: Literal["input", "output"], name: str = "value") -> bool:
    """Return the value of an input or output.

    Raises
    ------
    BadArgumentError
        Anything but a bool, by `name`: 1 might be meant as a number.
    """
    if not isinstance(value, bool):
        raise BadArgumentError(f"{name} is {value!r}; an {kind} is True or False.")
    return value
