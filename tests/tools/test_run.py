"""tests/run.py: what was skipped and why stands in the last lines; the exit status is ctest's."""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
RUN = ROOT / "tests/run.py"
LISTS = """cmake_minimum_required(VERSION 3.22)
project(sample NONE)
enable_testing()
add_test(NAME good COMMAND "${CMAKE_COMMAND}" -E echo fine)
add_test(NAME left COMMAND sh -c "echo begins; echo no such tool; exit 77")
set_tests_properties(left PROPERTIES SKIP_RETURN_CODE 77)
add_test(NAME unit COMMAND "${CMAKE_COMMAND}" -E echo "test_x.c:12:test_one:IGNORE: no display")
add_test(NAME hours COMMAND "${CMAKE_COMMAND}" -E false)
set_tests_properties(hours PROPERTIES LABELS long)
"""


class Run(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.build = Path(scratch.name) / "build"
        (Path(scratch.name) / "CMakeLists.txt").write_text(LISTS, encoding="utf-8")
        subprocess.run(["cmake", "-S", scratch.name, "-B", self.build], check=True, capture_output=True)

    def run_tests(self, *options):
        done = subprocess.run([sys.executable, "-B", RUN, self.build, *options], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout.splitlines()

    def test_each_that_was_skipped_is_named_last_with_its_reason(self):
        status, lines = self.run_tests("-LE", "long")
        self.assertEqual(status, 0)
        self.assertEqual(lines[-3:], ["skipped: left: no such tool", "skipped: unit: test_one: no display",
                                      "not in this run: 1 tests with label long"])

    def test_a_failure_is_ctests_exit_status(self):
        status, lines = self.run_tests("-L", "long")
        self.assertNotEqual(status, 0)
        self.assertEqual(lines[-1], "skipped: nothing")


if __name__ == "__main__":
    unittest.main()
