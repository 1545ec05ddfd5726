"""The steps of a program: straight moves, frames and tools, waits, outputs, timed points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, Self, Unpack

from . import _core
from ._arguments import ArrayLike, choice, number
from ._curve_steps import CurveSteps
from ._signals import on_or_off, signal
from ._source import caller
from ._wishes import Wishes
from ._zone import ZoneLike
from .errors import BadArgumentError
from .frames import Frame, Tool, frame_of, tool_of


class Steps(CurveSteps):
    """All that a program can be told to do, one step a call."""

    def movej(
        self,
        target: ArrayLike | None = None,
        *,
        position: ArrayLike | None = None,
        scale: float | None = None,
        zone: ZoneLike | None = None,
    ) -> Self:
        """Move straight in joint space (PTP).

        Parameters
        ----------
        target : array_like, (n,) or (4, 4)
            Joints [rad or m], or pose_base_tool [m], taken on the branch nearest to where the move
            begins.
        position : array_like, (3,), optional
            Instead of `target`: the tool's position [m], any orientation.
        scale : float, optional
            Share of all joint limits, in (0, 1].
        zone : Zone, float or "fine", optional
            How near the move must pass its point.

        Raises
        ------
        BadArgumentError, NotARotationError
            By the argument's name.
        """
        options = self._options(scale=scale, zone=zone)
        file, line = caller()
        self._core.add_movej(self._target(target, position), options, file, line)
        return self

    def movel(
        self,
        target: ArrayLike | None = None,
        *,
        position: ArrayLike | None = None,
        orientation: Literal["least", "wrist", "fixed", "spin"] = "least",
        **wishes: Unpack[Wishes],
    ) -> Self:
        """Move the tool's point in a straight line (LIN).

        Parameters
        ----------
        target : array_like, (4, 4) or (n,)
            pose_base_tool [m], or the joints [rad or m] of that pose.
        position : array_like, (3,), optional
            Instead of `target`: the tool's position [m], with its orientation left free.
        orientation : {"least", "wrist", "fixed", "spin"}
            The least rotation between the two poses; the wrist joints interpolated, with the
            position straight; the orientation as it is at the start; or the tool's z axis by the
            least turn to the target's, while the tool may spin about it as the joints like.
        speed, acceleration : float, optional
            At most that at the tool's point [m/s], [m/s²].
        angular_speed, angular_acceleration : float, optional
            At most that of the tool's turning [rad/s], [rad/s²].
        process_speed : float, optional
            Tool speed to be kept wherever the limits allow [m/s], instead of `speed`; see
            `Motion.process_stretches`.
        scale : float, optional
            Share of all joint limits, in (0, 1].
        zone : Zone, float or "fine", optional
            How near the move must pass its point.

        Raises
        ------
        BadArgumentError, NotARotationError
            By the argument's name.
        """
        options = self._options(**wishes)
        way = choice(orientation, "orientation", ("least", "wrist", "fixed", "spin"))
        file, line = caller()
        self._core.add_movel(self._target(target, position), way, options, file, line)
        return self

    def set_frame(self, frame: Frame | ArrayLike | None = None) -> Self:
        """Tell every later pose, position, center and axis in this frame.

        Joints are what they are. A frame only says where targets are: corners are rounded as if
        the same targets were told in the base frame.

        Parameters
        ----------
        frame : Frame or array_like, (4, 4), optional
            pose_base_frame [m]. Default: the base frame again.

        Raises
        ------
        BadArgumentError, NotARotationError
            No pose.
        """
        chosen = frame_of(frame)
        self._core.add_set_frame(chosen.pose, chosen.name, *caller())
        return self

    def set_tool(self, tool: Tool | ArrayLike | None = None) -> Self:
        """Move this tool in every later move.

        A zone is a promise about one tool's point, so the arm stops at the point where the tool
        changes; a zone given for the move before is reported as a stop.

        Parameters
        ----------
        tool : Tool or array_like, (4, 4), optional
            pose_flange_tool [m]. Default: the robot's own again.

        Raises
        ------
        BadArgumentError, NotARotationError
            No pose.
        """
        chosen = None if tool is None else tool_of(tool)
        pose, name = (None, "") if chosen is None else (chosen.pose, chosen.name)
        self._core.add_set_tool(pose, name, *caller())
        return self

    def wait(self, seconds: float) -> Self:
        """Stay at rest for `seconds` [s], 0 or longer.

        Raises
        ------
        BadArgumentError
            Negative or not finite.
        """
        self._core.add_wait(number(seconds, "seconds", "s", least=0.0), *caller())
        return self

    def wait_di(self, index: int, value: bool = True, *, timeout: float | None = None) -> Self:
        """Stay at rest until a digital input is so.

        The arm goes on in the cycle after the drive has reported it; an input that is so already
        holds it for no longer than the stop itself. Meanwhile ``job.state`` is ``"waiting"``. A
        pause holds the clock of the time-out.

        Parameters
        ----------
        index : int
            Input, 0 to 63.
        value : bool
            Until it is on, or until it is off.
        timeout : float, optional
            After so long [s] the run ends there: its state is ``"stopped"``, and waiting for it
            raises `InputTimeoutError`. Default: it waits for ever.

        Raises
        ------
        BadArgumentError
            Another index, a value that is not a bool, or a time-out that is not above 0.
        """
        number_of_input, awaited = signal(index), on_or_off(value, "input")
        longest = None if timeout is None else number(timeout, "timeout", "s", above=0.0)
        self._core.add_wait_di(number_of_input, awaited, longest, *caller())
        return self

    def set_do(self, index: int, value: bool, *, distance: float = 0.0, time: float = 0.0) -> Self:
        """Set a digital output where the path has got to, or some way or time from there.

        In a corner that is the place on the path nearest to the point.

        Parameters
        ----------
        index : int
            Output, 0 to 63.
        value : bool
            On or off.
        distance : float
            So far along the path of the tool [m]: on the move after, negative on the move before.
            A place, whatever the override. At most as long as that move.
        time : float
            So long after the arm passes that place [s], negative: before it does, at the rate it
            then runs at. On the clock, whatever the override. At most 2 s either way.

        Raises
        ------
        BadArgumentError
            Another index, a value that is not a bool, a time out of range. `plan` raises it for a
            distance longer than the move, and for changes of one output that would come in another
            order than they are told in.
        """
        output, switched = signal(index), on_or_off(value, "output")
        way = number(distance, "distance", "m")
        most = _core.MOST_OUTPUT_TIME
        seconds = number(time, "time", "s", least=-most, most=most)
        self._core.add_set_do(output, switched, way, seconds, *caller())
        return self

    def timed(
        self,
        points: Sequence[tuple[ArrayLike, float]],
        *,
        t_acc: float = 0.2,
        space: Literal["joint", "cartesian"] = "joint",
    ) -> Self:
        """Pass points at fixed times with quartic transitions: the classic form, for study.

        It starts and ends at full speed, so no drive takes it; it always plans, and the limits it
        breaks are in the report. It stands alone in its program.

        Parameters
        ----------
        points : sequence of (array_like, float)
            Each a pose (4, 4) [m] or joints (n,) [rad or m], and the time from the point before
            [s]; 0 for the first.
        t_acc : float
            The transition about an inner point lasts from -t_acc to t_acc [s].
        space : {"joint", "cartesian"}
            Joints linear in time, or the drive transform between the poses.

        Raises
        ------
        BadArgumentError, NotARotationError
            By the argument's name.
        """
        file, line = caller()
        if not isinstance(points, Sequence) or isinstance(points, str):
            raise BadArgumentError(
                f"points is {points!r}; it must be a list of (pose or joints, seconds)."
            )
        timed = []
        for i, point in enumerate(points):
            try:
                target, seconds = point
            except (TypeError, ValueError):
                raise BadArgumentError(
                    f"points[{i}] is {point!r}; it must be (pose or joints, seconds)."
                ) from None
            timed.append(
                (
                    self._target(target, None, f"points[{i}][0]"),
                    number(seconds, f"points[{i}][1]", "s", least=0.0),
                )
            )
        self._core.add_timed(
            timed,
            number(t_acc, "t_acc", "s", above=0.0),
            choice(space, "space", ("joint", "cartesian")),
            file,
            line,
        )
        return self
