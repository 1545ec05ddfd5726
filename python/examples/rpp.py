"""The RPP arm from (0, 0.2, 0.5) to (1, 1.2, 0.5) (textbook §5): a turn and two slides.

The textbook is the one that docs/maths.md describes.
"""

import numpy as np

import viapoint as vp

robot = vp.load_robot("rpp")
start = robot.ik(position=[0.0, 0.2, 0.5])
goal = robot.ik(position=[1.0, 1.2, 0.5], near=start)
print(f"start {np.round(start, 4)}, goal {np.round(goal, 4)}")

program = vp.Program(robot, start=start, name="rpp")
program.movel(position=[1.0, 1.2, 0.5], scale=0.5)
program.movej(start)
motion = program.plan()
line = motion.sample(0.001).pose[:, :3, 3]
print(f"{motion.duration:.3f} s, proven within {1e3 * motion.certificate.path_deviation:.4f} mm")
print(f"height stays between {line[:, 2].min():.6f} m and {line[:, 2].max():.6f} m")

with vp.connect("sim://rpp", start=start) as arm:
    job = arm.run(motion)
    print(f"{job.state} after {job.report.wall_time:.3f} s at {np.round(arm.pose[:3, 3], 6)}")
