"""Timing along a path, and corners, beside toppra, copp and justblend.

The same path under the same limits for all. A peer that is not installed is named and left out.
Ours is timed in C++ by libviapoint-path-timing, the peers around their Python calls.
"""

import ctypes
import importlib
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from benches.tables import Row

Array = npt.NDArray[np.float64]

PEERS = {"toppra": "toppra", "copp": "copp_py", "justblend": "justblend"}
POINTS, JOINTS = 50, 7
REPEATS = 3
CELLS = (20, 50, 100, 200)
"""Cells of a piece of path without jerk."""


def peer(name: str) -> Any:  # noqa: ANN401  # extensions without types
    """Return the module of a peer, None (and a line on stderr) where it is not installed."""
    try:
        return importlib.import_module(PEERS[name])
    except ImportError:
        print(f"paths: {name} is not installed, so it is left out", file=sys.stderr)
        return None


def versions() -> dict[str, str]:
    """Tell which peers take part."""
    found = {}
    for name, package in {"toppra": "toppra", "copp": "copp-py", "justblend": "justblend"}.items():
        try:
            found[name] = metadata.version(package)
        except metadata.PackageNotFoundError:
            found[name] = "not installed"
    return found


def timed(call: Callable[[], Any]) -> tuple[Any, float]:
    """Return what a call gives, and the seconds that the quickest of some takes."""
    best = np.inf
    for _ in range(REPEATS):
        begin = time.perf_counter()
        given = call()
        best = min(best, time.perf_counter() - begin)
    return given, best


@dataclass(frozen=True)
class Spline:
    """A natural cubic spline through points, a unit of its parameter between two."""

    coefficients: Array
    """Of s⁰ … s³ from the point before on, (pieces, 4, joints)."""

    @classmethod
    def through(cls, points: Array) -> "Spline":
        """Interpolate points, (k, joints)."""
        count = len(points)
        matrix = np.zeros((count, count))
        right = np.zeros_like(points)
        matrix[0, 0] = matrix[-1, -1] = 1.0
        for k in range(1, count - 1):
            matrix[k, k - 1 : k + 2] = 1.0, 4.0, 1.0
            right[k] = 6.0 * (points[k + 1] - 2.0 * points[k] + points[k - 1])
        bend = np.linalg.solve(matrix, right)
        rise = np.diff(points, axis=0) - (2.0 * bend[:-1] + bend[1:]) / 6.0
        return cls(np.stack([points[:-1], rise, bend[:-1] / 2.0, np.diff(bend, axis=0) / 6.0], 1))

    def at(self, s: Array, order: int) -> Array:
        """Return a derivative at places, (k, joints)."""
        piece = np.clip(s.astype(int), 0, len(self.coefficients) - 1)
        u = (s - piece)[:, None]
        value = np.zeros((len(s), self.coefficients.shape[2]))
        for power in range(3, order - 1, -1):
            factor = np.prod([power - k for k in range(order)]) if order else 1.0
            value = value * u + factor * self.coefficients[piece, power]
        return value


@dataclass(frozen=True)
class Problem:
    """A path of joints, and the limits along it."""

    points: Array
    rates: Array
    """Velocity, acceleration, jerk of every joint, (3, joints)."""

    @classmethod
    def random(cls, seed: int) -> "Problem":
        """Draw points within ±0.5, and limits of 1, 5, 50, all ±10 %."""
        random = np.random.default_rng([7, seed])
        points = random.uniform(-0.5, 0.5, (POINTS, JOINTS))
        rates = np.array([[1.0], [5.0], [50.0]]) * random.uniform(0.9, 1.1, (3, JOINTS))
        return cls(points, rates)


class Ours:
    """viapoint, timed in C++."""

    def __init__(self, folder: Path) -> None:
        library = ctypes.CDLL(str(folder / "libviapoint-path-timing.so"))
        self._path = library.viapoint_time_path
        self._walk = library.viapoint_time_walk
        pointer, number = ctypes.c_void_p, ctypes.c_int
        self._path.argtypes = [pointer, number, number, pointer, number, number, pointer]
        self._walk.argtypes = [pointer, number, number, pointer, ctypes.c_double, number, pointer]
        self._path.restype = self._walk.restype = ctypes.c_double

    def path(self, spline: Spline, rates: Array, cells: int) -> tuple[Array, float]:
        """Time a path, without jerk where there are cells.

        Returns
        -------
        result : ndarray, shape (4,)
            Duration [s], and the proven shares of velocity, acceleration and jerk.
        seconds : float
            What it took.
        """
        pieces, _, joints = spline.coefficients.shape
        quintics = np.zeros((pieces, 6, joints))
        quintics[:, :4] = spline.coefficients
        result = np.zeros(4)
        taken = self._path(
            quintics.ctypes.data, pieces, joints, np.ascontiguousarray(rates).ctypes.data,
            cells, REPEATS, result.ctypes.data,
        )  # fmt: skip
        return result, taken

    def walk(self, problem: Problem, deviation: float) -> tuple[Array, float]:
        """Plan straight moves with corners; as path()."""
        points = np.ascontiguousarray(problem.points)
        result = np.zeros(4)
        taken = self._walk(
            points.ctypes.data, len(points), points.shape[1],
            np.ascontiguousarray(problem.rates).ctypes.data, deviation, REPEATS,
            result.ctypes.data,
        )  # fmt: skip
        return result, taken


def acceleration_share(spline: Spline, s: Array, square_rate: Array, limits: Array) -> float:
    """Return the largest share of acceleration between stations, b = ṡ² being linear there."""
    worst = 0.0
    change = 0.5 * np.diff(square_rate) / np.diff(s)
    for part in np.linspace(0.0, 1.0, 11)[1:-1]:
        here = s[:-1] + part * np.diff(s)
        rate = square_rate[:-1] + part * np.diff(square_rate)
        q2 = spline.at(here, 2) * rate[:, None] + spline.at(here, 1) * change[:, None]
        worst = max(worst, float(np.max(np.abs(q2) / limits)))
    return worst


def run_toppra(spline: Spline, problem: Problem, cells: int) -> tuple[float, float, float]:
    """Return duration, seconds taken and the largest share of acceleration."""
    import toppra  # type: ignore[import-not-found,import-untyped,unused-ignore]
    from toppra import algorithm, constraint

    toppra.setup_logging("ERROR")
    pieces = len(spline.coefficients)
    path = toppra.SplineInterpolator(np.arange(pieces + 1.0), problem.points, bc_type="natural")
    stations = np.linspace(0.0, pieces, pieces * cells + 1)
    both = np.array([-1.0, 1.0])
    given = [
        constraint.JointVelocityConstraint(problem.rates[0][:, None] * both),
        constraint.JointAccelerationConstraint(
            problem.rates[1][:, None] * both,
            discretization_scheme=constraint.DiscretizationType.Interpolation,
        ),
    ]

    def solve() -> Any:  # noqa: ANN401
        solver = algorithm.TOPPRA(given, path, gridpoints=stations)
        return solver.compute_parameterization(0.0, 0.0)[1]

    rates, taken = timed(solve)
    duration = float(np.sum(2.0 * np.diff(stations) / (rates[1:] + rates[:-1])))
    share = acceleration_share(spline, stations, rates**2, problem.rates[1])
    return duration, taken, share


def run_copp(spline: Spline, problem: Problem, cells: int) -> tuple[float, float]:
    """Return duration and seconds taken by TOPP3-SOCP, from the solution without jerk on."""
    import copp_py as copp  # type: ignore[import-not-found,unused-ignore]

    pieces = len(spline.coefficients)
    s = np.linspace(0.0, pieces, pieces * cells + 1)
    v, a, j = problem.rates
    values = [np.ascontiguousarray(spline.at(s, order)) for order in range(4)]

    def solve() -> tuple[float, Any]:
        robot = copp.Robot(problem.points.shape[1], capacity=len(s))
        robot.append_s(s)
        robot.set_q(values[0], values[1], values[2], 0, dddq=values[3])
        robot.add_velocity_limits(v, -v, start_idx_s=0, length=len(s))
        robot.add_acceleration_limits(a, -a, start_idx_s=0, length=len(s))
        solver: Any = copp.solver
        second = solver.topp2_ra.Problem(robot.constraints, (0, len(s) - 1), (0.0, 0.0))
        start = solver.topp2_ra.solve(second)
        robot.add_jerk_limits(j, -j, start_idx_s=0, length=len(s))
        third = solver.topp3_socp.Problem(robot.constraints, start, num_stationary_max=1)
        profile = solver.topp3_socp.solve(third)
        return float(copp.interpolation.s_to_t_topp3(s, profile)[0]), profile

    (duration, _), taken = timed(solve)
    return duration, taken


def measure_without_jerk(ours: Ours, *, quick: bool) -> list[Row]:
    """Compare with toppra where jerk does not count, on the same stations."""
    there = peer("toppra") is not None
    rows: list[Row] = []
    for cells in CELLS[: 2 if quick else None]:
        found: dict[str, list[float]] = {"ours": [], "share": [], "ms": []}
        theirs: dict[str, list[float]] = {"ratio": [], "share": [], "ms": []}
        for seed in range(2 if quick else 5):
            problem = Problem.random(seed)
            spline = Spline.through(problem.points)
            (duration, velocity, acceleration, _), taken = ours.path(spline, problem.rates, cells)
            found["share"].append(max(velocity, acceleration))
            found["ms"].append(1e3 * taken)
            if there:
                other, other_taken, share = run_toppra(spline, problem, cells)
                theirs["ratio"].append(duration / other)
                theirs["share"].append(share)
                theirs["ms"].append(1e3 * other_taken)
        row: Row = {"bench": "paths: no jerk", "case": f"{cells} cells a piece"}
        row |= {"worst_share": max(found["share"]), "ms": float(np.median(found["ms"]))}
        if there:
            row |= {
                "time_over_toppra_less_1": float(np.median(theirs["ratio"])) - 1.0,
                "at_most": max(theirs["ratio"]) - 1.0,
                "toppra_worst_share": max(theirs["share"]),
                "toppra_ms": float(np.median(theirs["ms"])),
            }
        rows.append(row)
    return rows


def measure_jerk(ours: Ours, *, quick: bool) -> list[Row]:
    """Compare with copp's TOPP3 by cones, on 20 and 40 stations for each piece of path."""
    there = peer("copp") is not None
    rows: list[Row] = []
    for seed in range(2 if quick else 5):
        problem = Problem.random(seed)
        spline = Spline.through(problem.points)
        result, taken = ours.path(spline, problem.rates, 0)
        row: Row = {"bench": "paths: jerk", "case": f"path {seed}", "s": float(result[0])}
        row |= {"worst_share": float(max(result[1:])), "ms": 1e3 * taken}
        for stations in (20, 40) if there else ():
            duration, other_taken = run_copp(spline, problem, stations)
            row |= {
                f"time_over_copp_{stations}": float(result[0]) / duration,
                f"copp_{stations}_ms": 1e3 * other_taken,
                f"share_of_copp_{stations}_ms": taken / other_taken,
            }
        rows.append(row)
    return rows


def scenarios() -> dict[str, tuple[Problem, float]]:
    """Return the scenarios that justblend publishes, each with its blend radius."""
    space = np.array(
        [[0.0, 0.0, 0.0], [1.0, 0.5, -0.3], [1.5, -0.2, 0.4], [0.5, 0.8, 1.0], [0.0, 0.0, 0.0]]
    )
    plane = np.array([[0.0, 0.0], [1.0, 0.5], [1.5, -0.2], [0.0, 0.0]])
    joints = np.random.default_rng(42).uniform(-1.5, 1.5, (6, 6))
    rates = np.array([[1.5, 1.2, 1.0], [3.0, 2.5, 2.0], [20.0, 18.0, 15.0]])
    equal = np.repeat([[2.0], [5.0], [50.0]], 6, axis=1)
    return {
        "two_segments": (Problem(plane, rates[:, :2]), 0.1),
        "demo_3d": (Problem(space, rates), 0.15),
        "joints_6dof": (Problem(joints, equal), 0.15),
    }


def run_justblend(module: Any, problem: Problem, radius: float) -> tuple[Any, float]:  # noqa: ANN401
    """Return the trajectory of justblend and the seconds it took."""
    generator = module.SCurveTrajectoryGenerator(dim=problem.points.shape[1])
    v, a, j = problem.rates
    generator.set_limits(module.Limits(v_max=v, a_max=a, j_max=j))
    corners = module.CornerHandling.HYBRID
    generator.set_options(module.GenerationOptions(blend_radius=radius, corner_handling=corners))
    return timed(lambda: generator.generate(problem.points))


def measure_corners(ours: Ours) -> list[Row]:
    """Compare with justblend at its own deviation."""
    module = peer("justblend")
    rows: list[Row] = []
    for name, (problem, radius) in scenarios().items():
        stopping, _ = ours.walk(problem, 0.0)
        row: Row = {"bench": "paths: corners", "case": name, "stopping_s": float(stopping[0])}
        if module:
            other, other_taken = run_justblend(module, problem, radius)
            deviation = float(other.max_corner_deviation())
            result, taken = ours.walk(problem, deviation)
            row |= {
                "deviation": deviation,
                "s": float(result[0]),
                "worst_share": float(max(result[1:])),
                "ms": 1e3 * taken,
                "justblend_s": float(other.duration()),
                "time_over_justblend": float(result[0]) / float(other.duration()),
                "justblend_ms": 1e3 * other_taken,
            }
        rows.append(row)
    return rows


def measure(folder: Path, *, quick: bool) -> list[Row]:
    """Measure everything with the library of the benchmarks in `folder`."""
    ours = Ours(folder)
    return [
        *measure_without_jerk(ours, quick=quick),
        *measure_jerk(ours, quick=quick),
        *measure_corners(ours),
    ]
