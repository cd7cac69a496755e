"""run.py BUILD [OPTION...]: ctest in the build directory BUILD with these options; its last lines say what did not run, and why.
run.py --spent SECONDS BUILD...: the processor time of the latest run in each BUILD, beside what all may take. It tells, and fails nothing:
how fast a processor is, no test decides.

A test is skipped by exit status 77 (the last line that it prints is the reason), by Unity's TEST_IGNORE_MESSAGE or by unittest's
skipTest. A label that is left out (-LE) is counted. The exit status is ctest's; with NOTHING_SKIPPED=1 in the environment, as in
every job that exists to run them, it is 1 too when a test was skipped that EXCUSED does not name. To find no test at all is an error.
"""
import json
import os
import re
import resource
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

# What cannot run where nobody has agreed to somebody's licence, or added somebody's archive.
EXCUSED = {"check_ti": "TI gives its headers to whoever accepts its licence",
           "ros2_build": "ROS 2 is in no suite of Debian"}
IGNORED = re.compile(r"^[^:\n]+:\d+:(\w+):IGNORE(?:: (.*))?$", re.MULTILINE)
UNITTEST = re.compile(r"^(\w+) \([\w.]+\)(?:\n.*)? \.\.\. skipped ['\"](.*)['\"]$", re.MULTILINE)
UNITTEST_SUM = re.compile(r"^(?:OK|FAILED) \(.*?skipped=(\d+)", re.MULTILINE)


def inside(said):
    """(test, reason) of each that a program of tests left out; unittest names them only when it is told to be verbose."""
    named = [(test, reason or "says no reason") for test, reason in (*IGNORED.findall(said), *UNITTEST.findall(said))]
    left = sum(map(int, UNITTEST_SUM.findall(said))) - len(UNITTEST.findall(said))
    return named + ([(f"{left} tests", "run it with -v")] if left > 0 else [])


def skipped(report):
    """(test of ctest, what of it or None, reason) of each that ran nothing, or not all of it."""
    for case in ElementTree.parse(report).getroot().iter("testcase"):
        said = (case.findtext("system-out") or "").strip()
        if case.find("skipped") is not None:
            yield case.get("name"), None, said.splitlines()[-1] if said else "says no reason"
        else:
            for test, reason in inside(said):
                yield case.get("name"), test, reason


def names(build, options):
    listing = subprocess.run(["ctest", "--test-dir", build, "--show-only=json-v1", *options], check=True, capture_output=True, text=True)
    return {test["name"] for test in json.loads(listing.stdout)["tests"]}


def summary(build, options, rows):
    lines = [f"skipped: {name}{f': {test}' if test else ''}: {reason}" for name, test, reason in sorted(rows, key=str)] or ["skipped: nothing"]
    for at, option in enumerate(options):
        if option == "-LE":
            left = len(names(build, options[:at] + options[at + 2:])) - len(names(build, options))
            lines.append(f"not in this run: {left} tests with label {options[at + 1]}")
    return lines


def processor_s():
    """User and system, of all that ctest has started and waited for."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def spent_file(build):
    return Path(build).resolve() / "Testing/processor_s"


def spent(most_s, builds):
    each = {build: float(spent_file(build).read_text(encoding="ascii")) for build in builds}
    total_s = sum(each.values())
    words = " and ".join(f"{seconds:.0f} s in {build}" for build, seconds in each.items())
    return f"processor time: {words}: {total_s:.0f} s, {'MORE than' if total_s > most_s else 'of'} the {most_s:.0f} s that they may take"


def main():
    if sys.argv[1:2] == ["--spent"]:
        print(spent(float(sys.argv[2]), sys.argv[3:]))
        return
    build, *options = sys.argv[1:] or [""]
    if not build or not (Path(build) / "CTestTestfile.cmake").is_file():        # "" is the present one, and that may have tests
        sys.exit(f"run.py: {build or 'no directory'}: no build directory with tests; run.py BUILD -R NAME runs one test of BUILD")
    report = Path(build).resolve() / "Testing" / "run.xml"
    report.parent.mkdir(exist_ok=True)
    report.unlink(missing_ok=True)
    status = subprocess.run(["ctest", "--output-on-failure", f"-j{os.cpu_count()}", "--test-output-size-passed", "1000000", "--no-tests=error",
                             "--output-junit", str(report), "--test-dir", build, *options], check=False).returncode
    spent_file(build).write_text(f"{processor_s():.1f}\n", encoding="ascii")
    rows = list(skipped(report)) if report.exists() else []
    print("\n".join(summary(build, options, rows)))
    unexcused = sorted({name for name, _, _ in rows} - set(EXCUSED))
    if os.environ.get("NOTHING_SKIPPED") == "1" and unexcused:
        print(f"nothing may be skipped in this run: {', '.join(unexcused)}")
        status = status or 1
    sys.exit(status)


if __name__ == "__main__":
    main()
