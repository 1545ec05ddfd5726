"""A program that is run while it is told."""

from __future__ import annotations

import functools
import itertools
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from types import TracebackType
from typing import TYPE_CHECKING, Concatenate, ParamSpec, Protocol, TypeAlias, cast

from . import _core, _session
from ._arguments import ArrayLike
from ._job import ENDED, Execution
from ._program import Program, ProgramOptions
from ._proven import ToldTools, Tools
from ._report import Report
from ._robot import Robot
from ._stream_job import LateStep, StreamJob
from ._virtual import VirtualLoop
from .errors import BadProgramError, BusyError, MotionError, StoppedError

if TYPE_CHECKING:
    from ._chunks import Chunk
    from ._motion import Motion

_PERIOD = 0.02
"""How often a stream looks whether more is due [s]."""
_ROOM = 0.005
"""How often a step that has to wait looks for room [s]."""
_TOLD = 10
"""After so many looks for room whoever listens hears how far the run is."""
_MARGIN, _FAR_MARGIN = 0.05, 0.1
"""What planning and handing over may take of the motion under way [s], here and elsewhere."""


class OtherRun(Execution, Protocol):
    """A run in another process, which is told the tools for whoever finds it there."""

    told_tools: Callable[[], Tools]

    def tell_tools(self, tools: Tools) -> None: ...


class OtherLoop(Protocol):
    """A loop in another process."""

    followed: OtherRun
    """The run that `follow` has begun last."""

    @property
    def follow(self) -> Callable[[_core.PlannedMotion], OtherRun]: ...


StreamLoop: TypeAlias = _core.ControllerLoop | VirtualLoop | OtherLoop
_Told = ParamSpec("_Told")


class Stream(Program):
    """A program whose steps are run as they are told. Made by `Arm.stream`; use it in ``with``.

    Every builder of `Program` plans its step and hands it to the arm; it raises what is wrong with
    the step, and waits while the arm has `ahead` steps before it. A corner is rounded if the moves
    it hangs on are there in time: the two that it joins, and the one after them. Otherwise the arm
    rests on its path before the corner until they are, and `late` says for which step.

    Leaving the block tells that no step follows, and waits for the end; an exception in it brings
    the arm to rest on its path first. Threads: one tells steps, any may command the `job`.
    """

    _is_open = False
    """True once steps are run as they are told."""

    def __init__(
        self,
        robot: Robot,
        loop: StreamLoop,
        period: float,
        ahead: int,
        start: ArrayLike,
        options: ProgramOptions,
    ) -> None:
        super().__init__(robot, start=start, **options)
        self._loop = loop
        self._period = period
        self._ahead = ahead
        self._kept = len(self)
        self._told = self._kept
        self._tools = ToldTools(self._core, robot)
        if isinstance(loop, VirtualLoop):
            self._stream = _core.MotionStream(loop.core, robot._core, self._core, margin=5 * period)
        elif isinstance(loop, _core.ControllerLoop):
            self._stream = _core.MotionStream(loop, robot._core, self._core, margin=_MARGIN)
        else:
            self._stream = _core.MotionStream(
                self._follow, robot._core, self._core, margin=_FAR_MARGIN
            )
        self._job: StreamJob | None = None
        self._beginning = threading.Lock()
        self._trouble: BaseException | None = None
        self._closed = threading.Event()
        self._is_open = True
        if isinstance(loop, VirtualLoop):
            loop.feed = self._feed
        else:
            self._thread = threading.Thread(
                target=self._keep_on, name="viapoint-stream", daemon=True
            )
            self._thread.start()

    def __repr__(self) -> str:
        """Name, robot and number of steps."""
        return f"<Stream {self.name!r} for {self.robot.name}, {self._told} steps>"

    def __enter__(self) -> Stream:
        """Return the stream itself."""
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Wait for the end; on an exception, bring the arm to rest on its path."""
        self.close(stop=kind is not None)

    @property
    def job(self) -> StreamJob | None:
        """The run; None while there is nothing to move.

        Asking for it begins the motion with the steps told so far.

        Raises
        ------
        MotionError
            Why it could not begin.
        """
        if self.begun is None and not self._closed.is_set():
            self._stream.hand_over()
        return self.begun

    def _feed(self) -> None:
        """Hand over what is due, and have virtual time know the run that this may begin."""
        self._stream.hand_over()
        self.begun  # noqa: B018 -- asking tells whoever listens

    @property
    def begun(self) -> StreamJob | None:
        """The run, if the motion has begun; asking begins nothing."""
        with self._beginning:
            if self._job is None and self._stream.state is not None:
                self._job = StreamJob(self._execution(), self, self._period)
                _session.current().started(self._job)
            return self._job

    def _execution(self) -> Execution:
        """Return what the loop has begun."""
        core = self._stream.job
        if core is not None:
            loop = self._loop
            return loop.streamed(core) if isinstance(loop, VirtualLoop) else core
        return cast("OtherLoop", self._loop).followed

    def _follow(self, motion: _core.PlannedMotion) -> OtherRun:
        """Begin the run in another process."""
        run = cast("OtherLoop", self._loop).follow(motion)
        run.told_tools = lambda: self.tools
        run.tell_tools(self.tools)
        return run

    @property
    def tools(self) -> Tools:
        """From which step on the arm moves another tool, and the arm with that tool."""
        return self._tools.changes

    @property
    def steps_ahead(self) -> int:
        """Steps told that the arm has not begun."""
        return self._stream.steps_ahead

    @property
    def late(self) -> list[LateStep]:
        """Steps that came late, the newest 1000 of them, in order."""
        return [
            LateStep(step, file, line, cycles * self._period)
            for step, file, line, cycles in self._stream.late
        ]

    @property
    def late_count(self) -> int:
        """How many steps came late."""
        return self._stream.late_count

    @property
    def ended(self) -> bool:
        """True once no step can follow: the stream was closed, or its run is over."""
        return self._closed.is_set() or self._stream.state in ENDED

    def take_corners(self) -> list[_core.Corner]:
        """Return what became of the zones decided since the last call, the newest 1000."""
        return self._stream.take_corners()

    def take_warnings(self) -> Report:
        """Return the warnings met since the last call, the newest 1000."""
        return self._tell_warnings()

    def _tell_warnings(self) -> Report:
        """Have whoever listens hear them, too."""
        report = Report(self._stream.take_warnings())
        _session.current().checked(self, report)
        return report

    def close(self, *, stop: bool = False) -> None:
        """Tell that no step follows, and wait for the end.

        Parameters
        ----------
        stop : bool
            Bring the arm to rest on its path at once.

        Raises
        ------
        DriveFaultError
            The drive failed.
        MotionError
            Why motion that was told could not be handed over.
        """
        if self._closed.is_set():
            return
        is_told = False
        try:
            if stop:
                self._hand_over_no_more()
            else:
                self._stream.end()
                is_told = True
        finally:
            try:
                if (job := self.begun) is not None:
                    job.finish(stop=not is_told)
            finally:
                self._hand_over_no_more()
                self._tell_warnings()
        if self._trouble is not None and not stop:
            raise self._trouble

    def _hand_over_no_more(self) -> None:
        """From now on nothing new begins."""
        self._closed.set()
        if isinstance(self._loop, VirtualLoop):
            self._loop.feed = None
        else:
            self._thread.join()

    def check(self) -> Report:
        """Refuse: a stream is checked step by step as it is told."""
        raise _no_program("checked")

    def plan(self) -> Motion:
        """Refuse: a stream is planned while it is told."""
        raise _no_program("planned")

    def chunks(self, moves: Iterable[object] = ()) -> Iterator[Chunk]:
        """Refuse: a stream is handed to the arm in chunks by itself."""
        raise _no_program("planned")

    def _make_room(self, most: int) -> None:
        """Wait until the arm has fewer than `most` steps before it."""
        for turn in itertools.count():
            if self._trouble is not None:
                raise self._trouble
            if self._closed.is_set():
                raise BusyError(
                    "The stream has ended: no step can follow.", ways_out=["Begin another stream."]
                )
            if self._stream.state in ENDED and (job := self.begun) is not None:
                job.wait()  # raises what has failed, if that is why
                raise StoppedError(
                    f"The run of the stream is over ({job.state}): no step can follow.",
                    move=job.move,
                    ways_out=["Begin another stream where the arm rests."],
                )
            if self._stream.steps_ahead < most:
                return
            # Steps that move nothing leave the arm waiting for others, however many they are.
            self._stream.hand_over()
            if self._stream.wants_steps:
                return
            if turn % _TOLD == 0 and (job := self.begun) is not None:
                _session.current().waiting(job)
            if not isinstance(self._loop, VirtualLoop):
                time.sleep(_ROOM)
            elif self._loop.pass_cycles(_virtual_room(self._period)) == 1:
                time.sleep(_ROOM)  # it rests in a pause: another thread may act

    def _hand_on(self) -> None:
        """Hand on what a builder has added."""
        self._tools.add(self._core, self._kept, self._told)
        self._told += len(self) - self._kept
        self._stream.take(self._core, self._kept)

    def _keep_on(self) -> None:
        """Hand over what is due, again and again, until the stream is closed."""
        while not self._closed.wait(_PERIOD):
            try:
                self._stream.hand_over()
            except BaseException as error:  # noqa: BLE001 -- raised where the script tells a step
                self._trouble = error
                if (job := self.begun) is not None:
                    job.stop()
                return


def _virtual_room(period: float) -> int:
    """Cycles that pass in virtual time until a step looks for room again."""
    return max(2, round(_ROOM / period))


def _no_program(what: str) -> BadProgramError:
    return BadProgramError(
        f"A stream runs while it is told: it cannot be {what} as a whole.",
        ways_out=["Write a viapoint.Program."],
    )


def _streamed(
    builder: Callable[Concatenate[Program, _Told], Program],
) -> Callable[Concatenate[Stream, _Told], Stream]:
    @functools.wraps(builder)
    def tell(self: Stream, *args: _Told.args, **options: _Told.kwargs) -> Stream:
        if not self._is_open:
            builder(self, *args, **options)
            return self
        # An output that waited would come too late for a place before the end of its move.
        self._make_room(self._ahead * (2 if builder is Program.set_do else 1))
        try:
            builder(self, *args, **options)
            self._hand_on()
        except MotionError as error:
            _session.current().refused(self, error)
            raise
        return self

    return cast("Callable[Concatenate[Stream, _Told], Stream]", tell)


for _name in (
    "movej",
    "movel",
    "movec",
    "screw",
    "spline",
    "set_frame",
    "set_tool",
    "wait",
    "wait_di",
    "set_do",
    "timed",
):
    setattr(Stream, _name, _streamed(getattr(Program, _name)))
