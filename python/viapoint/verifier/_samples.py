"""How far a motion is from its curves moment by moment, for pictures; nothing is proven here."""

from __future__ import annotations

import numpy as np

from ._balls import Array
from ._deviation_checks import Along
from ._file_parts import TURNING
from ._motion_file import MotionFile

LOOKS = 9


def deviations(motion: MotionFile) -> tuple[Array, Array, Array]:
    """Find distance and angle of the tool from the curve that it follows.

    Returns
    -------
    time : ndarray, (k,)
        [s]
    distance, angle : ndarray, (k,)
        [m], [rad]; NaN where no curve is to be followed, as in corners.
    """
    x = np.linspace(0.0, 1.0, LOOKS)
    time = (motion.starts[:-1, None] + motion.durations[:, None] * x).ravel()
    u = np.clip(motion.timing @ np.vander(x, 6, increasing=True).T, 0.0, 1.0)
    distance, angle = np.full(u.shape, np.nan), np.full(u.shape, np.nan)
    for kinds, values, along_angle in (
        ((*TURNING, "position", "wrist"), distance, False),
        (TURNING, angle, True),
    ):
        paths = [i for i, s in enumerate(motion.stretches) if _hold(motion, s.leg) in kinds]
        if motion.chain is None or not paths:
            continue
        along = Along(motion, motion.chain, paths)
        number = {path: item for item, path in enumerate(paths)}
        pieces = [k for k, path in enumerate(motion.path_of) if int(path) in number]
        items = np.repeat([number[int(motion.path_of[k])] for k in pieces], LOOKS)
        middle = u[pieces].ravel()
        look = along.angles if along_angle else along.positions
        reached = look(items, middle, np.zeros_like(middle))[1]
        values[pieces] = reached.reshape(-1, LOOKS)
    return time, distance.ravel(), angle.ravel()


def _hold(motion: MotionFile, leg: int | None) -> str:
    return "" if leg is None else motion.legs[leg].hold
