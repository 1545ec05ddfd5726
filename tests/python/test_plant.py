"""An arm with mass follows setpoints as physics has it: later, by inertia, and exactly at rest."""

import subprocess
import sys

import numpy as np
import pytest

import viapoint as vp
from viapoint import _core, errors

HOMES = {
    "ur5e": np.radians([0, -90, 90, -90, -90, 0]),
    "puma560": np.radians([0, -60, 60, 0, 45, 0]),
    "scara": np.array([0.3, 1.0, 0.1, 0.0]),
    "panda": np.radians([0, -45, 0, -135, 0, 90, 45]),
}


def test_without_mujoco_its_installation_is_the_way_out():
    code = (
        "import sys; sys.modules['mujoco'] = None\n"
        "import viapoint as vp\n"
        "try:\n    vp.MujocoPlant(vp.load_robot('scara'), start=[0, 0, 0, 0])\n"
        "except vp.errors.FileError as error:\n    print(error.ways_out[0])\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "pip install viapoint[mujoco]" in done.stdout


def log_of(robot, start, reach=0.3):
    there = start + reach * np.where(robot.prismatic, 0.1, 1.0)
    motion = vp.Program(robot, start=start).movej(there).wait(0.4).plan()
    return vp.RunLog.of(_core.simulate(motion._core, [], 0.002), motion, 0.002)


def error_at_tool(robot, log):
    off = robot.fk(log.measured)[:, :3, 3] - robot.fk(log.q)[:, :3, 3]
    return np.linalg.norm(off, axis=1)


@pytest.fixture(autouse=True)
def _mujoco(request):
    if "without_mujoco" not in request.node.name:
        pytest.importorskip("mujoco", reason="SKIPPED: pip install viapoint[mujoco]")


@pytest.mark.parametrize("name", HOMES)
def test_the_model_is_the_robots_own_chain(name):
    robot = vp.load_robot(name)
    rng = np.random.default_rng(1)
    for _ in range(20):
        q = HOMES[name] + 0.3 * rng.uniform(-1, 1, robot.joints)
        plant = vp.MujocoPlant(robot, start=q)
        np.testing.assert_allclose(plant.tool, robot.fk(q)[:3, 3], atol=1e-12)


@pytest.mark.parametrize("name", HOMES)
def test_the_following_error_falls_with_the_square_of_the_bandwidth_and_ends_at_rest(name):
    robot = vp.load_robot(name)
    log = log_of(robot, HOMES[name])
    worst = []
    for bandwidth in (50.0, 100.0, 200.0):
        plant = vp.MujocoPlant(robot, start=HOMES[name], bandwidth=bandwidth)
        error = error_at_tool(robot, plant.track(log))
        worst.append(error.max())
        assert error[-1] < 0.02 * error.max()
    assert 2.0 < worst[0] / worst[1] < 5.0
    assert 2.0 < worst[1] / worst[2] < 5.0
    assert 1e-4 < worst[2] < 2e-3


def test_a_heavier_load_is_farther_behind_and_is_carried():
    robot = vp.load_robot("ur5e")
    log = log_of(robot, HOMES["ur5e"])
    worst, efforts = [], []
    for payload in (0.0, 10.0):
        plant = vp.MujocoPlant(robot, start=HOMES["ur5e"], payload=payload)
        worst.append(error_at_tool(robot, plant.track(log)).max())
        efforts.append(plant.effort)
    assert worst[1] != worst[0]
    # At rest the shoulder carries 10 kg more, by their lever about the second axis.
    lever = np.linalg.norm((robot.fk(log.q[-1])[:3, 3] - [0, 0, 0])[:2])
    extra = abs(efforts[1][1] - efforts[0][1])
    assert 0.5 * lever * 98.1 < extra < 1.1 * lever * 98.1


def test_tracking_is_deterministic_and_keeps_the_rest_of_the_log(tmp_path):
    robot = vp.load_robot("scara")
    log = log_of(robot, HOMES["scara"])
    first = vp.MujocoPlant(robot, start=HOMES["scara"]).track(log)
    second = vp.MujocoPlant(robot, start=HOMES["scara"]).track(log)
    np.testing.assert_array_equal(first.measured, second.measured)
    np.testing.assert_array_equal(first.q, log.q)
    first.save(tmp_path / "x.csv")
    read = vp.load_log(tmp_path / "x.csv", robot)
    np.testing.assert_array_equal(read.measured, first.measured)


def test_what_does_not_fit_is_refused(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # MuJoCo leaves a file of its warnings where it runs
    robot = vp.load_robot("scara")
    plant = vp.MujocoPlant(robot, start=HOMES["scara"])
    with pytest.raises(errors.BadArgumentError, match="from where the plant is"):
        plant.track(log_of(robot, HOMES["scara"] + 0.1))
    with pytest.raises(errors.BadArgumentError, match="has 6 joints"):
        plant.track(log_of(vp.load_robot("ur5e"), HOMES["ur5e"]))
    with pytest.raises(errors.BadArgumentError, match="no kinematics"):
        vp.MujocoPlant(vp.joint_robot(1, velocity=1, acceleration=1, jerk=1), start=[0])
    for name in ("density", "bandwidth", "steps"):
        with pytest.raises(errors.BadArgumentError, match=f"{name} is"):
            vp.MujocoPlant(robot, start=HOMES["scara"], **{name: 0})
    with pytest.raises(errors.BadArgumentError, match="unstable"):
        vp.MujocoPlant(robot, start=HOMES["scara"], bandwidth=5e4, steps=1).track(
            log_of(robot, HOMES["scara"])
        )
