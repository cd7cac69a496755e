"""examples/ros2 against stand-ins of rclcpp and of the message, on the model of a URG-04LX; by colcon where ROS 2 is installed.

Usage: test_ros2.py PLOMADA [--colcon]
"""
import math
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
NODE = ROOT / "examples/ros2"
COLCON = "--colcon" in sys.argv
PLOMADA = next((word for word in sys.argv[1:] if word != "--colcon"), str(ROOT / "build/plomada"))
ON_GROUND_M, NOISE_M = 0.205, 0.06


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], check=False, capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


class OnStandIns(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.top = Path(cls.folder.name)
        run("cmake", "-S", ROOT / "tools/scip_package", "-B", cls.top / "out", "-DPLOMADA_SCIP_EXAMPLES=OFF")
        run("cmake", "--build", cls.top / "out")
        include = ["-I", cls.top / "out/plomada_scip/src", "-I", ROOT / "examples/scanner", "-I", NODE / "src"]
        objects = []
        for source in (ROOT / "examples/scanner/posix.c", NODE / "src/laser_scan.c"):
            objects.append(cls.top / f"{source.stem}.o")
            run("cc", "-std=gnu99", "-Wall", "-Wextra", "-Werror", *include, "-c", source, "-o", objects[-1])
        run("c++", "-std=c++17", "-Wall", "-Wextra", "-Werror", *include, "-I", HERE / "ros2", NODE / "src/scan_node.cpp", *objects,
            cls.top / "out/libplomada_scip.a", "-lm", "-o", cls.top / "scan_node")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def messages(self, count, *parameters):
        """(arrival ns, the numbers) of so many messages."""
        link, found = self.top / "urg", []
        words = [word for name in parameters for word in ("-p", name)]
        with subprocess.Popen([PLOMADA, "laser", "--link", link, "--rate", "19200"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                              text=True) as sensor:
            sensor.stdout.readline()
            with subprocess.Popen([self.top / "scan_node", "--ros-args", "-p", f"device:={link}", *words], stdout=subprocess.PIPE,
                                  stderr=subprocess.PIPE, text=True) as node:
                for _ in range(count):
                    line = node.stdout.readline()
                    found.append((time.monotonic_ns(), line.split()))
                node.terminate()
                self.said = node.stderr.read()
            sensor.terminate()
        return found

    def test_a_urg_04lx_is_published_whole_with_the_time_of_its_rays(self):
        found = self.messages(8, "bit_rate:=250000", "cluster:=2", "frame_id:=nose")
        self.assertIn("SOKUIKI Sensor URG-04LX, H0706400", self.said)
        stamps = [int(words[0]) for _, words in found]
        for (arrived, words), stamp in zip(found, stamps):
            angle_min, angle_max, increment, ray_s, turn_s, range_min, range_max = map(float, words[2:9])
            self.assertEqual((words[1], len(words) - 9), ("nose", 341))
            self.assertAlmostEqual(angle_min, (44.5 - 384) * 2 * math.pi / 1024, places=4)
            self.assertAlmostEqual(angle_max, angle_min + 340 * increment, places=4)
            self.assertAlmostEqual(ray_s, 0.1 / 512, places=8)
            self.assertEqual((turn_s, range_min, range_max), (0.1, 0.02, 5.6))
            ahead = float(words[9 + round(-angle_min / increment)])
            self.assertAlmostEqual(ahead, ON_GROUND_M, delta=NOISE_M)
            # The rest of the turn behind step 44, and 1080 octets at 250000 bit/s; the line is read some milliseconds later.
            self.assertGreater(arrived - stamp, 95_000_000 + 40_000_000)
        gaps = sorted(later - earlier for earlier, later in zip(stamps, stamps[1:]))
        self.assertAlmostEqual(gaps[len(gaps) // 2] / 1e9, 0.1, delta=0.03)

    def test_an_order_that_no_sensor_takes_ends_it_with_the_cause(self):
        for parameter, cause in (("bit_rate:=38400", "stream_rate is not a rate of SCIP"), ("cluster:=100", "are impossible")):
            done = subprocess.run([self.top / "scan_node", "--ros-args", "-p", parameter], capture_output=True, text=True, check=False)
            self.assertEqual(done.returncode, 1)
            self.assertIn(cause, done.stderr)

    def test_what_is_no_distance_is_infinity_or_no_number(self):
        program = self.top / "ranges.c"
        program.write_text("""#include "laser_scan.h"
#include <stdio.h>
int main(void)
{
    uint16_t row[] = {0, 19, 20, 4094, 4095, 5600, 5601};
    scip_scan_t scan = {.distance_mm = row, .points = 7, .characters = 2, .cluster = 1, .first_step = 384};
    for (uint16_t i = 0; i < 7; i++) { printf("%.3f ", laser_scan_range(&scip_limits_urg04lx, &scan, i)); }
    scan.characters = 3;
    printf("%.3f %u", laser_scan_range(&scip_limits_urg04lx, &scan, 4), (unsigned)laser_scan_shape(&scip_limits_urg04lx, &scan, 0).first_ray_age_us);
    return 0;
}
""", encoding="utf-8")
        run("cc", "-std=gnu99", "-I", self.top / "out/plomada_scip/src", "-I", NODE / "src", program, NODE / "src/laser_scan.c",
            self.top / "out/libplomada_scip.a", "-lm", "-o", self.top / "ranges")
        self.assertEqual(run(self.top / "ranges").replace("-nan", "nan"), "nan nan 0.020 4.094 inf 5.600 inf 4.095 62500")


class ByColcon(unittest.TestCase):
    def test_colcon_builds_it(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "src").mkdir()
            (Path(folder) / "src/plomada_scip_ros").symlink_to(NODE)
            run("colcon", "build", cwd=folder)
            self.assertTrue((Path(folder) / "install/plomada_scip_ros/lib/plomada_scip_ros/scan_node").is_file())


if __name__ == "__main__":
    if COLCON and shutil.which("colcon") is None:
        print("no ROS 2 here: Debian has none, its own archive has")
        sys.exit(77)
    unittest.main(argv=[sys.argv[0], "ByColcon" if COLCON else "OnStandIns"], verbosity=2)
