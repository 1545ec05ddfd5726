"""Inverse kinematics beside its peers, whole calls from Python, same poses, one after the other.

What is timed is one pose in, in the form that each solver takes, and its solutions out: each
solver's turn comes after all others', which leaves it cold caches, and then by itself. The times
in C++ beside EAIK's core and KDL are ``viapoint-bench kinematics``.
"""

import sys
import time
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from benches.kinematics_peers import LIMIT, TABLES, Array, Solver, peers_of, versions
from benches.tables import Row

BENCH = "kinematics: whole calls from Python"


def one_turn(name: str) -> Any:  # noqa: ANN401  # only there once it is installed
    """Load an arm whose joints have one turn each, so that there are eight solutions to find."""
    import viapoint as vp

    robot = vp.load_robot(name)
    wide = np.full(6, LIMIT)
    return robot.with_limits(position_min=-wide, position_max=wide)


class Tally:
    """What one solver found, and how long it took."""

    def __init__(self, solver: Solver) -> None:
        self.solver = solver
        self.times: list[float] = []
        self.alone: list[float] = []
        self.exact = self.branches = self.again = 0

    def take(self, goal: Array, made_by: Array, near: Array, fk: Callable[[Array], Array]) -> None:
        """Solve one pose and judge the answer by the forward kinematics."""
        prepared = self.solver.prepare(goal)
        begin = time.perf_counter()
        found = self.solver.solve(prepared, near)
        self.times.append(time.perf_counter() - begin)
        if len(found) == 0:
            return
        joints = np.asarray(found)
        off = np.abs((self.solver.forward or fk)(joints) - goal).max(axis=(1, 2))
        right = joints[off < 1e-6]
        self.exact += int(len(right) > 0)
        self.branches += len(right)
        apart = np.abs((right - made_by + np.pi) % (2.0 * np.pi) - np.pi)
        self.again += int(len(right) > 0 and bool((apart.max(axis=1) < 1e-5).any()))

    def run_alone(self, goals: Array, nears: Array) -> None:
        """Time the solver with no other in between."""
        solve = self.solver.solve
        for goal, near in zip([self.solver.prepare(goal) for goal in goals], nears, strict=True):
            begin = time.perf_counter()
            solve(goal, near)
            self.alone.append(time.perf_counter() - begin)

    def row(self, arm: str) -> Row:
        """Sum up."""
        count = len(self.times)
        row: Row = {
            "bench": BENCH,
            "case": f"{arm}, {self.solver.name}",
            "poses": count,
            "solved_share": self.exact / count,
            "branches": self.branches / count,
            "p50_us": 1e6 * float(np.quantile(self.times, 0.5)),
            "p99_us": 1e6 * float(np.quantile(self.times, 0.99)),
            "alone_p50_us": 1e6 * float(np.quantile(self.alone, 0.5)),
        }
        if self.solver.forward is None:
            row["joints_found_share"] = self.again / count
        return row


def compare(name: str, poses: int) -> list[Row]:
    """Solve the same poses with every solver, one after the other, and each by itself."""
    robot = one_turn(name)
    random = np.random.default_rng(1)
    joints, nears = random.uniform(-LIMIT, LIMIT, (2, poses, 6))
    goals = robot.fk_batch(joints)
    ours = [
        Solver("viapoint ik_all", lambda pose, near: robot.ik_all(pose, near=near)),
        Solver("viapoint ik", lambda pose, near: robot.ik(pose, near=near)[None]),
    ]
    peers = peers_of(name)
    tallies = [Tally(solver) for solver in ours + peers]
    for k in range(poses):
        for tally in tallies:
            if k % tally.solver.every == 0:
                tally.take(goals[k], joints[k], nears[k], robot.fk_batch)
    for tally in tallies:
        tally.run_alone(goals[:: tally.solver.every], nears[:: tally.solver.every])
    return [tally.row(name) for tally in tallies] + batches(name, robot, peers, goals, nears)


def batches(
    name: str,
    robot: Any,  # noqa: ANN401
    peers: list[Solver],
    goals: Array,
    nears: Array,
) -> list[Row]:
    """Time many poses in one call, by the pose."""
    calls: dict[str, Callable[[], object]] = {
        "viapoint ik_batch, all in one call, a pose": lambda: robot.ik_batch(goals, near=nears)
    }
    listed = list(goals)
    for solver in peers:
        if (batch := solver.batch) is not None:
            calls[f"{solver.name}, all in one call, a pose"] = partial(batch, listed)
    rows: list[Row] = []
    for case, call in calls.items():
        times = []
        for _ in range(7):
            begin = time.perf_counter()
            call()
            times.append((time.perf_counter() - begin) / len(goals))
        rows.append(
            {
                "bench": BENCH,
                "case": f"{name}, {case}",
                "poses": len(goals),
                "alone_p50_us": 1e6 * float(np.median(times)),
            }
        )
    return rows


def measure(*, quick: bool) -> list[Row]:
    """Compare on the arms that closed forms of others serve."""
    for package, version in versions().items():
        print(f"{package}: {version}", file=sys.stderr)
    return [row for name in TABLES for row in compare(name, 1000 if quick else 10_000)]
