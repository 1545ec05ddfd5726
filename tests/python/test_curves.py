"""Arcs, helices, screws, splines and fitted curves, from the builder to the planned path."""

import math

import numpy as np
import pytest

import viapoint as vp
from viapoint import deg, errors, mm

HOME = deg * [0, 25, 0, 15, 50, 10]


@pytest.fixture
def program(puma):
    return vp.Program(puma, start=HOME)


@pytest.fixture
def here(puma):
    return puma.fk(HOME)


def moved(pose, x=0.0, y=0.0, z=0.0):
    result = pose.copy()
    result[:3, 3] += [x, y, z]
    return result


def places(motion):
    return motion.sample(0.002).pose[:, :3, 3]


def nearest(motion, place):
    return np.linalg.norm(places(motion) - place, axis=1).min()


def test_an_arc_passes_its_points_and_keeps_its_circle(program, here):
    via, end = moved(here, 0.04, 0.04), moved(here, 0.0, 0.08)
    motion = program.movec(via, end).plan()
    centre = here[:3, 3] + [0, 0.04, 0]
    radii = np.linalg.norm(places(motion) - centre, axis=1)
    np.testing.assert_allclose(radii, 0.04, atol=5e-5)
    assert nearest(motion, via[:3, 3]) < 1e-3
    np.testing.assert_allclose(motion.sample(0.1).pose[-1], end, atol=1e-6)
    assert motion.certificate.path_deviation <= 5e-5


def test_a_via_point_may_be_a_position(program, here):
    via, end = moved(here, 0.04, 0.04), moved(here, 0.0, 0.08)
    motion = program.movec(via[:3, 3], end).plan()
    assert nearest(motion, via[:3, 3]) < 1e-3


def test_a_turn_about_an_axis_goes_round_more_than_once(program, here):
    centre = here[:3, 3] + [0.03, 0, 0]
    motion = program.movec(center=centre, axis=[0, 0, 1], angle=900 * deg, pitch=4 * mm).plan()
    np.testing.assert_allclose(places(motion)[-1], np.add(centre, [0.03, 0, 0.01]), atol=1e-6)
    np.testing.assert_allclose(motion.sample(0.1).pose[-1, :3, :3], here[:3, :3], atol=1e-6)


def test_a_screw_turns_and_travels_together(program, here):
    motion = program.screw(90 * deg, 10 * mm).plan()
    end = motion.sample(0.1).pose[-1]
    np.testing.assert_allclose(end[:3, 3], here[:3, 3] + 2.5 * mm * here[:3, 2], atol=1e-6)
    turned = here[:3, :3].T @ end[:3, :3]
    np.testing.assert_allclose(turned, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-5)


@pytest.mark.parametrize("kind", ["cubic", "quintic"])
def test_a_spline_passes_its_poses(program, here, kind):
    poses = [moved(here, 0.05, 0.05, 0.02), moved(here, 0, 0.12), moved(here, -0.05, 0.15, 0.03)]
    motion = program.spline(poses, kind=kind).plan()
    for pose in poses:
        assert nearest(motion, pose[:3, 3]) < 2e-3


def test_a_spline_by_control_points_ends_at_the_last(program, here):
    poses = [moved(here, 0.05), moved(here, 0.05, 0.08), moved(here, 0, 0.08)]
    for kind in ("bezier", "b_spline"):
        fresh = vp.Program(program.robot, start=HOME)
        motion = fresh.spline(poses, kind=kind).plan()
        np.testing.assert_allclose(places(motion)[-1], poses[-1][:3, 3], atol=1e-6)
        assert nearest(motion, poses[1][:3, 3]) > 5e-3


def test_joints_as_points_make_a_spline_of_the_joints(program):
    joints = [deg * [10, 30, 10, 0, 50, 30], deg * [40, 10, 20, -20, 60, 0]]
    motion = program.spline(joints).plan()
    q = motion.sample(0.001).q
    for point in joints:
        assert np.abs(q - point).max(axis=1).min() < 5e-3
    again = vp.Program(program.robot, start=HOME).spline(joints, space="tool", orientation="least")
    assert np.abs(again.plan().sample(0.1).q[-1] - joints[-1]).max() < 1e-3


def test_positions_leave_the_orientation_free():
    rpp = vp.load_robot("rpp")
    start = [0.3, 0.1, 0.4]
    at = rpp.fk(start)[:3, 3]
    motion = (
        vp.Program(rpp, start=start)
        .spline(positions=[np.add(at, [0.05, 0.02, 0.0]), np.add(at, [0.1, 0.0, 0.05])])
        .movec(
            center=np.add(at, [0.1, 0.03, 0.05]),
            axis=[1, 0, 0],
            angle=-360 * deg,
            orientation="free",
        )
        .plan()
    )
    np.testing.assert_allclose(places(motion)[-1], np.add(at, [0.1, 0.0, 0.05]), atol=1e-6)


def test_a_spinning_tool_keeps_its_axis_and_spares_the_last_joint(program, here):
    target = moved(here, 0.02, 0.06)
    spun = target.copy()
    spun[:3, :2] = target[:3, 1::-1] * [1, -1]  # a quarter turn about z
    motion = (
        program.movel(spun, orientation="spin")
        .movec(
            center=target[:3, 3] + [0.02, 0, 0],
            axis=[0, 0, 1],
            angle=360 * deg,
            orientation="spin",
        )
        .plan()
    )
    s = motion.sample(0.002)
    np.testing.assert_allclose(s.pose[-1, :3, 2], target[:3, 2], atol=1e-6)
    np.testing.assert_allclose(s.pose[-1, :3, 3], target[:3, 3], atol=1e-6)
    assert np.ptp(s.q[:, 5]) < 1e-6


def test_points_on_one_line_are_refused_with_the_way_out(program, here):
    program.movec(moved(here, 0.02), moved(here, 0.04))
    with pytest.raises(errors.DegenerateCurveError, match="one straight line") as caught:
        program.plan()
    assert caught.value.line is not None
    assert any("movel" in way for way in caught.value.ways_out)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({}, "Neither via and end nor all of center"),
        ({"end": np.eye(4)}, "end is given without via"),
        ({"via": [0.1, 0.2, 0.3]}, "Neither end nor position"),
        ({"via": [0.1, 0.2]}, r"via has the shape \(2,\)"),
        ({"via": np.eye(4), "end": np.eye(4), "angle": 1.0}, "together with"),
        ({"center": [0, 0, 0], "axis": [0, 0, 1]}, "all of center"),
        ({"center": [0, 0, 0], "axis": [0, 0], "angle": 1.0}, r"axis has the shape"),
        ({"center": [0, 0, 0], "axis": [0, 0, 1], "angle": math.nan}, "angle is nan"),
        (
            {"center": [0, 0, 0], "axis": [0, 0, 1], "angle": 1.0, "orientation": "least"},
            'must be one of "fixed"',
        ),
        ({"via": np.eye(4), "end": np.eye(4), "orientation": "up"}, "orientation is 'up'"),
    ],
)
def test_a_bad_arc_is_refused_at_once(program, arguments, says):
    with pytest.raises(errors.BadArgumentError, match=says):
        program.movec(**arguments)
    assert len(program) == 0


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({}, "points is None"),
        ({"points": []}, "points is empty"),
        ({"points": "abc"}, "points is 'abc'"),
        ({"points": [[1, 2]]}, r"points\[0\] has the shape"),
        ({"points": [np.eye(4)], "positions": [[0, 0, 0]]}, "Both points and positions"),
        ({"positions": [0, 0, 0]}, r"positions has the shape \(3,\)"),
        ({"points": [np.eye(4)], "kind": "round"}, "kind is 'round'"),
        ({"points": [np.eye(4)], "space": "outer"}, "space is 'outer'"),
    ],
)
def test_a_bad_spline_is_refused_at_once(program, arguments, says):
    with pytest.raises(errors.BadArgumentError, match=says):
        program.spline(**arguments)
    assert len(program) == 0


def test_curves_survive_their_file(program, here, tmp_path):
    program.movec(moved(here, 0.04, 0.04), moved(here, 0, 0.08), orientation="through", zone=5 * mm)
    program.movec(center=[0.1, 0.2, 0.3], axis=[0, 0, 1], angle=7.0, pitch=-0.01)
    program.screw(1.0, 0.002)
    program.spline([here, moved(here, 0.1)], kind="quintic", orientation="least", speed=0.1)
    program.save(tmp_path / "p.json")
    assert vp.Program.load(tmp_path / "p.json")._core.to_json() == program._core.to_json()


def knot(here, t):
    shape = [np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t) + 1, -np.sin(3 * t)]
    return moved(here, *(0.02 * np.array(shape)))


def test_a_function_is_fitted_and_followed(program, here):
    fit = vp.fit_curve(lambda t: knot(here, t), tolerance=1e-4, domain=(0, 2 * np.pi))
    assert fit.oriented
    assert 0 < fit.deviation <= 1e-4
    assert fit.looked_at == 8 * (len(fit.poses) - 1)
    assert fit.poses.shape == (len(fit.at), 4, 4)
    motion = program.spline(fit).plan()
    way = np.array([knot(here, t)[:3, 3] for t in np.linspace(0, 2 * np.pi, 20001)])
    for place in places(motion)[::20]:
        assert np.linalg.norm(way - place, axis=1).min() < 1e-4 + 5e-5 + 1e-5


def test_samples_are_fitted(program, here):
    samples = np.array([knot(here, t) for t in np.linspace(0, 2 * np.pi, 500)])
    fit = vp.fit_curve(samples, tolerance=1e-4)
    assert len(fit.poses) < 200
    assert fit.deviation <= 1e-4
    positions = vp.fit_curve(samples[:, :3, 3], tolerance=1e-4)
    assert not positions.oriented
    np.testing.assert_allclose(positions.at, fit.at)
    program.spline(fit).plan()


def test_a_fitted_curve_must_begin_where_the_arm_is(program, here):
    fit = vp.fit_curve(lambda t: knot(moved(here, 0.01), t), tolerance=1e-4, domain=(0, 6))
    with pytest.raises(errors.DiscontinuousError, match="from where the arm is") as caught:
        program.spline(fit).plan()
    assert any("movel" in way for way in caught.value.ways_out)


def test_a_jump_is_named_with_its_place(here):
    with pytest.raises(errors.DegenerateCurveError) as caught:
        vp.fit_curve(lambda t: moved(here, t, 0.01 * (t > 0.25)), tolerance=1e-4)
    assert caught.value.share == pytest.approx(0.25, abs=1e-3)


def test_what_a_function_returns_is_checked(here):
    with pytest.raises(errors.BadArgumentError, match="the curve at 1"):
        vp.fit_curve(lambda t: here if t < 1 else [0, 0], tolerance=1e-3)
    with pytest.raises(errors.BadArgumentError, match="tolerance"):
        vp.fit_curve(lambda t: here, tolerance=0)
    with pytest.raises(errors.BadArgumentError, match="curve has the shape"):
        vp.fit_curve(np.zeros((5, 2)), tolerance=1e-3)
    with pytest.raises(errors.BadArgumentError, match="same place"):
        vp.fit_curve(np.zeros((5, 3)), tolerance=1e-3)
    with pytest.raises(ZeroDivisionError):
        vp.fit_curve(lambda t: 1 / 0, tolerance=1e-3)
