"""Every figure of docs/realtime.md is printed by, or given to, a command in it. Argument: the plomada program.

With a second argument --write: puts into the page what its commands print now. The text's own figures are for you.
"""
import functools
import re
import subprocess
import sys
import unittest
from decimal import Decimal
from pathlib import Path

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / "docs/realtime.md"
PROGRAM = sys.argv.pop(1)
BLOCK = re.compile(r"^```console\n\$ (.*)\n((?:.*\n)*?)```$", re.MULTILINE)
NUMBER = re.compile(r"(?<![\w.])\d+(?:\.\d+)?(?![\w]|\.\d)")
# A figure in the text: a number with a point, or one with a unit.
FIGURE = re.compile(r"(?<![\w.])(\d+\.\d+|\d+(?=\s+(?:ms|µs|%)))(\s+µs)?")


@functools.cache
def shell(command):
    """What it prints: the same each time."""
    return subprocess.run(command.replace("build/plomada", f"'{PROGRAM}'"), shell=True, cwd=ROOT, check=False, capture_output=True,
                          text=True).stdout


def rewritten(page):
    return BLOCK.sub(lambda block: f"```console\n$ {block.group(1)}\n{shell(block.group(1))}```", page)


def complaints(page):
    told = shell("python3 tools/rta/rta.py --help") + shell("python3 tools/rta/rta.py plomada-est --print").replace(",", " ")
    found, printed = [], {Decimal(number) for number in NUMBER.findall(told)}
    for command, shown in BLOCK.findall(page):
        output = shell(command)
        printed |= {Decimal(number) for number in NUMBER.findall((command + output).replace(",", " "))}
        if output != shown:
            found.append(f"`{command}` prints\n{output}")
    for match in FIGURE.finditer(BLOCK.sub("", page)):
        figure = Decimal(match.group(1)) / (1000 if match.group(2) else 1)
        if figure not in printed:
            found.append(f"{match.group()}: of no command of the page")
    return found


class Page(unittest.TestCase):
    def setUp(self):
        self.page = PAGE.read_text(encoding="utf-8")

    def test_every_figure_is_what_a_command_prints(self):
        self.assertEqual(complaints(self.page), [])

    def test_every_block_is_a_command(self):
        self.assertEqual(self.page.count("```"), 2 * len(BLOCK.findall(self.page)))
        self.assertEqual(len(BLOCK.findall(self.page)), 7)

    def test_a_changed_figure_is_noticed(self):
        for figure, other in (("5.0730   294.9270", "5.0731   294.9270"), ("not 29.7308", "not 29.7309"), ("57 µs", "58 µs"),
                              ("at most 5.0730", "at most 5.0731"), ("every 25 ms", "every 26 ms")):
            self.assertIn(figure, self.page)
            self.assertNotEqual(complaints(self.page.replace(figure, other)), [], figure)

    def test_annex_iv_is_on_the_page(self):
        for value in ("4.6151", "18.0610", "20.7323", "22.5766", "24.8147", "29.7308"):
            self.assertIn(value, self.page)


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        PAGE.write_text(rewritten(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
        sys.argv.pop()
    unittest.main()
