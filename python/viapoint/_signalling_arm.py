"""An arm's digital inputs and outputs."""

from __future__ import annotations

from ._loop import Loop
from ._signals import on_or_off, signal


class SignallingArm:
    """The part of `Arm` that tells and switches signals."""

    _loop: Loop

    def input(self, index: int) -> bool:
        """Return what the drive last reported of a digital input.

        Parameters
        ----------
        index : int
            Input, 0 to 63.

        Raises
        ------
        BadArgumentError
            Another index.
        """
        return bool(1 << signal(index) & self._loop.inputs)

    def set_input(self, index: int, value: bool) -> None:
        """Switch a digital input of the simulated drive.

        Parameters
        ----------
        index : int
            Input, 0 to 63.
        value : bool
            On or off.

        Raises
        ------
        BadArgumentError
            Another index, or a value that is not a bool.
        BusyError
            The drive is a real one.
        """
        bit = 1 << signal(index)
        self._loop.set_inputs(bit, bit if on_or_off(value, "input") else 0)

    def output(self, index: int) -> bool:
        """Return what the drive was last told of a digital output.

        Parameters
        ----------
        index : int
            Output, 0 to 63.

        Raises
        ------
        BadArgumentError
            Another index.
        """
        return bool(1 << signal(index) & self._loop.outputs)

    def set_output(self, index: int, value: bool) -> None:
        """Switch a digital output by hand from the next cycle on, at rest, in motion or guided.

        It stays so until a program that runs, or somebody else, switches it.

        Parameters
        ----------
        index : int
            Output, 0 to 63.
        value : bool
            On or off.

        Raises
        ------
        BadArgumentError
            Another index, or a value that is not a bool.
        DriveFaultError
            The arm has failed, or its drive was released: nothing is told it any more.
        """
        bit = 1 << signal(index)
        self._loop.switch_outputs(bit, bit if on_or_off(value, "output") else 0)
