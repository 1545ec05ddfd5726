"""Remember what tests have passed on, so that an edit need only run those it can have changed."""

import hashlib
import json
from collections.abc import Iterable
from pathlib import Path


def digest(files: Iterable[Path]) -> str:
    """Hash the names and contents of files, whatever order they come in."""
    total = hashlib.sha256()
    for file in sorted(files):
        total.update(str(file).encode() + b"\0" + hashlib.sha256(file.read_bytes()).digest())
    return total.hexdigest()


def executables(tree: Path) -> dict[str, Path]:
    """Return the GoogleTest executables of a build tree by their ctest label."""
    found = (path for path in (tree / "tests").rglob("test_*") if path.is_file())
    return {path.name.removeprefix("test_"): path for path in found if path.suffix == ""}


def test_data(root: Path) -> list[Path]:
    """Return what GoogleTest reads at run time: golden values and robots."""
    folders = ("tests/data", "python/viapoint/robots")
    return [path for folder in folders for path in (root / folder).rglob("*") if path.is_file()]


def python_files(root: Path) -> list[Path]:
    """Return what the Python tests read, apart from the extension: code, robots, documents."""
    folders = ("python", "tests/python", "tests/tools", "tests/data", "tools", "docs")
    files = [path for folder in folders for path in (root / folder).rglob("*") if path.is_file()]
    files += [root / "pyproject.toml", *root.glob("*.md")]
    return [path for path in files if "__pycache__" not in path.parts]


class Passed:
    """What the tests last passed on, by name; kept in a file of the build folder."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._digests: dict[str, str] = {}
        if file.exists():
            self._digests = json.loads(file.read_text(encoding="utf-8"))

    def holds(self, name: str, files: Iterable[Path]) -> bool:
        """Tell whether the tests called ``name`` have passed on these very files."""
        return self._digests.get(name) == digest(files)

    def record(self, name: str, files: Iterable[Path]) -> None:
        """Remember that they have now."""
        self._digests[name] = digest(files)
        self._file.write_text(json.dumps(self._digests, indent=1) + "\n", encoding="utf-8")
