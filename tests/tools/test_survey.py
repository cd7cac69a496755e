"""tools/campaign, surveys: what a situation means, what counts as wrong, and how often it is said to happen.

Usage: test_survey.py PLOMADA [draws]    draws: three draws of each situation are flown, one of them held out; without it one, of another kind in turn
"""
import contextlib
import io
import json
import random
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = sys.argv.pop(1)
DRAWS = {"draws": 3, "situations": 1}.get("".join(sys.argv[1:]))  # of each situation; None: every fourth situation is flown, once
sys.path.insert(0, str(ROOT / "tools/campaign"))
import campaign  # noqa: E402
import fleet  # noqa: E402
import harm  # noqa: E402
import musts  # noqa: E402
import plan  # noqa: E402
import situations  # noqa: E402
import survey  # noqa: E402

TABLES = {name: situations.load(name) for name in situations.TABLES}
GOOD = {"started": True, "halted": False, "highest_mm": 100.0, "touch_speed_mps": 0.3, "off_aloft": 0, "down_s": 4.0, "deceived_s": 0.0,
        "landed_unordered": 0, "takeovers": 0, "off_s": 0.0, "sight_doubts": 0, "imu_doubts": 0, "thrust_doubts": 0, "aloft_s": 36.0,
        "collided": 0}
SMALL = """
[base]
draw = { ref = [1, 2], long = [10, 20] }
reference = "{ref}"
land = "{long}"
[one]
row = "both"
draw = { high = [0, 1], far = { wide = [1, 100] }, push = { either = [5, 6] }, kind = { one_of = ["drop", "flip"] }, times = { whole = [1, 3] } }
set = { gust = "{push}", SEL = "PIN", platform = 0.5 }
place = [{ times = "{times}", draw = { gap = [1, 2] }, line = "block {far + gap} 0 1 1 {high}", then = { far = "far + 2 * gap" } }, "go 1 2 0 {min(far, 1)}"]
at = ["{long - 1} SETR {ref / 2}", "3 SETR 1"]
fault = ["{kind}:0.01"]
lies = ["sight"]
["and another"]
row = "both"
set = { tau = 0.1 }
reference = 0.5
[third]
set = { tau = 0.2 }
lies = ["IMU"]
[two]
mix = 2
runs = 2
"""


def flight(of_table, name, law="EST", number=1, held_out=False):
    return situations.flight(of_table, of_table.situations[name], plan.LAWS[law], 1, number, held_out)


def lines(text, word):
    return [line.split()[1:] for line in text.splitlines() if line.startswith(f"{word} ")]


class Meaning(unittest.TestCase):
    def setUp(self):
        self.table = situations.read("small", SMALL)

    def test_a_flight_has_what_its_situation_says(self):
        for number in range(1, 200):
            one = flight(self.table, "one", number=number)
            blocks, (go,) = [line[1:] for line in lines(one.text, "place") if line[0] == "block"], [line for line in lines(one.text, "place") if line[0] == "go"]
            figures = dict(line for line in lines(one.text, "set"))
            self.assertIn(len(blocks), (1, 2, 3))
            for near, far in zip(blocks, blocks[1:], strict=False):
                self.assertGreater(float(far[0]), float(near[0]) + 1)
            self.assertEqual(float(go[4]), 1.0)
            self.assertTrue(5 <= abs(float(figures["plant.gust"])) <= 6)
            self.assertEqual((figures["SEL"], figures["plant.platform"]), ("PIN", "0.5"))
            (reference,), (land,) = lines(one.text, "reference")[0], lines(one.text, "land")[0]
            orders = lines(one.text, "at")
            self.assertEqual(orders[0], ["3", "SETR", "1"])     # in the order of their times
            self.assertAlmostEqual(float(orders[1][0]), float(land) - 1, delta=0.006)
            self.assertAlmostEqual(float(orders[1][2]), float(reference) / 2, delta=0.001)
            self.assertIn(one.words[-2:], (["--fault", "drop:0.01"], ["--fault", "flip:0.01"]))
            self.assertEqual(one.sources, ("sight",))

    def test_a_mix_has_all_of_its_parts(self):
        mixed = flight(self.table, "two")
        figures = dict(lines(mixed.text, "set"))
        self.assertLessEqual({"plant.gust", "plant.tau", "SEL"}, set(figures))
        self.assertEqual(set(mixed.sources), {"sight", "IMU"})

    # Two of one row set the same figures: the second would undo the first.
    def test_what_is_mixed_lies_and_is_of_different_rows(self):
        for mix in (2, 3):
            seen = set()
            for number in range(300):
                parts = situations.mixed(TABLES["lies"], mix, random.Random(number))
                self.assertEqual((len(parts), len({part.row for part in parts})), (mix, mix))
                self.assertTrue(all(part.sources for part in parts))
                seen |= {part.name for part in parts}
            self.assertEqual(seen, {one.name for one in TABLES["lies"].situations.values() if one.sources and not one.alone})

    def test_every_law_flies_the_same_and_every_number_another(self):
        seen = set()
        for number in range(1, 50):
            of_laws = {law: flight(self.table, "one", law, number) for law in plan.LAWS}
            typed = {f"set {name} {value}" for law in plan.LAWS.values() for name, value in law.settings.items()}
            rest = {"\n".join(line for line in one.text.splitlines() if line not in typed and not line.startswith("like "))
                    for one in of_laws.values()}
            self.assertEqual(len(rest), 1)
            seen |= rest
        self.assertEqual(len(seen), 49)

    def test_what_is_held_out_is_never_drawn_otherwise_and_the_rest_is_filled(self):
        rng, found = situations.random.Random(1), {False: [], True: []}
        for held_out, values in found.items():
            values += [situations.drawn([10, 20], rng, held_out, "") for _ in range(3000)]
        def held(value):
            return any(10 + 10 * low <= value <= 10 + 10 * high for low, high in situations.HELD_OUT)
        self.assertTrue(all(map(held, found[True])))
        self.assertFalse(any(map(held, found[False])))
        for tenth in range(10):
            in_it = [10 + tenth <= value < 11 + tenth for value in found[False]]
            self.assertAlmostEqual(sum(in_it) / 3000, 0.0 if tenth in (3, 8) else 0.125, delta=0.03)
        wide = [situations.drawn({"wide": [1, 1000]}, rng, False, "") for _ in range(3000)]
        self.assertAlmostEqual(sum(value < 10 for value in wide) / 3000, 0.3 / 0.8, delta=0.03)

    def test_arithmetic_knows_numbers_and_what_is_drawn_and_nothing_else(self):
        self.assertEqual(situations.filled("a {x + 2 * -y} b {max(x, 3) / 2}", {"x": 1, "y": 2}), "a -3 b 1.5")
        for text in ("z", "x ** 2", "open('f')", "x.real", "max(x, key=y)", "x +", "'a'"):
            with self.assertRaises(situations.Wrong, msg=text):
                situations.calculate(text, {"x": 1, "y": 2})

    def test_what_is_wrong_in_a_table_is_told_with_its_place(self):
        for text, told in (("[one", "small.toml"), ("[one]\nsett = {}", "one: no such word: sett"), ('[one]\nlies = ["IMUS"]', "one: lies: IMUS")):
            with self.assertRaises(situations.Wrong) as end:
                situations.read("small", text)
            self.assertIn(told, str(end.exception))
        for range_ in ("[2, 1]", "3", "{ wide = [1, 2], either = [1, 2] }", "{ steep = [1, 2] }", "[1, 2, 3]"):
            table = situations.read("small", f"[base]\nreference = 1\nland = 9\n[one]\ndraw = {{ x = {range_} }}")
            with self.assertRaises(situations.Wrong) as end:
                flight(table, "one")
            self.assertIn("one", str(end.exception))


class Tables(unittest.TestCase):
    def test_there_are_as_many_as_were_asked_for(self):
        self.assertGreaterEqual(len(TABLES["healthy"].situations), 40)
        self.assertEqual([len(of_table.rows()) for of_table in TABLES.values()], [16, 20, 8])
        names = [situation.slug for of_table in TABLES.values() for situation in of_table.situations.values()]
        self.assertEqual(len(names), len(set(names)))

    def test_a_healthy_situation_has_no_lie(self):
        figures = {name for of in TABLES["healthy"].situations.values() for name in of.set}
        self.assertEqual({name for name in figures if re.match(r"sight|scan_|outage|scanner_restart|imu_|attitude_burst|acc_jump|pin_stuck|glitches", name)}, set())
        for of in TABLES["healthy"].situations.values():
            unseen = ("thrust",) if of.name == "pilot's turns, unseen" else ()     # it has no effect while he flies
            self.assertEqual((of.fault, of.sources), ([], unseen))

    # Ordered down at 3 s, and seen for a second more: what is wrong in a draw is told before the flight.
    def test_the_program_takes_every_situation(self):
        def fly(of):
            of_table, name, held_out, number = of
            one = flight(of_table, name, "PID" if number % 2 else "EST", number, held_out)
            return fleet.fly(PROGRAM, [*one.words, "--duration", "3", "--until-down", "1"], one.text)

        all_of = [(of_table, name, number > 2, number) for of_table in TABLES.values() for at, name in enumerate(of_table.situations)
                  for number in ((1, 2, 3) if DRAWS == 3 else (1 + at % 3,)) if DRAWS or at % 4 == 0]
        with ThreadPoolExecutor(2) as pool:
            for of, figures in zip(all_of, pool.map(fly, all_of), strict=True):
                self.assertFalse(figures["halted"], of[1:])

    def test_thousands_of_draws_have_room_in_a_scenario(self):
        for of_table in TABLES.values():
            for name in of_table.situations:
                for number in range(1, 40):
                    text = flight(of_table, name, number=number).text
                    self.assertLess(text.count("\nset plant."), 48, name)
                    self.assertLess(text.count("\nplace go "), 65, name)
                    self.assertNotRegex(text, r"nan|inf|\be[+-]\d\d\d")


class Judging(unittest.TestCase):
    def test_a_good_flight_does_nothing_wrong(self):
        self.assertEqual((harm.wrong(GOOD), harm.lied_to(GOOD, ())), ([], []))
        self.assertFalse(harm.harmed(GOOD) or harm.mishandled(GOOD) or harm.doubted(GOOD))

    def test_each_verdict_is_given_beyond_its_limit_and_not_at_it(self):
        for name, at, beyond, healthy, lied in (
                ("highest_mm", 800.0, 801.0, ["flew up"], ["mishandled"]), ("highest_mm", None, 1201.0, ["flew up"], ["flew up"]),
                ("touch_speed_mps", 0.8, 0.81, ["struck"], ["mishandled"]), ("touch_speed_mps", None, 1.21, ["struck"], ["struck"]),
                ("collided", 0, 1, ["struck"], ["mishandled"]), ("off_aloft", 0, 1, ["cut"], ["cut"]),
                ("down_s", 60.0, 60.1, ["not down"], ["not down"]), ("down_s", 4.0, None, ["not down"], ["not down"]),
                ("halted", False, True, ["halted"], ["halted"]), ("deceived_s", 2.0, 2.1, ["deceived"], ["deceived"]),
                ("landed_unordered", 0, 1, ["landed unordered"], []), ("takeovers", 0, 1, ["took over"], []),
                ("off_s", 2.0, 2.01, ["left the height"], []), ("sight_doubts", 0, 1, ["doubted sight"], ["doubted sight"]),
                ("imu_doubts", 0, 2, ["doubted IMU"], ["doubted IMU"]), ("thrust_doubts", 0, 1, ["doubted thrust"], ["doubted thrust"])):
            self.assertEqual(harm.wrong(GOOD | {name: at}), [], name)
            self.assertEqual(harm.wrong(GOOD | {name: beyond}), healthy, name)
            self.assertEqual(harm.lied_to(GOOD | {name: beyond}, ()), lied, name)
        self.assertEqual(harm.wrong(GOOD | {"started": False, "down_s": None}), ["did not start"])

    # A battery that is truly empty lands its vehicle; what it must not do is to strike the ground, and a wire's lie must not land at all.
    def test_a_landing_is_wrong_unless_the_situation_says_that_it_may_be_right(self):
        landed = GOOD | {"landed_unordered": 1}
        for name, landing in (("measured", ["landed unordered"]), ("voltage-absurd", ["landed unordered"]), ("voltage-frozen-low", ["landed unordered"]),
                              ("low-at-take-off", []), ("empties-in-flight", []), ("voltage-plausible", [])):
            flight = survey.find(f"{name}/1/EST")
            self.assertEqual(flight.verdicts(landed), landing, name)
            self.assertEqual(flight.verdicts(landed | {"touch_speed_mps": 0.9}), [*landing, "struck"], name)
            self.assertIn("\nset BAT PIN\n", flight.flight.text)

    def test_to_doubt_who_lies_is_no_doubt_of_the_truth(self):
        both = GOOD | {"sight_doubts": 2, "thrust_doubts": 1}
        self.assertEqual(harm.lied_to(both, ("sight",)), ["doubted thrust"])
        self.assertEqual(harm.doubts(both, ("sight", "thrust")), {"sight": 0, "IMU": 0, "thrust": 0})

    # Clopper and Pearson: the upper bound of none in n is 1 - 0.025^(1/n). Garwood 1936: of a count of 0 it is -ln 0.025, of 5 it is
    # 1.623 to 11.668 (his table).
    def test_rates_have_their_bounds(self):
        planned = survey.find("nothing/1/EST")
        none = [(planned, GOOD)] * 100
        self.assertEqual(survey.share(none, lambda _, figures: harm.harmed(figures)), "0 [0-3.6]")
        self.assertEqual(survey.share(none, lambda *_: True), "100 [96-100]")
        self.assertEqual(survey.share([], lambda *_: True), "-")
        self.assertAlmostEqual(survey.hours(none), 1.0)
        self.assertEqual(survey.hourly(none, 0), "0.00 [0.00-3.69]")
        self.assertEqual(survey.hourly(none, 5), "5.00 [1.62-11.7]")
        self.assertEqual(survey.hourly([(planned, GOOD | {"aloft_s": 0.0})], 0), "-")


class Saying(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)

    def campaign(self, *words):
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
            status = campaign.main([*words, "--program", PROGRAM, "--out", str(self.dir / "out")])
        return status, out.getvalue(), err.getvalue()

    def test_est_flies_all_and_the_others_a_quarter(self):
        flights = survey.planned(TABLES["healthy"], ["PD", "EST", "PIDT"], 1, 10, False, ["draughts", "hours-of-hover"])
        counts = {}
        for one in flights:
            key = (one.situation.name, one.law)
            counts[key] = counts.get(key, 0) + 1
        self.assertEqual(counts[("draught", "EST")], 10)
        self.assertEqual(counts[("open doors", "PD")], 3)
        self.assertEqual(counts[("hours of hover", "EST")], 3)  # 0.3 of the 10
        self.assertEqual(len({name for name, _ in counts}), 4)
        self.assertEqual([one.number for one in flights], sorted(one.number for one in flights))
        with self.assertRaises(situations.Wrong):
            survey.planned(TABLES["healthy"], ["EST"], 1, 10, False, ["drafts"])

    def test_no_flight_of_any_draw_is_longer_than_the_program_takes(self):
        source = (ROOT / "tools/plomada/scenario_file.c").read_text(encoding="utf-8")
        limit_s = float(re.search(r"DURATION_MAX_S (\S+)", source)[1])
        for table in TABLES.values():
            flights = survey.planned(table, ["EST"], 30401, 200, False, table.rows())
            times_s = [float(word) for one in flights for word in re.findall(r"^(?:land|end) (\S+)", one.flight.text, re.M)]
            self.assertGreater(len(times_s), 1000)
            self.assertLess(max(times_s), limit_s)

    def test_the_tables_count_by_row_and_name_the_worst(self):
        good, bad = survey.find("table-slow/1/EST"), survey.find("table-fast/2/EST")
        of_other = survey.find("table-fast/1/PD")
        flown = [(good, GOOD), (bad, GOOD | {"landed_unordered": 1, "sight_doubts": 3}), (of_other, GOOD | {"takeovers": 1})]
        head, (row, total) = survey.lines_of("healthy", flown, lambda situation: situation.row)
        cells = dict(zip(head, row, strict=True))
        self.assertEqual((cells["healthy"], cells["flights"], cells["worst flight"]), ("tables", "2", "`table-fast/2/EST`"))
        self.assertEqual(cells["landed unordered %"], "50 [1.3-99]")
        self.assertEqual(cells["sight doubted, an hour"], survey.hourly(flown[:2], 3))
        self.assertEqual(cells["other laws wrong %"], "100 [2.5-100]")
        self.assertEqual(total[0], "all")
        self.assertIn('make campaign ARGS="--fly table-fast/2/EST"', "\n".join(survey.failing(flown)))

    def test_usage_errors_have_status_2(self):
        for words in (("--healthy", "0"), ("--healthy", "--set", "nominal"), ("--lies", "--runs", "3"), ("--held-out",), ("--only", "calm"),
                      ("--lies", "--page", "--law", "EST"), ("--healthy", "--page", "--only", "calm")):
            with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(io.StringIO()):
                campaign.main(list(words))
            self.assertEqual(end.exception.code, 2, words)
        for words in (("--lies", "1", "--only", "lice"), ("--fly", "calm/1"), ("--fly", "calm/0/EST"), ("--fly", "calm/1/ESTE"), ("--fly", "clam/1/EST"),
                      ("--fly", "calm/1/EST/out")):
            self.assertEqual(self.campaign(*words)[0], 2, words)

    def test_what_would_be_dropped_without_a_word_is_refused(self):
        fly = ("--fly", "calm/1/EST")
        for words, said in ((("--lies", "4", "--healthy", "4"), "one of --healthy, --lies and --battery, not --healthy and --lies"),
                            ((*fly, "--set", "plant.tau=0.3"), "without --set"), ((*fly, "--vehicle", "v.json"), "without --vehicle"),
                            ((*fly, "--law", "PID", "--runs", "3"), "without --law, --runs"), ((*fly, "--lies"), "without --lies"),
                            (("--law", "EST", "--set", "LAW=PID"), "--set LAW=: the law of a flight comes from --law")):
            with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(io.StringIO()) as err:
                campaign.main(list(words))
            self.assertEqual(end.exception.code, 2, words)
            self.assertIn(said, err.getvalue())

    def test_a_name_of_a_flight_says_which_part_of_it_is_unknown(self):
        """It said `not of the form SITUATION/NUMBER/LAW` of a name that was of that form; musts.py took foo/1/EST for that too, and fell over foo."""
        campaigner = str(ROOT / "tools/campaign/campaign.py")
        for tool, situation in ((campaigner, "gravel"), (campaigner.replace("campaign.py", "musts.py"), next(iter(musts.load()[1].situations.values())).slug)):
            for name, told in (("foo", "foo: not of the form SITUATION/NUMBER/LAW"), ("foo/1/EST", "no situation foo: one of "),
                               (f"{situation}/1/FOO", "no law FOO: one of PD, PID"), (f"{situation}/0/EST", "not of the form"),
                               (f"{situation}/²/EST", "not of the form")):
                with self.subTest(tool=tool, name=name):
                    done = subprocess.run([sys.executable, "-B", tool, "--fly", name, "--program", PROGRAM], capture_output=True, text=True, check=False)
                    self.assertEqual(done.returncode, 2, done.stderr)
                    self.assertIn(told, done.stderr)
                    self.assertNotIn("Traceback", done.stderr)

    def test_a_share_of_no_flights_is_refused_and_a_part_of_the_musts_has_its_own_list(self):
        for share in ("0", "-1", "nan", "inf", "x"):
            with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(io.StringIO()):
                musts.main([f"--share={share}"])
            self.assertEqual(end.exception.code, 2, share)

        def named(*words):
            with mock.patch("musts.planned", return_value=[]), mock.patch("musts.fly", return_value=[]), mock.patch.dict(plan.LAWS), \
                    tempfile.TemporaryDirectory() as out, contextlib.redirect_stdout(io.StringIO()):
                musts.main([*words, "--out", out, "--program", PROGRAM])
                return [path.name for path in Path(out).glob("missed*")]
        self.assertEqual(named("--seed", "3"), ["missed-3.txt"])
        self.assertEqual(named("--only", "edges", "--share", "0.02"), ["missed-1-only-edges-share-0.02.txt"])

    def test_a_part_of_the_musts_does_not_go_into_the_page(self):
        for words in (("--only", "edges"), ("--share", "0.1"), ("--fly", "a-long-slope/47/EST")):
            with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(io.StringIO()) as err, mock.patch.object(survey, "write") as written:
                musts.main([*words, "--page", "--out", str(self.dir), "--program", PROGRAM])
            self.assertEqual((end.exception.code, written.call_count), (2, 0), words)
            self.assertIn("--page writes what a whole run found: leave --only, --share and --fly", err.getvalue())

    def test_the_page_has_the_blocks_that_the_command_writes(self):
        copy = self.dir / "page.md"
        shutil.copy(survey.PAGE, copy)
        with mock.patch.object(survey, "PAGE", copy), contextlib.redirect_stderr(io.StringIO()):
            for block in ("healthy", "lies", "battery", "held-out"):
                survey.write(block, f"\nwritten {block}\n\nso\n")
                self.assertEqual(survey.compare(block, f"\nwritten {block}\n\nso\n"), [])
                self.assertEqual(survey.compare(block, f"\nmore of {block}\n\nother\n"), [])
                self.assertIn("+other", survey.compare(block, f"\nwritten {block}\n\nother\n"))
        self.assertEqual(copy.read_text(encoding="utf-8").count("\nwritten "), 4)

    def test_the_rows_of_the_page_are_those_of_the_tables(self):
        for name, of_table in TABLES.items():
            shown = survey.pattern(name).search(survey.PAGE.read_text(encoding="utf-8")).group()
            titles = [line.split("|")[1].strip() for line in shown.splitlines() if line.startswith("| ")]
            self.assertEqual(titles[1:titles.index("all")], list(of_table.rows()))

    # With the real program and firmware: none may stop, and a command that is printed repeats its flight.
    def test_flights_are_kept_and_repeat(self):
        words = ("--lies", "4", "--only", "two-at-once,beam blocked in flight", "--law", "EST,PID")
        status, out, err = self.campaign(*words)
        self.assertEqual(status, 0, err)
        stored = [json.loads(line) for line in (self.dir / "out/lies.jsonl").read_text().splitlines()]
        self.assertIn(f"{len(stored)} flights flown, 0 known", err)
        self.assertEqual(len(stored), 16 + 4 + 8 + 2)
        self.assertEqual([record for record in stored if record["figures"]["halted"]], [])
        status, again, err = self.campaign(*words)
        self.assertEqual((status, again), (0, out))
        self.assertIn(f"0 flights flown, {len(stored)} known", err)
        kept = (self.dir / "out/lies.jsonl").read_text().splitlines(keepends=True)[:3]
        by_another = [line.replace(fleet.digest(PROGRAM)[:12], "0" * 12).replace('"key": "', '"key": "0') for line in kept]
        (self.dir / "out/lies.jsonl").write_text("".join(by_another))
        self.assertIn("the program is another one than that of 3 kept flights: they are flown again\n", self.campaign(*words)[1])
        for record in stored[:4]:
            with contextlib.redirect_stdout(io.StringIO()) as told:
                again = shlex.split(shlex.split(record["command"])[2].removeprefix("ARGS="))
                self.assertEqual(campaign.main([*again, "--program", PROGRAM]), 0)
            command = shlex.split(told.getvalue().splitlines()[-1])
            by_hand = subprocess.run([*command, "--json", "-"], capture_output=True, text=True, check=False)
            figures = json.loads(by_hand.stdout)
            self.assertEqual(figures, record["figures"])


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0]], defaultTest="Tables" if DRAWS else None)
