"""How near a move must pass its point."""

from __future__ import annotations

import math
import numbers
from dataclasses import dataclass
from typing import Literal, TypeAlias

from ._arguments import number
from .errors import BadArgumentError


@dataclass(frozen=True)
class Zone:
    """A zone: made by `radius`, `deviation` and `joint_deviation`.

    Attributes
    ----------
    kind : str
        ``"fine"``, ``"radius"``, ``"deviation"`` or ``"joint_deviation"``.
    size : float
        [m], or [rad] for ``"joint_deviation"``; 0 for ``"fine"``.
    angle : float or None
        Bound of the tool's orientation besides [rad].
    """

    kind: str
    size: float = 0.0
    angle: float | None = None


ZoneLike: TypeAlias = Zone | float | Literal["fine"]

FINE = Zone("fine")


def radius(metres: float, *, angle: float | None = None) -> Zone:
    """Let the path leave its legs at most `metres` from the point, at the tool.

    With `angle` it leaves them only where the tool's orientation, too, is that near to the one at
    the point. Position and orientation blend together, so what is used up first rules both.

    Parameters
    ----------
    metres : float
        Blend radius [m], above 0. The same as giving the number itself as `zone`.
    angle : float, optional
        Largest angle from the orientation at the point [rad], above 0 and at most pi.

    Raises
    ------
    BadArgumentError
        Not a positive finite number.
    """
    return Zone("radius", number(metres, "radius", "m", above=0.0), _angle(angle))


def deviation(metres: float, *, angle: float | None = None) -> Zone:
    """Let path and legs be at most `metres` apart, both ways, at the tool.

    With `angle` the tool is turned by at most that from where the legs have it, side by side along
    the way. Position and orientation blend together, so what is used up first rules both.

    Parameters
    ----------
    metres : float
        Largest distance [m], above 0.
    angle : float, optional
        Largest angle between the orientations [rad], above 0 and at most pi.

    Raises
    ------
    BadArgumentError
        Not a positive finite number.
    """
    return Zone("deviation", number(metres, "deviation", "m", above=0.0), _angle(angle))


def joint_deviation(radians: float) -> Zone:
    """Let path and legs be at most `radians` apart over all joints (2-norm), both ways.

    Parameters
    ----------
    radians : float
        Largest distance [rad, or m for prismatic joints], above 0.

    Raises
    ------
    BadArgumentError
        Not a positive finite number.
    """
    return Zone("joint_deviation", number(radians, "joint_deviation", "rad", above=0.0))


def _angle(value: float | None) -> float | None:
    return None if value is None else number(value, "angle", "rad", above=0.0, most=math.pi)


def zone_of(value: ZoneLike, name: str = "zone") -> Zone:
    """Return the zone that `value` means: a `Zone`, a number [m] or "fine".

    Raises
    ------
    BadArgumentError
        Anything else, or a size that is not positive and finite.
    """
    if isinstance(value, Zone):
        return value
    if isinstance(value, str):
        if value == "fine":
            return FINE
    elif isinstance(value, numbers.Real) and not isinstance(value, bool):
        return Zone("radius", number(value, name, "m", above=0.0))
    raise BadArgumentError(
        f"{name} is {value!r}; it must be a number [m], "
        '"fine", radius(m), deviation(m) or joint_deviation(rad).'
    )
