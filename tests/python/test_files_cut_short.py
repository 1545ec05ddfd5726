"""A file that is cut short at any byte is refused, or says the same without its last newline."""

import subprocess
from pathlib import Path

import numpy as np
import pytest

import viapoint as vp
from viapoint import _core, verifier
from viapoint.errors import MotionError

ROBOT = vp.load_robot("two_link")
T = np.arange(0.0, 0.03, 0.002)
WAY = np.outer(T, [1.0, 0.5])


def program() -> vp.Program:
    return vp.Program(ROBOT, start=[0, 0]).movej([0.1, 0.2]).wait(0.01)


def playback() -> vp.Playback:
    t = np.arange(0.0, 0.4, 0.002)
    share = 0.5 - 0.5 * np.cos(np.pi * t / 0.4)
    return vp.Recording.of_samples(ROBOT, t, np.outer(share, [0.3, 0.2])).fit(1e-3)


def log() -> vp.RunLog:
    motion = program().plan()
    return vp.RunLog.of(_core.simulate(motion._core, [], 0.002), motion, 0.002)


KINDS = {
    "program.json": (
        lambda path: program().save(path),
        lambda path: vp.Program.load(path, ROBOT).plan().duration,
    ),
    "move.motion.json": (
        lambda path: program().plan().save(path),
        lambda path: verifier.verify(path).holds,
    ),
    "robot.yaml": (ROBOT.save, lambda path: vp.load_robot(str(path)).fingerprint),
    "hand.npz": (
        lambda path: vp.Recording.of_samples(ROBOT, T, WAY).save(path),
        lambda path: vp.Recording.load(path).q.tolist(),
    ),
    "playback.json": (
        lambda path: playback().save(path),
        lambda path: vp.load_recording(path, ROBOT).duration,
    ),
    "points.json": (
        lambda path: vp.PointList(path, ROBOT).record("a", [0.1, 0.2]),
        lambda path: vp.PointList(path, ROBOT)["a"].tolist(),
    ),
    "log.npz": (lambda path: log().save(path), lambda path: vp.load_log(path).q.tolist()),
}
STRIDES = {"move.motion.json": 5, "log.npz": 13}
"""Of the long ones, not every byte; the last hundred are cut one by one."""


@pytest.mark.parametrize("name", KINDS)
def test_a_file_that_is_cut_short_is_refused(tmp_path: Path, name: str) -> None:
    save, read = KINDS[name]
    save(tmp_path / name)
    whole = (tmp_path / name).read_bytes()
    told = read(tmp_path / name)
    cut = tmp_path / f"cut_{name}"
    end = max(0, len(whole) - 100)
    for length in (*range(0, end, STRIDES.get(name, 1)), *range(end, len(whole))):
        cut.write_bytes(whole[:length])
        try:
            found = read(cut)
        except (MotionError, verifier.MotionFileError):
            continue
        assert whole[length:] == b"\n", f"{length} of {len(whole)} bytes were taken for all"
        assert found == told


def test_a_log_as_text_that_is_cut_short_is_refused_or_its_first_cycles(tmp_path: Path) -> None:
    log().save(tmp_path / "log.csv")
    whole = (tmp_path / "log.csv").read_bytes()
    told = vp.load_log(tmp_path / "log.csv", ROBOT)
    cut = tmp_path / "cut.csv"
    for length in range(len(whole) - 700, len(whole)):
        cut.write_bytes(whole[:length])
        try:
            found = vp.load_log(cut, ROBOT)
        except MotionError:
            continue
        np.testing.assert_array_equal(found.measured, told.measured[: len(found)])
        np.testing.assert_array_equal(found.q, told.q[: len(found)])


def test_a_configuration_whose_robot_comes_last_is_not_served_in_part(
    controller: str, tmp_path: Path
) -> None:
    config = tmp_path / "controller.yaml"
    whole = "listen: 127.0.0.1:0\ntool_speed: 0.25\nrobot: puma560\n"
    for length in range(0, len(whole) - 1, 7):
        config.write_text(whole[:length], encoding="utf-8")
        done = subprocess.run(
            [controller, "--config", config],
            capture_output=True,
            text=True,
            timeout=60,
            check=False,
        )
        assert done.returncode == 3, whole[:length]
        assert "controller.yaml" in done.stderr or "robot" in done.stderr, done.stderr
