"""The lecture's example (textbook §5): a quintic on all joints, and the homework's trapezoid.

From Rx(π) at (0.4, 0.2, 0) to Rx(π/2) at (0.4, -0.2, 0) in 5 s: inverse kinematics, a law on all
joints, and back through forward kinematics.

The textbook is the one that docs/maths.md describes.
"""

import numpy as np

import viapoint as vp

robot = vp.load_robot("puma560")


def rotated_about_x(angle: float, position: list[float]) -> np.ndarray:
    """Return the pose Rx(angle) at a position."""
    c, s = np.cos(angle), np.sin(angle)
    pose = np.eye(4)
    pose[1:3, 1:3] = [[c, -s], [s, c]]
    pose[:3, 3] = position
    return pose


q0 = robot.ik(rotated_about_x(np.pi, [0.4, 0.2, 0.0]))
q1 = robot.ik(rotated_about_x(np.pi / 2, [0.4, -0.2, 0.0]), near=q0)

quintic = vp.profile.quintic(q0, q1, 5.0)
trapezoid = vp.profile.lspb(q0, q1, 5.0, blend_time=5.0 / 3.0)
times = np.linspace(0.0, 5.0, 501)
for name, law in (("quintic", quintic), ("trapezoid, t_b = 5/3 s", trapezoid)):
    state = law.at(times)
    tool = robot.fk(state.q)[:, :3, 3]
    speed = np.abs(state.qd).max(axis=0) / robot.limits.velocity
    length = np.linalg.norm(np.diff(tool, axis=0), axis=1).sum()
    print(f"{name}: tool path {length:.4f} m, joint speeds {np.round(100 * speed, 1)} % of limit")

# What the arm can do: the same joint line, as quick as its limits allow.
program = vp.Program(robot, start=q0, name="quickest").movej(q1)
print(f"within all limits, at rest at both ends: {program.plan().duration:.3f} s")
