"""The loop of a viapoint-controller in another process, with the words of the one in this."""

from __future__ import annotations

import getpass
import os
import socket
import threading
import time
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core, _wire
from ._arguments import Vector
from ._wire import Message, Wire, message
from .errors import NotInControlError, UnconnectedError

_LOOK = 0.005
"""A wait looks at the run so often [s]."""
_BEATS = 4
"""So often an operator shows in each heartbeat that he is there."""
_PART = 1 << 19
"""Pieces go in messages of about so many bytes."""
_PROOF = 600.0
"""So long [s] the controller may take to prove a motion before it runs it."""
_STEERING = {"pause": 1, "resume": 2, "step": 3, "backward": 4}
_STOPS = {2: 5, 1: 6}
"""Wish of a stop's category."""
_RECORDS = 1000


class Heart(threading.Thread):
    """Shows the controller that this process is there, until told otherwise.

    It beats from Python, so that a script whose interpreter hangs falls silent, too.
    """

    def __init__(self, wire: Wire, control: Message) -> None:
        super().__init__(name="viapoint heartbeat", daemon=True)
        self._wire = wire
        self._beat = message("BeatRequest", token=control.token)
        self._heartbeat = control.heartbeat
        self._stop_wish = threading.Event()
        self.loss: NotInControlError | None = None

    def run(self) -> None:
        """Beat until stopped, or until control is lost."""
        while not self._stop_wish.wait(self._heartbeat / _BEATS):
            try:
                self._wire.call("Beat", self._beat, "BeatReply", patience=self._heartbeat)
            except NotInControlError as error:
                self.loss = error
                return
            except UnconnectedError:
                continue  # the next may come through; if none does, control is lost

    def stop(self) -> None:
        """Beat no more."""
        self._stop_wish.set()
        if self.is_alive():
            self.join()


class RemoteExecution:
    """One run of the controller's: the execution of a `Job`."""

    def __init__(self, loop: RemoteLoop, number: int) -> None:
        self._loop = loop
        self.number = number

    def _look(self) -> Message:
        return self._loop.call("GetRun", message("GetRunRequest", run=self.number), "RunState")

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
            time.sleep(min(left, _LOOK))

    def _steer(self, wish: int) -> None:
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

    def log(self) -> _core.Log:
        """Fetch every cycle so far, in parts."""
        parts: list[Message] = []
        start = 0
        while True:
            request = message("GetLogRequest", run=self.number, from_cycle=start, count=_RECORDS)
            part = self._loop.call("GetLog", request, "LogPart")
            if not part.cycle:
                return _core.Log.of_columns(_columns(parts, self._loop.joints))
            parts.append(part)
            start = part.cycle[-1] + 1

    def report(self) -> Message:
        """Cycles, overruns, latencies and computing times so far."""
        request = message("GetReportRequest", run=self.number)
        return self._loop.call("GetReport", request, "RunReport")


def _columns(parts: list[Message], joints: int) -> dict[str, npt.NDArray[Any]]:
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


class RemoteLoop:
    """What an arm needs of the controller, over the network. Threads: any.

    Parameters
    ----------
    wire : Wire
        The connection; closed with the loop.
    watch : bool
        Only look, and leave control to others.
    """

    def __init__(self, wire: Wire, watch: bool) -> None:
        self._wire = wire
        self.about = self.call("GetRobot", message("GetRobotRequest"), "RobotReply")
        _require_same_version(self.about.version)
        self.joints = len(self._state().setpoint)
        self.token = ""
        self._heart: Heart | None = None
        self._started: set[int] = set()
        self._sending = threading.Lock()
        self.is_open = True
        if not watch:
            self._take_control()

    def _take_control(self) -> None:
        name = f"{_user()}@{socket.gethostname()}, process {os.getpid()}"
        request = message("TakeControlRequest", name=name, version=_core.__version__)
        control = self.call("TakeControl", request, "Control")
        self.token = control.token
        self._heart = Heart(self._wire, control)
        self._heart.start()

    def call(
        self, method: str, request: Message, reply: str, patience: float = _wire.PATIENCE
    ) -> Message:
        """As `Wire.call`."""
        return self._wire.call(method, request, reply, patience=patience)

    def _state(self) -> Message:
        return self.call("GetState", message("GetStateRequest"), "ArmState")

    def require_kept_control(self) -> None:
        """Raise how control was lost, where it was."""
        if self._heart is not None and self._heart.loss is not None:
            loss = self._heart.loss
            raise NotInControlError(loss.message, ways_out=loss.ways_out)

    def run(self, motion: _core.PlannedMotion) -> RemoteExecution:
        """Send the motion, have it proven there, and begin it."""
        parts = _parts_of(_core.MotionPieces(motion))
        offset = 0
        with self._sending:  # or another thread's motion would run in its place
            for part in parts:
                request = message("AddPiecesRequest", token=self.token, offset=offset, pieces=part)
                self.call("AddPieces", request, "AddPiecesReply")
                offset += len(part)
            request = message("RunRequest", token=self.token, fingerprint=self.about.fingerprint)
            number = self.call("Run", request, "RunReply", patience=_PROOF).run
        self._started.add(number)
        return RemoteExecution(self, number)

    def jog(self, velocity: Vector) -> None:
        """Turn the joints for the next 250 ms."""
        request = message("JogRequest", token=self.token, velocity=velocity.tolist())
        self.call("Jog", request, "JogReply")

    @property
    def override(self) -> float:
        """Share of the planned speed."""
        return float(self._state().override)

    @override.setter
    def override(self, share: float) -> None:
        request = message("SetOverrideRequest", token=self.token, share=share)
        self.call("SetOverride", request, "SetOverrideReply")

    @property
    def measured(self) -> Vector:
        """What the drive measured last, (n,)."""
        return np.array(self._state().measured)

    @property
    def observed(self) -> tuple[int, Vector, int, int]:
        """Of the last cycle: its stamp [ns], joints (n,), inputs and outputs."""
        now = self._state()
        return now.stamp, np.array(now.measured), now.inputs, now.outputs

    @property
    def position(self) -> Vector:
        """Where the arm is told to be, (n,)."""
        return np.array(self._state().setpoint)

    @property
    def busy(self) -> bool:
        """True while a run is under way."""
        return bool(self._state().busy)

    @property
    def jogging(self) -> bool:
        """True until a jog has come to rest."""
        return bool(self._state().jogging)

    @property
    def jog_block(self) -> str:
        """What keeps the jog from doing what was asked."""
        return str(self._state().jog_block)

    @property
    def fault(self) -> str:
        """What has failed; empty: nothing."""
        return str(self._state().fault)

    @property
    def shortcomings(self) -> list[str]:
        """Real-time rights that the controller could not have."""
        return list(self._state().shortcomings)

    @property
    def operator(self) -> str:
        """Who has control; empty: nobody."""
        return str(self._state().operator)

    @property
    def control_loss(self) -> str:
        """How control was lost last; empty: it never was."""
        return str(self._state().control_loss)

    @property
    def last_run(self) -> int:
        """Number of the controller's last run; 0: none yet."""
        return int(self._state().run)

    def close(self) -> None:
        """Give up control and hang up; a run that was begun here is stopped on its path first."""
        if not self.is_open:
            return
        self.is_open = False
        try:
            self._leave()
        finally:
            if self._heart is not None:
                self._heart.stop()
            self._wire.close()

    def _leave(self) -> None:
        """Stop what was begun here, and give up control, unless it was lost already."""
        if not self.token or (self._heart is not None and self._heart.loss is not None):
            return
        try:
            number = self.last_run
            if number in self._started:
                run = RemoteExecution(self, number)
                run.stop(2)
                while not run.ended:
                    time.sleep(_LOOK)
            request = message("GiveUpControlRequest", token=self.token)
            self.call("GiveUpControl", request, "GiveUpControlReply")
        except (NotInControlError, UnconnectedError):
            return  # lost meanwhile: the controller has seen to the arm by itself


def _require_same_version(there: str) -> None:
    """Refuse a controller of another major or minor version, whose words may mean other things."""
    if there.split(".")[:2] != _core.__version__.split(".")[:2]:
        raise UnconnectedError(
            f"The controller has viapoint {there}, this script {_core.__version__}; the first two "
            "numbers have to be the same.",
            ways_out=[f'Install the controller\'s here: pip install "viapoint=={there}".'],
        )


def _parts_of(pieces: _core.MotionPieces) -> list[list[Message]]:
    """Return the motion's pieces as messages, some in each part."""
    paths = np.asarray(pieces.coefficients)
    outputs: dict[int, list[Message]] = {}
    for index, output, value, seconds in pieces.outputs:
        outputs.setdefault(index, []).append(
            message("OutputChange", output=output, value=value, time=seconds)
        )
    waits = {
        index: message("InputWait", input=number, value=value, timeout=timeout)
        for index, number, value, timeout in pieces.waits
    }
    flat = paths.reshape(len(paths), -1).tolist()
    told = [
        message(
            "Piece",
            duration=duration,
            path=flat[path],
            timing=timing,
            move=move,
            outputs=outputs.get(index, []),
            wait=waits.get(index),
        )
        for index, (duration, path, timing, move) in enumerate(
            zip(
                pieces.durations.tolist(),
                pieces.path_of,
                pieces.timing.tolist(),
                pieces.moves,
                strict=True,
            )
        )
    ]
    count = max(1, _PART // (8 * paths[0].size + 256))
    return [told[i : i + count] for i in range(0, len(told), count)]


def _user() -> str:
    """Name whoever runs this script, for people."""
    try:
        return getpass.getuser()
    except (KeyError, OSError):  # an account without a name
        return str(os.getuid())
