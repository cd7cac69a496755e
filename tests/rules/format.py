"""Every .c and .h file is as clang-format writes it by .clang-format.

Usage: format.py [--write] [ROOT]. The version is pinned (tools/format/requirements.txt), because each version breaks lines
another way; tools/setup/setup.sh test puts it into build/format. Exit status 77 when it is not there.
"""
import argparse
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import house

ROOMS = (*house.PRODUCT, "sim", "tests", "tools", "docs", "hil", "ground")


def files(the_house):
    """The C files, but for recordings and what is installed."""
    for room in ROOMS:
        if (the_house.root / room).is_dir():
            yield from (path for path in the_house.sources(room, ".c", ".h") if not re.search(r"^tests/fixtures/|/node_modules/|/build", path))


def formatted(program, the_house, path):
    return subprocess.run([program, "--style=file", f"--assume-filename={path}"], input=the_house.text(path), cwd=the_house.root,
                          check=True, capture_output=True, text=True).stdout


def check(the_house, program, write=False):
    paths = list(files(the_house))
    complaints = []
    with ThreadPoolExecutor(2) as pool:
        for path, text in zip(paths, pool.map(lambda path: formatted(program, the_house, path), paths)):
            before = the_house.text(path)
            if text != before and write:
                (the_house.root / path).write_text(text, encoding="utf-8")
            elif text != before:
                first = next((n for n, (a, b) in enumerate(zip(before.splitlines(), text.splitlines()), 1) if a != b), 1)
                complaints.append(f"{path}:{first}: not as clang-format writes it: make format")
    return complaints


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
