"""How often something goes wrong, over seeds that are drawn anew in each run: the one place of the draw, and of the verdict.

A requirement says how often it may at most. `judge` flies until the bounds of confidence (Clopper and Pearson 1934, exact) tell, at
the latest after the last of LOOKS:

  SHOWN   it happens at most as often: the upper bound is not above the requirement
  MISSED  it happens more often: the lower bound is above it
  OPEN    so many flights do not tell

Every look costs a part of the error, so that a requirement that is just met is taken for missed, or one that is just missed for
shown, in at most one run of twenty. All flights count: to look again is no second try.
"""
import os
import secrets
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field

from scipy import stats

ERROR = 0.05
LOOKS = (100, 200, 450, 900)
SHOWN, MISSED, OPEN = "SHOWN", "MISSED", "OPEN"
NAMED = 3           # flights that went wrong, by the command that repeats them


def drawn_seed():
    """Of this run; SOAK_SEED in the environment repeats one."""
    seed = int(os.environ.get("SOAK_SEED") or secrets.randbelow(1_000_000))
    print(f"SOAK_SEED={seed} repeats this run", flush=True)
    return seed


def bounds(count, of, error):
    """The lowest and the highest rate with which so few, or so many, are not less probable than `error` each."""
    low = stats.beta.ppf(error, count, of - count + 1) if count > 0 else 0.0
    high = stats.beta.ppf(1.0 - error, count + 1, of - count) if count < of else 1.0
    return float(low), float(high)


def told(count, of, must, error):
    low, high = bounds(count, of, error)
    return SHOWN if high <= must else MISSED if low > must else OPEN


@dataclass
class Found:
    verdict: str
    count: int
    of: int
    must: float
    wrong: list = field(default_factory=list)   # what was wrong with the first ones

    def __str__(self):
        low, high = bounds(self.count, self.of, ERROR / 2)
        return (f"{self.verdict}: {self.count} of {self.of}, {100 * self.count / self.of:.2g} % [{100 * low:.2g}-{100 * high:.2g}], "
                f"at most {100 * self.must:.2g} %")


def judge(must, wrong, looks=None):
    """Found. wrong(number) flies the flight of this number, from 0, and says what went wrong, or None."""
    complaints, flown, looks = [], 0, looks or LOOKS
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for look in looks:
            complaints += filter(None, pool.map(wrong, range(flown, look)))
            flown = look
            verdict = told(len(complaints), flown, must, ERROR / len(looks))
            if verdict != OPEN:
                break
    return Found(verdict, len(complaints), flown, must, complaints[:NAMED])
