"""docs/es/primera_tarde.md says what docs/first_evening.md says: the same steps, in each the same lines, values and places.

Usage: test_spanish.py ROOT. Words may differ, what stands in `...` and every link's target may not, nor whether it is typed or seen.
"""
import re
import sys
import unittest
from pathlib import Path

KINDS = {"type": "type", "escribe": "type", "you see": "see", "ves": "see"}
MARKED = re.compile(r"\*\*(type|you see|escribe|ves)\*\*|`([^`]+)`|\]\(([^)]+)\)", re.IGNORECASE)


def parts(text, page):
    """{step: [(kind, what)]} in the page's order; step 0 is the list behind the last step."""
    steps = re.split(r"^(?=\d+\. )|^(?=## )", text, flags=re.MULTILINE)
    found = {}
    for step in steps:
        number = re.match(r"(\d+)\. ", step)
        if number:
            found[int(number.group(1))] = list(marks(re.sub(r"`[^`]*`", lambda span: re.sub(r"\s+", " ", span.group(0)), step), page))
    found[0] = list(marks(re.sub(r"\s+", " ", steps[-1]), page))
    return found


def marks(step, page):
    for kind, span, link in MARKED.findall(step):
        if kind:
            yield "do", KINDS[kind.lower()]
        elif span:
            yield "span", span
        elif link:
            yield "link", (page.parent / link.split("#")[0]).resolve().name + "#" + link.partition("#")[2]


class Spanish(unittest.TestCase):
    maxDiff = None

    def test_each_step_has_the_same_lines_in_the_same_order(self):
        english, spanish = (parts(page.read_text(encoding="utf-8"), page) for page in (ENGLISH, SPANISH))
        self.assertEqual(max(english), 33)
        self.assertEqual(sorted(english), sorted(spanish))
        for step, marked in english.items():
            with self.subTest(step=step):
                self.assertEqual(spanish[step], marked)

    def test_a_line_that_was_changed_in_one_language_is_found(self):
        text = ENGLISH.read_text(encoding="utf-8")
        changed = parts(text.replace("`OK PING 1`", "`OK PING 2`"), ENGLISH)
        self.assertNotEqual(changed, parts(text, ENGLISH))


if __name__ == "__main__":
    ROOT = Path(sys.argv.pop(1))
    ENGLISH, SPANISH = ROOT / "docs/first_evening.md", ROOT / "docs/es/primera_tarde.md"
    unittest.main()
