"""Random programs of mixed moves, planned from Python: each ends in a proven motion.

``viapoint-bench programs`` makes them, as the C++ tests do. A move that is refused, with its line,
is left out, and the rest planned anew.
"""

import json
import statistics
import subprocess
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from benches.soundness import MOST_SHARE
from benches.tables import Row

if TYPE_CHECKING:
    import viapoint as vp

VERIFIED = 50
"""One motion in so many is proven again from its file, by the verifier."""
NEVER = {"internal", "discontinuous", "velocity_limit", "acceleration_limit", "jerk_limit"}
"""Refusals that would be the planner's own fault."""


def measure(maker: Path, problems: int, *, quick: bool) -> list[Row]:
    """Plan so many programs that ``maker`` prints; a row of failures at the end."""
    failures: list[str] = []
    tallies: dict[str, Tally] = {}
    for name, seed, program in random_programs(maker, 20 if quick else problems):
        tally = tallies.setdefault(name, Tally(name))
        if fault := tally.plan(program, verify=seed % VERIFIED == 0):
            failures.append(f"{name} {seed}: {fault}")
    rows: list[Row] = [
        {"bench": "programs", "case": name, **tally.row()} for name, tally in tallies.items()
    ]
    rows.append({"bench": "programs: soundness", "case": "failures", "value": len(failures)})
    rows += [{"bench": "programs: failed", "case": failure} for failure in failures[:20]]
    return rows


def random_programs(maker: Path, count: int) -> Iterator[tuple[str, int, dict[str, Any]]]:
    """Robot, seed and program, one after the other."""
    command = [str(maker), "programs", str(count)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as made:
        assert made.stdout is not None
        for line in made.stdout:
            row = json.loads(line)
            yield row["case"], row["seed"], row["program"]
    if made.returncode != 0:
        raise subprocess.CalledProcessError(made.returncode, command)


class Tally:
    """What became of one robot's programs."""

    def __init__(self, name: str) -> None:
        import viapoint as vp

        self.robot = vp.load_robot(name)
        self.programs = self.moves = self.planned = self.verified = 0
        self.refused: Counter[str] = Counter()
        self.times: list[float] = []
        self.share = self.deviation = 0.0

    def plan(self, program: dict[str, Any], *, verify: bool) -> str:
        """Plan one, without the moves that are refused, and say what is wrong with what came.

        Returns
        -------
        fault : str
            Empty where nothing is wrong.
        """
        import viapoint as vp

        self.programs += 1
        steps = program["steps"]
        self.moves += len(steps)
        while steps:
            loaded = self.load(program)
            begin = time.perf_counter()
            try:
                motion = loaded.plan()
            except vp.MotionError:
                wrong: set[int] = set()
                for problem in loaded.check().errors:
                    self.refused[problem.code] += 1
                    if problem.code == "empty_program":  # waits are all that is left
                        return ""
                    if not problem.message or not problem.line or problem.move is None:
                        return f"{problem} names no line or no move"
                    if problem.code in NEVER:
                        return str(problem)
                    wrong.add(problem.move)
                if not wrong:
                    return "refused, and the report has no error"
                program["steps"] = steps = [step for k, step in enumerate(steps) if k not in wrong]
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

    def load(self, program: dict[str, Any]) -> "vp.Program":
        """Read it from a file, as any program is read that was saved."""
        import viapoint as vp

        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "program.json"
            path.write_text(json.dumps(program))
            return vp.Program.load(path, self.robot)

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
