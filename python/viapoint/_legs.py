"""What the setpoints of a run tell of its moves: which keep a speed, and which are straight."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from ._arguments import Vector
from ._attained import Attained

STEADY = 0.5
"""A move is judged on the middle half of its way."""
_FEWEST = 10
"""A move that has fewer cycles there is not judged."""
_EVEN = 0.01
"""Speeds that differ by no more than this share are one."""
_STRAIGHT = 2e-4
"""A way that bends by no more [m] is a straight one; planned lines may by 5e-5."""


@dataclass(frozen=True)
class Leg:
    """The middle half of a move, as it was told.

    Attributes
    ----------
    move : int
        The program's step.
    order : int
        Its place among the moves of the run that go somewhere, from 0.
    speed : float or None
        That it keeps [m/s]; None where it changes.
    begin, end : ndarray, (3,)
        Of the middle half [m].
    is_straight : bool
        Whether it runs straight from `begin` to `end`.
    """

    move: int
    order: int
    speed: float | None
    begin: Vector
    end: Vector
    is_straight: bool

    @property
    def direction(self) -> Vector:
        """From begin to end, of length 1."""
        way: Vector = (self.end - self.begin) / np.linalg.norm(self.end - self.begin)
        return way


def middle_half(run: Attained, move: int) -> npt.NDArray[np.intp]:
    """Return the rows of the middle half of a move's way, (k,); none where there is none."""
    rows = np.flatnonzero(run.move == move)
    if not len(rows):
        return rows
    way = run.along[rows] - run.along[rows[0]]
    edge = 0.5 * (1.0 - STEADY) * way[-1]
    middle: npt.NDArray[np.intp] = rows[(way >= edge) & (way <= way[-1] - edge)]
    return middle


def _goes_somewhere(run: Attained, move: int) -> bool:
    """Tell a move, short as it may be, from a rest."""
    rows = np.flatnonzero(run.move == move)
    return bool(run.along[rows[-1]] - run.along[max(rows[0] - 1, 0)] > _STRAIGHT)


def legs_of(run: Attained) -> list[Leg]:
    """Return the moves of a run that are long enough to be judged, in order."""
    legs: list[Leg] = []
    order = -1
    _, first = np.unique(run.move, return_index=True)
    for move in run.move[np.sort(first)].tolist():
        order += _goes_somewhere(run, move)
        rows = middle_half(run, move)
        places = run.told[rows, :3, 3]
        if len(rows) < _FEWEST or np.linalg.norm(places[-1] - places[0]) < 10.0 * _STRAIGHT:
            continue
        speeds = np.diff(run.along[rows]) / np.diff(run.time[rows])
        usual = float(np.median(speeds))
        leg = Leg(
            move=move,
            order=order,
            speed=usual if np.ptp(speeds) <= _EVEN * usual else None,
            begin=places[0],
            end=places[-1],
            is_straight=False,
        )
        off = places - leg.begin
        aside = off - (off @ leg.direction)[:, None] * leg.direction
        straight = bool(np.linalg.norm(aside, axis=1).max() <= _STRAIGHT)
        legs.append(replace(leg, is_straight=straight))
    return legs


def corner_of(first: Leg, second: Leg) -> Vector | None:
    """Where the lines of two straight legs meet, (3,); None where they do not.

    Nor do they where the arm moves otherwise between them, be it for a moment.
    """
    if second.order != first.order + 1 or not (first.is_straight and second.is_straight):
        return None
    normal = np.cross(first.direction, second.direction)
    if np.linalg.norm(normal) < np.sin(np.radians(1.0)):
        return None
    # first.end + a d1 = second.begin - b d2 + c normal, with c the gap between the lines
    columns = np.column_stack([first.direction, second.direction, -normal])
    a, b, c = np.linalg.solve(columns, second.begin - first.end)
    if a < 0.0 or b < 0.0 or abs(c) * np.linalg.norm(normal) > 2.0 * _STRAIGHT:
        return None
    meet: Vector = first.end + a * first.direction
    return meet
