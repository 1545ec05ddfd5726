"""The same numbers as roboticstoolbox-python where both define the same thing.

docs/robotics_toolbox.md says what is the same and what is not; here is the proof of it.
"""

import warnings

import numpy as np
import pytest

import viapoint as vp

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # its own dependencies' warnings are not ours to judge
    try:
        from roboticstoolbox.tools import trajectory as toolbox
    except ImportError:
        pytest.skip(
            "roboticstoolbox-python is not installed: pip install 'viapoint[compare]'",
            allow_module_level=True,
        )

TIMES = np.linspace(0.0, 2.0, 41)


def assert_same(law, theirs, times, shift=0.0, atol=1e-12):
    state = law.at(times + shift)
    for ours, other in ((state.q, theirs.q), (state.qd, theirs.qd), (state.qdd, theirs.qdd)):
        np.testing.assert_allclose(ours, other.reshape(ours.shape), atol=atol)


def test_quintic_over_a_time_vector():
    theirs = toolbox.quintic(0.3, -1.2, TIMES, qd0=0.7, qdf=-0.4)
    assert_same(vp.profile.quintic(0.3, -1.2, 2.0, v0=0.7, v1=-0.4), theirs, TIMES)


def test_quintic_with_a_number_of_steps_counts_one_second_a_step():
    theirs = toolbox.quintic(0.3, -1.2, 50)
    steps = np.arange(50.0)
    assert_same(vp.profile.quintic(0.3, -1.2, 49.0), theirs, steps)


@pytest.mark.parametrize("velocity", [None, 0.8, 1.1, 1.5])
def test_trapezoidal_away_from_its_corners(velocity):
    theirs = toolbox.trapezoidal(0.3, 1.8, TIMES, velocity)
    law = vp.profile.lspb(0.3, 1.8, 2.0, velocity=velocity)
    corners = np.array([law.blend_time, law.duration - law.blend_time])
    apart = np.abs(TIMES[:, None] - corners).min(axis=1) > 1e-9
    state = law.at(TIMES)
    np.testing.assert_allclose(state.q, theirs.q, atol=1e-12)
    np.testing.assert_allclose(state.qd, theirs.qd, atol=1e-12)
    np.testing.assert_allclose(state.qdd[apart], theirs.qdd[apart], atol=1e-12)
    assert theirs.tblend == pytest.approx(float(law.blend_time), abs=1e-14)


def test_trapezoidal_takes_the_size_of_the_velocity_and_ours_its_sign():
    theirs = toolbox.trapezoidal(1.8, 0.3, TIMES, 1.1)
    with pytest.raises(vp.errors.BadArgumentError, match="with the sign of the move"):
        vp.profile.lspb(1.8, 0.3, 2.0, velocity=1.1)
    law = vp.profile.lspb(1.8, 0.3, 2.0, velocity=-1.1)
    np.testing.assert_allclose(law.at(TIMES).q, theirs.q, atol=1e-12)


def test_trapezoidal_at_the_mean_velocity_is_refused_here_and_not_there():
    with np.errstate(all="ignore"):
        theirs = toolbox.trapezoidal(0.0, 1.0, TIMES, np.float64(0.5))
    assert not np.isfinite(theirs.qdd).all() or theirs.tblend == 0.0
    with pytest.raises(vp.errors.BadArgumentError, match=r"greater than 0\.5 and at most 1"):
        vp.profile.lspb(0.0, 1.0, 2.0, velocity=0.5)


@pytest.mark.parametrize("velocity", [0.7, 1.6])
def test_trapezoidal_refuses_the_same_velocities(velocity):
    with pytest.raises(ValueError, match="V too"):
        toolbox.trapezoidal(0.3, 1.8, TIMES, velocity)
    with pytest.raises(vp.errors.BadArgumentError, match=r"0\.75 and at most 1\.5"):
        vp.profile.lspb(0.3, 1.8, 2.0, velocity=velocity)


def test_jtraj_over_a_time_vector_from_0():
    q0, q1 = [0.1, -0.4, 1.0], [1.3, 0.2, -0.7]
    v0, v1 = [0.2, 0.0, -0.3], [0.0, 0.5, 0.1]
    theirs = toolbox.jtraj(q0, q1, TIMES, qd0=v0, qd1=v1)
    assert_same(vp.profile.quintic(q0, q1, 2.0, v0=v0, v1=v1), theirs, TIMES)


def test_jtraj_with_a_number_of_steps_takes_one_second_though_its_times_say_more():
    theirs = toolbox.jtraj([0.1, -0.4], [1.3, 0.2], 11)
    assert theirs.t[-1] == 11.0
    assert_same(vp.profile.quintic([0.1, -0.4], [1.3, 0.2], 1.0), theirs, np.linspace(0, 1, 11))


def test_jtraj_takes_the_largest_time_for_the_duration():
    later = np.linspace(1.0, 3.0, 21)
    theirs = toolbox.jtraj([0.0], [1.0], later)  # its law begins at time 0, a third of it cut off
    assert_same(vp.profile.quintic([0.0], [1.0], 3.0), theirs, later)
    assert theirs.q[0, 0] > 0.2


def test_mtraj_is_one_call_an_axis():
    q0, q1 = [0.1, -0.4, 1.0], [1.3, 0.2, -0.7]
    with_quintic = toolbox.mtraj(toolbox.quintic, q0, q1, TIMES)
    assert_same(vp.profile.quintic(q0, q1, 2.0), with_quintic, TIMES)
    with_trapezoidal = toolbox.mtraj(toolbox.trapezoidal, q0, q1, TIMES)
    law = vp.profile.lspb(q0, q1, 2.0)
    np.testing.assert_allclose(law.at(TIMES).q, with_trapezoidal.q, atol=1e-12)
    np.testing.assert_allclose(law.at(TIMES).qd, with_trapezoidal.qd, atol=1e-12)


def test_inner_blends_of_mstraj_are_quartic_transitions():
    """Quintics between states of two lines that meet in the middle lose their highest term."""
    via = np.array([[0.0, 1.0], [1.0, 0.5], [0.4, 2.0], [2.0, -1.0]])
    dt, t_acc, durations = 0.01, 0.2, [1.0, 0.8, 1.4]
    theirs = toolbox.mstraj(via, dt, 2 * t_acc, tsegment=durations)
    law = vp.profile.quartic_transitions(via, durations, t_acc)
    # It drops the sample at time 0 and calls the next one 0: its clock is one step late.
    times = theirs.t + dt
    inside = (times > t_acc + 1e-9) & (times < sum(durations) - t_acc - 1e-9)
    assert inside.sum() > 200
    state = law.at(times[inside])
    np.testing.assert_allclose(state.q, theirs.q[inside], atol=1e-10)
    np.testing.assert_allclose(state.qd, theirs.qd[inside], atol=1e-9)
    # Where a line meets a transition the one has the later part's acceleration, the other 0.
    np.testing.assert_allclose(state.qdd, theirs.qdd[inside], atol=1e-7)


def test_mstraj_rounds_blends_up_to_its_time_step():
    via = np.array([[0.0], [1.0], [0.0]])
    fine = toolbox.mstraj(via, 0.01, 0.25, tsegment=[1.0, 1.0])
    coarse = toolbox.mstraj(via, 0.1, 0.25, tsegment=[1.0, 1.0])
    # The same motion sampled ten times coarser is another motion.
    at_one = fine.q[np.argmin(np.abs(fine.t + 0.01 - 1.0)), 0]
    coarse_at_one = coarse.q[np.argmin(np.abs(coarse.t + 0.1 - 1.0)), 0]
    assert abs(at_one - coarse_at_one) > 1e-3
