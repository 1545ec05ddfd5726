"""Runs of a controller that would never be over."""

import numpy as np
import pytest

import viapoint as vp
from viapoint._wire import message
from viapoint.errors import BadArgumentError


@pytest.fixture
def url(serve, abc):
    return serve(start=list(abc["A"])).url


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
