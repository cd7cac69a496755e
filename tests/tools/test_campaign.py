"""tools/campaign: what is flown, what is kept, and what is said of it. Argument: the plomada program.

Most flights here are those of a stand-in whose figures depend on the seed it is given.
"""
import contextlib
import csv
import io
import json
import math
import os
import re
import shlex
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
CAMPAIGN = ROOT / "tools/campaign/campaign.py"
PROGRAM = sys.argv.pop(1)
sys.path.insert(0, str(CAMPAIGN.parent))
import bound  # noqa: E402
import campaign  # noqa: E402
import fleet  # noqa: E402
import musts  # noqa: E402
import page  # noqa: E402
import plan  # noqa: E402
import situations  # noqa: E402
import table  # noqa: E402
import verdict  # noqa: E402

# Notes each flight, then does what the directory says: `broken` and `hanging` hold the seed of the flight that is.
STAND_IN = """#!/bin/sh
[ "$1" != params ] || {{ echo "one of: PD|PID|PIDT|EST|GLIDE"; exit; }}
for path; do :; done
seed=$(expr "$*" : '.*--seed \\([0-9]*\\)')
echo "$*" >> {dir}/log
[ ! -e {dir}/slow ] || sleep 0.1
if [ "$(cat {dir}/broken 2>/dev/null)" = "$seed" ]; then echo "no such wing: $seed" >&2; exit 3; fi
if [ "$(cat {dir}/hanging 2>/dev/null)" = "$seed" ]; then exec sleep 60; fi
cat > "$path" <<END
{figures}
END
"""
GOOD = {"met": True, "failed": False, "started": True, "halted": False, "rise_time_s": 1.0, "overshoot_mm": 14.0,
        "hover_rms_mm": 10.0, "terrain_rms_mm": 75.0, "recovery_s": 0.7, "undershoot_mm": 18.0, "max_error_mm": 50.0,
        "touch_speed_mps": 0.2, "thrust_std_n": 0.4, "ground_contacts": 0, "takeovers": 0, "cuts": 0,
        "highest_mm": 280.0}


def figures(**other):
    return GOOD | other


class Case(unittest.TestCase):
    def setUp(self):
        laws = mock.patch.dict(plan.LAWS)   # the stand-in's law GLIDE is not the program's
        laws.start()
        self.addCleanup(laws.stop)
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)
        self.out = self.dir / "out"
        self.program = self.dir / "plomada"
        body = json.dumps(figures(hover_rms_mm="SEED")).replace('"SEED"', "$seed")
        self.program.write_text(STAND_IN.format(dir=self.dir, figures=body), encoding="utf-8")
        self.program.chmod(0o755)

    def argv(self, *words):
        return [*words, "--program", str(self.program), "--out", str(self.out)]

    def campaign(self, *words):
        """(exit status, stdout, stderr, flights that the stand-in was asked for)."""
        return self.typed(*self.argv(*words))

    def typed(self, *words):
        """The same, of these words alone."""
        before = self.flown()
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
            status = campaign.main(list(words))
        return status, out.getvalue(), err.getvalue(), self.flown() - before

    def flown(self):
        return len((self.dir / "log").read_text().splitlines()) if (self.dir / "log").exists() else 0

    def stored(self):
        kept = self.out / "flights.jsonl"
        return kept.read_text(encoding="utf-8").splitlines() if kept.exists() else []

    def tell(self, name, text=""):
        (self.dir / name).write_text(str(text))


class Vehicles(unittest.TestCase):
    # Of Python 3.11: random.Random of a text is the same in every version and on every machine.
    FIRST = {"ray_noise": 7.473739911311, "hover_untrimmed": 6.827717159103, "outage_start": 12.833869108432}

    def test_the_first_vehicle_is_pinned(self):
        drawn = plan.draws(1, 1)
        for name, value in self.FIRST.items():
            self.assertAlmostEqual(drawn[name], value, places=9, msg=name)

    def test_a_vehicle_depends_on_seed_and_run_alone(self):
        self.assertEqual(plan.draws(3, 7), plan.draws(3, 7))
        vehicles = [tuple(plan.draws(seed, run).values()) for seed in range(1, 6) for run in range(1, 40)]
        for values in zip(*vehicles, strict=True):
            self.assertEqual(len(set(values)), len(vehicles))

    def test_all_laws_fly_the_same_vehicles_and_noises(self):
        for set_name in plan.SETS:
            for run in (1, 2, 50):
                flown = set()
                for law in plan.LAWS.values():
                    words = plan.arguments(law, set_name, 4, run)
                    flown.add((words[2], *(word for word in words if word.startswith("plant."))))
                self.assertEqual(len(flown), 1, (set_name, run))

    def test_sets_share_what_they_have_in_common(self):
        trimmed, untrimmed = plan.plant("trimmed", 1, 9), plan.plant("untrimmed", 1, 9)
        self.assertNotEqual(trimmed.pop("hover_thrust"), untrimmed.pop("hover_thrust"))
        self.assertEqual(trimmed, untrimmed)

    def test_draws_fill_their_ranges_and_keep_to_them(self):
        ranges = {"ray_noise": (5, 10), "common_noise": (3, 6), "gain": (0.8, 1.2), "tau": (0.09, 0.15),
                  "damping": (1.5, 3.0), "ray_instant": (0.004, 0.064), "acc_bias": (-0.25, 0.25),
                  "acc_noise": (0.4, 0.8), "attitude_rms": (math.radians(1.6), math.radians(3.0)),
                  "imu_noise": (math.radians(0.25), math.radians(0.5)),
                  "turbulence": (0.16, 0.3), "tdelay": (0.005, 0.020), "hover_trimmed": (7.25, 7.55),
                  "hover_untrimmed": (5.6, 8.4), "outage_start": (8, 14), "climb_rate": (0.483, 0.85652),
                  "climb_neutral": (7.25, 7.8), "climb_deadband": (0.0, 0.5), "climb_lag": (0.2315, 0.5556)}
        vehicles = [plan.draws(1, run) for run in range(1, 1001)]
        self.assertEqual(set(vehicles[0]), set(ranges))
        for name, (low, high) in ranges.items():
            values = [vehicle[name] for vehicle in vehicles]
            margin = 0.02 * (high - low)
            self.assertTrue(low <= min(values) < low + margin and high - margin < max(values) <= high, name)

    def test_seeds_of_two_campaigns_do_not_meet(self):
        seeds = [plan.arguments(plan.LAWS["EST"], "nominal", seed, run)[2] for seed in (1, 2) for run in (1, 200)]
        self.assertEqual(seeds, ["1", "200", "1000001", "1000200"])

    def test_the_program_knows_every_figure_parameter_and_scenario(self):
        known = subprocess.run([PROGRAM, "fly", "--help"], capture_output=True, text=True, check=True).stdout
        for set_name in plan.SETS:
            for name in plan.plant(set_name, 1, 1):
                self.assertIn(f"  plant.{name} ", known)
        for law in plan.LAWS.values():
            self.assertIn("rise_time_s", fleet.fly(PROGRAM, plan.arguments(law, "untrimmed", 1, 1)))


class Writing(Case):
    def test_what_does_not_fit_leaves_the_file_as_it_was(self):
        path = self.dir / "vehicle.json"
        fleet.write_whole(path, "old")
        with mock.patch.object(Path, "write_text", side_effect=OSError(28, "No space left on device")), self.assertRaises(OSError):
            fleet.write_whole(path, "new")
        self.assertEqual(path.read_text(), "old")
        fleet.write_whole(path, "new")
        self.assertEqual(path.read_text(), "new")
        self.assertEqual([name.name for name in self.dir.iterdir() if name.suffix == ".new"], [])

    @unittest.skipUnless(Path("/dev/full").exists(), "no /dev/full")
    def test_a_device_is_written_and_not_replaced(self):
        with self.assertRaises(OSError):
            fleet.write_whole("/dev/full", "new")
        self.assertTrue(Path("/dev/full").is_char_device())


class Keeping(Case):
    LESS = ("--law", "PID,EST", "--set", "nominal")

    def setUp(self):
        super().setUp()
        drawing = mock.patch("picture.draw")    # takes longer than all the rest
        drawing.start()
        self.addCleanup(drawing.stop)

    def test_a_rerun_flies_only_what_is_missing(self):
        self.assertEqual(self.campaign(*self.LESS, "--runs", "6")[3], 12)
        self.assertEqual(self.campaign(*self.LESS, "--runs", "6")[3], 0)
        self.assertEqual(self.campaign(*self.LESS, "--runs", "8")[3], 4)
        self.assertEqual(len(self.stored()), 16)
        self.assertEqual(self.campaign(*self.LESS, "--runs", "8", "--program", str(self.program))[3], 0)

    def test_another_campaign_does_not_write_into_the_folder_of_one(self):
        self.campaign(*self.LESS, "--runs", "2")
        before = {path.name: path.read_bytes() for path in self.out.iterdir()}
        for words in (("--seed", "2"), ("--lies", "1"), ("--set", "plant.tau=0.1")):
            status, _, err, flown = self.campaign(*self.LESS, "--runs", "2", *words) if words[0] != "--lies" else self.campaign(*words)
            self.assertEqual((status, flown), (2, 0))
            self.assertIn("has another campaign, begun with: --law PID,EST --set nominal --runs 2", err)
        self.assertEqual({path.name: path.read_bytes() for path in self.out.iterdir()}, before)

    def test_a_campaign_with_options_has_its_own_folder_and_one_that_goes_on_the_same(self):
        root = campaign.ROOT / "build/campaign"
        self.assertEqual(campaign.folder_of(["--page"]), root)
        self.assertEqual(campaign.folder_of(["--law", "PID,EST", "--set=plant.tau=0.1", "--program", "x"]), root / "law-PID-EST-set=plant.tau=0.1")
        long = [campaign.folder_of(["--set", "a" * 200 + end]).name for end in "xy"]
        self.assertTrue(long[0] != long[1] and all(len(name) <= 80 for name in long), long)
        self.assertEqual(campaign.identity(["--lies", "2000", "--seed", "3"]), campaign.identity(["--lies=100", "--seed", "3", "--resume"]))
        self.assertNotEqual(campaign.identity(["--lies", "--seed", "3"]), campaign.identity(["--lies", "--seed", "4"]))

    def test_a_line_torn_by_a_kill_is_flown_again_and_harms_no_other(self):
        first = self.campaign(*self.LESS, "--runs", "6")[1]
        path = self.out / "flights.jsonl"
        for cut in (1, 20, len(self.stored()[-1])):
            path.write_bytes(path.read_bytes()[:-cut - 1])
            again = self.campaign(*self.LESS, "--runs", "6")
            self.assertEqual((again[3], again[1]), (1, first), cut)
            self.assertEqual(self.campaign(*self.LESS, "--runs", "6")[3], 0, cut)

    def test_another_program_flies_anew(self):
        self.campaign(*self.LESS, "--runs", "3")
        with self.program.open("a", encoding="utf-8") as file:
            file.write("# a line more\n")
        told = "the program is another one than that of 6 kept flights: they are flown again\n"
        shutil.copytree(self.out, self.dir / "kept")
        _, out, _, flown = self.campaign(*self.LESS, "--runs", "4")
        self.assertEqual((out.count(told), flown), (1, 8), out)
        _, out, _, flown = self.campaign(*self.LESS, "--runs", "5")     # by the same program: no word
        self.assertEqual((out.count("another one"), flown), (0, 2), out)
        self.assertTrue(self.typed("--resume", "--out", str(self.dir / "kept"))[1].startswith(told))

    def test_a_broken_flight_is_named_and_the_others_are_kept(self):
        self.tell("broken", 25)
        status, out, err, _ = self.campaign("--law", "EST", "--set", "nominal", "--runs", "25")
        self.assertEqual((status, out), (2, ""))
        self.assertIn("no such wing: 25", err)
        self.assertIn("--seed 25", err)
        kept = len(self.stored())
        self.assertGreaterEqual(kept, fleet.BATCH)
        (self.dir / "broken").unlink()
        status, _, _, flown = self.campaign("--law", "EST", "--set", "nominal", "--runs", "25")
        self.assertEqual((status, flown), (0, 25 - kept))

    def test_a_hanging_program_is_given_up(self):
        self.tell("hanging", 2)
        begin = time.monotonic()
        with mock.patch.object(fleet, "WALL_LIMIT_S", 0.5):
            status, _, err, _ = self.campaign("--law", "EST", "--set", "nominal", "--runs", "3")
        self.assertEqual(status, 2)
        self.assertIn("timed out", err)
        self.assertLess(time.monotonic() - begin, 15.0)

    def test_processor_time_counts_and_a_busy_machine_does_not(self):
        """A campaign of hours ended because one flight had waited for the processor for two minutes."""
        self.program.write_text("#!/bin/sh\nsleep 2; exit 3\n", encoding="utf-8")
        with mock.patch.object(fleet, "FLIGHT_LIMIT_S", 1), self.assertRaisesRegex(fleet.Broken, "ended with status 3"):
            fleet.fly(str(self.program), ["est-60cm-ramp"])
        self.program.write_text("#!/bin/sh\nwhile :; do :; done\n", encoding="utf-8")
        with mock.patch.object(fleet, "FLIGHT_LIMIT_S", 1), self.assertRaisesRegex(fleet.Broken, "more than 1 s of processor time"):
            fleet.fly(str(self.program), ["est-60cm-ramp"])

    def test_no_figures_or_no_program_is_a_broken_flight(self):
        for name, body in (("silent", "exit 0"), ("prose", 'for p; do :; done; echo fine > "$p"')):
            self.program.write_text(f"#!/bin/sh\n{body}\n", encoding="utf-8")
            self.assertEqual(self.campaign(*self.LESS, "--runs", "1")[0], 2, name)
            self.assertFalse(self.out.exists(), name)
        self.program.unlink()
        status, _, err, _ = self.campaign(*self.LESS, "--runs", "1")
        self.assertEqual(status, 2)
        self.assertIn(str(self.program), err)

    def test_a_campaign_that_cannot_begin_leaves_no_folder(self):
        """An empty one stayed, and --resume without --out went on with it."""
        for words in (("--lies", "1", "--only", "lice"), ("--law", "EST", "--vehicle", str(self.dir / "none.json")), ("--law", "EST", "--program", "/none"),
                      ("--healthy", "1", "--program", str(self.dir))):
            self.assertEqual(self.typed("--program", str(self.program), "--out", str(self.out), *words)[::3], (2, 0), words)
            self.assertFalse(self.out.exists(), words)
        with contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(musts.main(["--only", "edges", "--program", "/none", "--out", str(self.out)]), 2)
        self.assertFalse(self.out.exists())

    def test_control_c_keeps_what_was_flown(self):
        self.tell("slow")
        campaigner = subprocess.Popen([sys.executable, "-B", CAMPAIGN, *self.argv("--law", "EST", "--runs", "2000")],
                                      stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(campaigner.kill)
        end = time.monotonic() + 30.0
        while time.monotonic() < end and not (self.out.exists() and len(self.stored()) >= fleet.BATCH):
            time.sleep(0.05)
        campaigner.send_signal(signal.SIGINT)
        err = campaigner.communicate(timeout=15)[1]
        self.assertEqual(campaigner.returncode, 130)
        self.assertIn("run it again", err)
        self.assertNotIn("Traceback", err)
        self.assertGreaterEqual(len([json.loads(line) for line in self.stored()]), fleet.BATCH)

    def test_resume_takes_the_options_that_the_campaign_was_begun_with(self):
        self.campaign("--law", "EST", "--set", "nominal", "--runs", "4")
        lines = self.stored()
        (self.out / "flights.jsonl").write_text("".join(line + "\n" for line in lines[:1]), encoding="utf-8")
        status, out, err, flown = self.typed("--resume", "--out", str(self.out))
        self.assertEqual((status, flown), (0, 3))
        self.assertIn(f"goes on with {self.out}, begun with: --law EST --set nominal --runs 4", err)
        self.assertIn("nominal", out)
        self.assertEqual(len(self.stored()), 4)
        shutil.rmtree(self.out)
        with contextlib.redirect_stderr(io.StringIO()) as err, self.assertRaises(SystemExit) as stopped:
            campaign.main(["--resume", "--out", str(self.out)])
        self.assertEqual(stopped.exception.code, 2)
        self.assertIn("no campaign was begun", err.getvalue())

    def test_resume_without_a_folder_goes_on_with_the_campaign_that_was_begun_last(self):
        campaigns = mock.patch.object(campaign, "CAMPAIGNS", self.dir / "campaigns")
        campaigns.start()
        self.addCleanup(campaigns.stop)
        status, _, err, flown = self.typed("--resume")
        self.assertEqual((status, flown), (2, 0))
        self.assertIn("no campaign was begun in", err)
        for number, runs in enumerate(("2", "3", "4")):
            self.typed("--law", "EST", "--set", "nominal", "--runs", runs, "--program", str(self.program))
            os.utime(campaign.CAMPAIGNS / f"law-EST-set-nominal-runs-{runs}" / campaign.BEGUN, (number, number))
        last = campaign.CAMPAIGNS / "law-EST-set-nominal-runs-4"
        (last / "flights.jsonl").unlink()
        status, _, err, flown = self.typed("--resume")
        self.assertEqual((status, flown), (0, 4))
        self.assertIn(f"goes on with {last}", err)

    def test_resume_with_options_is_refused_and_names_them(self):
        self.campaign("--law", "EST", "--set", "nominal", "--runs", "2")
        for words in (("--runs", "3", "--law", "PID", "--seed=9"), ("--page",), ("--program", "x")):
            with contextlib.redirect_stderr(io.StringIO()) as err, self.assertRaises(SystemExit) as stopped:
                campaign.main(["--resume", "--out", str(self.out), *words])
            self.assertEqual(stopped.exception.code, 2)
            self.assertIn(f"none beside --out: {' '.join(words)}.", err.getvalue())

    def test_a_campaign_goes_on_from_another_directory_and_says_that_its_plan_was_changed(self):
        own = self.dir / "own.json"
        own.write_text('{"sets": {"heavy": {"runs": 3, "fixed": {"hover_thrust": 8.4}}}}', encoding="utf-8")
        words = ("--plan", "own.json", "--law", "EST", "--set", "heavy")
        with mock.patch.dict(plan.SETS), contextlib.chdir(self.dir):
            self.assertEqual(self.campaign(*words)[3], 3)
        with mock.patch.dict(plan.SETS), contextlib.chdir(self.out):
            self.assertEqual(self.typed("--resume", "--out", str(self.out))[::3], (0, 0))
        own.write_text(own.read_text(encoding="utf-8").replace("8.4", "8.2"), encoding="utf-8")
        status, _, err, flown = self.typed("--resume", "--out", str(self.out))
        self.assertEqual((status, flown), (2, 0))
        self.assertIn(f"changed since the campaign in {self.out} was begun: {own};", err)
        with mock.patch.dict(plan.SETS), contextlib.chdir(self.dir):
            status, _, err, flown = self.campaign(*words)
        self.assertEqual((status, flown), (0, 3))
        self.assertIn(f"{own} was changed: what it changes is flown anew", err)

    def test_a_campaign_begun_before_its_files_had_sums_goes_on(self):
        self.out.mkdir()
        words = ["--law", "EST", "--set", "nominal", "--runs", "2", "--program", str(self.program)]
        (self.out / campaign.BEGUN).write_text(json.dumps(words), encoding="utf-8")
        self.assertEqual(self.typed("--resume", "--out", str(self.out))[::3], (0, 2))

    def test_every_result_says_how_to_fly_it_again(self):
        _, out, _, _ = self.campaign("--law", "EST", "--set", "nominal", "--runs", "2", "--set", "plant.gain=0.9")
        for record in map(json.loads, self.stored()):
            self.assertRegex(record["version"], r"\d+\.\d+")
            self.assertEqual(record["program"], fleet.digest(self.program)[:12])
            self.assertIn("plant.gain=0.9", record["command"])
            again = subprocess.run(f"{record['command']} --json {self.dir}/again.json", shell=True, check=False,
                                   capture_output=True)
            self.assertEqual(again.returncode, 0)
            self.assertEqual(json.loads((self.dir / "again.json").read_text()), record["figures"])
            self.assertIn("the worst flight", out)

    def test_own_laws_and_sets_come_from_a_file(self):
        own = {"laws": {"MINE": {"settings": {"POSK": 2}, "scenario": "est-60cm-ramp"}},
               "sets": {"heavy": {"runs": 3, "fixed": {"hover_thrust": 8.4}}}}
        file = self.dir / "own.json"
        self.addCleanup(plan.LAWS.pop, "MINE", None)
        self.addCleanup(plan.SETS.pop, "heavy", None)
        file.write_text(json.dumps(own))
        status, out, _, flown = self.campaign("--plan", str(file), "--law", "MINE", "--set", "heavy")
        self.assertEqual((status, flown), (0, 3), out)
        for record in map(json.loads, self.stored()):
            self.assertIn("--set POSK=2 --set plant.hover_thrust=8.4", record["command"])
        with contextlib.redirect_stderr(io.StringIO()) as err, self.assertRaises(SystemExit):
            campaign.main(self.argv("--plan", str(file)))
        self.assertIn("is there already", err.getvalue())

    def test_a_drawn_set_says_what_it_does_not_take_from_the_file_of_a_vehicle(self):
        file = self.dir / "vehicle.json"
        file.write_text('{"plant.hover_thrust": {"value": 9}, "plant.tau": {"value": 0.2}, "plant.sag_power": {"value": 1}}')
        _, out, _, flown = self.campaign("--vehicle", str(file), "--law", "EST", "--set", "nominal,untrimmed,glitches", "--runs", "1")
        self.assertEqual((flown, [line for line in out.splitlines() if str(file) in line and line.startswith("set ")]),
                         (3, [f"set untrimmed is not around {file}: it has figures of its own for hover_thrust, tau"]))

    def test_a_law_of_a_plan_that_the_program_has_too_is_refused(self):
        """It was flown in place of the program's, whose name its figures then had."""
        file = self.dir / "own.json"
        file.write_text(json.dumps({"laws": {"GLIDE": {"settings": {"LAW": "EST"}}}}))
        with contextlib.redirect_stderr(io.StringIO()) as err, self.assertRaises(SystemExit) as end:
            campaign.main(self.argv("--plan", str(file), "--law", "GLIDE"))
        self.assertEqual((end.exception.code, self.flown()), (2, 0))
        self.assertIn(f"--plan {file}: law GLIDE is one of the program's own; give it another name", err.getvalue())

    def test_a_law_that_only_the_program_has_is_flown_by_its_name(self):
        status, out, _, flown = self.campaign("--law", "GLIDE,PID", "--set", "nominal", "--runs", "2")
        self.assertEqual((status, flown), (0, 4), out)
        self.assertEqual([("--set LAW=GLIDE" in json.loads(line)["command"]) for line in sorted(self.stored())].count(True), 2)
        with contextlib.redirect_stderr(io.StringIO()) as err, self.assertRaises(SystemExit):
            campaign.main(self.argv("--law", "FALL"))
        self.assertIn("'FALL' is none of", err.getvalue())

    def dask(self, *words):
        process = subprocess.Popen([sys.executable, "-m", "dask", *words, "--no-dashboard", "--scheduler-file",
                                    self.dir / "scheduler.json"], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_a_worker_that_dies_loses_nothing(self):
        self.tell("slow")
        self.dask("scheduler", "--port", "0")
        workers = [self.dask("worker", "--nthreads", "1", "--no-nanny") for _ in range(2)]
        end = time.monotonic() + 60.0
        while time.monotonic() < end and not (self.dir / "scheduler.json").exists():
            time.sleep(0.05)
        address = json.loads((self.dir / "scheduler.json").read_text())["address"]
        campaigner = subprocess.Popen(
            [sys.executable, "-B", CAMPAIGN, *self.argv("--law", "EST", "--set", "nominal", "--runs", "60", "--scheduler", address)],
            stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self.addCleanup(campaigner.kill)
        while time.monotonic() < end and len(self.stored()) < 5:
            time.sleep(0.05)
        kept = len(self.stored())
        workers[0].kill()
        err = campaigner.communicate(timeout=120)[1]
        self.assertEqual(campaigner.returncode, 1, err)     # the stand-in's hover, its seed, is more than it must be
        self.assertTrue(5 <= kept < 60, kept)
        runs = [json.loads(line)["run"] for line in self.stored()]
        self.assertEqual(sorted(runs), list(range(1, 61)))

    def test_a_dead_scheduler_is_an_error(self):
        argv = self.argv("--law", "EST", "--scheduler", "tcp://127.0.0.1:1")
        impatient = os.environ | {"DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "1s"}
        done = subprocess.run([sys.executable, "-B", CAMPAIGN, *argv], capture_output=True, text=True, check=False,
                              timeout=30, stdin=subprocess.DEVNULL, env=impatient)
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertIn("127.0.0.1:1", done.stderr)
        self.assertNotIn("Traceback", done.stderr)

    def test_the_workers_of_a_cluster_need_none_of_the_scripts(self):
        from distributed import LocalCluster

        with LocalCluster(n_workers=0, processes=False, protocol="tcp://", host="127.0.0.1", silence_logs="ERROR",
                          dashboard_address="127.0.0.1:0") as cluster:
            address = cluster.scheduler_address
            worker = subprocess.Popen([sys.executable, "-m", "distributed.cli.dask_worker", address, "--no-nanny",
                                       "--nthreads", "2", "--no-dashboard", "--local-directory", self.dir],
                                      cwd=self.dir, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            try:
                status, _, err, flown = self.campaign(*self.LESS, "--runs", "4", "--scheduler", address)
            finally:
                worker.kill()
                worker.wait()
        self.assertEqual((status, flown, len(self.stored())), (0, 8, 8), err)


class Saying(Case):
    def test_percentiles_are_linear_between_neighbours(self):
        for share, value in ((0.0, 1.0), (0.5, 2.5), (0.95, 3.85), (1.0, 4.0)):
            self.assertAlmostEqual(table.percentile([4.0, 1.0, 3.0, 2.0], share), value)
        self.assertEqual(table.percentile([7.0], 0.95), 7.0)
        self.assertTrue(math.isnan(table.percentile([], 0.5)))

    def test_what_a_failure_is(self):
        for other, fails, fails_to_land in (
                ({}, False, False), ({"failed": True}, True, False), ({"takeovers": 1}, True, False),
                ({"touch_speed_mps": None}, False, True), ({"halted": True}, True, True),
                ({"started": False}, True, True)):
            self.assertEqual(table.failed(figures(**other)), fails, other)
            self.assertEqual(table.failed(figures(**other), lands=True), fails_to_land, other)

    def test_a_row_counts_all_flights_and_measures_those_that_did_not_fail(self):
        row = table.row("EST", "nominal", [
            figures(hover_rms_mm=10.0, cuts=2), figures(hover_rms_mm=30.0, ground_contacts=3),
            figures(hover_rms_mm=500.0, takeovers=2, highest_mm=900.0), figures(hover_rms_mm=20.0)])
        self.assertEqual([row[name] for name in ("flights", "failures", "contacts", "takeovers", "cuts", "highest_mm")],
                         [4, 1, 1, 1, 1, 900.0])
        self.assertEqual([row[f"hover_rms_mm_{name}"] for name in ("median", "p95", "mean", "max")],
                         [20.0, 29.0, 20.0, 30.0])
        nothing = table.row("EST", "nominal", [figures(halted=True, highest_mm=None)])
        for name in ("highest_mm", "hover_rms_mm_mean", "hover_rms_mm_max"):
            self.assertTrue(math.isnan(nothing[name]), name)

    def test_table_csv_json_and_picture_tell_the_same(self):
        status, out, err, _ = self.campaign("--law", "PID,EST", "--set", "nominal,blind", "--runs", "5")
        self.assertEqual(status, 0, err)
        self.assertIn("3.00 [4.80]", out)
        with (self.out / "campaign.csv").open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        told = json.loads((self.out / "campaign.json").read_text(encoding="utf-8"))
        self.assertEqual([(row["set"], row["law"]) for row in rows],
                         [("nominal", "PID"), ("nominal", "EST"), ("blind", "PID"), ("blind", "EST")])
        self.assertEqual([{name: str(value) for name, value in row.items()} for row in told["rows"]], rows)
        self.assertEqual((told["seed"], told["rows"][1]["hover_rms_mm_mean"]), (1, 3.0))
        picture = (self.out / "campaign.png").read_bytes()
        self.assertEqual(picture[:8], b"\x89PNG\r\n\x1a\n")
        self.assertGreater(len(picture), 5000)

    def test_nothing_measured_is_null_and_blank(self):
        rows = [table.row("EST", "nominal", [figures(halted=True, highest_mm=None)])]
        self.assertIsNone(table.plain(rows)[0]["hover_rms_mm_median"])
        table.write_csv(self.dir / "t.csv", rows)
        self.assertNotIn("nan", (self.dir / "t.csv").read_text())
        self.assertIn("- [-]", table.text(rows))

    def test_progress_tells_what_remains(self):
        out = io.StringIO()
        progress = fleet.Progress(10, out)
        progress.every_s = 0.0
        progress.step()
        self.assertRegex(out.getvalue(), r"^1 of 10 flights, \d+ s remain *\n$")

    def test_usage_errors_have_status_2(self):
        for words in (("--law", "PIDX"), ("--set", "windy"), ("--runs", "0"), ("--seed", "x")):
            with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(io.StringIO()):
                campaign.main(self.argv(*words))
            self.assertEqual(end.exception.code, 2, words)

    def test_a_page_is_written_by_a_whole_run_alone(self):
        """A vehicle, a plan, or a law of the program's own beside the others went into docs/control.md as if it were the campaign of the page."""
        own = self.dir / "own.json"
        own.write_text('{"laws": {"SLOWER": {"settings": {"POSK": 2}}}}', encoding="utf-8")
        for words in (("--runs", "9"), ("--law", "EST"), ("--law", f"{','.join(plan.LAWS)},GLIDE"), ("--set", "nominal"), ("--set", "KP=1"), ("--seed", "2"),
                      ("--plan", str(own)), ("--vehicle", str(own)), ("--healthy", "--held-out"), ("--battery", "--held-out")):
            with self.subTest(words=words), mock.patch.dict(plan.LAWS):
                with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(io.StringIO()) as err:
                    campaign.read_arguments(self.argv("--page", *words))
                self.assertEqual(end.exception.code, 2)
                self.assertIn("--page writes what a whole run found", err.getvalue())
        for words in ((), ("--healthy", "3"), ("--lies",), ("--lies", "2", "--held-out"), ("--battery",)):
            with self.subTest(words=words):
                self.assertTrue(campaign.whole(campaign.read_arguments(self.argv("--page", *words))))


def campaign_of(est=None, other=None):
    """Rows of a whole default campaign: of law EST, and of the others."""
    return [table.row(law, name, [figures(**((est if law == "EST" else other) or {}))] * s.runs, s.lands)
            for name, s in plan.SETS.items() if name in plan.DEFAULT_SETS for law in plan.LAWS]


class Judging(Case):
    def missed(self, rows):
        return [found.what for found in verdict.verdicts(rows) if found.missed]

    def test_good_flights_reach_every_aim(self):
        found = verdict.verdicts(campaign_of())
        self.assertEqual(len(found), len(verdict.EST) + 3)
        self.assertEqual({one.word for one in found}, {"aim"})

    def test_each_must_can_be_missed_by_est_alone(self):
        for bad, count in (({"hover_rms_mm": 27.1}, 5), ({"thrust_std_n": 0.51}, 1),
                           ({"failed": True}, len(verdict.EST) - 3), ({"ground_contacts": 1}, 1),
                           ({"recovery_s": 0.91}, 1), ({"undershoot_mm": 30.1}, 1), ({"max_error_mm": 90.1}, 1),
                           ({"touch_speed_mps": 0.51}, 1), ({"touch_speed_mps": None}, 2)):
            self.assertEqual(len(self.missed(campaign_of(est=bad))), count, (bad, self.missed(campaign_of(est=bad))))
            self.assertEqual(self.missed(campaign_of(other=bad)), [], bad)

    def test_between_must_and_aim(self):
        words = {found.what: found.word for found in verdict.verdicts(campaign_of(est={"recovery_s": 0.8}))}
        self.assertEqual(words["EST: within 50 mm after the edge"], "must")
        self.assertEqual(list(words.values()).count("must"), 1)

    def test_no_law_may_shoot_up_or_cut_the_throttle(self):
        for bad in ({"highest_mm": 1200.1}, {"cuts": 1}):
            self.assertEqual(len(self.missed(campaign_of(other=bad))), 1, bad)
        few = [table.row("PD", "nominal", [figures(cuts=1)])]
        self.assertEqual(len(self.missed(few)), 1)

    def test_few_flights_are_no_verdict_on_est(self):
        few = [table.row("EST", "untrimmed", [figures(hover_rms_mm=99.0)] * 199)]
        self.assertEqual(self.missed(few), [])
        self.assertNotEqual(self.missed([table.row("EST", "untrimmed", [figures(hover_rms_mm=99.0)] * 200)]), [])

    def test_a_missed_must_is_status_1(self):
        status, out, _, _ = self.campaign("--law", "EST", "--set", "nominal")
        self.assertEqual(status, 0, out)
        self.program.write_text(self.program.read_text().replace('"cuts": 0', '"cuts": 1'), encoding="utf-8")
        status, out, _, _ = self.campaign("--law", "EST", "--set", "nominal")
        self.assertEqual(status, 1)
        self.assertIn("MISSED", out)


class Bound(unittest.TestCase):
    def test_it_agrees_with_another_computation(self):
        # LQG of the same plant, written independently, its thrust changed every 25 ms: a little above ours.
        other_mm = {0.30: 11.7, 0.45: 9.5, 0.52: 9.0, 1.06: 7.5, 2.4: 6.6}
        for (activity_n, other), found in zip(other_mm.items(), bound.bounds(other_mm), strict=True):
            self.assertTrue(0.96 * other < found < other, (activity_n, found))


def shape(text):
    """The first cells of the tables, and how many others follow in their lines; without the demands that are not met."""
    text = text.partition("\nOf ")[0]
    return [(cells[1], len(cells)) for cells in (line.split("|") for line in text.splitlines() if line.startswith("|"))]


def plain_number(cell):
    return [float(number) for number in re.findall(r"\d+(?:\.\d+)?", cell)]


class Page(unittest.TestCase):
    def setUp(self):
        self.text = page.PAGE.read_text(encoding="utf-8")
        self.shown = page.BLOCK.search(self.text).group()

    def test_there_is_one_block_of_tables_and_it_is_complete(self):
        self.assertEqual(len(page.BLOCK.findall(self.text)), 1)
        rendered = page.render(campaign_of(), [(activity_n, 9.9) for activity_n in bound.ACTIVITIES_N])
        self.assertEqual(shape(self.shown), shape(rendered))

    def test_demands_that_do_not_reach_their_aim_are_on_the_page(self):
        for recovery_s, said, rows in ((0.7, f"{len(verdict.EST) + 3} reach their aim.", []),
                                       (0.8, f"{len(verdict.EST) + 2} reach their aim, these do not:", ["must"]),
                                       (0.95, f"{len(verdict.EST) + 2} reach their aim, these do not:", ["MISSED"])):
            found = page.demanded(verdict.verdicts(campaign_of(est={"recovery_s": recovery_s})))
            self.assertIn(said, found)
            self.assertEqual(re.findall(r"^\| EST: within 50 mm after the edge .* (\w+) \|$", found, re.MULTILINE), rows)

    def test_a_figure_that_differs_is_noticed(self):
        self.assertEqual(page.compare(self.shown, self.text), [])
        for match in list(re.finditer(r"\d+\.\d+", self.shown))[::7]:
            other = self.shown[:match.start()] + "7777" + self.shown[match.end():]
            self.assertNotEqual(page.compare(other, self.text), [], match.group())

    def test_the_bound_is_that_of_the_page(self):
        line = re.search(r"^\| bound \|.*$", self.shown, re.MULTILINE).group()
        self.assertEqual(plain_number(line), [round(value, 1) for value in bound.bounds(bound.ACTIVITIES_N)])

    def test_nominal_flights_are_still_as_the_page_says(self):
        # Another compiler may round otherwise: 2 %, and one unit of the last digit printed.
        lines = self.shown.splitlines()
        begin = next(k for k, line in enumerate(lines) if line.startswith("| law | rise"))
        cells = [line.strip("| ").split(" | ") for line in lines[begin + 2:begin + 2 + len(plan.LAWS)]]
        shown = {law: others for law, *others in cells}
        self.assertEqual(list(shown), list(plan.LAWS))
        runs = range(1, plan.SETS["nominal"].runs + 1)
        flights = [((law, run), plan.arguments(plan.LAWS[law], "nominal", 1, run)) for law in plan.LAWS for run in runs]
        flown = {}
        with fleet.fleet() as client:
            for (law, _), found in fleet.fly_all(client, PROGRAM, flights):
                flown.setdefault(law, []).append(found)
        for law, others in shown.items():
            for cell, found in zip(others, page.nominal(table.row(law, "nominal", flown[law])), strict=True):
                unit = 10.0 ** -len(found.partition(".")[2])
                page_says = plain_number(cell)[0]
                self.assertLessEqual(abs(page_says - float(found)), 0.02 * page_says + 1.01 * unit,
                                     (law, others, found))


class OnPages(unittest.TestCase):
    """What the pages tell to type, and the files that they show."""

    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)
        for table_of in (plan.LAWS, plan.SETS):     # what a page's plan adds is gone after each test
            kept = mock.patch.dict(table_of)
            kept.start()
            self.addCleanup(kept.stop)

    def understood(self, words):
        """Whether these are the arguments of a campaign, of a program that has a law MINE."""
        program = self.dir / "plomada"
        program.write_text("#!/bin/sh\necho 'one of: PD|PID|PIDT|EST|MINE'\n", encoding="utf-8")
        program.chmod(0o755)
        with mock.patch.dict(plan.LAWS), mock.patch.dict(plan.SETS), contextlib.chdir(ROOT), \
                mock.patch.object(campaign, "CAMPAIGNS", self.dir), \
                contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            (self.dir / campaign.BEGUN).write_text("[]", encoding="utf-8")     # one that --resume finds
            try:
                campaign.read_arguments(words if "--resume" in words else [*words, "--program", str(program)])
            except SystemExit as end:
                return end.code == 0        # --help
        return True

    def test_each_campaign_that_a_page_names_is_understood(self):
        pages = [*(ROOT / "docs").rglob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"]
        typed = {one for each in pages for one in re.findall(r'make campaign (ARGS=(?:"[^"]*"|[^\s`]+))', each.read_text(encoding="utf-8"))}
        self.assertGreater(len(typed), 9, typed)
        for line in sorted(typed):
            words = shlex.split(shlex.split(line)[0].removeprefix("ARGS="))
            words = [word for at, word in enumerate(words) if "--program" not in (word, *words[at - 1:at])]
            with self.subTest(line=line):
                self.assertTrue(self.understood(words))
        self.assertFalse(self.understood(["--law", "MINE,PIDD"]))
        self.assertFalse(self.understood(["--lying"]))

    def test_the_plan_the_scenario_and_the_situation_that_a_page_shows_are_ones(self):
        blocks = re.findall(r"^```\n(.*?)^```", (ROOT / "docs/campaign.md").read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
        own, = (block for block in blocks if block.startswith("{"))
        plan.extend(json.loads(own))
        self.assertEqual((plan.LAWS["SLOWER"].settings, plan.SETS["heavy"].runs), ({"POSK": "2"}, 50))
        scenario, = (block for block in blocks if block.startswith("like "))
        situation, = (block for block in blocks if block.startswith("["))
        (self.dir / "mine.scenario").write_text(scenario, encoding="utf-8")
        flown = subprocess.run([PROGRAM, "fly", self.dir / "mine.scenario"], capture_output=True, text=True, check=False)
        self.assertIn(flown.returncode, (0, 1), flown.stderr)
        self.assertIn("stairs", situations.read("page", situation).situations)


if __name__ == "__main__":
    unittest.main()
