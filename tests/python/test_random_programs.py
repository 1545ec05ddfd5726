"""Programs at random: what plans keeps every limit, and survives its file."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import viapoint as vp
from viapoint import _arguments, errors

ROBOT = vp.load_robot("ur5e")
HOME = np.radians([0.0, -90.0, 90.0, -90.0, -90.0, 0.0])

steady = settings(derandomize=True, deadline=None, max_examples=60)
offsets = st.lists(st.floats(-0.8, 0.8), min_size=6, max_size=6)
zones = st.one_of(
    st.just("fine"),
    st.floats(1e-3, 0.2),
    st.builds(vp.deviation, st.floats(1e-4, 0.05)),
    st.builds(vp.joint_deviation, st.floats(1e-4, 0.2)),
)
moves = st.lists(st.tuples(offsets, zones, st.floats(0.1, 1.0)), min_size=1, max_size=6)


def program_of(steps):
    program = vp.Program(ROBOT, start=HOME)
    for offset, zone, scale in steps:
        program.movej(HOME + offset, zone=zone, scale=scale)
    return program


@steady
@given(moves)
def test_what_plans_keeps_every_limit_and_starts_and_ends_at_rest(steps):
    program = program_of(steps)
    assert program.check().ok
    motion = program.plan()
    c = motion.certificate
    assert c.holds
    for share in (c.velocity_share, c.acceleration_share, c.jerk_share):
        assert share.max() <= 1 + 1e-6
    s = motion.sample(0.001)
    assert (np.abs(s.qd) <= ROBOT.limits.velocity * (1 + 1e-6)).all()
    assert (np.abs(s.qdd) <= ROBOT.limits.acceleration * (1 + 1e-6)).all()
    assert np.abs(s.qd[[0, -1]]).max() < 1e-9
    assert np.abs(np.diff(s.q, axis=0)).max() < 0.001 * ROBOT.limits.velocity.max() * 1.01


@steady
@given(moves)
def test_a_program_survives_its_file(tmp_path_factory, steps):
    program = program_of(steps)
    path = tmp_path_factory.mktemp("program") / "p.json"
    program.save(path)
    assert vp.Program.load(path)._core.to_json() == program._core.to_json()


@steady
@given(st.floats(allow_nan=True, allow_infinity=True), st.floats(-10, 10), st.floats(-10, 10))
def test_a_number_is_taken_exactly_when_it_is_finite_and_in_range(value, least, most):
    if np.isfinite(value) and least <= value <= most:
        assert _arguments.number(value, "x", least=least, most=most) == value
    else:
        with pytest.raises(errors.BadArgumentError, match="x is"):
            _arguments.number(value, "x", least=least, most=most)


@steady
@given(st.lists(st.floats(0.0, 1.5), max_size=5), st.floats(0.05, 1.0))
def test_commands_at_any_time_stay_on_the_path(times, share):
    motion = program_of([([0.5, -0.4, 0.3, 0.2, -0.6, 0.7], "fine", 1.0)]).plan()
    kinds = ["override", "pause", "resume", "override", "resume"]
    commands = [
        (t, kind, share) if kind == "override" else (t, kind)
        for t, kind in zip(times, kinds, strict=False)
    ]
    s = vp.simulate(motion, commands)
    direction = np.array([0.5, -0.4, 0.3, 0.2, -0.6, 0.7])
    along = (s.q - HOME) @ direction / (direction @ direction)
    np.testing.assert_allclose(s.q - HOME, np.outer(along, direction), atol=1e-9)
    assert (np.diff(along) >= -1e-12).all()  # never backwards
    assert (np.abs(s.qddd) <= ROBOT.limits.jerk * (1 + 1e-6)).all()
