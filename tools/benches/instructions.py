"""Instructions of each tick, counted by callgrind: the same on any machine, however loaded."""

import shutil
import subprocess
import tempfile
from pathlib import Path

from benches.tables import Row

TICK = "viapoint::Interpolator::tick(viapoint::Setpoint&)"
TICKS = 600
"""Of each case of the tick bench, which does each twice: callgrind writes a file for each."""


def totals(folder: Path) -> list[int]:
    """Read what every dump in `folder` counted, in ascending order; empty dumps do not count."""
    dumps = [dump.read_text(encoding="utf-8") for dump in folder.iterdir()]
    lines = [line for dump in dumps for line in dump.splitlines() if line.startswith("totals:")]
    counts = [int(line.split()[1]) for line in lines]
    return sorted(count for count in counts if count > 0)


def measure(program: Path) -> list[Row]:
    """Count the instructions of the tick bench's ticks; nothing without valgrind or ticks."""
    valgrind = shutil.which("valgrind")
    if valgrind is None:
        return []
    with tempfile.TemporaryDirectory() as name:
        command = [valgrind, "--tool=callgrind", "--collect-atstart=no", "--quiet"]
        command += [f"--callgrind-out-file={name}/ticks", f"--toggle-collect={TICK}"]
        command += [f"--dump-after={TICK}", str(program), "tick", str(TICKS)]
        subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
        counts = totals(Path(name))
    if not counts:
        return []
    return [
        {
            "bench": "tick",
            "case": "instructions of each tick, all cases",
            "ticks": len(counts),
            "p50_instructions": counts[len(counts) // 2],
            "p99_instructions": counts[len(counts) * 99 // 100],
            "max_instructions": counts[-1],
        }
    ]
