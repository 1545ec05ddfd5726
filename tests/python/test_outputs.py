"""Outputs at places and times, and waits for inputs, as scripts see them."""

import json
import threading
import time

import numpy as np
import pytest

import viapoint as vp
from viapoint import _session, errors, mm
from viapoint._run_log import RunLog
from viapoint.verifier import MotionFileError, seal, verify

HOME = np.array([0, -1.5, 1.5, -1.5, -1.5, 0])


class _Virtual(_session.Session):
    virtual = True


def there(robot, y=0.1, z=0.0):
    pose = robot.fk(HOME)
    pose[1:3, 3] += [y, z]
    return pose


def switched(samples, output):
    """The sample in which an output comes on first."""
    return int(np.flatnonzero(samples.outputs >> np.uint64(output) & np.uint64(1))[0])


def corner(robot):
    """Two lines and a corner, with outputs about it."""
    program = vp.Program(robot, start=HOME, zone=10 * mm)
    program.movel(there(robot)).set_do(1, True, distance=-20 * mm).set_do(2, True)
    program.set_do(3, True, distance=30 * mm).set_do(4, True, time=-0.05).set_do(5, True, time=0.05)
    return program.movel(there(robot, z=-0.1))


@pytest.mark.parametrize("share", [1.0, 0.3])
def test_outputs_come_at_their_places_and_times_whatever_the_override(ur5e, share):
    log = log_of(corner(ur5e).plan(), [(0.0, "override", share)])
    way = np.concatenate(
        [[0.0], np.cumsum(np.linalg.norm(np.diff(log.samples.pose[:, :3, 3], axis=0), axis=1))]
    )
    at = {output: switched(log, output) for output in range(1, 6)}
    cycle = np.diff(way).max()
    assert way[at[1]] == pytest.approx(way[at[2]] - 0.02, abs=1.01 * cycle)
    assert way[at[3]] == pytest.approx(way[at[2]] + 0.03, abs=1.01 * cycle)
    assert at[4] == pytest.approx(at[2] - 25, abs=2)
    assert at[5] == pytest.approx(at[2] + 25, abs=1)


def log_of(motion, commands):
    """As `vp.simulate`, but with the outputs."""
    from viapoint import _core

    timed = [(time, kind, np.array([float(value)])) for time, kind, value in commands]
    return RunLog.of(_core.simulate(motion._core, timed, 0.002), motion, 0.002)


def test_a_distance_longer_than_its_move_is_refused_with_its_line(ur5e):
    program = vp.Program(ur5e, start=HOME).movel(there(ur5e))
    program.set_do(1, True, distance=-0.2)
    report = program.check()
    assert not report.ok
    problem = next(iter(report))
    assert problem.code == "bad_argument"
    assert problem.limit == pytest.approx(0.1, abs=1e-5)
    assert problem.line is not None


@pytest.mark.parametrize(
    ("told", "what"),
    [
        ({"distance": np.nan}, "distance"),
        ({"distance": "1"}, "distance"),
        ({"time": 2.1}, "time"),
        ({"time": -2.1}, "time"),
    ],
)
def test_a_place_or_time_that_is_none_is_refused(ur5e, told, what):
    with pytest.raises(errors.BadArgumentError, match=what):
        vp.Program(ur5e, start=HOME).set_do(1, True, **told)


@pytest.mark.parametrize(
    ("told", "options", "what"),
    [
        ((64,), {}, "index"),
        ((1, 1), {}, "value"),
        ((1,), {"timeout": 0.0}, "timeout"),
        ((1,), {"timeout": np.inf}, "timeout"),
    ],
)
def test_a_wait_for_nothing_is_refused(ur5e, told, options, what):
    with pytest.raises(errors.BadArgumentError, match=what):
        vp.Program(ur5e, start=HOME).wait_di(*told, **options)


def test_program_and_motion_files_carry_them(ur5e, tmp_path):
    program = corner(ur5e).wait_di(7, False, timeout=1.5).wait_di(8)
    program.save(tmp_path / "p.json")
    again = vp.Program.load(tmp_path / "p.json", ur5e)
    assert again._core.to_json() == program._core.to_json()
    path = tmp_path / "m.motion.json"
    program.plan().save(path)
    verdict = verify(path)
    assert verdict.holds, [str(finding) for finding in verdict.findings]
    document = json.loads(path.read_text())
    times = [told[2] for p in document["pieces"] for told in p.get("outputs", []) if len(told) == 3]
    assert times == [-0.05, 0.05]
    assert [p["wait"] for p in document["pieces"] if "wait" in p] == [
        [7, False, 1.5],
        [8, True, None],
    ]


@pytest.mark.parametrize("wait", [[64, True, None], [1, True, 0.0], [1, True], [1, 1, None]])
def test_a_motion_file_with_a_wrong_wait_is_refused(ur5e, tmp_path, wait):
    path = tmp_path / "m.motion.json"
    vp.Program(ur5e, start=HOME).movel(there(ur5e)).wait_di(7).plan().save(path)
    document = json.loads(path.read_text())
    del document["sha256"]
    row = next(p for p in document["pieces"] if "wait" in p)
    row["wait"] = wait
    path.write_bytes(seal(json.dumps(document)[:-1] + "\n"))
    with pytest.raises(MotionFileError, match="wait"):
        verify(path)


def test_a_motion_file_waits_only_where_it_rests(ur5e, tmp_path):
    path = tmp_path / "m.motion.json"
    vp.Program(ur5e, start=HOME).movel(there(ur5e)).plan().save(path)
    document = json.loads(path.read_text())
    del document["sha256"]
    document["pieces"][0]["wait"] = [1, True, None]
    path.write_bytes(seal(json.dumps(document)[:-1] + "\n"))
    with pytest.raises(MotionFileError, match="rest"):
        verify(path)


def waiting(arm, timeout=None, value=True):
    program = vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.1)
    return program.wait_di(7, value, timeout=timeout).movej(arm.setpoint)


def test_a_run_waits_for_an_input_and_goes_on():
    with vp.connect("sim://two_link") as arm:
        job = arm.run(waiting(arm), wait=False)
        deadline = time.monotonic() + 30.0
        while job.state != "waiting":
            assert time.monotonic() < deadline
            time.sleep(0.001)
        assert job.move == 1
        assert not job.wait(0.05)
        arm.set_input(7, True)
        assert job.wait(30.0)
        assert job.state == "finished"


def test_a_wait_that_is_over_in_vain_ends_the_run_by_name():
    with vp.connect("sim://two_link") as arm:
        with pytest.raises(errors.InputTimeoutError, match="input 7 was not on") as caught:
            arm.run(waiting(arm, timeout=0.1))
        assert caught.value.move == 1
        assert arm.job.state == "stopped"
        np.testing.assert_allclose(arm.setpoint, [0.1, 0.1], atol=1e-12)
        arm.run(vp.Program(arm.robot, start=arm.setpoint).movej([0.0, 0.0]))


def test_in_virtual_time_the_input_comes_by_itself():
    with _session.use(_Virtual()), vp.connect("sim://two_link") as arm:
        for timeout in (None, 0.5):
            assert arm.run(waiting(arm, timeout)).state == "finished"


def test_a_simulated_run_is_told_its_inputs():
    robot = vp.load_robot("two_link")
    program = vp.Program(robot, start=[0, 0]).movej([0.1, 0.1]).wait_di(7, timeout=5.0)
    program.movej([0, 0])
    plain = len(vp.simulate(program, [(0.0, "input", 7, True)]).t)
    late = len(vp.simulate(program, [(3.0, "input", 7, True)]).t)
    assert late > plain + 500
    missed = vp.simulate(program)
    np.testing.assert_allclose(missed.q[-1], [0.1, 0.1], atol=1e-12)
    assert missed.t[-1] > 5.0
    for wrong in [(0.0, "input"), (0.0, "input", 64, True), (0.0, "input", 1, 1)]:
        with pytest.raises(errors.BadArgumentError):
            vp.simulate(program, [wrong])


@pytest.mark.parametrize("virtual", [False, True])
def test_a_stream_waits_and_switches(virtual):
    session = _Virtual() if virtual else _session.current()
    with _session.use(session), vp.connect("sim://two_link") as arm:
        if not virtual:
            threading.Timer(0.5, lambda: arm.set_input(7, True)).start()
        with arm.stream() as stream:
            stream.movej([0.1, 0.1]).set_do(2, True, time=0.1).wait_di(7, timeout=30.0)
            stream.movej([0.0, 0.0]).set_do(3, True, distance=-0.01).movej([0.1, 0.0])
        log = stream.job.log
    assert stream.job.state == "finished"
    assert log.outputs[-1] == 12
    assert "waiting" in {RunLog.STATES[state] for state in log.state} or virtual


def test_over_the_wire_a_run_waits_and_switches_the_same(serve):
    url = serve(robot="two_link", start=[0.0, 0.0]).url
    with vp.connect(url) as arm:
        program = vp.Program(arm.robot, start=arm.setpoint).movej([0.1, 0.1])
        program.set_do(1, True, time=-0.02).set_do(2, True, time=0.04).wait_di(7, False).movej(
            [0, 0]
        )
        job = arm.run(program)
        assert job.state == "finished"
        local = log_of(program.plan(), [])
        np.testing.assert_array_equal(job.log.outputs, local.outputs)
        with pytest.raises(errors.InputTimeoutError, match="input 7 was not on"):
            arm.run(waiting(arm, timeout=0.1))
        assert arm.job.state == "stopped"


def test_a_stream_switches_before_a_point_what_is_told_with_its_move(ur5e):
    targets = [there(ur5e, 0.1 if k % 2 == 0 else 0.0) for k in range(20)]
    with (
        _session.use(_Virtual()),
        vp.connect("sim://ur5e", start=HOME) as arm,
        arm.stream(ahead=4, scale=0.5) as stream,
    ):
        for k, target in enumerate(targets):
            stream.movel(target).set_do(3, k % 2 == 0, distance=-20 * mm)
    log = stream.job.log
    changes = np.flatnonzero(np.diff(log.outputs)) + 1
    assert len(changes) == len(targets)
    for k, target in zip(changes, targets, strict=True):
        before, at = (
            np.linalg.norm(log.samples.pose[i, :3, 3] - target[:3, 3]) for i in (k - 1, k)
        )
        assert at <= 20 * mm + 1e-6 <= before + 2e-6
