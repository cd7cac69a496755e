"""`plomada rta` as its users call it. Argument: the plomada program."""
import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = sys.argv.pop(1)
HEADER = "name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings\n"
# Burns and Wellings, Real-Time Systems and Programming Languages: responses 3, 6, 20.
BOOK = HEADER + "a,task,3,7,7,3,0,0\nb,task,2,12,12,3,0,0\nc,task,1,20,20,5,0,0\n"


class Command(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)

    def rta(self, *arguments):
        done = subprocess.run([PROGRAM, "rta", *arguments], cwd=self.dir, check=False, capture_output=True, text=True)
        return done.returncode, done.stdout, done.stderr

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

    def test_help(self):
        status, out, _ = self.rta("--help")
        self.assertEqual(status, 0)
        for option in ("--switch-ms", "--access-ms", "--jitter", "--bursts", "--chain", "--set", "--json", "--print"):
            self.assertIn(option, out)


if __name__ == "__main__":
    unittest.main()
