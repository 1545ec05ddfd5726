"""The textbook's laws of motion, for one axis or for several at once.

Every function returns a law: ``law.at(t)`` gives ``q, qd, qdd, qddd``, ``law.extremes(k)`` the
exact extremes of the derivative k, ``law.plot(path)`` a picture. Plain numbers make a law of one
axis, whose values have the shape () or (k,); arrays of n values make a law of n axes in the same
time, (n,) or (k, n)::

    law = vp.profile.quintic([0.0, 0.0], [1.0, -0.5], 2.0)
    q, qd, qdd, qddd = law.at(np.linspace(0.0, 2.0, 101))

Units are the caller's: radians or metres, and seconds. By their textbook names:

======================================================  =====================================
cubic, quintic, polynomial from any conditions          `cubic`, `quintic`, `polynomial`
LSPB, linear segment with parabolic blends              `lspb`
trapezoid of velocity under limits, bang-bang           `trapezoid`, `bang_bang`
seven-phase S-curve, double S                           `rest_to_rest`
sequential, simultaneous, synchronised axes             `together`, or ``timing=`` of the above
cubics through via points, cubic spline                 `via_cubics`, `via_velocities`
via velocities in task space, through J⁻¹               `joint_velocities`
lines with parabolic blends, pseudo via points          `blended_lines`
one parabolic blend of given width                      `parabolic_blend`
quartic transitions                                     `quartic_transitions`
Bézier, B-spline, B-spline through points               `bezier`, `b_spline`, `b_spline_through`
from any state to any other under jerk limits           `state_to_state`
======================================================  =====================================
"""

from __future__ import annotations

from ._axis_timing import together
from ._blends import blended_lines, parabolic_blend, quartic_transitions
from ._law import BlendedLines, Extremes, Law, Part, State, Trapezoid
from ._point_to_point import (
    bang_bang,
    cubic,
    lspb,
    polynomial,
    quintic,
    rest_to_rest,
    trapezoid,
)
from ._splines import b_spline, b_spline_through, bezier
from ._state_to_state import StateMotion, StateSamples, state_to_state
from ._via_points import joint_velocities, via_cubics, via_velocities

__all__ = [
    "BlendedLines",
    "Extremes",
    "Law",
    "Part",
    "State",
    "StateMotion",
    "StateSamples",
    "Trapezoid",
    "b_spline",
    "b_spline_through",
    "bang_bang",
    "bezier",
    "blended_lines",
    "cubic",
    "joint_velocities",
    "lspb",
    "parabolic_blend",
    "polynomial",
    "quartic_transitions",
    "quintic",
    "rest_to_rest",
    "state_to_state",
    "together",
    "trapezoid",
    "via_cubics",
    "via_velocities",
]
