"""The tables of tools/bench show every figure that viapoint-bench prints, with its unit."""

from pathlib import Path

import pytest

import run_bench
from benches import core, documents, profiles, tables

LINES = (
    '{"bench": "tick", "case": "full_speed", "ticks": 1000000, "p50_us": 0.51234, "checksum": 3}\n'
    '{"bench": "tick", "case": "pause", "ticks": 7, "p50_us": 12.0, "checksum": 4}\n'
)


def test_a_table_has_a_line_a_case_and_the_units_in_its_head():
    head, rule, first, second = tables.table(core.read_lines(LINES)).splitlines()
    assert head.split() == ["case", "ticks", "p50", "us"]
    assert set(rule) == {"-", " "}
    assert first.split() == ["full_speed", "1000000", "0.5123"]
    assert second.split() == ["pause", "7", "12"]


def test_a_table_for_a_document_is_markdown():
    head, rule, first, _ = tables.markdown(core.read_lines(LINES)).splitlines()
    assert head == "| case | ticks | p50 us |"
    assert rule == "| --- | --: | --: |"
    assert first == "| full_speed | 1000000 | 0.5123 |"


@pytest.mark.parametrize("line", ["not json", "[1, 2]", '{"case": "x"}'])
def test_output_that_is_no_figure_is_refused(line: str):
    with pytest.raises(ValueError, match="no object with bench and case"):
        core.read_lines(line)


def test_the_figures_are_written_with_the_machine_they_are_of(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    program = tmp_path / "viapoint-bench"
    program.write_text(f"#!/bin/sh\ncat <<'E'\n{LINES}E\n", encoding="utf-8")
    program.chmod(0o755)
    monkeypatch.setattr(run_bench, "machine", lambda: {"processor": "abacus"})
    figures = tmp_path / "figures.json"
    assert run_bench.main(["tick", "--program", str(program), "--json", str(figures)]) == 0
    assert "abacus" in capsys.readouterr().out
    text = figures.read_text(encoding="utf-8")
    assert '"abacus"' in text
    assert '"p50_us": 0.51234' in text


@pytest.mark.parametrize(("share", "failed"), [("1.000002", 1), ("1.0000001", 0)])
def test_a_motion_beyond_a_limit_fails_the_run_and_is_shown(
    share: str,
    failed: int,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
):
    program = tmp_path / "viapoint-bench"
    line = f'{{"bench": "walk", "case": "long", "worst_share": {share}}}'
    program.write_text(f"#!/bin/sh\necho '{line}'\n", encoding="utf-8")
    program.chmod(0o755)
    monkeypatch.setattr(run_bench, "machine", dict)
    assert run_bench.main(["walk", "--program", str(program)]) == failed
    above = capsys.readouterr().out.splitlines()[-1].split()[-1]
    assert float(above) == pytest.approx(float(share) - 1.0, rel=1e-3)


def test_an_unknown_subject_is_refused(capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit):
        run_bench.main(["speed"])
    assert "no subject speed; there are tick, commands, plan" in capsys.readouterr().err


@pytest.mark.parametrize(
    "arguments", [["tick", "--problems", "5"], ["profiles", "--problems", "0"]]
)
def test_a_number_of_problems_goes_with_profiles_alone(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
):
    with pytest.raises(SystemExit):
        run_bench.main(arguments)
    assert "--problems goes with profiles or programs alone" in capsys.readouterr().err


def test_the_run_by_the_million_passes_failures_on_and_lays_its_figures_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    program = tmp_path / "viapoint-profile-bench"
    line = '{"bench": "profiles", "case": "verified", "problems": 12, "failures": 1}'
    program.write_text(
        f"#!/bin/sh\necho 'failed: seed 3: line'\necho '{line}'\nexit 1\n", encoding="utf-8"
    )
    program.chmod(0o755)
    monkeypatch.setattr(run_bench, "machine", dict)
    folder = str(tmp_path / "viapoint-bench")
    assert run_bench.main(["profiles", "--problems", "12", "--program", folder]) == 1
    shown = capsys.readouterr().out
    assert "failed: seed 3: line" in shown
    assert ["failures", "1"] in [line.split() for line in shown.splitlines()]


def test_the_same_index_gives_the_same_problem_and_its_end_is_within_its_limits():
    for index in range(50):
        rows = profiles.problem("any state", 3, index)
        assert (rows == profiles.problem("any state", 3, index)).all()
        assert (abs(rows[:, 4]) <= rows[:, 7]).all()
        assert (abs(rows[:, 5]) <= rows[:, 9]).all()


def test_documents_get_the_tables_they_ask_for(tmp_path: Path) -> None:
    document = tmp_path / "figures.md"
    document.write_text(
        "Before.\n\n<!-- bench: machine -->\n<!-- /bench -->\n\n<!-- bench: tick -->\nold\n"
        "<!-- /bench -->\n\n<!-- bench: plan -->\nkept\n<!-- /bench -->\nAfter.\n"
    )
    other = tmp_path / "other.md"
    other.write_text("No figures here.\n")
    rows = core.read_lines(LINES)
    about = {"processor": "abacus"}
    assert documents.write(about, rows, (document, other)) == [document]
    text = document.read_text()
    assert "Measured on: processor abacus.\n" in text
    assert "| full_speed | 1000000 | 0.5123 |" in text
    assert "old" not in text
    assert "<!-- bench: plan -->\nkept\n<!-- /bench -->\nAfter.\n" in text
    assert documents.write(about, rows, (document, other)) == []
