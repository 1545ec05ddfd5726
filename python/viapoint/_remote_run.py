"""A run of a controller in another process."""

from __future__ import annotations

import contextlib
import time
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core, _wire
from ._proven import Tools
from ._robot import Robot
from ._wire import Message, message
from .errors import MotionError

if TYPE_CHECKING:
    from ._remote import RemoteLoop

LOOK = 0.005
"""A wait looks at the run so often [s]."""
_STEERING = {"pause": 1, "resume": 2, "step": 3, "backward": 4}
_REACTIONS = {"pause": 1, "resume": 2, "stop": 5}
_STOPS = {2: 5, 1: 6}
"""Wish of a stop's category."""
_RECORDS = 1000
_MOST_TOOLS = 100_000
"""A controller keeps so many changes of a run's tool."""


class RemoteExecution:
    """One run of the controller's: the execution of a `Job`.

    The controller forgets old runs; what is kept here stays.
    """

    def __init__(self, loop: RemoteLoop, number: int) -> None:
        self._loop = loop
        self.number = number
        self._end: Message | None = None
        """How the run was, once it has ended."""
        self._tools_told = 0
        self._kept: tuple[_core.Log, Message] | None = None

    def _look(self) -> Message:
        if self._end is None:
            look = self._ask()
            if not look.ended:
                return look
            self._end = look
        return self._end

    def _ask(self) -> Message:
        return self._loop.call("GetRun", message("GetRunRequest", run=self.number), "RunState")

    def keep(self) -> None:
        """Fetch the log and the figures, while the controller has them, unless that was done."""
        if self._kept is None and self._look().ended:
            self._kept = (self._fetched_log(), self._fetched_report())

    def wait(self, timeout: float) -> bool:
        """Wait for the end, at most `timeout` [s].

        Raises
        ------
        DriveFaultError
            The drive failed.
        InputTimeoutError
            An input that the program waits for did not come in time.
        NotInControlError
            Control was lost; the run waits for what the next operator says.
        """
        deadline = time.monotonic() + timeout
        while True:
            look = self._look()
            if look.HasField("fault"):
                raise _wire.error_of(look.fault)
            if look.ended:
                return True
            self._loop.require_kept_control()
            left = deadline - time.monotonic()
            if left <= 0.0:
                return False
            time.sleep(min(left, LOOK))

    def _is_over(self) -> bool:
        """Tell whether a wish comes too late: it then changes nothing, as in one process.

        The controller would have it so, too, for as long as it keeps the run.
        """
        return self._end is not None and self._loop.has_control

    def _steer(self, wish: int) -> None:
        if self._is_over():
            return
        request = message("SteerRequest", token=self._loop.token, run=self.number, wish=wish)
        self._loop.call("Steer", request, "SteerReply")

    def pause(self) -> None:
        """Come to rest on the path."""
        self._steer(_STEERING["pause"])

    def resume(self) -> None:
        """Go on."""
        self._steer(_STEERING["resume"])

    def step(self) -> None:
        """Run to the end of the move, then pause."""
        self._steer(_STEERING["step"])

    def backward(self) -> None:
        """Go back along the path."""
        self._steer(_STEERING["backward"])

    def stop(self, category: int) -> None:
        """Come to rest on the path and end."""
        self._steer(_STOPS[category])

    def on_input(self, index: int, value: bool, action: str) -> None:
        """Act on an input, in the cycle after it is so; none for -1."""
        if self._is_over():
            return
        self._loop.call(
            "OnInput",
            message(
                "OnInputRequest",
                token=self._loop.token,
                run=self.number,
                input=index,
                value=value,
                wish=_REACTIONS[action],
            ),
            "OnInputReply",
        )

    @property
    def ended(self) -> bool:
        """True when the arm rests, and the log is complete."""
        return bool(self._look().ended)

    @property
    def state(self) -> str:
        """As `Job.state`."""
        return str(self._look().state)

    @property
    def nominal_time(self) -> float:
        """How far along the motion [s]."""
        return float(self._look().nominal_time)

    @property
    def duration(self) -> float:
        """Of the motion [s]."""
        return float(self._look().duration)

    @property
    def overruns(self) -> int:
        """Cycles that woke a whole cycle late or more."""
        return int(self._look().overruns)

    @property
    def move(self) -> int:
        """The program's step under way."""
        return int(self._look().move)

    def tell_tools(self, tools: Tools) -> None:
        """Tell the controller those tools of the run that it does not know, for who finds it."""
        new = tools[self._tools_told : _MOST_TOOLS]
        # The run does not hang on it: what could not be told, without control say, is left out.
        with contextlib.suppress(MotionError):
            for first in range(0, len(new), _RECORDS):
                part = new[first : first + _RECORDS]
                changes = message(
                    "ToolsPart",
                    move=[step for step, _ in part],
                    tool=np.concatenate([arm.tool.ravel() for _, arm in part]),
                )
                request = message(
                    "AddToolsRequest", token=self._loop.token, run=self.number, tools=changes
                )
                self._loop.call("AddTools", request, "AddToolsReply")
                self._tools_told += len(part)

    def tools(self, robot: Robot) -> Tools:
        """Ask which tools the run moves, and from which step on."""
        found: list[tuple[int, Robot]] = []
        while True:
            request = message("GetToolsRequest", run=self.number, offset=len(found), count=_RECORDS)
            part = self._loop.call("GetTools", request, "ToolsPart")
            if not part.move:
                return tuple(found)
            poses = np.array(part.tool).reshape(-1, 4, 4)
            found += [
                (step, robot.with_tool(pose)) for step, pose in zip(part.move, poses, strict=True)
            ]

    def log(self) -> _core.Log:
        """Return every cycle so far."""
        return self._fetched_log() if self._kept is None else self._kept[0]

    def report(self) -> Message:
        """Cycles, overruns, latencies and computing times so far."""
        return self._fetched_report() if self._kept is None else self._kept[1]

    def _fetched_log(self) -> _core.Log:
        """Fetch the log in parts."""
        parts: list[Message] = []
        start = 0
        while True:
            request = message("GetLogRequest", run=self.number, from_cycle=start, count=_RECORDS)
            part = self._loop.call("GetLog", request, "LogPart")
            if not part.cycle:
                return _core.Log.of_columns(columns_of(parts, self._loop.joints))
            parts.append(part)
            start = part.cycle[-1] + 1

    def _fetched_report(self) -> Message:
        request = message("GetReportRequest", run=self.number)
        return self._loop.call("GetReport", request, "RunReport")


def columns_of(parts: list[Message], joints: int) -> dict[str, npt.NDArray[Any]]:
    """Put the parts of a log together, column by column."""
    kinds: dict[str, type[np.generic]] = {
        **dict.fromkeys(("cycle", "outputs"), np.uint64),
        **dict.fromkeys(("stamp", "latency", "compute"), np.int64),
        **dict.fromkeys(("nominal_time", "rate"), np.float64),
        "move": np.int32,
        "state": np.uint8,
    }

    def column(name: str, kind: type[np.generic]) -> npt.NDArray[Any]:
        arrays = [np.array(getattr(part, name), dtype=kind) for part in parts]
        return np.concatenate([np.zeros(0, dtype=kind), *arrays])

    columns = {name: column(name, kind) for name, kind in kinds.items()}
    for name in ("q", "qd", "qdd", "qddd", "measured"):
        columns[name] = column(name, np.float64).reshape(-1, joints)
    return columns
