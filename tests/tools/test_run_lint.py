"""A check that finds something fails the whole, and says which it was."""

import sys

import pytest

import run_lint


def fake(code: int, text: str):
    def check(*, fix: bool) -> list[list[str]]:
        """Do as told."""
        return [[sys.executable, "-c", f"import sys; print({text!r}); sys.exit({code})"]]

    return check


def test_one_finding_fails_the_lint_and_the_rest_still_runs(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    checks = {"first": fake(1, "a.cpp:3: wrong"), "second": fake(0, "7 files")}
    monkeypatch.setattr(run_lint, "CHECKS", checks)
    assert run_lint.main([]) == 1
    printed = capsys.readouterr().out
    assert "a.cpp:3: wrong" in printed
    assert "FAIL first" in printed
    assert "ok   second: Do as told. (7 files)" in printed
    assert run_lint.main(["second"]) == 0


def test_an_unknown_check_is_refused_with_those_there_are(capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit):
        run_lint.main(["spelling"])
    assert "no check spelling; there are layers, clang-format" in capsys.readouterr().err
