"""Each page has ten questions that a reader who has seen nothing but the page must answer, with the answers (tests/docs/*.md).

Usage: test_questions.py ROOT

What an answer names, `...` and numbers, must stand on the page, and most of its words: so an answer that the page no longer gives is
found. Whether people do answer them is tried with people: 9 of 10, from one reading.
"""
import re
import sys
import unittest
from pathlib import Path

TITLE = re.compile(r"# (?:Ten questions on|Diez preguntas sobre) (\S+)\n\n")
QUESTION = re.compile(r"(\d+)\. (.*\?)\n    - (.+)\n")
NEEDS_NONE = {"CHANGELOG.md", "docs/pages.md"}      # looked up by version, or a list of links
SHARE = 0.6     # of an answer's words: it may use its own to say yes or no


def plain(text):
    return " ".join(re.sub(r"^> ?", "", text, flags=re.MULTILINE).replace("**", "").split()).lower()


def missing(answer, page):
    """What of an answer the page does not have."""
    page = plain(page)
    for span in re.findall(r"`([^`]+)`", answer):
        if span.lower() not in page:
            yield f"`{span}`"
    rest = re.sub(r"`[^`]+`", " ", answer).lower()
    for number in re.findall(r"(?<![\w.,])\d+(?:[.,]\d+)?(?![\w.]\w)", rest):
        if not re.search(rf"(?<![\w.,]){re.escape(number)}(?!\w|[.,]\d)", page):
            yield number
    words = re.findall(r"[^\W\d_]{4,}", rest)
    found = [word for word in words if word in page]
    if len(found) < SHARE * len(words):
        yield f"most of its words, such as {', '.join(sorted(set(words) - set(found)))}"


def check(text, page):
    """What is wrong with a list of questions."""
    asked = QUESTION.findall(text)
    if [int(number) for number, _, _ in asked] != list(range(1, 11)):
        yield f"numbers {[int(number) for number, _, _ in asked]}, not 1 to 10"
    if QUESTION.sub("", TITLE.sub("", text)).strip():
        yield f"neither title, question nor answer: {QUESTION.sub('', TITLE.sub('', text)).strip()[:60]}"
    if len({question for _, question, _ in asked}) < len(asked):
        yield "a question stands twice"
    for number, _, answer in asked:
        for what in missing(answer, page):
            yield f"answer {number}: the page has not {what}"


class Questions(unittest.TestCase):
    def test_each_page_has_ten_that_it_answers(self):
        lists = {TITLE.match(path.read_text(encoding="utf-8")).group(1): path for path in (ROOT / "tests/docs").rglob("*.md")}
        pages = {path.relative_to(ROOT).as_posix() for folder in ("docs", "course") for path in (ROOT / folder).rglob("*.md")}
        pages |= {"README.md", "CONTRIBUTING.md", "drivers/README.md"}
        self.assertEqual(set(lists), pages - NEEDS_NONE)
        for name, path in sorted(lists.items()):
            with self.subTest(page=name):
                self.assertEqual(list(check(path.read_text(encoding="utf-8"), (ROOT / name).read_text(encoding="utf-8"))), [])

    def test_an_answer_that_the_page_does_not_give_is_found(self):
        page = "# Lamp\n\nPress `on` for 5 seconds. The lamp is green then.\n"
        good = "# Ten questions on docs/lamp.md\n\n" + "".join(f"{n}. What {n}?\n    - Press `on` for 5 s: it is green.\n" for n in range(1, 11))
        self.assertEqual(list(check(good, page)), [])
        for old, new, what in (("5 s", "6 s", "the page has not 6"), ("`on`", "`off`", "the page has not `off`"), ("green", "blue, purple, violet", "words"),
                               ("10. What 10?", "10. What 9?", "twice"), ("3. What", "4. What", "not 1 to 10"), ("What 7?", "What 7", "neither")):
            found = list(check(good.replace(old, new), page))
            self.assertTrue(any(what in complaint for complaint in found), (new, found))


if __name__ == "__main__":
    ROOT = Path(sys.argv.pop(1))
    unittest.main()
