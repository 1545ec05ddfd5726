"""A program planned while it is told, chunk by chunk."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from . import _core
from ._arguments import ArrayLike
from ._motion import CYCLE, Motion, Tools, tools_of
from ._report import Report
from ._samples import Samples

if TYPE_CHECKING:
    from ._program import Program


class Chunk:
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
        self.program = program
        self.begin: float = core.begin
        self.last: bool = core.last
        self.report = Report(core.motion.problems)
        self._motion = Motion(core.motion, program, program._core, self.report, tools)

    def __repr__(self) -> str:
        """Name, when it begins, and duration."""
        return f"<Chunk of {self.program.name!r}, from {self.begin:.3f} s, {self.duration:.3f} s>"

    @property
    def duration(self) -> float:
        """From its first setpoint to rest [s]."""
        return self._motion.duration

    @property
    def pieces(self) -> int:
        """Number of polynomial pieces that the controller evaluates."""
        return self._motion.pieces

    @property
    def certificate(self) -> _core.Certificate:
        """Proven bounds; also of the steps from the chunk before to this one."""
        return self._motion.certificate

    @property
    def corners(self) -> list[_core.Corner]:
        """What became of the zones decided since the chunk before."""
        return self._motion.corners

    def sample(self, dt: float = CYCLE) -> Samples:
        """States at 0, dt, 2 dt, … and at rest, as `Motion.sample`.

        Parameters
        ----------
        dt : float
            Step [s], above 0.

        Raises
        ------
        BadArgumentError
            dt is not positive and finite, or asks for more than 1e8 samples.
        """
        return self._motion.sample(dt)

    def at(self, times: ArrayLike) -> Samples:
        """States at the given instants, as `Motion.at`.

        Parameters
        ----------
        times : array_like, (k,)
            Ascending [s].

        Raises
        ------
        BadArgumentError
            No numbers at all, not ascending, or not finite.
        """
        return self._motion.at(times)


def chunks_of(program: Program, moves: Iterable[object]) -> Iterator[Chunk]:
    """Plan what a program holds, and what `moves` adds to it, while it is added."""
    kept = told = len(program)
    tools = tools_of(program._core, program.robot)
    stream = _core.Stream(program.robot._core, program._core)
    yield from _ready(stream, program, tools)
    for _ in moves:
        # The steps are counted on, though they are taken out of the program.
        tools += tuple(
            (told + step - kept, arm)
            for step, arm in tools_of(program._core, program.robot)
            if step >= kept
        )
        told += len(program) - kept
        stream.take(program._core, kept)
        yield from _ready(stream, program, tools)
    stream.take(program._core, kept)
    stream.end()
    yield from _ready(stream, program, tools)


def _ready(stream: _core.Stream, program: Program, tools: Tools) -> Iterator[Chunk]:
    while (core := stream.next()) is not None:
        yield Chunk(core, program, tools)
