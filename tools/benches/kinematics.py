"""Inverse kinematics beside its peers, whole calls from Python, same poses, one after the other.

What is timed is a matrix in and all solutions out. ``./tools/bench kinematics`` gives the times in
C++ besides; EAIK's list of poses is the nearest to that its package has.
"""

import importlib
import sys
import time
from collections.abc import Callable
from importlib import metadata
from typing import Any

import numpy as np
import numpy.typing as npt

from benches.tables import Row

Array = npt.NDArray[np.float64]
Solver = Callable[[Array, Array], Array]
"""Takes a pose (4, 4) and near joints (n,); gives solutions (k, n)."""

# Standard D-H tables: d, a [m], alpha [rad].
TABLES = {
    "puma560": (
        (0.0, 0.0, 0.149, 0.433, 0.0, 0.0),
        (0.0, 0.432, -0.02, 0.0, 0.0, 0.0),
        (-np.pi / 2, 0.0, np.pi / 2, -np.pi / 2, np.pi / 2, 0.0),
    ),
    "ur5e": (
        (0.1625, 0.0, 0.0, 0.1333, 0.0997, 0.0996),
        (0.0, -0.425, -0.3922, 0.0, 0.0, 0.0),
        (np.pi / 2, 0.0, 0.0, np.pi / 2, -np.pi / 2, 0.0),
    ),
}
PACKAGES = {
    "eaik": "EAIK",
    "ur_analytic_ik": "ur-analytic-ik",
    "roboticstoolbox": "roboticstoolbox-python",
}


def installed(module: str) -> Any:  # noqa: ANN401  # extensions without types
    """Return a peer's module, None where it is not installed."""
    try:
        return importlib.import_module(module)
    except ImportError:
        return None


def versions() -> dict[str, str]:
    """Name the peers' versions, and loudly those that are not there."""
    missing = "not installed (pip install 'viapoint[compare]'): left out"
    return {
        package.lower(): metadata.version(package) if installed(module) else missing
        for module, package in PACKAGES.items()
    }


def one_turn(name: str) -> Any:  # noqa: ANN401  # only there once it is installed
    """Load an arm whose joints have one turn each, so that there are eight solutions to find."""
    import viapoint as vp

    robot = vp.load_robot(name)
    wide = np.full(6, np.pi)
    return robot.with_limits(position_min=-wide, position_max=wide)


def solvers_of(name: str) -> dict[str, Solver]:
    """Every solver for this arm that is installed."""
    robot = one_turn(name)
    d, a, alpha = (np.array(column) for column in TABLES[name])
    solvers: dict[str, Solver] = {
        "viapoint ik_all": lambda pose, near: robot.ik_all(pose, near=near),
        "viapoint ik": lambda pose, near: robot.ik(pose, near=near)[None],
    }
    if installed("eaik"):
        eaik = importlib.import_module("eaik.IK_DH").DhRobot(alpha, a, d)
        solvers["EAIK"] = lambda pose, near: eaik.IK(pose).Q
    if (ur := installed("ur_analytic_ik")) and name == "ur5e":
        solvers["ur-analytic-ik"] = lambda pose, near: np.array(
            ur.ur5e.inverse_kinematics(np.ascontiguousarray(pose))
        )
    if rtb := installed("roboticstoolbox"):
        limits = robot.limits
        links = [
            rtb.RevoluteDH(d=d[i], a=a[i], alpha=alpha[i],
                           qlim=[limits.position_min[i], limits.position_max[i]])
            for i in range(6)
        ]  # fmt: skip
        chain = rtb.DHRobot(links).ets()
        solvers["Robotics Toolbox ik_LM"] = lambda pose, near: chain.ik_LM(
            pose, q0=near, tol=1e-14
        )[0][None]
    return solvers


def compare(name: str, poses: int) -> list[Row]:
    """Solve the same poses with every solver, one after the other."""
    robot = one_turn(name)
    random = np.random.default_rng(1)
    joints = random.uniform(robot.limits.position_min, robot.limits.position_max, (poses, 6))
    nears = random.uniform(robot.limits.position_min, robot.limits.position_max, (poses, 6))
    goals = robot.fk_batch(joints)
    solvers = solvers_of(name)
    taken = {key: np.empty(poses) for key in solvers}
    exact = dict.fromkeys(solvers, 0)
    again = dict.fromkeys(solvers, 0)
    branches = dict.fromkeys(solvers, 0)
    for k in range(poses):
        for key, solve in solvers.items():
            begin = time.perf_counter()
            found = solve(goals[k], nears[k])
            taken[key][k] = time.perf_counter() - begin
            if len(found) == 0:
                continue
            off = np.abs(robot.fk_batch(np.asarray(found)) - goals[k]).max(axis=(1, 2))
            right = np.asarray(found)[off < 1e-6]
            exact[key] += int(len(right) > 0)
            branches[key] += len(right)
            apart = np.abs((right - joints[k] + np.pi) % (2.0 * np.pi) - np.pi)
            again[key] += int(len(right) > 0 and bool((apart.max(axis=1) < 1e-5).any()))
    return [
        {
            "bench": "kinematics: whole calls from Python",
            "case": f"{name}, {key}",
            "poses": poses,
            "solved_share": exact[key] / poses,
            "branches": branches[key] / poses,
            "joints_found_share": again[key] / poses,
            "p50_us": 1e6 * float(np.quantile(taken[key], 0.5)),
            "p99_us": 1e6 * float(np.quantile(taken[key], 0.99)),
        }
        for key in solvers
    ]


def measure(*, quick: bool) -> list[Row]:
    """Compare on the arms that closed forms of others serve."""
    for package, version in versions().items():
        print(f"{package}: {version}", file=sys.stderr)
    return [row for name in TABLES for row in compare(name, 1000 if quick else 10_000)]
