"""Programs written for UR's RTDE look on at an arm, turn its speed and switch its outputs."""

import contextlib
import itertools
import json
import os
import re
import socket
import struct
import subprocess
import sys
import time
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

import viapoint as vp
from viapoint.errors import BadArgumentError, BusyError

DOCUMENT = Path(__file__).parents[2] / "docs" / "rtde.md"
START = [0.1, -1.5, 1.2, -0.8, -1.5, 0.3]


class Client:
    """A client of our own: the packages as the protocol's description has them."""

    def __init__(self, port):
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=20)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.socket.close()

    def send(self, kind, payload=b""):
        self.socket.sendall(struct.pack(">HB", 3 + len(payload), ord(kind)) + payload)

    def take(self, count):
        data = b""
        while len(data) < count:
            part = self.socket.recv(count - len(data))
            if not part:
                raise ConnectionResetError
            data += part
        return data

    def receive(self):
        length, kind = struct.unpack(">HB", self.take(3))
        return chr(kind), self.take(length - 3)

    def skip(self, count):
        for _ in range(count):
            self.receive()

    def ask(self, kind, payload=b""):
        self.send(kind, payload)
        answer, reply = self.receive()
        assert answer == kind, reply
        return reply

    def start(self, hertz, *names):
        assert self.ask("V", b"\0\2") == b"\1"
        setup = self.ask("O", struct.pack(">d", hertz) + ",".join(names).encode())
        assert self.ask("S") == b"\1"
        sizes = {"DOUBLE": "d", "VECTOR6D": "6d", "UINT64": "Q", "UINT32": "I", "INT32": "i"}
        self.formats = [sizes[kind] for kind in setup[1:].decode().split(",")]

    def values(self):
        """The next package: a list of tuples, one a variable."""
        kind, payload = self.receive()
        assert kind == "U"
        at, values = 1, []
        for form in self.formats:
            values.append(struct.unpack_from(">" + form, payload, at))
            at += struct.calcsize(">" + form)
        assert at == len(payload)
        return values


@pytest.fixture
def served(serve):
    """A controller with an RTDE server: where scripts connect, and the port of RTDE."""
    controller = serve(robot="ur5e", start=START, rtde={"port": 0})
    line = controller.process.stderr.readline()
    return controller.url, int(re.search(r"RTDE is served at \S+ port (\d+)", line).group(1))


def test_a_client_sees_the_cycles_that_the_log_has(served):
    url, port = served
    with vp.connect(url) as arm, Client(port) as client:
        client.start(500.0, "timestamp", "target_q", "target_qd", "actual_q", "runtime_state")
        program = vp.Program(arm.robot, start=arm.setpoint, scale=0.2)
        job = arm.run(program.movej(np.add(START, 0.2)), wait=False)
        seen = []
        deadline = time.monotonic() + 60
        while not seen or seen[-1][4] != (1,) or (2,) not in [state for *_, state in seen]:
            assert time.monotonic() < deadline
            seen.append(client.values())
        job.wait()
        log = job.log
    setpoints = {tuple(q): tuple(qd) for q, qd in zip(log.q, log.qd, strict=True)}
    moving = [values for values in seen if values[4] == (2,)]
    assert len(moving) > 10
    for _, q, qd, *_ in moving:
        assert setpoints[q] == qd  # to the last bit
    assert seen[-1][1] == tuple(log.q[-1])
    times = [time[0] for time, *_ in seen]
    assert all(later > earlier for earlier, later in itertools.pairwise(times))
    # The simulated drive is where it was told to be a cycle before.
    measured = {values[3] for values in moving}
    assert len(measured & set(setpoints)) > 10


def test_the_tools_pose_is_position_and_rotation_vector(served):
    _, port = served
    with Client(port) as client:
        client.start(100.0, "actual_TCP_pose", "target_TCP_pose", "target_TCP_speed")
        actual, target, speed = client.values()
    assert actual == target
    assert speed == (0.0,) * 6
    pose = vp.load_robot("ur5e").fk(START)
    np.testing.assert_allclose(actual[:3], pose[:3, 3], atol=1e-12)
    turn, angle = np.array(actual[3:]), np.linalg.norm(actual[3:])
    x, y, z = turn / angle
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    rotation = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    np.testing.assert_allclose(rotation, pose[:3, :3], atol=1e-12)


def test_what_a_client_sets_acts_on_the_run(served):
    url, port = served
    with vp.connect(url) as arm, Client(port) as client:
        client.start(
            100.0, "actual_digital_output_bits", "target_speed_fraction", "speed_scaling_combined"
        )
        slider = client_recipe(client, "speed_slider_mask,speed_slider_fraction,")
        outputs = client_recipe(client, "standard_digital_output_mask,standard_digital_output")
        program = vp.Program(arm.robot, start=arm.setpoint, scale=0.02)
        program.set_do(2, True).movej(np.add(START, 0.3)).set_do(2, False).wait(0.1)
        job = arm.run(program, wait=False)
        client.send("U", struct.pack(">BId", slider, 1, 0.25))
        client.send("U", struct.pack(">BBB", outputs, 0b1001, 0b1001))
        until(client, lambda bits, speed, rate: (bits, speed, rate) == (0b1101, 0.25, 0.25))
        assert arm.override == 0.25
        # One that the program has switched on goes off by hand, and stays so.
        client.send("U", struct.pack(">BBB", outputs, 0b0101, 0))
        until(client, lambda bits, *_: bits == 0b1000)
        client.send("U", struct.pack(">BId", slider, 1, 1.0))
        job.wait()
        until(client, lambda bits, *_: bits == 0b1000)
        assert job.log.outputs[-1] == 0b1000
        assert {0b0100, 0b1101, 0b1000} <= set(job.log.outputs.tolist())


def client_recipe(client, names):
    """Set up an input recipe; packages of data come between."""
    client.send("I", names.encode())
    replies = (client.receive() for _ in range(1000))
    return next(payload[0] for kind, payload in replies if kind == "I")


def until(client, holds):
    deadline = time.monotonic() + 60
    while not holds(*(value for (value,) in client.values())):
        assert time.monotonic() < deadline


def test_a_paused_and_a_stopped_run_show(served):
    url, port = served
    with vp.connect(url) as arm, Client(port) as client:
        client.start(100.0, "runtime_state")
        until(client, lambda state: state == 1)
        program = vp.Program(arm.robot, start=arm.setpoint, scale=0.02)
        job = arm.run(program.movej(np.add(START, 0.3)), wait=False)
        until(client, lambda state: state == 2)
        job.pause()
        until(client, lambda state: state == 4)
        job.stop()
        until(client, lambda state: state == 1)


def test_rubbish_slow_and_many_clients_disturb_neither_arm_nor_the_others(served):
    url, port = served
    with vp.connect(url) as arm, Client(port) as good, contextlib.ExitStack() as others:
        good.start(100.0, "runtime_state", "target_speed_fraction")
        program = vp.Program(arm.robot, start=arm.setpoint, scale=0.05)
        job = arm.run(program.movej(np.add(START, 0.2)), wait=False)
        for rubbish in (b"GET / HTTP/1.1\r\n\r\n", b"\xff" * 9000, b"\0\3S", b"\0\0\0\0"):
            with Client(port) as bad, contextlib.suppress(ConnectionError):
                bad.socket.sendall(rubbish)
                bad.skip(10)
        slow = others.enter_context(Client(port))
        slow.start(500.0, *["target_q"] * 50)
        refused = 0
        for _ in range(40):
            client = others.enter_context(Client(port))
            client.socket.sendall(b"\0\5V\0\2")
            try:
                assert client.receive() == ("V", b"\1")
            except ConnectionError:
                refused += 1
        assert refused == 40 - 14  # sixteen at once, with the two before
        job.wait()
        assert job.state == "finished"
        assert job.report.lost_records == 0
        until(good, lambda state, fraction: (state, fraction) == (1, 1.0))


def test_an_arm_of_this_process_serves_rtde_until_it_is_closed():
    with vp.connect("sim://ur5e", start=START) as arm:
        port = arm.serve_rtde(0)
        with pytest.raises(BusyError, match=f"port {port}"):
            arm.serve_rtde(port)
        with pytest.raises(BadArgumentError, match="neither passwords nor encryption"):
            arm.serve_rtde(0, address="0.0.0.0")
        client = Client(port)
        client.start(100.0, "actual_q", "target_speed_fraction")
        q, _ = client.values()
        assert q == tuple(START)
        slider = client_recipe(client, "speed_slider_mask,speed_slider_fraction")
        client.send("U", struct.pack(">BId", slider, 1, 0.5))
        assert any(client.values()[1] == (0.5,) for _ in range(1000))
        assert arm.override == 0.5
    with client, pytest.raises(ConnectionError):
        client.skip(1000)
    with pytest.raises(OSError, match="refused"):
        Client(port)


def test_an_arm_of_other_joints_is_not_served():
    with vp.connect("sim://two_link") as arm, pytest.raises(BadArgumentError, match="6 joints"):
        arm.serve_rtde(0)


def test_only_arms_of_six_joints_are_served(controller, tmp_path):
    config = tmp_path / "panda.yaml"
    config.write_text("{robot: panda, listen: '127.0.0.1:0', rtde: {port: 0}}", encoding="utf-8")
    done = subprocess.run(
        [controller, "--config", str(config)],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 3
    assert '6 joints and a tool; "panda" has 7 joints' in done.stderr


def told_types(section):
    """The variables of a section's table, each with its type."""
    rows = re.findall(r"^\| (`.*?) \| ([A-Z0-9, ]+) \|", section, re.MULTILINE)
    told = {}
    for names, types in rows:
        found = re.findall(r"`(\w+)`", names)
        kinds = types.split(", ")
        told |= zip(found, kinds * len(found) if len(kinds) == 1 else kinds, strict=False)
    return {name: kind for name, kind in told.items() if not name.startswith("_")}


def test_the_document_has_the_variables_and_their_types(served):
    _, port = served
    text = DOCUMENT.read_text(encoding="utf-8")
    read, written = text.split("## What clients read")[1].split("## What clients set")
    outputs, inputs = told_types(read), told_types(written)
    assert len(outputs) > 40
    assert len(inputs) > 12
    with Client(port) as client:
        assert client.ask("V", b"\0\2") == b"\1"
        setup = client.ask("O", struct.pack(">d", 125.0) + ",".join(outputs).encode())
        assert setup == b"\1" + ",".join(outputs.values()).encode()
        setup = client.ask("I", ",".join(inputs).encode())
        assert setup == b"\1" + ",".join(inputs.values()).encode()


# The package as it comes from the index, in a process of its own: it holds the interpreter's lock
# while it connects.
UR_RTDE = """
import json, sys, time
import rtde_io, rtde_receive
receive = rtde_receive.RTDEReceiveInterface(sys.argv[1])
io = rtde_io.RTDEIOInterface(sys.argv[1])
def seen():
    return {
        "q": receive.getActualQ(), "target_q": receive.getTargetQ(),
        "pose": receive.getActualTCPPose(), "speed": receive.getTargetSpeedFraction(),
        "outputs": receive.getActualDigitalOutputBits(), "mode": receive.getRobotMode(),
        "safety": receive.getSafetyMode(), "runtime": receive.getRuntimeState(),
        "modes": receive.getJointMode(), "stopped": receive.isProtectiveStopped(),
        "connected": receive.isConnected(),
    }
def until(holds):
    deadline = time.monotonic() + 30
    while not holds(seen()):
        assert time.monotonic() < deadline, seen()
        time.sleep(0.002)
until(lambda now: now["runtime"] == 2)
print(json.dumps(seen()), flush=True)
assert io.setSpeedSlider(0.5)
assert io.setStandardDigitalOut(3, True)
assert io.setConfigurableDigitalOut(1, True)
assert io.setToolDigitalOut(0, True)
until(lambda now: now["speed"] == 0.5 and now["outputs"] == 1 << 3 | 1 << 9 | 1 << 16)
assert io.setStandardDigitalOut(3, False)
until(lambda now: now["outputs"] == 1 << 9 | 1 << 16)
first = receive.getTimestamp()
until(lambda now: receive.getTimestamp() > first + 0.1)
assert io.setSpeedSlider(1.0)
until(lambda now: now["runtime"] == 1)
print(json.dumps(seen()), flush=True)
receive.disconnect()
io.disconnect()
"""


def test_the_package_ur_rtde_reads_and_sets_as_it_is(serve):
    if find_spec("rtde_receive") is None:
        pytest.skip("ur-rtde is not installed: it was NOT tested")
    # It knows one port only; an address of this process's own keeps it to ourselves.
    address = f"127.{1 + os.getpid() // 250 % 250}.{os.getpid() % 250}.1"
    controller = serve(robot="ur5e", start=START, rtde={"address": address})
    with vp.connect(controller.url) as arm:
        program = vp.Program(arm.robot, start=arm.setpoint, scale=0.05)
        there = np.add(START, 0.2)
        job = arm.run(program.movej(there).movej(START).movej(there), wait=False)
        done = subprocess.run(
            [sys.executable, "-c", UR_RTDE, address],
            capture_output=True,
            text=True,
            timeout=90,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        job.wait()
    first, last = (json.loads(line) for line in done.stdout.splitlines())
    assert first["connected"]
    assert (first["mode"], first["safety"], first["modes"]) == (7, 1, [253] * 6)
    assert not first["stopped"]
    np.testing.assert_allclose(first["q"], first["target_q"], atol=0.05)
    np.testing.assert_allclose(last["q"], there, atol=1e-9)
    np.testing.assert_allclose(last["pose"][:3], arm.robot.fk(there)[:3, 3], atol=1e-9)
