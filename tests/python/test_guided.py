"""A hand moves the simulated arm; what the drives measure is recorded, fitted and played."""

from __future__ import annotations

import time

import numpy as np
import pytest

import viapoint as vp
from viapoint import _session, errors
from viapoint._recorder import Recorder

HOME = np.radians([0, -90, 90, -90, -90, 0])


@pytest.fixture(params=["virtual", "clock"])
def session(request):
    if request.param == "clock":
        yield
        return
    with _session.use(Recorder(virtual=True)):
        yield


def test_what_the_hand_did_is_recorded_and_played(session, ur5e, hand):
    with vp.connect("sim://ur5e", start=HOME) as arm:
        arm.guide(hand)
        assert arm.guided
        recorded = arm.record(60.0, until=lambda: not arm.guided)
        # Each sample is one that the hand made, and nothing that a planner did.
        made = {tuple(q) for q in np.round(hand.q, 9)}
        seen = [tuple(q) for q in np.round(recorded.q[1:-2], 9)]
        assert len(seen) > 10
        assert sum(q not in made for q in seen) <= 1  # the arm before the hand took it
        assert recorded.duration < 10.0
        np.testing.assert_allclose(arm.setpoint, hand.q[-1], atol=1e-9)
        fit = recorded.fit(0.5e-3)
        assert fit.deviation <= 0.5e-3
        fit.play(arm, speed=None, reverse=True)
        assert np.abs(arm.setpoint - HOME).max() < 1e-3
        assert arm.fault == ""


def test_every_cycle_is_recorded_in_virtual_time(ur5e, hand):
    with (
        _session.use(Recorder(virtual=True)),
        vp.connect("sim://ur5e", start=HOME) as arm,
    ):
        arm.guide(hand)
        recorded = arm.record(2.0)
    np.testing.assert_allclose(np.diff(recorded.t), 0.002, atol=1e-12)
    assert recorded.duration == pytest.approx(2.0, abs=1e-9)
    np.testing.assert_allclose(recorded.q[1 : len(hand) + 1], hand.q, atol=1e-12)
    rest = recorded.q[len(hand) + 1 :]
    np.testing.assert_allclose(rest, np.tile(hand.q[-1], (len(rest), 1)), atol=1e-12)


def test_a_hand_of_another_rate_is_followed_between_its_samples(ur5e, hand):
    coarse = vp.Recording.of_samples(ur5e, hand.t[::5], hand.q[::5])
    with (
        _session.use(Recorder(virtual=True)),
        vp.connect("sim://ur5e", start=HOME) as arm,
    ):
        arm.guide(coarse)
        recorded = arm.record(1.0)
    np.testing.assert_allclose(recorded.q[1:501:5], hand.q[:500:5], atol=1e-12)
    middle = 0.5 * (recorded.q[1:496:5] + recorded.q[6:501:5])
    np.testing.assert_allclose(
        0.5 * (recorded.q[3:498:5] + recorded.q[4:499:5]), middle, atol=1e-12
    )


def test_outputs_are_recorded_with_the_joints(session, ur5e):
    program = vp.Program(ur5e, start=HOME).set_do(2, True).movej(HOME + 0.1).wait(0.3)
    program.set_do(2, False).set_do(63, True).movej(HOME)
    with vp.connect("sim://ur5e", start=HOME) as arm:
        job = arm.run(program, wait=False)
        recorded = arm.record(30.0, until=lambda: job.state == "finished")
        job.wait()
    seen = [int(bits) for bits in recorded.outputs]
    order = [bits for bits, before in zip(seen, [None, *seen[:-1]], strict=True) if bits != before]
    assert order in ([0, 4, 2**63], [4, 2**63])
    switch = int(np.argmax(recorded.outputs == 2**63))
    assert np.abs(recorded.q[switch] - (HOME + 0.1)).max() < 0.05
    fit = recorded.fit(1e-3)
    assert [stage.outputs for stage in fit.stages][-1] == 2**63


def test_an_output_that_is_switched_while_a_hand_guides_is_recorded_and_played(session, ur5e, hand):
    with vp.connect("sim://ur5e", start=HOME) as arm:
        arm.guide(hand)

        def halfway():
            if arm._loop.observed(arm._loop.newest_cycle, 1)[2][-1, 0] > HOME[0] + 0.15:
                arm.set_output(5, True)
            return arm.output(5) and not arm.guided

        recorded = arm.record(60.0, until=halfway)
        assert arm.output(5)
        assert not arm.output(4)
        switched = int(np.argmax(recorded.outputs == 32))
        assert recorded.q[switched, 0] - HOME[0] > 0.1
        assert set(recorded.outputs.tolist()) == {0, 32}
        fit = recorded.fit(0.5e-3)
        arm.set_output(5, False)
        job = fit.play(arm, speed=None, reverse=True)  # backwards: on at first, then off
        outputs = job.log.outputs
        assert outputs[-1] == 0
        assert 32 in outputs
        last_on = job.log.q[np.flatnonzero(outputs == 32)[-1]]
        assert abs(last_on[0] - recorded.q[switched, 0]) < 0.02


def test_a_program_switches_what_a_hand_has_switched_just_before_it(session, ur5e):
    motion = vp.Program(ur5e, start=HOME).set_do(5, True).movej(HOME + 0.05).movej(HOME).plan()
    with vp.connect("sim://ur5e", start=HOME) as arm:
        for _ in range(5):
            arm.set_output(5, True)
            deadline = time.monotonic() + 60.0
            while not arm.output(5):
                assert time.monotonic() < deadline
            arm.set_output(5, False)
            assert set(arm.run(motion).log.outputs.tolist()) == {32}


@pytest.mark.parametrize("released", [False, True])
def test_an_arm_that_has_failed_is_neither_guided_nor_switched(session, ur5e, released):
    """Its loop takes nothing any more: the hand would guide, and a recording last, for ever."""
    with vp.connect("sim://ur5e", start=HOME, tool_speed=None if released else 0.05) as arm:
        job = arm.run(vp.Program(ur5e, start=HOME).movej(HOME + 0.3), wait=False)
        if released:
            job.stop(1)
            job.wait()
        else:
            with pytest.raises(errors.DriveFaultError):
                job.wait()
        still = vp.Recording.of_samples(ur5e, [0.0, 60.0], np.tile(arm.joints, (2, 1)))
        with pytest.raises(errors.DriveFaultError):
            arm.guide(still)
        assert not arm.guided
        with pytest.raises(errors.DriveFaultError):
            arm.set_output(1, True)
        with pytest.raises(errors.DriveFaultError, match="released" if released else "the tool"):
            arm.record(0.01)


def test_a_recording_in_which_the_arm_fails_says_what_has_failed(session, ur5e):
    with vp.connect("sim://ur5e", start=HOME, tool_speed=0.05) as arm:
        job = arm.run(vp.Program(ur5e, start=HOME).movej(HOME + 0.3), wait=False)
        with pytest.raises(errors.DriveFaultError, match=r"After \d+\.\d+ s .* the tool") as caught:
            arm.record(60.0)
        assert arm.fault in caught.value.message
        assert caught.value.ways_out
        with pytest.raises(errors.DriveFaultError):
            job.wait()


def test_a_recording_in_which_the_drive_is_released_says_so(session, ur5e):
    with vp.connect("sim://ur5e", start=HOME) as arm:
        job = arm.run(vp.Program(ur5e, start=HOME).movej(HOME + 0.3), wait=False)

        def let_power_go():
            job.stop(1)
            return False

        with pytest.raises(errors.DriveFaultError, match="released by a stop of category 1"):
            arm.record(60.0, until=let_power_go)


def test_a_recording_that_is_over_at_once_holds_what_was_measured(session, ur5e):
    with vp.connect("sim://ur5e", start=HOME) as arm:
        recorded = arm.record(60.0, until=lambda: True)
        assert len(recorded) >= 2
        np.testing.assert_allclose(recorded.q, np.tile(HOME, (len(recorded), 1)))


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda arm: arm.set_output(64, True), "index is 64"),
        (lambda arm: arm.set_output(0, 1), "value is 1"),
        (lambda arm: arm.output(-1), "index is -1"),
    ],
)
def test_outputs_that_are_none_are_refused(call, says):
    with (
        vp.connect("sim://ur5e", start=HOME) as arm,
        pytest.raises(errors.BadArgumentError, match=says),
    ):
        call(arm)


def test_a_hand_may_let_go_early(session, ur5e, hand):
    with vp.connect("sim://ur5e", start=HOME) as arm:
        arm.guide(hand)
        arm.let_go()
        end = time.monotonic() + 30.0
        while arm.guided:
            assert time.monotonic() < end
        assert np.abs(arm.setpoint - HOME).max() < 0.5
        assert arm.run(vp.Program(ur5e, start=arm.setpoint).movej(HOME)).state == "finished"


def test_runs_and_jogs_are_refused_from_when_a_hand_guides(session, ur5e):
    still = vp.Recording.of_samples(ur5e, [0.0, 500.0], np.tile(HOME, (2, 1)))
    with vp.connect("sim://ur5e", start=HOME) as arm:
        arm.guide(still)
        for refused in (
            lambda: arm.jog([0.1] * 6),
            lambda: arm.run(vp.Program(ur5e, start=HOME).movej(HOME + 0.1)),
        ):
            with pytest.raises(errors.BusyError, match="guided by hand"):
                refused()
        with pytest.raises(errors.BusyError, match="guides the arm already"):
            arm.guide(vp.Recording.of_samples(ur5e, [0, 1], np.tile(arm.joints, (2, 1))))
        assert arm.guided
        assert arm.fault == ""


def test_an_arm_that_fails_while_it_is_guided_is_guided_no_more(session, ur5e):
    with vp.connect("sim://ur5e", start=HOME) as arm:
        jump = np.vstack([HOME, HOME, HOME + 0.5, HOME + 0.5])
        arm.guide(vp.Recording.of_samples(ur5e, [0.0, 0.1, 0.102, 500.0], jump))
        with pytest.raises(errors.DriveFaultError, match="jump"):
            arm.record(60.0, until=lambda: not arm.guided)
        assert not arm.guided
        assert "jump" in arm.fault


def test_hands_that_do_not_fit_are_refused(ur5e, hand):
    with vp.connect("sim://ur5e", start=HOME + 0.5) as arm:
        with pytest.raises(errors.BadArgumentError, match=r"begins 0\.5 rad or m from"):
            arm.guide(hand)
        with pytest.raises(errors.BadArgumentError, match="must be a Recording"):
            arm.guide("hand.npz")
        two = vp.joint_robot(2, velocity=1, acceleration=1, jerk=1)
        with pytest.raises(errors.BadArgumentError, match="moves 2 joints"):
            arm.guide(vp.Recording.of_samples(two, [0, 1], np.zeros((2, 2))))


def test_samples_are_read_from_a_table(tmp_path, ur5e, hand):
    names = ",".join(["t", *(f"q{i}" for i in range(1, 7)), "outputs"])
    outputs = np.where(hand.t > 1.0, 2**63, 5).astype(np.uint64)
    rows = [
        ",".join([repr(float(t)), *(repr(float(x)) for x in q), str(int(on))])
        for t, q, on in zip(hand.t, hand.q, outputs, strict=True)
    ]
    path = tmp_path / "hand.csv"
    path.write_text("\n".join([names, *rows]) + "\n", encoding="utf-8")
    read = vp.Recording.load(path, ur5e)
    np.testing.assert_array_equal(read.q, hand.q)
    np.testing.assert_array_equal(read.t, hand.t)
    np.testing.assert_array_equal(read.outputs, outputs)
    with pytest.raises(errors.BadArgumentError, match="does not say what robot"):
        vp.Recording.load(path)
    for text, says in (
        ("", "begins with"),
        ("t,q1\n0,0\n1,1\n", "begins with"),
        (names[:-8] + "\n0,1,2,3,4,5,x\n", "line 2"),
        (names[:-8] + "\n0,1,2,3,4,5\n", "line 2"),
        (names + "\n0,1,2,3,4,5,6,1\n0.1,1,2,3,4,5,6,-1\n", "line 3"),
        (names[:-8] + "\n0,1,2,3,4,5,6\n0,1,2,3,4,5,6\n", "two times or more"),
    ):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(errors.BadProgramError, match=says):
            vp.Recording.load(path, ur5e)
