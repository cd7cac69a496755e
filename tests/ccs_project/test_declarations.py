"""tools/ti/check_ti.py sees a difference. sim/'s own headers play TI's: unchanged nothing may differ, and each change must be
named, nothing else."""
import os
import re
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from here import REPOSITORY
import check_ti
import declarations

WARE = "driverlib/f2837xs/driverlib"


class Compared(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.top = Path(directory.name)
        shutil.copytree(REPOSITORY / "sim/ti/driverlib", self.top / WARE, ignore=shutil.ignore_patterns("*.c", "chip.h", "model.h"))
        (self.top / "device_support/f2837xs/common/include").mkdir(parents=True)
        for part in ("ti", "xdc"):
            shutil.copytree(REPOSITORY / "sim/ti/sysbios" / part, self.top / "packages" / part)
        shutil.copytree(REPOSITORY / "sim/ti/f021/include", self.top / check_ti.FLASH_API)

    def change(self, header, before, after):
        path = self.top / (header if header.startswith("packages") else f"{WARE}/{header}")
        content = path.read_text(encoding="utf-8")
        self.assertEqual(len(re.findall(before, content)), 1, before)
        path.write_text(re.sub(before, after, content), encoding="utf-8")

    def complaints(self, kernel=False):
        library = check_ti.sysbios(self.top, self.top) if kernel else check_ti.driverlib(self.top)
        if kernel:
            library.gcc.remove("-Dxdc_target_name__=C28_float")
        return [each.split(": ")[1] if each.startswith(library.name) else each for each in check_ti.compared(library)]

    def test_nothing_differs_from_itself(self):
        self.assertEqual(self.complaints(), [])
        self.assertEqual(self.complaints(kernel=True), [])

    def test_a_value_that_differs_is_named(self):
        self.change("inc/hw_memmap.h", r"SCIB_BASE 0x00007210U", "SCIB_BASE 0x00007211U")
        self.change("epwm.h", r"EPWM_HSCLOCK_DIVIDER_6 = 3", "EPWM_HSCLOCK_DIVIDER_6 = 13")
        self.change("sysctl.h", r"\(\(\(x\) / 2U\) <<", "(((x) / 4U) <<")
        self.assertEqual(self.complaints(), ["DEVICE_SETCLOCK_CFG", "EPWM_HSCLOCK_DIVIDER_6", "SCIB_BASE", "SYSCTL_SYSDIV(2)",
                                             "SYSCTL_SYSDIV(40)"])

    def test_a_value_that_counts_on_by_itself_is_checked_too(self):
        self.change("gpio.h", r"GPIO_QUAL_SYNC, GPIO_QUAL_3SAMPLE", "GPIO_QUAL_3SAMPLE, GPIO_QUAL_SYNC")
        self.assertEqual(self.complaints(), ["GPIO_QUAL_3SAMPLE", "GPIO_QUAL_SYNC"])

    def test_a_parameter_or_result_that_differs_is_named(self):
        self.change("sci.h", r"uint16_t SCI_readCharNonBlocking", "uint32_t SCI_readCharNonBlocking")
        self.change("gpio.h", r"GPIO_writePin\(uint32_t pin, uint32_t outVal\)", "GPIO_writePin(uint32_t pin, uint16_t outVal)")
        self.change("sysctl.h", r"SysCtl_disableWatchdog\(void\)", "SysCtl_disableWatchdog(uint16_t how)")
        self.assertEqual(self.complaints(), ["GPIO_writePin", "SCI_readCharNonBlocking", "SysCtl_disableWatchdog"])

    def test_what_is_missing_is_named(self):
        self.change("sci.h", r"void SCI_setBaud\([^;]*;", "")
        self.change("pin_map.h", r"#define GPIO_2_EPWM2A .*\n", "")
        self.change("cpu.h", r"#define ESTOP0 .*\n", "")
        self.assertEqual(self.complaints(), ["ESTOP0", "GPIO_2_EPWM2A", "SCI_setBaud"])

    def test_a_header_that_ti_does_not_have_is_named(self):
        (self.top / WARE / "cputimer.h").unlink()
        self.assertEqual(self.complaints(), ["sim/ti/driverlib/cputimer.h: driverlib has no such header"])

    def test_differences_of_the_kernel_are_named(self):
        self.change("packages/ti/sysbios/knl/Semaphore.h", r"Bool Semaphore_pend\(Semaphore_Handle handle, UInt32 timeout\)",
                    "Bool Semaphore_pend(Semaphore_Handle handle, UInt16 timeout)")
        self.change("packages/ti/sysbios/knl/Swi.h", r"UInt priority;", "Int priority;")
        self.change("packages/ti/sysbios/knl/Task.h", r"Void \(\*Task_FuncPtr\)\(UArg arg0, UArg arg1\)",
                    "Void (*Task_FuncPtr)(UArg arg0)")
        self.change("packages/xdc/std.h", r"typedef unsigned short Bool;", "typedef unsigned int Bool;")
        self.change("packages/ti/sysbios/knl/Event.h", r"Event_Id_15 \(0x8000U\)", "Event_Id_15 (0x4000U)")
        found = self.complaints(kernel=True)
        self.assertEqual(found, ["Bool", "Event_Id_15", "Semaphore_pend", "Swi_Params.priority", "Task_FuncPtr"])


    def test_differences_of_the_flash_library_are_named(self):
        library = check_ti.flash_library(self.top)
        self.assertEqual(check_ti.compared(library), [])
        path = self.top / check_ti.FLASH_API / "F021_F2837xS_C28x.h"
        content = path.read_text(encoding="utf-8")
        for before, after in (("Fapi_EraseSector = 0x0006", "Fapi_EraseSector = 0x0008"), ("void Fapi_flushPipeline(void)", "int Fapi_flushPipeline(void)"),
                              ("Fapi_StatusType Fapi_serviceWatchdogTimer(void);", ""), ("typedef uint16_t uint16", "typedef uint32_t uint16")):
            self.assertIn(before, content)
            content = content.replace(before, after)
        path.write_text(content, encoding="utf-8")
        found = [each.split(": ")[1] for each in check_ti.compared(library)]
        self.assertEqual(found, ["Fapi_EraseSector", "Fapi_flushPipeline", "Fapi_serviceWatchdogTimer", "uint16"])

    def test_another_compiler_than_driverlibs_is_named(self):
        spec = self.top / WARE / "ccs/driverlib.projectspec"
        self.assertEqual(check_ti.compiler(check_ti.Project(), self.top), [])
        spec.parent.mkdir()
        spec.write_text('<project cgtVersion="22.6.3.LTS"/>', encoding="utf-8")
        self.assertEqual(check_ti.compiler(check_ti.Project(), self.top), [])
        spec.write_text('<project cgtVersion="20.2.5.LTS"/>', encoding="utf-8")
        self.assertEqual(len(check_ti.compiler(check_ti.Project(), self.top)), 1)

    def test_the_headers_of_the_hooks_are_where_the_check_looks(self):
        own = [each for each in re.findall(r'#include "(.+)"', check_ti.HOOKS) if each != "debug.h"]    # that one is driverlib's
        self.assertEqual([each for each in own if not (REPOSITORY / each).is_file()], [])
        self.assertEqual(len(own), 2)


class Read(unittest.TestCase):
    TEXT = """
        #ifndef A_H
        #define A_H
        #define ONE 1U /* not TWO */
        #define LONG (ONE + \\
                      1U)
        #define SHIFT(x) ((x) << 2)
        #define ESTOP0 abort()
        typedef enum { RED = 3, GREEN, BLUE = 0x10 } colour_t;
        typedef Void (*call_t)(UArg a, Ptr b);
        typedef struct Thing_Object *Thing_Handle;
        typedef unsigned int UInt;
        typedef struct {
            Instance *instance;
            UArg a, b;
            Instance __hidden;
        } Thing_Params;
        static inline Void Thing_init(Thing_Params *p) { *p = (Thing_Params){0}; if (p) { p->a = 1; } }
        Thing_Handle Thing_create(const Thing_Params *p,
                                  Int n);
        Void Thing_all(Void);
        const volatile uint16_t *driverlib_secret(uint32_t a);
        #endif
    """

    def setUp(self):
        self.found = declarations.Declarations().read(self.TEXT)

    def test_every_kind_of_declaration_is_read(self):
        self.assertEqual(self.found.values, ["ONE", "LONG", "RED", "GREEN", "BLUE"])
        self.assertEqual((self.found.macros, self.found.present), (["SHIFT"], ["ESTOP0"]))
        self.assertEqual(self.found.function_types, [("Void ", "call_t", "UArg a, Ptr b")])
        self.assertEqual(self.found.aliases, [("unsigned int", "UInt")])
        self.assertEqual(self.found.fields, [("Thing_Params", "Instance *", "instance"), ("Thing_Params", "UArg", "a"),
                                             ("Thing_Params", "UArg", "b")])
        self.assertEqual(self.found.functions, [("Void", "Thing_init", "Thing_Params *p"),
                                                ("Thing_Handle", "Thing_create", "const Thing_Params *p, Int n"),
                                                ("Void", "Thing_all", "Void")])

    def test_no_declaration_of_sim_is_left_unread(self):
        # Counted another way: names before a parenthesis at the start of a line.
        for library in (check_ti.driverlib("."), check_ti.sysbios(".", ".")):
            read, counted = declarations.Declarations(), set()
            for header in library.headers:
                content = (library.stand_in / header).read_text(encoding="utf-8")
                read.read(content)
                counted |= set(re.findall(r"^(?!typedef)[A-Za-z][\w \*]*?\b(\w+)\(", declarations.COMMENT.sub("", content), re.MULTILINE))
            self.assertEqual({name for _, name, _ in read.functions}, {each for each in counted if not each.startswith("driverlib_")})


class Ours(unittest.TestCase):
    def test_the_script_runs_on_stand_in_headers_from_the_command_line(self):
        environment = {key: value for key, value in os.environ.items() if not key.endswith("_ROOT")}
        with tempfile.TemporaryDirectory() as directory:
            shutil.copytree(REPOSITORY / "sim/ti/driverlib", Path(directory) / WARE, ignore=shutil.ignore_patterns("*.c"))
            environment.update(C2000WARE_ROOT=directory, HOME=directory)
            done = subprocess.run([sys.executable, "-B", str(REPOSITORY / "tools/ti/check_ti.py")], env=environment,
                                  capture_output=True, text=True, check=False)
        self.assertIn(done.returncode, (0, 77), done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"driverlib: \d+ functions, \d+ types and fields, \d+ values")


if __name__ == "__main__":
    unittest.main()
