"""The numbers of one student: the same on each machine, and others for each student.

SHA-256 of the laboratory and the student's ID is the only source. Nothing of Python's random is used, because its sequences are Python's own affair.
"""
import hashlib
import re

ID = re.compile(r"[A-Za-z0-9._-]{1,32}")


class Draw:
    def __init__(self, laboratory, student):
        self.key, self.count = hashlib.sha256(f"plomada course {laboratory} {student} ".encode("ascii")), 0

    def bits(self):
        self.count += 1
        numbered = self.key.copy()
        numbered.update(b"%d" % self.count)
        return int.from_bytes(numbered.digest()[:8], "big")

    def whole(self, least, most, step=1):
        """One of least, least + step, ... most."""
        return least + step * (self.bits() % ((most - least) // step + 1))

    def one(self, choices):
        return choices[self.whole(0, len(choices) - 1)]

    def order(self, things):
        things = list(things)
        return [things.pop(self.whole(0, len(things) - 1)) for _ in range(len(things))]

    def noise(self, sigma):
        """About normal, with that deviation: the sum of twelve, a fixed order of IEEE additions."""
        return (sum(self.whole(0, 1 << 20) for _ in range(12)) / (1 << 20) - 6.0) * sigma
