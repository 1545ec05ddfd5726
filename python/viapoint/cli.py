"""The command ``viapoint``: run, check, plot or export a script; list the robots."""

from __future__ import annotations

import runpy
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table

from . import _core, _session
from ._job import Job
from ._motion import Motion
from ._outcome import file_stem, motion_tables, run_tables, write_pictures, write_run
from ._program import Program
from ._report import Report
from ._robot import load_robot
from .errors import FileError, MotionError

app = typer.Typer(
    help="Programs in, proven 2 ms setpoints out.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)
console = Console()
errors = Console(stderr=True)

Script = Annotated[
    Path, typer.Argument(metavar="SCRIPT", help="A Python script, or a program file")
]
Folder = Annotated[Path, typer.Option("--out", "-o", help="Where logs and pictures go")]


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
    """

    def __init__(self, virtual: bool) -> None:
        self.virtual = virtual
        self.motions: list[Motion] = []
        self.runs: list[Job] = []
        self.refusals: list[tuple[Program, MotionError]] = []

    def planned(self, motion: Motion) -> None:
        """Keep the motion."""
        self.motions.append(motion)

    def refused(self, program: Program, error: MotionError) -> None:
        """Keep what was refused, and why."""
        self.refusals.append((program, error))

    def started(self, motion: Motion, job: Job) -> None:
        """Keep the run."""
        self.runs.append(job)

    @property
    def chosen(self) -> list[Motion]:
        """The motions that were run; where none was, all that were planned."""
        if self.runs:
            return [job.motion for job in self.runs]
        latest = {id(motion.program): motion for motion in self.motions}
        return list(latest.values())


class ProgressRecorder(Recorder):
    """Draws a progress bar, too."""

    def __init__(self) -> None:
        super().__init__(virtual=False)
        self._bar: Progress | None = None
        self._tasks: dict[int, int] = {}

    def waiting(self, job: Job) -> None:
        """Draw how far the job is."""
        if self._bar is None:
            self._bar = Progress(
                TextColumn("{task.description}"),
                BarColumn(bar_width=40),
                TextColumn("{task.completed:6.3f} of {task.total:.3f} s"),
                TimeElapsedColumn(),
                console=console,
            )
            self._bar.start()
        if id(job) not in self._tasks:
            self._tasks[id(job)] = self._bar.add_task(job.motion.program.name, total=job.duration)
        self._bar.update(self._tasks[id(job)], completed=job.nominal_time)  # type: ignore[arg-type]

    def ended(self, job: Job) -> None:
        """Leave the bar where the job ended."""
        self.close()

    def close(self) -> None:
        """Give the terminal back."""
        if self._bar is not None:
            self._bar.stop()
        self._bar, self._tasks = None, {}


@app.command()
def run(script: Script, out: Folder = Path("out")) -> None:
    """Run a script; then show its figures and write its logs and pictures."""
    recorder = ProgressRecorder()
    try:
        with _reported(recorder):
            _execute(script, recorder)
    finally:
        recorder.close()
        taken: set[str] = set()
        for job in recorder.runs:
            console.print(*run_tables(job))
            _say_files(write_run(job, out, file_stem(script, job.motion, taken)))
    if not recorder.runs:
        console.print("The script ran nothing: no [bold]arm.run(program)[/bold] was reached.")


@app.command()
def check(script: Script) -> None:
    """Check what a script would run, without any motion and without waiting."""
    recorder = Recorder(virtual=True)
    try:
        with _reported(recorder):
            _execute(script, recorder)
    finally:
        for motion in recorder.chosen:
            console.print(f"[bold]{motion.program.name}[/bold], {motion.duration:.3f} s: ", end="")
            console.print(motion.report)
    if not recorder.chosen:
        console.print("The script planned nothing.")


@app.command()
def plot(script: Script, out: Folder = Path("out")) -> None:
    """Draw what a script would run, without any motion."""
    recorder = Recorder(virtual=True)
    with _reported(recorder):
        _execute(script, recorder)
        taken: set[str] = set()
        for motion in recorder.chosen:
            console.print(*motion_tables(motion))
            _say_files(write_pictures(motion, out, file_stem(script, motion, taken)))


@app.command()
def export(script: Script, out: Folder = Path("out")) -> None:
    """Write the programs of a script as files for viapoint-controller."""
    recorder = Recorder(virtual=True)
    with _reported(recorder):
        _execute(script, recorder)
        out.mkdir(parents=True, exist_ok=True)
        taken: set[str] = set()
        for motion in recorder.chosen:
            path = out / f"{file_stem(script, motion, taken)}.json"
            motion.program.save(path)
            _say_files([path])


@app.command()
def robots() -> None:
    """List the built-in robots."""
    table = Table(title="Built-in robots", title_justify="left")
    for heading in ("name", "joints", "inverse kinematics", "title"):
        table.add_column(heading, overflow="fold")
    for name in _core.builtin_robots():
        robot = load_robot(name)
        table.add_row(robot.name, str(robot.joints), robot.ik_family, robot.title)
    console.print(table)


def _say_version(wanted: bool) -> None:
    if wanted:
        console.print(_core.__version__, highlight=False)
        raise typer.Exit


@app.callback()
def common(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_say_version, is_eager=True, help="Say the version and end."
        ),
    ] = False,
) -> None:
    """Programs in, proven 2 ms setpoints out."""


def main() -> None:
    """Entry point of the command."""
    app()


def _execute(script: Path, session: _session.Session) -> None:
    """Run a script as Python would, or a program file on a simulated arm."""
    if not script.is_file():
        raise FileError(f"There is no script {script}.", file=str(script))
    with _session.use(session):
        if script.suffix == ".json":
            _execute_program(script)
            return
        arguments, path = sys.argv, sys.path
        sys.argv, sys.path = [str(script)], [str(script.resolve().parent), *path]
        try:
            runpy.run_path(str(script), run_name="__main__")
        finally:
            sys.argv, sys.path = arguments, path


def _execute_program(path: Path) -> None:
    from ._arm import connect

    program = Program.load(path)
    with connect(f"sim://{program.robot.name}", start=program.start) as arm:
        arm.run(program)


@contextmanager
def _reported(recorder: Recorder) -> Iterator[None]:
    """Turn a refusal into exit code 1 and its text: all that is wrong with a program, at once."""
    try:
        yield
    except MotionError as error:
        for program, reason in recorder.refusals:
            if reason is error:
                errors.print(f"[bold]{program.name}[/bold]: ", end="")
                errors.print(program.check())
                break
        else:
            errors.print(Report([error.problem]))
        raise typer.Exit(1) from error


def _say_files(files: list[Path]) -> None:
    for file in files:
        console.print(f"  wrote {file}", highlight=False)


if __name__ == "__main__":
    main()
