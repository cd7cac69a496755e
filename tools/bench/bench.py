#!/usr/bin/env python3
"""Instructions of each step of the firmware on x86-64 at -O2, counted by callgrind, against baseline.csv.

Usage: bench.py [--write] [--driver] [BUILD_DIRECTORY]
  --write   makes the counts the new baseline, and puts them where they are told: the costs of tools/rta/plomada-est.csv, docs/realtime.md,
            docs/reliability.md. What realtime.md prints by them then: tests/tools/rta/test_realtime_page.py PROGRAM --write
  --driver  only the scanner's driver

A count is the same on every run, so a change of it is a change of the code (or of the compiler or the C library: then the
ratios move together). Exit status 1 when a step has become more than a tenth dearer, or the scanner's driver is beyond its
limits; 77 when valgrind is not installed.
"""
import argparse
import csv
import re
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
BASELINE = HERE / "baseline.csv"
DEARER = 1.10
FRAME_N, THREE_N = 101, 309
# By the public calls, the loop included: a frame to its mean; and one of three mirrors, whose octets cost no more, to the scan.
LIMITS = {"scip_frame": 1300, "scip_frame_by_octet": 2300, "scip_three": 1300 * THREE_N // FRAME_N,
          "scip_three_by_octet": 2300 * THREE_N // FRAME_N}
# A cycle of law EST with a scan of one mirror, of three, and of three by TERRAIN IGNORE on a ramp: what it must cost at most, and what is aimed
# at. Told, and no failure yet: three are beyond both.
MUST = {name: (12000, 8000) for name in ("TaskControl_EST", "TaskControl_THREE", "TaskControl_IGNORE")}
MEMORY_LIMIT = 1024     # all that a user of the driver keeps, for 35 points


def build(directory):
    for command in (["cmake", "-S", HERE, "-B", directory], ["cmake", "--build", directory]):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(done.stdout + done.stderr)
    return directory / "steps"


def count(program, name):
    """Instructions inside measured(), without its own few."""
    done = subprocess.run(["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null",
                           "--toggle-collect=measured", program, name], capture_output=True, text=True)
    match = re.search(r"Collected : (\d+)", done.stderr)
    if done.returncode != 0 or match is None:
        sys.exit(f"bench: {name}: {done.stderr}")
    return int(match.group(1))


def read_baseline():
    with BASELINE.open(encoding="utf-8") as file:
        return {row["step"]: row for row in csv.DictReader(file)}


def write_baseline(baseline, counts):
    with BASELINE.open("w", encoding="utf-8") as file:
        file.write("step,instructions,annex_us\n")
        for name, instructions in counts.items():
            file.write(f"{name},{instructions},{baseline.get(name, {}).get('annex_us', '')}\n")


def grouped(count):
    return f"{count:,}".replace(",", " ")


def estimates_ms(counts):
    """What a cycle with a height of three mirrors costs, and one by TERRAIN IGNORE: the seed's law as measured, by the ratio of instructions."""
    seed_ms = float(read_baseline()["TaskControl"]["annex_us"]) / 1000
    return [seed_ms * counts[name] / counts["TaskControl"] for name in ("TaskControl_THREE", "TaskControl_IGNORE")]


def tell(counts, root=ROOT):
    """Puts them where they are told."""
    three_ms, ignore_ms = (f"{cost:.2f}" for cost in estimates_ms(counts))
    one, three, ignore = (grouped(counts[name]) for name in MUST)
    for path, pattern, told in (
            ("tools/rta/plomada-est.csv", r"(?m)(^TaskControl_height,task,\d+,\d+,\d+,)[\d.]+()", three_ms),
            ("docs/realtime.md", r"(ramp costs )[\d.]+( ms)", ignore_ms),
            ("docs/realtime.md", r"(TaskControl_height\.cost_ms=)[\d.]+()", ignore_ms),
            ("docs/reliability.md", r"(`make bench` counts )[\d ]+\d( on x86-64)", one),
            ("docs/reliability.md", r"(with one mirror, and )[\d ]+\d( with\s+three)", three),
            ("docs/reliability.md", r"(cycle is estimated to take )[\d.]+( ms)", three_ms),
            ("docs/reliability.md", r"(on a ramp it is )[\d ]+\d(: )", ignore),
            ("docs/reliability.md", r"(on a ramp it is [\d ]+\d: \w+, )[\d.]+( ms)", ignore_ms)):
        text = (root / path).read_text(encoding="utf-8")
        changed, places = re.subn(pattern, lambda match, told=told: match[1] + told + match[2], text)
        if places != 1:
            sys.exit(f"bench: {path}: {places} places for {pattern}")
        (root / path).write_text(changed, encoding="utf-8")


def show(baseline, counts):
    """Prints the table; returns {step: ratio}."""
    ratios = {}
    print(f"{'step':<22} {'instructions':>12} {'baseline':>9} {'ratio':>6} {'Annex IV C, us':>15}")
    for name, instructions in counts.items():
        row = baseline.get(name)
        before = int(row["instructions"]) if row else instructions
        ratios[name] = instructions / before
        line = f"{name:<22} {instructions:>12} {before:>9} {ratios[name]:>6.3f} {row['annex_us'] if row else '':>15}"
        print(line.rstrip())
    return ratios


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--driver", action="store_true")
    parser.add_argument("directory", nargs="?", type=Path, default=ROOT / "build/bench")
    options = parser.parse_args()
    if shutil.which("valgrind") is None:
        print("bench: no valgrind: tools/setup/setup.sh bench")
        sys.exit(77)
    program = build(options.directory)
    names = subprocess.run([program], check=True, capture_output=True, text=True).stdout.split()
    names = [name for name in names if name.startswith("scip_") or not options.driver]
    counts = {name: count(program, name) for name in names}
    memory = subprocess.run([program, "--memory"], check=True, capture_output=True, text=True).stdout
    baseline = read_baseline()
    if options.write and not options.driver:
        write_baseline(baseline, counts)
        tell(counts)
        baseline = read_baseline()
    ratios = show(baseline, counts)
    worst = max(ratios, key=ratios.get)
    octets = int(re.search(r": (\d+) octets", memory).group(1))
    print(f"\nworst change: {worst}, {(ratios[worst] - 1) * 100:+.1f} %")
    for name, limit in LIMITS.items():
        print(f"{name}: {counts[name]} instructions for {THREE_N if 'three' in name else FRAME_N} octets, at most {limit}")
    for name, (must, aim) in MUST.items() if not options.driver else ():
        told = "aim" if counts[name] <= aim else "must" if counts[name] <= must else "MISSED"
        print(f"{name}: {counts[name]} instructions in a cycle with a scan, at most {must}, aim {aim}: {told}")
    print(f"RAM of one driver: {memory.strip()}, at most {MEMORY_LIMIT}")
    sys.exit(ratios[worst] > DEARER or any(counts[name] > LIMITS[name] for name in LIMITS) or octets > MEMORY_LIMIT)


if __name__ == "__main__":
    main()
