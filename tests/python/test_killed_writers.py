"""A process killed at any moment of any write loses nothing of what was saved before."""

import subprocess
import sys

import numpy as np
import pytest

import viapoint as vp
from viapoint import verifier

pytest.importorskip("mcap")

WRITER = """
import sys
import numpy as np
import viapoint as vp
from viapoint import verifier
from viapoint import _core

robot = vp.load_robot("ur5e")
home = np.radians([0, -90, 90, -90, -90, 0])
t = np.arange(0.0, 0.6, 0.002)
s = 0.5 - 0.5 * np.cos(np.pi * t / 0.6)
points = vp.PointList("points.json", robot)
done = len(points)
while True:
    done += 1
    step = 1e-4 * done
    program = vp.Program(robot, start=home, name=f"{done}").movej(home + step)
    motion = program.plan()
    log = vp.RunLog.of(_core.simulate(motion._core, [], 0.002), motion, 0.002)
    q = home + np.outer(s, [0.1 + step, 0, 0, 0, 0, 0])
    fit = vp.Recording.of_samples(robot, t, q).fit(1e-3)
    points.record(f"p{done}", home + step)
    program.save("program.json")
    motion.save("move.motion.json")
    log.save("log.npz")
    log.save("log.csv")
    log.save("log.mcap")
    fit.save("recording.json")
    print(done, flush=True)
"""


@pytest.mark.parametrize("seed", range(4))
def test_a_killed_writer_leaves_the_old_files_or_the_new(tmp_path, seed):
    rng = np.random.default_rng(seed)
    robot = vp.load_robot("ur5e")
    home = np.radians([0, -90, 90, -90, -90, 0])
    acknowledged = 0
    for _ in range(2):
        process = subprocess.Popen(
            [sys.executable, "-c", WRITER], cwd=tmp_path, stdout=subprocess.PIPE, text=True
        )
        assert process.stdout is not None
        # The rounds differ by what was written, and the moment by the machine: never twice alike.
        for _ in range(int(rng.integers(1, 6))):
            acknowledged = int(process.stdout.readline())
        try:
            process.wait(timeout=float(rng.uniform(0.0, 0.05)))
        except subprocess.TimeoutExpired:
            process.kill()
        acknowledged = max([acknowledged, *map(int, process.stdout.read().split())])
        process.stdout.close()
        process.wait()
        points = vp.PointList(tmp_path / "points.json")
        assert acknowledged <= len(points) <= acknowledged + 1
        for i in range(1, acknowledged + 1):
            np.testing.assert_array_equal(points[f"p{i}"], home + 1e-4 * i)
        end = vp.Program.load(tmp_path / "program.json").plan().end
        assert acknowledged <= round((end[0] - home[0]) / 1e-4) <= acknowledged + 1
        verdict = verifier.verify(tmp_path / "move.motion.json")
        assert verdict.holds
        assert acknowledged <= int(verdict.name) <= acknowledged + 1
        for name in ("log.npz", "log.csv", "log.mcap"):
            log = vp.load_log(tmp_path / name, robot)
            written = round((log.q[-1, 0] - home[0]) / 1e-4)
            assert acknowledged <= written <= acknowledged + 1
        fit = vp.load_recording(tmp_path / "recording.json")
        written = round((fit.end[0] - home[0] - 0.1) / 1e-4)
        assert abs(written - acknowledged) <= 10  # the fit is good to its tolerance only
    # The first writer's remains aside are cleared by the next one's write of the same file.
    assert len(list(tmp_path.iterdir())) <= 7 + 1 + 1
