"""Where an arm's tool can be, and how well it moves there."""

from __future__ import annotations

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, integer, numbers_of, vector
from ._kinematics import Kinematics, checked_pose
from ._rotations import even_rotations
from .errors import BadArgumentError


class Workspace(Kinematics):
    """Rates, dexterity and reach of an arm, besides its kinematics. A `Robot` is one."""

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
            turned = checked_pose(matrix)[:3, :3]
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
