"""How a script comes by an arm."""

from __future__ import annotations

import math
from typing import Literal, TypedDict, Unpack, overload
from urllib.parse import parse_qs, urlsplit

import numpy as np

from . import _core, _session
from ._arguments import ArrayLike, Vector, integer, number, vector
from ._arm import Arm
from ._drives import SimulatedDrive, udp_device
from ._local_arm import LocalArm
from ._motion import CYCLE
from ._remote_arm import RemoteArm
from ._robot import Robot, load_robot, require_robot, require_within_limits
from ._tls import TlsFiles
from ._virtual import VirtualLoop
from .errors import BadArgumentError


class _LocalOptions(TypedDict, total=False):
    """What `connect` is told of an arm of this process, but for its start."""

    robot: Robot | None
    drive: SimulatedDrive | None
    silent_cycles: int | None
    cycle: float
    processor: int | None
    tool_speed: float | None
    workspace: tuple[ArrayLike, ArrayLike] | None


@overload
def connect(url: str, *, start: ArrayLike, **options: Unpack[_LocalOptions]) -> LocalArm: ...
@overload
def connect(
    url: str, *, watch: Literal[True], robot: Robot | None = None, tls: TlsFiles | None = None
) -> RemoteArm: ...
@overload
def connect(
    url: str, *, tls: TlsFiles, robot: Robot | None = None, watch: bool = False
) -> RemoteArm: ...
@overload
def connect(
    url: str,
    *,
    start: ArrayLike | None = None,
    watch: bool = False,
    tls: TlsFiles | None = None,
    **options: Unpack[_LocalOptions],
) -> Arm: ...
def connect(
    url: str,
    *,
    start: ArrayLike | None = None,
    robot: Robot | None = None,
    drive: SimulatedDrive | None = None,
    silent_cycles: int | None = None,
    cycle: float = CYCLE,
    processor: int | None = None,
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
        ``"udp://127.0.0.1:7500"``: a device that takes setpoints over UDP (docs/drives.md), under
        the 2 ms C++ loop of this process; in virtual time a simulated arm stands in for it.
    start : array_like, (n,), optional
        Joints where the simulated arm stands [rad or m]. Default: all zero.
    robot : Robot, optional
        Instead of loading the robot of the url: needed for other limits, for `joint_robot`, and
        for a device.
    drive : SimulatedDrive, optional
        How the simulated arm follows and measures. Default: exactly, one cycle later.
    silent_cycles : int, optional
        Cycles in a row that a device may leave unanswered, 0 to 10 000; then the arm stops on its
        path. Default: 10.
    cycle : float
        The loop's cycle [s].
    processor : int, optional
        That the loop's thread stays on, from 0; where it cannot, `Arm.shortcomings` says so.
        Default: any.
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
        For a ``with`` block: a `LocalArm`, or the `RemoteArm` of a controller. Where
        `start`, `watch` or `tls` is given a type checker knows which; else ``isinstance`` says it.

    Raises
    ------
    NotInControlError
        Another program has control of the controller's arm.
    UnconnectedError
        There is no controller at that address, or none that answers.
    BadArgumentError
        Not such a url, a start that does not fit, a cycle that is not 0.1 ms to 1 s, limits of the
        tool for a robot without kinematics, a workspace whose ends are not in order.
    DriveFaultError
        The device does not answer or reports a fault.
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
        told: dict[str, object] = {
            "start": start,
            "drive": drive,
            "silent_cycles": silent_cycles,
            "processor": processor,
            "tool_speed": tool_speed,
            "workspace": workspace,
        }
        if cycle != CYCLE:
            told["cycle"] = cycle
        return _connect_remote(url, told, robot, watch, tls)
    if watch or tls is not None:
        raise BadArgumentError('watch and tls are for a controller: connect("tcp://…").')
    if drive is not None and not isinstance(drive, SimulatedDrive):
        raise BadArgumentError(f"drive is {drive!r}; it must be a SimulatedDrive.")
    silence = integer(10 if silent_cycles is None else silent_cycles, "silent_cycles", 0, 10_000)
    kept_on = None if processor is None else integer(processor, "processor", 0, 4095)
    virtual = _session.current().virtual
    if parts.scheme == "udp":
        if robot is None:
            raise BadArgumentError(
                "A device does not tell what robot it moves.",
                ways_out=['Give it: connect("udp://…", robot=vp.load_robot("ur5e")).'],
            )
        if drive is not None or (start is not None and not virtual):
            raise BadArgumentError(
                "start and drive are for a simulated arm; a device tells where its arm stands."
            )
        arm_robot, device = robot, udp_device(url)
    elif parts.scheme == "sim" and (parts.netloc or parts.path):
        arm_robot, device = load_robot(parts.netloc + parts.path) if robot is None else robot, None
    else:
        raise BadArgumentError(
            f'url is "{url}"; it must be "sim://<robot>", "udp://<address>:<port>" or '
            '"tcp://<host>:<port>".',
            ways_out=['For example connect("sim://puma560"), or connect("tcp://127.0.0.1:7420").'],
        )
    speed, low, high = _guarded(arm_robot, tool_speed, workspace)
    setup: _core.SimulatedSetup | _core.UdpSetup
    if device is None or virtual:
        query = parts.query if device is None else ""
        simulated = _simulated(arm_robot, start, query, drive or SimulatedDrive())
        if virtual:
            loop = VirtualLoop(arm_robot, simulated, period, speed, (low, high))
            return LocalArm(arm_robot, loop, period)
        setup = simulated
    else:
        setup = device
    core = _core.ControllerLoop(
        arm_robot._core,
        setup,
        cycle=period,
        silent_cycles=silence,
        tool_speed=speed,
        box_min=low,
        box_max=high,
        processor=kept_on,
    )
    return LocalArm(arm_robot, core, period)


def _simulated(
    robot: Robot, start: ArrayLike | None, query: str, drive: SimulatedDrive
) -> _core.SimulatedSetup:
    """Return the drive of an arm that stands at `start`, or as the url says."""
    joints = np.zeros(robot.joints)
    if start is not None:
        joints = vector(start, "start", robot.joints)
    elif query:
        joints = _start_of(query, robot.joints)
    require_within_limits(robot, joints, "start", ["Say where the arm stands: start=[…]."])
    return drive.standing_at(joints)


def _connect_remote(
    url: str,
    told: dict[str, object],
    robot: Robot | None,
    watch: bool,
    tls: TlsFiles | None,
) -> RemoteArm:
    for name, value in told.items():
        if value is not None:
            raise BadArgumentError(
                f"{name} is for an arm of this process; a controller's is in its configuration."
            )
    try:
        from ._remote_connect import connect_remote
    except ImportError as error:
        raise BadArgumentError(
            f"Connecting to a controller needs what is not installed: {error}.",
            ways_out=['Install it: pip install "viapoint[remote]".'],
        ) from None
    return connect_remote(url, robot, watch, tls)


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
