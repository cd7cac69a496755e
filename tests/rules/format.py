"""Every .c and .h file is as clang-format writes it by .clang-format.

Usage: format.py [--write] [ROOT]. The version is pinned (tools/format/requirements.txt), because each version breaks lines
another way; tools/setup/setup.sh test puts it into build/format. Exit status 77 when it is not there.
"""
import argparse
import re
import subprocess
import sys
from pathlib import Path

import house

ROOMS = (*house.PRODUCT, "sim", "tests", "tools", "examples", "course", "docs", "hil", "ground")


def files(the_house):
    """The C files, but for recordings and what is installed."""
    for room in ROOMS:
        if (the_house.root / room).is_dir():
            yield from (path for path in the_house.sources(room, ".c", ".h") if not re.search(r"^tests/fixtures/|/node_modules/|/build", path))


def check(the_house, program, write=False):
    paths = [str(path) for path in files(the_house)]
    done = subprocess.run([program, "--style=file", *(["-i"] if write else ["--dry-run"]), *paths], cwd=the_house.root,
                          check=True, capture_output=True, text=True)
    first = {}
    for path, line in re.findall(r"^(.+?):(\d+):\d+: warning: code should be clang-formatted", done.stderr, re.MULTILINE):
        first.setdefault(path, line)
    return [f"{path}:{line}: not as clang-format writes it: make format" for path, line in first.items()]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("root", nargs="?", default=Path(__file__).resolve().parents[2])
    options = parser.parse_args()
    home = house.House(options.root)
    tool = home.root / "build/format/bin/clang-format"
    if not tool.exists():
        print("no build/format: tools/setup/setup.sh test")
        sys.exit(77)
    house.report(check(home, tool, options.write), "format")
