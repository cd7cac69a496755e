"""A vehicle of fit, drawn from its uncertainty, in flights; and what a log says of a flight's quality."""
import concurrent.futures
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

import flight_log
import model

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/campaign"))
import fleet  # noqa: E402

EDGE_M, EDGE_S = 0.15, 0.3      # a height that jumps so far from scan to scan, the reference steady so long, has passed an edge
LASTS_S = 0.33                  # when it stays there: three scans on either side, of which one may lie
SETTLED_S = 3.5                 # after a change of the reference
AFTER_EDGE_S = 3.98             # as the scenarios' metrics
NEVER_S = 3.97                  # recovery of a flight that was not within at the end of it; fly and docs/fit.md say the same
WITHIN_M = 0.05
COVERAGE = 0.9                  # of each interval, as intervals() says
FIGURES = {"hover_rms_mm": "mm", "recovery_s": "s", "undershoot_mm": "mm"}


def load(path):
    return json.loads(Path(path).read_text(encoding="utf-8"))


def load_vehicle(path):
    """A vehicle of fit, whole. ValueError says what is wrong with it."""
    try:
        vehicle = load(path)
        names, table = vehicle["names"], model.TABLES[vehicle["throttle"]]
        spread = numpy.array(vehicle["covariance"], float)
        numbers = numpy.array([*vehicle["units"], *spread.flat, vehicle["authority"]["value"],
                               *(vehicle[f"plant.{name}"]["value"] for name in names if f"plant.{name}" in vehicle)], float)
        whole = set(model.KINDS[vehicle["throttle"]]) <= set(names) <= set(table) and spread.shape == (len(names), len(names))
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise ValueError(f"{path}: no vehicle of make fit: {type(error).__name__} {error}") from None
    if not whole or len(vehicle["units"]) != len(names) or not numpy.isfinite(numbers).all():
        raise ValueError(f"{path}: no vehicle of make fit: figures are missing, or no numbers")
    return vehicle


def load_forecast(path):
    """(forecast of tune, its vehicle), whole. ValueError says what is wrong."""
    try:
        found = load(path)
        numbers = [f[word] for name, f in found["expected"].items() for word in ("value", "low", "high") if name in FIGURES]
        whole = set(found["expected"]) <= set(FIGURES) and numpy.isfinite(numpy.array(numbers, float)).all()
        vehicle = load(found["vehicle"])
        whole = whole and vehicle["throttle"] in model.KINDS
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise ValueError(f"{path}: no forecast of make tune: {type(error).__name__} {error}") from None
    if not whole:
        raise ValueError(f"{path}: no forecast of make tune: figures that are unknown, or no numbers")
    return found, vehicle


def plant_of(kind, figures):
    """Plant figures for --set."""
    unknown = ("height_noise", "climb_wander", *model.BEYOND[kind], *model.VOLTS[kind])
    plant = {name: value for name, value in figures.items() if name not in unknown}
    plant["common_noise"] = math.sqrt(max((1e3 * figures["height_noise"])**2 - 25.0 / 35.0, 0.01))
    plant["tdelay"] = max(plant["tdelay"], 0.0)
    if kind == "THRUST":
        plant["climb_rate"] = 0.0
    else:
        plant["climb_deadband"] = max(plant["climb_deadband"], 0.0)
    return plant


def rotors_of(figures):
    """The same vehicle by the simulation's other equations (plant.airframe 1), as far as the fit says: how steeply the thrust
    follows the throttle, and both lags of the rotors. Of the rest it has what that airframe has."""
    plant = {name: value for name, value in plant_of("THRUST", figures).items() if name not in ("gain", "tau", "damping", "climb_rate")}
    faster = math.exp(-figures["slower"] / 2.0)
    return plant | {"airframe": 1.0, "exponent": figures["gain"], "spin_up": figures["tau"] * faster,
                    "slow_down": figures["tau"] / faster}


def worlds(vehicle):
    """By which equations a vehicle is flown. One that its flights show to be beyond the model is also flown by those of the other
    airframe: what is better by both is not owed to what one of them leaves out."""
    return ("model", "rotors") if "slower" in vehicle["names"] else ("model",)


def draws(vehicle, count, seed, world=None):
    """[plant figures] of vehicles that the flights allow. world: of worlds(), None: each in turn."""
    rng = numpy.random.default_rng(seed)
    kind, table, known = vehicle["throttle"], model.TABLES[vehicle["throttle"]], worlds(vehicle)
    attitude = {"attitude_rms": vehicle["plant.attitude_rms"]["value"]} if "plant.attitude_rms" in vehicle else {}
    found = []
    for k, units in enumerate(rng.multivariate_normal(vehicle["units"], vehicle["covariance"], count)):
        figures = {name: table[name].back(table[name].prior()[0] + unit * table[name].prior()[1])
                   for name, unit in zip(vehicle["names"], units, strict=True)}
        by_rotors = (world or known[k % len(known)]) == "rotors"
        found.append((rotors_of(figures) if by_rotors else plant_of(kind, figures)) | attitude)
    return found


def words(scenario, seed, settings, plant):
    result = [scenario, "--seed", str(seed)]
    for name, value in settings.items():
        result += ["--set", f"{name}={value}"]
    for name, value in plant.items():
        result += ["--set", f"plant.{name}={value:.9g}"]
    return result


class Flights:
    """Flies [arguments] and gives what came of each, in their order. With a store every flight is kept when it ends, and none is
    flown twice."""

    def __init__(self, program, store=None, progress=None):
        self.program, self.store, self.progress = program, store, progress
        self.sum = fleet.digest(program)
        self.provenance = fleet.provenance(program)

    def each(self, way, flights):
        """way: fleet.fly or fly_logged."""
        known = {} if self.store is None else self.store.known
        keys = [f"{way.__name__} {fleet.key(self.sum, arguments)}" for arguments in flights]
        missing = {key: arguments for key, arguments in zip(keys, flights, strict=True) if key not in known}
        found = {}
        pool = concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0)))
        try:
            for (key, arguments), figures in zip(missing.items(), pool.map(lambda one: way(self.program, one), missing.values()),
                                                 strict=True):
                found[key] = figures
                if self.store is not None:
                    self.store.add(key, self.provenance | {"command": fleet.command(self.program, arguments)}, figures)
                if self.progress is not None:
                    self.progress.step()
        finally:
            pool.shutdown(cancel_futures=True)
        return [found[key] if key in found else known[key] for key in keys]


def fly_all(program, flights):
    """Figures of [arguments], in their order."""
    return Flights(program).each(fleet.fly, flights)


def fly_logged(program, arguments):
    """(figures of the program, those that its log shows)."""
    with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
        path = Path(scratch, "flight.csv")
        figures = fleet.fly(program, [*arguments, "--csv", str(path)])
        return figures, quality(path)


def fly_all_logged(program, flights):
    return Flights(program).each(fly_logged, flights)


def lasts(t_s, height_m, k):
    """Whether the height stays where it jumped to: one height that lies jumps there and back."""
    first, end = numpy.searchsorted(t_s, (t_s[k] - LASTS_S, t_s[k] + LASTS_S))
    return abs(numpy.median(height_m[k:end]) - numpy.median(height_m[first:k])) > EDGE_M


def edges(t_s, height_m, reference_m):
    """Instants at which the ground steps away under a steady reference."""
    found = []
    for k in range(1, len(t_s)):
        before = numpy.searchsorted(t_s, t_s[k] - EDGE_S)
        steady = reference_m[before] == reference_m[k] and t_s[k] - t_s[before] > 0.5 * EDGE_S
        jumped = abs(height_m[k] - height_m[k - 1]) > EDGE_M and lasts(t_s, height_m, k)
        if steady and jumped and (not found or t_s[k] - found[-1] > AFTER_EDGE_S):
            found.append(t_s[k])
    return found


def held(path):
    """Times, measured heights and references while a reference is held."""
    c = flight_log.columns(path)
    good = numpy.array([state in flight_log.FLYING for state in c["state"]]) & (c["ref_m"] > 0.0) & ~numpy.isnan(c["meas_m"])
    return [c[name][good] for name in ("t_s", "meas_m", "ref_m")]


def has_edges(path):
    return bool(edges(*held(path)))


def quality(path):
    """{figure: value or None} of a log, by the measured heights: what a real flight can be compared by."""
    t_s, height_m, reference_m = held(path)
    if len(t_s) < 2:
        return dict.fromkeys(FIGURES)
    error_m = height_m - reference_m
    changes = [t_s[0], *t_s[1:][numpy.diff(reference_m) != 0.0]]
    passed = edges(t_s, height_m, reference_m)
    steady = numpy.ones(len(t_s), bool)
    for change in changes:
        steady &= (t_s < change) | (t_s > change + SETTLED_S)
    for edge in passed:
        steady &= (t_s < edge - AFTER_EDGE_S) | (t_s > edge + AFTER_EDGE_S)
    result = dict.fromkeys(FIGURES)
    if steady.sum() > 50:
        result["hover_rms_mm"] = 1e3 * float(numpy.sqrt(numpy.mean(error_m[steady]**2)))
    if passed:
        after = (t_s >= passed[-1]) & (t_s <= passed[-1] + AFTER_EDGE_S)
        off = numpy.abs(error_m[after]) > WITHIN_M
        result["recovery_s"] = NEVER_S if off[-1] else float(t_s[after][off][-1] - passed[-1]) if off.any() else 0.0
        first = numpy.sign(error_m[after][0])
        result["undershoot_mm"] = 1e3 * float(max(0.0, numpy.max(-first * error_m[after])))
    return result


def intervals(flown):
    """{figure: {"value" (median), "low", "high"}}: the next flight is within in 90 % of all cases. So many flights rank evenly
    among themselves, which is why the quantiles are Weibull's. They are those of 95 %: of 90 % in the model's own world, 88 %
    of the true vehicles' flights were within (acceptance.py, seed 204)."""
    result = {}
    for name in FIGURES:
        values = [figures[name] for figures in flown if figures[name] is not None]
        if len(values) > len(flown) / 2:
            low, middle, high = numpy.quantile(values, (0.025, 0.5, 0.975), method="weibull")
            result[name] = {"value": float(middle), "low": float(low), "high": float(high)}
    return result


def fails_by_chance(count):
    """How often a flight breaks a forecast of so many figures that is right: one of them, or more, is above its interval. This is
    the most: it takes them for independent, and figures of one flight that fail together fail in fewer flights."""
    return 1.0 - (1.0 - (1.0 - COVERAGE) / 2.0)**count
