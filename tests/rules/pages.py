"""The documents: nothing that they name is missing, and each can be read through.

Usage: pages.py ROOT [PROGRAM]
  links and their anchors lead somewhere; files and folders in `...` exist
  a function with a file in parentheses behind it, `take` (`firmware/uart_port.c`), is defined there
  each `make TARGET` is in the Makefile; with PROGRAM each option behind `plomada SUBCOMMAND` is in its --help
  each page has its kind in KINDS, and at most as many words as WORDS says of that kind: those of its text. Blocks of code and
  tables are looked up, not read through, so they do not count but on the front page. No limit holds for all pages together.
  each page in docs/ and course/, and CONTRIBUTING.md, says behind its title for whom it is and what he has at its end
  lists begin behind an empty line, as the site's Markdown demands (tools/site)
"""
import re
import subprocess
import sys
from pathlib import Path

import house

# Chosen: 250 words are a minute. The front page in two, all of it; a lesson or a task in ten, what is read in parts in twenty.
WORDS = {"front": 500, "tutorial": 2500, "how-to": 2500, "reference": 4500, "explanation": 4500}
LABORATORIES = ("01_frame", "02_tilt", "03_p", "04_pd", "05_pid", "06_windup", "07_response", "08_inversion", "09_estimation", "10_lies")
KINDS = {
    "front": ("README.md",),
    "tutorial": (*(f"course/{name}/README.md" for name in LABORATORIES), "docs/first_evening.md", "docs/ground.md", "docs/my_law.md", "docs/es/index.md", "docs/es/primera_tarde.md"),
    "how-to": ("CONTRIBUTING.md", "course/README.md", "docs/acceptance.md", "docs/campaign.md", "docs/fit.md", "docs/flashing.md",
               "docs/recordings.md", "docs/why.md", "drivers/README.md"),
    "reference": ("CHANGELOG.md", "docs/commands.md", "docs/hardware.md", "docs/memory.md", "docs/operator.md", "docs/pages.md", "docs/razor.md",
                  "docs/scip.md"),
    "explanation": ("docs/ablation.md", "docs/architecture.md", "docs/control.md", "docs/flight_states.md", "docs/portability.md", "docs/realtime.md",
                    "docs/reliability.md", "docs/walked.md"),
}
PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "drivers/README.md")
ROOMS = "bsp|ccs_project|cmake|control|course|docs|drivers|examples|firmware|ground|sim|tests|tools"
# The first words below the title, in the page's language.
FOR_WHOM = re.compile(r"# .*\n\n(?:> \*\*For\*\* (?:.|\n> )+\*\*At the end\*\* |> \*\*Para\*\* (?:.|\n> )+\*\*Al final\*\* )")
LINK = re.compile(r"\]\(([^)\s]*)\)")
NAMED = re.compile(rf"`((?:{ROOMS})/[\w./-]*\w)`")
PLACED = re.compile(rf"((?:`\w+`(?:\(\))?(?:,\s+)?)+)\s+\(`((?:{ROOMS})/[\w/]+\.c)`\)")
MAKE = re.compile(r"(?:`|^|\$ )make ([a-z][\w-]*)", re.MULTILINE)
USED = re.compile(r"plomada (scip [a-z]+|[a-z]+)((?: +(?:--?)?[^`\s|#;&>]+)*)")


def pages(root):
    return [*sorted((root / "docs").rglob("*.md")), *sorted((root / "course").rglob("*.md")), *(root / name for name in PAGES if (root / name).is_file())]


def anchor(title):
    """As GitHub makes it of a heading."""
    return re.sub(r"[^\w -]", "", re.sub(r"[`*]", "", title).strip().lower()).replace(" ", "-")


def anchors(text):
    return {anchor(title) for title in re.findall(r"^#+ (.*)$", re.sub(r"```.*?```", "", text, flags=re.DOTALL), re.MULTILINE)}


def missing_links(page, text):
    for target in LINK.findall(text):
        if re.match(r"\w+:", target):
            continue
        path, _, name = target.partition("#")
        file = (page.parent / path).resolve() if path else page
        if not file.exists():
            yield f"link to {target}: no such file"
        elif name and name not in anchors(file.read_text(encoding="utf-8")):
            yield f"link to {target}: no such heading"


def missing_files(root, text):
    for name in sorted(set(NAMED.findall(text))):
        if "NAME" not in name and not (root / name).exists():
            yield f"`{name}` does not exist"


def defines(root, file, function):
    text = (root / file).read_text(encoding="utf-8") if (root / file).is_file() else ""
    return re.search(rf"^\w[^;\n]*\b{function}\(", text, re.MULTILINE)


def missing_functions(root, text):
    for names, file in PLACED.findall(text):
        for function in re.findall(r"`(\w+)`", names):
            if not defines(root, file, function):
                yield f"{function}() is not in {file}"


def missing_targets(root, text):
    known = set(re.findall(r"^([\w-]+):", (root / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
    for target in sorted(set(MAKE.findall(text)) - known):
        yield f"make {target}: not in the Makefile"


class Help:
    def __init__(self, program):
        self.program, self.known = program, {}

    def of(self, subcommand):
        if subcommand not in self.known:
            done = subprocess.run([self.program, *subcommand.split(), "--help"], capture_output=True, text=True, check=False)
            self.known[subcommand] = done.stdout if done.returncode == 0 else None
        return self.known[subcommand]

    def missing(self, text):
        for subcommand, words in sorted(set(USED.findall(text))):
            told = self.of(subcommand)
            if told is None:
                yield f"plomada {subcommand}: no such subcommand"
                continue
            for option in re.findall(r"(?<= )--[a-z][\w-]*", words):
                if option != "--help" and not re.search(rf"{option}(?![\w-])", told):
                    yield f"plomada {subcommand} {option}: not in its --help"


def kind_of(page, kinds):
    return next((kind for kind, names in kinds.items() if page in names), None)


def for_nobody(name, text):
    if (name.startswith(("docs/", "course/")) or name == "CONTRIBUTING.md") and not FOR_WHOM.match(text):
        yield "does not say below its title > **For** whom it is, **At the end** what he has"


def glued_lists(text):
    """Lists right behind a line of text, which only some Markdown takes for lists."""
    prose = re.sub(r"^ *```.*?^ *```", lambda block: "\n" * block.group(0).count("\n"), text, flags=re.DOTALL | re.MULTILINE)
    lines = prose.splitlines()
    for number, (before, line) in enumerate(zip(lines, lines[1:]), 2):
        if re.match(r"(?:[-*]|1\.) ", line) and before.strip() and not re.match(r" *(?:[-*]|\d+\.) |  ", before):
            yield f"line {number}: a list begins right behind a line of text"


def count(text):
    """The words of a page's text, without blocks of code and rows of tables."""
    prose = re.sub(r"^```.*?^```", "", text, flags=re.DOTALL | re.MULTILINE)
    return sum(len(line.split()) for line in prose.splitlines() if not line.startswith("|"))


def too_long(name, text, kinds):
    kind = kind_of(name, kinds)
    if kind is None:
        yield f"of no kind: put it into KINDS of tests/rules/pages.py ({', '.join(WORDS)})"
        return
    words = len(text.split()) if kind == "front" else count(text)
    if words > WORDS[kind]:
        yield f"{words} words of text; a page of its kind, {kind}, has at most {WORDS[kind]}"


def check(root, program=None, kinds=None):
    helps = Help(program) if program else None
    for page in pages(root):
        text, name = page.read_text(encoding="utf-8"), page.relative_to(root).as_posix()
        for complaint in (*missing_links(page, text), *missing_files(root, text), *missing_functions(root, text),
                          *missing_targets(root, text), *(helps.missing(text) if helps else ()), *too_long(name, text, kinds or KINDS),
                          *for_nobody(name, text), *glued_lists(text)):
            yield f"{name}: {complaint}"


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    house.report(list(check(Path(sys.argv[1]).resolve(), *sys.argv[2:])), "pages")
