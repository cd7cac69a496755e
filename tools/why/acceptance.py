#!/usr/bin/env python3
"""acceptance.py [--seed N] [--each N] [--kinds N] [--healthy N]: does `why` find causes that nobody told it?

Draws kinds of causes, plants each in the flights of drawn vehicles (planted.py), and asks `why`, which sees the logs alone. Prints each
flight, what was taken for what, and the rates with their 95 % bounds (Clopper and Pearson).

A must is a share. It is MISSED when so few would be improbable if it were kept (tools/campaign/rate.py).
Exit status: 0; 1 something is not as it must be; 2 usage.
"""
import argparse
import collections
import concurrent.futures
import os
import random
import sys
import tempfile
import time
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[1] / "fit"),
                str(Path(__file__).resolve().parents[1] / "campaign")]
import planted  # noqa: E402
import rate  # noqa: E402
import why  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
# Two sorts of one cause: their sentence tells them apart.
SORTS = {"colours": "floor", "rough": "floor", "blocked": "rays", "lost": "rays"}
KINDS = sorted({SORTS.get(name, name) for name in planted.CAUSES})
FIRST_MUST, TWO_MUST, HEALTHY_MUST = 24 / 30, 28 / 30, 9 / 10
SECONDS_MOST = 60.0


def sort_of(kind, number):
    sorts = [name for name in planted.CAUSES if SORTS.get(name, name) == kind] or [kind]
    return sorts[number % len(sorts)]


def one(program, seed, kind, number):
    """(kind, number, keys that were named, seconds of processor time)."""
    plan = planted.plan_of(sort_of(kind, number), seed, number)
    with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
        path = Path(scratch, "flight.csv")
        if not planted.fly(program, plan, path):
            return kind, number, None, 0.0
        begun = time.process_time()
        _, found = why.ask(path, program)
        return kind, number, why.verdict(found), time.process_time() - begun


def drawn_kinds(seed, count):
    return random.Random(f"kinds {seed}").sample(KINDS, min(count, len(KINDS)))


def results(program, seed, kinds, each, healthy):
    work = [(kind, number) for kind in kinds for number in range(each)] + [("nothing", number) for number in range(healthy)]
    with concurrent.futures.ProcessPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        futures = [pool.submit(one, program, seed, kind, number) for kind, number in work]
        for done in concurrent.futures.as_completed(futures):
            yield done.result()


def bounds_text(good, count):
    low, high = rate.bounds(good, count, rate.ERROR / 2)
    return f"{good} of {count} [{100 * low:.0f} .. {100 * high:.0f} %]"


def read_arguments(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seed", help="drawn anew, or SOAK_SEED of the environment, when none is given")
    parser.add_argument("--kinds", type=int, default=10, help=f"of the {len(KINDS)} kinds of causes (10)")
    parser.add_argument("--each", type=int, default=3, help="flights of each kind (3)")
    parser.add_argument("--healthy", type=int, default=10, help="flights without a cause (10)")
    parser.add_argument("--program", type=Path, default=ROOT / "build/plomada")
    return parser.parse_args(argv)


def main(argv=None):
    arguments = read_arguments(argv)
    seed = rate.drawn_seed() if arguments.seed is None else arguments.seed
    kinds = drawn_kinds(seed, arguments.kinds)
    print(f"seed {seed}: {', '.join(kinds)}")
    first = two = well = planted_count = healthy_count = 0
    taken, slowest = collections.Counter(), 0.0
    for kind, number, named, seconds in results(arguments.program, seed, kinds, arguments.each, arguments.healthy):
        slowest = max(slowest, seconds)
        named = [] if named is None else named
        right = named == [] if kind == "nothing" else named[:1] == [kind]
        if kind == "nothing":
            healthy_count, well = healthy_count + 1, well + right
        else:
            planted_count, first, two = planted_count + 1, first + right, two + (kind in named[:2])
        if not right:
            taken[kind, named[0] if named else "nothing"] += 1
        print(f"{'  ' if right else '! '}{kind:11} {number:3} {seconds:5.1f} s  {', '.join(named) or 'nothing found'}", flush=True)
    for (kind, other), count in taken.most_common():
        print(f"{kind} taken for {other}: {count}")
    musts = [("first guess right", first, planted_count, FIRST_MUST), ("one of the first two", two, planted_count, TWO_MUST),
             ("healthy: nothing found", well, healthy_count, HEALTHY_MUST)]
    missed = slowest > SECONDS_MOST
    for words, good, count, must in musts:
        if count:
            failed = rate.told(count - good, count, 1.0 - must, rate.ERROR / len(musts)) == rate.MISSED
            missed = missed or failed
            print(f"{words}: {bounds_text(good, count)}, must be {100 * must:.0f} %{': MISSED' if failed else ''}")
    print(f"slowest: {slowest:.1f} s of processor time, at most {SECONDS_MOST:.0f}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
