"""The PUMA 560 through A, B and C, in joints and in straight lines (textbook §3).

Runs as ``python puma560_abc.py``; ``viapoint run puma560_abc.py`` adds the progress bar, the
figures, the log of every 2 ms setpoint and the pictures.

The textbook is the one that docs/maths.md describes.
"""

import numpy as np
from rich.console import Console
from rich.table import Table

import viapoint as vp
from viapoint import deg, mm

robot = vp.load_robot("puma560")
console = Console()

A = deg * [-100.4577, 70.6108, 48.3997, 0.0, 60.9896, 29.2746]
B = deg * [-52.1158, -1.4358, 30.2060, -121.3834, -11.4781, -178.4572]
C = deg * [0.0955, 65.7969, 14.3196, 15.3377, -20.1730, 30.0401]
pose_b, pose_c = robot.fk(B), robot.fk(C)
blend = 50 * mm


def line_distance(points: np.ndarray, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Distance of points (k, 3) from the straight line between two others [m]."""
    along = end - start
    share = np.clip((points - start) @ along / (along @ along), 0.0, 1.0)
    distance: np.ndarray = np.linalg.norm(points - (start + np.outer(share, along)), axis=1)
    return distance


def figures(job: vp.Job) -> list[str]:
    """Measure what the textbook compares, on the setpoints that were executed."""
    motion = job.motion
    s = job.log.samples
    path = s.pose[:, :3, 3]
    a, b, c = (robot.fk(q)[:3, 3] for q in (A, B, C))
    deviation = np.minimum(line_distance(path, a, b), line_distance(path, b, c))
    nearest = min((robot.singularity(q) for q in s.q), key=lambda near: near.manipulability)
    peaks = np.abs(s.qd).max(axis=0) / robot.limits.velocity
    joint = int(peaks.argmax())
    return [
        f"{motion.duration:.3f} s",
        f"{np.linalg.norm(np.diff(path, axis=0), axis=1).sum():.4f} m",
        f"{1e3 * deviation.max():.2f} mm",
        f"{motion.knots}",
        f"{motion.pieces}",
        f"joint {joint + 1}, {100 * peaks[joint]:.1f} % of limit",
        f"{np.abs(s.qdd).max() / deg:.0f} °/s²",
        f"{nearest.manipulability:.2e} ({nearest.name})",
        f"{np.abs(s.q[:, 4]).min() / deg:.2f}°",
    ]


# 1. Straight in the joints, blended at B: no inverse kinematics, no limits in the way.
joint_move = vp.Program(robot, start=A, name="joint move")
joint_move.movej(B, zone=blend).movej(C)

# 2. Straight in space with the least rotation: every pose of B→C is reachable, the whole is not.
least = vp.Program(robot, start=A, name="least rotation")
least.movel(pose_b, zone=blend)
least.movel(pose_c)  # from B, joint 4 would have to turn through its limit
report = least.check()
console.print("Straight lines with the least rotation: ", end="")
console.print(report)
leg = report.errors[0]
assert leg.joint is not None
assert leg.share is not None
assert leg.value is not None
assert leg.limit is not None
console.print(
    f"  → {leg.code} of joint {leg.joint + 1} after {100 * leg.share:.0f} % of the leg: "
    f"{leg.value / deg:.0f}° of {leg.limit / deg:.0f}° allowed (line {leg.line})\n"
)

# 3. The way out: the tool's point still goes straight, the wrist joints are interpolated.
wrist = vp.Program(robot, start=A, name="straight lines")
wrist.movel(pose_b, orientation="wrist", zone=blend)
wrist.movel(pose_c, orientation="wrist")

columns = []
for program in (joint_move, wrist):
    with vp.connect("sim://puma560", start=A) as arm:
        job = arm.run(program)
        columns.append((program.name, figures(job)))

table = Table(title="A→B→C, measured on the executed setpoints", title_justify="left")
table.add_column("")
for name, _ in columns:
    table.add_column(name, justify="right")
for row in zip(
    (
        "duration",
        "length of the tool's path",
        "largest deviation from A→B→C",
        "knots solved while planning",
        "polynomial pieces evaluated",
        "highest joint speed",
        "highest joint acceleration",
        "least manipulability",
        "joint 5 nearest to 0 (wrist)",
    ),
    *(values for _, values in columns),
    strict=True,
):
    table.add_row(*row)
console.print(table)
console.print(
    "Both pass the wrist singularity (joint 5 at 0): the joints are given there, nothing happens.\n"
    "A line with its orientation prescribed would turn joints 4 and 6 against each other at once."
)
