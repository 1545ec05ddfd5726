"""What the command line says of a motion file that was verified."""

from __future__ import annotations

import os
from pathlib import Path

from rich.markup import escape
from rich.table import Table

from ._arguments import file_name
from .errors import BadProgramError, FileError
from .verifier import MotionFileError, Verdict, verify


def is_motion_file(path: Path) -> bool:
    """Tell a motion file, damaged or not, from a script and from a program file."""
    if path.suffix != ".json" or not path.is_file():
        return False
    if path.name.endswith(".motion.json"):
        return True
    with path.open("rb") as file:
        return b'"viapoint motion"' in file.read(200)


def verdict_on(path: str | os.PathLike[str]) -> Verdict:
    """Verify a file; what keeps it from being read is an error of the package's own.

    Raises
    ------
    BadProgramError
        It is damaged.
    FileError
        It cannot be read.
    """
    name = file_name(path)
    try:
        return verify(name)
    except MotionFileError as error:
        raise BadProgramError(
            f"The motion file cannot be read: {error}.",
            file=name,
            ways_out=["Save the motion again: motion.save(path)."],
        ) from None
    except OSError as error:
        raise FileError(f"{name} cannot be read: {error.strerror or error}.", file=name) from error


def verdict_table(verdict: Verdict) -> Table:
    """Every quantity that was proven, its worst and what is allowed."""
    word = "[bold green]holds" if verdict.holds else "[bold red]does not hold"
    table = Table(
        title=f"{escape(verdict.name)} of {escape(verdict.robot)}, {verdict.duration:.4f} s in "
        f"{verdict.pieces} pieces: {word}[/]",
        title_justify="left",
    )
    table.add_column("")
    table.add_column("quantity", overflow="fold")
    table.add_column("proven", overflow="fold")
    table.add_column("allowed", overflow="fold")
    for proof in verdict.proofs:
        mark = "[green]✓[/]" if proof.holds else "[red]✗[/]"
        table.add_row(
            mark, *(escape(text) for text in (proof.quantity, proof.worst, proof.allowed))
        )
    return table


def finding_lines(verdict: Verdict) -> list[str]:
    """Each thing that is wrong, in markup."""
    return [f"[bold red]wrong[/] {escape(str(finding))}" for finding in verdict.findings]
