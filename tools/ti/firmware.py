"""The target image without CCS: configuro, cl2000 and its linker, as ccs_project/plomada.projectspec says.

Usage: firmware.py [--config Release|Debug] [--out DIR]; writes DIR/CONFIG/plomada.out and .map, DIR is build-firmware.
Needs BIOS_ROOT, XDC_ROOT, CGT_ROOT and C2000WARE_ROOT (docs/flashing.md); exit status 2 names the missing ones.
"""
import argparse
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import roots
from ccs_project import REPOSITORY, Project

GENERATED = "configPkg"
# The compiler's options that say for which processor, and how it computes: the linker chooses the C library by them.
PROCESSOR = ("-v", "-ml", "-mt", "--float_support", "--fp_mode", "--abi")


def configuro(project, at):
    """Makes SYS/BIOS of app.cfg: its sources and library, compiler.opt, linker.cmd."""
    return [at["XDC_ROOT"] / "xs", f"--xdcpath={(at['BIOS_ROOT'] / 'packages').as_posix()};", "xdc.tools.configuro",
            "-o", GENERATED, "-t", project.properties["target"], "-p", project.properties["platform"],
            "-r", project.properties["buildProfile"], "-c", at["CGT_ROOT"],
            *shlex.split(project.properties["configuroOptions"]), "app.cfg"]


def compile_one(project, configuration, at, source):
    options = project.options(configuration, "compilerBuildOptions", COM_TI_C2000WARE_INSTALL_DIR=at["C2000WARE_ROOT"])
    return [at["CGT_ROOT"] / "bin" / "cl2000", *options, f"--cmd_file={GENERATED}/compiler.opt",
            f"-I{at['CGT_ROOT'] / 'include'}", f"--output_file={source.stem}.obj", source]


def link(project, configuration, at):
    options = project.options(configuration, "linkerBuildOptions", COM_TI_C2000WARE_INSTALL_DIR=at["C2000WARE_ROOT"])
    compiled = project.options(configuration, "compilerBuildOptions", COM_TI_C2000WARE_INSTALL_DIR=at["C2000WARE_ROOT"])
    return [at["CGT_ROOT"] / "bin" / "cl2000", *(word for word in compiled if word.startswith(PROCESSOR)), "--run_linker",
            f"--map_file={project.name}.map", f"--output_file={project.name}.out",
            f"--search_path={at['CGT_ROOT'] / 'lib'}", f"--search_path={at['CGT_ROOT'] / 'include'}",
            *(f"{source.stem}.obj" for source in project.files(".c")),
            f"{GENERATED}/linker.cmd", *project.files(".cmd"), *options, "--library=libc.a"]


def run(command, directory):
    words = [str(word) for word in command]
    print(shlex.join(words), flush=True)
    if subprocess.run(words, cwd=directory, check=False).returncode:
        sys.exit(1)


def main():
    project = Project()
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--config", choices=sorted(project.configurations), default="Release")
    parser.add_argument("--out", type=Path, default=REPOSITORY / "build-firmware")
    options = parser.parse_args()
    at = roots.require("BIOS_ROOT", "XDC_ROOT", "CGT_ROOT", "C2000WARE_ROOT")
    directory = (options.out / options.config).resolve()
    directory.mkdir(parents=True, exist_ok=True)
    # A copy: SYS/BIOS writes the sources of its library into src/ beside this file.
    shutil.copy(project.files("app.cfg")[0], directory)
    run(configuro(project, at), directory)
    for source in project.files(".c"):
        run(compile_one(project, options.config, at, source), directory)
    run(link(project, options.config, at), directory)
    print(directory / f"{project.name}.out")


if __name__ == "__main__":
    main()
