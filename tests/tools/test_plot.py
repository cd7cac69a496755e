"""tools/plot: reading the four kinds of recordings, refusing all else, and a picture of each."""
import contextlib
import io
import math
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest
import unittest.mock
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/plot"))
import belief  # noqa: E402
import plot  # noqa: E402
import recording  # noqa: E402

HEADER = "t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags,height_m,abs_m,terrain_m,pulse_us\n"
FLIGHT = HEADER + "".join(
    f"{0.01 * k:.2f},{'' if k < 5 else 0.4},{'' if k < 5 else 0.41},{0.01 if k > 9 else ''},{0 if k < 50 else 0.6},7.00,0.01,,"
    f"{'GROUND' if k < 100 else 'FLYING'},{5 if 120 < k < 130 else 0},{0.002 * k:.3f},{0.002 * k + 0.1:.3f},0.100,1400.0\n"
    for k in range(200))
LINE = "alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0"
RECORDER = "t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags\n" + "".join(
    f"{70 + 0.108 * k:.3f},{'' if k == 3 else 0.59},0.598,,0.600,7.123,-0.0123,0.0345,FLYING,{k % 2}\n" for k in range(50))
GAP = "alt:- ref:0.600 laser:LOST thr:6.90 state:COASTING flags:1"


def packets(text, size):
    octets = text.encode("ascii")
    return [octets[at:at + size].hex().upper() for at in range(0, len(octets), size)]


class Case(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)

    def write(self, name, text):
        (self.dir / name).write_bytes(text if isinstance(text, bytes) else text.encode())
        return self.dir / name

    def console(self, rows):
        head = '02-05-2015 23:59:58.000,-,AT,"Plomada,0013A2004031A8D7,XBee,10EF,COM4 - 9600/8/N/1/N"\n'
        return self.write("console.log", head + "".join(row + "\n" for row in rows))


class Reading(Case):
    def test_a_flight_recorder(self):
        rec = recording.read(self.write("flown.csv", RECORDER))
        self.assertEqual((rec.kind, len(rec.t), rec.columns["thrust_n"][7], rec.columns["flags"][7]), ("recorder", 50, 7.123, 1))
        self.assertTrue(math.isnan(rec.columns["meas_m"][3]))
        self.assertAlmostEqual(rec.t[1] - rec.t[0], 0.108)
        with self.assertRaisesRegex(recording.Unreadable, "no column est_m"):
            recording.read(self.write("flown.csv", RECORDER.replace("est_m", "e")))

    def test_a_flight(self):
        rec = recording.read(self.write("flight.csv", FLIGHT))
        self.assertEqual((rec.kind, rec.name, len(rec.t)), ("flight", "flight", 200))
        self.assertTrue(math.isnan(rec.columns["est_m"][4]))
        self.assertEqual((rec.columns["meas_m"][5], rec.columns["est_m"][5], rec.columns["innov_m"][10]), (0.4, 0.41, 0.01))
        self.assertEqual(rec.columns["state"][99:101], ["GROUND", "FLYING"])
        self.assertAlmostEqual(rec.t[-1], 1.99)

    def test_columns_are_found_by_name_and_missing_ones_named(self):
        swapped = "".join(",".join(row.split(",")[:1] + row.split(",")[:0:-1]) + "\n" for row in FLIGHT.split())
        self.assertEqual(recording.read(self.write("f.csv", swapped)).columns, recording.read(self.write("g.csv", FLIGHT)).columns)
        with self.assertRaisesRegex(recording.Unreadable, "no column ref_m"):
            recording.read(self.write("f.csv", FLIGHT.replace("ref_m", "reference")))

    def test_a_damaged_flight_names_its_line(self):
        with self.assertRaisesRegex(recording.Unreadable, ":3: .*zero"):
            recording.read(self.write("f.csv", HEADER + "0,0,0,0,0,0,0,0,GROUND,0,0,0,0,0\nzero,0,0,0,0,0,0,0,GROUND,0,0,0,0,0\n"))
        with self.assertRaisesRegex(recording.Unreadable, "no samples"):
            recording.read(self.write("f.csv", HEADER))

    def test_what_no_flight_can_hold_is_refused_with_its_line(self):
        row = "1.99,0.4,0.41,0.01,0.6,7.00,0.01,,FLYING,0,0.398,0.498,0.100,1400.0\n"
        for place, cell, reason in ((0, "1.5", "does not come after 1.98"), (0, "", "nothing does not"), (0, "nan", "no number"), (1, "612", "not in metres"),
                                    (1, "1e999", "no number"), (1, "0x1", "no number"), (4, "-0.1", "not in metres"), (5, "712", "not in newtons"),
                                    (6, "-12", "not in radians"), (8, "fly", "no state"), (9, "1e9", "not in flags"), (8, 'FLY"', "a quote")):
            cells = row.split(",")
            cells[place] = cell
            with self.subTest(cell), self.assertRaisesRegex(recording.Unreadable, f"f.csv:201: .*{reason}"):
                recording.read(self.write("f.csv", FLIGHT.replace(row, ",".join(cells))))
        with self.assertRaisesRegex(recording.Unreadable, "f.csv:201: 13 cells, the titles are 14"):
            recording.read(self.write("f.csv", FLIGHT.replace(row, row.replace(",1400.0", ""))))
        with self.assertRaisesRegex(recording.Unreadable, "two columns abs_m"):
            recording.read(self.write("f.csv", FLIGHT.replace("\n", ",abs_m\n", 1).replace("1400.0\n", "1400.0,0\n")))

    def test_a_file_without_end_is_no_flight(self):
        with self.assertRaisesRegex(recording.Unreadable, "no flight"):
            recording.read("/dev/zero")

    def test_a_csv_that_ends_within_a_row_says_so(self):
        rec = recording.read(self.write("f.csv", FLIGHT[:-30]))
        self.assertEqual((rec.cut, len(rec.t)), (True, 199))
        self.assertFalse(recording.read(self.write("f.csv", FLIGHT)).cut)

    def test_of_telemetry_what_cannot_be_is_left_out_and_counted(self):
        text = "".join(f"{line}\n" for line in (LINE, LINE.replace("0.598", "598"), LINE.replace("7.12", "inf"), LINE.replace("FLYING", "fly\x01"), LINE))
        rec = recording.read(self.write("t.txt", text))
        self.assertEqual((len(rec.t), rec.damaged), (2, 3))

    def test_telemetry_text_runs_at_200_ms_and_answers_take_no_time(self):
        rec = recording.read(self.write("t.txt", f"OK SETR 0.6\r\n{LINE}\r\n\r\nERR KP range\r\n{GAP}\r\nalt:0.5 re\r\n{LINE}\r\n"))
        self.assertEqual(rec.kind, "telemetry")
        self.assertEqual([round(t, 6) for t in rec.t], [0.0, 0.2, 0.6])
        self.assertEqual(rec.damaged, 1)
        self.assertTrue(math.isnan(rec.columns["meas_m"][1]))
        self.assertEqual(rec.columns["laser"], ["OK", "LOST", "OK"])
        self.assertEqual(rec.columns["thrust_n"], [7.12, 6.9, 7.12])

    def test_the_line_of_the_beams_takes_no_time_either_and_is_no_damage(self):
        beams = "mf:8,776,9,83,0 m1:8,804,28,108,99 m2:- out:m1"
        rec = recording.read(self.write("seen.txt", "".join((LINE + "\r\n") * 5 + beams + "\r\n" for _ in range(4))))
        self.assertEqual((len(rec.t), rec.damaged), (20, 0))
        self.assertAlmostEqual(rec.t[-1], 19 * 0.2)

    def test_a_console_log_split_anywhere_gives_the_same_lines(self):
        text = f"{LINE}\r\nOK SETR 0.6\r\n{GAP}\r\n{LINE}\r\n"
        for size in range(1, len(text) + 1):
            rec = recording.read(self.console(f"02-05-2015 23:59:58.100,{k},RECV,{packet}"
                                              for k, packet in enumerate(packets(text, size))))
            self.assertEqual((rec.kind, rec.columns["state"], rec.damaged), ("console", ["FLYING", "COASTING", "FLYING"], 0), size)

    def test_a_console_log_with_anything_before_its_header_is_one(self):
        rows = ['02-05-2015 23:59:58.000,-,AT,"A,0013A2004031A8D7,XBee,10EF,COM4 - 9600/8/N/1/N"',
                f"02-05-2015 23:59:58.100,0,RECV,{(LINE + chr(13) + chr(10)).encode().hex()}"]
        for before in ("", "\n", "flight 3\n", "\ufeff", "XCTU\n\n", f"{LINE}\n"):
            rec = recording.read(self.write("x.log", (before + "\n".join(rows) + "\n").encode()))
            self.assertEqual((rec.kind, rec.columns["state"]), ("console", ["FLYING"]), before)

    def test_a_console_log_over_midnight_with_commands_sent(self):
        line = (LINE + "\r\n").encode().hex()
        rec = recording.read(self.console([
            f"02-05-2015 23:59:59.900,0,RECV,{line}",
            "02-05-2015 23:59:59.950,1,SENT,23534554", "03-05-2015 00:00:00.000,1,SENT,5220302E350A",
            "what is this", f"03-05-2015 00:00:00.100,2,RECV,{line}", "03-05-2015 00:00:00.100,2,RECV,ABC"]))
        self.assertEqual([round(t, 3) for t in rec.t], [0.0, 0.2])
        self.assertEqual([(round(t, 3), text) for t, text in rec.sent], [(0.1, "#SETR 0.5")])
        self.assertEqual(rec.damaged, 1)

    def test_anything_else_is_refused(self):
        for text in ("", "\n\n", "hello world\n", "a,b,c\n1,2,3\n", b"\x00\x01\x02", b"\xff\xfe\xfd\n",
                     "OK SETR 0.6\n", "02-05-2015 11:44:56.017,-,AT,\"x\"\n02-05-2015 11:44:56.100,0,RECV,4F4B0A\n"):
            with self.subTest(text=text), self.assertRaises(recording.Unreadable):
                recording.read(self.write("x", text))


class Drawing(Case):
    def program(self, name, *arguments):
        return subprocess.run([sys.executable, "-B", ROOT / f"tools/plot/{name}.py", *arguments], capture_output=True, text=True, check=False)

    def called(self, tool, *arguments):
        """As its program, which Matplotlib lets wait for half a second each time."""
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            try:
                status = tool.main([str(word) for word in arguments])
            except SystemExit as ended:     # argparse
                status = ended.code
        return subprocess.CompletedProcess(arguments, status, out.getvalue(), err.getvalue())

    def plot(self, *arguments):
        return self.called(plot, *arguments)

    def assert_picture(self, done, path, told=True):
        printed = [str(path), *([str(path.with_suffix(".html"))] if told else [])]
        self.assertEqual((done.returncode, done.stderr, done.stdout.splitlines()), (0, "", printed))
        self.assertEqual(path.with_suffix(".html").exists(), told)
        head = path.read_bytes()[:24]
        self.assertEqual(head[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(struct.unpack(">II", head[16:]), (1200, 900))

    def test_a_csv_that_was_cut_off_is_drawn_with_a_word(self):
        done = self.plot(self.write("flight.csv", FLIGHT[:-30]))
        self.assertEqual(done.returncode, 0)
        self.assertIn("flight.csv: ends within a row, which is left out", done.stderr)

    def placed(self, name, xs, ys):
        rows = FLIGHT.split()
        return recording.read(self.write(name, "\n".join([f"{rows[0]},x_m,y_m", *(f"{row},{x},{y}" for row, x, y in zip(rows[1:], xs, ys))]) + "\n"))

    def test_the_way_flown_is_measured_along_the_ground_and_leaves_the_sway_of_a_hover_out(self):
        there = [0.01 * min(k, 100) for k in range(200)]                                # 1 m along x, then 1 m along y
        aside = [0.01 * max(k - 100, 0) for k in range(200)]
        way = plot.way_flown(self.placed("way.csv", there, aside))
        self.assertAlmostEqual(way[50], 0.5)
        self.assertAlmostEqual(way[-1], 1.99, delta=plot.STEP_M)
        self.assertEqual(way, sorted(way))
        sway = [0.015 * (-1) ** k for k in range(200)]
        self.assertIsNone(plot.way_flown(self.placed("hover.csv", sway, sway)))
        self.assertIsNone(plot.way_flown(recording.read(self.write("old.csv", FLIGHT))))

    def test_terrain_is_drawn_against_the_way_where_every_flight_goes_one(self):
        import matplotlib
        matplotlib.use("Agg")
        import matplotlib.pyplot as plt
        flies = self.placed("flies.csv", [0.01 * k for k in range(200)], [0.0] * 200)
        stays = self.placed("stays.csv", [0.0] * 200, [0.0] * 200)
        for recordings, label, end in (([flies], "way flown (m)", 1.99), ([flies, stays], "", None), ([stays], "", None)):
            figure, axis = plt.subplots()
            ways = plot.ways_flown(recordings)
            plot.draw_absolute(axis, recordings, ways, len(recordings) > 1)
            self.assertEqual((axis.get_xlabel(), ways is None), (label, end is None))
            if end:
                self.assertAlmostEqual(axis.get_xlim()[1], end, delta=plot.STEP_M)
            plt.close(figure)

    def test_the_program_draws_as_a_call_of_it_does(self):
        flown = self.write("flown.csv", RECORDER)
        self.assert_picture(self.program("plot", flown), self.dir / "flown.png")
        by_program = (self.dir / "flown.png").read_bytes()
        self.assert_picture(self.plot(flown), self.dir / "flown.png")
        self.assertEqual((self.dir / "flown.png").read_bytes(), by_program)

    @unittest.skipUnless(Path("/dev/full").exists(), "no /dev/full")
    def test_a_picture_that_cannot_be_written_is_status_2(self):
        (self.dir / "flight.png").symlink_to("/dev/full")
        done = self.program("plot", self.write("flight.csv", FLIGHT))
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("No space left", done.stderr)

    def test_every_kind_gives_a_picture(self):
        flight = self.write("flight.csv", FLIGHT)
        self.write("flight.json", '{"overshoot_mm": 12.5, "rise_time_s": null}')
        other = self.write("other.csv", FLIGHT.replace(",0.6,", ",0.5,"))
        self.assert_picture(self.plot(flight), self.dir / "flight.png")
        self.assert_picture(self.plot(flight, other, "-o", self.dir / "two/both.png"), self.dir / "two/both.png", told=False)
        log = self.console([f"02-05-2015 11:44:56.100,0,RECV,{(LINE + chr(10)).encode().hex()}",
                            "02-05-2015 11:44:56.150,0,SENT,23474554" + "0A"])
        self.assert_picture(self.plot(log, "-o", f"{self.dir}/"), self.dir / "console.png")
        text = self.write("text.txt", f"{LINE}\n{GAP}\n" * 4)
        self.assert_picture(self.plot(text), self.dir / "text.png")
        flown = self.write("flown.csv", RECORDER)
        self.assert_picture(self.plot(flown), self.dir / "flown.png")

    def test_the_page_beside_the_picture_says_each_event_where_its_mark_is(self):
        self.assert_picture(self.plot(self.write("flown.csv", RECORDER.replace("FLYING", "TAKEOFF", 10).replace("75.292,0.59", "75.292,0.89"))), self.dir / "flown.png")
        page = (self.dir / "flown.html").read_text(encoding="utf-8")
        marks = re.findall(r'<button data-kind="(\w+)" style="left:([\d.]+)%;top:([\d.]+)%" aria-label="([^"]*)"', page)
        self.assertEqual([(kind, text) for kind, _, _, text in marks],
                         [("takeoff", "70.0 s: Take-off to 0.60 m."), ("down", "75.3 s: An edge: the ground falls away by 0.30 m.")])
        across = [float(left) for _, left, _, _ in marks]
        self.assertAlmostEqual(across[0], 11.5, delta=0.1)      # the axis begins there
        self.assertAlmostEqual(across[1], 97.5, delta=0.3)      # and ends there: 75.292 is the last row
        self.assertEqual(re.findall(r"<li>(.*)</li>", page), [text for *_, text in marks])

    def test_names_in_a_file_are_no_html(self):
        self.plot(self.write("a<b>&.csv", RECORDER))
        self.assertIn("<h1>a&lt;b&gt;&amp;</h1>", (self.dir / "a<b>&.html").read_text(encoding="utf-8"))

    def test_what_another_law_would_have_commanded_is_drawn_as_open_loop(self):
        titles, *rows = FLIGHT.splitlines()
        replayed = self.write("replayed.csv", "\n".join([titles + ",flown_n", *(row + ",6.9" for row in rows)]) + "\n")
        title, words = plot.describe([replayed], [recording.read(replayed)])
        self.assertEqual(title, "replayed: open loop")
        self.assertIn("did not answer", words)
        self.assert_picture(self.plot(replayed), self.dir / "replayed.png")

    def test_the_colours_of_states_and_the_names_of_flags_are_the_firmwares(self):
        header = (ROOT / "control/where/flight_state.h").read_text(encoding="utf-8")
        states = {name for name in re.findall(r"\bFLIGHT_([A-Z]+),", header)}
        flags = {int(value) for value in re.findall(r"#define FLIGHT_FLAG_\w+[\s\\]+(\d+)U", header)}
        self.assertEqual(states, set(plot.STATE_COLOURS))
        self.assertEqual(flags, set(plot.FLAG_NAMES))

    def test_a_file_that_cannot_be_read_exits_2_with_one_line(self):
        junk = self.write("junk.txt", "hello\n")
        text = self.write("text.txt", f"{LINE}\n")
        for arguments, reason in (((junk,), "neither a flight CSV, an XCTU console log nor telemetry text"),
                                  ((self.dir / "none.csv",), "No such file"),
                                  ((text, text), "only CSVs of `plomada fly --csv` can be drawn together; draw each of these alone")):
            done = self.plot(*arguments)
            self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1), done.stderr)
            self.assertIn(reason, done.stderr)

    def test_an_output_that_is_no_picture_or_is_read_is_refused_and_nothing_changes(self):
        text = self.write("c2.txt", f"{LINE}\n" * 9)
        page = self.write("page.html", f"{LINE}\n" * 9)
        for file, output, reason in ((text, text, "no name of a picture"), (text, self.dir / "c2.jpeg.old", "no name of a picture"),
                                     (page, self.dir / "page.png", "page.html: is read here")):
            before = file.read_bytes()
            done = self.plot(file, "-o", output)
            self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1), done.stderr)
            self.assertIn(reason, done.stderr)
            self.assertEqual(file.read_bytes(), before)

    def a_program(self, script):
        path = self.write("program", f"#!/bin/sh\n{script}\n")
        path.chmod(0o755)
        return ("--program", path)

    def test_two_consoles_of_one_name_are_two_flights(self):
        drawn, files = [], []
        for name in ("x", "y"):
            (self.dir / name).mkdir()
            files.append(self.write(f"{name}/console.log", "OK LOG 1 74.3,0.6*0000\n"))
            self.write(f"{name}/console.log.csv", RECORDER)
        program = self.a_program('test ! -e "$4/console.csv" && cp "$2.csv" "$4/console.csv" && echo "$4/console.csv: 50 rows"')
        with unittest.mock.patch.object(plot, "groups", lambda found: drawn.extend(found) or []):
            self.assertEqual(self.plot(*files, *program).returncode, 0)
        self.assertEqual(len(set(drawn)), 2)

    def test_what_the_dump_lacks_is_told_of_the_file_that_was_typed(self):
        log = self.write("e.txt", "OK LOG 0 t_s,meas_m*0000\nOK LOG 1 7*0000\n")
        done = self.plot(log, *self.a_program('echo "$2, dump 1: the log is empty: not written" >&2; exit 2'))
        self.assertEqual((done.returncode, done.stderr), (2, f"plot: {log}, dump 1: the log is empty: not written\n"))

    def test_the_belief_is_drawn_from_a_flight_that_tells_it_and_from_no_other(self):
        titles, *rows = FLIGHT.splitlines()
        cells = ",".join(f"{mirror}_{what}" for mirror in ("mf", "m1", "m2") for what in ("mm", "lie"))
        told = self.write("told.csv", "\n".join([f"{titles},{cells}", *(f"{row},{',,,,,' if k % 10 else '400,99.9,800,0,810,0.1'}" for k, row in enumerate(rows))]) + "\n")
        out = self.dir / "belief.png"
        self.assertEqual(belief.told(recording.read(told), "mf_lie")[1][:2], [99.9, 99.9])
        for words, code in (((told, "-o", out, "--mark", "0.5 blocked", "--to", "1.5"), 0), ((self.write("front.csv", FLIGHT), "-o", out), 2),
                            ((self.dir / "none.csv",), 2), ((told, "-o", out, "--mark", "soon blocked"), 2)):
            done = self.called(belief, *words)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertEqual(bool(done.stderr), code == 2, done.stderr)
        self.assertEqual(out.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(self.program("belief", self.dir / "none.csv").returncode, 2)

    def test_stretches_of_equal_values(self):
        self.assertEqual(list(plot.runs([0, 1, 2, 3], "aabb")), [(0, 2, "a"), (2, 4, "b")])
        self.assertEqual(list(plot.runs([5], "a")), [(5, 6, "a")])

    def test_the_window_opens_1_s_before_the_first_reference(self):
        def rec(t, ref):
            return recording.Recording("x", "flight", {"t_s": t, "ref_m": ref})
        self.assertEqual(plot.window([rec([-11.0, 0.0, 1.0, 24.0], [0, 0, 0.6, 0])]), (0.0, 24.0))
        self.assertEqual(plot.window([rec([3.0, 4.0], [0, 0])]), (3.0, 4.0))
        self.assertEqual(plot.window([rec([3.0], [0.5])]), (3.0, 4.0))


if __name__ == "__main__":
    unittest.main()
