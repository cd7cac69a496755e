"""Constants of control/ that nothing stands behind but a choice. They may be as many as excuses.txt says, and that figure only falls.

A constant is a #define with a number of its own, or a table of numbers. Its comment, on its lines or right above it, says where it comes
from: a data sheet, a noise and how many sigmas of it, a fit that a command repeats, an arithmetic that a reader can follow. One that
says *chosen* or *tried* counts. One that says nothing counts too, when its number has a point or is a time: else a comment
less would be a debt less. A formula of other constants does not count: those do. Nor do flags and lengths of a queue, whole numbers.

`chosen.py --list` prints them, `chosen.py --by-file` the count of each file.
"""
import re
import sys
from pathlib import Path

import house

EXCUSES = "tests/rules/excuses.txt"
THING = "control:constants"
SLACK = 5     # a figure this little above the count is no complaint: others land too

DEFINE = re.compile(r"^#define (\w+)(?!\()[ \t]+((?:\\\n|[^\n])*)", re.MULTILINE)
TABLE = re.compile(r"^static const [^;=]*?(\w+)(?:\[[^\]]*\])* = \{(?:[^;])*?\};", re.MULTILINE)
NUMBER = re.compile(r"(?<!\w)\d[\w.+]*|UINT32_C\(\d+\)")
MEASURE = re.compile(r"\d\.\d|UINT32_C\(\d{3,}\)")
NAME = re.compile(r"\b[A-Z][A-Z0-9]*_[A-Z0-9_]+\b")
NOT_NAMES = re.compile(r"\bU?INT(?:16|32)_C\b")
CHOICE = re.compile(r"\b(?:chosen|tried)\b", re.IGNORECASE)
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
ABOVE = re.compile(r"/\*(?:(?!\*/).)*\*/\n\Z", re.DOTALL)


def above(text, offset):
    """The comment that ends on the line before, when it begins its line."""
    match = ABOVE.search(text[:offset])
    start = match and text.rfind("/*", 0, match.end())
    return text[start:offset] if match and text[text.rfind("\n", 0, start) + 1:start].strip() == "" else ""


def constants(text):
    """(name, line, value without comments, its comment) of each."""
    for match in sorted([*DEFINE.finditer(text), *TABLE.finditer(text)], key=lambda found: found.start()):
        whole = match.group()
        rest = text[match.end():text.find("\n", match.end())]
        open_comment = whole.count("/*") > whole.count("*/")
        end = text.find("*/", match.end()) + 2 if open_comment else match.end()
        whole = text[match.start():end] + ("" if open_comment else rest)
        value = COMMENT.sub("", whole)
        own = " ".join(COMMENT.findall(whole)) or above(text, match.start())
        yield match.group(1), house.line_of(text, match.start()), value.split(match.group(1), 1)[1], own


def is_choice(value, comment):
    formula = NAME.search(NOT_NAMES.sub("", value))
    number = NUMBER.search(value)
    if not number:
        return False
    return bool(CHOICE.search(comment)) or (not comment and not formula and bool(MEASURE.search(value)))


def choices(the_house):
    """(path, line, name) of each."""
    return [(path, line, name) for path in the_house.sources("control", ".c", ".h")
            for name, line, value, comment in constants(the_house.text(path)) if is_choice(value, comment)]


def check(the_house):
    excused = int(house.excuses(the_house, "chosen").get(THING, "0").split()[0])
    count = len(choices(the_house))
    if count > excused:
        return [f"{THING}: {count} are only chosen, at most {excused}; {Path(__file__).name} --list prints them"]
    if count < excused - SLACK:
        return [f"{EXCUSES}: {THING} is {count} now"]
    return []


def tell(the_house, by_file):
    found = choices(the_house)
    paths = [path for path, _, _ in found]
    for line in ([f"{paths.count(path):5} {path}" for path in sorted(set(paths), key=paths.count, reverse=True)] if by_file
                 else [f"{path}:{line}: {name}" for path, line, name in found]):
        print(line)
    print(f"{len(found)} constants")


if __name__ == "__main__":
    if sys.argv[1:2] in (["--list"], ["--by-file"]):
        tell(house.House(Path(__file__).resolve().parents[2]), sys.argv[1] == "--by-file")
    else:
        house.main(check)
