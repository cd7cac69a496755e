"""The tables of docs/operator.md tell the fields that the firmware publishes, with their units and decimals.

Usage: published.py ROOT

The table PUBLISHED of firmware/published.h is what there is. A number's unit is the end of its column's name. The
document's tables are those whose titles begin with | field | unit | decimals | and | column | unit | decimals |;
a row may name several, `roll_rad`, `pitch_rad`.
"""
import re
import sys
from pathlib import Path

import house

UNITS = {"m": "m", "n": "N", "v": "V", "rad": "rad", "mps": "m/s", "mps2": "m/s²", "us": "us", "s": "s"}
NUMBER = re.compile(r'NUMBER\((NULL|"\w+"), *(\d+)U, *(NULL|"\w+"), *(\d+)U, *(\d+)U, *[\w.]+, *FLIGHT_LOG_\w+\)')
OTHER = re.compile(r"(STATE|FLAGS|TEXT)\(([^)]*)\)")
DERIVED = re.compile(r'DERIVED\("(\w+)", *(\d+)U, *\d+U, *[\w.]+, *\w+, *[\w.]+\)')
BEAM = re.compile(r'BEAM\("(\w+)", *\w+\)')
SET = re.compile(r'SET\("(\w+)", *[\w.]+\)')
NAME = re.compile(r'NAME\("(\w+)", *[\w.]+, *\w+, *\d+U, *\d+U\)')
PARTS = {"rays": ("-", "0"), "mm": ("mm", "0"), "spread_mm": ("mm", "0"), "ms": ("ms", "0"), "lie": ("%", "0")}  # of a beam
MORE = {"t_s", "height_m", "abs_m", "terrain_m"}  # the time, and what only the PC board knows


def name_of(cell):
    return None if cell == "NULL" else cell.strip('" ')


def unit_of(column):
    return UNITS.get(column.rsplit("_", 1)[-1], f"unknown to published.py ({column})")


def published(source):
    """({telemetry field: (unit, decimals)}, {column: (unit, decimals)}), in the order of the table; the beams' parts one by one."""
    rows = re.search(r"#define PUBLISHED\(NUMBER.*?(?=\n/\* clang-format on)", source, re.S).group(0).split("\\\n")[1:]
    fields, columns, beams = {}, {}, []
    for row in rows:
        number, other = NUMBER.search(row), OTHER.search(row)
        if number:
            telemetry, decimals, column, log_decimals, _ = number.groups()
            column = name_of(column)
            columns[column] = (unit_of(column), log_decimals)
            if name_of(telemetry):
                fields[name_of(telemetry)] = (unit_of(column), decimals)
        elif derived := DERIVED.search(row):
            columns[derived.group(1)] = (unit_of(derived.group(1)), derived.group(2))
        elif beam := BEAM.search(row):
            beams.append(beam.group(1))
        elif name := NAME.search(row):
            columns[name.group(1)] = ("-", "-")
        elif name := SET.search(row):
            columns |= {f"{mirror}_{part}": told for part, told in PARTS.items() for mirror in beams}
            columns[name.group(1)] = ("-", "-")
        elif other:
            names = [name_of(cell) for cell in other.group(2).split(",")]
            if names[0]:
                fields[names[0]] = ("-", "-")
            if other.group(1) != "TEXT" and names[1]:
                columns[names[1]] = ("-", "-")
        else:
            raise ValueError(f"firmware/published.h: no row: {row.strip()}")
    return fields, columns


def documented(text, title):
    """{name: (unit, decimals)} of the table whose first column is called so."""
    table = re.search(rf"^\| {title} \| unit \| decimals \|.*\n\|[-|]+\|\n((?:\|.*\n)+)", text, re.M)
    found = {}
    for line in table.group(1).splitlines() if table else ():
        cells = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        for name in re.findall(r"`(\w+)`", cells[0]):
            found[name] = (cells[1], cells[2])
    return found


def compare(title, expected, found):
    for name, (unit, decimals) in expected.items():
        if name not in found:
            yield f"docs/operator.md: no row for the {title} `{name}`"
        elif found[name] != (unit, decimals):
            yield f"docs/operator.md: {title} `{name}` has unit and decimals {found[name]}, published are {(unit, decimals)}"
    for name in found:
        if name not in expected:
            yield f"docs/operator.md: the {title} `{name}` is not published"
    if [name for name in found if name in expected] != [name for name in expected if name in found]:
        yield f"docs/operator.md: the rows of the {title}s are in another order than published"


def names(root, path, table):
    """The names in a table of C: [THING] = "NAME", without the one that says none."""
    source = re.search(rf"{table}\[\] = {{(.*?)}};", (root / path).read_text(encoding="utf-8"), re.S).group(1)
    return [name for name in re.findall(r'= "([^"]+)"', source) if name != "-"]


def meanings(root, text):
    """Each reason of a doubt and each limit has a row in the document, in the order of the enum, and no row is of another."""
    for path, table, title in (("control/sense/verdict.c", "reason_names", "doubt"), ("control/bounds.c", "names", "limit")):
        rows = re.search(rf"^\| {title} \|.*\n\|[-|]+\|\n((?:\|.*\n)+)", text, re.M)
        told = re.findall(r"^\| `([^`]+)` \|", rows.group(1), re.M) if rows else []
        if told != names(root, path, table):
            yield f"docs/operator.md: the table of each {title} has {told}, {path} {names(root, path, table)}"


def check(root):
    fields, columns = published((root / "firmware/published.h").read_text(encoding="utf-8"))
    text = (root / "docs/operator.md").read_text(encoding="utf-8")
    told = {name: row for name, row in documented(text, "column").items() if name not in MORE}
    return [*compare("field", fields, documented(text, "field")), *compare("column", columns, told), *meanings(root, text)]


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    house.report(check(Path(sys.argv[1])), "published")
