"""What the command line says about a robot's description."""

from __future__ import annotations

import numpy as np
from rich.markup import escape
from rich.table import Table

from ._arguments import Vector
from ._robot import Robot

_SAMPLES = 20_000
_TURN = 2.0 * np.pi
_FAST = 30.0
"""A joint of an arm turns slower than this [rad/s]: faster ones are likely told in degrees."""


def joint_table(robot: Robot) -> Table:
    """Every joint with its limits, in the units that people read."""
    limits = robot.limits
    table = Table(
        title=f"{escape(robot.name)}: {escape(robot.title)}",
        title_justify="left",
        caption="turning joints in degrees, sliding ones in millimetres; rates per s, s², s³",
        caption_justify="left",
    )
    table.add_column("joint", overflow="fold")
    table.add_column("moves")
    for heading in ("from", "to", "velocity", "acceleration", "jerk"):
        table.add_column(heading, justify="right")
    columns = (
        limits.position_min,
        limits.position_max,
        limits.velocity,
        limits.acceleration,
        limits.jerk,
    )
    for i, name in enumerate(robot.joint_names):
        slides = robot.prismatic[i]
        factor = 1e3 if slides else 180.0 / np.pi
        values = [_number(factor * column[i]) for column in columns]
        table.add_row(escape(name), "slides" if slides else "turns", *values)
    return table


def findings(robot: Robot) -> Table:
    """Chain, solver, reach, and where the numbers come from."""
    table = Table(title="What it is", title_justify="left", show_header=False)
    table.add_column(overflow="fold")
    table.add_column(overflow="fold")
    if robot.has_kinematics:
        table.add_row("inverse kinematics", escape(robot.ik_family))
        if robot.redundancy:
            table.add_row("left open by a pose", escape(robot.redundancy))
        for what, where in _reach_of(robot):
            table.add_row(what, where)
        for what, pose in (("base", robot.base), ("tool, on the flange", robot.tool)):
            table.add_row(what, _pose(pose))
    else:
        table.add_row("inverse kinematics", "none: joints and limits only, so joint moves only")
    rows = len(robot.limits.coupling)
    if rows:
        table.add_row("coupled limits", f"{rows}")
    for heading, lines in (("source", robot.sources), ("chosen", robot.chosen)):
        for line in lines:
            table.add_row(heading, escape(line))
    table.add_row("fingerprint", robot.fingerprint)
    return table


def remarks(robot: Robot) -> list[str]:
    """Say what is missing or looks wrong in an arm that can be used, each with what to do."""
    limits = robot.limits
    said: list[str] = []
    for i, name in enumerate(robot.joint_names):
        if robot.prismatic[i]:
            if not np.isfinite([limits.position_min[i], limits.position_max[i]]).all():
                said.append(
                    f"joint {name} slides without position limits: nothing keeps it in the arm. "
                    "Give both ends of its travel."
                )
            continue
        fastest = limits.velocity[i]
        if fastest > _FAST:
            said.append(
                f"joint {name} may turn at {fastest:.4g} rad/s, {np.rad2deg(fastest):.4g} °/s: "
                "is the number in degrees where radians are meant?"
            )
        span = limits.position_max[i] - limits.position_min[i]
        if np.isfinite(span) and span > 4.0 * _TURN:
            said.append(
                f"joint {name} may turn {span / _TURN:.3g} times around: "
                "are its limits in degrees where radians are meant?"
            )
    if any("acceleration" in line and "URDF" in line for line in robot.chosen):
        said.append(
            "URDF has no limits of acceleration and jerk, so they are chosen. Give the maker's: "
            "robot.with_limits(acceleration=…, jerk=…).save(FILE.yaml)."
        )
    if robot.has_kinematics:
        if robot.ik_family.startswith("numerical"):
            said.append(
                "the geometry has no closed form, so poses are solved by search: slower, and "
                "without proof that every branch is found. If the arm should have one, its "
                "numbers are rounded or calibrated."
            )
        if np.array_equal(robot.tool, np.eye(4)):
            said.append(
                "no tool is given: poses are of the flange. Give one: tool: in the file, "
                "robot.with_tool(pose), or program.set_tool(pose)."
            )
    return said


def _reach_of(robot: Robot) -> list[tuple[str, str]]:
    if any(
        slides and not np.isfinite(robot.limits.position_max[i] - robot.limits.position_min[i])
        for i, slides in enumerate(robot.prismatic)
    ):
        return [("reach", "without end: a joint slides without limits")]
    points, _ = robot.workspace(_SAMPLES)
    base = robot.base
    own = (points - base[:3, 3]) @ base[:3, :3]
    far = np.linalg.norm(own, axis=1).max()
    around = np.hypot(own[:, 0], own[:, 1])
    return [
        ("reach from the base", f"{far:.3f} m in any direction, {around.max():.3f} m around"),
        ("height over the base", f"{own[:, 2].min():.3f} to {own[:, 2].max():.3f} m"),
        ("", f"(the tool's point at {_SAMPLES} random joint vectors within the limits)"),
    ]


def _pose(pose: Vector) -> str:
    if np.array_equal(pose, np.eye(4)):
        return "as it is"
    x, y, z = 1e3 * pose[:3, 3]
    cosine = np.clip((np.trace(pose[:3, :3]) - 1.0) / 2.0, -1.0, 1.0)
    turned = np.rad2deg(np.arccos(cosine))
    return f"at ({x:.4g}, {y:.4g}, {z:.4g}) mm, turned by {turned:.4g}°"


def _number(value: float) -> str:
    if np.isinf(value):
        return "none"
    return f"{value:.6g}"
