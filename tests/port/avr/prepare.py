"""Writes what the simulated machine is given to compile, into the directory OUT: Unity's runners without the tests of
left_out.txt, in OUT/runners; everything again for cells of 16 bits, in OUT/cells. What would not change is left untouched.
"""
import argparse
import re
import subprocess
import sys
from pathlib import Path

import cells


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


def left_out(table):
    """[(program, test)] of left_out.txt."""
    rows = [line.split(None, 2) for line in table.splitlines() if line.strip() and not line.startswith("#")]
    for row in rows:
        if len(row) < 3:
            raise ValueError(f"left_out.txt: {' '.join(row)}: no reason")
    return [tuple(row[:2]) for row in rows]


def without(runner, tests):
    for test in tests:
        runner, removed = re.subn(rf"^.*\brun_test\({test},.*\n", "", runner, flags=re.MULTILINE)
        if removed != 1:
            raise ValueError(f"left_out.txt: there is no {test}")
    return runner


def flat(text):
    """The cells stand in one directory: an include of theirs names the file alone."""
    return re.sub(r'^(#include ")(?:(?:control|drivers|tests/support|sense|est|where)/(?:\w+/)*)(\w+\.[ch]")', r"\1\2", text, flags=re.MULTILINE)


def generate(generator, test, runner):
    if not runner.exists() or runner.stat().st_mtime <= max(test.stat().st_mtime, generator.stat().st_mtime):
        runner.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run(["ruby", "-W0", generator, "--use_param_tests=1", "--main_name=suite_main", test, runner], check=True,
                       stdout=subprocess.DEVNULL)
    return runner.read_text(encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--generator", type=Path, required=True)
    parser.add_argument("--left-out", type=Path, required=True)
    parser.add_argument("--tests", type=Path, nargs="+", required=True)
    parser.add_argument("--sources", type=Path, nargs="+", required=True)
    options = parser.parse_args()
    rows = left_out(options.left_out.read_text(encoding="utf-8"))
    runners = []
    for test in options.tests:
        text = generate(options.generator, test, options.out / "all" / f"{test.stem}_runner.c")
        runners.append(options.out / "runners" / f"{test.stem}_runner.c")
        write(runners[-1], without(text, [name for program, name in rows if program == test.stem]))
    for source in options.sources + options.tests + runners:
        write(options.out / "cells" / source.name, flat(cells.convert(source.read_text(encoding="utf-8"), source)))


if __name__ == "__main__":
    try:
        main()
    except ValueError as error:
        sys.exit(str(error))
