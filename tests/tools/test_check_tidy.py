"""clang-tidy looks again at exactly the files whose answer may have changed."""

import json
from pathlib import Path

import pytest

from check_tidy import Source, fingerprint, project_headers, read_sources


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A checkout of one source, two headers it reads and one that it does not."""
    for name, text in {
        "cpp/src/core/a.cpp": '#include "viapoint/core/a.hpp"\n#include <vector>\n',
        "cpp/src/core/b.cpp": "int b;\n",
        "cpp/include/viapoint/core/a.hpp": '#include "viapoint/core/deep.hpp"\n',
        "cpp/include/viapoint/core/deep.hpp": '#include "viapoint/core/a.hpp"\n',
        "cpp/include/viapoint/core/other.hpp": "",
    }.items():
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return tmp_path


def print_of(checkout: Path, *, command: str = "g++ -c", settings: bytes = b"1") -> str:
    source = Source(checkout / "cpp/src/core/a.cpp", command)
    return fingerprint(source, settings, [checkout / "cpp/include"], checkout)


def test_headers_are_followed_through_cycles(checkout: Path):
    found = project_headers(checkout / "cpp/src/core/a.cpp", [checkout / "cpp/include"])
    assert {path.name for path in found} == {"a.cpp", "a.hpp", "deep.hpp"}


@pytest.mark.parametrize(
    "name", ["cpp/src/core/a.cpp", "cpp/include/viapoint/core/deep.hpp"], ids=["itself", "deep"]
)
def test_a_changed_file_that_is_read_changes_the_fingerprint(checkout: Path, name: str):
    before = print_of(checkout)
    (checkout / name).write_text('#include "viapoint/core/a.hpp"\nint x;\n', encoding="utf-8")
    assert print_of(checkout) != before


def test_a_changed_file_that_is_not_read_does_not(checkout: Path):
    before = print_of(checkout)
    (checkout / "cpp/include/viapoint/core/other.hpp").write_text("int y;\n", encoding="utf-8")
    (checkout / "cpp/src/core/b.cpp").write_text("int y;\n", encoding="utf-8")
    assert print_of(checkout) == before


def test_command_and_settings_count(checkout: Path):
    prints = {
        print_of(checkout),
        print_of(checkout, command="g++ -O1 -c"),
        print_of(checkout, settings=b"2"),
    }
    assert len(prints) == 3


def test_sources_outside_the_folders_are_left_alone(checkout: Path, tmp_path: Path):
    database = tmp_path / "compile_commands.json"
    entries = [
        {"directory": str(checkout), "file": "cpp/src/core/b.cpp", "command": "x"},
        {"directory": str(checkout), "file": "/usr/src/gtest.cc", "command": "x"},
    ]
    database.write_text(json.dumps(entries), encoding="utf-8")
    sources = read_sources(database, [checkout / "cpp"])
    assert [source.path.name for source in sources] == ["b.cpp"]
