"""What an arm's geometry answers: poses, joints, configurations, dexterity and reach."""

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
    integer,
    number,
    numbers_of,
    pose,
    vector,
)
from ._rotations import even_rotations
from .errors import BadArgumentError, PoseCorrectedWarning

_ANY = _core.Configuration()


class Kinematics:
    """Forward and inverse kinematics of an arm. A `Robot` is one."""

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
        matrix = _checked(pose)
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
        return self._core.ik_all(_checked(pose), reference, wish, value)

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

    def jacobian(self, q: ArrayLike) -> Vector:
        """Geometric Jacobian at the tool point, base frame.

        Parameters
        ----------
        q : array_like, (n,)
            Joints [rad or m].

        Returns
        -------
        ndarray, (6, n)
            Rows 0-2 linear [m/s], rows 3-5 angular velocity [rad/s], per unit joint rate.
        """
        return self._core.jacobian(vector(q, "q", self._core.joints))

    def manipulability(self, q: ArrayLike) -> float:
        """Yoshikawa's measure sqrt(det(J Jᵀ)) at q (n,) (Yoshikawa 1985)."""
        return self._core.manipulability(vector(q, "q", self._core.joints))

    def dexterity(self, q: ArrayLike) -> _core.Dexterity:
        """How well the arm moves at q (n,): manipulability, condition number, ellipsoids."""
        return self._core.dexterity(vector(q, "q", self._core.joints))

    def singularity(self, q: ArrayLike) -> _core.Singularity:
        """How near the arm at q (n,) is to losing a direction: name, distance, manipulability."""
        return self._core.singularity(vector(q, "q", self._core.joints))

    def reach(
        self,
        direction: ArrayLike,
        *,
        start: ArrayLike = (0.0, 0.0, 0.0),
        rotation: ArrayLike | None = None,
    ) -> Vector:
        """Where along a ray the tool's point can be, within the joint limits.

        Parameters
        ----------
        direction : array_like, (3,)
            Of the ray, in the base frame; its length does not count.
        start : array_like, (3,)
            Where the ray starts, in the base frame [m].
        rotation : array_like, (3, 3), optional
            The tool's orientation there; without it any will do.

        Returns
        -------
        ndarray, (m, 2)
            From and to of each stretch, distances from `start` [m]; ``reach(d)[-1, 1]`` is the
            farthest. Stretches and gaps narrower than a hundredth of the arm can be missed.

        Raises
        ------
        BadArgumentError
            A direction of no length, another shape, or a slide without limits.
        """
        turned = None
        if rotation is not None:
            matrix = np.eye(4)
            given = numbers_of(rotation, "rotation")
            if given.shape != (3, 3):
                raise BadArgumentError(f"rotation has the shape {given.shape}; it must be (3, 3).")
            matrix[:3, :3] = given
            turned = _checked(matrix)[:3, :3]
        return self._core.reach(
            vector(direction, "direction", 3, "x, y, z"),
            vector(start, "start", 3, "x, y, z"),
            turned,
        )

    def dexterity_share(self, positions: ArrayLike, *, orientations: int = 200) -> Vector:
        """Share of all tool orientations that the arm can hold at positions, within its limits.

        1 is in the dexterous workspace, 0 out of reach. Orientations are spread evenly over all
        rotations, the same ones every time (super-Fibonacci spirals: Alexa 2022).

        Parameters
        ----------
        positions : array_like, (k, 3)
            Tool positions in the base frame [m].
        orientations : int
            How many are tried; the share is told in steps of 1 over that.

        Returns
        -------
        ndarray, (k,)
            From 0 to 1.

        Raises
        ------
        BadArgumentError
            Another shape, or a number of orientations that is none.
        UncontrolledError
            The robot has no kinematics.
        """
        points = numbers_of(positions, "positions")
        if points.ndim != 2 or points.shape[1] != 3:
            raise BadArgumentError(
                f"positions has the shape {points.shape}; it must be (k, 3): x, y, z."
            )
        tried = even_rotations(integer(orientations, "orientations", 1, 1_000_000))
        poses = np.tile(np.eye(4), (len(tried), 1, 1))
        poses[:, :3, :3] = tried
        shares = np.empty(len(points))
        for k, point in enumerate(points):
            poses[:, :3, 3] = point
            held = np.isfinite(self.ik_batch(poses, unreachable="nan")[:, 0])
            shares[k] = held.mean()
        return shares

    def workspace(self, samples: int = 10_000, *, seed: int = 1) -> tuple[Vector, Vector]:
        """Sample where the tool's point can be, uniformly over the joints.

        Parameters
        ----------
        samples : int
            Number of joint vectors.
        seed : int
            Of the random numbers: the same seed gives the same samples.

        Returns
        -------
        points : ndarray, (samples, 3)
            Tool positions in the base frame [m].
        q : ndarray, (samples, n)
            The joints that bring the tool there [rad or m], all within position and coupled limits.

        Raises
        ------
        BadArgumentError
            A slide without limits, or coupled limits that hardly any joint vector keeps.
        """
        integer(samples, "samples", 1, 10_000_000)
        limits = self._core.limits
        low, high = limits.position_min, limits.position_max
        turns = ~np.asarray(self._core.prismatic)
        low = np.where(turns & ~np.isfinite(low), -np.pi, low)
        high = np.where(turns & ~np.isfinite(high), np.pi, high)
        if not (np.isfinite(low).all() and np.isfinite(high).all()):
            raise BadArgumentError("A joint slides without position limits; give it some.")
        generator = np.random.default_rng(seed)
        kept: list[Vector] = []
        missing = samples
        for _ in range(1000):
            q = generator.uniform(low, high, (samples, len(low)))
            if len(limits.coupling):
                value = q @ limits.coupling.T
                inside = (value >= limits.coupling_lower) & (value <= limits.coupling_upper)
                q = q[inside.all(axis=1)]
            kept.append(q[:missing])
            missing -= len(kept[-1])
            if missing == 0:
                break
        else:
            raise BadArgumentError("The coupled limits leave almost no joint vector to sample.")
        joints = np.concatenate(kept)
        return self._core.fk_batch(joints)[:, :3, 3], joints

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


def _checked(value: ArrayLike | None) -> Vector:
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
