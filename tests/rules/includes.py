"""Which room may include what."""
import re

import house

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(.*?)[ \t]*$', re.MULTILINE)
TARGET = re.compile(r'^([<"])([^>"]+)[>"]$')

STANDARD = {f"{name}.h" for name in ("float", "limits", "math", "stdbool", "stddef", "stdint", "string")}
DRIVERLIB = re.compile(r"^(?:driverlib/)?(?:driverlib|device|adc|asysctl|cputimer|epwm|flash|gpio|interrupt|pin_map|sci|sysctl|xbar|version|debug)\.h$"
                       r"|^inc/hw_\w+\.h$|^hw_\w+\.h$|^F021_F2837xS_C28x\.h$")
SYSBIOS = re.compile(r"^(?:xdc|ti/sysbios)/[\w/]+\.h$")

# room: rooms whose headers it may include
NEIGHBOURS = {
    "control": ("control",),
    "drivers": ("drivers",),
    "bsp": ("bsp",),
    "firmware": ("firmware", "control", "drivers", "bsp"),
}
# The PC board's libraries, clock and devices hear nothing of the product, so that no error is on both sides of a wire.
DEAF = ("sim/ti", "sim/devices")


def check(the_house):
    complaints = []
    for room in house.PRODUCT:
        own = {neighbour: set(the_house.sources(neighbour, ".h"))
               for neighbour in NEIGHBOURS[room]}
        for path in the_house.sources(room, ".c", ".h"):
            for line, mark, name in includes(the_house.text(path)):
                complaint = objection(room, path, mark, name, own)
                if complaint:
                    complaints.append(f"{path}:{line}: {complaint}")
    for place in DEAF:
        for path in the_house.sources(place, ".c", ".h"):
            for line, mark, name in includes(the_house.text(path)):
                if name and name.split("/")[0] in house.PRODUCT or names_product_header(the_house, place, mark, name):
                    complaints.append(f"{path}:{line}: {place}/ shares nothing with the product, but includes {name}")
    return complaints


def names_product_header(the_house, place, mark, name):
    """A quoted name without a directory that is a header of the product and none of its own."""
    return (mark == '"' and "/" not in name
            and not any(path.endswith("/" + name) for path in the_house.sources("sim", ".h"))
            and any(path.endswith("/" + name) for room in house.PRODUCT for path in the_house.sources(room, ".h")))


def includes(text):
    for match in INCLUDE.finditer(house.without_comments(text)):
        target = TARGET.match(match.group(1))
        line = house.line_of(text, match.start(1))
        yield (line, *target.groups()) if target else (line, "?", match.group(1))


def objection(room, path, mark, name, own):
    if mark == "?":
        return f"include of a macro, {name}: write the header's name"
    if mark == '"' and any(name in headers for headers in own.values()):
        return None
    if mark == '"' and any(path.endswith("/" + name) for headers in own.values() for path in headers):
        return f"{name}: name the room too"
    if mark == "<" and name in STANDARD:
        return None
    if room == "bsp" and DRIVERLIB.match(name):
        return None if path.endswith(".c") else f"{name}: driverlib in .c files only"
    if room == "firmware" and mark == "<" and SYSBIOS.match(name):
        return None
    return f"{room}/ may not include {mark}{name}{'>' if mark == '<' else mark}"


if __name__ == "__main__":
    house.main(check)
