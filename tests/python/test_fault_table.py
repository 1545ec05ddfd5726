"""Every row of the table of faults names tests that there are."""

import re
from pathlib import Path

ROOT = Path(__file__).parents[2]


def named_tests() -> list[list[str]]:
    """Return the tests of each row."""
    text = (ROOT / "docs" / "faults.md").read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith("| ")][1:]
    return [re.findall(r"`([\w.]+)`", row.rstrip("|").rsplit("|", 1)[1]) for row in rows]


def test_every_row_names_tests_that_there_are() -> None:
    python = "\n".join(
        path.read_text(encoding="utf-8") for path in (ROOT / "tests" / "python").glob("test_*.py")
    )
    cpp = "\n".join(
        path.read_text(encoding="utf-8") for path in (ROOT / "tests" / "cpp").rglob("*_test.cpp")
    )
    rows = named_tests()
    assert len(rows) >= 9
    for names in rows:
        assert names
        for name in names:
            if "." in name:
                suite, test = name.split(".")
                assert re.search(rf"TEST(_F)?\({suite},\s*{test}\)", cpp), name
            else:
                assert f"def {name}(" in python, name
