"""Points merged into one leg are in the motion file, and what the leg keeps of them is proven."""

import copy
import json
import math

import numpy as np
import pytest

import viapoint as vp
from viapoint import deg, mm, verifier
from viapoint._motion_file import motion_text
from viapoint.verifier._findings import Verdict
from viapoint.verifier._merged_checks import check_merged
from viapoint.verifier._motion_file import read

HOME = deg * [0, -90, 90, -90, -90, 0]


@pytest.fixture(scope="module")
def robot():
    return vp.load_robot("ur5e")


def moved(pose, x, y, turn):
    about_z = np.eye(4)
    about_z[:2, :2] = [[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]]
    result = pose @ about_z
    result[:3, 3] += [x, y, 0.0]
    return result


def dense_arc(robot, zone, turn=0.0, points=30):
    home = robot.fk(HOME)
    program = vp.Program(robot, start=HOME, zone=zone)
    for a in np.linspace(0.0, math.pi / 8, points + 1)[1:]:
        place = (0.1 * math.sin(a), 0.1 - 0.1 * math.cos(a))
        program.movel(moved(home, *place, turn * a))
    return program.plan()


def dense_joints(robot):
    program = vp.Program(robot, start=HOME, zone=vp.joint_deviation(0.002))
    for k in range(1, 41):
        x = k / 40
        program.movej(HOME + np.array([0.5 * x, 0.1 * x * x, 0.0, 0.0, 0.2 * x, 0.0]))
    return program.plan()


def unsealed(document):
    return {key: value for key, value in document.items() if key != "sha256"}


def verdict_of(document):
    return verifier.verify_bytes(verifier.seal(json.dumps(unsealed(document))[:-1] + "\n"))


def findings_of(document):
    """Of the merged points alone: whole motions take a second each."""
    motion = read(verifier.seal(json.dumps(unsealed(document))[:-1] + "\n"))
    verdict = Verdict("", "", 0, 0.0)
    check_merged(motion, verdict)
    return [str(finding) for finding in verdict.findings]


def merged_points(document):
    return [point for leg in document["legs"] for point in leg.get("merged", [])]


MAKERS = {
    "deviation": lambda robot: dense_arc(robot, vp.deviation(0.2 * mm)),
    "radius": lambda robot: dense_arc(robot, vp.radius(2 * mm)),
    "turning": lambda robot: dense_arc(robot, vp.deviation(0.2 * mm, angle=1 * deg), turn=0.3),
    "joints": dense_joints,
}


@pytest.fixture(scope="module", params=MAKERS)
def document(request, robot):
    motion = MAKERS[request.param](robot)
    told = json.loads(motion_text(motion))
    merged = [c for c in motion.corners if c.merged_into is not None]
    assert len(merged) >= 5
    points = merged_points(told)
    assert [p["move"] for p in points] == [c.move for c in merged]
    assert [p["used"] for p in points] == [c.used for c in merged]
    return told


def test_what_is_merged_is_in_the_file_and_proven(document):
    verdict = verdict_of(document)
    assert verdict.holds, verdict.findings
    (proof,) = [p for p in verdict.proofs if p.quantity == "merged points"]
    assert proof.holds
    assert 0.01 < float(proof.worst.split()[0]) <= 0.51


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda p: p.update(used=0.9 * p["used"]), "farther from its leg"),
        (lambda p: p.update(asked=0.5 * p["used"]), "leaves a point's zone"),
        (lambda p: p["at"].__setitem__(2, p["at"][2] + 0.01), "farther from its leg"),
        (lambda p: p.update(move=10**6), "not of the moves before"),
    ],
)
def test_a_false_claim_about_a_merged_point_is_found(document, change, told):
    false = copy.deepcopy(document)
    point = max(merged_points(false), key=lambda p: p["used"])
    change(point)
    findings = findings_of(false)
    assert any(told in finding for finding in findings), findings


def test_points_in_another_order_are_found(document):
    false = copy.deepcopy(document)
    leg = next(leg for leg in false["legs"] if len(leg.get("merged", [])) > 1)
    first, second = leg["merged"][:2]
    first["at"], second["at"] = second["at"], first["at"]
    assert any("go forward" in finding for finding in findings_of(false))


def test_a_turn_beyond_the_angle_of_a_zone_is_found(robot):
    told = json.loads(motion_text(MAKERS["turning"](robot)))
    point = merged_points(told)[2]
    cosine, sine = math.cos(0.05), math.sin(0.05)
    about_x = np.array([[1, 0, 0], [0, cosine, -sine], [0, sine, cosine]])
    point["rotation"] = (about_x @ np.array(point["rotation"])).tolist()
    findings = findings_of(told)
    assert any("turned farther" in f for f in findings), findings
    assert any("turns out of a zone's angle" in f for f in findings), findings


def test_a_radius_that_does_not_reach_the_next_point_is_found(robot):
    told = json.loads(motion_text(MAKERS["radius"](robot)))
    for point in merged_points(told):
        point["asked"] = 1.001 * point["used"]
    assert any("beyond the radius" in finding for finding in findings_of(told))


def test_a_corner_has_only_what_merging_has_left_of_its_zone(robot):
    told = json.loads(motion_text(MAKERS["joints"](robot)))
    corner = next(c for c in told["corners"] if not c["stopped"])
    beside = told["legs"][corner["leg"] : corner["leg"] + 2]
    merged = max(p["used"] for leg in beside for p in leg.get("merged", []))
    assert 0.0 < merged < corner["used"]
    corner["used"] -= 0.1 * merged
    findings = [str(finding) for finding in verdict_of(told).findings]
    assert any("farther apart than claimed" in finding for finding in findings), findings


def test_merged_points_of_random_programs_are_proven():
    rng = np.random.default_rng(11)
    merged = 0
    for name in ("puma560", "scara", "panda"):
        robot = vp.load_robot(name)
        limits = robot.limits
        middle = 0.5 * (limits.position_min + limits.position_max)
        span = np.minimum(0.5 * (limits.position_max - limits.position_min), 1.5)
        for seed in range(3):
            start = middle + 0.2 * span * rng.uniform(-1, 1, len(middle))
            bend = rng.normal(0.0, 0.002, (2, len(middle)))
            program = vp.Program(robot, start=start)
            for k in range(1, 25):
                q = start + span * (0.02 * k * np.cos(bend[0]) + bend[1] * (k / 24) ** 2)
                size = float(10 ** rng.uniform(-4, -2.5))
                program.movej(q, zone=vp.joint_deviation(size))
            told = json.loads(motion_text(program.plan()))
            merged += len(merged_points(told))
            assert findings_of(told) == [], (name, seed)
            here = robot.fk(start)
            program = vp.Program(robot, start=start)
            zones = (vp.deviation, vp.radius)
            for k in range(1, 25):
                step = [0.001 * k, 1e-5 * k * k, 2e-5 * rng.normal()]
                pose = here.copy()
                pose[:3, 3] += step
                program.movel(pose, zone=zones[rng.integers(2)](float(10 ** rng.uniform(-4, -2))))
            if program.check().ok:
                told = json.loads(motion_text(program.plan()))
                merged += len(merged_points(told))
                assert findings_of(told) == [], (name, seed)
    assert merged > 80


@pytest.mark.parametrize(
    ("key", "value"),
    [("at", [0.0]), ("kind", "fine"), ("asked", -1.0), ("used", None), ("rotation", [[1.0]])],
)
def test_a_merged_point_that_is_none_is_refused_by_its_place(document, key, value):
    false = copy.deepcopy(document)
    merged_points(false)[0][key] = value
    with pytest.raises(verifier.MotionFileError, match="merged"):
        findings_of(false)
