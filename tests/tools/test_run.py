"""tests/run.py: what was skipped and why stands in the last lines; the exit status is ctest's, and tells a skip where none may be."""
import os
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
add_test(NAME python COMMAND python3 "${CMAKE_SOURCE_DIR}/python.py" -v)
add_test(NAME terse COMMAND python3 "${CMAKE_SOURCE_DIR}/python.py")
add_test(NAME busy COMMAND python3 -c "import time\\nwhile time.process_time() < 0.6: pass")
add_test(NAME hours COMMAND "${CMAKE_COMMAND}" -E false)
set_tests_properties(hours PROPERTIES LABELS long)
add_test(NAME check_ti COMMAND sh -c "echo no headers; exit 77")
set_tests_properties(check_ti PROPERTIES SKIP_RETURN_CODE 77 LABELS licence)
"""
PYTHON = """import unittest
class Two(unittest.TestCase):
    def test_left(self):
        '''Says what it is.'''
        self.skipTest("no compiler")
    def test_other(self):
        self.skipTest("no wire")
    def test_good(self):
        pass
unittest.main()
"""


class Run(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.build = Path(scratch.name) / "build"
        (Path(scratch.name) / "CMakeLists.txt").write_text(LISTS, encoding="utf-8")
        (Path(scratch.name) / "python.py").write_text(PYTHON, encoding="utf-8")
        subprocess.run(["cmake", "-S", scratch.name, "-B", self.build], check=True, capture_output=True)

    def run_tests(self, *options, nothing_skipped=""):
        done = subprocess.run([sys.executable, "-B", RUN, self.build, *options], capture_output=True, text=True, check=False,
                              env=os.environ | {"NOTHING_SKIPPED": nothing_skipped})
        return done.returncode, done.stdout.splitlines()

    def test_each_that_was_skipped_is_named_last_with_its_reason(self):
        status, lines = self.run_tests("-LE", "long|licence")
        self.assertEqual(status, 0)
        self.assertEqual(lines[-6:], ["skipped: left: no such tool", "skipped: python: test_left: no compiler",
                                      "skipped: python: test_other: no wire", "skipped: terse: 2 tests: run it with -v",
                                      "skipped: unit: test_one: no display", "not in this run: 2 tests with label long|licence"])

    def test_a_failure_is_ctests_exit_status(self):
        status, lines = self.run_tests("-L", "long")
        self.assertNotEqual(status, 0)
        self.assertEqual(lines[-1], "skipped: nothing")

    def test_a_skip_of_each_kind_fails_a_run_in_which_nothing_may_be_skipped(self):
        for name in ("left", "unit", "python", "terse"):
            self.assertEqual(self.run_tests("-R", name)[0], 0)
            status, lines = self.run_tests("-R", name, nothing_skipped="1")
            self.assertEqual((status, lines[-1]), (1, f"nothing may be skipped in this run: {name}"))
        self.assertEqual(self.run_tests("-R", "good", nothing_skipped="1")[0], 0)

    def test_what_nobody_can_install_without_a_licence_is_excused_by_name_and_told(self):
        status, lines = self.run_tests("-R", "check_ti", nothing_skipped="1")
        self.assertEqual((status, lines[-1]), (0, "skipped: check_ti: no headers"))

    def test_the_processor_time_of_runs_is_told_beside_what_they_may_take_and_fails_nothing(self):
        def told(most_s):
            done = subprocess.run([sys.executable, "-B", RUN, "--spent", most_s, "build"], cwd=self.build.parent, capture_output=True,
                                  text=True, check=True)
            return done.stdout

        self.run_tests("-R", "busy")
        self.assertRegex(told("300"), r"^processor time: 1 s in build: 1 s, of the 300 s that they may take\n$")
        self.assertRegex(told("0.5"), r", MORE than the 0 s")

    def test_what_is_no_build_directory_is_named(self):
        for words in ((), ("test_flight",)):
            done = subprocess.run([sys.executable, "-B", RUN, *words], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (1, ""))
            self.assertIn("no build directory with tests; run.py BUILD -R NAME runs one test", done.stderr)
            self.assertNotIn("Traceback", done.stderr)

    def test_a_run_that_finds_no_test_fails(self):
        self.assertNotEqual(self.run_tests("-L", "nowhere")[0], 0)


if __name__ == "__main__":
    unittest.main()
