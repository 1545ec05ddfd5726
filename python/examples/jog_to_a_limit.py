"""Hold-to-run: jog an arm, let go, jog into a position limit, and run a program from there."""

import time

import numpy as np

import viapoint as vp
from viapoint import deg

robot = vp.load_robot("ur5e")
highest = np.array(robot.limits.position_max)
highest[0] = 40 * deg
robot = robot.with_limits(position_max=highest)
home = deg * [0, -90, 90, -90, -90, 0]
rest = deg * [-30, -80, 100, -110, -90, 0]


def hold(arm: vp.Arm, velocity: np.ndarray, seconds: float) -> None:
    """Press the button, and let go."""
    for _ in range(round(seconds / 0.05)):
        arm.jog(velocity)
        time.sleep(0.05)


with vp.connect("sim://ur5e", robot=robot, start=home) as arm:
    hold(arm, deg * [20, 0, 0, 0, -30, 0], 0.5)
    while arm.jogging:  # 250 ms after the last call it comes to rest
        time.sleep(0.01)
    print(f"let go at {np.round(arm.setpoint / deg, 2)}°")

    hold(arm, deg * [60, 0, 0, 0, 0, 0], 1.2)
    print(f"{np.round(arm.setpoint / deg, 2)}°: {arm.jog_block or 'free'}")
    arm.jog(np.zeros(6))
    while arm.jogging:
        time.sleep(0.01)

    job = arm.run(vp.Program(robot, start=arm.setpoint, scale=0.5).movej(rest))
    print(f"{job.state} at rest")
