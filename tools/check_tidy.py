"""Run clang-tidy over the C++ sources, each file again only when something it reads changed.

A file that passed is remembered in ``build/tidy`` under a hash of itself, every header of the
project that it includes, its compile command, ``.clang-tidy`` and clang-tidy's version.
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from check_layers import includes_of

ROOT = Path(__file__).parents[1]
CLANG_TIDY = str(Path(sys.executable).with_name("clang-tidy"))
# The compile commands carry gcc's options and -Werror: clang's own opinion of them is not asked.
EXTRA = ["--extra-arg=-Wno-unknown-warning-option", "--extra-arg=-Wno-error"]


@dataclass(frozen=True)
class Source:
    """A file to check and the command that compiles it."""

    path: Path
    command: str


def read_sources(compile_commands: Path, folders: list[Path]) -> list[Source]:
    """Return the project's sources of a compilation database that lie in ``folders``."""
    entries = json.loads(compile_commands.read_text(encoding="utf-8"))
    sources = {}
    for entry in entries:
        path = Path(entry["directory"], entry["file"]).resolve()
        if any(path.is_relative_to(folder) for folder in folders):
            sources[path] = Source(path, entry["command"])
    return [sources[path] for path in sorted(sources)]


def project_headers(path: Path, folders: list[Path]) -> set[Path]:
    """Return every project file that ``path`` includes, directly or not, itself too."""
    found: set[Path] = set()
    waiting = [path.resolve()]
    while waiting:
        current = waiting.pop()
        if current in found:
            continue
        found.add(current)
        for name in includes_of(current.read_text(encoding="utf-8")):
            candidates = [current.parent / name, *(folder / name for folder in folders)]
            waiting += [c.resolve() for c in candidates if c.is_file()][:1]
    return found


def fingerprint(source: Source, settings: bytes, folders: list[Path], root: Path) -> str:
    """Hash all that clang-tidy's answer about ``source`` depends on, wherever the checkout is."""
    digest = hashlib.sha256(settings)
    digest.update(source.command.replace(str(root), "").encode())
    for header in sorted(project_headers(source.path, folders)):
        digest.update(str(header.relative_to(root)).encode() + b"\0" + header.read_bytes())
    return digest.hexdigest()


def tidy(source: Source, tree: Path) -> str:
    """Check one file; returns what clang-tidy complains of, empty when it passes."""
    command = [CLANG_TIDY, "-p", str(tree), "--quiet", *EXTRA, str(source.path)]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    if result.returncode == 0:
        return ""
    return result.stdout.strip() or result.stderr.strip()


def main(arguments: list[str]) -> int:
    """Check what changed; 1 when a file does not pass."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tree", type=Path, default=ROOT / "build" / "release")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--all", action="store_true", help="forget what passed before")
    options = parser.parse_args(arguments)

    compile_commands = options.tree / "compile_commands.json"
    if not compile_commands.exists():
        print(f"{compile_commands} is missing: configure the tree first", file=sys.stderr)
        return 1
    include_folders = [ROOT / "cpp/include", ROOT / "cpp/src", ROOT / "tests/cpp"]
    sources = read_sources(compile_commands, [ROOT / "cpp", ROOT / "tests"])
    version = subprocess.run([CLANG_TIDY, "--version"], capture_output=True, check=True).stdout
    settings = version + (ROOT / ".clang-tidy").read_bytes() + " ".join(EXTRA).encode()
    cache = Path(os.environ.get("VIAPOINT_TIDY_CACHE", ROOT / "build" / "tidy"))
    cache.mkdir(parents=True, exist_ok=True)

    stamps = {s: cache / fingerprint(s, settings, include_folders, ROOT) for s in sources}
    changed = [s for s in sources if options.all or not stamps[s].exists()]
    failed = 0
    with ThreadPoolExecutor(options.jobs) as pool:
        for source, complaint in zip(
            changed, pool.map(lambda s: tidy(s, options.tree), changed), strict=True
        ):
            if complaint:
                failed += 1
                print(complaint, flush=True)
            else:
                stamps[source].touch()
    print(f"{len(sources)} files, {len(changed)} checked, {failed} with findings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
