"""Every line for the operator that stands on a page is typed, and answered by OK.

Usage: test_typed_lines.py ROOT OPERATOR_BOARD PLOMADA

A line is what a page writes as `#VERB ...`, also in a block of code. Each is typed on a board that stands on the ground, with its
sensors up and LINK set, and has heard no other of them. What needs more than that is named in BEFORE; what a page only speaks of, in SPOKEN_OF. A bare name of a
parameter is spoken of: it must be one.
"""
import re
import subprocess
import sys
import unittest
from pathlib import Path

from operator_board import OperatorBoard

READY = ["on", "wait 25", "type #LINK 60", "wait 0.5", "type #SAVE", "wait 0.5"]
TILTED = ["type #IMU LEVEL", "wait 1", "hold 0.1 20 0", "wait 2"]
NOSE_UP = ["type #IMU LEVEL", "wait 1", "hold 0.1 0 20", "wait 2"]
BEFORE = {"#IMU RIGHT": TILTED, "#IMU NOSE": NOSE_UP}
SPOKEN_OF = {"#NAME value", "#SETR", "#LAW MINE"}    # the form of a line; with some height; of another program: tests/examples/test_my_law.py
LINE = re.compile(r"#[A-Z][A-Z0-9]*(?: [^`]*)?\Z")


def lines_of(page):
    text = page.read_text(encoding="utf-8")
    blocks = re.findall(r"^```.*?^```", text, re.MULTILINE | re.DOTALL)
    for block in blocks:
        text = text.replace(block, "")
        yield from (line for line in block.splitlines() if LINE.match(line))
    yield from (re.sub(r"\s+", " ", span) for span in re.findall(r"`([^`]+)`", text) if LINE.match(re.sub(r"\s+", " ", span)))


class TypedLines(unittest.TestCase):
    def answer(self, board, line):
        with board.tried():
            for order in BEFORE.get(line, []):
                board.order(order)
            board.clear()
            board.order(f"type {line}")
            board.wait(1)
            answers = board.answers()
        return next(iter(answers), "no answer")

    def test_each_is_answered_by_ok(self):
        pages = [*sorted((ROOT / "docs").rglob("*.md")), ROOT / "README.md", ROOT / "CHANGELOG.md"]
        table = subprocess.run([PLOMADA, "params"], capture_output=True, text=True, check=True).stdout
        parameters = set(re.findall(r"^([A-Z0-9]+) ", table, re.MULTILINE))
        self.assertIn("GRAV", parameters)
        seen = {}
        with OperatorBoard(BOARD) as board:
            for order in READY:
                board.order(order)
            for page in pages:
                for line in lines_of(page):
                    if line in SPOKEN_OF or line[1:] in parameters:
                        continue
                    if line not in seen:
                        seen[line] = self.answer(board, line)
                    with self.subTest(page=page.name, line=line):
                        self.assertRegex(seen[line], r"^OK " if line.startswith("#GET") else rf"^OK {line[1:].split()[0]}\b")
        self.assertGreater(len(seen), 60)


HANDS_OVER = ["corners on", "wait 1", "corners off", "stick 0.2", "wait 2", "switch launchpad", "wait 5"]
HOVERS = ["type #ARM", "wait 1", "type #SETR 2.5", "wait 10"]
UP = ["on", "wait 25"]

# Page, where the recipe begins and ends there, what comes first, what is done behind a line, the pause, what is told in the end.
RECIPES = (
    ("operator.md", "1. `#LINK 60`", "With law PD", UP, {"#ARM": HANDS_OVER}, 15, r"OK CALIBRATE end:COMMAND .* grav:\d"),
    ("hardware.md", "2. **Throttle inversion**", "Less where", [*UP, "switch launchpad"], {}, 15, r"thr:0\.00 state:GROUND flags:0"),
    ("hardware.md", "1. Switch at *pilot*", "5. **To take", UP, {"#ARM": [*HANDS_OVER, "free"]}, 15, r"thr:1\.76 state:GROUND flags:0"),
    ("control.md", "2. **Step**", "From `alt` take", ["on running", "wait 25"], {"#DSAT 0": HOVERS}, 2, r"alt:2\.\d+ .* state:FLYING"),
)


class Recipes(unittest.TestCase):
    """Where lines stand in an order, they are typed in it."""

    def test_each_can_be_typed_from_its_first_line_to_its_last(self):
        for name, begin, end, before, behind, pause_s, told in RECIPES:
            with self.subTest(page=name, begin=begin), OperatorBoard(BOARD) as board:
                text = (ROOT / "docs" / name).read_text(encoding="utf-8").split(begin)[1].split(end)[0]
                lines = [line for line in re.findall(r"`([^`]+)`", begin + text) if LINE.match(line) and line not in SPOKEN_OF]
                self.assertGreater(len(lines), 2)
                for order in before:
                    board.order(order)
                board.clear()
                for line in lines:
                    board.order(f"type {line}")
                    for order in behind.get(line, []):
                        board.order(order)
                    board.wait(pause_s)
                board.wait(15)
                self.assertEqual([answer for answer in board.answers() if answer.startswith("ERR")], [], lines)
                self.assertRegex("\n".join(board.answers() + board.telemetry()[-1:]), told)


if __name__ == "__main__":
    ROOT, BOARD, PLOMADA = Path(sys.argv[1]), sys.argv[2], sys.argv[3]
    unittest.main(argv=sys.argv[:1])
