"""Adds up a meson test run: what was skipped and why, then "N passed, N failed, N skipped".

usage: summary.py JUNIT_XML LOG; exits 1 if a test failed or none ran.
"""

import re
import sys
import xml.etree.ElementTree as ElementTree


def outcome(case):
    if case.find("failure") is not None or case.find("error") is not None:
        return "failed"
    return "skipped" if case.find("skipped") is not None or case.get("result") == "skipped" else "passed"


def main(junit, log):
    counts = {"passed": 0, "failed": 0, "skipped": 0}
    for case in ElementTree.parse(junit).iter("testcase"):
        result = outcome(case)
        counts[result] += 1
        if result != "passed":
            print(f"{result.upper()}: {case.get('classname')} {case.get('name')}")
    with open(log, encoding="utf-8", errors="replace") as text:
        announced = {line.strip() for line in text if re.match(r"\s*SKIPPED\b", line)}
    for line in sorted(announced):
        print(line)
    print("{passed} passed, {failed} failed, {skipped} skipped".format(**counts))
    return 1 if counts["failed"] or not counts["passed"] else 0


sys.exit(main(*sys.argv[1:3]))
