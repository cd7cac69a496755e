"""Each step of tools/bench runs, and what docs/reliability.md says that they cost is the baseline. To count them takes valgrind: `make bench`.

Argument: a directory to build in.
"""
import re
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/bench"))
import bench  # noqa: E402

BUILD = Path(sys.argv.pop(1))


class Steps(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.program = bench.build(BUILD)
        done = subprocess.run([cls.program], check=True, capture_output=True, text=True)
        cls.names = done.stdout.split()

    def test_each_step_runs_as_it_is_meant(self):
        for name in self.names:
            with self.subTest(name):
                done = subprocess.run([self.program, name], capture_output=True, text=True)
                self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_the_baseline_has_each_step(self):
        self.assertEqual(list(bench.read_baseline()), self.names)

    def test_the_page_tells_the_baseline(self):
        page = (ROOT / "docs/reliability.md").read_text(encoding="utf-8")
        told = re.search(r"`make bench` counts ([\d ]+) on x86-64 with one mirror, and ([\d ]+) with\s+three.*?"
                         r"on a ramp it is ([\d ]+): ", page, re.DOTALL)
        counts = bench.read_baseline()
        self.assertEqual([figure.replace(" ", "") for figure in told.groups()],
                         [counts[name]["instructions"] for name in ("TaskControl_EST", "TaskControl_THREE", "TaskControl_IGNORE")])


if __name__ == "__main__":
    unittest.main()
