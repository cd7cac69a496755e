"""Every block of docs/scip.md is what its command prints. Usage: test_scip_page.py BUILD_DIRECTORY [--write]

With --write it puts into the page what the commands print. The block of the bench is left out where valgrind is not
installed, or the compiler is not that of the baseline."""
import csv
import re
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs/scip.md"
BUILD = Path(sys.argv.pop(1)).resolve()
BLOCK = re.compile(r"^```console\n\$ (.*)\n((?:.*\n)*?)```$", re.MULTILINE)


def counts_as_the_baseline():
    compiler = subprocess.run(["cc", "-dumpversion"], check=True, capture_output=True, text=True).stdout.strip()
    return shutil.which("valgrind") is not None and compiler == "12"


def skipped(command):
    return "bench.py" in command and not counts_as_the_baseline()


def printed(command):
    command = command.replace("build/", f"{BUILD}/") + (f" '{BUILD}/bench'" if "bench.py" in command else "")
    done = subprocess.run(command, shell=True, cwd=ROOT, check=False, capture_output=True, text=True)
    return done.stdout if done.returncode == 0 else f"status {done.returncode}\n{done.stdout}{done.stderr}"


class Page(unittest.TestCase):
    def setUp(self):
        self.page = PAGE.read_text(encoding="utf-8")

    def test_every_block_is_what_its_command_prints(self):
        for command, shown in BLOCK.findall(self.page):
            if not skipped(command):
                with self.subTest(command):
                    self.assertEqual(printed(command), shown)

    def test_every_block_is_a_command(self):
        self.assertEqual(self.page.count("```"), 2 * len(BLOCK.findall(self.page)))
        self.assertEqual(len(BLOCK.findall(self.page)), 6)

    def test_other_pages_have_the_same_figures(self):
        with open(ROOT / "tools/bench/baseline.csv", encoding="utf-8") as file:
            counted = {row["step"]: row["instructions"] for row in csv.DictReader(file)}
        for name in ("drivers/README.md", "docs/realtime.md"):
            words = " ".join((ROOT / name).read_text(encoding="utf-8").split())
            figures = re.findall(r"(\d+) instructions", words)
            with self.subTest(name):
                self.assertEqual(sorted(figures), sorted([counted["scip_frame"], counted["scip_frame_by_octet"]]))

    def test_the_files_it_names_exist(self):
        for name in re.findall(r"`((?:drivers|tests|tools|sim)/[\w/.]+\.\w+)`", self.page):
            self.assertTrue((ROOT / name).is_file(), name)
        for name in re.findall(r"\]\(([\w/.]+)\)", self.page):
            self.assertTrue((ROOT / "docs" / name).is_file(), name)


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        text = PAGE.read_text(encoding="utf-8")
        PAGE.write_text(BLOCK.sub(lambda block: f"```console\n$ {block.group(1)}\n{printed(block.group(1))}```", text),
                        encoding="utf-8")
    else:
        unittest.main()
