"""Accuracy and repeatability against sets worked out by hand, and from logs of runs."""

from dataclasses import replace

import numpy as np
import pytest
from typer.testing import CliRunner

import viapoint as vp
from viapoint import cli, errors, iso9283
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


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: iso9283.pose_accuracy(np.eye(3), [np.eye(4)]), "commanded has the shape"),
        (lambda: iso9283.pose_accuracy(np.eye(4), np.eye(4)), "attained has the shape"),
        (lambda: iso9283.pose_accuracy(np.eye(4), np.empty((0, 4, 4))), "attained has the shape"),
        (lambda: iso9283.path_accuracy([np.eye(4)], np.ones((2, 3, 4, 4))), r"must be \(n, 1"),
        (lambda: iso9283.from_logs([]), "logs is empty"),
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
    broken = CliRunner().invoke(cli.app, ["report", str(tmp_path / "none.npz")])
    assert broken.exit_code == 1
