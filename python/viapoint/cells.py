"""Where parts are in a cell: lifted, stacked and on a feeder; and what grips them.

`Program.pick`, `Program.place` and `Program.screw_in` move to such poses::

    from viapoint.cells import Gripper, stacked
    gripper = Gripper(output=3, dwell=0.2)
    for place in stacked(first, 0.04, 3):
        program.pick(pick, gripper).place(place, gripper)
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ._arguments import ArrayLike, Vector, integer, number, pose
from ._signals import signal
from .errors import BadArgumentError

__all__ = ["Gripper", "lifted", "on_feeder", "stacked"]


@dataclass(frozen=True)
class Gripper:
    """A gripper on a digital output.

    Parameters
    ----------
    output : int
        0 to 63.
    closed : bool
        The output's value that closes it.
    dwell : float
        How long it takes to close or open [s]: the arm waits.

    Raises
    ------
    BadArgumentError
        By the argument's name.
    """

    output: int
    closed: bool = True
    dwell: float = 0.2

    def __post_init__(self) -> None:
        """Check the arguments."""
        signal(self.output, "output")
        number(self.dwell, "dwell", "s", least=0.0)
        if not isinstance(self.closed, bool):
            raise BadArgumentError(f"closed is {self.closed!r}; it must be True or False.")


def lifted(at: ArrayLike, distance: float) -> Vector:
    """Return a pose drawn back along its own approach axis, the tool's z.

    Parameters
    ----------
    at : array_like, (4, 4)
        pose_base_tool at the part [m].
    distance : float
        How far back [m]; negative: forward.

    Returns
    -------
    ndarray, (4, 4)
        [m]

    Raises
    ------
    BadArgumentError, NotARotationError
        No pose, or no number.
    """
    there = pose(at, "at")[0].copy()
    there[:3, 3] -= number(distance, "distance", "m") * there[:3, 2]
    return there


def stacked(first: ArrayLike, height: float, count: int, *, up: ArrayLike = (0, 0, 1)) -> Vector:
    """Return the poses in which parts are set down on one another.

    A part that is gripped at half of its height adds twice its pick height, so the k-th place is
    k heights above the first.

    Parameters
    ----------
    first : array_like, (4, 4)
        pose_base_tool that sets the lowest part down [m].
    height : float
        Of a part [m].
    count : int
        Number of parts, 1 to 10000.
    up : array_like, (3,)
        Direction of the stack in the base frame.

    Returns
    -------
    ndarray, (count, 4, 4)
        [m]

    Raises
    ------
    BadArgumentError, NotARotationError
        By the argument's name.
    """
    parts = integer(count, "count", 1, 10_000)
    rise = number(height, "height", "m", above=0.0)
    direction = np.asarray(up, dtype=np.float64)
    size = float(np.linalg.norm(direction)) if direction.shape == (3,) else 0.0
    if not (math.isfinite(size) and size > 0.0):
        raise BadArgumentError(f"up is {up!r}; it must be a direction x, y, z.")
    poses = np.tile(pose(first, "first")[0], (parts, 1, 1))
    poses[:, :3, 3] += rise * np.arange(parts)[:, None] * direction / size
    return poses


def on_feeder(slope: float, edge: float, *, end: float = 0.0, friction: float = 0.0) -> Vector:
    """Return the pose that grips the lowest cube on an inclined feeder, in the feeder's frame.

    The frame's x points up the feeder along the ground, its z up. With slope β, edge c and the stop
    at x = f the cube's middle is at (f + c (cos β - sin β) / 2, 0, c (sin β + cos β) / 2), and the
    tool's axes are (cos β, 0, sin β), (0, -1, 0), (sin β, 0, -cos β): its z goes into the feeder.

    Parameters
    ----------
    slope : float
        β [rad], above 0 and below a right angle.
    edge : float
        c, the cubes' edge [m].
    end : float
        f, where the feeder's stop is [m].
    friction : float
        μ between cube and feeder: they slide where β > atan μ.

    Returns
    -------
    ndarray, (4, 4)
        pose_feeder_tool [m]; for a `viapoint.frames.Frame` of the feeder.

    Raises
    ------
    BadArgumentError
        By the argument's name; a slope on which no cube slides.
    """
    beta = number(slope, "slope", "rad", above=0.0, most=0.5 * math.pi)
    c = number(edge, "edge", "m", above=0.0)
    f = number(end, "end", "m")
    sliding = math.atan(number(friction, "friction", least=0.0))
    if beta <= sliding:
        raise BadArgumentError(
            f"slope is {beta:.4g} rad; cubes of this friction slide from {sliding:.4g} rad on.",
            ways_out=["Make the feeder steeper, or smoother."],
        )
    sine, cosine = math.sin(beta), math.cos(beta)
    return np.array(
        [
            [cosine, 0.0, sine, f + 0.5 * c * (cosine - sine)],
            [0.0, -1.0, 0.0, 0.0],
            [sine, 0.0, -cosine, 0.5 * c * (sine + cosine)],
            [0.0, 0.0, 0.0, 1.0],
        ]
    )
