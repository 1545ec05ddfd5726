"""Drives that lag and measure with noise, and devices that take setpoints over UDP."""

from __future__ import annotations

import socket
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path

import numpy as np
import pytest

import viapoint as vp
from viapoint import _session, errors
from viapoint._recorder import Recorder

EXAMPLE = Path(__file__).parents[2] / "python" / "examples" / "udp_drive.py"


@pytest.fixture
def virtual():
    with _session.use(Recorder(virtual=True)):
        yield


@pytest.fixture(scope="module")
def robot():
    return vp.joint_robot(2, velocity=2.0, acceleration=20.0, jerk=200.0)


def run(robot, drive, to=(0.5, -0.3)):
    with vp.connect("sim://two", robot=robot, drive=drive) as arm:
        return arm.run(vp.Program(robot, start=[0, 0]).movej(to).wait(0.5)).log


def test_the_arm_lags_by_its_time_constant(virtual, robot):
    log = run(robot, vp.SimulatedDrive(lag=0.02))
    expected, told = np.zeros(2), np.zeros(2)
    kept = np.exp(-0.002 / 0.02)
    for k in range(len(log)):
        expected = told + kept * (expected - told)
        np.testing.assert_allclose(log.measured[k], expected, atol=1e-12)
        told = log.q[k]
        if k + 1 < len(log) and log.cycle[k + 1] != log.cycle[k] + 1:
            break  # from here on the log leaves out the rest
    assert np.abs(log.measured - log.q).max() > 0.01


def test_readings_are_whole_steps_and_the_same_for_a_seed(virtual, robot):
    drive = vp.SimulatedDrive(lag=0.01, resolution=1e-4, noise=1e-4, seed=3)
    with vp.connect("sim://two", robot=robot, drive=drive) as arm:
        still = arm.record(0.2).q[1:]
    np.testing.assert_allclose(still / 1e-4, np.round(still / 1e-4), atol=1e-9)
    assert 0.7e-4 < still.std() < 1.5e-4
    one, two = run(robot, drive), run(robot, drive)
    np.testing.assert_array_equal(one.measured, two.measured)
    other = run(robot, vp.SimulatedDrive(lag=0.01, resolution=1e-4, noise=1e-4, seed=4))
    assert not np.array_equal(one.measured, other.measured)


def test_the_same_drive_runs_on_the_clock(robot):
    log = run(robot, vp.SimulatedDrive(lag=0.05, resolution=1e-4))
    assert np.abs(log.measured - log.q).max() > 0.01
    np.testing.assert_allclose(log.measured / 1e-4, np.round(log.measured / 1e-4), atol=1e-9)


@pytest.mark.parametrize(
    ("values", "says"),
    [
        ({"lag": -1.0}, "lag is -1"),
        ({"lag": 11.0}, "lag is 11"),
        ({"noise": np.nan}, "noise"),
        ({"resolution": "fine"}, "resolution"),
        ({"seed": -1}, "seed"),
        ({"seed": 1.5}, "seed"),
    ],
)
def test_values_that_are_none_are_refused_by_name(values, says):
    with pytest.raises(errors.BadArgumentError, match=says):
        vp.SimulatedDrive(**values)


@pytest.mark.parametrize(
    ("url", "told", "says"),
    [
        ("udp://127.0.0.1:7500", {}, "does not tell what robot"),
        ("udp://127.0.0.1", {"robot": True}, "a device's is \"udp://"),
        ("udp://127.0.0.1:0", {"robot": True}, "a device's is \"udp://"),
        ("udp://127.0.0.1:7500?x=1", {"robot": True}, "a device's is \"udp://"),
        ("udp://localhost:7500", {"robot": True}, "no address in numbers"),
        ("udp://127.0.0.1:7500", {"robot": True, "start": [0, 0]}, "a device tells where"),
        ("udp://127.0.0.1:7500", {"robot": True, "silent_cycles": -1}, "silent_cycles"),
        ("sim://ur5e", {"drive": 3}, "must be a SimulatedDrive"),
        ("tcp://127.0.0.1:1", {"drive": vp.SimulatedDrive()}, "drive is for an arm of this"),
        ("tcp://127.0.0.1:1", {"silent_cycles": 3}, "silent_cycles is for an arm of this"),
    ],
)
def test_connections_that_are_none_are_refused(robot, url, told, says):
    with pytest.raises(errors.BadArgumentError, match=says):
        vp.connect(url, **(told | ({"robot": robot} if "robot" in told else {})))


def test_a_device_that_is_not_there_is_named(robot):
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as deaf:
        deaf.bind(("127.0.0.1", 0))
        port = deaf.getsockname()[1]
        with pytest.raises(errors.DriveFaultError, match="no device has answered") as caught:
            vp.connect(f"udp://127.0.0.1:{port}", robot=robot)
    assert str(port) in caught.value.message
    assert caught.value.ways_out


@contextmanager
def device_of(joints):
    """The example's device, in a process of its own, and its port."""
    command = [sys.executable, str(EXAMPLE), "device", "0", str(joints)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        try:
            yield process, int(process.stdout.readline().split()[-1])
        finally:
            process.kill()


@pytest.fixture
def device(robot):
    with device_of(robot.joints) as made:
        yield made


def test_a_program_runs_on_a_device(robot, device):
    """A machine that is busy holds the device up: it has 10 s, and the way is short."""
    _, port = device
    with vp.connect(f"udp://127.0.0.1:{port}", robot=robot, silent_cycles=5000) as arm:
        np.testing.assert_array_equal(arm.joints, [0.0, 0.0])
        program = vp.Program(robot, start=arm.setpoint, scale=0.5)
        job = arm.run(program.set_do(5, True).movej([0.2, -0.1]).wait(0.2))
        assert job.state == "finished"
        np.testing.assert_allclose(arm.setpoint, [0.2, -0.1], atol=1e-12)
        for _ in range(1000):
            if np.abs(arm.joints - arm.setpoint).max() < 1e-6 and arm.input(5):
                break
            arm.record(0.01)
        np.testing.assert_allclose(arm.joints, [0.2, -0.1], atol=1e-6)
        assert arm.input(5)  # the device's inputs show the outputs that it was told
        counts = arm.datagrams
        assert counts["sent"] > 100
        assert counts["answered"] > 0
        assert [counts[key] for key in ("wrong_size", "wrong_magic", "wrong_version")] == [0] * 3
        assert not arm.guided
        with pytest.raises(errors.BadArgumentError, match="Only a simulated drive"):
            arm.set_input(0, True)
        with pytest.raises(errors.BadArgumentError, match="Only a simulated drive"):
            arm.let_go()


def test_a_run_rests_for_an_input_of_the_device_and_keeps_the_rest_of_its_path(robot, device):
    """The device's inputs show the outputs that it was told, so the program pauses itself."""
    _, port = device
    with vp.connect(f"udp://127.0.0.1:{port}", robot=robot, silent_cycles=5000) as arm:
        goal = np.array([0.6, -0.3])
        program = vp.Program(robot, start=arm.setpoint, scale=0.5).set_do(5, True).movej(goal)
        job = arm.run(program, wait=False)
        job.on_input(5, True, "pause")
        deadline = time.monotonic() + 30.0
        while job.state != "paused" and time.monotonic() < deadline:
            time.sleep(0.001)
        assert 0.0 < job.nominal_time < job.duration
        assert np.abs(arm.setpoint - goal).max() > 0.01
        job.resume()
        assert job.wait(30.0)
        assert job.state == "finished"
        np.testing.assert_allclose(arm.setpoint, goal, atol=1e-12)
        np.testing.assert_allclose(job.log.q[:, 1], -0.5 * job.log.q[:, 0], atol=1e-9)


def test_a_device_that_falls_silent_is_a_drive_fault(robot, device):
    process, port = device
    with vp.connect(f"udp://127.0.0.1:{port}", robot=robot, silent_cycles=1000) as arm:
        process.kill()
        process.wait()
        program = vp.Program(robot, start=arm.setpoint).wait(60.0).movej([0.1, 0.1])
        with pytest.raises(errors.DriveFaultError, match="has not answered for 1001 cycles"):
            arm.run(program)
        assert "on its path" in arm.fault


def test_in_virtual_time_nothing_is_sent_to_the_device(virtual, robot):
    with vp.connect("udp://127.0.0.1:9", robot=robot, start=[0.1, 0.2]) as arm:
        np.testing.assert_array_equal(arm.setpoint, [0.1, 0.2])
        assert arm.run(vp.Program(robot, start=[0.1, 0.2]).movej([0, 0])).state == "finished"
        assert arm.datagrams == {}


def test_the_controller_runs_on_drives_that_lag(serve):
    served = serve(drive={"simulated": {"lag": 0.05, "noise": 1e-6, "seed": 1}})
    with vp.connect(served.url) as arm:
        program = vp.Program(arm.robot, start=arm.setpoint).movej([0.3] * 6)
        log = arm.run(program).log
        assert np.abs(log.measured - log.q).max() > 1e-3
        recorded = arm.record(0.05)
        assert recorded.q.shape[1] == 6
        assert len(np.unique(recorded.q[:, 0])) > 1  # noise, and nothing that was planned


def test_the_controller_runs_on_a_device(serve, tmp_path, puma):
    # The file's name counts from the folder of the configuration.
    (tmp_path / "arm.yaml").write_text(puma._core.to_yaml(), encoding="utf-8")
    with device_of(6) as (_, port):
        drive = {"udp": f"127.0.0.1:{port}", "silent_cycles": 5000}
        with vp.connect(serve(robot="arm.yaml", drive=drive).url) as arm:
            program = vp.Program(arm.robot, start=arm.setpoint, scale=0.5)
            assert arm.run(program.movej([0.1] * 6).wait(0.2)).state == "finished"
            assert np.abs(arm.joints).max() > 0.0
