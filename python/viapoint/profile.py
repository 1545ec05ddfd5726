"""The textbook's laws of motion, for one axis or for several at once.

Every function returns a law: ``law.at(t)`` gives ``q, qd, qdd, qddd``, ``law.extremes(k)`` the
exact extremes of the derivative k. Plain numbers make a law of one axis, whose values have the
shape () or (k,); arrays of n values make a law of n axes in the same time, (n,) or (k, n)::

    law = vp.profile.quintic([0.0, 0.0], [1.0, -0.5], 2.0)
    q, qd, qdd, qddd = law.at(np.linspace(0.0, 2.0, 101))

Units are the caller's: radians or metres, and seconds.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, choice, number, numbers_of
from ._law import (
    BlendedLines,
    Extremes,
    Law,
    Part,
    State,
    Trapezoid,
    boundary_values,
    for_each_axis,
    point_columns,
    values_by_axis,
)
from ._state_to_state import StateMotion, StateSamples, state_to_state
from .errors import BadArgumentError

__all__ = [
    "BlendedLines",
    "Extremes",
    "Law",
    "Part",
    "State",
    "StateMotion",
    "StateSamples",
    "Trapezoid",
    "bang_bang",
    "blended_lines",
    "cubic",
    "lspb",
    "parabolic_blend",
    "quartic_transitions",
    "quintic",
    "rest_to_rest",
    "state_to_state",
    "via_cubics",
    "via_velocities",
]

_laws = _core.profile


def cubic(
    q0: ArrayLike,
    q1: ArrayLike,
    duration: float,
    *,
    v0: ArrayLike = 0.0,
    v1: ArrayLike = 0.0,
    t0: float = 0.0,
) -> Law:
    """Cubic with given position and velocity at both ends (Craig 2005, eq. 7.11).

    Parameters
    ----------
    q0, q1 : float or array_like, (n,)
        Where it begins and ends.
    duration : float
        [s], > 0
    v0, v1 : float or array_like, (n,)
        Velocities at the ends.
    t0 : float
        Time at which it begins [s].

    Raises
    ------
    BadArgumentError
        Values that are not finite, shapes that do not go together, a duration that is not positive.
    """
    shape, x = boundary_values(q0=q0, q1=q1, v0=v0, v1=v1)
    begin = number(t0, "t0", "s")
    end = begin + number(duration, "duration", "s", above=0.0)
    return Law(
        for_each_axis(
            shape,
            lambda i: _laws.cubic(x["q0"][i], x["q1"][i], begin, end, x["v0"][i], x["v1"][i]),
        ),
        shape,
    )


def quintic(
    q0: ArrayLike,
    q1: ArrayLike,
    duration: float,
    *,
    v0: ArrayLike = 0.0,
    v1: ArrayLike = 0.0,
    a0: ArrayLike = 0.0,
    a1: ArrayLike = 0.0,
    t0: float = 0.0,
) -> Law:
    """Quintic with given position, velocity and acceleration at both ends (Craig 2005, eq. 7.18).

    A quintic that begins or ends at speed can overshoot: look at ``extremes(0)``.

    Parameters
    ----------
    q0, q1 : float or array_like, (n,)
        Where it begins and ends.
    duration : float
        [s], > 0
    v0, v1, a0, a1 : float or array_like, (n,)
        Velocities and accelerations at the ends.
    t0 : float
        Time at which it begins [s].

    Raises
    ------
    BadArgumentError
        Values that are not finite, shapes that do not go together, a duration that is not positive.
    """
    shape, x = boundary_values(q0=q0, q1=q1, v0=v0, v1=v1, a0=a0, a1=a1)
    begin = number(t0, "t0", "s")
    end = begin + number(duration, "duration", "s", above=0.0)

    def make(i: int) -> _core.profile.AxisLaw:
        ends = (x["v0"][i], x["v1"][i], x["a0"][i], x["a1"][i])
        return _laws.quintic(x["q0"][i], x["q1"][i], begin, end, *ends)

    return Law(for_each_axis(shape, make), shape)


def lspb(
    q0: ArrayLike,
    q1: ArrayLike,
    duration: float,
    *,
    velocity: ArrayLike | None = None,
    blend_time: ArrayLike | None = None,
) -> Trapezoid:
    """Linear segment with parabolic blends, from rest to rest (Spong et al. 2006, §5.5.2).

    Parameters
    ----------
    q0, q1 : float or array_like, (n,)
        Where it begins and ends.
    duration : float
        [s], > 0
    velocity : float or array_like, (n,), optional
        Of the linear part, with the sign of ``q1 - q0``; its size must be greater than that of the
        mean velocity and at most twice that.
    blend_time : float or array_like, (n,), optional
        Of each blend [s], in (0, duration/2]. With neither, a third of the duration.

    Raises
    ------
    BadArgumentError
        Both or neither form in range; the message names the valid range.
    """
    if velocity is not None and blend_time is not None:
        raise BadArgumentError("give velocity or blend_time, not both: one follows from the other.")
    time = number(duration, "duration", "s", above=0.0)
    chosen = {"velocity": velocity, "blend_time": blend_time}
    shape, x = boundary_values(
        q0=q0, q1=q1, **{name: value for name, value in chosen.items() if value is not None}
    )

    def make(i: int) -> _core.profile.Trapezoid:
        form = {name: float(x[name][i]) for name in chosen if name in x}
        return _laws.lspb(x["q0"][i], x["q1"][i], time, **form)

    return Trapezoid(for_each_axis(shape, make), shape)


def bang_bang(q0: float, q1: float, acceleration: float) -> Trapezoid:
    """Quickest move of one axis from rest to rest under an acceleration limit.

    Raises
    ------
    BadArgumentError
        No distance, an acceleration that is not positive, values that are not finite.
    """
    law = _laws.bang_bang(
        number(q0, "q0"), number(q1, "q1"), number(acceleration, "acceleration", above=0.0)
    )
    return Trapezoid([law], ())


def rest_to_rest(q0: float, q1: float, *, v_max: float, a_max: float, j_max: float) -> Law:
    """Quickest move of one axis from rest to rest under velocity, acceleration and jerk limits.

    At most seven phases of constant jerk (Biagiotti & Melchiorri 2008, §3.4).

    Raises
    ------
    BadArgumentError
        No distance, limits that are not positive, values that are not finite.
    """
    begin, end = number(q0, "q0"), number(q1, "q1")
    if begin == end:
        raise BadArgumentError(f"from {begin:g} to itself there is nothing to move.")
    limits = [
        number(value, name, above=0.0)
        for name, value in (("v_max", v_max), ("a_max", a_max), ("j_max", j_max))
    ]
    return Law([_laws.rest_to_rest(begin, end, *limits)], ())


def via_velocities(
    points: ArrayLike,
    durations: ArrayLike,
    method: Literal["spline", "slope"] = "spline",
    *,
    first: float = 0.0,
    last: float = 0.0,
) -> Vector:
    """Velocities with which cubics pass via points.

    Parameters
    ----------
    points : array_like, (k,) or (k, n)
        k >= 2
    durations : array_like, (k - 1,)
        [s], each > 0
    method : {"spline", "slope"}
        ``"spline"``: such that acceleration is continuous. ``"slope"``: zero where the slope
        changes sign, else the mean of the two slopes.
    first, last : float
        Velocities at the ends.

    Returns
    -------
    ndarray
        Of the shape of `points`.

    Raises
    ------
    BadArgumentError
        Sizes that do not fit, durations that are not positive, another method.
    """
    shape, columns = point_columns(points)
    times = numbers_of(durations, "durations")
    make = {"spline": _laws.spline_velocities, "slope": _laws.slope_velocities}[
        choice(method, "method", ("spline", "slope"))
    ]
    ends = number(first, "first"), number(last, "last")
    made = for_each_axis(shape, lambda i: make(columns[:, i], times, *ends))
    return np.array(made).T.reshape(columns.shape[:1] + shape)


def via_cubics(
    points: ArrayLike,
    durations: ArrayLike,
    velocities: ArrayLike | None = None,
) -> Law:
    """One cubic a segment through via points, from time 0; every point is reached.

    Parameters
    ----------
    points : array_like, (k,) or (k, n)
        k >= 2
    durations : array_like, (k - 1,)
        [s], each > 0
    velocities : array_like, shape of `points`, optional
        At the points; by default those that make acceleration continuous, from rest to rest.

    Raises
    ------
    BadArgumentError
        Sizes that do not fit, durations that are not positive, values that are not finite.
    """
    shape, columns = point_columns(points)
    times = numbers_of(durations, "durations")
    if velocities is None:
        velocities = via_velocities(points, times)
    _, rates = point_columns(velocities, "velocities")
    if rates.shape != columns.shape:
        raise BadArgumentError(
            f"velocities have the shape {np.shape(velocities)}; they must have that of points, "
            f"{columns.shape[:1] + shape}."
        )
    made = for_each_axis(shape, lambda i: _laws.via_cubics(columns[:, i], times, rates[:, i]))
    return Law(made, shape)


def blended_lines(
    points: ArrayLike,
    durations: ArrayLike | None = None,
    *,
    acceleration: ArrayLike,
    speed: ArrayLike | None = None,
) -> BlendedLines:
    """Linear segments with parabolic blends, from time 0 (Craig 2005, eqs 7.24 to 7.29).

    Inner points are passed by; the first and the last are reached at rest.

    Parameters
    ----------
    points : array_like, (k,) or (k, n)
        k >= 2
    durations : array_like, (k - 1,), optional
        From point to point [s].
    acceleration : float or array_like
        Size of the acceleration in the blends: one value for all, (n,) one an axis, or one a point
        of the shape of `points`.
    speed : float or array_like, optional
        In place of `durations`: size of the velocity of the linear parts, one value for all,
        (n,) one an axis, or (k - 1,) for one axis and (k - 1, n) for several, one a segment. Of
        several axes the slowest gives each segment its duration.

    Raises
    ------
    BadArgumentError
        Durations and speed both or neither, sizes that do not fit, an acceleration too small to
        leave a linear part (``limit`` is the least that works), a speed that is not reached.
    """
    shape, columns = point_columns(points)
    accelerations = values_by_axis(acceleration, "acceleration", shape, len(columns))
    if durations is not None and speed is None:
        times = numbers_of(durations, "durations")
    elif speed is not None and durations is None:
        speeds = values_by_axis(speed, "speed", shape, len(columns) - 1)
        each = for_each_axis(
            shape, lambda i: _laws.durations_at_speed(columns[:, i], speeds[i], accelerations[i])
        )
        times = np.max(each, axis=0)
    else:
        raise BadArgumentError("give durations or speed, one of the two.")
    made = for_each_axis(
        shape, lambda i: _laws.blended_lines(columns[:, i], times, accelerations[i])
    )
    return BlendedLines(made, shape)


def parabolic_blend(
    w0: ArrayLike,
    w1: ArrayLike,
    w2: ArrayLike,
    before: float,
    after: float,
    half_width: float,
) -> Law:
    """Two lines at full speed and one parabolic blend about the point between (Taylor 1979).

    Parameters
    ----------
    w0, w1, w2 : float or array_like, (n,)
        The three points; w1 is passed by at time `before`.
    before, after : float
        Durations of the two segments [s].
    half_width : float
        The blend lasts from ``before - half_width`` to ``before + half_width`` [s].

    Raises
    ------
    BadArgumentError
        A half width that does not fit, durations that are not positive.
    """
    shape, x = boundary_values(w0=w0, w1=w1, w2=w2)
    times = (
        number(before, "before", "s", above=0.0),
        number(after, "after", "s", above=0.0),
        number(half_width, "half_width", "s"),
    )
    made = for_each_axis(
        shape, lambda i: _laws.parabolic_blend(x["w0"][i], x["w1"][i], x["w2"][i], *times)
    )
    return Law(made, shape)


def quartic_transitions(points: ArrayLike, durations: ArrayLike, t_acc: float) -> Law:
    """Lines through timed points with quartic transitions about the inner ones (Paul 1981, ch. 5).

    Velocity and acceleration are continuous inside; it starts and ends at speed.

    Parameters
    ----------
    points : array_like, (k,) or (k, n)
        k >= 2
    durations : array_like, (k - 1,)
        [s], each > 0
    t_acc : float
        Half the length of each transition [s].

    Raises
    ------
    BadArgumentError
        A t_acc that does not fit into the segments (``limit`` is the largest that does).
    """
    shape, columns = point_columns(points)
    times = numbers_of(durations, "durations")
    half = number(t_acc, "t_acc", "s")
    made = for_each_axis(shape, lambda i: _laws.quartic_transitions(columns[:, i], times, half))
    return Law(made, shape)
