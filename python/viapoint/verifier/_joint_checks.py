"""Joints over time: limits, continuity and rest, on the polynomials that run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._balls import Array, Ball, Indices
from ._file_parts import KINDS
from ._findings import Finding, Verdict
from ._motion_file import MotionFile
from ._polynomials import Peaks, at_ends, composed, control_points, derivative

if TYPE_CHECKING:
    from collections.abc import Iterator

SHARE_SLACK = 1e-6
"""A share of a limit up to 1 + this counts as kept."""
POSITION_SLACK = 1e-9
"""Of positions, coupled limits and steps between pieces [rad, m]."""
CLAIM_SLACK = 2e-9
"""Of a claimed share below the truth; the planner's bounds are this near."""
CLAIM_EXCESS = 1e-6
"""Of a claimed share above the truth."""
PARAMETER_SLACK = 2e-9
"""Of u outside [0, 1]."""
GAP = 2e-10
SAME_PLACE = 1e-9
"""Of x: this far beside a knot is at it."""
CHUNK = 1000
UNITS = ("rad/s", "rad/s²", "rad/s³")


class _Joints:
    """Peaks of every joint, gathered piece by piece."""

    def __init__(self, motion: MotionFile) -> None:
        n = motion.joints
        self.rates = [Peaks(n, GAP) for _ in KINDS]
        self.scaled = [Peaks(n, GAP) for _ in KINDS]
        self.low, self.high = Peaks(n, POSITION_SLACK / 4), Peaks(n, POSITION_SLACK / 4)
        rows = len(motion.limits.coupling)
        self.coupled_low = Peaks(rows, POSITION_SLACK / 4)
        self.coupled_high = Peaks(rows, POSITION_SLACK / 4)
        self.parameter = Peaks(2, POSITION_SLACK / 10)


def check_joints(motion: MotionFile, scales: Array, verdict: Verdict) -> None:
    """Prove the limits of every joint, and that pieces join and begin and end at rest.

    Parameters
    ----------
    scales : ndarray, (k,)
        Share of the limits that each piece may use.
    """
    peaks = _Joints(motion)
    ends = []
    for rows in _chunks(len(motion.durations)):
        durations = motion.durations[rows]
        q = composed(motion.paths[motion.path_of[rows]], motion.timing[rows])
        states = [q]
        for _ in KINDS:
            states.append(derivative(states[-1], durations))
        ends.append([at_ends(state) for state in states[:3]])
        _raise(peaks.high, q, rows)
        _raise(peaks.low, q, rows, sign=-1.0)
        _raise_parameter(peaks.parameter, motion.timing[rows], rows)
        for state, limit, rate, scaled in zip(
            states[1:], motion.limits.rates, peaks.rates, peaks.scaled, strict=True
        ):
            for sign in (1.0, -1.0):
                _raise(rate, state, rows, sign / limit[None, :])
                if np.any(scales < 1.0):
                    factor = sign / (limit[None, :] * scales[rows, None])
                    _raise(scaled, state, rows, factor)
        _raise_coupled(peaks, motion, q, rows)
    _judge_rates(motion, peaks, scales, verdict)
    _judge_positions(motion, peaks, verdict)
    _judge_parameter(motion, peaks.parameter, verdict)
    _judge_ends(motion, ends, verdict)


def _chunks(count: int) -> Iterator[Indices]:
    for begin in range(0, count, CHUNK):
        yield np.arange(begin, min(count, begin + CHUNK))


def _raise(peaks: Peaks, state: Ball, rows: Indices, sign: Array | float = 1.0) -> None:
    """Take (k, m, 26) polynomials in, times a factor (k, m) or (1, m)."""
    points, off = control_points(state)
    factor = np.broadcast_to(np.asarray(sign, dtype=float), off.shape)
    count = off.shape[1]
    group = np.tile(np.arange(count), len(rows))
    # Multiplying by the factor rounds each number once; `off` is far wider than that.
    scaled = (points * factor[..., None]).reshape(-1, points.shape[-1])
    size = np.abs(scaled).max(axis=1)
    peaks.raise_to(
        scaled,
        (off * np.abs(factor)).ravel() * (1 + 1e-12) + 1e-15 * size,
        group,
        np.repeat(rows, count),
    )


def _raise_parameter(peaks: Peaks, timing: Array, rows: Indices) -> None:
    u = Ball.exact(np.pad(timing, ((0, 0), (0, 20)))[:, None, :])
    points, off = control_points(u)
    for k, sign in enumerate((1.0, -1.0)):
        peaks.raise_to(sign * points[:, 0], off[:, 0], np.full(len(rows), k), rows)


def _raise_coupled(peaks: _Joints, motion: MotionFile, q: Ball, rows: Indices) -> None:
    if len(motion.limits.coupling) == 0:
        return
    mid = np.einsum("mn,knd->kmd", motion.limits.coupling, q.mid)
    size = np.abs(motion.limits.coupling)
    rad = np.einsum("mn,knd->kmd", size, q.rad + 1e-14 * np.abs(q.mid))
    coupled = Ball(mid, rad * (1 + 1e-12))
    _raise(peaks.coupled_high, coupled, rows)
    _raise(peaks.coupled_low, coupled, rows, sign=-1.0)


def _place(motion: MotionFile, peaks: Peaks, group: int) -> dict[str, Any]:
    piece = int(peaks.row[group])
    time = motion.starts[piece] + peaks.x[group] * motion.durations[piece]
    return {"piece": piece, "move": int(motion.moves[piece]), "time": float(time)}


def _judge_rates(motion: MotionFile, peaks: _Joints, scales: Array, verdict: Verdict) -> None:
    for k, kind in enumerate(KINDS):
        before = len(verdict.findings)
        worst = peaks.rates[k]
        asked = peaks.scaled[k] if np.any(scales < 1.0) else worst
        there = rates_at(motion, motion.certificate[kind]["time"], k + 1).diagonal()
        for joint in range(motion.joints):
            limit = float(motion.limits.rates[k, joint])
            if not asked.bound[joint] <= 1.0 + SHARE_SLACK:
                place = _place(motion, asked, joint)
                allowed = limit * float(scales[place["piece"]])
                share = float(asked.bound[joint])
                verdict.findings.append(
                    Finding(
                        f"the {kind} limit is broken",
                        joint=joint,
                        value=share * allowed,
                        limit=allowed,
                        **place,
                    )
                )
            _judge_claim(motion, worst, k, joint, float(there[joint]), verdict)
        shares = ", ".join(f"{100 * share:.4f}" for share in worst.bound)
        verdict.prove(f"{kind}, % of the limits", shares, "100 and as claimed", before)


def _judge_claim(
    motion: MotionFile, worst: Peaks, kind: int, joint: int, there: float, verdict: Verdict
) -> None:
    """Compare with the certificate: no less than is reached, no more than could be, and where."""
    name = KINDS[kind]
    limit = float(motion.limits.rates[kind, joint])
    claim = motion.certificate[name]
    value, share, time = (float(claim[key][joint]) for key in ("value", "share", "time"))
    place = _place(motion, worst, joint)
    reached, bound = float(worst.reached[joint]), float(worst.bound[joint])
    for told in (value / limit, share):
        if told < reached * (1.0 - CLAIM_SLACK) - CLAIM_SLACK:
            what = f"the certificate claims less {name} than is reached"
        elif told > bound + CLAIM_EXCESS:
            what = f"the certificate claims more {name} than there is"
        else:
            continue
        verdict.findings.append(
            Finding(what, joint=joint, value=told * limit, limit=reached * limit, **place)
        )
        return
    if there < (share - CLAIM_EXCESS) * limit:
        verdict.findings.append(
            Finding(
                f"the worst {name} is not where the certificate claims it",
                joint=joint,
                time=time,
                value=there,
                limit=value,
            )
        )


def rates_at(motion: MotionFile, times: Array, order: int) -> Array:
    """Return the derivative of the joints at some times in plain rounding, (k, n), in size.

    Where pieces meet, the larger: what happens at a knot may belong to either side of it.
    """
    last = len(motion.durations) - 1
    piece = np.searchsorted(motion.starts[1:-1], times, side="right")
    found = np.zeros((len(times), motion.joints))
    for near in (-1, 0, 1):
        rows = np.clip(piece + near, 0, last)
        x = (times - motion.starts[rows]) / motion.durations[rows]
        state = composed(motion.paths[motion.path_of[rows]], motion.timing[rows])
        for _ in range(order):
            state = derivative(state, motion.durations[rows])
        powers = np.clip(x, 0.0, 1.0)[:, None] ** np.arange(26)
        values = np.abs(np.einsum("knd,kd->kn", state.mid, powers))
        # A time is rounded, by more of a short piece the later it comes.
        slack = SAME_PLACE + 2.0**-50 * times / motion.durations[rows]
        inside = (x >= -slack) & (x <= 1.0 + slack)
        found = np.where(inside[:, None], np.maximum(found, values), found)
    return found


def _judge_positions(motion: MotionFile, peaks: _Joints, verdict: Verdict) -> None:
    limits = motion.limits
    before = len(verdict.findings)
    slack = np.maximum(POSITION_SLACK, 2.0**-46 * np.abs(motion.paths).max())
    for name, peak, sign, bounds in (
        ("position_max", peaks.high, 1.0, limits.position_max),
        ("position_min", peaks.low, -1.0, limits.position_min),
    ):
        for joint in range(motion.joints):
            place = _place(motion, peak, joint)
            value, limit = sign * float(peak.bound[joint]), float(bounds[joint])
            if not sign * value <= sign * limit + slack:
                verdict.findings.append(
                    Finding(
                        "the joint leaves its range", joint=joint, value=value, limit=limit, **place
                    )
                )
            claim = float(motion.certificate[name][joint])
            off = sign * claim - sign * value
            if not -2.0 * slack <= off <= CLAIM_EXCESS + slack:
                verdict.findings.append(
                    Finding(
                        f"the certificate's {name} is not what the joint reaches",
                        joint=joint,
                        value=claim,
                        limit=value,
                        **place,
                    )
                )
    verdict.prove("position of every joint", "within", "its range and as claimed", before)
    before = len(verdict.findings)
    for peak, sign, bounds in (
        (peaks.coupled_high, 1.0, limits.coupling_upper),
        (peaks.coupled_low, -1.0, limits.coupling_lower),
    ):
        for row in range(len(bounds)):
            value, limit = sign * float(peak.bound[row]), float(bounds[row])
            if not sign * value <= sign * limit + slack:
                verdict.findings.append(
                    Finding(
                        f"coupled limit {row + 1} is left",
                        value=value,
                        limit=limit,
                        **_place(motion, peak, row),
                    )
                )
    if len(limits.coupling):
        verdict.prove("coupled limits", "within", "their range", before)


def _judge_parameter(motion: MotionFile, peaks: Peaks, verdict: Verdict) -> None:
    for k, limit in ((0, 1.0), (1, 0.0)):
        value = float(peaks.bound[k])
        if not value <= limit + PARAMETER_SLACK:
            verdict.findings.append(
                Finding(
                    "a piece runs beyond the end of its path",
                    value=value if k == 0 else -value,
                    limit=limit,
                    **_place(motion, peaks, k),
                )
            )


def _judge_ends(motion: MotionFile, ends: list[list[tuple[Ball, Ball]]], verdict: Verdict) -> None:
    """Look at steps between pieces, and at the rates at both ends of the motion."""
    before = len(verdict.findings)
    n = motion.joints
    size = np.abs(motion.paths).max(axis=(0, 1))
    allowed = [
        np.maximum(POSITION_SLACK, 2.0**-49 * size),
        1e-6 * motion.limits.rates[0],
        1e-6 * motion.limits.rates[1],
    ]
    names = ("position", "velocity", "acceleration")
    worst = []
    for order in range(3):
        first = np.concatenate([chunk[order][0].mid for chunk in ends])
        last = np.concatenate([chunk[order][1].mid for chunk in ends])
        off = np.concatenate([chunk[order][0].rad + chunk[order][1].rad for chunk in ends])
        step = np.abs(first[1:] - last[:-1]) + off[1:] + off[:-1]
        worst.append(f"{step.max(initial=0.0):.1e}")
        for piece, joint in np.argwhere(~(step <= allowed[order]))[:n]:
            verdict.findings.append(
                Finding(
                    f"the {names[order]} steps between two pieces",
                    piece=int(piece) + 1,
                    move=int(motion.moves[piece + 1]),
                    time=float(motion.starts[piece + 1]),
                    joint=int(joint),
                    value=float(step[piece, joint]),
                    limit=float(allowed[order][joint]),
                )
            )
        if order == 0 or motion.timed:
            continue
        for state, blur, name, piece in (
            (first[0], off[0], "start", 0),
            (last[-1], off[-1], "end", len(motion.durations) - 1),
        ):
            speed = np.abs(state) + blur
            for joint in np.flatnonzero(~(speed <= allowed[order])):
                verdict.findings.append(
                    Finding(
                        f"the motion is not at rest at its {name}: {names[order]}",
                        piece=piece,
                        move=int(motion.moves[piece]),
                        time=float(motion.starts[piece and -1]),
                        joint=int(joint),
                        value=float(speed[joint]),
                        limit=float(allowed[order][joint]),
                    )
                )
    told = float(motion.certificate["duration"])
    total = float(motion.starts[-1])
    if abs(told - total) > 1e-9 * max(total, 1.0):
        verdict.findings.append(
            Finding("the claimed duration is not that of the pieces", value=told, limit=total)
        )
    verdict.prove("steps of q, q̇, q̈", ", ".join(worst), "C², at rest at both ends", before)
