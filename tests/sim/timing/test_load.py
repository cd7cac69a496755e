"""The simulated kernel and the response-time analysis are two models of one processor. Here each checks the other: a program that does nothing
but cost what a table says (load.c) runs on the kernel, and the analysis bounds the same table. Arguments: that program; then unittest's.
"""
import random
import re
import subprocess
import sys
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tools/rta"))
import analysis  # noqa: E402
import limits  # noqa: E402
import table as tables  # noqa: E402

PROGRAM = sys.argv.pop(1)
MS = analysis.PS_PER_MS
NS_PER_MS = 10 ** 6
TASK = re.compile(r"^Task (\S+) +(\d+) +([\d.]+) +(\S+) +([\d.]+) +(\d+) +([\d.]+) +([\d.]+) +([\d.]+) +(\d+) ", re.M)
# Of TaskIMU, TaskReceiveLaser, TaskControl, TaskSendLaser, TaskSendComm and TaskReceiveComm: which gates each enters, a bit for each.
# Annex IV's costs contain the accesses (0.0068 ms of TaskSendLaser cannot: it has none here).
ANNEX_GATES = (1, 3, 7, 0, 1, 4)
# Each task below shares a gate with one above, so that all the blockings that the analysis allows are possible.
CROWDED_GATES = (1, 3, 7, 2, 5, 6)
CROWDED_BLOCKINGS = (3, 4, 3, 2, 1, 0)      # lower tasks, or gates if there are fewer: one each at most


def ns(ps):
    return limits.nearest(ps / limits.PS_PER_NS)


def run(table, options, gates, run_ms, prices, bounds=None, offsets=None):
    """What the program printed. prices: (factor of the costs, factor of the switches, accesses are contained in the costs). bounds: the
    options of the analysis, where they are others."""
    factor, dearer, contained = prices
    lines = [f"{ns(options.access * factor)} {ns(options.switches * dearer)} {run_ms * NS_PER_MS}"]
    entered = dict(zip((row.name for row in analysis.tasks(table)), gates))
    for row in table:
        set_of = entered.get(row.name, 0)
        cost = row.cost - (bin(set_of).count("1") * options.access if contained else 0)
        assert cost >= 0
        lines.append(f"{row.kind} {row.name} {row.priority} {ns(row.period)} {ns(cost * factor)} {set_of} {(offsets or {}).get(row.name, 0)}")
    with tempfile.NamedTemporaryFile("w", encoding="ascii") as file:
        file.write("\n".join(limits.lines(table, bounds or options)) + "\n")
        file.flush()
        done = subprocess.run([PROGRAM, file.name], input="\n".join(lines), check=False, capture_output=True, text=True)
    if done.returncode == 2:
        raise AssertionError(done.stderr)
    return done.stdout


def broken(output):
    return [line for line in output.splitlines() if line.startswith("BROKEN")]


class Load(unittest.TestCase):
    def setUp(self):
        self.table = tables.load("seed")
        self.options = analysis.Options(switches=ns(0.057 * MS) * limits.PS_PER_NS, access=ns(0.0093 * MS) * limits.PS_PER_NS)

    def critical_instant(self, factor, switches_too, **options):
        return run(self.table, self.options, ANNEX_GATES, 700, (factor, factor if switches_too else 1, True), **options)

    def missed(self, factor, switches_too):
        return sum(int(late) for _, _, _, _, _, late, *_ in TASK.findall(self.critical_instant(factor, switches_too)))

    def breaking_factor(self, switches_too):
        holds, breaks = 4.0, 7.0
        self.assertEqual(self.missed(holds, switches_too), 0)
        self.assertGreater(self.missed(breaks, switches_too), 0)
        while breaks - holds > 0.002:
            middle = 0.5 * (holds + breaks)
            if self.missed(middle, switches_too):
                breaks = middle
            else:
                holds = middle
        return breaks

    def test_the_seeds_load_at_the_critical_instant_breaks_where_the_analysis_says(self):
        """The first factor is the 5.19 of docs/realtime.md."""
        for switches_too, factor in ((False, 5.1886), (True, 5.0953)):
            bound = analysis.growth(self.table, self.options, switches_too)[0]
            self.assertAlmostEqual(bound, factor, delta=1e-4)
            breaks = self.breaking_factor(switches_too)
            self.assertAlmostEqual(breaks, bound, delta=0.02 * bound)
            self.assertGreater(breaks, bound - 1e-4, "it breaks below the analysis' factor")

    def test_the_seeds_load_at_the_critical_instant_responds_as_the_analysis_says(self):
        """TaskReceiveComm, blocked by nobody, sees exactly the worst case; for the others nobody is in a gate at that instant."""
        output = self.critical_instant(1, False)
        self.assertEqual(broken(output), [])
        seen = {name: (float(response), float(bound)) for name, _, response, bound, *_ in TASK.findall(output)}
        self.assertEqual(seen["TaskReceiveComm"][0], 5.073)
        self.assertEqual(len(seen), 6)
        for row in analysis.tasks(self.table):
            response, bound = seen[row.name]
            self.assertLessEqual(response, bound, row.name)     # less blocking, fewer interrupts come between
            self.assertGreaterEqual(response, bound - 2 * analysis.blocking(row, self.options) / MS, row.name)

    def test_nothing_exceeds_the_analysis_whatever_the_phases(self):
        options = replace(self.options, access=3 * MS // 10)
        crowded = dict(zip((row.name for row in analysis.tasks(self.table)), zip(CROWDED_GATES, CROWDED_BLOCKINGS)))
        table = [replace(row, accesses=bin(crowded[row.name][0]).count("1"), blockings=crowded[row.name][1],
                         blocking=crowded[row.name][1] * options.access, period=row.period // 4, deadline=row.deadline // 4)
                 if row.name in crowded else row for row in self.table]
        dice, longest_inversion, most_waits = random.Random(20), 0.0, 0
        for phases in range(60):
            offsets = {row.name: dice.randrange(ns(row.period)) for row in table}
            output = run(table, options, CROWDED_GATES, 600, (1, 1, False), offsets=offsets)
            self.assertEqual(broken(output), [], phases)
            for found in TASK.findall(output):
                longest_inversion, most_waits = max(longest_inversion, float(found[7])), max(most_waits, int(found[9]))
        self.assertGreater(longest_inversion, 0.25)     # ms
        self.assertGreaterEqual(most_waits, 1)

    def test_a_bound_that_forgets_the_switches_is_exceeded(self):
        """A kernel that lost a context switch, or gates for nothing, would go unnoticed if the bounds were loose."""
        self.assertNotEqual(broken(self.critical_instant(1, False, bounds=replace(self.options, switches=0))), [])


if __name__ == "__main__":
    unittest.main()
