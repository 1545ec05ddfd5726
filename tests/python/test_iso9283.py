"""Accuracy and repeatability against sets worked out by hand, and from logs of runs."""

from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import viapoint as vp
from viapoint import cli, errors, iso9283
from viapoint._attained import Attained
from viapoint._legs import legs_of
from viapoint._rotation_vectors import rotations_of


def pose(position=(0, 0, 0), turn=(0, 0, 0)):
    matrix = np.eye(4)
    matrix[:3, 3] = position
    matrix[:3, :3] = rotations_of(np.array([turn], dtype=float))[0]
    return matrix


def test_five_poses_on_a_line():
    """x = 1, 2, 3, 4, 5: mean 3; l = 2, 1, 0, 1, 2 with mean 1.2 and S² = 2.8 / 4."""
    commanded = pose((0.5, 0.1, 0.2), (0.3, -0.2, 1.0))
    attained = [pose((0.5 + 1e-5 * k, 0.1, 0.2), (0.3, -0.2, 1.0)) for k in range(1, 6)]
    found = iso9283.pose_accuracy(commanded, attained)
    assert found.cycles == 5
    assert found.accuracy == pytest.approx(3e-5, rel=1e-9)
    np.testing.assert_allclose(found.accuracy_each, [3e-5, 0, 0], atol=1e-15)
    assert found.repeatability == pytest.approx((1.2 + 3 * np.sqrt(0.7)) * 1e-5, rel=1e-9)
    np.testing.assert_allclose(found.angle_accuracy, 0.0, atol=1e-15)
    np.testing.assert_allclose(found.angle_repeatability, 0.0, atol=1e-15)


def test_a_square_of_poses_about_the_commanded_one():
    """All as far from the mean as the others: AP = 0, RP = l̄ + 3 · 0 = √2 e-4."""
    corners = [(1, 1), (1, -1), (-1, -1), (-1, 1)]
    attained = [pose((1e-4 * x, 1e-4 * y, 0)) for x, y in corners]
    found = iso9283.pose_accuracy(pose(), attained)
    assert found.accuracy == pytest.approx(0.0, abs=1e-18)
    assert found.repeatability == pytest.approx(np.sqrt(2) * 1e-4, rel=1e-12)


def test_angles_about_the_axes_of_the_base():
    """c = 1, 2, 6 mrad: mean 3, S² = (4 + 1 + 9) / 2 = 7; commanded already turned."""
    commanded = pose((0, 0, 0), (0, 0.4, 0))
    attained = []
    for c in (1e-3, 2e-3, 6e-3):
        there = commanded.copy()
        there[:3, :3] = rotations_of(np.array([[0, 0, c]]))[0] @ commanded[:3, :3]
        attained.append(there)
    found = iso9283.pose_accuracy(commanded, attained)
    np.testing.assert_allclose(found.angle_accuracy, [0, 0, 3e-3], atol=1e-14)
    np.testing.assert_allclose(found.angle_repeatability, [0, 0, 3e-3 * np.sqrt(7)], atol=1e-14)


def test_one_cycle_has_no_repeatability():
    found = iso9283.pose_accuracy(pose(), [pose((1e-3, 0, 0))])
    assert found.accuracy == pytest.approx(1e-3)
    assert np.isnan(found.repeatability)
    assert np.isnan(found.angle_repeatability).all()


def test_a_path_is_judged_where_it_is_worst():
    """Place 1: y = 1, 3: AT 2, l = 1, 1: RT 1. Place 2: z = -4, 4, 0: AT 0, l̄ = 8/3, S² = 16/3."""
    commanded = [pose((0.1 * i, 0, 0)) for i in range(3)]
    offsets = np.zeros((3, 3, 3))
    offsets[:, 1, 1] = [1e-4, 3e-4, 2e-4]
    offsets[:, 2, 2] = [-4e-4, 4e-4, 0]
    attained = np.array([[pose(commanded[i][:3, 3] + row[i]) for i in range(3)] for row in offsets])
    found = iso9283.path_accuracy(commanded, attained)
    assert (found.cycles, found.places) == (3, 3)
    assert found.accuracy == pytest.approx(2e-4, rel=1e-9)
    assert found.accuracy_at == 1
    lengths = np.array([4.0, 4.0, 0.0])
    assert lengths.std(ddof=1) ** 2 == pytest.approx(16 / 3)
    assert found.repeatability == pytest.approx((8 / 3 + 3 * np.sqrt(16 / 3)) * 1e-4, rel=1e-9)
    assert found.repeatability_at == 2


def test_speeds_of_three_cycles():
    """Means 1.1, 0.9, 1.3: v̄ 1.1, S² = (0 + 0.04 + 0.04) / 2; widest swing 0.3, in the last."""
    found = iso9283.path_velocity(1.0, [[1.0, 1.2, 1.1], [0.9, 0.9], [1.15, 1.45]])
    assert found.cycles == 3
    assert found.attained == pytest.approx(1.1, rel=1e-12)
    assert found.accuracy == pytest.approx(0.1, rel=1e-12)
    assert found.repeatability == pytest.approx(3 * 0.2, rel=1e-12)
    assert found.fluctuation == pytest.approx(0.3, rel=1e-12)
    slow = iso9283.path_velocity(2.0, [[1.9]])
    assert slow.accuracy == pytest.approx(-0.05)
    assert np.isnan(slow.repeatability)
    assert slow.fluctuation == 0.0


def test_a_corner_that_is_cut_and_one_that_is_overshot():
    """Up to the origin along y, then along z. Cut: from (0, -3, 0) to (0, 0, 4), 2.4 away at least.

    Overshot: through the corner to y = 2, back to the leg; x = 0 at y = 2, and x = 1.5 at y = 2,
    which is 2.5 from it; beyond the leg's end, and on the side it comes from, nothing counts.
    """
    legs = ((0, -10, 0), (0, 0, 0), (0, 0, 10))
    cut = [[0, -10, 0], [0, -3, 0], [0, 0, 4], [0, 0, 10]]
    over = [
        *([0, -10, 0], [0, 0, 0], [0, 2, 1], [1.5, 2, 3], [0, -4, 5], [0, 0, 8], [0, 0, 11]),
        [0, 9, 9],
    ]
    found = iso9283.cornering(*legs, [cut, over])
    np.testing.assert_allclose(found.rounding_each, [2.4, 0.0], atol=1e-12)
    np.testing.assert_allclose(found.overshoot_each, [0.0, 2.5], atol=1e-12)
    assert (found.cycles, found.overshoot) == (2, 2.5)
    assert found.rounding == pytest.approx(2.4)


def test_a_corner_that_is_not_square():
    """Legs at 135°: beyond the second one is across it, on the side that the first points to."""
    after = np.array([-1.0, 1.0, 0.0])  # back at 45°
    aside = np.array([1.0, 1.0, 0.0]) / np.sqrt(2)
    way = [[-1, 0, 0], [0, 0, 0], 0.5 * after + 0.1 * aside, 0.8 * after - 0.3 * aside]
    found = iso9283.cornering((-1, 0, 0), (0, 0, 0), after, [way])
    assert found.overshoot == pytest.approx(0.1, rel=1e-12)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: iso9283.pose_accuracy(np.eye(3), [np.eye(4)]), "commanded has the shape"),
        (lambda: iso9283.pose_accuracy(np.eye(4), np.eye(4)), "attained has the shape"),
        (lambda: iso9283.pose_accuracy(np.eye(4), np.empty((0, 4, 4))), "attained has the shape"),
        (lambda: iso9283.path_accuracy([np.eye(4)], np.ones((2, 3, 4, 4))), r"must be \(n, 1"),
        (lambda: iso9283.from_logs([]), "logs is empty"),
        (lambda: iso9283.path_velocity(0.0, [[1.0]]), "commanded is 0"),
        (lambda: iso9283.path_velocity(1.0, []), "attained is empty"),
        (lambda: iso9283.path_velocity(1.0, [[]]), r"attained\[0\] has the shape"),
        (lambda: iso9283.cornering([0] * 3, [0] * 3, [1] * 3, [np.eye(3)]), "has no length"),
        (lambda: iso9283.cornering([0] * 3, [1] * 3, [2] * 3, [np.eye(3)]), "lie in one line"),
        (lambda: iso9283.cornering([0] * 3, [1] * 3, [2, 0, 0], []), "attained is empty"),
        (
            lambda: iso9283.cornering([0] * 3, [1] * 3, [2, 0, 0], [np.eye(2)]),
            r"attained\[0\] has the shape",
        ),
        (lambda: iso9283.from_logs([1]), r"logs\[0\] is 1"),
    ],
)
def test_what_does_not_fit_is_refused(call, says):
    with pytest.raises(errors.BadArgumentError, match=says):
        call()


@pytest.fixture(scope="module")
def log():
    """Two tool lines on an arm whose drives measured just what they were told."""
    robot = vp.load_robot("ur5e")
    home = np.radians([0, -90, 90, -90, -90, 0])
    there = robot.fk(home)
    program = vp.Program(robot, start=home)
    for y in (0.1, 0.05):
        target = there.copy()
        target[1, 3] += y
        program.movel(target, speed=0.5).wait(0.05)
    with vp.connect("sim://ur5e", start=home) as arm:
        log = arm.run(program).log
    return replace(log, measured=log.q)


def off_by(log, position):
    """Return the log of an arm that is off by `position` [m], nearly: by its Jacobian."""
    steps = [
        np.linalg.solve(log.robot.jacobian(q), np.append(position, np.zeros(3))) for q in log.q
    ]
    return replace(log, measured=log.q + np.array(steps))


def test_what_was_measured_as_told_is_exact(log):
    report = iso9283.from_logs([log, log, log], places=20)
    assert report.cycles == 3
    assert len(report.poses) == 2
    for found in report.poses:
        assert found.accuracy == 0.0
        assert found.repeatability == 0.0
    assert report.path.accuracy == pytest.approx(0.0, abs=1e-12)
    assert report.path.repeatability == pytest.approx(0.0, abs=1e-12)


def test_offsets_of_runs_are_found_at_every_stop_and_across_the_path(log):
    """The lines go along y: x = 1, 2, 3 is across them; y is along, and no plane sees it."""
    runs = [off_by(log, (1e-4 * k, 2e-4, 0)) for k in (1, 2, 3)]
    report = iso9283.from_logs(runs, places=20)
    expected = (2 / 3 + 3 * np.sqrt(1 / 3)) * 1e-4
    for found in report.poses:
        assert found.accuracy == pytest.approx(np.hypot(2e-4, 2e-4), rel=2e-3)
        assert found.repeatability == pytest.approx(expected, rel=2e-3)
    assert report.path.accuracy == pytest.approx(2e-4, rel=1e-2)
    assert report.path.repeatability == pytest.approx(expected, rel=1e-2)


def test_a_drive_that_is_late_stays_on_its_path(log):
    late = replace(log, measured=np.concatenate([log.q[:1]] * 5 + [log.q[:-5]]))
    report = iso9283.from_logs([late, log], places=20)
    assert report.path.accuracy < 1e-6
    assert report.path.repeatability < 1e-6


def test_the_speed_of_a_move_is_measured_on_its_middle_half():
    """Told 0.1 m/s along y, and kept there; an arm whose way is 1 % longer is 1 % quicker."""
    robot = vp.load_robot("ur5e")
    home = np.radians([0, -90, 90, -90, -90, 0])
    target = robot.fk(home)
    target[1, 3] += 0.1
    with vp.connect("sim://ur5e", start=home) as arm:
        log = arm.run(vp.Program(robot, start=home).movel(target, process_speed=0.1)).log
    log = replace(log, measured=log.q)
    found = iso9283.path_velocity_from_logs([log, log], 0.1, move=0)
    assert found.accuracy == pytest.approx(0.0, abs=1e-4)
    assert found.repeatability == 0.0
    assert found.fluctuation < 1e-5
    stretched = off_by_share(log, 0.01)
    found = iso9283.path_velocity_from_logs([stretched], 0.1, move=0)
    assert found.accuracy == pytest.approx(0.01, rel=1e-2)
    with pytest.raises(errors.BadArgumentError, match="nothing of move 77"):
        iso9283.path_velocity_from_logs([log], 0.1, move=77)
    with pytest.raises(errors.BadArgumentError, match="shorter `over`"):
        iso9283.path_velocity_from_logs([log], 0.1, move=0, over=100.0)


def off_by_share(log, share):
    """Return the log of an arm that goes farther along y by a share, nearly."""
    steps = []
    for q, pose in zip(log.q, log.samples.pose, strict=True):
        aside = np.array([0, share * (pose[1, 3] - log.samples.pose[0, 1, 3]), 0, 0, 0, 0])
        steps.append(np.linalg.solve(log.robot.jacobian(q), aside))
    return replace(log, measured=log.q + np.array(steps))


def test_a_blended_corner_is_cut_by_what_the_zone_says():
    robot = vp.load_robot("ur5e")
    home = np.radians([0, -90, 90, -90, -90, 0])
    corner, end = robot.fk(home), robot.fk(home)
    corner[1, 3] += 0.1
    end[:3, 3] += (0.1, 0.1, 0)
    program = vp.Program(robot, start=home).movel(corner, zone=vp.deviation(0.004)).movel(end)
    with vp.connect("sim://ur5e", start=home) as arm:
        log = arm.run(program).log
    places = robot.fk(home)[:3, 3], corner[:3, 3], end[:3, 3]
    found = iso9283.cornering_from_logs([replace(log, measured=log.q)], *places)
    assert 0.5e-3 < found.rounding <= 0.004 + 1e-6
    assert found.overshoot == pytest.approx(0.0, abs=1e-5)


def test_speeds_and_corners_of_a_program_are_found_in_its_logs():
    """Two legs of 150 mm with a rounded corner, an arc, and a move that is never steady."""
    robot = vp.load_robot("ur5e")
    home = np.radians([0, -90, 90, -90, -90, 0])
    there, back, over, down = (robot.fk(home) for _ in range(4))
    there[1, 3] += 0.15
    back[:2, 3] += (0.15, 0.15)
    over[:2, 3] += (0.19, 0.19)
    down[:2, 3] += (0.15, 0.23)
    program = vp.Program(robot, start=home).movel(there, speed=0.1, zone=vp.deviation(0.003))
    program.movel(back, speed=0.08).movec(over, down, speed=0.05).movej(home)
    with vp.connect("sim://ur5e", start=home) as arm:
        log = arm.run(program).log
    log = replace(log, measured=log.q)
    report = iso9283.from_logs([log, log])
    commanded = {move: found.commanded for move, found in report.speeds.items()}
    assert commanded == pytest.approx({0: 0.1, 1: 0.08, 2: 0.05}, rel=0.01)
    for found in report.speeds.values():
        assert found.accuracy == pytest.approx(0.0, abs=2e-3)
    (corner,) = report.corners
    assert corner.moves == (0, 1)
    np.testing.assert_allclose(corner.place, there[:3, 3], atol=1e-4)
    assert 1e-3 < corner.cornering.rounding <= 0.003 + 1e-4
    assert corner.cornering.overshoot < 1e-4
    slow = off_by_share(log, -0.05)  # along y alone
    report = iso9283.from_logs([slow])
    assert report.speeds[0].accuracy == pytest.approx(-0.05, rel=0.02)
    assert report.speeds[1].accuracy == pytest.approx(0.0, abs=3e-3)


def run_along(*stretches):
    """Return a run through the places of stretches (move, from, to, rows)."""
    places = np.vstack([np.linspace(begin, end, rows) for _, begin, end, rows in stretches])
    told = np.tile(np.eye(4), (len(places), 1, 1))
    told[:, :3, 3] = places
    steps = np.linalg.norm(np.diff(places, axis=0), axis=1)
    return Attained(
        name="logs[0]",
        told=told,
        reached=told,
        resting=np.zeros(len(places), dtype=bool),
        along=np.concatenate([[0.0], np.cumsum(steps)]),
        time=0.002 * np.arange(len(places)),
        move=np.repeat([move for move, *_ in stretches], [rows for *_, rows in stretches]),
        period=0.002,
    )


def test_lines_meet_in_a_corner_only_where_one_follows_the_other():
    """Between two lines at a right angle: nothing; a wait; a chamfer that is soon over."""
    corner = np.array([0.0, 0.1, 0.0])
    lines = [(0, [0, 0, 0], corner, 100), (3, corner, [0.1, 0.1, 0], 100)]
    wait = (2, corner, corner, 50)
    for run in (run_along(*lines), run_along(lines[0], wait, lines[1])):
        (found,) = iso9283._corners([run], legs_of(run))
        assert found.moves == (0, 3)
        np.testing.assert_allclose(found.place, corner, atol=1e-12)
    aside = np.array([0.003, 0.0, 0.0]), np.array([0.0, 0.003, 0.0])
    before, after = corner - aside[1], corner + aside[0]
    chamfered = run_along(
        (0, [0, 0, 0], before, 100), (2, before, after, 8), (3, after, [0.1, 0.1, 0], 100)
    )
    assert [leg.move for leg in legs_of(chamfered)] == [0, 3]
    assert list(iso9283._corners([chamfered], legs_of(chamfered))) == []


def test_a_slow_creep_is_no_rest_and_a_reversal_neither(log):
    """Rests are where the setpoint stands still for two cycles, whatever its velocity says."""
    from viapoint._attained import _rests

    cycle = np.arange(9)
    creep = np.arange(9.0)[:, None] * 2e-9
    assert not _rests(creep, cycle, at_rest=False).any()
    assert _rests(creep, cycle, at_rest=True).tolist() == [False] * 8 + [True]
    turn = np.array([0.0, 1, 2, 2, 1, 0, 0, 0, 1])[:, None]
    assert _rests(turn, cycle, at_rest=False).tolist() == [False] * 5 + [True] * 3 + [False]
    # A long rest of which the log keeps the first two cycles.
    kept = np.array([0.0, 1, 1, 2, 3])[:, None]
    assert not _rests(kept, np.array([0, 1, 2, 3, 4]), at_rest=False).any()
    kept = np.array([0.0, 1, 1, 1, 3])[:, None]
    assert _rests(kept, np.array([0, 1, 2, 30, 31]), at_rest=False).tolist() == [
        *(False, True, True, True, False)
    ]


def test_logs_of_another_program_are_refused(log):
    shorter = vp.Program(log.robot, start=log.q[0]).movel(log.samples.pose[-1]).plan()
    with vp.connect("sim://ur5e", start=log.q[0]) as arm:
        other = arm.run(shorter).log
    with pytest.raises(errors.BadArgumentError, match="must be of one program"):
        iso9283.from_logs([log, other])


def test_a_log_in_which_nothing_was_measured_is_refused(log):
    with pytest.raises(errors.BadArgumentError, match="nothing that a drive measured"):
        iso9283.from_logs([replace(log, measured=np.full_like(log.q, np.nan))])


def test_the_command_prints_the_figures_and_says_what_is_wrong(log, tmp_path):
    files = []
    for k in (1, 2, 3):
        files.append(str(tmp_path / f"{k}.npz"))
        off_by(log, (1e-4 * k, 2e-4, 0)).save(files[-1])
    done = CliRunner().invoke(cli.app, ["report", *files, "--places", "10"])
    assert done.exit_code == 0, done.output
    assert "3 cycles" in done.output
    assert "0.282" in done.output  # √(0.2² + 0.2²) mm, nearly
    assert "pose 2" in done.output
    assert "asks for 30" in done.output
    assert "of moves 0 and 1" not in done.output  # there and back in one line: no corner
    broken = CliRunner().invoke(cli.app, ["report", str(tmp_path / "none.npz")])
    assert broken.exit_code == 1
