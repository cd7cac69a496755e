"""test_belief_noise.py PLOMADA: the noises of control/sense/belief_world.c fit healthy flights, and their search finds a noise that was put in."""
import sys
import unittest
from pathlib import Path

import numpy
from scipy import stats

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tools/noise"))
sys.path.append(str(ROOT / "tools/campaign"))
import noise  # noqa: E402
import plan  # noqa: E402
import situations  # noqa: E402
import survey  # noqa: E402

PROGRAM = ""
SEED = 7  # not one of those that the noises were fitted on


def made(sigma_mm, scans=3000, seed=1):
    """Three mirrors over flat ground, each with a noise of its own, on a vehicle that goes up and down."""
    random = numpy.random.default_rng(seed)
    heights = 800.0 + 300.0 * numpy.sin(numpy.arange(scans) * 0.1)
    values = numpy.zeros((scans, 14), dtype=numpy.float32)
    values[:, 0] = 0.1
    for mirror in range(3):
        values[:, 5 + 3 * mirror] = 1.0
        values[:, 7 + 3 * mirror] = heights + random.normal(0.0, sigma_mm, scans)
        values[:, 6 + 3 * mirror] = values[:, 7 + 3 * mirror] + 205.0
    return values


class Noise(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.belief = noise.Belief()

    def test_healthy_flights_are_as_noisy_as_the_source_says(self):
        plan.extend({"laws": {"EST-THREE": {"scenario": "est-60cm-ramp", "settings": {"LAYOUT": "THREE"}}}})
        healthy = situations.load(situations.HEALTHY)
        planned = survey.planned(healthy, ["EST-THREE"], SEED, 1, False, ["draughts", "edges", "slopes", "stairs", "vehicle"])
        mirrors, values = noise.mirrors_of(PROGRAM), noise.values_of(PROGRAM)
        flights, on_ground = zip(*[noise.fly(PROGRAM, flight, i % 2 == 1, mirrors, values) for i, flight in enumerate(planned)], strict=True)
        self.assertGreater(sum(map(len, flights)), 2000)
        _, innovation = self.belief.likelihood(self.belief.start, flights)
        print(f"normalised innovation {innovation:.2f} of {len(flights)} flights, seed {SEED}")
        self.assertGreater(innovation, 0.8)
        self.assertLess(innovation, 1.2)
        strange, scale = numpy.concatenate(self.belief.strange_mps2).T
        calm = scale < 0.6
        for title, scans in (("calm", calm), ("thrust that changes", ~calm)):
            for percent in (50, 90, 99):
                found, expected = numpy.percentile(numpy.abs(strange / scale)[scans], percent), stats.t.ppf(0.5 + percent / 200, 3)
                print(f"the accelerometer beyond the thrust, {title}, {percent} %: {found:.2f} scales, {expected:.2f} expected")
                self.assertGreater(found, 0.5 * expected)
                self.assertLess(found, 1.5 * expected)

        rest = numpy.abs(numpy.concatenate(on_ground)) / self.belief.start[noise.NAMES.index("REST_MPS2")]
        self.assertGreater(len(rest), 100)
        for percent in (50, 90):    # its tail is thinner than that of flight: a Gaussian's
            found, expected = numpy.percentile(rest, percent), stats.t.ppf(0.5 + percent / 200, 3)
            print(f"the accelerometer on the ground, {percent} %: {found:.2f} scales, {expected:.2f} expected")
            self.assertGreater(found, 0.5 * expected)
            self.assertLess(found, 1.5 * expected)

    def test_what_is_expected_of_an_innovation_is_that_of_noise_and_small_steps_together(self):
        self.assertAlmostEqual(noise.expected_square([6.0, 0.0, *self.belief.start[2:]]), 1.0, delta=0.01)
        self.assertAlmostEqual(noise.expected_square([6.0, 1.0, 170.0, 1.0, 2.0, 0.0]), 2 * 2.0 ** 2 / 6.0 ** 2, delta=0.01)
        self.assertGreater(noise.expected_square(self.belief.start), 1.05)

    def test_what_the_accelerometer_tells_beyond_the_thrust_is_told_scan_by_scan(self):
        flights = [made(6.0, 40), made(6.0, 25, 2)]
        flights[0][:, 1], flights[0][:, 2] = 0.05, 0.02     # 0.5 m/s2 felt and 0.2 pushed, without a drag
        flights[1][:, 1:5] = 0.0, 0.0, 0.0, 0.24            # a drag of 2.4 1/s on a speed that the heights tell
        self.belief.likelihood(self.belief.start, flights)
        beyond, dragged = (told[:, 0] for told in self.belief.strange_mps2)
        self.assertEqual((len(beyond), len(dragged)), (40, 25))
        numpy.testing.assert_allclose(beyond, 0.3, atol=1e-5)
        self.assertGreater(numpy.abs(dragged).max(), 0.2)   # 0.3 m/s at most, less what the hover thrust is taken to be off by
        self.assertLess(numpy.abs(dragged).max(), 2.4 * 0.6)

    def test_a_noise_that_is_too_small_or_too_large_is_less_likely_and_shows(self):
        flights = [made(6.0)]
        likely = {}
        for sigma_mm in (3.0, 6.0, 12.0):
            likely[sigma_mm], innovation = self.belief.likelihood([sigma_mm, *self.belief.start[1:]], flights)
            expected = (6.0 / sigma_mm) ** 2
            if sigma_mm > 3.0:  # innovations beyond 4 sigmas are no part of it
                self.assertGreater(innovation, 0.9 * expected)
                self.assertLess(innovation, 1.6 * expected)  # the level of each mirror is known by its noise too
        self.assertGreater(likely[6.0], likely[3.0] + 0.1)
        self.assertGreater(likely[6.0], likely[12.0] + 0.1)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
