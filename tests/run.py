"""run.py BUILD [OPTION...]: ctest in the build directory BUILD with these options; its last lines say what did not run, and why.

A test is skipped by exit status 77 (the last line that it prints is the reason) or by Unity's TEST_IGNORE_MESSAGE. A label that
is left out (-LE) is counted. The exit status is ctest's.
"""
import json
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

IGNORED = re.compile(r"^[^:\n]+:\d+:(\w+):IGNORE(?:: (.*))?$", re.MULTILINE)


def skipped(report):
    """(name, reason) of each test of ctest's report that ran nothing, or not all of it."""
    for case in ElementTree.parse(report).getroot().iter("testcase"):
        said = (case.findtext("system-out") or "").strip()
        if case.find("skipped") is not None:
            yield case.get("name"), said.splitlines()[-1] if said else "says no reason"
        else:
            for test, reason in IGNORED.findall(said):
                yield f"{case.get('name')}: {test}", reason or "says no reason"


def names(build, options):
    listing = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1", *options], check=True, capture_output=True, text=True)
    return {test["name"] for test in json.loads(listing.stdout)["tests"]}


def summary(build, options, report):
    rows = sorted(skipped(report))
    lines = [f"skipped: {name}: {reason}" for name, reason in rows] or ["skipped: nothing"]
    for at, option in enumerate(options):
        if option == "-LE":
            left = len(names(build, options[:at] + options[at + 2:])) - len(names(build, options))
            lines.append(f"not in this run: {left} tests with label {options[at + 1]}")
    return lines


def main():
    build, *options = sys.argv[1:]
    report = Path(build).resolve() / "Testing" / "run.xml"
    report.parent.mkdir(exist_ok=True)
    status = subprocess.run(["ctest", "--output-on-failure", f"-j{os.cpu_count()}", "--test-output-size-passed", "1000000",
                             "--output-junit", str(report), "--test-dir", build, *options], check=False).returncode
    print("\n".join(summary(build, options, report)))
    sys.exit(status)


if __name__ == "__main__":
    main()
