"""Every command of the program that a page tells to type is run: it must be understood, and end as a flight or a listing does.

Usage: test_page_commands.py ROOT PLOMADA

A command is what begins with `plomada` or `build/plomada` in a block of code or in `...`. The commands of a page are run in its order in one folder,
which has the files that prepare() makes. A subcommand that is only named must have its --help. What is a form (FILE, [...]) or needs a board, a
port or a person is counted, not run. A line of make must have a target, variables and a file that are there: what it then does takes minutes, and has
tests of its own.
"""
import functools
import re
import shlex
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FORM = re.compile(r"\b(SCENARIO|FILE|DIR|NAME|ADDRESS|COMMAND|SUBCOMMAND|PATH|DEVICE|SPEC|LINE)\b|\.\.\.|…|\[|(^| )-o$")
BY_HAND = re.compile(r"/dev/|/tmp/|--realtime|\b(hil|accept|board|laser)\b|pty|\breal\b")
BEGINS = re.compile(r"(?:\$ )?(?:time )?((?:build/|build-mine/)?plomada(?: .*)?)")
FLIGHT_MOST_S = 120


def commands(text):
    """Those of a page, in its order, without what a shell would do with their output."""
    for block, span in re.findall(r"```\w*\n(.*?)```|`([^`]+)`", text, re.DOTALL):
        for line in block.replace("\\\n", " ").splitlines() if block else [" ".join(span.split())]:
            found = BEGINS.fullmatch(line.strip())
            if found:
                yield re.split(r" +[#|>]| >|>(?=\w)| &", found.group(1))[0].strip()


def kind(command):
    if re.fullmatch(r"plomada (scip )?[a-z]+", command):
        return "named"
    if FORM.search(command) or len(command.split()) < 2:
        return "form"
    return "by hand" if BY_HAND.search(command) else "run"


@functools.cache
def flown():
    """(console with a dump, log) of one short flight: the dump comes by radio and takes minutes, so all pages share it."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        assert fly(folder, "fly experiment --duration 8 --log console.log --csv console.csv").returncode == 0
        return (folder / "console.log").read_bytes(), (folder / "console.csv").read_bytes()


def prepare(folder):
    """What the pages speak of: a program, the repository's folders, a console with a dump, a scanner's recording."""
    for name in ("build", "build-mine"):
        (folder / name).mkdir()
        (folder / name / "plomada").symlink_to(PLOMADA)
    for name in ("docs", "examples", "tests"):
        (folder / name).symlink_to(ROOT / name)
    console, log = flown()
    (folder / "console.log").write_bytes(console)
    (folder / "build/console.csv").write_bytes(log)
    (folder / "build/vehicle.json").write_text('{"plant.hover_thrust": {"value": 7.2}}', encoding="utf-8")
    (folder / "room.bin").write_bytes((ROOT / "tests/fixtures/scip/real_md_0384.bin").read_bytes())


def fly(folder, words):
    return subprocess.run([PLOMADA, *shlex.split(words)], cwd=folder, capture_output=True, text=True, check=False, timeout=FLIGHT_MOST_S,
                          errors="replace")


def makes(text):
    """(target, {variable: value}) of each `make TARGET VARIABLE=VALUE ...` of a page."""
    for block, span in re.findall(r"```\w*\n(.*?)```|`([^`]+)`", text, re.DOTALL):
        for line in block.replace("\\\n", " ").splitlines() if block else [" ".join(span.split())]:
            found = re.fullmatch(r"(?:\$ )?(?:time )?make ([a-z-]+)((?: [A-Z]+=.*)?)", line.strip())
            if found:
                words = shlex.split(found.group(2).split(" # ")[0])
                yield found.group(1), dict(word.strip("[]").split("=", 1) for word in words if "=" in word)


def wrong_make(target, given):
    """What make would not do with it: a target or a variable that the Makefile does not have, a file that is not there."""
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    if not re.search(rf"^{target}:", makefile, re.MULTILINE):
        return f"no target {target}"
    for name, value in given.items():
        if f"$({name})" not in makefile:
            return f"nothing reads {name}"
        if name == "FILE" and "/" in value and not FORM.search(value) and not (ROOT / value).exists() and not value.startswith(("my", "answers/")):
            return f"no file {value}"
    return None


class Commands(unittest.TestCase):
    def test_each_that_can_be_run_is_understood(self):
        counted = {"form": 0, "named": 0, "by hand": 0, "run": 0}
        for page in (*sorted((ROOT / "docs").rglob("*.md")), *sorted((ROOT / "course").rglob("*.md")), ROOT / "README.md", ROOT / "CONTRIBUTING.md"):
            told = [(kind(command), command) for command in commands(page.read_text(encoding="utf-8"))]
            with tempfile.TemporaryDirectory() as name:
                if any(what == "run" for what, _ in told):
                    prepare(Path(name))
                for what, command in told:
                    counted[what] += 1
                    if what in ("run", "named"):
                        with self.subTest(page=page.name, command=command):
                            done = fly(Path(name), command.split(None, 1)[1] + " --help" * (what == "named"))
                            self.assertIn(done.returncode, (0, 1), done.stderr[-300:])
        self.assertGreater(counted["run"], 20, counted)
        self.assertLess(counted["by hand"], 25, counted)

    def test_make_has_each_target_variable_and_file_that_a_page_gives_it(self):
        found = [(page.name, target, given)
                 for page in (*(ROOT / "docs").rglob("*.md"), *(ROOT / "course").rglob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md")
                 for target, given in makes(page.read_text(encoding="utf-8"))]
        self.assertGreater(sum(1 for _, _, given in found if given), 20)
        self.assertEqual([(*one, wrong_make(*one[1:])) for one in found if wrong_make(*one[1:])], [])

    def test_a_line_of_make_that_would_do_nothing_is_found(self):
        for line in ("make fly-away", "make mine FLIE=law.c", "make mine FILE=examples/my_law/none.c", "make lab NUMBER=3"):
            self.assertIsNotNone(wrong_make(*next(makes(f"`{line}`"))), line)

    def test_a_command_that_is_not_understood_is_found(self):
        with tempfile.TemporaryDirectory() as name:
            prepare(Path(name))
            for command in ("build/plomada fly est-60cm-rump", "plomada fly est-60cm-ramp --sed 3", "build/plomada lost"):
                self.assertEqual([kind(found) for found in commands(f"`{command}`")], ["run"])
                self.assertNotIn(fly(Path(name), command.split(None, 1)[1]).returncode, (0, 1), command)


if __name__ == "__main__":
    ROOT, PLOMADA = Path(sys.argv[1]).resolve(), str(Path(sys.argv[2]).resolve())
    unittest.main(argv=sys.argv[:1])
