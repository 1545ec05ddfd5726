"""Solvers of others for the PUMA 560 and the UR5e, as Python calls them."""

import importlib
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

# Standard D-H tables: d, a [m], alpha [rad].
TABLES = {
    "puma560": (
        (0.0, 0.0, 0.149, 0.433, 0.0, 0.0),
        (0.0, 0.432, -0.02, 0.0, 0.0, 0.0),
        (-np.pi / 2, 0.0, np.pi / 2, -np.pi / 2, np.pi / 2, 0.0),
    ),
    "ur5e": (
        (0.1625, 0.0, 0.0, 0.1333, 0.0997, 0.0996),
        (0.0, -0.425, -0.3922, 0.0, 0.0, 0.0),
        (np.pi / 2, 0.0, 0.0, np.pi / 2, -np.pi / 2, 0.0),
    ),
}
PACKAGES = {
    "eaik": "EAIK",
    "ur_analytic_ik": "ur-analytic-ik",
    "py_opw_kinematics": "py-opw-kinematics",
    "roboticstoolbox": "roboticstoolbox-python",
    "trac_ik": "pytracik",
    "pinocchio": "pin",
}
LIMIT = np.pi
"""Joints may be within ± this [rad]: one turn, so that a pose has eight solutions."""


@dataclass(frozen=True)
class Solver:
    """One way to ask for joints."""

    name: str
    solve: Callable[[Any, Array], Any]
    """Takes what `prepare` made and near joints (n,); gives solutions (k, n)."""
    prepare: Callable[[Array], Any] = np.ascontiguousarray
    """Turns a pose (4, 4) into what the solver takes; not timed."""
    forward: Callable[[Array], Array] | None = None
    """The solver's own forward kinematics, where its joints count otherwise."""
    batch: Callable[[list[Array]], object] | None = None
    """Solves many poses in one call on one thread."""
    every: int = 1
    """Slow ones solve each so many poses."""


def installed(module: str) -> Any:  # noqa: ANN401  # extensions without types
    """Return a peer's module, None where it is not installed."""
    try:
        return importlib.import_module(module)
    except ImportError:
        return None


def versions() -> dict[str, str]:
    """Name the peers' versions, and loudly those that are not there."""
    missing = "not installed (pip install 'viapoint[compare]'): left out"
    return {
        package.lower(): metadata.version(package) if installed(module) else missing
        for module, package in PACKAGES.items()
    }


def turn(angle: float, axis: int) -> Array:
    """Rotate about x (0) or z (2), (4, 4)."""
    c, s = np.cos(angle), np.sin(angle)
    out = np.eye(4)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    out[i, i], out[i, j], out[j, i], out[j, j] = c, -s, s, c
    return out


def link(d: float, a: float, alpha: float) -> Array:
    """From a joint turned to zero to the next one, (4, 4)."""
    out = turn(alpha, 0)
    out[:3, 3] = a, 0.0, d
    return out


def eaik(name: str) -> Solver:
    """All solutions of EAIK."""
    d, a, alpha = (np.array(column) for column in TABLES[name])
    robot = importlib.import_module("eaik.IK_DH").DhRobot(alpha, a, d)
    return Solver(
        "EAIK",
        lambda pose, near: robot.IK(pose).Q,
        batch=lambda poses: robot.IK_batched(poses, 1),
    )


def ur_analytic_ik() -> Solver:
    """All solutions of ur-analytic-ik."""
    ur = installed("ur_analytic_ik")
    return Solver("ur-analytic-ik", lambda pose, near: np.array(ur.ur5e.inverse_kinematics(pose)))


def opw() -> Solver:
    """All solutions of py-opw-kinematics, for a PUMA 560 whose joints count from elsewhere."""
    module = installed("py_opw_kinematics")
    rigid = importlib.import_module("scipy.spatial.transform").RigidTransform
    model = module.KinematicModel(
        a1=0.0, a2=0.02, b=0.149, c1=0.0, c2=0.432, c3=0.433, c4=0.0,
        offsets=(0.0,) * 6, flip_axes=(False,) * 6,
    )  # fmt: skip
    robot = module.Robot(model, degrees=False)
    return Solver(
        "py-opw-kinematics",
        lambda pose, near: np.array(robot.inverse(pose)),
        prepare=rigid.from_matrix,
        forward=lambda joints: np.asarray(robot.batch_forward(joints).as_matrix()),
    )


def robotics_toolbox(name: str) -> Solver:
    """One solution of the Robotics Toolbox, by Levenberg-Marquardt in C."""
    rtb = installed("roboticstoolbox")
    links = [
        rtb.RevoluteDH(d=d, a=a, alpha=alpha, qlim=[-LIMIT, LIMIT])
        for d, a, alpha in zip(*TABLES[name], strict=True)
    ]
    chain = rtb.DHRobot(links).ets()
    return Solver(
        "Robotics Toolbox ik_LM",
        lambda pose, near: chain.ik_LM(pose, q0=near, tol=1e-14)[0][None],
    )


def urdf(name: str) -> str:
    """Write the arm as a URDF: each joint's place is the link before it."""
    before = np.eye(4)
    parts = ['<robot name="arm"><link name="l0"/>']
    rows = list(zip(*TABLES[name], strict=True))
    for k in range(len(rows) + 1):
        xyz = " ".join(map(repr, before[:3, 3].tolist()))
        roll = float(np.arctan2(before[2, 1], before[2, 2]))
        last = k == len(rows)
        parts.append(
            f'<joint name="j{k + 1}" type="{"fixed" if last else "revolute"}">'
            f'<parent link="l{k}"/><child link="l{k + 1}"/><origin xyz="{xyz}" rpy="{roll!r} 0 0"/>'
            f'<axis xyz="0 0 1"/><limit lower="{-LIMIT}" upper="{LIMIT}" effort="1" velocity="1"/>'
            f'</joint><link name="l{k + 1}"/>'
        )
        before = np.eye(4) if last else link(*rows[k])
    return "".join(parts) + "</robot>"


def trac_ik(name: str) -> Solver:
    """One solution of TRAC-IK, within the 5 ms that its package gives it."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "arm.urdf"
        path.write_text(urdf(name), encoding="utf-8")
        tip = f"l{len(TABLES[name][0]) + 1}"
        robot = installed("trac_ik").TracIK("l0", tip, str(path), epsilon=1e-7)

    def solve(pose: Array, near: Array) -> Array:
        found = robot.ik(pose[:3, 3], pose[:3, :3], near)
        return np.empty((0, 6)) if found is None else np.asarray(found)[None]

    return Solver("pytracik", solve, every=10)


def pinocchio(name: str) -> Solver:
    """One solution by pinocchio's algorithms, in the damped loop that its documentation shows."""
    pin = installed("pinocchio")
    model = pin.Model()
    joint, before = 0, np.eye(4)
    for k, row in enumerate(zip(*TABLES[name], strict=True)):
        joint = model.addJoint(joint, pin.JointModelRZ(), pin.SE3(before), f"j{k + 1}")
        before = link(*row)
    tool = pin.SE3(before)
    data = model.createData()

    def solve(goal: Any, near: Array) -> Array:  # noqa: ANN401  # pinocchio has no types
        q = near.copy()
        for _ in range(200):
            pin.forwardKinematics(model, data, q)
            off = data.oMi[joint].actInv(goal)
            error = pin.log6(off).vector
            if np.linalg.norm(error) < 1e-9:
                return np.array((q + np.pi) % (2.0 * np.pi) - np.pi)[None]
            jacobian = -pin.Jlog6(off.inverse()) @ pin.computeJointJacobian(model, data, q, joint)
            square = jacobian @ jacobian.T + 1e-6 * np.eye(6)
            q = q - jacobian.T @ np.linalg.solve(square, error)
        return np.empty((0, 6))

    return Solver(
        "pinocchio, damped loop", solve, lambda pose: pin.SE3(pose) * tool.inverse(), every=10
    )


def peers_of(name: str) -> list[Solver]:
    """Every solver for this arm that is installed."""
    solvers: list[Solver] = []
    if installed("eaik"):
        solvers.append(eaik(name))
    if installed("ur_analytic_ik") and name == "ur5e":
        solvers.append(ur_analytic_ik())
    if installed("py_opw_kinematics") and name == "puma560":
        solvers.append(opw())
    if installed("roboticstoolbox"):
        solvers.append(robotics_toolbox(name))
    if installed("trac_ik"):
        solvers.append(trac_ik(name))
    if installed("pinocchio"):
        solvers.append(pinocchio(name))
    return solvers
