"""Straight lines of the tool as knots of the joints."""

from __future__ import annotations

from typing import Literal

import numpy as np

from . import _core
from ._arguments import ArrayLike, choice, number, pose, vector
from ._robot import Robot, require_robot


def insert_knots(
    robot: Robot,
    pose0: ArrayLike,
    pose1: ArrayLike,
    *,
    position: float = 1e-5,
    angle: float = 1e-4,
    method: Literal["certified", "taylor"] = "certified",
    near: ArrayLike | None = None,
) -> _core.Knots:
    """Knots along the straight line from one pose to another, with the least rotation.

    Parameters
    ----------
    robot : Robot
        The arm.
    pose0, pose1 : array_like, (4, 4)
        pose_base_tool at both ends [m].
    position, angle : float
        Tolerances [m], [rad], 1e-8 or more: less would be lost in rounding.
    method : {"certified", "taylor"}
        ``"certified"``: knots of quintic pieces whose deviation is proven all along, as `movel`
        uses them. ``"taylor"``: bounded deviation joint paths (Taylor 1979), straight in the joints
        between knots and tested in the middle only; the bound that is returned is the truth, and
        may exceed the tolerance.
    near : array_like, (n,), optional
        Reference for the branch at the start [rad or m]. Default: all zero.

    Returns
    -------
    Knots
        ``q`` (k, n), ``position_bound`` [m] and ``angle_bound`` [rad], both proven.

    Raises
    ------
    JointLimitError, SingularError, UnreachableError, BranchChangeError, ZeroLengthError
        Each with the share of the line where it happens.
    BadArgumentError, NotARotationError
        By the argument's name.
    """
    require_robot(robot)
    kind = choice(method, "method", ("certified", "taylor"))
    reference = np.zeros(robot.joints) if near is None else vector(near, "near", robot.joints)
    return _core.insert_knots(
        robot._core,
        pose(pose0, "pose0")[0],
        pose(pose1, "pose1")[0],
        near=reference,
        method=kind,
        position=number(position, "position", "m", least=1e-8),
        angle=number(angle, "angle", "rad", least=1e-8),
    )
