"""Programs planned while they are told."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

import viapoint as vp
from viapoint import verifier

Array = npt.NDArray[np.float64]

MOVES = 150


@pytest.fixture(scope="module")
def robot() -> vp.Robot:
    return vp.joint_robot(3, velocity=[2.0] * 3, acceleration=[20.0] * 3, jerk=[200.0] * 3)


@pytest.fixture(scope="module")
def points() -> Array:
    return np.cumsum(np.random.default_rng(3).uniform(-0.4, 0.4, (MOVES, 3)), axis=0)


def new_program(robot: vp.Robot) -> vp.Program:
    return vp.Program(robot, start=np.zeros(3), zone=vp.joint_deviation(0.02))


def whole_duration(chunks: list[vp.Chunk]) -> float:
    return sum(chunk.begin for chunk in chunks) + chunks[-1].duration


def test_chunks_are_the_motion_of_the_plan(robot: vp.Robot, points: Array) -> None:
    program = new_program(robot)
    for q in points:
        program.movej(q)
    motion = program.plan()
    chunks = list(program.chunks())
    assert [chunk.last for chunk in chunks] == [False] * (len(chunks) - 1) + [True]
    assert whole_duration(chunks) == pytest.approx(motion.duration, rel=0.01)
    corners = [(c.move, c.used) for chunk in chunks for c in chunk.corners]
    assert corners == [(c.move, c.used) for c in motion.corners]
    assert len(program) == MOVES


def test_chunks_join_without_a_step_and_end_at_rest(robot: vp.Robot, points: Array) -> None:
    program = new_program(robot)
    chunks = list(program.chunks(program.movej(q) for q in points))
    assert len(chunks) > 4
    for chunk, after in itertools.pairwise(chunks):
        left, entered = chunk.at([after.begin]), after.at([0.0])
        np.testing.assert_allclose(entered.q, left.q, atol=1e-12)
        np.testing.assert_allclose(entered.qd, left.qd, atol=1e-9)
        np.testing.assert_allclose(entered.qdd, left.qdd, atol=1e-7)
    for chunk in chunks:
        assert chunk.certificate.holds
        assert np.abs(chunk.at([chunk.duration]).qd).max() < 1e-9
    np.testing.assert_allclose(chunks[-1].at([chunks[-1].duration]).q[0], points[-1], atol=1e-12)


def test_the_first_chunk_is_there_after_a_few_moves(robot: vp.Robot, points: Array) -> None:
    told = 0

    def moves(program: vp.Program) -> Iterator[vp.Program]:
        nonlocal told
        for q in points:
            told += 1
            yield program.movej(q)

    program = new_program(robot)
    chunks = program.chunks(moves(program))
    first = next(chunks)
    assert told <= 6
    assert not first.last
    assert "Chunk" in repr(first)
    assert first.pieces > 0


def test_moves_that_were_planned_are_dropped(robot: vp.Robot, points: Array) -> None:
    program = new_program(robot)
    program.movej(points[0])
    for _ in program.chunks(program.movej(q) for q in points[1:]):
        assert len(program) == 1


def test_an_error_comes_where_it_is_met(points: Array) -> None:
    robot = vp.load_robot("puma560")
    program = vp.Program(robot, start=np.zeros(6), zone=vp.joint_deviation(0.01))
    targets = [np.full(6, 0.02 * k) for k in range(1, 20)]
    targets[15][1] = 50.0
    with pytest.raises(vp.errors.JointLimitError) as refused:
        list(program.chunks(program.movej(q) for q in targets))
    assert refused.value.move == 15


def test_chunks_know_the_tools_told_on_the_way() -> None:
    robot = vp.load_robot("puma560")
    home = np.radians([0.0, 25.0, 0.0, 15.0, 50.0, 10.0])
    tool = np.eye(4)
    tool[2, 3] = 0.2

    def tell(program: vp.Program) -> Iterator[vp.Program]:
        yield program.movej(home + 0.1)
        yield program.set_tool(tool)
        for k in range(12):
            yield program.movej(home + 0.02 * k)

    whole = vp.Program(robot, start=home)
    for _ in tell(whole):
        pass
    told = vp.Program(robot, start=home)
    chunks = list(told.chunks(tell(told)))
    assert len(told) == 0
    np.testing.assert_allclose(
        chunks[-1].sample().pose[-1], whole.plan().sample().pose[-1], atol=1e-9
    )
    np.testing.assert_allclose(
        chunks[-1].sample().pose[-1], robot.with_tool(tool).fk(home + 0.22), atol=1e-9
    )


def test_a_motion_stays_what_was_planned(tmp_path: Path) -> None:
    robot = vp.load_robot("puma560")
    home = np.radians([0.0, 25.0, 0.0, 15.0, 50.0, 10.0])
    program = vp.Program(robot, start=home).movej(home + 0.1)
    motion = program.plan()
    program.movej(home + 0.2).movej(home + 9.0)
    motion.save(tmp_path / "m.motion.json")
    assert verifier.verify(tmp_path / "m.motion.json").holds
