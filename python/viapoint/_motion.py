"""A planned motion: finished, immutable and proven."""

from __future__ import annotations

import os
from functools import cached_property
from typing import TYPE_CHECKING

from . import _core
from ._arguments import Vector, number
from ._least_dexterity import LeastDexterity, least_dexterity
from ._proven import CYCLE as CYCLE
from ._proven import Proven, tools_of
from ._report import Report
from ._ruling import Rule

if TYPE_CHECKING:
    from ._program import Program


class Motion(Proven):
    """What `Program.plan` returns. Threads: any, at once.

    Attributes
    ----------
    program : Program
        What was planned; steps told to it later are none of the motion.
    report : Report
        Warnings; for timed programs also the limits they break.
    """

    def __init__(
        self,
        core: _core.PlannedMotion,
        program: Program,
        told: _core.MotionProgram,
        report: Report,
    ) -> None:
        super().__init__(core, program.robot, tools_of(told, program.robot))
        self.program = program
        self._told = told
        self.report = report

    def __repr__(self) -> str:
        """Name and duration."""
        return f"<Motion {self.program.name!r}, {self.duration:.3f} s>"

    @property
    def knots(self) -> int:
        """Number of points that the path's polynomials join, both ends included."""
        return self._core.path_pieces + 1

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
