"""Subjects that viapoint-bench measures in C++."""

import json
import subprocess
from pathlib import Path

from benches import instructions
from benches.tables import Row

SUBJECTS = (
    "tick",
    "commands",
    "plan",
    "certificate",
    "walk",
    "growth",
    "stream",
    "insertion",
    "kinematics",
    "tracking",
)
# What a quick look measures: enough to see the order of magnitude.
QUICK = {
    "tick": 100_000,
    "commands": 100,
    "plan": 10,
    "certificate": 10,
    "walk": 3,
    "growth": 1000,
    "stream": 1000,
    "insertion": 20,
    "kinematics": 10_000,
    "tracking": 30,
}


def read_lines(text: str) -> list[Row]:
    """Read what viapoint-bench prints: one JSON object a line.

    Raises
    ------
    ValueError
        A line that is none, or lacks ``bench`` or ``case``.
    """
    rows: list[Row] = []
    for line in filter(None, text.splitlines()):
        try:
            row = json.loads(line)
        except json.JSONDecodeError:
            row = None
        if not isinstance(row, dict) or not {"bench", "case"} <= row.keys():
            raise ValueError(f"viapoint-bench printed {line!r}, no object with bench and case")
        rows.append(row)
    return rows


def measure(program: Path, subject: str, *, quick: bool) -> list[Row]:
    """Run one subject of viapoint-bench."""
    command = [str(program), subject, *([str(QUICK[subject])] if quick else [])]
    text = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout
    rows = read_lines(text)
    if subject == "tick" and not quick:
        rows += instructions.measure(program)
    return rows
