"""The command where something goes wrong beside it: disks, terminals, readers, signals."""

import os
import signal
import subprocess
import sys
import textwrap
import time

import numpy as np
import pytest

SCRIPT = """
    import viapoint as vp
    robot = vp.load_robot("puma560")
    start = [0, 0, 0, 0, 0.5, 0]
    program = vp.Program(robot, start=start, name="{name}")
    program.movej([0.2, 0.1, 0, 0.1, 0.5, 0], zone=0.01).movej([0.1, -0.1, 0.2, 0, 0.6, 0])
    with vp.connect("sim://puma560", start=start) as arm:
        arm.run(program)
"""


def write(path, text=SCRIPT, **values):
    path.write_text(textwrap.dedent(text).format(**values), encoding="utf-8")
    return str(path)


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Pictures go into out/ of the working folder."""
    monkeypatch.chdir(tmp_path)


RUNS_TWICE = """
    import pathlib
    import viapoint as vp
    robot = vp.load_robot("puma560")
    start = [0, 0, 0, 0, 0.5, 0]
    out = [0.02, 0, 0, 0, 0.5, 0]
    pathlib.Path("out").mkdir(exist_ok=True)
    pathlib.Path("out/job_one.npz").mkdir(exist_ok=True)  # a file cannot go where a folder is
    with vp.connect("sim://puma560", start=start) as arm:
        arm.run(vp.Program(robot, start=start, name="one").movej(out))
        arm.run(vp.Program(robot, start=out, name="two").movej(start))
"""


def test_a_log_that_cannot_be_written_is_told_and_costs_no_other(tmp_path):
    done = _command("run", write(tmp_path / "job.py", RUNS_TWICE))
    assert done.returncode == 1
    assert "lost out/job_one" in done.stderr
    assert "Traceback" not in done.stderr
    assert "one: finished" in done.stdout
    assert "two: finished" in done.stdout
    out = tmp_path / "out"
    assert (out / "job_one.csv").is_file()
    assert (out / "job_two.npz").is_file()
    assert (out / "job_two_joints.png").is_file()


def test_a_picture_that_cannot_be_drawn_costs_no_log(tmp_path):
    text = RUNS_TWICE.replace("import pathlib", "import pathlib\n    from viapoint import _plots")
    text += "    _plots.DRAWINGS['joints'] = lambda samples, motion: 1 / 0\n"
    text = text.replace('pathlib.Path("out/job_one.npz")', 'pathlib.Path("out/elsewhere")')
    done = _command("run", write(tmp_path / "job.py", text))
    assert done.returncode == 1
    assert done.stderr.count("lost out/job_") == 2
    assert "one: finished" in done.stdout
    files = {file.name for file in (tmp_path / "out").iterdir()}
    assert files >= {f"job_{run}.{kind}" for run in ("one", "two") for kind in ("csv", "npz")}


def test_a_reader_that_leaves_costs_no_log(tmp_path):
    path = write(tmp_path / "job.py", name="p")
    command = [sys.executable, "-m", "viapoint.cli", "run", path]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as process:
        assert process.stdout is not None
        process.stdout.close()
        process.wait(timeout=120)
    names = {file.suffix for file in (tmp_path / "out").iterdir()}
    assert names == {".csv", ".npz", ".png"}


def test_a_terminal_without_letters_gets_a_report_all_the_same(tmp_path):
    done = subprocess.run(
        [
            sys.executable,
            "-m",
            "viapoint.cli",
            "check",
            write(tmp_path / "j.py", name="µ"),
        ],
        capture_output=True,
        check=False,
        timeout=120,
        env={**os.environ, "PYTHONIOENCODING": "ascii"},
    )
    assert done.returncode == 0, done.stderr
    assert rb"\xb5" in done.stdout


@pytest.mark.parametrize("signum", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_stops_the_run_on_its_path_and_keeps_its_log(tmp_path, signum):
    text = """
        import viapoint as vp
        robot = vp.load_robot("puma560")
        start = [0, 0, 0, 0, 0.5, 0]
        program = vp.Program(robot, start=start, scale=0.1, name="p").movej([2, 1, 1, 1, 1, 1])
        with vp.connect("sim://puma560", start=start) as arm:
            print("running", flush=True)
            arm.run(program)
    """
    path = write(tmp_path / "job.py", text)
    process = subprocess.Popen(
        [sys.executable, "-m", "viapoint.cli", "run", path],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        # What runs the tests may ignore a hang-up (nohup), and its children would, too.
        preexec_fn=lambda: signal.signal(signum, signal.SIG_DFL),
    )
    assert process.stdout is not None
    assert process.stdout.readline().strip() == "running"
    time.sleep(1.0)
    process.send_signal(signum)
    out, err = process.communicate(timeout=60)
    assert process.returncode != 0
    assert "stopped" in out, err
    with np.load(tmp_path / "out" / "job_p.npz") as log:
        np.testing.assert_allclose(log["qd"][-1], 0.0, atol=1e-9)
        assert log["q"][-1][0] < 1.9


def _command(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "viapoint.cli", *arguments],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
        env={**os.environ, "COLUMNS": "200"},
    )
