#!/usr/bin/env python3
"""fit.py LOG... [--out FILE]: finds the vehicle in its flights.

LOG is a CSV of `plomada log` (of a flight behind #LOG RATE FAST) or of `plomada fly --csv`; several logs are of one vehicle.
FILE (build/vehicle.json) has the plant's own names, each with a value and a 90 % interval, and whether the throttle commands
THRUST or CLIMB; `plomada fly --vehicle FILE` flies it; a picture lies beside FILE. A table on stdout says what was found, and what the flights say too
little about. docs/fit.md tells more. Exit status: 0; 2 usage, or logs that do not hold what is needed.
"""
import argparse
import json
import math
import os
import sys
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")       # matrices of six rows

import numpy

import flight_log
import model
import recording        # on the path by flight_log
from say import say

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/campaign"))
import fleet  # noqa: E402

TELLING = 6.0                   # twice a log-likelihood: a kind that is better by less is a guess
SEEN_WELL, SEEN = 0.9, 0.6      # share of what is known that comes from the flight
HOVER_STEPS = 6
RAYS, RAY_NOISE_MM = 35, 5.0    # of the front window; the plant's own noise of each ray

# What a figure means, and which manoeuvre shows it.
MEANING = {
    "hover_thrust": ("thrust per motor that hovers", "fly on for 10 s at one height"),
    "gain": ("effect of the throttle, 1: as its own hover thrust says", "quick steps of the reference: experiment"),
    "tau": ("lag of the motors", "quick doublets of the reference: experiment"),
    "tdelay": ("dead time behind the pulse", "quick doublets of the reference: experiment"),
    "damping": ("of a climb, by the air", "a climb of half a metre at full VUP, and down again"),
    "sag": ("growth of the hover thrust, battery", "hover for a minute"),
    "volts_power": ("thrust goes with the battery's voltage to the power of it; 0: compensated", "a log with a full battery, one with a low one"),
    "climb_neutral": ("throttle that commands no climb", "hover for 20 s"),
    "climb_rate": ("climb that a newton commands", "steps of the reference of 0.3 m, held: experiment"),
    "climb_deadband": ("to either side of the middle", "small steps of the reference, up and down: experiment"),
    "climb_lag": ("of the autopilot's speed loop", "quick steps of the reference: experiment"),
    "climb_wander": ("what the autopilot's own climb wanders", "hover for a minute"),
    "turbulence": ("of the air, rms", "hover for 20 s"),
    "turbulence_tau": ("its correlation time", "hover for a minute"),
    "acc_noise": ("of the accelerometer, rms", "any flight"),
    "acc_bias": ("of the accelerometer", "any flight"),
    "height_noise": ("of a height, rms", "any flight"),
    "slower": ("the rotors slow down later than they spin up", "quick doublets of the reference: experiment"),
    "curve": ("the thrust is no straight line of the throttle", "steps of the reference of 0.5 m"),
    "inflow": ("the thrust answers more at first than what stays, air through the rotors", "quick doublets of the reference: experiment"),
    "inflow_lag": ("until it stays", "quick doublets of the reference: experiment"),
    "authority": ("", ""),
    "response": ("", ""),
}
NOT_OF_THE_PLANT = ("height_noise", "climb_wander", *model.BEYOND["THRUST"], *model.VOLTS["THRUST"])
SIMULATED = {"THRUST": "thrust", "CLIMB": "a climb rate"}


def quantiles(values):
    return float(numpy.quantile(values, 0.05)), float(numpy.quantile(values, 0.95))


def bounded(value, low, high, least=0.0, otherwise=None):
    """otherwise: what other equations say. Where these were proved wrong, the next ones are wrong too, by as much or less."""
    off = 0.0 if otherwise is None else abs(value - otherwise)
    return {"value": max(value, least), "low": max(min(low, value - off), least), "high": max(high, value + off, least)}


def derived(found, rng):
    """What users ask for, from draws of the figures: m/s2 (or m/s) per newton, and lag and dead time together."""
    def authority(f):
        return f["climb_rate"] if found.kind == "CLIMB" else model.GRAVITY_MPS2 * f["gain"] / f["hover_thrust"]

    drawn = [found.draw(rng) for _ in range(2000)]
    return {name: bounded(of(found.figures), *quantiles([of(f) for f in drawn]), otherwise=of(found.simple))
            for name, of in (("authority", authority), ("response", model.response_s))}


def hover_over_time(found, stretches):
    """[[seconds of the log, N]] of all flights."""
    if found.kind == "CLIMB":
        return []
    rows = []
    for stretch in stretches:
        for t_s in numpy.linspace(stretch.grid_s[0], stretch.grid_s[-1], HOVER_STEPS):
            hover_n = found.figures["hover_thrust"] * (1.0 + found.figures["sag"] * (t_s - stretch.begin_s))
            if stretch.volts_share is not None:
                hover_n /= numpy.interp(t_s, stretch.grid_s, stretch.volts_share)**found.figures["volts_power"]
            rows.append([round(float(t_s), 2), round(float(hover_n), 3)])
    return rows


def hover_over_volts(found, stretches, volts):
    """[[V, N]] at the lowest, the mean and the highest voltage of the flights."""
    if found.kind == "CLIMB" or volts is None:
        return []
    levels = numpy.concatenate([stretch.volts for stretch in stretches])
    return [[round(float(v), 2), round(found.figures["hover_thrust"] * (volts / v)**found.figures["volts_power"], 3)]
            for v in (levels.min(), volts, levels.max())]


def told(found, name):
    """A plain sentence: did the flight show this figure?"""
    share = found.excited(name)
    if share > SEEN_WELL:
        return "seen well"
    manoeuvre = MEANING[name][1]
    return f"seen a little; {manoeuvre}" if share > SEEN else f"not seen, taken from other vehicles; {manoeuvre}"


def common_noise_mm(height_noise_m):
    return math.sqrt(max((1e3 * height_noise_m)**2 - RAY_NOISE_MM**2 / RAYS, 0.01))


def attitude_of(stretches):
    """Rms of roll and of pitch, from the cosine of the tilt; what the flights' seconds say differs by less than a tenth."""
    value = math.sqrt(max(float(numpy.mean(numpy.concatenate([1.0 - stretch.upright for stretch in stretches]))), 0.0))
    return {"value": value, "low": 0.9 * value, "high": 1.1 * value}


def beyond(found):
    """Sentences: what the vehicle does and neither the simulated vehicle nor law EST's model knows."""
    result = []
    for name in model.BEYOND[found.kind]:
        if name in found.table and name != "inflow_lag":
            low, high = found.interval(name)
            if low > 0.0 or high < 0.0:
                result.append(f"{MEANING[name][0]} ({name} {found.figures[name]:.2f} [{low:.2f} .. {high:.2f}])")
    return result


def vehicle_of(found, other, stretches, logs, rng, volts):
    heights = sum(len(stretch.ray_s) for stretch in stretches)
    telling = other.loss - found.loss
    result = {"throttle": found.kind, "throttle_told": telling > TELLING, "better_by": round(telling, 1)}
    for name in found.table:
        value, interval = found.figures[name], found.interval(name)
        least = -math.inf if name in ("acc_bias", "sag", "volts_power", "slower", "curve", "inflow") else 0.0  # a deadband, a dead time
        key = name if name in NOT_OF_THE_PLANT else f"plant.{name}"
        result[key] = bounded(value, *interval, least, found.simple.get(name)) | {"told": told(found, name)}
    noise = result["height_noise"]
    result["plant.common_noise"] = {word: common_noise_mm(noise[word]) for word in ("value", "low", "high")}
    result["plant.attitude_rms"] = attitude_of(stretches)
    if found.kind == "THRUST":
        result["plant.climb_rate"] = {"value": 0.0, "low": 0.0, "high": 0.0}
    result |= derived(found, rng)
    result["outliers"] = {"value": found.outliers / heights, "of": heights}
    result["hover_over_time"] = hover_over_time(found, stretches)
    result["hover_over_volts"] = hover_over_volts(found, stretches, volts)
    result["names"] = list(found.likelihood.names)
    result["units"] = [float(unit) for unit in found.units]
    result["covariance"] = [[float(cell) for cell in row] for row in found.covariance]
    result["beyond"] = beyond(found)
    result["logs"] = [str(log) for log in logs]
    return result


def stretches_of(logs):
    """Of all logs. A flight that counts twice would make the intervals too narrow."""
    found, known = [], {}
    for log in logs:
        stretches = flight_log.stretches(log)
        rays = [stretch.ray_s.tobytes() + stretch.ray_height_m.tobytes() for stretch in stretches]
        other = next((known[key] for key in rays if key in known), None)
        if other is not None:
            raise flight_log.Unfit(f"{log}: the same flight as in {other}; name each flight once")
        known |= dict.fromkeys(rays, log)
        found += stretches
    return found


def fit_logs(logs):
    """(vehicle for JSON, the fit, stretches). Raises flight_log.Unfit."""
    stretches = stretches_of(logs)
    volts = model.compare_volts(stretches)
    fits = sorted((model.fit(kind, stretches) for kind in model.KINDS), key=lambda fit: fit.loss)
    rng = numpy.random.default_rng(1)
    return vehicle_of(fits[0], fits[1], stretches, logs, rng, volts), fits[0], stretches


def number(value):
    return f"{value:.3g}"


def text(vehicle):
    kind = vehicle["throttle"]
    sure = f"better by {vehicle['better_by']:.0f} than the other kind" if vehicle["throttle_told"] else \
        "a guess: the flight does not tell; fly experiment"
    lines = [f"The throttle commands {SIMULATED[kind]} ({sure})."]
    unit = "m/s" if kind == "CLIMB" else "m/s2"
    for name, words, of in (("authority", "authority", f"{unit} per N"), ("response", "lag and dead time", "s")):
        f = vehicle[name]
        lines.append(f"{words}: {number(f['value'])} [{number(f['low'])} .. {number(f['high'])}] {of}")
    if vehicle["hover_over_time"]:
        (t0, n0), (t1, n1) = vehicle["hover_over_time"][0], vehicle["hover_over_time"][-1]
        lines.append(f"hover thrust: {n0:.2f} N at {t0:.0f} s, {n1:.2f} N at {t1:.0f} s of the log")
    if vehicle["hover_over_volts"]:
        (low_v, most_n), _, (high_v, least_n) = vehicle["hover_over_volts"]
        power = vehicle["volts_power"]
        lines.append(f"hover thrust: {least_n:.2f} N at {high_v:.1f} V, {most_n:.2f} N at {low_v:.1f} V: by the voltage to the power of "
                     f"{-power['value']:.1f} [{-power['high']:.1f} .. {-power['low']:.1f}]")
    lines += [f"beyond the model, forecasts do not know it: {sentence}" for sentence in vehicle["beyond"]]
    lines.append(f"heights that no noise explains: {100 * vehicle['outliers']['value']:.1f} % of {vehicle['outliers']['of']}")
    lines.append("")
    for key, f in vehicle.items():
        name = key.removeprefix("plant.")
        if isinstance(f, dict) and "told" in f:
            unit = model.TABLES[kind][name].unit
            lines.append(f"{key:22} {number(f['value']):>8} [{number(f['low'])} .. {number(f['high'])}] {unit:5} "
                         f"{MEANING[name][0]}: {f['told']}")
    return "\n".join(lines)


def read_arguments(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("logs", nargs="+", metavar="LOG", type=Path)
    parser.add_argument("--out", type=Path, default=ROOT / "build/vehicle.json", metavar="FILE")
    return parser.parse_args(argv)


def check_named(out, pictured):
    if out == pictured:
        raise flight_log.Unfit(f"{out}: the vehicle and its picture are one file; a name that ends in .json")


def main(argv=None):
    arguments = read_arguments(argv)
    pictured = arguments.out.with_suffix(".png")
    try:
        recording.apart([arguments.out, pictured], arguments.logs, "--out")      # said before the work
        check_named(arguments.out, pictured)
        vehicle, found, stretches = fit_logs(arguments.logs)
        import fit_picture  # Matplotlib takes its second: what is wrong with a log is told before
        vehicle["version"] = fleet.version()
        arguments.out.parent.mkdir(parents=True, exist_ok=True)
        fleet.write_whole(arguments.out, json.dumps(vehicle, indent=1) + "\n")
        fit_picture.draw(pictured, vehicle, found, stretches)
    except (flight_log.Unfit, OSError) as error:
        print(f"fit: {error}", file=sys.stderr)
        return 2
    say(text(vehicle))
    say(f"\n{arguments.out}\n{pictured}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
