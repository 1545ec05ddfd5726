"""viapoint: the motion kernel of an industrial robot controller.

Motion programs in, proven 2 ms setpoints out::

    import viapoint as vp
    from viapoint import deg, mm

    robot = vp.load_robot("puma560")
    program = vp.Program(robot, start=deg * [0, 0, 0, 0, 30, 0])
    program.movej(deg * [20, 30, -10, 0, 40, 0], zone=20 * mm).movel(position=[0.5, 0.2, 0.3])
    with vp.connect("sim://puma560", start=program.start) as arm:
        arm.run(program)

SI units and radians everywhere; poses are ``pose_base_tool``, (4, 4). Every error is a
`MotionError` (see `viapoint.errors`).
"""

from . import cells, errors, frames, iso9283, profile
from ._arm import Arm
from ._chunks import Chunk
from ._connect import connect
from ._core import (
    Certificate,
    Configuration,
    Corner,
    Dexterity,
    Extremum,
    JointLimits,
    Knots,
    Problem,
    Singularity,
    __version__,
)
from ._curve_fit import CurveFit, fit_curve
from ._drives import SimulatedDrive
from ._job import Job, RunReport
from ._knots import insert_knots
from ._local_arm import LocalArm
from ._log_files import load_log
from ._motion import Motion
from ._plant import MujocoPlant
from ._playback import Playback
from ._playback_file import load_recording
from ._points import PointList, TouchUp
from ._program import Program
from ._recording import Recording
from ._remote_arm import RemoteArm
from ._report import Report
from ._robot import Robot, joint_robot, load_robot
from ._run_log import RunLog
from ._samples import Samples
from ._simulation import simulate, simulate_jog
from ._stream import Stream
from ._stream_job import LateStep, StreamJob
from ._tls import TlsFiles
from ._units import deg, mm
from ._zone import Zone, deviation, joint_deviation, radius
from .errors import MotionError

__all__ = [
    "Arm",
    "Certificate",
    "Chunk",
    "Configuration",
    "Corner",
    "CurveFit",
    "Dexterity",
    "Extremum",
    "Job",
    "JointLimits",
    "Knots",
    "LateStep",
    "LocalArm",
    "Motion",
    "MotionError",
    "MujocoPlant",
    "Playback",
    "PointList",
    "Problem",
    "Program",
    "Recording",
    "RemoteArm",
    "Report",
    "Robot",
    "RunLog",
    "RunReport",
    "Samples",
    "SimulatedDrive",
    "Singularity",
    "Stream",
    "StreamJob",
    "TlsFiles",
    "TouchUp",
    "Zone",
    "__version__",
    "cells",
    "connect",
    "deg",
    "deviation",
    "errors",
    "fit_curve",
    "frames",
    "insert_knots",
    "iso9283",
    "joint_deviation",
    "joint_robot",
    "load_log",
    "load_recording",
    "load_robot",
    "mm",
    "profile",
    "radius",
    "simulate",
    "simulate_jog",
]
