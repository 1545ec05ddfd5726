"""Teach and playback: named points in a file, written so that none is ever lost."""

from __future__ import annotations

import fcntl
import json
import os
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, choice, file_name, vector, writing
from ._point_file import FORMAT, VERSION, TaughtPoint, is_text, read_points
from ._program import Program
from ._robot import Robot, load_robot, require_robot, require_within_limits
from ._rotation_vectors import rotation_vectors
from ._zone import ZoneLike
from .errors import (
    BadArgumentError,
    EmptyProgramError,
    FileError,
    OtherRobotWarning,
    PoseError,
)
from .frames import Frame


@dataclass(frozen=True, eq=False)
class TouchUp:
    """What teaching a point anew has changed.

    Attributes
    ----------
    name : str
        The point.
    joints : ndarray, (n,)
        Change of each joint [rad or m].
    moved, turned : float or None
        Distance of the tool's point [m] and angle of the tool [rad]; None without kinematics.
    """

    name: str
    joints: Vector
    moved: float | None
    turned: float | None

    def __str__(self) -> str:
        """Say it in one line."""
        if self.moved is None or self.turned is None:
            return f"{self.name}: joints by up to {np.abs(self.joints).max():.4g}"
        return f"{self.name}: {1e3 * self.moved:.3f} mm and {np.degrees(self.turned):.3f}°"


class PointList:
    """Taught points in the order they were taught, kept in a JSON file.

    Every `record` is on disk when it returns: the file is written aside and renamed, so that a
    crash leaves the old list or the new one, and processes that teach into one file wait for each
    other (at the empty file ``.<name>.lock`` beside it). A file that is damaged, or says what would
    be ignored, raises and is left alone. Points outside the robot's limits are read, so that they
    can be taught anew or removed; `program` refuses them by name.

    Parameters
    ----------
    path : str or path
        The file. It is made by the first `record`.
    robot : Robot, optional
        The arm. May be left out where the file exists: it names its robot.

    Raises
    ------
    FileError
        No such file, and no robot given to begin one.
    BadProgramError
        The file is damaged, or holds points of another robot.
    """

    def __init__(self, path: str | os.PathLike[str], robot: Robot | None = None) -> None:
        self.path = Path(file_name(path))
        if robot is None and not self.path.exists():
            raise FileError(
                f"There is no point file {self.path}.",
                file=str(self.path),
                ways_out=["To begin a new one, give its robot: PointList(path, robot)."],
            )
        self._points: dict[str, TaughtPoint] = {}
        self._fingerprint = ""
        if self.path.exists():
            name, self._fingerprint, self._points = read_points(self.path, robot)
            self.robot = load_robot(name) if robot is None else robot
        elif robot is not None:
            self.robot = require_robot(robot)

    def __repr__(self) -> str:
        """File and number of points."""
        return f"<PointList {str(self.path)!r}, {len(self)} points of {self.robot.name}>"

    def __len__(self) -> int:
        """Count the points."""
        return len(self._points)

    def __iter__(self) -> Iterator[str]:
        """Go through the names in the order of teaching."""
        return iter(self._points)

    def __contains__(self, name: object) -> bool:
        """Tell whether there is a point of this name."""
        return name in self._points

    def __getitem__(self, name: str) -> Vector:
        """Joints of a point, (n,) [rad or m]."""
        if name not in self._points:
            known = ", ".join(self._points) or "none"
            raise BadArgumentError(f'{self.path} has no point "{name}"; there are: {known}.')
        return self._points[name].q.copy()

    def frame(self, name: str) -> Frame | None:
        """Return the frame that a point was taught in, as it stood then, or None."""
        self[name]
        return self._points[name].frame

    def pose(self, name: str) -> Vector:
        """Return pose_base_tool of a point as it was taught, (4, 4) [m].

        Raises
        ------
        BadArgumentError
            No such point, or a robot without kinematics.
        """
        return self.robot.fk(self[name])

    def branch(self, name: str) -> _core.Configuration:
        """Return how the arm stands at a point: shoulder, elbow, wrist and whole turns.

        Raises
        ------
        BadArgumentError
            No such point, or a robot without kinematics.
        """
        return self.robot.configuration(self[name])

    def joints_in(self, name: str, frames: Iterable[Frame]) -> Vector:
        """Joints of a point whose frame stands elsewhere now.

        Parameters
        ----------
        name : str
            The point.
        frames : iterable of Frame
            Where frames stand now, found by their names. A point that was taught in none of them
            stays where it is.

        Returns
        -------
        ndarray, (n,)
            Joints [rad or m] that hold the tool in the frame as it was taught, on the branch that
            it was taught on: of its solutions the nearest to the taught joints.

        Raises
        ------
        BadArgumentError
            No such point.
        UnreachableError, OutsideLimitsError
            The point cannot be reached where its frame stands now, or not on its branch, by the
            point's name.
        """
        q = self[name]
        taught = self._points[name].frame
        now = next((f for f in frames if taught is not None and f.name == taught.name), None)
        if taught is None or now is None or np.array_equal(now.pose, taught.pose):
            return q
        target = now.to_base(taught.from_base(self.robot.fk(q)))
        stood = self.branch(name)
        kept = _core.Configuration(shoulder=stood.shoulder, elbow=stood.elbow, wrist=stood.wrist)
        try:
            nearest = self.robot.ik(target, near=q)
            if self.robot.configuration(nearest).fits(kept):
                return nearest
            return self.robot.ik(target, near=q, config=kept)
        except PoseError as error:
            raise type(error)(
                f'point "{name}" in the frame "{now.name}" as it stands now: {error.message}',
                ways_out=[*error.ways_out, f'Teach "{name}" anew.'],
            ) from None

    def record(self, name: str, q: ArrayLike, *, frame: Frame | None = None) -> None:
        """Add or replace a point, on disk at once.

        Parameters
        ----------
        name : str
            What to call it; a known name keeps its place in the order.
        q : array_like, (n,)
            Joints [rad or m].
        frame : Frame, optional
            The frame it belongs to, with a name: where that frame stands elsewhere later, the point
            goes with it (``program(frames=…)``).

        Raises
        ------
        BadArgumentError
            An empty name, joints that do not fit, or a frame without a name.
        JointLimitError, CouplingLimitError
            Joints outside the robot's limits.
        FileError, BadProgramError
            The file cannot be written, or what stands there is damaged (and is left alone).
        """
        if not isinstance(name, str) or not name.strip():
            raise BadArgumentError(f"name is {name!r}; a point needs a name.")
        if not is_text(name):
            raise BadArgumentError(
                f"name is {name!r}; half a surrogate pair cannot be written to a file.",
                ways_out=["Give a name of whole characters."],
            )
        joints = vector(q, "q", self.robot.joints)
        if frame is not None and not (isinstance(frame, Frame) and frame.name):
            raise BadArgumentError(
                f"frame is {frame!r}; a point is taught in a Frame that has a name.",
                ways_out=['Use vp.frames.Frame(pose, name="table").'],
            )
        require_within_limits(self.robot, joints, f'point "{name}"', [])
        with self._locked():
            # Another process may have taught meanwhile: what is on disk counts.
            points = self._on_disk() if self.path.exists() else dict(self._points)
            points[name] = TaughtPoint(joints, frame)
            self._write(points)

    def touch_up(self, name: str, q: ArrayLike) -> TouchUp:
        """Teach a point anew, on disk at once, and tell what that changes.

        Parameters
        ----------
        name : str
            A point of the list; its place in the order and its frame stay.
        q : array_like, (n,)
            Joints [rad or m], for example ``arm.joints``.

        Returns
        -------
        TouchUp
            How far the point has moved.

        Raises
        ------
        BadArgumentError
            No such point, or joints that do not fit.
        JointLimitError, CouplingLimitError, FileError, BadProgramError
            As for `record`.
        """
        before = self[name]
        self.record(name, q, frame=self.frame(name))
        now = self[name]
        moved = turned = None
        if self.robot.has_kinematics:
            there, here = self.robot.fk(before), self.robot.fk(now)
            moved = float(np.linalg.norm(here[:3, 3] - there[:3, 3]))
            turn = rotation_vectors((here[:3, :3] @ there[:3, :3].T)[None])[0]
            turned = float(np.linalg.norm(turn))
        return TouchUp(name, now - before, moved, turned)

    def remove(self, name: str) -> None:
        """Delete a point, on disk at once.

        Raises
        ------
        BadArgumentError
            No such point.
        FileError, BadProgramError
            As for `record`.
        """
        self[name]
        with self._locked():
            points = self._on_disk()
            points.pop(name, None)
            self._write(points)

    def program(
        self,
        *,
        kind: Literal["ptp", "lin"] = "ptp",
        start: ArrayLike | None = None,
        speed: float | None = None,
        acceleration: float | None = None,
        scale: float | None = None,
        zone: ZoneLike = "fine",
        name: str | None = None,
        frames: Iterable[Frame] = (),
    ) -> Program:
        """Return a program that plays the list back.

        Parameters
        ----------
        kind : {"ptp", "lin"}
            Straight in joint space, or straight lines of the tool.
        start : array_like, (n,), optional
            Where the arm stands [rad or m]; it then moves straight in joint space to the first
            point. Default: the first point itself.
        speed, acceleration : float, optional
            At the tool [m/s], [m/s²], for ``"lin"``.
        scale : float, optional
            Share of all joint limits, in (0, 1].
        zone : Zone, float or "fine"
            Zone at each point between the first and the last.
        name : str, optional
            The program's name. Default: the file's.
        frames : iterable of Frame
            Where the frames of the points stand now; see `joints_in`.

        Raises
        ------
        EmptyProgramError
            Fewer than two points to move between.
        JointLimitError, CouplingLimitError
            A point outside the robot's limits, by its name.
        UnreachableError, OutsideLimitsError
            A point that its frame has carried out of reach, by its name.
        BadArgumentError
            By the argument's name.

        Warns
        -----
        OtherRobotWarning
            The points were taught with other limits, another tool or another chain.
        """
        way = choice(kind, "kind", ("ptp", "lin"))
        moved_to = list(frames)
        points = [self.joints_in(point, moved_to) for point in self._points]
        if len(points) < (2 if start is None else 1):
            raise EmptyProgramError(
                f"{self.path} holds {len(points)} points; playing back needs at least two, or one "
                "and a start.",
                file=str(self.path),
                ways_out=["Teach more points: arm.teach(name, points)."],
            )
        if self._fingerprint not in ("", self.robot.fingerprint):
            warnings.warn(
                f'{self.path} was taught with another "{self.robot.name}" (fingerprint '
                f"{self._fingerprint}, now {self.robot.fingerprint}): limits, tool or chain "
                "differ.",
                OtherRobotWarning,
                stacklevel=2,
            )
        for point, q in zip(self._points, points, strict=True):
            way_out = [f'Teach "{point}" anew, or remove it: points.remove("{point}").']
            require_within_limits(self.robot, q, f'point "{point}"', way_out)
        program = Program(
            self.robot,
            start=points[0] if start is None else start,
            speed=speed,
            acceleration=acceleration,
            scale=scale,
            zone=zone,
            name=self.path.stem if name is None else name,
        )
        if start is not None and not np.array_equal(program.start, points[0]):
            program.movej(points[0], zone="fine")
        for q in points[1:]:
            if way == "ptp":
                program.movej(q)
            else:
                program.movel(q)
        return program

    @contextmanager
    def _locked(self) -> Iterator[None]:
        """Keep every other thread and process from changing the file meanwhile."""
        lock = self.path.with_name(f".{self.path.name}.lock")
        with writing(self.path):
            held = os.open(lock, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o666)
        try:
            fcntl.flock(held, fcntl.LOCK_EX)
            yield
        finally:
            os.close(held)

    def _on_disk(self) -> dict[str, TaughtPoint]:
        _, self._fingerprint, points = read_points(self.path, self.robot)
        return points

    def _write(self, points: dict[str, TaughtPoint]) -> None:
        fingerprint = self._fingerprint or self.robot.fingerprint
        document = {
            "format": FORMAT,
            "version": VERSION,
            "robot": self.robot.name,
            "robot_fingerprint": fingerprint,
            "points": [{"name": name, **point.json()} for name, point in points.items()],
        }
        text = json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False) + "\n"
        _core.write_file_atomically(str(self.path), text)
        self._points, self._fingerprint = points, fingerprint
