"""Factors to SI, so that people may write ``30 * deg`` and ``[10, 20] * mm``."""

from collections.abc import Sequence
from typing import overload

import numpy as np
import numpy.typing as npt

Vector = npt.NDArray[np.float64]


class Unit(float):
    """A factor to SI; times a list or tuple, on either side, it gives an array.

    Type checkers take a list on the left for a repetition: there write ``deg * [10, 20]``.
    """

    # float promises a float for every factor; a list, which float refuses, gives an array here.
    @overload  # type: ignore[override]
    def __mul__(self, other: float) -> float: ...
    @overload
    def __mul__(self, other: Sequence[float] | Sequence[Sequence[float]]) -> Vector: ...
    def __mul__(self, other: float | Sequence[float] | Sequence[Sequence[float]]) -> float | Vector:
        """Scale a number, or every number of a list."""
        if isinstance(other, (list, tuple)):
            return np.asarray(other, dtype=np.float64) * float(self)
        # What is no number either, float refuses in its own words.
        return super().__mul__(other)  # type: ignore[operator]

    @overload
    def __rmul__(self, other: float) -> float: ...
    @overload
    def __rmul__(self, other: Sequence[float] | Sequence[Sequence[float]]) -> Vector: ...
    def __rmul__(
        self, other: float | Sequence[float] | Sequence[Sequence[float]]
    ) -> float | Vector:
        """Scale a number, or every number of a list."""
        if isinstance(other, (list, tuple)):
            return np.asarray(other, dtype=np.float64) * float(self)
        # As above.
        return super().__rmul__(other)  # type: ignore[operator]


deg = Unit(np.pi / 180.0)
"""One degree in radians: ``30 * deg``."""

mm = Unit(1e-3)
"""One millimetre in metres: ``20 * mm``."""
