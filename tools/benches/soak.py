"""The loop on the machine's clock for a long time, with all that can be done to it done at random.

Programs and streams run one after the other on a simulated arm with lag and noise. One thread
tells them, one turns the override, pauses, resumes, steps, goes back and stops, one jogs, switches
inputs and outputs and lets runs act on inputs, and one watches and writes logs. Every logged cycle
is held against limits and path. A breach of the guard, a run that ends otherwise than it was told
to or not at all, and memory that grows are failures.
"""

import subprocess
from pathlib import Path

from benches import core
from benches.tables import Row

QUICK_SECONDS = 20


def measure(program: Path, minutes: float, *, quick: bool) -> list[Row]:
    """Soak for so long; what is wrong is told as it comes."""
    seconds = QUICK_SECONDS if quick else max(1, round(60.0 * minutes))
    command = [str(program), "soak", str(seconds)]
    text = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout
    return core.read_lines(text)
