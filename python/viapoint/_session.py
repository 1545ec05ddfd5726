"""Who is told what a script plans and runs.

A script runs as it is under ``python script.py``; then nobody listens. The command ``viapoint``
puts a session of its own in place, which draws the progress bar, collects every run for the table,
the log and the pictures, or has programs checked instead of run.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._job import Job
    from ._motion import Motion
    from ._program import Program
    from ._report import Report
    from .errors import MotionError


class Session:
    """Listens to nothing. Subclasses listen.

    Attributes
    ----------
    virtual : bool
        True where arms run in virtual time: nothing waits and nothing is sent to a drive.
    """

    virtual = False

    def planned(self, motion: Motion) -> None:
        """Hear that a program was planned."""

    def checked(self, program: Program, report: Report) -> None:
        """Hear that a program was checked."""

    def refused(self, program: Program, error: MotionError) -> None:
        """Hear that a program could not be planned."""

    def started(self, job: Job) -> None:
        """Hear that a run, of a program or of a stream, has begun."""

    def waiting(self, job: Job) -> None:
        """Hear, about 20 times a second, that the script waits for a job."""

    def ended(self, job: Job) -> None:
        """Hear that a job which the script waited for has ended."""


_current = Session()


def current() -> Session:
    """Return the session in place."""
    return _current


@contextmanager
def use(session: Session) -> Iterator[Session]:
    """Put `session` in place for the block."""
    global _current
    before, _current = _current, session
    try:
        yield session
    finally:
        _current = before
