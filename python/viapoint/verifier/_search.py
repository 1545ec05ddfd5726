"""Branch and bound over intervals of many paths at once: do all stay below a tolerance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ._balls import Array, Indices

Bounds = Callable[[Indices, Array, Array], tuple[Array, Array]]
"""Of items, middles and halves: what is never passed, and what is reached. Each (N,)."""

DEEPEST = 26
MOST_OPEN = 64
"""Intervals of one item that may be open at a time; what holds by a hair needs a handful."""
BATCH = 3000
OVERHANG = 4e-9
"""How far beyond its ends a path is looked at: as far as a piece may run beyond them, and more."""


@dataclass
class Worst:
    """What of an item was found, items by number.

    Attributes
    ----------
    bound, reached, at : ndarray, (m,)
        Never passed; reached for certain; and where on the item the open question was decided.
    proven : ndarray of bool, (m,)
    """

    bound: Array
    reached: Array
    at: Array
    proven: npt.NDArray[np.bool_]


def prove_below(
    bounds: Bounds, tolerance: Array, breaks: list[Array] | None = None, parts: int = 2
) -> Worst:
    """Prove that items keep their tolerances over u in [0, 1].

    Parameters
    ----------
    tolerance : ndarray, (m,)
        Of each item.
    breaks : list of ndarray, optional
        Where each item has to be cut.
    parts : int
        Into which each is cut to begin with.
    """
    count = len(tolerance)
    worst = Worst(np.zeros(count), np.zeros(count), np.full(count, 0.5), np.ones(count, dtype=bool))
    items, low, high = _begin(count, breaks, parts)
    for depth in range(DEEPEST + 1):
        if len(items) == 0:
            break
        found = [
            bounds(items[k : k + BATCH], *_middle(low[k : k + BATCH], high[k : k + BATCH]))
            for k in range(0, len(items), BATCH)
        ]
        bound = np.concatenate([f[0] for f in found])
        reached = np.concatenate([f[1] for f in found])
        np.maximum.at(worst.reached, items, reached)
        limit = tolerance[items]
        # Written so that NaN is no proof.
        good = bound <= limit
        np.maximum.at(worst.bound, items[good], bound[good])
        # A file may claim what is neither provable nor refutable: work on it has an end.
        open_ = np.bincount(items[~good], minlength=count)[items]
        endless = (depth == DEEPEST) | (open_ > MOST_OPEN)
        lost = ~good & ((reached > limit) | endless | ~np.isfinite(bound))
        for k in np.flatnonzero(lost):
            if worst.proven[items[k]] or bound[k] > worst.bound[items[k]]:
                worst.at[items[k]] = 0.5 * (low[k] + high[k])
            worst.bound[items[k]] = max(worst.bound[items[k]], bound[k])
            worst.proven[items[k]] = False
        keep = ~good & worst.proven[items]
        items, low, high = items[keep], low[keep], high[keep]
        middle = 0.5 * (low + high)
        items = np.tile(items, 2)
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
    return worst


def _begin(count: int, breaks: list[Array] | None, parts: int) -> tuple[Indices, Array, Array]:
    items, lows, highs = [], [], []
    for item in range(count):
        inner = np.linspace(0.0, 1.0, parts + 1)[1:-1]
        if breaks is not None:
            inner = np.union1d(inner, breaks[item])
        edges = np.concatenate([[-OVERHANG], inner, [1.0 + OVERHANG]])
        items.append(np.full(len(edges) - 1, item))
        lows.append(edges[:-1])
        highs.append(edges[1:])
    if not items:
        return np.empty(0, dtype=np.intp), np.empty(0), np.empty(0)
    return np.concatenate(items), np.concatenate(lows), np.concatenate(highs)


def _middle(low: Array, high: Array) -> tuple[Array, Array]:
    """Middle and half width, the latter wider by more than its rounding."""
    middle = 0.5 * (low + high)
    return middle, 0.5 * (high - low) * (1.0 + 1e-12) + 1e-16
