"""The quickest motion of one joint or several from any state to any other."""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, integer, number, numbers_of
from ._drawn import Drawn
from ._law import Extremes, Part, State
from .errors import BadArgumentError

MOST_SAMPLES = 1e8
"""What one call may ask for: some gigabytes."""


class StateSamples(NamedTuple):
    """States over time; t is (k,), the others are (k,) or (k, n)."""

    t: Vector
    q: Vector
    qd: Vector
    qdd: Vector
    qddd: Vector


class StateMotion(Drawn):
    """Joints on their way from state to state, in phases of constant jerk.

    Attributes
    ----------
    shape : tuple of int
        ``()`` for one joint given by plain numbers, ``(n,)`` for joints given as arrays.
    duration : float
        Until the last joint has arrived [s]; exact, not rounded to a cycle unless asked for.
    """

    __slots__ = ("_core", "duration", "shape")

    def __init__(self, core: _core.profile.StateMotion) -> None:
        self._core = core
        self.duration = core.duration
        self.shape: tuple[int, ...] = () if core.scalar else (core.joints,)

    @property
    def durations(self) -> Vector:
        """Until each joint has arrived [s]; of the shape `shape`."""
        durations: Vector = self._core.durations
        return durations.reshape(self.shape)

    def at(self, t: ArrayLike) -> State:
        """Position and derivatives at one time or at many.

        A joint that arrives before the others (``sync="none"``) goes on at its end velocity,
        past its position limits too.

        Parameters
        ----------
        t : float or array_like, (k,)
            Times in ``[0, duration]`` [s]; where two phases meet, the later one counts.

        Returns
        -------
        State
            Each field of shape ``shape`` for one time, ``(k, *shape)`` for many.

        Raises
        ------
        BadArgumentError
            A time outside the motion, NaN, or an array of more than one dimension.
        """
        times = t if type(t) is float else numbers_of(t, "t")
        return State(*self._core.at(times))

    def sample(self, dt: float) -> StateSamples:
        """States at 0, dt, 2 dt, … and at the exact end (the last step may be shorter).

        Parameters
        ----------
        dt : float
            Step [s], above 0.

        Raises
        ------
        BadArgumentError
            dt is not positive and finite, or asks for more than 1e8 samples.
        """
        step = number(dt, "dt", "s", above=0.0)
        if not self.duration / step < MOST_SAMPLES:
            raise BadArgumentError(
                f"dt is {step:g} s, that is {self.duration / step:.3g} samples; "
                f"at most {MOST_SAMPLES:g} are made at once."
            )
        times: Vector = step * np.arange(int(self.duration / step) + 1, dtype=np.float64)
        times = np.append(times[times < self.duration], self.duration)
        return StateSamples(times, *self._core.at(times))

    def extremes(self, derivative: int = 0) -> Extremes:
        """Smallest and largest value over the whole motion, found exactly and not on samples.

        Parameters
        ----------
        derivative : int
            0 for q, 1 for qd, 2 for qdd, 3 for qddd.

        Raises
        ------
        BadArgumentError
            Another derivative.
        """
        low, low_time, high, high_time = self._core.extremes(
            integer(derivative, "derivative", 0, 3)
        )
        return Extremes(
            *(values.reshape(self.shape) for values in (low, low_time, high, high_time))
        )

    def parts(self, axis: int = 0) -> list[Part]:
        """Return the phases of one joint, in order of time; none where nothing moves.

        Parameters
        ----------
        axis : int
            Joint, from 0.

        Raises
        ------
        BadArgumentError
            No such joint.
        """
        joint = integer(axis, "axis", 0, self._core.joints - 1)
        return [
            Part(begin, end, np.array(coefficients))
            for begin, end, coefficients in self._core.parts(joint)
        ]

    def knots(self, axis: int | None = None) -> Vector:
        """Return the times at which phases meet, ends included: of one joint, or of all.

        Parameters
        ----------
        axis : int, optional
            Joint, from 0.

        Returns
        -------
        ndarray, (m,)
            Ascending, from 0 to `duration` [s].

        Raises
        ------
        BadArgumentError
            No such joint.
        """
        axes = range(self._core.joints) if axis is None else (axis,)
        inner = [part.end for each in axes for part in self.parts(each)]
        return np.unique([0.0, *(t for t in inner if t < self.duration), self.duration])

    @property
    def start(self) -> float:
        """When it begins [s]: 0, as that of a law that was not told otherwise."""
        return 0.0

    @property
    def end(self) -> float:
        """When it ends [s]: `duration`."""
        return self.duration

    def __repr__(self) -> str:
        """Count joints and time."""
        return f"<StateMotion of {self._core.joints} joints, {self.duration:g} s>"


def state_to_state(
    q0: ArrayLike,
    q1: ArrayLike | None,
    *,
    v0: ArrayLike = 0.0,
    a0: ArrayLike = 0.0,
    v1: ArrayLike = 0.0,
    a1: ArrayLike = 0.0,
    v_max: ArrayLike,
    a_max: ArrayLike,
    j_max: ArrayLike,
    v_min: ArrayLike | None = None,
    a_min: ArrayLike | None = None,
    j_min: ArrayLike | None = None,
    p_min: ArrayLike | None = None,
    p_max: ArrayLike | None = None,
    sync: Literal["time", "line", "none"] | None = None,
    least_duration: float | None = None,
    cycle: float | None = None,
) -> StateMotion:
    """Move from any state to any other as quickly as velocity, acceleration and jerk may be.

    States and limits are one value for all joints, or one a joint.

    Parameters
    ----------
    q0, v0, a0 : float or array_like, (n,)
        Position, velocity and acceleration at the start [rad or m, per s, s²]. A start outside the
        limits comes back in by the quickest way, then stays in.
    q1, v1, a1 : float or array_like, (n,)
        Those at the end. With ``q1=None`` each joint goes to the velocity v1 wherever that is.
    v_max, a_max, j_max : float or array_like, (n,)
        Largest velocity, acceleration and jerk [rad or m per s, s², s³], above 0.
    v_min, a_min, j_min : float or array_like, (n,), optional
        Smallest ones, with their sign: below 0. Minus the largest where not given.
    p_min, p_max : float or array_like, (n,), optional
        Smallest and largest position during the motion [rad or m]; infinite where there is none.
        A start beyond them comes in.
    sync : {"time", "line", "none"}, optional
        ``"time"``: all joints arrive together, in the shortest time that all have a motion of.
        ``"line"``: all move on the straight line from q0 to q1; the states must lie on it, or the
        call is refused. ``"none"``: each joint as quickly as it can. ``"time"`` for a position,
        ``"none"`` for a velocity where not given.
    least_duration : float, optional
        Not quicker than this [s]. A duration no motion has is passed over for the next one.
    cycle : float, optional
        The duration is rounded up to a multiple of this [s].

    Returns
    -------
    StateMotion

    Raises
    ------
    BadArgumentError
        Values that are not finite, shapes that do not go together, no straight line under
        ``sync="line"``, numbers so many decades apart that doubles cannot hold the motion.
    BadLimitsError
        A maximum that is not above 0, a minimum that is not below 0.
    JointLimitError
        The end is beyond a position limit, or a state too fast to stop before one.
    VelocityLimitError, AccelerationLimitError
        An end state outside its limits, or one that can only be arrived at from outside.

    Examples
    --------
    >>> import viapoint as vp
    >>> motion = vp.profile.state_to_state([0, 0], [1, -0.5], v_max=1.0, a_max=[2, 4], j_max=20.0)
    >>> round(motion.duration, 3)
    1.6
    """
    return StateMotion(
        _core.profile.state_to_state(
            q0, q1, v0, a0, v1, a1, v_max, a_max, j_max, v_min, a_min, j_min, p_min, p_max,
            sync, least_duration, cycle,
        )
    )  # fmt: skip
