"""tools/seed_study: the simulations of chapter 4.1 against closed forms, and statements that a flight can break."""
import math
import re
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/seed_study"))
import chapter_4_1  # noqa: E402
import seed_study  # noqa: E402
import statements  # noqa: E402

PROGRAM = sys.argv.pop(1) if len(sys.argv) > 1 and Path(sys.argv[1]).is_file() else None
PAGE = (ROOT / "docs/control.md").read_text(encoding="utf-8")


class Chapter41(unittest.TestCase):
    def test_the_rotors_hover_speed_is_that_of_the_model(self):
        # Corke's mdl_quadrotor.m prints 861 rad/s for its w0.
        self.assertAlmostEqual(chapter_4_1.HOVER_RADPS, 861.0, delta=1.0)

    def test_newtons_follow_the_closed_form_of_a_mass_on_a_spring_and_damper(self):
        for kp, kd in chapter_4_1.GAINS:
            natural = math.sqrt(kp / chapter_4_1.MASS_KG)
            damping = kd / (2.0 * math.sqrt(kp * chapter_4_1.MASS_KG))
            course = chapter_4_1.simulate(kp, kd, chapter_4_1.OUTPUTS["newtons"], 4.0)
            if damping >= 1.0:      # the thrust does not reach 0 there, so the system is linear
                root = natural * math.sqrt(damping**2 - 1.0)
                slow, fast = -damping * natural + root, -damping * natural - root
                expected = [1.0 + (fast * math.exp(slow * t) - slow * math.exp(fast * t)) / (slow - fast)
                            for t in (0.5, 1.0, 3.0)]
            else:
                ring = natural * math.sqrt(1.0 - damping**2)
                expected = [1.0 - math.exp(-damping * natural * t)
                            * (math.cos(ring * t) + damping * natural / ring * math.sin(ring * t))
                            for t in (0.5, 1.0, 3.0)]
            for t, z in zip((0.5, 1.0, 3.0), expected, strict=True):
                self.assertAlmostEqual(course[round(t / chapter_4_1.STEP_S)], z, places=6, msg=f"{kp} {kd} {t}")

    def test_all_three_statements_of_the_seed_hold_in_both_units(self):
        for output, thrust_of in chapter_4_1.OUTPUTS.items():
            with self.subTest(output):
                alone, some, much = (chapter_4_1.respond(chapter_4_1.simulate(*gains, thrust_of)) for gains in chapter_4_1.GAINS)
                self.assertTrue(math.isinf(alone.settled_s))
                self.assertTrue(math.isfinite(some.settled_s))
                self.assertGreater(some.overshoot_percent, 5.0)
                self.assertLess(much.overshoot_percent, 1.0)
                self.assertLess(abs(much.error_mm), 1.0)

    def test_the_page_shows_what_the_simulation_gives(self):
        responses = {(output, gains): chapter_4_1.respond(chapter_4_1.simulate(*gains, thrust_of))
                     for gains in chapter_4_1.GAINS for output, thrust_of in chapter_4_1.OUTPUTS.items()}
        self.assertIn(chapter_4_1.table(responses), PAGE)


def flights(**changes):
    """Flights for which every statement holds, but for changes: {flight: {figure: value}}."""
    figures = {name: {"hover_rms_mm": 100.0, "hover_mean_error_mm": 0.0, "highest_mm": 100.0, "reference_mm": 400.0,
                      "ground_contacts": 1.0, "failed": 0.0} for name in statements.FLIGHTS}
    figures["no feed-forward"]["highest_mm"] = figures["GRAV alone"]["highest_mm"] = -400.0
    figures["P"]["hover_rms_mm"] = figures["PD, KP up"]["hover_rms_mm"] = figures["PD, KD up"]["hover_rms_mm"] = 150.0
    figures["PD"]["hover_mean_error_mm"] = -40.0
    figures["PD, KP down"]["hover_mean_error_mm"] = -90.0
    figures["PD saturated"] |= {"hover_rms_mm": 80.0, "hover_mean_error_mm": -40.0}
    figures["PID"] |= {"hover_rms_mm": 50.0, "hover_mean_error_mm": 5.0}
    figures["PID over the ramp"] |= {"dip_s": 7.6, "dip_mm": -90.0, "after_dip_mm": 60.0, "peak_s": 11.05, "before_mm": -20.0,
                                     "undershoot_mm": 90.0, "end_error_mm": 10.0}
    for name, change in changes.items():
        figures[name.replace("_", " ")] |= change
    return figures


class Statements(unittest.TestCase):
    def test_a_set_of_flights_can_satisfy_all(self):
        self.assertEqual([s.words for s in statements.STATEMENTS if not s.holds(flights())], [])

    def test_each_statement_can_fail(self):
        level = dict.fromkeys(("hover_rms_mm", "hover_mean_error_mm"), 0.0)
        same = {name.replace(" ", "_"): dict(level) for name in statements.FLIGHTS}
        worse = {
            "no_feed-forward": {"highest_mm": 0.0}, "GRAV_alone": {"highest_mm": 0.0},
            "PD_saturated": {"hover_rms_mm": 10.0, "hover_mean_error_mm": 0.0}, "PD": level,
            "PID": {"hover_rms_mm": 120.0, "hover_mean_error_mm": -60.0}, "PID,_tugs": {"failed": 1.0},
            "PID_over_the_ramp": {"before_mm": -180.0, "dip_s": 8.9, "after_dip_mm": 0.0, "peak_s": 9.0, "undershoot_mm": 0.0},
        }
        broken = {s.words for change in (same, worse, {"PD": level}, {"PD": {"hover_rms_mm": 200.0}})
                  for s in statements.STATEMENTS if not s.holds(flights(**change))}
        broken |= {s.words for s in statements.STATEMENTS
                   if not s.holds(flights(PD_saturated={"hover_rms_mm": 250.0}, PID={"hover_rms_mm": 240.0}))}
        self.assertEqual([s.words for s in statements.STATEMENTS if s.words not in broken], [])

    def test_the_course_over_the_ramp_is_read_from_the_log(self):
        rows = [(0.01 * k, 0.6) for k in range(2100)]
        rows[750], rows[950], rows[1105] = (7.5, 0.45), (9.5, 0.65), (11.05, 0.85)
        found = statements.course(rows, 0.6)
        self.assertEqual((found["dip_s"], found["peak_s"]), (7.5, 11.05))
        self.assertAlmostEqual(found["dip_mm"], -150.0, places=6)
        self.assertAlmostEqual(found["after_dip_mm"], 50.0, places=6)
        self.assertAlmostEqual(found["peak_mm"], 250.0, places=6)
        self.assertAlmostEqual(found["before_mm"], 0.0, places=6)
        self.assertAlmostEqual(found["end_error_mm"], 0.0, places=6)

    def test_the_page_shows_what_does_not_hold_and_counts_what_does(self):
        block = re.search(r"<!-- by make seed-study.*?<!-- end of the seed study -->", PAGE, re.DOTALL).group()
        rows = [line.strip("| ").split(" | ") for line in block.splitlines() if line.startswith("| ")]
        shown = {re.sub(r" \((?:Annex I|4\.|6).*", "", row[0]): row[1:] for row in rows}
        known = [s.words for s in statements.STATEMENTS]
        unmet = [words for words in shown if words in known]
        self.assertEqual(unmet, [words for words in known if words in unmet])
        self.assertTrue(unmet and all("**no**" in shown[words] for words in unmet))
        for at, cell in enumerate(shown["**holds**"]):
            missing = sum(shown[words][at] == "**no**" for words in unmet)
            self.assertEqual(cell, f"{len(known) - missing} of {len(known)}")

    def test_the_command_judges_every_statement_and_the_page_has_what_differs(self):
        best = {"good": (None, flights()), "bad": ({"damping": 2.0}, flights(PD_saturated={"hover_rms_mm": 10.0}))}
        held = [s.holds(best["bad"][1]) for s in statements.STATEMENTS]
        self.assertIn(False, held)
        expected = sum(s.holds(flights(PID={"hover_rms_mm": 90.0})) for s in statements.STATEMENTS)
        self.assertLess(expected, len(held))
        by_last = {"good": flights(PID={"hover_rms_mm": 90.0}), "bad": flights()}
        everything, page = seed_study.table(best, by_last), seed_study.table(best, by_last, for_page=True)
        for s, holds in zip(statements.STATEMENTS, held, strict=True):
            self.assertIn(f"| {s.words} ({s.source}) | {s.reading} | yes | {'yes' if holds else '**no**'} |", everything)
            self.assertEqual(f"| {s.words} ({s.source}) | yes | **no** |" in page, not holds)
        self.assertIn(f"| **holds** | {len(held)} of {len(held)} | {sum(held)} of {len(held)} |", page)
        self.assertIn(f"| holds, if PD had had the last bracket | {expected} of {len(held)} | {len(held)} of {len(held)} |", page)
        self.assertIn("- bad: damping 1/s 2.", page)


class Brackets(unittest.TestCase):
    def test_the_answer_of_the_first_bracket_takes_as_long_as_equations_27_and_28_say(self):
        self.assertAlmostEqual(statements.line_s(249, 519, 115200), 0.05026, places=5)
        self.assertAlmostEqual(statements.line_s(372, 406, 250000), 0.00396, places=5)
        self.assertAlmostEqual(statements.FIRST_BRACKET_LATER_S, 0.0463, places=5)

    def test_what_was_tuned_before_the_pid_flies_by_the_first_bracket_and_the_pid_by_the_last(self):
        typed = {name: line for name, (_, line, _) in statements.FLIGHTS.items()}
        for flight, (scenario, *_) in statements.FLIGHTS.items():
            feedback = typed[flight].get("KP") != "0" and scenario != "no-feedforward"
            first = {"scan_late": statements.FIRST_BRACKET_LATER_S} if feedback and not flight.startswith("PID") else {}
            self.assertEqual(seed_study.later(flight, "as flown"), first, flight)
            self.assertEqual(seed_study.later(flight, seed_study.LAST), {}, flight)

    def test_the_bracket_reaches_the_program(self):
        with tempfile.TemporaryDirectory() as scratch:
            heard, program = Path(scratch, "heard"), Path(scratch, "program")
            program.write_text("#!/bin/sh\n" f'echo "$@" >> {heard}\n'
                               'while [ "$1" != --json ]; do shift; done; echo \'{"hover_rms_mm": 1}\' > "$2"\n', encoding="utf-8")
            program.chmod(0o755)
            for flight, brackets in (("PD saturated", "as flown"), ("PID", "as flown"), ("PD saturated", seed_study.LAST)):
                seed_study.fly(str(program), "THRUST", {"tau": 0.1}, flight, 7, brackets)
            lines = heard.read_text(encoding="utf-8").splitlines()
        self.assertIn(" --set plant.scan_late=0.0463", lines[0])
        self.assertEqual([("scan_late" in line, "plant.tau=0.1" in line) for line in lines], [(True, True), (False, True), (False, True)])


class Flown(unittest.TestCase):
    """On the default plant, by the program that was given; the study itself flies 20 seeds."""
    def setUp(self):
        if PROGRAM is None:
            self.skipTest("no program given")

    def spread_mm(self, flight, brackets):
        return statements.spread_mm(seed_study.look(PROGRAM, "THRUST", {}, range(1, 9), (flight,), brackets)[flight])

    def test_pid_oscillates_less_than_pd_of_the_first_bracket_and_not_less_than_pd_of_the_last(self):
        pid = self.spread_mm("PID", "as flown")
        self.assertLess(pid, self.spread_mm("PD saturated", "as flown"))
        self.assertGreater(pid, self.spread_mm("PD saturated", seed_study.LAST))


if __name__ == "__main__":
    unittest.main()
