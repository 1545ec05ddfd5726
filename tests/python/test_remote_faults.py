"""What goes wrong around a controller: its arm stops on the path, or does not notice at all."""

import os
import select
import signal
import socket
import subprocess
import sys
import time

import numpy as np
import pytest

import viapoint as vp
from viapoint.errors import NotInControlError, UnconnectedError

grpc = pytest.importorskip("grpc")

CLIENT = """
import sys, time
import viapoint as vp
with vp.connect(sys.argv[1]) as arm:
    program = vp.Program(arm.robot, start=arm.setpoint, scale=0.02).movej(arm.setpoint + 0.3)
    job = arm.run(program, wait=False)
    print("runs", flush=True)
    try:
        job.wait()
    except vp.errors.NotInControlError as error:
        print("lost:", error.message, flush=True)
"""
STREAM = """
import itertools, sys
import viapoint as vp
with vp.connect(sys.argv[1]) as arm, arm.stream(scale=0.05) as stream:
    home = arm.setpoint
    for k in itertools.count():
        stream.movej(home + 0.3 * (1 - k % 2))
        if k == 3:
            assert stream.job is not None
            print("runs", flush=True)
"""
HEARTBEAT = 1.0
"""Long enough that a loaded machine loses no beat [s]."""


def until(holds):
    deadline = time.monotonic() + 60
    while not holds():
        assert time.monotonic() < deadline
        time.sleep(0.005)


@pytest.fixture
def client():
    """Start a script that runs a long move, and return it when the arm moves."""
    processes = []

    def start(url, script=CLIENT):
        process = subprocess.Popen(
            [sys.executable, "-c", script, url], stdout=subprocess.PIPE, text=True
        )
        processes.append(process)
        assert process.stdout.readline() == "runs\n"
        return process

    yield start
    for process in processes:
        process.kill()
        process.communicate(timeout=60)


def assert_waits_on_its_path(watcher):
    """The run has come to rest where its motion is at the time it says."""
    until(lambda: watcher.job.state == "paused")
    job = watcher.job
    assert 0.0 < job.nominal_time < job.duration
    assert watcher.operator == ""
    # A straight line of the joints: as far along for each.
    moved = watcher.setpoint
    np.testing.assert_allclose(moved, moved[0], rtol=0, atol=1e-9)
    assert 0.0 < moved[0] < 0.3


def test_a_script_that_is_killed_leaves_the_arm_at_rest_on_its_path(serve, client):
    url = serve(heartbeat=HEARTBEAT).url
    with vp.connect(url, watch=True) as watcher:
        process = client(url)
        until(lambda: watcher.job.nominal_time > 0.1)
        process.kill()
        assert_waits_on_its_path(watcher)
        assert "nothing was heard of" in watcher.control_loss
        time.sleep(0.05)
        assert watcher.job.state == "paused"  # nothing goes on by itself
    with vp.connect(url) as arm:
        assert arm.job.state == "paused"
        arm.override = 1.0
        arm.job.resume()
        until(lambda: arm.job.state == "running")
        arm.job.stop()
        assert arm.job.wait(60)
        log = arm.job.log
    limits = arm.robot.limits
    for rate, limit in ((log.qd, limits.velocity), (log.qdd, limits.acceleration)):
        assert (np.abs(rate) <= limit * (1 + 1e-6)).all()


def test_the_stream_of_a_script_that_is_killed_ends_where_it_was_told_to(serve, client):
    url = serve(heartbeat=HEARTBEAT).url
    with vp.connect(url, watch=True) as watcher:
        process = client(url, STREAM)
        until(lambda: watcher.job.nominal_time > 0.1)
        process.kill()
        assert_waits_on_its_path(watcher)
    with vp.connect(url) as arm:
        job = arm.job
        told = job.duration
        arm.override = 1.0
        job.resume()
        assert job.wait(120)
        assert job.state == "finished"
        assert job.duration == told
        ends = np.abs(arm.setpoint[:, None] - np.array([0.0, 0.3])).min(axis=1)
        assert ends.max() < 1e-9


def test_a_script_that_hangs_loses_control_and_is_told(serve, client):
    url = serve(heartbeat=HEARTBEAT).url
    with vp.connect(url, watch=True) as watcher:
        process = client(url)
        os.kill(process.pid, signal.SIGSTOP)
        assert_waits_on_its_path(watcher)
        with vp.connect(url) as arm:  # another takes over
            os.kill(process.pid, signal.SIGCONT)
            told = process.stdout.readline()
            assert told.startswith("lost: control was lost: nothing was heard of")
            assert process.wait(timeout=60) == 0
            assert arm.job.state == "paused"  # the script that was lost has stopped nothing
            arm.job.stop()


def test_sigterm_stops_on_the_path_and_the_script_is_told(serve):
    served = serve()
    with vp.connect(served.url) as arm:
        program = vp.Program(arm.robot, start=arm.setpoint, scale=0.02).movej(arm.setpoint + 0.3)
        job = arm.run(program, wait=False)
        until(lambda: job.nominal_time > 0.0)
        assert served.end() == 0
        with pytest.raises(UnconnectedError):
            job.wait()


def test_a_controller_whose_messages_nobody_reads_lives_on(serve):
    served = serve()
    served.process.stderr.close()
    for _ in range(2):  # each is told of there
        with vp.connect(served.url) as arm:
            arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.01))
    assert served.process.poll() is None


def test_a_hang_up_stops_on_the_path(serve):
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)  # not ignored by what it starts
    try:
        served = serve()
    finally:
        signal.signal(signal.SIGHUP, before)
    served.process.send_signal(signal.SIGHUP)
    assert served.process.wait(timeout=60) == 0


def raw(port):
    return socket.create_connection(("127.0.0.1", port), timeout=60)


def is_closed_by_peer(connection):
    readable, _, _ = select.select([connection], [], [], 60)
    try:
        while readable:
            if not connection.recv(4096):
                return True
            readable, _, _ = select.select([connection], [], [], 60)
    except ConnectionError:
        return True
    return False


def test_garbage_on_the_wire_is_hung_up_on_and_the_run_goes_on(serve):
    served = serve()
    random = np.random.default_rng(7)
    with vp.connect(served.url) as arm:
        program = vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.3)
        job = arm.run(program, wait=False)
        for length in (1, 24, 1000, 100_000):
            with raw(served.port) as connection:
                try:
                    connection.sendall(random.bytes(length) + b"\r\n\r\n" * 8)
                except ConnectionError:
                    continue
                assert length == 1 or is_closed_by_peer(connection)
        with raw(served.port) as connection:  # HTTP/2 as it should be, then none
            connection.sendall(b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + random.bytes(1000))
            assert is_closed_by_peer(connection)
        assert job.wait(60)
        assert job.state == "finished"


def test_connections_by_the_hundred_that_say_nothing_are_closed_and_keep_nobody_out(serve):
    served = serve()
    mute = [raw(served.port) for _ in range(300)]
    try:
        with vp.connect(served.url) as arm:
            arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.1))
        assert all(is_closed_by_peer(connection) for connection in mute[::50])
    finally:
        for connection in mute:
            connection.close()


@pytest.fixture
def call():
    """Call a method with bytes of one's own, and return the status and its text."""
    channels = []

    def ask(port, method, request):
        channel = grpc.insecure_channel(f"127.0.0.1:{port}", [("grpc.enable_http_proxy", 0)])
        channels.append(channel)
        try:
            channel.unary_unary(f"/viapoint.v1.Controller/{method}")(request, timeout=60)
        except grpc.RpcError as error:
            return error.code().name, error.details()
        return "OK", ""

    yield ask
    for channel in channels:
        channel.close()


def test_messages_that_are_none_or_too_large_are_refused_with_a_reason(serve, call):
    port = serve().port
    status, reason = call(port, "GetLog", bytes((1 << 20) + 1))
    assert status == "RESOURCE_EXHAUSTED"
    assert "larger than max" in reason
    status, reason = call(port, "Steer", b"\xff\xff\xff\xff")
    assert (status, "no SteerRequest" in reason) == ("INVALID_ARGUMENT", True)
    status, reason = call(port, "NoSuchCall", b"")
    assert (status, "NoSuchCall" in reason) == ("UNIMPLEMENTED", True)
    assert call(port, "GetState", b"")[0] == "OK"


def test_commands_that_say_nothing_or_nonsense_are_refused_with_a_reason(serve, call):
    from viapoint._wire import message

    served = serve()
    with vp.connect(served.url) as arm:
        token = arm._remote.token

        def refusal(method, kind, **fields):
            return call(served.port, method, message(kind, **fields).SerializeToString())

        def pieces(**fields):
            return refusal(
                "AddPieces", "AddPiecesRequest", token=token, pieces=[message("Piece", **fields)]
            )

        for method in ("Beat", "GiveUpControl", "AddPieces", "Run", "Steer", "SetOverride", "Jog"):
            status, reason = call(served.port, method, b"")
            assert status in ("PERMISSION_DENIED", "INVALID_ARGUMENT"), (method, reason)
            assert reason
        assert refusal("Steer", "SteerRequest", token=token, run=1, wish=2)[0] == "INVALID_ARGUMENT"
        for velocity in ([0.0] * 5, [], [float("nan")] * 6):
            status, reason = refusal("Jog", "JogRequest", token=token, velocity=velocity)
            assert (status, "velocity" in reason) == ("INVALID_ARGUMENT", True)
        for share in (-0.1, 1.1, float("nan")):
            status, reason = refusal("SetOverride", "SetOverrideRequest", token=token, share=share)
            assert (status, "override" in reason) == ("INVALID_ARGUMENT", True)
        good = {"duration": 1.0, "path": [0.0] * 36, "timing": [0.0] * 6}
        output = message("OutputChange", output=64, value=True)
        for bad in (
            {"path": [0.0] * 35},
            {"timing": []},
            {"outputs": [output]},
            {"outputs": [message("OutputChange")] * 9},
        ):
            status, reason = pieces(**(good | bad))
            assert (status, "piece 0" in reason) == ("INVALID_ARGUMENT", True)
        for name in ("", "x" * 201):
            assert refusal("TakeControl", "TakeControlRequest", name=name)[0] == "INVALID_ARGUMENT"
        fingerprint = arm.robot.fingerprint
        status, _ = refusal("Run", "RunRequest", token=token, fingerprint=fingerprint)
        assert status == "INVALID_ARGUMENT"  # nothing was added
        with pytest.raises(NotInControlError):
            vp.connect(served.url)
        assert arm.job is None


def test_requests_with_changed_bytes_are_answered_or_refused(serve):
    from viapoint._wire import message

    served = serve()
    random = np.random.default_rng(11)
    answers = set()
    with vp.connect(served.url) as arm:
        token = arm._remote.token
        piece = message("Piece", duration=1.0, path=[0.0] * 36, timing=[0.0] * 6)
        sound = {
            "GetRun": message("GetRunRequest", run=1),
            "GetLog": message("GetLogRequest", run=1, count=10),
            "AddPieces": message("AddPiecesRequest", token=token, pieces=[piece]),
            "Run": message("RunRequest", token=token, fingerprint=arm.robot.fingerprint),
            "Steer": message("SteerRequest", token=token, run=1, wish=2),
            "Jog": message("JogRequest", token=token, velocity=[0.0] * 6),
            "TakeControl": message("TakeControlRequest", name="nobody"),
            "Beat": message("BeatRequest", token=token),
        }
        options = [("grpc.enable_http_proxy", 0)]
        with grpc.insecure_channel(f"127.0.0.1:{served.port}", options) as channel:
            for method, request in sound.items():
                call = channel.unary_unary(f"/viapoint.v1.Controller/{method}")
                for _ in range(100):
                    changed = bytearray(request.SerializeToString())
                    for _ in range(random.integers(1, 4)):
                        changed[random.integers(len(changed))] = random.integers(256)
                    try:
                        call(bytes(changed), timeout=60)
                    except grpc.RpcError as error:
                        answers.add(error.code().name)
        assert answers <= {
            *("INVALID_ARGUMENT", "PERMISSION_DENIED", "FAILED_PRECONDITION"),
        }
        assert len(answers) > 2
        until(lambda: not arm.jogging)
        assert served.process.poll() is None
        assert arm.job is None or arm.job.wait(60)  # a change may have changed nothing
        arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.02))


def test_a_second_controller_on_the_same_address_does_not_start(serve):
    with pytest.raises(AssertionError, match="cannot listen on"):
        serve(listen=f"127.0.0.1:{serve().port}")
