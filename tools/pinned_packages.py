"""Print the pinned Python packages of pyproject.toml, one a line.

Debian 12's pip (23.0) does not know dependency groups, so this reads them for it.
"""

import tomllib
from pathlib import Path


def pinned_packages(pyproject: Path) -> list[str]:
    """Return every requirement of every dependency group, in file order.

    Raises
    ------
    ValueError
        A requirement is not pinned with ``==``.
    """
    groups = tomllib.loads(pyproject.read_text(encoding="utf-8"))["dependency-groups"]
    requirements = [requirement for group in groups.values() for requirement in group]
    for requirement in requirements:
        if "==" not in requirement:
            raise ValueError(f"{pyproject}: {requirement!r} is not pinned (write name==version)")
    return requirements


if __name__ == "__main__":
    print("\n".join(pinned_packages(Path(__file__).parents[1] / "pyproject.toml")))
