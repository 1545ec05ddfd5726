"""The summary counts what ctest and pytest really report, and hides no failure."""

import os
import sys
from pathlib import Path

import pytest

import run_tests
from run_tests import Counts

CTEST = """<?xml version="1.0" encoding="UTF-8"?>
<testsuite name="(empty)" tests="6" failures="1" disabled="1" skipped="3">
  <testcase name="A.Ok" classname="A.Ok" time="0.001" status="run"/>
  <testcase name="A.Skip" status="notrun">
    <skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/></testcase>
  <testcase name="A.Bad" status="fail"><failure message=""/></testcase>
  <testcase name="A.x" status="disabled"/>
  <testcase name="u_NOT_BUILT" status="notrun">
    <skipped message="Unable to find executable"/></testcase>
</testsuite>"""

PYTEST = """<testsuites><testsuite>
  <testcase name="a"/><testcase name="b"/>
  <testcase name="c"><error message="fixture"/></testcase>
  <testcase name="d"><skipped message="needs a right"/></testcase>
</testsuite></testsuites>"""


def test_ctest_report_counts_tests_that_were_not_built_as_failed(tmp_path: Path):
    report = tmp_path / "r.xml"
    report.write_text(CTEST, encoding="utf-8")
    assert run_tests.read_junit(report) == Counts(passed=1, failed=2, skipped=2)


def test_pytest_report_counts_errors_as_failed(tmp_path: Path):
    report = tmp_path / "r.xml"
    report.write_text(PYTEST, encoding="utf-8")
    assert run_tests.read_junit(report) == Counts(passed=2, failed=1, skipped=1)


def test_closing_line_names_skips_only_where_there_are_some():
    assert Counts(3, 0).line() == "3 passed, 0 failed"
    assert (Counts(3, 0) + Counts(1, 2, 1)).line() == "4 passed, 2 failed, 1 skipped"


@pytest.mark.parametrize(
    ("script", "expected"),
    [
        ("import sys; sys.exit(3)", Counts(failed=1)),
        ("import sys; open(sys.argv[1], 'w').write('<t/>'); sys.exit(5)", Counts()),
        ("import sys; open(sys.argv[1], 'w').write('<t/>'); sys.exit(2)", Counts(failed=1)),
        (
            "import sys; open(sys.argv[1], 'w').write('<t><testcase/></t>'); sys.exit(-11)",
            Counts(passed=1, failed=1),
        ),
    ],
    ids=["no report", "nothing selected", "bad end", "crash after the last test"],
)
def test_a_runner_that_ends_badly_is_a_failure(script: str, expected: Counts, tmp_path: Path):
    report = tmp_path / "r.xml"
    command = [sys.executable, "-c", script, str(report)]
    assert run_tests.run("runner", command, report, dict(os.environ)) == expected


def test_a_stale_report_is_not_counted(tmp_path: Path):
    report = tmp_path / "r.xml"
    report.write_text(PYTEST, encoding="utf-8")
    command = [sys.executable, "-c", "pass"]
    assert run_tests.run("runner", command, report, dict(os.environ)) == Counts(failed=1)
