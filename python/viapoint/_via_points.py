"""Cubics through via points, and the velocities with which they pass them."""

from __future__ import annotations

from typing import Literal, TypeAlias

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, choice, numbers_of
from ._axes import for_each_axis, one_an_axis, point_columns
from ._law import Law
from ._robot import Robot, require_robot
from .errors import BadArgumentError, SingularError, UncontrolledError

_laws = _core.profile

Method: TypeAlias = Literal["clamped", "natural", "periodic", "slope"]
METHODS = ("clamped", "natural", "periodic", "slope")

SINGULAR = 1e-6
"""A Jacobian whose smallest singular value is less than this share of its largest is singular."""

FOLLOWED = 1e-9
"""Share of a tool velocity that joint rates may miss by rounding."""


def via_velocities(
    points: ArrayLike,
    durations: ArrayLike,
    method: Method = "clamped",
    *,
    first: ArrayLike = 0.0,
    last: ArrayLike = 0.0,
) -> Vector:
    """Velocities with which cubics pass via points.

    Parameters
    ----------
    points : array_like, (k,) or (k, n)
        k >= 2
    durations : array_like, (k - 1,)
        [s], each > 0
    method : {"clamped", "natural", "periodic", "slope"}
        The first three make acceleration continuous (the cubic spline; de Boor 1978, ch. IV), with
        the given velocities at the ends, with no acceleration there, or with the velocity and the
        acceleration of the start at the end. ``"slope"``, the heuristic: zero where the slope
        changes sign, else the mean of the two slopes (Craig 2005, §7.3).
    first, last : float or array_like, (n,)
        Velocities at the ends; ``"clamped"`` and ``"slope"`` only.

    Returns
    -------
    ndarray
        Of the shape of `points`.

    Raises
    ------
    BadArgumentError
        Sizes that do not fit, durations that are not positive, another method, end velocities that
        the method settles itself.
    """
    shape, columns = point_columns(points)
    times = numbers_of(durations, "durations")
    word = choice(method, "method", METHODS)
    ends = [one_an_axis(value, name, shape) for value, name in ((first, "first"), (last, "last"))]
    if word in ("clamped", "slope"):
        given = {"clamped": _laws.spline_velocities, "slope": _laws.slope_velocities}[word]
        made = for_each_axis(shape, lambda i: given(columns[:, i], times, ends[0][i], ends[1][i]))
    else:
        if np.any(ends):
            raise BadArgumentError(f'first and last are not for "{word}", which settles the ends.')
        own = {
            "natural": _laws.natural_spline_velocities,
            "periodic": _laws.periodic_spline_velocities,
        }[word]
        made = for_each_axis(shape, lambda i: own(columns[:, i], times))
    return np.array(made).T.reshape(columns.shape[:1] + shape)


def via_cubics(
    points: ArrayLike,
    durations: ArrayLike,
    velocities: ArrayLike | Method = "clamped",
) -> Law:
    """One cubic a segment through via points, from time 0; every point is reached.

    Between points 0 and 1 in the time T with the velocities v0 and v1 (Craig 2005, §7.3):
    ``q = q0 + v0 t + b t² + a t³`` with ``a = (T (v1 + v0) - 2 (q1 - q0)) / T³`` and
    ``b = -(T (v1 + 2 v0) - 3 (q1 - q0)) / T²``.

    Parameters
    ----------
    points : array_like, (k,) or (k, n)
        k >= 2
    durations : array_like, (k - 1,)
        [s], each > 0
    velocities : array_like, shape of `points`, or a method of `via_velocities`
        At the points. In task space: see `joint_velocities`.

    Raises
    ------
    BadArgumentError
        Sizes that do not fit, durations that are not positive, values that are not finite.
    """
    shape, columns = point_columns(points)
    times = numbers_of(durations, "durations")
    if isinstance(velocities, str):
        # Any text may come in; via_velocities refuses the words that it does not know.
        velocities = via_velocities(points, times, velocities)  # type: ignore[arg-type]
    _, rates = point_columns(velocities, "velocities")
    if np.shape(velocities) != columns.shape[:1] + shape:
        raise BadArgumentError(
            f"velocities have the shape {np.shape(velocities)}; they must have that of points, "
            f"{columns.shape[:1] + shape}."
        )
    made = for_each_axis(shape, lambda i: _laws.via_cubics(columns[:, i], times, rates[:, i]))
    return Law(made, shape)


def joint_velocities(robot: Robot, points: ArrayLike, tool_velocities: ArrayLike) -> Vector:
    """Joint velocities that move the tool as wanted at via points: J⁻¹ of each (Craig 2005, §7.3).

    Parameters
    ----------
    robot : Robot
        An arm with kinematics.
    points : array_like, (k, n)
        Joints [rad or m].
    tool_velocities : array_like, (k, 6) or (k, 3)
        In the base frame: linear [m/s] and angular [rad/s], or linear alone for an arm of up to
        three joints.

    Returns
    -------
    ndarray, (k, n)
        [rad/s or m/s]; of an arm with more than six joints the smallest (least squares).

    Raises
    ------
    SingularError
        A point at which the arm has lost a direction; it names the point and the singularity.
    UncontrolledError
        A velocity that this arm cannot make at all, since it has too few joints.
    BadArgumentError
        Sizes that do not fit, values that are not finite.
    """
    arm = require_robot(robot)
    joints = numbers_of(points, "points")
    wanted = numbers_of(tool_velocities, "tool_velocities")
    n = arm.joints
    if joints.ndim != 2 or joints.shape[1] != n:
        raise BadArgumentError(f"points have the shape {joints.shape}; they must be (k, {n}).")
    rows = (3, 6) if n <= 3 else (6,)
    if wanted.ndim != 2 or len(wanted) != len(joints) or wanted.shape[1] not in rows:
        allowed = " or ".join(f"({len(joints)}, {m})" for m in rows)
        raise BadArgumentError(
            f"tool_velocities have the shape {wanted.shape}; they must be {allowed}."
        )
    rates = [
        _rates(arm, k, q, velocity)
        for k, (q, velocity) in enumerate(zip(joints, wanted, strict=True))
    ]
    return np.array(rates).reshape(joints.shape)


def _rates(arm: Robot, k: int, q: Vector, velocity: Vector) -> Vector:
    jacobian = arm.jacobian(q)[: len(velocity)]
    directions, shares, _ = np.linalg.svd(jacobian)
    if shares[-1] <= SINGULAR * shares[0]:
        kind = arm.singularity(q).name
        named = f"the {kind} singularity" if kind != "none" else "a singular point"
        raise SingularError(
            f"point {k} is at {named}: no joint velocity moves the tool as wanted there.",
            ways_out=[
                "give the velocity in joint space",
                "let via_velocities() choose it",
                "move the point",
            ],
            value=float(shares[-1] / shares[0]),
            limit=SINGULAR,
        )
    missed = directions[:, len(shares) :].T @ velocity
    if np.linalg.norm(missed) > FOLLOWED * np.linalg.norm(velocity):
        raise UncontrolledError(
            f"the arm's {arm.joints} joints cannot make the tool velocity at point {k}: "
            f"they miss {np.linalg.norm(missed):.3g} of it.",
            ways_out=["give a velocity that the arm can make", "give the linear velocity alone"],
            value=float(np.linalg.norm(missed)),
            limit=0.0,
        )
    rates: Vector = np.linalg.pinv(jacobian) @ velocity
    return rates
