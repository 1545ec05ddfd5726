"""Teach three points, keep them in a file, play them back (textbook §6).

The textbook is the one that docs/maths.md describes.
"""

import tempfile
from pathlib import Path

import numpy as np

import viapoint as vp
from viapoint import deg, mm

robot = vp.load_robot("puma560")
home = deg * [0, -60, 60, 0, 45, 0]
where = [
    ("above", deg * [20, -50, 55, 0, 45, 10]),
    ("seam start", deg * [25, -35, 40, 0, 50, 10]),
    ("seam end", deg * [40, -35, 40, 0, 50, 10]),
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
