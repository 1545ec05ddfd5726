"""The arm of a viapoint-controller in another process."""

from __future__ import annotations

from urllib.parse import urlsplit

from . import _core, _session
from ._arm import Arm
from ._drives import SimulatedDrive
from ._job import Job
from ._motion import Motion
from ._remote import RemoteLoop
from ._remote_run import RemoteExecution
from ._robot import Robot
from ._run_log import RunLog
from ._tls import TlsFiles
from ._virtual import VirtualLoop
from ._wire import Wire
from .errors import BadArgumentError


class FoundJob(Job):
    """A run that another program began: all of `Job` but the motion, which only that one has."""

    def __init__(self, execution: RemoteExecution, robot: Robot, period: float) -> None:
        self._execution = execution
        self._robot = robot
        self._period = period
        self._seen_to_end = False

    def __repr__(self) -> str:
        """State and progress."""
        return f"<Job found, {self.state}, {self.nominal_time:.3f} of {self.duration:.3f} s>"

    @property
    def motion(self) -> Motion:  # type: ignore[override]  # raises in place of an attribute
        """Not known here.

        Raises
        ------
        BadArgumentError
            Always.
        """
        raise BadArgumentError("Another program began this run; its motion is not known here.")

    @property
    def log(self) -> RunLog:
        """Every cycle so far; complete once the job has ended."""
        return RunLog.of_robot(self._execution.log(), self._robot, self._period)


class RemoteArm(Arm):
    """The arm of a ``viapoint-controller``. Made by `connect`; use it in a ``with`` block.

    One program at a time has control of it; any number may watch. When this one dies, hangs or
    cannot be heard of for the controller's heartbeat, the arm stops on its path, and the run waits,
    paused, for the next program that connects: `job` is the run then, to be resumed or stopped.
    """

    def __init__(self, robot: Robot, loop: RemoteLoop, cycle: float) -> None:
        super().__init__(robot, loop, cycle)
        self._remote = loop

    @property
    def job(self) -> Job | None:
        """The controller's run under way, or its last one, whoever began it; None: none yet."""
        number = self._remote.last_run
        if number == 0:
            return None
        for job in self._jobs:
            execution = job._execution
            if isinstance(execution, RemoteExecution) and execution.number == number:
                return job
        return FoundJob(RemoteExecution(self._remote, number), self.robot, self._cycle)

    @property
    def operator(self) -> str:
        """Who has control of the arm; empty: nobody."""
        return self._remote.operator

    @property
    def control_loss(self) -> str:
        """How control was lost last, in a sentence; empty: it never was."""
        return self._remote.control_loss


def connect_remote(url: str, robot: Robot | None, watch: bool, tls: TlsFiles | None) -> Arm:
    """Connect to the controller of a ``tcp://`` url, as `connect` says."""
    wire = Wire(_address_of(url), tls)
    virtual = _session.current().virtual
    try:
        loop = RemoteLoop(wire, watch=watch or virtual)
    except BaseException:
        wire.close()
        raise
    try:
        there = Robot(_core.robot_from_yaml(loop.about.description, url))
        if robot is not None and robot.fingerprint != there.fingerprint:
            raise BadArgumentError(
                f'The arm at {url} is "{there.name}", robot is "{robot.name}" or has other limits.',
                ways_out=["Leave robot out, and use arm.robot."],
            )
        if virtual:
            stand_in = VirtualLoop(
                there, SimulatedDrive().standing_at(loop.position), loop.about.cycle
            )
            loop.close()
            return Arm(there, stand_in, loop.about.cycle)
        return RemoteArm(there, loop, loop.about.cycle)
    except BaseException:
        loop.close()
        raise


def _address_of(url: str) -> str:
    parts = urlsplit(url)
    try:
        host, port = parts.hostname, parts.port
    except ValueError:
        host, port = None, None
    if not host or port is None or parts.path or parts.query or parts.username:
        raise BadArgumentError(
            f'url is "{url}"; a controller\'s is "tcp://<host>:<port>".',
            ways_out=['For example connect("tcp://127.0.0.1:7420").'],
        )
    return f"[{host}]:{port}" if ":" in host else f"{host}:{port}"
