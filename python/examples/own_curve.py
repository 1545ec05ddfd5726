"""Any curve that a function tells, a helix, and a screw that is driven home."""

import numpy as np

import viapoint as vp
from viapoint import deg, mm

robot = vp.load_robot("puma560")
home = deg * [0, 25, 0, 15, 50, 10]
first = robot.fk(home)


def knot(t: float) -> np.ndarray:
    """Return the place of a trefoil knot about where the tool is; t runs around once [rad]."""
    shape = [np.sin(t) + 2 * np.sin(2 * t), np.cos(t) - 2 * np.cos(2 * t) + 1, -np.sin(3 * t)]
    pose = first.copy()
    pose[:3, 3] += 0.03 * np.array(shape)
    return pose


fit = vp.fit_curve(knot, tolerance=0.05 * mm, domain=(0, 2 * np.pi))
print(
    f"{len(fit.poses)} poses: within {1e3 * fit.deviation:.3f} mm of the curve "
    f"at {fit.looked_at} places"
)

program = vp.Program(robot, start=home, name="own curve")
program.spline(fit)
# Down a bore of 15 mm, 2 mm a turn.
program.movec(
    center=first[:3, 3] + [0.015, 0, 0], axis=[0, 0, 1], angle=-1080 * deg, pitch=2 * mm, speed=0.2
)
# A screw of 1.25 mm pitch, two thirds of a turn about the tool's own axis.
program.screw(240 * deg, 1.25 * mm)

print(program.check())
motion = program.plan()
with vp.connect("sim://puma560", start=home) as arm:
    job = arm.run(motion)
    print(f"{job.state} after {motion.duration:.2f} s")
