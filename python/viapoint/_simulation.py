"""The real interpolator in virtual time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, choice, number, vector
from ._motion import CYCLE, Motion
from ._program import Program, motion_of
from ._robot import Robot
from ._run_log import RunLog
from ._samples import Samples
from ._signals import on_or_off, signal
from .errors import BadArgumentError

COMMANDS = ("override", "pause", "resume", "step", "backward", "jog", "stop", "input")
Command = (
    tuple[float, str]
    | tuple[float, str, float]
    | tuple[float, str, ArrayLike]
    | tuple[float, str, int, bool]
)


def simulate(
    program: Program | Motion, commands: Sequence[Command] = (), *, cycle: float = CYCLE
) -> Samples:
    """Run a program through the controller's interpolator in virtual time.

    Deterministic, as fast as the processor; no drive and no thread take part. What a drive would
    refuse is refused here, too.

    Parameters
    ----------
    program : Program or Motion
        What to run.
    commands : sequence of (float, str) or (float, str, value)
        Time from the start of the run [s] and ``"override"`` with its share in [0, 1],
        ``"pause"``, ``"resume"``, ``"step"``, ``"backward"`` or ``"stop"``; or, in a pause,
        ``"jog"`` with the joint velocities (n,) [rad/s or m/s], which count for 250 ms; or
        ``"input"`` with a digital input, 0 to 63, and True or False: all are off at first. Those
        after the end are ignored.
    cycle : float
        The controller's cycle [s].

    Returns
    -------
    Samples
        As `Motion.sample` gives them, one a cycle, until the motion has ended or rests for good: in
        a pause, or for an input that no command switches.

    Raises
    ------
    BadArgumentError
        A command that does not exist, or a time or share out of range.
    MotionError
        What `Program.plan` raises, and what a drive would refuse.
    """
    motion = motion_of(program)
    period = number(cycle, "cycle", "s", least=1e-4, most=1.0)
    timed = [
        _command(command, f"commands[{i}]", motion.robot.joints)
        for i, command in enumerate(commands)
    ]
    return RunLog.of(_core.simulate(motion._core, timed, period), motion, period).samples


def simulate_jog(
    robot: Robot,
    start: ArrayLike,
    calls: Sequence[tuple[float, ArrayLike]],
    *,
    cycle: float = CYCLE,
) -> Samples:
    """Jog an arm in virtual time: what `Arm.jog` does, without waiting for it.

    Deterministic, as fast as the processor; no drive and no thread take part.

    Parameters
    ----------
    robot : Robot
        The arm.
    start : array_like, (n,)
        Joints where it rests at first [rad or m].
    calls : sequence of (float, array_like (n,))
        When ``jog`` is called, from the start [s], and with which joint velocities [rad/s or m/s].
        As on an arm each call counts for 250 ms: hold a button by calling again in time.
    cycle : float
        The controller's cycle [s].

    Returns
    -------
    Samples
        One a cycle, until the arm rests after the last call. ``move`` is -1 throughout.

    Raises
    ------
    BadArgumentError
        No pair of a time from 0 on and n finite numbers, or a time beyond what a log holds.
    VelocityLimitError
        A joint is asked for more than its velocity limit.

    Examples
    --------
    >>> import viapoint as vp
    >>> robot = vp.joint_robot(2, velocity=1.0, acceleration=5.0, jerk=50.0)
    >>> held = [(0.1 * i, [0.5, 0.0]) for i in range(10)]
    >>> samples = vp.simulate_jog(robot, [0.0, 0.0], held)
    >>> bool(samples.qd.max() == 0.5 and samples.qd[-1].max() == 0.0)
    True
    """
    period = number(cycle, "cycle", "s", least=1e-4, most=1.0)
    timed = []
    for i, call in enumerate(calls):
        try:
            time, velocity = call
        except (TypeError, ValueError):
            raise BadArgumentError(
                f"calls[{i}] is {call!r}; it must be (seconds, velocities)."
            ) from None
        seconds = number(time, f"calls[{i}][0]", "s", least=0.0)
        timed.append((seconds, vector(velocity, f"calls[{i}][1]", robot.joints)))
    log = _core.simulate_jog(robot._core, vector(start, "start", robot.joints), timed, period)
    return RunLog(**log.columns(), period=period, robot=robot, core=log, tools=()).samples


def _command(command: Command, name: str, joints: int) -> tuple[float, str, Vector]:
    try:
        time, kind, *rest = command
    except (TypeError, ValueError):
        raise BadArgumentError(
            f'{name} is {command!r}; it must be (seconds, "pause") or the like.'
        ) from None
    seconds = number(time, f"{name}[0]", "s", least=0.0)
    word = choice(kind, f"{name}[1]", COMMANDS)
    if len(rest) != {"override": 1, "jog": 1, "input": 2}.get(word, 0):
        raise BadArgumentError(
            f'{name} is {command!r}; "override" has a share after it, "jog" the joint velocities, '
            '"input" an input and its value, the others nothing.'
        )
    if word == "input":
        told = signal(rest[0], f"{name}[2]"), on_or_off(rest[1], "input", f"{name}[3]")
        return seconds, word, np.array(told, dtype=float)
    if word == "jog":
        return seconds, word, vector(rest[0], f"{name}[2]", joints)
    share = [number(rest[0], f"{name}[2]", least=0.0, most=1.0)] if rest else []
    return seconds, word, np.array(share)
