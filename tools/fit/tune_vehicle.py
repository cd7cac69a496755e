#!/usr/bin/env python3
"""tune_vehicle.py VEHICLE [--law EST|PID] ...: gains for the vehicle that fit found, and a forecast.

The fit itself gives GRAV, and law EST's model of the vehicle: PLANT, GAIN, LAG, DELAY, DAMP, CRATE, CLAG. Gains are searched by
flights of vehicles drawn from the uncertainty of build/vehicle.json over the 60 cm course. Their cost is the mean hover RMS, a
twentieth of the terrain RMS and of the overshoot, 200 mm per newton of thrust activity beyond 1.3 times that of the stock gains
(0.45 N at least), and 500 mm for a failure, and half the worst vehicle's hover: the gains must suit all of them. The search is
Nelder and Mead's; gains that are not better on other draws are not proposed. Prints the commands, and what the next flight of that course will be like,
with 90 % intervals, by its log; `verdict.py` compares. Exit status: 0; 2 usage, or a program that does not fly.
"""
import argparse
import json
import math
import os
import sys
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.path.insert(0, str(Path(__file__).resolve().parent))
import forecast  # noqa: E402
import model  # noqa: E402
import numpy  # noqa: E402

SCENARIOS = {"EST": "est-60cm-ramp", "PID": "pid-60cm-ramp"}
# Where to look: name, stock, least, most.
GAINS = {
    "EST": (("POSK", 2.3, 0.8, 5.0), ("VELK", 8.0, 1.5, 12.0)),
    "PID": (("KP", 0.006, 0.001, 0.03), ("KD", 0.0267, 0.004, 0.1), ("KI", 0.0003, 0.00002, 0.01)),
}
STOCK = {"EST": {}, "PID": {"KP": "0.015", "KD": "0.008", "KI": "0.01", "USAT": "1", "DSAT": "0"}}
FIXED = {"EST": {}, "PID": {"LAW": "PID", "USAT": "1.7", "DSAT": "4"}}
FAILURE_MM, ACTIVITY_MM_PER_N, ACTIVITY_FREE_N, ACTIVITY_MORE, SHARE = 500.0, 200.0, 0.45, 1.3, 0.05
WORST = 0.5
FIRST_STEP = 0.25               # upwards: a law that knows its vehicle bears quicker gains
WORTH = 0.01                    # of the cost: less gained than that on further draws, and the stock gains stay
USUAL_MPS2_PER_N = 1.4          # authority of the vehicle that the PID gains above suit
# Parameters of law EST that the fit knows: name, least and most that the firmware takes, figure of the plant, what to add.
MODELS = {
    "THRUST": (("GAIN", 0.4, 2.5, "gain", 0.0), ("LAG", 0.03, 0.5, "tau", 0.0),
               ("DELAY", 0.008, 0.12, "tdelay", model.PULSE_S), ("DAMP", 0.5, 6.0, "damping", 0.0)),
    "CLIMB": (("CRATE", 0.125, 5.0, "climb_rate", 0.0), ("CLAG", 0.1, 1.0, "climb_lag", 0.0), ("LAG", 0.03, 0.5, "tau", 0.0),
              ("DELAY", 0.008, 0.12, "tdelay", model.PULSE_S)),
}
SEED = 700_000_000              # of the flights; no campaign uses it


def text(value):
    return f"{value:.3g}" if value >= 1e-4 else f"{value:.7f}".rstrip("0")


def vehicle_settings(law, vehicle, plant_kind):
    """What the fit itself says: feed-forward, kind of throttle, law EST's model of the vehicle."""
    thrust = vehicle["throttle"] == "THRUST"
    hover_n = vehicle["plant.hover_thrust" if thrust else "plant.climb_neutral"]["value"]
    settings = {"GRAV": f"{hover_n:.2f}"}
    if law == "EST":
        settings["PLANT"] = plant_kind
    if law == "EST" and plant_kind == vehicle["throttle"]:
        for name, least, most, figure, more in MODELS[plant_kind]:
            settings[name] = f"{min(max(vehicle[f'plant.{figure}']['value'] + more, least), most):.3g}"
    return settings


def gains_of(law, vehicle):
    """GAINS, those of PID for the authority that was found."""
    if law == "EST" or vehicle["throttle"] == "CLIMB":
        return GAINS[law]
    weaker = USUAL_MPS2_PER_N / vehicle["authority"]["value"]
    return tuple((name, min(max(start * weaker, least), most), least, most) for name, start, least, most in GAINS[law])


def cost(flown, free_n):
    """Of a candidate's flights; so much thrust activity costs nothing."""
    each = []
    for figures in flown:
        if figures["failed"] or figures["takeovers"] or figures["halted"] or figures["hover_rms_mm"] is None:
            each.append((FAILURE_MM, FAILURE_MM))
            continue
        activity = max(0.0, figures["thrust_std_n"] - free_n)
        hover = figures["hover_rms_mm"]
        each.append((hover + SHARE * ((figures["terrain_rms_mm"] or 0.0) + (figures["overshoot_mm"] or 0.0))
                     + ACTIVITY_MM_PER_N * activity, hover))
    return float(numpy.mean([one for one, _ in each]) + WORST * max(hover for _, hover in each))


def stock_settings(law):
    return ({"LAW": "PID"} if law == "PID" else {}) | STOCK[law]


class Course:
    def __init__(self, program, law, vehicle, count, seed):
        self.program, self.law = program, law
        self.plants = forecast.draws(vehicle, count, seed)
        self.seeds = [SEED + 1000 * seed + k for k in range(count)]
        self.free_n = self.activity(stock_settings(law))

    def arguments(self, settings):
        return [forecast.words(SCENARIOS[self.law], seed, settings, plant)
                for seed, plant in zip(self.seeds, self.plants, strict=True)]

    def activity(self, settings):
        flown = forecast.fly_all(self.program, self.arguments(settings))
        return max(ACTIVITY_MORE * float(numpy.mean([figures["thrust_std_n"] or 0.0 for figures in flown])), ACTIVITY_FREE_N)

    def cost(self, settings):
        return cost(forecast.fly_all(self.program, self.arguments(settings)), self.free_n)


def search(course, base, gains, budget):
    """(best settings, cost) by Nelder and Mead on the logarithms of the gains."""
    from scipy.optimize import minimize

    known = {}

    def settings_at(place):
        values = [min(max(math.exp(x), low), high) for x, (_, _, low, high) in zip(place, gains, strict=True)]
        return base | {name: text(value) for (name, *_), value in zip(gains, values, strict=True)}

    def evaluate(place):
        settings = settings_at(place)
        key = tuple(settings.values())
        if key not in known:
            known[key] = (course.cost(settings), settings)
        return known[key][0]

    start = numpy.log([stock for _, stock, _, _ in gains])
    corners = [start, *(start + FIRST_STEP * row for row in numpy.eye(len(start)))]
    minimize(evaluate, start, method="Nelder-Mead",
             options={"initial_simplex": numpy.array(corners), "maxfev": budget, "xatol": 0.03, "fatol": 0.1})
    best = min(known.values(), key=lambda one: one[0])
    return best[1], best[0]


def tune(program, vehicle, law, count, budget):
    """(settings, stock's cost, tuned cost), both on draws that the search has not seen."""
    course, others = Course(program, law, vehicle, count, 1), Course(program, law, vehicle, count + 2, 2)
    kinds = ("THRUST", "CLIMB") if law == "EST" and vehicle["throttle"] == "CLIMB" else ("THRUST",)
    bases = [FIXED[law] | vehicle_settings(law, vehicle, kind) for kind in kinds]
    base = min(bases, key=course.cost) if len(bases) > 1 else bases[0]
    found, _ = search(course, base, gains_of(law, vehicle), budget)
    stock = stock_settings(law)
    stock_cost, base_cost, found_cost = (others.cost(settings) for settings in (stock, base, found))
    best_cost, best = (found_cost, found) if found_cost < base_cost else (base_cost, base)
    return (best if best_cost < (1.0 - WORTH) * stock_cost else stock), stock_cost, best_cost


def read_arguments(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("vehicle", type=Path)
    parser.add_argument("--law", choices=GAINS, default="EST")
    parser.add_argument("--draws", type=int, default=8, help="vehicles that each candidate flies (8)")
    parser.add_argument("--budget", type=int, default=30, help="candidates (30)")
    parser.add_argument("--forecast", type=int, default=60, help="flights of the forecast (60)")
    parser.add_argument("--program", type=Path, default=forecast.ROOT / "build/plomada")
    parser.add_argument("--out", type=Path, default=forecast.ROOT / "build/forecast.json", metavar="FILE")
    return parser.parse_args(argv)


def predict(program, vehicle, law, settings, count):
    course = Course(program, law, vehicle, count, 3)
    return forecast.intervals(forecast.fly_all_logged(program, course.arguments(settings)))


def main(argv=None):
    arguments = read_arguments(argv)
    program = str(arguments.program.resolve())
    try:
        vehicle = forecast.load(arguments.vehicle)
        settings, stock, tuned = tune(program, vehicle, arguments.law, arguments.draws, arguments.budget)
        expected = predict(program, vehicle, arguments.law, settings, arguments.forecast)
    except (forecast.fleet.Broken, OSError, KeyError, ValueError) as error:
        print(f"tune: {type(error).__name__}: {error}", file=sys.stderr)
        return 2
    for name, value in ({"LAW": arguments.law} | settings).items():
        print(f"#{name} {value}")
    print(f"\ncost {stock:.0f} mm with the stock gains, {tuned:.0f} mm with these")
    print(f"forecast of the next {SCENARIOS[arguments.law]}, by its log:")
    for name, f in expected.items():
        print(f"  {name:14} {f['value']:.3g} [{f['low']:.3g} .. {f['high']:.3g}]")
    arguments.out.write_text(json.dumps({"law": arguments.law, "scenario": SCENARIOS[arguments.law], "settings": settings,
                                         "vehicle": str(arguments.vehicle.resolve()), "expected": expected}, indent=1) + "\n",
                             encoding="utf-8")
    print(arguments.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
