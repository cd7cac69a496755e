"""docs/my_law.md: each of its steps flies as the page says, and its lines of C stand in the files.

Usage: test_my_law.py [--write] PLOMADA PROGRAM...   PROGRAM is `plomada fly` with the law of a step, fly_1_gravity and so on
"""
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
FOLDER, PAGE = ROOT / "examples/my_law", ROOT / "docs/my_law.md"
STEPS = ("1_gravity", "2_p", "3_pd", "law_mine")
COLUMNS = (("rise_time_s", 2), ("overshoot_mm", 0), ("hover_rms_mm", 0), ("hover_mean_error_mm", 0), ("recovery_s", 2))
TABLE = re.compile(r"(?<=<!-- by tests/examples/test_my_law.py --write -->\n\n).*?(?=\n\n<!-- end -->)", re.DOTALL)
ALIKE = (0.1, 5.0)      # a tenth, or 5 mm: another noise is no other lesson; chosen


def fly(words, *options, scenario=FOLDER / "mine.scenario"):
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "flight.json"
        subprocess.run([*words, scenario, "--json", path, *options], capture_output=True, check=False)
        return json.loads(path.read_text(encoding="utf-8"))


def cell(value, decimals):
    return "-" if value is None else f"{value:.{decimals}f}"


def rows():
    """{step: {figure: value}}"""
    return {step: fly(PROGRAMS[step]) for step in STEPS}


def table(found):
    lines = ["| step | rise s | overshoot mm | hover RMS mm | hover mean error mm | recovery s |", "|---|---|---|---|---|---|"]
    return "\n".join(lines + [f"| `{step}.c` | " + " | ".join(cell(figures[name], decimals) for name, decimals in COLUMNS) + " |"
                              for step, figures in found.items()])


class Lessons(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.found = rows()

    def test_the_table_is_what_the_steps_fly(self):
        shown = [line.split("|")[2:-1] for line in TABLE.search(PAGE.read_text(encoding="utf-8")).group(0).splitlines()[2:]]
        for (step, figures), cells in zip(self.found.items(), shown, strict=True):
            for (name, _), text in zip(COLUMNS, cells, strict=True):
                with self.subTest(step=step, figure=name):
                    if figures[name] is None:
                        self.assertEqual(text.strip(), "-")
                    else:
                        self.assertAlmostEqual(float(text), figures[name], delta=max(ALIKE[0] * abs(figures[name]), ALIKE[1] * name.endswith("_mm")))

    def test_each_step_teaches_what_the_page_says(self):
        gravity, p, pd, mine = self.found.values()
        self.assertIsNone(gravity["rise_time_s"])
        self.assertGreater(p["overshoot_mm"], 10 * max(10.0, pd["overshoot_mm"]))
        self.assertLess(pd["hover_mean_error_mm"], -50)
        self.assertGreater(mine["hover_mean_error_mm"], pd["hover_mean_error_mm"] / 2)
        self.assertLess(mine["hover_rms_mm"], 0.5 * pd["hover_rms_mm"])

    def test_the_other_laws_fly_beside_it_as_without_it(self):
        for law in ("PD", "PID", "PIDT", "EST"):
            beside, without = (fly(words, "--set", f"LAW={law}", scenario="pid-60cm-ramp") for words in (PROGRAMS["law_mine"], PLOMADA))
            self.assertEqual(beside, without, law)

    def test_only_a_program_with_it_knows_its_name(self):
        for words, known in ((PROGRAMS["law_mine"], True), (PLOMADA, False)):
            done = subprocess.run([*words, "pid-60cm-ramp", "--set", "LAW=MINE"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode in (0, 1), known, done.stderr)

    def test_the_lines_of_c_stand_in_the_files(self):
        text = PAGE.read_text(encoding="utf-8")
        sources = "".join((FOLDER / f"{step}.c").read_text(encoding="utf-8") for step in STEPS) + (ROOT / "control/laws/laws.h").read_text(encoding="utf-8")
        blocks = re.findall(r"```c\n(.*?)```", text, re.DOTALL)
        self.assertEqual(len(blocks), 7)
        for block in blocks:
            self.assertIn(block, sources)


if __name__ == "__main__":
    plomada, *steps = [word for word in sys.argv[1:] if word != "--write"]
    PLOMADA = [plomada, "fly"]
    PROGRAMS = {Path(word).name[len("fly_"):]: [word] for word in steps}
    if "--write" in sys.argv:
        PAGE.write_text(TABLE.sub(lambda _: table(rows()), PAGE.read_text(encoding="utf-8")), encoding="utf-8")
        sys.exit(0)
    unittest.main(argv=sys.argv[:1])
