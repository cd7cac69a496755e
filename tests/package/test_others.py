"""urg_library's and hokuyoaist's programs, unmodified, on the model of the sensor and on a sensor of another hand
(tests/examples/hokuyo.py): what a URG-04LX can, they do; what it cannot, they say.

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
HOKUYO = ROOT / "tests/examples/hokuyo.py"
PATIENCE_S = 60


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], check=False, capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


class Built:
    """The programs, once for all tests."""
    folder = top = samples = None


def setUpModule():
    if not (SOURCES / "flexiport/.git").is_dir():     # the last that is fetched
        raise unittest.SkipTest("no build/others: tools/setup/setup.sh others")
    Built.folder = tempfile.TemporaryDirectory()
    Built.top = Path(Built.folder.name)
    unittest.addModuleCleanup(Built.folder.cleanup)
    for name in ("urg_library", "hokuyoaist", "flexiport"):
        shutil.copytree(SOURCES / name, Built.top / name, ignore=shutil.ignore_patterns(".git"))
    Built.samples = Built.top / "urg_library/current/samples"
    run("make", "-C", Built.samples.parent / "src")
    run("make", "-C", Built.samples)
    for name, more in (("flexiport", ["-DBUILD_EXAMPLES=OFF", "-DFLEXIPORT_INCLUDE_BT=OFF"]), ("hokuyoaist", ["-DBUILD_PYTHON_BINDINGS=OFF"])):
        build = Built.top / name / "b"
        run("cmake", "-S", Built.top / name, "-B", build, "-DBUILD_DOCUMENTATION=OFF", f"-DCMAKE_PREFIX_PATH={Built.top}",
            f"-DFlexiport_DIR={Built.top}/share/flexiport-2", f"-DCMAKE_INSTALL_PREFIX={Built.top}", *more)
        run("cmake", "--build", build)
        run("cmake", "--install", build)


class Programs:
    """sensor: the command that serves it on a link. The others: what it shows."""
    sensor, firmware = [], ""
    nearest_mm = farthest_mm = 0
    was_late = False

    @property
    def failureException(self):
        """What an assertion raises: urg_library waits 140 ms, so of a sensor that this machine made late nothing is known."""
        return unittest.SkipTest if self.was_late else AssertionError

    def on_the_sensor(self, command, *options):
        """(status, what it said) of a program while the sensor serves the link."""
        with subprocess.Popen([*self.sensor, "--link", Built.top / "urg", *options], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              text=True) as sensor:
            sensor.stdout.readline()
            done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, timeout=PATIENCE_S,
                                  env={**os.environ, "LD_LIBRARY_PATH": f"{Built.top}/lib"})
            sensor.terminate()
            behind = re.search(r"^behind (\d+) ms", sensor.stdout.read(), re.MULTILINE)     # hokuyo.py says so
        self.was_late = self.was_late or (behind is not None and int(behind.group(1)) > 0)
        return done.returncode, done.stdout + done.stderr

    def sample(self, name, *options):
        return self.on_the_sensor([Built.samples / name, "-s", Built.top / "urg"], *options)

    def example(self, *words, options=()):
        """It takes an answer to TM1 that comes in two parts for a fault: octets in packets, as from the sensor's own USB plug."""
        port = f"type=serial,device={Built.top / 'urg'},baud=115200,timeout=1"
        return self.on_the_sensor([Built.top / "bin/hokuyoaist_example", *words, "-o", port], "--burst", *options)

    def assert_example_reads(self, points, *words, options=()):
        status, said = self.example(*words, options=options)
        self.assertEqual(status, 0, said)
        self.assertIn("Sensor diagnostic: Sensor works well.", said)
        self.assertIn(f"{points} ranges", said)

    def test_urg_librarys_samples_show_distances_and_their_times(self):
        for name in ("c/get_distance", "c/get_distance_handshake", "cpp/get_distance", "cpp/get_distance_handshake"):
            with self.subTest(name):
                status, said = self.sample(name)
                rows = re.findall(r"^(\d+) \[mm\], \((\d+) \[msec\]\)$", said, re.MULTILINE)
                self.assertEqual((status, len(rows)), (0, 10), said)
                for distance, _ in rows:
                    self.assertTrue(self.nearest_mm <= int(distance) <= self.farthest_mm, said)
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
            for words in ("SOKUIKI Sensor URG-04LX", self.firmware, "Sensor works well.", "100000 [usec]"):
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

    def test_hokuyoaists_example_reads_whole_scans(self):
        self.assert_example_reads(682)


class OnTheModel(Programs, unittest.TestCase):
    sensor = [PLOMADA, "laser"]
    firmware = "3.1.04"
    nearest_mm, farthest_mm = 145, 265      # on the ground 205; the noise of a ray is 10 mm

    def test_hokuyoaists_example_reads_scans_in_clusters(self):
        self.assert_example_reads(227, "-c", "3", options=["--round-down"])

    def test_hokuyoaists_recordings_of_three_sensors_are_read(self):
        for name, sensor, points, unread in (("urg_04lx", "URG-04LX", 682, None), ("utm_30lx", "UTM-30LX", None, "ME           2"),
                                             ("uxm_30lx_e", "UXM-30LX-E", 761, None)):
            done = subprocess.run([PLOMADA, "scip", "decode", Built.top / f"hokuyoaist/examples/example_{name}.logr"], capture_output=True,
                                  text=True, check=False)
            rows = [line.count(",") for line in done.stdout.splitlines()[1:]]
            self.assertEqual(rows, [points] if points else [], name)
            self.assertIn(f"sensor: {sensor}(Hokuyo Automatic Co.,Ltd.)", done.stderr)
            self.assertIn("damaged: 0 ", done.stderr)
            self.assertIn(unread or "", done.stderr)


class OnASensorOfAnotherHand(Programs, unittest.TestCase):
    sensor = [sys.executable, "-B", str(HOKUYO), "--rate", "115200", "--boot-ms", "0", "--first-reply-ms", "100"]
    firmware = "3.2.00"
    nearest_mm = farthest_mm = 1384         # distance_mm() of hokuyo.py, straight ahead

    def test_urg_library_does_not_wait_for_a_first_answer_of_381_ms_and_hokuyoaist_does(self):
        late = ["--first-reply-ms", "381"]
        status, said = self.sample("c/get_distance", *late)
        self.assertEqual((status, said.endswith("could not detect serial baudrate.\n")), (1, True), said)
        self.assert_example_reads(682, options=late)


if __name__ == "__main__":
    unittest.main(verbosity=2)
