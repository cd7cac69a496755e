"""The commands are the same in the program, the Makefile, the page of commands and the packet list.

Usage: commands.py PROGRAM VERBS PAGE PACKETS MAKEFILE
  PROGRAM   whose `params` prints a header line, then one line per parameter, no blanks in a cell but the last; and whose
            `--help` prints its subcommands, two blanks before each
  VERBS     the C file whose table `verbs` holds the commands that are no parameters
  PAGE      Markdown with tables whose rows begin with | `#NAME ...` |, | `plomada NAME` | or | `make NAME` |
  PACKETS   the XCTU packet list
  MAKEFILE  whose targets with ## behind them are commands

Columns of the parameters' tables are compared where their titles agree (unit must be among them).
"""
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import house

NEEDED = {"unit"}
DASH = re.compile(r"^(?:-|–|—|)$")


def plain(cell):
    """A cell as compared: no Markdown marks, one kind of dash and of range."""
    cell = re.sub(r"[`*]|\\(?=[|_])", "", cell).strip()
    return "-" if DASH.match(cell) else re.sub(r"\s*(?:…|\.\.\.?|–)\s*", "..", cell)


def parameters(text):
    """{NAME: {title: cell}} from `plomada params`."""
    header, *lines = [line for line in text.splitlines() if line.strip()]
    titles = header.lower().split()
    rows = [line.split(None, len(titles) - 1) for line in lines]
    return {row[0].upper(): dict(zip(titles[1:], map(plain, row[1:]))) for row in rows}


def cells(line):
    return [cell.strip() for cell in re.split(r"(?<!\\)\|", line.strip())[1:-1]]


def page_commands(text):
    """{NAME: {title: cell}} from the page; the title row is the one above the |---| of the table."""
    found, titles, previous = {}, [], ""
    for line in text.splitlines():
        if re.match(r"^\s*\|[\s:|-]+\|\s*$", line):
            titles = [title.lower() for title in cells(previous)]
        match = re.match(r"^\s*\|\s*`#(\w+)", line)
        if match:
            found.setdefault(match.group(1).upper(), dict(zip(titles[1:], map(plain, cells(line)[1:]))))
        previous = line
    return found


def verb_names(source):
    table = re.search(r"verb_t verbs\[\] = \{(.*?)\n\};", source, re.S).group(1)
    return set(re.findall(r'\{"(\w+)"', table))


def packet_commands(text):
    payloads = [bytes.fromhex(element.text).decode("ascii") for element in ElementTree.fromstring(text).iter("payload")]
    return {re.match(r"#(\w+)", payload).group(1) for payload in payloads if payload.startswith("#")}


def listed(page, command):
    """The names behind `plomada` or `make` at the beginnings of rows."""
    return set(re.findall(rf"^\| `{command} ([\w-]+)", page, re.MULTILINE))


def differ(command, there_are, page):
    written = listed(page, command)
    yield from (f"page: no row for {command} {name}" for name in sorted(there_are - written))
    yield from (f"page: {command} {name} is no command" for name in sorted(written - there_are))


def check_others(told, makefile, page):
    """Subcommands and targets."""
    return [*differ("plomada", set(re.findall(r"^  (\w+) ", told, re.MULTILINE)), page),
            *differ("make", set(re.findall(r"^([a-z-]+):.*## ", makefile, re.MULTILINE)), page)]


def check(params, verbs, page, packets):
    table, written, sent = parameters(params), page_commands(page), packet_commands(packets)
    expected = set(table) | verb_names(verbs)
    complaints = [f"page: no row for #{name}" for name in sorted(expected - set(written))]
    complaints += [f"page: #{name} is no command" for name in sorted(set(written) - expected)]
    complaints += [f"packets: none for #{name}" for name in sorted(expected - sent)]
    complaints += [f"packets: #{name} is no command" for name in sorted(sent - expected)]
    for name in sorted(set(table) & set(written)):
        complaints += [f"page: #{name} has no column '{title}'" for title in sorted(NEEDED - set(written[name]))]
        complaints += [f"params: {name} has no column '{title}'" for title in sorted(NEEDED - set(table[name]))]
        complaints += [f"page: #{name} {title} is '{written[name][title]}', the program says '{table[name][title]}'"
                       for title in sorted(set(table[name]) & set(written[name]))
                       if table[name][title] != written[name][title]]
    return complaints


if __name__ == "__main__":
    if len(sys.argv) != 6:
        sys.exit(__doc__)
    printed, told = (subprocess.run([sys.argv[1], word], check=True, capture_output=True, text=True).stdout for word in ("params", "--help"))
    sources, page, packets, makefile = (Path(path).read_text(encoding="utf-8") for path in sys.argv[2:])
    house.report(check(printed, sources, page, packets) + check_others(told, makefile, page), "commands")
