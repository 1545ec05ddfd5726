"""A run that is found on a controller tells the tools that its program set."""

import numpy as np
import pytest

import viapoint as vp
from viapoint import errors
from viapoint._wire import message

HOME = np.radians([0, -90, 90, -90, -90, 0])
TOOLS = [np.eye(4), np.eye(4)]
TOOLS[0][2, 3], TOOLS[1][:3, 3] = 0.1, [0.2, 0.0, 0.05]


@pytest.fixture
def url(serve):
    return serve(robot="ur5e", start=list(HOME)).url


def require_same_log(found, own):
    """The same cycles, tools and places of the tool, to the last bit."""
    assert [step for step, _ in found.tools] == [step for step, _ in own.tools]
    for (_, there), (_, here) in zip(found.tools, own.tools, strict=True):
        np.testing.assert_array_equal(there.tool, here.tool)
    np.testing.assert_array_equal(found.q, own.q)
    np.testing.assert_array_equal(found.samples.pose, own.samples.pose)
    np.testing.assert_array_equal(found.samples.twist, own.samples.twist)


def test_the_log_of_a_run_that_is_found_has_the_tools_of_its_program(url):
    with vp.connect(url, watch=True) as watcher:
        with vp.connect(url) as arm:
            program = vp.Program(arm.robot, start=HOME).movej(HOME + 0.05)
            program.set_tool(TOOLS[0]).movej(HOME).set_tool(TOOLS[1]).movej(HOME + 0.05)
            own = arm.run(program).log
            assert len(own.tools) == 2
            require_same_log(watcher.job.log, own)
        require_same_log(watcher.job.log, own)  # when the operator has left, too
        with vp.connect(url) as arm:
            arm.run(vp.Program(arm.robot, start=arm.setpoint).movej(HOME))
        assert watcher.job.log.tools == ()


def test_the_log_of_a_stream_that_is_found_has_the_tools_it_was_told(url):
    with vp.connect(url) as arm, vp.connect(url, watch=True) as watcher:
        with arm.stream() as stream:
            for k in range(12):
                stream.set_tool(TOOLS[k % 2]).movej(HOME + 0.02 * (k % 3))
        own = stream.job.log
        assert len(own.tools) == 12
        require_same_log(watcher.job.log, own)


def test_tools_that_are_none_or_too_many_are_refused_by_the_controller(url):
    with vp.connect(url) as arm:
        loop = arm._remote
        run = arm.run(vp.Program(arm.robot, start=HOME).movej(HOME + 0.02))._execution.number

        def tell(moves, tool, number=run, token=None):
            told = message("ToolsPart", move=moves, tool=np.ravel(tool))
            loop.call(
                "AddTools",
                message("AddToolsRequest", token=token or loop.token, run=number, tools=told),
                "AddToolsReply",
            )

        for moves, tool, says in (
            ([0], np.eye(3), "tool has 9 values; expected are 16"),
            ([0], np.eye(4) * np.nan, "tool 0 is not finite"),
        ):
            with pytest.raises(errors.BadArgumentError, match=says):
                tell(moves, tool)
        with pytest.raises(errors.BadArgumentError, match="run 99 is not known"):
            tell([0], np.eye(4), number=99)
        with pytest.raises(errors.NotInControlError):
            tell([0], np.eye(4), token="none")
        part = [0] * 5000, np.tile(np.eye(4), (5000, 1, 1))
        for _ in range(20):
            tell(*part)
        with pytest.raises(errors.BadArgumentError, match="changes tools 100001 times; kept are"):
            tell([0], np.eye(4))
