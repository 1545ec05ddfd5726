"""What the command line says and keeps of a run: the table, the log and the pictures."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from rich.markup import escape
from rich.table import Table

from ._arguments import writing
from ._job import Job
from ._motion import Motion
from ._plots import DRAWINGS, drawings_for, save_figure, save_plot


def file_stem(script: Path, motion: Motion, taken: set[str]) -> str:
    """Name the files of a motion after script and program, never the same twice."""
    program = re.sub(r"[^\w.-]+", "_", motion.program.name.strip()).strip("_")
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
    certificate = job.motion.certificate
    table = _headed(f"{job.motion.program.name}: {job.state}")
    table.add_row("duration, planned", f"{job.duration:.4f} s")
    table.add_row("wall time, first to last cycle", f"{report.wall_time:.4f} s")
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
    return [table, _share_table(job.motion)]


def motion_tables(motion: Motion) -> list[Table]:
    """Figures of a motion that was planned and not run."""
    table = _headed(f"{motion.program.name}: planned")
    table.add_row("duration", f"{motion.duration:.4f} s")
    table.add_row("path deviation, proven", f"{1e3 * motion.certificate.path_deviation:.4f} mm")
    return [table, _share_table(motion)]


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
    samples = job.log.samples
    for what in drawings_for(job.motion):
        picture = folder / f"{stem}_{what}.png"
        save_figure(DRAWINGS[what](samples, job.motion), picture)
        yield picture


def write_pictures(motion: Motion, folder: Path, stem: str) -> list[Path]:
    """Write the pictures of a planned motion."""
    with writing(folder):
        folder.mkdir(parents=True, exist_ok=True)
    files = []
    for what in ("proof", *drawings_for(motion)):
        files.append(folder / f"{stem}_{what}.png")
        save_plot(motion, files[-1], what)
    return files


def _headed(title: str) -> Table:
    table = Table(title=escape(title), title_justify="left", title_style="bold", show_header=False)
    table.add_column()
    table.add_column(justify="right")
    return table


def _share_table(motion: Motion) -> Table:
    """Worst of each joint as a share of its limit, proven."""
    certificate = motion.certificate
    table = Table()
    table.add_column("worst, % of limit")
    for joint in range(motion.robot.joints):
        table.add_column(f"j{joint + 1}", justify="right")
    for name, shares in (
        ("velocity", certificate.velocity_share),
        ("acceleration", certificate.acceleration_share),
        ("jerk", certificate.jerk_share),
    ):
        table.add_row(name, *(f"{100.0 * share:.1f}" for share in shares))
    return table


def _microseconds(*seconds: float) -> str:
    return " / ".join(f"{1e6 * value:.1f}" for value in seconds) + " µs"
