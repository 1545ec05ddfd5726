"""Measure viapoint on this machine and print tables.

Subjects: ``tick`` (one cycle of the interpolator), ``commands`` (random commands replayed against
geometry and limits), ``plan`` (planning a move), ``certificate``
(proving a motion), ``walk`` (timing of long paths), ``growth`` (time and memory a move, from ten
moves to a hundred thousand), ``stream`` (hours of moves told while the arm runs, in virtual
time), ``insertion`` (tool curves as joints, every proof checked), ``kinematics`` (inverse
kinematics), ``tracking`` (tool lines followed pose by pose), all in C++ by viapoint-bench;
``sample`` (states of a motion into numpy arrays) and
``programs`` (random programs planned and proven) in Python;
``stops`` (stops on the path beside the shortest that a linear program finds);
``realtime`` (wake-ups of the loop beside cyclictest, idle and under stress-ng);
``remote`` (a controller in a process of its own: calls, heartbeat, latency while clients
misbehave); ``soak`` (programs and streams on the clock for 15 minutes, commanded at random from
four threads: limits, path, memory); ``profiles`` (state to state) beside Ruckig, ``paths`` (timing
along paths, corners) beside toppra, copp and justblend. Each has its place in tools/benches.
"""

import argparse
import datetime
import json
import sys
from pathlib import Path

from benches import (
    core,
    documents,
    kinematics,
    paths,
    profiles,
    programs,
    realtime,
    remote,
    sampling,
    soak,
    soundness,
    stops,
    tables,
)
from benches.machine import ROOT, machine
from benches.tables import Row

SUBJECTS = (
    *core.SUBJECTS,
    "sample",
    "programs",
    "stops",
    "realtime",
    "remote",
    "soak",
    "profiles",
    "paths",
)
BY_THE_MILLION = ("profiles", "programs")
PROGRAMS = 60


def measure(subject: str, options: argparse.Namespace) -> tuple[list[Row], list[Row]]:
    """Measure one subject.

    Returns
    -------
    figures, differences : list of Row
        What is shown, and the cases in which a peer gave another answer, which are only kept.
    """
    if subject in core.SUBJECTS:
        rows = core.measure(options.program, subject, quick=options.quick)
        if subject == "kinematics":
            rows += kinematics.measure(quick=options.quick)
        return rows, []
    if subject == "sample":
        return sampling.measure(quick=options.quick), []
    if subject == "paths":
        return paths.measure(options.program.parent, quick=options.quick), []
    if subject == "stops":
        return stops.measure(options.program, quick=options.quick), []
    if subject == "realtime":
        return realtime.measure(quick=options.quick), []
    if subject == "remote":
        return remote.measure(quick=options.quick), []
    if subject == "soak":
        return soak.measure(options.program, options.minutes, quick=options.quick), []
    if subject == "programs":
        return programs.measure(
            options.program, options.problems or PROGRAMS, quick=options.quick
        ), []
    if options.problems:
        return profiles.measure_sweep(options.program.parent, options.problems), []
    return profiles.measure(options.program.parent, quick=options.quick)


def parse(arguments: list[str]) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(prog="./tools/bench", description=__doc__)
    parser.add_argument("subjects", nargs="*", metavar="SUBJECT", help=", ".join(SUBJECTS))
    parser.add_argument("--quick", action="store_true", help="fewer repetitions, rougher figures")
    parser.add_argument("--markdown", action="store_true", help="tables for a document")
    parser.add_argument(
        "--docs", action="store_true", help="measure all, and write the tables into README and docs"
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="also write every figure there")
    parser.add_argument(
        "--problems",
        type=int,
        metavar="N",
        help="profiles: solve and judge so many, instead of the tables; programs: plan so many",
    )
    parser.add_argument(
        "--minutes", type=float, default=15.0, metavar="M", help="soak: so long (15)"
    )
    parser.add_argument(
        "--program",
        type=Path,
        default=ROOT / "build/bench/tools/bench_cpp/viapoint-bench",
        help=argparse.SUPPRESS,
    )
    options = parser.parse_args(arguments)
    if unknown := [name for name in options.subjects if name not in SUBJECTS]:
        parser.error(f"no subject {', '.join(unknown)}; there are {', '.join(SUBJECTS)}")
    if options.docs and options.subjects:
        parser.error("--docs writes one run into all documents: name no subject")
    alone = [*options.subjects] in ([name] for name in BY_THE_MILLION)
    if options.problems is not None and (options.problems < 1 or not alone):
        parser.error("--problems goes with profiles or programs alone, and is at least 1")
    if not options.minutes > 0:
        parser.error("--minutes is above 0")
    return options


def record(about: dict[str, str], figures: list[Row], differences: list[Row]) -> str:
    """Write everything as JSON, a row a line."""

    def rows(values: list[Row]) -> str:
        return "[\n" + ",\n".join(f"  {json.dumps(row)}" for row in values) + "\n ]"

    parts = [f' "machine": {json.dumps(about)}', f' "figures": {rows(figures)}']
    if differences:
        parts.append(f' "differences": {rows(differences)}')
    return "{\n" + ",\n".join(parts) + "\n}\n"


def main(arguments: list[str]) -> int:
    """Measure what was asked for and print it; 1 when a motion failed or breaks a limit."""
    options = parse(arguments)
    subjects = options.subjects or SUBJECTS
    about = machine()
    if "profiles" in subjects and not options.problems:
        about |= profiles.versions()
    if "paths" in subjects:
        about |= paths.versions()
    for key, value in about.items():
        print(f"{key + ':':<11} {value}")
    lay_out = tables.markdown if options.markdown else tables.table
    figures: list[Row] = []
    differences: list[Row] = []
    for subject in subjects:
        rows, others = measure(subject, options)
        for bench in dict.fromkeys(row["bench"] for row in rows):
            print(
                f"\n{bench}\n{lay_out([row for row in rows if row['bench'] == bench])}", flush=True
            )
        figures += rows
        differences += others
    if worst := soundness.worst_shares(figures):
        print(f"\nworst share\n{lay_out(worst)}", flush=True)
        figures += worst
    if options.docs:
        for document in documents.write(about, figures):
            print(f"wrote {document.relative_to(ROOT)}")
    results = [options.json] if options.json else []
    results += [documents.RESULTS] if options.docs else []
    for path in results:
        about["date"] = datetime.datetime.now(datetime.UTC).isoformat(timespec="seconds")
        path.write_text(record(about, figures, differences), encoding="utf-8")
    failed = any(row["case"] == "failures" and row.get("value") for row in figures)
    return int(failed or soundness.broken(worst))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
