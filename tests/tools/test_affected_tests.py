"""Tests are left out only when they passed on the very same files."""

from pathlib import Path

import pytest

import run_tests
from affected_tests import Passed, digest, executables
from run_tests import Counts


@pytest.fixture
def program(tmp_path: Path) -> Path:
    path = tmp_path / "tree" / "tests" / "cpp" / "core" / "test_core"
    path.parent.mkdir(parents=True)
    path.write_bytes(b"first")
    return path


def test_what_never_passed_does_not_hold(tmp_path: Path, program: Path):
    assert not Passed(tmp_path / "passed.json").holds("core", [program])


def test_a_pass_is_remembered_until_the_file_changes(tmp_path: Path, program: Path):
    Passed(tmp_path / "passed.json").record("core", [program])
    again = Passed(tmp_path / "passed.json")
    assert again.holds("core", [program])
    program.write_bytes(b"second")
    assert not again.holds("core", [program])


def test_a_renamed_file_is_a_change(tmp_path: Path, program: Path):
    before = digest([program])
    assert digest([program.rename(program.with_name("test_path"))]) != before


def test_executables_are_found_by_their_label_and_nothing_else(tmp_path: Path, program: Path):
    (program.parent / "test_core[1]_include.cmake").write_text("", encoding="utf-8")
    assert executables(tmp_path / "tree") == {"core": program}


def test_only_a_whole_pass_is_remembered(
    tmp_path: Path, program: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(run_tests, "ROOT", tmp_path)
    (tmp_path / run_tests.REPORTS).mkdir(parents=True)
    passed = Passed(tmp_path / "passed.json")
    commands: list[list[str]] = []
    ends = iter([Counts(1, 1), Counts(2, 0), Counts(3, 0), Counts(0, 0)])

    def runner(title: str, command: list[str], report: Path, environment: dict[str, str]) -> Counts:
        commands.append(command)
        return next(ends)

    monkeypatch.setattr(run_tests, "run", runner)
    run_tests.run_googletest(run_tests.parse(["--tree", "tree"]), passed)
    assert not passed.holds("core", [program])
    run_tests.run_googletest(run_tests.parse(["--tree", "tree", "-k", "Some"]), passed)
    assert not passed.holds("core", [program])
    run_tests.run_googletest(run_tests.parse(["--tree", "tree"]), passed)
    assert passed.holds("core", [program])
    run_tests.run_googletest(run_tests.parse(["--tree", "tree", "--affected"]), passed)
    assert commands[-1][-2:] == ["-LE", "^(core)$"]
