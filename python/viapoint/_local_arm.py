"""An arm that this process drives itself."""

from __future__ import annotations

from . import _core
from ._arguments import integer
from ._arm import Arm
from ._motion import CYCLE
from ._robot import Robot
from ._virtual import VirtualLoop


class LocalArm(Arm):
    """An arm under the 2 ms loop of this process. Made by `connect`; use it in a ``with`` block.

    It is simulated, or moved by a device over UDP.
    """

    def __init__(
        self, robot: Robot, loop: _core.ControllerLoop | VirtualLoop, cycle: float = CYCLE
    ) -> None:
        super().__init__(robot, loop, cycle)
        self._own_loop = loop
        self._rtde: list[_core.RtdeService] = []

    def close(self) -> None:
        """Disconnect; a run under way is brought to rest on its path first, a jog as it can."""
        try:
            for service in self._rtde:
                service.close()
        finally:
            super().close()

    def serve_rtde(
        self, port: int = 30004, *, address: str = "127.0.0.1", other_machines: bool = False
    ) -> int:
        """Let clients of UR's RTDE look on, turn the override and switch outputs, until `close`.

        For an arm of six joints; a ``viapoint-controller`` serves RTDE by its configuration
        (``docs/rtde.md``). In virtual time nobody is served.

        Parameters
        ----------
        port : int
            0 to 65535; 0 lets the system choose.
        address : str
            In numbers, IPv4 or IPv6.
        other_machines : bool
            Allows an address that other machines can reach. RTDE has neither passwords nor
            encryption.

        Returns
        -------
        int
            The port listened on.

        Raises
        ------
        BadArgumentError
            Another port, an address that is none or needs ``other_machines``, an arm of other than
            six joints.
        BusyError
            Another program listens there.
        """
        number_of_port = integer(port, "port", 0, 65535)
        loop = self._own_loop
        if isinstance(loop, VirtualLoop):
            return number_of_port
        service = _core.RtdeService(
            loop, self.robot._core, address, number_of_port, other_machines, self._cycle
        )
        self._rtde.append(service)
        return service.port

    @property
    def datagrams(self) -> dict[str, int]:
        """What has become of the datagrams to and from a UDP device; empty for other arms.

        ``sent``, ``unsent``, ``answered``; ``silent`` cycles; and what was ignored: ``wrong_size``,
        ``wrong_magic``, ``wrong_version``, ``wrong_joints``, ``not_finite``, ``old``.
        """
        return self._own_loop.datagrams
