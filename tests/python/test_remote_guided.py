"""A controller's arm is guided and recorded over the network, and no cycle is left out."""

from __future__ import annotations

import time

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors
from viapoint._wire import message

HOME = np.radians([0, -90, 90, -90, -90, 0])


@pytest.fixture
def url(serve):
    return serve(robot="ur5e", start=list(HOME)).url


@pytest.fixture
def long(ur5e):
    """A hand that holds the arm where it is until it lets go."""
    return vp.Recording.of_samples(ur5e, [0.0, 500.0], np.tile(HOME, (2, 1)))


def observed(loop, start):
    """What was measured in each cycle from `start` to now, of the 4096 that are kept."""
    newest = loop.newest_cycle
    rows = []
    while start <= newest:
        cycles, _, q, _, _ = loop.observed(start, 1000)
        rows.append(q)
        start = int(cycles[-1]) + 1
    return np.vstack(rows)


def test_every_position_of_the_hand_is_recorded_and_played(url, hand):
    with vp.connect(url) as arm:
        start = arm._loop.newest_cycle
        arm.guide(hand)
        recorded = arm.record(60.0, until=lambda: not arm.guided)
        # However late this process was, each position is there, to the last bit: the loop keeps
        # 8 s of cycles, of which the hand takes 1.4 s.
        seen = np.vstack([observed(arm._loop, start), recorded.q])
        assert {tuple(q) for q in hand.q} <= {tuple(q) for q in seen}
        cycles = np.diff(recorded.t) / 0.002
        assert cycles.min() > 0.0
        # What was recorded may begin within the hand's way: all of it is fitted.
        fit = hand.fit(0.5e-3)
        assert fit.deviation <= 0.5e-3
        assert fit.play(arm, speed=None, reverse=True).state == "finished"
        assert np.abs(arm.setpoint - HOME).max() < 1e-3


def test_an_arm_is_guided_from_the_answer_on_and_neither_run_nor_jogged(url, ur5e, long):
    with vp.connect(url) as arm, vp.connect(url, watch=True) as watcher:
        for _ in range(20):
            arm.guide(long)
            assert watcher.guided
            assert arm.guided
            with pytest.raises(errors.BusyError, match="guided by hand"):
                arm.jog([0.1] * 6)
            with pytest.raises(errors.BusyError, match="guided by hand"):
                arm.run(vp.Program(ur5e, start=HOME).movej(HOME + 0.05))
            arm.let_go()
            until(lambda: not arm.guided)
        assert arm.fault == ""


def until(holds):
    deadline = time.monotonic() + 60.0
    while not holds():
        assert time.monotonic() < deadline


def test_a_long_hand_comes_in_parts_and_lets_go_when_told(url, ur5e):
    long = vp.Recording.of_samples(ur5e, [0.0, 60.0], np.tile(HOME, (2, 1)))  # 30 001 cycles
    with vp.connect(url) as arm:
        arm.guide(long)
        with pytest.raises(errors.BusyError, match="guides the arm already"):
            arm.guide(long)
        arm.let_go()
        until(lambda: not arm.guided)
        assert arm.run(vp.Program(ur5e, start=arm.setpoint).movej(HOME + 0.05)).state == "finished"


def test_the_hand_of_a_script_that_has_left_lets_go(url, ur5e, long):
    with vp.connect(url, watch=True) as watcher:
        with vp.connect(url) as arm:
            arm.guide(long)
            assert watcher.guided
        until(lambda: not watcher.guided)
    with vp.connect(url) as arm:
        assert arm.run(vp.Program(ur5e, start=arm.setpoint).movej(HOME + 0.05)).state == "finished"


def test_a_released_arm_is_neither_guided_nor_switched(url, ur5e):
    still = vp.Recording.of_samples(ur5e, [0.0, 60.0], np.tile(HOME, (2, 1)))
    with vp.connect(url) as arm:
        job = arm.run(vp.Program(ur5e, start=HOME).wait(60.0), wait=False)
        job.stop(1)
        job.wait()
        with pytest.raises(errors.MotionError, match="released"):
            arm.guide(still)
        with pytest.raises(errors.MotionError, match="released"):
            arm.set_output(3, True)
    with vp.connect(url) as arm:
        assert not arm.guided


def test_a_watcher_is_told_that_the_arm_was_enabled_anew_while_he_recorded(serve, ur5e):
    url = serve(robot="ur5e", start=list(HOME), tool_speed=0.05).url
    with vp.connect(url, watch=True) as watcher:
        ends = []

        def fail_and_return():
            """All between two looks: the loop that failed is gone when the watcher looks again."""
            if not ends:
                with vp.connect(url) as arm, pytest.raises(errors.DriveFaultError) as caught:
                    arm.run(vp.Program(ur5e, start=arm.setpoint).movej(HOME + 0.3))
                ends.append(caught.value)
                vp.connect(url).close()
            return False

        with pytest.raises(errors.DriveFaultError, match="begun anew"):
            watcher.record(60.0, until=fail_and_return)
        assert ends
        assert watcher.fault == ""
        assert len(watcher.fault_cycles) > 0


def test_an_arm_that_fails_over_the_network_is_told_to_who_records(serve, ur5e):
    url = serve(robot="ur5e", start=list(HOME), tool_speed=0.05).url
    with vp.connect(url) as arm:
        job = arm.run(vp.Program(ur5e, start=HOME).movej(HOME + 0.3), wait=False)
        for _ in range(2):
            with pytest.raises(errors.DriveFaultError, match="the tool"):
                arm.record(60.0)
        with pytest.raises(errors.DriveFaultError):
            job.wait()


def test_hands_that_do_not_fit_are_refused_by_the_controller(url):
    with vp.connect(url) as arm, vp.connect(url, watch=True) as watcher:
        loop = arm._remote

        def guide(positions, offset=0, token=None, begins=True):
            request = message(
                "GuideRequest",
                token=loop.token if token is None else token,
                offset=offset,
                positions=np.ravel(positions),
                begins=begins,
            )
            loop.call("Guide", request, "GuideReply")

        for positions, offset, says in (
            ([HOME + 0.5], 0, r"begins 0\.5 rad or m from where the arm stands"),
            ([HOME[:5]], 0, "whole rows of 6"),
            ([HOME * np.nan], 0, "not finite"),
            ([HOME], 7, "from 7 on came where"),
            ([], 0, "at least one position"),
        ):
            with pytest.raises(errors.BadArgumentError, match=says):
                guide(positions, offset)
        with pytest.raises(errors.NotInControlError):
            guide([HOME], token="none")
        with pytest.raises(errors.NotInControlError):
            watcher.let_go()
        job = arm.run(
            vp.Program(arm.robot, start=arm.setpoint, scale=0.02).movej(HOME + 0.5), wait=False
        )
        with pytest.raises(errors.BusyError, match="already under way"):
            guide([arm.joints])
        assert not arm.guided
        job.stop()


def test_outputs_are_recorded_over_the_network(url):
    with vp.connect(url) as arm:
        program = vp.Program(arm.robot, start=HOME).set_do(2, True).movej(HOME + 0.1).wait(0.2)
        job = arm.run(program.set_do(63, True).movej(HOME), wait=False)
        recorded = arm.record(60.0, until=lambda: job.state == "finished")
        job.wait()
    changes = recorded.outputs[np.flatnonzero(np.diff(recorded.outputs)) + 1]
    assert changes.tolist()[-1] == 2**63 + 4
    assert np.abs(recorded.q[recorded.outputs == 4][-1] - (HOME + 0.1)).max() < 0.02


def test_an_operator_switches_outputs_and_a_watcher_does_not(url):
    with vp.connect(url) as arm, vp.connect(url, watch=True) as watcher:
        arm.set_output(63, True)
        until(lambda: watcher.output(63))
        with pytest.raises(errors.NotInControlError):
            watcher.set_output(63, False)
        assert arm.output(63)
        assert not arm.output(0)
