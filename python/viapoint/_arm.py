"""A connected arm: it runs programs in the C++ 2 ms loop."""

from __future__ import annotations

from collections.abc import Callable
from types import TracebackType
from typing import TYPE_CHECKING, Protocol, cast

from . import _core, _session
from ._arguments import ArrayLike, Vector, integer, number, vector
from ._job import Execution, Job
from ._motion import CYCLE, Motion
from ._program import Program, motion_of
from ._recording import Recording, record
from ._robot import Robot
from ._steps import INPUTS
from ._stream import Stream, StreamLoop
from ._virtual import VirtualLoop
from ._zone import ZoneLike
from .errors import BadArgumentError, BusyError, StoppedError
from .frames import Frame, Tool

if TYPE_CHECKING:
    from ._points import PointList

_REACH = 1e-3
"""A hand begins within this of where the arm is measured [rad or m], as an encoder may step."""


class Loop(Protocol):
    """What an arm needs of the controller: `_core.ControllerLoop`, `VirtualLoop`, `RemoteLoop`."""

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
    def observed(self) -> tuple[int, Vector, int, int]: ...
    @property
    def position(self) -> Vector: ...
    @property
    def inputs(self) -> int: ...
    def set_inputs(self, changed: int, on: int) -> None: ...
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
        self._stream: Stream | None = None
        self._rtde: list[_core.RtdeService] = []

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
            if self._stream is not None:
                self._stream.close(stop=kind is not None)
            for job in self._jobs:
                job.finish(stop=kind is not None)
        finally:
            self.close()

    def close(self) -> None:
        """Disconnect; a run under way is brought to rest on its path first, a jog as it can."""
        try:
            if self._stream is not None:
                self._stream.close(stop=True)
        finally:
            for service in self._rtde:
                service.close()
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
            By the argument's name.
        BusyError
            A run or another stream is under way.
        """
        loop = self._loop
        limit = integer(ahead, "ahead", 3, 1000)
        if self._stream is not None and self._stream.ended:
            self._stream.close(stop=True)
        elif self._stream is not None:
            raise BusyError("Another stream is under way.", ways_out=["Close it: stream.close()."])
        if isinstance(loop, VirtualLoop):
            loop.see_to_end()
        if loop.busy:
            raise BusyError("A run is under way.", ways_out=["Wait for its end."])
        self._stream = Stream(
            self.robot,
            cast("StreamLoop", loop),
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
        return self._stream

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

    def _own_loop(self) -> _core.ControllerLoop | VirtualLoop:
        if isinstance(self._loop, (_core.ControllerLoop, VirtualLoop)):
            return self._loop
        raise BadArgumentError(
            "The arm is driven by another process, where no hand guides "
            "it and RTDE is served by the configuration.",
            ways_out=["Run a program, or connect to an arm of this process."],
        )

    def input(self, index: int) -> bool:
        """Return what the drive last reported of a digital input.

        Parameters
        ----------
        index : int
            Input, 0 to 63.

        Raises
        ------
        BadArgumentError
            Another index.
        """
        bit = integer(index, "index", 0, INPUTS - 1)
        return bool(self._loop.inputs >> bit & 1)

    def set_input(self, index: int, value: bool) -> None:
        """Switch a digital input of the simulated drive.

        Parameters
        ----------
        index : int
            Input, 0 to 63.
        value : bool
            On or off.

        Raises
        ------
        BadArgumentError
            Another index, or a value that is not a bool.
        BusyError
            The drive is a real one.
        """
        bit = 1 << integer(index, "index", 0, INPUTS - 1)
        if not isinstance(value, bool):
            raise BadArgumentError(f"value is {value!r}; an input is True or False.")
        self._loop.set_inputs(bit, bit if value else 0)

    def serve_rtde(
        self, port: int = 30004, *, address: str = "127.0.0.1", other_machines: bool = False
    ) -> int:
        """Let clients of UR's RTDE look on, turn the override and switch outputs, until `close`.

        For an arm of six joints in this process; a ``viapoint-controller`` serves RTDE by its
        configuration (``docs/rtde.md``). In virtual time nobody is served.

        Parameters
        ----------
        port : int
            0 to 65535; 0 lets the system choose.
        address : str
            In numbers, IPv4 or IPv6.
        other_machines : bool
            Allows an address that other machines can reach. RTDE has neither passwords nor
            encryption.

        Returns
        -------
        int
            The port listened on.

        Raises
        ------
        BadArgumentError
            Another port, an address that is none or needs ``other_machines``, an arm of other than
            six joints, or one that is driven by another process.
        BusyError
            Another program listens there.
        """
        number_of_port = integer(port, "port", 0, 65535)
        loop = self._own_loop()
        if isinstance(loop, VirtualLoop):
            return number_of_port
        service = _core.RtdeService(
            loop, self.robot._core, address, number_of_port, other_machines, self._cycle
        )
        self._rtde.append(service)
        return service.port

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

    def guide(self, hand: Recording) -> None:
        """Move the simulated arm by hand: it is where the samples say, noise and all.

        The loop follows the hand as it would on an arm whose drives let it: the setpoint is where
        the arm is measured, and runs and jogs are refused until the hand has let go at the last
        sample. Returns at once; `record` meanwhile.

        Parameters
        ----------
        hand : Recording
            Where the hand takes the arm; it begins where the arm stands, within 0.001 rad or m.

        Raises
        ------
        BadArgumentError
            A hand for another number of joints, or one that begins elsewhere; an arm that is not
            simulated in this process.
        BusyError
            A run is under way, or a hand guides the arm already.
        """
        loop = self._own_loop()
        if not isinstance(hand, Recording):
            raise BadArgumentError(f"hand is {hand!r}; it must be a Recording.")
        if hand.robot.joints != self.robot.joints:
            raise BadArgumentError(
                f"The hand moves {hand.robot.joints} joints, the arm has {self.robot.joints}."
            )
        if loop.busy:
            raise BusyError("A run is under way.", ways_out=["Wait for its end, or stop it."])
        off = float(abs(hand.q[0] - loop.observed[1]).max())
        if off > _REACH:
            raise BadArgumentError(
                f"The hand begins {off:.3g} rad or m from where the arm stands.",
                ways_out=["Connect with the arm there: connect(…, start=hand.q[0])."],
            )
        loop.guide(list(hand.at_cycles(self._cycle)))

    def let_go(self) -> None:
        """Take the hand off the simulated arm, which stays where it is."""
        self._own_loop().let_go()

    @property
    def guided(self) -> bool:
        """True while a hand moves the arm: a simulated one, or one whose device says so."""
        return self._own_loop().guided

    @property
    def datagrams(self) -> dict[str, int]:
        """What has become of the datagrams to and from a UDP device; empty for other arms.

        ``sent``, ``unsent``, ``answered``; ``silent`` cycles; and what was ignored: ``wrong_size``,
        ``wrong_magic``, ``wrong_version``, ``wrong_joints``, ``old``.
        """
        return self._own_loop().datagrams

    def record(self, seconds: float, *, until: Callable[[], bool] | None = None) -> Recording:
        """Record what the drives measure and which outputs are on, while somebody guides the arm.

        A sample a cycle, with the loop's own time stamp. A cycle that the script slept through is
        left out; the times of the others stay right.

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
        return record(self._loop, self.robot, seconds, until, self._cycle)
