"""`plomada accept` on a board that is right, and on boards with one defect each, which it must name.

Usage: test_accept.py PLOMADA short|long
"""
import concurrent.futures
import json
import os
import signal
import subprocess
import sys
import tempfile
import unittest

import bench

PROGRAM = sys.argv[1]

# What is wrong with the board: the item that must fail, and the only one but those that follow from it.
DEFECTS = {
    "laser-swapped": ("scanner", {"starts", "faults", "flight", "rates", "pulse"}),
    "laser-garbled": ("scanner", {"starts", "faults", "flight", "rates", "pulse"}),
    "imu-swapped": ("imu", {"scanner", "starts", "faults", "flight", "pulse"}),
    "imu-garbled": ("imu", {"scanner", "starts", "faults", "flight", "pulse"}),
    "xbee-swapped": ("radio", set()),
    "wrong-rate": ("radio", set()),
    "pulse-inverted": ("pulse", set()),
    "pulse-long": ("pulse", set()),
    "pulse-missing": ("pulse", set()),
    "no-storage": ("save", set()),
    "forgetful": ("save", set()),
    "slow": ("perf", {"ping", "flight", "starts", "faults", "scanner", "imu", "pulse", "save", "watchdog", "boot", "rates"}),
    "fast": ("rates", set()),
    "no-watchdog": ("watchdog", {"starts", "faults", "pulse", "flight"}),
}


def run(defect=None, items=None, flight_s=12):
    """(exit status, output, report as JSON, report as Markdown) of an acceptance of a fresh board."""
    with tempfile.TemporaryDirectory() as directory:
        pulses, storage, report = (os.path.join(directory, name) for name in ("pulses.csv", "flash", "report"))
        bits = [word for line in ("laser", "imu", "xbee") for word in ("--bits", f"{line}={os.path.join(directory, line)}.csv")]
        options = ["--pulses", pulses, *bits, "--storage", storage, *(["--defect", defect] if defect else [])]
        with bench.Board(PROGRAM, *options) as board:
            words = ["--unattended", "--pulses", pulses, *bits, "--power", f"kill -USR1 {board.process.pid}", "--flight", str(flight_s),
                     "--report", report, *(["--items", items] if items else [])]
            done = subprocess.run([PROGRAM, "accept", *board.lines, *words], capture_output=True, text=True, timeout=900, check=False)
            with open(report + ".json", encoding="utf-8") as file:
                found = json.load(file)
            with open(report + ".md", encoding="utf-8") as file:
                markdown = file.read()
    return done.returncode, done.stdout + done.stderr, found, markdown


def failed(found):
    return {item["item"] for item in found["items"] if item["verdict"] == "FAIL"}


# Of the short ones: the defect, and the items that are asked.
SHORT = {None: "radio,boot,ping,scanner,rates,pulse,save", "pulse-inverted": "radio,pulse", "fast": "radio,rates"}


def at_once(trials):
    """{defect: what run() returns}. Each takes a minute or more by the clock and little of the processor."""
    with concurrent.futures.ThreadPoolExecutor(max_workers=4) as pool:
        return dict(zip(trials, pool.map(run, trials, trials.values())))


@bench.by_the_wall_clock
class Short(unittest.TestCase):
    def test_a_board_that_is_right_passes_and_what_is_wrong_with_another_is_named(self):
        results = at_once(SHORT)
        self.passes(*results[None])
        self.names("pulse", results["pulse-inverted"])
        self.assertIn("xbee 9889 bit/s (+3.01 %)", self.names("rates", results["fast"]))    # both ends just bear it

    def passes(self, status, output, found, markdown):
        """And the report says who, when and what."""
        self.assertEqual(status, 0, output)
        self.assertEqual(failed(found), set())
        self.assertEqual({item["item"]: item["verdict"] for item in found["items"]}["pulse"], "pass")
        self.assertIn("measured: first 1999", output)
        # The dividers of 100 MHz; the scanner's line began at 115200 and was raised.
        for rate in ("laser 114679 bit/s (-0.45 %)", "laser 250000 bit/s (+0.00 %)", "imu 57604 bit/s (+0.01 %)", "xbee 9601 bit/s (+0.01 %)"):
            self.assertIn(rate, output)
        self.assertTrue(found["passed"] and found["date"].endswith("Z") and "F28377S" in found["chip"])
        self.assertEqual(set(found["adapters"]), {"laser", "imu", "xbee"})
        self.assertIn("# Acceptance of a board: passed: 7 of 16 items tried\n", markdown)
        self.assertEqual((found["verdict"], found["tried"]), ("passed: 7 of 16 items tried", 7))
        self.assertIn("| Throttle pulse | pass | measured:", markdown)

    def names(self, item, result):
        status, output, found, _ = result
        self.assertEqual(status, 1, output)
        self.assertEqual(failed(found), {item})
        return output

    def test_interrupted_it_goes_on_where_it_was(self):
        with tempfile.TemporaryDirectory() as directory, bench.Board(PROGRAM) as board:
            command = [PROGRAM, "accept", *board.lines, "--unattended", "--report", os.path.join(directory, "r"), "--items", "radio,ping"]
            first = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
            self.assertIn("radio", first.stdout.readline())
            first.send_signal(signal.SIGINT)
            rest = first.communicate(timeout=60)[0]
            if "\npassed: " in "\n" + rest:
                bench.no_verdict()      # it was through before the signal came
            self.assertEqual(first.returncode, 1)
            second = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
            self.assertEqual(second.returncode, 0, second.stdout)
            self.assertIn("going on with", second.stdout)
            self.assertNotIn("radio ", second.stdout.split("\n", 1)[1])
            self.assertFalse(os.path.exists(os.path.join(directory, "r.state")))

    def test_a_board_of_which_items_were_skipped_is_not_accepted(self):
        for items, tried in (("supplies,leds", 0), ("supplies,radio", 1)):
            status, output, found, markdown = run(items=items)
            words = f"incomplete: {tried} of 16 items tried"
            self.assertEqual(status, 3, output)
            self.assertIn(f"\n{words}; ", output)
            self.assertEqual((found["passed"], found["verdict"], found["tried"]), (False, words, tried))
            self.assertIn(f"# Acceptance of a board: {words}\n", markdown)

    def test_items_and_options_that_are_none_are_refused(self):
        for words in (["--items", "raido"], ["--flight", "5"], []):
            lines = ["--laser", "/nowhere", "--imu", "/nowhere", "--xbee", "/nowhere"] if words else []
            self.assertEqual(subprocess.run([PROGRAM, "accept", *lines, *words], capture_output=True, check=False).returncode, 2)


@bench.by_the_wall_clock
class Long(unittest.TestCase):
    def test_a_board_that_is_right_passes_every_item_that_needs_nobody(self):
        status, output, found, _ = run(flight_s=60)
        if any("keep up" in item["detail"] for item in found["items"]):
            bench.no_verdict()
        self.assertEqual(status, 3, output)
        skipped = {item["item"] for item in found["items"] if item["verdict"] == "skipped"}
        self.assertLessEqual(skipped, {"supplies", "leds", "version"})

    def test_every_defect_is_named(self):
        results = at_once(dict.fromkeys(DEFECTS))
        for defect, (item, consequences) in DEFECTS.items():
            with self.subTest(defect):
                status, output, found, _ = results[defect]
                self.assertEqual(status, 1, output)
                self.assertIn(item, failed(found), output)
                self.assertLessEqual(failed(found) - {item}, consequences, output)


if __name__ == "__main__":
    chosen = {"short": Short, "long": Long}[sys.argv[2]]
    suite = unittest.defaultTestLoader.loadTestsFromTestCase(chosen)
    sys.exit(0 if unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful() else 1)
