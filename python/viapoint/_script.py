"""Runs a script or a program file for the command line."""

from __future__ import annotations

import runpy
import sys
import traceback
from pathlib import Path
from types import TracebackType

import typer
from rich.console import Console

from . import _session
from ._program import Program
from ._robot import Robot, load_robot
from .errors import BadArgumentError, FileError, MotionError


def execute(
    script: Path, session: _session.Session, errors: Console, robot: str | None = None
) -> None:
    """Run a script as Python would, or a program file on a simulated arm.

    An error of the script's own is printed to `errors`, and then ends the command with 1.
    """
    if not script.is_file():
        raise FileError(f"There is no script {script}.", file=str(script))
    with _session.use(session):
        if script.suffix == ".json":
            _execute_program(script, None if robot is None else load_robot(robot))
            return
        if robot is not None:
            raise BadArgumentError(
                f"--robot {robot} is for program files (.json); {script} chooses its own robot."
            )
        arguments, path = sys.argv, sys.path
        sys.argv, sys.path = [str(script)], [str(script.resolve().parent), *path]
        try:
            runpy.run_path(str(script), run_name="__main__")
        except MotionError:
            raise
        except Exception as error:
            trace = _from_script_on(error.__traceback__, str(script))
            text = "".join(traceback.format_exception(type(error), error, trace))
            errors.print(text, end="", markup=False, highlight=False, soft_wrap=True)
            raise typer.Exit(1) from error
        finally:
            sys.argv, sys.path = arguments, path


def _execute_program(path: Path, robot: Robot | None) -> None:
    from ._connect import connect

    program = Program.load(path, robot)
    arm_robot = program.robot
    with connect(f"sim://{arm_robot.name}", start=program.start, robot=arm_robot) as arm:
        arm.run(program)


def _from_script_on(trace: TracebackType | None, script: str) -> TracebackType | None:
    """Leave out the frames that run the script; none is left of one that is no Python."""
    while trace is not None and trace.tb_frame.f_code.co_filename != script:
        trace = trace.tb_next
    return trace
