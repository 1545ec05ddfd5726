"""Which part of which leg every stretch of a planned path is, and what its corners cut off."""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np

from . import _core
from ._arguments import Vector

SAME = 1e-9
"""Largest difference of a part's coefficients from those of its leg [rad, m]."""
_PLACES = 33


@dataclass(frozen=True)
class Stretch:
    """Quintics (6, n) of u in [0, 1], and whom they belong to."""

    coefficients: Vector
    leg: int | None = None
    corner: int | None = None
    start: float = 0.0
    end: float = 0.0


class LegPath:
    """The whole way of one leg in joints, piece by piece over s."""

    def __init__(self, leg: _core.WantedLeg) -> None:
        path = leg.path
        self.lengths = np.asarray(path["lengths"], dtype=float)
        self.coefficients = np.asarray(path["coefficients"], dtype=float)
        self.starts = np.concatenate([[0.0], np.cumsum(self.lengths)])

    @property
    def length(self) -> float:
        """Of s."""
        return float(self.starts[-1])

    def find(self, path: Vector) -> tuple[float, float] | None:
        """Return from where to where on the leg `path` goes; None where it is no part of it."""
        for k, whole in enumerate(self.coefficients):
            if np.array_equal(whole, path):
                return float(self.starts[k]), float(self.starts[k + 1])
        for k, whole in enumerate(self.coefficients):
            begin, end = _nearest(whole, path[0]), _nearest(whole, path.sum(axis=0))
            if end > begin and np.abs(part(whole, begin, end) - path).max() <= SAME:
                start, length = self.starts[k], self.lengths[k]
                return float(start + begin * length), float(start + end * length)
        return None

    def place_of(self, q: Vector) -> float:
        """Return s of the point of the leg nearest to joints q."""
        near = [_nearest(whole, q) for whole in self.coefficients]
        points = [value(whole, u) for whole, u in zip(self.coefficients, near, strict=True)]
        k = int(np.argmin([np.linalg.norm(point - q) for point in points]))
        return float(self.starts[k] + near[k] * self.lengths[k])

    def between(self, start: float, end: float, leg: int) -> list[Stretch]:
        """Cut out the pieces from one s to another."""
        result = []
        for k, whole in enumerate(self.coefficients):
            low, high = max(start, self.starts[k]), min(end, self.starts[k + 1])
            if high - low <= 1e-12 * self.length:
                continue
            u = (np.array([low, high]) - self.starts[k]) / self.lengths[k]
            cut = part(whole, max(u[0], 0.0), min(u[1], 1.0))
            result.append(Stretch(cut, leg=leg, start=float(low), end=float(high)))
        return result


def value(path: Vector, u: float) -> Vector:
    """Joints at u."""
    result: Vector = (u ** np.arange(6)) @ path
    return result


def part(path: Vector, begin: float, end: float) -> Vector:
    """Coefficients of the part between two u, over [0, 1] again."""
    out = np.zeros_like(path)
    for j in range(6):
        for k in range(j, 6):
            out[j] += comb(k, j) * begin ** (k - j) * (end - begin) ** j * path[k]
    return out


def _nearest(path: Vector, q: Vector) -> float:
    """Return u in [0, 1] of the point nearest to q: the best of many, then Gauss-Newton."""
    places = np.linspace(0.0, 1.0, _PLACES)
    points = np.vander(places, 6, increasing=True) @ path
    u = float(places[np.argmin(np.sum((points - q) ** 2, axis=1))])
    slopes = path[1:] * np.arange(1.0, 6.0)[:, None]
    for _ in range(8):
        slope = (u ** np.arange(5)) @ slopes
        if not (square := float(slope @ slope)) > 0.0:
            break
        u = min(1.0, max(0.0, u - float((value(path, u) - q) @ slope) / square))
    return u


def stretches_of(
    paths: Vector, moves: list[int], legs: list[_core.WantedLeg], corners: dict[int, int]
) -> tuple[list[Stretch], dict[int, tuple[list[Stretch], list[Stretch]]]]:
    """Tell what every path belongs to.

    Parameters
    ----------
    paths : ndarray, (m, 6, n)
        As they run.
    moves : list of int, (m,)
        Program step of each.
    legs : list of WantedLeg
        In order.
    corners : dict
        Number of each rounded corner, by the leg that it ends.

    Returns
    -------
    list of Stretch, (m,)
    dict of (list of Stretch, list of Stretch)
        What each corner cuts off its legs, before and after, by its number.
    """
    ways = [LegPath(leg) for leg in legs]
    leg_of = {leg.move: i for i, leg in enumerate(legs)}
    found: list[Stretch] = []
    blend: list[int] = []  # indices of paths that lie one after the other in corners
    ends: dict[int, tuple[Vector, Vector]] = {}

    def close(blend: list[int]) -> None:
        for at, leg in _shared_out([(j, leg_of[moves[j]]) for j in blend]):
            corner = corners[leg]
            found[at] = Stretch(paths[at], corner=corner)
            first = ends[corner][0] if corner in ends else paths[at][0]
            ends[corner] = first, paths[at].sum(axis=0)

    for path, move in zip(paths, moves, strict=True):
        at_rest = not path[1:].any()
        place = None
        if not at_rest and move in leg_of:
            place = ways[leg_of[move]].find(path)
            if place is None:
                blend.append(len(found))
        if at_rest or place is not None:
            close(blend)
            blend = []
        if place is None:
            found.append(Stretch(path))
        else:
            found.append(Stretch(path, leg=leg_of[move], start=place[0], end=place[1]))
    close(blend)
    cuts = {}
    for leg, corner in corners.items():
        first, last = ends[corner]
        before = ways[leg].between(ways[leg].place_of(first), ways[leg].length, leg)
        after = ways[leg + 1].between(0.0, ways[leg + 1].place_of(last), leg + 1)
        cuts[corner] = before, after
    return found, cuts


def _shared_out(blend: list[tuple[int, int]]) -> list[tuple[int, int]]:
    """Give each path of neighbouring corners the leg that its corner ends.

    The first half of a corner is told as of the leg that it leaves, the second of the next; where
    nothing is left of a leg between two corners, both their halves are its.
    """
    legs = sorted({leg for _, leg in blend})
    result = []
    for leg in legs:
        own = [at for at, other in blend if other == leg]
        if leg == legs[0]:
            half = 0
        elif leg == legs[-1]:
            half = len(own)
        else:
            half = len(own) // 2
        result += [(at, leg - 1) for at in own[:half]] + [(at, leg) for at in own[half:]]
    return sorted(result)
