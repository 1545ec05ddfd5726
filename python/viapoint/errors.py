"""One family of errors: every refusal of viapoint is a `MotionError`.

There is one class a code of the C++ core (``viapoint._core.error_codes()``). The message says what
was wrong, the value and the allowed range; ``ways_out`` says what would make it right.

The tree::

    MotionError
    ├── LimitError       JointLimitError, CouplingLimitError, VelocityLimitError, …
    ├── PoseError        NotARotationError, UnreachableError, SingularError, …
    ├── ProgramError     BadProgramError, EmptyProgramError, ZeroLengthError, …
    ├── RunError         NotAtStartError, NotAtRestError, DriveFaultError, StoppedError, …
    └── BadArgumentError, BadLimitsError, BadRobotError, FileError, InternalError
"""

from __future__ import annotations

from . import _core
from ._motion_error import MotionError

__all__ = [
    "AccelerationLimitError",
    "BadArgumentError",
    "BadLimitsError",
    "BadProgramError",
    "BadRobotError",
    "BranchChangeError",
    "BusyError",
    "CouplingLimitError",
    "DegenerateCurveError",
    "DegeneratePointsError",
    "DiscontinuousError",
    "DriveFaultError",
    "EmptyProgramError",
    "FileError",
    "HalfTurnError",
    "InputTimeoutError",
    "InternalError",
    "JerkLimitError",
    "JointLimitError",
    "LimitError",
    "MotionError",
    "NotARotationError",
    "NotAtRestError",
    "NotAtStartError",
    "NotInControlError",
    "OtherRobotWarning",
    "OutsideLimitsError",
    "PoseCorrectedError",
    "PoseCorrectedWarning",
    "PoseError",
    "ProgramError",
    "RunError",
    "SingularError",
    "StoppedError",
    "UnconnectedError",
    "UncontrolledError",
    "UnreachableError",
    "VelocityLimitError",
    "ZeroLengthError",
    "ZoneIsStopError",
    "ZoneShrunkError",
    "error_class",
    "from_problem",
]


class LimitError(MotionError):
    """A joint or coupled limit is broken."""


class PoseError(MotionError):
    """A pose that the arm cannot take, or that is none."""


class ProgramError(MotionError):
    """A program that cannot be read or makes no motion."""


class RunError(MotionError):
    """A run that was refused, faulted or stopped."""


class BadArgumentError(MotionError, ValueError):
    """Wrong type, size or sign; NaN or infinity."""

    code = "bad_argument"


class BadLimitsError(MotionError, ValueError):
    """Limits of zero, swapped, or missing."""

    code = "bad_limits"


class BadRobotError(MotionError):
    """A robot description that cannot be read."""

    code = "bad_robot"


class FileError(MotionError, OSError):
    """A file that cannot be read or written."""

    code = "file"

    def __str__(self) -> str:
        """Say what and where; OSError would print its arguments."""
        return self.problem.describe()


class InternalError(MotionError):
    """A defect of viapoint itself."""

    code = "internal"


class JointLimitError(LimitError):
    """A joint leaves its position limits."""

    code = "joint_limit"


class CouplingLimitError(LimitError):
    """A coupled limit is left."""

    code = "coupling_limit"


class VelocityLimitError(LimitError):
    """A joint is too fast."""

    code = "velocity_limit"


class AccelerationLimitError(LimitError):
    """A joint accelerates too much."""

    code = "acceleration_limit"


class JerkLimitError(LimitError):
    """A joint's jerk is too large."""

    code = "jerk_limit"


class NotARotationError(PoseError, ValueError):
    """A pose whose 3x3 block is no rotation."""

    code = "not_a_rotation"


class UnreachableError(PoseError):
    """The pose is outside the arm's reach."""

    code = "unreachable"


class OutsideLimitsError(PoseError):
    """Reachable, but on no branch within the joint limits."""

    code = "outside_limits"


class SingularError(PoseError):
    """The arm is at or too near a singularity."""

    code = "singular"


class BranchChangeError(PoseError):
    """Start and goal are reachable only on different branches."""

    code = "branch_change"


class UncontrolledError(PoseError):
    """The arm has too few joints to hold every coordinate asked for."""

    code = "uncontrolled"


class HalfTurnError(PoseError):
    """Two orientations half a turn apart: the least rotation has two ways."""

    code = "half_turn"


class DegenerateCurveError(PoseError):
    """Points that define no curve (those of an arc on one line), or a curve with a cusp."""

    code = "degenerate_curve"


class DegeneratePointsError(PoseError):
    """Touched points too alike to tell the tool or frame that is asked for."""

    code = "degenerate_points"


class PoseCorrectedError(PoseError):
    """A pose within rounding of a rotation was projected (a warning in reports)."""

    code = "pose_corrected"


class BadProgramError(ProgramError):
    """A program or point file that cannot be read."""

    code = "bad_program"


class EmptyProgramError(ProgramError):
    """Nothing to do."""

    code = "empty_program"


class ZeroLengthError(ProgramError):
    """A move that goes nowhere."""

    code = "zero_length"


class ZoneShrunkError(ProgramError):
    """A zone larger than its legs allow (a warning in reports)."""

    code = "zone_shrunk"


class ZoneIsStopError(ProgramError):
    """A corner where stopping is quicker, or a near reversal (a warning in reports)."""

    code = "zone_is_stop"


class NotAtStartError(RunError):
    """The arm is not where the motion starts."""

    code = "not_at_start"


class NotAtRestError(RunError):
    """The motion starts or ends at speed."""

    code = "not_at_rest"


class DiscontinuousError(RunError):
    """Pieces of a motion that do not meet."""

    code = "discontinuous"


class DriveFaultError(RunError):
    """The drive refused or failed."""

    code = "drive_fault"


class StoppedError(RunError):
    """The run was stopped before its end."""

    code = "stopped"


class InputTimeoutError(RunError):
    """An input that the program waits for did not come in time: the run has ended on its path."""

    code = "input_timeout"


class BusyError(RunError):
    """A run is already under way."""

    code = "busy"


class NotInControlError(BusyError):
    """Somebody else has control of the arm, or it was lost."""


class UnconnectedError(DriveFaultError):
    """A controller that cannot be reached, does not answer, or is of another version."""


class PoseCorrectedWarning(UserWarning):
    """A pose within rounding of a rotation was projected before its inverse was asked for."""


class OtherRobotWarning(UserWarning):
    """Points that were taught with another fingerprint of the robot are played back."""


def _leaves(root: type[MotionError]) -> list[type[MotionError]]:
    found = [root] if "code" in vars(root) and root is not MotionError else []
    for child in root.__subclasses__():
        found += _leaves(child)
    return found


_BY_CODE: dict[str, type[MotionError]] = {cls.code: cls for cls in _leaves(MotionError)}


def error_class(code: str) -> type[MotionError]:
    """Class of an error code.

    Parameters
    ----------
    code : str
        One of ``viapoint._core.error_codes()``.

    Raises
    ------
    KeyError
        No such code.
    """
    return _BY_CODE[code]


def from_problem(problem: _core.Problem) -> MotionError:
    """Make the exception that stands for a problem; the C++ core raises through this."""
    return error_class(problem.code)(
        problem.message,
        ways_out=problem.ways_out,
        move=problem.move,
        file=problem.file,
        line=problem.line,
        joint=problem.joint,
        time=problem.time,
        share=problem.share,
        value=problem.value,
        limit=problem.limit,
    )
