"""
The laws of one axis.
"""

from __future__ import annotations

import typing

import numpy
import numpy.typing

__all__: list[str] = [
    "AxisLaw",
    "BlendedLines",
    "StateMotion",
    "Trapezoid",
    "bang_bang",
    "blended_lines",
    "cubic",
    "durations_at_speed",
    "lspb",
    "parabolic_blend",
    "quartic_transitions",
    "quintic",
    "rest_to_rest",
    "slope_velocities",
    "spline_velocities",
    "state_to_state",
    "via_cubics",
]

class AxisLaw:
    """
    The course of one axis: polynomials one after the other.
    """
    def extremes(
        self, derivative: typing.SupportsInt | typing.SupportsIndex
    ) -> typing.Annotated[list[float], "FixedSize(4)"]:
        """
        Smallest value, its time, largest value, its time, of derivative 0 to 3.
        """
    def parts(self) -> list[tuple[float, float, typing.Annotated[list[float], "FixedSize(6)"]]]:
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

def bang_bang(
    q0: typing.SupportsFloat | typing.SupportsIndex,
    q1: typing.SupportsFloat | typing.SupportsIndex,
    acceleration: typing.SupportsFloat | typing.SupportsIndex,
) -> Trapezoid:
    """
    The quickest move under an acceleration limit.
    """

def blended_lines(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    durations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    accelerations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> BlendedLines:
    """
    Linear segments with parabolic blends, durations given.
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

def slope_velocities(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    durations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    first: typing.SupportsFloat | typing.SupportsIndex,
    last: typing.SupportsFloat | typing.SupportsIndex,
) -> list[float]:
    """
    Via velocities by the slope heuristic.
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
    sync: numpy.typing.ArrayLike | None,
    least_duration: numpy.typing.ArrayLike | None,
    cycle: numpy.typing.ArrayLike | None,
) -> StateMotion:
    """
    The quickest motion from state to state, or with q1 None to a velocity.
    """

def via_cubics(
    points: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    durations: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
    velocities: typing.Annotated[numpy.typing.ArrayLike, numpy.float64],
) -> AxisLaw:
    """
    One cubic a segment through points with given velocities.
    """
