"""examples/scanner on a sensor of another hand (hokuyo.py): in the sensor's own time, and on a pseudo-terminal by the wall clock; and
what `plomada laser` answers to the same questions.

Usage: test_hokuyo.py PIPE_BOARD PROGRAM PLOMADA TRIALS    TRIALS: sensors of each kind and rate, 1 to 5
"""
import math
import os
import re
import select
import signal
import subprocess
import sys
import tempfile
import termios
import time
import tty
import unittest
from pathlib import Path

import hokuyo

PIPE_BOARD, PROGRAM, PLOMADA = sys.argv[1:4]
TRIALS = int(sys.argv[4])
del sys.argv[1:5]
STEP_US, READ_MOST, WAIT_US = 500, 32, 5000     # board_uart_read() of posix.c waits so long at most
S = 1_000_000
SHORT_BOOT_US = S // 10
STRAIGHT_AHEAD_MM = hokuyo.distance_mm(384)     # the mean of 367..401, each a millimetre farther than the one before
FAST = {"first_reply_us": 100_000}
SLOW = {"first_reply_us": 381_000}
HEARS = {"first_reply_us": 100_000, "hears_us": 381_000}    # the other reading of the one late answer, docs/scip.md
AT_REVOLUTIONS = {"first_reply_us": 100_000, "at_revolutions": True}
# docs/scip.md, "Time without scans". "So, but first 381" is a sum there; 0.01 for the 5 ms of a read and of a step.
FAST_MOST_S, SLOW_MOST_S, IDLE_MOST_S = 1.0, 1.38, 2.0
PATIENCE_S = 60     # of the wall clock, on a machine at work


class Bench:
    """The program, whose board asks for octets, and the sensor, in one time."""

    def __init__(self, urg, tells_errors=True):
        self.urg, self.tells_errors = urg, tells_errors
        self.now_us, self.errors, self.heard, self.shown, self.rate, self.cycled = 0, 0, [], [], 19200, 0
        self.board = subprocess.Popen([PIPE_BOARD], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.board.communicate()

    def pass_time(self, end_us):
        """To the next step at which anything is due, or to the end."""
        due = [at_us for at_us in (self.urg.quiet_until_us(), self.urg.to_host.next_us(), end_us) if at_us is not None]
        self.now_us += STEP_US * max(1, math.ceil((min(due) - self.now_us) / STEP_US))
        self.urg.run(self.now_us)
        for _, octet, broken in self.urg.to_host.hear(self.now_us):
            self.heard.append(octet)
            self.errors += broken and self.tells_errors

    def answer_read(self):
        end_us = self.now_us + WAIT_US
        while not self.heard and self.now_us < end_us:
            self.pass_time(end_us)
        now, self.heard = self.heard[:READ_MOST], self.heard[READ_MOST:]
        self.board.stdin.write(f"{self.now_us} {self.errors} {bytes(now).hex() or '-'}\n")
        self.board.stdin.flush()
        self.errors = 0

    def serve(self):
        """One thing that the board does."""
        word, *words = self.board.stdout.readline().split()
        if word == "open":
            self.rate = self.urg.to_host.rate = int(words[0])
        elif word == "write":
            for octet in bytes.fromhex(words[0]):
                self.urg.to_sensor.drive(octet, self.now_us, self.rate)
        elif word == "show":
            self.shown.append(int(words[0]))
        elif word == "cycle":
            self.cycled += 1
        else:
            self.answer_read()

    def run_for(self, span_us):
        end_us = self.now_us + span_us
        while self.now_us < end_us:
            self.serve()

    def to_scan_s(self, most_s=40):
        begun_us, before = self.now_us, len(self.shown)
        while len(self.shown) == before and self.now_us - begun_us < most_s * S:
            self.serve()
        return (self.now_us - begun_us) / S


class InItsOwnTime(unittest.TestCase):
    def blind_s(self, trial, rate, options, **bench_options):
        """Beyond an outage of 0.1 s and a boot of 2 to 8 s."""
        boot_us = 2 * S + trial * 3_571_000 % 6_001_000
        urg = hokuyo.Urg(rate, SHORT_BOOT_US, seed=trial, turn_us=99_880, **options)
        urg.power(True, 0)      # a first boot that nobody times
        urg.boot_us = boot_us
        with Bench(urg, **bench_options) as bench:
            bench.to_scan_s()
            bench.run_for(2 * S + trial * 37_190 % 150_000)
            urg.power(False, bench.now_us)
            bench.run_for(S // 10)
            urg.power(True, bench.now_us)
            bench.run_for(boot_us)
            seconds = bench.to_scan_s()
            bench.run_for(S // 2)
            self.assertEqual((set(bench.shown), bench.cycled), ({STRAIGHT_AHEAD_MM}, 0))
        return seconds

    def assert_blind_at_most(self, most_s, options, **bench_options):
        for rate in hokuyo.RATES:
            for trial in range(TRIALS):
                with self.subTest(rate=rate, trial=trial):
                    self.assertLessEqual(self.blind_s(trial, rate, options, **bench_options), most_s)

    def test_after_a_power_dip_it_is_back_within_a_second_at_every_power_up_rate(self):
        self.assert_blind_at_most(FAST_MOST_S, FAST)

    def test_so_it_is_where_the_answers_come_at_revolutions_and_the_port_tells_no_errors(self):
        self.assert_blind_at_most(FAST_MOST_S, AT_REVOLUTIONS, tells_errors=False)

    def test_so_it_is_where_the_sensor_hears_before_it_answers(self):
        self.assert_blind_at_most(FAST_MOST_S, HEARS)
        self.assert_blind_at_most(FAST_MOST_S, HEARS, tells_errors=False)

    def test_a_first_answer_after_381_ms_costs_what_the_page_adds_up(self):
        self.assert_blind_at_most(SLOW_MOST_S, SLOW)
        self.assert_blind_at_most(SLOW_MOST_S, SLOW, tells_errors=False)

    def test_an_idle_sensor_gives_its_first_scan_within_two_seconds(self):
        for rate in hokuyo.RATES[:4]:
            urg = hokuyo.Urg(seed=rate)
            urg.wake_in_scip2(0, rate)
            with self.subTest(rate=rate), Bench(urg) as bench:
                self.assertLessEqual(bench.to_scan_s(), IDLE_MOST_S)
                self.assertEqual(bench.shown, [STRAIGHT_AHEAD_MM])


class OnALine(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.link = Path(folder.name) / "urg"

    def program(self, *command):
        started = subprocess.Popen([str(word) for word in command], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.addCleanup(started.wait)
        self.addCleanup(started.stdout.close)
        self.addCleanup(started.kill)
        return started

    def hokuyo(self, *words):
        sensor = self.program(sys.executable, "-B", hokuyo.__file__, "--link", self.link, *words)
        sensor.stdout.readline()
        return sensor

    def distance(self, scanner):
        self.assertTrue(select.select([scanner.stdout], [], [], PATIENCE_S)[0], "no scan")
        return scanner.stdout.readline()

    def test_the_program_shows_distances_and_shows_them_again_after_a_power_dip(self):
        sensor = self.hokuyo("--rate", "57600", "--boot-ms", "500")
        scanner = self.program(PROGRAM, self.link)
        for _ in range(10):
            self.assertEqual(self.distance(scanner), f"{STRAIGHT_AHEAD_MM} mm\n")
        os.set_blocking(scanner.stdout.fileno(), False)
        sensor.send_signal(signal.SIGUSR1)
        while select.select([scanner.stdout], [], [], 1.0)[0]:     # what was on its way, then no scan for a second
            self.assertNotEqual(os.read(scanner.stdout.fileno(), 4096), b"")
        sensor.send_signal(signal.SIGUSR2)
        self.assertTrue(select.select([scanner.stdout], [], [], PATIENCE_S)[0], "no scan after the dip")
        self.assertEqual(os.read(scanner.stdout.fileno(), 4096).split(b"\n")[0], f"{STRAIGHT_AHEAD_MM} mm".encode())

    def replies(self, commands):
        """What the sensor on the link says to each command at 115200, one after the other."""
        port = os.open(self.link, os.O_RDWR | os.O_NOCTTY)
        self.addCleanup(os.close, port)
        tty.setraw(port)
        settings = termios.tcgetattr(port)
        settings[4] = settings[5] = termios.B115200
        termios.tcsetattr(port, termios.TCSANOW, settings)
        said = []
        for command in commands:
            os.write(port, command.encode() + b"\n")
            text, begun = b"", time.monotonic()
            while not text.endswith(b"\n\n") and time.monotonic() - begun < PATIENCE_S:
                if select.select([port], [], [], 0.1)[0]:
                    text += os.read(port, 4096)
            said.append(text.decode("latin-1"))
        return said

    def test_plomada_laser_answers_as_this_sensor_does(self):
        """Echo, status and sum of each; texts by their keys; scans by their length."""
        commands = ("VV", "L1", "L0", "SCIP2.0", "SCIP2.0", "QT", "XX", "GS0372040601", "BM", "BM", "GS0372040601", "GD0000076800", "GD004407250A",
                    "GS0044076901", "GS0400039901", "MS04000399010", "MS0400039901000", "MS0400076901000", "SS115200", "SS38400x", "SS111111", "TM0",
                    "TM0", "QT", "SS115200", "TM2", "TM2", "VV", "PP", "II", "CR00", "QT;twelve_chars", "QT;a_string_that_is_17", "ME0044072501000", "ND", "QT")
        self.hokuyo("--rate", "115200", "--boot-ms", "0", "--first-reply-ms", "10")
        ours = self.replies(commands)
        self.link.unlink()
        laser = self.program(PLOMADA, "laser", "--link", self.link, "--rate", "115200")
        laser.stdout.readline()
        for command, one, other in zip(commands, ours, self.replies(commands)):
            with self.subTest(command):
                self.assertEqual(self.shape(command, other), self.shape(command, one))

    @staticmethod
    def shape(command, text):
        if command in ("VV", "PP", "II"):
            return text.split("\n")[:2] + re.findall(r"^(\w{4}):", text, re.MULTILINE)
        return text.split("\n")[:2] + [len(text)]


if __name__ == "__main__":
    unittest.main(verbosity=2)
