"""The tests of the control room use a module as the product does: they ask what it does, not how it remembers.

What a module remembers is a struct that a function of a header of control/ takes as a pointer it may write to, and every struct within
one; the published facts (facts.h, situation.h, flight_io.h, parameters.h) are none. Of what a module remembers a test may read what
another file of the product reads, and write what another file of the product writes. Every other member is an inner one. Nothing of
this is a list: the headers and sources of the product say it, and a new struct is seen at once.

Counted are the lines of tests/control that name inner members. They may be as many as excuses.txt says, and that figure only falls.
Where a name stands on something whose type cannot be told, it counts when any inner struct has it.

`inside.py --list` prints the lines, `inside.py --by-file` the count of each file.
"""
import re
import sys
from pathlib import Path

import house
import includes

LIMIT = 600
SLACK = 25    # a figure this little above the count is no complaint: others land too
EXCUSES = "tests/rules/excuses.txt"
THING = "tests/control:lines"
PUBLISHED = tuple(f"control/{name}.h" for name in ("facts", "situation", "flight_io", "parameters"))

STRUCT = re.compile(r"\bstruct\s*(?:\w+\s*)?\{")
AFTER_STRUCT = re.compile(r"\s*(\w+)")
FIELD = re.compile(r"^\s*(?:const\s+)?(\w+)[\s*]+(?:const\s+)?(\w.*)$", re.DOTALL)
DECLARED = re.compile(r"\b(\w+_t)\b\s*(?:const\s*)?\**\s*(?:const\s+)?(\w+(?:\[[^\]]*\])*(?:\s*,\s*\**\w+(?:\[[^\]]*\])*)*)\s*(?=[=;,)\[:{])")
RETURNS = re.compile(r"\b(\w+_t)\b[\s*]+(\w+)\s*[(\[]")    # of a function, and of a table in a header
ARGUMENT = re.compile(r"(const\s+)?\b(\w+_t)\s*\*\s*(?:const\s+)?\w+")
NAMED = re.compile(r"(?:->|\.)\s*([A-Za-z_]\w*)")
WRITTEN = re.compile(r"\s*(?:\[[^\]]*\]\s*)*(?:[-+*/|&^]?=(?!=)|\+\+|--)")
INITIALISED = re.compile(r"(\w+_t)\s*(?:const\s+)?(?:\w+\s*(?:\[[^\]]*\]\s*)*=\s*|\)\s*)$")


def closing(code, opening):
    """Offset of the bracket that closes the one at `opening`."""
    pairs, depth = {"{": "}", "(": ")", "[": "]"}, 0
    for offset in range(opening, len(code)):
        depth += (code[offset] == code[opening]) - (code[offset] == pairs[code[opening]])
        if depth == 0:
            return offset
    return len(code)


def opened(code, end):
    """Offset of the bracket that the one at `end` closes."""
    pairs, depth = {"}": "{", ")": "(", "]": "["}, 0
    for offset in range(end, -1, -1):
        depth += (code[offset] == code[end]) - (code[offset] == pairs[code[end]])
        if depth == 0:
            return offset
    return 0


def structs(text):
    """{type: {member: type}}; one without a name is called as what it declares."""
    code, found = house.code_only(text), {}
    for match in STRUCT.finditer(code):
        end = closing(code, match.end() - 1)
        name = AFTER_STRUCT.match(code, end + 1)
        if name:
            found[name.group(1)] = fields(code[match.end():end])
    return found


def without_members(code):
    """The code with the bodies of its structs blank: what they declare are no variables."""
    for match in list(STRUCT.finditer(code)):
        end = closing(code, match.end() - 1)
        code = code[:match.end()] + re.sub(r"[^\n]", " ", code[match.end():end]) + code[end:]
    return code


def fields(body):
    found = {}
    body = re.sub(r"\{[^{}]*\}\s*(\w+)", r" \1", re.sub(r"\b(?:struct|union|enum)\b\s*", "inner_", body))
    for declaration in re.sub(r"\[[^\]]*\]", "", body).split(";"):
        match = FIELD.match(declaration)
        if match:
            found.update({name.strip(" *\n"): match.group(1) for name in match.group(2).split(",")})
    return found


def remembered(the_house, known):
    """Types of what modules keep between two calls."""
    published = {name for path in PUBLISHED if (the_house.root / path).exists() for name in structs(the_house.text(path))}
    published |= {kind for name in set(published) for kind in known[name].values() if name != "situation_t"}
    kept = set()
    for path in the_house.sources("control", ".h"):
        code = re.sub(r"\{[^{}]*\}", ";", house.code_only(the_house.text(path)))
        kept |= {kind for const, kind in ARGUMENT.findall(code) if not const and "(" in code}
    kept &= set(known)
    while True:
        more = {kind for name in kept - published for kind in known[name].values() if kind in known} - kept
        if not more:
            return kept - published
        kept |= more


class Source:
    """One test file, with what the files say that it includes."""

    def __init__(self, the_house, path, known, returns):
        self.code = house.code_only(the_house.text(path))
        self.before = ""
        for header in headers(the_house, path):
            self.before += house.code_only(the_house.text(header)) + "\n"
        self.whole = self.before + "\n" + self.code
        self.shift = len(self.whole) - len(self.code)
        self.known = {**known, **structs(self.whole)}
        self.returns = {**returns, **dict((name, kind) for kind, name in RETURNS.findall(self.whole))}
        self.ends = [match.end() for match in re.finditer(r"^\}", self.whole, re.MULTILINE)]
        self.variables, self.outside = {}, {}
        for match in DECLARED.finditer(without_members(self.whole)):
            for name in re.findall(r"\w+", re.sub(r"\[[^\]]*\]", "", match.group(2))):
                self.variables.setdefault(name, []).append((match.start(), match.group(1)))
        for name in structs(self.whole):
            for match in re.finditer(rf"\}}\s*{name}\b", self.whole):
                self.variables.setdefault(name, []).append((match.start(), name))
        for places in self.variables.values():
            places.sort()

    def variable(self, name, offset):
        """Type of the variable that is called so at the offset: in its function, else outside of all."""
        begin = max((end for end in self.ends if end <= offset), default=0)
        told = [(place, kind) for place, kind in self.variables.get(name, ()) if place < offset]
        own = [kind for place, kind in told if place >= begin]
        outside = [kind for place, kind in told if self.is_outside(place)]
        whole_struct = [kind for place, kind in told if kind == name]
        return (own or outside or whole_struct or [self.returns.get(name)])[-1]

    def is_outside(self, offset):
        """Of every brace."""
        if offset not in self.outside:
            self.outside[offset] = self.whole.count("{", 0, offset) == self.whole.count("}", 0, offset)
        return self.outside[offset]

    def kind(self, end):
        """Type of the expression that ends before the offset; None where it cannot be told."""
        code = self.whole
        while end > 0 and (code[end - 1].isspace() or code[end - 1] == "]"):
            end = opened(code, end - 1) if code[end - 1] == "]" else end - 1
        if code[end - 1] == ")":
            start = opened(code, end - 1)
            name = re.search(r"(\w+)\s*$", code[:start])
            if name and name.group(1) not in ("if", "while", "for", "return", "switch"):
                return self.returns.get(name.group(1))
            inner = code[start + 1:end - 1].strip("*& \n")
            return self.kind(start + 1 + code[start + 1:end - 1].rfind(inner[-1]) + 1) if re.fullmatch(r"[\w.\->\[\]]+", inner) else None
        name = re.search(r"(\w+)$", code[max(0, end - 80):end])
        if not name:
            return None
        start = end - len(name.group(1))
        owner = re.search(r"(?:->|\.)\s*$", code[max(0, start - 4):start])
        if owner:
            parent = self.kind(start - len(owner.group()))
            return self.known.get(parent, {}).get(name.group(1))
        return self.variable(name.group(1), start)

    def initialised(self, offset):
        """Type whose braces the offset stands in; None where it cannot be told."""
        code, depth = self.whole, 0
        for place in range(offset - 1, -1, -1):
            depth += (code[place] in "})]") - (code[place] in "{([")
            if depth < 0:
                break
        if code[place] != "{":
            return None
        text = code[max(0, place - 200):place].rstrip()
        member = re.search(r"\.(\w+)(?:\[[^\]]*\])?\s*=$", text)
        match = INITIALISED.search(text + " ") or INITIALISED.search(text)
        if match:
            return match.group(1)
        if member:
            return self.known.get(self.initialised(place - (len(text) - member.start()) - 1), {}).get(member.group(1))
        if text.endswith(("{", ",")) or re.search(r"\]\s*=$", text):
            local = re.search(r"\}\s*(\w+)\s*(?:\[[^\]]*\]\s*)*=$", text)
            return local.group(1) if local else self.initialised(place)
        local = re.search(r"\}\s*(\w+)\s*(?:\[[^\]]*\]\s*)*=$", text)
        return local.group(1) if local else None

    def named(self):
        """(line, member, type it belongs to or None, whether it is written) of each member that this file names."""
        for match in NAMED.finditer(self.whole, self.shift):
            offset = match.start()
            first = match.group(0)[0] == "." and self.whole[:offset].rstrip()[-1:] in ("{", ",")
            kind = self.initialised(offset) if first else self.kind(offset)
            written = first or WRITTEN.match(self.whole, match.end()) is not None
            yield house.line_of(self.code, offset - self.shift), match.group(1), kind, written


def headers(the_house, path, seen=None):
    """The test headers that a file includes, first to last."""
    seen = [] if seen is None else seen
    for _, mark, name in includes.includes(the_house.text(path)):
        for place in (Path(path).parent / name, Path("tests/control") / name):
            header = place.as_posix()
            if mark == '"' and (the_house.root / header).exists() and header not in seen:
                headers(the_house, header, seen)
                seen.append(header)
                break
    return seen


def used_by_others(the_house, known, returns, home):
    """{(type, member): {written}} as files of the product use what another file declares."""
    found = {}
    for path in (path for room in house.PRODUCT for path in the_house.sources(room, ".c", ".h")):
        for _, member, kind, written in Source(the_house, path, known, returns).named():
            if kind in home and home[kind] != path.rsplit(".", 1)[0]:
                found.setdefault((kind, member), set()).add(written)
    return found


def lines(the_house):
    """{(path, line): names} of each line that names an inner member."""
    known, returns, home = {}, {}, {}
    for path in the_house.sources("control", ".h"):
        here = structs(the_house.text(path))
        known.update(here)
        home.update(dict.fromkeys(here, path.rsplit(".", 1)[0]))
        returns.update((name, kind) for kind, name in RETURNS.findall(house.code_only(the_house.text(path))))
    kept = remembered(the_house, known)
    used = used_by_others(the_house, known, returns, home)
    any_of_them = {member for kind in kept for member in known[kind]}
    found = {}
    for path in the_house.sources("tests/control", ".c", ".h"):
        source = Source(the_house, path, known, returns)
        for line, member, kind, written in source.named():
            uses = used.get((kind, member), set())
            inner = not uses or (written and True not in uses)
            if (kind in kept and inner) or (kind not in source.known and member in any_of_them):
                found.setdefault((path, line), []).append(f"{kind or '?'}.{member}")
    return found


def check(the_house):
    excused = int(house.excuses(the_house, "inside").get(THING, f"{LIMIT}").split()[0])
    count = len(lines(the_house))
    if count > excused:
        return [f"{THING}: {count} name inner members, at most {excused}"]
    if count < excused - SLACK and excused > LIMIT:
        return [f"{EXCUSES}: {THING} is {count} now" + ("" if count > LIMIT else " and needs no excuse")]
    return []


def tell(the_house, by_file):
    found = lines(the_house)
    if by_file:
        files = [path for path, _ in found]
        for path in sorted(set(files), key=files.count, reverse=True):
            print(f"{files.count(path):5} {path}")
    else:
        for (path, line), names in sorted(found.items()):
            print(f"{path}:{line}: {' '.join(names)}")
    print(f"{len(found)} lines")


if __name__ == "__main__":
    if sys.argv[1:2] in (["--list"], ["--by-file"]):
        tell(house.House(Path(__file__).resolve().parents[2]), sys.argv[1] == "--by-file")
    else:
        house.main(check)
