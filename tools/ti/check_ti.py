"""The target sources against TI's own headers: syntax and types, by the host's gcc with -Werror; and what sim/ declares
in TI's stead against what TI declares.

Needs C2000WARE_ROOT for bsp/, BIOS_ROOT and XDC_ROOT for firmware/ (or TI's usual places, docs/flashing.md).
Exit status: 0 all is as TI has it; 1 something differs; 2 a root that is given is none; 77 a root is missing, what could
be checked is right.
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import declarations
import roots
from ccs_project import REPOSITORY, Project

SKIPPED = 77
PRELUDE = Path(__file__).with_name("prelude.h")
GCC = [os.environ.get("CC", "gcc"), "-x", "c", "-std=gnu99", "-fsyntax-only", "-Wall", "-Wextra", "-Wconversion", "-Wsign-conversion",
       "-Wshadow", "-Wstrict-prototypes", "-Wmissing-prototypes", "-Wcast-qual", "-Wundef", "-Werror"]
# TI's addresses are 32 bits wide, the host's pointers 64; its pragmas are its own.
HOST = ["-Wno-int-to-pointer-cast", "-Wno-pointer-to-int-cast", "-Wno-unknown-pragmas"]
STAND_IN_ONLY = {"chip.h", "model.h"}
# Its types: those of C28x compilers, twice as wide on the host, or the host's own.
HOST_TYPES = "#undef __TMS320C28XX__\n"
FLASH_API = "libraries/flash_api/f2837xs/include"
HOOKS = ('#include <xdc/std.h>\n#include <xdc/runtime/Error.h>\n#include <xdc/runtime/System.h>\n#include "firmware/fault.h"\n'
         '#include "debug.h"\nError_HookFxn fault_hook_1 = fault_error;\nSystem_AbortFxn fault_hook_2 = fault_abort;\n'
         'System_ExitFxn fault_hook_3 = fault_exit;\n#include <ti/sysbios/interfaces/IHwi.h>\n#include "firmware/cpu_time.h"\n'
         'Task_HookSet task_hooks = {.switchFxn = cpu_time_task_switch};\n'
         'Swi_HookSet swi_hooks = {.beginFxn = cpu_time_swi_begin, .endFxn = cpu_time_swi_end};\n'
         'typedef __typeof__(((Hwi_HookSet *)0)->beginFxn) hwi_hook_t;\n'
         'Hwi_HookSet hwi_hooks = {.beginFxn = (hwi_hook_t)cpu_time_hwi_begin, .endFxn = (hwi_hook_t)cpu_time_hwi_end};\n')


class Library:
    """One of TI's libraries: its include directories, its stand-in, the room that uses it, what C text comes first."""

    def __init__(self, name, stand_in, headers, includes, defines, room, first=""):
        self.name, self.room, self.first = name, room, first
        self.stand_in, self.headers = REPOSITORY / stand_in, headers
        self.includes = includes
        self.gcc = [*GCC, *HOST, "-include", str(PRELUDE), *defines,
                    f"-I{REPOSITORY}",
                    *(word for each in includes for word in ("-isystem", str(each)))]


def headers_of(stand_in):
    base = REPOSITORY / stand_in
    return sorted(path.relative_to(base).as_posix() for path in base.rglob("*.h") if path.name not in STAND_IN_ONLY)


def driverlib(ware):
    includes = [Path(ware) / "driverlib/f2837xs/driverlib", Path(ware) / "device_support/f2837xs/common/include"]
    # TI's repository of C2000Ware has no flash library (the installer has): then bsp/storage.c is read with sim/'s declarations of it.
    flash_api = Path(ware) / FLASH_API if (Path(ware) / FLASH_API).is_dir() else REPOSITORY / "sim/ti/f021/include"
    return Library("driverlib", "sim/ti/driverlib", headers_of("sim/ti/driverlib"), [*includes, flash_api],
                   ["-DCPU1", "-D_LAUNCHXL_F28377S"], "bsp")


def flash_library(ware):
    """The rest of bsp/ is read with driverlib: here only the declarations are compared."""
    here = "sim/ti/f021/include"
    return Library("F021 flash library", here, headers_of(here), [Path(ware) / FLASH_API], [], "bsp", HOST_TYPES)


def sysbios(bios, xdc):
    here = "sim/ti/sysbios"
    headers = [each for each in headers_of(here) if each.split("/")[0] in ("xdc", "ti")]
    return Library("SYS/BIOS", here, headers, [Path(bios) / "packages", Path(xdc) / "packages"],
                   ["-Dxdc__strict", "-Dxdc_target_types__=ti/targets/std.h", "-Dxdc_target_name__=C28_float"], "firmware")


def run(command, text):
    return subprocess.run([*command, "-"], input=text, capture_output=True, text=True, check=False)


def sources(library):
    """Complaints of gcc about each source file of the library's room."""
    listed = [path for path in Project().files(".c") if path.parent.name == library.room]
    complaints = []
    for path in listed:
        for debug in ([], ["-DDEBUG"]) if library.room == "bsp" else ([],):
            done = subprocess.run([*library.gcc, *debug, str(path)], capture_output=True, text=True, check=False)
            complaints += [done.stderr.strip()] if done.returncode else []
    print(f"{library.name}: {len(listed)} files of {library.room}/")
    return complaints


def included(library):
    return library.first + "".join(f"#include <{header}>\n" for header in library.headers)


def failing(library, checks):
    """{name: gcc's first words} of the checks that do not compile."""
    found = {}
    command = [word for word in library.gcc if word not in ("-Wextra", "-Wmissing-prototypes", "-Wcast-qual")]
    text = included(library)
    for number, (name, check) in enumerate(checks.items()):
        own = re.sub(r"\b(pointer|nothing)\b", rf"\1_{number}", check)
        text += f'#line 1 "{name}"\n{own}\n'
    for line in run(command, text).stderr.splitlines():
        match = re.match(r"(.+?):\d+:(?:\d+:)? (?:fatal )?error: (.*)", line)
        if match:
            found.setdefault(match.group(1), match.group(2))
    return found


def stand_in_values(library, found):
    """{expression: value} as sim/'s headers have them, by a program that prints them."""
    wanted = declarations.expressions(found)
    lines = "".join(f'    printf("%llu\\n", (unsigned long long)({each}));\n' for each in wanted)
    text = f"#include <stdio.h>\n{included(library)}int main(void)\n{{\n{lines}    return 0;\n}}\n"
    with tempfile.TemporaryDirectory() as directory:
        program = Path(directory) / "values"
        done = run([GCC[0], "-x", "c", "-std=gnu99", f"-I{library.stand_in}", "-o", str(program)], text)
        if done.returncode:
            sys.exit(f"{library.name}: sim/'s own headers do not compile:\n{done.stderr}")
        printed = subprocess.run([program], capture_output=True, text=True, check=True).stdout
    return dict(zip(wanted, printed.split()))


def compared(library):
    """Complaints about what sim/ declares otherwise than TI."""
    absent = [each for each in library.headers if not any((directory / each).is_file() for directory in library.includes)]
    if absent:
        return [f"{library.stand_in.relative_to(REPOSITORY)}/{each}: {library.name} has no such header" for each in absent]
    found = declarations.Declarations()
    for header in library.headers:
        found.read((library.stand_in / header).read_text(encoding="utf-8"))
    types = declarations.type_checks(found)
    values = declarations.value_checks(stand_in_values(library, found))
    wrong = {**failing(library, types), **failing(library, values)}
    print(f"{library.name}: {len(found.functions)} functions, {len(types) - len(found.functions)} types and fields, "
          f"{len(values)} values that sim/ declares")
    return [f"{library.name}: {name}: {why}" for name, why in sorted(wrong.items())]


def hooks(ware, bios, xdc):
    """Complaints of gcc when the functions of firmware/fault.h and firmware/cpu_time.h are given to whom TI calls them by.
    A Hwi's hooks get its handle as the one of the interface that it implements."""
    kernel, registers = sysbios(bios, xdc), driverlib(ware)
    return [run([*kernel.gcc, "-DDEBUG", "-isystem", str(registers.includes[0])], HOOKS).stderr.strip()]


def compiler(project, ware):
    """Complaints when TI built driverlib by another release of the compiler than the project names."""
    spec = Path(ware) / "driverlib/f2837xs/driverlib/ccs/driverlib.projectspec"
    built = re.search(r'cgtVersion="([^"]+)"', spec.read_text(encoding="utf-8")) if spec.is_file() else None
    named = project.attributes["cgtVersion"]
    return [f"driverlib is of compiler {built.group(1)}, the project names {named}"] if built and built.group(1) != named else []


def looked_up(project, *variables):
    """The roots, or None; says which are missing and ends the program when one that is given is none."""
    found = {variable: roots.look_up(variable, project) for variable in variables}
    for variable, (_, why) in found.items():
        if why:
            print(why, flush=True)
            if os.environ.get(variable):
                sys.exit(roots.USAGE_ERROR)
    paths = [path for path, _ in found.values()]
    return None if None in paths else paths


def main():
    project = Project()
    ware, kernel = looked_up(project, "C2000WARE_ROOT"), looked_up(project, "BIOS_ROOT", "XDC_ROOT")
    complaints = []
    for library in ([driverlib(*ware)] if ware else []) + ([sysbios(*kernel)] if kernel else []):
        complaints += sources(library) + compared(library)
    if ware and (ware[0] / FLASH_API).is_dir():
        complaints += compared(flash_library(*ware))
    elif ware:
        print(f"{ware[0]} has no {FLASH_API}: bsp/storage.c was read with sim/'s declarations of the flash library")
    complaints += compiler(project, *ware) if ware else []
    complaints += hooks(*ware, *kernel) if ware and kernel else []
    complaints = [each for each in complaints if each]
    for each in complaints:
        print(each)
    return 1 if complaints else 0 if ware and kernel else SKIPPED


if __name__ == "__main__":
    sys.exit(main())
