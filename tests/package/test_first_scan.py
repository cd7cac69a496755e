"""drivers/README.md, "From nothing to a scan": every line that begins with $ is run, in the page's order, in a copy of the repository.

Usage: test_first_scan.py PLOMADA. The device is the model of the sensor behind a pseudo-terminal; the project of PlatformIO is an
empty one; FreeRTOS is its declarations in freertos/.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PLOMADA = sys.argv.pop(1) if len(sys.argv) > 1 else str(ROOT / "build/plomada")
PIO = ROOT / "build/pio/bin"
DEVICE = "/dev/ttyACM0"
SCREEN = 60     # lines


def section():
    return (ROOT / "drivers/README.md").read_text(encoding="utf-8").split("\n## From nothing to a scan\n")[1].split("\n## ")[0]


def commands():
    return re.findall(r"^\$ (.*)$", section(), re.MULTILINE)


class ThePage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        for program in (PIO / "pio", "arm-none-eabi-gcc"):
            if shutil.which(program) is None:
                raise unittest.SkipTest(f"no {program}: tools/setup/setup.sh package")
        cls.folder = tempfile.TemporaryDirectory()
        cls.top = Path(cls.folder.name)
        cls.clone = cls.top / "clone"
        for name in ("drivers", "docs", "examples", "tools/scip_package"):
            shutil.copytree(ROOT / name, cls.clone / name)
        shutil.copy(ROOT / "LICENSE", cls.clone)
        (cls.top / "my_project").mkdir()
        (cls.top / "my_project/platformio.ini").write_text("[env:mega]\nplatform = atmelavr\nboard = megaatmega2560\nframework = arduino\n",
                                                           encoding="utf-8")
        cls.environment = {**os.environ, "HOME": str(cls.top), "PATH": f"{PIO}:{os.environ['PATH']}", "FREERTOS": str(HERE / "freertos"),
                           "PLATFORMIO_SETTING_ENABLE_TELEMETRY": "no"}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_it(self, command):
        done = subprocess.run(["bash", "-c", command], cwd=self.clone, env=self.environment, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, f"{command}\n{done.stdout}{done.stderr}")

    def scan(self, command):
        """Three distances."""
        link = self.top / "urg"
        with subprocess.Popen([PLOMADA, "laser", "--link", link, "--rate", "19200", "--height", "0.8"], stdout=subprocess.PIPE,
                              stderr=subprocess.DEVNULL, text=True) as sensor:
            sensor.stdout.readline()
            with subprocess.Popen(command.replace(DEVICE, str(link)).split(), cwd=self.clone, stdout=subprocess.PIPE, text=True) as scanner:
                for _ in range(3):
                    self.assertRegex(scanner.stdout.readline(), r"^\d+ mm\n$")
                scanner.terminate()
            sensor.terminate()

    def test_every_line_of_it_does_what_it_says(self):
        for command in commands():
            with self.subTest(command):
                if DEVICE in command:
                    self.scan(command)
                else:
                    self.run_it(command)
        self.assertTrue(list((self.top / "my_project/.pio/libdeps/mega/plomada_scip/src").glob("plomada_scip.h")))
        self.assertEqual(len(list((self.clone / "out/plomada_scip").glob("*.o"))), 8)

    def test_the_sketch_is_a_program_for_platformio_with_its_include(self):
        sketch = (ROOT / "examples/FirstDistance/FirstDistance.ino").read_text(encoding="utf-8")
        declared = set(re.findall(r"\b(\w+)\(", sketch))
        for name in ("show_scan", "send"):    # no function is called above its definition: .cpp has no prototypes made for it
            self.assertIn(name, declared)
            self.assertEqual(re.search(rf"\b{name}\(", sketch).start(), re.search(rf"static void {name}\(", sketch).start() + len("static void "))

    def test_it_is_one_screen_and_names_this_version(self):
        self.assertLessEqual(len(section().splitlines()), SCREEN)
        version = re.search(r"VERSION (\S+)", (ROOT / "tools/scip_package/CMakeLists.txt").read_text(encoding="utf-8")
                            .split("project(plomada_scip")[1]).group(1)
        self.assertEqual(set(re.findall(r"plomada_scip-([\d.]+)\.zip", section())), {version})
        self.assertEqual(len(commands()), 7)


if __name__ == "__main__":
    unittest.main(verbosity=2)
