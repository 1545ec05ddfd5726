"""What an arm with mass makes of the setpoints: MuJoCo under the drives, in virtual time.

Three runs of one program with other payloads make a report by ISO 9283. Needs ``mujoco``
(``pip install viapoint[mujoco]``); without it, it says so and ends.
"""

import sys

import numpy as np

import viapoint as vp
from viapoint import deg, iso9283

robot = vp.load_robot("ur5e")
home = deg * [0, -90, 90, -90, -90, 0]
pose = robot.fk(home)
pose[:3, 3] += (-0.1, 0.25, 0.05)

program = vp.Program(robot, start=home, name="reach").movel(pose, speed=0.5).wait(0.3)
with vp.connect("sim://ur5e", start=home) as arm:
    told = arm.run(program).log

try:
    vp.MujocoPlant(robot, start=home)
except vp.errors.FileError as error:
    print(f"SKIPPED: {error.message}")
    sys.exit()

logs = []
for payload in (0.5, 2.0, 5.0):
    plant = vp.MujocoPlant(robot, start=home, payload=payload, bandwidth=100.0)
    logs.append(plant.track(told))
    late = np.linalg.norm(
        robot.fk(logs[-1].measured)[:, :3, 3] - told.samples.pose[:, :3, 3], axis=1
    )
    print(
        f"{payload:3.1f} kg: at most {1e3 * late.max():.2f} mm behind, {1e3 * late[-1]:.4f} at rest"
    )

report = iso9283.from_logs(logs)
print(f"pose repeatability {1e3 * report.poses[0].repeatability:.4f} mm")
print(f"path accuracy {1e3 * report.path.accuracy:.3f} mm")
