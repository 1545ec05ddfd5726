"""
The laws of one axis.
"""

from __future__ import annotations

import collections.abc
import typing

import numpy
import numpy.typing

__all__: list[str] = [
    "AxisLaw",
    "AxisTiming",
    "BlendedLines",
    "PseudoViaPoints",
    "StateMotion",
    "Trapezoid",
    "b_spline",
    "bang_bang",
    "bezier",
    "blended_lines",
    "clamped_knots",
    "cubic",
    "durations_at_speed",
    "lspb",
    "natural_spline_velocities",
    "parabolic_blend",
    "periodic_spline_velocities",
    "polynomial",
    "pseudo_via_points",
    "quartic_transitions",
    "quintic",
    "rest_to_rest",
    "resting",
    "slope_velocities",
    "spline_through",
    "spline_velocities",
    "state_to_state",
    "timed_together",
    "trapezoid",
    "via_cubics",
]

class AxisLaw:
    """
    The course of one axis: polynomials one after the other.
    """
    def delayed(self, seconds: typing.SupportsFloat | typing.SupportsIndex) -> AxisLaw:
        """
        The same course, later by that.
        """
    def extremes(
        self, derivative: typing.SupportsInt | typing.SupportsIndex
    ) -> typing.Annotated[list[float], "FixedSize(4)"]:
        """
        Smallest value, its time, largest value, its time, of derivative 0 to 3.
        """
    def parts(self) -> list[tuple[float, float, typing.Annotated[list[float], "FixedSize(12)"]]]:
        """
        (t0, t1, coefficients of (t - t0)^k) of each polynomial.
        """
    def sample(
        self, times: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        q and its three derivatives at times (k,), (k, 4); times outside are refused.
        """
    @property
    def end(self) -> float:
        """
        Time at which it ends [s].
        """
    @property
    def start(self) -> float:
        """
        Time at which it begins [s].
        """

class AxisTiming:
    """
    When the axes of one motion move.

    Members:

      sequential

      simultaneous

      synchronised
    """

    __members__: typing.ClassVar[dict[str, AxisTiming]]
    sequential: typing.ClassVar[AxisTiming]
    simultaneous: typing.ClassVar[AxisTiming]
    synchronised: typing.ClassVar[AxisTiming]
    @typing.overload
    def __eq__(self, other: AxisTiming) -> bool: ...
    @typing.overload
    def __eq__(self, other: typing.Any) -> bool: ...
    def __getstate__(self) -> int: ...
    def __hash__(self) -> int: ...
    def __index__(self) -> int: ...
    def __init__(self, value: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __int__(self) -> int: ...
    @typing.overload
    def __ne__(self, other: AxisTiming) -> bool: ...
    @typing.overload
    def __ne__(self, other: typing.Any) -> bool: ...
    def __repr__(self) -> str: ...
    def __setstate__(self, state: typing.SupportsInt | typing.SupportsIndex) -> None: ...
    def __str__(self) -> str: ...
    @property
    def name(self) -> str: ...
    @property
    def value(self) -> int: ...

class PseudoViaPoints:
    """
    Through points replaced by two each.
    """
    @property
    def durations(self) -> list[float]:
        """
        [s]
        """
    @property
    def middles(self) -> list[int]:
        """
        Segments with a through point inside.
        """
    @property
    def points(self) -> list[float]: ...
    @property
    def source(self) -> list[int]:
        """
        The original index of each point.
        """

class Trapezoid:
    """
    A trapezoid of velocity.
    """
    @property
    def acceleration(self) -> float:
        """
        Of the first blend, signed.
        """
    @property
    def blend_time(self) -> float:
        """
        [s]
        """
    @property
    def law(self) -> AxisLaw: ...
    @property
    def velocity(self) -> float:
        """
        Of the linear part, signed.
        """

class BlendedLines:
    """
    Lines joined by parabolic blends.
    """
    @property
    def blend_acceleration(self) -> list[float]:
        """
        Signed, (k,).
        """
    @property
    def blend_time(self) -> list[float]:
        """
        [s], (k,)
        """
    @property
    def durations(self) -> list[float]:
        """
        Of the segments [s], (k - 1,).
        """
    @property
    def law(self) -> AxisLaw: ...
    @property
    def linear_time(self) -> list[float]:
        """
        [s], (k - 1,)
        """
    @property
    def linear_velocity(self) -> list[float]:
        """
        Signed, (k - 1,).
        """

class StateMotion:
    """
    A motion from state to state.
    """
    def at(
        self, t: typing.Annotated[numpy.typing.ArrayLike, numpy.float64]
    ) -> tuple[
        numpy.typing.NDArray[numpy.float64],
        numpy.typing.NDArray[numpy.float64],
        numpy.typing.NDArray[numpy.float64],
        numpy.typing.NDArray[numpy.float64],
    ]:
        """
        q, qd, qdd, qddd at t, () or (k,); times outside are refused.
        """
    def extremes(
        self, derivative: typing.SupportsInt | typing.SupportsIndex
    ) -> numpy.typing.NDArray[numpy.float64]:
        """
        Smallest value, its time, largest value, its time; (4, n).
        """
    def parts(
        self, joint: typing.SupportsInt | typing.SupportsIndex
    ) -> list[tuple[float, float, typing.Annotated[list[float], "FixedSize(4)"]]]:
        """
        (begin, end, coefficients of (t - begin)^k) of each phase of a joint.
        """
    @property
    def duration(self) -> float:
        """
        [s]
        """
    @property
    def durations(self) -> numpy.typing.NDArray[numpy.float64]:
        """
        Of each joint [s], (n,).
        """
    @property
    def joints(self) -> int:
        """
        Number of joints.
        """
    @property
    def scalar(self) -> bool:
        """
        True for one joint given by numbers.
        """

def b_spline(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    knots: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    degree: typing.SupportsInt | typing.SupportsIndex,
) -> AxisLaw:
    """
    The B-spline of control points.
    """

def bang_bang(
    q0: typing.SupportsFloat | typing.SupportsIndex,
    q1: typing.SupportsFloat | typing.SupportsIndex,
    acceleration: typing.SupportsFloat | typing.SupportsIndex,
) -> Trapezoid:
    """
    The quickest move under an acceleration limit.
    """

def bezier(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    t0: typing.SupportsFloat | typing.SupportsIndex,
    t1: typing.SupportsFloat | typing.SupportsIndex,
) -> AxisLaw:
    """
    The Bézier law of control points.
    """

def blended_lines(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    durations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    accelerations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    straight_at_middle: collections.abc.Sequence[typing.SupportsInt | typing.SupportsIndex] = [],
) -> BlendedLines:
    """
    Linear segments with parabolic blends, durations given.
    """

def clamped_knots(
    points: typing.SupportsInt | typing.SupportsIndex,
    degree: typing.SupportsInt | typing.SupportsIndex,
    t0: typing.SupportsFloat | typing.SupportsIndex,
    t1: typing.SupportsFloat | typing.SupportsIndex,
) -> list[float]:
    """
    Knots with equal spans and both ends degree + 1 times.
    """

def cubic(
    q0: typing.SupportsFloat | typing.SupportsIndex,
    q1: typing.SupportsFloat | typing.SupportsIndex,
    t0: typing.SupportsFloat | typing.SupportsIndex,
    t1: typing.SupportsFloat | typing.SupportsIndex,
    v0: typing.SupportsFloat | typing.SupportsIndex,
    v1: typing.SupportsFloat | typing.SupportsIndex,
) -> AxisLaw:
    """
    The cubic with given position and velocity at both ends.
    """

def durations_at_speed(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    speeds: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    accelerations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> list[float]:
    """
    Durations with which the linear parts run at given speeds; 0 between equal points.
    """

def lspb(
    q0: typing.SupportsFloat | typing.SupportsIndex,
    q1: typing.SupportsFloat | typing.SupportsIndex,
    duration: typing.SupportsFloat | typing.SupportsIndex,
    velocity: typing.SupportsFloat | typing.SupportsIndex | None = None,
    blend_time: typing.SupportsFloat | typing.SupportsIndex | None = None,
) -> Trapezoid:
    """
    Linear segment with parabolic blends, by velocity, by blend time, or neither.
    """

def natural_spline_velocities(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    durations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> list[float]:
    """
    The same with no acceleration at both ends.
    """

def parabolic_blend(
    w0: typing.SupportsFloat | typing.SupportsIndex,
    w1: typing.SupportsFloat | typing.SupportsIndex,
    w2: typing.SupportsFloat | typing.SupportsIndex,
    before: typing.SupportsFloat | typing.SupportsIndex,
    after: typing.SupportsFloat | typing.SupportsIndex,
    half_width: typing.SupportsFloat | typing.SupportsIndex,
) -> AxisLaw:
    """
    Two lines and one parabolic blend of given half width.
    """

def periodic_spline_velocities(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    durations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> list[float]:
    """
    The same with ends that go over into each other.
    """

def polynomial(
    conditions: collections.abc.Sequence[
        tuple[
            typing.SupportsFloat | typing.SupportsIndex,
            typing.SupportsInt | typing.SupportsIndex,
            typing.SupportsFloat | typing.SupportsIndex,
        ]
    ],
) -> AxisLaw:
    """
    The polynomial of least degree that meets conditions (time, derivative, value).
    """

def pseudo_via_points(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    durations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    through: collections.abc.Sequence[
        tuple[
            typing.SupportsInt | typing.SupportsIndex,
            typing.SupportsFloat | typing.SupportsIndex,
            typing.SupportsFloat | typing.SupportsIndex,
        ]
    ],
) -> PseudoViaPoints:
    """
    Two points for every through point (index, velocity, half gap).
    """

def quartic_transitions(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    durations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    t_acc: typing.SupportsFloat | typing.SupportsIndex,
) -> AxisLaw:
    """
    Lines through timed points with quartic transitions.
    """

def quintic(
    q0: typing.SupportsFloat | typing.SupportsIndex,
    q1: typing.SupportsFloat | typing.SupportsIndex,
    t0: typing.SupportsFloat | typing.SupportsIndex,
    t1: typing.SupportsFloat | typing.SupportsIndex,
    v0: typing.SupportsFloat | typing.SupportsIndex,
    v1: typing.SupportsFloat | typing.SupportsIndex,
    a0: typing.SupportsFloat | typing.SupportsIndex,
    a1: typing.SupportsFloat | typing.SupportsIndex,
) -> AxisLaw:
    """
    The quintic with given position, velocity and acceleration at both ends.
    """

def rest_to_rest(
    q0: typing.SupportsFloat | typing.SupportsIndex,
    q1: typing.SupportsFloat | typing.SupportsIndex,
    velocity: typing.SupportsFloat | typing.SupportsIndex,
    acceleration: typing.SupportsFloat | typing.SupportsIndex,
    jerk: typing.SupportsFloat | typing.SupportsIndex,
) -> AxisLaw:
    """
    The quickest move under limits on velocity, acceleration and jerk.
    """

def resting(
    q: typing.SupportsFloat | typing.SupportsIndex,
    t0: typing.SupportsFloat | typing.SupportsIndex,
    t1: typing.SupportsFloat | typing.SupportsIndex,
) -> AxisLaw:
    """
    At rest at q.
    """

def slope_velocities(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    durations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    first: typing.SupportsFloat | typing.SupportsIndex,
    last: typing.SupportsFloat | typing.SupportsIndex,
) -> list[float]:
    """
    Via velocities by the slope heuristic.
    """

def spline_through(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    durations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    degree: typing.SupportsInt | typing.SupportsIndex,
    v0: typing.SupportsFloat | typing.SupportsIndex,
    v1: typing.SupportsFloat | typing.SupportsIndex,
    a0: typing.SupportsFloat | typing.SupportsIndex,
    a1: typing.SupportsFloat | typing.SupportsIndex,
) -> AxisLaw:
    """
    The B-spline through points.
    """

def spline_velocities(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    durations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    first: typing.SupportsFloat | typing.SupportsIndex,
    last: typing.SupportsFloat | typing.SupportsIndex,
) -> list[float]:
    """
    Via velocities that make acceleration continuous.
    """

def state_to_state(
    q0: numpy.typing.ArrayLike | None,
    q1: numpy.typing.ArrayLike | None,
    v0: numpy.typing.ArrayLike | None,
    a0: numpy.typing.ArrayLike | None,
    v1: numpy.typing.ArrayLike | None,
    a1: numpy.typing.ArrayLike | None,
    v_max: numpy.typing.ArrayLike | None,
    a_max: numpy.typing.ArrayLike | None,
    j_max: numpy.typing.ArrayLike | None,
    v_min: numpy.typing.ArrayLike | None,
    a_min: numpy.typing.ArrayLike | None,
    j_min: numpy.typing.ArrayLike | None,
    p_min: numpy.typing.ArrayLike | None,
    p_max: numpy.typing.ArrayLike | None,
    sync: numpy.typing.ArrayLike | None,
    least_duration: numpy.typing.ArrayLike | None,
    cycle: numpy.typing.ArrayLike | None,
) -> StateMotion:
    """
    The quickest motion from state to state, or with q1 None to a velocity.
    """

def timed_together(laws: collections.abc.Sequence[AxisLaw], timing: AxisTiming) -> list[AxisLaw]:
    """
    Several laws on one clock.
    """

def trapezoid(
    q0: typing.SupportsFloat | typing.SupportsIndex,
    q1: typing.SupportsFloat | typing.SupportsIndex,
    velocity: typing.SupportsFloat | typing.SupportsIndex,
    acceleration: typing.SupportsFloat | typing.SupportsIndex,
) -> Trapezoid:
    """
    The quickest move under velocity and acceleration limits.
    """

def via_cubics(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    durations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    velocities: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> AxisLaw:
    """
    One cubic a segment through points with given velocities.
    """
