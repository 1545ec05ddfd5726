"""From joints to poses and back: solutions, configurations and ways."""

from __future__ import annotations

import warnings
from typing import cast

import numpy as np

from . import _core
from ._arguments import (
    NOTEWORTHY_CORRECTION,
    ArrayLike,
    Vector,
    choice,
    number,
    numbers_of,
    pose,
    vector,
)
from .errors import BadArgumentError, PoseCorrectedWarning

_ANY = _core.Configuration()


class Kinematics:
    """Forward and inverse kinematics of an arm."""

    def __init__(self, core: _core.RobotModel) -> None:
        self._core = core

    @property
    def ik_family(self) -> str:
        """Which inverse-kinematics solver serves this arm, and why."""
        return self._core.ik_family

    @property
    def redundancy(self) -> str | None:
        """What a pose leaves open: ``"arm angle"`` or ``"joint 7"`` of seven joints, or None."""
        return self._core.redundancy or None

    def fk(self, q: ArrayLike) -> Vector:
        """Pose of the tool in the base frame.

        Parameters
        ----------
        q : array_like, (n,) or (k, n)
            Joints [rad or m].

        Returns
        -------
        ndarray, (4, 4) or (k, 4, 4)
            pose_base_tool [m].

        Raises
        ------
        BadArgumentError
            Another shape, or values that are not finite.
        UncontrolledError
            The robot has no kinematics.
        """
        joints = numbers_of(q, "q")
        if joints.ndim == 2 and joints.shape[1] == self._core.joints:
            return self._core.fk_batch(joints)
        return self._core.fk(vector(joints, "q", self._core.joints))

    def fk_batch(self, q: ArrayLike) -> Vector:
        """Poses of the tool for the rows of `q` (k, n) [rad or m]: (k, 4, 4), in one call.

        Raises
        ------
        BadArgumentError, UncontrolledError
            As for `fk`.
        """
        return self._core.fk_batch(numbers_of(q, "q"))

    def ik(
        self,
        pose: ArrayLike | None = None,
        *,
        position: ArrayLike | None = None,
        near: ArrayLike | None = None,
        config: _core.Configuration | None = None,
    ) -> Vector:
        """Joints of the solution within the limits that is nearest to `near`.

        The largest joint change decides, then the sum of squares, radians and metres alike. At a
        singular pose the free joint stays where `near` has it. Of seven joints the redundancy is
        chosen to stay near `near`, and away from the limits where that is far.

        Parameters
        ----------
        pose : array_like, (4, 4), optional
            pose_base_tool [m]. Either this or `position`.
        position : array_like, (3,), optional
            Tool position in the base frame [m], where the orientation does not count.
        near : array_like, (n,), optional
            Reference joints [rad or m]; only a reference, may lie outside the limits. Default:
            all zero.
        config : Configuration, optional
            Only solutions that stand so.

        Returns
        -------
        ndarray, (n,)
            Joints [rad or m], always within the limits.

        Raises
        ------
        NotARotationError, UnreachableError, OutsideLimitsError, UncontrolledError, BadArgumentError
            Each says how far, which joint, which coordinate, or which configurations there are.

        Warns
        -----
        PoseCorrectedWarning
            The pose was a rotation only up to rounding and was projected.
        """
        if position is None and config is None:
            quick = self._core.ik_quick(pose, near)
            if quick is not None:
                return quick
        reference = self._reference(near)
        wish = None if config is None else _configuration(config)
        if position is not None:
            _only_one(pose)
            point = vector(position, "position", 3, "x, y, z")
            if wish is None:
                return self._core.ik_near_position(point, reference)
            return cast("Vector", self._core.ik_all_position(point, reference, wish)[0])
        matrix = checked_pose(pose)
        if wish is None:
            return self._core.ik_near(matrix, reference)
        return cast("Vector", self._core.ik_all(matrix, reference, wish, None)[0])

    def ik_all(
        self,
        pose: ArrayLike | None = None,
        *,
        position: ArrayLike | None = None,
        near: ArrayLike | None = None,
        config: _core.Configuration | None = None,
        redundancy: float | None = None,
    ) -> Vector:
        """Every distinct solution within the limits, whole turns included, and no other.

        Of a branch with more than 4096 turns within very wide limits, the 4096 about `near`.
        Arms with seven joints: all with this `redundancy`, or, without one, one solution for each
        configuration, the one that keeps farthest from its limits.

        Parameters
        ----------
        pose : array_like, (4, 4), optional
            pose_base_tool [m]. Either this or `position`.
        position : array_like, (3,), optional
            Tool position in the base frame [m], where the orientation does not count.
        near : array_like, (n,), optional
            Nearest to these joints first [rad or m]; joints that a singular pose leaves free stay
            there. Default: all zero.
        config : Configuration, optional
            Only solutions that stand so; `configuration` tells each one's.
        redundancy : float, optional
            What `Robot.redundancy` names [rad].

        Returns
        -------
        ndarray, (k, n)
            Joints [rad or m], one solution a row.

        Raises
        ------
        NotARotationError, UnreachableError, OutsideLimitsError, UncontrolledError, BadArgumentError
            As for `ik`.
        """
        if position is None and config is None and redundancy is None:
            quick = self._core.ik_all_quick(pose, near)
            if quick is not None:
                return quick
        reference = self._reference(near)
        wish = _ANY if config is None else _configuration(config)
        if position is not None:
            _only_one(pose)
            if redundancy is not None:
                raise BadArgumentError("redundancy is for poses, not for positions.")
            point = vector(position, "position", 3, "x, y, z")
            return self._core.ik_all_position(point, reference, wish)
        value = None if redundancy is None else number(redundancy, "redundancy", "rad")
        return self._core.ik_all(checked_pose(pose), reference, wish, value)

    def ik_batch(
        self, poses: ArrayLike, *, near: ArrayLike | None = None, unreachable: str = "raise"
    ) -> Vector:
        """Solve many poses in one call, each as `ik` does.

        Parameters
        ----------
        poses : array_like, (k, 4, 4)
            pose_base_tool [m].
        near : array_like, (n,) or (k, n), optional
            Reference joints, for all poses or one row a pose. Default: all zero.
        unreachable : {"raise", "nan"}
            What to do with a pose that has no solution within the limits: raise its error, which
            names the row, or answer NaN in that row.

        Returns
        -------
        ndarray, (k, n)
            Joints [rad or m].

        Raises
        ------
        NotARotationError, UnreachableError, OutsideLimitsError, UncontrolledError, BadArgumentError
            As for `ik`, naming the row.
        """
        batch = numbers_of(poses, "poses")
        if near is None:
            references = np.zeros((1, self._core.joints))
        else:
            references = np.atleast_2d(numbers_of(near, "near"))
        nan = choice(unreachable, "unreachable", ("raise", "nan")) == "nan"
        return self._core.ik_batch(batch, references, nan)

    def ik_path(
        self, poses: ArrayLike, start: ArrayLike, *, largest_step: float = _core.LARGEST_STEP
    ) -> Vector:
        """Joints along a way told as poses: on one branch, without a jump.

        Each pose takes the solution nearest to the one before. Where that leads to a jump, all
        branches are followed at once from the start, with seven joints over a grid of what a pose
        leaves open, and the shortest way is taken.

        Parameters
        ----------
        poses : array_like, (k, 4, 4)
            pose_base_tool [m], near enough to each other.
        start : array_like, (n,)
            The solution of the first pose nearest to these joints begins the way [rad or m].
        largest_step : float
            The most that a joint may change from one pose to the next [rad or m].

        Returns
        -------
        ndarray, (k, n)
            Joints [rad or m].

        Raises
        ------
        BranchChangeError
            Every choice ends at a limit or a singularity: with the `share` of the way where, and
            the joint that would have to jump.
        UnreachableError, OutsideLimitsError, UncontrolledError
            A pose that has no solution, with its `share`.
        NotARotationError, BadArgumentError
            No poses.
        """
        return self._core.ik_path(
            numbers_of(poses, "poses"),
            vector(start, "start", self._core.joints),
            number(largest_step, "largest_step", "rad or m", above=0.0),
        )

    def configuration(self, q: ArrayLike) -> _core.Configuration:
        """On which side of its singularities the arm stands at q (n,), and its whole turns."""
        return self._core.configuration(vector(q, "q", self._core.joints))

    def redundancy_of(self, q: ArrayLike) -> float:
        """Value at q (n,) of what a pose leaves open [rad]; see `redundancy`.

        Raises
        ------
        UncontrolledError
            The arm leaves nothing open.
        """
        return self._core.redundancy_of(vector(q, "q", self._core.joints))

    def _reference(self, near: ArrayLike | None) -> Vector:
        joints = self._core.joints
        return np.zeros(joints) if near is None else vector(near, "near", joints)


def _configuration(value: object) -> _core.Configuration:
    if isinstance(value, _core.Configuration):
        return value
    raise BadArgumentError(
        f"config is {value!r}; it must be a Configuration.",
        ways_out=['Use vp.Configuration(elbow="up"), or robot.configuration(q).'],
    )


def checked_pose(value: ArrayLike | None) -> Vector:
    """Return `value` as a pose (4, 4), with a warning where it had to be corrected.

    Raises
    ------
    BadArgumentError, NotARotationError
        Nothing, another shape, or no rotation.
    """
    if value is None:
        raise BadArgumentError("Neither pose nor position is given; give one of them.")
    matrix, correction = pose(value, "pose")
    if correction > NOTEWORTHY_CORRECTION:
        warnings.warn(
            f"The pose is a rotation only up to rounding; the nearest one is used, "
            f"with elements changed by at most {correction:.3g}.",
            PoseCorrectedWarning,
            stacklevel=3,
        )
    return matrix


def _only_one(value: ArrayLike | None) -> None:
    if value is not None:
        raise BadArgumentError("Both pose and position are given; give one of them.")
