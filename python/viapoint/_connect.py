"""How a script comes by an arm."""

from __future__ import annotations

import math
from urllib.parse import parse_qs, urlsplit

import numpy as np

from . import _core, _session
from ._arguments import ArrayLike, Vector, number, vector
from ._arm import Arm
from ._motion import CYCLE
from ._robot import Robot, load_robot, require_robot, require_within_limits
from ._tls import TlsFiles
from ._virtual import VirtualLoop
from .errors import BadArgumentError


def connect(
    url: str,
    *,
    start: ArrayLike | None = None,
    robot: Robot | None = None,
    cycle: float = CYCLE,
    tool_speed: float | None = None,
    workspace: tuple[ArrayLike, ArrayLike] | None = None,
    watch: bool = False,
    tls: TlsFiles | None = None,
) -> Arm:
    """Connect to an arm.

    Parameters
    ----------
    url : str
        ``"sim://puma560"``: an arm simulated in this process, under the 2 ms C++ loop. A start may
        follow: ``"sim://puma560?start=0,0.5,0,0,0,0"`` [rad or m]. ``"tcp://127.0.0.1:7420"``: the
        arm of a ``viapoint-controller`` in another process, which this script then has control of;
        its configuration says what the robot, the cycle and the guard are.
    start : array_like, (n,), optional
        Joints where the simulated arm stands [rad or m]. Default: all zero.
    robot : Robot, optional
        Instead of loading the robot of the url: needed for other limits, and for `joint_robot`.
    cycle : float
        The loop's cycle [s].
    tool_speed : float, optional
        The guard's limit of the tool point's speed [m/s], e.g. 0.25 in reduced mode. A run or jog
        that goes beyond it is stopped on its path, and the arm has to be connected anew.
    workspace : (array_like (3,), array_like (3,)), optional
        The guard's box: least and greatest x, y, z of the tool point [m].
    watch : bool
        Only look at the arm of a controller, and leave control to others.
    tls : TlsFiles, optional
        For a controller beyond this machine.

    Returns
    -------
    Arm
        For a ``with`` block; a `RemoteArm` of a controller.

    Raises
    ------
    NotInControlError
        Another program has control of the controller's arm.
    UnconnectedError
        There is no controller at that address, or none that answers.
    BadArgumentError
        Not such a url, a start that does not fit, a cycle that is not 0.1 ms to 1 s, limits of the
        tool for a robot without kinematics, a workspace whose ends are not in order.
    JointLimitError, CouplingLimitError
        A start outside the robot's limits.
    BadRobotError
        No such robot.
    """
    if not isinstance(url, str):
        raise BadArgumentError(f'url is {url!r}; it must be text such as "sim://puma560".')
    if robot is not None:
        require_robot(robot)
    period = number(cycle, "cycle", "s", least=1e-4, most=1.0)
    parts = urlsplit(url)
    if parts.scheme == "tcp":
        told: dict[str, object] = {"start": start, "tool_speed": tool_speed, "workspace": workspace}
        if cycle != CYCLE:
            told["cycle"] = cycle
        return _connect_remote(url, told, robot, watch, tls)
    if watch or tls is not None:
        raise BadArgumentError('watch and tls are for a controller: connect("tcp://…").')
    if parts.scheme != "sim" or not (parts.netloc or parts.path):
        raise BadArgumentError(
            f'url is "{url}"; it must be "sim://<robot>" or "tcp://<host>:<port>".',
            ways_out=['For example connect("sim://puma560"), or connect("tcp://127.0.0.1:7420").'],
        )
    arm_robot = load_robot(parts.netloc + parts.path) if robot is None else robot
    joints = np.zeros(arm_robot.joints)
    if start is not None:
        joints = vector(start, "start", arm_robot.joints)
    elif parts.query:
        joints = _start_of(parts.query, arm_robot.joints)
    require_within_limits(arm_robot, joints, "start", ["Say where the arm stands: start=[…]."])
    speed, low, high = _guarded(arm_robot, tool_speed, workspace)
    if _session.current().virtual:
        virtual = VirtualLoop(arm_robot, joints, period, speed, (low, high))
        return Arm(arm_robot, virtual, period)
    loop = _core.ControllerLoop(
        arm_robot._core, joints, cycle=period, tool_speed=speed, box_min=low, box_max=high
    )
    return Arm(arm_robot, loop, period)


def _connect_remote(
    url: str,
    told: dict[str, object],
    robot: Robot | None,
    watch: bool,
    tls: TlsFiles | None,
) -> Arm:
    for name, value in told.items():
        if value is not None:
            raise BadArgumentError(
                f"{name} is for a simulated arm; a controller's is in its configuration."
            )
    try:
        from . import _remote_arm
    except ImportError as error:
        raise BadArgumentError(
            f"Connecting to a controller needs what is not installed: {error}.",
            ways_out=['Install it: pip install "viapoint[remote]".'],
        ) from None
    return _remote_arm.connect_remote(url, robot, watch, tls)


def _guarded(
    robot: Robot, tool_speed: float | None, workspace: tuple[ArrayLike, ArrayLike] | None
) -> tuple[float, Vector, Vector]:
    """Return the guard's speed and box of the tool; infinite where there are none."""
    if not robot.has_kinematics and not (tool_speed is None and workspace is None):
        raise BadArgumentError(
            f'The robot "{robot.name}" has no kinematics: its tool has no speed and no workspace.'
        )
    low, high = np.full(3, -np.inf), np.full(3, np.inf)
    if workspace is not None:
        try:
            least, most = workspace
        except (TypeError, ValueError):
            raise BadArgumentError(
                f"workspace is {workspace!r}; it must be (least, greatest) x, y, z."
            ) from None
        low, high = vector(least, "workspace[0]", 3), vector(most, "workspace[1]", 3)
        if not (low < high).all():
            raise BadArgumentError(
                f"The workspace goes from {low} to {high} m; each end must be beyond its beginning."
            )
    speed = math.inf if tool_speed is None else number(tool_speed, "tool_speed", "m/s", least=0.0)
    return speed, low, high


def _start_of(query: str, joints: int) -> Vector:
    fields = parse_qs(query)
    if set(fields) != {"start"} or len(fields["start"]) != 1:
        raise BadArgumentError(f'The url ends in "?{query}"; only "?start=…" is known.')
    try:
        values = [float(text) for text in fields["start"][0].split(",")]
    except ValueError:
        values = [math.nan]
    return vector(values, "start", joints)
