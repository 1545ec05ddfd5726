"""What was measured in every cycle, fetched from a loop that keeps the last few thousand."""

from __future__ import annotations

from typing import Protocol

import numpy as np
import numpy.typing as npt

from ._arguments import Vector

Bits = npt.NDArray[np.uint64]
Observed = tuple[Bits, npt.NDArray[np.int64], Vector, Bits, Bits]
"""Of k cycles: numbers (k,), stamps [ns] (k,), joints (k, n), inputs and outputs (k,)."""
_MOST = 1000
"""So many cycles are fetched at once."""


class Observable(Protocol):
    """A loop that tells what it has measured."""

    @property
    def newest_cycle(self) -> int: ...
    def observed(self, from_cycle: int, most: int) -> Observed: ...


class Tape:
    """Every cycle from the newest one on, as it is fetched in time.

    Parameters
    ----------
    loop : Observable
        It keeps 4096 cycles: `fetch` has to be called within them.

    Attributes
    ----------
    count : int
        Of the cycles fetched.
    seconds : float
        From the first of them to the last [s].
    """

    def __init__(self, loop: Observable) -> None:
        self._loop = loop
        self._next = loop.newest_cycle
        self._parts: list[Observed] = []
        self.count = 0
        self.seconds = 0.0

    def fetch(self) -> bool:
        """Take what has come; False where nothing has."""
        before = self.count
        while len((part := self._loop.observed(self._next, _MOST))[0]):
            self._parts.append(part)
            self._next = int(part[0][-1]) + 1
            self.count += len(part[0])
            self.seconds = 1e-9 * float(part[1][-1] - self._parts[0][1][0])
        return self.count > before

    def samples(self) -> tuple[Vector, Vector, Bits]:
        """Return times from the first cycle on [s], (k,), joints (k, n) and outputs (k,)."""
        stamps, q, outputs = (np.concatenate([p[i] for p in self._parts]) for i in (1, 2, 4))
        return 1e-9 * (stamps - stamps[0]).astype(np.float64), q, outputs
