"""The systemd unit that comes with the controller."""

import shutil
import subprocess
from pathlib import Path

import pytest

UNIT = Path(__file__).parents[2] / "cpp" / "controller" / "viapoint-controller.service"
MOST_EXPOSED = 25
"""Of 100, as ``systemd-analyze security`` counts: below 30 it calls a service OK."""


@pytest.fixture
def unit(tmp_path):
    """Return the unit as it stands on a machine that has what it names."""
    text = UNIT.read_text(encoding="utf-8").replace("User=viapoint", "User=daemon")
    words = text.split()
    (program,) = [word for word in words if word.startswith("ExecStart=")]
    path = tmp_path / UNIT.name
    path.write_text(text.replace(program, "ExecStart=/bin/true"), encoding="utf-8")
    return path


def analyze(*arguments):
    if shutil.which("systemd-analyze") is None:
        pytest.skip("systemd-analyze is not installed: the unit was NOT tested")
    return subprocess.run(
        ["systemd-analyze", *arguments], capture_output=True, text=True, timeout=60, check=False
    )


def test_the_unit_is_one(unit):
    done = analyze("verify", "--man=no", unit)
    assert (done.returncode, done.stderr) == (0, "")


def test_the_unit_leaves_the_process_little(unit):
    done = analyze("security", "--offline=true", f"--threshold={MOST_EXPOSED}", unit)
    assert done.returncode == 0, done.stdout


def test_the_unit_gives_the_loop_its_rights():
    lines = UNIT.read_text(encoding="utf-8").splitlines()
    for right in ("LimitRTPRIO=80", "LimitMEMLOCK=infinity", "CPUSchedulingPolicy=other"):
        assert right in lines
    assert "RestrictRealtime=yes" not in lines
