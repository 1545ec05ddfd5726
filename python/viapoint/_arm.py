"""A connected arm: it runs programs in the C++ 2 ms loop."""

from __future__ import annotations

import math
from collections.abc import Callable
from types import TracebackType
from typing import TYPE_CHECKING, Protocol
from urllib.parse import parse_qs, urlsplit

import numpy as np

from . import _core, _session
from ._arguments import ArrayLike, Vector, integer, number, vector
from ._job import Execution, Job
from ._motion import CYCLE, Motion
from ._program import Program, motion_of
from ._recording import Recording, record
from ._robot import Robot, load_robot, require_robot, require_within_limits
from ._stream import Stream
from ._tls import TlsFiles
from ._virtual import VirtualLoop
from ._zone import ZoneLike
from .errors import BadArgumentError, BusyError, StoppedError
from .frames import Frame, Tool

if TYPE_CHECKING:
    from ._points import PointList


class Loop(Protocol):
    """What an arm needs of the controller: `_core.ControllerLoop`, or `VirtualLoop`."""

    override: float

    def run(self, motion: _core.PlannedMotion) -> Execution: ...
    def jog(self, velocity: Vector) -> None: ...
    @property
    def jogging(self) -> bool: ...
    @property
    def jog_block(self) -> str: ...
    @property
    def measured(self) -> Vector: ...
    @property
    def position(self) -> Vector: ...
    @property
    def busy(self) -> bool: ...
    @property
    def is_open(self) -> bool: ...
    @property
    def fault(self) -> str: ...
    @property
    def shortcomings(self) -> list[str]: ...
    def close(self) -> None: ...


class Arm:
    """A connected arm. Made by `connect`; use it in a ``with`` block.

    Leaving the block waits for the run under way. An exception or Ctrl-C inside it brings the arm
    to rest on its path first. Threads: any.

    Attributes
    ----------
    robot : Robot
        What the arm is.
    """

    def __init__(self, robot: Robot, loop: Loop, cycle: float = CYCLE) -> None:
        self.robot = robot
        self._loop = loop
        self._cycle = cycle
        self._jobs: list[Job] = []
        self._streams: list[Stream] = []

    def __repr__(self) -> str:
        """Robot and state."""
        return f"<Arm {self.robot.name}, {'connected' if self._loop.is_open else 'closed'}>"

    def __enter__(self) -> Arm:
        """Return the arm itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Wait for the run under way, or on an exception bring it to rest; then disconnect."""
        try:
            for stream in self._streams:
                stream.close(stop=kind is not None)
            for job in self._jobs:
                job.finish(stop=kind is not None)
        finally:
            self.close()

    def close(self) -> None:
        """Disconnect; a run under way is brought to rest on its path first, a jog as it can."""
        self._loop.close()

    def run(self, program: Program | Motion, wait: bool = True) -> Job:
        """Run a program.

        Parameters
        ----------
        program : Program or Motion
            A program is planned first, and refused as a whole if anything is wrong with it.
        wait : bool
            Wait for the end. Ctrl-C meanwhile brings the arm to rest on its path and goes on up.

        Returns
        -------
        Job
            The run: its state, log and report; with ``wait=False`` still under way.

        Raises
        ------
        NotAtStartError
            The arm is not where the program starts.
        MotionError
            What `Program.plan` raises, or what the drive refuses: a broken limit, a motion that
            starts or ends at speed.
        BusyError
            A run is already under way.
        StoppedError
            The run that was waited for was stopped before its end.
        """
        motion = motion_of(program)
        if motion.robot.fingerprint != self.robot.fingerprint:
            raise BadArgumentError(
                f'The program is for the robot "{motion.robot.name}" and its limits, the arm is '
                f'"{self.robot.name}" with others.',
                ways_out=["Connect with the program's robot: connect(..., robot=robot)."],
            )
        session = _session.current()
        job = Job(self._loop.run(motion._core), motion, self._cycle)
        self._jobs = [j for j in self._jobs if not j.ended] + [job]
        session.started(motion, job)
        if wait:
            job.wait()
            if job.state == "stopped":
                raise StoppedError(
                    f"The run was stopped {job.nominal_time:.3f} s along its {job.duration:.3f} s.",
                    move=job.move,
                    time=job.nominal_time,
                    ways_out=["Plan a new program from where the arm rests: start=arm.setpoint."],
                )
        return job

    def stream(
        self,
        *,
        start: ArrayLike | None = None,
        ahead: int = 16,
        speed: float | None = None,
        acceleration: float | None = None,
        angular_speed: float | None = None,
        angular_acceleration: float | None = None,
        scale: float | None = None,
        zone: ZoneLike = "fine",
        name: str = "stream",
        position_tolerance: float = _core.POSITION_TOLERANCE,
        angle_tolerance: float = _core.ANGLE_TOLERANCE,
        frame: Frame | ArrayLike | None = None,
        tool: Tool | ArrayLike | None = None,
    ) -> Stream:
        """Run steps as they are told: for a script that decides as it goes.

        >>> import viapoint as vp
        >>> with vp.connect("sim://two_link") as arm, arm.stream(zone=vp.radius(0.02)) as stream:
        ...     for angle in (0.2, 0.4, 0.2):
        ...         _ = stream.movej([angle, 2 * angle])
        >>> arm_was_late = stream.late_count > 0

        Parameters
        ----------
        start : array_like, (n,), optional
            Joints where the first step begins [rad or m]. Default: where the arm rests.
        ahead : int
            A step waits while the arm has so many before it, 3 to 1000. The arm goes on without a
            rest where they are half a second of motion and more.
        speed, acceleration, angular_speed, angular_acceleration, scale, zone, name, \
        position_tolerance, angle_tolerance, frame, tool
            As for `Program`.

        Returns
        -------
        Stream
            For a ``with`` block.

        Raises
        ------
        BadArgumentError
            By the argument's name; or the arm is one that no stream can run on.
        BusyError
            A run is under way.
        """
        loop = self._loop
        if not isinstance(loop, (_core.ControllerLoop, VirtualLoop)):
            raise BadArgumentError(
                "The arm is driven by another process, which takes whole programs only.",
                ways_out=["Run a program, or connect to an arm of this process."],
            )
        limit = integer(ahead, "ahead", 3, 1000)
        if isinstance(loop, VirtualLoop):
            loop.see_to_end()
        if loop.busy:
            raise BusyError("A run is under way.", ways_out=["Wait for its end."])
        stream = Stream(
            self.robot,
            loop,
            self._cycle,
            limit,
            {
                "start": self.setpoint if start is None else start,
                "speed": speed,
                "acceleration": acceleration,
                "angular_speed": angular_speed,
                "angular_acceleration": angular_acceleration,
                "scale": scale,
                "zone": zone,
                "name": name,
                "position_tolerance": position_tolerance,
                "angle_tolerance": angle_tolerance,
                "frame": frame,
                "tool": tool,
            },
        )
        self._streams.append(stream)
        return stream

    def jog(self, velocity: ArrayLike) -> None:
        """Turn the joints at `velocity` for as long as this is called again within 250 ms.

        Hold-to-run: call it at 10 Hz or more for as long as the button is held. When the calls
        stop, or with zeros, every joint comes to rest within its limits. A joint stops at its
        position limit by itself, the arm before a coupled limit; `jog_block` tells. The velocity
        may change with every call. The override does not act on it.

        Parameters
        ----------
        velocity : array_like, (n,)
            Of each joint [rad/s or m/s].

        Raises
        ------
        BusyError
            A run is under way: the arm jogs between runs, and in one that rests after
            `Job.pause`; `Job.resume` then brings it back to the path first.
        VelocityLimitError
            A joint is asked for more than its velocity limit.
        BadArgumentError
            Not n finite numbers.
        DriveFaultError
            The drive has failed, or the arm is closed.
        """
        self._loop.jog(vector(velocity, "velocity", self.robot.joints))

    @property
    def jogging(self) -> bool:
        """True until a jog has come to rest; programs are refused meanwhile (`BusyError`)."""
        return self._loop.jogging

    @property
    def jog_block(self) -> str:
        """What keeps the jog, or kept the last one, from doing what was asked; empty if nothing."""
        return self._loop.jog_block

    @property
    def override(self) -> float:
        """Share of the planned speed, 0 to 1; changing it never leaves the path."""
        return self._loop.override

    @override.setter
    def override(self, share: float) -> None:
        self._loop.override = number(share, "override", least=0.0, most=1.0)

    @property
    def joints(self) -> Vector:
        """What the drive last measured, (n,) [rad or m]."""
        return self._loop.measured

    @property
    def setpoint(self) -> Vector:
        """Where the controller has told the arm to be, (n,) [rad or m].

        A program that goes on from here begins at ``start=arm.setpoint``: what the drive measures
        differs from it by the following error.
        """
        return self._loop.position

    @property
    def pose(self) -> Vector:
        """pose_base_tool at the measured joints, (4, 4) [m]."""
        return self.robot.fk(self.joints)

    @property
    def busy(self) -> bool:
        """True while a run is under way."""
        return self._loop.busy

    @property
    def job(self) -> Job | None:
        """The run under way, or the last one; None before the first."""
        return self._jobs[-1] if self._jobs else None

    @property
    def fault(self) -> str:
        """What has failed, in a sentence; empty while nothing has. Connect again after it."""
        return self._loop.fault

    @property
    def shortcomings(self) -> list[str]:
        """What real-time right could not be had, one line each, and what would give it."""
        return self._loop.shortcomings

    def teach(self, name: str, points: PointList, *, frame: Frame | None = None) -> Vector:
        """Record the present joints as the point `name` of `points`, on disk at once.

        Parameters
        ----------
        name : str
            The point; one of the same name is replaced.
        points : PointList
            The list, and its file.
        frame : Frame, optional
            The frame the point belongs to; see `PointList.record`.

        Returns
        -------
        ndarray, (n,)
            The joints recorded [rad or m].

        Raises
        ------
        FileError, BadProgramError
            The file cannot be written, or what stands there is damaged (and is left alone).
        """
        joints = self.joints
        points.record(name, joints, frame=frame)
        return joints

    def record(self, seconds: float, *, until: Callable[[], bool] | None = None) -> Recording:
        """Record what the drives measure, once a cycle, while somebody guides the arm.

        Parameters
        ----------
        seconds : float
            How long at most [s].
        until : callable, optional
            Called after every sample; recording ends when it returns True. It may jog the arm.

        Returns
        -------
        Recording
            The samples: to fit, save and play.

        Raises
        ------
        BadArgumentError
            Seconds that are no number above 0.
        """
        return record(self, seconds, until, self._cycle)


def connect(
    url: str,
    *,
    start: ArrayLike | None = None,
    robot: Robot | None = None,
    cycle: float = CYCLE,
    tool_speed: float | None = None,
    workspace: tuple[ArrayLike, ArrayLike] | None = None,
    watch: bool = False,
    tls: TlsFiles | None = None,
) -> Arm:
    """Connect to an arm.

    Parameters
    ----------
    url : str
        ``"sim://puma560"``: an arm simulated in this process, under the 2 ms C++ loop. A start may
        follow: ``"sim://puma560?start=0,0.5,0,0,0,0"`` [rad or m]. ``"tcp://127.0.0.1:7420"``: the
        arm of a ``viapoint-controller`` in another process, which this script then has control of;
        its configuration says what the robot, the cycle and the guard are.
    start : array_like, (n,), optional
        Joints where the simulated arm stands [rad or m]. Default: all zero.
    robot : Robot, optional
        Instead of loading the robot of the url: needed for other limits, and for `joint_robot`.
    cycle : float
        The loop's cycle [s].
    tool_speed : float, optional
        The guard's limit of the tool point's speed [m/s], e.g. 0.25 in reduced mode. A run or jog
        that goes beyond it is stopped on its path, and the arm has to be connected anew.
    workspace : (array_like (3,), array_like (3,)), optional
        The guard's box: least and greatest x, y, z of the tool point [m].
    watch : bool
        Only look at the arm of a controller, and leave control to others.
    tls : TlsFiles, optional
        For a controller beyond this machine.

    Returns
    -------
    Arm
        For a ``with`` block; a `RemoteArm` of a controller.

    Raises
    ------
    NotInControlError
        Another program has control of the controller's arm.
    UnconnectedError
        There is no controller at that address, or none that answers.
    BadArgumentError
        Not such a url, a start that does not fit, a cycle that is not 0.1 ms to 1 s, limits of the
        tool for a robot without kinematics, a workspace whose ends are not in order.
    JointLimitError, CouplingLimitError
        A start outside the robot's limits.
    BadRobotError
        No such robot.
    """
    if not isinstance(url, str):
        raise BadArgumentError(f'url is {url!r}; it must be text such as "sim://puma560".')
    if robot is not None:
        require_robot(robot)
    period = number(cycle, "cycle", "s", least=1e-4, most=1.0)
    parts = urlsplit(url)
    if parts.scheme == "tcp":
        told: dict[str, object] = {"start": start, "tool_speed": tool_speed, "workspace": workspace}
        if cycle != CYCLE:
            told["cycle"] = cycle
        return _connect_remote(url, told, robot, watch, tls)
    if watch or tls is not None:
        raise BadArgumentError('watch and tls are for a controller: connect("tcp://…").')
    if parts.scheme != "sim" or not (parts.netloc or parts.path):
        raise BadArgumentError(
            f'url is "{url}"; it must be "sim://<robot>" or "tcp://<host>:<port>".',
            ways_out=['For example connect("sim://puma560"), or connect("tcp://127.0.0.1:7420").'],
        )
    arm_robot = load_robot(parts.netloc + parts.path) if robot is None else robot
    joints = np.zeros(arm_robot.joints)
    if start is not None:
        joints = vector(start, "start", arm_robot.joints)
    elif parts.query:
        joints = _start_of(parts.query, arm_robot.joints)
    require_within_limits(arm_robot, joints, "start", ["Say where the arm stands: start=[…]."])
    speed, low, high = _guarded(arm_robot, tool_speed, workspace)
    if _session.current().virtual:
        virtual = VirtualLoop(arm_robot, joints, period, speed, low, high)
        return Arm(arm_robot, virtual, period)
    loop = _core.ControllerLoop(
        arm_robot._core, joints, cycle=period, tool_speed=speed, box_min=low, box_max=high
    )
    return Arm(arm_robot, loop, period)


def _connect_remote(
    url: str,
    told: dict[str, object],
    robot: Robot | None,
    watch: bool,
    tls: TlsFiles | None,
) -> Arm:
    for name, value in told.items():
        if value is not None:
            raise BadArgumentError(
                f"{name} is for a simulated arm; a controller's is in its configuration."
            )
    try:
        from . import _remote_arm
    except ImportError as error:
        raise BadArgumentError(
            f"Connecting to a controller needs what is not installed: {error}.",
            ways_out=['Install it: pip install "viapoint[remote]".'],
        ) from None
    return _remote_arm.connect_remote(url, robot, watch, tls)


def _guarded(
    robot: Robot, tool_speed: float | None, workspace: tuple[ArrayLike, ArrayLike] | None
) -> tuple[float, Vector, Vector]:
    """Return the guard's speed and box of the tool; infinite where there are none."""
    if not robot.has_kinematics and not (tool_speed is None and workspace is None):
        raise BadArgumentError(
            f'The robot "{robot.name}" has no kinematics: its tool has no speed and no workspace.'
        )
    low, high = np.full(3, -np.inf), np.full(3, np.inf)
    if workspace is not None:
        try:
            least, most = workspace
        except (TypeError, ValueError):
            raise BadArgumentError(
                f"workspace is {workspace!r}; it must be (least, greatest) x, y, z."
            ) from None
        low, high = vector(least, "workspace[0]", 3), vector(most, "workspace[1]", 3)
        if not (low < high).all():
            raise BadArgumentError(
                f"The workspace goes from {low} to {high} m; each end must be beyond its beginning."
            )
    speed = math.inf if tool_speed is None else number(tool_speed, "tool_speed", "m/s", least=0.0)
    return speed, low, high


def _start_of(query: str, joints: int) -> Vector:
    fields = parse_qs(query)
    if set(fields) != {"start"} or len(fields["start"]) != 1:
        raise BadArgumentError(f'The url ends in "?{query}"; only "?start=…" is known.')
    try:
        values = [float(text) for text in fields["start"][0].split(",")]
    except ValueError:
        values = [math.nan]
    return vector(values, "start", joints)
