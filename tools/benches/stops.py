"""Stops on the path beside the shortest that the limits allow from the same state.

``viapoint-bench stops`` prints stops from random moments of random motions. For each the shortest
stop in whole cycles is looked for with a linear program. Its unknowns are the rate r of nominal
time and its slope a at every cycle's beginning, and its curvature g, constant within the cycle.
With q1, q2, q3 the path's derivatives by nominal time, accelerations are q2 r^2 + q1 a and jerks
q3 r^3 + 3 q2 r a + q1 g: linear about a guess of the way. The least worst share of the limits is
asked for, and the answer is the next guess; the fewest cycles with a share of 1 are searched
for. The limits are asked for at some instants of each cycle, while ours are proven in
between, too: so what is found is rather too short than too long.
"""

import importlib
import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from benches.tables import Row

Array = npt.NDArray[np.float64]

CYCLE = 2e-3
STOPS = 40
GUESSES = 8
INSTANTS = np.array([0.0, 0.5, 1.0])
"""Of each cycle, at which limits are asked for."""
SLACK = 1.003
"""Of the limits at the optimum, as the linear program's answer is one of an approximation."""
LONGEST = 200
"""Cycles of stops that are looked at."""
CLASSES = ((1, 10), (10, 30), (30, LONGEST + 1))
"""Stops of so many cycles together: of a few cycles, one more is much."""


@dataclass(frozen=True)
class Stop:
    """A stop of ours, and the path about it."""

    acceleration: Array
    jerk: Array
    rate: Array
    """At every cycle's beginning and at rest, (cycles + 1,)."""
    spacing: float
    path: Array
    """First to third derivative every `spacing` of nominal time, (samples, 3, joints)."""

    @property
    def cycles(self) -> int:
        """How many it takes."""
        return len(self.rate) - 1

    def derivatives(self, tau: Array) -> Array:
        """Return the path's derivatives at nominal times [s] of any shape, (3, *shape, joints)."""
        x = np.clip(tau / self.spacing, 0.0, len(self.path) - 1.001)
        k = x.astype(int)
        part = (x - k)[..., None, None]
        between = self.path[k] * (1.0 - part) + self.path[k + 1] * part
        return np.moveaxis(between, -2, 0)


def measure(maker: Path, *, quick: bool) -> list[Row]:
    """Compare so many stops; without scipy, say so and nothing more."""
    try:
        importlib.import_module("scipy.optimize")
    except ImportError:
        print("stops: scipy is not installed, so they are left out", file=sys.stderr)
        return []
    command = [str(maker), "stops", str(5 if quick else STOPS)]
    text = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout
    found: list[tuple[str, int, int]] = []
    for line in text.splitlines():
        row = json.loads(line)
        stop = read(row)
        if 1 <= stop.cycles <= LONGEST:
            found.append((row["case"], stop.cycles, fewest_cycles(stop)))
    return figures(found)


def read(row: dict[str, Any]) -> Stop:
    """Read a line of viapoint-bench."""
    limits = np.array(row["acceleration"], dtype=float)
    return Stop(
        acceleration=limits,
        jerk=np.array(row["jerk"], dtype=float),
        rate=np.array(row["rate"], dtype=float),
        spacing=float(row["spacing"]),
        path=np.array(row["path"], dtype=float).reshape(-1, 3, len(limits)),
    )


def fewest_cycles(stop: Stop) -> int:
    """Fewest cycles in which it can be done, no more than ours."""
    least, best, step = 0, stop.cycles, 1
    while best - least > 1:
        # At first from ours downward, twice as far each time: most are near.
        tried = max(best - step, (least + best) // 2) if step else (least + best) // 2
        if worst_share(stop, tried) <= SLACK:
            best, step = tried, 2 * step
        else:
            least, step = tried, 0
    return best


def worst_share(stop: Stop, cycles: int) -> float:
    """Least share of the limits that a stop of so many cycles is found to need."""
    nodes = np.linspace(0.0, stop.cycles, cycles + 1)
    rate = np.interp(nodes, np.arange(stop.cycles + 1), stop.rate)
    slope = np.concatenate([[0.0], np.diff(rate) / CYCLE])
    way = Way(rate[0], np.diff(slope) / CYCLE)
    least = np.inf
    for _ in range(GUESSES):
        curvature = better(stop, way)
        if curvature is None:
            break
        before, way = way, Way(way.first_rate, curvature)
        least = min(least, way.share(stop))
        if least <= 1.0 or np.abs(way.tau - before.tau).max() < 1e-5 * max(way.tau.max(), CYCLE):
            break
    return float(least)


class Way:
    """The rate from a slope of 0 on, at the instants of every cycle, (instants, cycles)."""

    def __init__(self, first_rate: float, curvature: Array) -> None:
        self.first_rate = first_rate
        self.curvature = curvature
        slope = np.concatenate([[0.0], np.cumsum(CYCLE * curvature)])[:-1]
        steps = CYCLE * (slope + 0.5 * CYCLE * curvature)
        rate = first_rate + np.concatenate([[0.0], np.cumsum(steps)])[:-1]
        times = CYCLE * (rate + CYCLE * (0.5 * slope + CYCLE / 6.0 * curvature))
        tau = np.concatenate([[0.0], np.cumsum(times)])[:-1]
        x = CYCLE * INSTANTS[:, None]
        self.slope = slope + x * curvature
        self.rate = rate + x * (slope + 0.5 * x * curvature)
        self.tau = tau + x * (rate + x * (0.5 * slope + x / 6.0 * curvature))

    def share(self, stop: Stop) -> float:
        """Worst share of a limit."""
        first, second, third = stop.derivatives(self.tau)
        rate, slope = self.rate[..., None], self.slope[..., None]
        acceleration = second * rate**2 + first * slope
        jerk = third * rate**3 + 3.0 * second * rate * slope + first * self.curvature[:, None]
        shares = np.abs(acceleration / stop.acceleration), np.abs(jerk / stop.jerk)
        return float(max(share.max() for share in shares))


def better(stop: Stop, way: Way) -> Array | None:
    """Curvatures of the best stop as it looks from a guess; None where there is none.

    With h the cycle, unknowns are r and h a at every cycle's beginning and at the end, h^2 g of
    every cycle, so that all are of one size, and the share.
    """
    sparse = importlib.import_module("scipy.sparse")  # a package without types
    count = len(way.curvature)
    limits, constant = limit_rows(stop, way)
    share = np.full((limits.shape[0], 1), -1.0)
    bounds: list[tuple[float | None, float | None]] = [(0.0, 1.0)] * (count + 1)
    bounds += [(None, None)] * (2 * count + 1) + [(0.0, None)]
    bounds[0], bounds[count] = (way.first_rate, way.first_rate), (0.0, 0.0)
    bounds[count + 1] = bounds[2 * count + 1] = (0.0, 0.0)
    answer = importlib.import_module("scipy.optimize").linprog(
        np.concatenate([np.zeros(3 * count + 2), [1.0]]),
        A_ub=sparse.vstack(
            [sparse.hstack([limits, share]), sparse.hstack([-limits, share])]
        ).tocsr(),
        b_ub=np.concatenate([-constant, constant]),
        A_eq=cycle_rows(count),
        b_eq=np.zeros(2 * count),
        bounds=bounds,
        method="highs",
    )
    if answer.status != 0:
        return None
    return np.asarray(answer.x)[2 * count + 2 : 3 * count + 2] / CYCLE**2


def limit_rows(stop: Stop, way: Way) -> tuple[Any, Array]:
    """Accelerations and jerks as shares of their limits: rows of the unknowns, and constants."""
    sparse = importlib.import_module("scipy.sparse")
    first, second, third = stop.derivatives(way.tau)
    rate, slope = way.rate[..., None], way.slope[..., None]
    x = INSTANTS[:, None, None]

    def of_cycle(by_rate: Array, by_slope: Array, by_curvature: Array) -> Array:
        """From coefficients at an instant to those of its cycle's r, h a and h^2 g."""
        return np.stack(
            [
                by_rate,
                by_slope + x * by_rate,
                by_curvature + x * by_slope + 0.5 * x**2 * by_rate,
            ],
            axis=-1,
        )

    share = 1.0 / stop.acceleration
    rows = [of_cycle(share * 2.0 * second * rate, share * first / CYCLE, np.zeros_like(first))]
    constants = [-share * second * rate**2]
    share = 1.0 / stop.jerk
    rows.append(
        of_cycle(
            share * 3.0 * (third * rate**2 + second * slope),
            share * 3.0 * second * rate / CYCLE,
            share * first / CYCLE**2,
        )
    )
    constants.append(-share * (2.0 * third * rate**3 + 3.0 * second * rate * slope))

    values = np.stack(rows).reshape(-1, 3)
    count = len(way.curvature)
    cycle = np.broadcast_to(np.arange(count)[:, None], (2, *first.shape)).reshape(-1)
    columns = cycle[:, None] + (count + 1) * np.arange(3)
    places = np.repeat(np.arange(len(values)), 3), columns.ravel()
    matrix = sparse.csr_matrix((values.ravel(), places), shape=(len(values), 3 * count + 2))
    return matrix, np.stack(constants).ravel()


def cycle_rows(count: int) -> Any:  # noqa: ANN401  # as sparse is
    """How each cycle's end follows from its beginning, as rows of the unknowns and the share."""
    sparse = importlib.import_module("scipy.sparse")
    steps, ones = np.arange(count), np.ones(count)
    rates, slopes, curvatures = steps, count + 1 + steps, 2 * (count + 1) + steps
    values = np.concatenate([ones, -ones, -ones, ones, -ones, -ones, -0.5 * ones])
    rows = np.concatenate([steps] * 3 + [count + steps] * 4)
    columns = [slopes + 1, slopes, curvatures, rates + 1, rates, slopes, curvatures]
    return sparse.csr_matrix(
        (values, (rows, np.concatenate(columns))), shape=(2 * count, 3 * count + 3)
    )


def figures(found: list[tuple[str, int, int]]) -> list[Row]:
    """Quantiles of our cycles over the fewest, for each kind and each class of lengths."""
    groups = {kind: [f for f in found if f[0] == kind] for kind, _, _ in found}
    for low, high in CLASSES:
        groups[f"{low} to {high - 1} cycles"] = [f for f in found if low <= f[1] < high]
    groups["all"] = found
    rows: list[Row] = []
    for case, some in groups.items():
        if not some:
            continue
        ours, fewest = np.array([f[1:] for f in some], dtype=float).T
        row: Row = {"bench": "stops", "case": case, "stops": len(some)}
        row |= {"our_cycles": float(np.median(ours)), "fewest_cycles": float(np.median(fewest))}
        for name, q in (("p50", 50), ("p90", 90), ("max", 100)):
            row[f"ratio_{name}"] = float(np.percentile(ours / fewest, q))
        row["ratio_of_sums"] = float(ours.sum() / fewest.sum())
        row["within_a_tenth"] = float((ours <= 1.1 * fewest).mean())
        row["within_a_tenth_or_a_cycle"] = float(
            (ours <= np.maximum(1.1 * fewest, fewest + 1)).mean()
        )
        row["most_cycles_more"] = int((ours - fewest).max())
        rows.append(row)
    return rows
