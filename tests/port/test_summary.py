"""summary.py on records of ctest: it counts, and what ran nowhere is a complaint."""
import unittest

import summary


def record(**tests):
    return "Start testing: now\n" + "".join(
        f"1/9 Testing: {name}\n1/9 Test: {name}\nOutput:\n---\nx.c:1:test_a:PASS\n\n---\n{count} Tests {failures} Failures 0 Ignored \n"
        for name, (count, failures) in tests.items())


class Summary(unittest.TestCase):
    good = {"test_a_plain": (5, 0), "test_a_wide": (5, 0), "test_a_avr": (3, 0), "test_a_cells": (3, 0)}
    rows = [("test_a", "test_x"), ("test_a", "test_y")]

    def complaints(self, **changes):
        return list(summary.missing(summary.counts(record(**{**self.good, **changes})), self.rows))

    def test_it_counts(self):
        found = summary.counts(record(**self.good, test_b_avr=(7, 2)))
        self.assertEqual(found["avr"], {"test_a": (3, 0), "test_b": (7, 2)})
        self.assertRegex(list(summary.table(found))[3], r"^avr .* 2 +10 +2$")

    def test_all_there_is_no_complaint(self):
        self.assertEqual(self.complaints(), [])

    def test_a_test_that_ran_nowhere_is_one(self):
        for run in ("wide", "avr", "cells"):
            with self.subTest(run=run):
                self.assertEqual(len(self.complaints(**{f"test_a_{run}": (2, 0)})), 1)

    def test_a_program_that_did_not_come_to_its_end_is_one(self):
        text = record(**self.good).replace("3 Tests 0 Failures", "machine: crashed", 1)
        self.assertEqual(len(list(summary.missing(summary.counts(text), self.rows))), 1)

    def test_a_program_that_did_not_run_is_one(self):
        found = summary.counts(record(**{name: value for name, value in self.good.items() if name != "test_a_cells"}))
        self.assertEqual(len(list(summary.missing(found, self.rows))), 1)

    def test_the_left_out_are_told_by_reason(self):
        told = summary.reasons("# why\ntest_a test_b_c  takes too long\ntest_d test_e  strtof\n")
        self.assertEqual(told, {"takes too long": ["a: b c"], "strtof": ["d: e"]})


if __name__ == "__main__":
    unittest.main()
