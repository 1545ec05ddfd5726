"""After a fault the last 50 cycles can be read, wherever the loop runs."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import viapoint as vp
from viapoint import _session
from viapoint._recorder import Recorder
from viapoint.errors import DriveFaultError

SPEED = 0.05
"""What the guard holds the tool to, far below what the program does [m/s]."""


def break_the_tool_speed(arm):
    """Run until the guard stops the arm, and return what the error said."""
    program = vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.5)
    with pytest.raises(DriveFaultError) as caught:
        arm.run(program)
    return caught.value.message


def assert_last_cycles(arm, message):
    assert "the tool was told to move too fast" in message
    cycles = arm.fault_cycles
    assert len(cycles) == 50
    assert cycles.STATES[cycles.state[-1]] == "fault"
    assert "stopping" in {cycles.STATES[state] for state in cycles.state}
    assert (cycles.qd[-1] == 0).all()
    np.testing.assert_array_equal(np.diff(cycles.cycle.astype(np.int64)), 1)
    np.testing.assert_array_equal(cycles.q[-1], arm.setpoint)


@pytest.mark.parametrize("virtual", [False, True])
def test_an_arm_of_this_process_keeps_its_last_cycles(virtual, tmp_path: Path):
    with (
        _session.use(Recorder(virtual=virtual)),
        vp.connect("sim://puma560", tool_speed=SPEED) as arm,
    ):
        assert len(arm.fault_cycles) == 0
        assert_last_cycles(arm, break_the_tool_speed(arm))
        arm.fault_cycles.save(tmp_path / "fault.npz")
        again = vp.load_log(tmp_path / "fault.npz")
        np.testing.assert_array_equal(again.q, arm.fault_cycles.q)


def test_a_controller_keeps_them_for_the_next_operator(serve):
    pytest.importorskip("grpc")
    url = serve(tool_speed=SPEED).url
    with vp.connect(url, watch=True) as watcher:
        assert len(watcher.fault_cycles) == 0
        with vp.connect(url) as arm:
            assert_last_cycles(arm, break_the_tool_speed(arm))
            before = arm.fault_cycles
        with vp.connect(url) as arm:
            assert arm.fault == ""
            for kept in (arm.fault_cycles, watcher.fault_cycles):
                np.testing.assert_array_equal(kept.q, before.q)
                np.testing.assert_array_equal(kept.stamp, before.stamp)


def test_the_command_line_shows_them(tmp_path: Path):
    script = tmp_path / "fast.py"
    script.write_text(
        "import viapoint as vp\n"
        f"with vp.connect('sim://puma560', tool_speed={SPEED}) as arm:\n"
        "    arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.5))\n",
        encoding="utf-8",
    )
    done = subprocess.run(
        [Path(sys.executable).parent / "viapoint", "run", script, "--out", tmp_path / "out"],
        capture_output=True,
        text=True,
        timeout=120,
        env={"COLUMNS": "250"},
        check=False,
    )
    assert done.returncode == 1
    assert "the tool was told to move too fast" in done.stderr
    assert "The last cycles before the fault" in done.stdout
    assert "stopping" in done.stdout
