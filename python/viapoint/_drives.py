"""What a script says of the drives that its arm has."""

from __future__ import annotations

from dataclasses import dataclass
from urllib.parse import urlsplit

from . import _core
from ._arguments import Vector, integer, number
from .errors import BadArgumentError

_MOST_LAG = 10.0
_PATIENCE = 1.0
"""How long a device may take to answer at first [s]."""


@dataclass(frozen=True)
class SimulatedDrive:
    """How a simulated arm follows its setpoints, and how its encoders read.

    As it stands, the arm is exactly where it was told one cycle before. The same seed gives the
    same readings in every run, on the clock and in virtual time.

    Attributes
    ----------
    lag : float
        Time constant of each joint, a first-order lag [s], 0 to 10.
    resolution : float
        Step of the encoders [rad or m]; 0: none.
    noise : float
        Standard deviation of each reading [rad or m], normally distributed.
    seed : int
        Of the noise, 0 to 2⁶⁴ - 1.

    Raises
    ------
    BadArgumentError
        A value outside its range, by its name.

    Examples
    --------
    >>> import viapoint as vp
    >>> slow = vp.SimulatedDrive(lag=0.02, resolution=1e-5, noise=2e-6, seed=1)
    >>> with vp.connect("sim://ur5e", drive=slow) as arm:
    ...     _ = arm.run(vp.Program(arm.robot, start=arm.setpoint).movej([0.1] * 6))
    ...     bool(abs(arm.job.log.measured - arm.job.log.q).max() > 1e-3)
    True
    """

    lag: float = 0.0
    resolution: float = 0.0
    noise: float = 0.0
    seed: int = 0

    def __post_init__(self) -> None:
        """Check every value."""
        number(self.lag, "lag", "s", least=0.0, most=_MOST_LAG)
        number(self.resolution, "resolution", "rad or m", least=0.0)
        number(self.noise, "noise", "rad or m", least=0.0)
        integer(self.seed, "seed", 0, 2**64 - 1)

    def standing_at(self, start: Vector) -> _core.SimulatedSetup:
        """Return the drive of an arm that stands at `start`, (n,) [rad or m]."""
        return _core.SimulatedSetup(
            start, lag=self.lag, resolution=self.resolution, noise=self.noise, seed=self.seed
        )


def udp_device(url: str) -> _core.UdpSetup:
    """Return the device of a ``udp://`` url.

    Raises
    ------
    BadArgumentError
        No address and port in numbers, or more than these.
    """
    parts = urlsplit(url)
    try:
        host, port = parts.hostname, parts.port
    except ValueError:
        host, port = None, None
    if not host or not port or parts.path or parts.query or parts.username:
        raise BadArgumentError(
            f'url is "{url}"; a device\'s is "udp://<address>:<port>".',
            ways_out=['For example connect("udp://127.0.0.1:7500", robot=robot).'],
        )
    return _core.UdpSetup(host, port, patience=_PATIENCE)
