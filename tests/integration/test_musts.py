"""What law EST must keep (tools/campaign/musts.toml), on drawn flights.

Usage: test_musts.py PLOMADA short    each situation is flown once by each of its laws, and each must can be missed; no rate
       test_musts.py PLOMADA soak     all of it, drawn anew: no must is MISSED. An hour or more
"""
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tools/campaign"))
import musts  # noqa: E402
import plan  # noqa: E402
import rate  # noqa: E402
import situations  # noqa: E402

PROGRAM = ""
GOOD = {"started": True, "halted": False, "highest_mm": 100.0, "touch_speed_mps": 0.3, "off_aloft": 0, "down_s": 4.0, "sight_doubts": 0,
        "imu_doubts": 0, "thrust_doubts": 0, "ground_contacts": 0, "altitude_error_mm": 40.0, "recovery_s": 0.4, "settled_s": 0.4, "aloft_s": 20.0}
BAD = {"doubted": {"imu_doubts": 1}, "contacts": {"ground_contacts": 1}, "harmed": {"touch_speed_mps": 1.3}, "flew away": {"highest_mm": 2001.0}}


class Soak(unittest.TestCase):
    def test_no_must_is_missed(self):
        with tempfile.TemporaryDirectory() as out:
            self.assertEqual(musts.main(["--seed", str(1 + rate.drawn_seed()), "--program", PROGRAM, "--out", out]), 0)


class Short(unittest.TestCase):
    def test_each_situation_flies_once_by_each_of_its_laws(self):
        with tempfile.TemporaryDirectory() as out:
            self.assertIn(musts.main(["--share", "0.0001", "--program", PROGRAM, "--out", out]), (0, 1))
            flown = (Path(out) / "flights.jsonl").read_text(encoding="utf-8")
        wanted = {f'"{one.slug}/1/{law}"' for one in musts.load()[1].situations.values() for law in one.laws}
        self.assertEqual({name for name in wanted if name in flown}, wanted)
        self.assertNotIn('"halted": true', flown)

    def test_each_must_can_be_kept_and_missed(self):
        for must in musts.load()[0].values():
            self.assertFalse(must.missed(GOOD), must.name)
            for title in must.counts:
                self.assertTrue(must.missed(GOOD | BAD[title]), must.name)
            if must.figure:
                self.assertFalse(must.missed(GOOD | {must.figure: must.most}), must.name)
                self.assertTrue(must.missed(GOOD | {must.figure: 1.001 * must.most}), must.name)
                self.assertTrue(must.missed(GOOD | {must.figure: None}), must.name)

    def test_a_vehicle_that_stays_on_the_ground_has_struck_nothing(self):
        self.assertFalse(musts.load()[0]["farther"].missed(GOOD | {"touch_speed_mps": None, "aloft_s": 0.0}))

    def test_a_verdict_tells_what_the_bounds_tell(self):
        none, some = musts.load()[0]["unharmed"], musts.load()[0]["all"]
        self.assertEqual([musts.told(none, 0, 300), musts.told(none, 1, 300)], [musts.KEPT, rate.MISSED])
        self.assertEqual([musts.told(some, count, 200) for count in (10, 24, 40)], [rate.SHOWN, rate.OPEN, rate.MISSED])

    def test_half_of_the_uneven_flights_has_noise_of_each_mirrors_own(self):
        found, of_table = musts.load()
        flights = [one for one in musts.planned(found, of_table, ["healthy"], 0.1, 1) if one.law == "EST"]
        own = ["\nset plant.mirror_noise 3\n" in one.flight.text for one in flights]
        self.assertEqual((len(own), sum(own)), (30, 15))

    def test_what_is_wrong_in_the_table_is_told(self):
        for text in ('must.a = {says = "", share = 0, flights = 1}\nbase = {}\none = {of = "b"}',
                     'must.a = {says = "", share = 0, flights = 1}\nbase = {}\none = {of = "a", sett = {}}'):
            with self.assertRaises(situations.Wrong):
                musts.load(text)


if __name__ == "__main__":
    PROGRAM, mode = sys.argv[1:]
    if "EST-FRONT" not in plan.LAWS:
        plan.extend(musts.front())
    suite = unittest.defaultTestLoader.loadTestsFromTestCase({"soak": Soak, "short": Short}[mode])
    sys.exit(not unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful())
