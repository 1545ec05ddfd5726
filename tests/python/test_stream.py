"""Programs that are run while they are told."""

import math
import time
from pathlib import Path

import numpy as np
import pytest

import viapoint as vp
from viapoint import _session, errors

STATES = vp.RunLog.STATES


class _Virtual(_session.Session):
    virtual = True


@pytest.fixture
def in_virtual_time():
    with _session.use(_Virtual()):
        yield


def test_a_stream_that_changes_tools_again_and_again_keeps_each_once(in_virtual_time):
    robot = vp.load_robot("ur5e")
    home = np.radians([0, -90, 90, -90, -90, 0])
    tools = [np.eye(4), np.eye(4)]
    tools[0][2, 3], tools[1][0, 3] = 0.1, 0.2
    with vp.connect("sim://ur5e", start=home) as arm:
        with arm.stream() as stream:
            for k in range(20):
                stream.set_tool(tools[k % 2]).movej(home + 0.01 * (k % 3))
            stream.set_tool(tools[1]).movej(home)  # the one that it has
        log = stream.job.log
    assert [step for step, _ in log.tools] == list(range(0, 40, 2))
    assert len({id(robot) for _, robot in log.tools}) == 2
    for k in range(20):
        rows = log.move == 2 * k + 1
        expected = robot.with_tool(tools[k % 2]).fk(log.q[rows])
        np.testing.assert_allclose(log.samples.pose[rows], expected, atol=1e-12)


@pytest.fixture(params=["clock", "virtual", "remote"])
def arm(request):
    """The same arm on the machine's clock, in virtual time, and in another process."""
    robot = vp.joint_robot(3, velocity=3.0, acceleration=20.0, jerk=400.0)
    if request.param == "remote":
        file = request.getfixturevalue("tmp_path") / "axes.yaml"
        robot.save(file)
        served = request.getfixturevalue("serve")(robot=str(file), start=[0, 0, 0])
        with vp.connect(served.url) as connected:
            yield connected
    elif request.param == "virtual":
        with _session.use(_Virtual()), vp.connect("sim://axes", robot=robot) as connected:
            yield connected
    else:
        with vp.connect("sim://axes", robot=robot) as connected:
            yield connected


def places(count, seed=1):
    """Points of a random walk."""
    random = np.random.default_rng(seed)
    return np.cumsum(random.uniform(-0.3, 0.3, (count, 3)), axis=0)


def told(robot, points, zone):
    program = vp.Program(robot, start=[0.0] * 3, zone=zone)
    for q in points:
        program.movej(q)
    return program


def distance_to(path, points):
    """Largest distance of `points` from the nearest place of a densely sampled path."""
    worst = 0.0
    for begin in range(0, len(points), 100):
        part = points[begin : begin + 100]
        worst = max(worst, np.abs(part[:, None] - path[None]).max(axis=2).min(axis=1).max())
    return worst


def test_a_stream_is_run_on_the_path_of_the_whole_program(arm):
    points = places(20)
    zone = vp.joint_deviation(0.01)
    with arm.stream(zone=zone) as stream:
        for q in points:
            assert stream.movej(q) is stream
            assert stream.steps_ahead <= 16
    assert stream.job.state == "finished"
    np.testing.assert_allclose(arm.setpoint, points[-1], atol=1e-12)
    path = told(arm.robot, points, zone).plan().sample(5e-4).q
    assert distance_to(path, stream.job.log.q) < 1e-3
    assert stream.job.report.cycles > 100


def test_a_script_that_thinks_too_long_is_told_so_by_its_line(arm):
    points = places(8)
    with arm.stream(zone=vp.joint_deviation(0.01)) as stream:
        for index, q in enumerate(points):
            if index == 5:
                deadline = time.monotonic() + 30.0
                while stream.job.state != "waiting" and time.monotonic() < deadline:
                    time.sleep(0.005)
            stream.movej(q)
    assert stream.job.state == "finished"
    late = stream.late
    assert len(late) == stream.late_count
    assert 1 <= len(late) <= 4
    assert late[0].step in (5, 6)
    assert late[0].file == __file__
    assert late[0].waited > 0.0
    np.testing.assert_allclose(arm.setpoint, points[-1], atol=1e-12)


def tell_all(stream, points):
    for q in points:
        stream.movej(q)
    assert not stream.job.ended


def test_a_step_that_is_refused_raises_at_its_line_and_the_arm_rests(puma, abc, in_virtual_time):
    with (
        vp.connect("sim://puma560", start=abc["A"]) as arm,
        pytest.raises(errors.JointLimitError) as caught,
        arm.stream().movej(abc["B"]) as stream,
    ):
        stream.movej([100.0] * 6)
    assert caught.value.file == __file__
    lines = Path(__file__).read_text(encoding="utf-8").splitlines()
    assert "[100.0] * 6" in lines[caught.value.line - 1]
    assert stream.job is None or stream.job.state in ("stopped", "finished")


def test_nothing_moves_where_the_script_fails_before_the_motion_has_begun(in_virtual_time):
    robot = vp.joint_robot(3, velocity=3.0, acceleration=20.0, jerk=400.0)
    with vp.connect("sim://axes", robot=robot) as arm:
        with pytest.raises(ZeroDivisionError), arm.stream() as stream:
            raise ZeroDivisionError(stream.movej([0.1] * 3))
        assert stream.job is None
        assert not arm.joints.any()


def test_an_exception_brings_the_arm_to_rest_on_its_path(arm):
    points = places(6)
    stream = arm.stream(zone=vp.joint_deviation(0.01))
    with pytest.raises(ZeroDivisionError), stream:
        raise ZeroDivisionError(tell_all(stream, points))
    assert stream.job.state == "stopped"
    path = told(arm.robot, points, vp.joint_deviation(0.01)).plan().sample(5e-4).q
    assert distance_to(path, stream.job.log.q) < 1e-3
    with pytest.raises(errors.BusyError, match="ended"):
        stream.movej(points[0])


def test_a_run_that_was_stopped_takes_no_more_steps(arm):
    points = places(6)
    with arm.stream() as stream:
        tell_all(stream, points)
        stream.job.stop()
        deadline = time.monotonic() + 30.0
        while not stream.job.ended and time.monotonic() < deadline:
            time.sleep(0.005)
        with pytest.raises(errors.StoppedError):
            stream.movej(points[0])
    assert stream.job.state == "stopped"


def test_override_pause_and_resume_hold_for_a_stream(arm):
    points = places(12)
    arm.override = 0.5
    with arm.stream(zone=vp.joint_deviation(0.01)) as stream:
        for index, q in enumerate(points):
            stream.movej(q)
            if index == 6:
                stream.job.pause()
                stream.job.resume()
                arm.override = 1.0
    states = {STATES[s] for s in stream.job.log.state}
    assert "finished" in states
    np.testing.assert_allclose(arm.setpoint, points[-1], atol=1e-12)


def test_outputs_and_waits_come_in_their_order(arm):
    with arm.stream() as stream:
        stream.movej([0.2] * 3).set_do(3, True).wait(0.1).movej([0.0] * 3).set_do(3, False)
        stream.movej([0.1] * 3)
    outputs = stream.job.log.outputs
    on = np.flatnonzero(outputs == 1 << 3)
    assert len(on) > 10
    assert (np.diff(on) == 1).all()
    assert outputs[-1] == 0
    assert np.abs(stream.job.log.q[on[0]] - 0.2).max() < 0.01


def test_a_stream_of_nothing_moves_nothing(arm):
    with arm.stream() as stream:
        pass
    assert stream.job is None
    with pytest.raises(errors.BusyError):
        stream.movej([0.1] * 3)


def test_programs_and_streams_follow_one_another(arm):
    with arm.stream() as stream:
        stream.movej([0.1] * 3)
    job = arm.run(vp.Program(arm.robot, start=arm.setpoint).movej([0.2] * 3))
    assert job.state == "finished"
    with arm.stream() as stream:
        stream.movej([0.3] * 3)
    np.testing.assert_allclose(arm.setpoint, [0.3] * 3, atol=1e-12)


def test_a_stream_is_no_program(arm):
    with arm.stream() as stream:
        stream.movej([0.1] * 3)
        for use in (stream.check, stream.plan, stream.chunks):
            with pytest.raises(errors.BadProgramError, match="stream"):
                use()


@pytest.mark.parametrize("ahead", [2, 1001, 3.5, "8", True])
def test_a_number_ahead_that_is_none_is_refused(arm, ahead):
    with pytest.raises(errors.BadArgumentError, match="ahead"):
        arm.stream(ahead=ahead)


def test_thousands_of_moves_are_dropped_as_they_pass(in_virtual_time):
    robot = vp.joint_robot(2, velocity=3.0, acceleration=60.0, jerk=3000.0)
    with vp.connect("sim://axes", robot=robot, cycle=0.01) as arm:
        with arm.stream(zone=vp.joint_deviation(0.005), ahead=64) as stream:
            for index in range(2000):
                angle = 0.3 * index
                stream.movej([0.2 * math.cos(angle), 0.2 * math.sin(angle)])
                assert len(stream) == 0
        assert stream.job.state == "finished"
        assert stream.late_count == 0
        assert len(stream.take_corners()) == 1000
        # Longer than the loop's ring of records, and longer than what is kept of the way.
        assert stream.job.report.cycles > 4096


def test_dense_points_do_not_wait_for_ones_to_come(arm):
    """No line waits for ones that may only be told when it has been run."""
    with arm.stream(zone=vp.joint_deviation(0.01), ahead=4) as stream:
        for k in range(1, 41):
            stream.movej([0.005 * k, 0.0, 0.0])
    assert stream.job.state == "finished"
    np.testing.assert_allclose(arm.joints, [0.2, 0.0, 0.0], atol=1e-9)


def test_steps_that_move_nothing_do_not_wait_for_the_arm(arm):
    with arm.stream(ahead=3, zone=vp.joint_deviation(0.01)) as stream:
        for _ in range(6):
            stream.wait(0.0)
        stream.movej([0.1] * 3)
        for output in range(6):
            stream.set_do(output, True)
        stream.movej([0.2] * 3)
    assert stream.job.state == "finished"
    assert stream.job.log.outputs[-1] == 0b111111


def test_nothing_moves_after_a_motion_that_could_not_begin(arm):
    stream = arm.stream(start=[0.5] * 3)
    stream.movej([0.0] * 3).wait(0.1).movej([0.1] * 3)
    with pytest.raises(errors.NotAtStartError):
        stream.job.wait()
    with pytest.raises(errors.NotAtStartError):
        stream.movej([0.2] * 3)
    with pytest.raises(errors.NotAtStartError):
        stream.close()
    assert stream.job is None
    assert not arm.joints.any()


def test_a_step_after_a_fault_raises_what_has_failed(puma, abc, in_virtual_time):
    with vp.connect("sim://puma560", start=abc["A"], tool_speed=0.05) as arm:
        stream = arm.stream(ahead=3)
        with pytest.raises(errors.DriveFaultError, match="too fast"):
            tell_all(stream, [abc["B"], abc["A"]] * 50)
        assert stream.job.state == "fault"
        stream.close()


def test_an_input_that_a_stream_waits_for_in_vain_is_told_at_the_next_step():
    with vp.connect("sim://two_link") as arm:
        stream = arm.stream().movej([0.1, 0.1]).wait_di(3, timeout=0.05)
        stream.movej([0.2, 0.2])
        deadline = time.monotonic() + 30.0
        while not stream.job.ended and time.monotonic() < deadline:
            time.sleep(0.005)
        with pytest.raises(errors.InputTimeoutError):
            stream.movej([0.3, 0.3])
        stream.close()


def test_the_arm_tells_of_the_run_of_a_stream(arm):
    first = arm.run(vp.Program(arm.robot, start=[0.0] * 3).movej([0.1] * 3))
    with arm.stream() as stream:
        assert arm.job is first
        with pytest.raises(errors.BusyError, match="stream"):
            arm.run(vp.Program(arm.robot, start=arm.setpoint).movej([0.2] * 3))
        stream.movej([0.2] * 3)
        assert stream.job is arm.job
    assert arm.job is stream.job
    assert arm.job.state == "finished"
    last = arm.run(vp.Program(arm.robot, start=arm.setpoint).movej([0.3] * 3))
    assert arm.job is last


def test_a_look_at_a_stream_in_virtual_time_lets_no_more_pass_than_at_a_short_one(in_virtual_time):
    robot = vp.joint_robot(1, velocity=0.01, acceleration=1.0, jerk=10.0)
    with vp.connect("sim://axis", robot=robot) as arm, arm.stream() as stream:
        stream.movej([1.0])
        job = stream.job
        assert job.duration > 100.0
        before = job.nominal_time
        assert 0.0 < job.nominal_time - before < 0.2


def test_there_is_one_stream_at_a_time(arm):
    first = arm.stream()
    with pytest.raises(errors.BusyError, match="stream"):
        arm.stream()
    first.close()
    with arm.stream() as second:
        second.movej([0.1] * 3)
        second.job.stop()
        deadline = time.monotonic() + 30.0
        while not second.job.ended and time.monotonic() < deadline:
            time.sleep(0.005)
        with arm.stream() as third:
            third.movej([0.2] * 3)
    assert third.job.state == "finished"


@pytest.mark.skipif(not Path("/proc/self/task").is_dir(), reason="counts threads as Linux tells")
def test_a_closed_arm_is_not_held_by_its_stream():
    def threads():
        return {task.name for task in Path("/proc/self/task").iterdir()}

    robot = vp.joint_robot(3, velocity=3.0, acceleration=20.0, jerk=400.0)
    before = threads()
    with vp.connect("sim://axes", robot=robot) as arm, arm.stream() as stream:
        stream.movej([0.1] * 3)
        begun = threads() - before
        assert begun
    assert not threads() & begun
    assert stream.late == []
    unused = vp.connect("sim://axes", robot=robot)
    stream = unused.stream()
    begun = threads() - before
    unused.close()
    assert not threads() & begun
    assert stream.ended


def test_a_run_that_was_resumed_in_a_jog_is_seen_to_its_end(in_virtual_time):
    robot = vp.joint_robot(1, velocity=1.0, acceleration=5.0, jerk=50.0)
    for cycles in range(0, 60, 2):
        with vp.connect("sim://axis", robot=robot, cycle=0.01) as arm:
            job = arm.run(vp.Program(robot, start=[0.0]).movej([1.0]), wait=False)
            arm._loop.core.pass_cycles(20)
            job.pause()
            arm._loop.core.pass_cycles(1000)
            assert job.state == "paused"
            arm.jog([0.3])
            arm._loop.core.pass_cycles(cycles)
            job.resume()
        assert job.state == "finished", cycles
