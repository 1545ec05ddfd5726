"""A program planned while it is told, chunk by chunk."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from . import _core
from ._proven import Proven, ToldTools, Tools
from ._report import Report

if TYPE_CHECKING:
    from ._program import Program


class Chunk(Proven):
    """A proven stretch of motion that ends at rest on the path.

    It is run until the `begin` of the chunk after it. Where that one is late it is run to its end:
    the arm rests on the path, and goes on from there. Threads: any, at once.

    Attributes
    ----------
    program : Program
        What it is part of.
    begin : float
        When the chunk before is left for this one [s of that chunk's time]; 0 for the first.
    last : bool
        The program ends with it.
    report : Report
        Warnings met since the chunk before.
    """

    def __init__(self, core: _core.Chunk, program: Program, tools: Tools) -> None:
        super().__init__(core.motion, program.robot, tools)
        self.program = program
        self.begin: float = core.begin
        self.last: bool = core.last
        self.report = Report(core.motion.problems)

    def __repr__(self) -> str:
        """Name, when it begins, and duration."""
        return f"<Chunk of {self.program.name!r}, from {self.begin:.3f} s, {self.duration:.3f} s>"


def chunks_of(program: Program, moves: Iterable[object]) -> Iterator[Chunk]:
    """Plan what a program holds, and what `moves` adds to it, while it is added."""
    kept = told = len(program)
    tools = ToldTools(program._core, program.robot)
    stream = _core.Stream(program.robot._core, program._core)
    yield from _ready(stream, program, tools)
    for _ in moves:
        # The steps are counted on, though they are taken out of the program.
        tools.add(program._core, kept, told)
        told += len(program) - kept
        stream.take(program._core, kept)
        yield from _ready(stream, program, tools)
    stream.take(program._core, kept)
    stream.end()
    yield from _ready(stream, program, tools)


def _ready(stream: _core.Stream, program: Program, tools: ToldTools) -> Iterator[Chunk]:
    while (core := stream.next()) is not None:
        yield Chunk(core, program, tools.changes)
