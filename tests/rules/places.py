"""One place per fact: what a recipe of CONTRIBUTING.md promises is counted on one witness of each kind.

Usage: places.py ROOT. A witness is a name that stands in the product (and in sim/ and tools/) only where a thing of its kind
must be told. A file more is a place more that the next owner has to know of.
"""
import re
import sys
from pathlib import Path

import house

ROOMS = ("control", "drivers", "bsp", "firmware", "sim", "tools/plomada")
WITNESSES = {    # name: the files that a thing of its kind is told in
    r"\binnovation_mm\b": ("a published field", {"control/flight_io.h", "control/outputs.c", "firmware/published.h"}),
    r'"VUP"': ("a parameter", {"control/parameters.c"}),    # and its name in the enum of parameters.h
    r'"climb-rate"': ("a scenario", {"sim/scenarios/scenarios.c"}),
}


def check(root, rooms=ROOMS):
    files = [file for room in rooms for file in sorted((root / room).rglob("*")) if file.suffix in (".c", ".h")]
    texts = {file.relative_to(root).as_posix(): file.read_text(encoding="utf-8") for file in files}
    for name, (kind, expected) in WITNESSES.items():
        found = {path for path, text in texts.items() if re.search(name, house.without_comments(text))}
        for path in sorted(found - expected):
            yield f"{path}: names {name}: {kind} has a place more than CONTRIBUTING.md tells"
        for path in sorted(expected - found):
            yield f"{path}: does not name {name} any more: mend CONTRIBUTING.md and this rule"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    house.report(list(check(Path(sys.argv[1]))), "places")
