"""One class a code, one tree, all attributes, and a way across processes."""

import json
import pickle

import pytest

import viapoint as vp
from viapoint import _core, errors


def test_every_code_of_the_core_has_one_class_of_its_own():
    classes = [errors.error_class(code) for code in _core.error_codes()]
    assert len(set(classes)) == len(classes)
    for code, cls in zip(_core.error_codes(), classes, strict=True):
        assert cls.code == code
        assert issubclass(cls, vp.MotionError)


def test_no_class_stands_for_a_code_the_core_does_not_know():
    for name in errors.__all__:
        cls = getattr(errors, name)
        if isinstance(cls, type) and issubclass(cls, vp.MotionError) and "code" in vars(cls):
            assert cls is vp.MotionError or cls.code in _core.error_codes(), name


def test_every_error_class_is_exported():
    for code in _core.error_codes():
        assert errors.error_class(code).__name__ in errors.__all__


@pytest.mark.parametrize(
    ("child", "parent"),
    [
        (errors.JointLimitError, errors.LimitError),
        (errors.SingularError, errors.PoseError),
        (errors.EmptyProgramError, errors.ProgramError),
        (errors.NotAtStartError, errors.RunError),
        (errors.BadArgumentError, ValueError),
        (errors.FileError, OSError),
    ],
)
def test_the_tree(child: type, parent: type):
    assert issubclass(child, parent)
    assert issubclass(child, vp.MotionError)


def test_an_error_carries_the_fields_of_its_problem():
    problem = _core.Problem(
        "joint_limit",
        "joint 4 leaves its limit",
        ways_out=["movej(...)", 'orientation="wrist"'],
        move=1,
        file="script.py",
        line=12,
        joint=3,
        time=0.5,
        share=0.74,
        value=2.5,
        limit=2.4,
    )
    error = errors.from_problem(problem)
    assert type(error) is errors.JointLimitError
    for field in ("code", *vars(error)):
        assert getattr(error, field) == getattr(problem, field), field
    assert str(error) == problem.describe()
    assert str(error).startswith("script.py:12: joint 4 leaves its limit")
    assert "way out: movej(...)" in str(error)


def test_fields_that_do_not_apply_are_none():
    error = errors.BusyError("busy")
    assert error.ways_out == []
    assert error.file == ""
    assert (error.move, error.line, error.joint) == (None, None, None)
    assert (error.time, error.share, error.value, error.limit) == (None, None, None, None)


@pytest.mark.parametrize("code", _core.error_codes())
def test_errors_survive_pickling(code: str):
    error = errors.error_class(code)("what", ways_out=["how"], line=3, value=1.5)
    again = pickle.loads(pickle.dumps(error))
    assert type(again) is type(error)
    assert str(again) == str(error)
    assert (again.line, again.value, again.ways_out) == (3, 1.5, ["how"])


def test_the_core_raises_the_class_of_the_code():
    with pytest.raises(errors.BadRobotError) as caught:
        _core.load_robot("no_such_robot")
    assert caught.value.code == "bad_robot"
    with pytest.raises(errors.FileError, match="no_such_folder"):
        _core.read_file("/no_such_folder/p.json")


def test_an_unknown_code_is_refused():
    with pytest.raises(errors.BadArgumentError, match="no error code"):
        _core.Problem("nonsense", "…")


def test_a_value_just_beyond_its_bound_does_not_look_like_it(puma, abc):
    with pytest.raises(errors.BadArgumentError, match=r"scale is 1\.0000001; .* at most 1"):
        vp.Program(puma, start=abc["A"], scale=1.0000001)
    with pytest.raises(errors.BadArgumentError, match=r"1\.0000001"):
        vp.simulate(
            vp.Program(puma, start=abc["A"]).movej(abc["B"]).plan(),
            [(0.0, "override", 1.0000001)],
        )


def test_a_program_file_with_a_start_for_another_arm_is_refused_by_its_name(puma, abc, tmp_path):
    path = tmp_path / "cell.json"
    vp.Program(puma, start=abc["A"]).movej(abc["B"]).save(path)
    content = json.loads(path.read_text(encoding="utf-8"))
    content["start"].append(0.0)
    path.write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(
        errors.BadProgramError, match=r"cell\.json: The start has 7 values"
    ) as caught:
        vp.Program.load(path)
    assert caught.value.ways_out


@pytest.mark.parametrize("wish", ["scale", "speed", "acceleration"])
def test_a_wish_that_would_take_for_ever_has_a_way_out(puma, abc, wish):
    report = vp.Program(puma, start=abc["A"]).movel(puma.fk(abc["B"]), **{wish: 1e-9}).check()
    problem = next(p for p in report if wish in p.message)
    assert "1e-09" in problem.message
    assert problem.ways_out


@pytest.mark.parametrize("path", [3, None, b"p.json", 1.5, ["p.json"]])
def test_what_is_no_name_of_a_file_is_refused_by_name(short, path):
    motion = short.plan()
    for use in (
        vp.Program.load,
        short.save,
        short.robot.save,
        motion.save,
        motion.plot,
        lambda given: vp.PointList(given, short.robot),
    ):
        with pytest.raises(errors.BadArgumentError, match="must be the name of a file"):
            use(path)
