"""What the command line says of accuracy and repeatability."""

from __future__ import annotations

import numpy as np
from rich.table import Table

from ._arguments import Vector
from .iso9283 import Report


def accuracy_tables(report: Report) -> list[Table | str]:
    """Poses, path, speeds and corners, in millimetres and milliradians; how often is asked for."""
    title = f"ISO 9283, {report.cycles} " + ("cycle" if report.cycles == 1 else "cycles")
    table = _table(title, "accuracy, mm", "a, b, c, mrad", "repeatability, mm", "a, b, c, ± mrad")
    for i, pose in enumerate(report.poses):
        table.add_row(
            f"pose {i + 1} at {_place(pose.commanded[:3, 3])}",
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
    if report.speeds:
        speeds = _table("speeds", "AV, %", "RV, ± %", "FV, mm/s")
        for move, found in report.speeds.items():
            speeds.add_row(
                f"move {move} at {1e3 * found.commanded:.1f} mm/s",
                f"{1e2 * found.accuracy:.3f}",
                _share(found.repeatability),
                f"{1e3 * found.fluctuation:.3f}",
            )
        tables.append(speeds)
    if report.corners:
        corners = _table("corners", "round-off CR, mm", "overshoot CO, mm")
        for corner in report.corners:
            corners.add_row(
                f"of moves {corner.moves[0]} and {corner.moves[1]} at {_place(corner.place)}",
                _mm(corner.cornering.rounding),
                _mm(corner.cornering.overshoot),
            )
        tables.append(corners)
    if report.cycles < 30:
        tables.append("The standard asks for 30 cycles for poses, 10 for paths, 3 for corners.")
    return tables


def _table(title: str, *headings: str) -> Table:
    table = Table(title=title, title_justify="left", title_style="bold")
    table.add_column("")
    for heading in headings:
        table.add_column(heading, justify="right")
    return table


def _place(position: Vector) -> str:
    return ", ".join(f"{1e3 * value:.1f}" for value in position)


def _share(share: float) -> str:
    return "-" if np.isnan(share) else f"{1e2 * share:.3f}"


def _mm(metres: float) -> str:
    return "-" if np.isnan(metres) else f"{1e3 * metres:.4f}"


def _mrad(angles: Vector) -> str:
    return "-" if np.isnan(angles).any() else ", ".join(f"{1e3 * angle:.3f}" for angle in angles)
