"""ccs_project/ is complete, well formed, and describes the sources that CMake builds."""
import os
import re
import subprocess
import unittest
import xml.etree.ElementTree as ElementTree

from here import CCS, REPOSITORY, Project, cmake_sources, code, house, product_files, text

KEYWORDS = ("interrupt", "cregister", "far", "near", "ioport", "onchip", "asm")


class Files(unittest.TestCase):
    def test_the_directory_holds_what_the_project_needs_and_no_c_source(self):
        names = sorted(path.name for path in CCS.rglob("*") if path.is_file())
        self.assertEqual(names, ["TMS320F28377S.ccxml", "app.cfg", "plomada.cmd", "plomada.projectspec"])

    def test_every_file_that_the_project_names_exists(self):
        project = Project()
        self.assertGreater(len(project.entries), 30)
        for entry in project.entries:
            self.assertTrue((CCS / entry["path"]).is_file(), entry["path"])
        for path in project.variables.values():
            self.assertTrue(path.is_dir(), path)

    def test_xml_is_well_formed_and_says_so(self):
        for name in ("plomada.projectspec", "TMS320F28377S.ccxml"):
            content = text(f"ccs_project/{name}")
            self.assertTrue(content.startswith('<?xml version="1.0" encoding="UTF-8"'), name)
            ElementTree.fromstring(content.encode())

    def test_sources_are_exactly_those_that_cmake_builds(self):
        listed = [path.relative_to(REPOSITORY).as_posix() for path in Project().files(".c")]
        self.assertEqual(len(listed), len(set(listed)), "one is listed twice")
        self.assertEqual(sorted(listed), sorted(cmake_sources()), "tools/ti/list_sources.py writes the list")

    def test_no_two_sources_make_the_same_object_file(self):
        stems = [path.stem for path in Project().files(".c")]
        self.assertEqual(len(stems), len(set(stems)))

    def test_sources_and_linker_file_are_linked_where_they_are_and_app_cfg_is_copied(self):
        # SYS/BIOS writes src/ beside app.cfg: a link would have it write into the repository.
        for entry in Project().entries:
            expected = "copy" if entry["path"].endswith((".cfg", ".ccxml")) else "link"
            self.assertEqual(entry["action"], expected, entry["path"])

    def test_each_source_lands_in_a_folder_of_its_room(self):
        for entry in Project().entries:
            if entry["path"].endswith(".c"):
                self.assertEqual(entry["targetDirectory"], entry["path"].split("/")[1])


class Settings(unittest.TestCase):
    def setUp(self):
        self.project = Project()

    def test_device_target_platform_and_probe_are_the_launchpads(self):
        self.assertEqual(self.project.attributes["device"], "TMS320F28377S")
        self.assertEqual(self.project.properties["target"], "ti.targets.C28_float")
        self.assertEqual(self.project.properties["platform"], "ti.platforms.tms320x28:TMS320F28377S")
        self.assertEqual(self.project.properties["type"], "rtsc")
        probe = ElementTree.fromstring(text("ccs_project/TMS320F28377S.ccxml").encode())
        hrefs = [instance.attrib["href"] for instance in probe.iter("instance")]
        self.assertEqual(hrefs[0], "connections/TIXDS100v2_Connection.xml")
        self.assertEqual(hrefs[-1], "devices/tms320f28377s.xml")
        self.assertIn("drivers/tixds100v2c28x.xml", hrefs)
        connection = next(probe.iter("connection"))
        self.assertEqual(connection.attrib["id"], next(probe.iter("instance")).attrib["id"])

    def test_versions_are_those_of_the_plan(self):
        self.assertEqual(self.project.versions(), {
            "SYSBIOS": ["6", "83", "00", "18"], "XDCTOOLS": ["3", "62", "01", "15"],
            "C2000WARE": ["26", "01", "00", "00"], "CGT": ["22.6.3.LTS"]})

    def test_one_object_format_throughout(self):
        # ti.targets.C28_float is COFF.
        self.assertEqual(self.project.attributes["outputFormat"], "COFF")
        for name in self.project.configurations:
            self.assertIn("--abi=coffabi", self.options(name))

    def options(self, name, attribute="compilerBuildOptions"):
        return self.project.options(name, attribute, COM_TI_C2000WARE_INSTALL_DIR="/ware")

    def test_debug_and_release_differ_only_in_optimisation_asserts_and_driverlib(self):
        self.assertEqual(sorted(self.project.configurations), ["Debug", "Release"])
        debug, release = set(self.options("Debug")), set(self.options("Release"))
        self.assertEqual(debug - release, {"--opt_level=off", "--define=DEBUG"})
        self.assertEqual(release - debug, {"--opt_level=2"})
        for name in ("Debug", "Release"):
            libraries = [word for word in self.options(name, "linkerBuildOptions") if word.startswith("--library=")]
            self.assertEqual(libraries, [f"--library=/ware/driverlib/f2837xs/driverlib/ccs/{name}/driverlib.lib",
                                         "--library=F021_API_F2837xS_FPU32.lib"])

    def test_the_board_the_core_and_the_processor_are_defined(self):
        # Without _LAUNCHXL_F28377S device.h describes another board: half the clock and a dead UART.
        for name in self.project.configurations:
            for word in ("-v28", "-ml", "--float_support=fpu32", "--c99", "--define=CPU1", "--define=_LAUNCHXL_F28377S",
                         "--define=xdc__strict"):
                self.assertIn(word, self.options(name))

    def test_floats_are_computed_in_the_order_of_the_sources_everywhere_it_is_said(self):
        # docs/realtime.md says why. TI's compiler uses the TMU with --fp_mode=relaxed only.
        for name in self.project.configurations:
            for attribute in ("compilerBuildOptions", "linkerBuildOptions"):
                self.assertEqual([word for word in self.options(name, attribute) if re.match(r"--(?:fp_|tmu_)", word)],
                                 ["--fp_mode=strict"] * (attribute == "compilerBuildOptions"))
        for path in ("tools/ti/firmware.py", "ccs_project/app.cfg", "tools/size/stacks.txt", "tools/rta/plomada-est.csv"):
            self.assertNotRegex(text(path), r"--(?:fp|tmu)_\w+=|\bTMU\b", path)
        self.assertIn("add_compile_options(-ffp-contract=off)", text("CMakeLists.txt"))
        for path in ("CMakeLists.txt", *(f"cmake/{each.name}" for each in (REPOSITORY / "cmake").glob("*.cmake"))):
            self.assertNotRegex(text(path), r"-ffast-math|-Ofast|-funsafe-math|-fassociative-math", path)
        page = " ".join(text("docs/realtime.md").split())
        self.assertIn("the build says `--fp_mode=strict`", page)
        self.assertIn("uses the chip's trigonometric unit (TMU) with `--fp_mode=relaxed` only", page)

    def test_headers_are_found_in_the_rooms_and_in_driverlib(self):
        for name in self.project.configurations:
            found = [word[2:] for word in self.options(name) if word.startswith("-I")]
            self.assertEqual(found, [str(REPOSITORY), "/ware/driverlib/f2837xs/driverlib", "/ware/device_support/f2837xs/common/include",
                                             "/ware/libraries/flash_api/f2837xs/include"])


class Kernel(unittest.TestCase):
    def setUp(self):
        self.cfg = code("ccs_project/app.cfg")
        self.modules = dict(re.findall(r"var (\w+)\s*= xdc\.useModule\('([\w.]+)'\);", self.cfg))

    def value(self, setting):
        found = re.findall(rf"^{re.escape(setting)}\s*=\s*(.+?);[ \t]*$", self.cfg, re.MULTILINE)
        self.assertEqual(len(found), 1, setting)
        return found[0]

    def test_every_kernel_module_that_the_firmware_includes_is_configured(self):
        included = {match.replace("/", ".") for path in product_files(".c", ".h")
                    for match in re.findall(r"#include <((?:ti|xdc)/[\w/]+)\.h>", code(path))} - {"xdc.std"}
        self.assertGreater(len(included), 7)
        self.assertEqual(included - set(self.modules.values()), set())

    def test_every_setting_belongs_to_a_module_that_was_asked_for(self):
        for name in re.findall(r"^(\w+)\.", self.cfg, re.MULTILINE):
            self.assertIn(name, {*self.modules, "Program"})

    def test_nothing_but_assignments_use_module_and_the_reset_function(self):
        for line in filter(None, (line.strip() for line in self.cfg.splitlines())):
            self.assertRegex(line, r"^(var \w+\s*= xdc\.useModule\('[\w.]+'\);|[A-Z]\w*(\.\w+)+\s*=\s*['&\w.]+;|Reset\.fxns\.\$add\('&\w+'\);"
                                   r"|\w+\.addHookSet\(\{( \w+: '&\w+',?)+ \}\);)$")

    def test_the_clock_is_left_to_driverlib_and_told_to_the_kernel(self):
        self.assertEqual(self.value("Boot.configureClocks"), "false")
        self.assertEqual(self.value("Boot.disableWatchdog"), "false")
        self.assertEqual(self.value("BIOS.cpuFreq.lo"), "200000000")
        self.assertEqual(self.value("BIOS.cpuFreq.hi"), "0")
        self.assertIn("SysCtl_setClock(DEVICE_SETCLOCK_CFG)", code("bsp/board.c"))
        self.assertIn("SysCtl_disableWatchdog();", code("bsp/board.c"))

    def test_the_hooks_are_those_of_the_processor_time_and_all_of_them(self):
        named = re.findall(r"addHookSet\(\{(.*?)\}\)", self.cfg)
        self.assertEqual([" ".join(each.split()) for each in named],
                         ["beginFxn: '&cpu_time_hwi_begin', endFxn: '&cpu_time_hwi_end'",
                          "beginFxn: '&cpu_time_swi_begin', endFxn: '&cpu_time_swi_end'", "switchFxn: '&cpu_time_task_switch'"])
        declared = set(re.findall(r"^Void (cpu_time_\w+)\(", code("firmware/cpu_time.h"), re.MULTILINE))
        self.assertEqual(declared, set(re.findall(r"'&(cpu_time_\w+)'", self.cfg)))

    def test_the_tick_is_a_millisecond_on_timer_0_and_timers_1_and_2_are_left_to_the_time_base(self):
        self.assertEqual((self.value("Clock.tickPeriod"), self.value("Clock.timerId")), ("1000", "0"))
        self.assertIn("CPUTIMER1_BASE", code("bsp/timebase.c"))
        self.assertIn("CPUTIMER2_BASE", code("bsp/timebase.c"))
        self.assertEqual(int(self.value("Timer.anyMask"), 16), 0x1)

    def test_the_load_is_measured_by_the_timer_of_the_tick(self):
        self.assertEqual(self.modules["TickStamp"], "ti.sysbios.family.c28.TimestampProvider")
        self.assertEqual((self.value("TickStamp.useClockTimer"), self.value("Timestamp.SupportProxy")), ("true", "TickStamp"))

    def test_stacks_are_checked_and_the_heap_holds_what_main_creates(self):
        for setting in ("Task.checkStackFlag", "Task.initStackFlag", "HalHwi.checkStackFlag", "HalHwi.initStackFlag"):
            self.assertEqual(self.value(setting), "true")
        stack = int(re.search(r"#define TASK_STACK_CELLS (\d+)U", text("firmware/schedule.h")).group(1))
        self.assertEqual(int(self.value("Task.defaultStackSize"), 16), stack)
        tasks = len(re.findall(r"^void task_\w+_create\(", text("firmware/tasks.h"), re.MULTILINE))
        # A Task object is under 64 words; 2048 hold all Hwis, Swis, Clocks, semaphores and gates twice over.
        self.assertGreaterEqual(int(self.value("BIOS.heapSize"), 16), tasks * (stack + 64) + 2048)

    def test_priorities_of_the_schedule_fit(self):
        schedule = text("firmware/schedule.h")
        task = max(int(each) for each in re.findall(r"#define TASK_\w+_PRIORITY (\d+)", schedule))
        swi = max(int(each) for each in re.findall(r"#define \w+_SWI_PRIORITY (\d+)U", schedule))
        self.assertLess(task, int(self.value("Task.numPriorities")))
        # The kernel's Clock has the highest Swi priority for itself.
        self.assertLess(swi, int(self.value("Swi.numPriorities")) - 1)

    def test_every_fault_ends_in_a_hook_that_exists(self):
        self.assertEqual(self.value("Error.policyFxn"), "Error.policyDefault")
        for setting in ("Error.raiseHook", "System.abortFxn", "System.exitFxn"):
            name = re.fullmatch(r"'&(\w+)'", self.value(setting)).group(1)
            self.assertRegex(code("firmware/fault.c"), rf"\bVoid {name}\(")


class Sources(unittest.TestCase):
    def test_no_name_is_a_keyword_of_tis_compiler(self):
        # Outside --strict_ansi cl2000 takes these words for itself.
        for path in product_files(".c", ".h"):
            for match in re.finditer(rf"\b({'|'.join(KEYWORDS)})\b", house.code_only(text(path))):
                line = house.line_of(text(path), match.start())
                self.assertRegex(text(path).splitlines()[line - 1], r"^\s*#", f"{path}:{line}: {match.group()}")

    def test_sources_are_c99_as_the_compiler_is_told(self):
        command = [os.environ.get("CC", "gcc"), "-std=c99", "-pedantic-errors", "-fsyntax-only",
                   f"-I{REPOSITORY}",
                   *(word for each in ("driverlib", "f021/include", "sysbios") for word in ("-isystem", str(REPOSITORY / "sim/ti" / each))),
                   *(str(path) for path in Project().files(".c"))]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    unittest.main()
