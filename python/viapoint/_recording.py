"""Recordings of hand-guided motion: what the drives measured, and smooth paths near it."""

from __future__ import annotations

import csv
import os
import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from ._arguments import ArrayLike, Vector, file_name, number, numbers_of
from ._log_files import robot_in
from ._measure import Measure
from ._observed import Tape
from ._playback import Playback, Stage
from ._robot import Robot, require_robot, require_within_limits
from ._run_log import RunLog
from ._sample_table import read_table
from ._smoothing import SmoothCurve, reversals, smooth
from ._virtual import VirtualLoop
from ._written_aside import written_aside
from ._zone import Zone
from .errors import (
    BadArgumentError,
    BadProgramError,
    DegenerateCurveError,
    EmptyProgramError,
    FileError,
)

if TYPE_CHECKING:
    from ._loop import Loop

_PATIENCE = 1.0
"""A loop of which no cycle comes for so long [s], and some cycles, stands still."""
_LOOK = 0.01
"""So often a recording fetches what has come [s]."""
_QUICKEST = 0.05
"""Two reversals nearer than this in time [s] are none that a hand makes."""


@dataclass(frozen=True, eq=False, repr=False)
class Recording:
    """Measured joints over time. Made by `Arm.record`, from a log, or from arrays.

    Attributes
    ----------
    robot : Robot
        The arm that was guided.
    t : ndarray, (k,)
        Times, rising [s].
    q : ndarray, (k, n)
        Joints as they were measured [rad or m].
    outputs : ndarray of uint64, (k,)
        Digital outputs, bit i is output i.
    """

    robot: Robot
    t: Vector
    q: Vector
    outputs: npt.NDArray[np.uint64]

    @classmethod
    def of_samples(
        cls, robot: Robot, t: ArrayLike, q: ArrayLike, outputs: ArrayLike | None = None
    ) -> Recording:
        """Take samples from anywhere.

        Parameters
        ----------
        robot : Robot
            The arm.
        t : array_like, (k,)
            Times, rising [s]; k at least 2.
        q : array_like, (k, n)
            Joints [rad or m].
        outputs : array_like of int, (k,), optional
            Digital outputs, bit i is output i. Default: none on.

        Raises
        ------
        BadArgumentError
            Shapes that do not fit, or times that do not rise.
        """
        arm = require_robot(robot)
        times = numbers_of(t, "t")
        if times.ndim != 1 or len(times) < 2 or not (np.diff(times) > 0.0).all():
            raise BadArgumentError("t must hold two times or more, each above the one before.")
        joints = numbers_of(q, "q")
        if joints.shape != (len(times), arm.joints):
            raise BadArgumentError(
                f"q has the shape {joints.shape}; it must be ({len(times)}, {arm.joints})."
            )
        bits = np.zeros(len(times), dtype=np.uint64)
        if outputs is not None:
            given = np.asarray(outputs)
            if given.shape != bits.shape or given.dtype.kind not in "iu" or (given < 0).any():
                raise BadArgumentError(f"outputs must hold {len(times)} integers from 0.")
            bits = given.astype(np.uint64)
        return cls(arm, times, joints, bits)

    @classmethod
    def of_log(cls, log: RunLog) -> Recording:
        """Take what the drives measured in a run.

        Raises
        ------
        BadArgumentError
            Nothing was measured.
        """
        seen = np.isfinite(log.measured).all(axis=1)
        if seen.sum() < 2:
            raise BadArgumentError("The log holds nothing that a drive measured.")
        return cls.of_samples(log.robot, log.samples.t[seen], log.measured[seen], log.outputs[seen])

    @classmethod
    def load(cls, path: str | os.PathLike[str], robot: Robot | None = None) -> Recording:
        """Read the samples that `save` wrote, to the last bit; or a table of them.

        Parameters
        ----------
        path : str or path
            What `save` wrote; or, where it ends in ``.csv``, a table of text whose first line names
            the columns ``t,q1,…,qn``, and ``outputs`` after these if it has them.
        robot : Robot, optional
            The arm of a table, which does not say it; not for another file.

        Raises
        ------
        FileError
            There is no such file.
        BadProgramError
            It is damaged, or no recording.
        BadArgumentError
            A table without a robot, or a robot for a file that says it.
        """
        name = file_name(path)
        if not Path(name).is_file():
            raise FileError(f"There is no recording {name}.", file=name)
        is_table = name.endswith(".csv")
        if is_table != (robot is not None):
            raise BadArgumentError(
                "A table does not say what robot was guided: load(path, robot)."
                if is_table
                else "The recording says what robot was guided: load(path)."
            )
        if robot is not None:
            arm = require_robot(robot)
            try:
                return cls.of_samples(arm, *read_table(name, arm.joints))
            except (BadArgumentError, UnicodeDecodeError, csv.Error) as error:
                raise BadProgramError(f"The table cannot be read: {error}", file=name) from error
        try:
            with Path(name).open("rb") as stream, np.load(stream, allow_pickle=False) as file:
                arm = robot_in(str(file["robot"]))
                return cls.of_samples(arm, file["t"], file["q"], file["outputs"])
        except Exception as error:  # damage shows in many ways, those of decompressors too
            raise BadProgramError(f"The recording cannot be read: {error!r}.", file=name) from error

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the samples as they are, and their robot, into a numpy file (.npz), aside.

        Raises
        ------
        BadArgumentError
            Another ending.
        FileError
            With the path and the system's reason.
        """
        name = file_name(path)
        if not name.endswith(".npz"):
            raise BadArgumentError(f'path is "{name}"; samples of a recording go into .npz.')
        robot = np.array(self.robot._core.to_yaml())
        with written_aside(name) as file:
            np.savez_compressed(file, robot=robot, t=self.t, q=self.q, outputs=self.outputs)

    def __len__(self) -> int:
        """Count the samples."""
        return len(self.t)

    def __repr__(self) -> str:
        """Robot, number of samples and duration."""
        return f"<Recording of {self.robot.name}, {len(self)} samples, {self.duration:.3f} s>"

    @property
    def duration(self) -> float:
        """From the first sample to the last [s]."""
        return float(self.t[-1] - self.t[0])

    def at_cycles(self, period: float) -> Vector:
        """Return joints at 0, period, 2 period, … [s] of the recording, (m, n), between samples.

        Parameters
        ----------
        period : float
            [s]
        """
        times = np.arange(self.t[0], self.t[-1] + 1e-9, period)
        return np.column_stack([np.interp(times, self.t, joint) for joint in self.q.T])

    def fit(self, tolerance: float | Zone, *, angle_tolerance: float = 0.02) -> Playback:
        """Find a smooth path that passes every sample within the tolerance, and is proven to.

        The path is one of the joints: cubic B-splines with few and smooth spans. It is cut, and
        the arm stops, where an output changes and where the way goes back on itself. Noise is
        smoothed away as far as the tolerance allows, so a tolerance of some times the noise makes
        quick and quiet motions; one below it cannot be kept and is refused.

        Parameters
        ----------
        tolerance : float or Zone
            Largest distance of the tool's point from its place at a sample [m]; or
            ``vp.joint_deviation(r)``, the largest distance over all joints [rad or m], which is the
            way for a robot without kinematics.
        angle_tolerance : float
            Largest angle of the tool from its orientation at a sample [rad]; not for joints.

        Returns
        -------
        Playback
            The path, its deviations and its tempo: to save and to play.

        Raises
        ------
        DegenerateCurveError
            No smooth path comes within the tolerance; it names the worst sample's time.
        EmptyProgramError
            The arm was not moved.
        JointLimitError, CouplingLimitError
            A sample lies outside the robot's limits, by its time.
        BadArgumentError
            By the argument's name.
        """
        measure = Measure.of(self.robot, tolerance, angle_tolerance)
        for k in self._outermost():
            require_within_limits(self.robot, self.q[k], f"the recording at {self.t[k]:.3f} s", [])
        edges = [0, *(np.flatnonzero(np.diff(self.outputs)) + 1).tolist(), len(self)]
        stages: list[Stage] = []
        end: Vector | None = None
        for begin, stop in pairwise(edges):
            # The first sample with other outputs still belongs to the way before.
            made = self._stages(measure, slice(begin, min(stop + 1, len(self))), end)
            stages += made
            end = made[-1].control[-1]
        if not any(stage.moves for stage in stages):
            raise EmptyProgramError(
                "The arm was moved by less than the tolerance.",
                ways_out=["Record a motion.", "Give a smaller tolerance."],
            )
        return Playback(self.robot, tuple(stages), measure.position, measure.angle, measure.joints)

    def _outermost(self) -> list[int]:
        """Find the samples that reach farthest in each joint and coupled limit, either way."""
        rows = [self.q, self.q @ np.asarray(self.robot.limits.coupling).T]
        values = np.hstack(rows)
        return sorted({*values.argmin(axis=0).tolist(), *values.argmax(axis=0).tolist()})

    def _stages(self, measure: Measure, part: slice, first: Vector | None) -> list[Stage]:
        """Fit what lies between two changes of outputs: one stage a way without a reversal."""
        q, t = self.q[part], self.t[part]
        outputs = int(self.outputs[part.start])
        seen = measure.features(q)
        inner = reversals(seen)
        self._refuse_shaking(t[inner])
        turns = [0, *inner, len(q) - 1]
        stages: list[Stage] = []
        for begin, end in pairwise(turns):
            whole = slice(begin, end + 1)
            place = q[whole].mean(axis=0) if first is None else first
            still = np.tile(place, (end + 1 - begin, 1))
            if measure.shares(still, q[whole]).max() <= 1.0:  # nothing but noise about a place
                first = place
                deviation = measure.deviations(still, q[whole])
                stages.append(Stage.rest(float(t[end] - t[begin]), outputs, place, *deviation))
                continue
            curve = smooth(q[whole], measure.features, measure.shares, first)
            self._require_near(curve, t[whole])
            leaves, arrives = _moves_between(seen[whole])
            position, angle = measure.deviations(curve.points(curve.at), q[whole])
            stages.append(
                Stage(
                    control=curve.control,
                    outputs=outputs,
                    before=float(t[begin + leaves] - t[begin]),
                    moving=float(t[begin + arrives] - t[begin + leaves]),
                    after=float(t[end] - t[begin + arrives]),
                    position=position,
                    angle=angle,
                )
            )
            first = curve.control[-1]
        return stages

    def _refuse_shaking(self, turns: Vector) -> None:
        quick = np.flatnonzero(np.diff(turns) < _QUICKEST)
        if len(quick):
            time = float(turns[quick[0]])
            raise DegenerateCurveError(
                f"The way goes back on itself twice within {_QUICKEST:g} s at {time:.3f} s, "
                "by more than the tolerance: no hand does, noise does.",
                time=time,
                ways_out=["Give a larger tolerance: some times the noise of the samples."],
            )

    def _require_near(self, curve: SmoothCurve, t: Vector) -> None:
        worst = int(curve.shares.argmax())
        if curve.shares[worst] > 1.0:
            raise DegenerateCurveError(
                "No smooth path passes every sample within the tolerance: the best is "
                f"{curve.shares[worst]:.3g} times the tolerance away at {t[worst]:.3f} s.",
                time=float(t[worst]),
                ways_out=["Give a larger tolerance: some times the noise of the samples."],
            )


def record(
    loop: Loop,
    robot: Robot,
    seconds: float,
    until: Callable[[], bool] | None,
    period: float,
) -> Recording:
    """Take what every cycle measures; see `Arm.record`."""
    longest = number(seconds, "seconds", "s", above=0.0)
    tape = Tape(loop)
    tape.require_progress()

    def is_over() -> bool:
        return tape.count >= 2 and (tape.seconds >= longest or (until is not None and until()))

    if isinstance(loop, VirtualLoop):
        loop.look = tape.fetch
        try:
            loop.pass_cycles(1)
            while not is_over():
                before = tape.count
                loop.pass_cycles(1)
                if tape.count == before:
                    tape.refuse_standstill()
        finally:
            loop.look = None
    else:
        patience = _PATIENCE + 2.0 * period
        heard = time.monotonic()
        while True:
            if tape.fetch():
                heard = time.monotonic()
                if is_over():
                    break
            elif time.monotonic() > heard + patience:
                tape.refuse_standstill()
            else:
                tape.require_progress()
            time.sleep(max(period, _LOOK))
        tape.fetch()
    tape.require_progress()
    t, q, outputs = tape.samples()
    count = min(int(np.searchsorted(t, longest)) + 1, len(t))
    return Recording.of_samples(robot, t[:count], q[:count], outputs[:count])


def _moves_between(seen: Vector) -> tuple[int, int]:
    """First and last sample beyond a tolerance of the ends of the way: before and after, rest."""
    away_from_begin = np.linalg.norm(seen - seen[:5].mean(axis=0), axis=1) > 1.0
    away_from_end = np.linalg.norm(seen - seen[-5:].mean(axis=0), axis=1) > 1.0
    leaves = int(np.argmax(away_from_begin))
    arrives = len(seen) - 1 - int(np.argmax(away_from_end[::-1]))
    return leaves, max(arrives, leaves + 1)
