#!/usr/bin/env python3
"""tune.py LAW [--constants PART] [--set trimmed|untrimmed] [--flights N] [--runs N] [--seed N] ...: searches the gains of a
law, or, with --constants, those constants of control/ that are marked "fitted" in files whose path contains PART (est: all).

Each candidate flies the same vehicles: drawn ones and a third as many nominal ones, all of seed 2, so that
`make campaign` judges the result on vehicles that the search has not seen. Its cost, in mm:

    nominal   mean of hover RMS + terrain RMS / 4 + overshoot / 4 + 10 per second of rise time,
              and 200 per newton of mean thrust activity above 0.45 N
    drawn     mean of hover RMS, and its 95 % quantile over the flights that did not fail
    either    a failed flight (take-overs by the supervisor included) counts as 500, a ground contact as 100 more

The search is Nelder and Mead's (SciPy), on the logarithm of a gain that cannot be 0. It starts at the present gains,
starts anew around the best when it comes to rest, and ends with its budget of flights or when a new start finds nothing
better. The commands that set the best gains are printed on stdout; of constants the lines, to be put in place by hand: each
candidate is a program of its own, built in a copy of the tree (build/tune), where a constant may be a third to three times
what it is. Exit status: 0; 2 usage, a program that does not fly
or lacks a parameter of the law; 130 interrupted.
"""
import argparse
import math
import re
import shutil
import statistics
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/campaign"))
import campaign  # noqa: E402
import fleet  # noqa: E402
import plan  # noqa: E402
import table  # noqa: E402

FAILURE_MM, CONTACT_MM, ACTIVITY_MM_PER_N, ACTIVITY_FREE_N = 500.0, 100.0, 200.0, 0.45
SHARE, RISE_MM_PER_S = 0.25, 10.0
DIGITS = 3
SIMPLEX = 0.12                  # its first size, of a gain's whole range
AT_REST_MM, AT_REST_UNITS = 0.05, 0.01


class Spent(Exception):
    """The next candidate would exceed the budget."""


@dataclass(frozen=True)
class Gain:
    """A parameter of the firmware and where to look for it. low > 0: on a logarithmic scale."""
    name: str
    low: float
    high: float

    def unit(self, value):
        """0..1 from low to high; a value outside counts as the nearest."""
        value = min(max(value, self.low), self.high)
        if self.low > 0.0:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def value(self, unit):
        """Rounded, and never outside of low..high."""
        if self.low > 0.0:
            found = self.low * (self.high / self.low) ** unit
        else:
            found = self.low + unit * (self.high - self.low)
        return min(max(float(f"{found:.{DIGITS}g}"), self.low), self.high)


PROPORTIONAL = (Gain("KP", 0.001, 0.05), Gain("KD", 0.002, 0.1))
WINDOW = (Gain("USAT", 0.5, 4.0), Gain("DSAT", 0.0, 4.0))
GAINS = {
    "PD": PROPORTIONAL + WINDOW,
    "PID": (*PROPORTIONAL, Gain("KI", 0.00002, 0.02), *WINDOW),
    "PIDT": (Gain("PKP", 1.0, 30.0), Gain("PKD", 0.5, 15.0), Gain("PKI", 0.05, 10.0)),
    "EST": (Gain("POSK", 0.5, 6.0), Gain("VELK", 1.0, 12.0), Gain("VUP", 0.2, 1.5), Gain("VDN", 0.2, 1.5)),
}


def gains_of(law):
    return GAINS[law.settings.get("LAW", "EST")]


def text(value):
    """A number as it is typed: no exponent."""
    return f"{value:.10f}".rstrip("0").rstrip(".")


def mean_cost(flights, of_good):
    """The mean of what each flight costs; of_good gives it for one that did not fail."""
    return statistics.fmean((FAILURE_MM if table.failed(figures) else of_good(figures))
                            + CONTACT_MM * (figures["ground_contacts"] > 0) for figures in flights)


def nominal_cost(figures):
    return (figures["hover_rms_mm"] + SHARE * (figures["terrain_rms_mm"] + figures["overshoot_mm"])
            + RISE_MM_PER_S * figures["rise_time_s"])


def cost(nominal, drawn):
    """Of the figures of a candidate's flights."""
    result = mean_cost(nominal, nominal_cost) + mean_cost(drawn, lambda figures: figures["hover_rms_mm"])
    hover_mm = [figures["hover_rms_mm"] for figures in drawn if not table.failed(figures)] or [FAILURE_MM]
    result += table.percentile(hover_mm, 0.95)
    activity_n = [figures["thrust_std_n"] for figures in nominal if not table.failed(figures)] or [ACTIVITY_FREE_N]
    return result + ACTIVITY_MM_PER_N * max(0.0, statistics.fmean(activity_n) - ACTIVITY_FREE_N)


def present(program, law):
    """The law's gains as they are. Raises Broken unless `plomada params` knows each and its limits hold the search."""
    done = subprocess.run([program, "params"], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
    known = {words[0]: words[2:5] for words in map(str.split, done.stdout.splitlines()) if len(words) >= 5}
    values = []
    for gain in gains_of(law):
        if gain.name not in known:
            raise fleet.Broken(f"{program} has no parameter {gain.name}")
        low, high, initial = map(float, known[gain.name])
        if gain.low < low or gain.high > high:
            raise fleet.Broken(f"{gain.name}: the search from {gain.low:g} to {gain.high:g} leaves {low:g}..{high:g}")
        values.append(float(law.settings.get(gain.name, initial)))
    return values


FITTED = re.compile(r"^#define (\w+) ([\d.]+(?:e-?\d+)?)F(?= +/\* fitted)", re.MULTILINE)
REACH = 3.0


class Tree:
    """A copy of the sources whose constants can be changed."""

    def __init__(self, part):
        self.root, self.build = ROOT / "build/tune/tree", ROOT / "build/tune/build"
        listing = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True, text=True)
        for path in listing.stdout.splitlines():
            source, target = ROOT / path, self.root / path
            if source.is_file() and (not target.exists() or source.read_bytes() != target.read_bytes()):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, target)
                target.chmod(source.stat().st_mode)
        self.texts = {path: (ROOT / path).read_text(encoding="utf-8") for path in sorted(listing.stdout.splitlines())
                      if path.startswith("control/") and path.endswith(".c") and part in path and (ROOT / path).is_file()}
        self.constants = {name: float(value) for text in self.texts.values() for name, value in FITTED.findall(text)}
        if not self.constants:
            raise fleet.Broken(f"no constant of control/*{part}*.c is marked as fitted")
        self.run("cmake", "-S", self.root, "-B", self.build, "-DCMAKE_BUILD_TYPE=Release", "-DPLOMADA_TESTS=OFF")

    @staticmethod
    def run(*command):
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise fleet.Broken(done.stderr or done.stdout)

    def program(self, values):
        """The program with these constants, {name: value}."""
        for path, text in self.texts.items():
            changed = replaced(text, values)
            if (self.root / path).read_text(encoding="utf-8") != changed:
                (self.root / path).write_text(changed, encoding="utf-8")
        self.run("cmake", "--build", self.build, "--target", "plomada", "-j")
        return str(self.build / "plomada")


def define(name, shown):
    return f"#define {name} {shown if '.' in shown else shown + '.0'}F"


def replaced(text, values):
    """The source with other values of its fitted constants."""
    def line(match):
        return define(match.group(1), values[match.group(1)]) if match.group(1) in values else match.group()
    return FITTED.sub(line, text)


def cost_of_flights(candidates, law):
    flights = candidates.flights(law)
    if candidates.progress.done + len(flights) > candidates.options.flights:
        raise Spent
    flown = {"nominal": [], candidates.options.set: []}
    batch = math.ceil(len(flights) / 8)
    for (set_name, _), figures in fleet.fly_all(candidates.client, candidates.program, flights, batch):
        flown[set_name].append(figures)
        candidates.progress.step()
    return cost(flown["nominal"], flown[candidates.options.set])


class Candidates:
    """Flies candidates, whose gains are given by units 0..1, as long as the budget lasts; keeps the best."""

    def __init__(self, client, program, options):
        self.client, self.program, self.options = client, program, options
        self.law = plan.LAWS[options.law]
        self.gains = gains_of(self.law)
        self.progress = fleet.Progress(options.flights)
        self.known = {}
        self.best = (math.inf, None)

    def flights(self, law):
        """[(set and run, arguments)] of one candidate."""
        sets = (("nominal", math.ceil(self.options.runs / 3)), (self.options.set, self.options.runs))
        return [((name, run), plan.arguments(law, name, self.options.seed, run)) for name, runs in sets
                for run in range(1, runs + 1)]

    def fly(self, values):
        return cost_of_flights(self, plan.Law(self.law.settings | self.settings(values), self.law.scenario))

    def settings(self, values):
        return {gain.name: text(value) for gain, value in zip(self.gains, values, strict=True)}

    def __call__(self, units):
        values = tuple(gain.value(unit) for gain, unit in zip(self.gains, units, strict=True))
        if values not in self.known:
            self.known[values] = self.fly(values)
            self.keep_best(values)
        return self.known[values]

    def shown(self, values):
        """What sets these values, for a user."""
        return [f"#{name} {value}" for name, value in ({"LAW": "EST"} | self.law.settings | self.settings(values)).items()]

    def keep_best(self, values):
        if self.known[values] < self.best[0]:
            self.best = (self.known[values], values)
            shown = " ".join(f"{name} {value}" for name, value in self.settings(values).items())
            print(f"cost {self.best[0]:.1f} after {self.progress.done} flights: {shown}", file=sys.stderr)


class Constants(Candidates):
    """Candidates that differ in the fitted constants of control/."""

    def __init__(self, client, tree, options):
        super().__init__(client, None, options)
        self.tree = tree
        self.gains = [Gain(name, value / REACH, value * REACH) for name, value in tree.constants.items()]

    def fly(self, values):
        self.program = self.tree.program(self.settings(values))
        return cost_of_flights(self, self.law)

    def shown(self, values):
        return [define(name, value) for name, value in self.settings(values).items()]


def simplex(center, size):
    """The center and, for each gain, a step of it towards the middle of its range."""
    corners = [list(center)]
    for place, unit in enumerate(center):
        corner = list(center)
        corner[place] += size if unit < 0.5 else -size
        corners.append(corner)
    return corners


def search(candidates, units):
    """From these units on until the budget is spent, or until a new start finds nothing better."""
    from scipy.optimize import minimize

    size, before = SIMPLEX, math.inf
    try:
        while candidates.best[0] < before - AT_REST_MM or math.isinf(before):
            before = candidates.best[0]
            found = minimize(candidates, units, method="Nelder-Mead", bounds=[(0.0, 1.0)] * len(units),
                             options={"initial_simplex": simplex(units, size), "xatol": AT_REST_UNITS,
                                      "fatol": AT_REST_MM, "maxiter": sys.maxsize, "maxfev": sys.maxsize})
            units, size = found.x, size / 2.0
    except Spent:
        pass


def read_arguments(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("law", choices=plan.LAWS, metavar="LAW", help=", ".join(plan.LAWS))
    parser.add_argument("--constants", metavar="PART", default="",
                        help="not the gains but the fitted constants of control/*PART*.c: est, est/hover, ...")
    parser.add_argument("--set", choices=("trimmed", "untrimmed"), default="untrimmed",
                        help="drawn vehicles: GRAV trimmed by hand or not (untrimmed)")
    parser.add_argument("--flights", type=campaign.positive, default=4000, help="budget (4000)")
    parser.add_argument("--runs", type=campaign.positive, default=30, help="drawn vehicles that each candidate flies (30)")
    parser.add_argument("--seed", type=campaign.positive, default=2, help="of the vehicles (2)")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster (default: this machine's processors)")
    parser.add_argument("--program", type=Path, default=ROOT / "build/plomada", help="default: build/plomada")
    options = parser.parse_args(argv)
    if options.flights < options.runs + math.ceil(options.runs / 3):
        parser.error("--flights is less than one candidate flies")
    return options


def at_limit(gains, values):
    """Sentences: gains that the search would have taken further."""
    return [f"{gain.name} {text(value)} is at its limit, {text(gain.low)} to {text(gain.high)}: the best may lie beyond"
            for gain, value in zip(gains, values, strict=True) if not gain.low < value < gain.high]


def tune(options):
    program, law = str(options.program.resolve()), plan.LAWS[options.law]
    tree = Tree(options.constants) if options.constants else None
    start = list(tree.constants.values()) if tree else present(program, law)
    with fleet.fleet(options.scheduler) as client:
        candidates = Constants(client, tree, options) if tree else Candidates(client, program, options)
        search(candidates, [gain.unit(value) for gain, value in zip(candidates.gains, start, strict=True)])
    best, values = candidates.best
    print(f"cost {best:.1f} mm, {candidates.progress.done} flights", *at_limit(candidates.gains, values), sep="\n", file=sys.stderr)
    print("\n".join(candidates.shown(values)))


def main(argv=None):
    try:
        tune(read_arguments(argv))
    except (fleet.Broken, OSError) as error:
        print(f"tune: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("tune: interrupted", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
