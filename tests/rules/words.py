"""The words of cmake/poison.txt do not occur where they are banned."""
import functools
import re

import house

POISON = "cmake/poison.txt"
# Not searched for what is banned everywhere: the bans, their samples, and recordings, which stay as they came.
SPARED = (POISON, "tests/rules/selftest.py", "tests/fixtures/")
PART = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+|\d+")
IDENTIFIER = re.compile(r"[A-Za-z_]\w*")


@functools.cache
def parts_of(identifier):
    return frozenset(part.lower() for part in PART.findall(identifier))


class Ban:
    def __init__(self, row):
        self.where, self.match, self.scope, what, self.why = re.split(r"\s{2,}", row.strip(), maxsplit=4)
        if self.match == "regex":
            self.expression = re.compile(what, re.MULTILINE)
        elif self.match in ("words", "parts"):
            self.words = set(what.split())
        else:
            raise ValueError(f"{POISON}: {row}")

    def rooms(self):
        return house.PRODUCT if self.where == "product" else (self.where,)

    def hits(self, text):
        """(offset, word) of each occurrence in text."""
        if self.match == "regex":
            yield from ((match.start(), match.group().strip() or "blank") for match in self.expression.finditer(text))
            return
        for match in IDENTIFIER.finditer(text):
            if match.group() in self.words if self.match == "words" else parts_of(match.group()) & self.words:
                yield match.start(), match.group()


def bans(the_house):
    return [Ban(row) for row in the_house.text(POISON).splitlines() if row.strip() and not row.startswith("#")]


def files_of(the_house, ban):
    if ban.where == "everywhere":
        return [path for path in the_house.files() if not path.startswith(SPARED)]
    return [path for room in ban.rooms() for path in the_house.sources(room, ".c", ".h")]


def check(the_house):
    complaints = []
    for ban in bans(the_house):
        for path in files_of(the_house, ban):
            text = the_house.text(path)
            searched = house.code_only(text) if ban.scope == "code" else text
            complaints += [f"{path}:{house.line_of(text, offset)}: {word}: {ban.why}" for offset, word in ban.hits(searched)]
    return complaints


if __name__ == "__main__":
    house.main(check)
