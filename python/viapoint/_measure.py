"""How far apart joints are, at the tool or over all of them, by the tolerance of a recording."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ._arguments import Vector, number
from ._robot import Robot
from ._rotation_vectors import rotation_vectors
from ._zone import Zone
from .errors import BadArgumentError


@dataclass(frozen=True)
class Measure:
    """What distance is: of the tool, or over all joints.

    Attributes
    ----------
    position, angle : float or None
        Tolerances at the tool [m], [rad].
    joints : float or None
        Instead: over all joints [rad or m].
    """

    robot: Robot
    position: float | None
    angle: float | None
    joints: float | None

    @classmethod
    def of(cls, robot: Robot, tolerance: float | Zone, angle: float) -> Measure:
        """Take what was asked of a fit; see `Recording.fit`."""
        if isinstance(tolerance, Zone):
            if tolerance.kind != "joint_deviation":
                raise BadArgumentError(
                    f"tolerance is {tolerance!r}; it must be a distance [m] or "
                    "vp.joint_deviation(…)."
                )
            return cls(robot, None, None, number(tolerance.size, "tolerance", "rad", above=0.0))
        if not robot.has_kinematics:
            raise BadArgumentError(
                f'The robot "{robot.name}" has no kinematics: its tool has no place.',
                ways_out=["Give the tolerance in joints: fit(vp.joint_deviation(0.01))."],
            )
        return cls(
            robot,
            number(tolerance, "tolerance", "m", above=0.0),
            number(angle, "angle_tolerance", "rad", above=0.0),
            None,
        )

    def features(self, q: Vector) -> Vector:
        """Return joints (k, n) as points (k, f) in which distances count in tolerances."""
        if self.position is None or self.angle is None:
            return q / (self.joints or 1.0)
        scale = np.where(self.robot.prismatic, self.position, self.angle)
        places = self.robot.fk(q)[:, :3, 3] / self.position
        return np.hstack([places, q / scale])

    def shares(self, path: Vector, samples: Vector) -> Vector:
        """Return how far joints (k, n) are from samples (k, n), in tolerances, (k,)."""
        if self.position is None or self.angle is None:
            apart: Vector = np.linalg.norm(path - samples, axis=1) / (self.joints or 1.0)
            return apart
        off, turned = self._apart(path, samples)
        larger: Vector = np.maximum(off / self.position, turned / self.angle)
        return larger

    def deviations(self, path: Vector, samples: Vector) -> tuple[float, float]:
        """Return the largest distance [m] (over joints: [rad or m]) and angle [rad]."""
        if self.position is None:
            return float(np.linalg.norm(path - samples, axis=1).max()), 0.0
        off, turned = self._apart(path, samples)
        return float(off.max()), float(turned.max())

    def _apart(self, path: Vector, samples: Vector) -> tuple[Vector, Vector]:
        here, there = self.robot.fk(path), self.robot.fk(samples)
        off: Vector = np.linalg.norm(here[:, :3, 3] - there[:, :3, 3], axis=1)
        turn = rotation_vectors(here[:, :3, :3] @ np.swapaxes(there[:, :3, :3], 1, 2))
        turned: Vector = np.linalg.norm(turn, axis=1)
        return off, turned
