"""tools/campaign, flights with faults: what is drawn, what counts as harm, and how often it is said to happen.
Argument: the plomada program."""
import contextlib
import io
import json
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = sys.argv.pop(1)
sys.path.insert(0, str(ROOT / "tools/campaign"))
import campaign  # noqa: E402
import faults  # noqa: E402
import fleet  # noqa: E402
import harm  # noqa: E402
import plan  # noqa: E402

FIRST, DURATION = ("gust",), "14.6"
GOOD = {"started": True, "halted": False, "highest_mm": 100.0, "touch_speed_mps": 0.3, "off_aloft": 0, "down_s": 4.0,
        "deceived_s": 0.0}


def flight(law="EST", number=1, kinds=("gust",), words=("est-60cm-ramp", "--set", "plant.airframe=0"), **figures):
    return harm.Flight(law, number, kinds, words, GOOD | figures)


class Draws(unittest.TestCase):
    def test_the_same_number_is_the_same_flight_for_every_law_and_another_is_another(self):
        seen = set()
        for number in range(1, 300):
            of_law = [faults.assignments(law, 1, number)[1:] for law in plan.LAWS.values()]
            self.assertTrue(all(one == of_law[0] for one in of_law))
            seen.add(json.dumps(of_law[0]))
        self.assertEqual(len(seen), 299)
        self.assertNotEqual(faults.conditions(1, 1), faults.conditions(2, 1))

    # Of Python 3.11: random.Random of a text is the same in every version and on every machine.
    def test_the_first_flight_is_pinned(self):
        words = faults.arguments(plan.LAWS["EST"], 1, 1)
        self.assertEqual(words[:6], ["est-60cm-ramp", "--seed", "1", "--duration", DURATION, "--until-down"])
        self.assertEqual(tuple(faults.conditions(1, 1)), FIRST)

    def test_up_to_three_kinds_and_every_kind_comes(self):
        counts, alone = [0, 0, 0, 0], set()
        for number in range(1, 3001):
            kinds = tuple(faults.conditions(1, number))
            counts[len(kinds)] += 1
            alone |= set(kinds) if len(kinds) == 1 else set()
        for count, share in enumerate((1 / 13, 6 / 13, 4 / 13, 2 / 13)):
            self.assertAlmostEqual(counts[count] / 3000, share, delta=0.03)
        self.assertEqual(alone, set(faults.KINDS))

    def test_the_program_takes_every_draw(self):
        listed = subprocess.run([PROGRAM, "list", "--plant"], capture_output=True, text=True, check=True).stdout
        names = set(re.findall(r"  plant\.(\w+) ", listed))
        for number in range(1, 1001):
            typed, figures, _ = faults.assignments(plan.LAWS["PD"], 1, number)
            self.assertLessEqual(set(figures), names)
            self.assertLessEqual(len(typed) + len(figures), 60)
        for number, kind in enumerate(faults.KINDS, 1):
            with mock.patch.object(faults, "conditions", lambda *_, k=kind: {k: faults.KINDS[k](faults.random.Random(k))}):
                self.assertIn("down_s", fleet.fly(PROGRAM, faults.arguments(plan.LAWS["EST"], 1, number)), kind)


class Judging(unittest.TestCase):
    def test_a_good_flight_does_no_harm(self):
        self.assertEqual(harm.harms(GOOD), [])
        self.assertFalse(harm.harmed(GOOD))

    def test_each_harm_is_one(self):
        for figures, name in (({"highest_mm": 1201.0}, "flew up"), ({"touch_speed_mps": 1.21}, "struck"),
                              ({"off_aloft": 1}, "cut"), ({"down_s": None}, "not down"), ({"down_s": 60.1}, "not down"),
                              ({"halted": True}, "halted")):
            self.assertEqual(harm.harms(GOOD | figures), [name], figures)
            self.assertTrue(harm.harmed(GOOD | figures))
        self.assertEqual(harm.harms(GOOD | {"deceived_s": 2.1}), ["deceived"])
        self.assertFalse(harm.harmed(GOOD | {"deceived_s": 2.1}))

    def test_up_to_the_limit_there_is_none(self):
        at_limit = {"highest_mm": 1200.0, "touch_speed_mps": 1.2, "down_s": 60.0, "deceived_s": 2.0}
        self.assertEqual(harm.harms(GOOD | at_limit), [])
        self.assertEqual(harm.harms(GOOD | {"highest_mm": None, "touch_speed_mps": None}), [])
        self.assertEqual(harm.harms(GOOD | {"started": False, "down_s": None}), [])

    # Newcombe 1998, table I: Wilson's score without continuity correction.
    def test_the_bounds_are_wilsons(self):
        for count, flights, low, high in ((81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611),
                                          (1, 29, 0.0061, 0.1718), (29, 29, 0.8830, 1.0)):
            found = harm.wilson(count, flights)
            self.assertAlmostEqual(found[0], low, places=4)
            self.assertAlmostEqual(found[1], high, places=4)
        self.assertEqual(harm.wilson(0, 0), (0.0, 1.0))

    def test_rates_are_in_percent_with_their_bounds(self):
        self.assertEqual(harm.rate(81, 263), "31 [26-37]")
        self.assertEqual(harm.rate(1, 29), "3.4 [0.61-17]")
        self.assertEqual(harm.rate(0, 20), "0 [0-16]")
        self.assertEqual(harm.rate(0, 0), "-")


class Saying(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)

    def campaign(self, *words):
        with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(io.StringIO()) as err:
            status = campaign.main([*words, "--program", PROGRAM, "--out", str(self.dir / "out")])
        return status, out.getvalue(), err.getvalue()

    def test_tables_count_by_law_kind_number_and_airframe(self):
        flown = [flight(), flight(off_aloft=1), flight("PD", kinds=("bars", "gust")),
                 flight("PD", deceived_s=3.0, words=("x", "--set", "plant.airframe=1"))]
        laws = {line[0]: line for line in harm.by_law(flown)}
        self.assertEqual(laws["EST"][1:3], ["2", harm.rate(1, 2)])
        self.assertEqual(laws["all"][1:3], ["4", harm.rate(1, 4)])
        head, lines = harm.by_kind(flown)
        kinds = {line[0]: dict(zip(head, line, strict=True)) for line in lines}
        self.assertEqual(kinds["gust"]["EST"], harm.rate(1, 2))
        self.assertEqual(kinds["gust"]["deceived"], harm.rate(1, 3))
        self.assertEqual(kinds["two kinds"]["PD"], harm.rate(0, 1))
        self.assertEqual(kinds["airframe 1"]["all"], harm.rate(0, 1))
        self.assertEqual(kinds["bars"]["all"], "-")

    def test_the_page_has_the_blocks_that_the_command_writes(self):
        for block in ("default", "large"):
            self.assertIsNotNone(re.search(harm.BLOCK.format(block), harm.PAGE.read_text(encoding="utf-8"), re.DOTALL))
        copy = self.dir / "page.md"
        shutil.copy(harm.PAGE, copy)
        with mock.patch.object(harm, "PAGE", copy), contextlib.redirect_stderr(io.StringIO()):
            harm.write("default", "\nwritten\n\n")
            self.assertEqual(harm.compare("default", "\nwritten\n\n"), [])
            self.assertIn("+other", harm.compare("default", "\nother\n\n"))
            self.assertNotIn("written", re.search(harm.BLOCK.format("large"), copy.read_text(), re.DOTALL).group())

    def test_the_page_has_fewer_cells_than_the_command_prints(self):
        flown = [flight(law, kinds=(kind,), off_aloft=int(law + kind == "PDbars"))
                 for law in plan.LAWS for kind in ("bars", "gust")]
        rendered = harm.render(flown, len(flown), with_kinds=True)
        self.assertIn(f"| all | {harm.rate(1, 16)} | {harm.rate(0, 16)} | {harm.rate(0, 16)} | {harm.rate(1, 16)} |", rendered)
        self.assertIn(f"| PD | {harm.rate(1, 2)} | 0 | 0 | 50 | 0 | 0 |", rendered)
        self.assertIn(f"| bars | {harm.rate(0, 1)} | {harm.rate(1, 8)} |", rendered)
        self.assertIn("harmed with: gust.", rendered)
        self.assertNotIn("| gust |", rendered)
        brief = harm.render(flown, len(flown), with_kinds=False)
        self.assertEqual([line.split()[1] for line in brief.splitlines() if line.startswith("| ")], ["law", "EST", "all"])
        shown = harm.PAGE.read_text(encoding="utf-8")
        self.assertEqual(shown.count("| law | harmed % | flew up % |"), 2)
        self.assertIn(rendered.splitlines()[3], shown)

    def test_usage_errors_have_status_2(self):
        for words in (("--faults", "0"), ("--faults", "9", "--page"), ("--faults", "--set", "nominal"),
                      ("--faults", "--runs", "3"), ("--faults", "--page", "--law", "EST")):
            with self.assertRaises(SystemExit) as end, contextlib.redirect_stderr(io.StringIO()):
                campaign.main(list(words))
            self.assertEqual(end.exception.code, 2, words)

    # With the real program and firmware: none may stop, and a command that is printed repeats its flight.
    def test_a_hundred_flights_repeat_and_none_stops_the_firmware(self):
        status, out, err = self.campaign("--faults", "100")
        self.assertEqual(status, 0, err)
        self.assertIn("100 flights flown, 0 known", err)
        stored = [json.loads(line) for line in (self.dir / "out/faults.jsonl").read_text().splitlines()]
        self.assertEqual(len(stored), 100)
        self.assertEqual([record for record in stored if record["figures"]["halted"]], [])
        self.assertEqual(self.campaign("--faults", "100")[:2], (0, out))
        self.assertIn("0 flights flown, 100 known", self.campaign("--faults", "100")[2])
        harmful = (self.dir / "out/harm.txt").read_text().splitlines()
        self.assertEqual(len(harmful) % 2, 0)
        for line in harmful[1:8:2]:
            words = shlex.split(line)
            again = fleet.fly(words[0], words[2:])
            self.assertIn(again, [record["figures"] for record in stored])


if __name__ == "__main__":
    unittest.main()
