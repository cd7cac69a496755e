#!/usr/bin/env python3
"""acceptance.py [--vehicles N] [--seed N] [--tune EST,PID] ...: does fit find vehicles that nobody told it?

Draws vehicles: throttle THRUST or CLIMB in turn, mass +-20 %, motors' lag 60 to 150 ms, dead time 0 to 40 ms, gain (or climb
rate) +-30 %, damping, turbulence, noises. Each flies `experiment` with the stock gains, as often as --dumps says; fit sees what
the recorder holds. Then come the errors, how often the 90 % intervals hold the truth, and what must be. With --tune also: each
vehicle is tuned for on its fit, and flies the true vehicle with stock and with tuned gains: a minute of processor time a vehicle. With
--airframe 1 the vehicles fly by momentum theory (sim/devices/rotors.h), which neither fit nor law EST knows: the question is
whether tuning harms them. Results are kept in DIR as they come; a rerun with the same seed, program and tools goes on.

A must is a share of the vehicles. It is MISSED when so few would be improbable if it were kept: one run of twenty says so of tools
that just keep them all (tools/campaign/rate.py).
Exit status: 0; 1 something is not as it must be; 2 usage.
"""
import argparse
import concurrent.futures
import contextlib
import hashlib
import json
import os
import random
import subprocess
import sys
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[1] / "campaign")]
import fit  # noqa: E402
import flight_log  # noqa: E402
import forecast  # noqa: E402
import rate  # noqa: E402
import tune_vehicle  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
MIDDLE_S, LANDED_S = 12.0, 22.0 # of the experiment: the hover thrust is compared there, the battery sags; the landing command
SEED_STEP = 1_000_000
DRAWS, FORECAST, JUDGED = 8, 40, 20     # flights of a candidate, of a forecast, of a verdict
BUDGET = {"EST": 11, "PID": 14}         # candidates
MUST = {"hover": 0.02, "authority": 0.10, "response": 0.015}
FOUND_MUST, HOLDS_MUST = 29 / 30, 24 / 30
WORSE_MOST = 0.03               # no vehicle may hover or recover worse than that, as far as its flights tell


def rotors(seed, number):
    """What the other airframe has in place of gain, lag and damping; around rotors.h's own."""
    rng = random.Random(f"rotors {seed}/{number}")
    return {"airframe": 1.0, "exponent": rng.uniform(1.2, 1.8), "spin_up": rng.uniform(0.05, 0.09), "slow_down": rng.uniform(0.11, 0.21),
            "inflow_lag": rng.uniform(0.07, 0.13), "drag": 0.35 * rng.uniform(0.7, 1.3)}


def vehicle(seed, number, airframe=0):
    """Plant figures of a vehicle. Nothing but these counts."""
    rng = random.Random(f"vehicle {seed}/{number}")
    figures = {"hover_thrust": 7.0 * rng.uniform(0.8, 1.2), "tau": rng.uniform(0.06, 0.15),
               "tdelay": rng.uniform(0.0, 0.04), "damping": rng.uniform(1.5, 3.0), "sag": rng.uniform(0.0, 0.0015),
               "turbulence": 0.2 * rng.uniform(0.8, 1.5), "acc_bias": rng.uniform(-0.25, 0.25),
               "acc_noise": 0.4 * rng.uniform(1.0, 2.0), "common_noise": 3.0 * rng.uniform(1.0, 2.0),
               "attitude_rms": 0.035 * rng.uniform(0.8, 1.5)}
    strength = rng.uniform(0.7, 1.3)
    if airframe == 1:
        return {name: value for name, value in figures.items() if name not in ("tau", "damping")} | rotors(seed, number)
    if number % 2 == 1:
        return figures | {"gain": strength}
    return figures | {"climb_rate": 0.65 * strength, "climb_neutral": 7.0 + rng.uniform(-0.5, 0.8),
                      "climb_deadband": rng.uniform(0.0, 0.4), "climb_lag": rng.uniform(0.2, 0.5)}


def truth(figures):
    if "climb_rate" in figures:
        return {"hover": figures["climb_neutral"], "authority": figures["climb_rate"],
                "response": figures["tau"] + figures["tdelay"]}
    hover = {"hover": figures["hover_thrust"] * (1.0 + figures["sag"] * MIDDLE_S)}
    return hover if "airframe" in figures else hover | {"authority": 9.80665 * figures["gain"] / figures["hover_thrust"], "response": figures["tau"] + figures["tdelay"]}


def words(figures):
    return [word for name, value in figures.items() for word in ("--set", f"plant.{name}={value:.9g}")]


def experiment(program, figures, seed, path, scenario="experiment"):
    """What the chip's recorder holds of it, as `plomada log` writes it."""
    console = path.with_suffix(".log")
    subprocess.run([program, "fly", scenario, "--seed", str(seed), *words(figures), "--log", str(console)], check=False,
                   stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    subprocess.run([program, "log", str(console), "--force"], check=True, stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    console.unlink()


def middle_of(log):
    """MIDDLE_S of the experiment in seconds since the log begins."""
    c = flight_log.columns(log)
    landing = fit.numpy.flatnonzero(c["ref_m"] > 0.0)[-1] + 1
    return float(c["t_s"][landing] - c["t_s"][0]) - LANDED_S + MIDDLE_S


def hover_interval(found, middle_s):
    """With what the sag adds until then."""
    if found["throttle"] == "CLIMB":
        return found["plant.climb_neutral"]
    rng = fit.numpy.random.default_rng(1)
    units = rng.multivariate_normal(found["units"], found["covariance"], 2000)
    figures = fit.model.TABLES["THRUST"]
    drawn = []
    for unit in units:
        f = {name: figures[name].back(figures[name].prior()[0] + u * figures[name].prior()[1])
             for name, u in zip(found["names"], unit, strict=True)}
        drawn.append(f["hover_thrust"] * (1.0 + f["sag"] * middle_s))
    value = found["plant.hover_thrust"]["value"] * (1.0 + found["plant.sag"]["value"] * middle_s)
    low, high = fit.quantiles(drawn)
    return {"value": value, "low": low, "high": high}


def one(program, seed, number, folder, dumps, airframe):
    """A record of one vehicle, for the table."""
    figures = vehicle(seed, number, airframe)
    out = folder / f"{seed}-{number}.json"
    logs = [folder / f"{seed}-{number}-{k}.csv" for k in range(1, dumps + 1)]
    for k, log in enumerate(logs):
        experiment(program, figures, seed * SEED_STEP + 100 * number + k, log)
    try:
        found, _, _ = fit.fit_logs(logs)
    except flight_log.Unfit as error:
        return {"number": number, "unfit": str(error)}
    out.write_text(json.dumps(found, indent=1, default=float) + "\n", encoding="utf-8")
    middle_s = middle_of(logs[0])
    for log in logs:
        log.unlink()
    true = truth(figures)
    kind = "CLIMB" if "climb_rate" in figures else "THRUST"
    seen = {"hover": hover_interval(found, middle_s), "authority": found["authority"], "response": found["response"]}
    record = {"number": number, "kind": kind, "found": found["throttle"], "better_by": found["better_by"]}
    for name, value in true.items():
        f = seen[name]
        off = f["value"] - value
        record[name] = {"true": value, **f, "error": off if name == "response" else off / value,
                        "holds": f["low"] <= value <= f["high"]}
    return record


def tuned(program, law, vehicle_file, figures, seed, number):
    """The true vehicle with stock and with tuned gains, and whether the forecast held its next flight."""
    found = json.loads(vehicle_file.read_text(encoding="utf-8"))
    flights = forecast.Flights(program)
    proposal = tune_vehicle.tune(flights, found, law, DRAWS, BUDGET[law])
    expected = tune_vehicle.predict(flights, found, law, proposal.settings, FORECAST)
    scenario = tune_vehicle.SCENARIOS[law]
    seeds = [900_000_000 + seed * 10_000 + number * 100 + k for k in range(JUDGED)]
    stock, tuned = (forecast.fly_all_logged(program, [forecast.words(scenario, s, typed, figures) for s in seeds])
                    for typed in (tune_vehicle.stock_settings(law), proposal.settings))
    logs = [seen for _, seen in tuned]
    held = {name: [seen[name] is not None and f["low"] <= seen[name] <= f["high"] for seen in logs] for name, f in expected.items()}
    return {"settings": proposal.settings, "kept": proposal.kept, "expected": expected, "seen": logs[0],
            "changes": {name: vars(tune_vehicle.change(*[[of(f) for f, _ in flown] for flown in (stock, tuned)]))
                        for name, (of, _) in tune_vehicle.FRESH_FIGURES.items()},
            "holds": {name: each[0] for name, each in held.items()},
            "held_share": {name: sum(each) / JUDGED for name, each in held.items()}}


def row(record):
    if "unfit" in record:
        return f"{record['number']:3} {record['unfit']}"
    cells = [f"{record['number']:3} {record['kind']:6} {record['found']:6} {record['better_by']:6.0f}"]
    for name in (name for name in MUST if name in record):
        f = record[name]
        error = f"{1e3 * f['error']:+6.1f} ms" if name == "response" else f"{100 * f['error']:+6.1f} % "
        cells.append(f"{name} {error} {'holds' if f['holds'] else 'MISSES'}")
    for law in ("EST", "PID"):
        if law in record:
            shown = [f"{name} {c['stock']:.3g} -> {c['tuned']:.3g} ({100 * (c['tuned'] / c['stock'] - 1):+.1f} %)"
                     for name, c in record[law]["changes"].items()]
            cells.append(f"{law}{' kept' if record[law]['kept'] else ''}: {', '.join(shown)}; forecast missed: "
                         f"{' '.join(name for name, good in record[law]['holds'].items() if not good) or '-'}")
    return "  ".join(cells)


def verdicts(records):
    """[(what, of how many vehicles, for which share of all it must be so)]"""
    good = [r for r in records if "unfit" not in r and r["kind"] == r["found"]]
    yield "kind of throttle right", len(good), FOUND_MUST
    for name, limit in MUST.items():
        yield f"{name} within {limit:g}", sum(abs(r[name]["error"]) <= limit for r in good), FOUND_MUST
        yield f"interval of {name} holds the truth", sum(r[name]["holds"] for r in good), HOLDS_MUST


def no_worse(records, law):
    flown = [r[law]["changes"] for r in records if law in r]
    for name in ("hover RMS", "recovery"):
        yield (f"{law}: {name} not worse by more than {100 * WORSE_MOST:g} %, as far as {JUDGED} flights of each tell",
               len(records) - sum(c[name]["least"] > WORSE_MOST for c in flown), 1.0)


def tuning_verdicts(records, law):
    """The same of the tuning. A vehicle that was not fit was not tuned for."""
    flown = [r[law] for r in records if law in r]
    yield f"{law}: other gains proposed", sum(not r["kept"] for r in flown), 0.5
    for name in ("hover_rms_mm", "recovery_s", "undershoot_mm"):
        yield f"{law}: forecast of {name} holds", sum(r["holds"].get(name, False) for r in flown), HOLDS_MUST
        share = sum(r["held_share"].get(name, 0.0) for r in flown)
        yield f"{law}: would hold, the mean of {JUDGED} flights of each", round(share), HOLDS_MUST


def print_verdict(what, reached, must, of, error):
    """Whether it is missed."""
    missed = rate.told(of - reached, of, 1.0 - must, error) == rate.MISSED
    print(f"{what}: {reached} of {of}, must in {100 * must:.3g} %{' MISSED' if missed else ''}")
    return missed


def maker(program):
    """A sum of the program and of these tools: what others found is found anew."""
    files = [Path(program), *sorted(Path(__file__).resolve().parent.glob("*.py"))]
    return hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()[:12]


def known_records(path, made_by):
    """A line torn by an interruption is found anew."""
    found = {}
    for line in path.read_text(encoding="utf-8").splitlines() if path.exists() else ():
        with contextlib.suppress(ValueError):
            record = json.loads(line)
            if record["made_by"] == made_by:
                found[record["number"]] = record
    return found


def complete(arguments, number, record, laws):
    """(record of a vehicle with what it lacked, whether it lacked something)."""
    program = str(arguments.program.resolve())
    news = record is None
    record = one(program, arguments.seed, number, arguments.out, arguments.dumps, arguments.airframe) if news else record
    for law in laws:
        if law not in record and "unfit" not in record:
            file = arguments.out / f"{arguments.seed}-{number}.json"
            record[law] = tuned(program, law, file, vehicle(arguments.seed, number, arguments.airframe), arguments.seed, number)
            news = True
    return record, news


def read_arguments(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vehicles", type=int, default=30)
    parser.add_argument("--first", type=int, default=1, metavar="NUMBER", help="vehicle to begin with: a part of the work")
    parser.add_argument("--seed", type=int, help="drawn anew, or SOAK_SEED of the environment, when none is given")
    parser.add_argument("--dumps", type=int, default=2, help="flights of the experiment; the recorder holds 25 s of each (2)")
    parser.add_argument("--airframe", type=int, choices=(0, 1), default=0, help="1: vehicles that fit does not know")
    parser.add_argument("--tune", default="", metavar="LAW,LAW", help="also tune for each vehicle: EST, PID")
    parser.add_argument("--program", type=Path, default=ROOT / "build/plomada")
    parser.add_argument("--out", type=Path, default=ROOT / "build/fit-acceptance", metavar="DIR")
    return parser.parse_args(argv)


def main(argv=None):
    arguments = read_arguments(argv)
    arguments.seed = rate.drawn_seed() if arguments.seed is None else arguments.seed
    arguments.out.mkdir(parents=True, exist_ok=True)
    kept = arguments.out / f"{arguments.seed}.jsonl"
    made_by = maker(arguments.program)
    earlier = known_records(kept, made_by)
    records = dict(earlier)
    print(f"seed {arguments.seed}, program and tools {made_by}")
    laws = [law for law in arguments.tune.split(",") if law]
    with concurrent.futures.ProcessPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        work = [pool.submit(complete, arguments, number, earlier.get(number), laws)
                for number in range(arguments.first, arguments.vehicles + 1)]
        for done in concurrent.futures.as_completed(work):
            record, news = done.result()
            records[record["number"]] = record
            if news:
                with kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(record | {"made_by": made_by}, default=float) + "\n")
            print(row(record), flush=True)
    chosen = [records[number] for number in range(arguments.first, arguments.vehicles + 1)]
    known = arguments.airframe == 0         # else neither fit nor forecast is asked to be right
    found = list(verdicts(chosen)) if known else []
    for law in laws:
        found += [*no_worse(chosen, law), *(tuning_verdicts(chosen, law) if known else ())]
    return 1 if sum([print_verdict(*each, of=len(chosen), error=rate.ERROR / len(found)) for each in found]) else 0


if __name__ == "__main__":
    sys.exit(main())
