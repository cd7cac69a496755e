#!/usr/bin/env python3
"""acceptance.py [--seed N] [--each N] [--kinds N] [--healthy N] [--strengths N] [--cut S] [--table FILE...]: does `why` find causes that nobody told it?

Draws kinds of causes, plants each in the flights of drawn vehicles (planted.py), as strong as its range has it, and asks `why`, which
sees the logs alone. Prints each flight, what was taken for what, and the rates with their 95 % bounds (Clopper and Pearson). A cause
that is no stronger than what healthy vehicles, air and noise make is flown too, and counted by itself: `nothing found` is right there.

A must is a share, and the words are those of tools/campaign/rate.py: SHOWN, the bounds lie at it or above; MISSED, they lie below it;
OPEN, so many flights do not tell. docs/why.md has the words that this prints. --strengths N: in place of that N flights of each
third of each range, and how often the first guess was right there; --table: the same of what earlier runs printed. --cut S: no log has
the first S seconds of its flight. Causes that only the beginning tells are not drawn then.
Exit status: 0; 1 a must is MISSED, or a log took too long; 2 usage.
"""
import argparse
import collections
import concurrent.futures
import os
import random
import re
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[1] / "fit"),
                str(Path(__file__).resolve().parents[1] / "campaign")]
import planted  # noqa: E402
import rate  # noqa: E402
import why  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
# Two sorts of one cause: their sentence tells them apart.
SORTS = {"colours": "floor", "rough": "floor", "blocked": "rays", "lost": "rays", "rope": "ropes", "tugs": "ropes"}
KINDS = sorted({SORTS.get(name, name) for name in planted.CAUSES})
OF_THE_BEGINNING = {"grav"}     # law EST uses GRAV in its first command only
FIRST_MUST, TWO_MUST, HEALTHY_MUST = 24 / 30, 28 / 30, 9 / 10
SECONDS_MOST = 60.0
LINE = re.compile(r"(?P<mark>[ !~]) (?P<sort>\w+) +\d+ (?P<value>[\d.e-]+)")
TRIES = 20                      # draws for each flight that shows its cause


@dataclass
class Told:
    """What `why` said of one flight."""
    sort: str
    number: int
    plan: planted.Plan
    named: list
    guessed: list               # why.guesses(); None: nothing found
    mirrors: tuple
    seconds: float              # of processor time

    def kind(self):
        return SORTS.get(self.sort, self.sort)

    def right(self):
        return self.named == [] if self.sort == "nothing" else self.named[:1] == [self.kind()]

    def line(self):
        mark = " " if self.right() else "!" if self.plan.shown else "~"
        strength = "" if self.sort == "nothing" else f"{self.plan.value:.3g} {planted.RANGES[self.sort].unit}"
        said = ", ".join(self.named) if self.named else ", if anything ".join(["nothing found", *self.guessed[1:]])
        return f"{mark} {self.sort:11} {self.number:3} {strength:13} {self.seconds:5.1f} s  {said}"


def one(program, seed, cut_s, sort, number, share=None):
    plan = planted.plan_of(sort, seed, number, share)
    with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
        path = Path(scratch, "flight.csv")
        if not planted.fly(program, plan, path):
            return Told(sort, number, plan, [], [], (), 0.0)
        if cut_s > 0.0:
            planted.cut(path, cut_s)
        begun = time.process_time()
        _, found = why.ask(path, program)
        mirrors = found["rays"].words.get("mirrors", ()) if "rays" in found else ()
        return Told(sort, number, plan, why.verdict(found), why.guesses(found), mirrors, time.process_time() - begun)


def drawn_kinds(seed, count, kinds):
    return random.Random(f"kinds {seed}").sample(kinds, min(count, len(kinds)))


def drawn_work(seed, kinds, each, healthy):
    """[(sort, number, share)] until each kind has so many flights that show it."""
    work = []
    for kind in kinds:
        sorts = [name for name in planted.CAUSES if SORTS.get(name, name) == kind]
        number = shown = 0
        while shown < each and number < TRIES * each:
            sort = sorts[number % len(sorts)]
            work.append((sort, number, None))
            shown += planted.plan_of(sort, seed, number).shown
            number += 1
    return work + [("nothing", number, None) for number in range(healthy)]


def results(program, seed, work, cut_s=0.0):
    with concurrent.futures.ProcessPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        futures = [pool.submit(one, program, seed, cut_s, *job) for job in work]
        for done in concurrent.futures.as_completed(futures):
            yield done.result()


def strengths(program, seed, count):
    """Flies each third of each range so often, and prints the table."""
    work = [(sort, number, (number % 3 + (number // 3 + 0.5) / count) / 3.0) for number in range(3 * count) for sort in planted.CAUSES]
    lines = []
    for result in results(program, seed, work):
        lines.append(result.line())
        print(lines[-1], flush=True)
    print(table(lines))
    return 0


def table(lines):
    """How often the first guess was right, by third of each range: of flights as Told.line() has them."""
    cells = collections.defaultdict(list)
    for line in lines:
        flight = LINE.match(line)
        if flight and flight["sort"] in planted.RANGES:
            of = planted.RANGES[flight["sort"]]
            cells[flight["sort"], planted.third_of(of.share(float(flight["value"])))].append(flight["mark"] == " ")
    rows = ["| cause | strength | healthy up to | weak | middle | strong | where the range comes from |", "|---|---|---|---|---|---|---|"]
    for sort, of in planted.RANGES.items():
        rates = " | ".join(f"{sum(cells[sort, third])} of {len(cells[sort, third])}" for third in planted.THIRDS)
        limit = "-" if of.shown(of.weak) else f"{of.healthy:.3g}"
        rows.append(f"| {sort} | {of.what}, {of.weak:.3g} to {of.strong:.3g} {of.unit} | {limit} | {rates} | {of.source} |")
    return "\n".join(rows)


def bounds_text(good, count):
    low, high = rate.bounds(good, count, rate.ERROR / 2)
    return f"{good} of {count} [{100 * low:.0f} .. {100 * high:.0f} %]"


def read_arguments(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", help="drawn anew, or SOAK_SEED of the environment, when none is given")
    parser.add_argument("--kinds", type=int, default=10, help=f"of the {len(KINDS)} kinds of causes (10)")
    parser.add_argument("--each", type=int, default=3, help="flights of each kind that show it (3)")
    parser.add_argument("--healthy", type=int, default=10, help="flights without a cause (10)")
    parser.add_argument("--strengths", type=int, default=0, help="the table of strengths, with so many flights of each third")
    parser.add_argument("--cut", type=float, default=0.0, metavar="S", help="seconds of the flight that each log has lost (0)")
    parser.add_argument("--table", type=Path, nargs="+", metavar="FILE", help="the table of the flights that earlier runs printed, saved in FILE")
    parser.add_argument("--program", type=Path, default=ROOT / "build/plomada")
    return parser.parse_args(argv)


def main(argv=None):
    arguments = read_arguments(argv)
    if arguments.table:
        print(table([line for path in arguments.table for line in path.read_text(encoding="utf-8").splitlines()]))
        return 0
    seed = rate.drawn_seed() if arguments.seed is None else arguments.seed
    if arguments.strengths:
        return strengths(arguments.program, seed, arguments.strengths)
    kinds = drawn_kinds(seed, arguments.kinds, [kind for kind in KINDS if arguments.cut <= 0.0 or kind not in OF_THE_BEGINNING])
    print(f"seed {seed}: {', '.join(kinds)}")
    told = []
    for result in results(arguments.program, seed, drawn_work(seed, kinds, arguments.each, arguments.healthy), arguments.cut):
        told.append(result)
        print(result.line(), flush=True)
    shown = [each for each in told if each.sort != "nothing" and each.plan.shown]
    weak = [each for each in told if each.sort != "nothing" and not each.plan.shown]
    well = [each for each in told if each.sort == "nothing"]
    taken = collections.Counter((each.sort, each.named[0] if each.named else "nothing") for each in shown + well if not each.right())
    for (sort, other), count in taken.most_common():
        print(f"{sort} taken for {other}: {count}")
    slowest = max(each.seconds for each in told)
    musts = [("first guess right", sum(each.right() for each in shown), len(shown), FIRST_MUST),
             ("one of the first two", sum(each.kind() in each.guessed[:2] for each in shown), len(shown), TWO_MUST),
             ("healthy: nothing found", sum(each.right() for each in well), len(well), HEALTHY_MUST)]
    if weak:
        print(f"no stronger than what healthy flights have: {len(weak)}; nothing found {sum(not each.named for each in weak)}, "
              f"the cause itself {sum(each.right() for each in weak)}")
    if well:
        print(f"healthy, behind `nothing found` a cause that is too weak to be named: {sum(len(each.guessed) > 1 for each in well if not each.named)}")
    struck = [each for each in shown if each.plan.mirrors and each.right()]
    if struck:
        print(f"mirrors named right: {sum(set(each.mirrors) == each.plan.mirrors for each in struck)} of {len(struck)}")
    missed = slowest > SECONDS_MOST
    for words, good, count, must in musts:
        if count:
            verdict = rate.told(count - good, count, 1.0 - must, rate.ERROR / len(musts))
            missed = missed or verdict == rate.MISSED
            print(f"{words}: {bounds_text(good, count)}, must be {100 * must:.0f} %: {verdict}")
    print(f"slowest: {slowest:.1f} s of processor time, at most {SECONDS_MOST:.0f}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
