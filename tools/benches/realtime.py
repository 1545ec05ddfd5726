"""Wake-ups of the 2 ms loop beside cyclictest's (Debian rt-tests), in turn, idle and under load.

cyclictest asks the same of the machine as the loop does, and does nothing else: a thread at
SCHED_FIFO 80 with locked memory and processors kept out of deep sleep (/dev/cpu_dma_latency) that
sleeps until absolute instants 2 ms apart and then reads the clock. So the ratio is what the loop
adds, whatever the machine. Beside it stands a second cyclictest, the same as the first: how far
its quantiles are from the first one's is what the machine alone makes of the ratio.

The three take turns, in every order equally often, so that what the machine does beside them meets
all; the quantiles are over all turns together. Latencies count in whole microseconds, as
cyclictest's do. The load is stress-ng's: a worker a processor, and others that allocate and switch.
"""

import itertools
import os
import re
import shutil
import subprocess
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import numpy as np
import numpy.typing as npt

from benches.tables import Row

Microseconds = npt.NDArray[np.float64]

CYCLE_US = 2000
LONGEST_US = 100_000
"""cyclictest counts wake-ups later than that, and no more."""
BOUNDS_US = (20, 50, 100, 200, 500, 1000, 2000)
"""Of the histogram."""
QUANTILES = {"p50": 50.0, "p99": 99.0, "p99.9": 99.9, "max": 100.0}
REFERENCE, AGAIN, OURS = "cyclictest", "cyclictest again", "viapoint"
SECONDS = 10
"""Of a turn."""


def measure(*, quick: bool) -> list[Row]:
    """Measure all in turn; what is missing on the machine is said in a row."""
    missing = [tool for tool in ("cyclictest", "stress-ng") if shutil.which(tool) is None]
    if "cyclictest" in missing:
        return [{"bench": "realtime", "case": "SKIPPED: no cyclictest (Debian rt-tests)"}]
    rows: list[Row] = []
    for load in ("idle", "stress-ng"):
        if load in missing:
            rows.append({"bench": "realtime", "case": "SKIPPED: no stress-ng"})
            continue
        with stressed(load == "stress-ng"):
            taken = take_turns(1, 2) if quick else take_turns(2, SECONDS)
        rows += figures(load, taken)
    return rows


def take_turns(rounds: int, seconds: int) -> dict[str, Microseconds]:
    """Latencies of each, from six turns a round."""
    ways: dict[str, Callable[[int], Microseconds]] = {
        REFERENCE: cyclictest,
        AGAIN: cyclictest,
        OURS: own_loop,
    }
    taken: dict[str, list[Microseconds]] = {name: [] for name in ways}
    for _ in range(rounds):
        for order in itertools.permutations(ways):
            for name in order:
                taken[name].append(ways[name](seconds))
    return {name: np.concatenate(parts) for name, parts in taken.items()}


@contextmanager
def stressed(wanted: bool) -> Iterator[None]:
    """Load the machine during the block."""
    if not wanted:
        yield
        return
    workers = f"--cpu {os.cpu_count() or 1} --vm 1 --vm-bytes 64M --switch 1 --timer 1"
    load = subprocess.Popen(
        ["stress-ng", "--quiet", *workers.split()],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        yield
    finally:
        load.terminate()
        load.wait()


def cyclictest(seconds: int) -> Microseconds:
    """Wake-up latencies of cyclictest, to the microsecond."""
    command = ["cyclictest", "--quiet", "--mlockall", "--priority=80", "--threads=1"]
    command += [f"--interval={CYCLE_US}", f"--duration={seconds}", f"--histogram={LONGEST_US}"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:  # without the right to real time, as our loop goes on without it
        command = [word for word in command if not word.startswith(("--priority", "--mlockall"))]
        done = subprocess.run(command, capture_output=True, text=True, check=True)
    return read_histogram(done.stdout)


def read_histogram(text: str) -> Microseconds:
    """Latencies from what cyclictest prints, a count a microsecond, and how many were later."""
    counted = [
        (int(found[1]), int(found[2])) for found in re.finditer(r"(?m)^(\d+)\s+(\d+)$", text)
    ]
    late = re.search(r"(?m)^# Histogram Overflows:\s*(\d+)", text)
    values = np.array([value for value, _ in counted], dtype=np.float64)
    counts = np.array([count for _, count in counted], dtype=np.int64)
    beyond = np.full(int(late[1]) if late else 0, float(LONGEST_US))
    return np.concatenate([np.repeat(values, counts), beyond])


def own_loop(seconds: int) -> Microseconds:
    """Wake-up latencies of the loop during a run, to the microsecond."""
    import viapoint as vp

    with vp.connect("sim://ur5e") as arm:
        start = arm.setpoint
        # Most of it at rest: a wait is executed cycle by cycle, like any motion.
        log = arm.run(vp.Program(arm.robot, start=start).movej(start + 0.5).wait(seconds)).log
    return np.floor(np.asarray(log.latency, dtype=np.float64) / 1e3)


def figures(load: str, taken: dict[str, Microseconds]) -> list[Row]:
    """Quantiles of each, their ratios to cyclictest's, and the histograms."""
    rows: list[Row] = []
    for name, latencies in taken.items():
        row: Row = {"bench": "realtime", "case": f"{load}, {name}", "cycles": len(latencies)}
        row |= {f"{key}_us": float(np.percentile(latencies, q)) for key, q in QUANTILES.items()}
        rows.append(row)
    for name in (AGAIN, OURS):
        ratio: Row = {"bench": "realtime", "case": f"{load}, {name} / {REFERENCE}", "cycles": ""}
        ratio |= {
            f"{key}_us": float(
                np.percentile(taken[name], q) / max(np.percentile(taken[REFERENCE], q), 1.0)
            )
            for key, q in QUANTILES.items()
        }
        rows.append(ratio)
    for name, latencies in taken.items():
        histogram: Row = {"bench": "realtime_histogram", "case": f"{load}, {name}"}
        edges = (-np.inf, *BOUNDS_US, np.inf)
        counts, _ = np.histogram(latencies, bins=np.array(edges))
        labels = [f"to_{bound}_us" for bound in BOUNDS_US] + ["later"]
        histogram |= {label: int(count) for label, count in zip(labels, counts, strict=True)}
        rows.append(histogram)
    return rows
