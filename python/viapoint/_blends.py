"""Straight lines joined by blends: parabolic ones, through points among them, and quartic ones."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, integer, number, numbers_of
from ._axes import boundary_values, for_each_axis, one_an_axis, point_columns, values_by_axis
from ._law import BlendedLines, Law
from .errors import BadArgumentError

_laws = _core.profile

DEFAULT_HALF_GAP = 0.25
"""Time from a pseudo via point to its through point, as a share of the shorter segment there."""
SMALLEST_HALF_GAP = 1e-6
"""The same share; with less, the lines to the pseudo via points turn as if there were one point."""


@dataclass(frozen=True)
class _ThroughPoint:
    index: int
    velocity: Vector
    half_gap: float


def blended_lines(
    points: ArrayLike,
    durations: ArrayLike | None = None,
    *,
    acceleration: ArrayLike,
    speed: ArrayLike | None = None,
    through: Mapping[int, ArrayLike | None] | None = None,
    half_gap: float | None = None,
) -> BlendedLines:
    """Linear segments with parabolic blends, from time 0 (Craig 2005, eqs 7.24 to 7.29).

    Inner points are passed by; the first and the last are reached at rest, by blends that lie
    wholly inside their segments: ``t_1 = T - sqrt(T² - 2 Δq / a)``. A blend between the linear
    velocities v and v' takes ``|v' - v| / a`` about its point's time. Two ways to call it: with
    `durations`, or with the `speed` of the linear parts, from which durations follow.

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
    through : mapping from the index of an inner point to a velocity or None, optional
        Points to go exactly through, each by two *pseudo via points* on a line through it, with
        that velocity, a float or (n,), or with that of the slope heuristic.
    half_gap : float, optional
        Time from either pseudo via point to its through point [s]; by default a quarter of the
        shorter segment beside it; at least a millionth of that.

    Raises
    ------
    BadArgumentError
        Durations and speed both or neither, sizes that do not fit, an acceleration too small to
        leave a linear part (``limit`` is the least that works), a speed that is not reached, a
        half_gap that is too small or too large.
    """
    shape, columns = point_columns(points)
    accelerations = values_by_axis(acceleration, "acceleration", shape, len(columns))
    if durations is not None and speed is None:
        times = numbers_of(durations, "durations")
        return _lines(shape, columns, times, accelerations, through, half_gap)
    if speed is None or durations is not None:
        raise BadArgumentError("give durations or speed, one of the two.")
    speeds = values_by_axis(speed, "speed", shape, len(columns) - 1)
    times = _times_at(shape, columns, speeds, accelerations)
    try:
        return _lines(shape, columns, times, accelerations, through, half_gap)
    except BadArgumentError as error:
        axis = error.joint or 0
        if not _is_too_gentle(accelerations[axis], error):
            raise
        least = _least_at_speed(shape, columns, speeds, accelerations, through, half_gap, axis)
        if not math.isfinite(least):
            raise
        raise BadArgumentError(
            (f"axis {axis}: " if shape else "")
            + f"an acceleration of {np.min(accelerations[axis]):.7g} leaves no linear part at "
            f"this speed; at least {least * (1 + 1e-6):.7g} is needed in every blend.",
            ways_out=["give a larger acceleration", "give a smaller speed"],
            joint=error.joint,
            value=float(np.min(accelerations[axis])),
            limit=least,
        ) from None


def parabolic_blend(
    w0: ArrayLike,
    w1: ArrayLike,
    w2: ArrayLike,
    before: float,
    after: float,
    half_width: float,
) -> Law:
    """Two lines at full speed and one parabolic blend about the point between (Taylor 1979).

    On [T1 - ΔT, T1 + ΔT], with τ from its beginning, ``w = a τ² / 2 + b τ + c``,
    ``a = (T1 Δw2 - T2 Δw1) / (2 T1 T2 ΔT)``, ``b = Δw1 / T1`` and ``c = w1 - ΔT Δw1 / T1``.

    Parameters
    ----------
    w0, w1, w2 : float or array_like, (n,)
        The three points; w1 is passed by at time `before`.
    before, after : float
        Durations of the two segments, T1 and T2 [s].
    half_width : float
        The blend lasts from ``before - half_width`` to ``before + half_width``; ΔT [s].

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

    Velocity and acceleration are continuous inside; it starts and ends at speed. About the point
    q_B, with ``h = (t + t_acc) / (2 t_acc)``, ΔB the start of the transition and ΔC the next point
    seen from it, and ``K = ΔC t_acc / T + ΔB``: ``q = (K (2 - h) h² - 2 ΔB) h + q_B + ΔB``.

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


def _times_at(
    shape: tuple[int, ...], columns: Vector, speeds: list[Vector], accelerations: list[Vector]
) -> Vector:
    """Durations with which the slowest axis of each segment runs at its speed."""
    each = for_each_axis(
        shape, lambda i: _laws.durations_at_speed(columns[:, i], speeds[i], accelerations[i])
    )
    times: Vector = np.max(each, axis=0)
    for i in np.flatnonzero(times == 0.0):
        raise BadArgumentError(
            f"points {i} and {i + 1} are equal, so no speed gives the segment between them a "
            "duration.",
            ways_out=["leave one of them out", "give durations in place of speed"],
        )
    return times


def _lines(
    shape: tuple[int, ...],
    columns: Vector,
    times: Vector,
    accelerations: list[Vector],
    through: Mapping[int, ArrayLike | None] | None,
    half_gap: float | None,
) -> BlendedLines:
    passed = _through_points(shape, columns, times, through, half_gap)

    def make(i: int) -> tuple[_core.profile.BlendedLines, list[float]]:
        pseudo = _laws.pseudo_via_points(
            columns[:, i], times, [(p.index, p.velocity[i], p.half_gap) for p in passed]
        )
        each = accelerations[i] if len(accelerations[i]) == 1 else accelerations[i][pseudo.source]
        made = _laws.blended_lines(pseudo.points, pseudo.durations, each, pseudo.middles)
        return made, pseudo.points

    axes = for_each_axis(shape, make)
    aimed_at = np.array([points for _, points in axes]).T
    return BlendedLines(
        [law for law, _ in axes], shape, aimed_at.reshape(aimed_at.shape[:1] + shape)
    )


def _through_points(
    shape: tuple[int, ...],
    columns: Vector,
    times: Vector,
    through: Mapping[int, ArrayLike | None] | None,
    half_gap: float | None,
) -> list[_ThroughPoint]:
    if through is not None and not isinstance(through, Mapping):
        raise BadArgumentError("through must map indices of points to velocities or None.")
    if not through:
        return []
    heuristic = np.array(
        for_each_axis(shape, lambda i: _laws.slope_velocities(columns[:, i], times, 0.0, 0.0))
    ).T
    if len(columns) < 3:
        raise BadArgumentError("through needs an inner point, so at least 3 points.")
    given = {integer(key, "index in through", 1, len(columns) - 2): through[key] for key in through}
    passed = []
    for index in sorted(given):
        value = given[index]
        velocity = (
            heuristic[index] if value is None else one_an_axis(value, f"through[{index}]", shape)
        )
        shorter = float(min(times[index - 1], times[index]))
        gap = DEFAULT_HALF_GAP * shorter if half_gap is None else _half_gap(half_gap, shorter)
        passed.append(_ThroughPoint(index, velocity, gap))
    return passed


def _half_gap(value: float, shorter: float) -> float:
    gap = number(value, "half_gap", "s", above=0.0)
    least = SMALLEST_HALF_GAP * shorter
    if gap < least:
        raise BadArgumentError(
            f"half_gap is {gap:g} s; it must be at least {least:g} s, a millionth of the shorter "
            "segment beside its point.",
            ways_out=["give a larger half_gap", "leave it out for a quarter of that segment"],
            value=gap,
            limit=least,
        )
    return gap


def _is_too_gentle(accelerations: Vector, error: BadArgumentError) -> bool:
    """Tell whether the lines were refused for their acceleration: it is held against the least."""
    given = float(np.min(accelerations))
    return error.value == given > 0.0 and error.limit is not None and error.limit > given


def _least_at_speed(
    shape: tuple[int, ...],
    columns: Vector,
    speeds: list[Vector],
    accelerations: list[Vector],
    through: Mapping[int, ArrayLike | None] | None,
    half_gap: float | None,
    axis: int,
) -> float:
    """Return the least acceleration of one axis that works, where durations follow from it, too.

    Infinity where none does.
    """

    def works(acceleration: float) -> bool:
        tried = [*accelerations]
        tried[axis] = np.array([acceleration])
        try:
            times = _times_at(shape, columns, speeds, tried)
            _lines(shape, columns, times, tried, through, half_gap)
        except BadArgumentError as error:
            return (error.joint or 0) != axis  # another axis has a least of its own
        return True

    low = float(np.min(accelerations[axis]))
    high = 2.0 * low
    while math.isfinite(high) and not works(high):
        low, high = high, 2.0 * high
    for _ in range(60):  # halvings that exhaust a double
        middle = low + 0.5 * (high - low)
        low, high = (low, middle) if works(middle) else (middle, high)
    return high
