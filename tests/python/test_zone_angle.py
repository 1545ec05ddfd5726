"""Zones that bound the tool's orientation, merged points, and speeds that joints cannot keep."""

import json
import math

import numpy as np
import pytest

import viapoint as vp
from viapoint import deg, mm, verifier
from viapoint._motion_file import motion_text
from viapoint.errors import BadArgumentError

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


def around_a_corner(robot, zone, turn=0.6):
    home = robot.fk(HOME)
    program = vp.Program(robot, start=HOME, zone=zone)
    program.movel(moved(home, 0.06, 0.0, turn)).movel(moved(home, 0.06, 0.06, 0.0))
    return program.plan()


@pytest.mark.parametrize("make", [vp.radius, vp.deviation])
def test_the_angle_or_the_size_of_a_zone_rules_and_the_file_proves_both(robot, make):
    size = 20 * mm if make is vp.radius else 2 * mm
    wide = around_a_corner(robot, make(size, angle=60 * deg))
    (corner,) = wide.corners
    assert not corner.angle_rules
    assert corner.used == pytest.approx(size, rel=0.01)
    assert 0.0 < corner.used_angle < 60 * deg
    tight = around_a_corner(robot, make(size, angle=0.5 * deg))
    (corner,) = tight.corners
    assert corner.angle_rules
    assert corner.asked_angle == 0.5 * deg
    assert 0.98 * corner.asked_angle < corner.used_angle <= corner.asked_angle
    assert corner.used < 0.9 * size
    verdict = verifier.verify_bytes(motion_text(tight))
    assert verdict.holds, verdict.findings
    document = json.loads(motion_text(tight))
    document["corners"][0]["used_angle"] *= 0.8
    del document["sha256"]
    false = verifier.verify_bytes(verifier.seal(json.dumps(document)[:-1] + "\n"))
    assert any("turn" in str(finding) for finding in false.findings)


def test_a_zone_without_an_angle_tells_none(robot):
    (corner,) = around_a_corner(robot, 20 * mm).corners
    assert corner.asked_angle is None
    assert corner.used_angle == 0.0


@pytest.mark.parametrize("angle", [0.0, -0.1, 4.0, math.nan, math.inf, "5"])
def test_an_angle_that_is_none_is_refused_by_name(angle):
    with pytest.raises(BadArgumentError, match="angle"):
        vp.radius(0.02, angle=angle)
    with pytest.raises(BadArgumentError, match="angle"):
        vp.deviation(0.002, angle=angle)


def test_the_angle_of_a_zone_is_written_and_read_back(robot, tmp_path):
    program = vp.Program(robot, start=HOME, zone=vp.deviation(1 * mm, angle=2 * deg))
    home = robot.fk(HOME)
    program.movel(moved(home, 0.1, 0.0, 0.3)).movel(moved(home, 0.1, 0.1, 0.0))
    program.save(tmp_path / "p.json")
    again = vp.Program.load(tmp_path / "p.json", robot)
    (corner,) = again.plan().corners
    assert corner.asked_angle == 2 * deg
    assert corner.used == program.plan().corners[0].used


def test_dense_points_tell_which_leg_they_were_merged_into(robot):
    home = robot.fk(HOME)
    program = vp.Program(robot, start=HOME, zone=vp.deviation(0.1 * mm))
    angles = np.linspace(0.0, math.pi / 6, 61)[1:]
    for a in angles:
        program.movel(moved(home, 0.1 * math.sin(a), 0.1 - 0.1 * math.cos(a), 0.0))
    motion = program.plan()
    merged = [c for c in motion.corners if c.merged_into is not None]
    assert len(motion.corners) == 59
    assert len(merged) > 40
    assert all(c.move < c.merged_into and c.used <= 0.05 * mm for c in merged)
    assert motion.report.ok
    assert not motion.report.warnings
    verdict = verifier.verify_bytes(motion_text(motion))
    assert verdict.holds, verdict.findings
    # Between the chords, inside the circle by the zone at most.
    tool = motion.sample(0.001).pose[:, :3, 3] - home[:3, 3]
    off = np.linalg.norm(tool[:, :2] - [0.0, 0.1], axis=1) - 0.1
    assert np.abs(off).max() <= 0.1 * mm + 0.05 * mm


def test_a_speed_that_the_joints_cannot_keep_is_a_warning_with_one_that_they_can(robot):
    start = deg * [10, -80, 110, -120, -90, 10]
    goal = moved(robot.fk(start), 0.1, 0.0, 0.0)
    goal[:3, 3] += [0.05, 0.3, 0.0]

    def report(speed):
        return vp.Program(robot, start=start).movel(goal, speed=speed).check()

    assert not report(0.1).warnings
    (warning,) = report(5.0).warnings
    assert warning.code == "velocity_limit"
    assert warning.line is not None
    assert warning.joint is not None
    assert warning.value < warning.limit == 5.0
    offered = next(way for way in warning.ways_out if way.startswith("speed="))
    kept = float(offered.removeprefix("speed=").split(",")[0])
    assert not report(kept).warnings


def test_chunks_tell_where_a_process_speed_is_not_held(robot):
    home = robot.fk(HOME)
    program = vp.Program(robot, start=HOME)
    for k in range(1, 5):
        program.movel(moved(home, 0.05 * k, 0.0, 0.0), process_speed=0.05)
    whole = program.plan().process_stretches
    chunks = list(program.chunks())
    told = [stretch for chunk in chunks for stretch in chunk.process_stretches]
    assert [s.move for s in told] == [s.move for s in whole]
    assert sum(len(chunk.report.warnings) for chunk in chunks) == len(whole)
    np.testing.assert_allclose([s.start for s in told], [s.start for s in whole], atol=1e-6)


def test_a_keyword_that_no_move_has_is_refused_by_name(robot):
    program = vp.Program(robot, start=HOME)
    with pytest.raises(TypeError, match="'sped'"):
        program.movel(robot.fk(HOME), sped=0.1)


def test_a_corner_that_turns_the_tool_nowhere_is_proven_to_a_narrow_angle(robot):
    home = robot.fk(HOME)
    program = vp.Program(robot, start=HOME, zone=vp.deviation(0.3 * mm, angle=1e-6))
    # In its own plane this arm keeps the tool's orientation to the last bit.
    for x, z in ((0.02, 0.0), (0.03, 0.015), (0.05, 0.015)):
        pose = home.copy()
        pose[:3, 3] += (x, 0.0, z)
        program.movel(pose)
    verdict = verifier.verify_bytes(motion_text(program.plan()))
    assert verdict.holds, verdict.findings
