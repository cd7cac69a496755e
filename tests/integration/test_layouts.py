"""test_layouts.py PROGRAM...: each LAYOUT flies as FRONT does at the same bit rate.

The programs are named fly_RATE; each flies est-60cm-ramp with the same seeds and every layout, over a ground that rises and falls
under all mirrors at once. A layout whose rays were given another instant than they had shows at the edges: tens of millimetres
more of overshoot. Rays that are longer on their way (75 ms FRONT, up to 94 ms others) leave the vehicle at the old height for
longer: a few millimetres of the terrain's RMS.
"""
import hashlib
import json
import re
import statistics
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

# TWO on the bracket of two beams (sim/devices/bracket.c): its steps, and its mirrors 197 mm abeam, which is L - DF.
SETTINGS = {"FRONT": ("LAYOUT=FRONT",), "TWO": ("LAYOUT=TWO", "S1=263", "S2=505", "SW=14", "L=302"),
            "THREE": ("LAYOUT=THREE",)}
SCENARIO, SEEDS = "est-60cm-ramp", range(1, 9)
# The ground below every mirror rises at 7.3 s and falls at 11 s, at once. Over the ramp of the scenario's own course the
# mirrors see it one after the other, and the mean of their spots is no height of any: that is not a matter of instants.
COURSE = f"like {SCENARIO}\nname layouts\nplace foot 0 0 90 90 0.25 7.3 3.7\n"
BOUNDS = {"hover_rms_mm": 2.0, "terrain_rms_mm": 6.0, "overshoot_mm": 10.0, "undershoot_mm": 10.0, "recovery_s": 0.1}
PROGRAMS = []


def fly(program, layout, seed, scratch):
    csv, figures = scratch / "x.csv", scratch / "x.json"
    course = scratch / "x.scenario"
    course.write_text(COURSE, encoding="utf-8")
    done = subprocess.run([program, course, "--seed", str(seed), "--csv", csv, "--json", figures,
                           *(word for setting in SETTINGS[layout] for word in ("--set", setting))],
                          capture_output=True, text=True, check=False, timeout=120)
    if done.returncode not in (0, 1):
        raise AssertionError(f"{program} {SCENARIO} --seed {seed}: {done.stdout}{done.stderr}")
    return json.loads(figures.read_text(encoding="utf-8")), hashlib.sha256(csv.read_bytes()).hexdigest()


class Layouts(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.mean, cls.flown = {}, {}
        with tempfile.TemporaryDirectory() as scratch:
            for program in PROGRAMS:
                rate = re.fullmatch(r"fly_(\d+)", Path(program).name).group(1)
                for layout in SETTINGS:
                    flights = [fly(program, layout, seed, Path(scratch)) for seed in SEEDS]
                    cls.flown[layout, rate] = tuple(name for _, name in flights)
                    cls.mean[layout, rate] = {key: statistics.fmean(figures[key] for figures, _ in flights) for key in BOUNDS}
                    print(f"{layout:6} {rate:>6}", *(f"{key} {value:.2f}" for key, value in cls.mean[layout, rate].items()))

    def test_every_layout_and_rate_flies_in_its_own_way(self):
        self.assertEqual(len(set(self.flown.values())), len(PROGRAMS) * len(SETTINGS))

    def test_each_layout_flies_as_front_does(self):
        for (layout, rate), figures in self.mean.items():
            for key, bound in BOUNDS.items():
                with self.subTest(layout=layout, rate=rate, figure=key):
                    self.assertAlmostEqual(figures[key], self.mean["FRONT", rate][key], delta=bound)


if __name__ == "__main__":
    PROGRAMS = sys.argv[1:]
    unittest.main(argv=sys.argv[:1], verbosity=2)
