#!/usr/bin/env python3
"""tune_vehicle.py VEHICLE [--law EST|PID] ...: gains for the vehicle that fit found, and a forecast.

The fit itself gives GRAV, and law EST's model of the vehicle: PLANT, GAIN, LAG, DELAY, DAMP, CRATE, CLAG. Gains are searched by
flights of vehicles drawn from the uncertainty of build/vehicle.json over the 60 cm course; every candidate flies the same vehicles
in the same noise. Their cost is the mean hover RMS, 5 mm per second of recovery, a twentieth of the terrain RMS and of the
overshoot, 30 mm per newton of thrust activity beyond 1.5 times that of the stock gains (0.45 N at least), and 500 mm for a failure.
The search is Nelder and Mead's, and a quadratic surface through what it flew says where the valley's bottom is. What it found, and
the fit's model alone with the stock gains, then fly against the stock gains on fresh draws, pair by pair: proposed is what hovers
better and recovers no later, each beyond chance (95 %). Where nothing does, the stock gains stay. A vehicle that its flights show
to be beyond the model is searched and judged by the equations of both simulated airframes, and must be better by a tenth by each.
Prints the commands, what the fresh flights showed, thrust activity included, what lies at its limit, and what the next flight of
that course will be like, with 90 % intervals, by its log; `verdict.py` compares. Every flight is kept beside the forecast when it
ends: a rerun goes on.
Exit status: 0; 2 usage, or a program that does not fly; 130 interrupted.
"""
import argparse
import json
import math
import os
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).resolve().parent))
import forecast  # noqa: E402
import campaign  # noqa: E402  on the path by forecast
import flight_log  # noqa: E402
import model  # noqa: E402
import numpy  # noqa: E402
from scipy.stats import t as student  # noqa: E402

SCENARIOS = {"EST": "est-60cm-ramp", "PID": "pid-60cm-ramp"}
# Where to look: name, first, least, most. Law EST that knows its vehicle bears quicker gains than the delivered 2.3 and 8.
GAINS = {
    "EST": (("POSK", 2.6, 0.8, 5.0), ("VELK", 9.0, 1.5, 12.0)),
    "PID": (("KP", 0.006, 0.001, 0.03), ("KD", 0.0267, 0.004, 0.1), ("KI", 0.0003, 0.00002, 0.01)),
}
EST_CLIMB = {"POSK": 1.8, "VELK": 11.0}         # first, where the throttle commands a climb rate
STOCK = {"EST": {}, "PID": {"KP": "0.015", "KD": "0.008", "KI": "0.01", "USAT": "1", "DSAT": "0"}}
FIXED = {"EST": {}, "PID": {"LAW": "PID", "USAT": "1.7", "DSAT": "4"}}
FAILURE_MM, ACTIVITY_MM_PER_N, ACTIVITY_FREE_N, ACTIVITY_MORE, SHARE = 500.0, 30.0, 0.45, 1.5, 0.05
RECOVERY_MM_PER_S = 5.0         # chosen: as much as the hover gains by quicker gains
LATEST_S = forecast.AFTER_EDGE_S            # recovery of a flight that has none
FRESH, FIRST_FRESH = 120, 40    # pairs of flights that prove a candidate; after the first of them it is dropped if not better
CONFIDENCE = 0.95
# So much must hover and recovery of a vehicle beyond the model improve by each of the equations that it is flown by. Chosen: of six
# changes of gains on two vehicles of a third kind, the change of the hover was off by up to 9 %, though both had its sign.
BEYOND_SHARE = 0.10
FIRST_STEP = 0.25               # upwards
NEAR = 0.3                      # of the least cost: candidates within make the quadratic surface
USUAL_MPS2_PER_N = 1.4          # authority of the vehicle that the PID gains above suit
# Parameters of law EST that the fit knows: name, least and most that the firmware takes, figure of the plant, what to add.
MODELS = {
    "THRUST": (("GAIN", 0.4, 2.5, "gain", 0.0), ("LAG", 0.03, 0.5, "tau", 0.0),
               ("DELAY", 0.008, 0.12, "tdelay", model.PULSE_S), ("DAMP", 0.5, 6.0, "damping", 0.0)),
    "CLIMB": (("CRATE", 0.125, 5.0, "climb_rate", 0.0), ("CLAG", 0.1, 1.0, "climb_lag", 0.0), ("LAG", 0.03, 0.5, "tau", 0.0),
              ("DELAY", 0.008, 0.12, "tdelay", model.PULSE_S)),
}
RAY_AGE_S, SAMPLE_S, AROUND_S = 0.0705, 0.108, 10.0     # of a height as it arrives; PID's period; of the integral
SEED = 700_000_000              # of the flights; no campaign uses it


def text(value):
    return f"{value:.3g}" if value >= 1e-4 else f"{value:.7f}".rstrip("0")


def base_of(law, vehicle):
    """What the fit itself says: feed-forward; for law EST also the kind of throttle and the model of the vehicle."""
    kind = vehicle["throttle"]
    hover_n = vehicle["plant.hover_thrust" if kind == "THRUST" else "plant.climb_neutral"]["value"]
    base = FIXED[law] | {"GRAV": f"{hover_n:.2f}"}
    if law == "EST":
        base["PLANT"] = kind
        for name, least, most, figure, more in MODELS[kind]:
            base[name] = f"{min(max(vehicle[f'plant.{figure}']['value'] + more, least), most):.3g}"
    return base


def climb_starts(vehicle):
    """Gains of a PID whose output is a climb rate, behind lags and a dead time (Skogestad's rules, J. Process Control 13,
    2003): the closed loop as slow as the dead time is long, the derivative takes the lags. The integral only has to find the
    middle of the stick, and a deadband makes it swing: it gets AROUND_S."""
    dead_s = vehicle["plant.tdelay"]["value"] + model.PULSE_S + RAY_AGE_S + SAMPLE_S / 2.0
    kp_n_per_m = 1.0 / (vehicle["authority"]["value"] * 2.0 * dead_s)
    lag_s = vehicle["plant.climb_lag"]["value"] + vehicle["plant.tau"]["value"]
    return {"KP": 1e-3 * kp_n_per_m, "KD": 1e-3 * kp_n_per_m * lag_s / SAMPLE_S, "KI": 1e-3 * kp_n_per_m * SAMPLE_S / AROUND_S}


def gains_of(law, vehicle):
    """GAINS, begun where the found vehicle asks for it."""
    if vehicle["throttle"] == "CLIMB":
        starts = EST_CLIMB if law == "EST" else climb_starts(vehicle)
    else:
        weaker = USUAL_MPS2_PER_N / vehicle["authority"]["value"] if law == "PID" else 1.0
        starts = {name: first * weaker for name, first, _, _ in GAINS[law]}
    return tuple((name, min(max(starts[name], least), most), least, most) for name, _, least, most in GAINS[law])


def lost(figures):
    return figures["failed"] or figures["takeovers"] or figures["halted"] or figures["hover_rms_mm"] is None


def hover_mm(figures):
    return FAILURE_MM if lost(figures) else figures["hover_rms_mm"]


def recovery_s(figures):
    return LATEST_S if lost(figures) or figures["recovery_s"] is None else figures["recovery_s"]


def activity_n(figures):
    return figures["thrust_std_n"] or 0.0


def cost(flown, free_n):
    """Of a candidate's flights; so much thrust activity costs nothing."""
    each = []
    for figures in flown:
        if lost(figures):
            each.append(FAILURE_MM)
            continue
        activity = max(0.0, figures["thrust_std_n"] - free_n)
        each.append(figures["hover_rms_mm"] + ACTIVITY_MM_PER_N * activity + RECOVERY_MM_PER_S * recovery_s(figures)
                    + SHARE * ((figures["terrain_rms_mm"] or 0.0) + (figures["overshoot_mm"] or 0.0)))
    return float(numpy.mean(each))


def stock_settings(law):
    return ({"LAW": "PID"} if law == "PID" else {}) | STOCK[law]


class Course:
    """The same vehicles in the same noise for every candidate. world: of forecast.worlds(), None: each in turn."""

    def __init__(self, flights, law, vehicle, count, seed, world=None):
        self.flights, self.law = flights, law
        self.plants = forecast.draws(vehicle, count, seed, world)
        self.seeds = [SEED + 1000 * seed + k for k in range(count)]
        self.free_n = ACTIVITY_FREE_N

    def fly(self, way, settings, count=None):
        """count: the first of them only."""
        return self.flights.each(way, [forecast.words(SCENARIOS[self.law], seed, settings, plant)
                                       for seed, plant in zip(self.seeds[:count], self.plants[:count], strict=True)])

    def stock(self):
        """Cost of the stock gains, by whose activity that of all others is judged."""
        flown = self.fly(forecast.fleet.fly, stock_settings(self.law))
        self.free_n = max(ACTIVITY_MORE * float(numpy.mean([figures["thrust_std_n"] or 0.0 for figures in flown])), ACTIVITY_FREE_N)
        return cost(flown, self.free_n)

    def cost(self, settings):
        return cost(self.fly(forecast.fleet.fly, settings), self.free_n)


def bottom(places, costs):
    """Where a quadratic surface through the candidates that are nearly as good as the best is lowest, within what they span;
    None where they are too few. It averages the chance that each candidate's flights had."""
    from scipy.optimize import minimize

    places, costs = numpy.array(places), numpy.array(costs)
    near = costs < (1.0 + NEAR) * costs.min()
    rows, columns = numpy.triu_indices(places.shape[1])

    def terms(x):
        return numpy.concatenate(([1.0], x, x[rows] * x[columns]))

    if near.sum() <= len(terms(places[0])):
        return None
    center = places[numpy.argmin(costs)]
    fitted = numpy.linalg.lstsq(numpy.array([terms(x) for x in places[near] - center]), costs[near], rcond=None)[0]
    span = [(x.min(), x.max()) for x in (places[near] - center).T]
    return center + minimize(lambda x: float(fitted @ terms(x)), numpy.zeros(len(center)), bounds=span).x


def search(course, base, gains, budget):
    """Settings that may be the best, by Nelder and Mead on the logarithms of the gains."""
    from scipy.optimize import minimize

    flown = {}

    def settings_at(place):
        values = [min(max(math.exp(x), low), high) for x, (_, _, low, high) in zip(place, gains, strict=True)]
        return base | {name: text(value) for (name, *_), value in zip(gains, values, strict=True)}

    def evaluate(place):
        settings = settings_at(place)
        key = tuple(settings.values())
        if key not in flown:
            flown[key] = (course.cost(settings), settings)
        return flown[key][0]

    start = numpy.log([first for _, first, _, _ in gains])
    corners = [start, *(start + FIRST_STEP * row for row in numpy.eye(len(start)))]
    minimize(evaluate, start, method="Nelder-Mead",
             options={"initial_simplex": numpy.array(corners), "maxfev": budget, "xatol": 0.03, "fatol": 0.02})
    names = [name for name, *_ in gains]
    places = [[math.log(float(settings[name])) for name in names] for _, settings in flown.values()]
    lowest = bottom(places, [cost for cost, _ in flown.values()])
    best = min(flown.values(), key=lambda one: one[0])[1]
    return [best] if lowest is None else [best, settings_at(lowest)]


@dataclass
class Change:
    """Means of a figure with the stock gains and with others, and the shares by which it grows at least and at most, each with
    CONFIDENCE."""
    stock: float
    tuned: float
    least: float
    most: float

    @property
    def share(self):
        return self.tuned / self.stock - 1.0


def change(stock, tuned):
    """Of pairs of flights."""
    stock, off = numpy.array(stock), numpy.array(tuned) - numpy.array(stock)
    spread = off.std(ddof=1) / math.sqrt(len(off)) if len(off) > 1 else math.inf
    around = student.ppf(CONFIDENCE, len(off) - 1) * spread if spread > 0.0 else 0.0
    middle = stock.mean()
    return Change(float(middle), float(middle + off.mean()), float((off.mean() - around) / middle), float((off.mean() + around) / middle))


FRESH_FIGURES = {"hover RMS": (hover_mm, "mm"), "recovery": (recovery_s, "s"), "thrust activity": (activity_n, "N")}


def changes(course, settings, count):
    stock, tuned = (course.fly(forecast.fleet.fly, words, count) for words in (stock_settings(course.law), settings))
    return {name: change(*[[of(figures) for figures in flown] for flown in (stock, tuned)]) for name, (of, _) in FRESH_FIGURES.items()}


def is_promising(found):
    return found["hover RMS"].share < 0.0 and found["recovery"].share <= 0.0


def is_better(found, least):
    """least: the share that is owed to the equations."""
    return found["hover RMS"].most < -least and found["recovery"].most <= -least


@dataclass
class Proposal:
    settings: dict              # the stock gains where nothing is better
    kept: bool                  # the stock gains stay
    changes: dict               # {world: {figure: Change}} of the proposed, or of the one that came nearest
    tried: int                  # candidates on fresh flights


def prove(courses, settings, fresh):
    """(changes in each world, whether better in all). A candidate that the first flights do not favour flies no more."""
    least = BEYOND_SHARE if len(courses) > 1 else 0.0
    found = {world: changes(course, settings, min(FIRST_FRESH, fresh)) for world, course in courses.items()}
    if all(map(is_promising, found.values())):
        found = {world: changes(course, settings, fresh) for world, course in courses.items()}
    return found, all(is_better(one, least) for one in found.values())


def worst_hover(found):
    return max(one["hover RMS"].most for one in found.values())


def tune(flights, vehicle, law, count, budget, fresh=FRESH):
    """The proposal, by flights that the search has not seen."""
    course = Course(flights, law, vehicle, count, 1)
    course.stock()
    gains, base = gains_of(law, vehicle), base_of(law, vehicle)
    tried = search(course, base, gains, budget)
    if law == "EST":
        tried.append(base)
    courses = {world: Course(flights, law, vehicle, fresh, 2, world) for world in forecast.worlds(vehicle)}
    nearest = None
    for settings in tried:
        found, better = prove(courses, settings, fresh)
        if better:
            return Proposal(settings, False, found, len(tried))
        nearest = found if nearest is None or worst_hover(found) < worst_hover(nearest) else nearest
    return Proposal(stock_settings(law), True, nearest, len(tried))


def at_limit(law, vehicle, settings):
    """Sentences: what lies where the search, or the firmware, does not let it go on."""
    kind = vehicle["throttle"]
    limits = [(name, low, high) for name, _, low, high in GAINS[law]]
    limits += [(name, low, high) for name, low, high, _, _ in MODELS[kind] if law == "EST"]
    for name, low, high in limits:
        value = float(settings.get(name, "nan"))
        if value <= low or value >= high:
            yield f"{name} {value:g} is at its limit, {low:g} to {high:g}: the best for this vehicle may lie beyond"


def told(law, vehicle, proposal, defaults):
    """What is to be typed, and why."""
    shown = {"LAW": law} | proposal.settings
    if proposal.kept:
        shown |= {name: defaults[name] for name in base_of(law, vehicle) | {name: 0 for name, *_ in GAINS[law]}
                  if name not in shown and name != "GRAV"}
    yield from (f"#{name} {value}" for name, value in shown.items())
    yield ""
    if proposal.kept:
        much = f" by {100 * BEYOND_SHARE:g} %" if len(proposal.changes) > 1 else ""
        yield (f"The stock gains stay: none of {proposal.tried} candidates is surely better{much} in hover and no worse in recovery. "
               "The nearest, on fresh flights from the stock gains to it (by at most, 95 %):")
    else:
        yield "On fresh flights, from the stock gains to these (by at most, 95 %):"
    worlds = {"model": "", "rotors": "by the equations of the other airframe: "}
    for world, found in proposal.changes.items():
        for name, (_, unit) in FRESH_FIGURES.items():
            c = found[name]
            yield f"  {worlds[world]}{name} {c.stock:.3g} to {c.tuned:.3g} {unit}, {100 * c.share:+.0f} % ({100 * c.most:+.0f} %)"
    yield from at_limit(law, vehicle, proposal.settings)
    yield from (f"beyond the model: {sentence}" for sentence in vehicle.get("beyond", ()))


def defaults_of(program):
    """{parameter: as delivered}, as the program tells."""
    done = subprocess.run([program, "params"], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=True)
    return {words[0]: words[4] for words in map(str.split, done.stdout.splitlines()) if len(words) >= 5}


def read_arguments(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("vehicle", type=Path)
    parser.add_argument("--law", choices=GAINS, default="EST")
    parser.add_argument("--draws", type=campaign.positive, default=10, help="vehicles that each candidate flies (10)")
    parser.add_argument("--budget", type=campaign.positive, default=20, help="candidates (20)")
    parser.add_argument("--fresh", type=campaign.positive, default=FRESH, help=f"pairs of flights that prove a candidate ({FRESH})")
    parser.add_argument("--forecast", type=campaign.positive, default=60, help="flights of the forecast (60)")
    parser.add_argument("--program", type=Path, default=forecast.ROOT / "build/plomada")
    parser.add_argument("--out", type=Path, default=forecast.ROOT / "build/forecast.json", metavar="FILE",
                        help="the forecast, for verdict.py (build/forecast.json); its flights stand beside it in a .flights.jsonl")
    return parser.parse_args(argv)


def flights_of(out):
    return out.with_suffix(".flights.jsonl")


def predict(flights, vehicle, law, settings, count):
    flown = Course(flights, law, vehicle, count, 3).fly(forecast.fly_logged, settings)
    return forecast.intervals([seen for _, seen in flown])


def find(arguments, vehicle, program):
    """(proposal, forecast)"""
    candidates = 4
    most = (arguments.budget + 1) * arguments.draws + (candidates + 1) * len(forecast.worlds(vehicle)) * arguments.fresh + arguments.forecast
    with forecast.fleet.Store(flights_of(arguments.out)) as store:
        flights = forecast.Flights(program, store, forecast.fleet.Progress(most))
        proposal = tune(flights, vehicle, arguments.law, arguments.draws, arguments.budget, arguments.fresh)
        return proposal, predict(flights, vehicle, arguments.law, proposal.settings, arguments.forecast)


def record(arguments, words, program, proposal, expected):
    """For verdict.py, and for whoever asks later how it came about."""
    fresh = {world: {name: vars(c) for name, c in found.items()} for world, found in proposal.changes.items()}
    return {"law": arguments.law, "scenario": SCENARIOS[arguments.law], "settings": proposal.settings, "kept": proposal.kept,
            "fresh": fresh, "vehicle": str(arguments.vehicle.resolve()), "expected": expected,
            "arguments": words} | forecast.fleet.provenance(program)


def main(argv=None):
    arguments = read_arguments(argv)
    program = str(arguments.program.resolve())
    try:
        flight_log.recording.apart([arguments.out, flights_of(arguments.out)], [arguments.vehicle], "--out")
        vehicle = forecast.load_vehicle(arguments.vehicle)
        proposal, expected = find(arguments, vehicle, program)
        lines = list(told(arguments.law, vehicle, proposal, defaults_of(program)))
        kept = record(arguments, sys.argv[1:] if argv is None else argv, program, proposal, expected)
        forecast.fleet.write_whole(arguments.out, json.dumps(kept, indent=1) + "\n")
    except KeyboardInterrupt:
        print("tune: interrupted; what was flown is kept, the same command goes on", file=sys.stderr)
        return 130
    except (forecast.fleet.Broken, flight_log.Unfit, OSError, ValueError) as error:
        print(f"tune: {error}", file=sys.stderr)
        return 2
    print("\n".join(lines))
    print(f"forecast of the next {SCENARIOS[arguments.law]}, by its log:")
    for name, f in expected.items():
        print(f"  {name:14} {f['value']:.3g} [{f['low']:.3g} .. {f['high']:.3g}]")
    print(arguments.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
