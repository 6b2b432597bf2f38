"""Adds up meson test runs: times, what failed, what was skipped and why, then "N passed, N failed, N skipped".

usage: summary.py --begin BUILD_FOLDER <LIST       before a run: removes old reports, notes which tests must report
       summary.py [--failed TEXT]… [--skipped TEXT]… [--took SECONDS]… BUILD_FOLDER…    after the runs of all folders

LIST is the output of `meson test --list` for the same selection. A GoogleTest program counts as its cases. Each line
"SKIPPED …" that a test prints counts as a skip. A test that the list names and the log does not is a failure; so is a
program without a report or without a case. Each TEXT counts once: a stage that did not build, a check that was left
out. --took has a number for each folder, in their order: the seconds from its set-up to its last test. The table of
times has the slowest tests of each. Exit status: 1 if anything failed, or nothing passed.
"""

import argparse
import json
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

GOOD = {"OK", "EXPECTEDFAIL"}
SLOWEST = 10  # tests of a folder that the table of times names


def logs_of(build):
    return list((build / "meson-logs").glob("testlog*.json"))  # a test set-up has one of its own


def records_of(build):
    return [json.loads(line) for log in logs_of(build) for line in log.read_text().splitlines()]


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


def note_of(build):
    """The file with the names of the tests that must report."""
    return build / "meson-logs/selected-tests.txt"


def outcomes(build):
    selected = {line for line in note_of(build).read_text().splitlines() if line}
    reports = google_tests(build)
    records = records_of(build)
    for record in records:
        of_record = list(outcomes_of(record, reports.get(record["name"].split(" / ")[-1])))
        yield from of_record
        said = re.findall(r"(?m)^\s*(SKIPPED\b.*)", record.get("stdout", "") + record.get("stderr", ""))
        # A test that is skipped as a whole, and a case of GoogleTest, count once, although they print the reason.
        reasons = " ".join(reason for outcome, _, reason in of_record if outcome == "skipped")
        again = record["result"] == "SKIP"
        yield from (("repeated" if again or line in reasons else "announced", line, "") for line in said)
    for name in selected - {record["name"] for record in records}:
        yield "failed", name, "no outcome"


def times(build, took):
    """Lines of the table of times."""
    records = sorted(records_of(build), key=lambda record: -record["duration"])
    if not records:
        yield f"{build.name}: {took} s, no test ran"
        return
    first = min(record["starttime"] for record in records)
    tests = max(record["starttime"] + record["duration"] for record in records) - first
    yield f"{build.name}: {took} s, of which {len(records)} tests took {tests:.0f} s"
    for record in records[:SLOWEST]:
        yield f"{record['duration']:9.1f} s  {record['name'].split(' / ')[-1]}"


def begin(build):
    for stale in [*logs_of(build), *google_tests(build).values()]:
        stale.unlink(missing_ok=True)
    note_of(build).parent.mkdir(exist_ok=True)
    note_of(build).write_text("".join(line.strip() + "\n" for line in sys.stdin))


def main(options):
    counts = {"passed": 0, "failed": len(options.failed), "announced": len(options.skipped), "skipped": 0,
              "repeated": 0}
    lines = [f"FAILED: {text}" for text in options.failed] + [f"SKIPPED: {text}" for text in options.skipped]
    for build in options.builds:
        stage = f"{build.name}: " if len(options.builds) > 1 else ""
        for outcome, name, reason in outcomes(build):
            counts[outcome] += 1
            label = "" if outcome in {"announced", "repeated"} else f"{outcome.upper()}: "
            if outcome != "passed":
                lines.append(stage + label + name + (": " + " ".join(reason.split()) if reason else ""))
    counts["skipped"] += counts["announced"]
    for build, took in zip(options.builds, options.took):
        print(*times(build, took), sep="\n")
    print(*sorted(set(lines)), sep="\n")
    print("{passed} passed, {failed} failed, {skipped} skipped".format(**counts))
    return 1 if counts["failed"] or not counts["passed"] else 0


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--begin", action="store_true", help="remove old reports and note the tests of standard input")
parser.add_argument("--failed", action="append", default=[], metavar="TEXT", help="a failure outside the folders")
parser.add_argument("--skipped", action="append", default=[], metavar="TEXT", help="a skip outside the folders")
parser.add_argument("--took", action="append", default=[], type=int, metavar="SECONDS", help="those of a folder")
parser.add_argument("builds", nargs="*", type=Path, metavar="BUILD_FOLDER")
given = parser.parse_args()
if given.begin:
    begin(given.builds[0])
else:
    sys.exit(main(given))
