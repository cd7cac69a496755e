"""What a tool cannot do it says in a line, with status 2 and no traceback, whoever calls it how. Usage: test_faults_named.py PLOMADA"""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = sys.argv.pop(1)


class Faults(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)

    def named(self, reason, tool, *words):
        done = subprocess.run([sys.executable, "-B", ROOT / tool, *map(str, words)], cwd=self.dir, capture_output=True, text=True, check=False,
                              stdin=subprocess.DEVNULL, timeout=100)
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertNotIn("Traceback", done.stderr)
        self.assertIn(reason, done.stderr)

    def test_a_law_that_is_none(self):
        self.named("pid: no such law; one of PD, PID", "tests/rules/walk.py", "--show", "pid")

    def test_a_server_without_a_folder_or_a_port(self):
        self.named("DIRECTORY, PORT", "tools/ground/serve.py")
        self.named("/nonexist: no directory", "tools/ground/serve.py", "/nonexist", 0)
        self.named("port 99999: ", "tools/ground/serve.py", self.dir, 99999)

    def test_a_program_that_is_not_there(self):
        self.named("/nonexist: no program; make build", "tools/noise/noise.py", "/nonexist")
        for number in (1, 3):
            self.named(f"/nonexist: not there; `make lab N={number}` builds it", "course/mark/lab.py", number, "--marker", "/nonexist", "--plomada", "/nonexist")

    def test_a_verdict_before_there_is_a_forecast(self):
        log = self.dir / "b.csv"
        log.write_text("t_s\n", encoding="utf-8")
        self.named("none.json: no forecast; `make tune VEHICLE=", "tools/fit/verdict.py", log, "--forecast", self.dir / "none.json")

    def test_a_picture_in_a_folder_that_is_not_there_or_over_the_log(self):
        log = self.dir / "b.csv"
        log.write_text("t_s\n", encoding="utf-8")
        self.named("new is no folder", "tools/why/why.py", log, "--out", self.dir / "new/w.png", "--program", PROGRAM)
        self.assertFalse((self.dir / "new").exists())
        self.named("b.csv: is read here", "tools/why/why.py", log, "--out", log, "--program", PROGRAM)
        self.assertEqual(log.read_text(encoding="utf-8"), "t_s\n")

    def test_a_setting_that_no_flight_takes(self):
        self.named("KP=5: out of range 0..1 N/mm", "tools/campaign/campaign.py", "--law", "EST", "--set", "nominal", "--set", "KP=5", "--runs", 1,
                   "--program", PROGRAM, "--out", self.dir / "out")


if __name__ == "__main__":
    unittest.main()
