"""Logs of runs as files: .npz and .csv for numbers, .mcap for Foxglove and PlotJuggler."""

from __future__ import annotations

import json
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arguments import Vector, file_name
from ._motion import CYCLE
from ._robot import Robot, load_robot, require_robot
from ._written_aside import written_aside
from .errors import BadArgumentError, BadProgramError, FileError, MotionError

if TYPE_CHECKING:
    from ._run_log import RunLog

Columns = dict[str, np.ndarray[Any, Any]]
ROWS = ("q", "qd", "qdd", "qddd", "measured")
SCALARS = {
    "cycle": np.uint64,
    "stamp": np.int64,
    "latency": np.int64,
    "compute": np.int64,
    "nominal_time": np.float64,
    "rate": np.float64,
    "move": np.int32,
    "state": np.uint8,
    "outputs": np.uint64,
}
_CSV_NAMES = {"stamp": "stamp_ns", "latency": "latency_ns", "compute": "compute_ns"}
_ENDINGS = (".npz", ".csv", ".mcap")


def save_log(log: RunLog, path: str | os.PathLike[str]) -> None:
    """Write a log in the format that the name ends in; see `RunLog.save`."""
    name = file_name(path)
    ending = _ending_of(name)
    if ending == ".csv":
        log.core.save_csv(name)
        return
    if ending == ".mcap":
        from ._log_mcap import write_mcap

        write_mcap(log, header_of(log), name)
        return
    columns = {key: getattr(log, key) for key in (*SCALARS, *ROWS)}
    header = np.array(json.dumps(header_of(log)))
    with written_aside(name) as file:
        np.savez_compressed(file, period=log.period, header=header, **columns)


def load_log(path: str | os.PathLike[str], robot: Robot | None = None) -> RunLog:
    """Read a log that `RunLog.save`, or ``viapoint-controller --log``, wrote.

    Parameters
    ----------
    path : str or path
        A file that ends in .npz, .mcap or .csv.
    robot : Robot, optional
        The arm that moved. Needed for .csv, which does not hold it; the others do.

    Returns
    -------
    RunLog
        To the last bit what was saved. The period of a .csv is the median of its cycles'.

    Raises
    ------
    BadArgumentError
        Another ending, a .csv without a robot, or a robot of another number of joints.
    FileError
        It cannot be read.
    BadProgramError
        It is damaged, or no log.
    """
    from ._run_log import RunLog

    name = file_name(path)
    ending = _ending_of(name)
    if robot is not None:
        require_robot(robot)
    if not Path(name).is_file():
        raise FileError(f"There is no log {name}.", file=name)
    if ending == ".csv" and robot is None:
        raise BadArgumentError(
            f"{name} does not say which arm moved.",
            ways_out=['Give it: load_log(path, load_robot("puma560")).'],
        )
    try:
        if ending == ".csv":
            columns = _read_csv(_core.read_file(name), robot)
            header: dict[str, Any] = {"period": _period_of(columns)}
        elif ending == ".mcap":
            from ._log_mcap import read_mcap

            header, columns = read_mcap(name)
        else:
            header, columns = _read_npz(name)
        core = _core.Log.of_columns(columns)
        arm = robot_in(header["robot"]) if robot is None else robot
        period = float(header["period"])
        tools = tuple(
            (int(step), arm.with_tool(np.array(tool))) for step, tool in header.get("tools", [])
        )
    except FileError:
        raise
    except Exception as error:  # damage shows in many ways, those of decompressors too
        reason = error.message if isinstance(error, MotionError) else repr(error)
        raise BadProgramError(
            f"The log cannot be read: {reason}.",
            file=name,
            ways_out=["It may be cut short; save the log again: job.log.save(path)."],
        ) from error
    if columns["q"].shape[1] != arm.joints:
        raise BadArgumentError(
            f'{name} holds {columns["q"].shape[1]} joints; the robot "{arm.name}" has {arm.joints}.'
        )
    return RunLog(**core.columns(), robot=arm, period=period, core=core, tools=tools)


def header_of(log: RunLog) -> dict[str, Any]:
    """Return what a file holds besides the columns: enough to compute poses from it alone."""
    return {
        "viapoint": _core.__version__,
        "period": log.period,
        "joints": log.robot.joints,
        "robot": log.robot._core.to_yaml(),
        "tools": [[step, robot.tool.tolist()] for step, robot in log.tools],
    }


def _ending_of(name: str) -> str:
    for ending in _ENDINGS:
        if name.endswith(ending):
            return ending
    raise BadArgumentError(
        f'path is "{name}"; a log ends in {", ".join(_ENDINGS)}.',
        ways_out=["For example log.save('run.npz')."],
    )


def robot_in(text: str) -> Robot:
    """Make the robot that a file describes in the words of a robot's own file."""
    with tempfile.TemporaryDirectory() as folder:
        description = Path(folder) / "robot.yaml"
        description.write_text(text, encoding="utf-8")
        return load_robot(description)


def _read_npz(name: str) -> tuple[dict[str, Any], Columns]:
    # Opened here: numpy leaves a damaged file open.
    with Path(name).open("rb") as stream, np.load(stream, allow_pickle=False) as file:
        header = json.loads(str(file["header"]))
        return header, {key: file[key] for key in (*SCALARS, *ROWS)}


def _read_csv(text: str, robot: Robot | None) -> Columns:
    lines = text.splitlines()
    names = lines[0].split(",") if lines else []
    joints = sum(name.startswith("measured") for name in names)
    wanted = [_CSV_NAMES.get(key, key) for key in SCALARS]
    wanted += [f"{row}{i + 1}" for row in ROWS for i in range(joints)]
    is_of_joints = joints > 0 or len(lines) == 1
    if names != wanted or not is_of_joints or not text.endswith("\n"):
        raise ValueError("its columns are not those of a log, or its last line is cut short")
    if not joints and robot is not None:  # no cycle tells how many there are
        joints = robot.joints
    cells = [line.split(",") for line in lines[1:]]
    if any(len(row) != len(names) for row in cells):
        raise ValueError("a line has another number of values than the first")
    columns: Columns = {}
    states = {state: i for i, state in enumerate(_core.run_states())}
    for k, (key, kind) in enumerate(SCALARS.items()):
        values = [row[k] for row in cells]
        if key == "state":
            columns[key] = np.array([states[value] for value in values], dtype=kind)
        elif kind is np.float64:
            columns[key] = np.array([float(value) for value in values])
        else:  # through int: 64 bits are more than a double holds
            columns[key] = np.array([int(value) for value in values], dtype=kind)
    first = len(SCALARS)
    rows = [[float(value) if value else np.nan for value in row[first:]] for row in cells]
    table = np.array(rows, dtype=np.float64).reshape(len(cells), len(ROWS), joints)
    for k, key in enumerate(ROWS):
        columns[key] = np.ascontiguousarray(table[:, k])
    return columns


def _period_of(columns: Columns) -> float:
    """Take the median step between the instants due; now and then a cycle is slept through."""
    cycles = np.diff(columns["cycle"].astype(np.int64))
    if len(cycles) == 0:
        return CYCLE
    due = columns["stamp"] - columns["latency"]
    steps: Vector = np.diff(due) / np.maximum(cycles, 1)
    return round(float(np.median(steps)) * 1e-9, 9)
