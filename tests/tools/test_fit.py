"""tools/fit on flights of simulated vehicles. Usage: test_fit.py PLOMADA"""
import contextlib
import io
import json
import os
import random
import shutil
import statistics
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/fit"))
import acceptance  # noqa: E402
import flight_log  # noqa: E402
import forecast  # noqa: E402
import model  # noqa: E402
import tune_vehicle  # noqa: E402
import numpy  # noqa: E402
import verdict  # noqa: E402

PROGRAM = None
THRUST = {"hover_thrust": 8.1, "gain": 1.2, "tau": 0.08, "tdelay": 0.02}
PART_S = 15.0                   # of the recorder's 25 s: it takes less time
CLIMB = {"climb_rate": 0.65, "climb_neutral": 7.4, "climb_deadband": 0.2, "climb_lag": 0.4}


class Fit(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)

    def fly(self, seed, plant, scenario="experiment", settings=None):
        """What the chip's recorder holds, as an operator saves it and `plomada log` reads it."""
        path = self.dir / f"{seed}.csv"
        words = [word for name, value in plant.items() for word in ("--set", f"plant.{name}={value}")]
        words += [word for name, value in (settings or {}).items() for word in ("--set", f"{name}={value}")]
        # A log that is asked for before the vehicle is down goes on, and its oldest row may be overwritten meanwhile.
        subprocess.run([PROGRAM, "fly", scenario, "--seed", str(seed), "--until-down", "20", *words, "--log", path.with_suffix(".log")],
                       check=False, stdout=subprocess.DEVNULL)
        subprocess.run([PROGRAM, "log", path.with_suffix(".log"), "--force"], check=True, stdout=subprocess.DEVNULL)
        if scenario == "experiment":
            titles, *rows = path.read_text().splitlines()
            until_s = float(rows[0].split(",")[0]) + PART_S
            path.write_text("\n".join([titles, *(row for row in rows if float(row.split(",")[0]) < until_s)]) + "\n")
        return path

    def fit(self, *logs):
        out = self.dir / "vehicle.json"
        done = subprocess.run([sys.executable, "-B", ROOT / "tools/fit/fit.py", *logs, "--out", out], capture_output=True,
                              text=True, check=False)
        if done.returncode == 0:
            self.assertEqual(out.with_suffix(".png").read_bytes()[:4], b"\x89PNG")
        return done, json.loads(out.read_text()) if out.exists() else None

    def assert_near(self, vehicle, key, true, share):
        self.assertLess(abs(vehicle[key]["value"] - true), share * true, f"{key}: {vehicle[key]}, truth {true}")

    def test_a_vehicle_whose_throttle_commands_thrust(self):
        done, vehicle = self.fit(self.fly(4711, THRUST))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(vehicle["throttle"], "THRUST", done.stdout)
        self.assertEqual(vehicle["beyond"], [])
        self.assert_near(vehicle, "plant.hover_thrust", 8.1, 0.02)
        self.assert_near(vehicle, "authority", 9.80665 * 1.2 / 8.1, 0.12)
        self.assertLess(abs(vehicle["response"]["value"] - 0.1), 0.02, vehicle["response"])
        for key, true in (("plant.hover_thrust", 8.1), ("plant.gain", 1.2)):
            self.assertLess(vehicle[key]["low"], vehicle[key]["value"])
            self.assertLess(vehicle[key]["value"], vehicle[key]["high"])
            self.assertLess(vehicle[key]["high"] - vehicle[key]["low"], 0.3 * true)
        again = subprocess.run([PROGRAM, "fly", "est-60cm-ramp", "--vehicle", self.dir / "vehicle.json", "--json",
                                self.dir / "again.json"], check=False, stdout=subprocess.DEVNULL)
        self.assertIn(again.returncode, (0, 1))
        self.assertFalse(json.loads((self.dir / "again.json").read_text())["failed"])

    def test_a_vehicle_whose_throttle_commands_a_climb_rate(self):
        done, vehicle = self.fit(self.fly(4712, CLIMB))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(vehicle["throttle"], "CLIMB", done.stdout)
        self.assert_near(vehicle, "plant.climb_neutral", 7.4, 0.02)
        self.assert_near(vehicle, "authority", 0.65, 0.15)

    def test_a_vehicle_of_other_equations_is_named_and_its_intervals_are_wide_enough(self):
        done, vehicle = self.fit(self.fly(4719, {"airframe": 1}))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("the rotors slow down later than they spin up", done.stdout)
        self.assertIn("beyond the model", done.stdout)
        for key, true in (("plant.hover_thrust", 7.4), ("response", 0.01 + (0.07 + 0.16) / 2.0)):
            self.assertLess(vehicle[key]["low"], true, f"{key}: {vehicle[key]}")
            self.assertGreater(vehicle[key]["high"], true, f"{key}: {vehicle[key]}")
        self.assertLess(abs(vehicle["response"]["value"] - 0.125), 0.045, vehicle["response"])

    def fly_batteries(self, power, charges, measured="PIN"):
        plant = {"battery": 1, "volts_power": power, "sag": 0}
        logs = []
        for number, charge in enumerate(charges):
            logs.append(self.fly(4730 + number, plant | {"battery_charge": charge}, settings={"BAT": measured}))
        return logs

    # Without the voltage the second flight's hover thrust is that of another vehicle, and the fit bends its other figures to it.
    def test_the_hover_thrust_goes_with_the_voltage_that_the_logs_have(self):
        done, vehicle = self.fit(*self.fly_batteries(1.65, (1.0, 0.25)))
        self.assertEqual(done.returncode, 0, done.stderr)
        power, hovers = vehicle["volts_power"], vehicle["hover_over_volts"]
        self.assertLess(power["low"], 1.65)
        self.assertGreater(power["high"], 1.65)
        self.assertLess(power["high"] - power["low"], 0.6)
        self.assertLess(abs(hovers[-1][1] - 7.4), 0.03 * 7.4, hovers)       # of the full one
        self.assertGreater(hovers[0][1], hovers[-1][1] + 1.2)
        self.assertIn("by the voltage to the power of -", done.stdout)
        again = subprocess.run([PROGRAM, "fly", "est-60cm-ramp", "--vehicle", self.dir / "vehicle.json"], check=False, stdout=subprocess.DEVNULL)
        self.assertIn(again.returncode, (0, 1))
        self.assertEqual(len(forecast.draws(forecast.load_vehicle(self.dir / "vehicle.json"), 3, 1)), 3)

    def test_an_autopilot_that_compensates_is_seen_as_one(self):
        power = self.fit(*self.fly_batteries(0, (1.0, 0.25)))[1]["volts_power"]
        self.assertLess(abs(power["value"]), 0.3)
        self.assertLess(power["low"], 0.0)
        self.assertGreater(power["high"], 0.0)

    def test_a_voltage_that_is_not_measured_or_not_believed_is_none(self):
        good, = self.fly_batteries(1.65, (1.0,))
        titles, *rows = good.read_text().splitlines()
        place = titles.split(",").index("bat")
        doubted = self.dir / "doubted.csv"
        doubted.write_text("\n".join([titles, *(",".join([*cells[:place], "JUMPS", *cells[place + 1:]]) for cells in (row.split(",") for row in rows))]) + "\n")
        measured = flight_log.stretches(good)
        unmeasured, = self.fly_batteries(1.65, (0.9,), "NONE")
        others = [flight_log.stretches(path) for path in (doubted, unmeasured)]
        self.assertAlmostEqual(model.compare_volts(measured), 16.2, delta=0.3)
        for other in others:
            self.assertIsNone(other[0].volts)
            self.assertIsNone(model.compare_volts([*measured, *other]))
            self.assertNotIn("volts_power", model.Likelihood("THRUST", other).names)

    def test_a_flight_that_the_supervisor_lowered_now_and_then_is_one_stretch(self):
        vehicle = {"hover_thrust": 8.8, "tau": 0.15, "tdelay": 0.03, "damping": 1.2, "gain": 1.25, "common_noise": 5}
        path = self.dir / "lowered.csv"
        words = [word for name, value in vehicle.items() for word in ("--set", f"plant.{name}={value}")]
        words += ["--set", "LAYOUT=FRONT"]      # three mirrors tell a step of the reference from a climb
        subprocess.run([PROGRAM, "fly", "experiment", "--seed", "2", *words, "--csv", path], check=False,
                       stdout=subprocess.DEVNULL)
        self.assertIn(",LOWERING,", path.read_text())
        found = flight_log.stretches(path)
        self.assertEqual(len(found), 1)
        self.assertGreater(found[0].grid_s[-1] - found[0].grid_s[0], 19.0)

    def verdict(self, log, expected, vehicle):
        (self.dir / "old.json").write_text(json.dumps(vehicle))
        (self.dir / "forecast.json").write_text(json.dumps({"vehicle": str(self.dir / "old.json"), "expected": expected}))
        return subprocess.run([sys.executable, "-B", ROOT / "tools/fit/verdict.py", log, "--forecast",
                               self.dir / "forecast.json"], capture_output=True, text=True, check=False)

    def test_a_forecast_that_holds_and_one_that_does_not(self):
        log = self.fly(4714, {}, "est-60cm-ramp")
        for low, high, status, words in ((4.0, 25.0, 0, "the forecast held"), (4.0, 8.0, 1, "NOT HELD")):
            done = self.verdict(log, {"hover_rms_mm": {"value": low, "low": low, "high": high}}, {"throttle": "THRUST"})
            self.assertEqual(done.returncode, status, done.stdout + done.stderr)
            self.assertIn(words, done.stdout)
            self.assertIn("the ground steps", done.stdout)

    def test_a_flight_that_is_better_than_its_forecast_holds_it(self):
        expected = {"hover_rms_mm": {"value": 50.0, "low": 40.0, "high": 60.0}, "undershoot_mm": {"value": 400.0, "low": 300.0, "high": 500.0}}
        done = self.verdict(self.fly(4714, {}, "est-60cm-ramp"), expected, {"throttle": "THRUST"})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count("better than forecast"), 2, done.stdout)
        self.assertIn("the forecast held\n", done.stdout)

    def test_a_forecast_that_no_figure_of_the_flight_can_be_compared_with_has_not_held(self):
        edge = {name: {"value": 1.0, "low": 0.5, "high": 500.0} for name in ("recovery_s", "undershoot_mm")}
        log = self.fly(4717, {})
        done = self.verdict(log, edge, {"throttle": "THRUST"})
        self.assertEqual(done.returncode, 2, done.stdout)
        self.assertIn("verdict: nothing was compared: this flight has no recovery_s, undershoot_mm", done.stderr)
        self.assertNotIn("held", done.stdout)
        done = self.verdict(log, {}, {"throttle": "THRUST"})
        self.assertEqual(done.returncode, 2, done.stdout)
        hover = self.fly(4718, {}, "pid-40cm")
        done = self.verdict(hover, {"hover_rms_mm": {"value": 20.0, "low": 10.0, "high": 200.0}} | edge, {"throttle": "THRUST"})
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertIn("the forecast held as far as it was flown, 1 of 3 figures; not in this flight: recovery_s, undershoot_mm", done.stdout)

    def course(self, period_s, outliers=(), falls=True):
        """Times, heights and references: a ramp, an edge of 0.25 m at 11 s, and heights that lie by 0.3 m."""
        scan_s = numpy.arange(1.0, 20.0, 0.108)
        scan_m = numpy.where(scan_s < 11.0, 0.6, 0.6 + 0.25 * numpy.maximum(1.0 - falls * (scan_s - 11.0) / 1.2, 0.0))
        for at_s in outliers:
            scan_m[numpy.searchsorted(scan_s, at_s)] += 0.3
        t_s = numpy.arange(1.2, 19.0, period_s)
        return t_s, scan_m[numpy.searchsorted(scan_s, t_s, "right") - 1], numpy.full(len(t_s), 0.6)

    def test_one_wrong_height_is_no_edge_and_hides_none(self):
        for period_s in (0.01, 0.108):      # of fly --csv, and a row for each scan
            for outliers in ((), (9.5,), (8.0, 13.0), (11.0,), (10.9,)):
                with self.subTest(period_s=period_s, outliers=outliers):
                    found = forecast.edges(*self.course(period_s, outliers))
                    self.assertEqual(len(found), 1)
                    self.assertAlmostEqual(found[0], 11.0, delta=0.25)

    def test_a_height_that_never_comes_back_is_told_as_fly_tells_it(self):
        for falls, least, most in ((True, 0.8, 1.2), (False, 3.97, 3.97)):
            with mock.patch.object(forecast, "held", lambda path, falls=falls: self.course(0.01, falls=falls)):
                self.assertTrue(least <= forecast.quality("")["recovery_s"] <= most)
        self.assertIn(f"A recovery of {forecast.NEVER_S} s is no measured time", (ROOT / "docs/fit.md").read_text(encoding="utf-8"))

    def test_what_is_printed_is_compared(self):
        expected = {"low": 3.5, "high": 3.89}
        self.assertEqual([verdict.compared(expected, value) for value in (3.8900000000000006, 3.91, 3.499999, 3.4)],
                         ["held", "NOT HELD", "held", "better than forecast"])

    def test_how_often_a_right_forecast_fails_by_chance_is_said_and_stands_on_the_page(self):
        self.assertAlmostEqual(forecast.fails_by_chance(1), 0.05)
        self.assertAlmostEqual(forecast.fails_by_chance(3), 0.142625)
        words = dict.fromkeys(forecast.FIGURES, "held") | {"hover_rms_mm": "NOT HELD"}
        said, status = verdict.told(words)
        self.assertEqual(status, 1)
        self.assertIn("by chance one that is right fails in up to 14 of 100 flights, 3 figures compared", said)
        page = (ROOT / "docs/fit.md").read_text(encoding="utf-8")
        self.assertIn(f"up to {100 * forecast.fails_by_chance(3):.0f} of 100 flights", page)

    def test_who_reads_only_the_first_lines_hears_of_no_broken_pipe(self):
        old = {"throttle": "THRUST", "plant.hover_thrust": {"value": 9.0, "low": 8.9, "high": 9.1}}
        log = self.fly(4719, {})
        self.verdict(log, {}, old)
        reads, writes = os.pipe()
        os.close(reads)
        for words, status in (("verdict.py", log, "--forecast", self.dir / "forecast.json"), 2), (("fit.py", log, "--out", self.dir / "v.json"), 0):
            done = subprocess.run([sys.executable, "-B", ROOT / "tools/fit" / words[0], *words[1:]], stdout=writes, stderr=subprocess.PIPE, text=True, check=False)
            self.assertEqual(done.returncode, status, done.stderr)
            self.assertNotIn("Broken", done.stderr)
        os.close(writes)

    def test_a_flight_that_is_given_twice_is_refused(self):
        log = self.fly(4720, {})
        copied = self.dir / "copied.csv"
        shutil.copy(log, copied)
        for other in (log, copied):
            done, vehicle = self.fit(log, other)
            self.assertEqual((done.returncode, vehicle), (2, None))
            self.assertIn(f"{other}: the same flight as in {log}; name each flight once", done.stderr)

    def test_a_fit_never_writes_over_a_log_that_it_reads(self):
        logs = [self.dir / "a.csv", self.dir / "b.png"]
        for log in logs:
            log.write_text("t_s\n", encoding="utf-8")
        (self.dir / "a-link.json").symlink_to("a.csv")
        for out, refused in (("a.csv", "a.csv"), ("a-link.json", "a-link.json"), ("b.json", "b.png")):
            done = subprocess.run([sys.executable, "-B", ROOT / "tools/fit/fit.py", *logs, "--out", self.dir / out], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
            self.assertIn(f"{refused}: is read here; another --out", done.stderr)
        for log in logs:
            self.assertEqual(log.read_text(encoding="utf-8"), "t_s\n")
        done = subprocess.run([sys.executable, "-B", ROOT / "tools/fit/fit.py", logs[0], "--out", self.dir / "c.png"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("c.png: the vehicle and its picture are one file", done.stderr)

    def test_what_has_moved_since_is_named(self):
        old = {"throttle": "THRUST", "plant.hover_thrust": {"value": 9.0, "low": 8.9, "high": 9.1}}
        done = self.verdict(self.fly(4716, {"hover_thrust": 7.4}), {}, old)
        self.assertRegex(done.stdout, r"plant.hover_thrust is 7\.\d+, not 9")

    def test_a_log_without_accelerations_is_refused_and_the_reason_said(self):
        path = self.fly(4713, {}, "pid-40cm")
        rows = path.read_text().splitlines()
        place = rows[0].split(",").index("up_mps2")
        bare = [",".join("" if k == place and n else cell for k, cell in enumerate(row.split(",")))
                for n, row in enumerate(rows)]
        path.write_text("\n".join(bare) + "\n")
        done, _ = self.fit(path)
        self.assertEqual(done.returncode, 2)
        self.assertIn("no accelerations", done.stderr)

    def replay(self, log, *words):
        """(nine tenths of the thrusts in state FLYING are as near to the flown ones, what was told)."""
        out = self.dir / "replayed.csv"
        done = subprocess.run([PROGRAM, "replay", log, *words, "--csv", out], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        rows = [row.split(",") for row in out.read_text().splitlines()]
        thrust, flown, state = (rows[0].index(name) for name in ("thrust_n", "flown_n", "state"))
        off_n = sorted(abs(float(row[thrust]) - float(row[flown])) for row in rows[1:] if row[state] == "FLYING")
        self.assertGreater(len(off_n), 60)
        return off_n[len(off_n) * 9 // 10], done.stderr

    def test_replay_of_a_log_flies_it_open_loop_and_names_what_is_not_in_it(self):
        # 14 of 16 flights (seeds 4711 to 4726). On a ramp what the log lacks can turn a vote of the mirrors or a gate of the estimator: then
        # the thrust is another one for half a second.
        same_n = [self.replay(self.fly(seed, {}, "est-60cm-ramp"))[0] for seed in range(4711, 4717)]
        self.assertLess(statistics.median(same_n), 0.1)
        log = self.fly(4717, {}, "est-60cm-ramp")
        _, told = self.replay(log)
        for word in ("open loop", "accelerations", "octets of scanner", "did not answer"):
            self.assertIn(word, told)
        other_n, _ = self.replay(log, "--set", "LAW=PID")
        self.assertGreater(other_n, 0.5)
        self.assertLess(other_n, 3.0)
        picture = subprocess.run([sys.executable, "-B", ROOT / "tools/plot/plot.py", self.dir / "replayed.csv"],
                                 capture_output=True, text=True, check=False)
        self.assertEqual(picture.returncode, 0, picture.stderr)

    def test_replay_of_telemetry_flies_by_its_heights_alone(self):
        log = self.fly(4718, {}, "pid-60cm-ramp").with_suffix(".log")
        lines = [line for line in log.read_text().splitlines() if line.startswith("alt:")]
        text = self.dir / "telemetry.txt"
        text.write_text("\n".join(lines) + "\n")
        same_n, told = self.replay(text, "--set", "LAW=PID")
        self.assertLess(same_n, 1.5)
        self.assertIn("0 accelerations", told)

    def test_replay_of_what_is_no_flight_is_refused(self):
        path = self.dir / "words.txt"
        path.write_text("hello\n")
        done = subprocess.run([PROGRAM, "replay", path], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)

    def test_a_vehicle_without_a_figure_of_the_plant_is_refused_before_the_flight(self):
        for content, reason in (("{}", "no figure of the plant"), ('{"plant.gain": 1}', "without its value"),
                                ('{"plant.gian": {"value": 1}}', "unknown name")):
            path = self.dir / "wrong.json"
            path.write_text(content)
            done = subprocess.run([PROGRAM, "fly", "experiment", "--vehicle", path], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertIn(reason, done.stderr)


class BadLogs(unittest.TestCase):
    """What fit once believed, or fell over."""

    def test_the_fault_and_its_line_are_named(self):
        with tempfile.TemporaryDirectory() as scratch:
            log, given = Path(scratch, "log.csv"), Path(scratch, "given.csv")
            subprocess.run([PROGRAM, "fly", "experiment", "--csv", log], check=False, stdout=subprocess.DEVNULL)
            titles, *rows = [line.split(",") for line in log.read_text().splitlines()]

            def text(changed):
                """changed(cells by their title, line) of each row."""
                lines = [changed(dict(zip(titles, row, strict=True)), at) for at, row in enumerate(rows, 2)]
                return "\n".join(",".join(line) for line in (titles, *(cells.values() for cells in lines))) + "\n"

            def only(name, cell, line=700):
                return text(lambda cells, at: cells | {name: cell} if line in (0, at) else cells)

            def times(change):
                return text(lambda cells, at: cells | {"t_s": f"{change(float(cells['t_s']), at):g}"})

            for what, octets, reason in (
                    ("millimetres", text(lambda cells, _: cells | {"meas_m": f"{1e3 * float(cells['meas_m'] or 0):g}"}), r":2: meas_m: -\d+(\.\d)? is not in metres"),
                    ("milliseconds", times(lambda t, _: 1000 * t), ": t_s: .*no time of a flight in seconds"),
                    ("a jump", times(lambda t, at: t + (1e5 if at > 700 else 0)), ":701: t_s: from 6.98 to 100007"),
                    ("a long jump", times(lambda t, at: t + (1e15 if at > 700 else 0)), ":701: t_s: 1e[+]15 is not in seconds"),
                    ("time goes back", times(lambda t, at: t - (3 if at > 700 else 0)), ":701: t_s: 3.99 does not come after 6.98"),
                    ("inf", only("thrust_n", "inf"), ":700: thrust_n: 'inf' is no number"),
                    ("a quote", only("state", 'FLY"ING'), ":700: a quote within a row"),
                    ("degrees", only("roll_rad", "9.5"), ":700: roll_rad: 9.5 is not in radians"),
                    ("no time", only("t_s", ""), ":700: t_s: nothing does not come after"),
                    ("no heights", only("meas_m", "", 0), "no heights: meas_m is empty"),
                    ("no thrust", only("thrust_n", ""), "1 rows have no thrust_n"),
                    ("no tilt", only("roll_rad", "", 0), "no roll: roll_rad is empty"),
                    ("semicolons", log.read_text().replace(",", ";"), ":1: cells are separated by ';'"),
                    ("a picture", (ROOT / "docs/images/fit.png").read_bytes(), "neither a flight CSV"),
                    ("nothing", "", "neither a flight CSV"), ("titles", ",".join(titles) + "\n", "no samples")):
                given.write_bytes(octets if isinstance(octets, bytes) else octets.encode())
                with self.subTest(what), self.assertRaisesRegex(flight_log.Unfit, "given.csv.*" + reason):
                    flight_log.stretches(given)
            done = subprocess.run([sys.executable, "-B", ROOT / "tools/fit/fit.py", given], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertNotIn("Traceback", done.stderr)

            given.write_text("\ufeff" + "\r\n".join(",".join(f'"{cell}"' for cell in row) for row in (titles, *rows)) + "\r\n")
            self.assertEqual(len(flight_log.stretches(given)), len(flight_log.stretches(log)))     # of a spreadsheet

    def test_rows_that_are_missing_part_two_stretches(self):
        t_s = [*(k / 100 for k in range(700)), *(100 + k / 100 for k in range(700))]
        every = [True] * len(t_s)
        self.assertEqual(flight_log.spans(t_s, every, every), [(0.5, 6.99), (100.5, 106.99)])


FOUND = {"throttle": "THRUST", "plant.hover_thrust": {"value": 7.0}, "plant.gain": {"value": 1.0}, "plant.tau": {"value": 0.1},
         "plant.tdelay": {"value": 0.01}, "plant.damping": {"value": 2.0}, "authority": {"value": 1.4}, "names": list(model.THRUST),
         "units": [0.0] * len(model.THRUST), "covariance": [[0.01 * (k == m) for k in range(len(model.THRUST))]
                                                            for m in range(len(model.THRUST))]}


class Tuning(unittest.TestCase):
    def test_a_rerun_flies_only_what_is_missing_and_every_flight_says_how_to_fly_it_again(self):
        with tempfile.TemporaryDirectory() as scratch:
            vehicle, out = Path(scratch, "vehicle.json"), Path(scratch, "forecast.json")
            kept = out.with_suffix(".flights.jsonl")
            vehicle.write_text(json.dumps(FOUND))
            command = [sys.executable, "-B", ROOT / "tools/fit/tune_vehicle.py", vehicle, "--program", PROGRAM, "--out", out,
                       "--draws", "1", "--budget", "3", "--forecast", "2", "--fresh", "3"]
            first = subprocess.run(command, capture_output=True, text=True, check=True).stdout
            lines = kept.read_text().splitlines()
            kept.write_text("\n".join(lines[:-1]) + "\n" + lines[-1][:40])
            again = subprocess.run(command, capture_output=True, text=True, check=True).stdout
            self.assertEqual(again, first)
            self.assertEqual(len(kept.read_text().splitlines()), len(lines) + 1)    # the torn line, and its flight anew
            record = json.loads(lines[0])
            self.assertRegex(record["command"], r"fly est-60cm-ramp --seed \d+ ")
            self.assertTrue(record["version"] and record["program"])
            figures = json.loads(subprocess.run(f"{record['command']} --json -", shell=True, stdin=subprocess.DEVNULL,
                                                stderr=subprocess.DEVNULL, stdout=subprocess.PIPE, check=False).stdout)
            self.assertEqual(figures, record["figures"])

    def test_a_forecast_is_not_written_over_the_vehicle_and_numbers_of_nothing_are_refused(self):
        with tempfile.TemporaryDirectory() as scratch:
            for name in ("vehicle.json", "forecast.flights.jsonl"):
                path = Path(scratch, name)
                path.write_text(json.dumps(FOUND))
                out = Path(scratch, name.replace(".flights.jsonl", ".json"))
                with contextlib.redirect_stderr(io.StringIO()) as err:
                    self.assertEqual(tune_vehicle.main([str(path), "--out", str(out), "--program", PROGRAM]), 2)
                self.assertIn(f"{path}: is read here; another --out", err.getvalue())
                self.assertEqual(json.loads(path.read_text()), FOUND)
            for option in ("--draws", "--budget", "--fresh", "--forecast"):
                with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(io.StringIO()) as err:
                    tune_vehicle.main([str(path), option, "0"])
                self.assertEqual(end.exception.code, 2)
                self.assertIn(f"argument {option}: at least 1", err.getvalue())

    def test_what_is_no_vehicle_or_no_forecast_is_refused_by_its_name(self):
        with tempfile.TemporaryDirectory() as scratch:
            path = Path(scratch, "given.json")
            for text in ("", "null", "[]", "{}", '{"throttle": "THRUST"}', json.dumps(FOUND | {"units": [1.0]}), "\x89PNG\r\n",
                         json.dumps(FOUND | {"throttle": "STEAM"}), json.dumps(FOUND | {"plant.gain": {"value": float("inf")}})):
                path.write_text(text)
                with self.assertRaisesRegex(ValueError, "given.json: no vehicle of make fit"):
                    forecast.load_vehicle(path)
                with self.assertRaisesRegex(ValueError, "given.json: no forecast of make tune"):
                    forecast.load_forecast(path)
            path.write_text(json.dumps(FOUND))
            self.assertEqual(forecast.load_vehicle(path), FOUND)

    def test_the_lowest_place_of_a_surface_through_noisy_candidates_is_found(self):
        rng = random.Random(7)
        places = [[x, y] for x in (-0.4, 0.0, 0.4) for y in (-0.4, 0.0, 0.4)]
        costs = [12.0 + 8.0 * (x - 0.15)**2 + 6.0 * (y + 0.2)**2 + rng.gauss(0.0, 0.05) for x, y in places]
        x, y = tune_vehicle.bottom(places, costs)
        self.assertAlmostEqual(x, 0.15, delta=0.08)
        self.assertAlmostEqual(y, -0.2, delta=0.08)

    def test_it_stays_within_what_was_flown_and_leaves_out_what_failed(self):
        places = [[x, y] for x in (0.0, 0.1, 0.2) for y in (0.0, 0.1, 0.2)] + [[0.9, 0.9]]
        costs = [10.0 - 3.0 * x + y for x, y in places[:-1]] + [500.0]
        x, y = tune_vehicle.bottom(places, costs)
        self.assertAlmostEqual(x, 0.2, delta=1e-6)
        self.assertAlmostEqual(y, 0.0, delta=1e-6)
        self.assertIsNone(tune_vehicle.bottom(places[:5], costs[:5]))

    def test_a_failure_costs_500_mm_and_activity_more_than_is_free_30_mm_a_newton(self):
        good = {"failed": False, "takeovers": 0, "halted": False, "hover_rms_mm": 10.0, "thrust_std_n": 0.7,
                "terrain_rms_mm": 80.0, "overshoot_mm": 20.0, "recovery_s": 0.8}
        self.assertAlmostEqual(tune_vehicle.cost([good], 0.7), 19.0)
        self.assertAlmostEqual(tune_vehicle.cost([good | {"thrust_std_n": 0.8}], 0.7), 22.0)
        self.assertAlmostEqual(tune_vehicle.cost([good, good | {"takeovers": 1}], 0.7), 259.5)

    def test_records_of_another_program_or_of_other_tools_are_not_taken_up_again(self):
        with tempfile.TemporaryDirectory() as scratch:
            path = Path(scratch, "1.jsonl")
            path.write_text('{"number": 1, "made_by": "a"}\n{"number": 2, "made_by": "b"}\n{"number": 3, "made')
            self.assertEqual(list(acceptance.known_records(path, "a")), [1])

    def test_a_must_of_the_acceptance_is_missed_when_so_few_are_improbable_and_never_is_never(self):
        for reached, must, missed in ((30, 29 / 30, False), (28, 29 / 30, False), (24, 29 / 30, True), (22, 0.8, False), (14, 0.8, True),
                                      (30, 1.0, False), (29, 1.0, True)):
            with contextlib.redirect_stdout(io.StringIO()) as told:
                self.assertEqual(acceptance.print_verdict("x", reached, must, of=30, error=0.05 / 17), missed, (reached, must))
            self.assertEqual(told.getvalue().endswith(" MISSED\n"), missed)


class FakeFlights:
    """Flights whose figures are the stock gains' times `factors` where other gains are typed: {world: (hover, recovery)}."""

    def __init__(self, **factors):
        self.factors = factors

    def each(self, _, flights):
        return [self.figures(words) for words in flights]

    def figures(self, words):
        hover, recovery = self.factors["rotors" if "plant.airframe=1" in words else "model"]
        if not any(word.startswith("POSK=") for word in words):
            hover = recovery = 1.0
        chance = random.Random(words[2]).gauss(1.0, 0.1)
        return {"failed": False, "takeovers": 0, "halted": False, "hover_rms_mm": 12.0 * chance * hover, "recovery_s": 0.8 * chance * recovery,
                "thrust_std_n": 0.5 if hover == 1.0 else 0.7, "terrain_rms_mm": 80.0, "overshoot_mm": 20.0}


OF_ROTORS = FOUND | {"names": list(model.TABLES["THRUST"]), "units": [0.0] * len(model.TABLES["THRUST"]), "beyond": ["it slows down late"],
                     "covariance": [[0.01 * (k == m) for k in range(len(model.TABLES["THRUST"]))] for m in range(len(model.TABLES["THRUST"]))]}


class Proving(unittest.TestCase):
    def tune(self, vehicle, **factors):
        proposal = tune_vehicle.tune(FakeFlights(**factors), vehicle, "EST", 4, 5)
        defaults = {"POSK": "2.3", "VELK": "8", "PLANT": "THRUST", "GAIN": "1", "LAG": "0.12", "DELAY": "0.0185", "DAMP": "2.5"}
        return proposal, "\n".join(tune_vehicle.told("EST", vehicle, proposal, defaults))

    def test_what_hovers_better_and_recovers_no_later_is_proposed_and_its_activity_told(self):
        proposal, told = self.tune(FOUND, model=(0.9, 0.9))
        self.assertFalse(proposal.kept)
        self.assertIn("#POSK ", told)
        self.assertRegex(told, r"thrust activity 0.5 to 0.7 N, [+]40 %")
        self.assertRegex(told, r"hover RMS 12\S* to 10.\d mm, -10 %")

    def test_what_recovers_later_or_hovers_no_better_is_not(self):
        for factors in ((0.8, 1.01), (1.0, 0.5), (1.01, 0.9)):
            proposal, told = self.tune(FOUND, model=factors)
            self.assertEqual((proposal.kept, proposal.settings), (True, {}), factors)
            self.assertIn("The stock gains stay", told)
            self.assertIn("#VELK 8", told)

    def test_a_vehicle_beyond_the_model_must_be_better_by_both_equations_and_by_much(self):
        for model_, rotors, kept in (((0.7, 0.7), (0.8, 0.8), False), ((0.7, 0.7), (0.95, 0.95), True), ((0.95, 0.95), (0.7, 0.7), True),
                                     ((0.7, 0.7), (0.8, 1.1), True)):
            proposal, told = self.tune(OF_ROTORS, model=model_, rotors=rotors)
            self.assertEqual(proposal.kept, kept, (model_, rotors))
            self.assertIn("beyond the model: it slows down late", told)
            self.assertIn("by the equations of the other airframe: hover RMS", told)

    def test_what_lies_at_its_limit_is_told(self):
        limits = list(tune_vehicle.at_limit("EST", FOUND, {"POSK": "2.6", "VELK": "12", "LAG": "0.03", "GAIN": "1.1"}))
        self.assertEqual([sentence.split()[0] for sentence in limits], ["VELK", "LAG"])
        self.assertIn("VELK 12 is at its limit, 1.5 to 12", limits[0])

    def test_the_bounds_of_a_change_are_students(self):
        c = tune_vehicle.change([10.0, 10.0, 10.0, 10.0], [9.0, 9.0, 11.0, 11.0])
        self.assertAlmostEqual(c.tuned / c.stock, 1.0)
        self.assertAlmostEqual(c.most, 2.3534 * 1.1547 / 2.0 / 10.0, places=4)     # one-sided, three degrees of freedom
        self.assertAlmostEqual(c.least, -c.most)
        same = tune_vehicle.change([3.98, 3.98], [3.98, 3.98])
        self.assertEqual((same.least, same.most), (0.0, 0.0))

    def test_the_other_airframe_flies_with_what_the_fit_found(self):
        for plant in forecast.draws(OF_ROTORS, 3, 1, "rotors"):
            self.assertEqual(plant["airframe"], 1.0)
            self.assertAlmostEqual((plant["spin_up"] * plant["slow_down"])**0.5, 0.1, delta=0.03)
            done = subprocess.run([PROGRAM, "fly", *forecast.words("est-60cm-ramp", 1, {}, plant)], capture_output=True, text=True, check=False)
            self.assertIn(done.returncode, (0, 1), done.stderr)
        self.assertEqual([plant.get("airframe", 0.0) for plant in forecast.draws(OF_ROTORS, 4, 1)], [0.0, 1.0, 0.0, 1.0])
        self.assertFalse(any("airframe" in plant for plant in forecast.draws(FOUND, 4, 1)))


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
