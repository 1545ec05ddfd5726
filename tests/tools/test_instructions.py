"""The instructions of ticks as callgrind dumps them."""

from pathlib import Path

from benches import instructions


def test_each_dump_is_a_tick_and_empty_ones_are_none(tmp_path: Path):
    for number, total in enumerate([300, 100, 0, 200]):
        text = f"# callgrind format\nevents: Ir\nsummary: {total}\n\ntotals: {total}\n"
        (tmp_path / f"ticks.{number}").write_text(text, encoding="utf-8")
    assert instructions.totals(tmp_path) == [100, 200, 300]


def test_a_program_without_ticks_gives_no_figures():
    assert instructions.measure(Path("/bin/true")) == []
