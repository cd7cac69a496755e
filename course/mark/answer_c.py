"""An answer in C: a shared object that build/course_marker asks and flies."""
import json
import os
import shutil
import subprocess
import tempfile
from pathlib import Path

from criterion import Refused

ROOT = Path(__file__).resolve().parents[2]
# As the product is built. No -Werror: what a compiler warns of is not the same on each machine.
FLAGS = ("-std=gnu99", "-O2", "-ffp-contract=off", "-fPIC", "-shared", "-Wall", "-Wextra", f"-I{ROOT}")
ENDLESS_S = 60          # no answer needs a second: what takes so long does not end


class AnswerC:
    def __init__(self, path, marker):
        self.marker, self.folder, self.flights = marker, tempfile.TemporaryDirectory(), {}
        self.object = Path(self.folder.name) / "answer.so"
        compiler = os.environ.get("CC") or next(filter(shutil.which, ("cc", "gcc", "clang")), "cc")
        done = subprocess.run([compiler, *FLAGS, "-o", self.object, path, "-lm"], capture_output=True, text=True, errors="replace",
                              check=False)     # a line that it shows may have any octets
        self.built, self.complaints = done.returncode == 0, done.stderr

    def close(self):
        self.folder.cleanup()

    def run(self, *words, text=""):
        if not self.built:
            raise Refused("not asked, because it could not be built")
        try:
            done = subprocess.run([self.marker, self.object, *words], input=text, capture_output=True, text=True, errors="replace", check=False, timeout=ENDLESS_S)
        except subprocess.TimeoutExpired:
            raise Refused("it does not end") from None
        if done.returncode == 3:
            raise Refused(done.stderr.strip().replace("course_marker: ", ""))
        if done.returncode < 0:
            raise Refused("the program was ended by a fault of memory or arithmetic")
        return done.stdout

    def numbers(self, kind, lines):
        """Whole numbers, one row for each line that was asked, but for "again"."""
        return [[int(word) for word in row.split()] for row in self.run(kind, text="".join(f"{line}\n" for line in lines)).splitlines()]

    def foresaw(self, name):
        """A number that the student foresaw, in thousandths."""
        return int(self.run("number", name))

    def fly(self, scenario):
        """The figures of one flight; flown once."""
        if scenario not in self.flights:
            path = Path(self.folder.name) / "lab.scenario"
            path.write_text(scenario, encoding="ascii")
            figures = Path(self.folder.name) / "flight.json"
            figures.unlink(missing_ok=True)
            self.run("fly", path, "--json", figures)
            if not figures.exists():
                raise Refused("the flight could not be flown")
            self.flights[scenario] = json.loads(figures.read_text(encoding="utf-8"))
        return self.flights[scenario]
