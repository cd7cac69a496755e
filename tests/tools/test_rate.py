"""tools/campaign/rate.py: bounds against published ones, verdicts against coins whose rate is known."""
import os
import random
import sys
import unittest
from pathlib import Path
from unittest import mock

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools/campaign"))
import rate  # noqa: E402


def coin(share, seed):
    rng = random.Random(seed)
    throws = [rng.random() < share for _ in range(rate.LOOKS[-1])]
    return lambda number: f"throw {number}" if throws[number] else None


class Bounds(unittest.TestCase):
    def test_they_are_those_of_the_rule_of_three_and_of_tables(self):
        self.assertAlmostEqual(rate.bounds(0, 300, 0.05)[1], 3 / 300, delta=1e-4)
        for (count, of), (low, high) in {(5, 10): (0.1871, 0.8129), (1, 20): (0.0013, 0.2487), (0, 10): (0.0, 0.3085)}.items():
            self.assertAlmostEqual(rate.bounds(count, of, 0.025)[0], low, delta=1e-4)
            self.assertAlmostEqual(rate.bounds(count, of, 0.025)[1], high, delta=1e-4)

    def test_all_or_none_are_no_division_by_zero(self):
        self.assertEqual(rate.bounds(0, 5, 0.05)[0], 0.0)
        self.assertEqual(rate.bounds(5, 5, 0.05)[1], 1.0)


class Verdicts(unittest.TestCase):
    def test_what_never_happens_is_shown_early_and_what_happens_always_is_missed(self):
        found = rate.judge(0.05, lambda number: None)
        self.assertEqual((found.verdict, found.of), (rate.SHOWN, rate.LOOKS[0]))
        found = rate.judge(0.05, "throw {}".format)
        self.assertEqual((found.verdict, found.of), (rate.MISSED, rate.LOOKS[0]))
        self.assertEqual(found.wrong, ["throw 0", "throw 1", "throw 2"])

    def test_a_rate_that_is_the_requirement_itself_is_rarely_told_from_it(self):
        """On either side: 100 runs of the whole sequence of looks, at most one in twenty and what chance adds."""
        runs = [rate.judge(0.05, coin(0.05, seed)).verdict for seed in range(100)]
        self.assertLessEqual(runs.count(rate.SHOWN), 0.05 * 100 + 5)
        self.assertLessEqual(runs.count(rate.MISSED), 0.05 * 100 + 5)
        self.assertGreater(runs.count(rate.OPEN), 75)

    def test_half_and_twice_the_requirement_are_told(self):
        self.assertGreater([rate.judge(0.05, coin(0.02, seed)).verdict for seed in range(50)].count(rate.SHOWN), 45)
        self.assertGreater([rate.judge(0.05, coin(0.10, seed)).verdict for seed in range(50)].count(rate.MISSED), 45)

    def test_what_does_not_tell_is_open_after_the_last_look(self):
        found = rate.judge(0.02, lambda number: "wrong" if number % 50 == 0 else None)
        self.assertEqual((found.verdict, found.of, found.count), (rate.OPEN, rate.LOOKS[-1], rate.LOOKS[-1] // 50))


class Seeds(unittest.TestCase):
    def test_each_run_draws_its_own_and_the_environment_repeats_one(self):
        with mock.patch.dict(os.environ):
            os.environ.pop("SOAK_SEED", None)
            self.assertGreater(len({rate.drawn_seed() for _ in range(20)}), 15)
            os.environ["SOAK_SEED"] = "42"
            self.assertEqual({rate.drawn_seed() for _ in range(3)}, {42})


if __name__ == "__main__":
    unittest.main()
