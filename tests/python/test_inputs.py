"""Runs that act on digital inputs by themselves."""

import time

import numpy as np
import pytest

import viapoint as vp
from viapoint import _session, errors


class _Virtual(_session.Session):
    virtual = True


@pytest.fixture(params=["clock", "virtual", "remote"])
def arm(request):
    """The same arm on the machine's clock, in virtual time, and in another process."""
    if request.param == "remote":
        served = request.getfixturevalue("serve")(robot="two_link", start=[0, 0])
        with vp.connect(served.url) as connected:
            yield connected
    elif request.param == "virtual":
        with _session.use(_Virtual()), vp.connect("sim://two_link") as connected:
            yield connected
    else:
        with vp.connect("sim://two_link") as connected:
            yield connected


def reached(condition):
    """Look until a condition holds, for half a minute at most."""
    deadline = time.monotonic() + 30.0
    while not condition():
        if time.monotonic() > deadline:
            return False
        time.sleep(0.001)
    return True


def test_a_run_pauses_and_goes_on_by_an_input(arm):
    program = vp.Program(arm.robot, start=[0, 0], scale=0.3).movej([1.0, 1.0])
    job = arm.run(program, wait=False)
    job.on_input(3, True, "pause")
    arm.set_input(3, True)
    assert reached(lambda: job.state == "paused")
    assert arm.input(3)
    assert not arm.input(4)
    job.on_input(3, False, "resume")
    assert job.state == "paused"
    arm.set_input(3, False)
    assert job.wait(30.0)
    assert job.state == "finished"


def test_a_stream_stops_by_an_input(arm):
    with arm.stream() as stream:
        stream.movej([0.5, 0.5]).movej([0.0, 0.0])
        assert reached(lambda: stream.job is not None)
        stream.job.on_input(0, action="stop")
        arm.set_input(0, True)
        assert reached(lambda: stream.job.ended)
    assert stream.job.state == "stopped"


def test_a_stream_keeps_the_rest_of_its_path_for_an_input(arm):
    """Steps told while the arm rests follow on those that it had."""
    with arm.stream(scale=0.3) as stream:
        stream.movej([0.4, 0.2]).movej([0.8, 0.4])
        assert reached(lambda: stream.job is not None)
        stream.job.on_input(0, True, "pause")
        arm.set_input(0, True)
        assert reached(lambda: stream.job.state == "paused")
        stream.movej([1.2, 0.6])
        before = stream.job.nominal_time
        stream.job.on_input(0, False, "resume")
        assert stream.job.nominal_time == before
        arm.set_input(0, False)
    assert stream.job.state == "finished"
    np.testing.assert_allclose(arm.setpoint, [1.2, 0.6], atol=1e-12)
    q = stream.job.log.q
    np.testing.assert_allclose(q[:, 1], 0.5 * q[:, 0], atol=1e-9)
    assert (np.diff(q[:, 0]) > -1e-12).all()  # it never went back


@pytest.mark.parametrize(
    ("told", "what"),
    [((64,), "index"), ((True,), "index"), ((1, 1), "value"), ((1, True, "jump"), "action")],
)
def test_a_reaction_that_means_nothing_is_refused(arm, told, what):
    job = arm.run(vp.Program(arm.robot, start=[0, 0]).movej([0.1, 0.1]), wait=False)
    with pytest.raises(errors.BadArgumentError, match=what):
        job.on_input(*told)


def test_an_input_that_is_none_is_refused(arm):
    for use in (lambda: arm.input(64), lambda: arm.set_input(-1, True)):
        with pytest.raises(errors.BadArgumentError, match="index"):
            use()
    with pytest.raises(errors.BadArgumentError, match="value"):
        arm.set_input(1, 1)


def test_an_arm_that_an_input_has_paused_may_be_jogged(arm):
    program = vp.Program(arm.robot, start=[0, 0], scale=0.3).movej([1.0, 1.0])
    job = arm.run(program, wait=False)
    job.on_input(3, True, "pause")
    arm.set_input(3, True)
    assert reached(lambda: job.state == "paused")
    arm.jog([0.1, 0.0])
    assert reached(lambda: not arm.jogging)
    job.resume()
    assert job.wait(30.0)
    assert job.state == "finished"
