"""The command: run, check, plot, export, verify, robots."""

import json
import os
import re
import subprocess
import sys
import textwrap
import time
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import viapoint as vp
from viapoint import cli, verifier

SCRIPT = """
    import viapoint as vp
    robot = vp.load_robot("puma560")
    start = [0, 0, 0, 0, 0.5, 0]
    program = vp.Program(robot, start=start, name="{name}")
    program.movej({target}, zone=0.01).movej([0.1, -0.1, 0.2, 0, 0.6, 0])
    with vp.connect("sim://puma560", start=start) as arm:
        job = arm.run(program)
        print("the script saw", job.state, len(job.log) > 0, arm.joints.shape)
"""
GOOD = "[0.2, 0.1, 0, 0.1, 0.5, 0]"


def write(path, text=SCRIPT, **values):
    path.write_text(textwrap.dedent(text).format(**values), encoding="utf-8")
    return str(path)


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """Pictures go into out/ of the working folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "120")
    monkeypatch.setattr(cli.console, "_width", 120)


def call(*arguments):
    return CliRunner().invoke(cli.app, list(arguments))


def test_run_shows_figures_and_writes_log_and_pictures(tmp_path):
    result = call("run", write(tmp_path / "job.py", name="hello you", target=GOOD))
    assert result.exit_code == 0, result.output
    out = tmp_path / "out"
    stem = "job_hello_you"
    names = {path.name for path in out.iterdir()}
    pictures = {f"{stem}_{what}.png" for what in ("joints", "tool", "path")}
    assert names == {f"{stem}.csv", f"{stem}.npz", *pictures}
    with np.load(out / f"{stem}.npz") as log:
        np.testing.assert_allclose(log["q"][-1], [0.1, -0.1, 0.2, 0, 0.6, 0], atol=1e-9)
        assert np.diff(log["cycle"]).tolist() == [1] * (len(log["cycle"]) - 1)


def test_check_moves_nothing_and_waits_for_nothing(tmp_path):
    path = write(tmp_path / "job.py", name="p", target=GOOD)
    begin = time.monotonic()
    result = call("check", path)
    assert time.monotonic() - begin < 30
    assert result.exit_code == 0, result.output
    assert not (tmp_path / "out").exists()


def test_check_fails_with_the_scripts_line(tmp_path):
    path = write(tmp_path / "job.py", name="p", target="[9, 0, 0, 0, 0, 0]")
    done = _command("check", path)
    assert done.returncode == 1
    assert re.search(r"job\.py:\s*6", done.stderr), done.stderr
    assert "joint_limit" in done.stderr
    assert "way out" in done.stderr


def test_check_says_all_that_is_wrong_at_once(tmp_path):
    text = SCRIPT.replace(".movej({target}", ".movej({target}).movej([0, 9, 0, 0, 0, 0]")
    done = _command(
        "check", write(tmp_path / "job.py", text, name="p", target="[9, 0, 0, 0, 0, 0]")
    )
    assert done.returncode == 1
    assert "2 errors" in done.stderr
    assert "joint 1" in done.stderr
    assert "joint 2" in done.stderr


def test_check_is_virtual_and_the_script_notices_nothing(tmp_path):
    done = _command("check", write(tmp_path / "job.py", name="p", target=GOOD))
    assert done.returncode == 0, done.stderr
    assert "the script saw finished True (6,)" in done.stdout
    assert "nothing is wrong" in done.stdout


STREAM = """import viapoint as vp

with vp.connect("sim://puma560") as arm, arm.stream(name="looked") as stream:
    for angle in (0.1, 0.2, {last}):
        stream.movej([angle, 0, 0, 0, 0, 0], zone=vp.radius(0.02))
"""


def test_check_tells_of_streams_and_of_what_is_wrong_in_them(tmp_path):
    done = _command("check", write(tmp_path / "job.py", STREAM, last="0.3"))
    assert done.returncode == 0, done.stderr
    assert re.search(r"looked, 0\.\d+ s: ", done.stdout), done.stdout
    caught = STREAM.replace(" stream.movej", "".join((" try:\n", " " * 12, "stream.movej")))
    caught += "        except vp.MotionError:\n            break\n"
    done = _command("check", write(tmp_path / "caught.py", caught, last="9"))
    assert done.returncode == 1, done.stdout
    assert "1 error" in done.stdout
    assert re.search(r"caught\.py:\s*6", done.stdout), done.stdout


def test_run_keeps_the_figures_log_and_pictures_of_a_stream(tmp_path):
    result = call("run", write(tmp_path / "job.py", STREAM, last="0.3"), "-o", "kept")
    assert result.exit_code == 0, result.output
    assert "looked: finished" in result.output
    assert "steps that came late" in result.output
    names = {file.name for file in (tmp_path / "kept").iterdir()}
    stem = "job_looked"
    assert {f"{stem}.csv", f"{stem}.npz", f"{stem}_joints.png", f"{stem}_path.png"} <= names
    assert vp.load_log(tmp_path / "kept" / f"{stem}.npz").q[-1, 0] == pytest.approx(0.3)


def test_a_stream_is_drawn_and_neither_exported_nor_verified(tmp_path):
    script = write(tmp_path / "job.py", STREAM, last="0.3")
    assert call("plot", script, "-o", "drawn").exit_code == 0
    assert len(list((tmp_path / "drawn").glob("*.png"))) == 3
    for command in ("export", "verify"):
        result = call(command, script)
        assert result.exit_code == 0, result.output
        assert '"looked" is a stream' in result.output


def test_plot_draws_without_motion(tmp_path):
    result = call("plot", write(tmp_path / "job.py", name="p", target=GOOD), "--out", "pictures")
    assert result.exit_code == 0, result.output
    assert len(list((tmp_path / "pictures").glob("*.png"))) == 4


def test_export_writes_programs_that_read_back(tmp_path):
    path = write(tmp_path / "job.py", name="p", target=GOOD)
    result = call("export", path, "-o", "programs")
    assert result.exit_code == 0, result.output
    program = vp.Program.load(tmp_path / "programs" / "job_p.json")
    assert len(program) == 2
    assert program.plan().duration > 0.1


def test_export_writes_the_robot_that_a_script_has_made(tmp_path):
    made = '"puma560").with_limits(velocity=[1] * 6)'
    text = SCRIPT.replace('"puma560")', made, 1)
    assert "with_limits" in text
    text = text.replace("start=start) as arm", "start=start, robot=robot) as arm")
    result = call("export", write(tmp_path / "job.py", text, name="p", target=GOOD))
    assert result.exit_code == 0, result.output
    robot = vp.load_robot(str(tmp_path / "out" / "puma560.yaml"))
    assert robot.limits.velocity.tolist() == [1.0] * 6
    assert vp.Program.load(tmp_path / "out" / "job_p.json", robot).plan().duration > 0.1


def test_verify_proves_exported_motions_and_scripts(tmp_path):
    script = write(tmp_path / "job.py", name="p", target=GOOD)
    assert call("export", script, "-o", ".", "--motions").exit_code == 0
    for file in ("job_p.motion.json", "job_p.json", script):
        result = call("verify", file)
        assert result.exit_code == 0, result.output
        assert "holds" in result.output
        assert "jerk, % of the limits" in result.output


def test_verify_tells_what_is_wrong_by_its_exit_code_and_in_words(tmp_path):
    script = write(tmp_path / "job.py", name="p", target=GOOD)
    call("export", script, "-o", ".", "--motions")
    file = tmp_path / "job_p.motion.json"
    whole = file.read_bytes()
    document = json.loads(whole)
    del document["sha256"]
    document["robot"]["limits"]["velocity"][0] *= 0.1
    file.write_bytes(verifier.seal(json.dumps(document)[:-1]))
    result = call("verify", str(file))
    assert result.exit_code == 1
    assert "the velocity limit is broken (piece" in result.output
    assert "joint 1" in result.output
    file.write_bytes(whole[:-100])
    result = call("verify", str(file))
    assert result.exit_code == 1
    assert "bad_program" in result.stderr
    assert "cut short" in result.stderr
    assert call("verify", "none.motion.json").exit_code == 1


def test_a_program_file_runs_like_a_script(tmp_path):
    call("export", write(tmp_path / "job.py", name="p", target=GOOD), "-o", ".")
    result = call("run", "job_p.json")
    assert result.exit_code == 0, result.output
    assert (tmp_path / "out" / "job_p.csv").exists()


def test_run_reports_the_runs_before_a_refusal(tmp_path):
    text = SCRIPT + "        arm.run(program)\n"
    done = _command("run", write(tmp_path / "job.py", text, name="p", target=GOOD))
    assert done.returncode == 1
    assert "not_at_start" in done.stderr
    assert (tmp_path / "out" / "job_p.csv").exists()


def test_two_runs_of_one_name_have_files_of_their_own(tmp_path):
    text = (
        SCRIPT + "        arm.run(vp.Program(robot, start=arm.setpoint, name='p').movej(start))\n"
    )
    result = call("run", write(tmp_path / "job.py", text, name="p", target=GOOD))
    assert result.exit_code == 0, result.output
    assert {path.stem for path in (tmp_path / "out").glob("*.csv")} == {"job_p", "job_p_2"}


def test_a_stream_runs_as_a_script_of_its_own(tmp_path):
    text = """
        import viapoint as vp
        with vp.connect("sim://two_link") as arm, arm.stream() as stream:
            stream.movej([0.1, 0.1])
        print("it", stream.job.state)
    """
    result = call("run", write(tmp_path / "job.py", text))
    assert result.exit_code == 0, result.output
    assert "it finished" in result.output


def test_a_missing_script_is_named():
    done = _command("run", "none.py")
    assert done.returncode == 1
    assert "none.py" in done.stderr


def test_a_script_that_runs_nothing_is_told(tmp_path):
    done = _command("run", write(tmp_path / "idle.py", "print('idle')"))
    assert done.returncode == 0
    assert "ran nothing" in done.stdout


def test_an_error_of_the_scripts_own_shows_its_place(tmp_path):
    done = _command("run", write(tmp_path / "broken.py", "\n1 / 0\n"))
    assert done.returncode == 1
    assert "broken.py" in done.stderr
    assert "ZeroDivisionError" in done.stderr


def test_an_error_of_the_scripts_own_shows_its_frames_alone(tmp_path):
    done = _command("run", write(tmp_path / "broken.py", "\ndef f():\n    1 / 0\nf()\n"))
    frames = re.findall(r'File "([^"]*)", line (\d+)', done.stderr)
    assert [(Path(file).name, line) for file, line in frames] == [
        ("broken.py", "4"),
        ("broken.py", "3"),
    ]


def test_a_script_that_is_no_python_is_told_where(tmp_path):
    done = _command("run", write(tmp_path / "broken.py", "x = 1\nx +* 2\n"))
    assert done.returncode == 1
    assert re.search(r'broken.py", line 2', done.stderr)
    assert "runpy" not in done.stderr


@pytest.mark.parametrize("command", ["run", "plot", "export"])
def test_a_folder_that_cannot_be_written_is_refused_before_anything_moves(tmp_path, command):
    (tmp_path / "file").write_text("")
    path = write(tmp_path / "job.py", name="p", target=GOOD)
    done = _command(command, path, "--out", str(tmp_path / "file" / "out"))
    assert done.returncode == 1
    assert "cannot be written" in done.stderr
    assert "the script saw" not in done.stdout


def test_names_are_no_markup(tmp_path):
    path = write(tmp_path / "job.py", name="[red]p[/]", target=GOOD)
    for command in ("check", "run"):
        done = _command(command, path)
        assert done.returncode == 0, done.stderr
        assert "[red]p[/]" in done.stdout


def test_piped_reports_do_not_break_paths(tmp_path):
    folder = tmp_path / ("long" * 30)
    folder.mkdir()
    path = write(folder / "job.py", name="p", target="[9, 0, 0, 0, 0, 0]")
    assert path + ":6" in _command("check", path).stderr


CHECKED = """
    import viapoint as vp
    robot = vp.load_robot("puma560")
    bad = vp.Program(robot, start=[0] * 6, name="bad").movej([9, 0, 0, 0, 0, 0])
    good = vp.Program(robot, start=[0] * 6, name="good").movej([0.1] * 6)
    {body}
"""


@pytest.mark.parametrize(
    ("body", "code", "shows"),
    [
        ("bad.check()", 1, ["bad"]),
        ("good.check()", 0, ["good"]),
        ("good.plan()", 0, ["good"]),
        ("good.plan(); bad.check()", 1, ["good", "bad"]),
        ("vp.connect('sim://puma560').run(good); bad.check()", 1, ["good", "bad"]),
        ("\n    try: bad.plan()\n    except vp.MotionError: good.plan()", 1, ["bad", "good"]),
    ],
)
def test_check_counts_every_program(tmp_path, body, code, shows):
    done = _command("check", write(tmp_path / "job.py", CHECKED.replace("{body}", body)))
    assert done.returncode == code, done.stdout + done.stderr
    assert re.findall(r"^(\w+)(?:, [\d.]+ s)?: ", done.stdout, re.M) == shows


def test_a_program_file_of_an_own_robot_needs_the_robot(tmp_path, puma):
    slow = puma.with_limits(velocity=0.5)
    slow.save(tmp_path / "slow.yaml")
    vp.Program(slow, start=[0] * 6).movej([0.1] * 6).save(tmp_path / "p.json")
    assert _command("check", "p.json").returncode == 1
    for command in ("check", "plot", "export", "run"):
        done = _command(command, "p.json", "--robot", "slow.yaml")
        assert done.returncode == 0, done.stderr
    script = write(tmp_path / "job.py", name="p", target=GOOD)
    assert "--robot" in _command("check", script, "--robot", "slow.yaml").stderr


def test_robots_lists_the_built_in_ones():
    done = _command("robots")
    assert done.returncode == 0, done.stderr
    for name in ("panda", "puma560", "rpp", "scara", "two_link", "ur5e"):
        assert name in done.stdout


def test_version():
    done = _command("--version")
    assert done.stdout.strip() == vp.__version__


def _command(*arguments):
    return subprocess.run(
        [sys.executable, "-m", "viapoint.cli", *arguments],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
        env={**os.environ, "COLUMNS": "200"},
    )
