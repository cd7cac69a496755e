"""Files that are damaged, and disks that are full, as users of `plomada` meet them. Usage: test_bad_files.py PLOMADA"""
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = sys.argv.pop(1)
FULL = "/dev/full"
FLIGHT = "reference 0.5\nland 4\nend 8\n"


class Files(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.dir = Path(tempfile.mkdtemp())
        cls.addClassCleanup(shutil.rmtree, cls.dir)
        (cls.dir / "own.scenario").write_text(FLIGHT)
        done = cls.plomada("fly", "./own.scenario", "--csv", "flown.csv", "--record", "run", "--log", "console.log")
        assert done.returncode in (0, 1), done.stderr

    @classmethod
    def plomada(cls, *words, **options):
        return subprocess.run([PROGRAM, *words], cwd=cls.dir, check=False, capture_output="stdout" not in options, timeout=60,
                              stderr=subprocess.PIPE if "stdout" in options else None, text=True, errors="replace", **options)

    def refused(self, done, reason):
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn(reason, done.stderr)

    @unittest.skipUnless(os.path.exists(FULL), "no /dev/full")
    def test_what_does_not_fit_on_the_disk_is_status_2_whoever_writes_it(self):
        flight = ("fly", "./own.scenario")
        for words in ((*flight, "--csv"), (*flight, "--json"), (*flight, "--log"), (*flight, "--trace"),
                      ("replay", "run", "--csv"), ("replay", "flown.csv", "--csv")):
            with self.subTest(words):
                self.refused(self.plomada(*words, FULL), FULL)

    @unittest.skipUnless(os.path.exists(FULL), "no /dev/full")
    def test_what_cannot_be_printed_is_status_2(self):
        for words in (("list",), ("list", "--plant"), ("params",), ("--help",), ("--version",), ("fly", "--help"),
                      ("fly", "./own.scenario"), ("fly", "./own.scenario", "--csv", "-"), ("replay", "run"), ("log", "console.log", "-o", "-")):
            with self.subTest(words), open(FULL, "w", encoding="utf-8") as full:
                self.refused(self.plomada(*words, stdout=full), "stdout")

    def test_a_recording_is_not_overwritten(self):
        before = (self.dir / "run/flight.plomada").read_bytes()
        done = self.plomada("fly", "./own.scenario", "--seed", "2", "--record", "run", "--csv", "not-begun.csv")
        self.refused(done, "there is a recording already")
        self.assertEqual((self.dir / "run/flight.plomada").read_bytes(), before)
        self.assertFalse((self.dir / "not-begun.csv").exists())

    def test_a_flight_that_is_refused_leaves_nothing_and_changes_nothing(self):
        (self.dir / "kept.json").write_text("kept")
        (self.dir / "bad.limits").write_text("no limits")
        before = sorted(self.dir.rglob("*"))
        flight = ("fly", "./own.scenario", "--record", "left", "--log", "left.log", "--storage", "left.flash")
        for words, reason in ((("--json", "kept.json", "--csv", "nosuch/x.csv"), "nosuch/x.csv: No such file"), (("--csv", "left.csv", "--limits", "bad.limits"), "bad.limits"),
                              (("--csv", "left/x.csv", "--trace", "nosuch/x"), "nosuch/x: No such file")):
            with self.subTest(words):
                self.refused(self.plomada(*flight, *words), reason)
                self.assertEqual(sorted(self.dir.rglob("*")), before)
        self.assertEqual((self.dir / "kept.json").read_text(), "kept")
        self.assertIn(self.plomada(*flight, "--csv", "left.csv").returncode, (0, 1))
        self.assertGreater((self.dir / "left/flight.plomada").stat().st_size, 1000)

    def test_what_a_refused_command_was_to_replace_is_not_lost(self):
        """Files were emptied first, and the command refused then: by its limits, a device, a line of the log or another file."""
        (self.dir / "bad.limits").write_text("no limits")
        (self.dir / "torn.csv").write_text((self.dir / "flown.csv").read_text() + "9 m\n")
        (self.dir / "cut").write_bytes(re.sub(rb"first_row_ns \d+", b"first_row_ns 900000000000000000", (self.dir / "run/flight.plomada").read_bytes()))
        (self.dir / "kept.md").mkdir(exist_ok=True)
        sensor, end = os.openpty()
        self.addCleanup(os.close, sensor)
        self.addCleanup(os.close, end)
        flight = ("fly", "./own.scenario", "--csv", "kept", "--trace", "kept.trace")
        for words, reason in (((*flight, "--limits", "bad.limits"), "bad.limits: not the limits"), ((*flight, "--imu", "/nowhere"), "/nowhere"),
                              (("replay", "torn.csv", "--csv", "kept"), "not as many cells"), (("replay", "cut", "--csv", "kept"), "ends before its first row"),
                              (("board", "--laser", "l", "--imu", "i", "--xbee", "x", "--pulses", "kept", "--bits", "imu=/nowhere/i"), "/nowhere/i"),
                              (("scip", "record", os.ttyname(end), "kept", "--force"), "kept.md: Is a directory")):
            with self.subTest(words):
                (self.dir / "kept").write_text("kept")
                (self.dir / "kept.trace").write_text("kept")
                self.refused(self.plomada(*words), reason)
                self.assertEqual([(self.dir / name).read_text() for name in ("kept", "kept.trace")], ["kept", "kept"])
                self.assertFalse((self.dir / "kept.tx").exists())

    def test_a_folder_where_a_file_is_expected_is_named_as_one(self):
        """It was read as an empty file: `no figure of the plant in it`, `no row of a #LOG dump in it`."""
        (self.dir / "folder").mkdir(exist_ok=True)
        flight = ("fly", "./own.scenario")
        for words in ((*flight, "--vehicle"), (*flight, "--place"), (*flight, "--limits"), (*flight, "--storage"), (*flight, "--csv"), ("log",),
                      ("replay", "run", "--csv"), ("scip", "decode")):
            with self.subTest(words):
                self.refused(self.plomada(*words, "folder"), "folder: Is a directory")
        self.refused(self.plomada("fly", "./folder"), "./folder: Is a directory")
        self.refused(self.plomada("replay", "folder"), "folder: a folder without a recording: no flight.plomada in it")

    def test_an_output_that_is_there_already_holds_the_new_flight_alone(self):
        (self.dir / "old.csv").write_bytes((self.dir / "flown.csv").read_bytes() + b"more" * 1000)
        self.assertIn(self.plomada("fly", "./own.scenario", "--csv", "old.csv").returncode, (0, 1))
        self.assertEqual((self.dir / "old.csv").read_bytes(), (self.dir / "flown.csv").read_bytes())

    def apart(self, done, *files):
        """Refused as one file that was given twice; nothing in it has changed."""
        self.refused(done, "are one file")
        for file, octets in files:
            self.assertEqual((self.dir / file).read_bytes(), octets)

    def test_a_replay_never_writes_over_what_it_reads(self):
        (self.dir / "a-link.csv").unlink(missing_ok=True)
        (self.dir / "a-link.csv").symlink_to("flown.csv")
        log, record = ("flown.csv", (self.dir / "flown.csv").read_bytes()), ("run/flight.plomada", (self.dir / "run/flight.plomada").read_bytes())
        for name in ("flown.csv", "./flown.csv", "a-link.csv", str(self.dir / "flown.csv")):
            self.apart(self.plomada("replay", "flown.csv", "--csv", name), log)
        for name in ("run", "run/flight.plomada"):
            self.apart(self.plomada("replay", name, "--csv", "run/flight.plomada"), record)
        with open(self.dir / "flown.csv", "a", encoding="utf-8") as same:
            self.apart(self.plomada("replay", "flown.csv", stdout=same), log)

    def test_a_flight_never_writes_over_what_it_reads(self):
        (self.dir / "vehicle.json").write_text('{"plant.gain": {"value": 1}}')
        (self.dir / "a.place").write_text("block 9 9 1 1 0.1\n")
        for option, file in (("--vehicle", "vehicle.json"), ("--place", "a.place")):
            before = (self.dir / file).read_bytes()
            self.apart(self.plomada("fly", "./own.scenario", option, file, "--json", file), (file, before))
        self.apart(self.plomada("fly", "./own.scenario", "--csv", "own.scenario"), ("own.scenario", FLIGHT.encode()))

    def test_one_file_for_two_outputs_of_a_flight_is_refused_before_it_is_made(self):
        for words in (("--csv", "z", "--json", "z"), ("--csv", "z", "--radio", "./z"), ("--log", "z", "--trace", str(self.dir / "z")),
                      ("--storage", "z", "--csv", "z"), ("--record", "new", "--csv", "new/flight.plomada"), ("--csv", "new", "--record", "new"),
                      ("--csv", "-", "--json", "-")):
            with self.subTest(words):
                self.apart(self.plomada("fly", "./own.scenario", *words))
                self.assertFalse((self.dir / "z").exists() or (self.dir / "new").exists())
        self.assertIn(self.plomada("fly", "./own.scenario", "--csv", os.devnull, "--json", os.devnull).returncode, (0, 1))

    def test_a_board_and_its_acceptance_write_no_file_that_they_also_read_or_write(self):
        (self.dir / "pin.md").write_text("a recording")
        lines = ("--laser", "l", "--imu", "i", "--xbee", "x")
        self.apart(self.plomada("board", *lines, "--storage", "pin.md", "--pulses", "pin.md"), ("pin.md", b"a recording"))
        self.apart(self.plomada("board", *lines, "--bits", "imu=z", "--bits", "laser=z"))
        self.apart(self.plomada("accept", *lines, "--pulses", "pin.md", "--report", "pin", "--afresh"), ("pin.md", b"a recording"))
        self.assertFalse((self.dir / "z").exists() or (self.dir / "l").is_symlink())

    def test_the_report_on_a_board_is_not_overwritten_by_that_on_the_next(self):
        (self.dir / "board.json").write_text("{}")
        lines = ("accept", "--laser", "/nowhere", "--imu", "/nowhere", "--xbee", "/nowhere", "--report", "board")
        self.refused(self.plomada(*lines), "board: the report of another acceptance")
        self.refused(self.plomada(*lines, "--afresh"), "/nowhere: No such file")
        (self.dir / "board.state").write_text("")       # interrupted: it goes on
        self.refused(self.plomada(*lines), "/nowhere: No such file")

    def test_json_is_valid_whatever_the_scenario_is_called(self):
        for name in (b'a"b', b"back\\slash", b"\x01\xff"):
            (self.dir / "named.scenario").write_bytes(FLIGHT.encode() + b"name " + name + b"\n")
            self.plomada("fly", "./named.scenario", "--json", "named.json")
            told = json.loads((self.dir / "named.json").read_bytes())
            self.assertEqual(told["scenario"], name.decode("utf-8", errors="replace"))

    def test_a_seed_that_no_number_holds_is_refused(self):
        for seed in ("18446744073709551616", "9223372036854775808", "-1", ""):
            self.refused(self.plomada("fly", "./own.scenario", "--seed", seed), "not a seed")

    def test_a_flight_that_lands_before_the_edge_is_not_judged_by_it(self):
        of_edge = ("terrain_rms_mm", "recovery_s", "settled_s", "undershoot_mm")
        done = self.plomada("fly", "est-60cm-ramp", "--duration", "6", "--json", "short.json")
        self.assertEqual(done.returncode, 0, done.stdout)
        table, judged = done.stdout.split("Not judged, for the flight lands before: ")
        for name in of_edge:
            self.assertNotIn(name, table)
            self.assertIsNone(json.loads((self.dir / "short.json").read_text())[name])
        self.assertEqual(judged, "hover_rms_mm, hover_mean_error_mm, terrain_rms_mm, recovery_s, undershoot_mm, thrust_std_n\nMET: what could be judged of est-60cm-ramp\n")
        self.assertNotIn("Not judged", self.plomada("fly", "est-60cm-ramp").stdout)

    def test_a_flight_longer_than_time_is_refused(self):
        for option in ("--duration", "--until-down"):
            self.refused(self.plomada("fly", "./own.scenario", option, "1e18"), "not a number of seconds")

    def replay(self, octets):
        (self.dir / "given").write_bytes(octets)
        return self.plomada("replay", "given", "--csv", "replayed.csv")

    def test_a_recording_whose_times_go_back_is_refused_with_its_line(self):
        lines = (self.dir / "run/flight.plomada").read_bytes().splitlines(keepends=True)
        at = [n for n, line in enumerate(lines) if line.startswith(b"octets imu")]
        swapped = lines.copy()
        swapped[at[50]], swapped[at[80]] = lines[at[80]], lines[at[50]]
        self.refused(self.replay(b"".join(swapped)), f"line {at[51] + 1}: before the octet before it")
        levels = [*lines, b"select 9000000 1\n", b"select 8000000 0\n"]
        self.refused(self.replay(b"".join(levels)), f"line {len(levels)}: before the level before it")

    def test_a_recording_that_is_cut_is_replayed_and_named_with_status_1(self):
        whole = (self.dir / "run/flight.plomada").read_bytes()
        done = self.replay(whole)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertNotIn("cut", done.stderr)
        part = whole[:whole.rindex(b"\n", 0, len(whole) * 2 // 5) + 1]      # whole lines alone
        done = self.replay(part)
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("given: the recording is cut: it ends at ", done.stderr)
        self.assertIn("replayed ", done.stderr)
        done = self.replay(part.replace(b"plomada-recording 2", b"plomada-recording 1"))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("given: no end line, as in older recordings: it may be cut", done.stderr)

    def test_a_recording_of_other_than_text_is_refused_and_one_cut_off_is_not(self):
        whole = (self.dir / "run/flight.plomada").read_bytes()
        half = whole[:len(whole) // 2]
        self.assertEqual(self.replay(half).returncode, 1)
        self.refused(self.replay(half + b"\0\0\n" + whole[len(whole) // 2:]), "not text")
        self.refused(self.replay(b"plomada-recording 1\noctets imu 9223372036854775807 1e5 0000\n"), "line 2: beyond what a run lasts")
        self.refused(self.replay(b"plomada-recording 1\noctets imu 5 inf 0000\n"), "line 2")
        self.refused(self.replay(re.sub(rb"first_row_ns \d+", b"first_row_ns 900000000000000000", whole)), "ends before its first row")
        self.refused(self.replay(b""), "not a recording")

    def test_a_log_is_refused_with_the_line_that_is_wrong(self):
        rows = (self.dir / "flown.csv").read_text().splitlines()
        cells = rows[99].split(",")

        def with_cell(place, cell):
            return "\n".join([*rows[:99], ",".join([*cells[:place], cell, *cells[place + 1:]]), *rows[100:]]) + "\n"

        for text, reason in ((with_cell(0, "inf"), "line 100: t_s: not a number"), (with_cell(0, ""), "line 100: t_s: no time"),
                             (with_cell(0, "0.1"), "line 100: t_s: before the row"), (with_cell(0, "1e300"), "line 100: t_s: no time"),
                             (with_cell(1, "nan"), "line 100: meas_m: not a number"), (with_cell(1, "0.6m"), "line 100: meas_m"),
                             ("\n".join([*rows[:99], rows[99][:20]]), "line 100: row: not as many cells"),
                             ("\n".join([*rows[:99], "\0" + rows[99], rows[100]]), "line 100: row: not text"),
                             (rows[0] + "\n", "no row of a flight")):
            with self.subTest(reason):
                self.refused(self.replay(text.encode()), reason)

    def test_a_dump_in_a_console_is_not_passed_over(self):
        """The telemetry around it was replayed in its place: a height in 0.2 s, and level assumed."""
        console = (self.dir / "console.log").read_bytes()
        self.assertIn(b"\nalt:", console)
        for text in (console, console[console.index(b"OK LOG 0 "):]):
            self.refused(self.replay(text), "OK LOG: a dump of #LOG; type `plomada log` with this file, and replay the CSV that it makes")
        self.assertEqual(self.replay(b"\n".join(line for line in console.splitlines() if not re.match(rb"OK LOG [1-9]", line)) + b"\n").returncode, 0)
        self.assertEqual(self.plomada("log", "console.log", "--force").returncode, 0)
        self.assertEqual(self.plomada("replay", "console.csv", "--csv", os.devnull).returncode, 0)

    def test_a_log_from_another_system_is_the_same_log(self):
        self.assertEqual(self.replay((self.dir / "flown.csv").read_bytes()).returncode, 0)
        as_it_is = (self.dir / "replayed.csv").read_bytes()
        self.assertEqual(self.replay(b"\xef\xbb\xbf" + (self.dir / "flown.csv").read_bytes().replace(b"\n", b"\r\n")).returncode, 0)
        self.assertEqual((self.dir / "replayed.csv").read_bytes(), as_it_is)

    def test_a_vehicle_with_a_value_that_is_no_number_is_refused(self):
        for value in ("null", '"heavy"', "NaN", "Infinity", ""):
            (self.dir / "vehicle.json").write_text(f'{{"plant.gain": {{"value": {value}}}}}')
            self.refused(self.plomada("fly", "./own.scenario", "--vehicle", "vehicle.json"), "without its value")


if __name__ == "__main__":
    unittest.main()
