"""Where TI's tools are: an environment variable for each, or the versions of the CCS project in TI's usual places."""
import os
import sys
from pathlib import Path

from ccs_project import Project

USAGE_ERROR = 2
PLACES = [Path("C:/ti")] if os.name == "nt" else [Path.home() / "ti", Path("/opt/ti"), Path("/Applications/ti")]


def wanted(project):
    """{variable: (what it is, a file in it, directories under TI's places)}"""
    bios, xdc, ware = ("_".join(project.versions()[name]) for name in ("SYSBIOS", "XDCTOOLS", "C2000WARE"))
    cgt = f"ti-cgt-c2000_{project.attributes['cgtVersion']}"
    return {
        "CCS_ROOT": ("Code Composer Studio, its directory ccs", "ccs_base", ["ccs*/ccs", "ccs"]),
        "BIOS_ROOT": (f"SYS/BIOS, bios_{bios}", "packages/ti/sysbios/package.xdc", [f"bios_{bios}", f"ccs*/bios_{bios}"]),
        "XDC_ROOT": (f"XDCtools, xdctools_{xdc}_core", "packages/xdc/package.xdc",
                     [f"xdctools_{xdc}_core", f"xdctools_{xdc}", f"ccs*/xdctools_{xdc}_core"]),
        "CGT_ROOT": (f"the C2000 compiler, {cgt}", "include/stdint.h",
                     [cgt, f"ccs*/ccs/tools/compiler/{cgt}", f"ccs*/tools/compiler/{cgt}"]),
        "C2000WARE_ROOT": (f"C2000Ware, C2000Ware_{ware}", "driverlib/f2837xs/driverlib/sysctl.h",
                           [f"c2000/C2000Ware_{ware}", f"C2000Ware_{ware}"]),
    }


def look_up(variable, project, places=None):
    """(path, None) or (None, why not)."""
    what, marker, patterns = wanted(project)[variable]
    given = os.environ.get(variable)
    if given:
        there = (Path(given) / marker).exists()
        return (Path(given), None) if there else (None, f"{variable}={given}: no {marker} in it; it must be {what}")
    for place in PLACES if places is None else places:
        for pattern in patterns:
            for path in sorted(place.glob(pattern), reverse=True) if place.is_dir() else []:
                if (path / marker).exists():
                    return path, None
    return None, f"{variable} is not set, and {what} is not in " + ", ".join(map(str, PLACES if places is None else places))


def require(*variables):
    """{variable: path}; ends the program with status 2 and one line per missing one."""
    project = Project()
    found = {variable: look_up(variable, project) for variable in variables}
    missing = [why for _, why in found.values() if why]
    for why in missing:
        print(why, file=sys.stderr)
    if missing:
        print("See docs/flashing.md.", file=sys.stderr)
        sys.exit(USAGE_ERROR)
    return {variable: path for variable, (path, _) in found.items()}
