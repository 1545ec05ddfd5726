"""Laws drawn by control points: Bézier and B-spline."""

from __future__ import annotations

import numpy as np

from . import _core
from ._arguments import ArrayLike, integer, number, numbers_of
from ._axes import for_each_axis, one_an_axis, point_columns
from ._law import Law
from .errors import BadArgumentError

_laws = _core.profile


def bezier(points: ArrayLike, duration: float, *, t0: float = 0.0) -> Law:
    """Bézier law: one polynomial drawn by control points (Farin 2002, ch. 5).

    ``q = Σ C(m, i) (1 - u)^(m - i) u^i points[i]`` with u = (t - t0)/duration and m = k - 1. It
    begins at the first point toward the second, ends at the last from the one before, and stays
    between the least and the greatest of them. Doubled or tripled end points make it start and end
    at rest, or with no acceleration.

    Parameters
    ----------
    points : array_like, (k,) or (k, n)
        Control points, 2 <= k <= 12.
    duration : float
        [s], > 0
    t0 : float
        Time at which it begins [s].

    Raises
    ------
    BadArgumentError
        Another k, values that are not finite, a duration that is not positive.
    """
    shape, columns = point_columns(points)
    begin = number(t0, "t0", "s")
    end = begin + number(duration, "duration", "s", above=0.0)
    return Law(for_each_axis(shape, lambda i: _laws.bezier(columns[:, i], begin, end)), shape)


def b_spline(
    points: ArrayLike,
    duration: float | None = None,
    *,
    knots: ArrayLike | None = None,
    degree: int = 3,
    t0: float = 0.0,
) -> Law:
    """B-spline law: pieces of a polynomial drawn by control points (de Boor 1978, ch. IX).

    ``q = Σ N_{i,degree}(t) points[i]``. It stays in the hull of its control points and has
    ``degree - 1`` continuous derivatives; a control point moves ``degree + 1`` spans only.

    Parameters
    ----------
    points : array_like, (k,) or (k, n)
        Control points, k > degree. Inner ones are not reached.
    duration : float, optional
        With this, spans of equal length from t0 on, and the law begins at the first control point
        and ends at the last [s].
    knots : array_like, (k + degree + 1,), optional
        In place of `duration`: not falling; the law runs from ``knots[degree]`` to ``knots[k]``
        [s].
    degree : int
        1 to 5.
    t0 : float
        Time at which it begins, with `duration` [s].

    Raises
    ------
    BadArgumentError
        Duration and knots both or neither, sizes that do not fit, knots that fall or come too
        often, values that are not finite.
    """
    shape, columns = point_columns(points)
    order = integer(degree, "degree", 1, 5)
    begin = number(t0, "t0", "s")
    if duration is not None and knots is None:
        end = begin + number(duration, "duration", "s", above=0.0)
        times = np.array(_laws.clamped_knots(len(columns), order, begin, end))
    elif knots is not None and duration is None:
        if begin != 0.0:
            raise BadArgumentError("t0 is for a duration; knots say themselves when it begins.")
        times = numbers_of(knots, "knots")
    else:
        raise BadArgumentError("give duration or knots, one of the two.")
    return Law(for_each_axis(shape, lambda i: _laws.b_spline(columns[:, i], times, order)), shape)


def b_spline_through(
    points: ArrayLike,
    durations: ArrayLike,
    *,
    degree: int = 5,
    v0: ArrayLike = 0.0,
    v1: ArrayLike = 0.0,
    a0: ArrayLike = 0.0,
    a1: ArrayLike = 0.0,
) -> Law:
    """B-spline that reaches every point at its time, from time 0 (Biagiotti & Melchiorri, §4.5).

    Of degree 3 it is the clamped cubic spline; of degree 5 velocity, acceleration, jerk and the
    fourth derivative are continuous.

    Parameters
    ----------
    points : array_like, (k,) or (k, n)
        k >= 2
    durations : array_like, (k - 1,)
        [s], each > 0
    degree : {3, 5}
        Of the spline.
    v0, v1 : float or array_like, (n,)
        Velocities at the ends.
    a0, a1 : float or array_like, (n,)
        Accelerations at the ends; of degree 5 only.

    Raises
    ------
    BadArgumentError
        Another degree, accelerations of degree 3, sizes that do not fit, durations that are not
        positive or too far apart.
    """
    shape, columns = point_columns(points)
    times = numbers_of(durations, "durations")
    order = integer(degree, "degree", 3, 5)
    ends = [
        one_an_axis(value, name, shape)
        for value, name in ((v0, "v0"), (v1, "v1"), (a0, "a0"), (a1, "a1"))
    ]
    if order == 3 and np.any(ends[2:]):
        raise BadArgumentError("a spline of degree 3 takes no accelerations at its ends.")

    def make(i: int) -> _core.profile.AxisLaw:
        conditions = [float(end[i]) for end in ends]
        return _laws.spline_through(columns[:, i], times, order, *conditions)

    return Law(for_each_axis(shape, make), shape)
