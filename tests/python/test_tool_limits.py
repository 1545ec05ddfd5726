"""Limits of the tool, and a process speed that is kept."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import viapoint as vp
from viapoint import deg, mm
from viapoint.errors import BadArgumentError

HOME = np.array([10.0, -80.0, 110.0, -120.0, -90.0, 10.0]) * deg


def _pose(x: float, y: float, turn: float = 0.0) -> np.ndarray:
    pose = vp.load_robot("ur5e").fk(HOME)
    pose[:3, 3] += [x, y, 0.0]
    c, s = np.cos(turn), np.sin(turn)
    pose[:3, :3] = pose[:3, :3] @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    return pose


def _twists(motion: vp.Motion) -> np.ndarray:
    samples = motion.sample(1e-3)
    robot = motion.robot
    return np.array([robot.jacobian(q) @ qd for q, qd in zip(samples.q, samples.qd, strict=True)])


def test_the_turning_of_the_tool_is_limited_and_proven() -> None:
    program = vp.Program(vp.load_robot("ur5e"), start=HOME, angular_acceleration=2.0)
    program.movel(_pose(0.05, 0.0, 1.0), angular_speed=0.5)
    motion = program.plan()
    fastest = np.linalg.norm(_twists(motion)[:, 3:], axis=1).max()
    worst = motion.certificate.tool.angular_speed
    assert fastest <= 0.5 * (1 + 1e-9)
    assert fastest == pytest.approx(worst.value, rel=1e-2)
    assert 0.95 <= worst.share <= 1 + 1e-6
    assert 0.0 < worst.time < motion.duration
    assert worst.move == 0
    assert 0.0 < motion.certificate.tool.angular_acceleration.share <= 1 + 1e-6
    assert motion.certificate.tool.speed.share == 0.0


def test_a_process_speed_is_kept_but_where_it_is_said(tmp_path: Path) -> None:
    robot = vp.load_robot("ur5e")
    program = vp.Program(robot, start=HOME, zone=10 * mm, speed=0.3)
    program.movel(_pose(0.05, 0.0))
    program.movel(_pose(0.15, 0.0), process_speed=0.04)
    program.movel(_pose(0.15, 0.1), process_speed=0.04)
    program.movel(_pose(0.2, 0.1))
    program.save(tmp_path / "bead.json")
    again = vp.Program.load(tmp_path / "bead.json", robot)
    motion = again.plan()
    assert motion.duration == program.plan().duration
    lost = sum(s.end - s.start for s in motion.process_stretches)
    assert lost < 0.2
    speeds = np.linalg.norm(_twists(motion)[:, :3], axis=1)
    kept = np.count_nonzero(np.abs(speeds / 0.04 - 1) <= 1e-6)
    assert kept >= 1000 * (0.18 / 0.04)


def test_a_stop_in_a_process_is_a_warning_with_the_line() -> None:
    program = vp.Program(vp.load_robot("ur5e"), start=HOME)
    program.movel(_pose(0.1, 0.0), process_speed=0.04)
    report = program.check()
    assert report.ok
    warnings = [p for p in report.warnings if "process speed" in p.message]
    assert len(warnings) == 2
    assert all(w.line and w.ways_out for w in warnings)
    stretches = program.plan().process_stretches
    assert [s.limit for s in stretches] == ["rest", "rest"]
    assert stretches[0].start == 0.0
    assert stretches[0].end_length == pytest.approx(stretches[0].lowest_speed, abs=0.01)


def test_a_speed_and_a_process_speed_are_one_too_many() -> None:
    program = vp.Program(vp.load_robot("ur5e"), start=HOME)
    with pytest.raises(BadArgumentError, match="process_speed"):
        program.movel(_pose(0.1, 0.0), speed=0.1, process_speed=0.1)
