"""What the command line says and keeps of a run: the table, the log and the pictures."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from rich.markup import escape
from rich.table import Table

from ._arguments import Vector, writing
from ._job import Job
from ._motion import Motion
from ._plots import DRAWINGS, Subject, drawings_for, save_figure, save_plot
from ._stream_job import StreamJob

MOST_LATE = 10
"""So many late steps are listed."""

_CYCLES_SHOWN = 10
"""Of the last ones before a fault; the log has all."""


def file_stem(script: Path, program_name: str, taken: set[str]) -> str:
    """Name the files of a program after it and its script, never the same twice."""
    program = re.sub(r"[^\w.-]+", "_", program_name.strip()).strip("_")
    base = script.stem if program in ("", "program", script.stem) else f"{script.stem}_{program}"
    return unused(base, taken)


def unused(base: str, taken: set[str]) -> str:
    """Take a name; where it is taken, one with a number."""
    name, count = base, 1
    while name in taken:
        count += 1
        name = f"{base}_{count}"
    taken.add(name)
    return name


def run_tables(job: Job) -> list[Table]:
    """Figures of one run: of the run as a whole, and joint by joint."""
    report = job.report
    table = _headed(f"{job.name}: {job.state}")
    table.add_row("duration, planned", f"{job.duration:.4f} s")
    table.add_row("wall time, first to last cycle", f"{report.wall_time:.4f} s")
    if isinstance(job, StreamJob):
        table.add_row("steps that came late", str(job.stream.late_count))
        for late in job.stream.late[:MOST_LATE]:
            table.add_row(
                f"  {escape(Path(late.file).name)}:{late.line}", f"waited {late.waited:.3f} s"
            )
    else:
        certificate = job.motion.certificate
        table.add_row("path deviation, proven", f"{1e3 * certificate.path_deviation:.4f} mm")
        table.add_row("corner cut, proven", f"{1e3 * certificate.zone_deviation:.2f} mm")
    table.add_row("cycles / overruns", f"{report.cycles} / {report.overruns}")
    if report.missed_cycles:
        table.add_row("cycles slept through", str(report.missed_cycles))
    if report.lost_records:
        table.add_row("cycles missing in the log", str(report.lost_records))
    if not np.isnan(report.latency_p50):
        table.add_row(
            "wake-up latency p50 / p99 / max",
            _microseconds(report.latency_p50, report.latency_p99, report.latency_max),
        )
        table.add_row(
            "computing a cycle p50 / p99 / max",
            _microseconds(report.compute_p50, report.compute_p99, report.compute_max),
        )
    if isinstance(job, StreamJob):
        tables = [table, _share_table("worst, % of limit, run", _shares_run(job))]
    else:
        tables = [table, _share_table("worst, % of limit", _shares_proven(job.motion))]
    return [*tables, _last_cycles(job)] if job.state == "fault" else tables


def motion_tables(motion: Motion) -> list[Table]:
    """Figures of a motion that was planned and not run."""
    table = _headed(f"{motion.program.name}: planned")
    table.add_row("duration", f"{motion.duration:.4f} s")
    table.add_row("path deviation, proven", f"{1e3 * motion.certificate.path_deviation:.4f} mm")
    return [table, _share_table("worst, % of limit", _shares_proven(motion))]


def write_log(job: Job, folder: Path, stem: str) -> Iterator[Path]:
    """Write the log of what was executed (CSV and npz), one at a time."""
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    log = job.log
    for ending in ("csv", "npz"):
        log.save(folder / f"{stem}.{ending}")
        yield folder / f"{stem}.{ending}"


def write_run_pictures(job: Job, folder: Path, stem: str) -> Iterator[Path]:
    """Write the pictures of what was executed, one at a time."""
    samples, subject = job.log.samples, _subject_of(job)
    for what in drawings_for(subject.robot):
        picture = folder / f"{stem}_{what}.png"
        save_figure(DRAWINGS[what](samples, subject), picture)
        yield picture


def write_pictures(motion: Motion, folder: Path, stem: str) -> list[Path]:
    """Write the pictures of a planned motion."""
    files = []
    for what in ("proof", *drawings_for(motion.robot)):
        files.append(folder / f"{stem}_{what}.png")
        save_plot(motion, files[-1], what)
    return files


def _subject_of(job: Job) -> Subject:
    """Return what to draw; a stream's points are not kept."""
    if not isinstance(job, StreamJob):
        return Subject.of(job.motion)
    return Subject(job.stream.robot, job.name, job.duration, np.zeros((0, 3)))


def _last_cycles(job: Job) -> Table:
    """Before a fault: where each joint was told to be, and how far off it was measured."""
    log = job.log
    table = Table(title="The last cycles before the fault", title_justify="left")
    for heading in ("cycle", "state"):
        table.add_column(heading)
    for joint in range(log.q.shape[1]):
        table.add_column(f"j{joint + 1} told, measured - told", justify="right")
    for k in range(max(0, len(log) - _CYCLES_SHOWN), len(log)):
        pairs = zip(log.q[k], log.measured[k] - log.q[k], strict=True)
        joints = (f"{told:.5f} {off:+.5f}" for told, off in pairs)
        table.add_row(str(log.cycle[k]), log.STATES[log.state[k]], *joints)
    return table


def _headed(title: str) -> Table:
    table = Table(title=escape(title), title_justify="left", title_style="bold", show_header=False)
    table.add_column()
    table.add_column(justify="right")
    return table


def _share_table(title: str, shares: dict[str, Vector]) -> Table:
    """Worst of each joint as a share of its limit."""
    table = Table()
    table.add_column(title)
    for joint in range(len(shares["velocity"])):
        table.add_column(f"j{joint + 1}", justify="right")
    for name, values in shares.items():
        table.add_row(name, *(f"{100.0 * share:.1f}" for share in values))
    return table


def _shares_proven(motion: Motion) -> dict[str, Vector]:
    certificate = motion.certificate
    return {
        "velocity": certificate.velocity_share,
        "acceleration": certificate.acceleration_share,
        "jerk": certificate.jerk_share,
    }


def _shares_run(job: StreamJob) -> dict[str, Vector]:
    """Worst at the cycles run: a stream's chunks are proven one by one, and dropped."""
    log, limits = job.log, job.stream.robot.limits
    return {
        "velocity": np.abs(log.qd).max(axis=0, initial=0.0) / limits.velocity,
        "acceleration": np.abs(log.qdd).max(axis=0, initial=0.0) / limits.acceleration,
        "jerk": np.abs(log.qddd).max(axis=0, initial=0.0) / limits.jerk,
    }


def _microseconds(*seconds: float) -> str:
    return " / ".join(f"{1e6 * value:.1f}" for value in seconds) + " µs"
