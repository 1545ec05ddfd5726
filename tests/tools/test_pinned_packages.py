"""What ./tools/run installs is pinned, every package of it."""

from pathlib import Path

import pytest

from pinned_packages import pinned_packages

ROOT = Path(__file__).parents[2]


def test_every_requirement_of_the_project_is_pinned():
    names = {requirement.split("==")[0] for requirement in pinned_packages(ROOT / "pyproject.toml")}
    assert {"numpy", "pybind11", "pytest", "ruff", "clang-tidy"} <= names


def test_an_open_requirement_is_refused_by_name(tmp_path: Path):
    pyproject = tmp_path / "pyproject.toml"
    pyproject.write_text('[dependency-groups]\na = ["numpy==2.0", "rich>=13"]\n', encoding="utf-8")
    with pytest.raises(ValueError, match="'rich>=13' is not pinned"):
        pinned_packages(pyproject)
