"""Where the tool of a serial chain is, as jets: a walk from tool to base, joint by joint."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ._balls import ROUNDING, Array, Ball
from ._jets import constant, linear, product, sine_cosine_jets

QUATERNION_SLACK = 1e-14
"""Rounding of a quaternion from a matrix, by components of it, beyond what the matrix shows."""


@dataclass(frozen=True)
class Chain:
    """From the frame that poses are told in: go by `before`, then turn about or slide along `axis`.

    Attributes
    ----------
    prismatic : ndarray of bool, (n,)
    before : ndarray, (n, 4, 4)
    axis : ndarray, (n, 3)
        Unit.
    """

    prismatic: Array
    before: Array
    axis: Array

    @property
    def joints(self) -> int:
        """Number of joints."""
        return len(self.axis)


def tool_point(chain: Chain, tool: Array, joints: Ball) -> Ball:
    """Jets of the tool point, (p + 1, 3, N), from those of the joints, (p + 1, n, N)."""
    point = constant(Ball.exact(tool[:3, 3].reshape(3, 1)))
    for i in range(chain.joints - 1, -1, -1):
        axis = chain.axis[i]
        angle = joints[:, i : i + 1]
        if chain.prismatic[i]:
            along = Ball(axis[:, None] * angle.mid, np.abs(axis)[:, None] * angle.rad)
            point = point + Ball(along.mid, along.rad + ROUNDING * np.abs(along.mid))
        else:
            # Rodrigues: v = a (a·v) + cos q (v - a (a·v)) + sin q (a x v).
            sines, cosines = sine_cosine_jets(angle)
            along = linear(np.outer(axis, axis), point)
            turned = product(cosines, point - along)
            point = along + turned + product(sines, linear(cross_matrix(axis), point))
        point = linear(chain.before[i, :3, :3], point) + constant(
            Ball.exact(chain.before[i, :3, 3].reshape(3, 1))
        )
    return point


def tool_rotation(chain: Chain, tool: Array, joints: Ball) -> Ball:
    """Jets of the tool's unit quaternion (w, x, y, z), (p + 1, 4, N)."""
    turn = constant(column(quaternion(tool[:3, :3])))
    for i in range(chain.joints - 1, -1, -1):
        if not chain.prismatic[i]:
            sines, cosines = sine_cosine_jets(joints[:, i : i + 1].scaled(0.5))
            axis = left_product(np.concatenate([[0.0], chain.axis[i]]))
            turn = product(cosines, turn) + product(sines, linear(axis, turn))
        turn = apply(quaternion(chain.before[i, :3, :3]), turn)
    return turn


def cross_matrix(a: Array) -> Array:
    """Matrix of the cross product with a."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


def left_product(q: Array) -> Array:
    """Matrix of the quaternion product with q on the left."""
    w, x, y, z = q
    return np.array([[w, -x, -y, -z], [x, w, -z, y], [y, z, w, -x], [z, -y, x, w]])


def column(values: Ball) -> Ball:
    """Of a vector, for any number of intervals."""
    return Ball(values.mid[:, None], values.rad[:, None])


def apply(q: Ball, turn: Ball) -> Ball:
    """Quaternion product with a fixed ball on the left of jets, (p + 1, 4, N)."""
    sharp = linear(left_product(q.mid), turn)
    blur = np.abs(left_product(q.rad))
    return Ball(sharp.mid, sharp.rad + np.einsum("ij,kj...->ki...", blur, turn.size))


def quaternion(rotation: Array) -> Ball:
    """Return the unit quaternion of a matrix, (4,); what that is off by is in the radius."""
    trace = np.trace(rotation)
    k = int(np.argmax(np.append(np.diag(rotation), trace)))
    if k == 3:
        q = np.array(
            [
                1.0 + trace,
                rotation[2, 1] - rotation[1, 2],
                rotation[0, 2] - rotation[2, 0],
                rotation[1, 0] - rotation[0, 1],
            ]
        )
    else:
        a, b, c = k, (k + 1) % 3, (k + 2) % 3
        q = np.empty(4)
        q[0] = rotation[c, b] - rotation[b, c]
        q[1 + a] = 1.0 + rotation[a, a] - rotation[b, b] - rotation[c, c]
        q[1 + b] = rotation[b, a] + rotation[a, b]
        q[1 + c] = rotation[c, a] + rotation[a, c]
    q /= np.linalg.norm(q)
    off = float(np.linalg.norm(matrix_of(q) - rotation))
    return Ball(q, np.full(4, off + QUATERNION_SLACK))


def matrix_of(q: Array) -> Array:
    """Rotation matrix of a unit quaternion."""
    vector = q[1:]
    turn: Array = (
        (q[0] ** 2 - vector @ vector) * np.eye(3)
        + 2.0 * np.outer(vector, vector)
        + 2.0 * q[0] * cross_matrix(vector)
    )
    return turn
