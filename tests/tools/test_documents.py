"""The documents tell the truth: scripts run, links lead somewhere, lists are whole."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
DOCUMENTS = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]
SCRIPT = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)
RUN_ELSEWHERE = {
    "gallery.md",  # test_gallery.py: many blocks, one process
    "controller.md",  # test_remote.py, test_remote_tls.py: each beside a controller
}
LINK = re.compile(r"\]\((?!https?:)([^)#\s]+)(?:#[^)]*)?\)")


def scripts() -> list[tuple[str, str]]:
    return [
        (f"{document.relative_to(ROOT)}:{text[: match.start()].count(chr(10)) + 1}", match.group(1))
        for document in DOCUMENTS
        if document.name not in RUN_ELSEWHERE
        for text in [document.read_text(encoding="utf-8")]
        for match in SCRIPT.finditer(text)
    ]


@pytest.mark.parametrize("script", [s for _, s in scripts()], ids=[name for name, _ in scripts()])
def test_a_script_of_the_documents_runs(script: str, tmp_path: Path):
    result = subprocess.run(
        [sys.executable, "-W", "error", "-c", script],
        cwd=tmp_path,
        env=os.environ | {"MPLBACKEND": "Agg"},
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert result.returncode == 0, result.stderr


def test_there_are_scripts_to_run():
    assert any(name.startswith("README.md") for name, _ in scripts())


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_links_lead_to_files(document: Path):
    text = document.read_text(encoding="utf-8")
    missing = [link for link in LINK.findall(text) if not (document.parent / link).exists()]
    assert missing == []


def test_every_error_code_is_in_the_table_and_no_other():
    header = (ROOT / "cpp/src/core/error.cpp").read_text(encoding="utf-8")
    codes = set(re.findall(r'Name\{ErrorCode::k\w+, "(\w+)"\}', header))
    table = (ROOT / "docs/errors.md").read_text(encoding="utf-8")
    assert set(re.findall(r"^\| `(\w+)` \| `\w+Error` \|", table, re.MULTILINE)) == codes


def test_every_tool_is_in_the_daily_commands():
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    tools = [
        path.name
        for path in (ROOT / "tools").iterdir()
        if path.is_file() and os.access(path, os.X_OK)
    ]
    assert tools != []
    assert [tool for tool in tools if f"./tools/{tool}" not in text] == []


def test_the_drive_of_the_documents_is_the_one_that_is_tested():
    page = (ROOT / "docs/drives.md").read_text(encoding="utf-8")
    tested = (ROOT / "tests/cpp/drives/cia402_drive.hpp").read_text(encoding="utf-8")
    shown = tested.split("// [docs/drives.md]\n")[1]
    assert f"```cpp\n{shown}```" in page
