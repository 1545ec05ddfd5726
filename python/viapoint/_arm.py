"""A connected arm: it runs programs in the C++ 2 ms loop."""

from __future__ import annotations

from types import TracebackType
from typing import Self, Unpack, cast

from . import _session
from ._arguments import ArrayLike, Vector, integer, number, vector
from ._handled_arm import HandledArm
from ._job import Execution, Job
from ._loop import Loop
from ._motion import CYCLE, Motion
from ._program import Program, ProgramOptions, motion_of
from ._robot import Robot
from ._run_log import RunLog
from ._signalling_arm import SignallingArm
from ._stream import Stream, StreamLoop
from ._virtual import VirtualLoop
from .errors import BadArgumentError, BusyError, StoppedError


class Arm(HandledArm, SignallingArm):
    """A connected arm. Made by `connect`; use it in a ``with`` block.

    It is a `LocalArm` or a `RemoteArm`: what both can is here.

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

    def __repr__(self) -> str:
        """Robot and state."""
        return f"<Arm {self.robot.name}, {'connected' if self._loop.is_open else 'closed'}>"

    def __enter__(self) -> Self:
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
        self._require_no_stream()
        session = _session.current()
        job = Job(self._begin(motion), motion, self._cycle)
        self._stream = None
        self._jobs = [j for j in self._jobs if not j.ended] + [job]
        session.started(job)
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

    def _begin(self, motion: Motion) -> Execution:
        return self._loop.run(motion._core)

    def stream(
        self,
        *,
        start: ArrayLike | None = None,
        ahead: int = 16,
        **options: Unpack[ProgramOptions],
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
        **options
            As for `Program`: ``speed``, ``acceleration``, ``angular_speed``,
            ``angular_acceleration``, ``scale``, ``zone``, ``name``, ``position_tolerance``,
            ``angle_tolerance``, ``frame``, ``tool``.

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
        self._require_no_stream()
        if isinstance(loop, VirtualLoop):
            loop.see_to_end()
        if loop.busy:
            raise BusyError("A run is under way.", ways_out=["Wait for its end."])
        begin = self.setpoint if start is None else start
        options.setdefault("name", "stream")
        self._stream = Stream(
            self.robot, cast("StreamLoop", loop), self._cycle, limit, begin, options
        )
        return self._stream

    def _require_no_stream(self) -> None:
        """Refuse while a stream is open; one whose run is over is closed."""
        if self._stream is None:
            return
        if not self._stream.ended:
            raise BusyError("A stream is under way.", ways_out=["Close it: stream.close()."])
        self._stream.close(stop=True)

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
        """The run under way, or the last one, of a program or a stream; None before the first."""
        runs = self._runs
        return runs[-1] if runs else None

    @property
    def _runs(self) -> list[Job]:
        """Runs begun here that may be under way, or the last one."""
        streamed = None if self._stream is None else self._stream.begun
        return [*self._jobs, streamed] if streamed is not None else self._jobs

    @property
    def fault(self) -> str:
        """What has failed, in a sentence; empty while nothing has. Connect again after it."""
        return self._loop.fault

    @property
    def fault_cycles(self) -> RunLog:
        """The last 50 cycles before the fault, of a run or a jog; empty while nothing has failed.

        A controller keeps those of its newest fault, also when the drive is enabled anew.
        """
        return RunLog.of_robot(self._loop.fault_cycles(), self.robot, self._cycle)

    @property
    def shortcomings(self) -> list[str]:
        """What real-time right could not be had, one line each, and what would give it."""
        return self._loop.shortcomings
