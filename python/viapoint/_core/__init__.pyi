"""
The C++ core of viapoint. Use the package `viapoint`; this module is its private part.
"""

from __future__ import annotations

import collections.abc
import typing

import numpy
import numpy.typing

from . import profile

__all__: list[str] = [
    "ANGLE_TOLERANCE",
    "AtomicFile",
    "CYCLE",
    "Certificate",
    "Chunk",
    "Configuration",
    "ControllerLoop",
    "Corner",
    "Dexterity",
    "Extremum",
    "Fit",
    "FrameFit",
    "Job",
    "JointLimits",
    "Knots",
    "LARGEST_STEP",
    "Log",
    "MAX_JOINTS",
    "MOST_OUTPUT_TIME",
    "MotionPieces",
    "MotionProgram",
    "MotionStream",
    "MoveOptions",
    "POSITION_TOLERANCE",
    "PlannedMotion",
    "PoseFit",
    "Problem",
    "ProcessStretch",
    "RobotModel",
    "RtdeService",
    "RunReport",
    "SimulatedSetup",
    "Singularity",
    "Stream",
    "Target",
    "TcpCalibration",
    "ToolCalibration",
    "ToolExtrema",
    "UdpSetup",
    "VelocityEllipsoid",
    "VirtualLoop",
    "WantedLeg",
    "admit",
    "builtin_robots",
    "calibrate_tcp",
    "calibrate_tool",
    "chain_of",
    "check",
    "checked_pose",
    "error_codes",
    "fit_function",
    "fit_samples",
    "frame_from_known_points",
    "frame_from_points",
    "insert_knots",
    "joint_robot",
    "json_rows",
    "load_program",
    "load_robot",
    "plan",
    "profile",
    "read_file",
    "robot_from_yaml",
    "run_states",
    "simulate",
    "simulate_jog",
    "wanted_legs",
    "write_file_atomically",
]

class Problem:
    """
    One thing that is wrong; fields that do not apply are None.
    """
    def __init__(
        self,
        code: str,
        message: str,
        *,
        ways_out: collections.abc.Sequence[str] = [],
        warning: bool = False,
        move: typing.SupportsInt | typing.SupportsIndex | None = None,
        file: str = "",
        line: typing.SupportsInt | typing.SupportsIndex | None = None,
        joint: typing.SupportsInt | typing.SupportsIndex | None = None,
        time: typing.SupportsFloat | typing.SupportsIndex | None = None,
        share: typing.SupportsFloat | typing.SupportsIndex | None = None,
        value: typing.SupportsFloat | typing.SupportsIndex | None = None,
        limit: typing.SupportsFloat | typing.SupportsIndex | None = None,
    ) -> None: ...
    def __repr__(self) -> str: ...
    def __str__(self) -> str: ...
    def describe(self) -> str:
        """
        Where, what and the ways out, in one text.
        """
    @property
    def code(self) -> str:
        """
        Stable lower-case name, e.g. "joint_limit".
        """
    @property
    def file(self) -> str:
        """
        Source of the move, or the file that was read.
        """
    @property
    def joint(self) -> int | None:
        """
        Joint, from 0.
        """
    @property
    def limit(self) -> float | None:
        """
        What it was held against [SI, rad].
        """
    @property
    def line(self) -> int | None:
        """
        Line in `file`, from 1.
        """
    @property
    def message(self) -> str:
        """
        What was wrong and the allowed range.
        """
    @property
    def move(self) -> int | None:
        """
        Index of the move in its program, from 0.
        """
    @property
    def share(self) -> float | None:
        """
        Share of the leg where it happens, 0 to 1.
        """
    @property
    def time(self) -> float | None:
        """
        [s] from the motion's start.
        """
    @property
    def value(self) -> float | None:
        """
        The offending value [SI, rad].
        """
    @property
    def warning(self) -> bool:
        """
        True for a warning, False for an error.
        """
    @property
    def ways_out(self) -> list[str]:
        """
        What would make it right.
        """

class AtomicFile:
    """
    A file in pieces: a crash leaves the old content or the new.
    """
    def __init__(self, path: str) -> None: ...
    def commit(self) -> None:
        """
        What was written takes the place of the old content.
        """
    def discard(self) -> None:
        """
        Removes what was written; nothing after commit().
        """
    def write(self, piece: bytes) -> None:
        """
        Writes on, beside the old content.
        """

class JointLimits:
    """
    What each joint may do [SI, rad].

    position_min <= q <= position_max, |qd| <= velocity, |qdd| <= acceleration, |qddd| <= jerk,
    coupling_lower <= coupling @ q <= coupling_upper. Arrays are copies: a robot's limits never change
    (see Robot.with_limits).
    """
    def __init__(
        self,
        *,
        position_min: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        position_max: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        acceleration: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        jerk: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        coupling: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, n]"],
        coupling_lower: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        coupling_upper: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    ) -> None: ...
    def contains(
        self,
        q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        slack: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> bool:
        """
        True when every position and coupled limit holds at q (n,), within slack [rad or m].
        """
    @property
    def acceleration(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,)
        """
    @property
    def coupling(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]:
        """
        (m, n)
        """
    @property
    def coupling_lower(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (m,)
        """
    @property
    def coupling_upper(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (m,)
        """
    @property
    def jerk(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,)
        """
    @property
    def position_max(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,)
        """
    @property
    def position_min(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,)
        """
    @property
    def velocity(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,)
        """

class Singularity:
    """
    How near the arm is to losing a direction.
    """
    def __repr__(self) -> str: ...
    @property
    def distance(self) -> float:
        """
        To the nearest singularity [rad or m].
        """
    @property
    def manipulability(self) -> float:
        """
        sqrt(det(J J^T)).
        """
    @property
    def name(self) -> str:
        """
        "none", "shoulder", "elbow", "wrist" or "boundary".
        """

class RobotModel:
    """
    An arm: chain, limits and kinematics.
    """
    def configuration(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
    ) -> Configuration: ...
    def dexterity(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
    ) -> Dexterity: ...
    def fk(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 4]"]: ...
    def fk_batch(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]
    ) -> numpy.typing.NDArray[numpy.float64]: ...
    def ik_all(
        self,
        pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"],
        near: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        config: Configuration,
        redundancy: typing.SupportsFloat | typing.SupportsIndex | None,
    ) -> numpy.typing.NDArray[numpy.float64]: ...
    def ik_all_position(
        self,
        position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        near: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        config: Configuration,
    ) -> numpy.typing.NDArray[numpy.float64]: ...
    def ik_all_quick(
        self, pose: typing.Any, near: typing.Any
    ) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        ik_all() for any configuration, of such arrays as ik_quick() takes; None for others.
        """
    def ik_batch(
        self,
        poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        near: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        nan: bool,
    ) -> numpy.typing.NDArray[numpy.float64]: ...
    def ik_near(
        self,
        pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"],
        near: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    def ik_near_position(
        self,
        position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        near: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    def ik_path(
        self,
        poses: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        largest_step: typing.SupportsFloat | typing.SupportsIndex,
    ) -> numpy.typing.NDArray[numpy.float64]: ...
    def ik_quick(
        self, pose: typing.Any, near: typing.Any
    ) -> numpy.typing.NDArray[numpy.float64] | None:
        """
        ik_near() of arrays that need no conversion and no correction; None for others.
        """
    def jacobian(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
    ) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]: ...
    def manipulability(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
    ) -> float: ...
    def reach(
        self,
        direction: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        rotation: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 3]"] | None,
    ) -> numpy.typing.NDArray[numpy.float64]: ...
    def redundancy_of(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
    ) -> float: ...
    def singularity(
        self, q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
    ) -> Singularity: ...
    def to_yaml(self) -> str:
        """
        The description as a .yaml file that reads back to the same numbers.
        """
    def tool_rates(
        self,
        q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        qd: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
        qdd: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    ) -> tuple[numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]: ...
    def with_base(
        self, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"]
    ) -> RobotModel: ...
    def with_limits(self, limits: JointLimits) -> RobotModel: ...
    def with_tool(
        self, pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"]
    ) -> RobotModel: ...
    @property
    def base(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 4]"]: ...
    @property
    def chosen(self) -> list[str]: ...
    @property
    def fingerprint(self) -> str: ...
    @property
    def has_kinematics(self) -> bool: ...
    @property
    def ik_family(self) -> str:
        """
        Which inverse-kinematics solver serves this arm, and why.
        """
    @property
    def joint_names(self) -> list[str]: ...
    @property
    def joints(self) -> int: ...
    @property
    def limits(self) -> JointLimits: ...
    @property
    def name(self) -> str: ...
    @property
    def prismatic(self) -> list[bool]: ...
    @property
    def redundancy(self) -> str:
        """
        What a pose leaves open, or an empty text.
        """
    @property
    def sources(self) -> list[str]: ...
    @property
    def title(self) -> str: ...
    @property
    def tool(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 4]"]: ...

class Configuration:
    """
    On which side of its singularities an arm stands.

    shoulder "front" or "back" (the wrist before or behind axis 1), elbow "up" or "down" (as seen with the
    shoulder in front), wrist "noflip" or "flip" (the sign of the wrist's bend); turns, one int a joint: k
    with q in (-pi, pi] + 2 pi k. None is at the singularity, or an arm without that choice; in a wish it
    stands for any.
    """
    def __init__(
        self,
        *,
        shoulder: str | None = None,
        elbow: str | None = None,
        wrist: str | None = None,
        turns: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] | None = None,
    ) -> None: ...
    def __repr__(self) -> str: ...
    def fits(self, wish: Configuration) -> bool:
        """
        True when every side and turn that the wish names is this one's.
        """
    @property
    def elbow(self) -> str | None:
        """
        "up", "down" or None.
        """
    @property
    def shoulder(self) -> str | None:
        """
        "front", "back" or None.
        """
    @property
    def turns(self) -> list[int]:
        """
        Whole turns, one a joint; empty in a wish for any.
        """
    @property
    def wrist(self) -> str | None:
        """
        "noflip", "flip" or None.
        """

class VelocityEllipsoid:
    """
    The tool rates that joint rates of length 1 make.
    """
    @property
    def axes(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 3]"]:
        """
        Unit vectors in the base frame, columns, longest axis first, (3, 3).
        """
    @property
    def lengths(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Half-axes [m or rad, per unit joint rate], (3,).
        """

class Dexterity:
    """
    How well an arm moves at one place.
    """
    def __repr__(self) -> str: ...
    @property
    def angular(self) -> VelocityEllipsoid:
        """
        Ellipsoid of the tool's orientation.
        """
    @property
    def asada(self) -> float:
        """
        Least over greatest principal acceleration of the tool's point, 0 to 1.
        """
    @property
    def condition(self) -> float:
        """
        1 / isotropy; inf at a singular pose.
        """
    @property
    def isotropy(self) -> float:
        """
        Least over greatest singular value, metres over length, 0 to 1.
        """
    @property
    def least(self) -> float:
        """
        Least singular value, metres over length.
        """
    @property
    def length(self) -> float:
        """
        Makes metres comparable with radians [m].
        """
    @property
    def linear(self) -> VelocityEllipsoid:
        """
        Ellipsoid of the tool's point.
        """
    @property
    def yoshikawa(self) -> float:
        """
        sqrt(det(J J^T)).
        """

class Fit:
    """
    How well touched points agree with what was found from them.
    """
    @property
    def largest(self) -> float:
        """
        [m].
        """
    @property
    def residuals(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        Of each touched point, (n,) [m].
        """
    @property
    def rms(self) -> float:
        """
        Of the residuals [m].
        """
    @property
    def worst(self) -> int:
        """
        Index of the point that has the largest residual.
        """

class TcpCalibration:
    """
    The tool's point, from touching one point.
    """
    @property
    def fit(self) -> Fit:
        """
        How well the touches agree.
        """
    @property
    def point(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        The fixed point in the base frame, (3,) [m].
        """
    @property
    def pose(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 4]"]:
        """
        pose_flange_tool of a tool that stands as the flange does, (4, 4) [m].
        """
    @property
    def sensitivity(self) -> float:
        """
        Error of the TCP where it is known least, over that of a touch.
        """
    @property
    def tcp(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[3, 1]"]:
        """
        The tool's point in the flange frame, (3,) [m].
        """
    @property
    def uncertainty(self) -> float:
        """
        Standard deviation of the TCP where it is known least, by the residuals [m].
        """

class ToolCalibration:
    """
    Point and orientation of a tool.
    """
    @property
    def angle(self) -> float:
        """
        Between the ways that showed x and z [rad]; a right angle but for errors.
        """
    @property
    def pose(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 4]"]:
        """
        pose_flange_tool, (4, 4) [m].
        """
    @property
    def tcp(self) -> TcpCalibration:
        """
        Where its point is, and how well that is known.
        """

class FrameFit:
    """
    A frame whose points are known beforehand.
    """
    @property
    def fit(self) -> Fit:
        """
        How well the points agree.
        """
    @property
    def pose(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 4]"]:
        """
        pose_base_frame, (4, 4) [m].
        """

class PoseFit:
    """
    Poses on a curve, and how near the spline through them is.
    """
    @property
    def angle_deviation(self) -> float: ...
    @property
    def at(self) -> list[float]:
        """
        Parameter of each pose.
        """
    @property
    def deviation(self) -> float: ...
    @property
    def looked_at(self) -> int: ...
    @property
    def poses(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, 4, 4)
        """

class Knots:
    """
    Knots along a straight tool line, with a proven bound.
    """
    def __len__(self) -> int: ...
    @property
    def angle_bound(self) -> float:
        """
        The tool turns at most so far from the line's orientation [rad].
        """
    @property
    def position_bound(self) -> float:
        """
        The tool strays at most so far from the line [m].
        """
    @property
    def q(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        (k, n) [rad or m]
        """

class Target:
    """
    Where a move goes.
    """
    @staticmethod
    def joints(q: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]) -> Target: ...
    @staticmethod
    def pose(
        pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"],
        correction: typing.SupportsFloat | typing.SupportsIndex = 0.0,
    ) -> Target:
        """
        A pose, and how far the matrix it was given as was from a rotation.
        """
    @staticmethod
    def position(
        position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    ) -> Target: ...

class MoveOptions:
    """
    Wishes of one move.
    """
    def __init__(
        self,
        *,
        speed: typing.SupportsFloat | typing.SupportsIndex | None = None,
        acceleration: typing.SupportsFloat | typing.SupportsIndex | None = None,
        angular_speed: typing.SupportsFloat | typing.SupportsIndex | None = None,
        angular_acceleration: typing.SupportsFloat | typing.SupportsIndex | None = None,
        process_speed: typing.SupportsFloat | typing.SupportsIndex | None = None,
        scale: typing.SupportsFloat | typing.SupportsIndex | None = None,
        zone: str = "fine",
        size: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        angle: typing.SupportsFloat | typing.SupportsIndex | None = None,
    ) -> None: ...

class MotionProgram:
    """
    Moves, waits and outputs, in order.
    """
    def __init__(
        self,
        robot: RobotModel,
        start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    ) -> None: ...
    def __len__(self) -> int: ...
    def add_movec(
        self,
        via: Target,
        target: Target,
        orientation: str,
        options: MoveOptions,
        file: str,
        line: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def add_movej(
        self,
        target: Target,
        options: MoveOptions,
        file: str,
        line: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def add_movel(
        self,
        target: Target,
        orientation: str,
        options: MoveOptions,
        file: str,
        line: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def add_set_do(
        self,
        index: typing.SupportsInt | typing.SupportsIndex,
        value: bool,
        distance: typing.SupportsFloat | typing.SupportsIndex,
        time: typing.SupportsFloat | typing.SupportsIndex,
        file: str,
        line: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def add_set_frame(
        self,
        pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"],
        name: str,
        file: str,
        line: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def add_set_tool(
        self,
        pose: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"] | None,
        name: str,
        file: str,
        line: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def add_spline(
        self,
        points: collections.abc.Sequence[Target],
        kind: str,
        of_joints: bool,
        orientation: str,
        at: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
        start: Target | None,
        options: MoveOptions,
        file: str,
        line: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def add_timed(
        self,
        points: collections.abc.Sequence[
            tuple[Target, typing.SupportsFloat | typing.SupportsIndex]
        ],
        t_acc: typing.SupportsFloat | typing.SupportsIndex,
        space: str,
        file: str,
        line: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def add_turn(
        self,
        center: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] | None,
        axis: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"] | None,
        angle: typing.SupportsFloat | typing.SupportsIndex,
        pitch: typing.SupportsFloat | typing.SupportsIndex,
        orientation: str,
        options: MoveOptions,
        file: str,
        line: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def add_wait(
        self,
        seconds: typing.SupportsFloat | typing.SupportsIndex,
        file: str,
        line: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def add_wait_di(
        self,
        index: typing.SupportsInt | typing.SupportsIndex,
        value: bool,
        timeout: typing.SupportsFloat | typing.SupportsIndex | None,
        file: str,
        line: typing.SupportsInt | typing.SupportsIndex,
    ) -> None: ...
    def copy(self) -> MotionProgram:
        """
        The program as it is now.
        """
    def save(self, path: str) -> None: ...
    def set_tolerance(
        self,
        position: typing.SupportsFloat | typing.SupportsIndex,
        angle: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None:
        """
        How far the tool may be from its lines and curves [m, rad].
        """
    def targets(
        self,
    ) -> list[tuple[int, str, typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"]]]:
        """
        Step, kind of target and its array, for every target.
        """
    def to_json(self) -> str: ...
    def tools(
        self,
    ) -> list[tuple[int, typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 4]"] | None]]:
        """
        Step and pose_flange_tool, None for the robot's own, of every change.
        """
    @property
    def robot(self) -> str: ...
    @property
    def robot_fingerprint(self) -> str: ...
    @property
    def start(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...

class Extremum:
    """
    The worst of one quantity of one joint.
    """
    def __repr__(self) -> str: ...
    @property
    def move(self) -> int:
        """
        Program step it happens in.
        """
    @property
    def share(self) -> float:
        """
        Value over its limit.
        """
    @property
    def time(self) -> float:
        """
        Where [s].
        """
    @property
    def value(self) -> float:
        """
        Largest magnitude [SI, rad].
        """

class ToolExtrema:
    """
    The worst of the tool, against the limits that each move gives it; zero where no move limits it.
    """
    @property
    def acceleration(self) -> Extremum:
        """
        Of the tool point [m/s²].
        """
    @property
    def angular_acceleration(self) -> Extremum:
        """
        [rad/s²]
        """
    @property
    def angular_speed(self) -> Extremum:
        """
        [rad/s]
        """
    @property
    def speed(self) -> Extremum:
        """
        Of the tool point [m/s].
        """

class Certificate:
    """
    Proven bounds over a whole motion.
    """
    @property
    def acceleration(self) -> list[Extremum]:
        """
        One Extremum a joint.
        """
    @property
    def acceleration_jump(self) -> float: ...
    @property
    def acceleration_share(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) worst share of the acceleration limit
        """
    @property
    def angle_deviation(self) -> float:
        """
        Proven, outside zones [rad].
        """
    @property
    def end_acceleration(self) -> float: ...
    @property
    def end_speed(self) -> float:
        """
        Largest |qd| at the end.
        """
    @property
    def holds(self) -> bool:
        """
        True when the motion may run.
        """
    @property
    def jerk(self) -> list[Extremum]:
        """
        One Extremum a joint.
        """
    @property
    def jerk_share(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) worst share of the jerk limit
        """
    @property
    def manipulability(self) -> float:
        """
        Smallest found along the motion.
        """
    @property
    def path_deviation(self) -> float:
        """
        Proven, outside zones [m].
        """
    @property
    def position_jump(self) -> float:
        """
        Largest step between pieces.
        """
    @property
    def position_max(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) largest joint position reached [rad or m]
        """
    @property
    def position_min(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) least joint position reached [rad or m]
        """
    @property
    def problems(self) -> list[Problem]:
        """
        Everything that is broken, worst first.
        """
    @property
    def start_acceleration(self) -> float: ...
    @property
    def start_speed(self) -> float:
        """
        Largest |qd| at the start.
        """
    @property
    def tool(self) -> ToolExtrema:
        """
        Speeds and accelerations of the tool, where moves limit them.
        """
    @property
    def velocity(self) -> list[Extremum]:
        """
        One Extremum a joint.
        """
    @property
    def velocity_jump(self) -> float: ...
    @property
    def velocity_share(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]:
        """
        (n,) worst share of the velocity limit
        """
    @property
    def zone_deviation(self) -> float:
        """
        Largest cut of a corner at the tool [m].
        """

class Corner:
    """
    What became of the zone of one move.
    """
    def __repr__(self) -> str: ...
    @property
    def angle_rules(self) -> bool:
        """
        The angle was used up before the size.
        """
    @property
    def asked(self) -> float:
        """
        Size asked for.
        """
    @property
    def asked_angle(self) -> float | None:
        """
        Angle asked for [rad]; None for a zone without.
        """
    @property
    def cut(self) -> float:
        """
        Proven largest distance from the legs [m].
        """
    @property
    def kind(self) -> str:
        """
        "fine", "radius", "deviation" or "joint_deviation".
        """
    @property
    def merged_into(self) -> int | None:
        """
        Index of the move whose straight leg the point lies so near, by `used`, that it makes no corner; or None.
        """
    @property
    def move(self) -> int:
        """
        Index of the move, from 0.
        """
    @property
    def reason(self) -> str:
        """
        Why shrunk or stopped.
        """
    @property
    def stopped(self) -> bool:
        """
        The arm stops at the point.
        """
    @property
    def used(self) -> float:
        """
        Size really used, in the zone's own unit.
        """
    @property
    def used_angle(self) -> float:
        """
        Angle really used, proven [rad]; 0 for a zone without.
        """

class ProcessStretch:
    """
    A stretch of motion in which a move could not hold its process speed.
    """
    def __repr__(self) -> str: ...
    @property
    def end(self) -> float:
        """
        Where it ends [s].
        """
    @property
    def end_length(self) -> float:
        """
        The same where it ends [m].
        """
    @property
    def joint(self) -> int | None:
        """
        Whose limit that is, from 0; or None.
        """
    @property
    def limit(self) -> str:
        """
        What rules there: "rest" where the arm starts or stops, else the limit; "timing" where none asks for less.
        """
    @property
    def lowest_speed(self) -> float:
        """
        [m/s]
        """
    @property
    def move(self) -> int:
        """
        Index of the move, from 0.
        """
    @property
    def process_speed(self) -> float:
        """
        Asked for [m/s].
        """
    @property
    def start(self) -> float:
        """
        Where it begins [s].
        """
    @property
    def start_length(self) -> float:
        """
        Way of the tool since the process began, where it begins [m].
        """

class PlannedMotion:
    """
    A finished motion and its proof.
    """
    def sample(
        self, dt: typing.SupportsFloat | typing.SupportsIndex
    ) -> dict[str, numpy.ndarray]: ...
    def sample_at(
        self, times: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
    ) -> dict[str, numpy.ndarray]: ...
    @property
    def certificate(self) -> Certificate: ...
    @property
    def corners(self) -> list[Corner]: ...
    @property
    def duration(self) -> float: ...
    @property
    def joints(self) -> int: ...
    @property
    def path_pieces(self) -> int: ...
    @property
    def pieces(self) -> int: ...
    @property
    def problems(self) -> list[Problem]: ...
    @property
    def process_stretches(self) -> list[ProcessStretch]: ...

class MotionPieces:
    """
    What of a motion runs, as arrays.
    """
    def __init__(self, motion: PlannedMotion) -> None: ...
    @property
    def coefficients(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Of u^k, joint by joint, of every stretch of path, (m, 6, n).
        """
    @property
    def durations(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        [s], (k,).
        """
    @property
    def moves(self) -> list[int]:
        """
        Program step, (k,).
        """
    @property
    def outputs(self) -> list[tuple[int, int, bool, float]]:
        """
        Piece, output, value and time [s] of every change.
        """
    @property
    def path_of(self) -> list[int]:
        """
        Path of every piece, (k,).
        """
    @property
    def timing(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Of x^k of every piece, (k, 6).
        """
    @property
    def waits(self) -> list[tuple[int, int, bool, float | None]]:
        """
        Piece, input, value and time-out [s] of every wait for an input.
        """

class WantedLeg:
    """
    What a program asks of one move.
    """
    @property
    def acceleration(self) -> float | None: ...
    @property
    def angular_acceleration(self) -> float | None: ...
    @property
    def angular_speed(self) -> float | None: ...
    @property
    def hold(self) -> str:
        """
        "pose", "axis", "position" or "wrist".
        """
    @property
    def merged(
        self,
    ) -> list[
        tuple[Corner, numpy.typing.NDArray[numpy.float64], numpy.typing.NDArray[numpy.float64]]
    ]:
        """
        The points that it passes without a corner: what became of the zone, joints (n,) or tool point (3,), and the tool's rotation (3, 3) as they were told.
        """
    @property
    def move(self) -> int:
        """
        Program step.
        """
    @property
    def on_curve(self) -> bool:
        """
        True where the tool follows a curve, and not the joints a line or spline.
        """
    @property
    def orientation(self) -> dict[str, numpy.ndarray]:
        """
        Steady turn or spline of the tool over s; only where on_curve.
        """
    @property
    def path(self) -> dict[str, numpy.ndarray]:
        """
        lengths (m,) of s and coefficients (m, 6, n).
        """
    @property
    def position(self) -> dict[str, numpy.ndarray]:
        """
        Line, helix or quintics of the tool point over s; only where on_curve.
        """
    @property
    def scale(self) -> float | None: ...
    @property
    def speed(self) -> float | None:
        """
        The tool's largest, a process speed too [m/s].
        """
    @property
    def tool(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        In the frame of the last joint, (4, 4).
        """

class Chunk:
    """
    A motion to rest, and when the one before is left for it.
    """
    @property
    def begin(self) -> float:
        """
        [s] of the chunk before
        """
    @property
    def last(self) -> bool: ...
    @property
    def motion(self) -> PlannedMotion: ...

class Stream:
    """
    Plans a program while it is told.
    """
    def __init__(self, robot: RobotModel, program: MotionProgram) -> None: ...
    def end(self) -> None:
        """
        No step follows.
        """
    def next(self, not_before: typing.SupportsFloat | typing.SupportsIndex = 0.0) -> Chunk | None:
        """
        The next chunk, if it can be made already.
        """
    def take(self, program: MotionProgram, kept: typing.SupportsInt | typing.SupportsIndex) -> None:
        """
        Take the steps of a program from the number kept on, and drop them there.
        """
    @property
    def stops(self) -> int:
        """
        Rests where a longer view would have gone on.
        """

class Log:
    """
    Every cycle of a run as it was executed.
    """
    @staticmethod
    def of_columns(columns: dict[str, numpy.ndarray]) -> Log:
        """
        A log of what columns() returned, one row a cycle.
        """
    def __len__(self) -> int: ...
    def columns(self) -> dict[str, numpy.ndarray]:
        """
        A dict of arrays, one row a cycle.
        """
    def head(self, count: typing.SupportsInt | typing.SupportsIndex) -> Log:
        """
        The first `count` cycles.
        """
    def save_csv(self, path: str) -> None:
        """
        Writes the same table as viapoint-controller --log.
        """

class RunReport:
    """
    Figures of one run; times in seconds.
    """
    @property
    def compute_max(self) -> float: ...
    @property
    def compute_p50(self) -> float: ...
    @property
    def compute_p99(self) -> float: ...
    @property
    def cycles(self) -> int: ...
    @property
    def latency_max(self) -> float: ...
    @property
    def latency_p50(self) -> float: ...
    @property
    def latency_p99(self) -> float: ...
    @property
    def lost_records(self) -> int:
        """
        Cycles that found no room in the log.
        """
    @property
    def missed_cycles(self) -> int:
        """
        Cycles that overruns slept through.
        """
    @property
    def overruns(self) -> int:
        """
        Cycles that woke a whole cycle late or more.
        """
    @property
    def rested_cycles(self) -> int:
        """
        Cycles at rest that left no record.
        """
    @property
    def wall_time(self) -> float:
        """
        First to last cycle.
        """

class Job:
    """
    One motion under way.
    """
    def backward(self) -> None: ...
    def log(self) -> Log: ...
    def on_input(
        self, input: typing.SupportsInt | typing.SupportsIndex, value: bool, action: str
    ) -> None: ...
    def pause(self) -> None: ...
    def report(self) -> RunReport: ...
    def resume(self) -> None: ...
    def step(self) -> None: ...
    def stop(self, category: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def wait(self, timeout: typing.SupportsFloat | typing.SupportsIndex) -> bool: ...
    @property
    def awaited(self) -> tuple[int, bool, float] | None:
        """
        Input, value and time-out [s] that the run rests for, if it does.
        """
    @property
    def duration(self) -> float: ...
    @property
    def move(self) -> int: ...
    @property
    def nominal_time(self) -> float: ...
    @property
    def overruns(self) -> int: ...
    @property
    def state(self) -> str: ...

class SimulatedSetup:
    """
    An arm simulated in this process.
    """
    def __init__(
        self,
        start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        *,
        lag: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        resolution: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        noise: typing.SupportsFloat | typing.SupportsIndex = 0.0,
        seed: typing.SupportsInt | typing.SupportsIndex = 0,
    ) -> None: ...

class UdpSetup:
    """
    A device that takes setpoints over UDP.
    """
    def __init__(
        self,
        host: str,
        port: typing.SupportsInt | typing.SupportsIndex,
        *,
        patience: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...

class ControllerLoop:
    """
    The 2 ms loop over a drive.
    """
    def __init__(
        self,
        robot: RobotModel,
        drive: SimulatedSetup | UdpSetup,
        *,
        cycle: typing.SupportsFloat | typing.SupportsIndex,
        silent_cycles: typing.SupportsInt | typing.SupportsIndex,
        tool_speed: typing.SupportsFloat | typing.SupportsIndex,
        box_min: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        box_max: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        processor: typing.SupportsInt | typing.SupportsIndex | None = None,
    ) -> None: ...
    def close(self) -> None: ...
    def fault_cycles(self) -> Log: ...
    def guide(
        self,
        positions: collections.abc.Sequence[
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
        ],
    ) -> None:
        """
        A hand takes the simulated arm there, a position a cycle.
        """
    def jog(
        self, velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
    ) -> None:
        """
        Joint velocities for the next 250 ms.
        """
    def let_go(self) -> None:
        """
        The hand lets go of the simulated arm.
        """
    def observed(
        self,
        from_cycle: typing.SupportsInt | typing.SupportsIndex,
        most: typing.SupportsInt | typing.SupportsIndex,
    ) -> tuple[
        typing.Annotated[numpy.typing.NDArray[numpy.uint64], "[m, 1]"],
        typing.Annotated[numpy.typing.NDArray[numpy.int64], "[m, 1]"],
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"],
        typing.Annotated[numpy.typing.NDArray[numpy.uint64], "[m, 1]"],
        typing.Annotated[numpy.typing.NDArray[numpy.uint64], "[m, 1]"],
    ]:
        """
        Of cycles that are still kept: numbers, stamps [ns], joints (k, n), inputs, outputs.
        """
    def run(self, motion: PlannedMotion) -> Job: ...
    def set_inputs(
        self,
        changed: typing.SupportsInt | typing.SupportsIndex,
        on: typing.SupportsInt | typing.SupportsIndex,
    ) -> None:
        """
        Switch inputs of the simulated drive, bit by bit.
        """
    def switch_outputs(
        self,
        changed: typing.SupportsInt | typing.SupportsIndex,
        on: typing.SupportsInt | typing.SupportsIndex,
    ) -> None:
        """
        Switch outputs by hand from the next cycle on.
        """
    @property
    def busy(self) -> bool: ...
    @property
    def datagrams(self) -> dict[str, int]: ...
    @property
    def fault(self) -> str: ...
    @property
    def guided(self) -> bool: ...
    @property
    def inputs(self) -> int: ...
    @property
    def is_open(self) -> bool: ...
    @property
    def jog_block(self) -> str: ...
    @property
    def jogging(self) -> bool: ...
    @property
    def measured(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    @property
    def newest_cycle(self) -> int: ...
    @property
    def outputs(self) -> int: ...
    @property
    def override(self) -> float: ...
    @override.setter
    def override(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    @property
    def shortcomings(self) -> list[str]: ...

class VirtualLoop:
    """
    The same in virtual time.
    """
    def __init__(
        self,
        robot: RobotModel,
        drive: SimulatedSetup | UdpSetup,
        *,
        cycle: typing.SupportsFloat | typing.SupportsIndex,
        silent_cycles: typing.SupportsInt | typing.SupportsIndex,
        tool_speed: typing.SupportsFloat | typing.SupportsIndex,
        box_min: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        box_max: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
        processor: typing.SupportsInt | typing.SupportsIndex | None = None,
    ) -> None: ...
    def close(self) -> None: ...
    def fault_cycles(self) -> Log: ...
    def guide(
        self,
        positions: collections.abc.Sequence[
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
        ],
    ) -> None:
        """
        A hand takes the simulated arm there, a position a cycle.
        """
    def jog(
        self, velocity: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"]
    ) -> None:
        """
        Joint velocities for the next 250 ms.
        """
    def let_go(self) -> None:
        """
        The hand lets go of the simulated arm.
        """
    def observed(
        self,
        from_cycle: typing.SupportsInt | typing.SupportsIndex,
        most: typing.SupportsInt | typing.SupportsIndex,
    ) -> tuple[
        typing.Annotated[numpy.typing.NDArray[numpy.uint64], "[m, 1]"],
        typing.Annotated[numpy.typing.NDArray[numpy.int64], "[m, 1]"],
        typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, n]"],
        typing.Annotated[numpy.typing.NDArray[numpy.uint64], "[m, 1]"],
        typing.Annotated[numpy.typing.NDArray[numpy.uint64], "[m, 1]"],
    ]:
        """
        Of cycles that are still kept: numbers, stamps [ns], joints (k, n), inputs, outputs.
        """
    def pass_cycles(self, count: typing.SupportsInt | typing.SupportsIndex) -> int:
        """
        Let cycles pass until a run ends or nothing moves; how many have passed.
        """
    def run(self, motion: PlannedMotion) -> Job: ...
    def set_inputs(
        self,
        changed: typing.SupportsInt | typing.SupportsIndex,
        on: typing.SupportsInt | typing.SupportsIndex,
    ) -> None:
        """
        Switch inputs of the simulated drive, bit by bit.
        """
    def switch_outputs(
        self,
        changed: typing.SupportsInt | typing.SupportsIndex,
        on: typing.SupportsInt | typing.SupportsIndex,
    ) -> None:
        """
        Switch outputs by hand from the next cycle on.
        """
    @property
    def busy(self) -> bool: ...
    @property
    def datagrams(self) -> dict[str, int]: ...
    @property
    def fault(self) -> str: ...
    @property
    def guided(self) -> bool: ...
    @property
    def inputs(self) -> int: ...
    @property
    def is_open(self) -> bool: ...
    @property
    def jog_block(self) -> str: ...
    @property
    def jogging(self) -> bool: ...
    @property
    def measured(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...
    @property
    def newest_cycle(self) -> int: ...
    @property
    def outputs(self) -> int: ...
    @property
    def override(self) -> float: ...
    @override.setter
    def override(self, arg1: typing.SupportsFloat | typing.SupportsIndex) -> None: ...
    @property
    def position(self) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[m, 1]"]: ...

class MotionStream:
    """
    Runs a program while it is told. Threads: any.
    """
    @typing.overload
    def __init__(
        self,
        loop: ControllerLoop,
        robot: RobotModel,
        program: MotionProgram,
        *,
        margin: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    @typing.overload
    def __init__(
        self,
        loop: VirtualLoop,
        robot: RobotModel,
        program: MotionProgram,
        *,
        margin: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    @typing.overload
    def __init__(
        self,
        follow: collections.abc.Callable[[PlannedMotion], typing.Any],
        robot: RobotModel,
        program: MotionProgram,
        *,
        margin: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    def end(self) -> None:
        """
        No step follows.
        """
    def hand_over(self) -> None:
        """
        Hand over what is due.
        """
    def take(self, program: MotionProgram, kept: typing.SupportsInt | typing.SupportsIndex) -> None:
        """
        Take the steps of a program from the number kept on, and drop them there.
        """
    def take_corners(self) -> list[Corner]:
        """
        Corners decided since the last call.
        """
    def take_warnings(self) -> list[Problem]:
        """
        Warnings met since the last call.
        """
    @property
    def job(self) -> Job | None:
        """
        The run, once it has begun, of a loop of this process.
        """
    @property
    def late(self) -> list[tuple[int, str, int, int]]:
        """
        (step, file, line, cycles waited) of the newest late steps.
        """
    @property
    def late_count(self) -> int: ...
    @property
    def state(self) -> str | None:
        """
        Of the run, once it has begun.
        """
    @property
    def steps_ahead(self) -> int:
        """
        Steps told that the arm has not begun.
        """
    @property
    def wants_steps(self) -> bool:
        """
        What was told gives the arm no motion more.
        """

class RtdeService:
    """
    Serves RTDE clients until it is closed.
    """
    def __init__(
        self,
        loop: ControllerLoop,
        robot: RobotModel,
        address: str,
        port: typing.SupportsInt | typing.SupportsIndex,
        other_machines: bool,
        cycle: typing.SupportsFloat | typing.SupportsIndex,
    ) -> None: ...
    def close(self) -> None: ...
    @property
    def port(self) -> int: ...

def admit(
    motion: PlannedMotion,
    position: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
) -> None:
    """
    Raises the first reason why the motion must not run from `position`.
    """

def builtin_robots() -> list[str]:
    """
    Names of the built-in robots, sorted.
    """

def calibrate_tcp(
    flanges: collections.abc.Sequence[
        typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"]
    ],
) -> TcpCalibration: ...
def calibrate_tool(
    flanges: collections.abc.Sequence[
        typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"]
    ],
    along_x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"],
    along_z: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"],
) -> ToolCalibration: ...
def chain_of(robot: RobotModel) -> dict[str, numpy.ndarray]:
    """
    prismatic (n,), before (n, 4, 4), axis (n, 3, 1), tool (4, 4).
    """

def check(robot: RobotModel, program: MotionProgram) -> list[Problem]:
    """
    Every problem of a program, in program order.
    """

def checked_pose(
    matrix: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"],
) -> tuple[typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 4]"], float]:
    """
    The pose with its rotation made exact, and the largest element by which it was changed.
    """

def error_codes() -> list[str]:
    """
    Every error code's name, in the order of the C++ enum.
    """

def fit_function(
    gamma: collections.abc.Callable[
        [float], typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"]
    ],
    *,
    from_: typing.SupportsFloat | typing.SupportsIndex,
    to: typing.SupportsFloat | typing.SupportsIndex,
    tolerance: typing.SupportsFloat | typing.SupportsIndex,
    angle_tolerance: typing.SupportsFloat | typing.SupportsIndex,
) -> PoseFit: ...
def fit_samples(
    samples: collections.abc.Sequence[
        typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"]
    ],
    at: collections.abc.Sequence[typing.SupportsFloat | typing.SupportsIndex],
    *,
    tolerance: typing.SupportsFloat | typing.SupportsIndex,
    angle_tolerance: typing.SupportsFloat | typing.SupportsIndex,
) -> PoseFit: ...
def frame_from_known_points(
    known: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"],
    touched: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 3]"],
) -> FrameFit: ...
def frame_from_points(
    origin: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    on_x: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
    on_xy: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[3, 1]"],
) -> typing.Annotated[numpy.typing.NDArray[numpy.float64], "[4, 4]"]: ...
def insert_knots(
    robot: RobotModel,
    pose0: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"],
    pose1: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[4, 4]"],
    *,
    near: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    method: str,
    position: typing.SupportsFloat | typing.SupportsIndex,
    angle: typing.SupportsFloat | typing.SupportsIndex,
) -> Knots: ...
def joint_robot(limits: JointLimits) -> RobotModel:
    """
    Joints with limits and no kinematics.
    """

def json_rows(values: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]) -> list[str]:
    """
    Each row of a matrix as a list in JSON; null is no finite number.
    """

def load_program(path: str) -> MotionProgram: ...
def load_robot(name_or_path: str, tip: str = "") -> RobotModel:
    """
    A built-in robot by name, or a .yaml or .urdf file; tip: the link of a URDF that carries the tool.
    """

def plan(robot: RobotModel, program: MotionProgram) -> PlannedMotion:
    """
    Plans; raises the first error of the report.
    """

def read_file(path: str) -> str:
    """
    The whole text of a file.
    """

def robot_from_yaml(text: str, source: str) -> RobotModel:
    """
    The robot that to_yaml wrote; source: for errors.
    """

def run_states() -> list[str]:
    """
    Every state's name, in the order of the C++ enum.
    """

def simulate(
    motion: PlannedMotion,
    commands: collections.abc.Sequence[
        tuple[
            typing.SupportsFloat | typing.SupportsIndex,
            str,
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        ]
    ],
    cycle: typing.SupportsFloat | typing.SupportsIndex,
) -> Log:
    """
    The interpolator in virtual time: one record a cycle.
    """

def simulate_jog(
    robot: RobotModel,
    start: typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
    calls: collections.abc.Sequence[
        tuple[
            typing.SupportsFloat | typing.SupportsIndex,
            typing.Annotated[numpy.typing.ArrayLike, numpy.float64, "[m, 1]"],
        ]
    ],
    cycle: typing.SupportsFloat | typing.SupportsIndex,
) -> Log:
    """
    A jog in virtual time: one record a cycle.
    """

def wanted_legs(robot: RobotModel, program: MotionProgram) -> list[WantedLeg]:
    """
    What a program asks of every move, in order; raises the first error of its report.
    """

def write_file_atomically(path: str, content: bytes | str) -> None:
    """
    Writes a whole file: a crash leaves the old content or the new, never a part.
    """

ANGLE_TOLERANCE: float = 0.00017453292519943296
CYCLE: float = 0.002
LARGEST_STEP: float = 0.2
MAX_JOINTS: int = 16
MOST_OUTPUT_TIME: float = 2.0
POSITION_TOLERANCE: float = 5e-05
__version__: str = "0.1.0"
