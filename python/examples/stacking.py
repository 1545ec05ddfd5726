"""Cubes from an inclined feeder onto a stack, and a screw through the topmost (textbook §5).

The textbook is the one that docs/maths.md describes.
"""

import math

import numpy as np

import viapoint as vp
from viapoint import deg, mm
from viapoint.cells import Gripper, on_feeder, stacked
from viapoint.frames import Frame

robot = vp.load_robot("ur5e")
edge = 40 * mm
gripper = Gripper(output=3, dwell=0.2)

# The feeder stands to the right and slides cubes of friction 0.3 down to its stop.
feeder = np.eye(4)
feeder[:3, 3] = (0.35, -0.25, 0.1)
pick = Frame(feeder, "feeder").to_base(on_feeder(25 * deg, edge, friction=0.3))

# The stack: a cube is gripped in the middle, so the lowest is set down half an edge above ground.
first = np.diag([1.0, -1.0, -1.0, 1.0])
first[:3, 3] = (0.4, 0.2, 0.1 + edge / 2)

home = robot.ik(vp.cells.lifted(first, 0.25), near=deg * [0, -90, 90, -90, -90, 0])
program = vp.Program(robot, start=home, zone=20 * mm, name="stacking")
for place in stacked(first, edge, 3):
    program.pick(pick, gripper).place(place, gripper)
program.screw_in(6 * mm, 2 * mm, gripper=gripper, most_turn=0.75 * math.pi)
motion = program.plan()

places = motion.sample(0.002).pose[:, :3, 3]
for k, place in enumerate(stacked(first, edge, 3)):
    miss = np.linalg.norm(places - place[:3, 3], axis=1).min()
    print(f"cube {k + 1} at {1e3 * place[2, 3]:.0f} mm: the tool passes within {1e3 * miss:.3f} mm")
print(f"{len(program)} steps, {motion.duration:.2f} s; the screw is {1e3 * 6 * mm:.0f} mm deep")
