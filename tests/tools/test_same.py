"""tools/same: two commits that fly alike are told from two that do not. A repository whose program is a shell script."""
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
LISTS = """cmake_minimum_required(VERSION 3.22)
project(sample NONE)
add_custom_target(plomada COMMAND "${CMAKE_COMMAND}" -E copy "${CMAKE_SOURCE_DIR}/plomada.sh" "${CMAKE_BINARY_DIR}/plomada")
"""
PROGRAM = """#!/bin/sh
[ "$1" != list ] || {{ printf 'hover\\n    summary\\nramp\\n    summary\\n'; exit; }}
echo "$2 $4 {figure}" > "$6"
exit {status}
"""


class Same(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root = Path(scratch.name)
        self.git("init", "-q")
        (self.root / "tools").mkdir()
        (self.root / "tools/same.sh").write_bytes((ROOT / "tools/same/same.sh").read_bytes())
        (self.root / "CMakeLists.txt").write_text(LISTS, encoding="utf-8")
        self.commit("1.0")

    def git(self, *words):
        subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@example.org", *words], cwd=self.root, check=True, capture_output=True)

    def write(self, figure, status=0):
        script = self.root / "plomada.sh"
        script.write_text(PROGRAM.format(figure=figure, status=status), encoding="utf-8")
        script.chmod(0o755)

    def commit(self, figure):
        self.write(figure)
        self.git("add", ".")
        self.git("commit", "-qm", figure)

    def same(self, *words):
        done = subprocess.run(["bash", self.root / "tools/same.sh", *words], capture_output=True, text=True, check=False)
        return done.returncode, done.stdout.splitlines(), done.stderr

    def test_files_that_fly_like_head_are_the_same(self):
        self.assertEqual(self.same()[:2], (0, ["6 flights, 0 differ"]))

    def test_a_change_is_named_by_scenario_and_seed(self):
        self.write("1.1")
        status, said, _ = self.same()
        self.assertEqual(status, 1)
        self.assertEqual(said[0], "differs: hover --seed 1")
        self.assertEqual(said[-1], "6 flights, 6 differ")

    def test_two_commits_are_compared_whatever_the_files_are(self):
        self.commit("1.2")
        self.write("1.3")
        self.assertEqual(self.same("HEAD~1..HEAD")[0], 1)
        self.assertEqual(self.same("HEAD..HEAD")[0], 0)

    def test_a_program_that_does_not_fly_and_wrong_usage_are_status_2(self):
        self.write("1.0", status=3)
        self.assertEqual(self.same()[0], 2)
        self.assertEqual(self.same("nonsense")[0], 2)


if __name__ == "__main__":
    unittest.main()
