"""The port's runs can fail: each names the mistakes that it is there for, and an end that is none is a failure.

Usage: test_machine.py PLAIN WIDE MACHINE IMAGES; the first three are programs, IMAGES the directory with avr/ and cells/.
"""
import re
import subprocess
import sys
import unittest
from pathlib import Path

RIGHT = "test_right_everywhere"
WRONG = "test_wrong_everywhere"
OCTET = "test_an_octet_wraps_at_256"
INT = "test_an_int_has_32_bits"
SIZE = "test_a_long_has_four_sizes_of_char"
CHAR = "test_a_char_is_negative_above_127"


class Runs(unittest.TestCase):
    plain = wide = machine = images = None

    def found(self, *command):
        """What fails; the exit status says the same."""
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)
        results = dict(re.findall(r":(test_\w+):(PASS|FAIL)", done.stdout))
        self.assertEqual(set(results), {RIGHT, WRONG, OCTET, INT, SIZE, CHAR}, done.stdout + done.stderr)
        self.assertEqual(done.returncode != 0, "FAIL" in results.values())
        return {name for name, result in results.items() if result == "FAIL"}

    def test_a_pc_finds_none_of_the_mistakes(self):
        self.assertEqual(self.found(self.plain), {WRONG})

    def test_wide_octets_find_what_counts_on_8_bits(self):
        self.assertEqual(self.found(self.wide), {WRONG, OCTET, CHAR})

    def test_a_16_bit_int_is_found_where_it_is_one(self):
        self.assertEqual(self.found(self.machine, self.images / "avr/mistakes.bin"), {WRONG, INT})

    def test_cells_of_16_bits_find_all(self):
        self.assertEqual(self.found(self.machine, self.images / "cells/mistakes.bin"), {WRONG, OCTET, INT, SIZE, CHAR})


class Ends(unittest.TestCase):
    machine = images = None

    def end(self, image, *cycles):
        done = subprocess.run([self.machine, self.images / image, *cycles], capture_output=True, text=True, check=False, timeout=60)
        return done.returncode, done.stdout + done.stderr

    def test_a_program_that_never_ends_is_a_failure(self):
        status, said = self.end("avr/end_loop.bin", "10000000")
        self.assertEqual(status, 2, said)
        self.assertIn("no end after 10000000 cycles", said)

    def test_a_program_that_ends_in_time_is_none(self):
        self.assertEqual(self.end("avr/mistakes.bin", "10000000")[0], 1)

    def test_a_crash_is_a_failure(self):
        status, said = self.end("avr/end_crash.bin")
        self.assertEqual(status, 2, said)
        self.assertIn("machine: crashed", said)

    def test_a_stack_that_meets_the_variables_is_a_failure(self):
        status, said = self.end("avr/end_stack.bin")
        self.assertEqual(status, 2, said)
        self.assertIn("reached the variables", said)

    def test_an_image_that_is_not_there_is_a_failure(self):
        self.assertEqual(self.end("avr/nothing.bin")[0], 2)


if __name__ == "__main__":
    Runs.plain, Runs.wide, Runs.machine, Runs.images = (Path(argument) for argument in sys.argv[1:5])
    Ends.machine, Ends.images = Runs.machine, Runs.images
    unittest.main(argv=sys.argv[:1])
