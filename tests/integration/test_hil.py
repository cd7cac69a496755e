"""A board on three pseudo-terminals, flown by `plomada hil` in real time.

Usage: test_hil.py PLOMADA short|long
"""
import os
import re
import select
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import bench

PROGRAM = sys.argv[1]
CYCLE_TENTH_MS = 2.5    # of law EST, 25 ms. How well it hovers, the scenario's expectations judge: one flight spreads too far for less


def widest_mm(scenario):
    """The flown figure spreads from seed to seed, and no two real-time flights are the same: against the widest of five."""
    return max(bench.virtual(PROGRAM, scenario, seed)["hover_rms_mm"] for seed in range(1, 6))


@bench.by_the_wall_clock
class Short(unittest.TestCase):
    def test_the_ramp_is_flown_as_in_virtual_time(self):
        status, output = bench.hil(PROGRAM, "est-60cm-ramp")
        bench.note_lost(output)
        self.assertEqual(status, 0, output)
        self.assertIn("MET: all expectations of est-60cm-ramp", output)
        self.assertRegex(output, r"the board ended safe: on the ground, pulse 1999\.\d us")
        self.assertRegex(output, r"(?m)^damaged: laser [0-3] and imu [0-3] frames found by the board; laser 0 commands and xbee 0 lines")
        self.assertNotIn("late:", output)
        loop_ms, simulated_ms = map(float, re.search(r"loop: (\d+\.\d) ms from a scan's last octet to its pulse \(.*in simulation (\d+\.\d)\)", output).groups())
        self.assertAlmostEqual(loop_ms, simulated_ms, delta=CYCLE_TENTH_MS)
        self.tells_what_it_measures_and_no_more(output)

    def tells_what_it_measures_and_no_more(self, output):
        found, simulated = bench.metrics(output), bench.virtual(PROGRAM, "est-60cm-ramp")
        self.assertAlmostEqual(found["aloft_s"], simulated["aloft_s"], delta=0.5)
        self.assertAlmostEqual(found["touch_speed_mps"], simulated["touch_speed_mps"], delta=0.2)
        self.assertEqual((found["cuts"], found["landed_unordered"]), (0, 0))
        unmeasured = re.search(r"(?m)^not measured here: (.*)$", output).group(1).split(", ")
        for name in ("sight_doubts", "imu_doubts", "thrust_doubts", "deceived_s", "flagged_s", "takeovers"):
            self.assertIn(name, unmeasured)
        self.assertFalse(set(unmeasured) & set(found), output)

    def test_a_radio_that_is_wired_the_wrong_way_round_is_named(self):
        status, output = bench.hil(PROGRAM, "hover-60s", ["xbee-swapped"], patience=3)
        self.assertEqual(status, 1)
        self.assertIn("xbee: nothing comes from the board", output)
        self.assertNotIn("laser:", output)
        self.assertNotIn("imu:", output)

    def test_ports_that_are_none_and_scenarios_that_are_none_are_refused(self):
        for words in (["est-60cm-ramp", "--laser", "/nowhere", "--imu", "/nowhere", "--xbee", "/nowhere"], ["bench"], ["est-60cm-ramp"],
                      ["no-such-flight", "--laser", "a", "--imu", "b", "--xbee", "c"]):
            self.assertEqual(subprocess.run([PROGRAM, "hil", *words], capture_output=True, check=False).returncode, 2, words)

    def test_a_flight_that_needs_what_this_world_does_not_have_is_refused_and_says_what(self):
        for scenario, reason in (("battery", "sets plant.battery"), ("field-day", "needs a pilot"), ("stick", "plant.stick")):
            done = subprocess.run([PROGRAM, "hil", scenario, "--laser", "a", "--imu", "b", "--xbee", "c"], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 2)
            self.assertRegex(done.stderr, rf"^plomada hil: {scenario}: .*{reason}")

    def test_a_file_of_ones_own_may_stand_for_a_scenario_and_what_is_wrong_in_it_is_told_with_its_line(self):
        with tempfile.TemporaryDirectory() as directory:
            own = Path(directory, "own.scenario")
            for text, reason in (("reference 0.5\nlnd 9\n", ":2: lnd: no such word here"), ("like est-60cm-ramp\nset plant.tau 0.1\n", "sets plant.tau"),
                                 ("like est-60cm-ramp\nplace block 9 9 1 1 0.1\n", "--laser a: ")):
                own.write_text(text)
                done = subprocess.run([PROGRAM, "hil", own, "--laser", "a", "--imu", "b", "--xbee", "c"], cwd=directory, capture_output=True, text=True,
                                      check=False)
                self.assertEqual(done.returncode, 2)
                self.assertIn("plomada hil: ", done.stderr)
                self.assertIn(reason, done.stderr)

    def test_a_recording_of_the_pin_that_cannot_be_read_is_refused(self):
        with bench.Board(PROGRAM) as board:
            done = subprocess.run([PROGRAM, "hil", "est-60cm-ramp", *board.lines, "--pulses", "/nowhere/pulses.csv"],
                                  capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("/nowhere/pulses.csv", done.stderr)

    def test_with_nothing_but_its_own_usb_port_a_board_says_its_version_and_how_it_performs(self):
        with tempfile.TemporaryDirectory() as directory:
            usb = os.path.join(directory, "usb")
            with bench.Board(PROGRAM, "--usb", usb) as board:
                end, heard = time.monotonic() + 30, b""
                port = os.open(usb, os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
                while heard.count(b"OK VERSION") < 2 and time.monotonic() < end:
                    if select.select([port], [], [], 1.0)[0]:
                        heard += os.read(port, 4096)
                os.close(port)
                self.assertTrue(os.path.islink(usb))
            self.assertEqual(board.status, 0)
            self.assertFalse(os.path.lexists(usb))
        said = heard.decode().split("\r\n")
        version = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
        self.assertIn(f"OK VERSION {version}", said)
        for name in ("TaskIMU", "TaskReceiveLaser", "TaskControl", "TaskSendLaser", "TaskSendComm", "TaskReceiveComm"):
            self.assertEqual(sum(line.startswith(f"OK PERF {name} worst_us:") for line in said), 1, said)

    def test_the_boards_links_are_gone_when_it_ends_and_a_power_cycle_keeps_them(self):
        with bench.Board(PROGRAM) as board:
            self.assertTrue(all(os.path.islink(path) for path in board.wires.values()))
            board.power_cycle()
            self.assertIsNone(board.process.poll())
            board.process.send_signal(signal.SIGINT)
            self.assertEqual(board.process.wait(timeout=20), 0)
            self.assertFalse(any(os.path.islink(path) for path in board.wires.values()))

    def test_a_board_that_this_pc_stopped_says_how_late_it_was(self):
        with bench.Board(PROGRAM) as board:
            time.sleep(0.5)
            board.process.send_signal(signal.SIGSTOP)
            time.sleep(0.2)
            board.process.send_signal(signal.SIGCONT)
            time.sleep(0.5)
        self.assertGreater(max(bench.lags_ms), 180)

    def test_what_fails_on_a_pc_that_was_late_begins_again_and_what_fails_in_real_time_fails(self):
        for lag_ms, tries in ((bench.LATE_MS + 1, 2), (bench.LATE_MS, 1)):
            begun = []

            def test(unused, begun=begun, lag_ms=lag_ms):
                begun.append(lag_ms)
                bench.lags_ms.append(lag_ms)
                if len(begun) == 1:
                    raise AssertionError
            try:
                bench.once_more_if_late(test)(None)
            except AssertionError:
                self.assertEqual(tries, 1)
            bench.lags_ms.clear()      # else this test itself would begin again
            self.assertEqual(len(begun), tries)

    def test_a_signal_at_the_moment_the_links_appear_is_obeyed(self):
        for _ in range(10):
            with bench.Board(PROGRAM, wait=0) as board:
                board.power_cycle()
                board.process.send_signal(signal.SIGINT)
                self.assertEqual(board.process.wait(timeout=20), 0)
                self.assertFalse(any(os.path.islink(path) for path in board.wires.values()))


@bench.by_the_wall_clock
class Long(unittest.TestCase):
    def fly(self, scenario):
        status, output = bench.hil(PROGRAM, scenario)
        self.assertEqual(status, 0, output)
        return bench.metrics(output)

    def test_a_minute_of_the_seeds_hover(self):
        hover_mm = self.fly("hover-60s")["hover_rms_mm"]
        self.assertLess(hover_mm, 1.3 * widest_mm("hover-60s"))

    def test_the_seeds_ramp(self):
        self.fly("pid-60cm-ramp")

    def test_the_ramp_by_the_pulses_that_an_analyser_sees_on_the_pin(self):
        status, output = bench.hil(PROGRAM, "est-60cm-ramp", pin=True)
        self.assertEqual(status, 0, output)
        told = float(re.search(r"loop: (\d+\.\d) ms", bench.hil(PROGRAM, "est-60cm-ramp")[1]).group(1))
        seen = float(re.search(r"loop: (\d+\.\d) ms", output).group(1))
        self.assertLess(seen, told, "the pin is faster than the radio")

    def test_pulses_that_no_throttle_channel_has_are_named(self):
        status, output = bench.hil(PROGRAM, "est-60cm-ramp", ["pulse-inverted"], pin=True)
        self.assertEqual(status, 1, output)
        self.assertRegex(output, r"(?m)^pin: \d+ pulses are not of 0.9 to 2.1 ms$")
        status, output = bench.hil(PROGRAM, "est-60cm-ramp", ["pulse-missing"], pin=True)
        self.assertEqual(status, 1, output)
        self.assertRegex(output, r"(?m)^pin: no pulse$")

    def trouble(self, defect):
        status, output = bench.hil(PROGRAM, "est-60cm-ramp", [defect])
        return status, output

    def test_a_scanner_that_is_unplugged_in_flight_is_named_and_the_board_lands(self):
        status, output = self.trouble("laser-gone@25")
        self.assertEqual(status, 1, output)
        self.assertRegex(output, r"(?m)^laser: gone: the adapter was lost at t = 1\d\.\d s$")
        self.assertIn("the board ended safe", output)

    def test_an_imu_that_is_unplugged_in_flight_is_named_and_the_board_lands(self):
        _, output = self.trouble("imu-gone@25")
        self.assertRegex(output, r"(?m)^imu: gone: the adapter was lost at t = 1\d\.\d s$")
        self.assertIn("the board ended safe", output)

    def test_a_radio_that_is_unplugged_in_flight_is_named_and_nobody_claims_to_know_the_end(self):
        status, output = self.trouble("xbee-gone@25")
        self.assertEqual(status, 1, output)
        self.assertRegex(output, r"(?m)^xbee: silent: no pulse for 0\.5 s at t = 1\d\.\d\d s$")
        self.assertIn("how the board ended is not known", output)

    def test_garbled_lines_are_named(self):
        _, output = self.trouble("xbee-garbled@20")
        self.assertRegex(output, r"(?m)^xbee: garbled: \d+ lines from the board mean nothing$")
        _, output = self.trouble("laser-garbled@20")
        self.assertRegex(output, r"(?m)^laser: garbled: ")
        self.assertIn("the board ended safe", output)
        _, output = self.trouble("imu-garbled@20")
        self.assertRegex(output, r"(?m)^imu: garbled: the board found \d+ frames damaged$")
        self.assertIn("the board ended safe", output)

    def test_late_lines_are_named(self):
        for line in ("laser", "imu"):
            _, output = self.trouble(f"{line}-late@5")
            self.assertRegex(output, rf"(?m)^{line}: late: \d+ frames came more than 0\.2 s after they were sent$")
            self.assertIn("the board ended safe", output)
        _, output = self.trouble("xbee-late@5")
        self.assertRegex(output, r"(?m)^xbee: late: \d+ ms until #LAW EST was answered$")


if __name__ == "__main__":
    chosen = {"short": Short, "long": Long}[sys.argv[2]]
    suite = unittest.defaultTestLoader.loadTestsFromTestCase(chosen)
    sys.exit(0 if unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful() else 1)
