"""What a cell does over and over: pick, place, and screw in."""

from __future__ import annotations

import math
from typing import Literal, Self

from . import _core
from ._arguments import ArrayLike, Vector, choice, number
from ._arguments import pose as pose_of
from ._source import caller
from ._steps import Steps
from ._zone import ZoneLike
from .cells import Gripper, lifted
from .errors import BadArgumentError

_MOST_STROKES = 10_000


class WorkSteps(Steps):
    """Steps of a program that are made of several moves."""

    def pick(
        self,
        at: ArrayLike,
        gripper: Gripper,
        *,
        approach: float = 0.1,
        near_speed: float = 0.1,
        travel: Literal["ptp", "lin"] = "ptp",
        zone: ZoneLike | None = None,
    ) -> Self:
        """Go above a part, down to it, grip it, and lift it.

        Above is `approach` back along the tool's z axis (`viapoint.cells.lifted`).

        Parameters
        ----------
        at : array_like, (4, 4)
            pose_base_tool at the part [m], in the program's frame.
        gripper : Gripper
            Closes there, and the arm waits for it.
        approach : float
            How far above [m].
        near_speed : float
            Tool speed between above and the part [m/s].
        travel : {"ptp", "lin"}
            How the arm gets above: straight in joint space or with the tool.
        zone : Zone, float or "fine", optional
            How near the way must pass above; at the part the arm stops. Default: the program's.

        Raises
        ------
        BadArgumentError, NotARotationError
            By the argument's name.
        """
        return self._visit(at, gripper, True, approach, near_speed, travel, zone)

    def place(
        self,
        at: ArrayLike,
        gripper: Gripper,
        *,
        approach: float = 0.1,
        near_speed: float = 0.1,
        travel: Literal["ptp", "lin"] = "ptp",
        zone: ZoneLike | None = None,
    ) -> Self:
        """Go above a place, set the part down, open the gripper, and draw back.

        Parameters and errors are those of `pick`.
        """
        return self._visit(at, gripper, False, approach, near_speed, travel, zone)

    def screw_in(
        self,
        length: float,
        pitch: float,
        *,
        gripper: Gripper | None = None,
        most_turn: float = math.pi,
        angular_speed: float | None = None,
    ) -> Self:
        """Turn a screw into its thread: about the tool's z axis, with the travel of the thread.

        A length of b pitches takes b turns. What is more than `most_turn` is done in equal strokes:
        after each the gripper opens, the tool turns back on the spot, and the gripper closes again.

        Parameters
        ----------
        length : float
            How deep [m].
        pitch : float
            Travel of the thread for every turn [m]; negative: a left-hand thread.
        gripper : Gripper, optional
            Needed for more than one stroke.
        most_turn : float
            Largest angle of a stroke [rad].
        angular_speed : float, optional
            At most that of the turning [rad/s].

        Raises
        ------
        BadArgumentError
            By the argument's name; more than one stroke without a gripper.
        """
        deep = number(length, "length", "m", above=0.0)
        travel = number(pitch, "pitch", "m")
        if travel == 0.0:
            raise BadArgumentError("pitch is 0 m; a thread has one.")
        whole = 2.0 * math.pi * deep / travel
        most = number(most_turn, "most_turn", "rad", above=0.0)
        needed = abs(whole) / most * (1.0 - 1e-12)
        if not needed <= _MOST_STROKES:
            raise BadArgumentError(
                f"{deep:g} m of pitch {travel:g} m take {needed:.4g} strokes of {most:.4g} rad; "
                f"allowed are {_MOST_STROKES}."
            )
        strokes = max(1, math.ceil(needed))
        if strokes > 1 and gripper is None:
            raise BadArgumentError(
                f"{deep:g} m take {abs(whole):.4g} rad, more than a stroke of {most:.4g} rad.",
                ways_out=["Give the gripper that lets go between strokes.", "Raise most_turn."],
            )
        angle = whole / strokes
        for stroke in range(strokes):
            if stroke and gripper is not None:
                self._grip(gripper, False)
                self._turn(-angle, 0.0, angular_speed)
                self._grip(gripper, True)
            self._turn(angle, travel, angular_speed)
        return self

    def _visit(
        self,
        at: ArrayLike,
        gripper: Gripper,
        closed: bool,
        approach: float,
        near_speed: float,
        travel: str,
        zone: ZoneLike | None,
    ) -> Self:
        if not isinstance(gripper, Gripper):
            raise BadArgumentError(f"gripper is {gripper!r}; it must be a viapoint.cells.Gripper.")
        there: Vector = pose_of(at, "at")[0]
        above = lifted(there, number(approach, "approach", "m", above=0.0))
        slow = number(near_speed, "near_speed", "m/s", above=0.0)
        way = choice(travel, "travel", ("ptp", "lin"))
        file, line = caller()
        passing = self._options(zone=zone)
        if way == "ptp":
            self._core.add_movej(_core.Target.pose(above, 0.0), passing, file, line)
        else:
            self._core.add_movel(_core.Target.pose(above, 0.0), "least", passing, file, line)
        down = self._options(speed=slow, zone="fine")
        self._core.add_movel(_core.Target.pose(there, 0.0), "least", down, file, line)
        self._grip(gripper, closed)
        back = self._options(speed=slow, zone=zone)
        self._core.add_movel(_core.Target.pose(above, 0.0), "least", back, file, line)
        return self

    def _grip(self, gripper: Gripper, closed: bool) -> None:
        self._core.add_set_do(gripper.output, closed == gripper.closed, 0.0, 0.0, *caller())
        if gripper.dwell > 0.0:
            self._core.add_wait(gripper.dwell, *caller())

    def _turn(self, angle: float, pitch: float, angular_speed: float | None) -> None:
        options = self._options(angular_speed=angular_speed, zone="fine")
        self._core.add_turn(None, None, angle, pitch, "tangent", options, *caller())
