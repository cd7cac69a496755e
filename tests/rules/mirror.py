"""tests/ mirrors the rooms: every .c file of the product has its test file, none is empty, and ctest runs them all.

Usage: mirror.py [--build DIR] [ROOT]; only with a build directory is ctest asked.
"""
import argparse
import json
import re
import subprocess
from pathlib import Path

import house

EXCUSES = "tests/rules/excuses.txt"


def check(the_house):
    excused = house.excuses(the_house, "mirror")
    sources, complaints = [], []
    for room in house.PRODUCT:
        tests = {Path(path).name for path in the_house.sources(f"tests/{room}", ".c")}
        for source in the_house.sources(room, ".c"):
            sources.append(source)
            tested = f"test_{Path(source).name}" in tests
            if not tested and source not in excused:
                complaints.append(f"{source}: no test_{Path(source).name} in tests/{room}/")
            if tested and source in excused:
                complaints.append(f"{EXCUSES}: {source} has a test and needs no excuse")
    complaints += [f"{EXCUSES}: {path} does not exist" for path in excused if path not in sources]
    return complaints + list(check_empty(the_house))


def check_empty(the_house):
    """Every test file in C holds a test, and asks something."""
    for path in the_house.sources("tests", ".c"):
        code = house.code_only(the_house.text(path))
        if Path(path).name.startswith("test_") and not (re.search(r"\bvoid test_\w+\(", code) and re.search(r"\bTEST_[A-Z]|_Expect\w*\(", code)):
            yield f"{path}: tests nothing"
    for path in the_house.sources("tests", ".py"):
        if Path(path).name.startswith("test_") and not re.search(r"^\s+def test_\w+\(", the_house.text(path), re.MULTILINE):
            yield f"{path}: tests nothing"


def check_registered(the_house, listing):
    """Every tests/**/test_*.c is a ctest test of that name."""
    registered = {test["name"] for test in json.loads(listing)["tests"]}
    return [f"{path}: ctest does not run it" for path in the_house.sources("tests", ".c")
            if Path(path).name.startswith("test_") and Path(path).stem not in registered]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", metavar="DIR")
    parser.add_argument("root", nargs="?", default=Path(__file__).resolve().parents[2])
    options = parser.parse_args()
    home = house.House(options.root)
    found = check(home)
    if options.build:
        found += check_registered(home, subprocess.run(
            ["ctest", "--test-dir", options.build, "--show-only=json-v1"], check=True, capture_output=True, text=True).stdout)
    house.report(found, "mirror")
