"""A motion under way."""

from __future__ import annotations

import contextlib
import math
from dataclasses import dataclass
from typing import Literal, Protocol

from . import _core, _session
from ._arguments import choice, number
from ._motion import CYCLE, Motion
from ._run_log import RunLog
from ._signals import on_or_off, signal
from .errors import BadArgumentError, DriveFaultError, InputTimeoutError, NotInControlError

ENDED = ("finished", "stopped", "fault")
_SLICE = 0.05
"""So long [s] a wait stays in C++ before Python looks after its signals."""


class Execution(Protocol):
    """What a job needs of the controller: `_core.Job`, or its stand-in in virtual time."""

    def wait(self, timeout: float) -> bool: ...
    def pause(self) -> None: ...
    def resume(self) -> None: ...
    def step(self) -> None: ...
    def backward(self) -> None: ...
    def stop(self, category: int) -> None: ...
    def on_input(self, index: int, value: bool, action: str) -> None: ...
    @property
    def state(self) -> str: ...
    @property
    def nominal_time(self) -> float: ...
    @property
    def duration(self) -> float: ...
    @property
    def overruns(self) -> int: ...
    @property
    def move(self) -> int: ...
    def log(self) -> _core.Log: ...
    def report(self) -> _core.RunReport | RunReport: ...


@dataclass(frozen=True)
class RunReport:
    """Figures of one run; times in seconds, NaN where there was no clock to measure.

    Attributes
    ----------
    cycles, overruns : int
        Cycles run, and those that woke a whole cycle late or more.
    latency_p50, latency_p99, latency_max : float
        Wake-up after its due instant [s].
    compute_p50, compute_p99, compute_max : float
        The tick itself [s].
    wall_time : float
        First to last cycle [s].
    missed_cycles : int
        Cycles of the clock that overruns slept through: the run is later by so many.
    lost_records : int
        Cycles that found no room in the log.
    rested_cycles : int
        Cycles at rest that left no record: a rest leaves its first two.
    """

    cycles: int
    overruns: int
    latency_p50: float
    latency_p99: float
    latency_max: float
    compute_p50: float
    compute_p99: float
    compute_max: float
    wall_time: float
    missed_cycles: int
    lost_records: int
    rested_cycles: int


class Job:
    """One motion under way. Threads: any.

    Once it has ended there is nothing left to pause, resume or stop: such a wish changes nothing.

    Attributes
    ----------
    motion : Motion
        What runs.
    """

    def __init__(self, execution: Execution, motion: Motion, period: float = CYCLE) -> None:
        self._execution = execution
        self._period = period
        self._seen_to_end = False
        self.motion = motion

    def __repr__(self) -> str:
        """Name, state and progress."""
        return (
            f"<Job {self.name!r}, {self.state}, {self.nominal_time:.3f} of {self.duration:.3f} s>"
        )

    @property
    def name(self) -> str:
        """Name of the program that runs."""
        return self.motion.program.name

    @property
    def state(self) -> str:
        """``"running"``, ``"paused"``, ``"jogging"``, …: one of ``RunLog.STATES``."""
        return self._execution.state

    @property
    def ended(self) -> bool:
        """True when the arm is at rest and the job will not go on."""
        return self.state in ENDED

    @property
    def nominal_time(self) -> float:
        """How far along the motion the arm is [s]."""
        return self._execution.nominal_time

    @property
    def duration(self) -> float:
        """Nominal duration [s]."""
        return self._execution.duration

    @property
    def move(self) -> int:
        """Index of the program's step under way."""
        return self._execution.move

    @property
    def overruns(self) -> int:
        """Cycles so far that woke a whole cycle late or more."""
        return self._execution.overruns

    def wait(self, timeout: float | None = None) -> bool:
        """Wait for the end.

        Ctrl-C, or any other exception, while waiting brings the arm to rest on its path and then
        goes on up.

        Parameters
        ----------
        timeout : float, optional
            At most so long [s], 0 or longer; for ever when left out.

        Returns
        -------
        bool
            True when the job has ended (see `state`), False at the timeout.

        Raises
        ------
        BadArgumentError
            A timeout that is no number, negative or not finite.
        DriveFaultError
            The drive failed, or the controller does not answer any more.
        InputTimeoutError
            An input that the program waits for (`Program.wait_di`) did not come in time: the run
            has ended there, ``"stopped"``.
        NotInControlError
            Control of an arm in another process was lost: the run waits there, paused.
        """
        left = math.inf if timeout is None else number(timeout, "timeout", "s", least=0.0)
        session = _session.current()
        try:
            while True:
                # Counted in slices, not on a clock: virtual time has none.
                part = min(left, _SLICE)
                if self._execution.wait(part):
                    self._seen_to_end = True
                    session.waiting(self)
                    session.ended(self)
                    return True
                session.waiting(self)
                left -= part
                if left <= 0.0:
                    return False
        except (DriveFaultError, InputTimeoutError, NotInControlError):
            self._seen_to_end = True
            raise
        except BaseException:
            self._come_to_rest()
            raise

    def pause(self) -> None:
        """Come to rest on the path and stay there until `resume`."""
        self._execution.pause()

    def resume(self) -> None:
        """Go on after `pause`, `step` or `backward`.

        Where the arm was jogged away meanwhile it first returns to where it left the path, in a
        straight line in joint space (``"returning"``).
        """
        self._execution.resume()

    def step(self) -> None:
        """Run to the end of the move under way, then pause. Returns at once.

        A move that ends at rest ends the step exactly there; after one that is rounded into the
        next, the arm comes to rest as soon as it can.
        """
        self._execution.step()

    def backward(self) -> None:
        """Go back along the path, to its start at most, until told otherwise. Returns at once.

        The override holds backward, too. Outputs stay as they are, and on the way forward until
        the arm is past where it turned. At the start it is ``"paused"``.
        """
        self._execution.backward()

    def stop(self, category: int = 2) -> None:
        """Come to rest on the path; the job then ends as ``"stopped"``. Returns at once.

        Parameters
        ----------
        category : int
            2: the arm then holds its position, and the next program may start there. 1: the drive
            is released; connect again to go on.

        Raises
        ------
        BadArgumentError
            Another category. 0 is the drive's own: its power goes at once.
        """
        if category not in (1, 2) or isinstance(category, bool):
            raise BadArgumentError(
                f"The stop's category is {category!r}; it must be 1 or 2.",
                ways_out=["Category 0 is the drive's own emergency stop."],
            )
        self._execution.stop(category)

    def on_input(
        self,
        index: int,
        value: bool = True,
        action: Literal["pause", "resume", "stop"] = "pause",
    ) -> None:
        """Have the loop itself act on a digital input, in the cycle after the drive reports it.

        It acts once, also on an input that is so already. The last call for each action counts; a
        paused run keeps the rest of its path, and goes on by `resume` or by another input.

        Parameters
        ----------
        index : int
            Input, 0 to 63.
        value : bool
            When it is on, or when it is off.
        action : {"pause", "resume", "stop"}
            What to do.

        Raises
        ------
        BadArgumentError
            Another input or action.
        NotInControlError
            Of an arm in another process: control was lost.
        """
        wished = choice(action, "action", ("pause", "resume", "stop"))
        self._execution.on_input(signal(index), on_or_off(value, "input"), wished)

    @property
    def log(self) -> RunLog:
        """Every cycle so far; complete once the job has ended."""
        return RunLog.of(self._execution.log(), self.motion, self._period)

    @property
    def report(self) -> RunReport:
        """Cycles, overruns, latencies and computing times so far."""
        core = self._execution.report()
        return RunReport(**{name: getattr(core, name) for name in RunReport.__dataclass_fields__})

    def finish(self, stop: bool) -> None:
        """See the job to its end, unless that was done; stopped first, if asked or if it pauses."""
        if self._seen_to_end:
            return
        if stop:
            self.stop()
        # A pause may be a cycle old, and an override of 0 reached only later: look again and again,
        # and twice, for the arm also rests for a moment between a jog and the way back from it.
        was_paused = False
        while not self.wait(_SLICE):
            is_paused = self.state in ("pausing", "paused")
            if is_paused and was_paused:
                self.stop()
            was_paused = is_paused

    def _come_to_rest(self) -> None:
        """Stop and wait; a fault meanwhile is the drive's, which is then at rest, too."""
        with contextlib.suppress(NotInControlError):  # who only watches stops nothing
            self._execution.stop(2)
            while not self.ended:
                self._execution.wait(_SLICE)
