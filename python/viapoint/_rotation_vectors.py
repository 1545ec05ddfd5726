"""Rotation matrices, unit quaternions and rotation vectors, many at a time."""

from __future__ import annotations

import numpy as np

from ._arguments import Vector


def quaternions(rotations: Vector) -> Vector:
    """Return unit quaternions (w, x, y, z), w >= 0, (k, 4), of matrices (k, 3, 3).

    The row of 4 q qᵀ with the largest diagonal, so that nothing is divided by little
    (Shepperd 1978).
    """
    r = rotations
    square = np.empty((len(r), 4, 4))
    trace = np.trace(r, axis1=1, axis2=2)
    square[:, 0, 0] = 1.0 + trace
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        square[:, 1 + i, 1 + i] = 1.0 + 2.0 * r[:, i, i] - trace
        square[:, 0, 1 + i] = square[:, 1 + i, 0] = r[:, k, j] - r[:, j, k]
        square[:, 1 + i, 1 + j] = square[:, 1 + j, 1 + i] = r[:, i, j] + r[:, j, i]
    largest = np.argmax(np.diagonal(square, axis1=1, axis2=2), axis=1)
    q = square[np.arange(len(r)), largest]
    q = q * np.where(q[:, :1] < 0.0, -1.0, 1.0)
    unit: Vector = q / np.linalg.norm(q, axis=1)[:, None]
    return unit


def rotation_vectors(rotations: Vector) -> Vector:
    """Return axis times angle, (k, 3) [rad], of at most half a turn, of matrices (k, 3, 3)."""
    q = quaternions(rotations)
    size = np.linalg.norm(q[:, 1:], axis=1)
    angle = 2.0 * np.arctan2(size, q[:, 0])
    factor = np.divide(angle, size, out=np.full(len(q), 2.0), where=size > 0.0)
    vectors: Vector = q[:, 1:] * factor[:, None]
    return vectors


def rotations_of(vectors: Vector) -> Vector:
    """Return matrices, (k, 3, 3), of rotation vectors (k, 3) [rad] (Rodrigues 1840)."""
    cross = np.zeros((len(vectors), 3, 3))
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        cross[:, k, j], cross[:, j, k] = vectors[:, i], -vectors[:, i]
    angle = np.linalg.norm(vectors, axis=1)[:, None, None]
    first = np.sinc(angle / np.pi)
    second = 0.5 * np.sinc(0.5 * angle / np.pi) ** 2  # (1 - cos φ) / φ²
    matrices: Vector = np.eye(3) + first * cross + second * (cross @ cross)
    return matrices
