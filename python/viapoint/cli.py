"""The command ``viapoint``: run, check, plot, export or verify a script; read logs; list robots."""

from __future__ import annotations

import io
import signal
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import FrameType
from typing import Annotated

import typer
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from . import _core, iso9283
from ._accuracy_table import accuracy_tables
from ._arguments import writing
from ._job import Job
from ._log_files import load_log
from ._motion import Motion
from ._outcome import (
    file_stem,
    motion_tables,
    run_tables,
    unused,
    write_log,
    write_pictures,
    write_run_pictures,
)
from ._program import Program
from ._recorder import ProgressRecorder, Recorder
from ._report import Report
from ._robot import load_robot
from ._robot_check import findings, joint_table, remarks
from ._script import execute
from ._verification import finding_lines, is_motion_file, verdict_on, verdict_table
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
RobotFile = Annotated[
    str | None,
    typer.Option("--robot", help="The robot of a program file: a name, or a .yaml or .urdf file"),
]


@app.command()
def run(script: Script, out: Folder = Path("out"), robot: RobotFile = None) -> None:
    """Run a script; then show its figures and write its logs and pictures."""
    recorder = ProgressRecorder(console)
    try:
        with _reported(recorder), _signals_as_ctrl_c():
            _require_writable(out)
            execute(script, recorder, errors, robot)
    finally:
        try:
            recorder.close()
        finally:  # a terminal that is gone cannot be given back
            lost = _keep_runs(recorder.runs, out, script)
    if not recorder.runs:
        console.print("The script ran nothing: no [bold]arm.run(program)[/bold] was reached.")
    if lost:
        raise typer.Exit(1)


@app.command()
def check(script: Script, robot: RobotFile = None) -> None:
    """Check every program of a script, without any motion and without waiting.

    Every program that the script checks, plans or runs is shown; the exit code is 1 when any of
    them has an error.
    """
    recorder = Recorder(virtual=True)
    wrong = False
    try:
        with _reported(recorder):
            execute(script, recorder, errors, robot)
    finally:
        told = [program for program, error in recorder.refusals if error is recorder.ended_by]
        for program in recorder.programs:
            if not any(program is other for other in told):
                wrong |= _say_report(recorder, program)
    if not recorder.programs:
        console.print("The script planned nothing.")
    if wrong:
        raise typer.Exit(1)


@app.command()
def plot(script: Script, out: Folder = Path("out"), robot: RobotFile = None) -> None:
    """Draw what a script would run, without any motion."""
    recorder = Recorder(virtual=True)
    with _reported(recorder):
        _require_writable(out)
        execute(script, recorder, errors, robot)
        with writing(out):
            out.mkdir(parents=True, exist_ok=True)
        taken: set[str] = set()
        for motion in recorder.chosen:
            console.print(*motion_tables(motion))
            _say_files(write_pictures(motion, out, file_stem(script, motion.program.name, taken)))
        for job in recorder.streams:
            console.print(*run_tables(job))
            _say_files(list(write_run_pictures(job, out, file_stem(script, job.name, taken))))


@app.command()
def export(
    script: Script,
    out: Folder = Path("out"),
    robot: RobotFile = None,
    motions: Annotated[
        bool, typer.Option("--motions", help="Write the planned motions, too, for verify")
    ] = False,
) -> None:
    """Write the programs of a script as files for viapoint-controller."""
    recorder = Recorder(virtual=True)
    with _reported(recorder):
        _require_writable(out)
        execute(script, recorder, errors, robot)
        with writing(out):
            out.mkdir(parents=True, exist_ok=True)
        taken: set[str] = set()
        written: list[Path] = []
        for motion in recorder.chosen:
            path = out / f"{file_stem(script, motion.program.name, taken)}.json"
            motion.program.save(path)
            written.append(path)
            if motions:
                written.append(path.with_suffix(".motion.json"))
                motion.save(written[-1])
        written += _save_own_robots(recorder.chosen, out)
        _say_files(written)
        _say_streams(recorder, "exported")


@app.command()
def verify(
    file: Annotated[
        Path, typer.Argument(metavar="FILE", help="A motion file, or a script or program file")
    ],
    robot: RobotFile = None,
) -> None:
    """Prove from its file alone that a motion keeps every limit and its path.

    What verifies shares no code with what planned, only the format of the file. A script is
    planned first, and its motions are written aside and verified. The exit code is 1 where
    anything is wrong.
    """
    recorder = Recorder(virtual=True)
    with _reported(recorder):
        if is_motion_file(file):
            holds = _say_verdict(file)
        else:
            execute(file, recorder, errors, robot)
            holds = True
            with tempfile.TemporaryDirectory() as folder:
                for i, motion in enumerate(recorder.chosen):
                    path = Path(folder) / f"{i}.motion.json"
                    motion.save(path)
                    holds &= _say_verdict(path)
            if not recorder.chosen:
                console.print("The script planned nothing.")
            _say_streams(recorder, "verified")
    if not holds:
        raise typer.Exit(1)


def _say_verdict(file: Path) -> bool:
    """Print what was proven of a motion file; True where nothing is wrong."""
    verdict = verdict_on(file)
    console.print(verdict_table(verdict))
    for line in finding_lines(verdict):
        console.print(line, highlight=False, soft_wrap=not console.is_terminal)
    return verdict.holds


@app.command()
def report(
    logs: Annotated[
        list[Path], typer.Argument(metavar="LOG...", help="Logs of runs of one program")
    ],
    robot: Annotated[
        str | None, typer.Option("--robot", help="The arm of .csv logs: a name, .yaml or .urdf")
    ] = None,
    places: Annotated[int, typer.Option("--places", help="Where the paths are compared")] = 50,
) -> None:
    """Tell accuracy and repeatability by ISO 9283 from logs of several runs of one program."""
    with _reported(Recorder(virtual=True)):
        arm = None if robot is None else load_robot(robot)
        found = iso9283.from_logs([load_log(log, arm) for log in logs], places=places)
        console.print(*accuracy_tables(found))


robots_app = typer.Typer(help="List the built-in robots; explain a description.")
app.add_typer(robots_app, name="robots")


@robots_app.callback(invoke_without_command=True)
def robots(context: typer.Context) -> None:
    """List the built-in robots; ``check`` explains a description."""
    if context.invoked_subcommand is not None:
        return
    table = Table(title="Built-in robots", title_justify="left")
    for heading in ("name", "joints", "inverse kinematics", "title"):
        table.add_column(heading, overflow="fold")
    for name in _core.builtin_robots():
        robot = load_robot(name)
        table.add_row(robot.name, str(robot.joints), escape(robot.ik_family), escape(robot.title))
    console.print(table)


@robots_app.command("check")
def check_robot(
    description: Annotated[
        str, typer.Argument(metavar="FILE", help="A .yaml or .urdf file, or a built-in name")
    ],
    tip: Annotated[
        str | None, typer.Option("--tip", help="The link of a URDF that carries the tool")
    ] = None,
) -> None:
    """Explain a robot's description: joints, limits, solver, reach, and what is missing.

    The exit code is 1 when the description cannot be used; then it says what to add.
    """
    with _reported(Recorder(virtual=True)):
        robot = load_robot(description, tip=tip)
    console.print(joint_table(robot), findings(robot))
    for remark in remarks(robot):
        console.print(f"[bold]note[/bold]: {escape(remark)}", soft_wrap=not console.is_terminal)


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
    for stream in (sys.stdout, sys.stderr):  # a terminal that knows no µ gets a \\xb5
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="backslashreplace")
    app()


def _save_own_robots(motions: list[Motion], out: Path) -> list[Path]:
    """Write the robots that a script has made or changed: the controller needs their files."""
    own = {motion.robot.fingerprint: motion.robot for motion in motions}
    for name in _core.builtin_robots():
        own.pop(load_robot(name).fingerprint, None)
    files = []
    taken: set[str] = set()
    for robot in own.values():
        files.append(out / f"{unused(robot.name, taken)}.yaml")
        robot.save(files[-1])
    return files


def _keep_runs(runs: list[Job], out: Path, script: Path) -> bool:
    """Write what was run, then show it, so that nothing said can cost a log; True if one is lost.

    What of one run cannot be written does not keep the rest from being written.
    """
    taken: set[str] = set()
    kept = [(job, file_stem(script, job.name, taken)) for job in runs]
    files: dict[str, list[Path]] = {stem: [] for _, stem in kept}
    lost: list[str] = []
    for write in (write_log, write_run_pictures):  # every log before the first picture
        for job, stem in kept:
            try:
                files[stem].extend(write(job, out, stem))
            except Exception as error:  # noqa: BLE001  # whatever one of them lacks, the others are written
                lost.append(f"{out / stem}: {getattr(error, 'strerror', None) or error}")
    for text in lost:
        errors.print(f"[bold red]lost[/bold red] {escape(text)}", soft_wrap=True)
    for job, stem in kept:
        console.print(*run_tables(job))
        _say_files(files[stem])
    return bool(lost)


def _require_writable(folder: Path) -> None:
    """Refuse, before anything moves, a folder that cannot be made or written into: by trying."""
    there = folder
    try:
        while not there.exists() and there != there.parent:
            there = there.parent
        with tempfile.TemporaryDirectory(dir=there):
            pass
    except OSError as error:
        raise FileError(
            f"{folder} cannot be written: {there}: {error.strerror or error}.",
            file=str(folder),
            ways_out=["Give another folder: --out FOLDER."],
        ) from error


@contextmanager
def _signals_as_ctrl_c() -> Iterator[None]:
    """Have SIGTERM, and a terminal that closes, bring the arm to rest and keep the log too."""

    def interrupt(number: int, frame: FrameType | None) -> None:
        raise KeyboardInterrupt

    before = {number: signal.getsignal(number) for number in (signal.SIGTERM, signal.SIGHUP)}
    for number, handler in before.items():
        if handler is not signal.SIG_IGN:  # under nohup it stays ignored
            signal.signal(number, interrupt)
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def _reported(recorder: Recorder) -> Iterator[None]:
    """Turn a refusal into exit code 1 and its text: all that is wrong with a program, at once."""
    try:
        yield
    except MotionError as error:
        recorder.ended_by = error
        for program, reason in recorder.refusals:
            if reason is error:
                errors.print(f"[bold]{escape(program.name)}[/bold]: ", end="")
                errors.print(recorder.report_of(program), soft_wrap=not errors.is_terminal)
                break
        else:
            errors.print(Report([error.problem]), soft_wrap=not errors.is_terminal)
        raise typer.Exit(1) from error


def _say_report(recorder: Recorder, program: Program) -> bool:
    """Print the report of a program; True when it holds an error."""
    report = recorder.report_of(program)
    duration = recorder.duration_of(program)
    seconds = "" if duration is None else f", {duration:.3f} s"
    console.print(f"[bold]{escape(program.name)}[/bold]{seconds}: ", end="")
    console.print(report, soft_wrap=not console.is_terminal)
    return not report.ok


def _say_streams(recorder: Recorder, done: str) -> None:
    """Name the streams, of which no motion is kept."""
    for job in recorder.streams:
        console.print(
            f'"{escape(job.name)}" is a stream: it is planned as it runs, and not {done}.'
        )


def _say_files(files: list[Path]) -> None:
    for file in files:
        console.print(f"  wrote {escape(str(file))}", highlight=False, soft_wrap=True)


if __name__ == "__main__":
    main()
