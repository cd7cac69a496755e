"""tools/rta/rta.py as its users call it."""
import contextlib
import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TOOL = Path(__file__).resolve().parents[3] / "tools/rta"
PROGRAM = (sys.executable, "-B", str(TOOL / "rta.py"))
sys.path.insert(0, str(TOOL))
import rta  # noqa: E402

FULL = "/dev/full"
HEADER = "name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings\n"
# Burns and Wellings, Real-Time Systems and Programming Languages: responses 3, 6, 20.
BOOK = HEADER + "a,task,3,7,7,3,0,0\nb,task,2,12,12,3,0,0\nc,task,1,20,20,5,0,0\n"


class Command(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)

    def program(self, *arguments):
        done = subprocess.run([*PROGRAM, *arguments], cwd=self.dir, check=False, capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

    def rta(self, *arguments):
        """As the program, without a start of Python each time."""
        out, err, before, words = io.StringIO(), io.StringIO(), os.getcwd(), sys.argv
        os.chdir(self.dir)
        sys.argv = [PROGRAM[-1], *arguments]
        try:
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
                status = rta.main()
        except SystemExit as ended:     # argparse
            status = ended.code
        finally:
            os.chdir(before)
            sys.argv = words
        return status, out.getvalue(), err.getvalue()

    def test_the_program_says_what_a_call_of_it_does(self):
        for words in (("seed",), ("--bogus",), ("no-such-file",)):
            self.assertEqual(self.program(*words), self.rta(*words), words)

    def write(self, text, name="table.csv"):
        (self.dir / name).write_text(text, encoding="utf-8", newline="")
        return name

    def column(self, output, index):
        return [line.split()[index] for line in output.splitlines()[1:] if not line.split()[0].endswith(":") and "all" not in line]

    def test_the_seed_is_the_default(self):
        status, out, error = self.rta()
        self.assertEqual((status, error), (0, ""))
        self.assertEqual(out, self.rta("seed")[1])
        self.assertEqual(self.column(out, 3), ["4.6151", "18.0610", "20.7323", "22.5766", "24.8147", "29.7308"])
        self.assertEqual(self.column(out, 6), ["0.9461", "2.3086", "2.9155", "2.9130", "4.1009", "5.0730"])

    def test_a_file_is_read_and_deadlines_decide_the_status(self):
        name = self.write(BOOK)
        status, out, _ = self.rta(name, "--switch-ms", "0")
        self.assertEqual((status, self.column(out, 6)), (0, ["3.0000", "6.0000", "20.0000"]))
        status, out, _ = self.rta(name)
        self.assertEqual(status, 1)
        self.assertRegex(out, r"(?m)^c .* LATE$")
        self.assertIn("NOT all deadlines hold", out)

    def test_no_bound_is_a_dash(self):
        status, out, _ = self.rta(self.write(HEADER + "a,task,2,2,2,2,0,0\nb,task,1,20,20,1,0,0\n"), "--switch-ms", "0")
        self.assertEqual((status, self.column(out, 6)), (1, ["2.0000", "-"]))

    def test_print_gives_back_a_table_that_reads_the_same(self):
        for name in ("seed", "plomada", "plomada-est"):
            status, text, _ = self.rta(name, "--print")
            self.assertEqual(status, 0)
            copy = self.write(text)
            self.assertEqual(self.rta(copy)[1].splitlines()[1:], self.rta(name)[1].splitlines()[1:])

    def measured(self, task_ns=900000, hold_ns=20000):
        """An answer to #PERF COSTS of a board with one interrupt, two tasks and two gates."""
        rows = [("tick", "longest", 15000), ("low", "longest", 2 * task_ns), ("high", "longest", task_ns), ("never", "longest", 0),
                ("imu", "hold", hold_ns), ("laser", "hold", hold_ns // 2)]
        return [f"OK PERF COSTS {i} {name} {kind}_ns:{ns}" for i, (name, kind, ns) in enumerate(rows, 1)] + [f"OK PERF END lines:{len(rows)}"]

    TABLE = HEADER + "tick,hwi,,1,,0.010,,\nhigh,task,3,10,10,0.5,0.01,1\nhigh_too,task,3,20,20,0.5,0.01,1\nlow,task,1,50,50,1,0,0\n"

    def test_what_a_board_measured_stands_beside_the_table(self):
        table = self.write(self.TABLE)
        saved = self.write("alt:0.60 ref:0.6\r\n" + "\r\nalt:0.60 ref:0.6\r\n".join(self.measured()) + "\r\n", "saved.txt")
        status, out, error = self.rta(table, "--measured", saved)
        self.assertEqual((status, error), (0, ""))
        self.assertRegex(out, r"(?m)^tick +0\.0100 +0\.0150$")
        self.assertRegex(out, r"(?m)^high +0\.5570 +0\.9000$")
        self.assertRegex(out, r"(?m)^high_too +0\.5570 +0\.9000$")
        self.assertRegex(out, r"(?m)^low +1\.0570 +1\.8000$")
        self.assertRegex(out, r"(?m)^hold of a gate +0\.0093 +0\.0200 imu$")
        # high: itself and its equal, the hold and the switches of its one blocking, two ticks; by hand.
        self.assertRegex(out, r"(?m)^high +10 +1\.2010 +1\.9070 +8\.7990 +8\.0930$")
        # the same by a table that has these costs: nothing else is in the measured ones
        same = self.write(HEADER + "tick,hwi,,1,,0.015,,\nhigh,task,3,10,10,0.843,0.02,1\nhigh_too,task,3,20,20,0.843,0.02,1\n"
                          "low,task,1,50,50,1.743,0,0\n", "same.csv")
        responses = dict(zip(("high", "high_too", "low"), self.column(self.rta(same)[1], 6)))
        for name, response in responses.items():
            self.assertRegex(out, rf"(?m)^{name} +\d+ +\S+ +{response} ")

    def test_a_slow_board_is_late_and_the_status_says_so(self):
        saved = self.write("\n".join(self.measured(task_ns=6000000)) + "\n", "saved.txt")
        status, out, _ = self.rta(self.write(self.TABLE), "--measured", saved)
        self.assertEqual(status, 1)
        self.assertRegex(out, r"(?m)^high .* LATE$")
        self.assertIn("NOT all deadlines hold on this board", out)

    def test_what_the_board_did_not_measure_is_named_and_nothing_measured_is_no_verdict(self):
        table, lines = self.write(self.TABLE), self.measured()
        saved = self.write("\n".join(lines).replace("low longest_ns:1800000", "low longest_ns:0") + "\n", "saved.txt")
        status, out, _ = self.rta(table, "--measured", saved)
        self.assertEqual((status, out.splitlines()[-2:]), (0, ["not measured, taken from the table: low", "all deadlines hold on this board"]))
        self.assertNotIn("not measured", self.rta(table, "--measured", self.write("\n".join(lines) + "\n", "whole.txt"))[1])
        status, out, error = self.rta(table, "--measured", self.write("\n".join(self.measured(0, 0)).replace(":15000", ":0") + "\n", "idle.txt"))
        self.assertEqual((status, out), (2, ""))
        self.assertIn("idle.txt: no row of the table was measured, so there is no verdict", error)

    def test_the_console_log_of_xctu_is_read_too(self):
        text = "\r\n".join(self.measured()) + "\r\n"
        packets = [text[i:i + 37].encode().hex(" ").upper() for i in range(0, len(text), 37)]
        log = "".join(f"11-22-2026 10:00:{i % 60:02d}.123,{i},RECV,{hexed}\n" for i, hexed in enumerate(packets))
        table = self.write(self.TABLE)
        plain = self.rta(table, "--measured", self.write(text, "saved.txt"))
        self.assertEqual(self.rta(table, "--measured", self.write(log, "xctu.log")), plain)

    def test_of_two_answers_the_last_counts_and_a_broken_one_is_refused(self):
        table, lines = self.write(self.TABLE), self.measured()
        twice = self.write("\n".join(self.measured(task_ns=1) + lines) + "\n", "twice.txt")
        once = self.write("\n".join(lines) + "\n", "once.txt")
        self.assertEqual(self.rta(table, "--measured", twice), self.rta(table, "--measured", once))
        for left_out in range(len(lines)):
            broken = self.write("\n".join(lines[:left_out] + lines[left_out + 1:]) + "\n", "broken.txt")
            status, _, error = self.rta(table, "--measured", broken)
            self.assertEqual(status, 2, left_out)
            self.assertIn("no whole answer to #PERF COSTS", error)

    def test_options_change_the_figures(self):
        plain = self.rta("plomada")[1]
        for options in (["--jitter", "1"], ["--bursts"], ["--switch-ms", "0.1"], ["--access-ms", "0.02"],
                        ["--set", "TaskIMU.cost_ms=0.2"]):
            self.assertNotEqual(self.rta("plomada", *options)[1], plain, options)

    def test_json_has_the_same_figures(self):
        chain = "Laser_SWI,TaskReceiveLaser,TaskControl"
        status, out, _ = self.rta("--chain", chain, "--json", "rta.json")
        figures = json.loads((self.dir / "rta.json").read_text(encoding="utf-8"))
        self.assertEqual((status, figures["holds"]), (0, True))
        for index, key in ((3, "demand_seed_ms"), (4, "demand_ms"), (5, "demand_switching_ms"), (6, "response_ms"), (7, "slack_ms")):
            self.assertEqual(self.column(out, index), [f"{task[key]:.4f}" for task in figures["tasks"]])
        self.assertEqual(figures["chain"], {"members": chain, "response_ms": 3.0895})
        self.assertAlmostEqual(figures["growth"], 5.18865, places=4)
        self.assertAlmostEqual(figures["load"]["total"], 0.194, places=3)

    def test_json_of_no_bound_is_null(self):
        status, _, _ = self.rta(self.write(HEADER + "a,task,1,2,2,3,0,0\n"), "--json", "rta.json")
        task = json.loads((self.dir / "rta.json").read_text(encoding="utf-8"))["tasks"][0]
        self.assertEqual((status, task["response_ms"], task["slack_ms"]), (1, None, None))

    def test_a_bad_file_is_refused_with_its_line(self):
        status, out, error = self.rta(self.write(BOOK + "d,task,1,20,20,soon,0,0\n"))
        self.assertEqual((status, out), (2, ""))
        self.assertIn("table.csv:5: cost_ms: not a time", error)
        for text in ("", "hello\n", "\0" * 100, HEADER, HEADER + "x" * 70000):
            status, out, error = self.rta(self.write(text))
            self.assertEqual((status, out), (2, ""), text[:20])
            self.assertIn("table.csv", error)
        self.assertEqual(self.rta("no-such-file")[0], 2)
        self.assertEqual(self.rta(str(self.dir))[0], 2)

    def test_usage_errors(self):
        for wrong in (["--bogus"], ["seed", "plomada"], ["--jitter", "-1"], ["--jitter", "1x"], ["--jitter", "nan"], ["--jitter", ""],
                      ["--switch-ms", "."], ["--switch-ms", "1e9"], ["--access-ms", "100001"], ["--set", "TaskIMU.cost_ms=0"],
                      ["--set", "TaskX.cost_ms=1"], ["--chain", "TaskX"], ["--chain", ""], ["--chain", "TaskControl,Laser_SWI"],
                      ["--chain", "TaskControl,TaskIMU"], ["--chain", "TaskIMU,TaskIMU"], ["--json", "no/such/dir/x.json"]):
            status, out, error = self.rta(*wrong)
            self.assertEqual((status, out), (2, ""), wrong)
            self.assertNotEqual(error, "", wrong)

    @unittest.skipUnless(os.path.exists(FULL), "no /dev/full")
    def test_what_does_not_fit_on_the_disk_is_status_2(self):
        self.assertEqual(self.rta("--json", FULL)[0], 2)
        for words in ((), ("--print",)):
            with open(FULL, "w", encoding="utf-8") as full:
                done = subprocess.run([*PROGRAM, *words], stdout=full, stderr=subprocess.PIPE, check=False, text=True)
            self.assertEqual(done.returncode, 2, words)
            self.assertIn("No space left", done.stderr)

    def test_help(self):
        status, out, _ = self.rta("--help")
        self.assertEqual(status, 0)
        for option in ("--switch-ms", "--access-ms", "--jitter", "--bursts", "--chain", "--set", "--measured", "--json", "--print"):
            self.assertIn(option, out)


if __name__ == "__main__":
    unittest.main()
