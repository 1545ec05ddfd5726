"""A run of the controller's that gets longer while it runs."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import TYPE_CHECKING

from . import _core
from ._proven import Tools
from ._remote_run import RemoteExecution
from ._wire import Message, message

if TYPE_CHECKING:
    from ._remote import RemoteLoop

_FRESH = 1e-3
"""An answer counts for so long [s]."""


class RemoteOpenRun(RemoteExecution):
    """What hands over a stream's motion to the controller: a `Follower` in C++."""

    def __init__(self, loop: RemoteLoop, number: int) -> None:
        super().__init__(loop, number)
        self.told_tools: Callable[[], Tools] = tuple
        """What the stream has told so far."""
        self._lock = threading.Lock()
        self._answer: Message | None = None
        self._asked = 0.0

    def _look_ahead(self) -> Message:
        """Ask how far the arm is, and what has become of the last motion, unless just asked."""
        with self._lock:
            now = time.monotonic()
            if self._answer is None or now - self._asked > _FRESH:
                request = message("GetHandOverRequest", token=self._loop.token, run=self.number)
                self._answer = self._loop.call("GetHandOver", request, "HandOver")
                self._asked = now
            return self._answer

    def _ask(self) -> Message:
        return self._look_ahead().run if self._loop.has_control else super()._ask()

    def lengthen(self, motion: _core.PlannedMotion, leave: float) -> None:
        """Hand over what follows: it begins at `leave` [s] of the motion before, or at its end."""
        with self._loop.sent(motion):
            request = message(
                "LengthenRequest", token=self._loop.token, run=self.number, leave=leave
            )
            self._loop.call("Lengthen", request, "LengthenReply")
        with self._lock:
            self._answer = None
        self.tell_tools(self.told_tools())

    def fate(self) -> int:
        """Return what became of the motion handed over last: 0 not yet, 1 taken, 2 too late."""
        return int(self._look_ahead().fate)

    def close(self) -> None:
        """Nothing more comes."""
        request = message("CloseRequest", token=self._loop.token, run=self.number)
        self._loop.call("Close", request, "CloseReply")

    @property
    def earliest_leave(self) -> float:
        """Before this a motion handed over now would be too late [s of the motion before]."""
        return float(self._look_ahead().earliest_leave)

    @property
    def waited_cycles(self) -> int:
        """For how long the arm has rested for want of motion."""
        return int(self._look_ahead().waited_cycles)
