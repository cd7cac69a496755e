"""urg_library's and hokuyoaist's programs, unmodified, on the model of the sensor: what a URG-04LX can, they do; what it cannot, they say.

Usage: test_others.py PLOMADA, after `tools/setup/setup.sh others`.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PLOMADA = sys.argv.pop(1) if len(sys.argv) > 1 else str(ROOT / "build/plomada")
SOURCES = ROOT / "build/others"
ON_GROUND_MM, NOISE_MM = 205, 60    # of a single ray: the model's noise is 10 mm
PATIENCE_S = 60


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], check=False, capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


class Programs(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not (SOURCES / "flexiport/.git").is_dir():     # the last that is fetched
            raise unittest.SkipTest("no build/others: tools/setup/setup.sh others")
        cls.folder = tempfile.TemporaryDirectory()
        cls.top = Path(cls.folder.name)
        for name in ("urg_library", "hokuyoaist", "flexiport"):
            shutil.copytree(SOURCES / name, cls.top / name, ignore=shutil.ignore_patterns(".git"))
        cls.link = cls.top / "urg"
        cls.samples = cls.top / "urg_library/current/samples"
        run("make", "-C", cls.samples.parent / "src")
        run("make", "-C", cls.samples)
        cls.flexiport()

    @classmethod
    def flexiport(cls):
        for name, more in (("flexiport", ["-DBUILD_EXAMPLES=OFF", "-DFLEXIPORT_INCLUDE_BT=OFF"]), ("hokuyoaist", ["-DBUILD_PYTHON_BINDINGS=OFF"])):
            run("cmake", "-S", cls.top / name, "-B", cls.top / name / "b", "-DBUILD_DOCUMENTATION=OFF", f"-DCMAKE_PREFIX_PATH={cls.top}",
                f"-DFlexiport_DIR={cls.top}/share/flexiport-2", f"-DCMAKE_INSTALL_PREFIX={cls.top}", *more)
            run("cmake", "--build", cls.top / name / "b")
            run("cmake", "--install", cls.top / name / "b")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def on_the_sensor(self, command, *options):
        """(status, what it said) of a program while the model serves the link."""
        with subprocess.Popen([PLOMADA, "laser", "--link", self.link, *options], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              text=True) as sensor:
            sensor.stdout.readline()
            done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, timeout=PATIENCE_S,
                                  env={**os.environ, "LD_LIBRARY_PATH": f"{self.top}/lib"})
            sensor.terminate()
        return done.returncode, done.stdout + done.stderr

    def sample(self, name, *options):
        return self.on_the_sensor([self.samples / name, "-s", self.link], *options)

    def example(self, *words, model=()):
        port = f"type=serial,device={self.link},baud=115200,timeout=1"
        return self.on_the_sensor([self.top / "bin/hokuyoaist_example", *words, "-o", port], "--burst", *model)

    def test_urg_librarys_samples_show_distances_and_their_times(self):
        for name in ("c/get_distance", "c/get_distance_handshake", "cpp/get_distance", "cpp/get_distance_handshake"):
            with self.subTest(name):
                status, said = self.sample(name)
                rows = re.findall(r"^(\d+) \[mm\], \((\d+) \[msec\]\)$", said, re.MULTILINE)
                self.assertEqual((status, len(rows)), (0, 10), said)
                for distance, _ in rows:
                    self.assertAlmostEqual(int(distance), ON_GROUND_MM, delta=NOISE_MM)
                stamps = [int(stamp) for _, stamp in rows]
                self.assertEqual(stamps, sorted(set(stamps)))

    def test_urg_librarys_samples_draw_a_scan_and_read_the_clock(self):
        status, said = self.sample("c/calculate_xy")
        self.assertEqual(status, 0)
        self.assertGreater(len(re.findall(r"^-?\d+, -?\d+$", said, re.MULTILINE)), 100)
        for name in ("c/sync_time_stamp", "cpp/sync_time_stamp"):
            status, said = self.sample(name)
            self.assertEqual((status, len(re.findall(r"^\d+,\s+\d+$", said, re.MULTILINE))), (0, 6), said)

    def test_urg_librarys_samples_know_the_sensor(self):
        for name in ("c/sensor_parameter", "cpp/sensor_parameter"):
            status, said = self.sample(name)
            self.assertEqual(status, 0, said)
            for words in ("SOKUIKI Sensor URG-04LX", "3.1.04", "Sensor works well.", "100000 [usec]"):
                self.assertIn(words, said, name)
        status, said = self.sample("c/angle_convert_test")
        self.assertEqual((status, "urg_step2deg(341): 119.882812" in said), (0, True), said)
        self.assertEqual(self.sample("c/reboot_test")[0], 0)    # RB is refused, and it does not say so
        self.assertEqual(self.sample("c/timeout_test")[0], 0)

    def test_what_no_urg_04lx_can_is_refused_and_said(self):
        for name in ("get_distance_intensity", "get_multiecho", "get_multiecho_intensity"):
            self.assertEqual(self.sample(f"c/{name}"), (1, f"urg_{name}: invalid response.\n"))
        status, said = self.example("-i")
        self.assertEqual(status, 1)
        self.assertIn("Command: ME Error : (0E)", said)

    def test_hokuyoaists_example_reads_scans_whole_and_in_clusters(self):
        for words, model, points in (((), (), 682), (("-c", "3"), ("--round-down",), 227)):
            status, said = self.example(*words, model=model)
            self.assertEqual(status, 0, said)
            self.assertIn("Sensor diagnostic: Sensor works well.", said)
            self.assertIn(f"{points} ranges", said)

    def test_hokuyoaists_recordings_of_three_sensors_are_read(self):
        for name, sensor, points, unread in (("urg_04lx", "URG-04LX", 682, None), ("utm_30lx", "UTM-30LX", None, "ME           2"),
                                             ("uxm_30lx_e", "UXM-30LX-E", 761, None)):
            done = subprocess.run([PLOMADA, "scip", "decode", self.top / f"hokuyoaist/examples/example_{name}.logr"], capture_output=True,
                                  text=True, check=False)
            rows = [line.count(",") for line in done.stdout.splitlines()[1:]]
            self.assertEqual(rows, [points] if points else [], name)
            self.assertIn(f"sensor: {sensor}(Hokuyo Automatic Co.,Ltd.)", done.stderr)
            self.assertIn("damaged: 0 ", done.stderr)
            self.assertIn(unread or "", done.stderr)


if __name__ == "__main__":
    unittest.main(verbosity=2)
