"""Frames and tools: where a workpiece stands, where the tool's point is, and how to find both.

A frame is a pose seen from the robot's base; a tool is a pose seen from its flange. Both are found
by touching points with the arm::

    import viapoint as vp

    found = vp.frames.six_point(robot, touches, along_x, along_z)
    robot = robot.with_tool(found.pose)
    table = vp.frames.three_points(origin, on_x, on_xy, robot=robot, name="table")
    program = vp.Program(robot, start=q0).set_frame(table)
    program.movel(pose_table_tool)

Every result says how well the points agree, and points that cannot tell what is asked for are
refused with what to do instead.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, numbers_of, vector
from ._arguments import pose as pose_of
from ._core import Fit, FrameFit, TcpCalibration, ToolCalibration
from .errors import BadArgumentError

if TYPE_CHECKING:
    from ._robot import Robot

__all__ = [
    "Fit",
    "Frame",
    "FrameFit",
    "TcpCalibration",
    "Tool",
    "ToolCalibration",
    "four_point",
    "known_points",
    "place_base",
    "six_point",
    "three_points",
]


class _Named:
    """A pose with a name. Immutable."""

    def __init__(self, pose: ArrayLike, name: str = "") -> None:
        if not isinstance(name, str):
            raise BadArgumentError(f"name is {name!r}; it must be text.")
        matrix, _ = pose_of(pose, "pose")
        self._pose = matrix.copy()
        self._name = name

    def __repr__(self) -> str:
        """Name and position."""
        x, y, z = self._pose[:3, 3]
        return f"<{type(self).__name__} {self._name!r} at ({x:.4g}, {y:.4g}, {z:.4g}) m>"

    @property
    def pose(self) -> Vector:
        """The pose, (4, 4) [m]; a copy."""
        return self._pose.copy()

    @property
    def name(self) -> str:
        """For people, and for points taught in it."""
        return self._name


class Frame(_Named):
    """A frame to work in: a table, a fixture, a workpiece.

    Parameters
    ----------
    pose : array_like, (4, 4)
        pose_base_frame [m].
    name : str
        For people, and for points taught in it.

    Raises
    ------
    BadArgumentError, NotARotationError
        No pose.
    """

    def to_base(self, value: ArrayLike) -> Vector:
        """Tell in the base frame what is told in this one.

        Parameters
        ----------
        value : array_like, (4, 4), (3,) or (k, 3)
            A pose, a position or positions [m].

        Returns
        -------
        ndarray
            Of the same shape.

        Raises
        ------
        BadArgumentError
            Another shape.
        """
        return _moved(self._pose, value)

    def from_base(self, value: ArrayLike) -> Vector:
        """Tell in this frame what is told in the base frame; as `to_base`."""
        return _moved(_inverse(self._pose), value)


class Tool(_Named):
    """A tool: where its point is on the flange, and how it stands there.

    Parameters
    ----------
    pose : array_like, (4, 4)
        pose_flange_tool [m].
    name : str
        For people.

    Raises
    ------
    BadArgumentError, NotARotationError
        No pose.
    """


def four_point(robot: Robot, joints: ArrayLike) -> TcpCalibration:
    """Find the tool's point from touching one fixed point with several orientations.

    Least squares over all touches. The robot's own tool does not count: what is found stands on
    the flange.

    Parameters
    ----------
    robot : Robot
        The arm.
    joints : array_like, (k, n)
        Joints of each touch [rad or m], k at least 4: tilted by 30° or more about two axes.

    Returns
    -------
    TcpCalibration
        ``tcp``, ``pose`` (oriented as the flange), ``fit.rms`` and ``fit.residuals`` [m],
        ``sensitivity``, ``uncertainty`` [m].

    Raises
    ------
    BadArgumentError
        Fewer than four touches, or another shape.
    DegeneratePointsError
        The orientations are parallel or too much alike: with the measure, and what to do.
    """
    return _core.calibrate_tcp(_flanges(robot, joints, "joints"))


def six_point(
    robot: Robot, joints: ArrayLike, along_x: ArrayLike, along_z: ArrayLike
) -> ToolCalibration:
    """Find the tool's point and orientation: `four_point`, and two ways along the tool's axes.

    Parameters
    ----------
    robot : Robot
        The arm.
    joints : array_like, (k, n)
        As for `four_point`. From the last of these touches both ways begin.
    along_x, along_z : array_like, (n,)
        Joints after a move along the tool's own +x, and along its own +z [rad or m]; 100 mm and
        more tell it well. z is taken as it was shown, x is made square to it.

    Returns
    -------
    ToolCalibration
        ``pose`` for `Robot.with_tool` or `Program.set_tool`; ``tcp``, what `four_point` returns;
        ``angle`` between the two ways [rad], a right angle but for errors.

    Raises
    ------
    BadArgumentError, DegeneratePointsError
        As for `four_point`; also two ways that are too short or show one direction.
    """
    of_ways = [
        vector(q, name, robot.joints) for q, name in ((along_x, "along_x"), (along_z, "along_z"))
    ]
    after_x, after_z = _flanges(robot, np.array(of_ways), "joints")
    return _core.calibrate_tool(_flanges(robot, joints, "joints"), after_x, after_z)


def three_points(
    origin: ArrayLike,
    on_x: ArrayLike,
    on_xy: ArrayLike,
    *,
    robot: Robot | None = None,
    name: str = "",
) -> Frame:
    """Make a frame from its origin, a point on its x axis and a third on the side of +y.

    Parameters
    ----------
    origin, on_x, on_xy : array_like, (3,), or (n,) with a robot
        Positions in the base frame [m]; with a robot the joints that touch them [rad or m].
    robot : Robot, optional
        The arm whose tool touches the points.
    name : str
        The frame's name.

    Raises
    ------
    DegeneratePointsError
        Points that coincide or lie on one line, with how far from it they are.
    BadArgumentError
        Another shape.
    """
    points = [
        _point(value, which, robot)
        for value, which in ((origin, "origin"), (on_x, "on_x"), (on_xy, "on_xy"))
    ]
    return Frame(_core.frame_from_points(*points), name)


def known_points(known: ArrayLike, touched: ArrayLike, *, robot: Robot | None = None) -> FrameFit:
    """Find the frame in which touched points have known coordinates, by least squares.

    Parameters
    ----------
    known : array_like, (k, 3)
        Coordinates in the frame [m], k at least 3 and not on one line.
    touched : array_like, (k, 3), or (k, n) with a robot
        The same points in the base frame [m]; with a robot the joints that touch them.
    robot : Robot, optional
        The arm whose tool touches the points.

    Returns
    -------
    FrameFit
        ``pose``, for `Frame`; ``fit.rms`` and ``fit.residuals`` [m].

    Raises
    ------
    DegeneratePointsError, BadArgumentError
        As for `three_points`.
    """
    places = _rows(touched, "touched", 3) if robot is None else robot.fk(_rows_of(robot, touched))
    return _core.frame_from_known_points(
        _rows(known, "known", 3), places if robot is None else places[:, :3, 3]
    )


def place_base(robot: Robot, known: ArrayLike, joints: ArrayLike) -> FrameFit:
    """Find where the arm stands, from touching points that are known in the world.

    Parameters
    ----------
    robot : Robot
        The arm, with the tool that touches.
    known : array_like, (k, 3)
        The points in the world frame [m], k at least 3 and not on one line.
    joints : array_like, (k, n)
        Joints that touch them [rad or m].

    Returns
    -------
    FrameFit
        ``pose`` is pose_world_base, for `Robot.with_base`.

    Raises
    ------
    DegeneratePointsError, BadArgumentError
        As for `three_points`.
    """
    touched = robot.fk(_rows_of(robot, joints))[:, :3, 3]
    return _core.frame_from_known_points(
        _moved(_inverse(robot.base), touched), _rows(known, "known", 3)
    )


def frame_of(value: Frame | ArrayLike | None) -> Frame:
    """Return the frame, that of a pose, or the base for None."""
    if isinstance(value, Frame):
        return value
    if isinstance(value, _Named):
        raise BadArgumentError(f"frame is {value!r}; it must be a Frame or a pose (4, 4).")
    return Frame(np.eye(4) if value is None else value)


def tool_of(value: Tool | ArrayLike) -> Tool:
    """Return the tool, or that of a pose."""
    if isinstance(value, Tool):
        return value
    if isinstance(value, _Named):
        raise BadArgumentError(f"tool is {value!r}; it must be a Tool or a pose (4, 4).")
    return Tool(value)


def _inverse(pose: Vector) -> Vector:
    inverse = np.eye(4)
    inverse[:3, :3] = pose[:3, :3].T
    inverse[:3, 3] = -pose[:3, :3].T @ pose[:3, 3]
    return inverse


def _moved(by: Vector, value: ArrayLike) -> Vector:
    array = numbers_of(value, "value")
    if array.shape == (4, 4):
        return by @ pose_of(array, "value")[0]
    if array.ndim not in (1, 2) or array.shape[-1] != 3:
        raise BadArgumentError(
            f"value has the shape {array.shape}; it must be (4, 4), (3,) or (k, 3)."
        )
    points: Vector = array @ by[:3, :3].T + by[:3, 3]
    return points


def _rows(value: ArrayLike, name: str, columns: int) -> Vector:
    array = numbers_of(value, name)
    if array.ndim != 2 or array.shape[1] != columns:
        raise BadArgumentError(f"{name} has the shape {array.shape}; it must be (k, {columns}).")
    return array


def _rows_of(robot: Robot, joints: ArrayLike) -> Vector:
    return _rows(joints, "joints", robot.joints)


def _flanges(robot: Robot, joints: ArrayLike, name: str) -> list[Vector]:
    tools = robot.fk(_rows(joints, name, robot.joints))
    flange = _inverse(robot.tool)
    return [tool @ flange for tool in tools]


def _point(value: ArrayLike, name: str, robot: Robot | None) -> Vector:
    if robot is None:
        return vector(value, name, 3, "x, y, z")
    touched: Vector = robot.fk(vector(value, name, robot.joints))[:3, 3]
    return touched
