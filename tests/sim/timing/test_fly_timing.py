"""Flights keep the bounds of the response-time analysis. Arguments: the plomada program, a scratch directory; then unittest's.

Alone: test_fly_timing.py PLOMADA SCRATCH --all flies every scenario with 200 seeds and prints the worst of each task.
"""
import functools
import json
import re
import subprocess
import sys
import unittest
from pathlib import Path

import check_trace

ROOT = Path(__file__).resolve().parents[3]

PROGRAM = sys.argv.pop(1)
SCRATCH = Path(sys.argv.pop(1))
RELEASES = ("FREE", "SCAN")
SEEDS = 200
TASK = re.compile(r"^Task (\S+) +(\d+) +([\d.]+) +([\d.-]+) +([\d.]+) +(\d+) +([\d.]+) +([\d.]+) +([\d.]+) +(\d+) +(\d+) ", re.M)
LATENCY = re.compile(r"release (\w+): (\d+), ([\d.]+) to ([\d.]+) ms, mean ([\d.]+), bound ([\d.]+)")


def plomada(*arguments):
    return subprocess.run([PROGRAM, *arguments], check=False, capture_output=True, text=True)


def rta(script, *arguments):
    return subprocess.run([sys.executable, "-B", str(ROOT / "tools/rta" / script), *arguments], check=False, capture_output=True, text=True).stdout


@functools.cache
def limits(scale):
    path = SCRATCH / f"limits-{scale}.csv"
    path.write_text(rta("limits.py", "--cost-scale", scale), encoding="ascii")
    return str(path)


def fly(scenario, *arguments, scale="1"):
    return plomada("fly", scenario, "--limits", limits(scale), "--cost-scale", scale, *arguments)


def scenarios():
    return [line for line in plomada("list").stdout.splitlines() if line and not line.startswith(" ")]


def rta_json(table):
    path = SCRATCH / "rta.json"
    rta("rta.py", table, "--json", str(path))
    return path.read_text(encoding="utf-8")


def growth():
    """How far all costs can grow, switches too."""
    return json.loads(rta_json("plomada-est"))["growth_with_switches"]


def latency(output, release):
    """answers, shortest, longest, mean, bound"""
    return next(tuple(map(float, figures)) for name, *figures in LATENCY.findall(output) if name == release)


def broken(output):
    return [line for line in output.splitlines() if line.startswith("BROKEN")]


class FlyTiming(unittest.TestCase):
    def test_200_seeds_keep_every_bound(self):
        names = scenarios()
        for seed in range(1, SEEDS + 1):
            release = RELEASES[seed // len(names) % 2]
            flight = (names[seed % len(names)], "--seed", str(seed), "--set", f"RELEASE={release}")
            output = fly(*flight).stdout
            self.assertEqual(broken(output), [], flight)
            self.assertEqual(len(TASK.findall(output)), 6, flight)

    def test_nothing_breaks_just_below_the_analysis_growth_factor(self):
        scale = 0.99 * growth()
        for seed in range(1, 13):
            for release in RELEASES:
                output = fly("pid-60cm-ramp", "--seed", str(seed), "--set", f"RELEASE={release}", scale=str(scale)).stdout
                self.assertEqual(broken(output), [], seed)

    def test_stretched_costs_stretch_what_is_observed(self):
        one, two = (TASK.findall(fly("pid-60cm-ramp", scale=scale).stdout) for scale in ("1", "2"))
        for (name, _, before, *_), (_, _, after, *_) in zip(one, two):
            self.assertGreater(float(after), 1.7 * float(before), name)

    def test_without_a_bound_a_word_is_printed_and_no_number(self):
        output = fly("pid-60cm-ramp", scale="8").stdout
        self.assertRegex(output, r"release FREE: .* bound none: the costs are beyond what can be scheduled")
        self.assertNotIn("9223372036854", output)

    def test_a_flight_that_misses_deadlines_fails_and_says_which(self):
        result = fly("pid-60cm-ramp", scale="32")
        self.assertEqual(result.returncode, 1)
        self.assertTrue(any("missed deadlines" in line for line in broken(result.stdout)))

    def test_without_timing_late_jobs_do_not_matter(self):
        self.assertNotIn("BROKEN", plomada("fly", "pid-60cm-ramp", "--cost-scale", "32").stdout)

    def test_a_met_flight_is_met_with_timing(self):
        for release in RELEASES:
            flight = ("pid-60cm-ramp", "--set", f"RELEASE={release}")
            self.assertEqual(fly(*flight).returncode, plomada("fly", *flight).returncode)

    def test_measuring_does_not_change_the_flight(self):
        flight = ("fly", "pid-60cm-ramp", "--seed", "7", "--csv")
        plomada(*flight, str(SCRATCH / "plain.csv"))
        plomada(*flight, str(SCRATCH / "measured.csv"), "--timing", "--trace", str(SCRATCH / "measured.json"))
        self.assertEqual((SCRATCH / "plain.csv").read_bytes(), (SCRATCH / "measured.csv").read_bytes())
        (SCRATCH / "measured.json").unlink()

    def test_released_by_scans_the_way_to_the_pulse_is_short(self):
        for law, release in (("PID", "SCAN"), ("EST", "FRAME")):
            output = fly("pid-60cm-ramp", "--set", "RELEASE=SCAN", "--set", f"LAW={law}").stdout
            answers, shortest, longest, mean, bound = latency(output, release)
            self.assertGreater(answers, 200)
            self.assertTrue(1.0 < shortest <= mean <= longest < 2.5 < bound < 5.5, output)

    def test_free_running_a_scan_waits_for_up_to_a_period(self):
        _, _, longest, mean, bound = latency(fly("pid-60cm-ramp", "--set", "RELEASE=FREE").stdout, "FREE")
        self.assertTrue(90.0 < longest < bound < 120.0)
        self.assertTrue(40.0 < mean < 65.0)

    def test_law_est_is_held_against_its_own_releases(self):
        output = fly("est-60cm-ramp").stdout
        name, jobs, response, bound, deadline, late, *_ = TASK.findall(output)[2]
        bounds = json.loads(rta_json("plomada-est"))["tasks"]
        self.assertEqual((name, float(deadline), int(late)), ("TaskControl", 25.0, 0))
        self.assertAlmostEqual(float(bound), next(row["response_ms"] for row in bounds if row["name"] == name), places=4)
        self.assertGreater(int(jobs), 1500)

    def test_a_flights_trace_is_right(self):
        path = SCRATCH / "flight.json"
        plomada("fly", "pid-60cm-ramp", "--seed", "3", "--trace", str(path))
        self.assertEqual(check_trace.complaints(path.read_text(encoding="utf-8"))[:20], [])
        path.unlink()

    def test_nonsense_is_refused(self):
        for arguments in (("--cost-scale", "0"), ("--cost-scale", "x"), ("--cost-scale", "101"), ("--cost-scale", "-1"),
                          ("--cost-scale", "nan"), ("--limits", "/nowhere"), ("--limits", str(ROOT / "README.md")), ("--trace", "/nowhere/trace.json")):
            self.assertEqual(plomada("fly", "pid-60cm-ramp", *arguments).returncode, 2, arguments)


def fly_all():
    worst, bad = {}, 0
    for scenario in scenarios():
        for seed in range(1, SEEDS + 1):
            release = RELEASES[seed % 2]
            output = fly(scenario, "--seed", str(seed), "--set", f"RELEASE={release}").stdout
            for line in broken(output):
                print(scenario, seed, release, line)
                bad += 1
            for name, _, response, bound, _, _, wait, inversion, allowed, waits, _ in TASK.findall(output):
                row = worst.setdefault(name, [bound, allowed, 0.0, 0.0, 0.0, 0])
                row[2:] = (max(row[2], float(response)), max(row[3], float(wait)), max(row[4], float(inversion)),
                           max(row[5], int(waits)))
            for release, _, shortest, longest, _, bound in LATENCY.findall(output):
                row = worst.setdefault(f"latency {release}", [bound, "", 0.0, 0.0, 0.0, 0])
                row[2] = max(row[2], float(longest))
    print(f"{'':18} {'bound':>9} {'response':>9} {'gate wait':>9} {'allowed':>9} {'inversion':>9} waits")
    for name, (bound, allowed, response, wait, inversion, waits) in worst.items():
        print(f"{name:18} {bound:>9} {response:9.4f} {wait:9.4f} {allowed:>9} {inversion:9.4f} {waits:5d}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(fly_all()) if sys.argv[1:] == ["--all"] else unittest.main()
