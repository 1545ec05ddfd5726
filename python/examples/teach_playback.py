"""Teach three points, keep them in a file, play them back (textbook §6)."""

import tempfile
from pathlib import Path

import numpy as np

import viapoint as vp
from viapoint import deg, mm

robot = vp.load_robot("puma560")
home = [0, -60, 60, 0, 45, 0] * deg
where = [
    ("above", [20, -50, 55, 0, 45, 10] * deg),
    ("seam start", [25, -35, 40, 0, 50, 10] * deg),
    ("seam end", [40, -35, 40, 0, 50, 10] * deg),
]

with tempfile.TemporaryDirectory() as folder:
    file = Path(folder) / "seam.json"

    # Teach: drive the arm somewhere, and record where it really stands.
    points = vp.PointList(file, robot)
    with vp.connect("sim://puma560", start=home) as arm:
        for name, q in where:
            arm.run(vp.Program(robot, start=arm.setpoint, name=f"to {name}").movej(q))
            arm.teach(name, points)
    print(f"{file.name} holds {', '.join(points)}")

    # Play back, another day: the file knows its robot.
    points = vp.PointList(file)
    with vp.connect("sim://puma560", start=home) as arm:
        arm.run(points.program(start=home, kind="ptp", zone=30 * mm, name="joint playback"))
        back = points.program(start=arm.setpoint, kind="lin", speed=0.25, name="straight playback")
        job = arm.run(back)
        miss = np.abs(arm.joints - points["seam end"]).max()
        print(f"{job.state}; {miss:.1e} rad from the last taught point")
