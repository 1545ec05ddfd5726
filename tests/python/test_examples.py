"""Every example runs as it is, and says what it should."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "python" / "examples"

SAYS = {
    "gluing_contour.py": ["the bead is proven within", "zone of move"],
    "own_curve.py": ["of the curve at", "finished after"],
    "hand_guided.py": ["pass every sample within 0.", "at double speed: 2.0", "finished, 0."],
    "jog_to_a_limit.py": ["let go", "at its position limit", "finished"],
    "mujoco_plant.py": ["pose repeatability", "path accuracy"],
    "override_and_stop.py": ["paused", "finished", "stopped after"],
    "puma560_abc.py": [
        "joint_limit",
        "joint_limit of joint 4 after 74 % of the leg",
        'orientation="wrist"',
        "movej",
        "deviation from A→B→C",
        "knots",
        "manipulability",
    ],
    "puma560_quintic.py": ["quintic: tool path", "trapezoid"],
    "puma560_timed.py": ["501 samples, 1 s", "the drive refuses: NotAtRestError"],
    "rpp.py": ["finished", "height stays between 0.5000"],
    "scara.py": ["finished", "gripper at"],
    "sort_by_camera.py": ["1 red and 2 blue parts in 6.9 s"],
    "stacking.py": ["cube 3 at 200 mm", "the screw is 6 mm deep"],
    "teach_playback.py": ["seam.json holds above, seam start, seam end", "finished"],
    "udp_drive.py": ["finished, at most"],
    "two_link.py": ["72.8856 -41.4096", "54.6642 -18.2214", "finished"],
}


def test_every_example_is_here():
    assert {path.name for path in EXAMPLES.glob("*.py")} == set(SAYS)


@pytest.mark.parametrize("name", SAYS)
def test_example(name, tmp_path):
    done = subprocess.run(
        [sys.executable, "-W", "error", str(EXAMPLES / name)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
        env={**os.environ, "COLUMNS": "120"},
    )
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""
    if done.stdout.startswith("SKIPPED"):
        pytest.skip(done.stdout.strip())
    for text in SAYS[name]:
        assert text in done.stdout, done.stdout
    assert list(tmp_path.iterdir()) == []  # an example leaves nothing behind


SHOWS_ERRORS = {"puma560_abc.py", "puma560_timed.py"}
"""Examples whose point is an error: ``viapoint check`` ends with 1."""


NEEDS = {"mujoco_plant.py": "mujoco"}
"""Examples that need a package of an extra."""


OWN_ROBOTS = {"jog_to_a_limit.py"}
"""Examples whose robot is not a built-in one as it is: its file is exported, too."""


STREAMS = {"sort_by_camera.py"}
"""Examples that are planned as they run: there is no program to export."""


@pytest.mark.parametrize("command", ["check", "plot", "export"])
@pytest.mark.parametrize("name", SAYS)
def test_the_command_gets_to_the_end_of_every_example(name, command, tmp_path):
    if package := NEEDS.get(name):
        pytest.importorskip(package, reason=f"SKIPPED: pip install viapoint[{package}]")
    done = subprocess.run(
        [sys.executable, "-m", "viapoint.cli", command, str(EXAMPLES / name)],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
        env={**os.environ, "COLUMNS": "200"},
    )
    expected = 1 if command == "check" and name in SHOWS_ERRORS else 0
    assert done.returncode == expected, done.stdout + done.stderr
    assert done.stderr == ""
    exported = set() if name in STREAMS else {".json"}
    if name in OWN_ROBOTS:
        exported.add(".yaml")
    made = {"check": set(), "plot": {".png"}, "export": exported}[command]
    assert {path.suffix for path in tmp_path.glob("out/*")} == made
