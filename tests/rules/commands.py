"""The operator's commands are the same in the program, the README and the packet list.

Usage: commands.py PROGRAM VERBS README PACKETS
  PROGRAM  whose `params` prints a header line, then one line per parameter, no blanks in a cell but the last
  VERBS    the C file whose table `verbs` holds the commands that are no parameters
  README   Markdown with one table whose rows begin with | `#NAME ...` |
  PACKETS  the XCTU packet list

Columns of the two tables are compared where their titles agree (unit must be among them).
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


def readme_commands(text):
    """{NAME: {title: cell}} from the README; the title row is the one above the |---| of the table."""
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


def check(params, verbs, readme, packets):
    table, written, sent = parameters(params), readme_commands(readme), packet_commands(packets)
    expected = set(table) | verb_names(verbs)
    complaints = [f"README: no row for #{name}" for name in sorted(expected - set(written))]
    complaints += [f"README: #{name} is no command" for name in sorted(set(written) - expected)]
    complaints += [f"packets: none for #{name}" for name in sorted(expected - sent)]
    complaints += [f"packets: #{name} is no command" for name in sorted(sent - expected)]
    for name in sorted(set(table) & set(written)):
        complaints += [f"README: #{name} has no column '{title}'" for title in sorted(NEEDED - set(written[name]))]
        complaints += [f"params: {name} has no column '{title}'" for title in sorted(NEEDED - set(table[name]))]
        complaints += [f"README: #{name} {title} is '{written[name][title]}', the program says '{table[name][title]}'"
                       for title in sorted(set(table[name]) & set(written[name]))
                       if table[name][title] != written[name][title]]
    return complaints


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    printed = subprocess.run([sys.argv[1], "params"], check=True, capture_output=True, text=True).stdout
    house.report(check(printed, *(Path(path).read_text(encoding="utf-8") for path in sys.argv[2:])), "commands")
