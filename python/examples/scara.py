"""A SCARA picks and places (textbook §5): tool pointing down, straight up and down.

The textbook is the one that docs/maths.md describes.
"""

import numpy as np

import viapoint as vp
from viapoint import deg, mm

robot = vp.load_robot("scara")
home = np.array([0.0, 60 * deg, 0.10, 0.0])


def above(pose: np.ndarray, height: float) -> np.ndarray:
    """Return the same pose, higher by `height` [m]."""
    lifted = pose.copy()
    lifted[2, 3] += height
    return lifted


pick = robot.fk([30 * deg, 70 * deg, 0.25, 0.0])
place = robot.fk([-60 * deg, -50 * deg, 0.25, 0.0])

program = vp.Program(robot, start=home, zone=20 * mm, name="pick and place")
program.movej(above(pick, 80 * mm))
program.movel(pick, speed=0.4, zone="fine").set_do(0, True).wait(0.05)
program.movel(above(pick, 80 * mm))
program.movej(above(place, 80 * mm))
program.movel(place, speed=0.4, zone="fine").set_do(0, False).wait(0.05)
program.movel(above(place, 80 * mm))
program.movej(home)

print(program.check())
motion = program.plan()
for corner in motion.corners:
    print(f"  zone of move {corner.move}: {1e3 * corner.used:.1f} of {1e3 * corner.asked:.1f} mm")
with vp.connect("sim://scara", start=home) as arm:
    job = arm.run(motion)
    gripper = np.flatnonzero(np.diff(job.log.outputs.astype(np.int64))) * 0.002
    print(f"{job.state} after {job.report.wall_time:.3f} s; gripper at {np.round(gripper, 3)} s")
