"""How a script comes by the arm of a viapoint-controller."""

from __future__ import annotations

from urllib.parse import urlsplit

from . import _core, _session
from ._drives import SimulatedDrive
from ._remote import RemoteLoop
from ._remote_arm import RemoteArm
from ._robot import Robot
from ._tls import TlsFiles
from ._virtual import VirtualLoop
from ._wire import Wire
from .errors import BadArgumentError


def connect_remote(url: str, robot: Robot | None, watch: bool, tls: TlsFiles | None) -> RemoteArm:
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
            return RemoteArm(there, stand_in, loop.about.cycle)
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
