"""Where along a motion the arm moves worst."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from . import _core
from .errors import UncontrolledError

if TYPE_CHECKING:
    from ._motion import Motion

_GOLDEN = (np.sqrt(5.0) - 1.0) / 2.0
_REFINEMENTS = 30


@dataclass(frozen=True)
class Least:
    """The smallest value of a measure along a motion.

    Attributes
    ----------
    value : float
        The measure.
    time : float
        When [s] from the motion's start.
    move : int
        Index of the program's step under way.
    """

    value: float
    time: float
    move: int


@dataclass(frozen=True)
class LeastDexterity:
    """The smallest values of the measures of dexterity along a motion, each with its own time.

    Attributes
    ----------
    yoshikawa, asada, isotropy, least : Least
        As `Robot.dexterity` has them. The largest condition number is 1 over ``isotropy.value``.
    """

    yoshikawa: Least
    asada: Least
    isotropy: Least
    least: Least


def least_dexterity(motion: Motion, dt: float) -> LeastDexterity:
    """Look every `dt` [s], then narrow each minimum down between its neighbours.

    Raises
    ------
    UncontrolledError
        The robot has no kinematics.
    """
    if not motion.robot.has_kinematics:
        raise UncontrolledError(
            f'The robot "{motion.robot.name}" has no kinematics, so it has no tool to move.'
        )

    def dexterity_at(times: list[float]) -> list[tuple[_core.Dexterity, int]]:
        states = motion.at(times)
        found = []
        for q, move in zip(states.q, states.move, strict=True):
            arms = [motion.robot, *(arm for first, arm in motion.tools if first <= move)]
            found.append((arms[-1].dexterity(q), int(move)))
        return found

    steps = max(2, int(np.ceil(motion.duration / dt)))
    times = np.linspace(0.0, motion.duration, steps + 1)
    seen = dexterity_at(times.tolist())

    def smallest(measure: Callable[[_core.Dexterity], float]) -> Least:
        k = int(np.argmin([measure(dexterity) for dexterity, _ in seen]))
        best = Least(measure(seen[k][0]), float(times[k]), seen[k][1])
        low, high = float(times[max(k - 1, 0)]), float(times[min(k + 1, steps)])
        for _ in range(_REFINEMENTS):
            inner = [high - _GOLDEN * (high - low), low + _GOLDEN * (high - low)]
            values = dexterity_at(inner)
            for time, (dexterity, move) in zip(inner, values, strict=True):
                if measure(dexterity) < best.value:
                    best = Least(measure(dexterity), time, move)
            if measure(values[0][0]) <= measure(values[1][0]):
                high = inner[1]
            else:
                low = inner[0]
        return best

    return LeastDexterity(
        yoshikawa=smallest(lambda d: d.yoshikawa),
        asada=smallest(lambda d: d.asada),
        isotropy=smallest(lambda d: d.isotropy),
        least=smallest(lambda d: d.least),
    )
