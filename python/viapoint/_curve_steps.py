"""Moves along curves: arcs, helices, screws and splines."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, Self, Unpack

from . import _core
from ._arguments import ArrayLike, choice, number, numbers_of, vector
from ._curve_fit import CurveFit
from ._source import caller
from ._step_list import StepList
from ._wishes import Wishes
from .errors import BadArgumentError

ArcOrientation = Literal["least", "wrist", "fixed", "tangent", "through", "spin", "free"]
SplineOrientation = ArcOrientation
SplineKind = Literal["cubic", "quintic", "bezier", "b_spline"]

_ORIENTATIONS = ("least", "wrist", "fixed", "tangent", "through", "spin", "free")
_OF_TURNS = ("fixed", "tangent", "wrist", "spin", "free")


class CurveSteps(StepList):
    """The steps of a program that follow curves."""

    def movec(
        self,
        via: ArrayLike | None = None,
        end: ArrayLike | None = None,
        *,
        position: ArrayLike | None = None,
        center: ArrayLike | None = None,
        axis: ArrayLike | None = None,
        angle: float | None = None,
        pitch: float = 0.0,
        orientation: ArcOrientation | None = None,
        **wishes: Unpack[Wishes],
    ) -> Self:
        """Move the tool's point on a circular arc (CIRC), or on a helix.

        Either through a point, ``movec(via, end)``, or about an axis,
        ``movec(center=…, axis=…, angle=…)``, for any angle, more than one turn as well.

        Parameters
        ----------
        via : array_like, (4, 4) or (3,)
            A pose or position [m] that the arc passes.
        end : array_like, (4, 4) or (n,)
            pose_base_tool [m] where it ends, or the joints [rad or m] of that pose.
        position : array_like, (3,), optional
            Instead of `end`: the tool's position [m], with its orientation left free.
        center, axis : array_like, (3,)
            A point of the axis and its direction, in the base frame [m].
        angle : float
            How far to turn about the axis [rad], positive by the right-hand rule; any size.
        pitch : float
            Travel along the axis for every positive turn [m]: a helix.
        orientation : {"least", "wrist", "fixed", "tangent", "through", "spin", "free"}, optional
            The least rotation from start to end (default of an arc by `via`); wrist joints
            interpolated; as it is at the start (default about an axis); turning with the arc;
            through the orientation of `via` as well; the tool's z axis by the least turn, free to
            spin about it; or only the position held. About an axis there is no end pose, so
            "least" and "through" mean nothing.
        **wishes
            Limits of the move, the speed that it shall hold, and its zone, as for `movel`.

        Raises
        ------
        BadArgumentError, NotARotationError
            By the argument's name.
        """
        options = self._options(**wishes)
        if via is not None:
            if center is not None or axis is not None or angle is not None or pitch != 0.0:
                raise BadArgumentError(
                    "via is given together with center, axis, angle or pitch; an arc is either "
                    "through a point or about an axis."
                )
            way = choice(orientation or "least", "orientation", _ORIENTATIONS)
            passed = self._pose_or_position(via, "via")
            goal = self._target(end, position, "end")
            self._core.add_movec(passed, goal, way, options, *caller())
            return self
        if end is not None or position is not None:
            raise BadArgumentError("end is given without via; an arc needs a point that it passes.")
        if center is None or axis is None or angle is None:
            raise BadArgumentError(
                "Neither via and end nor all of center, axis and angle are given; an arc needs "
                "one or the other."
            )
        self._core.add_turn(
            vector(center, "center", 3, "x, y, z"),
            vector(axis, "axis", 3, "x, y, z"),
            number(angle, "angle", "rad"),
            number(pitch, "pitch", "m"),
            choice(orientation or "fixed", "orientation", _OF_TURNS),
            options,
            *caller(),
        )
        return self

    def screw(
        self,
        angle: float,
        pitch: float,
        *,
        axis: ArrayLike | None = None,
        **wishes: Unpack[Wishes],
    ) -> Self:
        """Turn the tool about an axis through its point while it travels along it, as a thread.

        Parameters
        ----------
        angle : float
            How far to turn [rad], positive by the right-hand rule; any size.
        pitch : float
            Travel along the axis for every positive turn [m]. 0: a turn on the spot.
        axis : array_like, (3,), optional
            Direction in the base frame. Default: the z axis of the tool.
        **wishes
            Limits of the move, the speed that it shall hold, and its zone, as for `movel`.

        Raises
        ------
        BadArgumentError
            By the argument's name.
        """
        options = self._options(**wishes)
        self._core.add_turn(
            None,
            None if axis is None else vector(axis, "axis", 3, "x, y, z"),
            number(angle, "angle", "rad"),
            number(pitch, "pitch", "m"),
            "tangent",
            options,
            *caller(),
        )
        return self

    def spline(
        self,
        points: Sequence[ArrayLike] | CurveFit | None = None,
        *,
        positions: ArrayLike | None = None,
        kind: SplineKind = "cubic",
        space: Literal["tool", "joint"] | None = None,
        orientation: SplineOrientation | None = None,
        **wishes: Unpack[Wishes],
    ) -> Self:
        """Move on a smooth curve from where the arm is through, or by, points.

        Parameters
        ----------
        points : sequence of array_like, each (4, 4) or (n,), or CurveFit
            Poses [m] or joints [rad or m]; or a curve that `fit_curve` made, whose beginning must
            be where the arm is.
        positions : array_like, (k, 3), optional
            Instead of `points`: tool positions [m], with the orientation left free.
        kind : {"cubic", "quintic", "bezier", "b_spline"}
            A natural spline through all points, with a continuous second or fourth derivative; or
            a curve by control points, which only begins and ends at the outer ones: one Bézier
            curve of up to 5 points after the start, or a cubic B-spline of any number.
        space : {"tool", "joint"}, optional
            Whether the tool or the joints move on the spline. Default: the joints where all points
            are joints, else the tool.
        orientation : {"through", "least", "wrist", "fixed", "tangent", "spin", "free"}, optional
            Of the tool: through that of every point (default), with continuous angular
            acceleration; by the least rotation from the first to the last; wrist joints
            interpolated; as it is at the start; led along the curve; its z axis through that of
            every point, free to spin about it; or left to the joints (default for `positions`).
        **wishes
            Limits of the move, the speed that it shall hold, and its zone, as for `movel`; in
            joint space `scale` and `zone` alone have a meaning.

        Raises
        ------
        BadArgumentError, NotARotationError
            By the argument's name.
        """
        options = self._options(**wishes)
        at: list[float] = []
        start = None
        only_positions = positions is not None
        if isinstance(points, CurveFit):
            if only_positions:
                raise BadArgumentError("Both points and positions are given; give one of them.")
            if kind != "cubic" or space == "joint":
                raise BadArgumentError("A fitted curve is a cubic spline of the tool.")
            at = points.at.tolist()
            only_positions = not points.oriented
            targets = [_fitted(pose, points.oriented) for pose in points.poses]
            start = targets.pop(0)
        else:
            targets = self._points(points, positions)
        if space is None:
            of_joints = _all_joints(self, points, positions)
        else:
            of_joints = choice(space, "space", ("tool", "joint")) == "joint"
        self._core.add_spline(
            targets,
            choice(kind, "kind", ("cubic", "quintic", "bezier", "b_spline")),
            of_joints,
            choice(
                orientation or ("free" if only_positions else "through"),
                "orientation",
                _ORIENTATIONS,
            ),
            at,
            start,
            options,
            *caller(),
        )
        return self

    def _points(
        self, points: Sequence[ArrayLike] | None, positions: ArrayLike | None
    ) -> list[_core.Target]:
        if positions is not None:
            if points is not None:
                raise BadArgumentError("Both points and positions are given; give one of them.")
            array = numbers_of(positions, "positions")
            if array.ndim != 2 or array.shape[1] != 3 or len(array) == 0:
                raise BadArgumentError(
                    f"positions has the shape {array.shape}; it must be (k, 3), k at least 1."
                )
            return [_core.Target.position(row) for row in array]
        if points is None or isinstance(points, str) or not hasattr(points, "__len__"):
            raise BadArgumentError(f"points is {points!r}; it must be a list of poses or joints.")
        if len(points) == 0:
            raise BadArgumentError("points is empty; a spline needs at least one point.")
        return [self._target(point, None, f"points[{i}]") for i, point in enumerate(points)]

    def _pose_or_position(self, value: ArrayLike, name: str) -> _core.Target:
        array = numbers_of(value, name)
        if array.shape == (3,):
            return _core.Target.position(array)
        if array.shape != (4, 4):
            raise BadArgumentError(
                f"{name} has the shape {array.shape}; it must be (4, 4): a pose, or (3,): a "
                "position."
            )
        return self._target(array, None, name)


def _fitted(pose: ArrayLike, oriented: bool) -> _core.Target:
    array = numbers_of(pose, "pose")
    return _core.Target.pose(array) if oriented else _core.Target.position(array[:3, 3])


def _all_joints(
    steps: StepList, points: Sequence[ArrayLike] | CurveFit | None, positions: ArrayLike | None
) -> bool:
    if points is None or positions is not None or isinstance(points, CurveFit):
        return False
    return all(numbers_of(p, "points").shape == (steps.robot.joints,) for p in points)
