"""State-to-state motion beside Ruckig, and by the million.

Every problem is solved by both, one after the other, in this process; each is timed in C++: ours
around ``StateToState::plan``, Ruckig by its own ``calculation_duration``. The quickest of three
solutions counts, for both. Whole calls from Python are timed apart: arrays in, a profile out.
"""

import ctypes
import itertools
import re
import shutil
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from benches.core import read_lines
from benches.tables import Row

JOINTS = (1, 3, 6, 7, 14)
KINDS = ("any state", "rest to rest")
REPEATS = 3
LISTED = 100
"""Of the problems in which one of both is quicker, as many are written down a case."""

Array = npt.NDArray[np.float64]
Solver = Callable[[Array], tuple[float, float]]
"""Takes a problem; gives the duration of the motion [s], NaN without one, and the time taken."""


def problem(kind: str, joints: int, index: int) -> Array:
    """Make a problem after the distributions of Ruckig's own tests, (joints, 12).

    The columns are q, v, a of start and end, and v, a, j limits, each minimum before its maximum.
    """
    random = np.random.default_rng([KINDS.index(kind), joints, index])
    rows = np.zeros((joints, 12))
    rows[:, [0, 3]] = random.normal(0.0, 4.0, (joints, 2))
    if kind == "any state":
        for column, share in ((1, 0.9), (2, 0.8), (4, 0.7), (5, 0.6)):
            moves = random.random(joints) < share
            rows[:, column] = np.where(moves, random.normal(0.0, 0.8, joints), 0.0)
    rows[:, [7, 9, 11]] = random.uniform(0.1, 12.0, (joints, 3))
    rows[:, 7] += np.abs(rows[:, 4])
    rows[:, 9] += np.abs(rows[:, 5])
    # An end has to be reachable from inside its velocity limit.
    needed = np.abs(rows[:, 4]) + rows[:, 5] ** 2 / (2.0 * rows[:, 11])
    rows[:, 7] = np.maximum(rows[:, 7], 1.001 * needed)
    rows[:, [6, 8, 10]] = -rows[:, [7, 9, 11]]
    return rows


def solver_in_cpp(library: Path) -> Solver:
    """Solve by viapoint, timed in C++."""
    plan = ctypes.CDLL(str(library)).viapoint_time_plan
    plan.restype = ctypes.c_double
    duration = ctypes.c_double()

    def solve(rows: Array) -> tuple[float, float]:
        taken = plan(
            rows.ctypes.data_as(ctypes.c_void_p), len(rows), 0, REPEATS, ctypes.byref(duration)
        )
        return duration.value if duration.value >= 0.0 else np.nan, taken

    return solve


def ruckig() -> Any:  # noqa: ANN401  # an extension without types
    """Return the module of Ruckig, None where it is not installed."""
    try:
        import ruckig as module  # type: ignore[import-not-found,unused-ignore]
    except ImportError:
        return None
    return module


def inputs(module: Any, rows: Array) -> Any:  # noqa: ANN401
    """Write a problem as Ruckig takes it."""
    given = module.InputParameter(len(rows))
    given.current_position, given.current_velocity, given.current_acceleration = rows.T[:3]
    given.target_position, given.target_velocity, given.target_acceleration = rows.T[3:6]
    given.max_velocity, given.max_acceleration, given.max_jerk = rows.T[[7, 9, 11]]
    return given


def solver_ruckig(module: Any, joints: int) -> Solver:  # noqa: ANN401
    """Solve by Ruckig, timed by itself."""
    solver = module.Ruckig(joints, 0.001)
    output = module.OutputParameter(joints)
    good = {module.Result.Working, module.Result.Finished}

    def solve(rows: Array) -> tuple[float, float]:
        given = inputs(module, rows)
        best = np.inf
        for _ in range(REPEATS):
            solver.reset()
            try:
                result = solver.update(given, output)
            except RuntimeError:
                return np.nan, np.nan
            if result not in good:
                return np.nan, np.nan
            best = min(best, 1e-6 * output.calculation_duration)
        return output.trajectory.duration, best

    return solve


def whole_calls(module: Any, problems: list[Array]) -> dict[str, float]:  # noqa: ANN401
    """Time calls from Python in turn: arrays in, a profile out."""
    import viapoint as vp

    joints = len(problems[0])
    solver: Any = module.Ruckig(joints) if module else None

    def ours(columns: list[Array]) -> None:
        vp.profile.state_to_state(
            columns[0], columns[3], v0=columns[1], a0=columns[2], v1=columns[4], a1=columns[5],
            v_max=columns[7], a_max=columns[9], j_max=columns[11],
        )  # fmt: skip

    def theirs(columns: list[Array]) -> None:
        given = module.InputParameter(joints)
        given.current_position, given.current_velocity = columns[0], columns[1]
        given.current_acceleration, given.target_position = columns[2], columns[3]
        given.target_velocity, given.target_acceleration = columns[4], columns[5]
        given.max_velocity, given.max_acceleration = columns[7], columns[9]
        given.max_jerk = columns[11]
        solver.calculate(given, module.Trajectory(joints))

    calls = {"python_us": ours} | ({"ruckig_python_us": theirs} if module else {})
    taken: dict[str, list[float]] = {name: [] for name in calls}
    for rows in problems:
        columns = [np.ascontiguousarray(column) for column in rows.T]
        for name, call in calls.items():
            begin = time.perf_counter()
            call(columns)
            taken[name].append(time.perf_counter() - begin)
    return {name: 1e6 * statistics.median(values) for name, values in taken.items()}


def compare(library: Path, kind: str, joints: int, count: int) -> tuple[Row, Row, list[Row]]:
    """Solve `count` problems both ways.

    Returns
    -------
    durations, times : Row
        Of all problems.
    differences : list of Row
        The problems in which one of both is quicker.
    """
    module = ruckig()
    ours = solver_in_cpp(library)
    theirs = solver_ruckig(module, joints) if module else None
    problems = [problem(kind, joints, index) for index in range(count)]
    mine = np.full((count, 2), np.nan)
    other = np.full((count, 2), np.nan)
    for index, rows in enumerate(problems):
        mine[index] = ours(rows)
        if theirs:
            other[index] = theirs(rows)

    subject = f"{kind}, {joints}"
    solved = np.isfinite(mine[:, 0])
    durations: Row = {"bench": "profiles: durations", "case": subject, "problems": count}
    durations["solved"] = int(solved.sum())
    times: Row = {"bench": "profiles: µs a solution", "case": subject}
    mean, p99 = 1e6 * mine[:, 1].mean(), 1e6 * float(np.quantile(mine[:, 1], 0.99))
    times |= {"mean": float(mean), "p99": p99}
    differences: list[Row] = []
    if theirs:
        both = solved & np.isfinite(other[:, 0]) & (other[:, 0] > 0.0)
        ratio = np.where(both, mine[:, 0] / other[:, 0], np.nan)
        shorter, longer = ratio < 1.0 - 1e-9, ratio > 1.0 + 1e-9
        durations |= {
            "ruckig_solved": int(np.isfinite(other[:, 0]).sum()),
            "ratio_min": float(np.nanmin(ratio)),
            "ratio_mean": float(np.nanmean(ratio)),
            "ratio_max_less_1": float(np.nanmax(ratio) - 1.0),
            "ours_shorter": int(shorter.sum()),
            "ours_longer": int(longer.sum()),
        }
        differences = [
            {"kind": kind, "joints": joints, "index": int(i), "ours": float(mine[i, 0]),
             "ruckig": float(other[i, 0])}
            for i in np.flatnonzero(shorter | longer)[:LISTED]
        ]  # fmt: skip
        other_mean = 1e6 * float(np.nanmean(other[:, 1]))
        other_p99 = 1e6 * float(np.nanquantile(other[:, 1], 0.99))
        times |= {"ruckig_mean": other_mean, "ruckig_p99": other_p99}
        times |= {"share_mean": float(mean / other_mean), "share_p99": p99 / other_p99}
    calls = whole_calls(module, problems[: min(count, 2000)])
    times |= calls
    if theirs:
        times["share_python"] = calls["python_us"] / calls["ruckig_python_us"]
    return durations, times, differences


def run(program: Path, *arguments: object) -> list[Row]:
    """Run viapoint-profile-bench; what it says beside figures goes on to the reader."""
    command = [str(program), *map(str, arguments)]
    text = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False).stdout
    figures = [line for line in text.splitlines() if line.startswith("{")]
    for line in text.splitlines():
        if line not in figures:
            print(line)
    if not figures:
        raise RuntimeError(f"{' '.join(command)} printed no figures")
    return read_lines("\n".join(figures))


def instructions(program: Path, kind: str, joints: int, count: int) -> float | None:
    """Count the instructions of one solution with callgrind; None where valgrind is not there."""
    if not shutil.which("valgrind"):
        return None
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null"]
    command += ["--toggle-collect=viapoint::StateToState::plan(*"]
    task = "rest" if kind == "rest to rest" else "plan"
    command += [str(program), task, str(joints), str(count)]
    said = subprocess.run(command, capture_output=True, text=True, check=True).stderr
    collected = re.search(r"Collected\s*:\s*(\d+)", said)
    if not collected:
        raise RuntimeError(f"callgrind counted nothing: {said[-300:]}")
    return int(collected.group(1)) / count


def versions() -> dict[str, str]:
    """Name the peers' versions."""
    if ruckig() is None:
        return {"ruckig": "not installed (pip install 'viapoint[compare]'): ours alone is shown"}
    return {"ruckig": metadata.version("ruckig")}


def measure_sweep(folder: Path, problems: int) -> list[Row]:
    """Solve that many problems in C++ and judge every motion."""
    rows = run(folder / "viapoint-profile-bench", "verify", problems)
    for row in rows:
        row["bench"] = "profiles: judged"
    # One figure a line reads better than a line of twenty.
    return [
        {"bench": row["bench"], "case": key, "value": value}
        for row in rows
        for key, value in row.items()
        if key not in {"bench", "case"}
    ]


def measure(folder: Path, *, quick: bool) -> tuple[list[Row], list[Row]]:
    """Compare with Ruckig, and look at the worst case and at instructions.

    Returns
    -------
    figures, differences : list of Row
    """
    library = next(folder.glob("*viapoint-profile-timing.so"))
    program = folder / "viapoint-profile-bench"
    durations, times, differences = [], [], []
    for kind in KINDS:
        for joints in JOINTS:
            print(f"{kind}, {joints} joints …", file=sys.stderr, flush=True)
            one, two, three = compare(library, kind, joints, 500 if quick else 20_000)
            durations.append(one)
            times.append(two)
            differences += three
    worst = run(program, "worst", 10_000 if quick else 1_000_000)
    for row in worst:
        row["bench"] = "profiles: µs of processor time, limits over six decades"
    counted: list[Row] = []
    for kind, joints in itertools.product(KINDS, JOINTS):
        count = instructions(program, kind, joints, 200 if quick else 2000)
        shown: str | float = "valgrind is not installed" if count is None else round(count)
        counted.append(
            {"bench": "profiles: instructions a solution", "case": f"{kind}, {joints}",
             "instructions": shown}
        )  # fmt: skip
    return durations + times + worst + counted, differences
