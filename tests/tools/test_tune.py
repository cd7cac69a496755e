"""tools/tune: what a candidate costs, where gains are looked for, and how a search ends. Argument: the plomada program.

Most flights here are those of a stand-in: its hover RMS grows with the distance of POSK and VELK from 3 and 5.
"""
import contextlib
import io
import json
import math
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
TUNE = ROOT / "tools/tune/tune.py"
PROGRAM = sys.argv.pop(1)
sys.path.insert(0, str(TUNE.parent))
import tune  # noqa: E402
from tune import plan  # noqa: E402

GOOD = {"failed": False, "started": True, "halted": False, "rise_time_s": 1.0, "overshoot_mm": 20.0,
        "hover_rms_mm": 10.0, "terrain_rms_mm": 80.0, "touch_speed_mps": 0.2, "thrust_std_n": 0.4,
        "ground_contacts": 0, "takeovers": 0}
STAND_IN = r"""#!/bin/sh
if [ "$1" = params ]; then cat {dir}/params; exit; fi
for path; do :; done
echo "$*" >> {dir}/log
[ ! -e {dir}/slow ] || sleep 0.1
[ ! -e {dir}/broken ] || {{ echo "no such wing" >&2; exit 3; }}
echo "$*" | awk -v RS=' ' -F= '$1 == "POSK" {{ p = $2 }} $1 == "VELK" {{ v = $2 }}
    END {{ hover = 10 + 20 * (p - 3) * (p - 3) + 5 * (v - 5) * (v - 5); printf "{figures}", hover }}' > "$path"
"""


def figures(**other):
    return GOOD | other


def vehicle_of(words):
    return tuple(word for word in words if word.startswith("plant.") or word.isdigit())


class Cost(unittest.TestCase):
    NOMINAL = 10.0 + (80.0 + 20.0) / 4.0 + 10.0 * 1.0
    DRAWN = 10.0 + 10.0

    def cost(self, nominal=(), drawn=()):
        return tune.cost([*nominal, *[figures()] * (4 - len(nominal))], [*drawn, *[figures()] * (20 - len(drawn))])

    def test_flights_that_do_well(self):
        self.assertAlmostEqual(self.cost(), self.NOMINAL + self.DRAWN)

    def test_a_failure_counts_as_500_mm_and_is_left_out_of_the_quantile(self):
        for bad in ({"failed": True}, {"takeovers": 1}, {"halted": True}, {"started": False}):
            lost = figures(hover_rms_mm=None, overshoot_mm=None, terrain_rms_mm=None, rise_time_s=None, **bad)
            self.assertAlmostEqual(self.cost(drawn=[lost]), self.NOMINAL + self.DRAWN + 490.0 / 20, msg=bad)
            self.assertAlmostEqual(self.cost(nominal=[lost]), self.cost() + (500.0 - self.NOMINAL) / 4, msg=bad)
        self.assertAlmostEqual(tune.cost([figures(failed=True)], [figures(failed=True)]), 1500.0)

    def test_a_contact_counts_whether_the_flight_failed_or_not(self):
        self.assertAlmostEqual(self.cost(drawn=[figures(ground_contacts=7)]), self.cost() + 100.0 / 20)
        self.assertAlmostEqual(self.cost(drawn=[figures(failed=True, ground_contacts=1)]),
                               self.cost(drawn=[figures(failed=True)]) + 100.0 / 20)

    def test_activity_of_the_nominal_vehicle_is_free_up_to_450_millinewtons(self):
        self.assertAlmostEqual(self.cost(nominal=[figures(thrust_std_n=0.45)] * 4), self.cost())
        self.assertAlmostEqual(self.cost(nominal=[figures(thrust_std_n=0.55)] * 4), self.cost() + 20.0)
        self.assertAlmostEqual(self.cost(drawn=[figures(thrust_std_n=3.0)] * 20), self.cost())

    def test_drawn_vehicles_count_by_mean_and_quantile(self):
        self.assertAlmostEqual(self.cost(drawn=[figures(hover_rms_mm=float(10 + k)) for k in range(20)]),
                               self.NOMINAL + 19.5 + 28.05)


class Gains(unittest.TestCase):
    ALL = sorted({gain for gains in tune.GAINS.values() for gain in gains}, key=lambda gain: gain.name)

    def test_a_value_survives_its_unit(self):
        for gain in self.ALL:
            for k in range(101):
                value = gain.value(k / 100.0)
                self.assertTrue(gain.low <= value <= gain.high, (gain, k))
                self.assertEqual(gain.value(gain.unit(value)), value, (gain, k))

    def test_the_ends_are_0_and_1_and_nothing_lies_beyond(self):
        for gain in self.ALL:
            self.assertAlmostEqual(gain.unit(gain.low), 0.0)
            self.assertAlmostEqual(gain.unit(gain.high), 1.0)
            self.assertEqual((gain.value(-0.1), gain.value(1.1)), (gain.low, gain.high))
            self.assertEqual(gain.unit(gain.low - 1.0), gain.unit(gain.low))
            self.assertEqual(gain.unit(gain.high * 2.0), gain.unit(gain.high))

    def test_rounding_stays_within_the_limits(self):
        gain = tune.Gain("KP", 0.0012345, 0.0098765)
        self.assertEqual((gain.value(0.0), gain.value(1.0)), (0.0012345, 0.0098765))

    def test_a_zero_is_reached_on_a_linear_scale_only(self):
        self.assertEqual(tune.Gain("DSAT", 0.0, 4.0).value(0.0), 0.0)
        self.assertEqual(tune.Gain("DSAT", 0.0, 4.0).value(0.25), 1.0)
        self.assertAlmostEqual(tune.Gain("KP", 0.01, 1.0).value(0.5), 0.1)

    def test_a_gain_at_its_limit_is_told(self):
        found = tune.at_limit(tune.GAINS["EST"], (2.0, 12.0, 0.2, 1.1))
        self.assertEqual(found, ["VELK 12 is at its limit, 1 to 12: the best may lie beyond", "VUP 0.2 is at its limit, 0.2 to 1.5: the best may lie beyond"])

    def test_numbers_are_typed_without_exponent(self):
        self.assertEqual([tune.text(value) for value in (0.00002, 5.0, 0.0, 12.3, 0.000183)],
                         ["0.00002", "5", "0", "12.3", "0.000183"])

    def test_the_program_has_every_gain_and_accepts_both_ends(self):
        for name, law in plan.LAWS.items():
            values = tune.present(PROGRAM, law)
            self.assertEqual(len(values), len(tune.gains_of(law)), name)
            for gain, value in zip(tune.gains_of(law), values, strict=True):
                self.assertTrue(gain.low <= value <= gain.high, (name, gain, value))

    def test_the_first_simplex_spans_all_gains_within_their_ranges(self):
        corners = tune.simplex([0.0, 0.49, 0.5, 1.0], 0.12)
        self.assertEqual(len(corners), 5)
        for place, corner in enumerate(corners[1:]):
            moved = [k for k in range(4) if corner[k] != corners[0][k]]
            self.assertEqual(moved, [place])
            self.assertTrue(0.0 <= corner[place] <= 1.0)


class Constants(unittest.TestCase):
    SOURCE = ("#define A 0.0013F /* fitted */\n#define B 28.0F           /* fitted; N per m */\n#define C 3.0F /* chosen */\n"
              "#define D 4U /* fitted */\n")

    def test_only_what_is_marked_as_fitted_is_found(self):
        self.assertEqual(tune.FITTED.findall(self.SOURCE), [("A", "0.0013"), ("B", "28.0")])

    def test_values_are_put_in_place_and_nothing_else_changes(self):
        self.assertEqual(tune.replaced(self.SOURCE, {"A": "0.002", "B": "30"}),
                         self.SOURCE.replace("0.0013F", "0.002F").replace("28.0F", "30.0F"))
        self.assertEqual(tune.replaced(self.SOURCE, {}), self.SOURCE)

    def test_the_estimators_law_has_its_constants_in_every_file_that_names_the_command(self):
        for path in (ROOT / "control/est").glob("*.c"):
            text = path.read_text(encoding="utf-8")
            with self.subTest(path=path.name):
                self.assertEqual("--constants" in text, bool(tune.FITTED.findall(text)))

    def test_each_candidate_is_a_program_of_its_own(self):
        done = subprocess.run([sys.executable, "-B", TUNE, "EST", "--constants", "est/cascade", "--runs", "1", "--flights", "8"],
                              capture_output=True, text=True, check=False, timeout=280)
        self.assertEqual(done.returncode, 0, done.stderr)
        names = tune.FITTED.findall((ROOT / "control/est/cascade.c").read_text(encoding="utf-8"))
        self.assertEqual(re.findall(r"^#define (\w+) [\d.]+F$", done.stdout, re.M), [name for name, _ in names])
        self.assertRegex(done.stderr, r"cost [\d.]+ after [2468] flights")

    def test_a_place_without_fitted_constants_is_status_2(self):
        done = subprocess.run([sys.executable, "-B", TUNE, "EST", "--constants", "no_such_file"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("no_such_file", done.stderr)


class Searching(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)
        self.program = self.dir / "plomada"
        body = json.dumps(figures(hover_rms_mm="AWK")).replace('"AWK"', "%.6f").replace('"', r'\"')
        self.program.write_text(STAND_IN.format(dir=self.dir, figures=body), encoding="utf-8")
        self.program.chmod(0o755)
        shown = subprocess.run([PROGRAM, "params"], capture_output=True, text=True, check=True).stdout
        (self.dir / "params").write_text(shown, encoding="utf-8")

    def tune(self, *words):
        """(exit status, stdout, stderr)."""
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
            status = tune.main([*words, "--program", str(self.program)])
        return status, out.getvalue(), err.getvalue()

    def flown(self):
        return (self.dir / "log").read_text().splitlines()

    def test_it_finds_the_best_gains_and_prints_the_commands(self):
        status, out, err = self.tune("EST", "--flights", "480", "--runs", "3")
        self.assertEqual(status, 0, err)
        commands = dict(line[1:].split() for line in out.splitlines() if re.fullmatch(r"#[A-Z]+ \S+", line))
        self.assertEqual(list(commands), ["LAW", "POSK", "VELK", "VUP", "VDN"])
        self.assertEqual(commands["LAW"], "EST")
        self.assertAlmostEqual(float(commands["POSK"]), 3.0, delta=0.15)
        self.assertAlmostEqual(float(commands["VELK"]), 5.0, delta=0.3)

    def test_the_budget_is_kept_and_used(self):
        for budget in (4, 61, 100):
            (self.dir / "log").unlink(missing_ok=True)
            status, _, err = self.tune("EST", "--flights", str(budget), "--runs", "3")
            self.assertEqual(status, 0, err)
            self.assertTrue(budget - 4 < len(self.flown()) <= budget, (budget, len(self.flown())))

    def test_candidates_fly_the_same_vehicles_which_are_not_the_campaigns(self):
        self.tune("PID-TUNED", "--flights", "40", "--runs", "6")
        vehicles = [vehicle_of(line.split()) for line in self.flown()]
        self.assertEqual(len(vehicles), 40)
        self.assertEqual({vehicles.count(vehicle) for vehicle in vehicles}, {5})
        campaign = {vehicle_of(plan.arguments(plan.LAWS["PID"], name, 1, run)) for name in plan.SETS
                    for run in range(1, 201)}
        self.assertFalse(campaign & set(vehicles))

    def test_the_first_candidate_is_the_present_one(self):
        self.tune("PID-TUNED", "--flights", "4", "--runs", "3")
        for line in self.flown():
            for name, value in plan.LAWS["PID-TUNED"].settings.items():
                self.assertIn(f"--set {name}={value} ", line)

    def test_a_search_that_finds_no_more_ends_before_its_budget(self):
        (self.dir / "log").unlink(missing_ok=True)
        self.tune("EST", "--flights", "100000", "--runs", "1")
        self.assertLess(len(self.flown()), 2000)

    def test_a_broken_program_is_status_2(self):
        (self.dir / "broken").touch()
        status, out, err = self.tune("EST", "--flights", "40", "--runs", "3")
        self.assertEqual((status, out), (2, ""))
        self.assertIn("no such wing", err)
        self.program.unlink()
        self.assertEqual(self.tune("EST")[:2], (2, ""))

    def test_a_missing_or_narrower_parameter_is_status_2(self):
        params = (self.dir / "params").read_text()
        for name, text in (("no parameter VELK", re.sub(r"(?m)^VELK.*\n", "", params)),
                           ("VELK: the search from 1 to 12 leaves",
                            re.sub(r"(?m)^VELK( +\S+ +\S+) +12 ", r"VELK\1 9 ", params))):
            self.assertNotEqual(text, params)
            (self.dir / "params").write_text(text)
            status, out, err = self.tune("EST")
            self.assertEqual((status, out), (2, ""))
            self.assertIn(name, err)

    def test_usage_errors_are_status_2(self):
        for words in ((), ("PIDX",), ("EST", "--flights", "0"), ("EST", "--flights", "39", "--runs", "30")):
            with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(io.StringIO()):
                tune.main([*words])
            self.assertEqual(end.exception.code, 2, words)

    def test_an_interruption_is_status_130(self):
        (self.dir / "slow").touch()
        tuner = subprocess.Popen([sys.executable, "-B", TUNE, "EST", "--program", self.program], stdout=subprocess.PIPE,
                                 stderr=subprocess.PIPE, text=True)
        self.addCleanup(tuner.kill)
        end = time.monotonic() + 30.0
        while time.monotonic() < end and not (self.dir / "log").exists():
            time.sleep(0.05)
        tuner.send_signal(signal.SIGINT)
        out, err = tuner.communicate(timeout=15)
        self.assertEqual((tuner.returncode, out), (130, ""))
        self.assertNotIn("Traceback", err)

    def test_the_firmware_accepts_what_is_printed(self):
        for name, law in plan.LAWS.items():
            with mock.patch.object(tune, "search", lambda candidates, units: candidates(units)):
                self.program = Path(PROGRAM)
                status, out, err = self.tune(name, "--flights", "2", "--runs", "1")
            self.assertEqual(status, 0, err)
            settings = [word for line in out.splitlines() for word in ("--set", line[1:].replace(" ", "="))]
            self.assertGreaterEqual(len(settings), 2 * (1 + len(tune.gains_of(law))))
            done = tune.fleet.fly(PROGRAM, [law.scenario, *settings])
            self.assertEqual(done["commands_err"], 0)
            self.assertTrue(math.isfinite(done["hover_rms_mm"]))


if __name__ == "__main__":
    unittest.main()
