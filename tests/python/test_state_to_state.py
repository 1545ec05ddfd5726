"""State to state from Python: shapes, synchronisation, velocity targets, and what is refused."""

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors

LIMITS = {"v_max": [1.0, 2.0, 3.0], "a_max": [4.0, 5.0, 6.0], "j_max": [30.0, 40.0, 50.0]}
START = np.array([0.1, -0.2, 0.3])
END = np.array([1.0, -1.5, 0.4])


def state_to_state(q0, q1, **options):
    return vp.profile.state_to_state(q0, q1, **(LIMITS | options))


def test_begins_and_ends_in_the_given_states():
    v0, a0, v1, a1 = [0.5, 0.0, -0.5], [1.0, -1.0, 0.0], [0.0, 0.3, -0.2], [0.5, 0.0, -0.5]
    motion = state_to_state(START, END, v0=v0, a0=a0, v1=v1, a1=a1)
    for t, state in ((0.0, (START, v0, a0)), (motion.duration, (END, v1, a1))):
        q, qd, qdd, qddd = motion.at(t)
        np.testing.assert_allclose(q, state[0], atol=1e-15)
        np.testing.assert_allclose(qd, state[1], atol=1e-15)
        np.testing.assert_allclose(qdd, state[2], atol=1e-15)
        assert qddd.shape == (3,)


def test_shapes_follow_time_and_joints():
    many = state_to_state(START, END)
    assert many.shape == (3,)
    assert many.durations.shape == (3,)
    assert many.at(0.1).q.shape == (3,)
    assert many.at([0.1, 0.2]).qddd.shape == (2, 3)
    assert many.at(np.empty(0)).q.shape == (0, 3)
    one = vp.profile.state_to_state(0.0, 1.0, v_max=1.0, a_max=2.0, j_max=10.0)
    assert one.shape == ()
    assert one.durations.shape == ()
    assert one.at(0.1).q.shape == ()
    assert one.at([0.1, 0.2]).q.shape == (2,)
    assert one.extremes(1).high == pytest.approx(1.0)


@pytest.mark.parametrize(
    "convert",
    [
        np.array,
        list,
        tuple,
        lambda x: np.array(x, dtype=np.float32).astype(float)[::-1][::-1],
        lambda x: np.array([x, x])[:, :].T[:, 0],
    ],
)
def test_any_array_of_numbers_is_taken(convert):
    q0, q1 = [0.0, 0.0], [1.0, -0.5]
    wanted = vp.profile.state_to_state(q0, q1, v_max=1.0, a_max=2.0, j_max=10.0)
    motion = vp.profile.state_to_state(
        convert(q0), convert(q1), v_max=convert([1.0, 1.0]), a_max=2, j_max=np.float64(10.0)
    )
    assert motion.duration == wanted.duration


def test_one_number_stands_for_all_joints():
    each = state_to_state(START, END, v_max=[2.0] * 3, j_max=[9.0] * 3, v0=[0.1] * 3)
    assert state_to_state(START, END, v_max=2.0, j_max=9.0, v0=0.1).duration == each.duration


def test_the_motion_does_not_change_with_the_arrays_it_was_made_from():
    q1 = END.copy()
    motion = state_to_state(START, q1)
    q1[:] = 99.0
    np.testing.assert_array_equal(motion.at(motion.duration).q, END)


def test_synchronised_joints_arrive_together_and_others_on_their_own():
    together = state_to_state(START, END)
    apart = state_to_state(START, END, sync="none")
    np.testing.assert_array_equal(together.durations, together.duration)
    assert apart.duration == together.duration
    assert sorted(apart.durations)[1] < apart.duration
    # Those that have arrived rest.
    first = int(np.argmin(apart.durations))
    after = apart.at(np.linspace(apart.durations[first], apart.duration, 9))
    np.testing.assert_allclose(after.q[:, first], END[first], atol=1e-15)
    assert not after.qd[:, first].any()


def test_a_joint_that_arrives_early_at_speed_goes_on_at_that_speed():
    motion = state_to_state(START, END, v1=[0.0, 0.0, 0.5], sync="none")
    early = motion.durations[2]
    assert early < motion.duration
    later = motion.at(motion.duration)
    assert later.qd[2] == 0.5
    assert later.q[2] == pytest.approx(END[2] + 0.5 * (motion.duration - early), abs=1e-14)
    assert motion.extremes(0).high[2] == pytest.approx(later.q[2], abs=1e-14)


def test_a_line_is_straight_and_holds_every_joint_within_its_limits():
    motion = state_to_state(START, END, v0=0.1 * (END - START), sync="line")
    q = motion.at(np.linspace(0.0, motion.duration, 101)).q
    share = (q - START) / (END - START)
    np.testing.assert_allclose(share, share[:, :1] * np.ones(3), atol=1e-13)
    for derivative, name in ((1, "v_max"), (2, "a_max"), (3, "j_max")):
        found = motion.extremes(derivative)
        largest = np.maximum(-found.low, found.high) / LIMITS[name]
        assert largest.max() <= 1.0 + 1e-12
    assert motion.duration >= state_to_state(START, END, v0=0.1 * (END - START)).duration


@pytest.mark.parametrize("name", ["v0", "a0", "v1", "a1"])
def test_no_straight_line_is_refused_and_not_replaced(name):
    with pytest.raises(errors.BadArgumentError, match="no straight line") as caught:
        state_to_state(START, END, sync="line", **{name: [0.3, 0.0, 0.0]})
    assert caught.value.joint is not None
    assert any('sync="time"' in way for way in caught.value.ways_out)


def test_limits_differ_by_direction():
    limits = {"v_min": -0.5, "a_min": -1.0, "j_min": -5.0}
    motion = vp.profile.state_to_state(
        [0.0, 0.0], [2.0, -2.0], v_max=1.0, a_max=2.0, j_max=10.0, sync="none", **limits
    )
    for derivative, (low, high) in enumerate([(-0.5, 1.0), (-1.0, 2.0), (-5.0, 10.0)], start=1):
        found = motion.extremes(derivative)
        assert found.low.min() == pytest.approx(low, rel=1e-12)
        assert found.high.max() == pytest.approx(high, rel=1e-12)


def test_a_start_outside_its_limits_comes_back_in():
    motion = vp.profile.state_to_state(0.0, 5.0, v0=2.0, a0=1.0, v_max=1.0, a_max=2.0, j_max=10.0)
    qd = motion.at(np.linspace(0.0, motion.duration, 1001)).qd
    inside = np.flatnonzero(qd <= 1.0 + 1e-12)[0]
    assert qd[inside:].max() <= 1.0 + 1e-12
    # It is not made faster on its way than its acceleration makes it.
    assert qd.max() <= 2.0 + 1.0**2 / (2.0 * 10.0) + 1e-12


def test_durations_are_whole_cycles_and_at_least_what_was_asked_for():
    plain = state_to_state(START, END)
    rounded = state_to_state(START, END, cycle=0.002)
    assert 0.0 <= rounded.duration - plain.duration < 0.002
    assert rounded.duration / 0.002 == pytest.approx(round(rounded.duration / 0.002), abs=1e-9)
    assert state_to_state(START, END, least_duration=3.0).duration == 3.0
    assert state_to_state(START, END, least_duration=0.1).duration == plain.duration


def test_a_velocity_target_leaves_the_position_open():
    motion = state_to_state(START, None, v0=[0.5, 0.0, -1.0], a0=1.0, v1=[0.0, 1.0, 1.0])
    end = motion.at(motion.duration)
    np.testing.assert_allclose(end.qd, [0.0, 1.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(end.qdd, 0.0, atol=1e-12)
    # Rest to speed under jerk and acceleration limits takes v/a + a/j.
    alone = vp.profile.state_to_state(0.0, None, v1=3.0, v_max=3.0, a_max=2.0, j_max=10.0)
    assert alone.duration == pytest.approx(3.0 / 2.0 + 2.0 / 10.0, rel=1e-12)
    for options in ({"sync": "time"}, {"sync": "line"}, {"cycle": 0.002}, {"p_max": 9.0}):
        with pytest.raises(errors.BadArgumentError, match="q1 is None"):
            state_to_state(START, None, **options)


def test_position_limits_hold_on_the_way():
    # 0.7 m/s within 0.08 m takes a run-up of 0.0767 m.
    run_up = {"v1": 0.7, "v_max": 1.0, "a_max": 2.0, "j_max": 20.0}
    motion = vp.profile.state_to_state(0.0, 0.08, p_min=-0.08, p_max=0.1, **run_up)
    assert -0.08 <= motion.extremes(0).low < -0.07
    with pytest.raises(errors.JointLimitError, match=r"v1 is 0\.7.*-0\.07 to 0\.1"):
        vp.profile.state_to_state(0.0, 0.08, p_min=-0.07, p_max=0.1, **run_up)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"p_max": [0.9, 9.0, 9.0]}, r"q1\[0\] is 1; p_min to p_max is -inf to 0\.9"),
        ({"v0": [1.0, 0.0, 0.0], "p_max": [0.11, 9, 9], "q1": [0.1, 0, 0]}, r"v0\[0\] is 1.*0\.11"),
    ],
)
def test_position_limits_that_cannot_be_held_are_named(options, words):
    with pytest.raises(errors.JointLimitError, match=words):
        state_to_state(START, **({"q1": END} | options))


def test_extremes_are_those_of_a_dense_sampling_and_not_less():
    motion = state_to_state(START, END, v0=[0.9, -1.9, 2.0], v1=[-0.5, 0.5, 1.0])
    times = np.linspace(0.0, motion.duration, 20001)
    for derivative, samples in enumerate(motion.at(times)):
        found = motion.extremes(derivative)
        assert (found.high >= samples.max(axis=0) - 1e-12).all()
        assert (found.low <= samples.min(axis=0) + 1e-12).all()
        if derivative < 3:
            for joint in range(3):
                high = motion.at(found.high_time[joint])[derivative][joint]
                assert high == pytest.approx(found.high[joint], abs=1e-12)


def test_knots_are_where_the_jerk_changes():
    motion = state_to_state(START, END)
    for joint in range(3):
        knots = motion.knots(joint)
        assert knots[0] == 0.0
        assert knots[-1] == motion.duration
        middles = (knots[:-1] + knots[1:]) / 2
        np.testing.assert_allclose(
            motion.at(middles).qddd[:, joint],
            [6.0 * part.coefficients[3] for part in motion.parts(joint)],
            rtol=1e-15,
        )
    assert set(motion.knots()) >= set(motion.knots(1))


def test_samples_end_with_the_exact_end():
    motion = state_to_state(START, END)
    samples = motion.sample(0.01)
    np.testing.assert_allclose(np.diff(samples.t)[:-1], 0.01, rtol=1e-9)
    assert samples.t[-1] == motion.duration
    assert samples.q.shape == (len(samples.t), 3)
    np.testing.assert_array_equal(samples.q[-1], END)
    with pytest.raises(errors.BadArgumentError, match="samples"):
        motion.sample(1e-12)
    with pytest.raises(errors.BadArgumentError, match="dt"):
        motion.sample(0.0)


def test_nothing_to_do_takes_no_time():
    motion = state_to_state(START, START)
    assert motion.duration == 0.0
    np.testing.assert_array_equal(motion.at(0.0).q, START)
    np.testing.assert_array_equal(motion.extremes(0).high, START)
    np.testing.assert_array_equal(motion.knots(), [0.0])
    assert motion.parts(0) == []
    assert len(motion.sample(0.1).t) == 1


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"v0": [0.0, np.nan, 0.0]}, errors.BadArgumentError, r"v0\[1\] is nan.*finite"),
        ({"q1": [1.0, np.inf, 0.0]}, errors.BadArgumentError, r"q1\[1\] is inf.*finite"),
        ({"v_max": [1.0, 0.0, 1.0]}, errors.BadLimitsError, r"v_max\[1\] is 0.*above 0"),
        ({"j_max": np.nan}, errors.BadLimitsError, r"j_max\[0\] is nan.*above 0"),
        ({"a_max": np.inf}, errors.BadLimitsError, r"a_max\[0\] is inf.*finite"),
        ({"a_max": 5e-324}, errors.BadLimitsError, r"a_max\[0\] is 4\.94.*1e-30 to 1e\+30"),
        ({"q0": 1e200}, errors.BadArgumentError, r"q0\[0\] is 1e\+200.*1e\+30"),
        ({"v_min": 0.5}, errors.BadLimitsError, r"v_min\[0\] is 0\.5.*below 0"),
        ({"v_max": -1.0, "v_min": 1.0}, errors.BadLimitsError, r"v_max\[0\] is -1"),
        ({"p_min": 3.0, "p_max": 2.0}, errors.BadLimitsError, r"p_min\[0\] is 3.*above p_max"),
        ({"p_min": np.nan}, errors.BadLimitsError, r"p_min\[0\] is nan"),
        ({"v1": [0.0, 2.5, 0.0]}, errors.VelocityLimitError, r"v1\[1\] is 2\.5.*-2 to 2"),
        ({"a1": [0.0, 0.0, -7.0]}, errors.AccelerationLimitError, r"a1\[2\] is -7.*-6 to 6"),
        ({"v1": -1.0, "a1": [1, 0, 0]}, errors.VelocityLimitError, r"a1\[0\] is 1.*before"),
        ({"v0": [0.0, 0.0]}, errors.BadArgumentError, "v0 has 2 values, q0 has 3"),
        ({"v0": np.zeros((3, 1))}, errors.BadArgumentError, "v0 has 2 dimensions"),
        ({"v0": []}, errors.BadArgumentError, "v0 has 0 values"),
        ({"v0": "fast"}, errors.BadArgumentError, "v0 is 'fast'.*numbers"),
        ({"v0": [1j, 0, 0]}, errors.BadArgumentError, "numbers"),
        ({"v0": [[1], [2, 3]]}, errors.BadArgumentError, "v0 is"),
        ({"sync": "phase"}, errors.BadArgumentError, '''sync is 'phase'.*"line"'''),
        ({"least_duration": -1.0}, errors.BadArgumentError, "least_duration is -1"),
        ({"least_duration": np.nan}, errors.BadArgumentError, "least_duration is nan"),
        ({"least_duration": [1.0, 2.0]}, errors.BadArgumentError, "least_duration is .*one"),
        ({"cycle": 0.0}, errors.BadArgumentError, "cycle is 0"),
        ({"cycle": "2 ms"}, errors.BadArgumentError, "cycle is '2 ms'"),
        ({"sync": 3}, errors.BadArgumentError, "sync is 3"),
        ({"q0": np.zeros(17)}, errors.BadArgumentError, "q0 has 17 values; allowed are 1 to 16"),
    ],
)
def test_what_is_wrong_is_named(options, error, words):
    given = {"q0": START, "q1": END} | options
    with pytest.raises(error, match=words):
        state_to_state(given.pop("q0"), given.pop("q1"), **given)


def test_errors_carry_joint_value_limit_and_a_way_out():
    with pytest.raises(errors.VelocityLimitError) as caught:
        state_to_state(START, END, v1=[0.0, 2.5, 0.0])
    error = caught.value
    assert (error.joint, error.value, error.limit) == (1, 2.5, 2.0)
    assert error.ways_out
    with pytest.raises(errors.VelocityLimitError) as caught:
        vp.profile.state_to_state(0.0, 1.0, v1=2.0, v_max=1.0, a_max=1.0, j_max=1.0)
    assert caught.value.joint is None
    assert caught.value.message.startswith("v1 is 2;")


def test_numbers_that_doubles_cannot_hold_together_are_refused():
    with pytest.raises(errors.BadArgumentError, match="double precision"):
        vp.profile.state_to_state(0.0, 0.0, a0=11137764.0, v_max=1.0, a_max=2.0, j_max=1e-3)


@pytest.mark.parametrize("t", [-0.01, 9.0, np.nan, [0.0, np.inf]])
def test_times_outside_are_refused(t):
    with pytest.raises(errors.BadArgumentError):
        state_to_state(START, END).at(t)


@pytest.mark.parametrize("joint", [-1, 3])
def test_joints_that_are_not_there_are_refused(joint):
    with pytest.raises(errors.BadArgumentError, match="from 0 to 2"):
        state_to_state(START, END).parts(joint)


def test_a_robots_limits_are_given_as_they_are(puma):
    home = np.zeros(6)
    limits = puma.limits
    motion = vp.profile.state_to_state(
        home, home + 0.3, v_max=limits.velocity, a_max=limits.acceleration, j_max=limits.jerk
    )
    assert motion.shape == (6,)


def test_hard_cases_known_from_elsewhere():
    # Residuals of rounding, moves of hours, limits from 1e-6 to 1e9.
    tiny = vp.profile.state_to_state(
        0.3, 0.3 + 1e-15, v0=1e-15, a0=-1e-15, v_max=1.0, a_max=2.0, j_max=10.0
    )
    assert tiny.duration < 1e-4
    long = vp.profile.state_to_state(0.0, 1e4, v_max=1.0, a_max=1.0, j_max=1.0)
    assert long.duration == pytest.approx(1e4 + 2.0, rel=1e-12)
    mixed = vp.profile.state_to_state(0.0, 1.0, v_max=1e9, a_max=1e-6, j_max=1e3)
    assert mixed.duration == pytest.approx(2.0 * np.sqrt(1.0 / 1e-6), rel=1e-6)


def test_a_lowered_velocity_limit_never_reverses_the_motion():
    state = (0.0, 0.0, 0.0)
    at_speed = vp.profile.state_to_state(state[0], 5.0, v_max=2.0, a_max=4.0, j_max=30.0)
    q, qd, qdd, _ = at_speed.at(1.0)
    slower = vp.profile.state_to_state(q, 5.0, v0=qd, a0=qdd, v_max=0.3, a_max=4.0, j_max=30.0)
    assert slower.extremes(1).low >= -1e-12
    assert slower.extremes(0).high <= 5.0 + 1e-12


def test_a_motion_is_drawn_with_what_was_asked_for(tmp_path):
    motion = state_to_state(START, END, v0=[0.5, 0.0, -0.5], v1=[0.0, 0.3, 0.0], sync="none")
    assert (motion.start, motion.end) == (0.0, motion.duration)
    motion.plot(
        tmp_path / "motion.png",
        title="a motion",
        unit="m",
        names=["a", "b", "c"],
        limits={"velocity": 3.0},
    )
    assert (tmp_path / "motion.png").stat().st_size > 10_000
    for wrong in ({"names": ["a", "b"]}, {"limits": {"speed": 1.0}}):
        with pytest.raises(errors.BadArgumentError):
            motion.plot(tmp_path / "wrong.png", **wrong)
    with pytest.raises(errors.BadArgumentError, match="nothing moves"):
        state_to_state(START, START).plot(tmp_path / "rest.png")
