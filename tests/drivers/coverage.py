#!/usr/bin/env python3
"""coverage.py BUILD_DIRECTORY: the scanner's tests reach the lines and branches of its driver, else exit 1. 77: no gcovr.

The unit tests, and trials through the public calls against a sensor that starts, stops and talks nonsense. What they do not reach
is counted below, and may only become less.
"""
import json
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TESTS = [f"test_{name}" for name in ("scip_info", "scip_layout", "scip_parser", "scip_request", "urg", "urg_link")]
TRIALS = [["power"], ["stops"], ["starts"], ["damage", "100"]]
# Not reached since the link learns the sensor's rate: the answer to SS that comes late (a line of on_late_answer()), and an edge each of
# has_answered(), free_us(), asking_us(), on_late_answer(), held() and head_in_place().
OWED = {"line": 1, "branch": 6}
SKIPPED = 77


def run(*command):
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(done.stdout + done.stderr)


def main():
    build = Path(sys.argv[1]).resolve()
    if shutil.which("gcovr") is None:
        print("gcovr is missing: tools/setup/setup.sh coverage")
        sys.exit(SKIPPED)
    run("cmake", "-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Debug", "-DCOVERAGE=ON", "-DPLOMADA_TESTS=ON")
    run("cmake", "--build", build, "--target", *TESTS, "scip_recovery")
    for old in build.rglob("*.gcda"):
        old.unlink()
    for test in TESTS:
        run(build / "tests/drivers" / test)
    for trial in TRIALS:
        run(build / "tests/faults/scip_recovery", *trial)
    gcovr = ["gcovr", "--root", ROOT, "--object-directory", build, "--filter", "drivers/scip_", "--filter", "drivers/urg"]
    for report in ([], ["--branches"]):
        subprocess.run([*gcovr, *report], cwd=ROOT, check=True)
    summary = json.loads(subprocess.run([*gcovr, "--json-summary"], cwd=ROOT, check=True, capture_output=True, text=True).stdout)
    missed = {what: summary[f"{what}_total"] - summary[f"{what}_covered"] for what in OWED}
    print(f"not reached: {missed}, at most {OWED}")
    sys.exit(any(missed[what] > OWED[what] for what in OWED))


if __name__ == "__main__":
    main()
