"""What was measured in every cycle, fetched from a loop that keeps the last few thousand."""

from __future__ import annotations

from typing import Protocol

import numpy as np
import numpy.typing as npt

from ._arguments import Vector
from .errors import DriveFaultError

Bits = npt.NDArray[np.uint64]
Observed = tuple[Bits, npt.NDArray[np.int64], Vector, Bits, Bits]
"""Of k cycles: numbers (k,), stamps [ns] (k,), joints (k, n), inputs and outputs (k,)."""
_MOST = 1000
"""So many cycles are fetched at once."""


class Observable(Protocol):
    """A loop that tells what it has measured."""

    @property
    def newest_cycle(self) -> int: ...
    @property
    def fault(self) -> str: ...
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
        """Take what has come; False where nothing has.

        Raises
        ------
        DriveFaultError
            The loop is another one, begun anew after this one's end.
        """
        before = self.count
        while True:
            # From the last one that is known: the cycles of a loop begun anew have other stamps.
            part = self._loop.observed(self._next - (self.count > 0), _MOST)
            new = part if self.count == 0 else self._after_the_last(part)
            if not len(new[0]):
                return self.count > before
            self._parts.append(new)
            self._next = int(new[0][-1]) + 1
            self.count += len(new[0])
            self.seconds = 1e-9 * float(new[1][-1] - self._parts[0][1][0])
            if len(part[0]) < _MOST:
                return True

    def _after_the_last(self, part: Observed) -> Observed:
        """Return the cycles after the last one that is known."""
        last = self._next - 1
        numbers, stamps = part[0], part[1]
        if len(numbers) and int(numbers[0]) > last:  # it is kept no more
            return part
        if not len(numbers) or stamps[0] != self._parts[-1][1][-1]:
            raise DriveFaultError(
                f"After {self.seconds:.3f} s of measured cycles the loop was begun anew: the "
                "drive had failed, or was released.",
                ways_out=["Look at arm.fault_cycles, and begin again."],
            )
        numbers, stamps, q, inputs, outputs = part
        return numbers[1:], stamps[1:], q[1:], inputs[1:], outputs[1:]

    def require_progress(self) -> None:
        """Raise what keeps more cycles from coming.

        Raises
        ------
        DriveFaultError
            The loop has failed.
        """
        if fault := self._loop.fault:
            before = f"After {self.seconds:.3f} s of measured cycles: " if self.count else ""
            raise DriveFaultError(
                before + fault, ways_out=["Clear the fault at the drive, then connect again."]
            )

    def refuse_standstill(self) -> None:
        """Raise that no more cycles come.

        Raises
        ------
        DriveFaultError
            Always; with what has failed, where something has.
        """
        self.require_progress()
        raise DriveFaultError(
            f"After {self.seconds:.3f} s of measured cycles no more come: the drive was released "
            "by a stop of category 1, or the loop stands still.",
            ways_out=["Connect again."],
        )

    def samples(self) -> tuple[Vector, Vector, Bits]:
        """Return times from the first cycle on [s], (k,), joints (k, n) and outputs (k,)."""
        stamps, q, outputs = (np.concatenate([p[i] for p in self._parts]) for i in (1, 2, 4))
        return 1e-9 * (stamps - stamps[0]).astype(np.float64), q, outputs
