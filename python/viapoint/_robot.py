"""Robots: what an arm is, where its tool is, and which joints bring it there."""

from __future__ import annotations

import os
from typing import cast

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, file_name, integer, numbers_of, pose, shown, vector
from ._envelope import joint_envelope
from ._workspace import Workspace
from .errors import (
    BadArgumentError,
    CouplingLimitError,
    JointLimitError,
)
from .frames import Tool, tool_of

_SLACK = 1e-9
"""Joints this far outside a limit [rad or m] are at it, but for rounding."""


class Robot(Workspace):
    """An arm: chain, limits, forward and inverse kinematics. Immutable.

    Made by `load_robot` and `joint_robot`. Angles are in radians, lengths in metres; poses are
    ``pose_base_tool``, (4, 4). Threads: any, at once.
    """

    def __repr__(self) -> str:
        """Name and number of joints."""
        return f"<Robot {self.name}, {self.joints} joints>"

    @property
    def name(self) -> str:
        """Short name, e.g. ``"puma560"``."""
        return self._core.name

    @property
    def title(self) -> str:
        """One line for people."""
        return self._core.title

    @property
    def joints(self) -> int:
        """Number of joints, n."""
        return self._core.joints

    @property
    def joint_names(self) -> list[str]:
        """Names of the joints, n of them."""
        return self._core.joint_names

    @property
    def prismatic(self) -> list[bool]:
        """Which joints slide (metres) rather than turn (radians), n of them."""
        return self._core.prismatic

    @property
    def sources(self) -> list[str]:
        """Where the description's numbers come from."""
        return self._core.sources

    @property
    def chosen(self) -> list[str]:
        """The numbers that nobody publishes, and why these were chosen."""
        return self._core.chosen

    @property
    def limits(self) -> _core.JointLimits:
        """The joint limits: ``position_min``, ``position_max``, ``velocity``, … each (n,)."""
        return self._core.limits

    def joint_envelope(self, first: int, second: int, *, at: ArrayLike | None = None) -> Vector:
        """Corners of what two joints may be together, under position and coupled limits.

        Parameters
        ----------
        first, second : int
            The two joints, from 0.
        at : array_like, (n,), optional
            Where the other joints stand [rad or m]; coupled limits count them. Default: zero.

        Returns
        -------
        ndarray, (k, 2)
            Corners of a convex polygon, in turn [rad or m]; (0, 2) where the others leave nothing.

        Raises
        ------
        BadArgumentError
            No two joints, or one without position limits.
        """
        i = integer(first, "first", 0, self.joints - 1)
        j = integer(second, "second", 0, self.joints - 1)
        if i == j:
            raise BadArgumentError(f"first and second are both {i}; they must be two joints.")
        place = np.zeros(self.joints) if at is None else vector(at, "at", self.joints)
        return joint_envelope(self.limits, i, j, place)

    @property
    def has_kinematics(self) -> bool:
        """False for `joint_robot`: then every question about poses is refused."""
        return self._core.has_kinematics

    @property
    def fingerprint(self) -> str:
        """Hash of chain, limits and tool: two robots with the same one move alike."""
        return self._core.fingerprint

    @property
    def base(self) -> Vector:
        """Where the arm stands, (4, 4) [m]: its base in the frame that all poses are told in."""
        return self._core.base

    @property
    def tool(self) -> Vector:
        """pose_flange_tool, (4, 4) [m]."""
        return self._core.tool

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the robot as a .yaml file that `load_robot` reads back: the same fingerprint.

        So an arm with limits or a tool of its own leaves Python: ``viapoint --robot`` and
        ``viapoint-controller --robot`` take the file. It is written aside and renamed.

        Raises
        ------
        BadArgumentError
            A file that does not end in .yaml.
        FileError
            With the path and the system's reason.
        """
        name = file_name(path)
        if not name.endswith(".yaml"):
            raise BadArgumentError(f'path is "{name}"; a robot\'s file ends in .yaml.')
        _core.write_file_atomically(name, self._core.to_yaml())

    def with_limits(
        self,
        *,
        position_min: ArrayLike | None = None,
        position_max: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        jerk: ArrayLike | None = None,
    ) -> Robot:
        """Return the same arm under other limits; what is not given stays.

        Parameters
        ----------
        position_min, position_max, velocity, acceleration, jerk : array_like, optional
            One number for all joints, or (n,) [rad or m, and per s, s², s³].

        Raises
        ------
        BadLimitsError
            Limits of zero, swapped or not finite, by joint.
        """
        old = self.limits
        n = self.joints
        return Robot(
            self._core.with_limits(
                _core.JointLimits(
                    position_min=_each(position_min, "position_min", n, old.position_min),
                    position_max=_each(position_max, "position_max", n, old.position_max),
                    velocity=_each(velocity, "velocity", n, old.velocity),
                    acceleration=_each(acceleration, "acceleration", n, old.acceleration),
                    jerk=_each(jerk, "jerk", n, old.jerk),
                    coupling=old.coupling,
                    coupling_lower=old.coupling_lower,
                    coupling_upper=old.coupling_upper,
                )
            )
        )

    def with_tool(self, tool: ArrayLike | Tool) -> Robot:
        """Return the same arm with another tool in the place of its own.

        Parameters
        ----------
        tool : array_like, (4, 4), or Tool
            pose_flange_tool [m]; `viapoint.frames` finds it by touching a point.

        Raises
        ------
        BadArgumentError, NotARotationError
            No pose.
        UncontrolledError
            The robot has no kinematics.
        """
        return Robot(self._core.with_tool(tool_of(tool).pose))

    def with_base(self, base: ArrayLike) -> Robot:
        """Return the same arm standing elsewhere: every pose is then told in the world frame.

        Parameters
        ----------
        base : array_like, (4, 4)
            pose_world_base [m]; it takes the place of any earlier one.

        Raises
        ------
        BadArgumentError, NotARotationError
            No pose.
        UncontrolledError
            The robot has no kinematics.
        """
        return Robot(self._core.with_base(pose(base, "base")[0]))


def load_robot(name_or_path: str | os.PathLike[str], *, tip: str | None = None) -> Robot:
    """Load a robot.

    Parameters
    ----------
    name_or_path : str or path
        A built-in name (``"puma560"``; the command ``viapoint robots`` lists them), or a file that
        ends in ``.yaml`` or ``.urdf``.
    tip : str, optional
        The link of a URDF that carries the tool. Default: its only leaf that moves.

    Raises
    ------
    BadRobotError
        A description with an error: file, line or key, and what was expected.
    FileError
        No such file.
    """
    if not isinstance(name_or_path, (str, os.PathLike)):
        raise BadArgumentError(
            f'name_or_path is {name_or_path!r}; it must be a name such as "puma560", or a file.'
        )
    return Robot(_core.load_robot(os.fspath(name_or_path), tip or ""))


def require_robot(robot: object) -> Robot:
    """Return `robot`, which must be a Robot.

    Raises
    ------
    BadArgumentError
        It is something else, such as a name.
    """
    if not isinstance(robot, Robot):
        raise BadArgumentError(
            f"robot is {robot!r}; it must be a Robot.", ways_out=["Use load_robot(name)."]
        )
    return robot


def require_within_limits(robot: Robot, q: Vector, name: str, ways_out: list[str]) -> None:
    """Refuse joints `q` (n,) [rad or m] outside the position or coupled limits.

    Raises
    ------
    JointLimitError, CouplingLimitError
        By `name`, with the joint, its value and its limit.
    """
    limits = robot.limits
    if limits.contains(q, slack=_SLACK):
        return
    for joint, value in enumerate(q):
        low, high = limits.position_min[joint], limits.position_max[joint]
        if not low - _SLACK <= value <= high + _SLACK:
            raise JointLimitError(
                f"{name}: joint {joint + 1} is at {shown(value)}; it may be from {shown(low)} "
                f"to {shown(high)} [rad or m].",
                joint=joint,
                value=float(value),
                limit=float(low if value < low else high),
                ways_out=ways_out,
            )
    raise CouplingLimitError(f"{name} breaks a coupled limit of the robot.", ways_out=ways_out)


def joint_robot(
    n: int,
    *,
    velocity: ArrayLike,
    acceleration: ArrayLike,
    jerk: ArrayLike,
    position_min: ArrayLike | None = None,
    position_max: ArrayLike | None = None,
    coupling: ArrayLike | None = None,
    lower: ArrayLike | None = None,
    upper: ArrayLike | None = None,
) -> Robot:
    """Make `n` joints with limits and no kinematics, for joint moves only.

    Parameters
    ----------
    n : int
        Number of joints.
    velocity, acceleration, jerk : array_like
        One number for all joints, or (n,) [rad or m per s, s², s³].
    position_min, position_max : array_like, optional
        As above [rad or m], infinite allowed; none when left out.
    coupling, lower, upper : array_like, optional
        Coupled limits lower <= coupling @ q <= upper; (m, n), (m,), (m,).

    Raises
    ------
    BadArgumentError, BadLimitsError
        Sizes that differ, NaN, or limits that are not positive.
    """
    if isinstance(n, bool) or not isinstance(n, int) or not 1 <= n <= _core.MAX_JOINTS:
        raise BadArgumentError(f"n is {n!r}; a robot has 1 to {_core.MAX_JOINTS} joints.")
    matrix = np.zeros((0, n)) if coupling is None else numbers_of(coupling, "coupling")
    if matrix.ndim != 2 or matrix.shape[1] != n:
        raise BadArgumentError(f"coupling has the shape {matrix.shape}; it must be (m, {n}).")
    rows = matrix.shape[0]
    if rows and (lower is None or upper is None):
        raise BadArgumentError("coupling needs lower and upper, one value a row of it.")
    return Robot(
        _core.joint_robot(
            _core.JointLimits(
                position_min=_bound(position_min, "position_min", n, -np.inf),
                position_max=_bound(position_max, "position_max", n, np.inf),
                velocity=_each(velocity, "velocity", n),
                acceleration=_each(acceleration, "acceleration", n),
                jerk=_each(jerk, "jerk", n),
                coupling=matrix,
                coupling_lower=vector([] if lower is None else lower, "lower", rows, "one a row"),
                coupling_upper=vector([] if upper is None else upper, "upper", rows, "one a row"),
            )
        )
    )


def _each(value: ArrayLike | None, name: str, n: int, default: Vector | None = None) -> Vector:
    if value is None:
        return cast("Vector", default)
    array = numbers_of(value, name)
    return np.full(n, float(array)) if array.ndim == 0 else vector(array, name, n)


def _bound(value: ArrayLike | None, name: str, n: int, none: float) -> Vector:
    """Return position limits of a side, where `none` (an infinity) means that there is none."""
    if value is None:
        return np.full(n, none)
    array = np.asarray(value)
    unlimited = array == none
    finite = _each(np.where(unlimited, 0.0, array), name, n)
    return np.where(unlimited, none, finite)
