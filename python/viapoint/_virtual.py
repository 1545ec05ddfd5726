"""The controller's stand-in in virtual time: the same interpolator, nothing waits."""

from __future__ import annotations

import math
import time

import numpy as np

from . import _core
from ._arguments import Vector
from ._job import ENDED, RunReport
from ._robot import Robot
from .errors import BusyError, DriveFaultError

_STATES = _core.run_states()
_HOLD = 0.05
"""A call to jog, and a look at one, let so much time pass [s]: buttons are repeated that often."""
_LOOKS = 20
"""A motion is over after so many looks at it, so that a script which polls gets on."""
_NOTHING = np.zeros(0)


class VirtualExecution:
    """One run in virtual time.

    Time does not pass by itself: every look at the run lets a twentieth of the motion pass, and a
    wait lets pass what it would have waited. Commands take effect in the next cycle.
    """

    def __init__(self, motion: _core.PlannedMotion, override: float, cycle: float) -> None:
        self._motion = motion
        self._cycle = cycle
        self._step = math.ceil(motion.duration / cycle / _LOOKS)
        self._commands = [(0.0, "override", np.array([override]))]
        self.released = False
        self._now = 0
        self.duration = motion.duration
        self.overruns = 0
        self._simulate()

    def _simulate(self) -> None:
        """Look ahead to where the run ends, or rests, if no other command comes."""
        self._log = _core.simulate(self._motion, self._commands, self._cycle)
        self._columns = self._log.columns()

    def command(self, kind: str, values: Vector = _NOTHING) -> None:
        """Have a command take effect in the next cycle."""
        if self._state() not in ENDED:
            self._commands.append(((self._now + 1) * self._cycle, kind, values))
            self._simulate()

    @property
    def may_be_jogged(self) -> bool:
        """True where it rests after `pause`, or is being jogged there."""
        wishes = [kind for _, kind, _ in self._commands if kind not in ("override", "jog")]
        return wishes[-1:] == ["pause"] and self._state() in ("paused", "jogging")

    @property
    def jogging(self) -> bool:
        """True until a jog has come to rest."""
        return self._state() == "jogging"

    def pass_cycles(self, count: int) -> None:
        """Let time pass, at most until the run ends or rests."""
        self._now = min(self._now + count, len(self._log) - 1)

    def to_end(self) -> bool:
        """Let time pass until the run ends (True) or rests."""
        self.pass_cycles(len(self._log))
        return self._state() in ENDED

    def joints(self) -> Vector:
        """Joints now, (n,)."""
        return np.array(self._columns["q"][self._now])

    def _state(self) -> str:
        return _STATES[int(self._columns["state"][self._now])]

    @property
    def state(self) -> str:
        """State after a while has passed."""
        self.pass_cycles(self._step)
        return self._state()

    @property
    def nominal_time(self) -> float:
        """How far along the motion after a while has passed [s]."""
        self.pass_cycles(self._step)
        return float(self._columns["nominal_time"][self._now])

    @property
    def move(self) -> int:
        """The step under way after a while has passed."""
        self.pass_cycles(self._step)
        return int(self._columns["move"][self._now])

    def wait(self, timeout: float) -> bool:
        """Let `timeout` [s] pass; in earnest for a run that rests, as a thread may act."""
        self.pass_cycles(max(1, round(timeout / self._cycle)))
        if self._state() in ENDED:
            return True
        if self._now + 1 == len(self._log):
            time.sleep(timeout)
        return False

    def pause(self) -> None:
        """Come to rest on the path."""
        self.command("pause")

    def resume(self) -> None:
        """Go on."""
        self.command("resume")

    def step(self) -> None:
        """Run to the end of the move, then pause."""
        self.command("step")

    def backward(self) -> None:
        """Go back along the path."""
        self.command("backward")

    def stop(self, category: int) -> None:
        """Come to rest on the path and end."""
        self.released = self.released or (category == 1 and self._state() not in ENDED)
        self.command("stop")

    def log(self) -> _core.Log:
        """Return every cycle so far."""
        return self._log.head(self._now + 1)

    def report(self) -> RunReport:
        """Count the cycles; virtual time has no latencies."""
        return RunReport(
            cycles=self._now + 1,
            overruns=0,
            latency_p50=math.nan,
            latency_p99=math.nan,
            latency_max=math.nan,
            compute_p50=math.nan,
            compute_p99=math.nan,
            compute_max=math.nan,
            wall_time=self._now * self._cycle,
            missed_cycles=0,
            lost_records=0,
        )


class VirtualLoop:
    """Runs motions in virtual time, one after the other, refusing what the drive would refuse."""

    def __init__(self, robot: Robot, start: Vector, cycle: float) -> None:
        self._robot = robot
        self._cycle = cycle
        self._jog = _core.VirtualJog(robot._core, start, cycle=cycle)
        self._hold = math.ceil(_HOLD / cycle)
        self._override = 1.0
        self._run: VirtualExecution | None = None
        self._shortcomings: list[str] = []
        self.is_open = True

    def _require_open(self) -> None:
        if not self.is_open:
            raise DriveFaultError(
                "The arm is no longer connected.",
                ways_out=["Connect again: viapoint.connect(...)."],
            )

    def _require_power(self) -> None:
        self._require_open()
        if self._run is not None and self._run.released:
            raise DriveFaultError(
                "The drive was released by a stop of category 1.", ways_out=["Connect again."]
            )

    @property
    def fault(self) -> str:
        """Nothing: there is no drive to fail."""
        self._require_open()
        return ""

    @property
    def override(self) -> float:
        """Share of the planned speed."""
        self._require_open()
        return self._override

    @override.setter
    def override(self, share: float) -> None:
        self._require_open()
        self._override = share
        if self._run is not None:
            self._run.command("override", np.array([share]))

    @property
    def position(self) -> Vector:
        """Joints after a while has passed, (n,)."""
        self._require_open()
        if self._run is None:
            self._jog.pass_cycles(self._hold)
            return np.array(self._jog.position)
        self._run.state  # noqa: B018 -- the look lets time pass
        return self._run.joints()

    @property
    def measured(self) -> Vector:
        """The same: nothing lags in virtual time."""
        return self.position

    @property
    def busy(self) -> bool:
        """True while a run is under way."""
        self._require_open()
        return self._run is not None and self._run.state not in ENDED

    @property
    def shortcomings(self) -> list[str]:
        """Nothing: virtual time needs no rights."""
        self._require_open()
        return self._shortcomings

    def run(self, motion: _core.PlannedMotion) -> VirtualExecution:
        """Begin the motion; one before it, which the script may have slept through, goes on first.

        Raises
        ------
        BusyError
            The one before it rests without having ended.
        DriveFaultError
            The arm is closed.
        MotionError
            What the drive would refuse.
        """
        self._require_open()
        if self._run is not None:
            if not self._run.to_end():
                raise BusyError(
                    "A run is already under way.", ways_out=["Resume or stop it, and wait for it."]
                )
            self._require_power()
            self._end_run()
        if self._jog.jogging:
            raise BusyError(
                "the arm is being jogged", ways_out=["stop the jog, and wait until the arm rests"]
            )
        _core.admit(motion, self._jog.position)
        self._run = VirtualExecution(motion, self._override, self._cycle)
        return self._run

    def jog(self, velocity: Vector) -> None:
        """Jog, and let pass what a script usually lets pass until it calls again.

        Raises
        ------
        BusyError
            A run is under way, and does not rest in a pause.
        DriveFaultError
            The arm is closed, or released.
        VelocityLimitError
            A joint is asked for more than its velocity limit.
        """
        self._require_power()
        if self._run is not None and self._run.may_be_jogged:
            self._run.command("jog", velocity)
            self._run.pass_cycles(self._hold)
            return
        if self.busy:
            raise BusyError(
                "A run is under way, and the arm jogs only between runs and in a pause.",
                ways_out=[
                    "Wait for its end.",
                    "Pause it and wait until it rests.",
                    "Stop it first.",
                ],
            )
        self._end_run()
        self._jog.jog(velocity)
        self._jog.pass_cycles(self._hold)

    def _end_run(self) -> None:
        """Have the arm rest where its last run has ended."""
        if self._run is not None:
            rest, self._run = self._run.joints(), None
            self._jog = _core.VirtualJog(self._robot._core, rest, cycle=self._cycle)

    @property
    def jogging(self) -> bool:
        """True until a jog has come to rest, after a while has passed."""
        self._require_open()
        if self._run is not None:
            self._run.pass_cycles(self._hold)
            return self._run.jogging
        self._jog.pass_cycles(self._hold)
        return self._jog.jogging

    @property
    def jog_block(self) -> str:
        """What keeps the jog from doing what was asked, after a while has passed."""
        self._require_open()
        self._jog.pass_cycles(self._hold)
        return self._jog.jog_block

    def close(self) -> None:
        """Disconnect; a run under way is brought to rest on its path first."""
        if self._run is not None:
            self._run.stop(2)
            self._run.to_end()
        self.is_open = False
