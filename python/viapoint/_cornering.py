"""How a corner was passed: CR and CO of ISO 9283:1998, §8.5."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ._arguments import ArrayLike, Vector, numbers_of, vector
from ._attained import attained_runs
from ._run_log import RunLog
from .errors import BadArgumentError

_STRAIGHT = 1e-6
"""Legs that turn by less than this [rad] meet in no corner."""


@dataclass(frozen=True)
class Cornering:
    """How far a corner of two straight legs was cut, and overshot.

    Attributes
    ----------
    cycles : int
        n, of which the standard asks for 3.
    rounding : float
        CR [m]: the largest, over the cycles, of the least distances from the corner.
    overshoot : float
        CO [m]: the largest deviation from the second leg on the side that the first one points to;
        0 where there is none.
    rounding_each, overshoot_each : ndarray, (n,)
        CR_j and CO_j of each cycle [m].
    """

    cycles: int
    rounding: float
    overshoot: float
    rounding_each: Vector
    overshoot_each: Vector


def cornering(
    before: ArrayLike, corner: ArrayLike, after: ArrayLike, attained: Sequence[ArrayLike]
) -> Cornering:
    """Cornering round-off error CR and overshoot CO (ISO 9283:1998, §8.5).

    CR_j = min_i |x_ij - x_e|, over the way between the samples, too. For CO the second leg is the
    z axis, and the first one comes from the side of negative y:
    CO_j = max_i √((x_ij - x_ci)² + (y_ij - y_ci)²) over those i after the corner with
    y_ij > y_ci, up to the end of the second leg.

    Parameters
    ----------
    before, corner, after : array_like, (3,)
        Where the first leg begins, where the legs meet, and where the second ends [m].
    attained : sequence of array_like, (m_j, 3)
        Places of each cycle, in order of time [m].

    Raises
    ------
    BadArgumentError
        Shapes that do not fit, or legs without length or without a corner.
    """
    ends = [vector(before, "before", 3, "x, y, z"), vector(after, "after", 3, "x, y, z")]
    meet = vector(corner, "corner", 3, "x, y, z")
    legs = [meet - ends[0], ends[1] - meet]
    lengths = [float(np.linalg.norm(leg)) for leg in legs]
    if min(lengths) <= 0.0:
        raise BadArgumentError("A leg of the corner has no length.")
    first, second = legs[0] / lengths[0], legs[1] / lengths[1]
    beyond = first - (first @ second) * second
    if float(np.linalg.norm(beyond)) < _STRAIGHT:
        raise BadArgumentError("The legs lie in one line; there is no corner between them.")
    cycles = [numbers_of(places, f"attained[{j}]") for j, places in enumerate(attained)]
    if not cycles:
        raise BadArgumentError("attained is empty; give at least one cycle.")
    cut, over = np.empty(len(cycles)), np.empty(len(cycles))
    for j, places in enumerate(cycles):
        if places.ndim != 2 or places.shape[1] != 3 or len(places) < 2:
            raise BadArgumentError(
                f"attained[{j}] has the shape {places.shape}; it must be (m, 3), m at least 2."
            )
        cut[j], passed = _nearest(places, meet)
        later = places[passed:] - meet
        along = later @ second
        on_leg = np.cumsum(along > lengths[1]) == 0
        aside = later - along[:, None] * second
        outside = on_leg & (aside @ beyond > 0.0)
        over[j] = np.linalg.norm(aside[outside], axis=1).max(initial=0.0)
    return Cornering(
        cycles=len(cycles),
        rounding=float(cut.max()),
        overshoot=float(over.max()),
        rounding_each=cut,
        overshoot_each=over,
    )


def cornering_from_logs(
    logs: Sequence[RunLog], before: ArrayLike, corner: ArrayLike, after: ArrayLike
) -> Cornering:
    """Take the tool's places from what drives measured.

    Parameters
    ----------
    logs : sequence of RunLog
        One a cycle; each passes the corner once.
    before, corner, after : array_like, (3,)
        The corner as it was programmed, without its zone [m].

    Raises
    ------
    BadArgumentError
        As `cornering`; logs without measured joints.
    """
    runs = attained_runs(logs)
    return cornering(before, corner, after, [run.reached[:, :3, 3] for run in runs])


def _nearest(places: Vector, point: Vector) -> tuple[float, int]:
    """Least distance of the polygon through `places` from `point`, and the first place after it."""
    steps = np.diff(places, axis=0)
    squares = np.maximum((steps**2).sum(axis=1), np.finfo(float).tiny)
    shares = np.clip(((point - places[:-1]) * steps).sum(axis=1) / squares, 0.0, 1.0)
    distances = np.linalg.norm(places[:-1] + shares[:, None] * steps - point, axis=1)
    nearest = int(distances.argmin())
    return float(distances[nearest]), nearest + 1
