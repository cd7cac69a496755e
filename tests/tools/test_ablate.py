"""tools/ablate: are its parts in the sources yet, and does it count right? What the flights say is a build and minutes for each part, which
`make ablate` is for."""
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/ablate"))
import ablate  # noqa: E402


class Flight:
    def __init__(self, name):
        self.name = name


class Parts(unittest.TestCase):
    def test_each_part_is_once_in_its_source_and_its_loss_changes_it(self):
        for part in ablate.load():
            whole = (ROOT / part.file).read_text(encoding="utf-8")
            self.assertNotEqual(whole, part.away(whole), part.name)

    def test_a_part_that_is_not_in_the_source_any_more_or_twice_is_an_error(self):
        part = ablate.Part("dips", "a.c", "says", "x = 1;", "x = 0;")
        for text in ("", "x = 1; x = 1;"):
            with self.assertRaisesRegex(ValueError, "dips"):
                part.away(text)

    def test_each_line_of_the_page_is_a_part(self):
        block = ablate.BLOCK.search(ablate.PAGE.read_text(encoding="utf-8")).group()
        lines = [line.strip("| ").split(" | ")[:2] for line in block.splitlines() if line.startswith("| ")][1:]
        self.assertGreater(len(lines), 10)
        self.assertLessEqual({(name, says) for name, says in lines}, {(part.name, part.says) for part in ablate.load()})


class Counts(unittest.TestCase):
    def test_worse_and_better_are_those_that_changed(self):
        flights = [Flight(name) for name in "abcd"]
        whole = dict(zip("abcd", (0, 0, 1, 1), strict=True))
        without = dict(zip("abcd", (1, 0, 1, 0), strict=True))
        self.assertEqual((1, 1), ablate.split(flights, whole, without, lambda _, figures: figures == 1))

    def test_a_flight_counts_once_however_many_verdicts_change(self):
        fine, struck = {"at": 0}, {"at": 2}
        old = ablate.VERDICTS
        ablate.VERDICTS = {"harmed": lambda _, figures: figures["at"] > 1, "mishandled": lambda _, figures: figures["at"] > 0}
        try:
            self.assertEqual((1, 0), ablate.changed([Flight("a")], {"a": fine}, {"a": struck}))
            self.assertEqual((0, 1), ablate.changed([Flight("a")], {"a": struck}, {"a": fine}))
            self.assertEqual((0, 0), ablate.changed([Flight("a")], {"a": fine}, {"a": fine}))
        finally:
            ablate.VERDICTS = old

    def test_the_sign_test_is_that_of_a_fair_coin(self):
        self.assertEqual(1.0, ablate.sign_test(0, 0))
        self.assertAlmostEqual(0.5 ** 5, ablate.sign_test(5, 0))
        self.assertAlmostEqual(1.0, ablate.sign_test(0, 5))
        self.assertAlmostEqual(0.1875, ablate.sign_test(4, 1))    # (1 + 5) / 32


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
