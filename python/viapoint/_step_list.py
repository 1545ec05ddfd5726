"""What every program is: a robot, where it starts, its defaults, and the steps so far."""

from __future__ import annotations

from math import inf
from typing import Literal, Unpack

from . import _core
from ._arguments import (
    NOTEWORTHY_CORRECTION,
    ArrayLike,
    Vector,
    number,
    numbers_of,
    pose,
    vector,
)
from ._robot import Robot, require_robot
from ._wishes import Wishes, refuse_others
from ._zone import ZoneLike, zone_of
from .errors import BadArgumentError

_Limit = Literal["speed", "acceleration", "angular_speed", "angular_acceleration", "scale"]


class StepList:
    """Steps for one robot, and the defaults of their options."""

    def __init__(
        self,
        robot: Robot,
        *,
        start: ArrayLike,
        speed: float | None,
        acceleration: float | None,
        angular_speed: float | None,
        angular_acceleration: float | None,
        scale: float | None,
        zone: ZoneLike,
    ) -> None:
        self.robot = require_robot(robot)
        self._defaults: dict[_Limit, float | None] = {
            "speed": speed,
            "acceleration": acceleration,
            "angular_speed": angular_speed,
            "angular_acceleration": angular_acceleration,
            "scale": scale,
        }
        self._zone = zone_of(zone)
        self._options()  # refuses a bad default here, where it was given
        self._core = _core.MotionProgram(robot._core, vector(start, "start", robot.joints))

    def __len__(self) -> int:
        """Count the steps."""
        return len(self._core)

    @property
    def start(self) -> Vector:
        """Joints where the program begins, (n,) [rad or m]."""
        return self._core.start

    def _options(self, **wishes: Unpack[Wishes]) -> _core.MoveOptions:
        """Check the wishes of a move, and add the defaults."""
        refuse_others(wishes)
        process_speed = wishes.get("process_speed")
        if wishes.get("speed") is not None and process_speed is not None:
            raise BadArgumentError(
                "Both speed and process_speed are given; the second is the speed to hold, give "
                "that alone."
            )
        given = wishes.get("zone")
        zone = self._zone if given is None else zone_of(given)

        def wish(name: _Limit, unit: str, most: float = inf) -> float | None:
            value = wishes.get(name)
            value = self._defaults[name] if value is None else value
            return None if value is None else number(value, name, unit, above=0.0, most=most)

        return _core.MoveOptions(
            speed=wish("speed", "m/s"),
            acceleration=wish("acceleration", "m/s²"),
            angular_speed=wish("angular_speed", "rad/s"),
            angular_acceleration=wish("angular_acceleration", "rad/s²"),
            process_speed=None
            if process_speed is None
            else number(process_speed, "process_speed", "m/s", above=0.0),
            scale=wish("scale", "", most=1.0),
            zone=zone.kind,
            size=zone.size,
            angle=zone.angle,
        )

    def _target(
        self,
        target: ArrayLike | None,
        position: ArrayLike | None,
        name: str = "target",
    ) -> _core.Target:
        if position is not None:
            if target is not None:
                raise BadArgumentError(f"Both {name} and position are given; give one of them.")
            return _core.Target.position(vector(position, "position", 3, "x, y, z"))
        if target is None:
            raise BadArgumentError(f"Neither {name} nor position is given; give one of them.")
        array = numbers_of(target, name)
        if array.ndim == 2:
            matrix, correction = pose(array, name)
            # The planner reports the correction as a warning, with the script's line.
            return _core.Target.pose(
                matrix, correction if correction > NOTEWORTHY_CORRECTION else 0.0
            )
        if array.shape != (self.robot.joints,):
            raise BadArgumentError(
                f"{name} has the shape {array.shape}; it must be ({self.robot.joints},): joints, "
                "or (4, 4): a pose."
            )
        return _core.Target.joints(array)
