"""cmake/sources.cmake names every .c file of the product, and no other; ccs_project/ holds none."""
import re

import house

LISTS = "cmake/sources.cmake"


def listed(the_house):
    """{room: [paths]} as in cmake/sources.cmake."""
    text = re.sub(r"#.*", "", the_house.text(LISTS))
    return {name.lower(): paths.split() for name, paths in re.findall(r"set\((\w+)_SOURCES\s+([^)]*)\)", text)}


def check(the_house):
    lists = listed(the_house)
    complaints = [f"{LISTS}: no list {room.upper()}_SOURCES" for room in house.PRODUCT if room not in lists]
    for room in house.PRODUCT:
        named, present = lists.get(room, []), the_house.sources(room, ".c")
        complaints += [f"{path}: not in {LISTS}" for path in present if path not in named]
        complaints += [f"{LISTS}: {path} does not exist" for path in named if path not in present]
        complaints += [f"{LISTS}: {path} twice" for path in sorted(set(named)) if named.count(path) > 1]
    complaints += [f"{path}: ccs_project/ holds no source file" for path in the_house.sources("ccs_project", ".c", ".h", ".asm")]
    return complaints


if __name__ == "__main__":
    house.main(check)
