"""Measure viapoint on this machine and print tables.

Subjects: ``tick`` (one cycle of the interpolator), ``plan`` (planning a move), ``certificate``
(proving a motion), all three in C++ by viapoint-bench; ``sample`` (states of a motion into numpy
arrays) in Python. Each has its place in tools/benches.
"""

import argparse
import json
import sys
from pathlib import Path

from benches import core, sampling, tables
from benches.machine import ROOT, machine
from benches.tables import Row

SUBJECTS = (*core.SUBJECTS, "sample")


def measure(subject: str, options: argparse.Namespace) -> list[Row]:
    """Measure one subject."""
    if subject in core.SUBJECTS:
        return core.measure(options.program, subject, quick=options.quick)
    return sampling.measure(quick=options.quick)


def main(arguments: list[str]) -> int:
    """Measure what was asked for and print it."""
    parser = argparse.ArgumentParser(prog="./tools/bench", description=__doc__)
    parser.add_argument("subjects", nargs="*", metavar="SUBJECT", help=", ".join(SUBJECTS))
    parser.add_argument("--quick", action="store_true", help="fewer repetitions, rougher figures")
    parser.add_argument("--markdown", action="store_true", help="tables for a document")
    parser.add_argument("--json", type=Path, metavar="FILE", help="also write every figure there")
    parser.add_argument(
        "--program",
        type=Path,
        default=ROOT / "build/bench/tools/bench_cpp/viapoint-bench",
        help=argparse.SUPPRESS,
    )
    options = parser.parse_args(arguments)
    if unknown := [name for name in options.subjects if name not in SUBJECTS]:
        parser.error(f"no subject {', '.join(unknown)}; there are {', '.join(SUBJECTS)}")

    about = machine()
    for key, value in about.items():
        print(f"{key + ':':<11} {value}")
    lay_out = tables.markdown if options.markdown else tables.table
    figures: list[Row] = []
    for subject in options.subjects or SUBJECTS:
        rows = measure(subject, options)
        print(f"\n{subject}\n{lay_out(rows)}", flush=True)
        figures += rows
    if options.json:
        text = json.dumps({"machine": about, "figures": figures}, indent=1)
        options.json.write_text(text + "\n", encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
