"""Override, pause and stop: all on the path (the geometry never changes)."""

import time

import numpy as np

import viapoint as vp
from viapoint import deg

robot = vp.load_robot("ur5e")
home = deg * [0, -90, 90, -90, -90, 0]
program = vp.Program(robot, start=home, scale=0.5, name="there")
program.movej(deg * [60, -70, 70, -90, -90, 30], zone=vp.joint_deviation(0.05))
program.movej(deg * [90, -100, 100, -90, -60, 0])
motion = program.plan()

with vp.connect("sim://ur5e", start=home) as arm:
    job = arm.run(motion, wait=False)
    time.sleep(0.3)
    arm.override = 0.4
    time.sleep(0.3)
    job.pause()
    while job.state != "paused":
        time.sleep(0.01)
    print(f"paused {job.nominal_time:.3f} s along the path, at {np.round(arm.joints / deg, 1)}°")
    job.resume()
    arm.override = 1.0
    job.wait()
    print(f"{job.state}: {job.report.wall_time:.3f} s for a motion of {motion.duration:.3f} s")

# The same again in virtual time, and stopped: every setpoint is a point of the planned path.
planned = motion.sample(0.0005).q
samples = vp.simulate(
    motion, commands=[(0.3, "override", 0.4), (0.5, "pause"), (0.9, "resume"), (1.2, "stop")]
)
off = max(np.abs(planned - q).max(axis=1).min() for q in samples.q[::10])
print(
    f"stopped after {samples.t[-1]:.3f} s, never farther than {off:.1e} rad from the path's samples"
)
