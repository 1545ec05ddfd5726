"""A cable that is cut, and a disk that is full, while a controller runs an arm."""

import resource
import select
import signal
import socket
import threading
import time

import numpy as np
import pytest

import viapoint as vp
from viapoint.errors import NotInControlError, UnconnectedError

pytest.importorskip("grpc")


class Cable:
    """Hands bytes on between a client and a controller until it is cut; then it says nothing."""

    def __init__(self, port):
        self._port = port
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port = self._listener.getsockname()[1]
        self._peer = {}
        self._cut = threading.Event()
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self):
        while not self._cut.is_set():
            for ready in select.select([self._listener, *self._peer], [], [], 0.01)[0]:
                if ready is self._listener:
                    near, _ = self._listener.accept()
                    far = socket.create_connection(("127.0.0.1", self._port))
                    self._peer |= {near: far, far: near}
                elif ready in self._peer:
                    self._hand_on(ready)

    def _hand_on(self, ready):
        try:
            if told := ready.recv(65536):
                return self._peer[ready].sendall(told)
        except ConnectionError:
            pass
        other = self._peer.pop(ready)
        del self._peer[other]
        ready.close()
        return other.close()

    def cut(self):
        """Hand nothing on any more, without a word to either end."""
        self._cut.set()
        self._thread.join()

    def drop(self):
        self.cut()
        for connection in (self._listener, *self._peer):
            connection.close()


def until(holds):
    deadline = time.monotonic() + 60
    while not holds():
        assert time.monotonic() < deadline
        time.sleep(0.005)


def test_a_cable_that_is_cut_leaves_the_arm_at_rest_on_its_path(serve):
    served = serve(heartbeat=1.0)
    cable = Cable(served.port)
    try:
        with vp.connect(served.url, watch=True) as watcher:
            arm = vp.connect(f"tcp://127.0.0.1:{cable.port}")
            program = vp.Program(arm.robot, start=arm.setpoint, scale=0.02)
            job = arm.run(program.movej(arm.setpoint + 0.3), wait=False)
            until(lambda: job.nominal_time > 0.1)
            cable.cut()
            until(lambda: watcher.job.state == "paused")
            assert 0.0 < watcher.job.nominal_time < watcher.job.duration
            np.testing.assert_allclose(watcher.setpoint, watcher.setpoint[0], rtol=0, atol=1e-9)
            assert "nothing was heard of" in watcher.control_loss
        cable.drop()  # now the script hears of it, too
        with pytest.raises((UnconnectedError, NotInControlError)):
            job.wait(60)
        arm.close()
        with vp.connect(served.url) as arm:
            assert arm.job.state == "paused"  # nothing goes on by itself
            arm.job.stop()
    finally:
        cable.drop()


def test_a_full_disk_costs_the_log_and_not_the_run(serve, tmp_path):
    def no_room():
        # A write beyond 4 KiB fails, as it does on a full disk, and kills nobody.
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))

    logs = tmp_path / "logs"
    logs.mkdir()
    served = serve(before=no_room, logs=str(logs))
    with vp.connect(served.url) as arm:
        arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(arm.setpoint + 0.3))
        assert arm.job.state == "finished"
        assert len(arm.job.log) == arm.job.report.cycles  # still to be had from the controller
    assert served.end() == 0
    assert "the log of run 1 was not written" in served.process.stderr.read()
    assert list(logs.iterdir()) == []  # no half of a log either
