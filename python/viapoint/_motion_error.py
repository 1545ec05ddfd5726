"""The root of the errors: what every one of them tells, and how it crosses processes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, ClassVar

from . import _core


class MotionError(Exception):
    """The root of all errors of viapoint.

    Attributes
    ----------
    code : str
        Stable lower-case name, e.g. ``"joint_limit"``.
    message : str
        What was wrong and the allowed range.
    ways_out : list of str
        What would make it right.
    move : int or None
        Index of the move in its program, from 0.
    file : str
        Source of the move, or the file that was read; empty where none.
    line : int or None
        Line in `file`, from 1.
    joint : int or None
        Joint, from 0.
    time : float or None
        [s] from the motion's start.
    share : float or None
        Share of the leg where it happens, 0 to 1.
    value, limit : float or None
        The offending value and what it was held against [SI, rad].
    """

    __module__ = "viapoint.errors"  # where scripts and tracebacks find it

    code: ClassVar[str] = "internal"

    def __init__(
        self,
        message: str,
        *,
        ways_out: Sequence[str] = (),
        move: int | None = None,
        file: str = "",
        line: int | None = None,
        joint: int | None = None,
        time: float | None = None,
        share: float | None = None,
        value: float | None = None,
        limit: float | None = None,
    ) -> None:
        self.message = message
        self.ways_out = list(ways_out)
        self.move = move
        self.file = file
        self.line = line
        self.joint = joint
        self.time = time
        self.share = share
        self.value = value
        self.limit = limit
        super().__init__(self.problem.describe())

    @property
    def problem(self) -> _core.Problem:
        """The error as data, as reports hold it."""
        return _core.Problem(
            self.code,
            self.message,
            ways_out=self.ways_out,
            move=self.move,
            file=self.file,
            line=self.line,
            joint=self.joint,
            time=self.time,
            share=self.share,
            value=self.value,
            limit=self.limit,
        )

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by fields, so that errors cross processes."""
        fields = {name: value for name, value in vars(self).items() if name != "message"}
        return (_rebuild, (type(self), self.message, fields))


def _rebuild(cls: type[MotionError], message: str, fields: dict[str, Any]) -> MotionError:
    return cls(message, **fields)
