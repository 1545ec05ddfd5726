"""The controller's stand-in in virtual time: the same loop, guard and all, and nothing waits."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np

from . import _core
from ._arguments import Vector
from ._job import ENDED, RunReport
from ._observed import Observed
from ._robot import Robot
from .errors import BusyError

_HOLD = 0.05
"""A call to jog, and a look at a jog or a stream, let so much time pass [s], as between calls."""
_LOOKS = 20
"""A program is over after so many looks at it, so that a script which polls gets on."""
_SLICE = 5
"""So many cycles pass at most before a stream hands over what is due."""


class VirtualExecution:
    """One run in virtual time.

    Time does not pass by itself: every look at the run lets some pass, and a wait lets pass what it
    would have waited. Commands take effect in the next cycle.

    Parameters
    ----------
    job : Job
        The run.
    loop : VirtualLoop
        Where it runs.
    look : int
        Cycles that pass with every look.
    """

    def __init__(self, job: _core.Job, loop: VirtualLoop, look: int) -> None:
        self._job = job
        self._loop = loop
        self._cycles = look

    @property
    def awaited(self) -> tuple[int, bool, float] | None:
        """Input, value and time-out [s] that the run rests for."""
        return self._job.awaited

    def _look(self) -> None:
        if self._job.state not in ENDED:
            self._loop.pass_cycles(self._cycles)

    @property
    def state(self) -> str:
        """State after a while has passed."""
        self._look()
        return self._job.state

    @property
    def nominal_time(self) -> float:
        """How far along the motion after a while has passed [s]."""
        self._look()
        return self._job.nominal_time

    @property
    def move(self) -> int:
        """The step under way after a while has passed."""
        self._look()
        return self._job.move

    @property
    def duration(self) -> float:
        """Nominal duration [s]."""
        return self._job.duration

    @property
    def overruns(self) -> int:
        """None: virtual time is never late."""
        return self._job.overruns

    def wait(self, timeout: float) -> bool:
        """Let `timeout` [s] pass; in earnest for a run that rests, as a thread may act."""
        wanted = max(1, round(timeout / self._loop.cycle))
        passed = 0 if self._job.state in ENDED else self._loop.pass_cycles(wanted)
        if self._job.state in ENDED:
            return self._job.wait(0.0)
        if passed < wanted:
            time.sleep(timeout)
        return False

    def pause(self) -> None:
        """Come to rest on the path."""
        self._job.pause()

    def resume(self) -> None:
        """Go on."""
        self._job.resume()

    def step(self) -> None:
        """Run to the end of the move, then pause."""
        self._job.step()

    def backward(self) -> None:
        """Go back along the path."""
        self._job.backward()

    def stop(self, category: int) -> None:
        """Come to rest on the path and end."""
        self._job.stop(category)

    def on_input(self, index: int, value: bool, action: str) -> None:
        """Act on an input, in the cycle after it is so."""
        self._job.on_input(index, value, action)

    def log(self) -> _core.Log:
        """Return every cycle so far."""
        return self._job.log()

    def report(self) -> RunReport:
        """Count the cycles; virtual time has no latencies."""
        core = self._job.report()
        return RunReport(
            cycles=core.cycles,
            overruns=0,
            latency_p50=math.nan,
            latency_p99=math.nan,
            latency_max=math.nan,
            compute_p50=math.nan,
            compute_p99=math.nan,
            compute_max=math.nan,
            wall_time=core.wall_time,
            missed_cycles=0,
            lost_records=core.lost_records,
            rested_cycles=core.rested_cycles,
        )


class VirtualLoop:
    """Runs motions in virtual time, one after the other, refusing what the drive would refuse.

    Attributes
    ----------
    core : VirtualLoop
        The same in C++.
    cycle : float
        [s]
    feed : callable, optional
        Called as time passes: hands over what a stream is to hand over.
    look : callable, optional
        Called after every cycle, while somebody records.
    """

    def __init__(
        self,
        robot: Robot,
        drive: _core.SimulatedSetup,
        cycle: float,
        tool_speed: float = math.inf,
        workspace: tuple[Vector, Vector] | None = None,
    ) -> None:
        beyond = np.full(3, math.inf)
        low, high = (-beyond, beyond) if workspace is None else workspace
        self.core = _core.VirtualLoop(
            robot._core,
            drive,
            cycle=cycle,
            silent_cycles=0,
            tool_speed=tool_speed,
            box_min=low,
            box_max=high,
        )
        self.cycle = cycle
        self.feed: Callable[[], None] | None = None
        self.look: Callable[[], object] | None = None
        self._hold = math.ceil(_HOLD / cycle)
        self._run: VirtualExecution | None = None
        self._shortcomings: list[str] = []

    def pass_cycles(self, count: int) -> int:
        """Let time pass until a run ends or nothing moves; return how many cycles have passed."""
        passed = 0
        while passed < count:
            part = count - passed if self.feed is None else min(_SLICE, count - passed)
            if self.look is not None:
                part = 1
            passed += (came := self.core.pass_cycles(part))
            if self.look is not None:
                self.look()
            if self.feed is not None:
                self.feed()
            rests = came < part or (self.look is not None and self._rests())
            if rests and not self._answer():
                break
        return passed

    def _rests(self) -> bool:
        """Tell whether nothing moves until somebody says so."""
        if self.core.jogging or self.core.guided:
            return False
        return not self.core.busy or (
            self._run is not None and self._run._job.state in ("paused", "waiting")
        )

    def _answer(self) -> bool:
        """Switch the input that the run waits for: nobody else would. False where it does not."""
        awaited = None if self._run is None else self._run.awaited
        if awaited is None:
            return False
        bit = 1 << awaited[0]
        self.core.set_inputs(bit, bit if awaited[1] else 0)
        return True

    def streamed(self, job: _core.Job) -> VirtualExecution:
        """Return the run of a stream, which has begun; nobody knows how long it will be."""
        self._run = VirtualExecution(job, self, self._hold)
        return self._run

    @property
    def is_open(self) -> bool:
        """True until `close`."""
        return self.core.is_open

    @property
    def fault(self) -> str:
        """What the guard has found, in a sentence; empty while it has found nothing."""
        return self.core.fault

    def fault_cycles(self) -> _core.Log:
        """Return the last cycles before the fault."""
        return self.core.fault_cycles()

    @property
    def override(self) -> float:
        """Share of the planned speed."""
        return self.core.override

    @override.setter
    def override(self, share: float) -> None:
        self.core.override = share

    def _look(self) -> None:
        """Let a while pass: of the run under way, or of a jog."""
        if self._run is not None and self.core.busy:
            self._run.state  # noqa: B018 -- the look lets time pass
        else:
            self.pass_cycles(self._hold)

    @property
    def position(self) -> Vector:
        """Joints after a while has passed, (n,)."""
        self._look()
        return self.core.position

    @property
    def inputs(self) -> int:
        """Digital inputs after a while has passed, bit i for input i."""
        self._look()
        return self.core.inputs

    def set_inputs(self, changed: int, on: int) -> None:
        """Switch inputs."""
        self.core.set_inputs(changed, on)

    @property
    def outputs(self) -> int:
        """Digital outputs after a while has passed, bit i for output i."""
        self._look()
        return self.core.outputs

    def switch_outputs(self, changed: int, on: int) -> None:
        """Switch outputs by hand."""
        self.core.switch_outputs(changed, on)

    @property
    def measured(self) -> Vector:
        """What the drive measured last, after a while has passed, (n,)."""
        self._look()
        return self.core.measured

    @property
    def newest_cycle(self) -> int:
        """Number of the last cycle. No time passes."""
        return self.core.newest_cycle

    def observed(self, from_cycle: int, most: int) -> Observed:
        """Return what was measured from a cycle on. No time passes."""
        return self.core.observed(from_cycle, most)

    def guide(self, positions: list[Vector]) -> None:
        """Move the arm by hand, a position (n,) a cycle."""
        self.core.guide(positions)

    def let_go(self) -> None:
        """Take the hand off the arm."""
        self.core.let_go()

    @property
    def guided(self) -> bool:
        """True while a hand moves the arm, after a while has passed."""
        self._look()
        return self.core.guided

    @property
    def datagrams(self) -> dict[str, int]:
        """None: nothing leaves the process."""
        return {}

    @property
    def busy(self) -> bool:
        """True while a run is under way."""
        self._look()
        return self.core.busy

    @property
    def shortcomings(self) -> list[str]:
        """Nothing: virtual time needs no rights."""
        self.core.fault  # noqa: B018 -- refuses where the arm is closed
        return self._shortcomings

    def run(self, motion: _core.PlannedMotion) -> VirtualExecution:
        """Begin the motion; one before it, which the script may have slept through, goes on first.

        Raises
        ------
        BusyError
            The one before it rests without having ended.
        DriveFaultError
            The arm is closed, or has failed.
        MotionError
            What the drive would refuse.
        """
        self.see_to_end()
        job = self.core.run(motion)
        self._run = VirtualExecution(job, self, math.ceil(job.duration / self.cycle / _LOOKS))
        return self._run

    def see_to_end(self) -> None:
        """Let the run under way go on to its end.

        Raises
        ------
        BusyError
            It rests without having ended.
        """
        while self.core.busy:
            if self.pass_cycles(self._hold) < self._hold and self.core.busy:
                raise BusyError(
                    "A run is already under way.", ways_out=["Resume or stop it, and wait for it."]
                )

    def jog(self, velocity: Vector) -> None:
        """Jog, and let pass what a script usually lets pass until it calls again.

        Raises
        ------
        BusyError
            A run is under way, and does not rest in a pause.
        DriveFaultError
            The arm is closed, released, or has failed.
        VelocityLimitError
            A joint is asked for more than its velocity limit.
        """
        if self.core.busy:
            self._look()
        self.core.jog(velocity)
        self.pass_cycles(self._hold)

    @property
    def jogging(self) -> bool:
        """True until a jog has come to rest, after a while has passed."""
        self.pass_cycles(self._hold)
        return self.core.jogging

    @property
    def jog_block(self) -> str:
        """What keeps the jog from doing what was asked, after a while has passed."""
        self.pass_cycles(self._hold)
        return self.core.jog_block

    def close(self) -> None:
        """Disconnect; a run under way is brought to rest on its path first."""
        if self._run is not None and self.core.is_open:
            self._run.stop(2)
            while self.core.busy:
                self.pass_cycles(self._hold)
        self.core.close()
