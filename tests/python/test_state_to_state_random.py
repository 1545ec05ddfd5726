"""state_to_state on anything: a named error or a right answer, never NaN, never a hang."""

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

import viapoint as vp

steady = settings(derandomize=True, deadline=None, max_examples=400)

anything = st.one_of(
    st.floats(),
    st.floats(-10.0, 10.0),
    st.sampled_from(
        [0.0, -0.0, 5e-324, -5e-324, 2.2e-308, 1e-15, 1e15, 1e300, -1e308, math.inf, math.nan]
    ),
)
sane = st.floats(-10.0, 10.0)
limit = st.floats(1e-3, 1e3)
# Mostly what can be, so that the rest is not always refused for another reason.
state_of_any_kind = st.one_of(st.just(0.0), sane, sane, st.floats(-1e-9, 1e-9), anything)
limit_of_any_kind = st.one_of(limit, limit, limit, limit, st.floats(1e-12, 1e12), anything)
minimum_of_any_kind = limit_of_any_kind.map(lambda value: -value)


def values(of):
    return st.one_of(of, of, st.lists(of, min_size=2, max_size=2))


states = ("q0", "q1", "v0", "a0", "v1", "a1")
limits = ("v_max", "a_max", "j_max", "v_min", "a_min", "j_min")
extras = {
    "sync": st.sampled_from(["time", "line", "none", None]),
    "least_duration": st.one_of(st.none(), st.floats(1e-9, 100.0)),
    "cycle": st.one_of(st.none(), st.floats(1e-3, 1.0)),
}


def must_be_right(motion, arguments):
    """Hold a motion against what was asked for, from its phases alone."""
    shape = motion.shape
    joints = shape[0] if shape else 1

    def column(name, otherwise=None):
        value = arguments.get(name)
        value = otherwise if value is None else value
        return np.broadcast_to(np.asarray(value, dtype=float), (joints,))

    assert math.isfinite(motion.duration)
    assert motion.duration >= 0.0
    found = [motion.extremes(derivative) for derivative in range(4)]
    for extremes in found:
        assert all(np.isfinite(value).all() for value in extremes)
        assert (extremes.low <= extremes.high).all()
    clock = 1e-15 * motion.duration  # what the times of phases are rounded by
    for joint in range(joints):
        start = [column(name, 0.0)[joint] for name in ("q0", "v0", "a0")]
        end = [column(name, 0.0)[joint] for name in ("q1", "v1", "a1")]
        high = [column(name)[joint] for name in ("v_max", "a_max", "j_max")]
        low = [
            -high[k] if arguments.get(name) is None else column(name)[joint]
            for k, name in enumerate(("v_min", "a_min", "j_min"))
        ]
        rest = start[2] ** 2 / 2 / min(high[2], -low[2])
        held = low[1] <= start[2] <= high[1] and (
            low[0] <= start[1] - rest and start[1] + rest <= high[0]
        )
        for k in range(3) if held else (2,):
            slack = 1e-8 * (high[k] - low[k])
            assert np.ravel(found[k + 1].low)[joint] >= low[k] - slack
            assert np.ravel(found[k + 1].high)[joint] <= high[k] + slack

        for sign, name, of in ((1.0, "p_max", found[0].high), (-1.0, "p_min", found[0].low)):
            goes_on = end[1] != 0.0 and motion.durations.reshape(-1)[joint] < motion.duration
            if not goes_on and sign * start[0] <= sign * arguments.get(name, sign * math.inf):
                beyond = sign * (of.ravel()[joint] - arguments.get(name, sign * math.inf))
                assert beyond <= 1e-8 * (abs(found[0].high - found[0].low).max() + 1.0)

        here, rounding = start[0], 0.0
        size = abs(end[0] - start[0]) if arguments.get("q1") is not None else 0.0
        size = max(size, *(abs(value.ravel()[joint] - start[0]) for value in found[0][::2]))
        size += 1e-6 * abs(start[0]) + 1e-290  # denormals have fewer digits
        for part in motion.parts(joint):
            q, v, a, j = part.coefficients * [1.0, 1.0, 2.0, 6.0]
            assert np.isfinite(part.coefficients).all()
            span = part.end - part.start
            assert abs(q - here) <= 1e-7 * size + rounding
            rounding = clock * (abs(v) + (span + clock) * (abs(a) + (span + clock) * abs(j)))
            here = q + span * (v + span * (a / 2 + span * j / 6))
        if arguments.get("q1") is not None and motion.parts(joint):
            arrived = motion.durations.reshape(-1)[joint] == motion.duration
            assert not arrived or abs(here - end[0]) <= 1e-7 * size + rounding
        if motion.durations.reshape(-1)[joint] == motion.duration > 0.0:
            at_end = [np.ravel(value)[joint] for value in motion.at(motion.duration)[:3]]
            assert at_end[1:] == end[1:]
            assert at_end[0] == end[0] or arguments.get("q1") is None


def solve(arguments):
    try:
        return vp.profile.state_to_state(**arguments)
    except vp.errors.InternalError:
        raise
    except vp.MotionError:
        return None


@steady
@given(
    st.fixed_dictionaries(
        {
            **dict.fromkeys(("q0", "q1"), values(state_of_any_kind)),
            **dict.fromkeys(("v_max", "a_max", "j_max"), values(limit_of_any_kind)),
        },
        optional={
            **dict.fromkeys(("v0", "a0", "v1", "a1"), values(state_of_any_kind)),
            **dict.fromkeys(("v_min", "a_min", "j_min"), values(minimum_of_any_kind)),
            **extras,
        },
    )
)
def test_anything_gives_a_right_answer_or_a_named_error(arguments):
    motion = solve(arguments)
    if motion is not None:
        must_be_right(motion, arguments)


@steady
@given(
    st.fixed_dictionaries(
        {
            **{name: st.lists(sane, min_size=2, max_size=2) for name in states},
            **{name: st.lists(limit, min_size=2, max_size=2) for name in limits},
        },
        optional={**extras, "p_min": st.floats(-30.0, -10.0), "p_max": st.floats(10.0, 30.0)},
    )
)
def test_numbers_as_robots_have_them_give_a_right_answer(arguments):
    for name in ("v_min", "a_min", "j_min"):
        arguments[name] = [-value for value in arguments[name]]
    motion = solve(arguments)
    if motion is not None:
        must_be_right(motion, arguments)


@steady
@given(
    st.fixed_dictionaries(
        {
            "q0": state_of_any_kind,
            **dict.fromkeys(("v_max", "a_max", "j_max"), limit_of_any_kind),
        },
        optional={
            **dict.fromkeys(("v0", "a0", "v1", "a1"), state_of_any_kind),
            **dict.fromkeys(("v_min", "a_min", "j_min"), minimum_of_any_kind),
        },
    )
)
def test_velocity_targets_give_a_right_answer_or_a_named_error(arguments):
    motion = solve(arguments | {"q1": None})
    if motion is not None:
        must_be_right(motion, arguments | {"q1": None})
        end = motion.at(motion.duration)
        assert end.qd == arguments.get("v1", 0.0)
        assert end.qdd == arguments.get("a1", 0.0)


@steady
@given(values(st.one_of(anything, st.text(max_size=3), st.none(), st.booleans())))
def test_times_are_taken_or_refused_by_name(t):
    motion = vp.profile.state_to_state(0.0, 1.0, v_max=1.0, a_max=2.0, j_max=10.0)
    try:
        state = motion.at(t)
    except vp.errors.BadArgumentError:
        return
    assert all(np.isfinite(value).all() for value in state)
