"""An answer in Python: run in a process of its own, so that what it prints, or does to itself, is not the marker's.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from criterion import Refused

RUNNER = Path(__file__).with_name("run_python.py")
ENDLESS_S = 60          # as in answer_c.py


class AnswerPython:
    built = True

    def __init__(self, path, plomada):
        self.path, self.plomada, self.complaints = Path(path), plomada, ""

    def close(self):
        pass

    def ask(self, steps):
        """What each step gave; Refused with the first that fails."""
        with tempfile.TemporaryDirectory() as folder:
            results = Path(folder) / "results.json"
            try:
                done = subprocess.run([sys.executable, "-B", "-I", RUNNER, self.path, results], input=json.dumps(steps), capture_output=True,
                                      text=True, check=False, timeout=ENDLESS_S)
            except subprocess.TimeoutExpired:
                raise Refused("it does not end") from None
            self.complaints = done.stderr
            if not results.exists():
                raise Refused("Python cannot run the file")
            found = json.loads(results.read_text(encoding="utf-8"))
        if isinstance(found, str):
            raise Refused(found)
        return found

    def value(self, name):
        return self.ask([["value", name]])[0]

    def calls(self, name, rows):
        return self.ask([["call", name, row] for row in rows])
