"""What every planned stretch of motion has: states at any time, and its proof."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, number, numbers_of
from ._robot import Robot
from ._samples import Samples
from .errors import BadArgumentError

CYCLE: float = _core.CYCLE
"""The controller's cycle [s]."""


Tools: TypeAlias = tuple[tuple[int, Robot], ...]


def tools_of(told: _core.MotionProgram, robot: Robot) -> Tools:
    """From which step on a program moves another tool, and the arm with that tool."""
    return tuple(
        (step, robot if tool is None else robot.with_tool(tool)) for step, tool in told.tools()
    )


class ToldTools:
    """The tools of steps that are told without end: one arm for each that is different.

    Parameters
    ----------
    told : MotionProgram
        The steps so far.
    robot : Robot
        The arm with its own tool.
    """

    def __init__(self, told: _core.MotionProgram, robot: Robot) -> None:
        self._robot = robot
        self._arms: dict[bytes, Robot] = {}
        self._present = robot
        self._changes: list[tuple[int, Robot]] = []
        self.add(told, 0, 0)

    def add(self, told: _core.MotionProgram, kept: int, first: int) -> None:
        """Take what follows the `kept` steps of `told`: steps from `first` on of all."""
        for step, tool in told.tools():
            if step < kept:
                continue
            arm = self._robot if tool is None else self._arm(tool)
            if arm is not self._present:
                self._changes.append((first + step - kept, arm))
            self._present = arm

    def _arm(self, tool: Vector) -> Robot:
        key = tool.tobytes()
        if key not in self._arms:
            self._arms[key] = self._robot.with_tool(tool)
        return self._arms[key]

    @property
    def changes(self) -> Tools:
        """From which step on the arm moves another tool, and the arm with that tool."""
        return tuple(self._changes)


class Proven:
    """Finished, immutable and proven. Threads: any, at once.

    Attributes
    ----------
    robot : Robot
        The arm that moves.
    tools : tuple of (int, Robot)
        From which step on the arm moves another tool, and the arm with that tool.
    """

    def __init__(self, core: _core.PlannedMotion, robot: Robot, tools: Tools) -> None:
        self._core = core
        self.robot = robot
        self.tools = tools

    @property
    def duration(self) -> float:
        """From the first setpoint to the last [s]."""
        return self._core.duration

    @property
    def pieces(self) -> int:
        """Number of polynomial pieces that the controller evaluates."""
        return self._core.pieces

    @property
    def certificate(self) -> _core.Certificate:
        """Proven bounds: worst velocity, acceleration and jerk a joint, path deviation, …."""
        return self._core.certificate

    @property
    def corners(self) -> list[_core.Corner]:
        """What became of each move's zone; of a chunk, of those decided since the one before."""
        return self._core.corners

    @property
    def process_stretches(self) -> list[_core.ProcessStretch]:
        """Where moves with a `process_speed` could not hold it, in the order of time.

        Everywhere else on them the tool's speed is proven to lie within 1e-6 of it, and nowhere
        above.
        A chunk has what has become known since the one before: each stretch when it is known when
        the chunk it lies in is left. Its times count from the beginning of the first chunk.
        """
        return self._core.process_stretches

    def sample(self, dt: float = CYCLE) -> Samples:
        """States at 0, dt, 2 dt, … and at the exact end (the last step may be shorter).

        Parameters
        ----------
        dt : float
            Step [s], above 0.

        Raises
        ------
        BadArgumentError
            dt is not positive and finite, or asks for more than 1e8 samples.
        """
        return self._samples(self._core.sample(number(dt, "dt", "s", above=0.0)))

    def at(self, times: ArrayLike) -> Samples:
        """States at the given instants; before the start and after the end, the ends.

        Parameters
        ----------
        times : array_like, (k,)
            Ascending [s].

        Raises
        ------
        BadArgumentError
            No numbers at all, not ascending, or not finite.
        """
        instants = np.asarray(times)
        if instants.size == 0:
            raise BadArgumentError("times is empty; it must hold one instant or more.")
        return self._samples(self._core.sample_at(numbers_of(times, "times").reshape(-1)))

    def _samples(self, columns: dict[str, Vector]) -> Samples:
        # mypy takes a column for a possible robot; the extension gives t, q and derivatives only.
        return Samples(**columns, robot=self.robot, tools=self.tools)  # type: ignore[arg-type]  # columns by name
