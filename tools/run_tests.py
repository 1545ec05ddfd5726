"""Run GoogleTest (through ctest) and pytest, and end with one line that sums both."""

import argparse
import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import dataclass
from pathlib import Path

from affected_tests import Passed, executables, python_files, test_data

ROOT = Path(__file__).parents[1]
REPORTS = Path("build/reports")


@dataclass(frozen=True)
class Counts:
    """How many tests ended which way."""

    passed: int = 0
    failed: int = 0
    skipped: int = 0

    def __add__(self, other: "Counts") -> "Counts":
        """Sum of two runs."""
        return Counts(
            self.passed + other.passed, self.failed + other.failed, self.skipped + other.skipped
        )

    def line(self) -> str:
        """Return the closing line, e.g. ``12 passed, 0 failed, 1 skipped``."""
        text = f"{self.passed} passed, {self.failed} failed"
        return f"{text}, {self.skipped} skipped" if self.skipped else text


def read_junit(report: Path) -> Counts:
    """Count the test cases of a JUnit file as ctest or pytest writes it.

    A test that could not be run (not built, broken set-up) counts as failed.

    Raises
    ------
    FileNotFoundError
        The runner ended before it wrote its report.
    """
    counts = Counts()
    for case in ET.parse(report).getroot().iter("testcase"):
        status = case.get("status", "")
        if case.find("failure") is not None or case.find("error") is not None:
            counts += Counts(failed=1)
        elif case.find("skipped") is not None or status in {"notrun", "disabled"}:
            # ctest writes a test that asked to be skipped and one it could not start alike, but
            # only the first has the word in its message.
            skipped = case.find("skipped")
            message = skipped.get("message", "") if skipped is not None else ""
            unavailable = status == "notrun" and "SKIP" not in message.upper()
            counts += Counts(failed=1) if unavailable else Counts(skipped=1)
        else:
            counts += Counts(passed=1)
    return counts


def run(title: str, command: list[str], report: Path, environment: dict[str, str]) -> Counts:
    """Run one runner, show its output, and count from its report.

    A runner that ends badly although no test failed (a crash, a collection error) counts as one
    failure, so that it cannot pass unseen.
    """
    print(f"Running {title}", flush=True)
    report.unlink(missing_ok=True)
    code = subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode
    if not report.exists():
        print(f"error: {title} ended with code {code} and wrote no report", file=sys.stderr)
        return Counts(failed=1)
    counts = read_junit(report)
    nothing_selected = code == 5 or (counts == Counts() and code == 0)
    if code != 0 and not nothing_selected and counts.failed == 0:
        print(f"error: {title} ended with code {code}", file=sys.stderr)
        counts += Counts(failed=1)
    return counts


def run_googletest(options: argparse.Namespace, passed: Passed) -> Counts:
    """Run GoogleTest through ctest; executables that passed as they are may be left out."""
    report = ROOT / REPORTS / "ctest.xml"
    tree = ROOT / options.tree
    command = ["ctest", "--test-dir", str(tree), "--output-on-failure", "--no-tests=ignore"]
    command += ["--progress", "--parallel", str(os.cpu_count() or 1)]
    command += ["--output-junit", str(report)]
    command += ["-R", options.k] if options.k else []
    programs = {name: [path, *test_data(ROOT)] for name, path in executables(tree).items()}
    if options.affected:
        done = sorted(name for name, files in programs.items() if passed.holds(name, files))
        print(f"Unchanged since they passed: {', '.join(done) or 'none'}", flush=True)
        command += ["-LE", f"^({'|'.join(done)})$"] if done else []
    counts = run("GoogleTest", command, report, dict(os.environ))
    if counts.failed == 0 and not options.k:
        for name, files in programs.items():
            passed.record(name, files)
    return counts


def run_pytest(options: argparse.Namespace, passed: Passed) -> Counts:
    """Run pytest; it may be left out when nothing of Python changed since it passed."""
    files = python_files(ROOT)
    if options.affected and passed.holds("pytest", files):
        print("Nothing of Python changed since pytest passed", flush=True)
        return Counts()
    report = ROOT / REPORTS / "pytest.xml"
    command = [sys.executable, "-m", "pytest", "-q", f"--junitxml={report}"]
    command += ["--numprocesses", str(os.cpu_count() or 1), "--dist", "worksteal"]
    command += ["-k", options.k] if options.k else []
    command += options.pytest_arguments
    # Pictures are drawn without a screen.
    counts = run("pytest", command, report, os.environ | {"MPLBACKEND": "Agg"})
    if counts.failed == 0 and not options.k and not options.pytest_arguments:
        passed.record("pytest", files)
    return counts


def parse(arguments: list[str]) -> argparse.Namespace:
    """Read the command line."""
    parser = argparse.ArgumentParser(
        prog="./tools/test",
        description="Set up what is missing, build, run GoogleTest and pytest, and sum them.",
    )
    parser.add_argument("-k", metavar="NAME", help="only tests whose name contains NAME")
    parser.add_argument(
        "--affected",
        action="store_true",
        help="leave out GoogleTest executables that passed as they are, and pytest when it passed "
        "and nothing of Python changed since (a change of C++ alone does not count)",
    )
    parser.add_argument("--cpp", action="store_true", help="only GoogleTest")
    parser.add_argument("--python", action="store_true", help="only pytest")
    parser.add_argument("--tree", default="build/release", help="build tree (default: %(default)s)")
    parser.add_argument(
        "pytest_arguments", nargs="*", metavar="ARG", help="after --: handed to pytest as they are"
    )
    return parser.parse_args(arguments)


def main(arguments: list[str]) -> int:
    """Run what was asked for; 0 when none failed and, unless only ``--affected``, one ran."""
    options = parse(arguments)
    both = options.cpp == options.python
    (ROOT / REPORTS).mkdir(parents=True, exist_ok=True)
    passed = Passed(ROOT / REPORTS / "passed.json")
    counts = Counts()
    if both or options.cpp:
        counts += run_googletest(options, passed)
    if both or options.python:
        counts += run_pytest(options, passed)
    none = counts.passed + counts.failed == 0
    if none and not options.affected:
        print("error: no test was run", file=sys.stderr)
    print(counts.line(), flush=True)
    return 1 if counts.failed or (none and not options.affected) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
