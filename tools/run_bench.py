"""Measure viapoint on this machine and print tables.

Subjects: ``tick`` (one cycle of the interpolator), ``plan`` (planning a move), ``certificate``
(proving a motion), all three in C++ by viapoint-bench; ``sample`` (states of a motion into numpy
arrays) in Python.
"""

import argparse
import json
import os
import platform
import statistics
import subprocess
import sys
import time
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).parents[1]
Row = dict[str, str | float]

IN_CPP = ("tick", "plan", "certificate")
# What a quick look measures: enough to see the order of magnitude.
QUICK = {"tick": 100_000, "plan": 10, "certificate": 10}


def output_of(*command: str) -> str:
    """Return the first line a command prints, or "unknown" where it is not there."""
    try:
        text = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
    return text.partition("\n")[0].strip()


def machine() -> dict[str, str]:
    """Describe what the figures were measured on, and of what."""
    cpu = "unknown"
    for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            cpu = line.partition(":")[2].strip()
            break
    changed = output_of("git", "status", "--porcelain", "--untracked-files=no") != ""
    commit = output_of("git", "rev-parse", "--short", "HEAD")
    return {
        "viapoint": f"{metadata.version('viapoint')}, commit {commit}"
        + (" and local changes" if changed else ""),
        "processor": f"{cpu}, {os.cpu_count()} cores",
        "system": f"{platform.system()} {platform.release()}, load {os.getloadavg()[0]:.1f}",
        "compiler": output_of("g++", "--version"),
        "python": f"{platform.python_version()}, numpy {metadata.version('numpy')}",
    }


def read_lines(text: str) -> list[Row]:
    """Read what viapoint-bench prints: one JSON object a line.

    Raises
    ------
    ValueError
        A line that is none, or lacks ``bench`` or ``case``.
    """
    rows: list[Row] = []
    for line in filter(None, text.splitlines()):
        try:
            row = json.loads(line)
        except json.JSONDecodeError:
            row = None
        if not isinstance(row, dict) or not {"bench", "case"} <= row.keys():
            raise ValueError(f"viapoint-bench printed {line!r}, no object with bench and case")
        rows.append(row)
    return rows


def measure_cpp(program: Path, subject: str, *, quick: bool) -> list[Row]:
    """Run one subject of viapoint-bench."""
    command = [str(program), subject, *([str(QUICK[subject])] if quick else [])]
    return read_lines(subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout)


def measure_sampling(*, quick: bool) -> list[Row]:
    """Sample a motion of six joints into arrays of q and three derivatives."""
    import numpy as np

    import viapoint as vp

    robot = vp.load_robot("puma560")
    generator = np.random.default_rng(1)
    low, high = 0.5 * robot.limits.position_min, 0.5 * robot.limits.position_max
    program = vp.Program(robot, start=np.zeros(6), zone=vp.joint_deviation(0.02))
    for _ in range(20):
        program.movej(generator.uniform(low, high))
    motion = program.plan()
    rows: list[Row] = []
    for wanted in (1_000, 100_000) if quick else (1_000, 100_000, 1_000_000):
        step = motion.duration / wanted
        times = []
        for _ in range(3 if quick else 9):
            begin = time.perf_counter()
            samples = motion.sample(step)
            times.append(time.perf_counter() - begin)
        median = statistics.median(times)
        rows.append(
            {
                "bench": "sample",
                "case": f"puma560, {motion.pieces} pieces",
                "samples": len(samples.t),
                "p50_ms": 1e3 * median,
                "max_ms": 1e3 * max(times),
                "million_samples_per_s": len(samples.t) / median / 1e6,
            }
        )
    return rows


def layout(value: str | float) -> str:
    """Write a number with four digits, a count in full."""
    if isinstance(value, str):
        return value
    return f"{value:d}" if isinstance(value, int) else f"{value:.4g}"


def table(rows: list[Row]) -> str:
    """Lay rows of one bench out as a table; a checksum is no figure and is left out."""
    keys = [key for key in rows[0] if key not in {"bench", "checksum"}]
    lines = [[key.replace("_", " ") for key in keys]]
    lines += [[layout(row.get(key, "")) for key in keys] for row in rows]
    widths = [max(len(line[column]) for line in lines) for column in range(len(keys))]
    lines.insert(1, ["-" * width for width in widths])
    return "\n".join(
        "  ".join(
            cell.ljust(width) if column == 0 else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(line, widths, strict=True))
        ).rstrip()
        for line in lines
    )


def main(arguments: list[str]) -> int:
    """Measure what was asked for and print it."""
    subjects = (*IN_CPP, "sample")
    parser = argparse.ArgumentParser(prog="./tools/bench", description=__doc__)
    parser.add_argument("subjects", nargs="*", metavar="SUBJECT", help=", ".join(subjects))
    parser.add_argument("--quick", action="store_true", help="fewer repetitions, rougher figures")
    parser.add_argument("--json", type=Path, metavar="FILE", help="also write every figure there")
    parser.add_argument(
        "--program",
        type=Path,
        default=ROOT / "build/bench/tools/bench_cpp/viapoint-bench",
        help=argparse.SUPPRESS,
    )
    options = parser.parse_args(arguments)
    if unknown := [name for name in options.subjects if name not in subjects]:
        parser.error(f"no subject {', '.join(unknown)}; there are {', '.join(subjects)}")

    about = machine()
    for key, value in about.items():
        print(f"{key + ':':<11} {value}")
    figures: list[Row] = []
    for subject in options.subjects or subjects:
        if subject in IN_CPP:
            rows = measure_cpp(options.program, subject, quick=options.quick)
        else:
            rows = measure_sampling(quick=options.quick)
        print(f"\n{subject}\n{table(rows)}", flush=True)
        figures += rows
    if options.json:
        text = json.dumps({"machine": about, "figures": figures}, indent=1)
        options.json.write_text(text + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
