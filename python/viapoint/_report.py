"""Everything that is wrong with a program, at once."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from . import _core

if TYPE_CHECKING:
    from rich.console import Console, ConsoleOptions, RenderResult


class Report:
    """The problems of a program, in program order. Prints as text, and in colour through rich.

    Attributes
    ----------
    problems : tuple of Problem
        Each with code, message, ways_out, move, file, line, joint, time, share, value, limit.
    """

    def __init__(self, problems: Iterable[_core.Problem]) -> None:
        self.problems = tuple(problems)

    @property
    def errors(self) -> tuple[_core.Problem, ...]:
        """The problems that keep the program from running."""
        return tuple(p for p in self.problems if not p.warning)

    @property
    def warnings(self) -> tuple[_core.Problem, ...]:
        """What was done otherwise than asked, and does no harm."""
        return tuple(p for p in self.problems if p.warning)

    @property
    def ok(self) -> bool:
        """True when there are no errors."""
        return not self.errors

    def __len__(self) -> int:
        """Count errors and warnings."""
        return len(self.problems)

    def __iter__(self) -> Iterator[_core.Problem]:
        """Go through errors and warnings in program order."""
        return iter(self.problems)

    def __str__(self) -> str:
        """Say everything, one problem a paragraph."""
        return "\n".join([self._headline(), *(_text(p) for p in self.problems)])

    def __repr__(self) -> str:
        """Count errors and warnings."""
        return f"<Report: {self._headline()}>"

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Print the report in colour."""
        from rich.text import Text

        yield Text(self._headline(), style="bold green" if self.ok else "bold red")
        for problem in self.problems:
            style = "yellow" if problem.warning else "red"
            word, _, rest = _text(problem).partition(" ")
            yield Text.assemble((word, f"bold {style}"), " ", rest)

    def _headline(self) -> str:
        if not self.problems:
            return "nothing is wrong"
        return f"{_count(len(self.errors), 'error')}, {_count(len(self.warnings), 'warning')}"


def _count(number: int, word: str) -> str:
    return f"{number} {word}" if number == 1 else f"{number} {word}s"


def _text(problem: _core.Problem) -> str:
    return f"{'warning' if problem.warning else 'error'} {problem.code}: {problem.describe()}"
