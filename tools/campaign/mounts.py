#!/usr/bin/env python3
"""mounts.py [--runs N] [--planted N] [--only TEXT] [--seed N] [--program FILE]: what the mirrors find of themselves and of the IMU, with LAYOUT THREE.

Flies law EST in situations of healthy.toml, drawn by the seed; every second flight, about, has noise of each mirror's own in place of noise that
they share. First as they are: whatever is found is a false alarm. Then with one thing mounted wrongly in each flight. #MIRRORS, typed before
the landing, says what was found; flag 4096 of the log says when.
"""
import argparse
import csv
import os
import random
import re
import statistics
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import fleet
import plan
import situations
from scipy import stats

FLAG = 4096
ERROR = 0.025                   # on each side
LIFTED_M = 0.03
STRIDE = 4                      # chosen: the flights are drawn of so many more
STANDS = "lands and takes off again"    # a scenario stands for 1.4 s before its first take-off, a pilot for longer
OWN_NOISE = ["set plant.mirror_noise 3", "set plant.common_noise 0"]
ANSWER = re.compile(r"OK MIRRORS .* wrong:(\S+) .* imu:(\S+)")
LAW = {"laws": {"EST-THREE": {"scenario": "est-60cm-ramp", "settings": {"LAYOUT": "THREE"}}}}
ALWAYS = ["set plant.attitude_burst_start -2", "set plant.attitude_burst_length 100000"]    # behind the IMU's zero

# What is wrong, by what it is called, and what may be named: mirrors, faults of the IMU.
PLANTED = {
    "roll the other way round": (["set plant.imu_roll_sign -1"], {"ROLL"}),
    "pitch the other way round": (["set plant.imu_pitch_sign -1"], {"PITCH"}),
    "nose to the tail": (["set plant.imu_turned 1"], {"ROLL+PITCH"}),
    "roll and pitch exchanged": (["set plant.imu_swapped 1"], {"SWAPPED"}),
    "roll off by 2 degrees": ([*ALWAYS, "set plant.attitude_burst_deg 2"], {"OFFSET"}),
    "roll off by 4 degrees": ([*ALWAYS, "set plant.attitude_burst_deg 4"], {"OFFSET"}),
    "pitch off by 2 degrees": ([*ALWAYS, "set plant.attitude_burst_deg 2", "set plant.attitude_burst_turned 90"], {"OFFSET"}),
    "pitch off by 4 degrees": ([*ALWAYS, "set plant.attitude_burst_deg 4", "set plant.attitude_burst_turned 90"], {"OFFSET"}),
    "pitch off by 0.5 degrees": ([*ALWAYS, "set plant.attitude_burst_deg 0.5", "set plant.attitude_burst_turned 90"], {"-"}),
    "mirror 2 told 5 mm wrong": (["set L2 110"], {"-"}),
    "front mirror missing": (["set plant.missing_mirror 1"], {"FRONT"}),
    "mirror 1 missing": (["set plant.missing_mirror 2"], {"AFT"}),
    "mirror 2 missing": (["set plant.missing_mirror 3"], {"FORE"}),
    "wrong steps of mirror 1": (["set S1 180"], {"AFT"}),
    "mirror 2 told 80 mm wrong": (["set L2 185"], {"FORE"}),
    "mirror 2 blocked at 400 mm": (["set plant.sight_blocked 1", "set plant.block_mm 400", "set plant.struck_beam 3"], {"FORE"}),
}


def share(count, of):
    """'12 of 300 [2.1 .. 6.9 %]' (Clopper and Pearson 1934)."""
    least = stats.beta.ppf(ERROR, count, of - count + 1) if count else 0.0
    most = stats.beta.ppf(1 - ERROR, count + 1, of - count) if count < of else 1.0
    return f"{count} of {of} [{100 * least:.2g} .. {100 * most:.2g} %]"


def fly(program, flight, lines):
    """(what #MIRRORS has named, seconds from lift-off to the flag or None)."""
    with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
        path, log, radio = Path(scratch, "own.scenario"), Path(scratch, "log.csv"), Path(scratch, "radio.log")
        land_s = float(re.search(r"^land (\S+)$", flight.text, re.MULTILINE).group(1))
        ask = [line for line in flight.text.splitlines() if not line.startswith(("land ", "end "))]
        path.write_text("\n".join([*ask, *lines, f"at {land_s - 1:g} MIRRORS", f"at {land_s - 0.6:g} LOG RATE SLOW", f"at {land_s - 0.3:g} LOG CLEAR", f"land {land_s:g}", f"end {land_s + 10:g}", ""]), encoding="utf-8")
        done = subprocess.run(fleet.limited([program, "fly", path, *flight.words, "--csv", log, "--log", radio]), capture_output=True, text=True,
                              check=False, timeout=fleet.WALL_LIMIT_S)
        answers = ANSWER.findall(radio.read_text(encoding="ascii", errors="replace"))
        if done.returncode not in (0, 1) or not answers:
            raise fleet.Broken(f"{path.name}: {done.stderr.strip() or 'no answer to #MIRRORS'}\n{path.read_text()}")
        rows = list(csv.DictReader(log.open(encoding="utf-8")))
    lifted = next((float(row["t_s"]) for row in rows if float(row["height_m"]) > LIFTED_M), None)
    flagged = next((float(row["t_s"]) for row in rows if int(row["flags"]) & FLAG), None)
    named = "/".join(word for word in answers[-1] if word != "-") or "-"
    return named, None if flagged is None or lifted is None else flagged - lifted


def flights(table, count, seed, lands=False):
    """So many, a situation after the other, but for hours of flight; or of those that stand for some seconds between two flights."""
    law = plan.LAWS["EST-THREE"]
    chosen = [table.situations[STANDS]] if lands else [one for one in table.situations.values() if one.row != "hours"]
    return [(f"{chosen[i % len(chosen)].slug}/{1 + i // len(chosen)}",
             situations.flight(table, chosen[i % len(chosen)], law, seed, 1 + i // len(chosen)), OWN_NOISE if i % 2 else [])
            for i in random.Random(seed).sample(range(count * STRIDE), count)]


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=300, help="healthy flights (300)")
    parser.add_argument("--planted", type=int, default=40, help="with each fault (40)")
    parser.add_argument("--only", default="", help="faults whose name has this text")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--program", type=Path, default=fleet.ROOT / "build/plomada")
    arguments = parser.parse_args(argv)
    plan.extend(LAW)
    table = situations.load(situations.HEALTHY)
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        def all_of(planned, lines):
            return list(pool.map(lambda one: (one[0], *fly(arguments.program, one[1], [*one[2], *lines])), planned))

        healthy = [] if arguments.only else all_of(flights(table, arguments.runs, arguments.seed), [])
        false = [one for one in healthy if one[1] != "-" or one[2] is not None]
        if healthy:
            print(f"healthy: something was found in {share(len(false), len(healthy))}")
        print(*(f"  {name}: {named}, {when if when is None else round(when, 1)} s after lift-off" for name, named, when in false), sep="\n", flush=True)
        print("\n| mounted wrongly | named rightly | otherwise | before lift-off | s after lift-off, median / p90 |\n|---|---|---|---|---|")
        for title, (lines, wanted) in PLANTED.items():
            if arguments.only not in title:
                continue
            found = all_of(flights(table, arguments.planted, arguments.seed + 1, lines[:len(ALWAYS)] == ALWAYS), lines)
            right = [one for one in found if one[1] in wanted]
            other = [one for one in found if one[1] not in wanted | {"-"}]
            times = sorted(one[2] for one in right if one[2] is not None)
            before = sum(when <= 0 for when in times)
            late = f"{statistics.median(times):.1f} / {times[int(0.9 * (len(times) - 1))]:.1f}" if times else "-"
            print(f"| {title} | {share(len(right), len(found))} | {len(other)} | {before} | {late} |", flush=True)
            print(*(f"    {one}" for one in other), sep="\n", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
