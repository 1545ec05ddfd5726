"""Guide an arm by hand, record it, and play it quicker, backwards and in loops (textbook §6).

The textbook is the one that docs/maths.md describes. The hand is a file of samples as encoders tell
them, noise and all; a real arm whose drives let it be guided is recorded by the same line.
"""

import tempfile
from pathlib import Path

import numpy as np

import viapoint as vp
from viapoint import deg, mm

robot = vp.load_robot("ur5e")
home = deg * [0, -90, 90, -90, -90, 0]


def swing_of_a_hand(file: Path) -> None:
    """Write 4 s of wiping in a shrinking circle, at 500 Hz, with an encoder's noise."""
    t = np.arange(0.0, 4.0, 0.002)
    share = np.clip((t - 0.3) / 3.4, 0.0, 1.0)
    turn = 4 * np.pi * share**2 * (3 - 2 * share)
    size = 0.18 - 0.06 * share
    q = np.tile(home, (t.size, 1))
    q[:, 0] += size * np.sin(turn)
    q[:, 1] += 0.7 * size * (np.cos(turn) - 1)
    q[:, 2] -= 0.9 * size * (np.cos(turn) - 1)
    q += 2e-5 * np.random.default_rng(1).normal(size=q.shape)
    rows = np.column_stack([t, q])
    np.savetxt(file, rows, "%.6f", ",", header="t,q1,q2,q3,q4,q5,q6", comments="")


with tempfile.TemporaryDirectory() as folder:
    swing_of_a_hand(Path(folder) / "hand.csv")
    hand = vp.Recording.load(Path(folder) / "hand.csv", robot)

    with vp.connect("sim://ur5e", start=hand.q[0]) as arm:
        arm.guide(hand)
        arm.set_output(2, True)  # the nozzle opens
        recording = arm.record(10.0, until=lambda: not arm.guided)
        arm.set_output(2, False)
    print(f"recorded {len(recording)} cycles, {recording.duration:.3f} s")

    recording.fit(0.5 * mm).save(Path(folder) / "wipe.json")
    wipe = vp.load_recording(Path(folder) / "wipe.json")  # another day
    controls = sum(len(stage.control) for stage in wipe.stages)
    print(
        f"{controls} control points pass every sample within {1e3 * wipe.deviation:.3f} mm and "
        f"{1e3 * wipe.angle_deviation:.2f} mrad"
    )
    for title, told in {
        "as recorded": {},
        "at double speed": {"speed": 2.0},
        "backwards, as fast as the limits allow": {"speed": None, "reverse": True},
        "three times": {"speed": 3.0, "loops": 3},
    }.items():
        motion = wipe.program(**told).plan()
        print(
            f"{title}: {motion.duration:.2f} s, at most "
            f"{100 * max(motion.certificate.jerk_share):.0f} % of the jerk limits"
        )

    with vp.connect("sim://ur5e", start=home + 0.1) as arm:
        job = wipe.play(arm, speed=2.0)  # approaches the path first
        miss = np.linalg.norm(arm.pose[:3, 3] - robot.fk(recording.q[-1])[:3, 3])
        print(f"{job.state}, {1e3 * miss:.2f} mm from where the hand let go")
