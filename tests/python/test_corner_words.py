"""What the report says of corners that come out otherwise than asked for."""

import numpy as np
import pytest

import viapoint as vp
from viapoint import deg, mm

HOME = deg * [0, -90, 90, -90, -90, 0]
ZONE_CODES = ("zone_shrunk", "zone_is_stop")


@pytest.fixture(scope="module")
def robot():
    return vp.load_robot("ur5e")


def said_of(program):
    report = program.check()
    assert report.ok
    return [p for p in report.warnings if p.code in ZONE_CODES]


@pytest.mark.parametrize("zone", [vp.deviation(0.3), vp.joint_deviation(0.5)])
def test_a_zone_that_is_offered_fits(robot, zone):
    program = vp.Program(robot, start=HOME, zone=zone)
    program.movej(HOME + 0.2).movej(HOME + deg * [20, 0, 30, 0, 0, 0])
    (shrunk,) = said_of(program)
    assert shrunk.code == "zone_shrunk"
    assert "too short" in shrunk.message
    offered = next(way for way in shrunk.ways_out if way.endswith(", which fits"))
    text = offered.removeprefix("zone=").removesuffix(", which fits")
    names = {"mm": mm, "deviation": vp.deviation, "joint_deviation": vp.joint_deviation}
    again = vp.Program(robot, start=HOME, zone=eval(text, names))  # ours, as printed
    again.movej(HOME + 0.2).movej(HOME + deg * [20, 0, 30, 0, 0, 0])
    assert said_of(again) == []


def test_a_radius_that_is_offered_is_the_one_that_was_used(robot):
    program = vp.Program(robot, start=HOME, zone=0.5)
    program.movej(HOME + 0.2).movej(HOME + deg * [20, 0, 30, 0, 0, 0])
    (shrunk,) = said_of(program)
    (corner,) = program.plan().corners
    way = next(way for way in shrunk.ways_out if "as large as was used" in way)
    size = float(way.removeprefix("zone=").split(" ")[0]) * mm
    assert 0.99 * corner.used <= size <= corner.used


def test_a_path_that_turns_back_is_told_to_go_round(robot):
    program = vp.Program(robot, start=HOME, zone=0.02)
    program.movej(HOME + 0.2).movej(HOME)
    (stop,) = said_of(program)
    assert stop.code == "zone_is_stop"
    assert stop.line is not None
    assert stop.move == 0
    assert "turns back" in stop.message
    assert any("goes round" in way for way in stop.ways_out)


def test_a_stop_for_a_tool_is_told_to_be_meant(robot):
    program = vp.Program(robot, start=HOME, zone=0.02)
    longer = np.eye(4)
    longer[2, 3] = 0.1
    program.movej(HOME + 0.2).set_tool(longer).movej(HOME + 0.1)
    (stop,) = said_of(program)
    assert "tool changes" in stop.message
    assert any('zone="fine"' in way for way in stop.ways_out)


def test_every_shrink_and_stop_has_line_reason_and_ways_out(robot):
    rng = np.random.default_rng(5)
    count = 0
    for _ in range(40):
        program = vp.Program(robot, start=HOME)
        zones = (float(rng.uniform(0.001, 0.3)), vp.deviation(0.05), vp.joint_deviation(0.3))
        for _ in range(6):
            where = HOME + rng.uniform(-1, 1, 6) * rng.choice([0.02, 0.5])
            program.movej(where, zone=zones[rng.integers(3)])
        for problem in said_of(program):
            count += 1
            assert problem.line is not None
            assert problem.move is not None
            assert len(problem.message) > len("the zone was shrunk: ")
            assert len(problem.ways_out) == 2, problem.message
    assert count > 20
