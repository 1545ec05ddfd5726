"""The names users have, and the units."""

import subprocess
import sys

import numpy as np
import pytest

import viapoint as vp
from viapoint import deg, mm

FIXED = [
    *("load_robot", "joint_robot", "Program", "connect", "simulate", "profile", "insert_knots"),
    *("deg", "mm", "radius", "deviation", "joint_deviation", "PointList", "errors", "MotionError"),
]


@pytest.mark.parametrize("name", FIXED)
def test_the_names_of_the_public_face_exist(name: str):
    assert name in vp.__all__
    assert getattr(vp, name) is not None


def test_all_lists_what_exists_and_nothing_private():
    assert sorted(set(vp.__all__)) == sorted(vp.__all__)
    for name in vp.__all__:
        assert hasattr(vp, name)
        assert name == "__version__" or not name.startswith("_")


@pytest.mark.parametrize("name", [n for n in vp.__all__ if n not in ("deg", "mm", "__version__")])
def test_everything_public_is_documented(name: str):
    assert (getattr(vp, name).__doc__ or "").strip(), name


def test_units_scale_numbers_and_lists():
    assert 180 * deg == pytest.approx(np.pi, abs=1e-15)
    assert 20 * mm == pytest.approx(0.02, abs=1e-15)
    np.testing.assert_allclose([90, 180] * deg, [np.pi / 2, np.pi], atol=1e-15)
    np.testing.assert_allclose(((0, 1000), (1, 2)) * mm, [[0, 1], [0.001, 0.002]], atol=1e-15)
    assert 1.0 / deg == pytest.approx(180 / np.pi)


def test_importing_draws_in_nothing_that_only_some_need():
    code = (
        "import viapoint, sys; "
        "print([m for m in ('matplotlib', 'typer', 'rich', 'grpc') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
