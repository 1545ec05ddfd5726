"""What the Python tests share: the golden numbers and the arms."""

from __future__ import annotations

import json
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import viapoint as vp

# A shell's background jobs ignore Ctrl-C, and so would the programs that the tests interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="session")
def golden() -> dict[str, Any]:
    return json.loads((ROOT / "tests" / "data" / "golden.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="session")
def puma() -> vp.Robot:
    return vp.load_robot("puma560")


@pytest.fixture(scope="session")
def abc(golden: dict[str, Any]) -> dict[str, np.ndarray]:
    """Joints of A, B and C [rad]."""
    return {key: np.radians(value) for key, value in golden["puma560"]["joints_deg"].items()}


@pytest.fixture
def short(puma: vp.Robot, abc: dict[str, np.ndarray]) -> vp.Program:
    """A joint move of about 0.3 s from A."""
    return vp.Program(puma, start=abc["A"], name="short").movej(abc["A"] + 0.2)
