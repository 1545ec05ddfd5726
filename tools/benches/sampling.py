"""States of a motion into numpy arrays, from Python."""

import statistics
import time

from benches.tables import Row


def measure(*, quick: bool) -> list[Row]:
    """Sample a motion of six joints into arrays of q and three derivatives."""
    import numpy as np

    import viapoint as vp

    robot = vp.load_robot("puma560")
    generator = np.random.default_rng(1)
    low, high = 0.5 * robot.limits.position_min, 0.5 * robot.limits.position_max
    program = vp.Program(robot, start=np.zeros(6), zone=vp.joint_deviation(0.02))
    for _ in range(20):
        program.movej(generator.uniform(low, high))
    motion = program.plan()
    rows: list[Row] = []
    for wanted in (1_000, 100_000) if quick else (1_000, 100_000, 1_000_000):
        step = motion.duration / wanted
        times = []
        for _ in range(3 if quick else 9):
            begin = time.perf_counter()
            samples = motion.sample(step)
            times.append(time.perf_counter() - begin)
        median = statistics.median(times)
        rows.append(
            {
                "bench": "sample",
                "case": f"puma560, {motion.pieces} pieces",
                "samples": len(samples.t),
                "p50_ms": 1e3 * median,
                "max_ms": 1e3 * max(times),
                "million_samples_per_s": len(samples.t) / median / 1e6,
            }
        )
    return rows
