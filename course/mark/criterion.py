"""What a laboratory asks for, and how its points are told."""
from dataclasses import dataclass
from typing import Callable


class Refused(Exception):
    """An answer that cannot be asked: why, in words that are the same on each machine."""


@dataclass(frozen=True)
class Criterion:
    points: int
    says: str                       # what gets the points
    check: Callable                 # check(answer, numbers): (points, what was measured)
    hint: str                       # for who did not get them all

    def row(self, answer, numbers):
        """(points, the lines of the report)"""
        try:
            earned, measured = self.check(answer, numbers)
        except Refused as why:
            earned, measured = 0, str(why)
        lines = [f"{earned} of {self.points}  {self.says}: {measured}"]
        return earned, lines + [f"        {self.hint}"] * (earned < self.points)


def all_or_nothing(points, passed, measured):
    return (points if passed else 0), measured


def shared(points, right, asked, measured):
    """As many points as the share of right ones, rounded down."""
    return points * right // asked, measured
