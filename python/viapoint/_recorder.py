"""What the command line hears of a script: what it checks, plans and runs."""

from __future__ import annotations

from rich.console import Console
from rich.markup import escape
from rich.progress import BarColumn, Progress, TaskID, TextColumn, TimeElapsedColumn

from . import _session
from ._job import Job
from ._motion import Motion
from ._program import Program
from ._report import Report
from ._stream import Stream
from ._stream_job import StreamJob
from .errors import MotionError


class Recorder(_session.Session):
    """Collects what a script plans and runs.

    Attributes
    ----------
    motions : list of Motion
        Everything planned, in order.
    runs : list of Job
        Everything run, in order.
    refusals : list of (Program, MotionError)
        Everything that could not be planned.
    checks : list of (Program, Report)
        Everything the script checked itself.
    """

    def __init__(self, virtual: bool) -> None:
        self.virtual = virtual
        self.ended_by: MotionError | None = None
        self.motions: list[Motion] = []
        self.runs: list[Job] = []
        self.refusals: list[tuple[Program, MotionError]] = []
        self.checks: list[tuple[Program, Report]] = []

    def planned(self, motion: Motion) -> None:
        """Keep the motion."""
        self.motions.append(motion)
        self.checks.append((motion.program, motion.report))

    def refused(self, program: Program, error: MotionError) -> None:
        """Keep what was refused, and why."""
        self.refusals.append((program, error))
        self.checks.append((program, Report([error.problem])))

    def checked(self, program: Program, report: Report) -> None:
        """Keep the report."""
        self.checks.append((program, report))

    def started(self, job: Job) -> None:
        """Keep the run."""
        self.runs.append(job)

    @property
    def streams(self) -> list[StreamJob]:
        """The runs of streams: they have no motion."""
        return [job for job in self.runs if isinstance(job, StreamJob)]

    @property
    def chosen(self) -> list[Motion]:
        """The motions that were run; where nothing was, all that were planned."""
        if self.runs:
            return [job.motion for job in self.runs if not isinstance(job, StreamJob)]
        latest = {id(motion.program): motion for motion in self.motions}
        return list(latest.values())

    @property
    def programs(self) -> list[Program]:
        """Every program that was checked, planned or refused, once each."""
        return list({id(program): program for program, _ in self.checks}.values())

    def report_of(self, program: Program) -> Report:
        """Return what the script last heard of a program; where it was refused, all of it.

        Of a stream, which is checked step by step, everything.
        """
        reports = [report for checked, report in self.checks if checked is program]
        if isinstance(program, Stream):
            return Report([problem for report in reports for problem in report])
        if any(refused is program for refused, _ in self.refusals):
            whole = program.check()
            return reports[-1] if whole.ok else whole
        return reports[-1]

    def duration_of(self, program: Program) -> float | None:
        """Return how long a program takes, as it was planned or streamed last [s]."""
        planned = [motion.duration for motion in self.motions if motion.program is program]
        streamed = [job.duration for job in self.streams if job.stream is program]
        return (planned + streamed)[-1] if planned or streamed else None


class ProgressRecorder(Recorder):
    """Draws a progress bar, too."""

    def __init__(self, console: Console) -> None:
        super().__init__(virtual=False)
        self._console = console
        self._bar: Progress | None = None
        self._tasks: dict[int, TaskID] = {}

    def waiting(self, job: Job) -> None:
        """Draw how far the job is."""
        if self._bar is None:
            self._bar = Progress(
                TextColumn("{task.description}"),
                BarColumn(bar_width=40),
                TextColumn("{task.completed:6.3f} of {task.total:.3f} s"),
                TimeElapsedColumn(),
                console=self._console,
            )
            self._bar.start()
        if id(job) not in self._tasks:
            self._tasks[id(job)] = self._bar.add_task(escape(job.name), total=job.duration)
        task = self._tasks[id(job)]
        self._bar.update(task, completed=job.nominal_time, total=job.duration)

    def ended(self, job: Job) -> None:
        """Leave the bar where the job ended."""
        self.close()

    def close(self) -> None:
        """Give the terminal back."""
        if self._bar is not None:
            self._bar.stop()
        self._bar, self._tasks = None, {}
