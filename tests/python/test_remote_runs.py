"""Runs of a controller that are over before they are told something, or would never be."""

import numpy as np
import pytest

import viapoint as vp
from viapoint._wire import message
from viapoint.errors import BadArgumentError, NotInControlError


@pytest.fixture
def url(serve, abc):
    return serve(start=list(abc["A"])).url


@pytest.mark.parametrize("away", [True, False])
def test_wishes_of_a_run_that_has_ended_change_nothing(url, puma, abc, away):
    with vp.connect(url) if away else vp.connect("sim://puma560", start=abc["A"]) as arm:
        jobs = [
            arm.run(vp.Program(puma, start=arm.setpoint).movej(abc["A"] + 0.02 * k))
            for k in range(1, 4)  # of which the controller keeps two
        ]
        for job in jobs:
            job.pause()
            job.step()
            job.backward()
            job.on_input(3, True, "stop")
            job.stop()
            job.stop(1)
            job.resume()
            assert job.state == "finished"
        rest = arm.setpoint
        # The drive has kept its power, and the next run is one as any other.
        assert arm.run(vp.Program(puma, start=rest).movej(rest + 0.02)).state == "finished"
        if away:
            with (
                vp.connect(url, watch=True) as watcher,
                pytest.raises(NotInControlError),
            ):
                watcher.job.stop()
    jobs[0].pause()  # of an arm that is closed, too


def test_a_motion_without_an_end_is_refused(url, puma):
    with vp.connect(url) as arm:
        loop = arm._remote
        rest = [*arm.setpoint, *np.zeros(30)]
        piece = message("Piece", duration=1e308, path=rest, timing=[0, 0, 0, 10, -15, 6])
        begin = message("RunRequest", token=loop.token, fingerprint=loop.about.fingerprint)
        for method in ("Run", "Follow"):
            request = message("AddPiecesRequest", token=loop.token, pieces=[piece, piece])
            loop.call("AddPieces", request, "AddPiecesReply")
            with pytest.raises(BadArgumentError, match=r"1e\+308 s .* up to 1e\+12 s"):
                loop.call(method, begin, "RunReply")
        assert arm.job is None
        program = vp.Program(puma, start=arm.setpoint)
        with pytest.raises(BadArgumentError, match=r"wait of 1e\+308 s; allowed are 0 to 1e\+12 s"):
            arm.run(program.wait(1e308))
        twice = vp.Program(puma, start=arm.setpoint).wait(9e11).wait(9e11)
        with pytest.raises(BadArgumentError, match=r"1\.8e\+12 s .* up to 1e\+12 s") as refusal:
            twice.plan()
        assert refusal.value.move == 1
