"""The planar two-link arm from (3, 0) to (2, 2) (textbook §5): two branches, one straight line.

The textbook is the one that docs/maths.md describes.
"""

import numpy as np

import viapoint as vp
from viapoint import deg

robot = vp.load_robot("two_link")
goal = [2.0, 2.0, 0.0]

branches = robot.ik_all(position=goal)
for q in branches:
    m = robot.manipulability(q)
    print(f"branch {np.round(q / deg, 4)}°: manipulability {m:.4f} of at most 2")

# The lecture's move: cubics of 2 s to the elbow-up branch.
stretched = np.zeros(2)
elbow = branches[np.argmin(branches[:, 1])]
law = vp.profile.cubic(stretched, elbow, 2.0)
for axis in range(2):
    print(f"joint {axis + 1}: a = {np.round(law.parts(axis)[0].coefficients[:4] / deg, 4)}")

# As a program: joints first (a stretched arm cannot start on a line), then a straight line back.
program = vp.Program(robot, start=stretched, name="two link")
program.movej(elbow)
program.movel(position=[1.0, 2.0, 0.0], speed=1.0)
with vp.connect("sim://two_link", start=stretched) as arm:
    job = arm.run(program)
    print(f"{job.state} after {job.report.wall_time:.3f} s at {np.round(arm.pose[:3, 3], 6)}")
