"""What the command line says of accuracy and repeatability."""

from __future__ import annotations

import numpy as np
from rich.table import Table

from ._arguments import Vector
from .iso9283 import Report


def accuracy_tables(report: Report) -> list[Table | str]:
    """Poses and path, in millimetres and milliradians, and what the standard would have."""
    title = f"ISO 9283, {report.cycles} " + ("cycle" if report.cycles == 1 else "cycles")
    table = Table(title=title, title_justify="left", title_style="bold")
    table.add_column("")
    for heading in ("accuracy, mm", "a, b, c, mrad", "repeatability, mm", "a, b, c, ± mrad"):
        table.add_column(heading, justify="right")
    for i, pose in enumerate(report.poses):
        x, y, z = 1e3 * pose.commanded[:3, 3]
        table.add_row(
            f"pose {i + 1} at {x:.1f}, {y:.1f}, {z:.1f}",
            _mm(pose.accuracy),
            _mrad(pose.angle_accuracy),
            _mm(pose.repeatability),
            _mrad(pose.angle_repeatability),
        )
    if report.path is not None:
        table.add_row(
            f"path, at {report.path.places} places",
            _mm(report.path.accuracy),
            _mrad(report.path.angle_accuracy),
            _mm(report.path.repeatability),
            _mrad(report.path.angle_repeatability),
        )
    tables: list[Table | str] = [table]
    if report.cycles < 30:
        tables.append("The standard asks for 30 cycles for poses, 10 for paths.")
    return tables


def _mm(metres: float) -> str:
    return "-" if np.isnan(metres) else f"{1e3 * metres:.4f}"


def _mrad(angles: Vector) -> str:
    return "-" if np.isnan(angles).any() else ", ".join(f"{1e3 * angle:.3f}" for angle in angles)
