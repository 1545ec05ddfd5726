"""A motion as arrays over time."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from ._arguments import Vector
from ._robot import Robot


@dataclass(frozen=True, repr=False)
class Samples:
    """States of a motion, one a row.

    Attributes
    ----------
    t : ndarray, (k,)
        Time from the motion's start [s].
    q, qd, qdd, qddd : ndarray, (k, n)
        Joints and their derivatives [rad or m, per s, s², s³].
    move : ndarray of int, (k,)
        Index of the program's step under way.
    robot : Robot
        The arm that moves.
    tools : tuple of (int, Robot)
        From which step on the arm moves another tool, and the arm with that tool.
    """

    t: Vector
    q: Vector
    qd: Vector
    qdd: Vector
    qddd: Vector
    move: npt.NDArray[np.int32]
    robot: Robot
    tools: tuple[tuple[int, Robot], ...] = ()

    def __len__(self) -> int:
        """Count the samples."""
        return len(self.t)

    def __repr__(self) -> str:
        """Count samples and joints."""
        return f"<Samples {len(self)} of {self.q.shape[1]} joints, to {self.t[-1]:.3f} s>"

    @cached_property
    def pose(self) -> Vector:
        """pose_base_tool, (k, 4, 4) [m]; computed when first asked for.

        Raises
        ------
        UncontrolledError
            The robot has no kinematics.
        """
        poses = self.robot.fk(self.q)
        for first, robot in self.tools:
            now = self.move >= first
            poses[now] = robot.fk(self.q[now])
        return poses

    @cached_property
    def _rates(self) -> tuple[Vector, Vector]:
        rates = self.robot._core.tool_rates(self.q, self.qd, self.qdd)
        for first, robot in self.tools:
            now = self.move >= first
            of_tool = robot._core.tool_rates(self.q[now], self.qd[now], self.qdd[now])
            for all_rates, new in zip(rates, of_tool, strict=True):
                all_rates[now] = new
        return rates

    @property
    def twist(self) -> Vector:
        """Linear over angular velocity of the tool, base frame, (k, 6) [m/s, rad/s]."""
        return self._rates[0]

    @property
    def twist_rate(self) -> Vector:
        """Linear over angular acceleration of the tool, base frame, (k, 6) [m/s², rad/s²]."""
        return self._rates[1]
