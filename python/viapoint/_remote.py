"""The loop of a viapoint-controller in another process, with the words of the one in this."""

from __future__ import annotations

import contextlib
import getpass
import os
import socket
import threading
import time
import weakref
from collections.abc import Iterator

import numpy as np

from . import _core, _wire
from ._arguments import Vector
from ._observed import Observed
from ._remote_run import LOOK, RemoteExecution, columns_of
from ._remote_stream import RemoteOpenRun
from ._wire import Message, Wire, message
from .errors import NotInControlError, UnconnectedError

_BEATS = 4
"""So often an operator shows in each heartbeat that he is there."""
_PART = 1 << 19
"""Pieces go in messages of about so many bytes."""
_POSITIONS = 1 << 16
"""So many joint values of a hand's way go in a message."""
_PROOF = 600.0
"""So long [s] the controller may take to prove a motion before it runs it."""


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
        self._held: weakref.WeakSet[RemoteExecution] = weakref.WeakSet()
        """Runs begun here that the script has still hold of."""
        self._sending = threading.Lock()
        self.followed: RemoteOpenRun
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
        run = RemoteExecution(self, self._begin("Run", motion))
        self._held.add(run)
        return run

    def follow(self, motion: _core.PlannedMotion) -> RemoteOpenRun:
        """Do the same with a motion that gets longer while it runs."""
        self.followed = RemoteOpenRun(self, self._begin("Follow", motion))
        self._held.add(self.followed)
        return self.followed

    def _begin(self, method: str, motion: _core.PlannedMotion) -> int:
        last = self.last_run
        for run in list(self._held):
            if run.number < last:  # the controller keeps two runs
                run.keep()
        # Ctrl-C may come between the beginning and the answer: such a run is stopped at the end.
        self._started.add(last + 1)
        with self.sent(motion):
            request = message("RunRequest", token=self.token, fingerprint=self.about.fingerprint)
            return int(self.call(method, request, "RunReply", patience=_PROOF).run)

    @contextlib.contextmanager
    def sent(self, motion: _core.PlannedMotion) -> Iterator[None]:
        """Send the motion, and keep other threads from sending another until the block ends."""
        parts = _parts_of(_core.MotionPieces(motion))
        offset = 0
        with self._sending:
            for part in parts:
                request = message("AddPiecesRequest", token=self.token, offset=offset, pieces=part)
                self.call("AddPieces", request, "AddPiecesReply")
                offset += len(part)
            yield

    @property
    def has_control(self) -> bool:
        """True until control is known to be lost; never for one that watches."""
        return bool(self.token) and (self._heart is None or self._heart.loss is None)

    @property
    def inputs(self) -> int:
        """What the drive last reported, bit i for input i."""
        return int(self._state().inputs)

    def set_inputs(self, changed: int, on: int) -> None:
        """Switch inputs of a simulated drive."""
        request = message("SetInputsRequest", token=self.token, mask=changed, values=on)
        self.call("SetInputs", request, "SetInputsReply")

    @property
    def outputs(self) -> int:
        """What the drive was last told, bit i for output i."""
        return int(self._state().outputs)

    def switch_outputs(self, changed: int, on: int) -> None:
        """Switch outputs by hand."""
        request = message("SetOutputsRequest", token=self.token, mask=changed, values=on)
        self.call("SetOutputs", request, "SetOutputsReply")

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
    def newest_cycle(self) -> int:
        """Number of the last cycle."""
        return int(self._state().cycle)

    def observed(self, from_cycle: int, most: int) -> Observed:
        """Ask what was measured from a cycle on; the controller sends 1000 at once."""
        request = message("GetCyclesRequest", from_cycle=from_cycle, count=most)
        part = self.call("GetCycles", request, "CyclesPart")
        return (
            np.array(part.cycle, dtype=np.uint64),
            np.array(part.stamp, dtype=np.int64),
            np.array(part.measured).reshape(-1, self.joints),
            np.array(part.inputs, dtype=np.uint64),
            np.array(part.outputs, dtype=np.uint64),
        )

    def guide(self, positions: list[Vector]) -> None:
        """Move a simulated arm by hand, a position (n,) a cycle."""
        rows = _POSITIONS // self.joints
        with self._sending:
            for offset in range(0, len(positions), rows):
                request = message(
                    "GuideRequest",
                    token=self.token,
                    offset=offset,
                    positions=np.concatenate(positions[offset : offset + rows]),
                    begins=offset + rows >= len(positions),
                )
                self.call("Guide", request, "GuideReply")

    def let_go(self) -> None:
        """Take the hand off the simulated arm."""
        self.call("LetGo", message("LetGoRequest", token=self.token), "LetGoReply")

    @property
    def guided(self) -> bool:
        """True while a hand moves the arm."""
        return bool(self._state().guided)

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

    def fault_cycles(self) -> _core.Log:
        """Fetch the last cycles before the newest fault."""
        request = message("GetFaultCyclesRequest")
        part = self.call("GetFaultCycles", request, "LogPart")
        return _core.Log.of_columns(columns_of([part], self.joints))

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

    def found(self, number: int) -> RemoteExecution:
        """Return the controller's run of that number, whoever began it."""
        return RemoteExecution(self, number)

    @staticmethod
    def is_run(execution: object, number: int) -> bool:
        """Tell whether an execution is the controller's run of that number."""
        return isinstance(execution, RemoteExecution) and execution.number == number

    def close(self) -> None:
        """Give up control and hang up; a run that was begun here is stopped on its path first.

        The logs of runs that the script has still hold of are fetched.
        """
        if not self.is_open:
            return
        self.is_open = False
        try:
            self._leave()
            for run in list(self._held):
                run.keep()
        except UnconnectedError:
            pass  # what was fetched before stays
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
                    time.sleep(LOOK)
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
