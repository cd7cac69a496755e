"""The house as the checks see it: rooms, source files, C text without comments; and how a check is run.

A check is a function of a House that returns its complaints, each "path:line: what is wrong".
"""
import argparse
import functools
import os
import re
import sys
from pathlib import Path

PRODUCT = ("control", "drivers", "bsp", "firmware")
COMMENT_OR_LITERAL = re.compile(
    r"//(?:\\\n|[^\n])*|/\*.*?\*/|\"(?:\\.|[^\"\\\n])*\"|'(?:\\.|[^'\\\n])*'", re.DOTALL)
LEFT_OUT = ("build", ".git", "__pycache__", "node_modules", ".vscode", ".idea")


def belongs(name):
    return name not in LEFT_OUT and not name.startswith("build-")


class House:
    def __init__(self, root):
        self.root = Path(root).resolve()

    def path(self, file):
        return file.relative_to(self.root).as_posix()

    def text(self, file):
        return (self.root / file).read_text(encoding="utf-8", errors="replace")

    def sources(self, room, *suffixes):
        """Files of a room (a directory, sub-directories included) with one of the suffixes, sorted, as paths from the root."""
        base = self.root / room
        return sorted(self.path(file) for file in base.rglob("*") if file.is_file() and file.suffix in suffixes)

    def files(self):
        """Every text file that belongs to the repository. What was built, thousands of files, is not entered."""
        found = []
        for folder, folders, names in os.walk(self.root):
            folders[:] = [name for name in folders if belongs(name)]
            found += [Path(folder, name) for name in names if belongs(name)]
        for file in sorted(file for file in found if file.is_file()):
            with file.open("rb") as opened:
                if b"\0" in opened.read(4096):
                    continue
            yield self.path(file)


def blank(match):
    return re.sub(r"[^\n]", " ", match.group())


def without_comments(text):
    """C without comments; lines and columns stay."""
    return COMMENT_OR_LITERAL.sub(lambda match: blank(match) if match.group()[0] == "/" else match.group(), text)


@functools.cache    # the rules ask for the same files again
def code_only(text):
    """C without comments, string and character literals; lines and columns stay."""
    return COMMENT_OR_LITERAL.sub(blank, text)


def line_of(text, offset):
    return text.count("\n", 0, offset) + 1


def excuses(house, rule):
    """{thing: reason} of tests/rules/excuses.txt for one rule."""
    found = {}
    for line in house.text("tests/rules/excuses.txt").splitlines():
        if line.strip() and not line.startswith("#"):
            name, thing, reason = line.split(None, 2)
            if name == rule:
                found[thing] = reason
    return found


def report(complaints, what):
    """Prints the complaints; exits 0 if there are none, else 1."""
    for complaint in complaints:
        print(complaint)
    print(f"{what}: {'ok' if not complaints else f'{len(complaints)} complaints'}")
    sys.exit(1 if complaints else 0)


def main(check):
    """A check run by itself: argument is the root of the repository."""
    parser = argparse.ArgumentParser(description=sys.modules["__main__"].__doc__)
    parser.add_argument("root", nargs="?", default=Path(__file__).resolve().parents[2])
    report(check(House(parser.parse_args().root)), Path(sys.argv[0]).stem)
