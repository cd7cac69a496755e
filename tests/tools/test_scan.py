"""tools/plot/scan.py: what the program decodes is where the picture's data has it; a picture of a recording, of a log, of a
live sensor; nothing to draw. Argument: the program plomada."""
import contextlib
import io
import math
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/plot"))
import numpy  # noqa: E402
import scan  # noqa: E402

PROGRAM = sys.argv.pop(1)
FIXTURES = ROOT / "tests/fixtures/scip"


def is_picture(path):
    return path.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n" and path.stat().st_size > 20000


class Case(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)

    def run_scan(self, *arguments):
        said, complained = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
            status = scan.main([*map(str, arguments), "--program", PROGRAM])
        return status, said.getvalue(), complained.getvalue()

    def test_every_distance_stands_at_its_time_and_direction(self):
        scans, _ = scan.read(PROGRAM, str(FIXTURES / "md_beams.bin"), 0)
        rows = [list(map(int, line.split(","))) for line in (FIXTURES / "md_beams.csv").read_text().splitlines()]
        self.assertEqual(scans.distance_m.shape, (len(rows), 271))
        for i, row in enumerate(rows):
            self.assertAlmostEqual(scans.time_s[i], row[0] / 1000)
            for k, mm in enumerate(row[2:]):
                self.assertAlmostEqual(scans.angle_deg[k], (249 + k - 384) * 360 / 1024, delta=0.00051)
                if mm < 20:
                    self.assertTrue(math.isnan(scans.distance_m[i, k]))
                else:
                    self.assertAlmostEqual(scans.distance_m[i, k], mm / 1000)

    def test_scans_of_other_steps_leave_gaps(self):
        table = numpy.array([[1.0, 5, -1, 500], [1.0, 6, 0, 19], [2.0, 6, 0, 4095], [2.0, 7, 1, 700]]).T
        scans = scan.Scans(table)
        self.assertEqual(list(scans.angle_deg), [-1, 0, 1])
        numpy.testing.assert_array_equal(scans.distance_m, [[0.5, math.nan, math.nan], [math.nan, math.nan, 0.7]])
        numpy.testing.assert_array_equal(scans.median_m(), [0.5, math.nan, 0.7])

    def test_a_recording_becomes_a_picture_beside_it_or_where_it_is_asked_for(self):
        source = self.dir / "room.bin"
        shutil.copy(FIXTURES / "ms_front.bin", source)
        status, said, _ = self.run_scan(source)
        self.assertEqual((status, said), (0, str((self.dir / "room.bin.png").resolve()) + "\n"))
        self.assertTrue(is_picture(self.dir / "room.bin.png"))
        self.assertEqual(self.run_scan(source, "-o", self.dir / "other.png")[0], 0)
        self.assertTrue(is_picture(self.dir / "other.png"))

    def test_one_scan_and_one_step_can_be_drawn(self):
        frame = b"MS0384038401000\n99b\n00000\nGPG\n\n"
        for name, octets in {"one.bin": frame, "two.bin": frame + frame.replace(b"00000", b"000AA")}.items():
            (self.dir / name).write_bytes(octets)
            self.assertEqual(self.run_scan(self.dir / name)[0], 0)
            self.assertTrue(is_picture(self.dir / (name + ".png")))

    def test_nothing_to_draw_is_said_and_no_picture_made(self):
        for octets in (b"", b"a shopping list\n", b"VV\n00P\n\n"):
            (self.dir / "empty.bin").write_bytes(octets)
            status, said, complained = self.run_scan(self.dir / "empty.bin")
            self.assertEqual((status, said), (2, ""))
            self.assertTrue(complained.startswith(f"scan: {self.dir}/empty.bin: no scan in it; it is to be a recording of `plomada scip record`"), complained)
        self.assertIn("VV           1", complained)
        self.assertEqual(self.run_scan(self.dir / "nowhere")[0], 2)
        self.assertEqual(list(self.dir.glob("*.png")), [])

    def test_a_picture_never_lies_over_its_recording_and_has_the_name_of_one(self):
        source = self.dir / "room.png"
        shutil.copy(FIXTURES / "ms_front.bin", source)
        before = source.read_bytes()
        for output, reason in ((source, "room.png: is read here; another -o"), (self.dir / "x.bin", "x.bin: no name of a picture"), (self.dir / "x", "x: no name of a picture")):
            status, said, complained = self.run_scan(source, "-o", output)
            self.assertEqual((status, said), (2, ""))
            self.assertIn(reason, complained)
        self.assertEqual([path.name for path in self.dir.iterdir()], ["room.png"])
        self.assertEqual(source.read_bytes(), before)

    def test_a_live_sensor_is_recorded_and_drawn(self):
        link = self.dir / "urg"
        with subprocess.Popen([PROGRAM, "laser", "--link", link, "--height", "0.4"], stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL) as server:
            try:
                while not link.exists():
                    time.sleep(0.01)
                status = self.run_scan(link, "--seconds", "0.5", "-o", self.dir / "live.png")[0]
            finally:
                server.terminate()
        self.assertEqual(status, 0)
        self.assertTrue(is_picture(self.dir / "live.png"))


if __name__ == "__main__":
    unittest.main()
