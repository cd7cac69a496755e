"""examples/scanner on this PC: PROGRAM on the model of the sensor behind a pseudo-terminal, which hears octets at its own rate alone.

Usage: test_posix.py PROGRAM PLOMADA
"""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCANNER, PLOMADA = sys.argv.pop(1), sys.argv.pop(1)
ON_GROUND_MM = 205      # the mirror above the ground, and the way of the rays to it: docs/hardware.md
HEIGHT_M = 0.8
NOISE_MM = 30           # as tests/integration/test_laser_pty.c: of a mean of 35 rays far less


class OnALine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.link = Path(folder.name) / "urg"

    def program(self, *command):
        started = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.addCleanup(started.wait)
        self.addCleanup(started.stdout.close)
        self.addCleanup(started.stderr.close)
        self.addCleanup(started.kill)
        return started

    def test_a_sensor_as_delivered_shows_distances_at_250000_bits_a_second(self):
        sensor = self.program(PLOMADA, "laser", "--link", self.link, "--rate", "19200", "--height", str(HEIGHT_M))
        sensor.stdout.readline()    # its name: from now on the link is there
        scanner = self.program(SCANNER, self.link)
        for _ in range(10):
            shown = re.fullmatch(r"(\d+) mm\n", scanner.stdout.readline())
            self.assertIsNotNone(shown)
            self.assertAlmostEqual(int(shown.group(1)), 1000 * HEIGHT_M + ON_GROUND_MM, delta=NOISE_MM)
        scanner.terminate()
        self.assertEqual(scanner.wait(timeout=20), 0)
        sensor.terminate()
        self.assertRegex(sensor.communicate()[1], r"commands: [1-9]")

    def test_a_sensor_that_is_unplugged_ends_it_with_a_word(self):
        sensor = self.program(PLOMADA, "laser", "--link", self.link, "--rate", "115200")
        sensor.stdout.readline()
        scanner = self.program(SCANNER, self.link)
        scanner.stdout.readline()
        sensor.terminate()
        said = scanner.communicate(timeout=20)[1]
        self.assertEqual(scanner.returncode, 1)
        self.assertEqual(said, f"scanner: {self.link}: is gone\n")

    def test_a_port_without_a_sensor_gets_a_hint(self):
        master, slave = os.openpty()
        self.addCleanup(os.close, master)
        self.addCleanup(os.close, slave)
        scanner = self.program(SCANNER, os.ttyname(slave))
        self.assertIn("no scan yet", scanner.stderr.readline())
        scanner.terminate()
        self.assertEqual(scanner.wait(), 0)

    def test_what_is_no_serial_port_and_nothing_at_all_are_named(self):
        for arguments, words, status in (((self.link,), f"scanner: {self.link}: No such file or directory\n", 1),
                                         ((Path("/dev/null"),), "scanner: /dev/null: Inappropriate ioctl for device\n", 1),
                                         ((), "usage: scanner DEVICE\n", 2)):
            done = subprocess.run([SCANNER, *arguments], capture_output=True, text=True, check=False, timeout=20)
            self.assertEqual((done.returncode, done.stderr), (status, words))


if __name__ == "__main__":
    unittest.main(verbosity=2)
