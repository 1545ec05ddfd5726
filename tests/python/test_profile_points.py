"""Laws through several points: splines, task space, lines with blends, control points."""

from itertools import pairwise

import numpy as np
import pytest

import viapoint as vp


def test_blended_lines_at_speed_take_the_time_of_the_slowest_axis():
    points = [[0.0, 0.0], [1.0, 2.0], [3.0, 2.0]]
    law = vp.profile.blended_lines(points, speed=[1.0, 0.5], acceleration=[10.0, 20.0])
    assert law.durations == pytest.approx([2.0 / 0.5 + 0.5 * 0.5 / 20.0, 2.0 + 0.5 * 1.0 / 10.0])
    assert law.linear_velocity[0, 1] == pytest.approx(0.5)
    assert law.linear_velocity[1, 0] == pytest.approx(1.0)
    assert np.all(np.abs(law.linear_velocity) <= [1.0 + 1e-12, 0.5 + 1e-12])
    np.testing.assert_allclose(law.at(law.end).q, points[-1], atol=1e-12)
    assert law.blend_time.shape == (3, 2)


def test_an_acceleration_too_small_is_refused_with_the_least_that_works():
    with pytest.raises(vp.errors.BadArgumentError, match="at least") as refusal:
        vp.profile.blended_lines([10, 35, 25, 10], [2, 1, 3], acceleration=5)
    least = refusal.value.limit
    vp.profile.blended_lines([10, 35, 25, 10], [2, 1, 3], acceleration=least)
    with pytest.raises(vp.errors.BadArgumentError):
        vp.profile.blended_lines([10, 35, 25, 10], [2, 1, 3], acceleration=0.999 * least)


@pytest.mark.parametrize("method", ["clamped", "natural", "periodic"])
def test_splines_have_continuous_acceleration_over_any_durations(method):
    points = [[0.0, 1.0], [1.0, -1.0], [1.5, 0.5], [0.0, 0.0]]
    law = vp.profile.via_cubics(points, [1.0, 0.3, 2.2], method)
    for axis in range(2):
        parts = law.parts(axis)
        for before, after in pairwise(parts):
            c = before.coefficients
            at_end = 2 * c[2] + 6 * c[3] * (before.end - before.start)
            assert at_end == pytest.approx(2 * after.coefficients[2], abs=1e-11)
    ends = law.at([0.0, law.end])
    if method == "clamped":
        np.testing.assert_allclose(ends.qd, 0.0, atol=1e-12)
    elif method == "natural":
        np.testing.assert_allclose(ends.qdd, 0.0, atol=1e-11)
    else:
        np.testing.assert_allclose(ends.qd[0], ends.qd[1], atol=1e-12)
        np.testing.assert_allclose(ends.qdd[0], ends.qdd[1], atol=1e-11)


def test_end_velocities_can_differ_by_axis():
    points = [[0.0, 1.0], [1.0, -1.0], [1.5, 0.5]]
    velocities = vp.profile.via_velocities(points, [1.0, 1.0], first=[0.1, 0.2], last=-0.3)
    np.testing.assert_array_equal(velocities[[0, 2]], [[0.1, 0.2], [-0.3, -0.3]])


def test_tool_velocities_become_joint_velocities(puma, abc):
    points = np.array([abc["A"], abc["C"]])
    tool = np.array([[0.1, -0.2, 0.05, 0.3, 0.0, -0.1], [0.0, 0.0, 0.1, 0.0, 0.0, 0.0]])
    rates = vp.profile.joint_velocities(puma, points, tool)
    for q, qd, wanted in zip(points, rates, tool, strict=True):
        np.testing.assert_allclose(puma.jacobian(q) @ qd, wanted, atol=1e-12)


def test_a_tool_velocity_at_a_singular_point_is_refused_by_name(puma, abc):
    wrist = abc["A"].copy()
    wrist[4] = 0.0
    with pytest.raises(vp.errors.SingularError, match="point 1 is at the wrist singularity"):
        vp.profile.joint_velocities(puma, [abc["A"], wrist], np.zeros((2, 6)))
    arm = vp.load_robot("two_link")
    with pytest.raises(vp.errors.SingularError, match="point 0"):
        vp.profile.joint_velocities(arm, [[0.4, 0.0]], [[0.0, 1.0, 0.0]])


def test_a_tool_velocity_that_an_arm_cannot_make_is_refused():
    arm = vp.load_robot("two_link")
    with pytest.raises(vp.errors.UncontrolledError, match="2 joints"):
        vp.profile.joint_velocities(arm, [[0.4, 1.0]], [[0.0, 1.0, 0.5]])
    with pytest.raises(vp.errors.UncontrolledError):
        vp.profile.joint_velocities(arm, [[0.4, 1.0]], [[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]])


def test_an_arm_of_seven_joints_moves_with_the_least_joint_velocity():
    arm = vp.load_robot("panda")
    q = np.array([0.1, 0.4, -0.2, -1.5, 0.3, 1.8, 0.5])
    tool = np.array([0.1, 0.0, -0.05, 0.2, 0.0, 0.1])
    rates = vp.profile.joint_velocities(arm, [q], [tool])[0]
    np.testing.assert_allclose(arm.jacobian(q) @ rates, tool, atol=1e-12)
    null = np.linalg.svd(arm.jacobian(q))[2][6]
    assert abs(null @ rates) < 1e-12


def test_through_points_are_gone_through_exactly():
    points = [[10.0, 0.0], [35.0, 5.0], [25.0, 9.0], [10.0, 0.0]]
    through = {1: None, 2: [-12.0, 1.0]}
    law = vp.profile.blended_lines(points, [2.0, 1.0, 3.0], acceleration=200.0, through=through)
    heuristic = vp.profile.via_velocities(points, [2.0, 1.0, 3.0], "slope")[1]
    for t, q, qd in ((2.0, points[1], heuristic), (3.0, points[2], [-12.0, 1.0])):
        np.testing.assert_allclose(law.at(t).q, q, atol=1e-10)
        np.testing.assert_allclose(law.at(t).qd, qd, atol=1e-10)
        np.testing.assert_allclose(law.at(t).qdd, 0.0)  # on the linear part
    assert law.points.shape == (6, 2)
    np.testing.assert_allclose(law.point_times, [0.0, 1.75, 2.25, 2.75, 3.25, 6.0])
    wider = vp.profile.blended_lines(
        points, [2.0, 1.0, 3.0], acceleration=200.0, through={1: None}, half_gap=0.4
    )
    np.testing.assert_allclose(wider.point_times, [0.0, 1.6, 2.4, 3.0, 6.0])


def axis_refused(points, speed, acceleration):
    try:
        vp.profile.blended_lines(points, speed=speed, acceleration=acceleration)
    except vp.errors.BadArgumentError as error:
        return error.joint
    return None


def test_at_a_speed_the_least_acceleration_named_is_the_one_that_works():
    """Durations follow from the acceleration, too: at fixed ones another would do."""
    random = np.random.default_rng(11)
    refused = 0
    for trial in range(300):
        points = random.uniform(-3.0, 3.0, (random.integers(3, 6), 2))
        speed = random.uniform(0.5, 3.0, 2)
        ends = np.abs(np.diff(points, axis=0))[[0, -1]].min(axis=0)
        start = 1.001 * np.max(speed**2 / (2.0 * ends))  # the ends just reach their speeds
        try:
            vp.profile.blended_lines(points, speed=speed, acceleration=start)
        except vp.errors.BadArgumentError as error:
            if not error.value == start < error.limit:
                continue  # the speed is not reached in an end segment
            refused += 1
            least = np.full(2, start)
            least[error.joint] = error.limit
            for factor, works in ((1.0 + 1e-9, True), (1.0 - 1e-6, False)):
                tried = least.copy()
                tried[error.joint] *= factor
                refused_again = axis_refused(points, speed, tried) == error.joint
                assert refused_again != works, (trial, factor)
    assert refused > 50


def test_control_points_draw_laws():
    control = [[0.0, 1.0], [0.5, 2.0], [-1.0, 0.0], [1.0, 1.0], [2.0, 0.0]]
    curve = vp.profile.bezier(control, 2.0, t0=1.0)
    np.testing.assert_allclose(curve.at(1.0).qd, 4 / 2.0 * (np.array([0.5, 2.0]) - [0.0, 1.0]))
    spline = vp.profile.b_spline(control, 2.0, degree=3, t0=1.0)
    by_knots = vp.profile.b_spline(control, knots=[1, 1, 1, 1, 2, 3, 3, 3, 3], degree=3)
    times = np.linspace(1.0, 3.0, 21)
    np.testing.assert_allclose(spline.at(times).q, by_knots.at(times).q, atol=1e-14)
    for law in (curve, spline):
        np.testing.assert_allclose(law.at([1.0, 3.0]).q, [control[0], control[-1]], atol=1e-12)


def test_b_splines_through_points_reach_them_with_the_wanted_ends():
    points = [[0.0, 1.0], [1.0, -1.0], [1.5, 0.5], [0.0, 0.0]]
    law = vp.profile.b_spline_through(
        points, [1.0, 0.7, 1.2], v0=[0.5, 0.0], v1=-0.2, a0=1.0, a1=[0.0, 2.0]
    )
    np.testing.assert_allclose(law.at([0.0, 1.0, 1.7, 2.9]).q, points, atol=1e-11)
    ends = law.at([0.0, 2.9])
    np.testing.assert_allclose(ends.qd, [[0.5, 0.0], [-0.2, -0.2]], atol=1e-10)
    np.testing.assert_allclose(ends.qdd, [[1.0, 1.0], [0.0, 2.0]], atol=1e-9)
    cubic = vp.profile.b_spline_through(points, [1.0, 0.7, 1.2], degree=3)
    clamped = vp.profile.via_cubics(points, [1.0, 0.7, 1.2])
    times = np.linspace(0.0, 2.9, 50)
    np.testing.assert_allclose(cubic.at(times).q, clamped.at(times).q, atol=1e-12)
