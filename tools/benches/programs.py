"""Random programs of mixed moves, from Python: each ends in a proven motion.

A move that is refused, with its line, is left out, and the rest planned anew.
"""

import random
import statistics
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal

import numpy as np

from benches.soundness import MOST_SHARE
from benches.tables import Row

if TYPE_CHECKING:
    import viapoint as vp

Step = Callable[["vp.Program"], None]

ROBOTS = ("puma560", "ur5e", "panda", "scara")
FEWEST, MOST = 2, 200
"""Moves of a program."""
VERIFIED = 50
"""One motion in so many is proven again from its file, by the verifier."""


def measure(problems: int, *, quick: bool) -> list[Row]:
    """Plan so many programs a robot; a row of failures, with their seeds, at the end."""
    import viapoint as vp

    count = 20 if quick else problems
    rows: list[Row] = []
    failures: list[str] = []
    for name in ROBOTS:
        robot = vp.load_robot(name)
        tally = Tally()
        for seed in range(count // len(ROBOTS)):
            start, steps = random_steps(robot, seed)
            if fault := tally.plan(robot, start, steps, verify=seed % VERIFIED == 0):
                failures.append(f"{name} {seed}: {fault}")
        rows.append({"bench": "programs", "case": name, **tally.row()})
    rows.append({"bench": "programs: soundness", "case": "failures", "value": len(failures)})
    rows += [{"bench": "programs: failed", "case": failure} for failure in failures[:20]]
    return rows


class Tally:
    """What became of one robot's programs."""

    def __init__(self) -> None:
        self.programs = self.moves = self.planned = self.verified = 0
        self.refused: Counter[str] = Counter()
        self.times: list[float] = []
        self.share = self.deviation = 0.0

    def plan(self, robot: "vp.Robot", start: np.ndarray, steps: list[Step], *, verify: bool) -> str:
        """Plan one, without the moves that are refused, and say what is wrong with what came.

        Returns
        -------
        fault : str
            Empty where nothing is wrong.
        """
        import viapoint as vp

        self.programs += 1
        self.moves += len(steps)
        steps = list(steps)
        while steps:
            program = vp.Program(robot, start=start)
            for step in steps:
                step(program)
            begin = time.perf_counter()
            try:
                motion = program.plan()
            except vp.MotionError as error:
                self.refused[error.code] += 1
                if not (str(error) and error.line) or error.move is None:
                    return f"{error!r} names no line or no move"
                del steps[error.move]
            else:
                break
        else:
            return ""
        moves = len(steps)
        self.times.append((time.perf_counter() - begin) / moves)
        self.planned += 1
        certificate = motion.certificate
        share = max(
            float(np.max(part))
            for part in (
                certificate.velocity_share,
                certificate.acceleration_share,
                certificate.jerk_share,
            )
        )
        self.share = max(self.share, share)
        self.deviation = max(self.deviation, certificate.path_deviation)
        if not certificate.holds or share > MOST_SHARE:
            return f"the certificate does not hold: {share:.9g} of a limit"
        return self.prove_again(motion) if verify else ""

    def prove_again(self, motion: "vp.Motion") -> str:
        """Verify the motion's file."""
        from viapoint import verifier

        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "motion.json"
            motion.save(path)
            verdict = verifier.verify(path)
        self.verified += 1
        return "" if verdict.holds else f"the verifier found {verdict.findings[0]}"

    def row(self) -> Row:
        """Its figures."""
        times = sorted(self.times) or [0.0]
        refused = ", ".join(f"{code} {n}" for code, n in self.refused.most_common(3))
        return {
            "programs": self.programs,
            "moves": self.moves,
            "planned": self.planned,
            "verified": self.verified,
            "worst_share": self.share,
            "worst_deviation_mm": 1e3 * self.deviation,
            "p50_ms_per_move": 1e3 * statistics.median(times),
            "p99_ms_per_move": 1e3 * times[int(0.99 * (len(times) - 1))],
            "refused_moves": refused,
        }


def random_steps(robot: "vp.Robot", seed: int) -> tuple[np.ndarray, list[Step]]:
    """Walk the joints about a place, told in moves of every kind: start and steps."""
    chance = random.Random(seed)
    middle = 0.5 * (robot.limits.position_min + robot.limits.position_max)
    half = np.minimum(0.5 * (robot.limits.position_max - robot.limits.position_min), 1.5)
    home = middle + 0.6 * half * np.array([chance.uniform(-1, 1) for _ in range(robot.joints)])
    steps: list[Step] = []
    for _ in range(round(FEWEST * (MOST / FEWEST) ** chance.random())):
        away = np.array([chance.gauss(0.0, 0.08) for _ in range(robot.joints)])
        steps.append(random_move(robot, home + half * away, chance))
        if chance.random() < 0.05:
            steps.append(partial(wait, seconds=0.1 * chance.random()))
        if chance.random() < 0.05:
            steps.append(partial(output, index=chance.randrange(8), value=chance.random() < 0.5))
    return home, steps


def wait(program: "vp.Program", seconds: float) -> None:
    """Rest."""
    program.wait(seconds)


def output(program: "vp.Program", index: int, value: bool) -> None:
    """Change an output."""
    program.set_do(index, value)


def random_move(robot: "vp.Robot", q: np.ndarray, chance: random.Random) -> Step:
    """One move to these joints, or to where they bring the tool."""
    pose = robot.fk(q)
    zone = random_zone(chance)
    scale = 10 ** -chance.random() if chance.random() < 0.2 else None
    speed = 10 ** -(2 * chance.random()) if chance.random() < 0.3 else None
    spread = 0.3 * chance.random()
    joints = q + spread * np.array([chance.gauss(0.0, 0.1) for _ in range(robot.joints)])
    beside = [chance.gauss(0.0, 0.02) for _ in range(3)]
    angle = chance.uniform(-7, 7)

    def move(program: "vp.Program", kind: int = chance.randrange(8)) -> None:
        if kind <= 1:
            program.movej(q, zone=zone, scale=scale)
        elif kind == 2:
            program.movel(pose, zone=zone, speed=speed, orientation="spin")
        elif kind <= 4:
            program.movel(pose, zone=zone, speed=speed, scale=scale)
        elif kind == 5:
            program.movec(pose[:3, 3] + beside, pose, zone=zone, speed=speed)
        elif kind == 6:
            center = pose[:3, 3] + beside
            program.movec(center=center, axis=[0, 0, 1], angle=angle, zone=zone)
        elif angle < 0.0:
            program.spline([robot.fk(joints), pose], zone=zone, speed=speed)
        else:
            program.spline([joints, q], zone=zone)

    return move


def random_zone(chance: random.Random) -> "vp.Zone | Literal['fine']":
    """Every kind, over four decades."""
    import viapoint as vp

    size = 10 ** -(1.0 + 3.0 * chance.random())
    zones: tuple[vp.Zone | Literal["fine"], ...] = (
        "fine",
        vp.radius(size),
        vp.deviation(size),
        vp.joint_deviation(size),
    )
    return zones[chance.randrange(4)]
