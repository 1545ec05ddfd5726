"""What a program may ask of a single move, besides where it goes."""

from __future__ import annotations

from typing import TypedDict

from ._zone import ZoneLike


class Wishes(TypedDict, total=False):
    """Limits of a move, the speed that it shall hold, and its zone."""

    speed: float | None
    acceleration: float | None
    angular_speed: float | None
    angular_acceleration: float | None
    process_speed: float | None
    scale: float | None
    zone: ZoneLike | None


def refuse_others(wishes: Wishes) -> None:
    """Refuse keywords that no move has, as a function that names its own would.

    Raises
    ------
    TypeError
        With the first of them.
    """
    for name in wishes:
        if name not in Wishes.__annotations__:
            raise TypeError(
                f"unexpected keyword argument {name!r}; what a move may be asked is "
                f"{', '.join(Wishes.__annotations__)}"
            )
