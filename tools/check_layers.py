"""Hold the #includes of cpp/ and the links of CMake against the layering table.

Reports every include of a module that the including module may not use, every file outside
``robot_model.cpp`` that includes Orocos KDL, every CMake link that the table does not allow or
that is missing, and every cycle between modules or headers.
"""

import re
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

# Whom each module may include, itself apart.
MAY_INCLUDE: dict[str, frozenset[str]] = {
    "core": frozenset(),
    "profile": frozenset({"core"}),
    "kinematics": frozenset({"core"}),
    "path": frozenset({"core", "kinematics", "profile"}),
    "trajectory": frozenset({"core", "profile", "path"}),
    "program": frozenset({"core"}),
    "planning": frozenset({"core", "kinematics", "profile", "path", "trajectory", "program"}),
    "realtime": frozenset({"core", "profile"}),
    "drives": frozenset({"core", "realtime"}),
    "remote": frozenset({"core", "realtime", "trajectory"}),
    "rtde": frozenset({"core", "kinematics", "realtime"}),
    "streaming": frozenset({"core", "kinematics", "trajectory", "program", "planning", "realtime"}),
}
# The single headers that a module may include on top.
ALSO: dict[str, frozenset[str]] = {
    "realtime": frozenset(
        {
            "viapoint/trajectory/trajectory.hpp",
            # What trajectory.hpp itself is made of.
            "viapoint/trajectory/trajectory_piece.hpp",
            "viapoint/trajectory/certificate.hpp",
            "viapoint/kinematics/forward_kinematics.hpp",
        }
    )
}
KDL_USER = "cpp/src/kinematics/robot_model.cpp"

INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
COMMENT = re.compile(r"//[^\n]*|/\*.*?\*/", re.DOTALL)
MODULE_CALL = re.compile(r"viapoint_module\(\s*(\w+)([^)]*)\)")


def includes_of(text: str) -> list[str]:
    """Return what a C++ source includes, in order; comments do not count."""
    return INCLUDE.findall(COMMENT.sub("", text))


def module_of(path: Path) -> str | None:
    """Return the module a file of ``cpp/`` belongs to; None for those that may use everything."""
    for part, following in zip(path.parts, path.parts[1:], strict=False):
        if part in {"viapoint", "src"} and following in MAY_INCLUDE:
            return following
    return None


def find_cycle(graph: Mapping[str, Iterable[str]]) -> list[str] | None:
    """Return one cycle as ``[a, b, …, a]``, or None where there is none."""
    done: set[str] = set()

    def walk(node: str, trail: list[str]) -> list[str] | None:
        if node in trail:
            return [*trail[trail.index(node) :], node]
        if node in done:
            return None
        for following in sorted(graph.get(node, ())):
            if cycle := walk(following, [*trail, node]):
                return cycle
        done.add(node)
        return None

    for node in sorted(graph):
        if cycle := walk(node, []):
            return cycle
    return None


def check_includes(sources: Mapping[Path, str]) -> list[str]:
    """Check the text of every file, by its path from the root of the checkout.

    Returns
    -------
    list[str]
        One message a breach, each with file and header; empty when all is well.
    """
    problems: list[str] = []
    modules: dict[str, set[str]] = {}
    headers: dict[str, set[str]] = {}
    for path, text in sorted(sources.items()):
        module = module_of(path)
        name = path.as_posix().removeprefix("cpp/include/").removeprefix("cpp/src/")
        for included in includes_of(text):
            if included.startswith("kdl/") and path.as_posix() != KDL_USER:
                problems.append(f"{path}: includes <{included}>; only {KDL_USER} may")
            other = module_of(Path("src") / included) or module_of(Path(included))
            if other is None:
                continue
            headers.setdefault(name, set()).add(included)
            if module is None or other == module:
                continue
            if included in ALSO.get(module, ()):
                continue
            modules.setdefault(module, set()).add(other)
            if other not in MAY_INCLUDE[module]:
                allowed = ", ".join(sorted(MAY_INCLUDE[module])) or "nothing"
                problems.append(
                    f"{path}: {module} includes {included} of {other}; it may include {allowed}"
                )
    for kind, graph in (("modules", modules), ("headers", headers)):
        if cycle := find_cycle(graph):
            problems.append(f"cycle of {kind}: {' -> '.join(cycle)}")
    return problems


def check_links(cmake: Mapping[Path, str]) -> list[str]:
    """Check that every ``viapoint_module(… DEPENDS …)`` says what the table says."""
    problems: list[str] = []
    found: set[str] = set()
    for path, text in sorted(cmake.items()):
        for module, rest in MODULE_CALL.findall(text):
            found.add(module)
            words = rest.split()
            start = words.index("DEPENDS") + 1 if "DEPENDS" in words else len(words)
            links: set[str] = set()
            for word in words[start:]:
                if word.isupper():
                    break
                links.add(word)
            if module not in MAY_INCLUDE:
                problems.append(f"{path}: module {module} is not in the layering table")
                continue
            single = {Path(header).parts[1] for header in ALSO.get(module, ())}
            allowed = set(MAY_INCLUDE[module]) | single
            if links != allowed:
                problems.append(
                    f"{path}: {module} links {sorted(links)}; the layering table says "
                    f"{sorted(allowed)}"
                )
    problems += [f"no CMakeLists.txt defines module {m}" for m in MAY_INCLUDE if m not in found]
    return problems


def check(root: Path) -> list[str]:
    """Check a whole checkout."""
    sources = {
        path.relative_to(root): path.read_text(encoding="utf-8")
        for folder in ("cpp/include", "cpp/src", "cpp/bindings", "cpp/controller")
        for pattern in ("*.hpp", "*.cpp")
        for path in (root / folder).rglob(pattern)
    }
    cmake = {
        path.relative_to(root): path.read_text(encoding="utf-8")
        for path in (root / "cpp/src").glob("*/CMakeLists.txt")
    }
    if not sources:
        return [f"{root}: no C++ sources found"]
    return check_includes(sources) + check_links(cmake)


def main() -> int:
    """Print every breach; 1 when there is one."""
    problems = check(Path(__file__).parents[1])
    for problem in problems:
        print(problem, file=sys.stderr)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
