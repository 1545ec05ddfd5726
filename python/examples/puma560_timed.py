"""The classic fixed-time form of the same job, for study (textbook §3): 501 samples in one second.

It starts and ends at full speed, so it plans, samples and plots, and a drive refuses it.

The textbook is the one that docs/maths.md describes.
"""

import viapoint as vp
from viapoint import deg

robot = vp.load_robot("puma560")
A = deg * [-100.4577, 70.6108, 48.3997, 0.0, 60.9896, 29.2746]
B = deg * [-52.1158, -1.4358, 30.2060, -121.3834, -11.4781, -178.4572]
C = deg * [0.0955, 65.7969, 14.3196, 15.3377, -20.1730, 30.0401]

joint = vp.Program(robot, start=A, name="timed joint move")
joint.timed([(A, 0.0), (B, 0.5), (C, 0.5)], t_acc=0.2, space="joint")
cartesian = vp.Program(robot, start=A, name="timed Cartesian move")
cartesian.timed(
    [(robot.fk(A), 0.0), (robot.fk(B), 0.5), (robot.fk(C), 0.5)], t_acc=0.2, space="cartesian"
)

for program in (joint, cartesian):
    motion = program.plan()
    samples = motion.sample(0.002)
    print(f"{program.name}: {len(samples)} samples, {motion.duration:g} s")
    worst = int(motion.certificate.velocity_share.argmax())
    peak = motion.certificate.velocity[worst]
    share = 100.0 * peak.share
    print(f"  fastest joint: {worst + 1}, {peak.value / deg:.1f} °/s, {share:.0f} % of its limit")
    print(f"  {len(motion.report.errors)} reasons why no drive takes it, the first three:")
    for problem in motion.report.errors[:3]:
        print(f"    {problem.code}: {problem.message}")
    with vp.connect("sim://puma560", start=motion.start) as arm:
        try:
            arm.run(motion)
        except vp.MotionError as error:
            print(f"  the drive refuses: {type(error).__name__}\n")
