"""One picture of a motion and its proof: path, zones, what limits it when, and its deviation."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Line3DCollection  # type: ignore[import-untyped]  # it brings no types

from ._arguments import Vector
from ._motion_file import motion_text
from ._ruling import KINDS, shares_at
from .verifier import MotionFile, deviations, read, scales_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ._motion import Motion
    from ._samples import Samples

COLOURS = {
    "velocity": "#1f5fa8",
    "acceleration": "#e08a1e",
    "jerk": "#8e3a9d",
    "other": "#8a8f98",
    "rest": "#d0d3d8",
}
NAMES = {"other": "no joint at its limit"}
ZONE = "#2e8b57"
STOP = "#c0392b"
JOINT_COLOURS = (
    "#1f77b4", "#ff7f0e", "#2ca02c", "#d62728", "#9467bd", "#8c564b", "#e377c2", "#17becf",
)  # fmt: skip


def draw_proof(samples: Samples, motion: Motion) -> Figure:
    """Draw the tool's path with its zones, shares of the limits over time, and the deviation.

    Along path and time the colour tells which kind of limit holds the motion back there; of every
    joint's shares the one that does is drawn thick.
    """
    document = read(motion_text(motion))
    in_space = motion.robot.has_kinematics
    figure = Figure(figsize=(14.5, 8.8) if in_space else (9.5, 8.2), layout="constrained")
    figure.suptitle(
        f"{motion.robot.name}, {motion.program.name}: what limits the motion "
        f"({motion.duration:.3f} s)",
        fontweight="bold",
    )
    grid = figure.add_gridspec(
        16, 2 if in_space else 1, width_ratios=(1.0, 1.15) if in_space else None
    )
    right = grid[:, 1] if in_space else grid[:, 0]
    panels = right.subgridspec(4, 1, height_ratios=(1, 1, 1, 0.14), hspace=0.06)
    axes = [figure.add_subplot(panels[0])]
    axes += [figure.add_subplot(panels[i], sharex=axes[0]) for i in (1, 2, 3)]
    _draw_shares(axes[:3], motion, document)
    _draw_strip(axes[3], document)
    if in_space:
        space: Any = figure.add_subplot(grid[:12, 0], projection="3d")
        _draw_space(space, samples, motion, document)
        _draw_deviation(figure.add_subplot(grid[12:, 0]), document)
    _draw_legends(figure, axes[0], motion, document)
    return figure


def _kind_at(document: MotionFile, times: Vector) -> list[str]:
    rules = document.certificate["rules"]
    ends = np.array([rule["to"] for rule in rules])
    place = np.clip(np.searchsorted(ends, times), 0, len(rules) - 1)
    return [rules[k]["kind"] for k in place]


def _draw_shares(axes: list[Axes], motion: Motion, document: MotionFile) -> None:
    """Every joint's share of its limits; thick where it rules."""
    rules = document.certificate["rules"]
    times = np.linspace(0.0, motion.duration, 3000)
    shares = 100.0 * shares_at(motion, times)
    for row, (ax, kind) in enumerate(zip(axes, KINDS, strict=True)):
        for joint in range(motion.robot.joints):
            colour = JOINT_COLOURS[joint % len(JOINT_COLOURS)]
            values = shares[:, row, joint]
            ax.plot(times, values, color=colour, lw=0.9, alpha=0.55)
            ruling = np.full(len(times), np.nan)
            for rule in rules:
                if rule["kind"] == kind and rule["joint"] == joint:
                    inside = (times >= rule["from"]) & (times <= rule["to"])
                    ruling[inside] = values[inside]
            ax.plot(times, ruling, color=colour, lw=3.0, solid_capstyle="butt")
        ax.stairs(
            100.0 * scales_of(document), document.starts, baseline=None, color=STOP, lw=1.0, ls="--"
        )
        ax.set_ylim(0.0, 109.0)
        ax.set_ylabel(f"{kind} [% of limit]", fontsize=9)
        ax.grid(alpha=0.25, lw=0.5)
        ax.tick_params(labelsize=8, labelbottom=False)


def _draw_strip(ax: Axes, document: MotionFile) -> None:
    """Which kind of limit rules, along time."""
    for rule in document.certificate["rules"]:
        ax.axvspan(rule["from"], rule["to"], color=COLOURS[rule["kind"]], lw=0)
    ax.set_yticks([])
    ax.set_ylabel("rules", fontsize=9, rotation=0, ha="right", va="center")
    ax.set_xlim(0.0, float(document.starts[-1]))
    ax.set_xlabel("time [s]", fontsize=9)
    ax.tick_params(labelsize=8)


def _draw_space(ax: Any, samples: Samples, motion: Motion, document: MotionFile) -> None:  # noqa: ANN401  # matplotlib has no types of 3-D axes
    points = samples.pose[:, :3, 3] * 1e3
    kinds = _kind_at(document, 0.5 * (samples.t[1:] + samples.t[:-1]))
    segments = np.stack([points[:-1], points[1:]], axis=1)
    ax.add_collection3d(Line3DCollection(segments, colors=[COLOURS[k] for k in kinds], lw=2.6))
    low, high = points.min(axis=0), points.max(axis=0)
    half = max(float((high - low).max()) / 2.0, 1.0) * 1.08
    centre = 0.5 * (low + high)
    for place, radius, stopped in _zones(motion, document):
        if stopped:
            ax.scatter(*place, color=STOP, marker="s", s=36, depthshade=False)
        else:
            ax.plot_wireframe(*_sphere(place, radius), color=ZONE, lw=0.5, alpha=0.55)
    closed = bool(np.linalg.norm(points[-1] - points[0]) < 0.02 * half)
    for name, point in (("start, end" if closed else "start", points[0]), ("end", points[-1])):
        if closed and name == "end":
            continue
        ax.scatter(*point, color="#333333", s=22, depthshade=False)
        ax.text(*(point + 0.03 * half), name, fontsize=9)
    for set_limits, middle in zip((ax.set_xlim, ax.set_ylim, ax.set_zlim), centre, strict=True):
        set_limits(middle - half, middle + half)
    ax.set_box_aspect((1, 1, 1))
    for set_label, name in zip((ax.set_xlabel, ax.set_ylabel, ax.set_zlabel), "xyz", strict=True):
        set_label(f"{name} [mm]", fontsize=9)
    ax.tick_params(labelsize=7)
    ax.view_init(elev=24, azim=-56)
    ax.set_title("path of the tool and its zones", fontsize=10)


def _zones(motion: Motion, document: MotionFile) -> list[tuple[Vector, float, bool]]:
    """Place [mm], radius as seen at the tool [mm], and whether the arm stops there."""
    found = []
    for corner in document.corners:
        ends = [
            i
            for i, stretch in enumerate(document.stretches)
            if stretch.leg == corner.leg
            and abs(stretch.end - document.legs[corner.leg].length) <= 1e-9 * stretch.end
        ]
        if not ends:
            continue
        joints = document.paths[ends[-1]].sum(axis=0)
        move = document.legs[corner.leg].move
        arm = [motion.robot, *(arm for first, arm in motion.tools if first <= move)][-1]
        radius = corner.cut if corner.kind == "joint_deviation" else corner.used
        found.append((arm.fk(joints)[:3, 3] * 1e3, 1e3 * radius, corner.stopped))
    return found


def _sphere(place: Vector, radius: float) -> tuple[Vector, Vector, Vector]:
    along, up = np.meshgrid(np.linspace(0, 2 * np.pi, 17), np.linspace(0, np.pi, 9))
    return (
        place[0] + radius * np.cos(along) * np.sin(up),
        place[1] + radius * np.sin(along) * np.sin(up),
        place[2] + radius * np.cos(up),
    )


def _draw_deviation(ax: Axes, document: MotionFile) -> None:
    """Distance from the wanted curve over time; the angle on its own scale at the right."""
    time, distance, angle = deviations(document)
    ax.set_xlim(0.0, float(document.starts[-1]))
    ax.set_xlabel("time [s]", fontsize=9)
    ax.tick_params(labelsize=8)
    ax.set_title("deviation from lines and curves (gaps: joint moves, corners, rest)", fontsize=10)
    if np.all(np.isnan(distance)):
        ax.set_yticks([])
        text = "no line or curve of the tool: joint moves are exact"
        ax.text(0.5, 0.5, text, transform=ax.transAxes, ha="center", va="center", fontsize=9)
        return
    line = ax.plot(time, distance * 1e6, color="#333333", lw=1.2, label="distance")
    tolerance = document.position_tolerance * 1e6
    bound = ax.axhline(tolerance, color=STOP, lw=1.0, ls="--", label="tolerance of both")
    ax.set_ylim(0.0, 1.15 * tolerance)
    ax.set_ylabel("distance [µm]", fontsize=9)
    ax.grid(alpha=0.25, lw=0.5)
    handles = [*line, bound]
    if not np.all(np.isnan(angle)):
        other = ax.twinx()
        handles += other.plot(time, angle * 1e3, color=ZONE, lw=1.0, label="angle")
        other.set_ylim(0.0, 1.15e3 * document.angle_tolerance)
        other.set_ylabel("angle [mrad]", fontsize=9, color=ZONE)
        other.tick_params(labelsize=8, colors=ZONE)
    ax.legend(handles=handles, loc="upper right", fontsize=8, ncols=3, framealpha=0.85)


def _draw_legends(figure: Figure, ax: Axes, motion: Motion, document: MotionFile) -> None:
    from matplotlib.lines import Line2D

    joints = [
        Line2D(
            [],
            [],
            color=JOINT_COLOURS[i % len(JOINT_COLOURS)],
            lw=2,
            label=f"joint {i + 1}" if i == 0 else f"{i + 1}",
        )
        for i in range(motion.robot.joints)
    ]
    joints.append(Line2D([], [], color=STOP, lw=1, ls="--", label="limit (times the move's scale)"))
    ax.legend(
        handles=joints, loc="lower left", bbox_to_anchor=(0.0, 1.0), ncols=len(joints),
        fontsize=8, frameon=False, handlelength=1.4, columnspacing=1.0,
    )  # fmt: skip
    told = {rule["kind"] for rule in document.certificate["rules"]}
    handles = [
        Line2D([], [], color=colour, lw=5, label=NAMES.get(kind, kind))
        for kind, colour in COLOURS.items()
        if kind in told
    ]
    if any(not corner.stopped for corner in document.corners) and motion.robot.has_kinematics:
        handles.append(Line2D([], [], color=ZONE, lw=1, label="zone, as used"))
    if any(corner.stopped for corner in document.corners) and motion.robot.has_kinematics:
        handles.append(
            Line2D([], [], color=STOP, lw=0, marker="s", label="zone that became a stop")
        )
    figure.legend(
        handles=handles, loc="outside lower center", ncols=len(handles), frameon=False,
        fontsize=9, title="what holds it back", title_fontsize=9,
    )  # fmt: skip
