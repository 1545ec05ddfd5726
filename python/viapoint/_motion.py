"""A planned motion: finished, immutable and proven."""

from __future__ import annotations

import os
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, number, numbers_of
from ._least_dexterity import LeastDexterity, least_dexterity
from ._report import Report
from ._robot import Robot
from ._ruling import Rule
from ._samples import Samples
from .errors import BadArgumentError

if TYPE_CHECKING:
    from ._program import Program

CYCLE: float = _core.CYCLE
"""The controller's cycle [s]."""


Tools: TypeAlias = tuple[tuple[int, Robot], ...]


def tools_of(told: _core.MotionProgram, robot: Robot) -> Tools:
    """From which step on a program moves another tool, and the arm with that tool."""
    return tuple(
        (step, robot if tool is None else robot.with_tool(tool)) for step, tool in told.tools()
    )


class Motion:
    """What `Program.plan` returns. Threads: any, at once.

    Attributes
    ----------
    program : Program
        What was planned; steps told to it later are none of the motion.
    robot : Robot
        The arm that moves.
    tools : tuple of (int, Robot)
        From which step on the arm moves another tool, and the arm with that tool.
    report : Report
        Warnings; for timed programs also the limits they break.
    """

    def __init__(
        self,
        core: _core.PlannedMotion,
        program: Program,
        told: _core.MotionProgram,
        report: Report,
        tools: Tools | None = None,
    ) -> None:
        self._core = core
        self.program = program
        self._told = told
        self.report = report
        self.tools = tools_of(told, program.robot) if tools is None else tools

    def __repr__(self) -> str:
        """Name and duration."""
        return f"<Motion {self.program.name!r}, {self.duration:.3f} s>"

    @property
    def robot(self) -> Robot:
        """The arm that moves."""
        return self.program.robot

    @property
    def duration(self) -> float:
        """From the first setpoint to the last [s]."""
        return self._core.duration

    @property
    def pieces(self) -> int:
        """Number of polynomial pieces that the controller evaluates."""
        return self._core.pieces

    @property
    def knots(self) -> int:
        """Number of points that the path's polynomials join, both ends included."""
        return self._core.path_pieces + 1

    @property
    def certificate(self) -> _core.Certificate:
        """Proven bounds: worst velocity, acceleration and jerk a joint, path deviation, …."""
        return self._core.certificate

    @property
    def corners(self) -> list[_core.Corner]:
        """What became of each move's zone."""
        return self._core.corners

    @property
    def process_stretches(self) -> list[_core.ProcessStretch]:
        """Where moves with a `process_speed` could not hold it, in the order of time.

        Everywhere else on them the tool's speed is proven to lie within 1e-6 of it, and nowhere
        above.
        """
        return self._core.process_stretches

    @property
    def start(self) -> Vector:
        """Joints where the motion begins, (n,) [rad or m]."""
        first: Vector = self.at([0.0]).q[0]
        return first

    @property
    def end(self) -> Vector:
        """Joints where the motion ends, (n,) [rad or m]."""
        last: Vector = self.at([self.duration]).q[0]
        return last

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

    def least_dexterity(self, dt: float = 0.01) -> LeastDexterity:
        """Find the smallest manipulability, isotropy and the like along the motion, and when.

        Looked at every `dt`, then narrowed down between the neighbours: a narrower dip can be
        missed. ``certificate.manipulability`` is looked at on the pieces alone.

        Parameters
        ----------
        dt : float
            Step [s], above 0.

        Raises
        ------
        BadArgumentError
            dt is not positive and finite.
        UncontrolledError
            The robot has no kinematics.
        """
        return least_dexterity(self, number(dt, "dt", "s", above=0.0))

    def _samples(self, columns: dict[str, Vector]) -> Samples:
        # mypy takes a column for a possible robot; the extension gives t, q and derivatives only.
        return Samples(**columns, robot=self.robot, tools=self.tools)  # type: ignore[arg-type]

    @cached_property
    def rules(self) -> tuple[Rule, ...]:
        """Which limit of which joint holds the motion back, stretch by stretch in time.

        Each has ``start`` and ``end`` [s], ``kind`` ("velocity", "acceleration", "jerk"; "other"
        where none is at 95 % of what the move may use; "rest"), ``joint`` and ``share``.
        """
        from ._motion_file import motion_rules

        return tuple(motion_rules(self))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the motion and its proof into a file that ``viapoint verify`` proves anew.

        Parameters
        ----------
        path : str or path
            The file, by custom ``.motion.json``; written aside and renamed.

        Raises
        ------
        EmptyProgramError
            The motion has no pieces.
        FileError
            It cannot be written.
        """
        from ._motion_file import save_motion

        save_motion(self, path)

    def plot(self, path: str | os.PathLike[str], what: str = "proof") -> None:
        """Draw the motion into a picture file (.png, .svg or .pdf).

        Parameters
        ----------
        path : str or path
            The file to write.
        what : {"proof", "joints", "tool", "path"}
            The tool's path with its zones, every joint's share of its limits with what limits the
            motion when, and the deviation from the lines and curves; joint angles, velocities,
            accelerations and jerks against their limits; x, y, z of the tool with velocity and
            acceleration; or the tool's path in 3-D with approach vectors.

        Raises
        ------
        BadArgumentError
            Another word for `what`, or another ending of the file.
        FileError
            The file cannot be written.
        UncontrolledError
            "tool" or "path" of a robot without kinematics.
        """
        from ._plots import save_plot

        save_plot(self, path, what)
