"""The arm of a viapoint-controller in another process."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ._arm import Arm
from ._job import Execution, Job
from ._motion import Motion
from ._robot import Robot
from ._run_log import RunLog
from ._virtual import VirtualLoop
from .errors import BadArgumentError

if TYPE_CHECKING:
    from ._remote import RemoteLoop
    from ._remote_run import RemoteExecution


class FoundJob(Job):
    """A run that another program began: all of `Job` but the motion, which only that one has."""

    _execution: RemoteExecution

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
        """Every cycle so far, with the tools of the program; complete once the job has ended."""
        tools = self._execution.tools(self._robot)
        return RunLog.of_robot(self._execution.log(), self._robot, self._period, tools)


class RemoteArm(Arm):
    """The arm of a ``viapoint-controller``. Made by `connect`; use it in a ``with`` block.

    One program at a time has control of it; any number may watch. When this one dies, hangs or
    cannot be heard of for the controller's heartbeat, the arm stops on its path, and the run waits,
    paused, for the next program that connects: `job` is the run then, to be resumed or stopped.
    """

    def __init__(self, robot: Robot, loop: RemoteLoop | VirtualLoop, cycle: float) -> None:
        super().__init__(robot, loop, cycle)
        self._remote = None if isinstance(loop, VirtualLoop) else loop
        """None in virtual time."""

    @property
    def job(self) -> Job | None:
        """The controller's run under way, or its last one, whoever began it; None: none yet."""
        if self._remote is None:
            return super().job
        number = self._remote.last_run
        for job in self._runs:
            if self._remote.is_run(job._execution, number):
                return job
        return (
            None if number == 0 else FoundJob(self._remote.found(number), self.robot, self._cycle)
        )

    def _begin(self, motion: Motion) -> Execution:
        if self._remote is None:
            return super()._begin(motion)
        run = self._remote.run(motion._core)
        run.tell_tools(motion.tools)
        return run

    @property
    def operator(self) -> str:
        """Who has control of the arm; empty: nobody, or it is a stand-in in virtual time."""
        return "" if self._remote is None else self._remote.operator

    @property
    def control_loss(self) -> str:
        """How control was lost last, in a sentence; empty: it never was."""
        return "" if self._remote is None else self._remote.control_loss
