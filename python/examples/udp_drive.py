"""A device that takes setpoints over UDP (docs/drives.md), and an arm that runs on it.

``python udp_drive.py device 7500 6`` is the device alone, here one with joints that lag behind; it
ends when nobody has talked to it for five seconds. Without arguments the script starts one in a
process of its own and moves it.
"""

import math
import socket
import struct
import subprocess
import sys
import time

import viapoint as vp
from viapoint import deg

COMMAND = struct.Struct("<4sBBBxQqQ")  # magic, version, order, joints, sequence, stamp, outputs
ANSWER = struct.Struct("<4sBBBxQqQIxxxx")  # …, condition, joints, …, inputs, fault code
ENABLE, FOLLOW, RELEASE = 1, 2, 3
OFF, FOLLOWING = 0, 1


def be_a_device(port: int, joints: int, lag: float = 0.01) -> None:
    """Serve one loop at a time, on this machine."""
    position = [0.0] * joints
    target = list(position)
    condition, newest, moved = OFF, 0, time.monotonic()
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as line:
        line.bind(("127.0.0.1", port))
        line.settimeout(5.0)
        print(f"device at port {line.getsockname()[1]}", flush=True)
        while True:
            try:
                data, sender = line.recvfrom(1024)
            except TimeoutError:
                return
            if len(data) != COMMAND.size + 16 * joints:
                continue
            magic, version, order, count, sequence, stamp, outputs = COMMAND.unpack_from(data)
            if (magic, version, count) != (b"VPSP", 1, joints):
                continue
            if order == ENABLE:
                condition, newest, target = FOLLOWING, sequence, list(position)
            elif sequence <= newest:
                continue
            newest = sequence
            now = time.monotonic()
            kept = math.exp(-(now - moved) / lag)
            moved = now
            position = [u + kept * (x - u) for x, u in zip(position, target, strict=True)]
            if order == RELEASE:
                condition, target = OFF, list(position)
            elif order == FOLLOW:
                target = list(struct.unpack_from(f"<{joints}d", data, COMMAND.size))
            head = ANSWER.pack(
                b"VPMS", 1, condition, joints, sequence, stamp, outputs, 0
            )  # its inputs show the outputs that it was told
            line.sendto(head + struct.pack(f"<{joints}d", *position), sender)


def main() -> None:
    """Start a device, and run a program on it."""
    robot = vp.load_robot("ur5e")
    with subprocess.Popen(
        [sys.executable, __file__, "device", "0", str(robot.joints)],
        stdout=subprocess.PIPE,
        text=True,
    ) as device:
        assert device.stdout is not None
        port = int(device.stdout.readline().split()[-1])
        # A device written in Python may be held up for long; a drive has ten cycles.
        with vp.connect(f"udp://127.0.0.1:{port}", robot=robot, silent_cycles=2000) as arm:
            program = vp.Program(robot, start=arm.setpoint, scale=0.2)
            program.set_do(3, True).movej(deg * [10, -10, 20, 0, 0, 5]).wait(0.1)
            job = arm.run(program)
            behind = abs(job.log.measured - job.log.q).max()
            print(f"{job.state}, at most {behind / deg:.2f}° behind")
        device.terminate()


if __name__ == "__main__":
    if sys.argv[1:2] == ["device"]:
        be_a_device(int(sys.argv[2]), int(sys.argv[3]))
    else:
        main()
