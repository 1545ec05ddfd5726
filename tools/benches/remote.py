"""viapoint-controller as a process: its calls, the heartbeat, and its loop while clients misbehave.

All traffic goes to a controller started here, on a port of 127.0.0.1 that the system chooses.
"""

import json
import os
import re
import resource
import signal
import socket
import statistics
import struct
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from benches.tables import Row

if TYPE_CHECKING:
    import viapoint as vp

HEARTBEAT = 0.1
MUTE = 2000
"""Connections that say nothing, about twice as many as the controller takes."""
RTDE_CLIENTS = 16
RTDE_NAMES = (
    b"timestamp,target_q,target_qd,target_qdd,actual_q,actual_qd,actual_TCP_pose,joint_mode"
)
CLIENT = """
import sys
import viapoint as vp
with vp.connect(sys.argv[1]) as arm:
    there = arm.setpoint + (0.5 if arm.setpoint[0] < 0.25 else -0.5)
    job = arm.run(vp.Program(arm.robot, start=arm.setpoint, scale=0.02).movej(there), wait=False)
    print("runs", flush=True)
    job.wait()
"""


@contextmanager
def controller() -> Iterator[tuple[str, int, int]]:
    """Start a controller, and give its url, its port, and that of RTDE."""
    with tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "controller.yaml"
        told = {
            "robot": "puma560",
            "listen": "127.0.0.1:0",
            "heartbeat": HEARTBEAT,
            "rtde": {"port": 0},
        }
        config.write_text(json.dumps(told), encoding="utf-8")
        process = subprocess.Popen(
            [Path(sys.executable).parent / "viapoint-controller", "--config", config],
            stderr=subprocess.PIPE,
            text=True,
        )
        assert process.stderr is not None
        try:
            ports: list[int] = []
            for line in process.stderr:
                if found := re.search(r"is served at \S+(?::| port )(\d+)", line):
                    ports.append(int(found.group(1)))
                if len(ports) == 2:
                    yield f"tcp://127.0.0.1:{ports[0]}", ports[0], ports[1]
                    break
        finally:
            process.terminate()
            process.communicate()


def call_times(url: str, count: int) -> list[Row]:
    """Time a look at the arm, over the wire and back."""
    import viapoint as vp

    times = []
    with vp.connect(url, watch=True) as arm:
        for _ in range(count):
            begin = time.perf_counter()
            _ = arm.setpoint
            times.append(1e3 * (time.perf_counter() - begin))
    return [
        {
            "bench": "remote",
            "case": "a call, there and back",
            "p50_ms": statistics.median(times),
            "max_ms": max(times),
            "count": count,
        }
    ]


def silence_times(url: str, signal_number: signal.Signals, count: int) -> Row:
    """Time from a signal that silences the operator's process to the first cycle of the stop."""
    import viapoint as vp

    times = []
    for _ in range(count):
        client = subprocess.Popen(
            [sys.executable, "-c", CLIENT, url], stdout=subprocess.PIPE, text=True
        )
        assert client.stdout is not None
        client.stdout.readline()
        time.sleep(0.2)
        os.kill(client.pid, signal_number)
        silent = time.monotonic_ns()
        with vp.connect(url, watch=True) as watcher:
            while watcher.job is None or watcher.job.state != "paused":
                time.sleep(0.01)
            log = watcher.job.log
        client.kill()
        client.communicate()
        # The clock of the log is that of this process, too.
        stops = log.stamp[(log.state == log.STATES.index("pausing")) & (log.stamp > silent)]
        if len(stops):  # else the machine lost a beat before, and the arm was at rest already
            times.append((int(stops[0]) - silent) / 1e6)
        with vp.connect(url) as arm:
            assert arm.job is not None
            arm.job.stop()
            arm.job.wait()
    return {
        "bench": "remote",
        "case": f"{signal_number.name} to the stop's first cycle",
        "p50_ms": statistics.median(times) if times else "none",
        "max_ms": max(times, default=float("nan")),
        "count": len(times),
    }


def latency(url: str, case: str, seconds: float) -> Row:
    """Wake-up latency of the loop during a run."""
    import viapoint as vp

    with vp.connect(url) as arm:
        report = arm.run(back_and_forth(arm, seconds)).report
    return {
        "bench": "remote_latency",
        "case": case,
        "cycles": report.cycles,
        "overruns": report.overruns,
        "p50_us": 1e6 * report.latency_p50,
        "p99_us": 1e6 * report.latency_p99,
        "max_us": 1e6 * report.latency_max,
        "tick_p99_us": 1e6 * report.compute_p99,
    }


def back_and_forth(arm: "vp.Arm", seconds: float) -> "vp.Program":
    """Return a program of about so long."""
    import viapoint as vp

    start = arm.setpoint
    program = vp.Program(arm.robot, start=start, zone=vp.joint_deviation(0.02))
    moves = 0
    while moves == 0 or program.plan().duration < seconds:
        for _ in range(max(2, moves)):
            program.movej(start + 0.3).movej(start)
            moves += 2
    return program


@contextmanager
def repeated(act: Callable[[], object]) -> Iterator[None]:
    """Repeat an act in a thread until the block ends."""
    over = threading.Event()

    def repeat() -> None:
        while not over.wait(0.001):
            act()

    thread = threading.Thread(target=repeat)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


def connect(port: int) -> socket.socket:
    """Connect, and say nothing."""
    return socket.create_connection(("127.0.0.1", port), timeout=5)


def frame(kind: int, flags: int, stream: int, payload: bytes) -> bytes:
    """Return an HTTP/2 frame."""
    return struct.pack(">I", len(payload))[1:] + struct.pack(">BBI", kind, flags, stream) + payload


def ask_and_never_read(port: int) -> socket.socket:
    """Make sixteen calls whose answers the window has no room for."""
    headers = {
        b":method": b"POST",
        b":scheme": b"http",
        b":path": b"/viapoint.v1.Controller/GetState",
        b":authority": b"nobody",
        b"te": b"trailers",
        b"content-type": b"application/grpc",
    }
    block = b"".join(
        b"\0" + bytes([len(name)]) + name + bytes([len(value)]) + value
        for name, value in headers.items()
    )
    connection = connect(port)
    connection.sendall(b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + frame(4, 0, 0, b"\0\4\0\0\0\0"))
    for stream in range(1, 32, 2):
        connection.sendall(frame(1, 4, stream, block) + frame(0, 1, stream, bytes(5)))
    return connection


def rtde_client(port: int) -> socket.socket:
    """Begin to be sent data at 500 Hz."""

    def package(kind: bytes, payload: bytes) -> bytes:
        return struct.pack(">H", 3 + len(payload)) + kind + payload

    client = connect(port)
    recipe = struct.pack(">d", 500.0) + RTDE_NAMES
    client.sendall(package(b"V", b"\0\2") + package(b"O", recipe) + package(b"S", b""))
    return client


def flood(port: int) -> None:
    """Send bytes that mean nothing."""
    try:
        with connect(port) as connection:
            connection.sendall(os.urandom(1 << 16))
    except OSError:
        return  # hung up on, as it should be


def measure(*, quick: bool) -> list[Row]:
    """Measure calls, heartbeat and latency."""
    import viapoint as vp

    count, seconds = (3, 3.0) if quick else (20, 30.0)
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))
    with controller() as (url, port, rtde):
        rows = call_times(url, 100 if quick else 2000)
        rows += [silence_times(url, number, count) for number in (signal.SIGKILL, signal.SIGSTOP)]
        rows.append(latency(url, "its operator alone", seconds))
        with ExitStack() as stack:
            arm = stack.enter_context(vp.connect(url, watch=True))  # gRPC shares its connection
            for _ in range(MUTE):
                stack.enter_context(connect(port))
            rows.append(latency(url, f"{MUTE} mute connections", seconds))
        with ExitStack() as stack:
            for _ in range(20):
                stack.enter_context(ask_and_never_read(port))
            rows.append(latency(url, "320 calls whose answers nobody reads", seconds))
        with ExitStack() as stack:
            for k in range(RTDE_CLIENTS):
                client = stack.enter_context(rtde_client(rtde))
                if k % 4:  # the others never read
                    stack.enter_context(repeated(partial(client.recv, 1 << 16)))
            rows.append(latency(url, f"{RTDE_CLIENTS} clients of RTDE, 4 never read", seconds))
        with repeated(lambda: flood(port)):
            rows.append(latency(url, "garbage, 64 KiB a ms at most", seconds))
        with ExitStack() as stack:
            for _ in range(8):
                arm = stack.enter_context(vp.connect(url, watch=True))
                stack.enter_context(repeated(partial(getattr, arm, "busy")))
            rows.append(latency(url, "8 that look every ms", seconds))
    return rows
