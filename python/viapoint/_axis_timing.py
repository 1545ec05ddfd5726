"""Axes with laws of their own, brought into one motion."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal, TypeAlias

import numpy as np

from . import _core
from ._arguments import Vector, choice
from ._axes import for_each_axis
from ._law import AxisLaw, Law
from .errors import BadArgumentError

_laws = _core.profile

Timing: TypeAlias = Literal["synchronised", "simultaneous", "sequential"]
TIMINGS = ("synchronised", "simultaneous", "sequential")


def together(laws: Sequence[Law], timing: Timing = "synchronised") -> Law:
    """Make one motion of several axes, each with a law of its own.

    Parameters
    ----------
    laws : sequence of Law
        One an axis, all beginning at one time.
    timing : {"synchronised", "simultaneous", "sequential"}
        ``"synchronised"``: all start together and arrive together, the quicker ones stretched in
        time; of laws of one shape this is a straight line in joint space. ``"simultaneous"``: all
        start together, each at its own pace, and wait at their ends. ``"sequential"``: one after
        the other.

    Returns
    -------
    Law
        Of the shape (n,), one axis a law.

    Raises
    ------
    BadArgumentError
        No law, a law of several axes, laws that begin at different times, or, unless synchronised,
        one that would have to wait where it has speed.
    """
    try:
        alone = list(laws)
    except TypeError:
        raise BadArgumentError(
            f"laws is a {type(laws).__name__}; it must be a list of laws, one an axis."
        ) from None
    for k, law in enumerate(alone):
        if not isinstance(law, Law) or law.shape not in ((), (1,)):
            raise BadArgumentError(f"laws[{k}] must be the law of one axis.")
    axes = [law._axes[0] for law in alone]
    return Law(_laws.timed_together(axes, _timing(timing)), (len(axes),))


def moving_axes(
    shape: tuple[int, ...], x: dict[str, Vector], make: Callable[[int], AxisLaw]
) -> list[AxisLaw | None]:
    """Return the laws of the axes that have a distance to go, None for the others."""
    made = for_each_axis(shape, lambda i: make(i) if x["q0"][i] != x["q1"][i] else None)
    if all(law is None for law in made):
        raise BadArgumentError(
            f"from {np.array2string(x['q0'], threshold=4)} to itself there is nothing to move."
        )
    return made


def timed_axes(x: dict[str, Vector], moves: list[AxisLaw | None], timing: Timing) -> list[AxisLaw]:
    """Time the moves together, and let the other axes rest meanwhile."""
    moving = iter(_laws.timed_together([law for law in moves if law is not None], _timing(timing)))
    timed = [None if law is None else next(moving) for law in moves]
    span = next(law for law in timed if law is not None)
    return [
        _laws.resting(x["q0"][i], span.start, span.end) if law is None else law
        for i, law in enumerate(timed)
    ]


def _timing(timing: Timing) -> _core.profile.AxisTiming:
    # The stubs cannot say what an attribute by name gives; choice() lets only its members through.
    return getattr(_laws.AxisTiming, choice(timing, "timing", TIMINGS))  # type: ignore[no-any-return]  # found by name
