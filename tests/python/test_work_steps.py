"""Pick, place, stack, feed and screw in: the moves that they are made of (textbook §5)."""

import math

import numpy as np
import pytest

import viapoint as vp
from viapoint import _core, cells, errors
from viapoint.cells import Gripper

DOWN = np.diag([1.0, -1.0, -1.0, 1.0])


def tool_at(x, y, z):
    pose = DOWN.copy()
    pose[:3, 3] = (x, y, z)
    return pose


@pytest.fixture(scope="module")
def ur5e():
    return vp.load_robot("ur5e")


@pytest.fixture(scope="module")
def home(ur5e):
    return ur5e.ik(tool_at(0.3, -0.2, 0.5), near=np.radians([0, -90, 90, -90, -90, 0]))


def run(motion):
    """Run it in virtual time, with its outputs."""
    return vp.RunLog.of(_core.simulate(motion._core, [], 0.002), motion, 0.002)


def test_a_part_is_picked_and_placed_slowly_near_it(ur5e, home):
    gripper = Gripper(output=5, dwell=0.1)
    pick, place = tool_at(0.4, -0.2, 0.2), tool_at(0.4, 0.2, 0.2)
    program = vp.Program(ur5e, start=home, zone=0.02)
    program.pick(pick, gripper, near_speed=0.2).place(place, gripper, near_speed=0.2)
    motion = program.plan()
    log = run(motion)
    points = log.samples.pose[:, :3, 3]
    on = (log.outputs & np.uint64(1 << 5)) != 0
    closes, opens = int(np.argmax(on)), len(on) - int(np.argmax(on[::-1]))
    np.testing.assert_allclose(points[closes], pick[:3, 3], atol=1e-4)
    np.testing.assert_allclose(points[opens], place[:3, 3], atol=1e-4)
    # Where the gripper moves the arm rests for its dwell.
    rest = np.abs(log.qd).max(axis=1) < 1e-9
    assert rest[closes : closes + 49].all()
    # Below the height above both parts it goes straight up or down, at 0.2 m/s at most.
    low = points[:, 2] < 0.27
    beside = np.minimum(
        np.linalg.norm(points[:, :2] - pick[:2, 3], axis=1),
        np.linalg.norm(points[:, :2] - place[:2, 3], axis=1),
    )
    assert beside[low].max() < 1e-4
    speed = np.linalg.norm(log.samples.twist[:, :3], axis=1)
    assert speed[low].max() <= 0.2 * (1 + 1e-6)
    assert speed.max() > 0.3


def test_parts_are_stacked_each_a_height_above_the_last(ur5e, home):
    gripper = Gripper(output=0, dwell=0.0)
    first = tool_at(0.4, 0.2, 0.15)
    places = cells.stacked(first, 0.04, 3)
    np.testing.assert_allclose(places[:, 2, 3], [0.15, 0.19, 0.23], atol=1e-15)
    np.testing.assert_array_equal(places[0], first)
    program = vp.Program(ur5e, start=home)
    for place in places:
        program.pick(tool_at(0.4, -0.2, 0.15), gripper, travel="lin").place(place, gripper)
    motion = program.plan()
    samples = motion.sample(0.002)
    for place in places:
        assert np.linalg.norm(samples.pose[:, :3, 3] - place[:3, 3], axis=1).min() < 1e-4


def test_lifting_goes_back_along_the_tools_own_axis():
    pose = np.array([[0, 0, 1, 0.5], [0, 1, 0, 0.1], [-1, 0, 0, 0.3], [0, 0, 0, 1.0]])
    np.testing.assert_allclose(cells.lifted(pose, 0.1)[:3, 3], [0.4, 0.1, 0.3])
    np.testing.assert_array_equal(cells.lifted(pose, 0.1)[:3, :3], pose[:3, :3])


def test_the_feeders_lowest_cube_lies_against_stop_and_slope():
    slope, edge, end = math.radians(30), 0.05, 0.2
    pose = cells.on_feeder(slope, edge, end=end, friction=0.5)
    assert np.linalg.det(pose[:3, :3]) == pytest.approx(1.0)
    np.testing.assert_allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), atol=1e-15)
    up_the_slope = np.array([math.cos(slope), 0, math.sin(slope)])
    off_the_slope = np.array([-math.sin(slope), 0, math.cos(slope)])
    middle = pose[:3, 3] - [end, 0, 0]
    # Half an edge above the slope, and half an edge up it from the stop.
    assert middle @ off_the_slope == pytest.approx(edge / 2)
    assert middle @ up_the_slope == pytest.approx(edge / 2)
    np.testing.assert_allclose(pose[:3, 2], -off_the_slope, atol=1e-15)


def test_cubes_that_do_not_slide_are_refused():
    with pytest.raises(errors.BadArgumentError, match=r"slide from 0\.4636"):
        cells.on_feeder(0.46, 0.05, friction=0.5)
    cells.on_feeder(0.47, 0.05, friction=0.5)


@pytest.mark.parametrize("pitch", [1e-9, 1e-320])
def test_a_screw_that_would_never_be_in_is_refused(ur5e, home, pitch):
    program = vp.Program(ur5e, start=home)
    with pytest.raises(errors.BadArgumentError, match="allowed are 10000"):
        program.screw_in(0.1, pitch, gripper=Gripper(output=1))


def test_a_screw_turns_with_its_thread_in_strokes(ur5e, home):
    """10 mm of pitch 2 mm: five turns, in strokes of at most 3 rad: eleven."""
    gripper = Gripper(output=1, dwell=0.05)
    program = vp.Program(ur5e, start=home)
    program.screw_in(0.01, 0.002, gripper=gripper, most_turn=3.0)
    motion = program.plan()
    log = run(motion)
    poses = log.samples.pose
    assert poses[0, 2, 3] - poses[-1, 2, 3] == pytest.approx(0.01, abs=1e-6)
    np.testing.assert_allclose(
        poses[:, :2, 3], poses[0, :2, 3][None].repeat(len(poses), 0), atol=2e-5
    )
    turned = np.diff(np.unwrap(np.arctan2(poses[:, 1, 0], poses[:, 0, 0])))
    down = -np.diff(poses[:, 2, 3])
    driving = down > 1e-9
    assert abs(turned[driving].sum()) == pytest.approx(5 * 2 * math.pi, rel=2e-3)
    # All along, the travel is that of the thread.
    ratio = np.abs(turned[driving]) / (2 * math.pi) * 0.002
    assert np.abs(np.cumsum(ratio - down[driving])).max() < 5e-5
    stroke = 5 * 2 * math.pi / 11
    assert abs(turned[~driving].sum()) == pytest.approx(10 * stroke, rel=2e-3)
    opened = np.diff(((log.outputs & np.uint64(2)) != 0).astype(int))
    assert (opened == 1).sum() == 10  # closed again ten times
    left = vp.Program(ur5e, start=home).screw_in(0.001, -0.002).plan()
    samples = left.sample(0.002)
    assert samples.pose[-1, 2, 3] - samples.pose[0, 2, 3] == pytest.approx(-0.001, abs=1e-6)


def test_every_step_tells_the_line_of_the_script(ur5e, home):
    program = vp.Program(ur5e, start=home).pick(tool_at(3.0, 0, 0), Gripper(1))
    problem = program.check().errors[0]
    assert problem.file.endswith("test_work_steps.py")
    assert problem.line is not None


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda p: p.pick(np.eye(3), Gripper(1)), "at has the shape"),
        (lambda p: p.pick(np.eye(4), 3), "gripper is 3"),
        (lambda p: p.pick(np.eye(4), Gripper(1), approach=0), "approach is"),
        (lambda p: p.place(np.eye(4), Gripper(1), near_speed=-1), "near_speed is"),
        (lambda p: p.place(np.eye(4), Gripper(1), travel="fly"), "travel is"),
        (lambda p: p.screw_in(0.01, 0.002), "more than a stroke"),
        (lambda p: p.screw_in(0.01, 0), "pitch is 0"),
        (lambda p: p.screw_in(-0.01, 0.002), "length is"),
        (lambda p: Gripper(64), "output is 64"),
        (lambda p: Gripper(1, closed=1), "closed is 1"),
        (lambda p: Gripper(1, dwell=-1), "dwell is"),
        (lambda p: cells.stacked(np.eye(4), 0, 3), "height is"),
        (lambda p: cells.stacked(np.eye(4), 0.1, 0), "count is"),
        (lambda p: cells.stacked(np.eye(4), 0.1, 2, up=(0, 0, 0)), "up is"),
    ],
)
def test_what_does_not_fit_is_refused_by_name(ur5e, home, call, says):
    program = vp.Program(ur5e, start=home)
    with pytest.raises(errors.BadArgumentError, match=says):
        call(program)
    assert len(program) == 0
