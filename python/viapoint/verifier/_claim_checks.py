"""Claims of the certificate that are no bounds: which limit rules when, and manipulability."""

from __future__ import annotations

import numpy as np

from ._balls import Array
from ._chain import Chain, cross_matrix
from ._file_parts import KINDS
from ._findings import Finding, Verdict
from ._joint_checks import rates_at
from ._motion_file import MotionFile
from ._zone_checks import points_at

SLACK = 1e-6
SAME_TIME = 1e-9
BESIDE = 1e-7
"""How far beside the middle of a stretch, by its length."""


def check_claims(motion: MotionFile, verdict: Verdict) -> None:
    """Compare what the certificate tells besides its bounds."""
    before = len(verdict.findings)
    _check_rules(motion, verdict)
    verdict.prove("which limit rules when", "as claimed", "in the middle of each stretch", before)
    claim = float(motion.certificate["zone_deviation"])
    largest = max((c.cut for c in motion.corners), default=0.0)
    if claim < largest:
        verdict.findings.append(
            Finding(
                "the certificate's zone_deviation is below a corner's", value=claim, limit=largest
            )
        )
    if motion.chain is None or motion.timed:
        return
    before = len(verdict.findings)
    found = least_manipulability(motion, motion.chain)
    told = float(motion.certificate["manipulability"])
    if abs(told - found) > SLACK * max(abs(found), SLACK):
        verdict.findings.append(
            Finding("the claimed manipulability is not what the arm has", value=told, limit=found)
        )
    verdict.prove("least manipulability", f"{found:.6g}", "as claimed", before)


def _check_rules(motion: MotionFile, verdict: Verdict) -> None:
    end = 0.0
    rules = motion.certificate["rules"]
    middles = np.array([0.5 * (rule["from"] + rule["to"]) for rule in rules])
    widths = np.array([rule["to"] - rule["from"] for rule in rules])
    # There, just before and after: jerk may step in the middle, or a piece may hardly last.
    sides = np.stack([_shares(motion, middles + side * widths) for side in (-BESIDE, 0.0, BESIDE)])
    for k, rule in enumerate(rules):
        if abs(rule["from"] - end) > SAME_TIME * max(end, 1.0):
            verdict.findings.append(Finding(f"rule {k} does not begin where the one before ends"))
        end = float(rule["to"])
        both = sides[:, k].max(axis=(1, 2))
        if rule["kind"] in KINDS:
            both = sides[:, k, KINDS.index(rule["kind"]), rule["joint"]]
        there = float(np.clip(rule["share"], both.min(), both.max()))
        if abs(there - rule["share"]) > 1e-4:
            verdict.findings.append(
                Finding(
                    f"rule {k} claims another share of the {rule['kind']} limit",
                    time=float(middles[k]),
                    joint=rule.get("joint"),
                    value=rule["share"],
                    limit=there,
                )
            )
    if abs(end - motion.starts[-1]) > SAME_TIME * max(end, 1.0):
        verdict.findings.append(Finding("the rules end before the motion does, or after"))


def _shares(motion: MotionFile, times: Array) -> Array:
    """Find all joints' shares of their limits, (k, 3, n)."""
    rates = [rates_at(motion, times, i + 1) for i in range(len(KINDS))]
    shares: Array = np.stack(rates, axis=1) / motion.limits.rates
    return shares


def least_manipulability(motion: MotionFile, chain: Chain) -> float:
    """√det J Jᵀ at ends and middles of the pieces (Yoshikawa 1985), in plain rounding."""
    u = motion.timing @ np.vander([0.0, 0.5, 1.0], 6, increasing=True).T
    q = np.einsum(
        "ksj,kjn->ksn",
        np.vander(u.ravel(), 6, increasing=True).reshape(*u.shape, 6),
        motion.paths[motion.path_of],
    )
    legs = {leg.move: leg.tool for leg in motion.legs}
    tool_at = np.array([legs.get(int(move), -1) for move in motion.moves])
    # A rest keeps the tool of the move before it; before the first, that of the first.
    for k in range(1, len(tool_at)):
        tool_at[k] = tool_at[k - 1] if tool_at[k] < 0 else tool_at[k]
    first = next((t for t in tool_at if t >= 0), 0)
    tool_at[tool_at < 0] = first
    least = np.inf
    for number in np.unique(tool_at):
        chosen = q[tool_at == number].reshape(-1, motion.joints)
        jacobian = jacobians(chain, motion.tools[number], chosen)
        least = min(least, float(_volume(chain, motion.tools[number], jacobian).min()))
    return least


def _volume(chain: Chain, tool: Array, jacobian: Array) -> Array:
    """Over the rows that the arm can move at all."""
    n = chain.joints
    generic = np.sin(1.3 + 2.1 * np.arange(5)[:, None] + 1.7 * np.arange(n))
    rows = np.flatnonzero(np.abs(jacobians(chain, tool, generic)).max(axis=(0, 2)) > 1e-9)
    if len(rows) > n:
        rows = rows[rows < 3]
    part = jacobian[:, rows]
    values: Array = np.prod(np.linalg.svd(part, compute_uv=False), axis=1)
    return values


def jacobians(chain: Chain, tool: Array, q: Array) -> Array:
    """Geometric Jacobians at the tool point, base frame, (k, 6, n)."""
    count = len(q)
    turn = np.broadcast_to(np.eye(3), (count, 3, 3))
    place = np.zeros((count, 3))
    axes, origins = [], []
    for i in range(chain.joints):
        place = place + turn @ chain.before[i, :3, 3]
        turn = turn @ chain.before[i, :3, :3]
        axis = turn @ chain.axis[i]
        axes.append(axis)
        origins.append(place)
        if chain.prismatic[i]:
            place = place + axis * q[:, i, None]
        else:
            cross = cross_matrix(chain.axis[i])
            sines, cosines = np.sin(q[:, i])[:, None, None], np.cos(q[:, i])[:, None, None]
            turn = turn @ (np.eye(3) + sines * cross + (1.0 - cosines) * (cross @ cross))
    end = points_at(chain, tool, q)
    columns = []
    for i in range(chain.joints):
        arm = np.cross(axes[i], end - origins[i])
        slides = bool(chain.prismatic[i])
        turning = np.zeros_like(arm) if slides else axes[i]
        columns.append(np.concatenate([axes[i] if slides else arm, turning], axis=1))
    return np.stack(columns, axis=2)
