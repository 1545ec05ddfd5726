"""Programs: checked with the script's own lines, planned, kept in files."""

import inspect

import numpy as np
import pytest

import viapoint as vp
from viapoint import deg, errors, mm


def line() -> int:
    """Line of the caller."""
    return inspect.currentframe().f_back.f_lineno


def test_an_empty_program_is_refused(puma, abc):
    program = vp.Program(puma, start=abc["A"])
    assert [p.code for p in program.check().errors] == ["empty_program"]
    with pytest.raises(errors.EmptyProgramError):
        program.plan()


def test_the_textbooks_cartesian_leg_is_found_to_break_joint_4(puma, abc):
    """Textbook §3: with the least rotation joint 4 passes 140° at 74 % of B→C."""
    program = vp.Program(puma, start=abc["A"])
    program.movel(puma.fk(abc["B"]))
    program.movel(puma.fk(abc["C"]))
    here = line() - 1
    report = program.check()
    assert not report.ok
    (problem,) = report.errors
    assert problem.code == "joint_limit"
    assert problem.joint == 3
    assert problem.move == 1
    assert problem.share == pytest.approx(0.74, abs=0.01)
    assert problem.limit == pytest.approx(140 * deg)
    assert problem.value / deg == pytest.approx(195, abs=1)
    assert (problem.file, problem.line) == (__file__, here)
    ways = " ".join(problem.ways_out)
    assert "movej" in ways
    assert 'orientation="wrist"' in ways
    with pytest.raises(errors.JointLimitError) as caught:
        program.plan()
    assert (caught.value.joint, caught.value.line) == (3, here)


def test_the_way_out_reaches_the_printed_joints_of_c(puma, abc):
    program = vp.Program(puma, start=abc["A"])
    program.movel(puma.fk(abc["B"]), orientation="wrist", zone=50 * mm)
    program.movel(puma.fk(abc["C"]), orientation="wrist")
    motion = program.plan()
    np.testing.assert_allclose(motion.end, abc["C"], atol=1e-8)
    assert motion.certificate.holds
    assert motion.certificate.path_deviation <= 5e-5
    assert (motion.certificate.zone_deviation > 0) == (not motion.corners[0].stopped)


def test_all_problems_come_at_once_each_with_its_line(puma, abc):
    program = vp.Program(puma, start=abc["A"])
    program.movej([9.0, 0, 0, 0, 0, 0])
    first = line() - 1
    program.movej(position=[5.0, 0.0, 0.0])
    program.movej(abc["B"])
    program.movel(position=[0.0, 0.0, 9.0])
    last = line() - 1
    report = program.check()
    assert [p.line for p in report.errors] == [first, first + 2, last]
    assert [p.code for p in report.errors] == ["joint_limit", "unreachable", "unreachable"]
    assert all(p.file == __file__ for p in report)


def test_a_chain_over_lines_names_the_line_of_each_call(puma, abc):
    program = vp.Program(puma, start=abc["A"])
    start = line()
    (
        program
        .movej(abc["B"])
        .movej([9.0, 0, 0, 0, 0, 0])
    )  # fmt: skip
    (problem,) = program.check().errors
    assert problem.line == start + 4


def test_a_rounded_pose_is_projected_with_a_warning(puma, abc, golden):
    program = vp.Program(puma, start=abc["A"])
    program.movej(golden["puma560"]["poses_m"]["B"])
    report = program.check()
    assert report.ok
    (warning,) = report.warnings
    assert warning.code == "pose_corrected"
    assert warning.line == line() - 5
    assert 0 < warning.value < 0.02
    assert [p.code for p in program.plan().report] == ["pose_corrected"]


def test_a_pose_from_forward_kinematics_is_no_correction(puma, abc):
    assert len(vp.Program(puma, start=abc["A"]).movej(puma.fk(abc["B"])).check()) == 0


def test_a_zone_larger_than_its_legs_is_shrunk_and_said(puma, abc):
    program = vp.Program(puma, start=abc["A"])
    program.movej(abc["A"] + 0.1, zone=2.0).movej(abc["A"] + [0.2, 0, 0.2, 0.1, 0, 0])
    motion = program.plan()
    assert {p.code for p in motion.report} <= {"zone_shrunk", "zone_is_stop"}
    assert motion.report.ok
    assert len(motion.report.warnings) == 1
    assert motion.corners[0].reason


def test_a_program_that_goes_home_from_there_rests_and_says_so(puma, abc):
    program = vp.Program(puma, start=abc["A"]).movej(abc["A"])
    report = program.check()
    assert [p.code for p in report] == ["zero_length"]
    assert report.ok
    motion = program.plan()
    assert motion.duration == 0.002
    np.testing.assert_array_equal(motion.sample(0.001).q, np.tile(abc["A"], (3, 1)))
    with vp.connect("sim://puma560", start=abc["A"]) as arm:
        assert arm.run(program).state == "finished"
        np.testing.assert_array_equal(arm.setpoint, abc["A"])


def test_a_move_to_where_the_arm_is_among_others_is_a_warning(puma, abc):
    motion = vp.Program(puma, start=abc["A"]).movej(abc["A"]).movej(abc["B"]).plan()
    assert [p.code for p in motion.report] == ["zero_length"]
    np.testing.assert_allclose(motion.end, abc["B"], atol=1e-12)


def test_opposite_orientations_have_no_least_rotation(puma, abc):
    pose = puma.fk(abc["A"])
    pose[:3, :3] = pose[:3, :3] @ np.diag([1.0, -1.0, -1.0])
    pose[:3, 3] += [0.05, 0.0, 0.05]
    report = vp.Program(puma, start=abc["A"]).movel(pose).check()
    assert [p.code for p in report.errors] == ["half_turn"]
    assert report.errors[0].ways_out


def test_a_report_says_everything_as_text(puma, abc):
    report = vp.Program(puma, start=abc["A"]).movej([9.0, 0, 0, 0, 0, 0]).check()
    text = str(report)
    assert text.startswith("1 error, 0 warnings")
    assert "joint_limit" in text
    assert __file__ in text
    assert "way out" in text
    assert str(vp.Program(puma, start=abc["A"]).movej(abc["B"]).check()) == "nothing is wrong"


def test_a_report_prints_through_rich(puma, abc):
    from rich.console import Console

    console = Console(width=200, record=True)
    with console.capture() as captured:
        console.print(vp.Program(puma, start=abc["A"]).movej([9.0, 0, 0, 0, 0, 0]).check())
    assert "joint_limit" in captured.get()


def test_speed_bounds_the_tool(puma, abc):
    target = puma.fk(abc["A"])
    target[:3, 3] += [0.1, 0.05, 0.1]
    motion = vp.Program(puma, start=abc["A"], speed=0.1).movel(target).plan()
    speed = np.linalg.norm(motion.sample(0.001).twist[:, :3], axis=1)
    assert 0.099 < speed.max() <= 0.1 * (1 + 1e-9)


def test_scale_slows_every_limit(puma, abc):
    fast = vp.Program(puma, start=abc["A"]).movej(abc["B"]).plan()
    slow = vp.Program(puma, start=abc["A"]).movej(abc["B"], scale=0.5).plan()
    assert slow.certificate.velocity_share.max() == pytest.approx(0.5, rel=1e-6)
    assert slow.duration > 1.5 * fast.duration


def test_a_program_reads_back_to_the_same_motion(puma, abc, tmp_path):
    program = vp.Program(puma, start=abc["A"], name="round trip")
    program.movej(abc["B"], zone=vp.joint_deviation(0.02)).set_do(2, True).movej(abc["C"]).wait(0.1)
    path = tmp_path / "round_trip.json"
    program.save(path)
    again = vp.Program.load(path)
    assert again.name == "round_trip"
    first, second = program.plan().sample(0.002), again.plan().sample(0.002)
    for name in ("t", "q", "qd", "qdd", "qddd", "move"):
        np.testing.assert_array_equal(getattr(first, name), getattr(second, name))


def test_a_program_of_another_robot_is_refused(puma, abc, short, tmp_path):
    path = tmp_path / "p.json"
    short.save(path)
    with pytest.raises(errors.BadProgramError, match="fingerprint"):
        vp.Program.load(path, vp.load_robot("ur5e"))
    with pytest.raises(errors.BadProgramError, match="fingerprint"):
        vp.Program.load(path, puma.with_limits(velocity=1.0))


@pytest.mark.parametrize("keep", [0, 1, 40, 0.5, -3])
def test_a_truncated_program_is_refused_by_name(short, tmp_path, keep):
    path = tmp_path / "p.json"
    short.save(path)
    text = path.read_text(encoding="utf-8")
    path.write_text(text[: int(len(text) * keep) if 0 < keep < 1 else keep], encoding="utf-8")
    with pytest.raises(errors.BadProgramError) as caught:
        vp.Program.load(path)
    assert str(path) in str(caught.value)


def test_a_missing_program_is_a_file_error(tmp_path):
    with pytest.raises(errors.FileError, match=r"none\.json"):
        vp.Program.load(tmp_path / "none.json")


def test_a_program_that_cannot_be_written_says_why(short, tmp_path):
    with pytest.raises(errors.FileError, match="no_such_folder"):
        short.save(tmp_path / "no_such_folder" / "p.json")


class TestTimed:
    """Textbook §3: the classic timing."""

    @pytest.fixture
    def joint(self, puma, abc):
        points = [(abc["A"], 0.0), (abc["B"], 0.5), (abc["C"], 0.5)]
        return vp.Program(puma, start=abc["A"]).timed(points, t_acc=0.2, space="joint")

    def test_the_joint_move_is_the_golden_one(self, joint, golden):
        samples = joint.plan().sample(0.002)
        assert len(samples) == golden["puma560"]["timing_s"]["samples"] == 501
        for row in golden["puma560"]["joint_move_deg"]:
            k = round((row["t"] + 0.5) / 0.002)
            np.testing.assert_allclose(np.degrees(samples.q[k]), row["q"], atol=1e-6)
            np.testing.assert_allclose(np.degrees(samples.qd[k]), row["qd"], atol=1e-6)

    def test_the_cartesian_move_is_the_golden_one(self, puma, abc, golden):
        points = [(puma.fk(abc[key]), 0.0 if key == "A" else 0.5) for key in "ABC"]
        program = vp.Program(puma, start=abc["A"]).timed(points, space="cartesian")
        samples = program.plan().sample(0.002)
        assert len(samples) == 501
        for row in golden["puma560"]["cartesian_move"]:
            pose = samples.pose[round((row["t"] + 0.5) / 0.002)]
            np.testing.assert_allclose(pose, row["pose"], atol=2e-4)

    def test_every_broken_limit_is_in_its_report(self, joint):
        report = joint.plan().report
        codes = {problem.code for problem in report.errors}
        assert {"not_at_rest", "velocity_limit"} <= codes
        assert 5 in {p.joint for p in report.errors if p.code == "velocity_limit"}

    def test_a_drive_refuses_it(self, joint):
        with (
            vp.connect("sim://puma560", start=joint.start) as arm,
            pytest.raises(errors.NotAtRestError),
        ):
            arm.run(joint)

    def test_it_stands_alone(self, joint, abc):
        report = joint.movej(abc["A"]).check()
        assert not report.ok
