#!/usr/bin/env python3
"""coverage.py BUILD_DIRECTORY: the scanner's unit tests reach every line and every branch of its driver, else exit 1. 77: no gcovr."""
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TESTS = [f"test_{name}" for name in ("scip_info", "scip_layout", "scip_parser", "scip_request", "urg", "urg_link")]
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
    run("cmake", "--build", build, "--target", *TESTS)
    for old in build.rglob("*.gcda"):
        old.unlink()
    for test in TESTS:
        run(build / "tests/drivers" / test)
    gcovr = ["gcovr", "--root", ROOT, "--object-directory", build, "--filter", "drivers/scip_", "--filter", "drivers/urg"]
    subprocess.run(gcovr, cwd=ROOT, check=True)
    done = subprocess.run([*gcovr, "--branches", "--fail-under-line", "100", "--fail-under-branch", "100"], cwd=ROOT, check=False)
    sys.exit(done.returncode != 0)


if __name__ == "__main__":
    main()
