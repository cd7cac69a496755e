"""tools/mutants: which faults are drawn. What becomes of them is a build for each, which `make mutants` is for."""
import re
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools/mutants"))
import mutants  # noqa: E402

SOURCE = """#include "a.h"
#define LIMIT 0.5F /* + is no operator here */

static bool low(float x)
{
    const float half = x * LIMIT;
    if (half < 1.0F) {
        count += 2U;
        note(half);
        return true;
    }
    return false;
}
"""


class Mutants(unittest.TestCase):
    def setUp(self):
        self.found = [(number + 1, line.strip()) for number, line in mutants.mutants(SOURCE)]

    def test_each_kind_of_fault_is_drawn(self):
        for expected in ((2, "#define LIMIT ((1.3F*0.5F+0.001F)) /* + is no operator here */"),
                         (6, "const float half = x / LIMIT;"), (7, "if (half <= 1.0F) {"), (7, "if (!half < 1.0F) {"),
                         (8, "count -= 2U;"), (8, "count += (2U+1U);"), (8, ";"), (9, ";"), (10, "return false;"),
                         (12, "return true;")):
            self.assertIn(expected, self.found)

    def test_comments_includes_declarations_and_jumps_are_left_alone(self):
        self.assertNotIn(1, {number for number, _ in self.found})
        self.assertFalse([line for _, line in self.found if "- is no operator" in line])
        self.assertNotIn((6, ";"), self.found)
        self.assertNotIn((10, ";"), self.found)

    def test_where_the_smaller_of_two_is_taken_their_equality_is_no_fault(self):
        line = "    return (x < LIMIT_N) ? x : LIMIT_N;"
        self.assertFalse(list(mutants.mutants("int f(int x)\n{\n" + line + "\n}\n")))
        other = [fault for _, fault in mutants.mutants("int f(int x)\n{\n" + line.replace("? x", "? y") + "\n}\n")]
        self.assertEqual(other, ["    return (x <= LIMIT_N) ? y : LIMIT_N;"])

    def test_a_fault_changes_its_line_only(self):
        for number, line in mutants.mutants(SOURCE):
            before = SOURCE.splitlines()[number]
            self.assertNotEqual(line, before)
            self.assertNotIn("\n", line)

    def test_the_estimators_restart_is_among_the_faults(self):
        text = (mutants.ROOT / "control/est/estimator.c").read_text(encoding="utf-8")
        lines = text.splitlines()
        body = re.search(r"static void restart_at_frame.*?\n}", text, re.S).group().count(";")
        start = next(i for i, line in enumerate(lines) if line.startswith("static void restart_at_frame"))
        deleted = [n for n, line in mutants.mutants(text) if start < n < start + body + 3 and line.strip() == ";"]
        self.assertEqual(len(deleted), body)


if __name__ == "__main__":
    unittest.main()
