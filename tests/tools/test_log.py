"""plomada log: dumps of #LOG in what people really save. Usage: test_log.py PLOMADA"""
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM = None
TITLES = "t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags"
ROWS = [TITLES] + [f"{74 + 0.045 * k:.3f},0.598,0.598,,0.600,7.123,-0.0123,0.0345,FLYING,{k % 2}" for k in range(30)]
CSV = "".join(row + "\n" for row in ROWS)
TELEMETRY = "alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0"


def line_sum(text):
    """CRC-16/CCITT-FALSE by long division, apart from the firmware's."""
    register = 0xFFFF
    for octet in text.encode("ascii"):
        register ^= octet << 8
        for _ in range(8):
            register = (register << 1) ^ (0x11021 if register & 0x8000 else 0)
    return f"{register:04X}"


def dump(rows=ROWS, leave_out=(), end=True):
    lines = [f"OK LOG records:{len(rows) - 1}"]
    for number, row in enumerate(rows):
        line = f"OK LOG {number} {row}"
        if number not in leave_out:
            lines.append(f"{line}*{line_sum(line)}")
        if number % 7 == 3:
            lines.append(TELEMETRY)
    return lines + ([f"OK LOG END lines:{len(rows)}"] if end else [])


def text(lines):
    return "".join(line + "\r\n" for line in lines)


def console(octets, size=17):
    """As XCTU saves a console: its packets end anywhere."""
    rows = ['02-05-2015 23:59:58.000,-,AT,"Plomada,0013A2004031A8D7,XBee,10EF,COM4 - 9600/8/N/1/N"',
            "02-05-2015 23:59:58.500,0,SENT," + b"#LOG\n".hex().upper()]
    for at in range(0, len(octets), size):
        rows.append(f"02-05-2015 23:59:59.{at % 1000:03d},{at},RECV,{octets[at:at + size].hex().upper()}")
    return "\n".join(rows) + "\n"


class Log(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)

    def log(self, name, content, *options):
        (self.dir / name).write_bytes(content.encode("latin-1"))
        return subprocess.run([PROGRAM, "log", name, *options], cwd=self.dir, capture_output=True, text=True, check=False)

    def test_a_flight_that_is_not_down_yet_at_its_end_is_dumped_when_its_motors_stand(self):
        """#LOG was typed while it landed, and up to 55 of the rows that it had announced were overwritten on the way."""
        (self.dir / "short.scenario").write_text("like est-60cm-ramp\nname short\nland 30\nend 30.5\n", encoding="utf-8")
        flown = subprocess.run([PROGRAM, "fly", "short.scenario", "--log", "short.log"], cwd=self.dir, capture_output=True, text=True, check=False)
        self.assertIn(flown.returncode, (0, 1), flown.stderr)
        told = subprocess.run([PROGRAM, "log", "short.log"], cwd=self.dir, capture_output=True, text=True, check=False)
        self.assertEqual(told.returncode, 0, told.stdout + told.stderr)

    def written(self, name):
        return (self.dir / name).read_text(encoding="ascii")

    def test_the_sum_is_that_of_the_catalogue(self):
        self.assertEqual(line_sum("123456789"), "29B1")     # CRC RevEng catalogue, CRC-16/IBM-3740

    def test_a_terminals_text_and_an_xctu_console_give_the_same_csv(self):
        lines = [TELEMETRY, "OK KP 0.015", *dump(), TELEMETRY]
        for name, content in (("a.txt", text(lines)), ("b.txt", text(lines).replace("\r\n", "\n")),
                              ("c.log", console(text(lines).encode())), ("d.log", console(text(lines).encode(), 1)),
                              ("e.log", console(b"\0\0" + text(lines).encode(), 200)),
                              # what precedes XCTU's own header, and a log that lacks it
                              ("f.log", "\n" + console(text(lines).encode())), ("g.log", "XCTU, flight 3\r\n\n" + console(text(lines).encode())),
                              ("h.log", "\xef\xbb\xbf" + console(text(lines).encode())),
                              ("i.log", console(text(lines).encode()).split("\n", 1)[1])):
            done = self.log(name, content)
            self.assertEqual((done.returncode, done.stderr), (0, ""), name)
            self.assertEqual(self.written(Path(name).stem + ".csv"), CSV, name)

    def test_two_dumps_make_two_files_also_when_the_second_announcement_was_lost(self):
        later = [TITLES, *ROWS[10:]]
        for second in (dump(later), dump(later)[1:]):
            done = self.log("two.txt", text(dump() + second), "--force")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual(self.written("two.csv"), CSV)
            self.assertEqual(self.written("two-2.csv"), "".join(row + "\n" for row in later))

    def test_missing_rows_are_named_and_nothing_is_put_in_their_place(self):
        done = self.log("gap.txt", text(dump(leave_out=(4, 9, 10, 11))))
        self.assertEqual(done.returncode, 1)
        self.assertIn("gap.txt, dump 1: 4 of 31 rows are missing: 4 9..11\n", done.stderr)
        self.assertEqual(self.written("gap.csv"), "".join(row + "\n" for n, row in enumerate(ROWS) if n not in (4, 9, 10, 11)))

    def test_a_damaged_row_is_left_out_whatever_octet_of_it_changed(self):
        good = text(dump())
        row = f"OK LOG 12 {ROWS[12]}*"
        at = good.index(row)
        for offset in range(len("OK LOG "), len(row) + 4):
            octet = "7" if good[at + offset] != "7" else "8"
            done = self.log("bad.txt", good[:at + offset] + octet + good[at + offset + 1:], "--force")
            self.assertEqual(done.returncode, 1, offset)
            self.assertEqual(self.written("bad.csv"), "".join(r + "\n" for n, r in enumerate(ROWS) if n != 12), offset)

    def test_a_file_that_ends_within_a_row_says_so(self):
        whole = text(dump())
        cut = whole[:whole.index("OK LOG 20 ") + 30]
        done = self.log("cut.txt", cut)
        self.assertEqual(done.returncode, 1)
        self.assertIn("ends within a row", done.stderr)
        self.assertIn("11 of 31 rows are missing: 20..30", done.stderr)
        self.assertEqual(self.written("cut.csv"), "".join(row + "\n" for row in ROWS[:20]))

    def test_stdout_directories_and_names(self):
        done = self.log("a.txt", text(dump()), "-o", "-")
        self.assertEqual((done.returncode, done.stdout), (0, CSV))
        (self.dir / "out").mkdir()
        self.assertEqual(self.log("a.txt", text(dump()), "-o", "out").returncode, 0)
        self.assertEqual(self.written("out/a.csv"), CSV)
        done = self.log("console.csv", console(text(dump()).encode()))      # never over what it reads
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.written("console-log.csv"), CSV)
        self.assertEqual(self.log("a.txt", text(dump() + dump()), "-o", "-").returncode, 2)

    def plomada(self, *words):
        return subprocess.run([PROGRAM, "log", *words], cwd=self.dir, capture_output=True, text=True, check=False)

    def test_two_flights_of_one_name_do_not_become_one_file(self):
        for folder in ("x", "y", "out"):
            (self.dir / folder).mkdir()
        (self.dir / "x/console.log").write_text(text(dump()))
        (self.dir / "y/console.log").write_text(text(dump(ROWS[:9])))
        for force in ((), ("--force",)):
            done = self.plomada("x/console.log", "y/console.log", "-o", "out", *force)
            self.assertEqual(done.returncode, 2)
            self.assertIn("plomada log: out/console.csv: two dumps would have this name", done.stderr)
            self.assertEqual(list((self.dir / "out").iterdir()), [])
        self.assertEqual(self.plomada("x/console.log", "y/console.log").returncode, 0)
        self.assertEqual(self.written("x/console.csv"), CSV)
        (self.dir / "x/again.log").write_text(text(dump()))
        self.assertEqual(self.plomada("x/console.log", "x/again.log", "-o", "-").returncode, 2)

    def test_another_log_that_is_there_is_not_replaced_unasked_and_the_same_one_is_no_fault(self):
        (self.dir / "a.csv").write_text("what fly --csv wrote\n")
        (self.dir / "b.txt").write_text(text(dump()))
        (self.dir / "a.txt").write_text(text(dump()))
        done = self.plomada("b.txt", "a.txt")
        self.assertEqual(done.returncode, 2)
        self.assertIn("plomada log: a.csv: is there already, and is another log", done.stderr)
        self.assertEqual((self.written("a.csv"), (self.dir / "b.csv").exists()), ("what fly --csv wrote\n", False))
        for force in (("--force",), ()):
            self.assertEqual(self.plomada("a.txt", *force).returncode, 0)
            self.assertEqual(self.written("a.csv"), CSV)

    def test_a_file_that_is_read_is_never_written(self):
        (self.dir / "a.csv").symlink_to("a.txt")
        (self.dir / "a.txt").write_text(text(dump()))
        before = (self.dir / "a.txt").read_bytes()
        done = self.plomada("a.txt", "--force")
        self.assertEqual((done.returncode, done.stderr), (2, "plomada log: a.csv: is read here; -o DIR writes elsewhere\n"))
        self.assertEqual((self.dir / "a.txt").read_bytes(), before)

    def test_an_empty_log_is_named_and_not_written(self):
        for rows, leave_out, reason in ((ROWS[:1], (), "the log is empty"), (ROWS, range(1, len(ROWS)), "none of its records came")):
            done = self.log("e.txt", text(dump(rows, leave_out)))
            self.assertEqual(done.returncode, 2)
            self.assertIn(f"e.txt, dump 1: {reason}: not written\n", done.stderr)
            self.assertFalse((self.dir / "e.csv").exists())
        done = self.log("f.txt", text(dump(ROWS[:1]) + dump()))
        self.assertEqual((done.returncode, done.stderr), (1, "f.txt, dump 1: the log is empty: not written\n"))
        self.assertEqual((self.written("f-2.csv"), (self.dir / "f.csv").exists()), (CSV, False))

    def test_nothing_to_read_is_an_error(self):
        done = self.log("t.txt", TELEMETRY + "\n")
        self.assertEqual((done.returncode, done.stderr), (2, "plomada log: t.txt: no row of a #LOG dump in it\n"))
        done = subprocess.run([PROGRAM, "log", self.dir / "none"], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertEqual(subprocess.run([PROGRAM, "log"], capture_output=True, check=False).returncode, 2)


if __name__ == "__main__":
    PROGRAM = str(Path(sys.argv.pop(1)).resolve())
    unittest.main()
