"""Pictures of a motion: joints against their limits, the tool over time, its path in space."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ._arguments import Vector, choice, file_name, writing
from ._proof_plot import draw_proof
from ._samples import Samples
from .errors import BadArgumentError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._motion import Motion
    from ._robot import Robot

LINE = "#1f5fa8"
LIMIT = "#c0392b"
SWEEP = "#8a8f98"
AXIS_COLOURS = ("#c0392b", "#2e8b57", "#1f5fa8")
PIXELS_PER_INCH = 110
MOST_SAMPLES = 4000

ENDINGS = (".png", ".svg", ".pdf")


@dataclass(frozen=True)
class Subject:
    """What is drawn, besides its samples.

    Attributes
    ----------
    robot : Robot
        Whose limits and kinematics.
    name : str
        The program's.
    duration : float
        [s]
    points : ndarray, (k, 3)
        Tool positions of the program's start and targets [m]; k is 0 where they are not known.
    """

    robot: Robot
    name: str
    duration: float
    points: Vector

    @classmethod
    def of(cls, motion: Motion) -> Subject:
        """Take it from a motion."""
        robot = motion.robot
        points = _target_points(motion) if robot.has_kinematics else np.zeros((0, 3))
        return cls(robot, motion.program.name, motion.duration, points)


def save_plot(motion: Motion, path: str | os.PathLike[str], what: str) -> None:
    """Draw one picture of a planned motion into a file."""
    kind = choice(what, "what", ("proof", "joints", "tool", "path"))
    if Path(file_name(path)).suffix not in ENDINGS:
        raise BadArgumentError(
            f'path is "{file_name(path)}"; a picture ends in {", ".join(ENDINGS)}.'
        )
    samples = motion.sample(max(0.001, motion.duration / MOST_SAMPLES))
    if kind == "proof":
        save_figure(draw_proof(samples, motion), path)
    else:
        save_figure(DRAWINGS[kind](samples, Subject.of(motion)), path)


def save_figure(figure: Figure, path: str | os.PathLike[str]) -> None:
    """Write a figure into a file whose ending names the format."""
    FigureCanvasAgg(figure)
    with writing(path):
        figure.savefig(file_name(path), dpi=PIXELS_PER_INCH)


def draw_joints(samples: Samples, of: Subject) -> Figure:
    """Angles, velocities, accelerations and jerks of every joint over one time axis.

    Parameters
    ----------
    samples : Samples
        What to draw: planned or executed.
    of : Subject
        Whose limits and name to show.
    """
    robot = of.robot
    n = robot.joints
    width = max(7.0, 2.7 * n)
    figure = Figure(figsize=(width, 8.6))
    # Margins in inches; a constrained layout of so many axes takes longer than the drawing.
    figure.subplots_adjust(
        left=0.75 / width,
        right=1 - 0.15 / width,
        bottom=0.105,
        top=0.915,
        wspace=0.5 if any(robot.prismatic) else 0.34,  # mixed units: labels between the columns
        hspace=0.22,
    )
    figure.suptitle(_title(of, "joints against their limits"), fontweight="bold")
    axes = figure.subplots(4, n, sharex=True, squeeze=False)
    limits = robot.limits
    rows = (
        ("position", samples.q, limits.position_min, limits.position_max),
        ("velocity", samples.qd, -limits.velocity, limits.velocity),
        ("acceleration", samples.qdd, -limits.acceleration, limits.acceleration),
        ("jerk", samples.qddd, -limits.jerk, limits.jerk),
    )
    for row, (quantity, values, low, high) in enumerate(rows):
        for joint in range(n):
            scale, unit = _unit(robot, joint, row)
            ax = axes[row, joint]
            _mark_moves(ax, samples)
            ax.plot(samples.t, values[:, joint] * scale, color=LINE, lw=1.3, zorder=3)
            for bound in (low[joint] * scale, high[joint] * scale):
                if np.isfinite(bound):
                    ax.axhline(bound, color=LIMIT, lw=1.0, ls="--")
            ax.grid(alpha=0.25, lw=0.5)
            ax.tick_params(labelsize=8)
            ax.ticklabel_format(axis="y", scilimits=(-3, 4), useMathText=True)
            if joint == 0 or _unit(robot, joint - 1, row)[1] != unit:
                ax.set_ylabel(f"{quantity} [{unit}]", fontsize=9)
            if row == 0:
                ax.set_title(_joint_name(robot, joint), fontsize=10)
            if row == 3:
                ax.set_xlabel("time [s]", fontsize=9)
    axes[0, 0].set_xlim(samples.t[0], samples.t[-1])
    figure.align_ylabels()
    _legend(figure, [("setpoint", LINE, "-"), ("limit", LIMIT, "--"), ("next move", SWEEP, ":")])
    return figure


def draw_tool(samples: Samples, of: Subject) -> Figure:
    """x, y and z of the tool point with velocity and acceleration, and the speed along the path."""
    figure = Figure(figsize=(11.5, 8.0), layout="constrained")
    figure.suptitle(_title(of, "tool point in the base frame"), fontweight="bold")
    axes = figure.subplots(3, 4, sharex=True, squeeze=False)
    rows = (
        ("position", "mm", samples.pose[:, :3, 3] * 1e3),
        ("velocity", "m/s", samples.twist[:, :3]),
        ("acceleration", "m/s²", samples.twist_rate[:, :3]),
    )
    for row, (quantity, unit, values) in enumerate(rows):
        size = np.linalg.norm(values if row else values - values[0], axis=1)
        columns = [*values.T, size]
        for column, curve in enumerate(columns):
            ax = axes[row, column]
            _mark_moves(ax, samples)
            colour = AXIS_COLOURS[column] if column < 3 else "#333333"
            ax.plot(samples.t, curve, color=colour, lw=1.4, zorder=3)
            ax.grid(alpha=0.25, lw=0.5)
            ax.tick_params(labelsize=8)
        axes[row, 0].set_ylabel(f"{quantity} [{unit}]", fontsize=9)
    for column, name in enumerate(("x", "y", "z")):
        axes[0, column].set_title(name, fontsize=11)
    axes[0, 3].set_title("distance from the start", fontsize=10)
    axes[1, 3].set_title("speed", fontsize=10)
    axes[2, 3].set_title("size of the acceleration", fontsize=10)
    for ax in axes[2]:
        ax.set_xlabel("time [s]", fontsize=9)
    axes[0, 0].set_xlim(samples.t[0], samples.t[-1])
    _legend(figure, [("next move", SWEEP, ":")])
    return figure


def draw_path(samples: Samples, of: Subject) -> Figure:
    """Draw the tool's path in space with its approach vectors and the program's points."""
    figure = Figure(figsize=(8.6, 7.6), layout="constrained")
    figure.suptitle(_title(of, "path of the tool"), fontweight="bold")
    ax = figure.add_subplot(projection="3d")
    points = samples.pose[:, :3, 3]
    span = float(max(np.ptp(points, axis=0).max(), 1e-3))
    ax.plot(*points.T, color=LINE, lw=2.2, label="path of the tool")
    arrows = samples.pose[_evenly_along(points, 31)]
    ax.quiver(
        *arrows[:, :3, 3].T,
        *arrows[:, :3, 2].T,
        length=0.09 * span,
        color="#2e8b57",
        lw=1.0,
        arrow_length_ratio=0.3,
        label="approach vector (tool z)",
    )
    targets = of.points
    if len(targets):
        ax.plot(*targets.T, color=SWEEP, lw=1.0, ls="--", label="straight between the points")
        ax.scatter(*targets.T, color=LIMIT, s=34, depthshade=False, label="points of the program")
    for point, label in _labels(targets, 1e-3 * span):
        ax.text(*(point + 0.03 * span), label, fontsize=11, weight="bold")
    low, high = _cube_around(np.vstack([points, targets]))
    ax.set_xlim(low[0], high[0])
    ax.set_ylim(low[1], high[1])
    ax.set_zlim(low[2], high[2])
    ax.set_box_aspect((1, 1, 1))
    ax.set_xlabel("x [m]")
    ax.set_ylabel("y [m]")
    ax.set_zlabel("z [m]")
    ax.view_init(elev=22, azim=-58)
    ax.legend(loc="upper left", fontsize=9, framealpha=0.9)
    return figure


DRAWINGS: dict[str, Callable[[Samples, Subject], Figure]] = {
    "joints": draw_joints,
    "tool": draw_tool,
    "path": draw_path,
}


def drawings_for(robot: Robot) -> list[str]:
    """Name the pictures that this robot allows."""
    return ["joints", "tool", "path"] if robot.has_kinematics else ["joints"]


def _title(of: Subject, what: str) -> str:
    robot, program = of.robot.name, of.name
    name = robot if program in (robot, "program") else f"{robot}, {program}"
    return f"{name}: {what} ({of.duration:.3f} s)"


def _joint_name(robot: Robot, joint: int) -> str:
    names = robot.joint_names
    name = names[joint] if joint < len(names) else ""
    return f"joint {joint + 1}" if name in ("", f"joint{joint + 1}") else f"{joint + 1}: {name}"


def _unit(robot: Robot, joint: int, derivative: int) -> tuple[float, str]:
    """Return the factor and unit people read: degrees, or millimetres for sliding joints."""
    per = ("", "/s", "/s²", "/s³")[derivative]
    if robot.prismatic[joint]:
        return 1e3, "mm" + per
    return 180.0 / np.pi, "°" + per


def _mark_moves(ax: Axes, samples: Samples) -> None:
    """Draw where the program's steps change."""
    for k in np.flatnonzero(np.diff(samples.move)) + 1:
        if samples.move[k] >= 0 and samples.move[k - 1] >= 0:
            ax.axvline(samples.t[k], color=SWEEP, lw=0.9, ls=":", zorder=1)


def _legend(figure: Figure, entries: list[tuple[str, str, str]]) -> None:
    from matplotlib.lines import Line2D

    handles = [Line2D([], [], color=colour, ls=style) for _, colour, style in entries]
    figure.legend(
        handles,
        [name for name, _, _ in entries],
        loc="outside lower center" if figure.get_layout_engine() else "lower center",
        ncols=len(entries),
        frameon=False,
        fontsize=9,
    )


def _target_points(motion: Motion) -> Vector:
    """Tool positions of the program's start and targets, (k, 3) [m]."""
    robot = motion.robot
    points = [robot.fk(motion.program.start)[:3, 3]]
    for step, kind, value in motion._told.targets():
        if kind == "joints":
            arms = [robot, *(arm for first, arm in motion.tools if first < step)]
            points.append(arms[-1].fk(value.reshape(-1))[:3, 3])
        else:
            points.append(value[:3, 3] if kind == "pose" else value.reshape(-1))
    return np.array(points)


def _labels(points: Vector, near: float) -> list[tuple[Vector, str]]:
    """Give every point its number; those that coincide share a label."""
    groups: list[tuple[Vector, list[str]]] = []
    for i, point in enumerate(points):
        name = "start" if i == 0 else str(i)
        for place, names in groups:
            if np.linalg.norm(place - point) <= near:
                names.append(name)
                break
        else:
            groups.append((point, [name]))
    return [(place, ", ".join(names)) for place, names in groups]


def _evenly_along(points: Vector, count: int) -> npt.NDArray[np.intp]:
    """Return indices of samples that lie evenly along the path, not in time."""
    travelled = np.concatenate([[0.0], np.linalg.norm(np.diff(points, axis=0), axis=1).cumsum()])
    wanted = np.linspace(0.0, travelled[-1], count)
    return np.clip(np.searchsorted(travelled, wanted), 0, len(points) - 1)


def _cube_around(points: Vector) -> tuple[Vector, Vector]:
    """Return opposite corners of a cube that holds the points, so that no axis is stretched."""
    centre = (points.min(axis=0) + points.max(axis=0)) / 2.0
    half = max(float(np.ptp(points, axis=0).max()) / 2.0, 1e-3) * 1.12
    return centre - half, centre + half
