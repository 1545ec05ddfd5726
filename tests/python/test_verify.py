"""The verifier proves what holds, and shares nothing with what it verifies."""

import ast
import json
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import viapoint as vp
from viapoint import verifier
from viapoint._motion_file import motion_text
from viapoint.verifier import _joint_checks, _motion_file

FOLDER = Path(verifier.__file__).parent
HOMES = {
    "ur5e": [0, -90, 90, -90, -90, 0],
    "puma560": [0, -100, 130, 0, 60, 0],
    "panda": [0, -45, 0, -135, 0, 90, 45],
    "scara": [20, 60, 0.1, 0],
}


def home_of(robot):
    values = np.array(HOMES[robot.name], dtype=float)
    return np.where(robot.prismatic, values, np.radians(values))


def at_random(seed):
    """From one to three steps of any kind; not every one can be planned."""
    rng = np.random.default_rng(seed)
    robot = vp.load_robot(list(HOMES)[seed % len(HOMES)])
    home = home_of(robot)
    program = vp.Program(robot, start=home, scale=float(rng.choice([1.0, 0.6])), name=f"{seed}")
    step = np.where(robot.prismatic, 0.02, 0.2)

    def joints(reach=1.0):
        return home + reach * step * rng.uniform(-1, 1, robot.joints)

    def target():
        return joints() if robot.joints < 6 else robot.fk(joints())

    for _ in range(int(rng.integers(1, 4))):
        zone = [
            "fine",
            float(rng.uniform(2e-3, 0.03)),
            vp.deviation(float(rng.uniform(1e-3, 1e-2))),
            vp.joint_deviation(float(rng.uniform(1e-3, 0.05))),
        ][rng.integers(4)]
        wishes = {"zone": zone}
        if rng.random() < 0.5:
            name = ["speed", "acceleration", "angular_speed", "angular_acceleration"][
                rng.integers(4)
            ]
            wishes[name] = float(rng.uniform(0.05, 0.5) * (6 if name.endswith("tion") else 1))
        kind = rng.integers(6)
        if kind == 0:
            program.movej(joints(2.0), zone=zone)
        elif kind <= 2:
            program.movel(target(), **wishes)
        elif kind == 3:
            program.movec(target(), target(), **wishes)
        elif kind == 4 and rng.random() < 0.5:
            program.spline([joints() for _ in range(3)], space="joint", zone=zone)
        elif kind == 4 and robot.joints >= 6:
            program.spline([target() for _ in range(3)], **wishes)
        else:
            program.wait(0.05)
    return program


@pytest.fixture(scope="module")
def data(everything):
    return motion_text(everything)


def found(verdict):
    return "\n".join(str(finding) for finding in verdict.findings)


def test_what_was_planned_holds_and_every_quantity_is_proven(data):
    verdict = verifier.verify_bytes(data)
    assert verdict.holds, found(verdict)
    quantities = " ".join(proof.quantity for proof in verdict.proofs)
    for word in ("velocity", "jerk", "curve", "radius", "joint deviation", "speed", "rules"):
        assert word in quantities


@pytest.mark.parametrize("first", range(0, 200, 25))
def test_random_programs_of_four_robots_hold(first):
    planned = 0
    for seed in range(first, first + 25):
        try:
            motion = at_random(seed).plan()
        except vp.MotionError:
            continue
        planned += 1
        verdict = verifier.verify_bytes(motion_text(motion))
        assert verdict.holds, f"seed {seed}:\n{found(verdict)}"
    assert planned >= 10


def test_a_blend_whose_places_are_near_to_two_of_a_curved_leg_holds():
    file = Path(__file__).parents[1] / "data" / "curved_legs.json"
    motion = vp.Program.load(file, vp.load_robot("puma560")).plan()
    assert not motion.corners[0].stopped
    verdict = verifier.verify_bytes(motion_text(motion))
    assert verdict.holds, found(verdict)


def test_what_happens_in_a_late_short_piece_is_found_at_its_rounded_beginning():
    robot = vp.joint_robot(1, velocity=1.0, acceleration=10.0, jerk=100.0)
    planned = vp.Program(robot, start=[0.0]).wait(1e5).movej([1e-7]).plan()
    motion = _motion_file.read(motion_text(planned))
    begin = motion.starts[np.flatnonzero(motion.moves == 1)[0]]
    early = np.array([np.nextafter(begin, 0.0)])
    assert _joint_checks.rates_at(motion, early, 3)[0, 0] == pytest.approx(100.0)


@pytest.mark.parametrize(("most", "wrong"), [(1e3, False), (0.5, True)])
def test_timed_motions_are_held_against_limits_alone(most, wrong):
    robot = vp.joint_robot(2, velocity=[most] * 2, acceleration=[1e3] * 2, jerk=[1e6] * 2)
    q = np.zeros(2)
    program = vp.Program(robot, start=q)
    program.timed([(q, 0.0), (q + 1.0, 1.0), (q - 1.0, 1.0)], t_acc=0.2)
    verdict = verifier.verify_bytes(motion_text(program.plan()))
    assert ("velocity limit is broken" in found(verdict)) == wrong
    assert verdict.holds != wrong  # it starts and ends at speed, and may


def test_the_verifier_uses_numpy_python_and_itself_alone():
    allowed = {"numpy", *sys.stdlib_module_names}
    for source in FOLDER.glob("*.py"):
        for node in ast.walk(ast.parse(source.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                modules = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                modules = [node.module]
            else:
                assert not (isinstance(node, ast.ImportFrom) and node.level > 1), source
                continue
            assert {name.split(".")[0] for name in modules} <= allowed, source


def test_the_verifier_runs_alone_and_its_exit_code_tells(data, tmp_path):
    shutil.copytree(FOLDER, tmp_path / "verifier", ignore=shutil.ignore_patterns("__pycache__"))
    (tmp_path / "good.json").write_bytes(data)
    document = json.loads(data)
    document["legs"][0]["scale"] = 0.3
    del document["sha256"]
    (tmp_path / "bad.json").write_bytes(verifier.seal(json.dumps(document)[:-1]))

    def run(*files):
        command = [sys.executable, "-m", "verifier", *files]
        return subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)

    good, bad = run("good.json"), run("good.json", "bad.json")
    assert good.returncode == 0, good.stdout + good.stderr
    assert "holds" in good.stdout
    assert bad.returncode == 1
    assert "limit is broken" in bad.stdout
    assert run("none.json").returncode == 1
