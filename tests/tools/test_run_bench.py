"""The tables of tools/bench show every figure that viapoint-bench prints, with its unit."""

from pathlib import Path

import pytest

import run_bench
from benches import core, tables

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


def test_an_unknown_subject_is_refused(capsys: pytest.CaptureFixture[str]):
    with pytest.raises(SystemExit):
        run_bench.main(["speed"])
    assert "no subject speed; there are tick, plan" in capsys.readouterr().err
