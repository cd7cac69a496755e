"""Puts an image into the LaunchPad's flash by the XDS100v2 on its USB, with DSLite of CCS, and starts it.

Usage: flash.py [IMAGE], by default build-firmware/Release/plomada.out. Needs CCS_ROOT (docs/flashing.md).
"""
import subprocess
import sys
from pathlib import Path

import roots
from ccs_project import REPOSITORY, Project


def main():
    project = Project()
    image = Path(sys.argv[1]) if len(sys.argv) > 1 else REPOSITORY / "build-firmware" / "Release" / f"{project.name}.out"
    at = roots.require("CCS_ROOT")
    if not image.is_file():
        print(f"{image}: no such image; make firmware builds it", file=sys.stderr)
        sys.exit(roots.USAGE_ERROR)
    dslite = at["CCS_ROOT"] / "ccs_base" / "DebugServer" / "bin" / "DSLite"
    command = [str(word) for word in (dslite, "load", "-c", project.files(".ccxml")[0], "-f", image)]
    sys.exit(1 if subprocess.run(command, check=False).returncode else 0)


if __name__ == "__main__":
    main()
