"""The names of buttons and states in the first steps of a page are those of the browser page.

Usage: test_buttons.py ROOT
"""
import re
import sys
import unittest
from pathlib import Path

PAGES = ("docs/ground.md", "docs/es/index.md")


def named(text):
    """What stands in *...* in the numbered steps, and below them up to the next heading."""
    steps = re.findall(r"^1\. .*?(?=^#)", text, re.MULTILINE | re.DOTALL)
    return [" ".join(name.split()) for name in re.findall(r"(?<!\*)\*([^*\n][^*]*?)\*(?!\*)", steps[0] if steps else "")]


class Buttons(unittest.TestCase):
    def test_each_is_one_of_the_page(self):
        words = (ROOT / "ground/src/texts.ts").read_text(encoding="utf-8")
        for page in PAGES:
            names = named((ROOT / page).read_text(encoding="utf-8"))
            self.assertGreater(len(names), 3, page)
            for name in names:
                with self.subTest(page=page, name=name):
                    self.assertIn(f"'{name}'", words)


if __name__ == "__main__":
    ROOT = Path(sys.argv.pop(1))
    unittest.main()
