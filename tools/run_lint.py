"""Run the checks that need no test: layout, layering, types, stubs and clang-tidy."""

import argparse
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

ROOT = Path(__file__).parents[1]
BIN = Path(sys.executable).parent
PYTHON_FOLDERS = ["python", "tools", "tests"]


def tracked(*patterns: str) -> list[str]:
    """Return the files of the checkout that match, whether committed yet or not."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *patterns]
    names = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    return [name for name in names.splitlines() if (ROOT / name).exists()]


def clang_format(*, fix: bool) -> list[list[str]]:
    """Hold C++ to the layout of .clang-format."""
    how = ["-i"] if fix else ["--dry-run", "--Werror"]
    return [[str(BIN / "clang-format"), *how, *tracked("*.hpp", "*.cpp")]]


def layers(*, fix: bool) -> list[list[str]]:
    """Hold includes and links against the layering table."""
    del fix
    return [[sys.executable, "tools/check_layers.py"]]


def ruff(*, fix: bool) -> list[list[str]]:
    """Hold Python to the rules and the layout of pyproject.toml."""
    check = ["check", "--quiet", *(["--fix"] if fix else [])]
    layout = ["format", "--quiet", *([] if fix else ["--diff"])]
    return [[str(BIN / "ruff"), *how, *PYTHON_FOLDERS] for how in (check, layout)]


def mypy(*, fix: bool) -> list[list[str]]:
    """Check the types of the package and the tools."""
    del fix
    command = [sys.executable, "-m", "mypy", "--no-error-summary", "python/viapoint"]
    return [[*command, *tracked("tools/*.py")]]


def stubs(*, fix: bool) -> list[list[str]]:
    """Compare the committed stubs with the extension."""
    return [[sys.executable, "tools/check_stubs.py", *(["--write"] if fix else [])]]


def shell(*, fix: bool) -> list[list[str]]:
    """Parse the shell scripts."""
    del fix
    scripts = [
        name
        for name in [*tracked("tools/*"), ".ci/run"]
        if (ROOT / name).read_bytes().startswith(b"#!/usr/bin/env bash") or name.endswith(".sh")
    ]
    return [["bash", "-n", script] for script in scripts]


def clang_tidy(*, fix: bool) -> list[list[str]]:
    """Hold C++ to the checks of .clang-tidy."""
    del fix
    return [[sys.executable, "tools/check_tidy.py"]]


CHECKS: dict[str, Callable[..., list[list[str]]]] = {
    "layers": layers,
    "clang-format": clang_format,
    "shell": shell,
    "ruff": ruff,
    "mypy": mypy,
    "stubs": stubs,
    "clang-tidy": clang_tidy,
}


def passes(name: str, *, fix: bool) -> bool:
    """Run one check, print its findings and one line about it."""
    start = time.monotonic()
    good = True
    last = ""
    for command in CHECKS[name](fix=fix):
        result = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
        if result.returncode == 0:
            last = result.stdout.strip().rpartition("\n")[2]
        else:
            good = False
            print(result.stdout + result.stderr, end="", flush=True)
    note = f" ({last})" if last and good else ""
    print(f"{'ok  ' if good else 'FAIL'} {name}: {CHECKS[name].__doc__}{note}", end=" ")
    print(f"{time.monotonic() - start:.1f} s", flush=True)
    return good


def main(arguments: list[str]) -> int:
    """Run the checks asked for, all by default; 1 when one finds something."""
    parser = argparse.ArgumentParser(prog="./tools/lint", description=__doc__)
    parser.add_argument("checks", nargs="*", metavar="CHECK", help=", ".join(CHECKS))
    parser.add_argument("--fix", action="store_true", help="mend what can be mended by itself")
    options = parser.parse_args(arguments)
    if unknown := [name for name in options.checks if name not in CHECKS]:
        parser.error(f"no check {', '.join(unknown)}; there are {', '.join(CHECKS)}")
    results = [passes(name, fix=options.fix) for name in options.checks or CHECKS]
    return 0 if all(results) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
