"""How a path's speed was kept: AV, RV and FV of ISO 9283:1998, §8.6."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ._arguments import ArrayLike, Vector, integer, number, numbers_of
from ._attained import Attained, attained_runs
from ._legs import middle_half
from ._run_log import RunLog
from .errors import BadArgumentError

OVER = 0.01
"""A speed is the way between two places so far apart in time [s]."""


@dataclass(frozen=True)
class PathVelocity:
    """How well a speed along a path was kept.

    Attributes
    ----------
    cycles : int
        n, of which the standard asks for 10.
    commanded, attained : float
        v_c and v̄ [m/s].
    accuracy : float
        AV, as a share of v_c.
    repeatability : float
        RV, as a share of v_c, to be read as ±; NaN for one cycle.
    fluctuation : float
        FV [m/s].
    """

    cycles: int
    commanded: float
    attained: float
    accuracy: float
    repeatability: float
    fluctuation: float


def path_velocity(commanded: float, attained: Sequence[ArrayLike]) -> PathVelocity:
    """Path velocity accuracy AV, repeatability RV and fluctuation FV (ISO 9283:1998, §8.6).

    With the speeds v_ij of cycle j, their mean v̄_j, and v̄ the mean of these:
    AV = (v̄ - v_c) / v_c, RV = ±3 √(Σ (v̄_j - v̄)² / (n - 1)) / v_c, and
    FV = max_j (max_i v_ij - min_i v_ij).

    Parameters
    ----------
    commanded : float
        v_c [m/s].
    attained : sequence of array_like, (m_j,)
        The speeds of each cycle [m/s].

    Raises
    ------
    BadArgumentError
        No speed above 0, no cycles, or a cycle without speeds.
    """
    wanted = number(commanded, "commanded", "m/s", above=0.0)
    cycles = [numbers_of(speeds, f"attained[{j}]") for j, speeds in enumerate(attained)]
    if not cycles:
        raise BadArgumentError("attained is empty; give at least one cycle.")
    for j, speeds in enumerate(cycles):
        if speeds.ndim != 1 or not len(speeds):
            raise BadArgumentError(
                f"attained[{j}] has the shape {speeds.shape}; it must be (m,), m at least 1."
            )
    means = np.array([speeds.mean() for speeds in cycles])
    spread = 3.0 * float(means.std(ddof=1)) if len(means) > 1 else float("nan")
    return PathVelocity(
        cycles=len(cycles),
        commanded=wanted,
        attained=float(means.mean()),
        accuracy=(float(means.mean()) - wanted) / wanted,
        repeatability=spread / wanted,
        fluctuation=max(float(np.ptp(speeds)) for speeds in cycles),
    )


def path_velocity_from_logs(
    logs: Sequence[RunLog], commanded: float, *, move: int, over: float = OVER
) -> PathVelocity:
    """Take the speeds of one move from what drives measured, on the middle half of its way.

    Parameters
    ----------
    logs : sequence of RunLog
        One a cycle, of the same program.
    commanded : float
        v_c, the speed that the move was programmed with [m/s].
    move : int
        The program's step, as `RunLog.move` counts, from 0.
    over : float
        A speed is the way between two measured places so far apart in time [s]: as long as is
        needed for the noise of encoders not to count.

    Raises
    ------
    BadArgumentError
        As `path_velocity`; logs without measured joints or without that move, or in which its
        middle half takes less time than `over`.
    """
    step = integer(move, "move", 0, 2**31 - 1)
    window = number(over, "over", "s", above=0.0)
    return path_velocity(commanded, [speeds_of(run, step, window) for run in attained_runs(logs)])


def speeds_of(run: Attained, move: int, over: float = OVER) -> Vector:
    """Speeds that were attained on the middle half of a move, (k,) [m/s].

    Raises
    ------
    BadArgumentError
        As `path_velocity_from_logs`.
    """
    steady = middle_half(run, move)
    if len(steady) < 2:
        raise BadArgumentError(f"{run.name} holds nothing of move {move}.")
    apart = max(1, round(over / run.period))
    if len(steady) <= apart:
        raise BadArgumentError(
            f"{run.name}: the middle half of move {move} has {len(steady)} cycles, less than "
            f"{over:g} s.",
            ways_out=["Give a shorter `over`, or take a longer move."],
        )
    places, times = run.reached[steady, :3, 3], run.time[steady]
    distance = np.linalg.norm(places[apart:] - places[:-apart], axis=1)
    speeds: Vector = distance / (times[apart:] - times[:-apart])
    return speeds
