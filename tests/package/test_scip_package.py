"""The scanner's driver as others get it: built, installed, taken in by another project, and as a package for Arduino and PlatformIO."""
import re
import shutil
import subprocess
import tempfile
import unittest
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
PACKAGE = ROOT / "tools/scip_package"
URL = "https://example.org/plomada"

FOUND = """cmake_minimum_required(VERSION 3.21)
project(consumer LANGUAGES C)
find_package(plomada_scip 0.2 REQUIRED)
add_executable(consumer consumer.c)
target_link_libraries(consumer PRIVATE plomada_scip::scip)
"""
# No CMock, no Ruby, no tests: whoever takes this repository in has none of them.
TAKEN = """cmake_minimum_required(VERSION 3.21)
project(consumer LANGUAGES C)
set(CMAKE_DISABLE_FIND_PACKAGE_CMock ON)
{way}
add_executable(consumer consumer.c)
target_link_libraries(consumer PRIVATE plomada_scip::scip)
"""
WAYS = {
    "add_subdirectory": f'add_subdirectory("{ROOT}" plomada)',
    "FetchContent": f'include(FetchContent)\nFetchContent_Declare(plomada SOURCE_DIR "{ROOT}")\nFetchContent_MakeAvailable(plomada)',
}

PROGRAM = """#include <plomada/scip_layout.h>
#include <plomada/scip_version.h>
#include <plomada/urg.h>

#include <stdio.h>

#if PLOMADA_SCIP_VERSION_NUMBER < 200
#error too old
#endif

int main(void)
{
    static const urg_config_t config = { 0, 115200, 115200, 0, SCIP_STREAM_2, { 372, 406, 1, 0, 0 }, 0, false };
    static uint16_t points[70];
    static urg_driver_t urg;
    urg_output_t output;

    if (!urg_init(&urg, &config, points, 70, 0)) {
        return 1;
    }
    urg_step(&urg, 0);
    if (urg_next_to_send(&urg, &output)) {
        printf("%s %.*s", PLOMADA_SCIP_VERSION, (int)output.count, (const char *)output.octets);
    }
    return 0;
}
"""


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], check=False, capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def version():
    return re.search(r"project\(plomada_scip VERSION (\S+)", (PACKAGE / "CMakeLists.txt").read_text(encoding="utf-8")).group(1)


class ThePackage(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.top = Path(cls.folder.name)
        cls.out = cls.top / "out"
        run("cmake", "-S", PACKAGE, "-B", cls.out, f"-DPLOMADA_SCIP_URL={URL}")
        cls.library = cls.out / "plomada_scip"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def consumer(self, name, text, *options):
        """What a project of these words prints, built in a directory of its own."""
        folder = self.top / name
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text(text, encoding="utf-8")
        (folder / "consumer.c").write_text(PROGRAM, encoding="utf-8")
        run("cmake", "-S", folder, "-B", folder / "build", *options)
        run("cmake", "--build", folder / "build")
        return run(folder / "build/consumer"), folder

    def test_a_project_outside_the_tree_finds_the_installed_library(self):
        run("cmake", "--build", self.out)
        run("cmake", "--install", self.out, "--prefix", self.top / "prefix")
        printed, _ = self.consumer("found", FOUND, f"-DCMAKE_PREFIX_PATH={self.top / 'prefix'}")
        self.assertEqual(printed, f"{version()} \nL0\n")
        config = next((self.top / "prefix").rglob("plomada_scipConfig*.cmake"))
        self.assertNotIn(str(ROOT), config.read_text(encoding="utf-8"))

    def test_a_project_takes_the_repository_in_and_nothing_but_the_library(self):
        for name, way in WAYS.items():
            printed, folder = self.consumer(name, TAKEN.format(way=way))
            self.assertEqual(printed, f"{version()} \nL0\n", name)
            self.assertEqual([path.name for path in folder.rglob("*.a")], ["libplomada_scip.a"], name)
            self.assertNotIn("PLOMADA_TESTS", (folder / "build/CMakeCache.txt").read_text(encoding="utf-8"), name)

    def test_a_changed_source_is_packed_again(self):
        copy = self.top / "copy"
        for name in ("drivers", "docs", "examples", "tools/scip_package"):
            shutil.copytree(ROOT / name, copy / name)
        shutil.copy(ROOT / "LICENSE", copy)
        run("cmake", "-S", copy / "tools/scip_package", "-B", copy / "out", "-DPLOMADA_SCIP_EXAMPLES=OFF")
        run("cmake", "--build", copy / "out")
        with open(copy / "drivers/urg.c", "a", encoding="utf-8") as source:
            source.write("#error changed\n")
        with self.assertRaisesRegex(AssertionError, "#error changed"):
            run("cmake", "--build", copy / "out")

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
void complain(const char *words);
""" + block, encoding="utf-8")
        run("cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-I", self.library / "src", "-c", program, "-o", self.top / "readme.o")

    def test_a_program_that_uses_urg_library_compiles_with_it(self):
        theirs, ours = f'#include "{HERE}/urg_library_names.h"\n', "#include <plomada_scip.h>\n"
        for compiler, language in (("cc", "c"), ("c++", "c++")):
            if shutil.which(compiler) is None:
                continue
            for text in (theirs + ours, ours + theirs):
                program = self.top / f"both.{language}"
                program.write_text(text + "urg_t their_sensor; urg_driver_t our_sensor;\n", encoding="utf-8")
                run(compiler, "-x", language, "-Wall", "-Wextra", "-Werror", "-I", self.library / "src", "-c", program, "-o", self.top / "both.o")

    def test_a_source_of_the_package_includes_only_what_is_in_it(self):
        for path in (self.library / "src").rglob("*.[ch]"):
            text = path.read_text(encoding="utf-8")
            for name in re.findall(r'#include "(.*?)"', text):
                self.assertTrue((self.library / "src" / name).is_file(), f"{path.name}: {name}")
            self.assertLessEqual(set(re.findall(r"#include <(.*?)>", text)), {f"std{name}.h" for name in ("bool", "def", "int")} | {"string.h"}, path.name)

    def test_a_link_of_a_page_of_the_package_leads_somewhere_in_it(self):
        for page in self.library.rglob("*.md"):
            for target in re.findall(r"\]\(([^)\s#]+)", page.read_text(encoding="utf-8")):
                self.assertTrue((page.parent / target).is_file(), f"{page.name}: {target}")

    def test_the_zip_holds_what_arduino_and_platformio_want(self):
        run("cmake", "--build", self.out, "--target", "package")
        with zipfile.ZipFile(self.out / f"plomada_scip-{version()}.zip") as package:
            names = set(package.namelist())
            text = {name: package.read(f"plomada_scip/{name}").decode() for name in ("library.properties", "library.json")}
        self.assertEqual({name.split("/")[0] for name in names}, {"plomada_scip"})
        for name in ("README.md", "LICENSE", "src/plomada_scip.h", "src/plomada/urg.h", "extras/scip.md", "extras/scanner/scanner.c",
                     "examples/FirstDistance/FirstDistance.ino"):
            self.assertIn(f"plomada_scip/{name}", names)
        for name in ("version", "author", "maintainer", "sentence", "paragraph", "category", "url", "architectures"):
            self.assertRegex(text["library.properties"], rf"(?m)^{name}=\S")
        self.assertIn(f"\nversion={version()}\n", text["library.properties"])
        self.assertIn(f"\nurl={URL}\n", text["library.properties"])
        self.assertIn(f'"url": "{URL}.git"', text["library.json"])
        self.assertIn(f'"version": "{version()}"', text["library.json"])

    def test_an_address_that_nobody_knows_is_asked_for_and_not_made_up(self):
        out = self.top / "nowhere"
        run("cmake", "-S", PACKAGE, "-B", out, "-DPLOMADA_SCIP_URL=ftp://example.org/plomada")
        self.assertFalse((out / "plomada_scip/library.properties").exists())
        with self.assertRaisesRegex(AssertionError, "want the repository's address"):
            run("cmake", "--build", out, "--target", "package")

    def test_the_sketch_and_the_library_compile_for_an_avr_board(self):
        if shutil.which("avr-g++") is None or shutil.which("avr-gcc") is None:
            self.skipTest("no avr-gcc here: tools/setup/setup.sh port")
        flags = ["-mmcu=atmega2560", "-Os", "-Wall", "-Wextra", "-Werror", "-I", self.library / "src", "-c"]
        for source in sorted((self.library / "src").rglob("*.c")):
            run("avr-gcc", "-std=gnu11", *flags, source, "-o", self.top / "object.o")
        run("avr-g++", "-std=gnu++11", "-x", "c++", "-include", HERE / "Arduino.h", *flags,
            self.library / "examples/FirstDistance/FirstDistance.ino", "-o", self.top / "sketch.o")


if __name__ == "__main__":
    unittest.main(verbosity=2)
