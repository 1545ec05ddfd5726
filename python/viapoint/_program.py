"""Motion programs: what the arm shall do, in order."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TypedDict

from . import _core, _session
from ._arguments import ArrayLike, file_name, number
from ._chunks import Chunk, chunks_of
from ._motion import Motion
from ._report import Report
from ._robot import Robot, load_robot
from ._work_steps import WorkSteps
from ._zone import ZoneLike
from .errors import BadArgumentError, BadProgramError, MotionError
from .frames import Frame, Tool


class ProgramOptions(TypedDict, total=False):
    """What a `Program` may be told besides its robot and its start."""

    speed: float | None
    acceleration: float | None
    angular_speed: float | None
    angular_acceleration: float | None
    scale: float | None
    zone: ZoneLike
    name: str
    position_tolerance: float
    angle_tolerance: float
    frame: Frame | ArrayLike | None
    tool: Tool | ArrayLike | None


class Program(WorkSteps):
    """A list of moves, waits and outputs for one robot.

    The builders return the program itself, so that they can be chained. They check types, shapes
    and finiteness at once; what needs kinematics, limits or neighbours is found by `check` and
    raised by `plan`.

    Parameters
    ----------
    robot : Robot
        The arm to move.
    start : array_like, (n,)
        Joints where the program begins [rad or m].
    speed, acceleration : float, optional
        Default for Cartesian moves, at the tool's point [m/s], [m/s²]. Default: the limits only.
    angular_speed, angular_acceleration : float, optional
        Likewise, of the tool's turning [rad/s], [rad/s²].
    scale : float, optional
        Default share of all joint limits, in (0, 1].
    zone : Zone, float or "fine"
        Default zone of every move; the last move of a program always stops.
    name : str
        For people and for the names of files.
    position_tolerance, angle_tolerance : float
        Lines and curves stay proven within this [m], [rad].
    frame : Frame or array_like, (4, 4), optional
        As the first `set_frame` would have it.
    tool : Tool or array_like, (4, 4), optional
        As the first `set_tool` would have it.

    Raises
    ------
    BadArgumentError
        By the argument's name.
    """

    def __init__(
        self,
        robot: Robot,
        *,
        start: ArrayLike,
        speed: float | None = None,
        acceleration: float | None = None,
        angular_speed: float | None = None,
        angular_acceleration: float | None = None,
        scale: float | None = None,
        zone: ZoneLike = "fine",
        name: str = "program",
        position_tolerance: float = _core.POSITION_TOLERANCE,
        angle_tolerance: float = _core.ANGLE_TOLERANCE,
        frame: Frame | ArrayLike | None = None,
        tool: Tool | ArrayLike | None = None,
    ) -> None:
        super().__init__(
            robot,
            start=start,
            speed=speed,
            acceleration=acceleration,
            angular_speed=angular_speed,
            angular_acceleration=angular_acceleration,
            scale=scale,
            zone=zone,
        )
        self.name = name
        self._core.set_tolerance(
            number(position_tolerance, "position_tolerance", "m", above=0.0),
            number(angle_tolerance, "angle_tolerance", "rad", above=0.0),
        )
        if frame is not None:
            self.set_frame(frame)
        if tool is not None:
            self.set_tool(tool)

    def __repr__(self) -> str:
        """Name, robot and number of steps."""
        return f"<Program {self.name!r} for {self.robot.name}, {len(self)} steps>"

    def check(self) -> Report:
        """Look at every step without moving anything.

        Returns
        -------
        Report
            Every problem at once, each with the script's line, and what would make it right.
        """
        report = Report(_core.check(self.robot._core, self._core))
        _session.current().checked(self, report)
        return report

    def plan(self) -> Motion:
        """Plan and prove the motion.

        Raises
        ------
        MotionError
            The first error of the report.
        """
        told = self._core.copy()
        try:
            core = _core.plan(self.robot._core, told)
        except MotionError as error:
            _session.current().refused(self, error)
            raise
        motion = Motion(core, self, told, Report(core.problems))
        _session.current().planned(motion)
        return motion

    def chunks(self, moves: Iterable[object] = ()) -> Iterator[Chunk]:
        """Plan in chunks, while the program is told: the first is there after a few moves.

        The path is that of `plan`; its timing is made in windows. Every chunk ends at rest on the
        path, so that the arm may always stop where nothing more comes.

        Parameters
        ----------
        moves : iterable
            Adds steps to this program each time that it is asked for its next item, whatever that
            is: ``program.chunks(program.movej(q) for q in points)``. Such steps are planned and
            then dropped, so that memory does not grow with their number.

        Yields
        ------
        Chunk
            With the time at which the chunk before is left for it.

        Raises
        ------
        MotionError
            The first error, where it is met; all chunks before it are good.
        """
        return chunks_of(self, moves)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the program as JSON, for `load` and for ``viapoint-controller``.

        The file is written aside and renamed: a reader sees the old file or the new one.

        Raises
        ------
        FileError
            With the path and the system's reason.
        """
        self._core.save(file_name(path))

    @classmethod
    def load(cls, path: str | os.PathLike[str], robot: Robot | None = None) -> Program:
        """Read a program that `save` wrote.

        Parameters
        ----------
        path : str or path
            The file.
        robot : Robot, optional
            The arm; by default the built-in one the file names.

        Raises
        ------
        FileError
            The file cannot be read.
        BadProgramError
            The file is damaged, or was written for another robot.
        """
        name = file_name(path)
        core = _core.load_program(name)
        arm = load_robot(core.robot) if robot is None else robot
        if core.robot_fingerprint and core.robot_fingerprint != arm.fingerprint:
            raise BadProgramError(
                f'The program was written for the robot "{core.robot}" with fingerprint '
                f'{core.robot_fingerprint}; "{arm.name}" has {arm.fingerprint}.',
                file=name,
                ways_out=[
                    "Pass the robot it was written for: Program.load(path, robot), or --robot FILE."
                ],
            )
        if len(core.start) != arm.joints:
            raise BadProgramError(
                f'The start has {len(core.start)} values; "{arm.name}" has {arm.joints} joints.',
                file=name,
                ways_out=['Give "start" one value a joint.', "Pass the robot it was written for."],
            )
        program = cls(arm, start=core.start, name=Path(name).stem)
        program._core = core
        return program


def motion_of(program: Program | Motion) -> Motion:
    """Return the motion itself, or that of a program.

    Raises
    ------
    BadArgumentError
        Neither of the two.
    MotionError
        What `Program.plan` raises.
    """
    if isinstance(program, Motion):
        return program
    if isinstance(program, Program):
        return program.plan()
    raise BadArgumentError(f"program is {program!r}; it must be a Program or a Motion.")
