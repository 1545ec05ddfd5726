"""Samples of joints as a table of text."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import numpy.typing as npt

from ._arguments import Vector
from .errors import BadProgramError

_OUTPUTS = 2**64


def read_table(path: str, joints: int) -> tuple[Vector, Vector, npt.NDArray[np.uint64]]:
    """Read lines of time, joints and, where there is such a column, outputs.

    The first line names the columns: ``t,q1,…,qn`` or ``t,q1,…,qn,outputs``, times in s, joints in
    rad or m, outputs as an integer whose bit i is output i.

    Returns
    -------
    t : ndarray, (k,)
    q : ndarray, (k, n)
    outputs : ndarray of uint64, (k,)

    Raises
    ------
    BadProgramError
        Other columns, or a line that does not hold such numbers, by its number.
    """
    columns = ["t", *(f"q{i}" for i in range(1, joints + 1))]
    with Path(path).open(encoding="utf-8", newline="") as stream:
        lines = csv.reader(stream)
        names = [name.strip() for name in next(lines, [])]
        if names not in (columns, [*columns, "outputs"]):
            raise BadProgramError(
                f'The table begins with "{",".join(names)[:80]}"; it must begin with '
                f'"{",".join(columns)}", and may have "outputs" after that.',
                file=path,
                line=1,
            )
        rows: list[list[float]] = []
        outputs: list[int] = []
        for number, line in enumerate(lines, start=2):
            try:
                if len(line) != len(names):
                    raise ValueError
                rows.append([float(text) for text in line[: joints + 1]])
                outputs.append(int(line[joints + 1]) if len(names) > len(columns) else 0)
                if not all(map(math.isfinite, rows[-1])) or not 0 <= outputs[-1] < _OUTPUTS:
                    raise ValueError
            except ValueError:
                raise BadProgramError(
                    f"line {number} does not hold {len(names)} numbers: {','.join(line)[:80]}",
                    file=path,
                    line=number,
                ) from None
    table = np.array(rows, dtype=np.float64).reshape(-1, joints + 1)
    return table[:, 0], table[:, 1:], np.array(outputs, dtype=np.uint64)
