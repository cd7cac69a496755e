"""Each step of tools/bench runs, and what docs/reliability.md says that they cost is the baseline. To count them takes valgrind: `make bench`.

Argument: a directory to build in.
"""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/bench"))
import bench  # noqa: E402

BUILD = Path(sys.argv.pop(1))
TELLING = ("tools/rta/plomada-est.csv", "docs/realtime.md", "docs/reliability.md")


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

    def test_what_tells_the_counts_tells_the_baseline(self):
        """A new baseline alone had left the pages, or the pages had left it: each `--write` puts both."""
        counts = {name: int(row["instructions"]) for name, row in bench.read_baseline().items()}
        with tempfile.TemporaryDirectory() as directory:
            for path in TELLING:
                (Path(directory) / path).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(ROOT / path, Path(directory) / path)
            bench.tell(counts, Path(directory))
            for path in TELLING:
                self.assertEqual((Path(directory) / path).read_text(), (ROOT / path).read_text(), f"{path}: make bench ARGS=--write")
            other = {**counts, "TaskControl_THREE": 2 * counts["TaskControl_THREE"], "TaskControl_IGNORE": 2 * counts["TaskControl_IGNORE"]}
            bench.tell(other, Path(directory))
            for path in TELLING:
                self.assertNotEqual((Path(directory) / path).read_text(), (ROOT / path).read_text(), path)


if __name__ == "__main__":
    unittest.main()
