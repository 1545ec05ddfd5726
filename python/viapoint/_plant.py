"""An arm with mass under its drives, simulated by MuJoCo and stepped in virtual time."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from types import ModuleType
from xml.etree import ElementTree as ET

import numpy as np

from . import _core
from ._arguments import ArrayLike, Vector, integer, number, vector
from ._robot import Robot, require_robot
from ._rotation_vectors import quaternions
from ._run_log import RunLog
from .errors import BadArgumentError, FileError

_ROTOR = "0.1"
"""Inertia of a motor behind its gear [kg m² or kg]."""
_LEAST_LENGTH = 0.02
"""Links shorter than this [m] weigh as one of this length."""


class MujocoPlant:
    """Links with mass and drives that follow setpoints, as well as they can.

    The links are capsules from joint to joint. Every drive is a servo of position and velocity
    about the setpoint, tuned to `bandwidth` for the inertia that it moves at `start`. It knows the
    weight that it carries but not what it accelerates: what is left is the following error.
    Needs the package ``mujoco`` (``pip install viapoint[mujoco]``). Threads: one at a time.

    Parameters
    ----------
    robot : Robot
        The arm; its chain becomes the bodies.
    start : array_like, (n,)
        Joints at first [rad or m].
    density : float
        Mass of the links a metre [kg/m].
    payload : float
        Mass at the tool [kg].
    bandwidth : float
        Of the position servos [rad/s].
    steps : int
        Steps of the simulation a cycle.

    Attributes
    ----------
    robot : Robot
        The arm.
    xml : str
        The model as MuJoCo reads it.

    Raises
    ------
    FileError
        The package ``mujoco`` is not installed.
    BadArgumentError
        By the argument's name; a robot without kinematics.
    """

    def __init__(
        self,
        robot: Robot,
        *,
        start: ArrayLike,
        density: float = 8.0,
        payload: float = 1.0,
        bandwidth: float = 100.0,
        steps: int = 4,
    ) -> None:
        self._mujoco = _package()
        self.robot = require_robot(robot)
        if not robot.has_kinematics:
            raise BadArgumentError(f'The robot "{robot.name}" has no kinematics, so no links.')
        self._steps = integer(steps, "steps", 1, 1000)
        pace = number(bandwidth, "bandwidth", "rad/s", above=0.0)
        self.xml = model_of(
            robot,
            number(density, "density", "kg/m", above=0.0),
            number(payload, "payload", "kg", least=0.0),
        )
        self._model = self._mujoco.MjModel.from_xml_string(self.xml)
        self._data = self._mujoco.MjData(self._model)
        self._data.qpos[:] = vector(start, "start", robot.joints)
        self._mujoco.mj_forward(self._model, self._data)
        inertia = np.empty(robot.joints)
        for joint, unit in enumerate(np.eye(robot.joints)):
            column = np.zeros(robot.joints)
            self._mujoco.mj_mulM(self._model, self._data, column, unit)
            inertia[joint] = column[joint]
        # Critically damped for the inertia that each drive alone sees.
        self._stiffness = inertia * pace**2
        self._damping = 2.0 * inertia * pace
        self._model.dof_damping[:] = self._damping  # integrated implicitly, so stable at any pace

    @property
    def joints(self) -> Vector:
        """Where the joints are, (n,) [rad or m]."""
        return np.array(self._data.qpos)

    @property
    def tool(self) -> Vector:
        """Where MuJoCo has the tool's point, in the frame that poses are told in, (3,) [m]."""
        return np.array(self._data.site("tool").xpos)

    @property
    def effort(self) -> Vector:
        """What the drives apply, (n,) [N m or N]."""
        return np.array(self._data.qfrc_applied)

    def step(self, q: ArrayLike, qd: ArrayLike, period: float) -> Vector:
        """Let a cycle pass under one setpoint.

        Parameters
        ----------
        q, qd : array_like, (n,)
            Setpoint [rad or m, per s].
        period : float
            The cycle [s].

        Returns
        -------
        ndarray, (n,)
            Where the joints are at its end [rad or m].

        Raises
        ------
        BadArgumentError
            By the argument's name; or the simulation has become unstable.
        """
        target, rate = vector(q, "q", self.robot.joints), vector(qd, "qd", self.robot.joints)
        data = self._data
        begin = float(data.time)
        self._model.opt.timestep = number(period, "period", "s", above=0.0) / self._steps
        for i in range(self._steps):
            # The setpoint goes on between two cycles, as in a drive that interpolates.
            there = target + rate * (i * self._model.opt.timestep)
            data.qfrc_applied[:] = (
                self._stiffness * (there - data.qpos) + self._damping * rate + data.qfrc_bias
            )
            self._mujoco.mj_step(self._model, data)
        if not float(data.time) > begin:  # MuJoCo begins anew where accelerations are endless
            raise BadArgumentError(
                "The plant has become unstable.",
                ways_out=["Give a lower bandwidth, or more steps a cycle."],
            )
        return self.joints

    def track(self, log: RunLog) -> RunLog:
        """Follow the setpoints of a run, cycle by cycle.

        Parameters
        ----------
        log : RunLog
            Of a run that began where the plant is, in virtual time or on an arm.

        Returns
        -------
        RunLog
            The same with `measured` as the plant's joints, as an encoder would read them at the
            beginning of every cycle.

        Raises
        ------
        BadArgumentError
            A log of another number of joints, or one that begins elsewhere.
        """
        if log.q.shape[1] != self.robot.joints:
            raise BadArgumentError(
                f"The log has {log.q.shape[1]} joints, the plant {self.robot.joints}."
            )
        off = float(np.abs(log.q[0] - self.joints).max()) if len(log) else 0.0
        if off > 0.01:
            raise BadArgumentError(
                f"The log begins {off:.3g} rad or m from where the plant is.",
                ways_out=["Make the plant at its start: MujocoPlant(robot, start=log.q[0])."],
            )
        measured = np.empty_like(log.q)
        for k in range(len(log)):
            measured[k] = self.joints
            self.step(log.q[k], log.qd[k], log.period)
        columns = {**log.core.columns(), "measured": measured}
        return replace(log, core=_core.Log.of_columns(columns), measured=measured)


def model_of(robot: Robot, density: float, payload: float) -> str:
    """Write the chain as MJCF: a body a joint, its frame that of the joint at zero."""
    chain = _core.chain_of(robot._core)
    root = ET.Element("mujoco", model=robot.name)
    ET.SubElement(root, "compiler", angle="radian", autolimits="false")
    # Links that meet in a joint touch, and nothing else is there to be touched.
    option = ET.SubElement(root, "option", integrator="implicitfast")
    ET.SubElement(option, "flag", contact="disable")
    parent = ET.SubElement(root, "worldbody")
    frames = [np.asarray(before) for before in chain["before"]] + [np.asarray(chain["tool"])]
    for i, (slides, axis) in enumerate(zip(chain["prismatic"], chain["axis"], strict=True)):
        parent = ET.SubElement(parent, "body", {"name": f"link{i + 1}", **_placed(frames[i])})
        ET.SubElement(
            parent,
            "joint",
            name=f"joint{i + 1}",
            type="slide" if slides else "hinge",
            axis=_text(np.asarray(axis).ravel()),
            armature=_ROTOR,
        )
        end = frames[i + 1][:3, 3]
        length = max(float(np.linalg.norm(end)), _LEAST_LENGTH)
        if np.linalg.norm(end) < _LEAST_LENGTH:
            end = np.array([0.0, 0.0, _LEAST_LENGTH])
        ET.SubElement(
            parent,
            "geom",
            type="capsule",
            fromto=_text([0, 0, 0, *end]),
            size="0.04",
            mass=repr(density * length),
        )
    tool = frames[-1]
    ET.SubElement(parent, "site", {"name": "tool", **_placed(tool)})
    if payload > 0.0:
        place = _text(tool[:3, 3])
        ET.SubElement(parent, "geom", type="sphere", size="0.03", pos=place, mass=repr(payload))
    return ET.tostring(root, encoding="unicode")


def _placed(frame: Vector) -> dict[str, str]:
    return {"pos": _text(frame[:3, 3]), "quat": _text(quaternions(frame[None, :3, :3])[0])}


def _text(values: ArrayLike) -> str:
    return " ".join(repr(float(value)) for value in np.asarray(values))


def _package() -> ModuleType:
    try:
        return import_module("mujoco")
    except ImportError:
        raise FileError(
            'The plant needs the package "mujoco", which is not installed.',
            ways_out=["pip install viapoint[mujoco]"],
        ) from None
