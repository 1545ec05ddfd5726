"""How well poses, paths, speeds and corners are reached, by ISO 9283:1998, from logs of runs.

Run one program several times, keep the logs, and ask::

    from viapoint import iso9283
    report = iso9283.from_logs([vp.load_log(f"run_{i}.npz") for i in range(30)])
    print(report.poses[0].accuracy, report.poses[0].repeatability)

Commanded is what the controller told the drive, attained what the drive measured: this is the
accuracy of drives and timing. That of the arm's own geometry is seen by an external instrument
alone; what it measured goes into `pose_accuracy` and `path_accuracy` as it is.

Notation, with n cycles j: x_j attained, x_c commanded, and x̄ the mean over j, of positions; and
likewise a, b, c for the angles about x, y, z of the base frame, which are the components of the
rotation vector from the commanded orientation to the attained one.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ._arguments import ArrayLike, Vector, integer, numbers_of
from ._attained import Attained, attained_path, attained_runs, attained_stops
from ._cornering import Cornering, cornering, cornering_from_logs
from ._legs import Leg, corner_of, legs_of, middle_half
from ._path_velocity import (
    OVER,
    PathVelocity,
    path_velocity,
    path_velocity_from_logs,
    speeds_of,
)
from ._rotation_vectors import rotation_vectors
from ._run_log import RunLog
from .errors import BadArgumentError

__all__ = [
    "Cornering",
    "PassedCorner",
    "PathAccuracy",
    "PathVelocity",
    "PoseAccuracy",
    "Report",
    "cornering",
    "cornering_from_logs",
    "from_logs",
    "path_accuracy",
    "path_velocity",
    "path_velocity_from_logs",
    "pose_accuracy",
]


@dataclass(frozen=True)
class PoseAccuracy:
    """How well a pose was reached.

    Attributes
    ----------
    cycles : int
        n; the standard asks for 30.
    accuracy : float
        AP_P [m]: from the commanded position to the mean of the attained.
    accuracy_each : ndarray, (3,)
        AP_x, AP_y, AP_z [m].
    angle_accuracy : ndarray, (3,)
        AP_a, AP_b, AP_c [rad].
    repeatability : float
        RP_l [m]: radius about the mean that holds (nearly) all attained; NaN for one cycle.
    angle_repeatability : ndarray, (3,)
        RP_a, RP_b, RP_c [rad], each to be read as ±; NaN for one cycle.
    commanded : ndarray, (4, 4)
        The pose [m].
    """

    cycles: int
    accuracy: float
    accuracy_each: Vector
    angle_accuracy: Vector
    repeatability: float
    angle_repeatability: Vector
    commanded: Vector


@dataclass(frozen=True)
class PathAccuracy:
    """How well a path was followed; places count from 0 along it.

    Attributes
    ----------
    cycles, places : int
        n, of which the standard asks for 10, and the number of places compared, m.
    accuracy, repeatability : float
        AT_P and RT_P [m].
    angle_accuracy, angle_repeatability : ndarray, (3,)
        AT_a, AT_b, AT_c and RT_a, RT_b, RT_c [rad].
    accuracy_at, repeatability_at : int
        The place where AT_P and RT_P are taken; -1 where the latter is NaN.
    """

    cycles: int
    places: int
    accuracy: float
    repeatability: float
    angle_accuracy: Vector
    angle_repeatability: Vector
    accuracy_at: int
    repeatability_at: int


@dataclass(frozen=True)
class PassedCorner:
    """How a corner of the program was passed.

    Attributes
    ----------
    moves : (int, int)
        The straight moves that meet there.
    place : ndarray, (3,)
        Where their lines meet [m].
    cornering : Cornering
        How far it was cut and overshot.
    """

    moves: tuple[int, int]
    place: Vector
    cornering: Cornering


@dataclass(frozen=True)
class Report:
    """What the logs of one program tell.

    Attributes
    ----------
    cycles : int
        Number of logs.
    poses : tuple of PoseAccuracy
        Of every place where the arm rested for a cycle or longer, in order.
    path : PathAccuracy or None
        Of the way between; None where the tool never moved.
    speeds : dict of int to PathVelocity
        Of every move that was told to keep one speed on the middle half of its way, by its number.
    corners : tuple of PassedCorner
        Of every corner between two straight moves, in order.
    """

    cycles: int
    poses: tuple[PoseAccuracy, ...]
    path: PathAccuracy | None
    speeds: dict[int, PathVelocity]
    corners: tuple[PassedCorner, ...]


def pose_accuracy(commanded: ArrayLike, attained: ArrayLike) -> PoseAccuracy:
    """Pose accuracy AP and repeatability RP (ISO 9283:1998, §7.2.1 and §7.2.2).

    AP_P = √((x̄ - x_c)² + (ȳ - y_c)² + (z̄ - z_c)²), AP_a = ā - a_c; with
    l_j = √((x_j - x̄)² + (y_j - ȳ)² + (z_j - z̄)²) and S_l = √(Σ (l_j - l̄)² / (n - 1)):
    RP_l = l̄ + 3 S_l, and RP_a = ±3 √(Σ (a_j - ā)² / (n - 1)).

    Parameters
    ----------
    commanded : array_like, (4, 4)
        pose_base_tool [m].
    attained : array_like, (n, 4, 4)
        What each cycle reached [m].

    Raises
    ------
    BadArgumentError
        Shapes that do not fit.
    """
    wanted = numbers_of(commanded, "commanded")
    if wanted.shape != (4, 4):
        raise BadArgumentError(f"commanded has the shape {wanted.shape}; it must be (4, 4).")
    found = _poses(attained, "attained", "(n, 4, 4)", 3)
    place, turn = _spread(wanted[None], found[:, None])
    return PoseAccuracy(
        cycles=len(found),
        accuracy=float(place.accuracy[0]),
        accuracy_each=place.mean[0],
        angle_accuracy=turn.mean[0],
        repeatability=float(place.radius[0]),
        angle_repeatability=turn.three_sigma[0],
        commanded=wanted,
    )


def path_accuracy(commanded: ArrayLike, attained: ArrayLike) -> PathAccuracy:
    """Path accuracy AT and repeatability RT (ISO 9283:1998, §8.2 and §8.3).

    At m places i along the commanded path the attained paths are cut by the plane across it. Then
    AT_P = max_i √((x̄_i - x_ci)² + (ȳ_i - y_ci)² + (z̄_i - z_ci)²), AT_a = max_i |ā_i - a_ci|,
    RT_P = max_i (l̄_i + 3 S_li) and RT_a = max_i 3 √(Σ_j (a_ij - ā_i)² / (n - 1)), with l and S of
    each place as for a pose.

    Parameters
    ----------
    commanded : array_like, (m, 4, 4)
        Poses along the path [m].
    attained : array_like, (n, m, 4, 4)
        Of each cycle, where it crosses the planes [m].

    Raises
    ------
    BadArgumentError
        Shapes that do not fit.
    """
    wanted = _poses(commanded, "commanded", "(m, 4, 4)", 3)
    found = _poses(attained, "attained", f"(n, {len(wanted)}, 4, 4)", 4)
    if found.shape[1] != len(wanted):
        raise BadArgumentError(
            f"attained has the shape {found.shape}; it must be (n, {len(wanted)}, 4, 4)."
        )
    place, turn = _spread(wanted, found)
    alone = len(found) == 1
    return PathAccuracy(
        cycles=len(found),
        places=len(wanted),
        accuracy=float(place.accuracy.max()),
        repeatability=float(place.radius.max()),
        angle_accuracy=np.abs(turn.mean).max(axis=0),
        angle_repeatability=turn.three_sigma.max(axis=0),
        accuracy_at=int(place.accuracy.argmax()),
        repeatability_at=-1 if alone else int(place.radius.argmax()),
    )


def from_logs(logs: Sequence[RunLog], *, places: int = 50) -> Report:
    """Compare what drives measured with what they were told, over runs of one program.

    Poses are taken in the last cycle of every rest but the one before the motion. A stop that goes
    on at once rests in no cycle: let the program ``wait`` where a pose counts. The path is that
    of the tool's setpoints in the first log; every cycle is cut by the plane across it at `places`
    places, equally far apart along it. The speed that a move was told to keep, and where the lines
    of two straight moves meet, are taken from the setpoints of the first log, too.

    Parameters
    ----------
    logs : sequence of RunLog
        One a cycle, of the same program; the override may differ.
    places : int
        m, 1 to 10000.

    Raises
    ------
    BadArgumentError
        No logs, logs of different programs or without measured joints, a robot without kinematics,
        or a run that never crosses one of the planes.
    """
    count = integer(places, "places", 1, 10_000)
    runs = attained_runs(logs)
    poses = [
        pose_accuracy(commanded, attained)
        for commanded, attained in zip(*attained_stops(runs), strict=True)
    ]
    path = None
    if runs[0].length > 0.0:
        path = path_accuracy(*attained_path(runs, count))
    legs = legs_of(runs[0])
    return Report(
        cycles=len(runs),
        poses=tuple(poses),
        path=path,
        speeds=_speeds(runs, legs),
        corners=tuple(_corners(runs, legs)),
    )


def _speeds(runs: list[Attained], legs: list[Leg]) -> dict[int, PathVelocity]:
    """Of the moves that keep a speed, and are long enough to tell it."""
    fewest = round(OVER / runs[0].period) + 2
    return {
        leg.move: path_velocity(leg.speed, [speeds_of(run, leg.move) for run in runs])
        for leg in legs
        if leg.speed is not None and all(len(middle_half(run, leg.move)) >= fewest for run in runs)
    }


def _corners(runs: list[Attained], legs: list[Leg]) -> Iterator[PassedCorner]:
    """Of straight moves one after the other."""
    for first, second in pairwise(legs):
        place = corner_of(first, second)
        if place is None:
            continue
        moves = (first.move, second.move)
        ways = [run.reached[np.isin(run.move, moves), :3, 3] for run in runs]
        if all(len(way) >= 2 for way in ways):
            yield PassedCorner(moves, place, cornering(first.begin, place, second.end, ways))


@dataclass(frozen=True)
class _Spread:
    """Of deviations (n, m, 3) at each of m places."""

    deviations: Vector

    @property
    def mean(self) -> Vector:
        mean: Vector = self.deviations.mean(axis=0)
        return mean

    @property
    def accuracy(self) -> Vector:
        size: Vector = np.linalg.norm(self.mean, axis=1)
        return size

    @property
    def radius(self) -> Vector:
        """l̄ + 3 S_l."""
        lengths = np.linalg.norm(self.deviations - self.mean, axis=2)
        radius: Vector = lengths.mean(axis=0) + 3.0 * _deviation(lengths)
        return radius

    @property
    def three_sigma(self) -> Vector:
        sigma: Vector = 3.0 * _deviation(self.deviations)
        return sigma


def _spread(commanded: Vector, attained: Vector) -> tuple[_Spread, _Spread]:
    """Of positions and of angles."""
    places = attained[..., :3, 3] - commanded[:, :3, 3]
    turns = attained[..., :3, :3] @ np.swapaxes(commanded[:, :3, :3], 1, 2)
    angles = rotation_vectors(turns.reshape(-1, 3, 3)).reshape(places.shape)
    return _Spread(places), _Spread(angles)


def _deviation(values: Vector) -> Vector:
    """Return the standard deviation over cycles; NaN for one alone."""
    if len(values) == 1:
        return np.full(values.shape[1:], np.nan)
    deviation: Vector = values.std(axis=0, ddof=1)
    return deviation


def _poses(value: ArrayLike, name: str, shape: str, dimensions: int) -> Vector:
    poses = numbers_of(value, name)
    if poses.ndim != dimensions or poses.shape[-2:] != (4, 4) or 0 in poses.shape:
        raise BadArgumentError(f"{name} has the shape {poses.shape}; it must be {shape}.")
    return poses
