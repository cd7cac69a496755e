"""Writes the sources of cmake/sources.cmake into ccs_project/plomada.projectspec, in place of those that it lists."""
import re

from ccs_project import REPOSITORY, SPEC

ROOMS = ("firmware", "bsp", "control", "drivers")
ENTRY = re.compile(r' *<file action="link" path="\.\./[\w/]+\.c"[^\n]*\n')


def main():
    listed = re.findall(r"\b(?:" + "|".join(ROOMS) + r")/[\w/]+\.c\b", (REPOSITORY / "cmake/sources.cmake").read_text(encoding="utf-8"))
    listed.sort(key=lambda path: (ROOMS.index(path.split("/")[0]), path))
    entries = "".join(f'    <file action="link" path="../{path}" targetDirectory="{path.split("/")[0]}"/>\n' for path in listed)
    content = SPEC.read_text(encoding="utf-8")
    first = ENTRY.search(content).start()
    SPEC.write_text(content[:first] + entries + ENTRY.sub("", content[first:]), encoding="utf-8")


if __name__ == "__main__":
    main()
