"""Clients by the hundred, and clients that read nothing: the operator does not notice."""

import resource
import socket
import struct
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import viapoint as vp
from viapoint.errors import UnconnectedError

grpc = pytest.importorskip("grpc")
from viapoint._wire import Wire, message  # noqa: E402 -- needs grpc

PREFACE = b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"
SETTINGS, HEADERS, DATA = 4, 1, 0


def frame(kind, flags, stream, payload):
    """Return an HTTP/2 frame."""
    return struct.pack(">I", len(payload))[1:] + struct.pack(">BBI", kind, flags, stream) + payload


def header(name, value):
    """Return a header as HPACK writes it in plain letters."""
    return b"\0" + bytes([len(name)]) + name + bytes([len(value)]) + value


def ask_and_never_read(port, method, message, calls):
    """Make calls whose answers the controller may not send: the window has no room for a byte."""
    no_room = struct.pack(">HI", 4, 0)
    headers = b"".join(
        header(name, value)
        for name, value in {
            b":method": b"POST",
            b":scheme": b"http",
            b":path": b"/viapoint.v1.Controller/" + method,
            b":authority": b"nobody",
            b"te": b"trailers",
            b"content-type": b"application/grpc",
        }.items()
    )
    connection = socket.create_connection(("127.0.0.1", port), timeout=60)
    connection.sendall(PREFACE + frame(SETTINGS, 0, 0, no_room))
    body = struct.pack(">BI", 0, len(message)) + message
    for stream in range(1, 2 * calls, 2):
        connection.sendall(frame(HEADERS, 4, stream, headers) + frame(DATA, 1, stream, body))
    return connection


def test_clients_that_read_no_answer_keep_no_command_waiting(serve):
    served = serve()
    with vp.connect(served.url) as arm:
        program = vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.3)
        job = arm.run(program, wait=False)
        # More calls than any number of threads would be made for.
        unread = [ask_and_never_read(served.port, b"GetState", b"", 16) for _ in range(20)]
        try:
            for _ in range(20):
                arm.override = 1.0
                assert arm.operator
            with vp.connect(served.url, watch=True) as watcher:
                assert watcher.busy or job.wait(60)
            assert job.wait(60)
            assert job.state == "finished"
            threads = len(list(Path(f"/proc/{served.process.pid}/task").iterdir()))
            assert threads < 40
        finally:
            for connection in unread:
                connection.close()


FULL = (grpc.StatusCode.RESOURCE_EXHAUSTED, "too many calls wait for an answer")
GIVEN_UP = (grpc.StatusCode.CANCELLED, "")


class Crowded(grpc.GenericRpcHandler):
    """Stands in for a controller that has no room for the first calls, or for their answers."""

    def __init__(self, refusals, refusal):
        self.left = refusals
        self.refusal = refusal

    def service(self, details):
        return grpc.unary_unary_rpc_method_handler(self.answer)

    def answer(self, request, context):
        self.left -= 1
        if self.left >= 0:
            context.abort(*self.refusal)
        return b""


@pytest.fixture
def crowded():
    """Begin such a controller, and connect to it."""
    ends = []

    def begin(refusals, refusal):
        controller = Crowded(refusals, refusal)
        server = grpc.server(ThreadPoolExecutor(1), handlers=(controller,))
        wire = Wire(f"127.0.0.1:{server.add_insecure_port('127.0.0.1:0')}", None)
        ends.extend([wire.close, lambda: server.stop(0)])
        server.start()
        return controller, wire

    yield begin
    for end in ends:
        end()


def test_a_call_that_finds_no_room_is_made_again_for_as_long_as_it_may_take(crowded):
    controller, wire = crowded(3, FULL)
    steer = message("SteerRequest")
    assert wire.call("Steer", steer, "SteerReply", patience=60.0) == message("SteerReply")
    assert controller.left == -1
    _, wire = crowded(10**9, FULL)
    with pytest.raises(UnconnectedError, match="too many calls wait"):
        wire.call("Steer", steer, "SteerReply", patience=0.2)


def test_what_only_reads_is_asked_again_when_its_answer_was_given_up(crowded):
    controller, wire = crowded(3, GIVEN_UP)
    state = wire.call("GetState", message("GetStateRequest"), "ArmState", patience=60.0)
    assert state == message("ArmState")
    assert controller.left == -1
    _, wire = crowded(10**9, GIVEN_UP)
    with pytest.raises(UnconnectedError, match="CANCELLED"):
        wire.call("GetState", message("GetStateRequest"), "ArmState", patience=0.2)


def test_a_command_whose_answer_was_given_up_is_not_given_twice(crowded):
    controller, wire = crowded(3, GIVEN_UP)
    with pytest.raises(UnconnectedError, match="CANCELLED"):
        wire.call("Steer", message("SteerRequest"), "SteerReply", patience=60.0)
    assert controller.left == 2


def test_a_crowd_is_turned_away_with_a_reason_and_there_is_room_when_it_has_gone(serve):
    def few():
        resource.setrlimit(resource.RLIMIT_NOFILE, (160, 160))

    served = serve(before=few)
    with vp.connect(served.url) as arm:
        program = vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.3)
        job = arm.run(program, wait=False)
        # As many as are let in greet, or they would be sent away after a moment.
        crowd = [ask_and_never_read(served.port, b"GetState", b"", 0) for _ in range(160)]
        try:
            crowd.append(socket.create_connection(("127.0.0.1", served.port), timeout=60))
            told = b""
            while piece := crowd[-1].recv(4096):
                told += piece
            assert b"too many connections" in told
            arm.override = 1.0  # who was there before is served
            # In a process of its own, which shares no connection with us.
            late = subprocess.run(
                [sys.executable, "-c", f"import viapoint; viapoint.connect('{served.url}')"],
                capture_output=True,
                text=True,
                timeout=60,
                check=False,
            )
            assert "too many connections" in late.stderr
        finally:
            for connection in crowd:
                connection.close()
        assert job.wait(60)
        assert job.state == "finished"
        deadline = time.monotonic() + 60
        while True:
            try:
                with vp.connect(served.url, watch=True) as watcher:
                    assert not watcher.busy
                break
            except UnconnectedError:
                assert time.monotonic() < deadline
                time.sleep(0.1)
    assert served.end() == 0
    assert "clients turned away" in served.process.stderr.read()
