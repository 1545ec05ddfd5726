"""The controller's stand-in in virtual time: the same interpolator, nothing waits."""

from __future__ import annotations

import math

import numpy as np

from . import _core
from ._arguments import Vector
from ._job import RunReport


class VirtualExecution:
    """A run that has ended before anybody can look: `_core.simulate`'s records."""

    def __init__(self, log: _core.Log, duration: float, cycle: float) -> None:
        self._log = log
        self.duration = duration
        self._cycle = cycle
        columns = log.columns()
        self.state: str = _core.run_states()[int(columns["state"][-1])]
        self.nominal_time = float(columns["nominal_time"][-1])
        self.move = int(columns["move"][-1])
        self.last = np.array(columns["q"][-1])
        self.overruns = 0

    def wait(self, timeout: float) -> bool:
        """Return at once: it has ended."""
        return True

    def pause(self) -> None:
        """Do nothing: it has ended."""

    def resume(self) -> None:
        """Do nothing: it has ended."""

    def stop(self) -> None:
        """Do nothing: it has ended."""

    def log(self) -> _core.Log:
        """Return every cycle."""
        return self._log

    def report(self) -> RunReport:
        """Count the cycles; virtual time has no latencies."""
        cycles = len(self._log)
        return RunReport(
            cycles=cycles,
            overruns=0,
            latency_p50=math.nan,
            latency_p99=math.nan,
            latency_max=math.nan,
            compute_p50=math.nan,
            compute_p99=math.nan,
            compute_max=math.nan,
            wall_time=(cycles - 1) * self._cycle,
        )


class VirtualLoop:
    """Runs motions in virtual time, one after the other, refusing what the drive would refuse."""

    def __init__(self, start: Vector, cycle: float) -> None:
        self._cycle = cycle
        self.position = np.array(start)
        self.override = 1.0
        self.busy = False
        self.shortcomings: list[str] = []
        self.is_open = True

    @property
    def measured(self) -> Vector:
        """Joints where the last motion ended."""
        return self.position

    def run(self, motion: _core.PlannedMotion) -> VirtualExecution:
        """Simulate the motion to its end."""
        _core.admit(motion, self.position)
        # At an override of 0 the real arm would wait for ever; time here is not real, so go on.
        commands = [(0.0, "override", self.override)] if 0.0 < self.override < 1.0 else []
        log = _core.simulate(motion, commands, self._cycle)
        execution = VirtualExecution(log, motion.duration, self._cycle)
        self.position = execution.last
        return execution

    def close(self) -> None:
        """Disconnect."""
        self.is_open = False
