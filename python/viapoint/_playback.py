"""Smooth paths near a recording: played in its tempo, faster, slower, backwards or in loops."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, file_name, integer, number
from ._program import Program
from ._robot import Robot
from ._smoothing import b_spline

if TYPE_CHECKING:
    from ._arm import Arm
    from ._job import Job

_TEMPO = 0.002
"""Share of a stage's duration that its tempo may be off by."""
_TRIALS = 12
_LEAST_SCALE = 1e-4
_STILL = 0.02
"""Rests shorter than this [s] are none."""
_SAME_PLACE = 1e-9
"""Joints nearer than this are at the same place [rad or m]."""


@dataclass(frozen=True, eq=False)
class Stage:
    """One way without a stop, or a rest, which has one control point.

    Attributes
    ----------
    control : ndarray, (m, n)
        Control points of a clamped uniform cubic B-spline of the joints [rad or m]; one: a rest.
    outputs : int
        Digital outputs meanwhile, bit i is output i.
    before, moving, after : float
        Rest before the way, the way, and rest after it, as recorded [s].
    position, angle : float
        Largest distance of a sample from the path [m; over all joints: rad or m], and angle [rad].
    """

    control: Vector
    outputs: int
    before: float
    moving: float
    after: float
    position: float
    angle: float

    @classmethod
    def rest(
        cls, seconds: float, outputs: int, place: Vector, position: float, angle: float
    ) -> Stage:
        """Stay at a place, (n,) [rad or m]."""
        return cls(place[None], outputs, seconds, 0.0, 0.0, position, angle)

    @property
    def moves(self) -> bool:
        """False for a rest."""
        return len(self.control) > 1

    def reversed(self) -> Stage:
        """Return the same way from its end to its beginning."""
        return Stage(
            self.control[::-1],
            self.outputs,
            self.after if self.moves else self.before,
            self.moving,
            self.before if self.moves else self.after,
            self.position,
            self.angle,
        )


@dataclass(frozen=True, eq=False, repr=False)
class Playback:
    """A smooth path near a recording, and its tempo. Made by `Recording.fit` or `load_recording`.

    Attributes
    ----------
    robot : Robot
        The arm that was guided.
    stages : tuple of Stage
        Ways and rests in order; the arm stops between them.
    tolerance, angle_tolerance : float or None
        At the tool [m], [rad]: what was asked of every sample.
    joint_tolerance : float or None
        Instead: over all joints [rad or m].
    """

    robot: Robot
    stages: tuple[Stage, ...]
    tolerance: float | None
    angle_tolerance: float | None
    joint_tolerance: float | None

    def __repr__(self) -> str:
        """Robot, number of ways and recorded duration."""
        ways = sum(stage.moves for stage in self.stages)
        return f"<Playback of {self.robot.name}, {ways} ways, {self.duration:.3f} s as recorded>"

    @property
    def duration(self) -> float:
        """As recorded [s]."""
        return sum(stage.before + stage.moving + stage.after for stage in self.stages)

    @property
    def deviation(self) -> float:
        """Largest distance of a sample from the path, proven [m; over all joints: rad or m]."""
        return max(stage.position for stage in self.stages)

    @property
    def angle_deviation(self) -> float:
        """Largest angle of a sample from the path, proven [rad]; 0 for a tolerance in joints."""
        return max(stage.angle for stage in self.stages)

    @property
    def start(self) -> Vector:
        """Joints where the path begins, (n,) [rad or m]."""
        begin: Vector = next(stage.control[0] for stage in self.stages if stage.moves)
        return begin.copy()

    @property
    def end(self) -> Vector:
        """Joints where the path ends, (n,) [rad or m]."""
        last: Vector = next(s.control[-1] for s in reversed(self.stages) if s.moves)
        return last.copy()

    def path(self, points: int = 200) -> Vector:
        """Return joints along the whole path, `points` a way, (k, n) [rad or m]: for pictures."""
        count = integer(points, "points", 2, 100_000)
        u = np.linspace(0.0, 1.0, count)
        return np.concatenate([b_spline(s.control, u) for s in self.stages if s.moves])

    def program(
        self,
        *,
        start: ArrayLike | None = None,
        speed: float | None = 1.0,
        reverse: bool = False,
        loops: int = 1,
        approach_scale: float = 0.25,
        name: str = "playback",
    ) -> Program:
        """Return a program that plays the path.

        A way takes the time that it took when it was recorded, over `speed`, or longer where the
        limits do not allow that; between its ends the tempo is the planner's own. Outputs change
        where and when they changed; backwards they change back.

        Parameters
        ----------
        start : array_like, (n,), optional
            Where the arm stands [rad or m]: it first moves straight in joint space to the path.
            Default: the path's own beginning.
        speed : float or None
            Factor of the recorded tempo, above 0; None: as fast as the limits allow, and no rests.
        reverse : bool
            From the end to the beginning.
        loops : int
            How often, 1 to 10000; between two the arm moves straight back where it has to.
        approach_scale : float
            Share of the joint limits on the way to the path and between loops, in (0, 1].
        name : str
            The program's name.

        Raises
        ------
        BadArgumentError
            By the argument's name.
        MotionError
            What planning the path says against it.
        """
        if speed is not None:
            number(speed, "speed", above=0.0)
        times = integer(loops, "loops", 1, 10_000)
        share = number(approach_scale, "approach_scale", above=0.0, most=1.0)
        stages = list(self.stages)
        if reverse:
            stages = [stage.reversed() for stage in reversed(stages)]
        begin, end = (self.end, self.start) if reverse else (self.start, self.end)
        program = Program(self.robot, start=begin if start is None else start, name=name)
        scales = [self._scale_of(stage, speed) if stage.moves else 1.0 for stage in stages]
        at, outputs = program.start, 0
        for _ in range(times):
            if np.abs(at - begin).max() > _SAME_PLACE:
                program.movej(begin, scale=share)
            for stage, scale in zip(stages, scales, strict=True):
                for output, on in _changes(outputs, stage.outputs):
                    program.set_do(output, on)
                outputs = stage.outputs
                _wait(program, stage.before, speed)
                if stage.moves:
                    program.spline(
                        list(stage.control[1:]), kind="b_spline", space="joint", scale=scale
                    )
                _wait(program, stage.after, speed)
            at = end
        return program

    def play(
        self,
        arm: Arm,
        *,
        speed: float | None = 1.0,
        reverse: bool = False,
        loops: int = 1,
        approach_scale: float = 0.25,
        wait: bool = True,
    ) -> Job:
        """Approach the path from where the arm stands, and play it; see `program` and `Arm.run`.

        Returns
        -------
        Job
            The run.

        Raises
        ------
        MotionError
            As `program` and `Arm.run`.
        """
        program = self.program(
            start=arm.setpoint,
            speed=speed,
            reverse=reverse,
            loops=loops,
            approach_scale=approach_scale,
        )
        return arm.run(program, wait=wait)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the path as a file for `load_recording`, aside and renamed.

        Raises
        ------
        FileError
            With the path and the system's reason.
        """
        from ._playback_file import playback_text

        _core.write_file_atomically(file_name(path), playback_text(self))

    def _scale_of(self, stage: Stage, speed: float | None) -> float:
        """Find the share of the limits at which a way takes its time; 1 where that is too short."""
        if speed is None or stage.moving <= 0.0:
            return 1.0
        wanted = stage.moving / speed
        low, high = _LEAST_SCALE, 1.0
        scale = 1.0
        for _ in range(_TRIALS):
            took = self._duration_at(stage, scale)
            if scale == 1.0 and took >= wanted:
                return 1.0
            if abs(took - wanted) <= _TEMPO * wanted:
                return scale
            low, high = (scale, high) if took > wanted else (low, scale)
            # Between duration ~ 1 / share (velocity rules) and its root (acceleration) or less.
            guess = scale * (took / wanted) ** 1.5
            scale = guess if low < guess < high else float(np.sqrt(low * high))
        return scale

    def _duration_at(self, stage: Stage, scale: float) -> float:
        trial = Program(self.robot, start=stage.control[0])
        trial.spline(list(stage.control[1:]), kind="b_spline", space="joint", scale=scale)
        return _core.plan(self.robot._core, trial._core).duration


def _changes(before: int, now: int) -> Iterator[tuple[int, bool]]:
    changed = before ^ now
    for output in range(changed.bit_length()):
        if changed >> output & 1:
            yield output, bool(now >> output & 1)


def _wait(program: Program, seconds: float, speed: float | None) -> None:
    if speed is not None and seconds > _STILL:
        program.wait(seconds / speed)
