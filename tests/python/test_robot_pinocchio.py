"""URDFs of real packages, against pinocchio's forward kinematics.

Needs packages that the library does not: ``pip install "viapoint[compare]"``.
"""

from __future__ import annotations

import importlib.util
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors

pin = pytest.importorskip("pinocchio", reason='pip install "viapoint[compare]" to compare FK')

TOLERANCE = 1e-9


@dataclass(frozen=True)
class File:
    """A URDF of a package, and what is expected of it."""

    package: str
    path: str
    frame: str = "tool0"
    tip: str | None = None
    family: str = ""

    def located(self) -> Path:
        spec = importlib.util.find_spec(self.package)
        folders = [] if spec is None else spec.submodule_search_locations or []
        for folder in folders:
            if (path := (Path(folder) / self.path).resolve()).is_file():
                return path
        pytest.skip(f'{self.path} is missing: pip install "viapoint[compare]"')


PANDA = "../../../../share/example-robot-data/robots/panda_description/urdf/panda.urdf"
KUKA = "xacro/kuka_description"
FILES = {
    "ur5e": File("airo_models", "arms/ur5e/ur5e.urdf", family="three parallel axes"),
    "irb140": File("rtbdata", "xacro/abb_irb140_description/urdf/irb140.urdf"),
    "iiwa14": File("rtbdata", f"{KUKA}/kuka_lbr_iiwa/urdf/lbr_iiwa_14_r820.urdf"),
    "kr16": File("rtbdata", f"{KUKA}/kuka_kr16/urdf/kr16_2.urdf", family="spherical wrist"),
    "kr120": File(
        "rtbdata", f"{KUKA}/kuka_kr120/urdf/kr120r2500pro.urdf", family="spherical wrist"
    ),
    # example-robot-data lies beside pinocchio, in the folder that both share.
    "panda": File("pinocchio", PANDA, frame="panda_hand", tip="panda_hand", family="closed form"),
}
PUMA = File(
    "rtbdata",
    "xacro/unimation_puma560_description/urdf/puma560_robot.urdf",
    frame="link7",
    family="closed form",
)


def joints_within(robot: vp.Robot, count: int) -> np.ndarray:
    limits = robot.limits
    low = np.where(np.isfinite(limits.position_min), limits.position_min, -np.pi)
    high = np.where(np.isfinite(limits.position_max), limits.position_max, np.pi)
    return np.random.default_rng(1).uniform(low, high, (count, robot.joints))


def farthest(robot: vp.Robot, path: Path, frame: str, joints: np.ndarray) -> float:
    """Largest difference of an element of a pose [m, and about rad]."""
    model = pin.buildModelFromUrdf(str(path))
    data = model.createData()
    index = model.getFrameId(frame)
    assert index < model.nframes, f"{path} has no frame {frame}"
    columns = [model.joints[model.getJointId(name)].idx_q for name in robot.joint_names]
    whole = pin.neutral(model)
    worst = 0.0
    for q, pose in zip(joints, robot.fk(joints), strict=True):
        whole[columns] = q
        pin.framesForwardKinematics(model, data, whole)
        worst = max(worst, np.abs(data.oMf[index].homogeneous - pose).max())
    return worst


@pytest.mark.parametrize("name", FILES)
def test_a_package_s_urdf_moves_as_in_pinocchio(name: str, record_property):
    file = FILES[name]
    path = file.located()
    robot = vp.load_robot(path, tip=file.tip)
    worst = farthest(robot, path, file.frame, joints_within(robot, 1000))
    record_property("worst", worst)
    print(f"{name}: {robot.joints} joints, worst {worst:.2g}; {robot.ik_family}")
    assert worst < TOLERANCE
    assert robot.ik_family.startswith(file.family)


@pytest.mark.parametrize("name", FILES)
def test_poses_of_a_package_s_urdf_are_solved(name: str):
    file = FILES[name]
    robot = vp.load_robot(file.located(), tip=file.tip)
    for q in joints_within(robot, 100):
        found = robot.ik(robot.fk(q), near=q)
        np.testing.assert_allclose(robot.fk(found), robot.fk(q), atol=2e-9)


def test_the_puma_without_velocities_is_refused_and_moves_once_they_are_there(tmp_path: Path):
    path = PUMA.located()
    with pytest.raises(errors.BadLimitsError, match="velocity") as caught:
        vp.load_robot(path)
    assert '"j6"' in caught.value.message
    mended = tmp_path / "puma.urdf"
    mended.write_text(path.read_text().replace('velocity="0"', 'velocity="1"'))
    robot = vp.load_robot(mended)
    worst = farthest(robot, mended, PUMA.frame, joints_within(robot, 1000))
    print(f"puma560: {robot.joints} joints, worst {worst:.2g}; {robot.ik_family}")
    assert worst < TOLERANCE
    assert robot.ik_family.startswith(PUMA.family)


@pytest.mark.parametrize("name", ["ur5e", "panda"])
def test_the_arm_of_a_package_is_our_own_but_for_its_base(name: str):
    """Between UR's base and base_link lies half a turn; the Panda's table is its maker's."""
    file = FILES[name]
    theirs = vp.load_robot(file.located(), tip=file.tip)
    ours = vp.load_robot(name)
    joints = joints_within(ours, 50)
    base = np.diag([-1.0, -1.0, 1.0, 1.0]) if name == "ur5e" else np.eye(4)
    tool = np.linalg.inv(ours.fk(joints[0])) @ base @ theirs.fk(joints[0])
    for q in joints:
        np.testing.assert_allclose(base @ theirs.fk(q), ours.fk(q) @ tool, atol=1e-3)
