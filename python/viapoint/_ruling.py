"""Which limit rules a motion, moment by moment."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ._arguments import Vector

if TYPE_CHECKING:
    from ._motion import Motion

KINDS = ("velocity", "acceleration", "jerk")
LOOKS = 8
RULES = 0.95
"""From this share on a limit counts as what holds the motion back."""


@dataclass(frozen=True)
class Rule:
    """A stretch of time and the limit that holds it back.

    Attributes
    ----------
    start, end : float
        [s]
    kind : {"velocity", "acceleration", "jerk", "rest", "other"}
        "other": none of the joints' rates is at its limit, as where the tool's speed was asked for.
    joint : int or None
        From 0; None for "rest" and "other".
    share : float
        Of that limit, in the middle of the stretch, 0 to 1; the largest of all where none rules.
    """

    start: float
    end: float
    kind: str
    joint: int | None
    share: float


def shares_at(motion: Motion, times: Vector) -> Vector:
    """Return shares of velocity, acceleration and jerk limits, (k, 3, n), signs dropped."""
    states = motion.at(times)
    limits = motion.robot.limits
    shares: Vector = np.stack(
        [
            np.abs(states.qd) / limits.velocity,
            np.abs(states.qdd) / limits.acceleration,
            np.abs(states.qddd) / limits.jerk,
        ],
        axis=1,
    )
    return shares


def rules_of(motion: Motion, starts: Vector, scales: Vector) -> list[Rule]:
    """Find the stretches of a motion.

    Parameters
    ----------
    starts : ndarray, (k + 1,)
        When each piece begins, and the end [s].
    scales : ndarray, (k,)
        Share of the limits that each piece may use.
    """
    edges = starts[:-1, None] + np.diff(starts)[:, None] * np.arange(LOOKS) / LOOKS
    edges = np.append(edges.ravel(), starts[-1])
    shares = (
        shares_at(motion, 0.5 * (edges[1:] + edges[:-1])) / np.repeat(scales, LOOKS)[:, None, None]
    )
    joints = shares.shape[2]
    flat = shares.reshape(len(shares), -1)
    which = flat.argmax(axis=1)
    worst = flat.max(axis=1)
    which = np.where(worst >= RULES, which, np.where(worst > 0.0, -1, -2))
    cuts = np.concatenate([[0], np.flatnonzero(np.diff(which)) + 1, [len(which)]])
    bounds = edges[cuts]
    middle = shares_at(motion, 0.5 * (bounds[1:] + bounds[:-1])).reshape(len(cuts) - 1, -1)
    rules = []
    for k in range(len(cuts) - 1):
        number = int(which[cuts[k]])
        kind = ("rest", "other")[number + 2] if number < 0 else KINDS[number // joints]
        joint = None if number < 0 else number % joints
        share = float(middle[k].max() if number < 0 else middle[k][number])
        rules.append(Rule(float(bounds[k]), float(bounds[k + 1]), kind, joint, share))
    return rules
