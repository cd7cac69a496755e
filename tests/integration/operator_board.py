"""The board of operator_board.c, and a person who types at it with pauses."""
import contextlib
import re
import subprocess

PAUSE_S = 15    # between two lines of somebody who reads, looks and types


class OperatorBoard:
    def __init__(self, program, pause_s=PAUSE_S, seed=1):
        self.pause_s = pause_s
        self.process = subprocess.Popen([program, str(seed)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, encoding="latin-1")
        self.heard = []         # lines since clear()
        self.all = []

    def __enter__(self):
        return self

    def __exit__(self, *unused):
        self.process.stdin.close()
        self.process.stdout.close()
        self.process.wait(timeout=60)

    def order(self, text):
        """What came meanwhile."""
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()
        lines = []
        while (line := self.process.stdout.readline()) not in (".\n", ""):
            lines.append(line.rstrip("\r\n"))
        assert line, f"the board stopped at: {text}"
        self.heard += lines
        self.all += lines
        return lines

    def clear(self):
        self.heard = []

    @contextlib.contextmanager
    def tried(self):
        """What is done with the board in here has not happened afterwards."""
        before = [*self.heard], [*self.all]
        self.order("keep")
        yield
        self.order("back")
        self.heard, self.all = before

    def type(self, line):
        self.order(f"type {line}")
        self.wait(self.pause_s)

    def wait(self, seconds):
        self.order(f"wait {seconds}")

    def truth(self):
        """height_m, thrust_n, whether the motors run."""
        height, thrust, motors = self.order("truth")[-1].split()[1:]
        return float(height), float(thrust), motors == "1"

    def answers(self):
        return [line for line in self.heard if re.match(r"(OK|ERR) ", line)]

    def telemetry(self):
        return [line for line in self.heard if line.startswith("alt:")]
