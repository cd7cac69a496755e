"""tools/plot/trace.py draws a scan's way to the pulse, and refuses what is no such trace. Needs the plot environment."""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[3] / "tools/plot/trace.py"


def label(pid, tid, name):
    return {"ph": "M", "pid": pid, "tid": tid, "name": "thread_name", "args": {"name": name}}


def span(pid, tid, name, begin, end, **args):
    return {"ph": "X", "pid": pid, "tid": tid, "name": name, "ts": begin, "dur": end - begin, "args": args}


def run(tid, name, begin, end):
    return [span(1, 1, name, begin, end), span(2, tid, "runs", begin, end), span(2, tid, name, begin, end)]


def schedule(pulse_changed=True):
    return ([label(1, 1, "runs"), label(2, 96, "Hwi 96 SCIA_RX"), label(2, 1001, "Swi 2 Laser_SWI"),
             label(2, 2001, "Task 5 TaskReceiveLaser"), label(2, 2002, "Task 4 TaskControl"), label(3, 1, "Altitude_server")]
            + [span(4, 1, "frame", 6000, 10000, octets=101)] + run(96, "SCIA_RX", 10000, 10002.4)
            + run(1001, "Laser_SWI", 10002.4, 10304.4) + run(2001, "TaskReceiveLaser", 10304.4, 11400)
            + [span(3, 1, "TaskReceiveLaser", 11390, 11400)] + run(2002, "TaskControl", 11400, 11900)
            + [{"ph": "i", "pid": 4, "tid": 2, "name": "compare 3000", "ts": 11890.6, "s": "t",
                "args": {"after_scan_us": 1890.6}},
               span(4, 3, "1400.0 us", 1000, 2400, changed=False),
               span(4, 3, "1390.0 us", 14600, 15990, changed=pulse_changed)])


class PlotTrace(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.TemporaryDirectory()
        self.trace = Path(self.directory.name) / "t.json"
        self.picture = Path(self.directory.name) / "t.png"

    def tearDown(self):
        self.directory.cleanup()

    def draw(self, text, *arguments):
        self.trace.write_text(text, encoding="utf-8")
        return subprocess.run([sys.executable, "-B", SCRIPT, self.trace, *arguments], check=False, capture_output=True, text=True)

    def test_it_draws_and_prints_the_path(self):
        result = self.draw(json.dumps({"traceEvents": schedule()}))
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(result.stdout.strip(), str(self.picture.resolve()))
        self.assertEqual(self.picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertGreater(self.picture.stat().st_size, 10000)

    def test_a_scan_that_changed_no_pulse_is_refused(self):
        result = self.draw(json.dumps({"traceEvents": schedule(pulse_changed=False)}))
        self.assertEqual(result.returncode, 2)
        self.assertIn("no scan that changed the pulse", result.stderr)
        self.assertFalse(self.picture.exists())

    def test_what_is_no_trace_is_refused(self):
        for text in ("", "{}", "[]", "t_s,height_m\n"):
            result = self.draw(text)
            self.assertEqual(result.returncode, 2, text)
            self.assertNotIn("Traceback", result.stderr)

    def test_a_file_that_is_not_there_is_refused(self):
        result = subprocess.run([sys.executable, "-B", SCRIPT, "/nowhere.json"], check=False, capture_output=True, text=True)
        self.assertEqual(result.returncode, 2)
        self.assertNotIn("Traceback", result.stderr)


if __name__ == "__main__":
    unittest.main()
