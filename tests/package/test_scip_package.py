"""The scanner's driver as a library of its own, built and used from a directory outside the tree."""
import re
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PACKAGE = ROOT / "tools/scip_package"

CONSUMER = """cmake_minimum_required(VERSION 3.22)
project(consumer LANGUAGES C)
find_package(plomada_scip 0.1 REQUIRED)
add_executable(consumer consumer.c)
target_link_libraries(consumer PRIVATE plomada_scip::scip)
"""

PROGRAM = """#include "drivers/scip_layout.h"
#include "drivers/urg.h"

#include <stdio.h>

int main(void)
{
    static const urg_config_t config = { 0, 115200, 115200, 0, SCIP_STREAM_2, { 372, 406, 1, 0, 0 }, 0 };
    static uint16_t points[70];
    static urg_driver_t urg;
    urg_output_t output;

    if (!urg_init(&urg, &config, points, 70, 0)) {
        return 1;
    }
    urg_step(&urg, 0);
    if (urg_next_to_send(&urg, &output)) {
        printf("%.*s", (int)output.count, (const char *)output.octets);
    }
    return 0;
}
"""


def run(*command):
    done = subprocess.run([str(word) for word in command], check=False, capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


class ThePackage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.top = Path(cls.folder.name)
        cls.out = cls.top / "out"
        run("cmake", "-S", PACKAGE, "-B", cls.out, "-DCMAKE_BUILD_TYPE=Release")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_a_project_outside_the_tree_finds_the_installed_library(self):
        run("cmake", "--build", self.out)
        run("cmake", "--install", self.out, "--prefix", self.top / "prefix")
        (self.top / "consumer").mkdir()
        (self.top / "consumer/CMakeLists.txt").write_text(CONSUMER, encoding="utf-8")
        (self.top / "consumer/consumer.c").write_text(PROGRAM, encoding="utf-8")
        run("cmake", "-S", self.top / "consumer", "-B", self.top / "build", f"-DCMAKE_PREFIX_PATH={self.top / 'prefix'}")
        run("cmake", "--build", self.top / "build")
        self.assertEqual(run(self.top / "build/consumer"), "\nL0\n")
        config = next((self.top / "prefix").rglob("plomada_scipConfig*.cmake"))
        self.assertNotIn(str(ROOT), config.read_text(encoding="utf-8"))

    def test_the_first_program_of_the_readme_compiles(self):
        block = re.search(r"```c\n(.*?)```", (ROOT / "drivers/README.md").read_text(encoding="utf-8"), re.DOTALL).group(1)
        program = self.top / "readme.c"
        program.write_text("""#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
uint32_t time_us(void);
void uart_open(uint32_t rate);
size_t uart_read(unsigned char *octets, size_t most);
void uart_write(const unsigned char *octets, size_t count);
void wait_ms(unsigned ms);
void show(float mm);
""" + block, encoding="utf-8")
        run("cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-I", ROOT, "-c", program, "-o", self.top / "readme.o")

    def test_a_program_that_uses_urg_library_compiles_with_it(self):
        theirs, ours = f'#include "{HERE}/urg_library_names.h"\n', '#include "drivers/scip_layout.h"\n#include "drivers/urg.h"\n'
        for compiler, language in (("cc", "c"), ("c++", "c++")):
            if shutil.which(compiler) is None:
                continue
            for text in (theirs + ours, ours + theirs):
                program = self.top / f"both.{language}"
                program.write_text(text + "urg_t their_sensor; urg_driver_t our_sensor;\n", encoding="utf-8")
                run(compiler, "-x", language, "-Wall", "-Wextra", "-Werror", "-I", ROOT, "-c", program, "-o", self.top / "both.o")

    def test_every_header_that_is_installed_includes_only_such(self):
        text = (PACKAGE / "CMakeLists.txt").read_text(encoding="utf-8")
        headers = set(re.findall(r"\b\w+\.h\b", re.search(r"set\(HEADERS ([^)]*)\)", text).group(1)))
        sources = set(re.findall(r"\b\w+\.c\b", re.search(r"set\(SOURCES ([^)]*)\)", text).group(1)))
        for name in headers | sources:
            included = re.findall(r'#include "drivers/(\w+\.h)"', (ROOT / "drivers" / name).read_text(encoding="utf-8"))
            self.assertLessEqual(set(included), headers, name)

    def test_the_sketch_and_the_library_compile_for_an_avr_board(self):
        if shutil.which("avr-g++") is None or shutil.which("avr-gcc") is None:
            self.skipTest("no avr-gcc here")
        run("cmake", "--build", self.out, "--target", "arduino")
        library = self.out / "plomada_scip"
        flags = ["-mmcu=atmega2560", "-Os", "-Wall", "-Wextra", "-Werror", "-I", library / "src", "-c"]
        for source in sorted(library.rglob("*.c")):
            run("avr-gcc", "-std=gnu11", *flags, source, "-o", self.top / "object.o")
        run("avr-g++", "-std=gnu++11", "-x", "c++", "-include", HERE / "Arduino.h", *flags,
            library / "examples/FirstDistance/FirstDistance.ino", "-o", self.top / "sketch.o")
        for name in ("README.md", "LICENSE", "library.json", "library.properties", "src/plomada_scip.h"):
            self.assertTrue((library / name).is_file(), name)
        self.assertIn("version=0.1.0\n", (library / "library.properties").read_text(encoding="utf-8"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
