#!/usr/bin/env python3
"""seed_study.py [--vehicles N] [--page]: which autopilot did the seed fly?

The seed tells in words how its laws flew, and never what the throttle commands. This draws N vehicles of two kinds,
throttle = THRUST and throttle = CLIMB rate (mid-point, deadband, lag free), flies the seed's tests on each, counts the
statements (statements.py) that hold, searches on around the best, and flies the best of each kind again with seeds that
the search did not use. P and PD fly by the seed's first bracket, PID by its last; at the end the best are judged with the
last bracket for all, too. A vehicle is the plant's figures, drawn from --seed; all else is the nominal vehicle.
The table goes to stdout and DIR/seed_study.md, every vehicle with what holds to DIR/seed_study.csv; --page writes
the statements that do not hold for all into docs/control.md. Exit status 0; 2 usage or a program that does not fly.
"""
import argparse
import csv
import json
import math
import random
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/campaign"))
import fleet  # noqa: E402
import statements  # noqa: E402

PAGE = ROOT / "docs/control.md"
MARKS = ("<!-- by make seed-study ARGS=--page -->", "<!-- end of the seed study -->")
REFERENCE_M = {"no-feedforward": 0.4, "p-only-30cm": 0.3, "pd-unsaturated-30cm": 0.3, "pd-35cm": 0.35, "pid-40cm": 0.4,
               "pid-40cm-tugs": 0.4, "pid-60cm-ramp": 0.6}

# figure: (lowest, highest, drawn by its logarithm). Hover thrust: GRAV 7 N "almost lifts" the vehicle, so it is above.
KINDS = {
    "THRUST": {"damping": (0.5, 5.0, False), "hover_thrust": (7.02, 7.9, False), "tau": (0.06, 0.25, True),
               "gain": (0.7, 1.3, False), "tdelay": (0.005, 0.06, True), "turbulence": (0.1, 0.4, True)},
    "CLIMB": {"climb_rate": (0.3, 4.0, True), "climb_neutral": (5.88, 7.9, False), "climb_deadband": (0.0, 1.0, False),
              "climb_lag": (0.08, 0.8, True), "tdelay": (0.005, 0.06, True), "turbulence": (0.1, 0.4, True)},
}
MEANT = {"damping": "damping 1/s", "hover_thrust": "hover thrust N", "tau": "motor lag s", "gain": "thrust gain",
         "tdelay": "delay s", "turbulence": "turbulence m/s2", "climb_rate": "rate m/s/N", "climb_neutral": "mid-point N",
         "climb_deadband": "deadband N", "climb_lag": "lag s"}
MANY = 18          # statements that fit a vehicle well
LAST = "the last bracket for all"
CLIMB_AS_DRAWN = {"hover_thrust": 7.4}     # under the autopilot's own speed loop it hardly matters


def draw(rng, kind):
    def one(low, high, by_logarithm):
        return math.exp(rng.uniform(math.log(low), math.log(high))) if by_logarithm else rng.uniform(low, high)
    return {name: one(*span) for name, span in KINDS[kind].items()}


def near(rng, kind, vehicle, width):
    """A vehicle beside one, within the ranges."""
    found = {}
    for name, (low, high, by_logarithm) in KINDS[kind].items():
        at = math.log(vehicle[name]) if by_logarithm else vehicle[name]
        span = math.log(high / low) if by_logarithm else high - low
        moved = at + rng.gauss(0.0, width * span)
        found[name] = min(max(math.exp(moved) if by_logarithm else moved, low), high)
    return found


def later(flight, brackets):
    """Rays of the first bracket come later; LAST: nothing flew by it."""
    return {"scan_late": statements.FIRST_BRACKET_LATER_S} if brackets != LAST and flight in statements.BY_FIRST_BRACKET else {}


def fly(program, kind, vehicle, flight, seed, brackets="as flown"):
    scenario, typed, _ = statements.FLIGHTS[flight]
    figures = vehicle | (CLIMB_AS_DRAWN if kind == "CLIMB" else {}) | later(flight, brackets)
    words = [scenario, "--seed", str(seed)]
    words += [word for name, value in figures.items() for word in ("--set", f"plant.{name}={value:.6g}")]
    words += [word for name, value in typed.items() for word in ("--set", f"{name}={value}")]
    with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
        log = Path(scratch, "flight.csv")
        out = Path(scratch, "flight.json")
        words += ["--json", str(out)] + (["--csv", str(log)] if flight in statements.TRACKED else [])
        done = subprocess.run([program, "fly", *words], stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                              stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode not in (0, 1):
            raise fleet.Broken(f"{program} fly {' '.join(words)}: {done.stderr.strip()}")
        found = json.loads(out.read_text(encoding="utf-8"))
        reference_m = REFERENCE_M[scenario]
        found["reference_mm"] = reference_m * 1000.0
        if flight in statements.TRACKED:
            with log.open(encoding="utf-8") as rows:
                found |= statements.course([(float(row["t_s"]), float(row["height_m"])) for row in csv.DictReader(rows)],
                                           reference_m)
        return {name: float(value) for name, value in found.items() if isinstance(value, (int, float))}


def look(program, kind, vehicle, seeds, flights=statements.FLIGHTS, brackets="as flown"):
    """{flight: mean figures}."""
    means = {}
    for flight in flights:
        once = statements.FLIGHTS[flight][2]
        flown = [fly(program, kind, vehicle, flight, seed, brackets) for seed in (seeds[:1] if once else seeds)]
        means[flight] = {name: sum(one[name] for one in flown) / len(flown) for name in flown[0]
                         if all(name in one for one in flown)}
    return means


def judge(means):
    return [bool(statement.holds(means)) for statement in statements.STATEMENTS]


def search(program, kind, rng, vehicles, seeds, progress):
    """[(how many hold, vehicle, what holds)], best first."""
    def flown(candidates):
        def one(vehicle):
            held = judge(look(program, kind, vehicle, seeds))
            progress.step()
            return sum(held), vehicle, held
        with ThreadPoolExecutor(max_workers=2) as pool:
            return list(pool.map(one, candidates))

    found = flown([draw(rng, kind) for _ in range(vehicles // 2)])
    for width in (0.12, 0.06):
        found.sort(key=lambda row: -row[0])
        best = [vehicle for _, vehicle, _ in found[:6]]
        found += flown([near(rng, kind, best[at % len(best)], width) for at in range(vehicles // 4)])
    return sorted(found, key=lambda row: -row[0])


def described(vehicle):
    return ", ".join(f"{MEANT[name]} {value:.3g}" for name, value in vehicle.items())


def figures_of(best):
    """Lines: what the two best laws of the seed do with each vehicle, in mm."""
    for name, pick in (("PD with a window: spread mm", lambda f: statements.spread_mm(f["PD saturated"])),
                       ("and mean error mm", lambda f: f["PD saturated"]["hover_mean_error_mm"]),
                       ("PID: spread mm", lambda f: statements.spread_mm(f["PID"])),
                       ("and mean error mm", lambda f: f["PID"]["hover_mean_error_mm"])):
        yield name, [f"{pick(means):.0f}" for _, means in best.values()]


def count(means):
    return f"{sum(judge(means))} of {len(statements.STATEMENTS)}"


def table(best, by_last, for_page=False):
    """best: {column: (vehicle or None, means)}; by_last: {column: means} with the last bracket for all. The page has the
    statements that do not hold for all, without how they are judged."""
    judged = [judge(means) for _, means in best.values()]
    rows = [(["the seed", "judged by"], list(best))]
    for statement, held in zip(statements.STATEMENTS, zip(*judged, strict=True), strict=True):
        if not (for_page and all(held)):
            rows.append(([f"{statement.words} ({statement.source})", statement.reading], ["yes" if one else "**no**" for one in held]))
    rows.append((["**holds**", ""], [count(means) for _, means in best.values()]))
    rows.append((["holds, if PD had had the last bracket", ""], [count(by_last[column]) for column in best]))
    rows += [] if for_page else [([name, ""], cells) for name, cells in figures_of(best)]
    first, *others = ["| " + " | ".join([*(names[:1] if for_page else names), *cells]) + " |" for names, cells in rows]
    columns = len(best) + (1 if for_page else 2)
    return "\n".join([first, "|" + "---|" * columns, *others, "", *(
        f"- {column}: {described(vehicle) if vehicle else 'the default plant'}." for column, (vehicle, _) in best.items())])


def write_page(text):
    page = PAGE.read_text(encoding="utf-8")
    start, end = (re.escape(mark) for mark in MARKS)
    page, count = re.subn(f"{start}.*?{end}", lambda _: f"{MARKS[0]}\n\n{text}\n{MARKS[1]}", page, flags=re.DOTALL)
    if count != 1:
        raise fleet.Broken(f"{PAGE}: no place for the table")
    PAGE.write_text(page, encoding="utf-8")


def write_csv(path, found):
    with path.open("w", encoding="utf-8", newline="") as out:
        rows = csv.writer(out)
        names = list(MEANT)
        rows.writerow(["kind", "holds", *names, *(statement.words for statement in statements.STATEMENTS)])
        for kind, ranked in found.items():
            for count, vehicle, held in ranked:
                rows.writerow([kind, count, *(f"{vehicle[name]:.6g}" if name in vehicle else "" for name in names),
                               *(int(one) for one in held)])


def tally(kind, ranked, confirmed):
    """How far the search came, and how well its best stand the flights with new seeds."""
    fit = sum(held >= MANY for held, _, _ in ranked)
    finals = ", ".join(str(sum(judge(means))) for _, means in confirmed)
    return (f"{kind}: {MANY} statements or more fit {fit} of {len(ranked)} vehicles, at most {ranked[0][0]} in the search; "
            f"the finalists with new seeds: {finals}.")


def run(arguments):
    rng = random.Random(arguments.seed)
    search_seeds = list(range(1001, 1001 + arguments.flights))
    fresh = list(range(1, 1 + arguments.confirm))
    program = str(arguments.program.resolve())
    progress = fleet.Progress(len(KINDS) * (arguments.vehicles // 2 + 2 * (arguments.vehicles // 4)), what="vehicles")
    tallies = {}
    found = {kind: search(program, kind, rng, arguments.vehicles, search_seeds, progress) for kind in KINDS}
    best = {"default": (None, look(program, "THRUST", {}, fresh))}
    for kind, ranked in found.items():
        confirmed = [(vehicle, look(program, kind, vehicle, fresh)) for _, vehicle, _ in ranked[:arguments.finalists]]
        best[kind] = max(confirmed, key=lambda pair: sum(judge(pair[1])))
        tallies[kind] = tally(kind, ranked, confirmed)
    by_last = {column: means | look(program, column, vehicle or {}, fresh, statements.BY_FIRST_BRACKET, LAST)
               for column, (vehicle, means) in best.items()}
    text = table(best, by_last)
    arguments.out.mkdir(parents=True, exist_ok=True)
    write_csv(arguments.out / "seed_study.csv", found)
    (arguments.out / "seed_study.md").write_text(text + "\n", encoding="utf-8")
    print(text)
    print("\n".join(tallies.values()))
    if arguments.page:
        write_page(table(best, by_last, for_page=True))
    return 0


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vehicles", type=int, default=80, help="of each kind (80)")
    parser.add_argument("--flights", type=int, default=4, help="of each test per vehicle (4)")
    parser.add_argument("--confirm", type=int, default=20, help="fresh flights of each test for the finalists (20)")
    parser.add_argument("--finalists", type=int, default=5, help="of each kind (5)")
    parser.add_argument("--seed", type=int, default=1, help="of the draws (1)")
    parser.add_argument("--page", action="store_true", help="writes the table into docs/control.md")
    parser.add_argument("--program", type=Path, default=ROOT / "build/plomada", help="default: build/plomada")
    parser.add_argument("--out", type=Path, default=ROOT / "build/seed_study", metavar="DIR",
                        help="default: build/seed_study")
    try:
        return run(parser.parse_args(argv))
    except (fleet.Broken, OSError) as error:
        print(f"seed_study: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
