"""Hand-guided motion: smooth paths that pass every noisy sample, in its tempo, and back."""

import json
import warnings

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors, verifier
from viapoint.errors import OtherRobotWarning

HOME = np.radians([0, -90, 90, -90, -90, 0])
CYCLE = 0.002


def eased(t, begin, end):
    """From 0 to 1, smoothly."""
    s = np.clip((t - begin) / (end - begin), 0.0, 1.0)
    return s**3 * (10 - 15 * s + 6 * s**2)


def guided(seed, seconds=2.0, noise=2e-5):
    """Rest, a smooth way of random size and waviness, rest; with noise on every encoder."""
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, seconds, CYCLE)
    s = eased(t, 0.2, seconds - 0.2)
    far, wave = rng.uniform(-0.3, 0.3, (2, 6))
    q = HOME + np.outer(s, far) + np.outer(np.sin(rng.integers(2, 9) * s), 0.3 * wave)
    return t, q + noise * rng.normal(size=q.shape)


def distance_to_path(robot, q, path):
    """Of each sample's tool point from the polygon through points of the path."""
    points = robot.fk(path)[:, :3, 3]
    begin, chord = points[:-1], np.diff(points, axis=0)
    square = np.maximum(np.sum(chord**2, axis=1), 1e-300)
    found = []
    for p in robot.fk(q)[:, :3, 3]:
        share = np.clip(np.sum((p - begin) * chord, axis=1) / square, 0.0, 1.0)
        found.append(np.linalg.norm(begin + share[:, None] * chord - p, axis=1).min())
    return np.array(found)


@pytest.mark.parametrize("seed", range(8))
def test_the_motion_passes_every_sample_within_the_tolerance(ur5e, seed):
    tolerance = [5e-4, 2e-3][seed % 2]
    t, q = guided(seed)
    fit = vp.Recording.of_samples(ur5e, t, q).fit(tolerance)
    assert fit.deviation <= tolerance
    assert fit.angle_deviation <= 0.02
    motion = fit.program(speed=None).plan()
    off = distance_to_path(ur5e, q[::7], motion.sample(1e-3).q)
    assert off.max() <= fit.deviation + 1e-6
    # And it smooths: a rest shakes by the noise, the motion keeps its jerk limits.
    assert max(motion.certificate.jerk_share) <= 1.0 + 1e-6


def test_noise_is_smoothed_away_and_costs_no_time(ur5e):
    times = []
    for noise in (0.0, 5e-5):
        t, q = guided(3, noise=noise)
        fit = vp.Recording.of_samples(ur5e, t, q).fit(1e-3)
        times.append(fit.program(speed=None).plan().duration)
    assert times[1] < 1.1 * times[0]


@pytest.mark.parametrize("speed", [1.0, 0.5])
def test_a_way_takes_its_recorded_time_over_the_speed(ur5e, speed):
    t, q = guided(1)
    fit = vp.Recording.of_samples(ur5e, t, q).fit(1e-3)
    assert fit.duration == pytest.approx(t[-1], abs=1e-9)
    motion = fit.program(speed=speed).plan()
    assert motion.duration == pytest.approx(fit.duration / speed, rel=5e-3)


def test_what_the_limits_do_not_allow_takes_longer(ur5e):
    t, q = guided(1)
    fit = vp.Recording.of_samples(ur5e, t, q).fit(1e-3)
    fastest = fit.program(speed=None).plan().duration
    (stage,) = fit.stages
    rests = (stage.before + stage.after) / 1000
    assert fit.program(speed=1000.0).plan().duration == pytest.approx(fastest + rests, abs=2e-2)


def test_backwards_and_loops_pass_the_same_path(ur5e):
    t, q = guided(5)
    fit = vp.Recording.of_samples(ur5e, t, q).fit(1e-3)
    there = fit.program(speed=None).plan()
    back = fit.program(speed=None, reverse=True).plan()
    np.testing.assert_array_equal(back.program.start, fit.end)
    np.testing.assert_allclose(back.end, fit.start, atol=1e-9)
    assert back.duration == pytest.approx(there.duration, rel=0.02)
    assert distance_to_path(ur5e, q[::25], back.sample(1e-3).q).max() < 1e-3
    thrice = fit.program(speed=None, loops=3).plan()
    returns = vp.Program(ur5e, start=fit.end).movej(fit.start, scale=0.25).plan().duration
    assert thrice.duration == pytest.approx(3 * there.duration + 2 * returns, rel=0.02)


def there_and_back():
    """Along one line and back on it, with an output on from the far end on."""
    t = np.arange(0.0, 2.0, CYCLE)
    s = eased(t, 0.1, 0.9) - eased(t, 1.1, 1.9)
    q = HOME + np.outer(s, [0.3, 0.1, 0.0, 0.0, 0.0, 0.2])
    q += 1e-5 * np.random.default_rng(4).normal(size=q.shape)
    return t, q, s


def test_a_way_that_goes_back_on_itself_is_cut_and_kept(ur5e):
    t, q, _ = there_and_back()
    fit = vp.Recording.of_samples(ur5e, t, q).fit(5e-4)
    assert sum(stage.moves for stage in fit.stages) == 2
    motion = fit.program(speed=None).plan()
    assert distance_to_path(ur5e, q[::7], motion.sample(1e-3).q).max() <= fit.deviation + 1e-6


def test_a_small_move_after_a_large_one_is_kept_within_the_tolerance(ur5e):
    """By less than what tells a move from noise, and by more than the tolerance."""
    t = np.arange(0.0, 2.0, CYCLE)
    q = HOME + np.outer(eased(t, 0.1, 0.9), np.full(6, 0.2))
    q += np.outer(eased(t, 1.3, 1.6), np.full(6, 0.004))
    outputs = np.where(t > 1.1, 1, 0)
    fit = vp.Recording.of_samples(ur5e, t, q, outputs).fit(2e-3)
    motion = fit.program(speed=None).plan()
    assert distance_to_path(ur5e, q[::7], motion.sample(1e-3).q).max() <= fit.deviation + 1e-6
    assert np.abs(motion.end - q[-1]).max() < 1e-3


def test_outputs_are_played_where_and_when_they_changed(ur5e):
    t, q, s = there_and_back()
    outputs = np.where(t > 1.0, 0b1001, 0b1000)
    fit = vp.Recording.of_samples(ur5e, t, q, outputs).fit(5e-4)
    assert fit.duration == pytest.approx(t[-1], abs=2 * CYCLE)
    motion = fit.program().plan()
    for reverse in (False, True):
        motion = fit.program(reverse=reverse).plan()
        with vp.connect("sim://ur5e", start=motion.program.start) as arm:
            log = arm.run(motion).log
        on = (log.outputs & np.uint64(1)) != 0
        assert ((log.outputs & np.uint64(8)) != 0)[10:].all()
        change = int(np.flatnonzero(on != on[0])[0]) if on[0] else int(np.argmax(on))
        assert change * CYCLE == pytest.approx(t[-1] - 1.0 if reverse else 1.0, abs=0.05)
        far = log.q[change]
        assert np.abs(far - q[int(np.argmax(s))]).max() < 2e-3
        assert bool(on[-1]) != reverse


def test_playing_approaches_the_path_from_where_the_arm_stands(ur5e):
    t, q = guided(2, seconds=1.0)
    fit = vp.Recording.of_samples(ur5e, t, q).fit(1e-3)
    with vp.connect("sim://ur5e", start=HOME - 0.2) as arm:
        job = fit.play(arm, speed=None)
        assert job.state == "finished"
        np.testing.assert_allclose(arm.setpoint, fit.end, atol=1e-9)
        again = vp.Recording.of_log(job.log)
    assert len(again) == len(job.log)
    second = again.fit(1e-3)
    assert np.abs(second.end - fit.end).max() < 1e-3


def test_an_arm_is_recorded_while_it_is_jogged(ur5e):
    with vp.connect("sim://ur5e", start=HOME) as arm:
        seen = [0.0]

        def until():
            arm.jog([0.5, 0, 0, 0, 0, 0])
            seen.append(arm.joints[0])
            return seen[-2] > 0.1  # so that a sample after it was taken

        recording = arm.record(60.0, until=until)
    assert recording.q[0, 0] == pytest.approx(0.0, abs=1e-6)
    assert recording.q[-1, 0] > 0.1
    assert (np.diff(recording.t) > 0).all()
    fit = recording.fit(1e-3)
    assert fit.deviation <= 1e-3


def test_raw_samples_are_kept_to_the_last_bit(tmp_path):
    robot = vp.joint_robot(2, velocity=2, acceleration=20, jerk=200)
    t = np.arange(0.0, 1.0, CYCLE)
    q = np.random.default_rng(2).normal(size=(len(t), 2))
    recording = vp.Recording.of_samples(robot, t, q, np.where(t > 0.5, 2**63, 1).astype(np.uint64))
    path = tmp_path / "raw.npz"
    recording.save(path)
    read = vp.Recording.load(path)
    for name in ("t", "q", "outputs"):
        np.testing.assert_array_equal(getattr(read, name), getattr(recording, name))
    assert read.robot.fingerprint == robot.fingerprint
    data = path.read_bytes()
    path.write_bytes(data[: len(data) // 2])
    with pytest.raises(errors.BadProgramError, match="cannot be read"):
        vp.Recording.load(path)
    with pytest.raises(errors.FileError, match="no recording"):
        vp.Recording.load(tmp_path / "none.npz")
    with pytest.raises(errors.BadArgumentError, match=r"\.npz"):
        recording.save(tmp_path / "raw.json")


def test_robots_without_kinematics_are_fitted_in_joints():
    robot = vp.joint_robot(2, velocity=2, acceleration=20, jerk=200)
    t = np.arange(0.0, 1.0, CYCLE)
    q = np.outer(eased(t, 0.1, 0.9), [1.0, 0.5])
    fit = vp.Recording.of_samples(robot, t, q).fit(vp.joint_deviation(2e-3))
    assert fit.deviation <= 2e-3
    assert fit.program().plan().duration == pytest.approx(1.0, abs=0.01)
    with pytest.raises(errors.BadArgumentError, match="no kinematics"):
        vp.Recording.of_samples(robot, t, q).fit(1e-3)


@pytest.mark.parametrize(
    ("noise", "says"), [(1e-3, "goes back on itself twice"), (5e-5, "times the tolerance")]
)
def test_a_tolerance_below_the_noise_is_refused_with_the_time(ur5e, noise, says):
    t, q = guided(1, noise=noise)
    with pytest.raises(errors.DegenerateCurveError, match=says) as caught:
        vp.Recording.of_samples(ur5e, t, q).fit(1e-4)
    assert 0.0 <= caught.value.time <= t[-1]


def test_a_sample_outside_the_limits_is_refused_by_its_time(ur5e):
    t, q = guided(1)
    q[500, 1] = 7.0
    with pytest.raises(errors.JointLimitError, match=r"recording at 1\.000 s"):
        vp.Recording.of_samples(ur5e, t, q).fit(1e-3)


def test_an_arm_that_was_not_moved_is_refused(ur5e):
    t = np.arange(0.0, 1.0, CYCLE)
    with pytest.raises(errors.EmptyProgramError, match="was moved by less"):
        vp.Recording.of_samples(ur5e, t, np.tile(HOME, (len(t), 1))).fit(1e-3)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (([0.0, 0.0], [HOME, HOME]), "times or more"),
        (([0.0], [HOME]), "times or more"),
        (([0.0, 1.0], [HOME]), "q has the shape"),
        (([0.0, 1.0], [HOME, HOME], [0.5, 1]), "integers"),
        (([0.0, 1.0], [HOME, HOME], [-1, 1]), "integers"),
    ],
)
def test_samples_that_do_not_fit_are_refused(ur5e, arguments, says):
    with pytest.raises(errors.BadArgumentError, match=says):
        vp.Recording.of_samples(ur5e, *arguments)


def test_bad_wishes_are_refused_by_name(ur5e):
    recording = vp.Recording.of_samples(ur5e, *guided(1, seconds=1.0))
    for tolerance in (0, -1, "x", vp.radius(0.01)):
        with pytest.raises(errors.BadArgumentError, match="tolerance is"):
            recording.fit(tolerance)
    fit = recording.fit(2e-3)
    for name, value in (("speed", 0), ("loops", 0), ("approach_scale", 2), ("loops", 1.5)):
        with pytest.raises(errors.BadArgumentError, match=f"{name} is"):
            fit.program(**{name: value})


@pytest.fixture(scope="module")
def saved(ur5e, tmp_path_factory):
    t, q = guided(6, seconds=1.0)
    outputs = np.where(t > 0.9, 2**63, 0).astype(np.uint64)
    fit = vp.Recording.of_samples(ur5e, t, q, outputs).fit(1e-3)
    path = tmp_path_factory.mktemp("recordings") / "wipe.json"
    fit.save(path)
    return fit, path


def test_a_file_reads_back_to_the_last_bit(saved):
    fit, path = saved
    read = vp.load_recording(path)
    assert len(read.stages) == len(fit.stages)
    for one, other in zip(read.stages, fit.stages, strict=True):
        np.testing.assert_array_equal(one.control, other.control)
        assert vars(one) | {"control": 0} == vars(other) | {"control": 0}
    assert read.tolerance == 1e-3
    np.testing.assert_array_equal(read.start, fit.start)


def test_another_robot_warns_and_one_of_another_name_is_refused(saved):
    _, path = saved
    with pytest.warns(OtherRobotWarning, match="fingerprint"):
        vp.load_recording(path, vp.load_robot("ur5e").with_limits(velocity=0.5))
    with pytest.raises(errors.BadProgramError, match='not with "puma560"'):
        vp.load_recording(path, vp.load_robot("puma560"))
    with pytest.raises(errors.FileError, match="cannot be read"):
        vp.load_recording(path.with_name("none.json"))


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (lambda d: d.update(version=2), "version"),
        (lambda d: d.update(extra=1), "unknown key"),
        (lambda d: d["stages"].clear(), "none of them moves"),
        (lambda d: d["stages"][0]["control"].pop(0), None),
        (lambda d: d["stages"][0].update(control=d["stages"][0]["control"][:3]), "four or more"),
        (lambda d: d["stages"][0].update(before=-1), "not within"),
        (lambda d: d["stages"][0].update(outputs=2**64), "not within"),
        (lambda d: d["stages"][0]["control"][0].pop(), "must hold 6"),
    ],
)
def test_a_file_that_says_something_else_is_refused_by_its_place(saved, tmp_path, change, says):
    document = json.loads(saved[1].read_text(encoding="utf-8"))
    del document["sha256"]
    change(document)
    path = tmp_path / "x.json"
    path.write_bytes(verifier.seal(json.dumps(document)[:-1]))
    if says is None:
        assert len(vp.load_recording(path).stages) == len(saved[0].stages)
        return
    with pytest.raises(errors.BadProgramError, match=says):
        vp.load_recording(path)


def test_a_file_cut_short_or_changed_is_refused(saved, tmp_path):
    data = saved[1].read_bytes()
    rng = np.random.default_rng(9)
    path = tmp_path / "x.json"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for _ in range(50):
            broken = bytearray(data)
            if rng.random() < 0.3:
                del broken[int(rng.integers(len(data))) :]
            else:
                broken[int(rng.integers(len(data)))] ^= 1 << int(rng.integers(8))
            path.write_bytes(broken)
            with pytest.raises(errors.BadProgramError):
                vp.load_recording(path)


def test_a_short_way_between_reversals_whose_samples_leave_its_curve_open_is_fitted(ur5e):
    random = np.random.default_rng(13)
    count = random.integers(3, 600)
    random.integers(4)
    t = np.cumsum(random.uniform(0.001, 0.02, count))
    q = np.outer(np.abs(np.sin(2 * t)), random.uniform(-1, 1, 6))
    q += np.array([0, -1.5, 1.5, -1.5, -1.5, 0])
    q += random.normal(0, 10 ** random.uniform(-6, -3.5), (count, 6))
    tolerance = 0.00037054920584675123
    recording = vp.Recording.of_samples(ur5e, t, q, (np.sin(3 * t) > 0).astype(int))
    assert recording.fit(vp.joint_deviation(tolerance)).deviation <= tolerance
