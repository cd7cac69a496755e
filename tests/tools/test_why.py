"""tools/why on flights of simulated vehicles. Usage: test_why.py PLOMADA [long]

Without `long` flights of ten seconds and what needs none; with it whole ones.
"""
import contextlib
import dataclasses
import io
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools/why"), str(ROOT / "tools/fit"), str(ROOT / "tools/campaign")]
import acceptance  # noqa: E402
import begun  # noqa: E402
import commanded  # noqa: E402
import flight  # noqa: E402
import law  # noqa: E402
import mirrors  # noqa: E402
import numpy  # noqa: E402
import planted  # noqa: E402
import vehicle  # noqa: E402
import why  # noqa: E402
from causes import case as cases  # noqa: E402
from causes import forces, ground, rays, settings  # noqa: E402

PROGRAM = None
SEED = "test_why"


def dump_as_xctu(console, path):
    """What XCTU saves of the same octets: packets, as hex, with their times."""
    octets = console.read_bytes()
    packets = [octets[at:at + 90] for at in range(0, len(octets), 90)]
    lines = [f"02-05-2015 11:{number // 600:02d}:{number / 10.0 % 60.0:06.3f},-,RECV,{packet.hex().upper()}" for number, packet in enumerate(packets)]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


class Flights(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)

    def flown(self, cause, number=0, seed=SEED, share=None, **changes):
        path = self.dir / f"{cause}-{number}.csv"
        self.assertTrue(planted.fly(PROGRAM, dataclasses.replace(planted.plan_of(cause, seed, number, share), **changes), path))
        return path

    def plomada(self, *words):
        return subprocess.run([PROGRAM, "why", *map(str, words)], check=False, capture_output=True, text=True, cwd=self.dir)

    def refused(self, path, reason, out="no.png"):
        told = io.StringIO()
        with contextlib.redirect_stderr(told):
            status = why.main([str(path), "--out", str(self.dir / out), "--program", PROGRAM])
        self.assertEqual(status, 2)
        self.assertIn(reason, told.getvalue())
        self.assertFalse((self.dir / out).exists())


class OfTenSeconds(Flights):
    """With two references."""

    def short(self, cause, number=0, **changes):
        return self.flown(cause, number, land_s=10.0, lines=planted.plan_of(cause, SEED, number).lines[:2], **changes)


class Short(OfTenSeconds):
    def test_of_a_saved_console_two_sentences_and_a_picture_name_the_blocked_mirror(self):
        plan = planted.plan_of("nothing", SEED, 1)
        plant = plan.plant | {"sight_blocked": 1.0, "struck_beam": 2.0, "block_mm": 300.0, "sight_blocked_start": 5.0}
        console = self.short("nothing", 1, csv=False, plant=plant, settings=plan.settings | {"LAYOUT": "THREE"}).with_suffix(".log")
        self.assertTrue(console.exists())
        done = self.plomada(console, "--out", self.dir / "shown.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("the aft mirror showed a thing 0.30 m along its rays", done.stdout.splitlines()[0])
        self.assertIn("Look for what stands before the aft mirror", done.stdout.splitlines()[1])
        self.assertIn("vibration ...", done.stderr)
        self.assertEqual((self.dir / "shown.png").read_bytes()[:4], b"\x89PNG")

    def test_the_picture_lies_where_it_is_said_to_and_the_end_of_a_pipe_is_no_end_of_the_work(self):
        log = self.short("nothing")
        (self.dir / "pictures").mkdir()
        done = self.plomada(log, "--out", "pictures")
        self.assertEqual((done.returncode, done.stdout.splitlines()[-1]), (0, "pictures/why.png"), done.stderr)
        self.assertEqual((self.dir / "pictures/why.png").read_bytes()[:4], b"\x89PNG")
        self.assertFalse((self.dir / "pictures.png").exists())
        self.assertEqual(why.read_arguments(["a.csv", "--out", "shown"]).out, Path("shown.png"))
        reads, writes = os.pipe()
        os.close(reads)
        done = subprocess.run([PROGRAM, "why", log, "--out", self.dir / "piped.png"], stdout=writes, stderr=subprocess.PIPE, text=True, check=False)
        os.close(writes)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("Broken", done.stderr)
        self.assertEqual((self.dir / "piped.png").read_bytes()[:4], b"\x89PNG")

    def test_of_a_healthy_flight_nothing_is_named(self):
        case, found = why.ask(self.short("nothing"), PROGRAM)
        self.assertEqual(why.verdict(found), [])
        self.assertIn("Nothing found", why.sentences(case, found)[0])

    def test_a_law_that_the_firmware_does_not_fly_again_is_left_to_the_thrusts(self):
        seen = flight.read(self.short("nothing", settings=planted.PID_TUNED | {"LAW": "PID", "GRAV": 7.0, "LAYOUT": "FRONT"}), PROGRAM)
        told = commanded.of(seen, PROGRAM, law.of(seen))
        self.assertTrue(told is None or told.fits > law.of(seen).fits)

    def test_the_columns_of_the_truth_are_not_looked_at(self):
        path = self.short("axes", csv=True)
        lines = path.read_text(encoding="utf-8").splitlines()
        titles = lines[0].split(",")
        places = [titles.index(name) for name in ("height_m", "abs_m", "terrain_m")]
        wrong = self.dir / "untold.csv"
        rows = [lines[0]]
        for line in lines[1:]:
            cells = line.split(",")
            for place in places:
                cells[place] = "9.0"
            rows.append(",".join(cells))
        wrong.write_text("\n".join(rows) + "\n", encoding="utf-8")
        one, other = (flight.read(each, PROGRAM) for each in (path, wrong))
        self.assertEqual(set(one.column), {*flight.NEEDED, *flight.WORDS, "innov_m", "est_m"})
        for name in one.column:
            numpy.testing.assert_array_equal(one.column[name], other.column[name])

    def test_of_several_dumps_it_says_which_one_it_answers_for_and_one_in_utf_16_is_one(self):
        text = self.short("nothing", csv=False).with_suffix(".log").read_bytes().decode("latin-1")
        for name, octets, dump in (("one.log", text.encode("utf-16"), ""), ("two.log", (text + text[:len(text) // 2]).encode("latin-1"), "dump 1 of 2"),
                                   ("last.log", (text[:len(text) // 2] + "\r\n" + text).encode("latin-1"), "dump 2 of 2")):
            (self.dir / name).write_bytes(octets)
            seen = flight.read(self.dir / name, PROGRAM)
            self.assertEqual(seen.dump, dump)
            self.assertEqual(why.which(cases.Case(seen, [], None, None)),
                             f"This is {dump}, the longest; `plomada log` makes a CSV of each." if dump else "")

    def test_a_piece_of_a_flight_that_is_too_short_is_told_as_one(self):
        rows = self.short("nothing").read_text(encoding="utf-8").splitlines()
        piece = self.dir / "piece.csv"
        aloft = next(number for number, row in enumerate(rows) if ",FLYING," in row)
        piece.write_text("\n".join([rows[0], *rows[aloft:aloft + 100]]) + "\n", encoding="utf-8")
        self.assertRegex(why.sentences(*why.ask(piece, PROGRAM))[0], r"too short\. Of [012]\.\d s in the air \d+ heights can be used; it takes 1\.5 s in one piece, "
                         "and 12 heights")

    def test_what_is_no_flight_is_refused_with_a_reason(self):
        self.refused(self.dir / "none.csv", "No such file")
        text = self.dir / "text.csv"
        text.write_text("dear diary\n", encoding="utf-8")
        self.refused(text, "neither a flight CSV")
        telemetry = self.dir / "telemetry.txt"
        telemetry.write_text("alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0\r\n" * 50, encoding="utf-8")
        self.refused(telemetry, "type #LOG after the flight")
        bench = self.dir / "bench.csv"
        bench.write_text("t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags,up_mps2,pulse_us,age_s,doubt,limit\n"
                         + "".join(f"{0.025 * k:.3f},0.000,0.000,,0.000,0.000,0.0,0.0,GROUND,0,0.0,2000,0.07,,\n" for k in range(400)), encoding="utf-8")
        self.refused(bench, "no flight")

    def test_without_its_packages_it_says_what_installs_them(self):
        """After `make fly` build/venv has those of the pictures alone."""
        for name in ("build/venv/bin", "tools/why"):
            (self.dir / name).mkdir(parents=True)
        program = shutil.copy(PROGRAM, self.dir / "build/plomada")
        (self.dir / "build/venv/bin/python").symlink_to(sys.executable)
        (self.dir / "tools/why/why.py").write_text("import no_such_package\n")
        for word in ("--help", "flight.csv"):
            done = subprocess.run([program, "why", word], check=False, capture_output=True, text=True)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn("its Python: is not installed; `make why LOG=FILE` installs it", done.stderr)
            self.assertNotIn("Traceback", done.stderr)

    def test_a_picture_that_cannot_be_written_is_status_2(self):
        path = self.dir / "any.csv"
        path.touch()
        self.refused(path, "any.csv", "any.csv/no.png")


class BegunInTheAir(OfTenSeconds):
    """Logs that do not hold the take-off, or not all of it."""

    def test_of_a_healthy_log_that_begins_in_the_air_nothing_is_named_whatever_law_flew_it(self):
        wide = {"USAT": 3.0, "DSAT": 3.0}
        for number, law_of in enumerate(({"LAW": "EST"}, {"LAW": "PIDT"}, planted.PID_TUNED | wide | {"LAW": "PID"})):
            with self.subTest(law_of["LAW"]):
                path = self.short("nothing", number, settings=planted.plan_of("nothing", SEED, number).settings | law_of)
                planted.cut(path, 3.0)
                case, found = why.ask(path, PROGRAM)
                self.assertEqual(why.verdict(found), [])
                self.assertGreater(case.model.linear_figure("authority"), 0.8)      # the thrust does what it does on other vehicles

    def test_of_a_healthy_flight_of_a_minute_whose_beginning_the_ring_has_lost_nothing_is_named(self):
        console = self.dir / "minute.log"
        subprocess.run([PROGRAM, "fly", "hover-60s", "--set", "LAW=EST", "--set", "LAYOUT=THREE", "--log", console], check=False,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        case, found = why.ask(console, PROGRAM)
        self.assertEqual(len(case.flight.t_s), flight.RING_ROWS)
        self.assertEqual(why.verdict(found), [])

    def test_a_take_off_of_est_that_lacks_its_first_rows_does_not_tell_grav(self):
        path = self.short("nothing", settings=planted.plan_of("nothing", SEED, 0).settings | {"LAW": "EST"}, csv=False)
        self.assertTrue(math.isfinite(law.of(flight.read(path, PROGRAM)).first_n))
        lines = path.read_text(encoding="utf-8").splitlines()
        path.write_text("\n".join([lines[0], *lines[13:]]) + "\n", encoding="utf-8")
        seen = flight.read(path, PROGRAM)
        self.assertEqual(seen.column["state"][0], "TAKEOFF")
        self.assertTrue(math.isnan(law.of(seen).first_n))
        self.assertIsNone(ground.takeoff_s(seen, seen.spans[0][0]))


class Gains(OfTenSeconds):
    """As the firmware tells them, by many replays. `make soak` asks these."""

    def test_the_firmware_that_flies_the_log_again_tells_which_gains_were_set(self):
        for law_name, gains, within in (("EST", {"VELK": 5.5}, 0.15), ("PIDT", {"PKP": 9.5, "PKD": 3.4, "PKI": 1.9}, 0.03)):
            with self.subTest(law_name):
                usual = planted.plan_of("nothing", SEED, 0).settings
                seen = flight.read(self.short("nothing", settings=usual | gains | {"LAW": law_name}), PROGRAM)
                told = commanded.of(seen, PROGRAM, law.of(seen))
                self.assertEqual(told.law, law_name)
                self.assertGreater(told.fits, 0.9)
                for name, value in gains.items():
                    self.assertLess(abs(math.log(told.value[name] / value)), within, name)
                self.assertLess(abs(told.value["GRAV"] - usual["GRAV"]), 0.1)

    def test_of_a_log_that_begins_in_the_air_est_tells_its_gains_and_pidt_does_not(self):
        for law_name, known in (("EST", True), ("PIDT", False)):
            with self.subTest(law_name):
                usual = planted.plan_of("nothing", SEED, 0).settings | {"LAW": law_name, "VELK": 5.5}
                lines = self.short("nothing", settings=usual).read_text(encoding="utf-8").splitlines()
                late = self.dir / "late.csv"
                late.write_text("\n".join([lines[0], *lines[len(lines) // 4:]]) + "\n", encoding="utf-8")
                seen = flight.read(late, PROGRAM)
                told = commanded.of(seen, PROGRAM, law.of(seen))
                self.assertEqual(told is not None, known)
                if known:
                    self.assertLess(abs(math.log(told.value["VELK"] / 5.5)), 0.2)
                self.assertIsNone(settings.grav_n(cases.Case(seen, [], None, law.of(seen), told)))


class Planted(Flights):
    """Whole flights. `make soak` asks these."""

    def first(self, cause, number=0, seed=SEED, share=None, **settings_too):
        plan = planted.plan_of(cause, seed, number, share)
        found = why.ask(self.flown(cause, number, seed, share, settings=plan.settings | settings_too), PROGRAM)[1]
        return why.verdict(found)[:1], found

    def test_a_rope_and_a_lost_link_are_named_first(self):
        for cause, kind in (("rope", "ropes"), ("link", "link")):
            with self.subTest(cause):
                self.assertEqual(self.first(cause)[0], [kind])

    def test_flights_on_which_earlier_models_were_wrong(self):
        """An autopilot's climb rate that looked like a slow vehicle, a window in which the thrust chatters, tiles that three mirrors average."""
        for cause, kind, number, share in (("mode", "mode", 1, 0.25), ("saturation", "saturation", 4, 0.75), ("colours", "floor", 2, 0.42)):
            with self.subTest(cause):
                self.assertEqual(self.first(cause, number, "train-11", share)[0], [kind])

    def test_weak_causes_that_earlier_models_missed(self):
        """Gains of 0.61 and 1.64 times, GRAV 1.0 N off, rays 43 ms late, a ground effect that the air hid but at the lift-off."""
        for cause, kind, number, seed, share in (("cold", "cold", 0, "dev-1", 0.31875), ("hot", "hot", 0, "dev-1", 0.31875),
                                                 ("grav", "grav", 1, "dev-1", 0.294), ("late", "late", 2, "dev-2", None),
                                                 ("ground", "ground", 9, "dev-1", 0.98)):
            with self.subTest(cause):
                self.assertEqual(self.first(cause, number, seed, share)[0], [kind])

    def test_causes_are_named_in_logs_that_begin_in_the_air(self):
        for cause, kind in (("axes", "axes"), ("tugs", "ropes"), ("cold", "cold"), ("rough", "floor"), ("vibration", "vibration")):
            with self.subTest(cause):
                path = self.flown(cause, 0, SEED, 0.85)
                planted.cut(path, 5.0)
                self.assertEqual(why.verdict(why.ask(path, PROGRAM)[1])[:1], [kind])

    def test_of_three_mirrors_one_two_or_all_blocked_are_named(self):
        for number, share in ((1, 0.1), (2, 0.5), (4, 0.75)):
            with self.subTest(share):
                named, found = self.first("blocked", number, "train-11", share)
                self.assertEqual(named, ["rays"])
                self.assertEqual(set(found["rays"].words["mirrors"]), planted.plan_of("blocked", "train-11", number, share).mirrors)

    def test_of_one_mirror_that_one_is_named_and_another_does_not_matter(self):
        blocked = {"sight_blocked": 1.0, "block_mm": 300.0, "sight_blocked_start": 8.0}
        for beam, expected in ((1.0, ("front",)), (2.0, None)):
            with self.subTest(beam):
                plan = planted.plan_of("nothing", SEED, 1)
                path = self.flown("nothing", 1, plant=plan.plant | blocked | {"struck_beam": beam}, settings=plan.settings | {"LAYOUT": "FRONT", "LAW": "EST"})
                found = why.ask(path, PROGRAM)[1]
                self.assertEqual(found["rays"].words.get("mirrors") if expected else why.verdict(found) or None, expected)

    def test_a_mirror_that_sees_nothing_is_named(self):
        plan = planted.plan_of("nothing", SEED, 1)
        path = self.flown("nothing", 1, plant=plan.plant | {"rays_lost": 1.0, "rays_lost_start": 6.0, "rays_lost_length": 4.0, "struck_beam": 3.0},
                          settings=plan.settings | {"LAYOUT": "THREE"})
        case, found = why.ask(path, PROGRAM)
        self.assertIn("the fore mirror saw nothing", why.sentences(case, found)[0])

    def test_a_vehicle_that_never_left_the_ground_is_told_why(self):
        case, found = why.ask(self.flown("grav", 4, "train-11", 0.75), PROGRAM)
        self.assertIn("It never lifted off", why.sentences(case, found)[0])

    def test_every_kind_of_log_with_three_mirrors_and_with_one_gets_the_same_answer_or_a_reason(self):
        for layout, expected in (("THREE", ["rays"]), ("FRONT", [])):
            scenario = self.dir / "short.scenario"
            scenario.write_text("reference 0.60\nat 6.5 SETR 0.80\nland 12\nend 18\n", encoding="utf-8")
            csv, console, record = (self.dir / f"{layout}{ending}" for ending in (".csv", ".log", ".record"))
            subprocess.run([PROGRAM, "fly", scenario, "--seed", "3", "--set", "LAW=EST", "--set", f"LAYOUT={layout}", "--set", "plant.sight_blocked=1",
                            "--set", "plant.struck_beam=2", "--set", "plant.block_mm=300", "--set", "plant.sight_blocked_start=6",
                            "--csv", csv, "--log", console, "--record", record], check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            rows = csv.read_text(encoding="utf-8").splitlines()
            cut, torn, few = (self.dir / f"{layout}-{name}.csv" for name in ("cut", "torn", "few"))
            cut.write_text("\n".join(rows[:1100]) + "\n" + rows[1100][:20], encoding="utf-8")
            torn.write_text("\n".join(row for number, row in enumerate(rows) if not 900 < number < 1000) + "\n", encoding="utf-8")
            few.write_text("\n".join(rows[:240]) + "\n", encoding="utf-8")
            half = self.dir / f"{layout}-half.log"
            half.write_bytes(console.read_bytes()[:int(0.7 * console.stat().st_size)])
            for log in (csv, console, dump_as_xctu(console, self.dir / f"{layout}-xctu.log"), record, cut, torn, half):
                with self.subTest(log.name):
                    self.assertEqual(why.verdict(why.ask(log, PROGRAM)[1]), expected)
            with self.subTest(few.name):
                case, found = why.ask(few, PROGRAM)
                self.assertIn("It does not know", why.sentences(case, found)[0])


class Mirrors(unittest.TestCase):
    """Scans that are made of the words of tools/why/mirrors.py."""

    def scans(self, blocked=(), seed=1, floor_mm=0.0, count=150):
        rng = numpy.random.default_rng(seed)
        time_s = 0.1 * numpy.arange(count)
        height = 700.0 + 12.0 * numpy.convolve(rng.standard_normal(count + 9), numpy.ones(10) / math.sqrt(10.0), "valid")
        tilt = 0.03 * rng.standard_normal((count, 2))
        slant = height + numpy.array([[105.0], [115.0], [107.0]]) + numpy.outer([0.0, -110.0, 110.0], tilt[:, 0]) + 3.3 * rng.standard_normal((3, count))
        floors = numpy.zeros((3, count))
        for k in range(1, count):
            floors[:, k] = 0.78 * floors[:, k - 1] + 0.63 * floor_mm * rng.standard_normal(3)
        slant += floors
        for m in blocked:
            slant[m, 70:] = 300.0 + 5.0 * rng.standard_normal(count - 70)
        return mirrors.Scans(time_s, ["front", "aft", "fore"], slant, tilt, numpy.zeros((3, count)))

    def test_a_mirror_that_stands_still_while_the_others_move_is_found_and_since_when(self):
        for blocked, names in (((1,), ("aft",)), ((0, 2), ("front", "fore"))):
            found = mirrors.liars(self.scans(blocked))
            self.assertEqual(found.mirrors, names)
            self.assertGreater(found.nats, why.WORTH)
            self.assertLess(abs(found.begin_s - 7.0), 0.6)
            self.assertLess(abs(found.slant_mm[0] - 300.0), 3.0)

    def test_of_honest_mirrors_over_a_plain_floor_and_over_a_rough_one_none_is_a_liar(self):
        for seed in range(6):
            for floor_mm in (0.0, 15.0):
                self.assertLess(mirrors.liars(self.scans(seed=seed, floor_mm=floor_mm)).nats, why.WORTH)

    def test_a_thing_before_all_mirrors_is_not_said_to_stand_before_two(self):
        self.assertEqual(mirrors.liars(self.scans((0, 1, 2))).mirrors, ("front", "aft", "fore"))

    def test_scans_without_a_slant_are_no_news(self):
        scans = self.scans((1,))
        scans.slant_mm[:, 40:48] = numpy.nan
        scans.slant_mm[0, 90:95] = numpy.nan
        self.assertEqual(mirrors.liars(scans).mirrors, ("aft",))
        quiet = self.scans()
        quiet.slant_mm[:, 40:48] = numpy.nan
        self.assertLess(mirrors.liars(quiet).nats, why.WORTH)
        self.assertEqual(mirrors.unseeing(quiet)["aft"], [])

    def test_a_floor_with_heights_of_its_own_under_each_mirror_is_found_and_a_plain_one_is_not(self):
        nats, mm = mirrors.terrain(self.scans(floor_mm=8.0))
        self.assertGreater(nats, 20.0)
        self.assertLess(abs(mm - 8.0), 4.0)
        for seed in range(4):
            self.assertLess(mirrors.terrain(self.scans(seed=seed))[0], 0.0)

    def test_one_mirror_alone_tells_nothing_of_itself(self):
        alone = self.scans((0,))
        alone = mirrors.Scans(alone.time_s, ["front"], alone.slant_mm[:1], alone.tilt, alone.lie[:1])
        self.assertLess(mirrors.liars(alone).nats, 0.0)
        self.assertEqual(mirrors.terrain(alone), (0.0, 0.0))


class Strengths(unittest.TestCase):
    def test_every_cause_has_a_range_with_a_source_that_grows_from_weak_to_strong(self):
        self.assertEqual(set(planted.RANGES), set(planted.CAUSES))
        for name, of in planted.RANGES.items():
            with self.subTest(name):
                self.assertAlmostEqual(of.at(0.0), of.weak)
                self.assertAlmostEqual(of.at(1.0), of.strong)
                self.assertAlmostEqual(of.share(of.at(0.4)), 0.4)
                self.assertTrue(of.source)
                self.assertTrue(of.shown(of.strong))
                self.assertFalse(of.shown(of.healthy))

    def test_the_table_counts_the_flights_that_runs_printed(self):
        told = [acceptance.Told("hot", 0, planted.plan_of("hot", "x", 0, share), named, named, (), 1.0) for share, named in
                ((0.1, []), (0.5, ["hot"]), (0.9, ["hot"]), (0.95, ["mode"]))]
        row = next(line for line in acceptance.table([each.line() for each in told] + ["nonsense"]).splitlines() if line.startswith("| hot "))
        self.assertIn("| 0 of 1 | 1 of 1 | 1 of 2 |", row)

    def test_what_why_holds_for_healthy_is_what_is_drawn(self):
        self.assertEqual(settings.TRIM_N, planted.TRIM_N)
        self.assertEqual(forces.GROWTH_HEALTHY, 0.0015)
        for number in range(40):
            plan = planted.plan_of("nothing", "x", number)
            self.assertLess(abs(plan.settings["GRAV"] - plan.plant["hover_thrust"]), settings.TRIM_N)
            self.assertLess(abs(math.log(plan.plant["gain"])), settings.EFFECT_WITHIN + 1e-9)
            self.assertLessEqual(plan.plant["sag"], forces.GROWTH_HEALTHY)
            self.assertLess(abs(plan.plant["ray_instant"] - 0.034), vehicle.AGE_MOST_S)

    def test_the_whole_range_is_drawn(self):
        thirds = {planted.plan_of("hot", "x", number).third() for number in range(30)}
        self.assertEqual(thirds, set(planted.THIRDS))


class Likelihood(unittest.TestCase):
    """The filter and the regression, on data that are drawn from their own equations."""

    FIGURES = {name: median for name, (median, _) in vehicle.FIGURES.items()}

    def span(self, seed=1, seconds=12.0):
        rng = numpy.random.default_rng(seed)
        grid = numpy.arange(-1.0, seconds, vehicle.STEP_S)
        thrust = 7.0 + 0.6 * numpy.sin(2.0 * grid) + 0.4 * numpy.sign(numpy.sin(0.7 * grid))
        ray_s, frame_s = numpy.arange(0.0, seconds - 0.1, 0.1), numpy.arange(0.0, seconds - 0.1, 0.025)
        level = numpy.ones(len(grid))
        span = vehicle.Span(0.0, seconds, grid, thrust, level, 0.6 * level, ray_s, numpy.zeros(len(ray_s)), 0.03 * rng.standard_normal(len(ray_s)),
                            0.03 * rng.standard_normal(len(ray_s)), frame_s, numpy.zeros(len(frame_s)), grid, 0.0 * grid, 0.0 * grid)
        span.order()
        span.log_middle = 0.5 * seconds
        f = self.FIGURES
        steps = int(seconds / vehicle.STEP_S)
        keep = math.exp(-vehicle.STEP_S / f["turbulence_tau"])
        gust = numpy.zeros(len(grid))
        for k in range(len(grid) - steps, len(grid)):
            gust[k] = keep * gust[k - 1] + f["turbulence"] * math.sqrt(1.0 - keep**2) * rng.standard_normal()
        air = vehicle.model.ground_effect(span.height_m)
        push = 1.4 * vehicle.lagged(span, f) * air - vehicle.G + gust
        made = vehicle.response(span, push, f["damping"])
        noise = numpy.where(span.is_height, f["height_noise"], f["acc_noise"]) * rng.standard_normal(len(made))
        unsorted = numpy.empty_like(made)
        unsorted[span.sorted] = made + noise
        span.ray_m, span.up = unsorted[:len(ray_s)], unsorted[len(ray_s):]
        return span

    def test_what_the_equations_leave_is_white_and_of_one_standard_deviation(self):
        found = vehicle.model_of("THRUST", [self.span()], dict(self.FIGURES)).solve()
        self.assertAlmostEqual(float((found.rest**2).mean()), 1.0, delta=0.12)
        self.assertLess(abs(float((found.rest[1:] * found.rest[:-1]).mean())), 0.12)

    def test_a_batch_of_figures_gives_what_each_gives_alone(self):
        span = self.span()
        others = [dict(self.FIGURES, turbulence=value, damping=value * 10.0) for value in (0.15, 0.3)]
        together = vehicle.solve_together([vehicle.model_of("THRUST", [span], f) for f in others])
        for one, f in zip(together, others):
            self.assertAlmostEqual(one.evidence(), vehicle.model_of("THRUST", [span], f).solve().evidence(), places=6)

    def test_a_column_that_is_there_is_found_and_one_that_is_not_costs(self):
        span = self.span()
        span.ray_m = span.ray_m + 0.25 * span.roll

        def tilt(of):
            return lambda each, _f: each.merged(getattr(each, of)[:, None], numpy.zeros((len(each.frame_s), 1)))
        found = vehicle.model_of("THRUST", [span], dict(self.FIGURES)).solve()
        nats, size, spread = found.gain(tilt("roll"), 0.3)
        self.assertGreater(float(nats[0]), 10.0)
        self.assertLess(abs(float(size[0]) - 0.25), 3.0 * float(spread[0]))
        self.assertLess(float(found.gain(tilt("pitch"), 0.3)[0][0]), 0.5)

    def test_a_column_tried_alone_gains_what_the_model_with_it_gains(self):
        span = self.span()
        span.ray_m = span.ray_m + 0.1 * span.roll

        def tilt(each, _f):
            return each.merged(each.roll[:, None], numpy.zeros((len(each.frame_s), 1)))
        plain = vehicle.model_of("THRUST", [span], dict(self.FIGURES)).solve()
        wide = vehicle.model_of("THRUST", [span], dict(self.FIGURES), [tilt], [0.3]).solve()
        self.assertAlmostEqual(float(plain.gain(tilt, 0.3)[0][0]), wide.evidence() - plain.evidence(), delta=0.5)     # robust weights differ

    def test_a_figure_within_what_healthy_vehicles_have_speaks_against_a_cause(self):
        self.assertLess(cases.wider(0.0, 0.1, 0.3, 2.0), 0.0)
        self.assertGreater(cases.wider(2.0, 0.1, 0.3, 2.0), 10.0)
        self.assertAlmostEqual(cases.wider(2.0, 50.0, 0.3, 2.0), 0.0, places=1)     # not known: no news


    def test_a_figure_that_lies_evenly_within_bounds_has_a_density_of_one_in_all(self):
        places = numpy.arange(-4.0, 6.0, 0.01)
        for sigma in (0.05, 0.4, 0.8):
            density = numpy.exp([cases.even(x, sigma, -1.0, 2.0) for x in places])
            self.assertAlmostEqual(float(density.sum()) * 0.01, 1.0, delta=0.005)
        self.assertAlmostEqual(cases.even(50.0, 0.1, -1.0, 2.0), cases.even(-49.0, 0.1, -1.0, 2.0), places=6)       # far tails keep their digits
        self.assertLess(cases.even(50.0, 0.1, -1.0, 2.0), -1e5)

    def test_what_is_expected_of_a_growing_hover_thrust_does_not_count_as_seen(self):
        def seen(expected, spread):
            model = vehicle.model_of("THRUST", [self.span()], dict(self.FIGURES))
            model.prior, model.spread = model.prior.copy(), model.spread.copy()
            model.prior[2], model.spread[2] = expected, spread
            return forces.growth(model.solve())
        (usual, spread), (other, other_spread) = seen(0.0007, 0.0012), seen(0.01, 0.004)
        self.assertAlmostEqual(usual, other, delta=0.05 * spread)
        self.assertAlmostEqual(spread, other_spread, delta=0.05 * spread)

    def test_nothing_moves_a_vehicle_that_the_ground_carries(self):
        span = dataclasses.replace(self.span(), free_s=5.0)
        moved = vehicle.response(span, numpy.ones(len(span.grid_s)), 2.0)
        self.assertEqual(float(numpy.abs(moved[span.time_s < 5.0]).max()), 0.0)
        heights = moved[span.is_height & (span.time_s > 5.2)]
        self.assertTrue((numpy.diff(heights) > 0.0).all())

    def test_a_span_begins_when_the_commands_before_it_are_known_and_no_earlier_push_is_counted(self):
        count = 400
        t_s = 0.025 * numpy.arange(count)
        column = {name: numpy.zeros(count) for name in flight.NEEDED} | {"t_s": t_s, "meas_m": numpy.full(count, 0.6), "thrust_n": numpy.full(count, 7.0)}
        for before, begin in (("FLYING", vehicle.LEAD_S), ("GROUND", 0.5)):
            column["state"] = numpy.array([before] + ["FLYING"] * (count - 1))
            seen = flight.Flight("x", column, numpy.ones(count, bool), t_s, numpy.ones(count, bool), 0.0, [])
            span = vehicle.span_of(seen, 0.5, 9.0)
            self.assertAlmostEqual(span.begin, begin)
            moved = vehicle.response(span, numpy.where(span.grid_s < begin - vehicle.STEP_S, 1e3, 0.0), 2.0)
            self.assertEqual(float(numpy.abs(moved).max()), 0.0)

    def test_older_rays_see_the_motion_from_their_own_first_instant_on(self):
        older = vehicle.changed(dataclasses.replace(self.span(), free_s=0.0), 0.1)
        self.assertLess(older.free_s, older.ray_s[0])
        self.assertEqual(vehicle.changed(dataclasses.replace(self.span(), free_s=-1.0), 0.1).free_s, -1.0)

    def test_more_ground_effect_lifts_off_earlier(self):
        span = self.span()
        span.height_m = numpy.zeros(len(span.grid_s))
        span.thrust_n = 4.0 + 0.5 * (span.grid_s + 1.0)
        usual = vehicle.model_of("THRUST", [self.span()], dict(self.FIGURES)).solve()
        instants = [ground.lift_off_s(span, 0.0, usual, times) for times in (1.0, 2.0, 4.0)]
        self.assertGreater(instants[0], instants[1] + 0.1)
        self.assertGreater(instants[1], instants[2] + 0.1)
        self.assertIsNone(ground.lift_off_s(dataclasses.replace(span, thrust_n=0.0 * span.thrust_n), 0.0, usual, 1.0))

    def test_the_age_of_the_rays_is_where_the_likelihood_has_its_top_and_as_sure_as_that_is_sharp(self):
        known = {age_s: (-0.5 * ((age_s - 0.063) / 0.004)**2, None) for age_s in (0.05, 0.06, 0.07)}
        age_s, sigma_s = rays.peak(known, 0.06)
        self.assertAlmostEqual(age_s, 0.063, places=6)
        self.assertAlmostEqual(sigma_s, math.hypot(0.004, rays.METHOD_S), places=6)


class Guesses(unittest.TestCase):
    def found(self, **nats):
        return {key: cases.Finding(value) for key, value in nats.items()}

    def test_behind_nothing_found_stands_a_cause_that_is_too_weak_to_be_named_and_says_so(self):
        weak = self.found(hot=1.6, floor=0.9, grav=-1.0)
        self.assertEqual(why.guesses(weak), [None, "hot"])
        self.assertIn("gains too hot, 5 times as likely as nothing. To be named takes 33 times", why.hint(weak))

    def test_a_cause_that_is_named_is_the_first_guess_and_one_that_is_no_likelier_than_nothing_is_none(self):
        for found, guesses in ((self.found(floor=9.0, hot=4.0, grav=3.7), ["floor", "hot"]), (self.found(floor=9.0, hot=2.0), ["floor"]),
                               (self.found(hot=0.5), [None]), ({}, [None])):
            self.assertEqual(why.guesses(found), guesses)
            self.assertEqual(why.hint(found), "")


class Law(unittest.TestCase):
    """What the log tells of the law, on rows made by its own equations."""

    def rows(self, thrust, height=None):
        count = len(thrust)
        t_s = 0.1 * numpy.arange(count)
        column = {"t_s": t_s, "meas_m": numpy.zeros(count) if height is None else height, "ref_m": numpy.full(count, 0.6), "thrust_n": thrust,
                  "state": numpy.array(["GROUND"] + ["TAKEOFF"] * (count - 1)), "limit": numpy.array([""] * count), "doubt": numpy.array([""] * count)}
        return flight.Flight("x", column, numpy.ones(count, bool), t_s, numpy.ones(count, bool), 0.0, [])

    def test_pidt_that_swings_has_its_gain_lowered_and_one_that_is_calm_has_not(self):
        flying = numpy.ones(100, bool)
        to_and_fro = numpy.where(numpy.arange(100) // 3 % 2 == 0, 1.0, -1.0)
        seen = self.rows(numpy.zeros(100))
        self.assertLess(law.pidt_calm(seen, flying, 1.5 * to_and_fro)[-1], 0.5)
        self.assertEqual(law.pidt_calm(seen, flying, 0.5 * to_and_fro)[-1], 1.0)

    def test_grav_is_read_from_the_first_thrusts_of_a_pidt_flight(self):
        state = law.Law(False, 0, 0.0, 0.0, (9.0, 9.0), 0.0, 0.0, 0.0, (0.0, 0.0), [], 5.8, numpy.nan)
        gathered = 1.4 * 0.4 * 0.1 * numpy.arange(20)
        grav_n, sigma_n = begun.grav_n(self.rows(3.4 + 6.0 * 0.4 + gathered), state)
        self.assertLess(abs(grav_n - 3.4), 2.0 * sigma_n)
        self.assertLess(sigma_n, 0.5)

    def test_a_thrust_that_rests_at_its_limit_is_saturated_in_any_window_and_one_that_swings_is_not(self):
        def nats(stays_s):
            return settings.saturation(cases.Case(None, [], None, law.Law(True, 99, 0.0, 0.0, (9.0, 9.0), 0.0, 0.3, 0.0, (4.0, 9.0), stays_s, 5.0, 7.0))).nats
        self.assertGreater(nats([1.5, 2.0, 0.8]), why.WORTH)
        self.assertLess(nats([0.2] * 30), 0.0)


class Reader(unittest.TestCase):
    def test_a_height_that_comes_a_row_after_its_age_belongs_to_that_age(self):
        rays_s = numpy.repeat([1.0, 1.1, 1.2], 4)
        heights = numpy.array([0.5, 0.5, 0.5, 0.5, 0.5, 0.6, 0.6, 0.6, 0.6, 0.7, 0.7, 0.7])
        self.assertEqual(list(heights[flight.scans_of(rays_s, heights)]), [0.5, 0.6, 0.7])

    def test_spans_in_the_air_end_where_rows_are_missing(self):
        t_s = numpy.concatenate((numpy.arange(0.0, 5.0, 0.025), numpy.arange(7.0, 12.0, 0.025)))
        count = len(t_s)
        column = {"t_s": t_s, "meas_m": numpy.full(count, 0.6), "state": numpy.array(["FLYING"] * count)}
        seen = flight.Flight("x", column, numpy.ones(count, bool), t_s - 0.07, numpy.ones(count, bool), 0.0, [])
        self.assertEqual(len(flight.spans_of(seen)), 2)

    def rows(self, states, t_s=None, ring=True, scanned=(0,), felt=(0,)):
        count = len(states)
        rays, new = numpy.full(count, math.nan), numpy.zeros(count, bool)
        rays[list(scanned)], new[list(felt)] = 8.0, True
        t_s = 0.025 * numpy.arange(count) if t_s is None else numpy.array(t_s)
        return flight.Flight("x", {"t_s": t_s, "state": numpy.array(states)}, new, t_s, new, 0.0, [], {"mf_rays": rays}, ring)

    def test_a_take_off_begins_behind_a_row_of_the_ground_or_with_the_row_that_the_recorder_begins_with(self):
        behind = ["GROUND", "TAKEOFF", "TAKEOFF", "FLYING"]
        self.assertEqual(list(flight.takeoffs(self.rows(behind))), [False, True, True, False])
        first = ["TAKEOFF", "TAKEOFF", "FLYING"]
        for seen, begun in ((self.rows(first), True), (self.rows(first, ring=False), False), (self.rows(first, scanned=()), False),
                            (self.rows(first, felt=()), False), (self.rows(["TAKEOFF"] * flight.RING_ROWS), False)):
            self.assertEqual(bool(flight.takeoffs(seen)[0]), begun)

    def test_a_second_flight_that_the_recorder_has_begins_behind_its_pause_on_the_ground(self):
        states, t_s = ["FLYING", "GROUND", "TAKEOFF", "FLYING"], [0.0, 0.025, 9.0, 9.025]
        self.assertTrue(flight.takeoffs(self.rows(states, t_s, scanned=(2,), felt=(2,)))[2])
        self.assertFalse(flight.takeoffs(self.rows(states, t_s, scanned=(3,), felt=(2,)))[2])

    def test_the_commands_before_a_log_are_known_when_it_begins_on_the_ground_and_not_when_it_begins_in_the_air_or_behind_lost_rows(self):
        self.assertEqual(flight.commands_since(self.rows(["GROUND", "TAKEOFF", "FLYING"]), 0.05), -math.inf)
        self.assertEqual(flight.commands_since(self.rows(["FLYING"] * 3), 0.05), 0.0)
        self.assertEqual(flight.commands_since(self.rows(["GROUND", "FLYING", "FLYING"], [0.0, 2.0, 2.025]), 2.025), 2.0)


if __name__ == "__main__":
    PROGRAM = str(Path(sys.argv.pop(1)).resolve())
    if sys.argv[1:2] == ["long"]:
        sys.argv[1:2] = ["Gains", "Planted"]
    elif len(sys.argv) == 1:
        sys.argv += [name for name, of in list(globals().items()) if isinstance(of, type) and issubclass(of, unittest.TestCase)
                     and of not in (Gains, Planted)]
    unittest.main()
