"""A function of the product has at most 40 lines between its braces."""
import re

import house

LIMIT = 40
EXCUSES = "tests/rules/excuses.txt"
# A brace after `)` outside of any other brace opens a function's body.
OPENING = re.compile(r"(\w+)\s*\([^;{}]*\)\s*\{")


def functions(text):
    """(name, line, lines between the braces) of each function."""
    code = re.sub(r"^[ \t]*#(?:\\\n|[^\n])*", house.blank, house.code_only(text), flags=re.MULTILINE)
    position = 0
    while True:
        brace = code.find("{", position)
        if brace < 0:
            return
        depth, end = 1, brace + 1
        while depth and end < len(code):
            depth += {"{": 1, "}": -1}.get(code[end], 0)
            end += 1
        match = OPENING.search(code, position, brace + 1)
        if match:
            yield match.group(1), house.line_of(code, match.start()), max(0, code.count("\n", brace, end) - 1)
        position = end


def check(the_house):
    excused = house.excuses(the_house, "length")
    complaints, used = [], set()
    for path in (path for room in house.PRODUCT for path in the_house.sources(room, ".c", ".h")):
        for name, line, lines in functions(the_house.text(path)):
            thing = f"{path}:{name}"
            if lines > LIMIT and thing in excused:
                used.add(thing)
                print(f"{path}:{line}: {name} has {lines} lines, excused: {excused[thing]}")
            elif lines > LIMIT:
                complaints.append(f"{path}:{line}: {name} has {lines} lines, {LIMIT} are enough")
    complaints += [f"{EXCUSES}: {thing} needs no excuse" for thing in sorted(set(excused) - used)]
    return complaints


if __name__ == "__main__":
    house.main(check)
