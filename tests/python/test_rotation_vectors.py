"""Rotations in their three forms: there and back, half turns and tiny ones, too."""

import numpy as np

from viapoint._rotation_vectors import quaternions, rotation_vectors, rotations_of


def test_matrices_quaternions_and_vectors_are_the_same_rotation():
    rng = np.random.default_rng(1)
    q = rng.normal(size=(5000, 4)) * rng.choice([1.0, 1e-9, 0.0], size=(5000, 4), p=[0.7, 0.2, 0.1])
    q = q[np.linalg.norm(q, axis=1) > 0]
    q /= np.linalg.norm(q, axis=1)[:, None]
    w, x, y, z = q.T
    rotations = np.moveaxis(
        np.array(
            [
                [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
            ]
        ),
        -1,
        0,
    )
    found = quaternions(rotations)
    np.testing.assert_allclose(np.abs(np.sum(found * q, axis=1)), 1.0, atol=1e-12)
    assert (found[:, 0] >= 0.0).all()
    vectors = rotation_vectors(rotations)
    assert np.linalg.norm(vectors, axis=1).max() <= np.pi + 1e-12
    np.testing.assert_allclose(rotations_of(vectors), rotations, atol=1e-12)


def test_small_vectors_come_back_as_they_are():
    vectors = np.array([[0.0, 0.0, 0.0], [1e-12, 0.0, 0.0], [0.0, -1e-5, 2e-5], [0.3, 0.2, -0.1]])
    np.testing.assert_allclose(rotation_vectors(rotations_of(vectors)), vectors, atol=1e-15)
