"""Laws from one point to another."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from . import _core
from ._arguments import ArrayLike, Vector, integer, number
from ._axes import boundary_values, for_each_axis
from ._axis_timing import Timing, moving_axes, timed_axes
from ._law import AxisLaw, Law, Trapezoid
from .errors import BadArgumentError

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

    With T the duration and t from its beginning, ``q = q0 + v0 t + a2 t² + a3 t³``,
    ``a2 = (3 (q1 - q0) / T - 2 v0 - v1) / T`` and ``a3 = (v0 + v1 - 2 (q1 - q0) / T) / T²``.

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
    begin, end = _span(t0, duration)
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

    From rest to rest ``q = q0 + (q1 - q0) (10 u³ - 15 u⁴ + 6 u⁵)`` with u = t/duration, the law of
    least jerk. A quintic that begins or ends at speed can overshoot: look at ``extremes(0)``.

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
    begin, end = _span(t0, duration)

    def make(i: int) -> AxisLaw:
        ends = (x["v0"][i], x["v1"][i], x["a0"][i], x["a1"][i])
        return _laws.quintic(x["q0"][i], x["q1"][i], begin, end, *ends)

    return Law(for_each_axis(shape, make), shape)


def polynomial(conditions: Sequence[tuple[float, int, ArrayLike]]) -> Law:
    """Polynomial of least degree that meets any conditions (Biagiotti & Melchiorri 2008, §2.1).

    k conditions make the degree k - 1: the coefficients solve one linear equation a condition.

    Parameters
    ----------
    conditions : sequence of (time, derivative, value)
        2 to 12 of them, in any order: at that time [s] the derivative 0 (position) to 3 (jerk) has
        that value, a float or (n,). The law runs from the first time to the last.

    Raises
    ------
    BadArgumentError
        Values that are not finite, a condition given twice, all at one time, conditions that leave
        the polynomial open (such as velocities alone) or contradict each other, or that ask for
        coefficients which doubles cannot hold to 1e-9.
    """
    try:
        rows = None if isinstance(conditions, (str, bytes)) else list(conditions)
    except TypeError:
        rows = None
    if rows is None:
        raise BadArgumentError("conditions must be a list of (time, derivative, value).")
    for k, row in enumerate(rows):
        if isinstance(row, (str, bytes)) or not hasattr(row, "__len__") or len(row) != 3:
            raise BadArgumentError(f"conditions[{k}] must be (time, derivative, value).")
    if not rows:
        raise BadArgumentError("conditions is empty; 2 to 12 settle a polynomial.")
    times = [number(row[0], f"time of conditions[{k}]", "s") for k, row in enumerate(rows)]
    orders = [integer(row[1], f"derivative of conditions[{k}]", 0, 3) for k, row in enumerate(rows)]
    shape, x = boundary_values(**{f"conditions[{k}]": row[2] for k, row in enumerate(rows)})
    values = list(x.values())
    made = for_each_axis(
        shape,
        lambda i: _laws.polynomial(
            [(t, order, value[i]) for t, order, value in zip(times, orders, values, strict=True)]
        ),
    )
    return Law(made, shape)


def lspb(
    q0: ArrayLike,
    q1: ArrayLike,
    duration: float,
    *,
    velocity: ArrayLike | None = None,
    blend_time: ArrayLike | None = None,
) -> Trapezoid:
    """Linear segment with parabolic blends, from rest to rest (Spong et al. 2006, §5.5.2).

    With V the velocity and T the duration each blend takes ``t_b = (q0 - q1 + V T) / V`` at the
    acceleration ``V / t_b``.

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

    made = for_each_axis(shape, make)
    return Trapezoid([axis.law for axis in made], shape, [_numbers_of(axis) for axis in made])


def trapezoid(
    q0: ArrayLike,
    q1: ArrayLike,
    *,
    v_max: ArrayLike,
    a_max: ArrayLike,
    timing: Timing = "synchronised",
) -> Trapezoid:
    """Quickest move from rest to rest under velocity and acceleration limits.

    A trapezoid of velocity; where ``v_max² / a_max >= |q1 - q0|`` the velocity is not reached, and
    it is bang-bang (Biagiotti & Melchiorri 2008, §3.2.3).

    Parameters
    ----------
    q0, q1 : float or array_like, (n,)
        Where it begins and ends.
    v_max, a_max : float or array_like, (n,)
        Limits, > 0.
    timing : {"synchronised", "simultaneous", "sequential"}
        Of several axes, see `together`. An axis without a distance rests.

    Raises
    ------
    BadArgumentError
        No distance at all, limits that are not positive, values that are not finite.
    """
    shape, x = boundary_values(q0=q0, q1=q1, v_max=v_max, a_max=a_max)
    _require_limits(shape, x, "v_max", "a_max")
    return _trapezoids(
        shape,
        x,
        timing,
        lambda i: _laws.trapezoid(x["q0"][i], x["q1"][i], x["v_max"][i], x["a_max"][i]),
    )


def bang_bang(
    q0: ArrayLike,
    q1: ArrayLike,
    acceleration: ArrayLike,
    *,
    timing: Timing = "synchronised",
) -> Trapezoid:
    """Quickest move from rest to rest under an acceleration limit (Spong et al. 2006, §5.5.2).

    Full acceleration to the middle, full deceleration from there, with the switch at
    ``t_s = sqrt(|q1 - q0| / acceleration)``.

    Parameters
    ----------
    q0, q1 : float or array_like, (n,)
        Where it begins and ends.
    acceleration : float or array_like, (n,)
        Its size, > 0.
    timing : {"synchronised", "simultaneous", "sequential"}
        Of several axes, see `together`. An axis without a distance rests.

    Raises
    ------
    BadArgumentError
        No distance at all, an acceleration that is not positive, values that are not finite.
    """
    shape, x = boundary_values(q0=q0, q1=q1, acceleration=acceleration)
    _require_limits(shape, x, "acceleration")
    return _trapezoids(
        shape,
        x,
        timing,
        lambda i: _laws.bang_bang(x["q0"][i], x["q1"][i], x["acceleration"][i]),
    )


def rest_to_rest(
    q0: ArrayLike,
    q1: ArrayLike,
    *,
    v_max: ArrayLike,
    a_max: ArrayLike,
    j_max: ArrayLike,
    timing: Timing = "synchronised",
) -> Law:
    """Seven-phase S-curve: the quickest move from rest to rest under v, a and j limits.

    Phases of constant jerk, fewer where a limit is not reached (Biagiotti & Melchiorri 2008, §3.4,
    the double S).

    Parameters
    ----------
    q0, q1 : float or array_like, (n,)
        Where it begins and ends.
    v_max, a_max, j_max : float or array_like, (n,)
        Limits, > 0.
    timing : {"synchronised", "simultaneous", "sequential"}
        Of several axes, see `together`. An axis without a distance rests.

    Raises
    ------
    BadArgumentError
        No distance at all, limits that are not positive, values that are not finite.
    """
    shape, x = boundary_values(q0=q0, q1=q1, v_max=v_max, a_max=a_max, j_max=j_max)
    _require_limits(shape, x, "v_max", "a_max", "j_max")

    def make(i: int) -> AxisLaw:
        limits = x["v_max"][i], x["a_max"][i], x["j_max"][i]
        return _laws.rest_to_rest(x["q0"][i], x["q1"][i], *limits)

    moves = moving_axes(shape, x, make)
    return Law(timed_axes(x, moves, timing), shape)


def _span(t0: float, duration: float) -> tuple[float, float]:
    begin = number(t0, "t0", "s")
    return begin, begin + number(duration, "duration", "s", above=0.0)


def _require_limits(shape: tuple[int, ...], x: dict[str, Vector], *names: str) -> None:
    """Refuse limits that are not positive, of axes that rest as well."""

    def check(axis: int) -> None:
        for name in names:
            number(float(x[name][axis]), name, above=0.0)

    for_each_axis(shape, check)


def _numbers_of(axis: _core.profile.Trapezoid) -> tuple[float, float, float]:
    return axis.velocity, axis.acceleration, axis.blend_time


def _trapezoids(
    shape: tuple[int, ...],
    x: dict[str, Vector],
    timing: Timing,
    make: Callable[[int], _core.profile.Trapezoid],
) -> Trapezoid:
    numbers = [(0.0, 0.0, 0.0)] * len(x["q0"])

    def keep(i: int) -> AxisLaw:
        axis = make(i)
        numbers[i] = _numbers_of(axis)
        return axis.law

    moves = moving_axes(shape, x, keep)
    axes = timed_axes(x, moves, timing)
    if timing == "synchronised":  # stretched in time
        for i, law in enumerate(moves):
            if law is not None:
                rate = (law.end - law.start) / (axes[i].end - axes[i].start)
                velocity, acceleration, blend_time = numbers[i]
                numbers[i] = (velocity * rate, acceleration * rate**2, blend_time / rate)
    return Trapezoid(axes, shape, numbers)
