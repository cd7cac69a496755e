"""The package under compilers that are not this PC's, and in PlatformIO's hands: `make package` installs and runs them.

Usage: test_builds.py [ROOT/build], where tools/setup/setup.sh package has put PlatformIO.
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
PIO = ROOT / "build/pio/bin/pio"
STRICT = ("-pedantic", "-Wall", "-Wextra", "-Wconversion", "-Wsign-conversion", "-Wshadow", "-Wundef", "-Werror")
OFFLINE = "Could not load SPDX licenses"    # PlatformIO fetches the list of licences


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], check=False, capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr}")
    return done.stdout


def clang():
    return next((name for name in ("clang", *(f"clang-{version}" for version in range(14, 31))) if shutil.which(name)), None)


def need(*programs):
    for program in programs:
        if program is None or shutil.which(program) is None:
            raise unittest.SkipTest(f"no {program}: tools/setup/setup.sh package")


class Builds(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.top = Path(cls.folder.name)
        cls.out = cls.top / "out"
        run("cmake", "-S", ROOT / "tools/scip_package", "-B", cls.out, "-DPLOMADA_SCIP_URL=https://example.org/plomada")
        cls.library = cls.out / "plomada_scip"
        cls.sources = sorted((cls.library / "src").rglob("*.c"))
        cls.example = cls.library / "extras/scanner"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def compile(self, compiler, *options, sources=None, language=()):
        self.assertEqual(len(self.sources), 6)
        for source in sources or self.sources:
            run(compiler, *options, "-I", self.library / "src", *language, "-c", source, "-o", self.top / "object.o")

    def test_gcc_and_clang_have_nothing_to_say(self):
        need("gcc", clang())
        for compiler in ("gcc", clang()):
            for standard in ("c99", "c11", "c17"):
                self.compile(compiler, f"-std={standard}", *STRICT)
            self.compile(compiler, "-std=gnu99", "-funsigned-char", "-m64", *STRICT)
            self.compile(compiler, "-std=c99", *STRICT, "-Wno-pedantic", sources=[self.example / "scanner.c"])

    def test_the_headers_are_cxx_too(self):
        need("g++")
        for standard in ("c++11", "c++17"):
            for header in sorted((self.library / "src").rglob("*.h")):
                run("g++", f"-std={standard}", "-Wall", "-Wextra", "-Werror", "-x", "c++", "-I", self.library / "src", "-fsyntax-only",
                    "-include", header, "/dev/null")

    def test_the_language_of_microsofts_compiler_has_nothing_against_it(self):
        need(clang())
        for source in self.sources:    # without Windows's headers: its own stdint.h and the like are enough
            run(clang(), "--driver-mode=cl", "--target=x86_64-pc-windows-msvc", "/W4", "/WX", "/c", "/clang:-ffreestanding",
                "/clang:-isystem" + str(HERE / "freestanding"), f"/I{self.library / 'src'}", f"/Fo{self.top / 'object.obj'}", source)

    def test_an_avr_and_two_arms_compile_it(self):
        need("avr-gcc", "arm-none-eabi-gcc")
        self.compile("avr-gcc", "-mmcu=atmega2560", "-Os", "-std=c99", *STRICT)
        for core in ("cortex-m0", "cortex-m4"):
            self.compile("arm-none-eabi-gcc", f"-mcpu={core}", "-mthumb", "-Os", "-std=c99", *STRICT)

    def test_the_scanner_of_windows_is_linked(self):
        need("x86_64-w64-mingw32-gcc")
        run("cmake", "-S", ROOT / "tools/scip_package", "-B", self.top / "windows", "-DCMAKE_SYSTEM_NAME=Windows",
            "-DCMAKE_C_COMPILER=x86_64-w64-mingw32-gcc", "-DCMAKE_C_FLAGS=-Wall -Wextra -Wconversion -Werror")
        run("cmake", "--build", self.top / "windows")
        self.assertEqual((self.top / "windows/scanner.exe").read_bytes()[:2], b"MZ")

    def test_the_task_of_freertos_compiles_against_its_declarations(self):
        need("arm-none-eabi-gcc")
        self.compile("arm-none-eabi-gcc", "-mcpu=cortex-m4", "-mthumb", "-Os", "-std=c99", "-Wall", "-Wextra", "-Wconversion", "-Werror",
                     "-I", HERE / "freertos", sources=[self.example / "scanner.c", self.example / "freertos.c"])

    def test_platformio_packs_it_whole(self):
        need(PIO)
        whole = self.packed(self.library)
        if whole is None:    # no network: all but the licence's name is looked at
            manifest = self.library / "library.json"
            text = manifest.read_text(encoding="utf-8")
            self.assertIn('"license": "BSD-3-Clause"', text)
            bare = self.top / "bare"
            shutil.copytree(self.library, bare)
            (bare / "library.json").write_text(re.sub(r'\n *"license".*', "", text), encoding="utf-8")
            whole = self.packed(bare)
        names = set(run("tar", "tzf", whole).split())
        here = {path.relative_to(self.library).as_posix() for path in self.library.rglob("*") if path.is_file()}
        self.assertEqual(names, here)

    def packed(self, folder):
        """The packed file; None when the list of licences cannot be fetched."""
        target = self.top / f"{folder.name}.tar.gz"
        environment = {**os.environ, "PLATFORMIO_CORE_DIR": str(self.top / "pio"), "PLATFORMIO_SETTING_ENABLE_TELEMETRY": "no"}
        done = subprocess.run([PIO, "pkg", "pack", folder, "-o", target], check=False, capture_output=True, text=True, env=environment)
        if OFFLINE in done.stdout + done.stderr:
            return None
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return target


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))
