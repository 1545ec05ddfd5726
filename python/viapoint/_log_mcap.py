"""Logs as MCAP files: JSON channels with schemas that Foxglove and PlotJuggler open.

The schemas ``foxglove.…`` are those that Foxglove draws by itself: joint states, the tool's pose in
its base frame, and events as a log. The others hold the rest of every cycle, to the last bit.
"""

from __future__ import annotations

import io
import json
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _core
from ._rotation_vectors import quaternions
from .errors import FileError

if TYPE_CHECKING:
    from ._run_log import RunLog

_NUMBER = {"type": "number"}
_INTEGER = {"type": "integer"}
_TEXT = {"type": "string"}
_NUMBERS = {"type": "array", "items": _NUMBER}
_LEVEL_INFO = 2
"""Of ``foxglove.Log``."""


def _record(**members: object) -> dict[str, object]:
    return {"type": "object", "properties": members}


_TIME = _record(sec=_INTEGER, nsec=_INTEGER)
_JOINT = _record(name=_TEXT, position=_NUMBER, velocity=_NUMBER, acceleration=_NUMBER)
_POINT = _record(x=_NUMBER, y=_NUMBER, z=_NUMBER)
_TURN = _record(x=_NUMBER, y=_NUMBER, z=_NUMBER, w=_NUMBER)
_SCALARS = ("cycle", "latency", "compute", "nominal_time", "rate", "move", "outputs")
_SETPOINT = ("q", "qd", "qdd", "qddd")

TOPICS: dict[str, tuple[str, dict[str, object]]] = {
    "/cycle": (
        "viapoint.Cycle",
        _record(
            timestamp=_TIME,
            state=_TEXT,
            **dict.fromkeys(("nominal_time", "rate"), _NUMBER),
            **{k: _INTEGER for k in _SCALARS if k not in ("nominal_time", "rate")},
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


def mcap_bytes(log: RunLog, header: dict[str, Any]) -> bytes:
    """Return the file of a log.

    Raises
    ------
    FileError
        The package ``mcap`` is not installed.
    """
    writer_of, _ = _package()
    buffer = io.BytesIO()
    writer = writer_of.Writer(buffer)
    writer.start(profile="", library=f"viapoint {_core.__version__}")
    channels = {}
    for topic, (name, schema) in TOPICS.items():
        number = writer.register_schema(name, "jsonschema", json.dumps(schema).encode())
        channels[topic] = writer.register_channel(topic, "json", number)
    writer.add_metadata("viapoint", {"header": json.dumps(header)})
    for topic, row, stamp, message in _messages(log):
        message["timestamp"] = {"sec": stamp // 10**9, "nsec": stamp % 10**9}
        data = json.dumps(message, allow_nan=False, separators=(",", ":")).encode()
        writer.add_message(channels[topic], stamp, data, stamp, row)
    writer.finish()
    return buffer.getvalue()


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
    columns = {key: np.array([row[key] for row in rows["/cycle"]]) for key in _SCALARS}
    columns["outputs"] = np.array([row["outputs"] for row in rows["/cycle"]], dtype=np.uint64)
    columns["state"] = np.array([states[row["state"]] for row in rows["/cycle"]], dtype=np.uint8)
    columns["stamp"] = np.array(stamps, dtype=np.int64)
    for key in _SETPOINT:
        columns[key] = np.array([row[key] for row in rows["/setpoint"]], dtype=np.float64)
    measured = [row["q"] for row in rows["/measured"]]
    columns["measured"] = np.array(measured, dtype=np.float64)  # None is NaN
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


def _messages(log: RunLog) -> Iterator[tuple[str, int, int, dict[str, Any]]]:
    """All of a log in the order of time: topic, number of the cycle's row, stamp and content."""
    names = log.robot.joint_names
    poses = log.samples.pose if log.robot.has_kinematics else None
    turns = None if poses is None else quaternions(poses[:, :3, :3]).tolist()
    before: dict[str, Any] = {}
    for k in range(len(log)):
        stamp = int(log.stamp[k])
        state = log.STATES[log.state[k]]
        scalars = {key: getattr(log, key)[k].item() for key in _SCALARS}
        yield "/cycle", k, stamp, {**scalars, "state": state}
        yield "/setpoint", k, stamp, {key: getattr(log, key)[k].tolist() for key in _SETPOINT}
        measured = [None if np.isnan(v) else float(v) for v in log.measured[k]]
        yield "/measured", k, stamp, {"q": measured}
        there = np.where(np.isnan(log.measured[k]), log.q[k], log.measured[k])
        joints = [
            {"name": name, "position": q, "velocity": qd, "acceleration": qdd}
            for name, q, qd, qdd in zip(
                names, there.tolist(), log.qd[k].tolist(), log.qdd[k].tolist(), strict=True
            )
        ]
        yield "/joint_states", k, stamp, {"joints": joints}
        if poses is not None and turns is not None:
            x, y, z = poses[k, :3, 3].tolist()
            turn = dict(zip("wxyz", turns[k], strict=True))
            pose = {"position": {"x": x, "y": y, "z": z}, "orientation": turn}
            yield "/tool", k, stamp, {"frame_id": "base", "pose": pose}
        now = {"state": state, "move": scalars["move"], "outputs": scalars["outputs"]}
        for text in _events(before, now):
            about = {"name": log.robot.name, "file": "", "line": 0}
            yield "/events", k, stamp, {"level": _LEVEL_INFO, "message": text, **about}
        before = now


def _events(before: dict[str, Any], now: dict[str, Any]) -> Iterator[str]:
    if before.get("state") != now["state"]:
        yield f"state: {now['state']}"
    if before.get("move") != now["move"]:
        yield f"move: {now['move']}"
    changed = before.get("outputs", 0) ^ now["outputs"]
    for output in range(changed.bit_length()):
        if changed >> output & 1:
            yield f"output {output}: {'on' if now['outputs'] >> output & 1 else 'off'}"
