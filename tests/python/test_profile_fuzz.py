"""Any numbers at all into the laws: a refusal by name or a right answer, never NaN or a hang."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import viapoint as vp

p = vp.profile

fuzz = settings(max_examples=100, derandomize=True, deadline=None, database=None)

anything = st.floats(allow_nan=True, allow_infinity=True, allow_subnormal=True)
usual = st.floats(-1e3, 1e3)
number = st.one_of(usual, usual, anything, st.sampled_from([0.0, -0.0, 5e-324, 1e308, -1e308]))
duration = st.one_of(st.floats(1e-3, 1e3), st.floats(1e-3, 1e3), number)
limit = st.one_of(st.floats(1e-6, 1e9), st.floats(1e-6, 1e9), number)
timing = st.sampled_from(["synchronised", "simultaneous", "sequential"])


def value(n):
    """One number for all axes, or one an axis."""
    return st.one_of(number, st.lists(number, min_size=n, max_size=n))


@st.composite
def ways(draw, most=6):
    """Points (k,) or (k, 2), and k - 1 durations."""
    k = draw(st.integers(1, most))
    row = number if draw(st.booleans()) else st.lists(number, min_size=2, max_size=2)
    points = draw(st.lists(row, min_size=k, max_size=k))
    return points, draw(st.lists(duration, min_size=k - 1, max_size=k - 1))


def made(call):
    """The law, or None where it was refused by name."""
    try:
        return call()
    except vp.MotionError:
        return None


def check(law):
    """Finite everywhere, extremes that hold every sample and are taken where they say."""
    times = np.clip(np.linspace(law.start, law.end, 41), law.start, law.end)
    state = law.at(times)
    for derivative, values in enumerate(state):
        assert np.isfinite(values).all()
        found = law.extremes(derivative)
        assert np.isfinite(found).all()
        sizes = np.maximum(np.abs(found.low), np.abs(found.high))
        # What the terms of the polynomials cancel: their sizes, not that of the sum, are rounded.
        slack = 1e-9 * sizes + rounding(law, derivative)
        assert (values.min(axis=0) >= found.low - slack).all()
        assert (values.max(axis=0) <= found.high + slack).all()
        assert (found.low_time >= law.start).all()
        assert (found.high_time <= law.end).all()


def rounding(law, derivative):
    """What a derivative may be off by.

    1e-14 of the terms that add up to it, what one step of a clock of doubles changes, and the last
    bit of a coefficient so small that it has few.
    """
    worst = []
    tick = 4e-16 * max(abs(law.start), abs(law.end)) / 1e-14
    for axis in range(law.shape[0] if law.shape else 1):
        sizes = [0.0]
        for part in law.parts(axis):
            c = np.polynomial.Polynomial(np.abs(part.coefficients) + 1e-310)
            length = part.end - part.start
            with np.errstate(over="ignore", invalid="ignore"):
                here, change = (float(c.deriv(derivative + k)(length)) for k in (0, 1))
                sizes.append(here + tick * change)
        worst.append(1e-14 * max(sizes) + 1e-300)
    return np.array(worst).reshape(law.shape)


def meets(law, t, derivative, wanted):
    here = law.at(t)[derivative]
    slack = 1e-9 * np.abs(wanted) + 1e3 * rounding(law, derivative)
    assert (np.abs(here - wanted) <= slack).all(), (t, derivative, here, wanted)


@fuzz
@given(value(2), value(2), duration, value(2), value(2), number)
def test_cubic(q0, q1, seconds, v0, v1, t0):
    law = made(lambda: p.cubic(q0, q1, seconds, v0=v0, v1=v1, t0=t0))
    if law is not None:
        check(law)
        for t, q, v in ((law.start, q0, v0), (law.end, q1, v1)):
            meets(law, t, 0, np.array(q))
            meets(law, t, 1, np.array(v))


@fuzz
@given(value(2), value(2), duration, value(2), value(2), value(2), value(2), number)
def test_quintic(q0, q1, seconds, v0, v1, a0, a1, t0):
    law = made(lambda: p.quintic(q0, q1, seconds, v0=v0, v1=v1, a0=a0, a1=a1, t0=t0))
    if law is not None:
        check(law)
        for t, ends in ((law.start, (q0, v0, a0)), (law.end, (q1, v1, a1))):
            for derivative, wanted in enumerate(ends):
                meets(law, t, derivative, np.array(wanted))


@fuzz
@given(st.lists(st.tuples(duration, st.integers(-1, 4), number), max_size=14))
def test_polynomial(conditions):
    law = made(lambda: p.polynomial(conditions))
    if law is not None:
        check(law)


@fuzz
@given(value(2), value(2), duration, st.none() | value(2), st.none() | value(2))
def test_lspb(q0, q1, seconds, velocity, blend_time):
    law = made(lambda: p.lspb(q0, q1, seconds, velocity=velocity, blend_time=blend_time))
    if law is not None:
        check(law)
        meets(law, law.start, 0, np.array(q0))
        meets(law, law.end, 0, np.array(q1))


@fuzz
@given(value(3), value(3), value(3), value(3), timing)
def test_trapezoid_and_bang_bang(q0, q1, v_max, a_max, how):
    for call in (
        lambda: p.trapezoid(q0, q1, v_max=v_max, a_max=a_max, timing=how),
        lambda: p.bang_bang(q0, q1, a_max, timing=how),
    ):
        law = made(call)
        if law is not None:
            check(law)
            meets(law, law.end, 0, np.array(q1))


@fuzz
@given(value(2), value(2), limit, limit, limit, timing)
def test_rest_to_rest(q0, q1, v_max, a_max, j_max, how):
    law = made(lambda: p.rest_to_rest(q0, q1, v_max=v_max, a_max=a_max, j_max=j_max, timing=how))
    if law is not None:
        check(law)
        meets(law, law.end, 0, np.array(q1))
        for derivative, bound in ((1, v_max), (2, a_max), (3, j_max)):
            found = law.extremes(derivative)
            worst = np.max(np.maximum(-found.low, found.high) - rounding(law, derivative))
            assert worst <= bound * (1 + 1e-9)


@fuzz
@given(ways(), st.sampled_from(["clamped", "natural", "periodic", "slope"]), number, number)
def test_via_cubics(way, method, first, last):
    points, durations = way
    ends = {"first": first, "last": last} if method in ("clamped", "slope") else {}
    velocities = made(lambda: p.via_velocities(points, durations, method, **ends))
    if velocities is None:
        return
    assert np.isfinite(velocities).all()
    law = made(lambda: p.via_cubics(points, durations, velocities))
    if law is not None:
        check(law)
        meets(law, law.start, 0, np.array(points[0]))
        meets(law, law.end, 0, np.array(points[-1]))


@fuzz
@given(ways(), limit, st.booleans(), st.none() | st.dictionaries(st.integers(-1, 5), number))
def test_blended_lines(way, acceleration, by_speed, through):
    points, durations = way
    how = {"speed": acceleration} if by_speed else {"durations": durations}
    law = made(lambda: p.blended_lines(points, acceleration=acceleration, through=through, **how))
    if law is not None:
        check(law)
        meets(law, law.start, 0, np.array(points[0]))


@fuzz
@given(value(2), value(2), value(2), duration, duration, duration)
def test_parabolic_blend(w0, w1, w2, before, after, half_width):
    law = made(lambda: p.parabolic_blend(w0, w1, w2, before, after, half_width))
    if law is not None:
        check(law)


@fuzz
@given(ways(), duration)
def test_quartic_transitions(way, t_acc):
    law = made(lambda: p.quartic_transitions(*way, t_acc))
    if law is not None:
        check(law)


@fuzz
@given(ways(14), duration, st.integers(0, 6), number)
def test_control_points(way, seconds, degree, t0):
    points, _ = way
    for call in (
        lambda: p.bezier(points, seconds, t0=t0),
        lambda: p.b_spline(points, seconds, degree=degree, t0=t0),
    ):
        law = made(call)
        if law is not None:
            check(law)
            meets(law, law.start, 0, np.array(points[0]))


@fuzz
@given(ways(), st.lists(number, max_size=12), st.integers(0, 6))
def test_b_spline_with_knots(way, knots, degree):
    law = made(lambda: p.b_spline(way[0], knots=sorted(knots, key=repr), degree=degree))
    if law is not None:
        check(law)


@fuzz
@given(ways(), st.integers(2, 6), number, number)
def test_b_spline_through(way, degree, v0, a1):
    law = made(lambda: p.b_spline_through(*way, degree=degree, v0=v0, a1=a1))
    if law is not None:
        check(law)


@fuzz
@given(duration, duration, timing, number)
def test_together_and_starting_at(first, second, how, t0):
    laws = [made(lambda s=s: p.quintic(0.0, 1.0, s)) for s in (first, second)]
    if None in laws:
        return
    law = made(lambda: p.together(laws, how).starting_at(t0))
    if law is not None:
        check(law)


@fuzz
@given(anything)
def test_times_outside_are_refused(t):
    law = p.cubic(0.0, 1.0, 2.0)
    if 0.0 <= t <= 2.0:
        assert np.isfinite(law.at(t)).all()
    elif math.isnan(t) or t < -1e-9 or t > 2.0 + 1e-9:
        with pytest.raises(vp.errors.BadArgumentError):
            law.at(t)
