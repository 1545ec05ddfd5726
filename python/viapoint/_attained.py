"""What a run reached, beside what it was told: at its stops, and across its path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from ._arguments import Vector
from ._rotation_vectors import rotation_vectors, rotations_of
from ._run_log import RunLog
from .errors import BadArgumentError

_AT_REST = 1e-9
"""Setpoints of a joint that differ by no more [rad or m] stand still."""
_REST_CYCLES = 2
"""So many cycles without a change are a rest; a reversal stands still for less."""
_STATES_AT_REST = ("finished", "stopped", "paused", "waiting")
"""States in which the last setpoint of a log rests."""
_SAME_PLACE = 1e-6
"""Setpoints of two runs of one program differ by less [m]."""
_SAME_LENGTH = 1e-3
"""Their paths' lengths by less, as a share: they are those of polygons through the setpoints."""
_STILL = 1e-9
"""Setpoints nearer than this to the one before [m] add nothing to the path."""


@dataclass(frozen=True)
class Attained:
    """One run.

    Attributes
    ----------
    name : str
        For messages.
    told, reached : ndarray, (k, 4, 4)
        Poses of setpoints and of measured joints [m].
    resting : ndarray of bool, (k,)
        Where the setpoint rests.
    along : ndarray, (k,)
        How far along the path the setpoint is [m].
    time : ndarray, (k,)
        From the start of the run [s].
    move : ndarray of int, (k,)
        The program's step.
    period : float
        The cycle [s].
    """

    name: str
    told: Vector
    reached: Vector
    resting: npt.NDArray[np.bool_]
    along: Vector
    time: Vector
    move: npt.NDArray[np.int32]
    period: float

    @classmethod
    def of(cls, log: RunLog, name: str) -> Attained:
        """Take a log."""
        if not isinstance(log, RunLog):
            raise BadArgumentError(f"{name} is {log!r}; it must be a RunLog.")
        if not log.robot.has_kinematics:
            raise BadArgumentError(f'{name}: the robot "{log.robot.name}" has no kinematics.')
        measured = np.isfinite(log.measured).all(axis=1)
        if not measured.any():
            raise BadArgumentError(
                f"{name} holds nothing that a drive measured.",
                ways_out=["Give logs of runs on an arm: vp.connect(…).run(program).log."],
            )
        told = log.samples.pose[measured]
        reached = _poses_of(log, log.measured)[measured]
        steps = np.linalg.norm(np.diff(told[:, :3, 3], axis=0), axis=1)
        return cls(
            name=name,
            told=told,
            reached=reached,
            resting=_rests(
                log.q[measured],
                log.cycle[measured].astype(np.int64),
                RunLog.STATES[log.state[measured][-1]] in _STATES_AT_REST,
            ),
            along=np.concatenate([[0.0], np.cumsum(steps)]),
            time=log.samples.t[measured],
            move=log.move[measured],
            period=log.period,
        )

    @property
    def length(self) -> float:
        """Of the path [m]."""
        return float(self.along[-1])

    @property
    def stops(self) -> npt.NDArray[np.intp]:
        """Rows at the end of every rest but the first, before the motion."""
        ends = np.flatnonzero(self.resting & ~np.append(self.resting[1:], False))
        return ends[1:] if self.resting[0] else ends


def _rests(q: Vector, cycle: npt.NDArray[np.int64], at_rest: bool) -> npt.NDArray[np.bool_]:
    """Rows in which the setpoint stands still for two cycles or longer.

    The last one counts where the run ends `at_rest`: what follows is not in the log.
    """
    still = np.abs(np.diff(q, axis=0)).max(axis=1, initial=0.0) <= _AT_REST
    # A stretch of equal setpoints is from `begin` to before `end`; a single row is one, too.
    edges = np.flatnonzero(~still) + 1
    begins, ends = np.append(0, edges), np.append(edges, len(q))
    resting = np.zeros(len(q), dtype=bool)
    for begin, end in zip(begins, ends, strict=True):
        resting[begin:end] = cycle[end - 1] - cycle[begin] >= _REST_CYCLES
    resting[begins[-1] :] |= at_rest
    return resting


def _poses_of(log: RunLog, joints: Vector) -> Vector:
    poses = log.robot.fk(np.nan_to_num(joints))
    for first, robot in log.tools:
        now = log.move >= first
        poses[now] = robot.fk(np.nan_to_num(joints[now]))
    return poses


def attained_runs(logs: Sequence[RunLog]) -> list[Attained]:
    """Return what each log tells.

    Raises
    ------
    BadArgumentError
        No logs, or as `Attained.of`.
    """
    runs = [Attained.of(log, f"logs[{i}]") for i, log in enumerate(logs)]
    if not runs:
        raise BadArgumentError("logs is empty; give at least one log.")
    return runs


def attained_stops(runs: list[Attained]) -> tuple[list[Vector], list[Vector]]:
    """Return the commanded pose of every stop, (4, 4), and what the runs attained, (n, 4, 4).

    Raises
    ------
    BadArgumentError
        Runs that stopped elsewhere, or another number of times.
    """
    first = runs[0]
    for run in runs[1:]:
        same = len(run.stops) == len(first.stops)
        off = 0.0
        if same and len(run.stops):
            places, others = run.told[run.stops, :3, 3], first.told[first.stops, :3, 3]
            off = float(np.abs(places - others).max())
        if not same or off > _SAME_PLACE:
            raise BadArgumentError(
                f"{run.name} rests {len(run.stops)} times, {first.name} {len(first.stops)} times, "
                f"up to {off:.3g} m apart; the logs must be of one program.",
                ways_out=["Leave out runs that were paused or stopped."],
            )
    wanted = [first.told[row] for row in first.stops]
    found = [np.stack([run.reached[run.stops[k]] for run in runs]) for k in range(len(first.stops))]
    return wanted, found


def attained_path(runs: list[Attained], count: int) -> tuple[Vector, Vector]:
    """Return poses along the path, (m, 4, 4), and where runs cross the planes, (n, m, 4, 4).

    Raises
    ------
    BadArgumentError
        Runs of other lengths, or one that never crosses a plane.
    """
    first = runs[0]
    for run in runs[1:]:
        if abs(run.length - first.length) > _SAME_LENGTH * first.length:
            raise BadArgumentError(
                f"{run.name} has a path of {run.length:.6g} m, {first.name} one of "
                f"{first.length:.6g} m; the logs must be of one program."
            )
    shares = (np.arange(count) + 0.5) / count
    wanted, tangents = _along(first, shares)
    found = np.stack([_crossings(run, wanted, tangents, shares) for run in runs])
    return wanted, found


def _along(run: Attained, shares: Vector) -> tuple[Vector, Vector]:
    """Poses (m, 4, 4) at shares of the path's length, and its direction there, (m, 3)."""
    moving = np.flatnonzero(np.append(True, np.diff(run.along) > _STILL))
    along = run.along[moving]
    after = np.clip(np.searchsorted(along, shares * run.length), 1, len(along) - 1)
    share = (shares * run.length - along[after - 1]) / (along[after] - along[after - 1])
    before, end = run.told[moving[after - 1]], run.told[moving[after]]
    tangents = end[:, :3, 3] - before[:, :3, 3]
    return _between(before, end, share), tangents / np.linalg.norm(tangents, axis=1)[:, None]


def _crossings(run: Attained, wanted: Vector, tangents: Vector, shares: Vector) -> Vector:
    """Where a run crosses each plane: of all crossings that nearest in time to the setpoint's."""
    found = np.empty_like(wanted)
    for i, (pose, tangent, share) in enumerate(zip(wanted, tangents, shares, strict=True)):
        ahead = (run.reached[:, :3, 3] - pose[:3, 3]) @ tangent
        rows = np.flatnonzero((ahead[:-1] < 0.0) & (ahead[1:] >= 0.0))
        if len(rows) == 0:
            raise BadArgumentError(
                f"{run.name} never crosses the plane at {share:.3g} of the path's length.",
                ways_out=["Leave out runs that were stopped before their end."],
            )
        there = np.searchsorted(run.along, share * run.length)
        row = rows[np.argmin(np.abs(rows - there))]
        part = ahead[row] / (ahead[row] - ahead[row + 1])
        found[i] = _between(
            run.reached[row : row + 1], run.reached[row + 1 : row + 2], np.array([part])
        )[0]
    return found


def _between(first: Vector, last: Vector, share: Vector) -> Vector:
    """Poses between poses, (m, 4, 4): on the line, and by the least rotation."""
    turn = rotation_vectors(last[:, :3, :3] @ np.swapaxes(first[:, :3, :3], 1, 2))
    pose = first.copy()
    pose[:, :3, 3] += share[:, None] * (last[:, :3, 3] - first[:, :3, 3])
    pose[:, :3, :3] = rotations_of(share[:, None] * turn) @ first[:, :3, :3]
    return pose
