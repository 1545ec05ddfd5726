"""Sampling, certificates, virtual time, knots and pictures."""

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors, mm
from viapoint._proof_plot import draw_proof


@pytest.fixture(scope="module")
def motion(puma, abc):
    program = vp.Program(puma, start=abc["A"], name="abc")
    program.movej(abc["B"], zone=vp.joint_deviation(0.05)).set_do(1, True).movej(abc["C"])
    return program.plan()


def test_samples_have_their_shapes_and_the_exact_end(motion, abc):
    s = motion.sample(0.002)
    k = len(s)
    assert s.t.shape == (k,)
    for values in (s.q, s.qd, s.qdd, s.qddd):
        assert values.shape == (k, 6)
    assert s.pose.shape == (k, 4, 4)
    assert s.t[-1] == motion.duration
    assert s.t[1] == 0.002
    assert 0 < s.t[-1] - s.t[-2] <= 0.002 * (1 + 1e-9)
    np.testing.assert_allclose(s.q[0], abc["A"], atol=1e-12)
    np.testing.assert_allclose(s.q[-1], abc["C"], atol=1e-12)
    np.testing.assert_allclose(s.qd[[0, -1]], 0.0, atol=1e-9)


def test_a_step_that_divides_the_duration_has_no_sample_twice(motion):
    for count in (1, 3, 10, 997):
        s = motion.sample(motion.duration / count)
        assert len(s) == count + 1
        assert (np.diff(s.t) > 0).all()


def test_a_step_longer_than_the_motion_gives_its_ends(motion):
    s = motion.sample(100.0)
    np.testing.assert_array_equal(s.t, [0.0, motion.duration])


@pytest.mark.parametrize("dt", [0, -0.1, np.nan, np.inf, "1", None])
def test_a_bad_step_is_refused(motion, dt):
    with pytest.raises(errors.BadArgumentError, match="dt"):
        motion.sample(dt)


def test_a_step_for_more_samples_than_memory_is_refused(motion):
    with pytest.raises(errors.BadArgumentError, match="1e8"):
        motion.sample(1e-12)


def test_single_states_agree_with_the_batch(motion):
    s = motion.sample(0.01)
    again = motion.at(s.t)
    np.testing.assert_array_equal(again.q, s.q)
    np.testing.assert_array_equal(again.qddd, s.qddd)
    outside = motion.at([-1.0, motion.duration + 1.0])
    np.testing.assert_array_equal(outside.q, s.q[[0, -1]])


@pytest.mark.parametrize("times", [[1.0, 0.0], [0.0, np.nan]])
def test_times_that_do_not_ascend_are_refused(motion, times):
    with pytest.raises(errors.BadArgumentError, match="times"):
        motion.at(times)


def test_derivatives_agree_with_differences(motion):
    dt = 1e-5
    s = motion.sample(dt)
    for value, rate in ((s.q, s.qd), (s.qd, s.qdd)):
        slope = (value[2:-1] - value[:-3]) / (2 * dt)
        np.testing.assert_allclose(slope, rate[1:-2], atol=2e-2)


def test_tool_rates_agree_with_differences(motion):
    dt = 1e-4
    s = motion.sample(dt)
    slope = (s.pose[2:-1, :3, 3] - s.pose[:-3, :3, 3]) / (2 * dt)
    np.testing.assert_allclose(slope, s.twist[1:-2, :3], atol=1e-4)
    slope = (s.twist[2:-1] - s.twist[:-3]) / (2 * dt)
    np.testing.assert_allclose(slope, s.twist_rate[1:-2], atol=0.05)


def test_the_certificate_bounds_every_sample(motion):
    s = motion.sample(1e-4)
    c = motion.certificate
    limits = motion.robot.limits
    for name, values, limit in (
        ("velocity", s.qd, limits.velocity),
        ("acceleration", s.qdd, limits.acceleration),
        ("jerk", s.qddd, limits.jerk),
    ):
        share = getattr(c, f"{name}_share")
        assert (share <= 1 + 1e-6).all(), name
        seen = np.abs(values).max(axis=0) / limit
        assert (seen <= share * (1 + 1e-9) + 1e-12).all(), name
    assert c.holds
    assert (c.position_min <= s.q.min(axis=0) + 1e-9).all()


def test_sampling_does_not_loop_in_python(motion):
    import time

    begin = time.process_time()
    count = len(motion.sample(1e-5))
    seconds = time.process_time() - begin
    assert count > 1e5
    assert seconds < 2e-6 * count  # a Python loop takes several times as long


def test_simulate_follows_the_plan_at_full_rate(motion):
    s = vp.simulate(motion)
    at = motion.at(s.t)
    np.testing.assert_allclose(s.q, at.q, atol=1e-9)
    np.testing.assert_allclose(np.diff(s.t), 0.002, atol=1e-12)
    np.testing.assert_allclose(s.q[-1], motion.end, atol=1e-9)


def test_simulate_is_deterministic_and_keeps_the_limits(motion):
    commands = [(0.31, "override", 0.4), (0.5, "pause"), (0.9, "resume"), (1.2, "stop")]
    first, second = (vp.simulate(motion, commands) for _ in range(2))
    np.testing.assert_array_equal(first.q, second.q)
    limits = motion.robot.limits
    assert (np.abs(first.qd) <= limits.velocity * (1 + 1e-6)).all()
    assert (np.abs(first.qdd) <= limits.acceleration * (1 + 1e-6)).all()
    np.testing.assert_allclose(first.qd[-1], 0.0, atol=1e-9)
    assert np.abs(first.q[-1] - motion.end).max() > 0.01  # it was stopped before its end
    planned = motion.sample(1e-4).q
    for q in first.q[::25]:
        assert np.abs(planned - q).max(axis=1).min() < 1e-3  # on the path


@pytest.mark.parametrize(
    "command",
    [
        (0.1, "hop"),
        (-0.1, "pause"),
        (0.1, "override"),
        (0.1, "override", 1.5),
        (0.1, "pause", 0.5),
        ("now", "pause"),
        0.5,
    ],
)
def test_simulate_refuses_a_bad_command(motion, command):
    with pytest.raises(errors.BadArgumentError, match=r"commands\[0\]"):
        vp.simulate(motion, [command])


def test_certified_knots_keep_their_tolerance_and_taylors_may_not(puma, abc):
    pose0 = puma.fk(abc["A"])
    pose1 = puma.fk(abc["A"] + [0.3, -0.4, 0.3, 0.2, -0.2, 0.1])
    certified = vp.insert_knots(puma, pose0, pose1, position=1e-4, angle=1e-3, near=abc["A"])
    taylor = vp.insert_knots(
        puma, pose0, pose1, position=1e-4, angle=1e-3, near=abc["A"], method="taylor"
    )
    assert certified.position_bound <= 1e-4
    assert certified.angle_bound <= 1e-3
    assert len(certified) < len(taylor)
    for knots in (certified, taylor):
        assert knots.q.shape == (len(knots), 6)
        np.testing.assert_allclose(puma.fk(knots.q[0]), pose0, atol=1e-6)
        np.testing.assert_allclose(puma.fk(knots.q[-1]), pose1, atol=1e-6)
    line = pose1[:3, 3] - pose0[:3, 3]
    share = np.linspace(0, 1, 50)[:, None]
    for a, b in zip(taylor.q[:-1], taylor.q[1:], strict=True):
        between = puma.fk(a + share * (b - a))[:, :3, 3] - pose0[:3, 3]
        along = np.clip(between @ line / (line @ line), 0, 1)
        miss = np.linalg.norm(between - np.outer(along, line), axis=1)
        assert miss.max() <= taylor.position_bound


def test_knots_across_a_joint_limit_are_refused(puma, abc):
    with pytest.raises(errors.JointLimitError) as caught:
        vp.insert_knots(puma, puma.fk(abc["B"]), puma.fk(abc["C"]), near=abc["B"])
    assert caught.value.joint == 3
    assert caught.value.share == pytest.approx(0.12, abs=0.01)  # textbook §3


@pytest.mark.parametrize("what", ["proof", "joints", "tool", "path"])
def test_pictures_are_drawn(motion, tmp_path, what):
    path = tmp_path / f"{what}.png"
    motion.plot(path, what)
    assert path.read_bytes().startswith(b"\x89PNG")
    assert path.stat().st_size > 20_000


def test_the_picture_of_the_proof_shows_what_the_certificate_says(everything):
    figure = draw_proof(everything.sample(0.005), everything)
    rates = [ax for ax in figure.axes if "% of limit" in ax.get_ylabel()]
    assert [ax.get_ylabel().split()[0] for ax in rates] == ["velocity", "acceleration", "jerk"]
    certificate = everything.certificate
    for ax, shares in zip(
        rates,
        (certificate.velocity_share, certificate.acceleration_share, certificate.jerk_share),
        strict=True,
    ):
        drawn = max(np.nanmax(line.get_ydata(), initial=0.0) for line in ax.lines)
        assert drawn == pytest.approx(100 * shares.max(), abs=1.0)
    far = next(ax for ax in figure.axes if "µm" in ax.get_ylabel())
    distance = np.nanmax(far.lines[0].get_ydata())
    assert 0 < distance <= 1e6 * certificate.path_deviation
    words = {text.get_text() for legend in figure.legends for text in legend.get_texts()}
    assert {"velocity", "acceleration", "jerk", "rest", "zone, as used"} <= words


def test_what_limits_a_joint_move_is_named_moment_by_moment():
    robot = vp.joint_robot(1, velocity=[1.0], acceleration=[2.0], jerk=[10.0])
    motion = vp.Program(robot, start=[0.0]).movej([3.0]).plan()
    rules = motion.rules
    kinds = [rule.kind for rule in rules if rule.end - rule.start > 0.05 and rule.joint == 0]
    assert kinds == ["jerk", "acceleration", "jerk", "velocity", "jerk", "acceleration", "jerk"]
    assert rules[0].start == 0.0
    assert rules[-1].end == pytest.approx(motion.duration)


def test_an_unknown_picture_is_refused(motion, tmp_path):
    with pytest.raises(errors.BadArgumentError, match="what is 'torque'"):
        motion.plot(tmp_path / "x.png", "torque")


def test_outputs_change_where_the_point_is_passed(puma, abc):
    program = vp.Program(puma, start=abc["A"])
    program.movej(abc["B"], zone=vp.joint_deviation(0.05)).set_do(3, True).movej(abc["C"])
    with vp.connect("sim://puma560", start=abc["A"]) as arm:
        log = arm.run(program).log
    on = log.outputs == 1 << 3
    first = int(np.argmax(on))
    assert 0 < first < len(log) - 1
    assert not on[:first].any()
    assert on[first:].all()
    # The corner is passed where the arm is nearest to its point.
    nearest = int(np.argmin(np.linalg.norm(log.q - abc["B"], axis=1)))
    assert abs(first - nearest) * 0.002 < 0.05


@pytest.mark.parametrize("name", ["x.bmp", "x", "x.png.gz"])
def test_a_picture_of_no_known_format_is_refused(motion, tmp_path, name):
    with pytest.raises(errors.BadArgumentError, match="ends in"):
        motion.plot(tmp_path / name)


def test_a_picture_into_no_folder_is_refused(motion, tmp_path):
    with pytest.raises(errors.FileError, match="no_such_folder"):
        motion.plot(tmp_path / "no_such_folder" / "x.png")


def test_no_instants_are_refused(motion):
    with pytest.raises(errors.BadArgumentError, match="times is empty"):
        motion.at([])


@pytest.mark.parametrize("program", ["x", None, 3])
def test_simulating_no_program_is_refused(program):
    with pytest.raises(errors.BadArgumentError, match="program is"):
        vp.simulate(program)


def test_knots_of_a_name_are_refused(puma, abc):
    with pytest.raises(errors.BadArgumentError, match="load_robot"):
        vp.insert_knots("puma560", puma.fk(abc["A"]), puma.fk(abc["B"]))
    with pytest.raises(errors.BadArgumentError, match="position is 1e-15"):
        vp.insert_knots(puma, puma.fk(abc["A"]), puma.fk(abc["B"]), position=1e-15)


def test_corners_tell_what_became_of_the_zone(puma, abc):
    motion = vp.Program(puma, start=abc["A"]).movej(abc["B"], zone=50 * mm).movej(abc["C"]).plan()
    (corner,) = motion.corners
    assert corner.kind == "radius"
    assert corner.asked == 0.05
    assert not corner.stopped
    assert 0 < corner.used <= 0.05
