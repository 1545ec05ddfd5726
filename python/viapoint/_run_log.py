"""Every cycle of a run, as it was executed."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from . import _core
from ._arguments import Vector
from ._log_files import save_log
from ._motion import Motion
from ._robot import Robot
from ._samples import Samples


@dataclass(frozen=True, repr=False)
class RunLog:
    """The setpoints of a run, one row a cycle; a rest keeps its first two rows.

    Attributes
    ----------
    cycle : ndarray of uint64, (k,)
        From the start of the run.
    stamp : ndarray of int64, (k,)
        CLOCK_MONOTONIC at wake-up [ns]; virtual time in a simulated run.
    latency, compute : ndarray of int64, (k,)
        Wake-up after its due instant, and the tick's own computing time [ns].
    nominal_time, rate : ndarray, (k,)
        How far along the motion [s], and its rate of advance.
    move : ndarray of int32, (k,)
        The program's step under way.
    state : ndarray of uint8, (k,)
        Index into ``RunLog.STATES``.
    outputs : ndarray of uint64, (k,)
        Digital outputs, bit i is output i.
    q, qd, qdd, qddd : ndarray, (k, n)
        Setpoints [rad or m, per s, s², s³ of real time].
    measured : ndarray, (k, n)
        What the drive reported [rad or m]; NaN where there was no drive.
    period : float
        The cycle [s].
    robot : Robot
        The arm that moved.
    core : Log
        The same records in C++.
    tools : tuple of (int, Robot)
        As `Samples.tools`.
    """

    cycle: npt.NDArray[np.uint64]
    stamp: npt.NDArray[np.int64]
    latency: npt.NDArray[np.int64]
    compute: npt.NDArray[np.int64]
    nominal_time: Vector
    rate: Vector
    move: npt.NDArray[np.int32]
    state: npt.NDArray[np.uint8]
    outputs: npt.NDArray[np.uint64]
    q: Vector
    qd: Vector
    qdd: Vector
    qddd: Vector
    measured: Vector
    period: float
    robot: Robot = field(repr=False)
    core: _core.Log = field(repr=False)
    tools: tuple[tuple[int, Robot], ...] = field(default=(), repr=False)

    STATES: ClassVar[list[str]] = _core.run_states()

    def __len__(self) -> int:
        """Count the cycles."""
        return len(self.cycle)

    def __repr__(self) -> str:
        """Count cycles and joints."""
        return f"<RunLog {len(self)} cycles of {self.q.shape[1]} joints>"

    @property
    def samples(self) -> Samples:
        """The setpoints as `Motion.sample` gives them, one a cycle."""
        first = self.cycle[0] if len(self) else 0
        return Samples(
            t=(self.cycle - first).astype(np.float64) * self.period,
            q=self.q,
            qd=self.qd,
            qdd=self.qdd,
            qddd=self.qddd,
            move=self.move,
            robot=self.robot,
            tools=self.tools,
        )

    @classmethod
    def of(cls, core: _core.Log, motion: Motion, period: float) -> RunLog:
        """Take over what the controller kept of a run of `motion`."""
        return cls.of_robot(core, motion.robot, period, motion.tools)

    @classmethod
    def of_robot(
        cls,
        core: _core.Log,
        robot: Robot,
        period: float,
        tools: tuple[tuple[int, Robot], ...] = (),
    ) -> RunLog:
        """Take over what a controller kept of a run."""
        return cls(**core.columns(), robot=robot, period=period, core=core, tools=tools)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the log; `load_log` reads it back to the last bit.

        The file is written aside and renamed: a reader finds the old one or the new one.

        Parameters
        ----------
        path : str or path
            Ends in ``.npz``: the arrays by their names, for numpy; ``.csv``: one line a cycle, as
            ``viapoint-controller --log`` writes it; or ``.mcap``: for Foxglove and PlotJuggler, by
            the package ``mcap`` (``pip install viapoint[mcap]``).

        Raises
        ------
        BadArgumentError
            Another ending.
        FileError
            With the path and the system's reason; or the package ``mcap`` is not installed.
        """
        save_log(self, path)
