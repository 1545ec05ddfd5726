"""A script that decides as it goes: a camera finds parts one by one, and the arm sorts them.

``python sort_by_camera.py`` moves an arm simulated in this process, ``python sort_by_camera.py
tcp://127.0.0.1:7420`` that of a viapoint-controller (a ur5e that stands at `HOME`), and
``viapoint check sort_by_camera.py`` none: it only looks for what is wrong.
"""

import sys
import time
from dataclasses import dataclass

import numpy as np

import viapoint as vp
from viapoint import deg, mm
from viapoint.cells import Gripper
from viapoint.frames import Frame

HOME = deg * [180, -90, 90, -90, -90, 0]


@dataclass
class Part:
    """What the camera tells of a part: where it lies on the table [m, rad], and its colour."""

    x: float
    y: float
    turn: float
    colour: str


class Camera:
    """Stands in for a real one: it sees a part at a time, and takes a while to look."""

    def __init__(self, parts: int) -> None:
        self._left = parts
        self._random = np.random.default_rng(7)

    def look(self) -> Part | None:
        """Return the next part; None where the table is empty."""
        time.sleep(0.1)
        if self._left == 0:
            return None
        self._left -= 1
        x, y = self._random.uniform([0.0, 0.0], [0.2, 0.3])
        turn = self._random.uniform(-45, 45) * deg
        return Part(x, y, turn, str(self._random.choice(["red", "blue"])))


def down(x: float, y: float, z: float, turn: float = 0.0) -> np.ndarray:
    """Return the pose of a tool that points down."""
    pose = np.diag([1.0, -1.0, -1.0, 1.0])
    pose[:2, :2] = [[np.cos(turn), np.sin(turn)], [np.sin(turn), -np.cos(turn)]]
    pose[:3, 3] = (x, y, z)
    return pose


table = np.eye(4)
table[:3, 3] = (0.35, -0.15, 0.05)
table = Frame(table, "table")
boxes = {"red": down(0.4, 0.25, 0.1), "blue": down(0.3, 0.3, 0.1)}
gripper = Gripper(output=3, dwell=0.05)
camera = Camera(parts=3)
count = dict.fromkeys(boxes, 0)

with vp.connect(sys.argv[1]) if sys.argv[1:] else vp.connect("sim://ur5e", start=HOME) as arm:
    # A part and a half ahead at most, so that the next look sees the table nearly as it is.
    with arm.stream(name="sort by camera", zone=30 * mm, ahead=12) as stream:
        while part := camera.look():  # while the arm carries the one before
            at = table.to_base(down(part.x, part.y, 20 * mm, part.turn))
            stream.pick(at, gripper, approach=50 * mm, near_speed=0.5)
            stream.place(boxes[part.colour], gripper, approach=50 * mm, near_speed=0.5)
            count[part.colour] += 1
        stream.movej(HOME)
    print(f"{count['red']} red and {count['blue']} blue parts in {stream.job.duration:.1f} s")
    for late in stream.late:
        print(f"line {late.line} came late: the arm waited {late.waited:.2f} s for the camera")
