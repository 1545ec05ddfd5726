"""The run of a stream, and what came late in it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from ._job import Execution, Job
from ._run_log import RunLog

if TYPE_CHECKING:
    from ._stream import Stream


@dataclass(frozen=True)
class LateStep:
    """A step that came when the arm had nothing else to do any more.

    Attributes
    ----------
    step : int
        Index of the step in the stream, from 0.
    file : str
        The script.
    line : int
        Its line, from 1.
    waited : float
        How long the arm waited at rest [s]; 0 where it only slowed down to rest.
    """

    step: int
    file: str
    line: int
    waited: float


class StreamJob(Job):
    """The run of a stream: a `Job` whose motion gets longer. Threads: any.

    Its `duration` is that of what has been handed to the arm, and its state ``"waiting"`` where the
    arm rests at the end of that. It has no `motion`.

    Attributes
    ----------
    stream : Stream
        What is told.
    """

    def __init__(self, execution: Execution, stream: Stream, period: float) -> None:
        self._execution = execution
        self._period = period
        self._seen_to_end = False
        self.stream = stream

    def __repr__(self) -> str:
        """Name, state and progress."""
        return (
            f"<StreamJob {self.name!r}, {self.state}, "
            f"{self.nominal_time:.3f} of {self.duration:.3f} s so far>"
        )

    @property
    def name(self) -> str:
        """Name of the stream."""
        return self.stream.name

    @property
    def log(self) -> RunLog:
        """Every cycle so far; complete once the job has ended."""
        robot, tools = self.stream.robot, self.stream.tools
        return RunLog.of_robot(self._execution.log(), robot, self._period, tools)
