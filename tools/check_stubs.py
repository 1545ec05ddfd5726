"""Generate the type stubs of viapoint._core and compare them with the committed ones.

``--write`` replaces the committed ones instead.
"""

import argparse
import difflib
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "python" / "viapoint"
BIN = Path(sys.executable).parent


def generate(folder: Path) -> None:
    """Write the stubs of ``viapoint._core`` below ``folder``, formatted as they are committed.

    Raises
    ------
    RuntimeError
        The generator could not express a signature.
    """
    generator = [sys.executable, "-m", "pybind11_stubgen", "viapoint._core", "--exit-code"]
    generator += ["--numpy-array-remove-parameters", "-o", str(folder)]
    result = subprocess.run(generator, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise RuntimeError(result.stderr.strip() or result.stdout.strip())
    options = ["--config", str(ROOT / "pyproject.toml")]
    # The generator's output is not sorted; what it writes is laid out as our own files are.
    fixes = ["check", "--fix", "--quiet", "--select", "F401,I,UP", "--exit-zero"]
    for command in (fixes, ["format", "--quiet"]):
        subprocess.run([BIN / "ruff", *command, *options, folder], check=True)


def stubs_below(folder: Path) -> dict[str, str]:
    """Return the text of the ``_core`` stubs by their path below ``folder``."""
    paths = [*folder.glob("_core.pyi"), *folder.glob("_core/**/*.pyi")]
    return {str(p.relative_to(folder)): p.read_text(encoding="utf-8") for p in paths}


def difference(committed: dict[str, str], generated: dict[str, str]) -> str:
    """Return a unified diff from the committed stubs to the generated ones."""
    lines: list[str] = []
    for name in sorted(committed.keys() | generated.keys()):
        old, new = committed.get(name, ""), generated.get(name, "")
        names = (f"committed/{name}", f"generated/{name}")
        lines += difflib.unified_diff(old.splitlines(), new.splitlines(), *names, lineterm="", n=1)
    return "\n".join(lines)


def main(arguments: list[str]) -> int:
    """Compare, or write; 1 when the committed stubs are not what the extension has."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help="replace the committed stubs")
    options = parser.parse_args(arguments)
    with tempfile.TemporaryDirectory() as temporary:
        try:
            generate(Path(temporary))
        except RuntimeError as error:
            print(f"the stubs cannot be generated:\n{error}", file=sys.stderr)
            return 1
        fresh = Path(temporary) / "viapoint"
        generated = stubs_below(fresh)
        if options.write:
            shutil.rmtree(PACKAGE / "_core", ignore_errors=True)
            (PACKAGE / "_core.pyi").unlink(missing_ok=True)
            for name in generated:
                (PACKAGE / name).parent.mkdir(exist_ok=True)
                shutil.copyfile(fresh / name, PACKAGE / name)
            return 0
    changes = difference(stubs_below(PACKAGE), generated)
    if changes:
        print(changes)
        print("the committed stubs are stale: run ./tools/lint --fix stubs", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
