"""Logs as MCAP files: JSON channels with schemas that Foxglove and PlotJuggler open.

The schemas ``foxglove.…`` are those that Foxglove draws by itself: joint states, the tool's pose in
its base frame, and events as a log. The others hold the rest of every cycle, to the last bit.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from dataclasses import replace
from itertools import repeat
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._arguments import Vector
from ._rotation_vectors import quaternions
from ._written_aside import written_aside
from .errors import FileError

if TYPE_CHECKING:
    from ._run_log import RunLog
    from ._samples import Samples

_NUMBER = {"type": "number"}
_INTEGER = {"type": "integer"}
_TEXT = {"type": "string"}
_NUMBERS = {"type": "array", "items": _NUMBER}
_LEVEL_INFO = 2
"""Of ``foxglove.Log``."""
_POSE = (
    '"frame_id":"base","pose":{"position":{"x":%s,"y":%s,"z":%s},'
    '"orientation":{"w":%s,"x":%s,"y":%s,"z":%s}}'
)
_BLOCK = 1000
"""So many cycles are written at a time."""


def _record(**members: object) -> dict[str, object]:
    return {"type": "object", "properties": members}


_TIME = _record(sec=_INTEGER, nsec=_INTEGER)
_JOINT = _record(name=_TEXT, position=_NUMBER, velocity=_NUMBER, acceleration=_NUMBER)
_POINT = _record(x=_NUMBER, y=_NUMBER, z=_NUMBER)
_TURN = _record(x=_NUMBER, y=_NUMBER, z=_NUMBER, w=_NUMBER)
_INTEGERS = ("cycle", "latency", "compute", "move", "outputs")
_RATES = ("nominal_time", "rate")
_SETPOINT = ("q", "qd", "qdd", "qddd")

TOPICS: dict[str, tuple[str, dict[str, object]]] = {
    "/cycle": (
        "viapoint.Cycle",
        _record(
            timestamp=_TIME,
            state=_TEXT,
            **dict.fromkeys(_RATES, _NUMBER),
            **dict.fromkeys(_INTEGERS, _INTEGER),
        ),
    ),
    "/setpoint": (
        "viapoint.Setpoint",
        _record(timestamp=_TIME, **dict.fromkeys(_SETPOINT, _NUMBERS)),
    ),
    "/measured": ("viapoint.Measured", _record(timestamp=_TIME, q=_NUMBERS)),
    "/joint_states": (
        "foxglove.JointStates",
        _record(timestamp=_TIME, joints={"type": "array", "items": _JOINT}),
    ),
    "/tool": (
        "foxglove.PoseInFrame",
        _record(timestamp=_TIME, frame_id=_TEXT, pose=_record(position=_POINT, orientation=_TURN)),
    ),
    "/events": (
        "foxglove.Log",
        _record(
            timestamp=_TIME, level=_INTEGER, message=_TEXT, name=_TEXT, file=_TEXT, line=_INTEGER
        ),
    ),
}
"""Of each topic its schema's name, and the schema: an object of these members."""


def write_mcap(log: RunLog, header: dict[str, Any], path: str) -> None:
    """Write the file of a log, chunk by chunk.

    Raises
    ------
    FileError
        It cannot be written, or the package ``mcap`` is not installed.
    """
    writer_of, _ = _package()
    with written_aside(path) as file:
        writer = writer_of.Writer(file)
        writer.start(profile="", library=f"viapoint {_core.__version__}")
        channels = {}
        for topic, (name, schema) in TOPICS.items():
            number = writer.register_schema(name, "jsonschema", json.dumps(schema).encode())
            channels[topic] = writer.register_channel(topic, "json", number)
        writer.add_metadata("viapoint", {"header": json.dumps(header)})
        for topic, row, stamp, data in _messages(log):
            writer.add_message(channels[topic], stamp, data, stamp, row)
        writer.finish()


def read_mcap(path: str) -> tuple[dict[str, Any], dict[str, np.ndarray[Any, Any]]]:
    """Read header and columns of a log.

    Raises
    ------
    Exception
        It is damaged, or no log: whatever the reader and its decompressors raise.
    FileError
        The package ``mcap`` is not installed.
    """
    _, reader_of = _package()
    rows: dict[str, list[dict[str, Any]]] = {topic: [] for topic in TOPICS}
    stamps = []
    header = None
    with Path(path).open("rb") as file:
        reader = reader_of.make_reader(file, validate_crcs=True)
        for metadata in reader.iter_metadata():
            if metadata.name == "viapoint":
                header = json.loads(metadata.metadata["header"])
        for _, channel, message in reader.iter_messages(
            topics=["/cycle", "/setpoint", "/measured"]
        ):
            rows[channel.topic].append(json.loads(message.data))
            if channel.topic == "/cycle":
                stamps.append(message.log_time)
    if header is None:
        raise ValueError("it is no log of viapoint")
    states = {state: i for i, state in enumerate(_core.run_states())}
    columns = {key: np.array([row[key] for row in rows["/cycle"]]) for key in (*_INTEGERS, *_RATES)}
    columns["outputs"] = np.array([row["outputs"] for row in rows["/cycle"]], dtype=np.uint64)
    columns["state"] = np.array([states[row["state"]] for row in rows["/cycle"]], dtype=np.uint8)
    columns["stamp"] = np.array(stamps, dtype=np.int64)
    table = {key: [row[key] for row in rows["/setpoint"]] for key in _SETPOINT}
    table["measured"] = [row["q"] for row in rows["/measured"]]  # None is NaN
    for key, values in table.items():
        columns[key] = np.array(values or np.zeros((0, header["joints"])), dtype=np.float64)
    return header, columns


def _package() -> tuple[ModuleType, ModuleType]:
    try:
        import mcap.reader
        import mcap.writer
    except ImportError:
        raise FileError(
            'A .mcap file needs the package "mcap", which is not installed.',
            ways_out=["pip install viapoint[mcap]", "Save the log as .npz or .csv."],
        ) from None
    return mcap.writer, mcap.reader


def _messages(log: RunLog) -> Iterator[tuple[str, int, int, bytes]]:
    """All of a log in the order of time: topic, number of the cycle's row, stamp, and JSON."""
    before: dict[str, Any] = {}
    samples = log.samples
    about = f'"name":{json.dumps(log.robot.name)},"file":"","line":0'
    for begin in range(0, len(log), _BLOCK):
        rows = slice(begin, begin + _BLOCK)
        columns = zip(
            log.stamp[rows].tolist(),
            _cycles(log, rows),
            _setpoints(log, rows),
            _measured(log, rows),
            _joint_states(log, rows),
            _tools(samples, rows),
            _changing(log, rows),
            strict=True,
        )
        for k, (stamp, cycle, setpoint, measured, joints, tool, now) in enumerate(columns, begin):
            told = [
                ("/cycle", cycle),
                ("/setpoint", setpoint),
                ("/measured", measured),
                ("/joint_states", joints),
            ]
            if tool:
                told.append(("/tool", tool))
            told.extend(
                ("/events", f'"level":{_LEVEL_INFO},"message":"{text}",{about}')
                for text in _events(before, now)
            )
            before = now
            time = f'"timestamp":{{"sec":{stamp // 10**9},"nsec":{stamp % 10**9}}}'
            for topic, members in told:
                yield topic, k, stamp, f"{{{members},{time}}}".encode()


# These give the members of a message, JSON without its braces, for each of the rows: put together
# as text, since an hour has nine million messages.


def _cycles(log: RunLog, rows: slice) -> Iterator[str]:
    template = ",".join(f'"{key}":%d' for key in _INTEGERS)
    integers = zip(*(getattr(log, key)[rows].tolist() for key in _INTEGERS), strict=True)
    values = np.stack([getattr(log, key)[rows] for key in _RATES], axis=1)
    rates = _filled(",".join(f'"{key}":%s' for key in _RATES), values)
    for state, counts, rate in zip(log.state[rows], integers, rates, strict=True):
        yield f'{template % counts},{rate},"state":"{log.STATES[state]}"'


def _rows(values: Vector) -> list[str]:
    """Return each row as a list in JSON."""
    if not np.isfinite(values).all():
        raise ValueError("a value of the log is not finite")
    return _core.json_rows(values)


def _filled(template: str, values: Vector) -> Iterator[str]:
    """Put the numbers of each row into the places of a template."""
    for row in _rows(values):
        yield template % tuple(row[1:-1].split(","))


def _setpoints(log: RunLog, rows: slice) -> Iterator[str]:
    columns = [_rows(getattr(log, key)[rows]) for key in _SETPOINT]
    for q, qd, qdd, qddd in zip(*columns, strict=True):
        yield f'"q":{q},"qd":{qd},"qdd":{qdd},"qddd":{qddd}'


def _measured(log: RunLog, rows: slice) -> Iterator[str]:
    for q in _core.json_rows(log.measured[rows]):
        yield f'"q":{q}'


def _joint_states(log: RunLog, rows: slice) -> Iterator[str]:
    names = (json.dumps(name).replace("%", "%%") for name in log.robot.joint_names)
    joints = ",".join(
        f'{{"name":{name},"position":%s,"velocity":%s,"acceleration":%s}}' for name in names
    )
    seen = np.where(np.isnan(log.measured[rows]), log.q[rows], log.measured[rows])
    values = np.stack((seen, log.qd[rows], log.qdd[rows]), axis=2)
    return _filled(f'"joints":[{joints}]', values.reshape(len(values), -1))


def _tools(samples: Samples, rows: slice) -> Iterator[str]:
    """Poses of the tool; empty for a robot without kinematics."""
    if not samples.robot.has_kinematics:
        return repeat("", len(samples.t[rows]))
    part = {key: getattr(samples, key)[rows] for key in ("t", "q", "qd", "qdd", "qddd", "move")}
    poses = replace(samples, **part).pose
    return _filled(_POSE, np.hstack((poses[:, :3, 3], quaternions(poses[:, :3, :3]))))


def _changing(log: RunLog, rows: slice) -> Iterator[dict[str, Any]]:
    """Tell what an event is about when it changes."""
    columns = (log.state[rows], log.move[rows], log.outputs[rows])
    for state, move, outputs in zip(*(column.tolist() for column in columns), strict=True):
        yield {"state": log.STATES[state], "move": move, "outputs": outputs}


def _events(before: dict[str, Any], now: dict[str, Any]) -> Iterator[str]:
    if before.get("state") != now["state"]:
        yield f"state: {now['state']}"
    if before.get("move") != now["move"]:
        yield f"move: {now['move']}"
    changed = before.get("outputs", 0) ^ now["outputs"]
    for output in range(changed.bit_length()):
        if changed >> output & 1:
            yield f"output {output}: {'on' if now['outputs'] >> output & 1 else 'off'}"
