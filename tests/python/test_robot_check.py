"""viapoint robots check: a description explained, and what is missing."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner

import viapoint as vp
from viapoint.cli import app

URDF = """<robot name="two">
  <link name="base"/><link name="upper"/><link name="tip"/>
  <joint name="a" type="revolute"><parent link="base"/><child link="upper"/>
    <origin xyz="0 0 0.4"/><axis xyz="0 0 1"/>
    <limit lower="-2" upper="2" effort="1" velocity="1.5"/></joint>
  <joint name="b" type="revolute"><parent link="upper"/><child link="tip"/>
    <origin xyz="0.5 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="1" velocity="2"/></joint>
</robot>"""


def check(*arguments: str) -> tuple[int, str]:
    done = CliRunner().invoke(app, ["robots", "check", *arguments], env={"COLUMNS": "200"})
    return done.exit_code, done.output


def written(folder: Path, old: str = "", new: str = "") -> str:
    path = folder / "two.urdf"
    assert old in URDF
    path.write_text(URDF.replace(old, new))
    return str(path)


@pytest.mark.parametrize("name", ["puma560", "panda", "rpp", "scara"])
def test_a_built_in_arm_is_explained(name: str):
    code, output = check(name)
    assert code == 0
    robot = vp.load_robot(name)
    for word in [*robot.joint_names, robot.fingerprint, "reach from the base"]:
        assert word in output
    assert robot.ik_family.split(":")[0] in output


def test_limits_solver_reach_and_what_is_chosen_are_told(tmp_path: Path):
    code, output = check(written(tmp_path))
    assert code == 0
    assert "114.592" in output  # 2 rad
    assert "URDF has no limits of acceleration and jerk" in output
    assert "no tool is given" in output
    assert "0.640 m in any direction" in output  # the second axis is 0.5 out and 0.4 up


def test_joints_without_a_velocity_are_named_with_what_to_add(tmp_path: Path):
    code, output = check(written(tmp_path, 'velocity="1.5"', 'velocity="0"'))
    assert code == 1
    assert 'joint "a"' in output
    assert 'add velocity="..."' in output
    code, output = check(written(tmp_path, ' velocity="1.5"', ""))
    assert code == 1
    assert "velocity" in output


def test_degrees_where_radians_are_meant_are_pointed_at(tmp_path: Path):
    code, output = check(written(tmp_path, 'velocity="2"', 'velocity="180"'))
    assert code == 0
    assert "is the number in degrees" in output


def test_the_tip_chooses_among_branches(tmp_path: Path):
    branch = '<link name="side"/><joint name="s" type="fixed"><parent link="upper"/>'
    branch += '<child link="side"/></joint></robot>'
    path = written(tmp_path, "</robot>", branch)
    code, output = check(path)
    assert code == 1
    assert "side, tip" in output
    assert check(path, "--tip", "side")[0] == 0
    assert vp.load_robot(path, tip="tip").joints == 2
    assert vp.load_robot(path, tip="side").joints == 1


def test_joints_without_kinematics_are_said_to_be_so(tmp_path: Path):
    path = tmp_path / "joints.yaml"
    vp.joint_robot(2, velocity=1, acceleration=1, jerk=1).save(path)
    code, output = check(str(path))
    assert code == 0
    assert "joint moves only" in output


def test_what_is_no_robot_is_refused():
    code, output = check("no_such_arm")
    assert code == 1
    assert "no_such_arm" in output
