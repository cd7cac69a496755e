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
        self.path, self.plomada, self.complaints, self.asked = Path(path), plomada, "", {}

    def close(self):
        pass

    def ask(self, steps):
        """What each step gave; Refused with the first that fails. The same steps are asked once."""
        question = json.dumps(steps)
        if question not in self.asked:
            self.asked[question] = self.told(question)
        if isinstance(self.asked[question], str):
            raise Refused(self.asked[question])
        return self.asked[question]

    def told(self, question):
        """A list, or in words what went wrong."""
        with tempfile.TemporaryDirectory() as folder:
            results = Path(folder) / "results.json"
            try:
                done = subprocess.run([sys.executable, "-B", "-I", RUNNER, self.path, results], input=question, capture_output=True,
                                      text=True, errors="replace", check=False, timeout=ENDLESS_S)
            except subprocess.TimeoutExpired:
                return "it does not end"
            self.complaints = done.stderr
            return json.loads(results.read_text(encoding="utf-8")) if results.exists() else "Python cannot run the file"

    def value(self, name):
        return self.ask([["value", name]])[0]

    def calls(self, name, rows):
        return self.ask([["call", name, row] for row in rows])
