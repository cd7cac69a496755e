#!/usr/bin/env python3
"""coverage.py BUILD_DIRECTORY: the scanner's tests reach the lines and branches of its driver, else exit 1. 77: no gcovr.

The unit tests, and trials through the public calls against a sensor that starts, stops and talks nonsense.
"""
import json
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TESTS = [f"test_{name}" for name in ("scip_family", "scip_free", "scip_info", "scip_layout", "scip_parser", "scip_request", "urg", "urg_link")]
TRIALS = [["power", "6"], ["stops"], ["starts"], ["damage", "100"]]
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
    missed = {what: summary[f"{what}_total"] - summary[f"{what}_covered"] for what in ("line", "branch")}
    print(f"not reached: {missed}")
    sys.exit(any(missed.values()))


if __name__ == "__main__":
    main()
