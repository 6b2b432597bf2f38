"""Adds up a meson test run: what failed, what was skipped and why, then "N passed, N failed, N skipped".

usage: summary.py BUILD_FOLDER <LIST
LIST is what `meson test --list` says of the same selection. A GoogleTest program counts as its cases. A test that
the list names and the log does not is a failure; so is a program without a report or without a case.
Before the run, the reports of the one before must go: summary.py --forget BUILD_FOLDER.
"""

import json
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

GOOD = {"OK", "EXPECTEDFAIL"}


def logs_of(build):
    return list((build / "meson-logs").glob("testlog*.json"))  # a test set-up has one of its own


def google_tests(build):
    """The reports of GoogleTest programs by the test's name, those not written included."""
    tests = json.loads((build / "meson-info/intro-tests.json").read_text())
    return {test["name"]: build / (test["name"] + ".xml") for test in tests if test["protocol"] == "gtest"}


def cases_in(report):
    """Outcome, name and reason of each case of a GoogleTest program; none where it did not live to report."""
    try:
        cases = list(ElementTree.parse(report).iter("testcase"))
    except (FileNotFoundError, ElementTree.ParseError):
        return
    for case in cases:
        name, skip = f"{case.get('classname')}.{case.get('name')}", case.find("skipped")
        if case.find("failure") is not None or case.find("error") is not None:
            yield "failed", name, ""
        elif skip is not None or case.get("status") == "notrun":
            yield "skipped", name, "" if skip is None else skip.get("message", "")
        else:
            yield "passed", name, ""


def outcomes_of(record, report):
    """Those of one record of the log; `report` is where a GoogleTest program reports, else None."""
    name, result = record["name"], record["result"]
    cases = list(cases_in(report)) if report and result in {"OK", "FAIL"} else []
    yield from ((outcome, f"{name} {case}", reason) for outcome, case, reason in cases)
    if result in GOOD and report and not cases:
        yield "failed", name, "no case ran"
    elif result in GOOD and not cases:
        yield "passed", name, ""
    elif result == "SKIP":
        yield "skipped", name, ""
    elif result not in GOOD and not any(outcome == "failed" for outcome, _, _ in cases):
        yield "failed", name, f"{result}, exit status {record.get('returncode')}"


def outcomes(build, selected):
    reports = google_tests(build)
    records = [json.loads(line) for log in logs_of(build) for line in log.read_text().splitlines()]
    for record in records:
        yield from outcomes_of(record, reports.get(record["name"].split(" / ")[-1]))
        said = record.get("stdout", "") + record.get("stderr", "")
        yield from (("announced", line, "") for line in re.findall(r"(?m)^\s*(SKIPPED\b.*)", said))
    for name in selected - {record["name"] for record in records}:
        yield "failed", name, "no outcome"


def main(build, selected):
    counts = {"passed": 0, "failed": 0, "skipped": 0, "announced": 0}
    lines = []
    for outcome, name, reason in outcomes(build, selected):
        counts[outcome] += 1
        label = "" if outcome == "announced" else f"{outcome.upper()}: "
        if outcome != "passed":
            lines.append(label + name + (": " + " ".join(reason.split()) if reason else ""))
    print(*sorted(set(lines)), sep="\n")
    print("{passed} passed, {failed} failed, {skipped} skipped".format(**counts))
    return 1 if counts["failed"] or not counts["passed"] else 0


if sys.argv[1] == "--forget":
    folder = Path(sys.argv[2])
    for stale in [*logs_of(folder), *google_tests(folder).values()]:
        stale.unlink(missing_ok=True)
else:
    sys.exit(main(Path(sys.argv[1]), {line.strip() for line in sys.stdin if line.strip()}))
