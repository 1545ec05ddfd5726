"""What the Python tests share: the golden numbers and the arms."""

from __future__ import annotations

import json
import re
import shutil
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import viapoint as vp

# A shell's background jobs ignore Ctrl-C, and so would the programs that the tests interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def golden() -> dict[str, Any]:
    return json.loads((ROOT / "tests" / "data" / "golden.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def puma() -> vp.Robot:
    return vp.load_robot("puma560")


@pytest.fixture(scope="session")
def abc(golden: dict[str, Any]) -> dict[str, np.ndarray]:
    """Joints of A, B and C [rad]."""
    return {key: np.radians(value) for key, value in golden["puma560"]["joints_deg"].items()}


@pytest.fixture
def point_file(tmp_path: Path) -> Path:
    return tmp_path / "points.json"


@pytest.fixture
def points(point_file: Path, puma: vp.Robot, abc: dict[str, np.ndarray]) -> vp.PointList:
    """A, B and C, taught into the point file."""
    taught = vp.PointList(point_file, puma)
    for key in "ABC":
        taught.record(key, abc[key])
    return taught


@pytest.fixture
def short(puma: vp.Robot, abc: dict[str, np.ndarray]) -> vp.Program:
    """A joint move of about 0.3 s from A."""
    return vp.Program(puma, start=abc["A"], name="short").movej(abc["A"] + 0.2)


@pytest.fixture(scope="session")
def ur5e() -> vp.Robot:
    return vp.load_robot("ur5e")


@pytest.fixture(scope="session")
def hand(ur5e: vp.Robot) -> vp.Recording:
    """A swing of 1 s at 500 Hz, between rests, with the noise of encoders."""
    t = np.arange(0.0, 1.4, 0.002)
    s = np.clip((t - 0.2) / 1.0, 0.0, 1.0)
    swing = np.outer(s**3 * (10 - 15 * s + 6 * s**2), [0.3, 0.1, -0.1, 0, 0, 0.2])
    q = np.radians([0, -90, 90, -90, -90, 0]) + swing
    q += 2e-5 * np.random.default_rng(7).normal(size=q.shape)
    return vp.Recording.of_samples(ur5e, t, q)


@pytest.fixture(scope="session")
def everything() -> vp.Motion:
    """Joint and tool moves, every kind of zone, a speed, outputs and a wait, planned."""
    robot = vp.load_robot("ur5e")
    q = np.radians([[30, -90, 90, -90, -90, 0], [30, -80, 120, -120, -90, 0]])
    program = vp.Program(
        robot, start=np.radians([0, -90, 90, -90, -90, 0]), scale=0.5, zone=0.02, name="everything"
    )
    program.movej(q[0]).set_do(3, True).movej(q[1])
    pose = robot.fk(q[1])

    def moved(x: float, y: float, z: float) -> np.ndarray:
        there = pose.copy()
        there[:3, 3] += (x, y, z)
        return there

    program.movel(moved(-0.06, 0.05, 0), speed=0.2, zone=vp.deviation(0.003))
    program.movel(moved(-0.06, 0.05, -0.05), zone="fine")
    program.movec(moved(-0.11, 0, -0.05), moved(-0.06, -0.05, -0.05), zone=vp.joint_deviation(0.02))
    return program.movel(moved(-0.06, 0.05, 0)).wait(0.1).plan()


@dataclass
class Served:
    """A viapoint-controller process that serves an arm."""

    process: subprocess.Popen[str]
    port: int

    @property
    def url(self) -> str:
        return f"tcp://127.0.0.1:{self.port}"

    def end(self) -> int:
        """Ask it to end, as a service's manager does, and return its exit code."""
        self.process.terminate()
        return self.process.wait(timeout=60)


@pytest.fixture(scope="session")
def controller() -> str:
    """The viapoint-controller that was built with the package."""
    beside = Path(sys.executable).parent / "viapoint-controller"
    found = str(beside) if beside.exists() else shutil.which("viapoint-controller")
    if found is None:
        pytest.skip("viapoint-controller is not installed: it was NOT tested")
    return found


@pytest.fixture
def serve(controller: str, tmp_path: Path) -> Iterator[Callable[..., Served]]:
    """Start controllers with the configuration given, on a port that the system chooses.

    The heartbeat is long unless told otherwise, so that a loaded machine loses no beat. ``before``
    is called in the new process before the controller begins.
    """
    processes: list[subprocess.Popen[str]] = []

    def start(before: Callable[[], None] | None = None, **keys: object) -> Served:
        config = tmp_path / f"controller{len(processes)}.yaml"
        told = {"robot": "puma560", "listen": "127.0.0.1:0", "heartbeat": 20.0} | keys
        config.write_text(json.dumps(told), encoding="utf-8")  # which is YAML, too
        process = subprocess.Popen(
            [controller, "--config", str(config)],
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=before,
        )
        processes.append(process)
        assert process.stderr is not None
        heard = []
        for line in process.stderr:
            heard.append(line)
            if found := re.search(r"is served at \S+:(\d+)", line):
                return Served(process, int(found.group(1)))
        raise AssertionError("the controller did not start: " + "".join(heard))

    yield start
    for process in processes:
        if process.poll() is None:
            process.kill()
        process.communicate(timeout=60)
