"""A bead of glue along a contour of lines, arcs and a spline, the nozzle led along it."""

import numpy as np

import viapoint as vp
from viapoint import deg, mm

robot = vp.load_robot("ur5e")

down = np.diag([1.0, -1.0, -1.0, 1.0])  # the tool points at the table


def over(x: float, y: float, z: float = 0.10) -> np.ndarray:
    """Return a pose that points down at a place of the table [m]."""
    pose = down.copy()
    pose[:3, 3] = x, y, z
    return pose


corner = over(0.40, 0.00)
home = robot.ik(over(0.40, 0.00, 0.15), near=deg * [0, -90, 90, -90, -90, 0])

program = vp.Program(robot, start=home, speed=0.15, zone=2 * mm, name="gluing contour")
program.movel(corner, zone="fine").set_do(0, True)
program.movel(over(0.46, 0.00), orientation="fixed")
# A quarter of a circle of 20 mm: the nozzle turns with it.
program.movec(over(0.4741, 0.0059), over(0.48, 0.02), orientation="tangent")
# The wavy edge, as it was measured; the nozzle follows its direction to the boss at its end.
edge = [over(0.48 + 0.008 * np.sin(a), 0.02 + 0.10 * a / 9.0) for a in np.linspace(0, 9, 10)[1:]]
program.spline(edge, orientation="tangent", zone="fine")
# Once and a half around a boss, then away.
program.movec(
    center=edge[-1][:3, 3] + [-0.02, 0.0, 0.0], axis=[0, 0, 1], angle=540 * deg, zone="fine"
)
program.set_do(0, False)

report = program.check()
print(report)
motion = program.plan()
proven = motion.certificate
print(
    f"{motion.duration:.2f} s; the bead is proven within {1e6 * proven.path_deviation:.0f} µm of "
    f"the contour, outside zones"
)
for zone in motion.corners:
    print(f"  zone of move {zone.move}: {1e3 * zone.used:.2f} of {1e3 * zone.asked:.1f} mm")
