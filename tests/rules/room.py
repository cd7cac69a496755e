"""The control room stays a room that one person can hold: small files, small structs, plain functions, no circles.

Counted as architects do, by text: lines of a .c file, members of a struct, decisions of a function (if, for, while, case, ?, &&, ||,
plus one), the members of other files' structs that flight.c names, includes and calls that come back to where they began, tests that
include a source. What is above its limit stands in tests/rules/excuses.txt with its figure, and may only fall.
"""
import re

import house
import includes
import length

LINES = 450       # of a .c file
MEMBERS = 25      # of a struct
DECISIONS = 12    # of any function
MANY, MANY_ABOVE = 5, 10    # functions with more than ten decisions
FLIGHT_NAMES = 12  # members of other files' structs that flight.c names

DECISION = re.compile(r"\b(?:if|for|while|case)\b|\?|&&|\|\|")
LABELS = re.compile(r"case\b[^:]*:(?=\s*case\b)")    # labels that stand together are one decision
STRUCT = re.compile(r"typedef struct(?:\s+\w+)?\s*\{(.*?)\n\}\s*(\w+);", re.DOTALL)
FUNCTION = re.compile(r"^(?!static\b)\w[\w ]*?[ *](\w+)\([^;{}]*\)\s*\{", re.MULTILINE)    # that others may call
ORIGIN = re.compile(r"\b([A-Z][A-Z0-9_]{3,}) (?:in|of) (\w+\.[ch])\b")
TABLES = {"control/laws/table.h": "control/laws/laws"}
EXCUSES = "tests/rules/excuses.txt"


def members(body):
    """Number of members of a struct, of the structs in it too."""
    return sum(len(declaration.split(",")) for declaration in re.sub(r"\[[^\]]*\]", "", body).replace("{", ";").replace("}", ";").split(";")
               if re.match(r"\s*[\w*]+[\s*]+\w", declaration) and not declaration.strip().startswith(("struct", "union")))


def bodies(text):
    """(name, body) of each function."""
    code = re.sub(r"^[ \t]*#(?:\\\n|[^\n])*", house.blank, house.code_only(text), flags=re.MULTILINE)
    lines = code.split("\n")
    for name, line, count in length.functions(text):
        yield name, "\n".join(lines[line - 1:line + count + 4]).split("\n}\n")[0]


def one_of(path):
    """Header and source of one name count as one."""
    return path.rsplit(".", 1)[0]


def included(the_house):
    """{file: files of control/ that it includes}"""
    edges = {}
    for path in the_house.sources("control", ".c", ".h"):
        names = {one_of(name) for _, mark, name in includes.includes(the_house.text(path)) if mark == '"'}
        edges.setdefault(one_of(path), set()).update(names - {one_of(path)})
    return edges


def called(the_house):
    """{file: files of control/ whose functions it names}; what the rows of laws/table.h name, laws.c calls."""
    code = {path: house.code_only(the_house.text(path)) for path in the_house.sources("control", ".c", ".h")}
    home = {name: one_of(path) for path, text in code.items() if path.endswith(".c") for name in FUNCTION.findall(text)}
    edges = {}
    for path, text in code.items():
        caller = TABLES.get(path, one_of(path))
        edges.setdefault(caller, set())
        if path.endswith(".c") or path in TABLES:
            edges[caller] |= {home[word] for word in set(re.findall(r"\w+", text)) & home.keys()} - {caller}
    return edges


def circles(edges):
    """Ways that come back to where they began."""
    done, found = set(), []

    def visit(node, trail):
        if node in trail:
            found.append(" -> ".join(trail[trail.index(node):] + [node]))
        elif node not in done:
            for other in sorted(edges.get(node, ())):
                visit(other, trail + [node])
            done.add(node)

    for node in sorted(edges):
        visit(node, [])
    return found


def origins(the_house):
    """Constants that say they are as one of another file, which that file does not define, or which is their own."""
    sources = [path for room in house.PRODUCT for path in the_house.sources(room, ".c", ".h")]
    complaints = []
    for path in sources:
        text = the_house.text(path)
        for match in ORIGIN.finditer(text):
            homes = [other for other in sources if other.endswith("/" + match.group(2))]
            defined = any(re.search(rf"#define {match.group(1)}\b|\b{match.group(1)}\s*[,=}}]", the_house.text(home)) for home in homes)
            if path in homes or not defined:
                complaints.append(f"{path}:{house.line_of(text, match.start())}: {match.group()}: it is not defined there")
    return complaints


def flight_names(the_house):
    """Members of structs of other headers that flight.c reaches through a member of its own: flight->a.b counts b."""
    code = house.code_only(the_house.text("control/flight.c"))
    return sorted({match.group(1) for match in re.finditer(r"(?:->|\.)\w+(?:\.|->)(\w+)\b(?!\s*\()", code)}
                  | {match.group(1) for match in re.finditer(r"\b(?:supervisor|contact|where)->(\w+)\b(?!\.)", code)})


def figures(the_house):
    """{thing: (figure, limit)}"""
    found = {}
    complex_ones = []
    for path in the_house.sources("control", ".c", ".h"):
        text = the_house.text(path)
        if path.endswith(".c"):
            found[path] = (text.count("\n"), LINES)
        for match in STRUCT.finditer(house.code_only(text)):
            found[f"{path}:{match.group(2)}"] = (members(match.group(1)), MEMBERS)
        for name, body in bodies(text):
            decisions = 1 + len(DECISION.findall(LABELS.sub("", body)))
            found[f"{path}:{name}()"] = (decisions, DECISIONS)
            if decisions > MANY_ABOVE:
                complex_ones.append(name)
    for path in the_house.sources("tests/control", ".c", ".h"):
        sources = sum(name.endswith(".c") for _, _, name in includes.includes(the_house.text(path)))
        found[f"{path}:sources"] = (sources, 0)    # a test looks at the headers
    found[f"control/:above-{MANY_ABOVE}"] = (len(complex_ones), MANY)
    found["control/flight.c:names"] = (len(flight_names(the_house)), FLIGHT_NAMES)
    return found


def check(the_house):
    excused = {thing: int(reason.split()[0]) for thing, reason in house.excuses(the_house, "room").items()}
    found = figures(the_house)
    complaints = []
    for thing, (figure, limit) in sorted(found.items()):
        if figure > max(limit, excused.get(thing, 0)):
            complaints.append(f"{thing}: {figure}, at most {excused.get(thing, limit)}")
        if thing in excused and figure < excused[thing]:
            complaints.append(f"{EXCUSES}: {thing} is {figure} now" + ("" if figure > limit else " and needs no excuse"))
    complaints += [f"{EXCUSES}: {thing} does not exist" for thing in excused if thing not in found]
    complaints += origins(the_house)
    complaints += [f"includes in a circle: {circle}" for circle in circles(included(the_house))]
    complaints += [f"calls in a circle: {circle}" for circle in circles(called(the_house))]
    return complaints


if __name__ == "__main__":
    house.main(check)
