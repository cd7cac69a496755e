"""summary.py BUILD: what the runs of `make port` proved, from the record of ctest in the build directory BUILD.

Ends with the tests that the simulated machine leaves out. Exit status 1 when a test of a program ran neither there nor is
left out by a row of left_out.txt.
"""
import argparse
import re
import sys
from collections import Counter
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "avr"))
import prepare  # noqa: E402

MACHINES = {"plain": "this PC, as it is", "wide": "this PC, octets of 16 bits", "avr": "simulated, int of 16 bits",
            "cells": "simulated, CHAR_BIT 16"}
TEST = re.compile(r"^\d+/\d+ Testing: (test_\w+)_(plain|wide|avr|cells)$(.*?)(?=^\d+/\d+ Testing: |\Z)", re.DOTALL | re.MULTILINE)
COUNT = re.compile(r"^(\d+) Tests (\d+) Failures", re.MULTILINE)


def counts(record):
    """{machine: {program: (tests, failures)}}; a program that did not come to its end has no tests."""
    found = {machine: {} for machine in MACHINES}
    for program, machine, text in TEST.findall(record):
        count = COUNT.search(text)
        found[machine][program] = (int(count.group(1)), int(count.group(2))) if count else (0, 0)
    return found


def missing(found, rows):
    """Programs with tests that neither ran nor are left out."""
    left = Counter(program for program, _ in rows)
    for machine, programs in found.items():
        for program, (expected, _) in found["plain"].items():
            ran = programs.get(program, (0, 0))[0]
            out = left[program] if machine in ("avr", "cells") else 0
            if ran + out != expected:
                yield f"{program} on {machine}: {ran} tests ran and {out} are left out, of {expected}"


def table(found):
    yield f"{'run':7} {'machine':28} {'programs':>8} {'tests':>6} {'failed':>6}"
    for machine, programs in found.items():
        tests, failures = (sum(numbers) for numbers in zip(*programs.values())) if programs else (0, 0)
        yield f"{machine:7} {MACHINES[machine]:28} {len(programs):8} {tests:6} {failures:6}"


def reasons(text):
    """The rows of left_out.txt by their reason."""
    by_reason = {}
    for line in text.splitlines():
        if line.strip() and not line.startswith("#"):
            program, test, reason = line.split(None, 2)
            by_reason.setdefault(reason, []).append(f"{program[5:]}: {test[5:].replace('_', ' ')}")
    return by_reason


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("build", type=Path)
    options = parser.parse_args()
    text = (HERE / "left_out.txt").read_text(encoding="utf-8")
    found = counts((options.build / "Testing/Temporary/LastTest.log").read_text(encoding="utf-8", errors="replace"))
    print("\nNot on the simulated machine (tests/port/left_out.txt):")
    for reason, tests in reasons(text).items():
        print(f"  {reason}: {len(tests)}", *tests, sep="\n    ")
    print("", *table(found), sep="\n")
    complaints = list(missing(found, prepare.left_out(text)))
    print(*complaints, sep="\n")
    sys.exit(1 if complaints or not found["plain"] else 0)


if __name__ == "__main__":
    main()
