"""The real interpolator in virtual time."""

from __future__ import annotations

from collections.abc import Sequence

from . import _core
from ._arguments import choice, number
from ._motion import CYCLE, Motion
from ._program import Program, motion_of
from ._run_log import RunLog
from ._samples import Samples
from .errors import BadArgumentError

Command = tuple[float, str] | tuple[float, str, float]


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
    commands : sequence of (float, str) or (float, str, float)
        Time from the start of the run [s] and ``"override"`` with its share in [0, 1],
        ``"pause"``, ``"resume"`` or ``"stop"``. Those after the end are ignored.
    cycle : float
        The controller's cycle [s].

    Returns
    -------
    Samples
        As `Motion.sample` gives them, one a cycle, until the motion has ended or rests for good.

    Raises
    ------
    BadArgumentError
        A command that does not exist, or a time or share out of range.
    MotionError
        What `Program.plan` raises, and what a drive would refuse.
    """
    motion = motion_of(program)
    period = number(cycle, "cycle", "s", least=1e-4, most=1.0)
    timed = [_command(command, f"commands[{i}]") for i, command in enumerate(commands)]
    return RunLog.of(_core.simulate(motion._core, timed, period), motion, period).samples


def _command(command: Command, name: str) -> tuple[float, str, float]:
    try:
        time, kind, *rest = command
    except (TypeError, ValueError):
        raise BadArgumentError(
            f'{name} is {command!r}; it must be (seconds, "pause") or the like.'
        ) from None
    seconds = number(time, f"{name}[0]", "s", least=0.0)
    word = choice(kind, f"{name}[1]", ("override", "pause", "resume", "stop"))
    if (word == "override") != (len(rest) == 1):
        raise BadArgumentError(
            f'{name} is {command!r}; "override" has a share after it, the others nothing.'
        )
    share = number(rest[0], f"{name}[2]", least=0.0, most=1.0) if rest else 0.0
    return seconds, word, share
