"""control/ and drivers/ are the same in every build and remember nothing; nothing is declared behind its header's back.

  - control/ and drivers/: no #if, #ifdef, #elif: a build switch hides code from the tests. Only a header's guard and its extern "C" may stand.
  - control/ and drivers/: no variable outside of a function, and no static one inside, unless it is const.
  - the product: no extern and no prototype in a .c file; an extern in a header names what its own room defines.
    Excused (excuses.txt): what the linker's script defines.
"""
import functools
import re

import house

PURE = ("control", "drivers")
EXCUSES = "tests/rules/excuses.txt"
CONDITION = re.compile(r"^[ \t]*#[ \t]*(if\w*|elif)\b[ \t]*([^\n]*)$", re.MULTILINE)
GUARD = re.compile(r"\A\s*#[ \t]*ifndef[ \t]+(\w+)\s*\n\s*#[ \t]*define[ \t]+\1[ \t]*\n")
EXTERN = re.compile(r"\bextern\b([^;({\[=]*\b(\w+))\s*[;({\[=]")
# Up to what follows the name; the star of a table of functions is a group of its own.
STATIC = re.compile(r"\bstatic\b([^;={(]*)(\(\s*\*)?")
NO_VARIABLE = re.compile(r"^\s*(?:typedef|extern|static|struct\s+\w+\s*(?:\{\})?\s*$|union\s+\w+\s*(?:\{\})?\s*$|enum\b)")


def bare(text):
    """C without comments, literals and lines of the preprocessor."""
    return re.sub(r"^[ \t]*#(?:\\\n|[^\n])*", house.blank, house.code_only(text), flags=re.MULTILINE)


@functools.cache    # the rule asks for the same files again
def outside(code):
    """The code outside of every brace; lines and columns stay, the outermost braces too."""
    out, depth = [], 0
    for part in re.split(r"([{}])", code):
        depth -= part == "}"
        out.append(part if depth == 0 else re.sub(r"[^\n]", " ", part))
        depth += part == "{"
    return "".join(out)


def statements(code):
    """(offset, text) of each declaration outside of functions; a function's body ends one too."""
    start, code = 0, outside(code)
    for match in re.finditer(r";|(?<=\))(\s*)\{[^}]*\}", code):
        text = code[start:match.start()] if match.group() == ";" else ""
        if text.strip():
            yield start + len(text) - len(text.lstrip()), " ".join(re.sub(r"\{\s*\}", "{}", text).split())
        start = match.end()


def constant(declaration):
    """Whether what is declared cannot change: const after the last star, or anywhere when there is none."""
    return re.search(r"\bconst\b", declaration.rpartition("*")[2]) is not None


def switches(text, header):
    code = house.code_only(text)
    guard = GUARD.match(code) if header else None
    for match in CONDITION.finditer(code, guard.end() if guard else 0):
        if header and match.groups() == ("ifdef", "__cplusplus"):
            continue
        yield match.start(), f"#{match.group(1)} {match.group(2).strip()}: a build switch hides code from the tests"


def variables(text):
    code = bare(text)
    for match in STATIC.finditer(code):
        function = not match.group(2) and code[match.end():match.end() + 1] == "("
        table = match.group(2) and re.match(r"\s*const\b", code[match.end():])
        if not function and not table and (match.group(2) or not constant(match.group(1))):
            yield match.start(), f"static {' '.join(match.group(1).split())}: a variable that outlives the call; the caller owns the state"
    for offset, declaration in statements(code):
        name = declaration.split("=")[0]
        if "(" not in name and not NO_VARIABLE.match(declaration) and not constant(name):
            yield offset, f"{name.strip()}: a variable of the whole program; the caller owns the state"


def declared(text):
    """(offset, name) of each extern, and of each prototype that is not static."""
    code = bare(text)
    yield from ((match.start(), match.group(2)) for match in EXTERN.finditer(code))
    for offset, declaration in statements(code):
        match = re.match(r"^(?!typedef|static|extern)[^=(]*?\b(\w+)\s*\([^=]*\)$", declaration)
        if match:
            yield offset, match.group(1)


def defines(text, name):
    return re.search(rf"^(?!\s*extern)\w[^;({{]*\b{name}\b[^;({{]*(?:=|;)|^\w[^;={{]*\b{name}\s*\([^;]*\)\s*\{{", outside(bare(text)), re.MULTILINE)


def check_pure(the_house, path):
    text = the_house.text(path)
    found = [*switches(text, path.endswith(".h")), *(variables(text) if path.endswith(".c") else ())]
    return [f"{path}:{house.line_of(text, offset)}: {what}" for offset, what in found]


def check_declarations(the_house, room, excused, used):
    for path in the_house.sources(room, ".c"):
        text = the_house.text(path)
        for offset, name in declared(text):
            if f"{path}:{name}" in excused:
                used.add(f"{path}:{name}")
            else:
                yield f"{path}:{house.line_of(text, offset)}: {name}: declared behind its header's back; include the header"
    own = [the_house.text(path) for path in the_house.sources(room, ".c")]
    for path in the_house.sources(room, ".h"):
        text = the_house.text(path)
        for match in EXTERN.finditer(bare(text)):
            if not any(defines(source, match.group(2)) for source in own):
                yield f"{path}:{house.line_of(text, match.start())}: {match.group(2)}: {room}/ does not define it"


def check(the_house):
    excused, used, complaints = house.excuses(the_house, "state"), set(), []
    for path in (path for room in PURE for path in the_house.sources(room, ".c", ".h")):
        complaints += check_pure(the_house, path)
    for room in house.PRODUCT:
        complaints += check_declarations(the_house, room, excused, used)
    return complaints + [f"{EXCUSES}: {thing} needs no excuse" for thing in sorted(set(excused) - used)]


if __name__ == "__main__":
    house.main(check)
