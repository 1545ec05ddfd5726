"""An arm in somebody's hands: taught, guided and recorded."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from ._arguments import Vector
from ._loop import Loop
from ._recording import Recording, record
from ._robot import Robot
from .errors import BadArgumentError, BusyError
from .frames import Frame

if TYPE_CHECKING:
    from ._points import PointList

_REACH = 1e-3
"""A hand begins within this of where the arm is measured [rad or m], as an encoder may step."""


class HandledArm:
    """The part of `Arm` that is taught, guided by hand, and recorded."""

    robot: Robot
    _loop: Loop
    _cycle: float

    @property
    def joints(self) -> Vector:
        """What the drive last measured, (n,) [rad or m]."""
        return self._loop.measured

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
            simulated.
        BusyError
            A run or a jog is under way, or a hand guides the arm already.
        DriveFaultError
            The arm has failed, or its drive was released.
        """
        loop = self._loop
        if not isinstance(hand, Recording):
            raise BadArgumentError(f"hand is {hand!r}; it must be a Recording.")
        if hand.robot.joints != self.robot.joints:
            raise BadArgumentError(
                f"The hand moves {hand.robot.joints} joints, the arm has {self.robot.joints}."
            )
        if loop.busy:
            raise BusyError("A run is under way.", ways_out=["Wait for its end, or stop it."])
        seen = loop.observed(loop.newest_cycle, 1)[2]
        there = seen[-1] if len(seen) else loop.measured
        off = float(abs(hand.q[0] - there).max())
        if off > _REACH:
            raise BadArgumentError(
                f"The hand begins {off:.3g} rad or m from where the arm stands.",
                ways_out=["Move the arm there first, or connect with it there: start=hand.q[0]."],
            )
        loop.guide(list(hand.at_cycles(self._cycle)))

    def let_go(self) -> None:
        """Take the hand off the simulated arm, which stays where it is."""
        self._loop.let_go()

    @property
    def guided(self) -> bool:
        """True while a hand moves the arm: a simulated one, or one whose device says so."""
        return self._loop.guided

    def record(self, seconds: float, *, until: Callable[[], bool] | None = None) -> Recording:
        """Record what the drives measure and which outputs are on, while somebody guides the arm.

        A sample a cycle, with the loop's own time stamp: the loop keeps its last 4096 cycles, so
        that none is left out while this process, or the network, is late.

        Parameters
        ----------
        seconds : float
            How long at most [s].
        until : callable, optional
            Called every 10 ms; recording ends when it returns True. It may jog the arm.

        Returns
        -------
        Recording
            The samples: to fit, save and play.

        Raises
        ------
        DriveFaultError
            The arm has failed or was released, before or meanwhile; the samples until then are
            dropped, and the message says how long they lasted.
        BadArgumentError
            Seconds that are no number above 0.
        """
        return record(self._loop, self.robot, seconds, until, self._cycle)
