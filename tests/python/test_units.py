"""Factors to SI scale numbers and lists, on either side."""

import numpy as np
import pytest

from viapoint import deg, mm


@pytest.mark.parametrize("values", [[180, -90], (180.0, -90.0), np.array([180.0, -90.0])])
def test_a_list_is_scaled_on_either_side(values):
    for scaled in (deg * values, values * deg):
        np.testing.assert_allclose(scaled, [np.pi, -np.pi / 2])


def test_a_number_is_scaled_on_either_side():
    assert 20 * mm == mm * 20 == 0.02
    assert [[1, 2], [3, 4]] * mm == pytest.approx(np.array([[1, 2], [3, 4]]) / 1000)
