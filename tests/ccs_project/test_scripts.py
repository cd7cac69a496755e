"""tools/ti/ calls TI's tools as the CCS project says, and names what is missing. TI's tools are stand-ins that write down
how they were called."""
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from here import CCS, REPOSITORY, Project

TOOLS = REPOSITORY / "tools" / "ti"
SOURCES = [path.relative_to(REPOSITORY).as_posix() for path in Project().files(".c")]
ALL = ("CCS_ROOT", "BIOS_ROOT", "XDC_ROOT", "CGT_ROOT", "C2000WARE_ROOT")
MARKERS = {"CCS_ROOT": "ccs_base/DebugServer/bin/none", "BIOS_ROOT": "packages/ti/sysbios/package.xdc",
           "XDC_ROOT": "packages/xdc/package.xdc", "CGT_ROOT": "include/stdint.h",
           "C2000WARE_ROOT": "driverlib/f2837xs/driverlib/sysctl.h"}
# Logs its own name, working directory and arguments; then does what is asked of the real one.
STAND_IN = r"""#!/bin/sh
{ echo "${0##*/}"; pwd; printf '%s\n' "$@"; echo; } >> "$CALLS"
for word in "$@"; do
    case "$word" in
        --output_file=*) : > "${word#--output_file=}" ;;
        configPkg) mkdir -p configPkg && : > configPkg/compiler.opt && : > configPkg/linker.cmd ;;
    esac
done
case "${0##*/}" in "$FAILING") exit 3 ;; esac
"""


class Script(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.top = Path(directory.name).resolve()
        self.out = self.top / "out"
        self.home = self.top / "home"
        self.home.mkdir()
        self.roots = {}

    def install(self, variable, path=None):
        """A root in which the scripts believe, with its programs."""
        root = path or self.top / variable.lower()
        (root / MARKERS[variable]).parent.mkdir(parents=True, exist_ok=True)
        (root / MARKERS[variable]).touch()
        program = {"XDC_ROOT": "xs", "CGT_ROOT": "bin/cl2000", "CCS_ROOT": "ccs_base/DebugServer/bin/DSLite"}.get(variable)
        if program:
            (root / program).parent.mkdir(parents=True, exist_ok=True)
            (root / program).write_text(STAND_IN, encoding="utf-8")
            (root / program).chmod(0o755)
        if path is None:
            self.roots[variable] = str(root)
        return root

    def call(self, script, *arguments, failing="none"):
        environment = {key: value for key, value in os.environ.items() if key not in ALL}
        environment.update(self.roots, HOME=str(self.home), CALLS=str(self.top / "calls"), FAILING=failing)
        return subprocess.run([sys.executable, "-B", str(TOOLS / script), *map(str, arguments)], env=environment,
                              capture_output=True, text=True, check=False)

    def calls(self):
        written = (self.top / "calls").read_text(encoding="utf-8")
        return [call.split("\n") for call in written.rstrip("\n").split("\n\n")]


@unittest.skipIf(any(Path(place).exists() for place in ("/opt/ti", "/Applications/ti")), "TI's tools may be on this machine")
class Missing(Script):
    def test_every_missing_root_is_named_on_a_line_of_its_own(self):
        for script, variables in (("firmware.py", ALL[1:]), ("flash.py", ALL[:1])):
            done = self.call(script)
            self.assertEqual(done.returncode, 2)
            lines = done.stderr.splitlines()
            self.assertEqual([line.split()[0] for line in lines[:-1]], list(variables))
            self.assertIn("docs/flashing.md", lines[-1])

    def test_only_the_missing_one_is_named(self):
        for variable in ALL[2:]:
            self.install(variable)
        done = self.call("firmware.py")
        self.assertEqual(done.returncode, 2)
        self.assertIn("BIOS_ROOT", done.stderr)
        self.assertNotIn("XDC_ROOT", done.stderr)

    def test_a_directory_that_is_not_the_root_is_refused_with_its_path(self):
        for variable in ALL[1:]:
            self.install(variable)
        self.roots["CGT_ROOT"] = str(self.home)
        done = self.call("firmware.py")
        self.assertEqual(done.returncode, 2)
        self.assertIn(f"CGT_ROOT={self.home}", done.stderr)

    def test_the_projects_versions_are_found_in_tis_usual_places(self):
        ti = self.home / "ti"
        places = {"CCS_ROOT": "ccs1250/ccs", "BIOS_ROOT": "bios_6_83_00_18", "XDC_ROOT": "xdctools_3_62_01_15_core",
                  "CGT_ROOT": "ccs1250/ccs/tools/compiler/ti-cgt-c2000_22.6.3.LTS",
                  "C2000WARE_ROOT": "c2000/C2000Ware_26_01_00_00"}
        for variable, place in places.items():
            self.install(variable, ti / place)
        self.assertEqual(self.call("firmware.py", "--out", self.out).returncode, 0)
        xs = self.calls()[0]
        self.assertIn(f"--xdcpath={ti}/bios_6_83_00_18/packages;", xs)
        self.assertIn(f"{ti}/ccs1250/ccs/tools/compiler/ti-cgt-c2000_22.6.3.LTS", xs)

    def test_another_version_is_not_taken_by_itself(self):
        for variable in ALL[2:]:
            self.install(variable)
        self.install("BIOS_ROOT", self.home / "ti" / "bios_6_76_04_02")
        self.assertEqual(self.call("firmware.py").returncode, 2)

    def test_flash_without_an_image_says_how_to_make_one(self):
        self.install("CCS_ROOT")
        done = self.call("flash.py", self.top / "none.out")
        self.assertEqual(done.returncode, 2)
        self.assertIn("make firmware", done.stderr)

    def test_check_ti_without_roots_is_skipped_and_with_a_wrong_one_is_an_error(self):
        self.assertEqual(self.call("check_ti.py").returncode, 77)
        self.roots["XDC_ROOT"] = str(self.home)
        self.assertEqual(self.call("check_ti.py").returncode, 2)


class Build(Script):
    """Of each configuration one build, which the tests look at."""

    @classmethod
    def setUpClass(cls):
        cls.script = Script()
        cls.script.setUp()
        cls.addClassCleanup(cls.script.doCleanups)
        for variable in ALL[1:]:
            cls.script.install(variable)
        cls.built, cls.out, cls.roots = {}, cls.script.out, cls.script.roots
        for configuration in ("Debug", "Release"):
            done = cls.script.call("firmware.py", "--config", configuration, "--out", cls.out)
            cls.built[configuration] = done, cls.script.calls()
            (cls.script.top / "calls").unlink()

    def setUp(self):
        pass

    def build(self, configuration="Release"):
        done, calls = self.built[configuration]
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.splitlines()[-1], str(self.out / configuration / "plomada.out"))
        return calls

    def test_configuro_gets_the_projects_target_platform_and_profile(self):
        name, directory, *words = self.build()[0]
        self.assertEqual((name, directory), ("xs", str(self.out / "Release")))
        self.assertEqual(words[:2], [f"--xdcpath={self.roots['BIOS_ROOT']}/packages;", "xdc.tools.configuro"])
        self.assertEqual(words[2:], ["-o", "configPkg", "-t", "ti.targets.C28_float", "-p", "ti.platforms.tms320x28:TMS320F28377S",
                                     "-r", "release", "-c", self.roots["CGT_ROOT"], "--compileOptions", "-g", "app.cfg"])

    def test_app_cfg_is_copied_beside_what_it_makes(self):
        self.build()
        copy = self.out / "Release" / "app.cfg"
        self.assertFalse(copy.is_symlink())
        self.assertEqual(copy.read_bytes(), (CCS / "app.cfg").read_bytes())
        self.assertFalse((CCS / "src").exists())

    def test_each_source_is_compiled_once_with_the_projects_options(self):
        for configuration in ("Debug", "Release"):
            compiled = [call for call in self.build(configuration) if call[0] == "cl2000" and "--run_linker" not in call]
            sources = [Path(call[-1]).relative_to(REPOSITORY).as_posix() for call in compiled]
            self.assertEqual(sorted(sources), sorted(SOURCES))
            expected = Project().options(configuration, "compilerBuildOptions",
                                         COM_TI_C2000WARE_INSTALL_DIR=self.roots["C2000WARE_ROOT"])
            for _, directory, *words in compiled:
                self.assertEqual(directory, str(self.out / configuration))
                self.assertEqual(words[:len(expected)], expected)
                self.assertIn("--cmd_file=configPkg/compiler.opt", words)
                self.assertIn(f"-I{self.roots['CGT_ROOT']}/include", words)

    def test_no_variable_is_left_unexpanded(self):
        self.assertNotRegex("\n".join("\n".join(call) for call in self.build()), r"\$\{")

    def test_everything_is_linked_with_the_kernels_and_the_projects_linker_files(self):
        *_, (name, _, *words) = self.build()
        self.assertEqual(name, "cl2000")
        before, after = words[:words.index("--run_linker")], words[words.index("--run_linker"):]
        compiled = Project().options("Release", "compilerBuildOptions", COM_TI_C2000WARE_INSTALL_DIR=self.roots["C2000WARE_ROOT"])
        self.assertEqual(before, ["-v28", "-ml", "-mt", "--float_support=fpu32", "--fp_mode=strict", "--abi=coffabi"])
        self.assertEqual([word for word in compiled if word in before], before)
        objects = [word for word in after if word.endswith(".obj")]
        self.assertEqual(sorted(objects), sorted(Path(source).stem + ".obj" for source in SOURCES))
        self.assertEqual([word for word in after if word.endswith(".cmd")], ["configPkg/linker.cmd", str(CCS / "plomada.cmd")])
        libraries = [word for word in after if word.startswith("--library=")]
        self.assertEqual(libraries, [f"--library={self.roots['C2000WARE_ROOT']}/driverlib/f2837xs/driverlib/ccs/Release/driverlib.lib",
                                     "--library=F021_API_F2837xS_FPU32.lib", "--library=libc.a"])
        self.assertIn(f"--search_path={self.roots['C2000WARE_ROOT']}/libraries/flash_api/f2837xs/lib", after)
        self.assertIn("--output_file=plomada.out", after)
        self.assertIn("--rom_model", after)


class Broken(Script):
    def test_the_first_failure_ends_the_build(self):
        for variable in ALL[1:]:
            self.install(variable)
        for program, calls in (("xs", 1), ("cl2000", 2)):
            done = self.call("firmware.py", "--out", self.out, failing=program)
            self.assertEqual(done.returncode, 1)
            self.assertEqual(len(self.calls()), calls)
            (self.top / "calls").unlink()


class Flash(Script):
    def test_dslite_loads_the_image_by_the_launchpads_probe(self):
        self.install("CCS_ROOT")
        image = self.top / "plomada.out"
        image.touch()
        self.assertEqual(self.call("flash.py", image).returncode, 0)
        (name, _, *words), = self.calls()
        self.assertEqual((name, words), ("DSLite", ["load", "-c", str(CCS / "TMS320F28377S.ccxml"), "-f", str(image)]))
        self.assertEqual(self.call("flash.py", image, failing="DSLite").returncode, 1)


class Make(unittest.TestCase):
    def test_make_has_the_three_targets_and_lists_them(self):
        makefile = (REPOSITORY / "Makefile").read_text(encoding="utf-8")
        for target, script in (("firmware", "firmware.py"), ("flash", "flash.py"), ("check-ti", "check_ti.py")):
            self.assertRegex(makefile, rf"(?m)^{target}: ## .+\n\t@python3 -B tools/ti/{re.escape(script)}$")
        listed = subprocess.run(["make", "-C", str(REPOSITORY), "help"], capture_output=True, text=True, check=True).stdout
        for target in ("firmware", "flash", "check-ti"):
            self.assertIn(f"make {target} ", listed)


if __name__ == "__main__":
    unittest.main(verbosity=2)
