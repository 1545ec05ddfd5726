"""The laws of `viapoint.profile`: golden values, shapes, and what they refuse."""

import json
from pathlib import Path

import numpy as np
import pytest

import viapoint as vp

GOLDEN = json.loads((Path(__file__).parents[1] / "data" / "golden.json").read_text())


def coefficients(law, axis=0, part=0):
    return law.parts(axis)[part].coefficients


def padded(values):
    return np.array(values + [0.0] * (6 - len(values)))


def test_golden_textbook_section_1_cubic():
    law = vp.profile.cubic(10.0, -20.0, 1.0)
    wanted = padded(GOLDEN["cubic_10_to_-20_deg_1s"]["coeffs"])
    np.testing.assert_allclose(coefficients(law), wanted, atol=1e-12)


@pytest.mark.parametrize(
    ("key", "q1", "duration"),
    [("quintic_0_to_40_deg_2s", 40.0, 2.0), ("quintic_0_to_1_rad_5s", 1.0, 5.0)],
)
def test_golden_textbook_section_1_quintic(key, q1, duration):
    law = vp.profile.quintic(0.0, q1, duration)
    np.testing.assert_allclose(coefficients(law), padded(GOLDEN[key]["coeffs"]), atol=1e-12)


@pytest.mark.parametrize(
    ("key", "duration"), [("quintic_0_to_1_v0_5_tf_1", 1.0), ("quintic_0_to_1_v0_5_tf_5", 5.0)]
)
def test_golden_textbook_section_1_quintic_overshoot_is_found(key, duration):
    law = vp.profile.quintic(0.0, 1.0, duration, v0=5.0)
    found = law.extremes()
    assert found.high == pytest.approx(GOLDEN[key]["peak"], abs=1e-11)
    assert found.high_time == pytest.approx(GOLDEN[key]["t_peak"], abs=1e-5)


def test_golden_textbook_section_1_lspb():
    golden = GOLDEN["lspb_0_to_1_18s"]
    by_time = vp.profile.lspb(0.0, 1.0, 18.0, blend_time=6.0)
    assert by_time.velocity == pytest.approx(golden["tb_6_gives_V"], abs=1e-15)
    for velocity, key in ((0.06, "V_0_06_tb"), (0.11, "V_0_11_tb")):
        law = vp.profile.lspb(0.0, 1.0, 18.0, velocity=velocity)
        assert law.blend_time == pytest.approx(golden[key], abs=1e-12)
    assert vp.profile.lspb(0.0, 1.0, 18.0).blend_time == 6.0
    with pytest.raises(vp.errors.BadArgumentError, match=r"0\.05555556 .* 0\.1111111"):
        vp.profile.lspb(0.0, 1.0, 18.0, velocity=0.02)


def test_golden_textbook_section_1_bang_bang():
    law = vp.profile.bang_bang(0.0, 1.0, 4.0)
    golden = GOLDEN["bang_bang_0_to_1_a_4"]
    assert law.blend_time == golden["ts"]
    assert law.duration == golden["tf"]
    assert law.extremes(1).high == golden["v_peak"]


@pytest.mark.parametrize(
    ("key", "points", "durations"),
    [
        ("two_cubics_via_5_15_40_equal_1s", [5, 15, 40], [1, 1]),
        ("two_cubics_via_5_15_-10_1s_2s", [5, 15, -10], [1, 2]),
    ],
)
def test_golden_textbook_section_2_two_cubics(key, points, durations):
    law = vp.profile.via_cubics(points, durations)
    for part, name in enumerate(("first", "second")):
        wanted = padded(GOLDEN[key][name])
        np.testing.assert_allclose(coefficients(law, part=part), wanted, atol=1e-12)


def test_golden_textbook_section_2_blended_lines():
    law = vp.profile.blended_lines([10, 35, 25, 10], [2, 1, 3], acceleration=50)
    golden = GOLDEN["lfpb_10_35_25_10_durations_2_1_3_acc_50"]
    np.testing.assert_allclose(law.blend_acceleration, golden["blend_acc"], atol=1e-11)
    np.testing.assert_allclose(law.blend_time, golden["blend_time"], atol=1e-11)
    np.testing.assert_allclose(law.linear_velocity, golden["linear_velocity"], atol=1e-11)
    np.testing.assert_allclose(law.linear_time, golden["linear_time"], atol=1e-11)


def test_golden_textbook_section_3_joint_move():
    puma = GOLDEN["puma560"]
    points = [puma["joints_deg"][name] for name in "ABC"]
    law = vp.profile.quartic_transitions(points, [0.5, 0.5], 0.2)
    rows = puma["joint_move_deg"]
    state = law.at([row["t"] + 0.5 for row in rows])
    assert state.q.shape == (9, 6)
    np.testing.assert_allclose(state.q, [row["q"] for row in rows], atol=1e-10)
    np.testing.assert_allclose(state.qd, [row["qd"] for row in rows], atol=1e-10)
    np.testing.assert_allclose(state.qdd, [row["qdd"] for row in rows], atol=1e-9)


def test_shapes_follow_those_of_the_boundary_values_and_of_the_times():
    times = np.linspace(0.0, 2.0, 5)
    one = vp.profile.quintic(0.0, 1.0, 2.0)
    assert one.at(1.0).q.shape == ()
    assert one.at(times).qdd.shape == (5,)
    assert one.extremes().high.shape == ()
    several = vp.profile.quintic([0.0, 1.0, 2.0], 1.0, 2.0)
    assert several.at(1.0).q.shape == (3,)
    assert several.at(times).qddd.shape == (5, 3)
    assert several.extremes(1).low.shape == (3,)
    single = vp.profile.quintic([0.0], [1.0], 2.0)
    assert single.at(times).q.shape == (5, 1)
    assert several.at([]).q.shape == (0, 3)


def laws():
    points = [[0.0, 1.0], [1.0, -1.0], [1.5, 0.5], [0.0, 0.0]]
    yield vp.profile.cubic([0.0, 1.0], [2.0, 0.5], 1.5, v0=0.3, v1=[0.0, -1.0], t0=-4.0)
    yield vp.profile.quintic([0.0, 1.0], [2.0, 0.5], 1.5, v0=0.3, a1=[0.0, -1.0], t0=10.0)
    yield vp.profile.lspb([0.0, 1.0], [2.0, -1.0], 3.0)
    yield vp.profile.bang_bang(0.0, -2.0, 3.0)
    yield vp.profile.rest_to_rest(1.0, -2.0, v_max=1.0, a_max=2.0, j_max=10.0)
    yield vp.profile.via_cubics(points, [1.0, 0.7, 1.2])
    slopes = vp.profile.via_velocities(points, [1.0, 0.7, 1.2], "slope")
    yield vp.profile.via_cubics(points, [1.0, 0.7, 1.2], slopes)
    yield vp.profile.blended_lines(points, [1.0, 0.7, 1.2], acceleration=60.0)
    yield vp.profile.parabolic_blend([0.0, 1.0], [1.0, 0.0], [0.0, 0.0], 1.0, 0.8, 0.3)
    yield vp.profile.quartic_transitions(points, [1.0, 0.7, 1.2], 0.2)
    yield vp.profile.trapezoid([0.0, 1.0], [2.0, 0.5], v_max=1.0, a_max=3.0)
    moves = ([0.0, 1.0], [2.0, 0.5])
    yield vp.profile.rest_to_rest(*moves, v_max=1, a_max=3, j_max=20, timing="sequential")
    yield vp.profile.polynomial([(0.0, 0, 0.0), (0.5, 0, 1.0), (1.0, 1, 0.0), (2.0, 0, -1.0)])
    yield vp.profile.via_cubics(points, [1.0, 0.7, 1.2], "natural")
    yield vp.profile.via_cubics(points, [1.0, 0.7, 1.2], "periodic")
    yield vp.profile.blended_lines(points, [1.0, 0.7, 1.2], acceleration=90.0, through={1: None})
    yield vp.profile.bezier(points, 2.0)
    yield vp.profile.b_spline(points, 2.0, degree=2)
    yield vp.profile.b_spline_through(points, [1.0, 0.7, 1.2])


@pytest.mark.parametrize("law", list(laws()), ids=repr)
def test_derivatives_match_finite_differences(law):
    h = 1e-6
    times = np.linspace(law.start + 2 * h, law.end - 2 * h, 401)
    left, here, right = law.at(times - h), law.at(times), law.at(times + h)
    smooth = np.ones(here.q.shape, dtype=bool)
    for axis in range(here.q[0].size):
        for part in law.parts(axis):
            near = np.abs(times - part.start) < 2 * h
            smooth[near] = False
    assert smooth.mean() > 0.9
    for low, middle, high in zip(left[:3], here[1:], right[:3], strict=True):
        np.testing.assert_allclose((high - low)[smooth] / (2 * h), middle[smooth], atol=1e-6)


@pytest.mark.parametrize("law", list(laws()), ids=repr)
def test_extremes_bound_every_sample_and_are_reached(law):
    state = law.at(np.linspace(law.start, law.end, 2001))
    for derivative in range(3):
        found = law.extremes(derivative)
        values = state[derivative]
        scale = np.max(np.abs(values)) + 1e-12
        assert np.all(values.min(axis=0) >= found.low - 1e-12 * scale)
        assert np.all(values.max(axis=0) <= found.high + 1e-12 * scale)
        assert np.all(values.min(axis=0) <= found.low + 5e-3 * scale)
        assert np.all(values.max(axis=0) >= found.high - 5e-3 * scale)


def test_rest_to_rest_keeps_its_limits_and_arrives():
    random = np.random.default_rng(7)
    for _ in range(500):
        q0, q1 = random.uniform(-3.0, 3.0, 2)
        v, a, j = 10.0 ** random.uniform(-2.0, 3.0, 3)
        law = vp.profile.rest_to_rest(q0, q1, v_max=v, a_max=a, j_max=j)
        end = law.at(law.end)
        assert law.at(0.0).q == q0
        assert end.q == pytest.approx(q1, abs=1e-11)
        for derivative, limit in ((1, v), (2, a), (3, j)):
            found = law.extremes(derivative)
            assert max(-found.low, found.high) <= limit * (1 + 1e-10)


def test_a_refusal_of_one_axis_names_it():
    with pytest.raises(vp.errors.BadArgumentError, match="axis 1") as refusal:
        vp.profile.lspb([0.0, 0.0], 1.0, 18.0, velocity=[0.06, 0.02])
    assert refusal.value.joint == 1


def test_polynomial_of_the_conditions_of_a_quintic_is_the_quintic():
    conditions = [(1.0, 0, [0.0, 1.0]), (3.0, 0, [2.0, 0.5]), (1.0, 1, 0.3), (3.0, 1, 0.0)]
    law = vp.profile.polynomial([*conditions, (1.0, 2, -1.0), (3.0, 2, [0.0, 2.0])])
    quintic = vp.profile.quintic(
        [0.0, 1.0], [2.0, 0.5], 2.0, v0=0.3, a0=-1.0, a1=[0.0, 2.0], t0=1.0
    )
    for axis in range(2):
        np.testing.assert_allclose(coefficients(law, axis), coefficients(quintic, axis), atol=1e-12)


def test_polynomial_of_degree_seven_has_eight_coefficients():
    still = [(t, k, 0.0) for t in (0.0, 1.0) for k in (1, 2, 3)]
    law = vp.profile.polynomial([(0.0, 0, 0.0), (1.0, 0, 1.0), *still])
    np.testing.assert_allclose(coefficients(law), [0, 0, 0, 0, 35, -84, 70, -20], atol=1e-12)


@pytest.mark.parametrize("timing", ["synchronised", "simultaneous", "sequential"])
def test_axes_come_together_as_the_timing_says(timing):
    q0, q1, a = [0.0, 0.5, 1.0], [1.0, 0.5, 0.5], 2.0
    law = vp.profile.bang_bang(q0, q1, a, timing=timing)
    alone = [vp.profile.bang_bang(0.0, 1.0, a), None, vp.profile.bang_bang(1.0, 0.5, a)]
    total = alone[0].duration + (alone[2].duration if timing == "sequential" else 0.0)
    assert law.duration == pytest.approx(total)
    np.testing.assert_allclose(law.at(law.end).q, q1, atol=1e-12)
    assert np.all(law.at(np.linspace(0.0, law.end, 50)).q[:, 1] == 0.5)  # it rests
    assert law.blend_time[1] == law.velocity[1] == law.acceleration[1] == 0.0
    assert law.velocity[2] == pytest.approx(law.extremes(1).low[2])
    assert law.acceleration[2] == pytest.approx(law.extremes(2).low[2])
    share = alone[2].duration / total if timing == "synchronised" else 1.0
    assert law.extremes(2).low[2] == pytest.approx(-a * share**2)
    if timing == "sequential":
        assert np.all(law.at(0.5 * alone[0].duration).qd[1:] == 0.0)
        assert law.at(law.end - 0.5 * alone[2].duration).qd[0] == 0.0


def test_synchronised_laws_of_one_shape_make_a_straight_line():
    laws = [vp.profile.quintic(0.0, 1.0, 1.0), vp.profile.quintic(0.5, -0.5, 2.0)]
    law = vp.profile.together(laws)
    q = law.at(np.linspace(0.0, 2.0, 101)).q
    np.testing.assert_allclose(q[:, 1], 0.5 - q[:, 0], atol=1e-12)


def test_a_limit_of_an_axis_that_rests_is_checked_too():
    with pytest.raises(vp.errors.BadArgumentError, match="axis 1"):
        vp.profile.trapezoid([0.0, 1.0], [1.0, 1.0], v_max=[1.0, -1.0], a_max=1.0)


def test_a_law_can_begin_at_any_time():
    law = vp.profile.lspb([0.0, 1.0], [2.0, -1.0], 3.0).starting_at(-7.0)
    assert (law.start, law.end) == (-7.0, -4.0)
    np.testing.assert_allclose(law.at(-4.0).q, [2.0, -1.0], atol=1e-12)
    np.testing.assert_allclose(law.extremes(1).high_time[0], -6.0, atol=1e-12)


def test_a_law_is_drawn_with_what_was_asked_for(tmp_path):
    law = vp.profile.trapezoid([0.0, 1.0], [1.0, 0.5], v_max=1.0, a_max=2.0)
    law.plot(
        tmp_path / "law.png",
        title="Two axes",
        unit="m",
        names=["x", "y"],
        points=([0.0, law.end], [[0.0, 1.0], [1.0, 0.5]]),
        limits={"velocity": 1.0, "acceleration": 2.0},
    )
    assert (tmp_path / "law.png").stat().st_size > 10_000
    for wrong in (
        {"names": ["x"]},
        {"points": ([0.0], [[0.0]])},
        {"limits": {"speed": 1.0}},
        {"limits": {"velocity": -1.0}},
    ):
        with pytest.raises(vp.errors.BadArgumentError):
            law.plot(tmp_path / "wrong.png", **wrong)
    with pytest.raises(vp.errors.BadArgumentError, match=r"law\.txt"):
        law.plot("law.txt")


@pytest.mark.parametrize(
    "call",
    [
        lambda p: p.cubic(0.0, 1.0, 0.0),
        lambda p: p.polynomial([]),
        lambda p: p.polynomial(3.0),
        lambda p: p.polynomial([(0.0, 0)]),
        lambda p: p.polynomial([(0.0, 1, 0.0), (1.0, 1, 1.0)]),
        lambda p: p.polynomial([(0.0, 0, 0.0), (1.0, 4, 1.0)]),
        lambda p: p.polynomial([(0.0, 0, [0.0, 1.0]), (1.0, 0, [1.0, 2.0, 3.0])]),
        lambda p: p.trapezoid([0.0, 1.0], [0.0, 1.0], v_max=1.0, a_max=1.0),
        lambda p: p.trapezoid(0.0, 1.0, v_max=0.0, a_max=1.0),
        lambda p: p.trapezoid(0.0, 1.0, v_max=1.0, a_max=1.0, timing="together"),
        lambda p: p.together([]),
        lambda p: p.together([p.cubic([0.0, 1.0], 1.0, 1.0)]),
        lambda p: p.together([p.cubic(0.0, 1.0, 1.0), p.cubic(0.0, 1.0, 1.0, t0=1.0)]),
        lambda p: p.together([p.cubic(0, 1, 1.0, v1=1), p.cubic(0, 1, 2.0)], "simultaneous"),
        lambda p: p.cubic(0.0, 1.0, 1.0).starting_at(float("inf")),
        lambda p: p.cubic(0.0, 1.0, 1.0).parts(1),
        lambda p: p.via_velocities([0.0, 1.0], [1.0], "natural", first=1.0),
        lambda p: p.via_velocities([0.0, 1.0], [1.0], first=[1.0, 2.0]),
        lambda p: p.joint_velocities("arm", [[0.0]], [[0.0]]),
        lambda p: p.joint_velocities(vp.load_robot("two_link"), [[0.0]], [[0.0, 0.0, 0.0]]),
        lambda p: p.joint_velocities(vp.load_robot("two_link"), [[0.0, 1.0]], [[0.0, 0.0]]),
        lambda p: p.blended_lines([0, 1, 0], [1, 1], acceleration=50, through={0: None}),
        lambda p: p.blended_lines([0, 1, 0], [1, 1], acceleration=50, through=[1]),
        lambda p: p.blended_lines([0, 1, 0], [1, 1], acceleration=50, through={1: [0, 1]}),
        lambda p: p.blended_lines([0, 1], [1], acceleration=50, through={1: None}),
        lambda p: p.blended_lines([0, 1, 0], [1, 1], acceleration=50, through={1: 0}, half_gap=1),
        lambda p: p.bezier([0.0], 1.0),
        lambda p: p.bezier(np.zeros(13), 1.0),
        lambda p: p.b_spline([0.0, 1.0, 0.0], 1.0, degree=3),
        lambda p: p.b_spline([0.0, 1.0, 0.0, 1.0]),
        lambda p: p.b_spline([0.0, 1.0], knots=[0, 0, 1, 1], degree=1, t0=1.0),
        lambda p: p.b_spline_through([0.0, 1.0], [1.0], degree=4),
        lambda p: p.b_spline_through([0.0, 1.0], [1.0], degree=3, a0=1.0),
        lambda p: p.b_spline_through([0.0, 1.0], [1.0], v0=[1.0, 2.0]),
        lambda p: p.cubic(0.0, float("nan"), 1.0),
        lambda p: p.quintic([0.0, 1.0], [0.0, 1.0, 2.0], 1.0),
        lambda p: p.quintic([], [], 1.0),
        lambda p: p.quintic([[0.0]], 1.0, 1.0),
        lambda p: p.lspb(0.0, 1.0, 1.0, velocity=1.5, blend_time=0.2),
        lambda p: p.lspb(0.0, 1.0, 1.0, blend_time=0.6),
        lambda p: p.bang_bang(0.0, 1.0, -1.0),
        lambda p: p.bang_bang(1.0, 1.0, 1.0),
        lambda p: p.rest_to_rest(0.0, 0.0, v_max=1.0, a_max=1.0, j_max=1.0),
        lambda p: p.rest_to_rest(0.0, 1.0, v_max=1.0, a_max=0.0, j_max=1.0),
        lambda p: p.via_cubics([0.0, 1.0], [1.0, 1.0]),
        lambda p: p.via_cubics([0.0, 1.0], [1.0], [0.0]),
        lambda p: p.via_cubics([[0.0, 1.0], [1.0, 1.0]], [1.0], [0.0, 0.0]),
        lambda p: p.via_velocities([0.0, 1.0], [1.0], "guess"),
        lambda p: p.via_velocities([0.0], []),
        lambda p: p.blended_lines([0.0, 1.0], acceleration=1.0),
        lambda p: p.blended_lines([0.0, 1.0], [3.0], speed=1.0, acceleration=1.0),
        lambda p: p.blended_lines([0.0, 1.0], [3.0], acceleration=[1.0, 1.0, 1.0]),
        lambda p: p.blended_lines([0.0, 0.0], speed=1.0, acceleration=1.0),
        lambda p: p.parabolic_blend(0.0, 1.0, 0.0, 1.0, 1.0, 1.5),
        lambda p: p.quartic_transitions([0.0, 1.0, 0.0], [1.0, 1.0], 1.5),
        lambda p: p.cubic(0.0, 1.0, 1.0).at(1.1),
        lambda p: p.cubic(0.0, 1.0, 1.0).at([[0.1]]),
        lambda p: p.cubic(0.0, 1.0, 1.0).at(float("nan")),
        lambda p: p.cubic(0.0, 1.0, 1.0).extremes(4),
    ],
)
def test_what_cannot_be_is_refused(call):
    with pytest.raises(vp.errors.BadArgumentError):
        call(vp.profile)
