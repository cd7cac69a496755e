"""Walls around the vehicle, from the scanner's rays between the mirrors to the lines on the radio.

test_walls.py PLOMADA. The firmware flies in places with walls. What the lines must say comes from the place, and from where the
vehicle truly is. Some seconds for each flight.
"""
import csv
import math
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz"
SENSOR_OUT_M, HALF_WIDTH_M = 0.115, 0.352
ROOM = "wall 3 -2 3 4 2.5\nwall -3 -1.5 3 -1.5 2.5\nwall -3 -2 -3 4 2.5\nwall -3 4 3 4 2.5\n"


def sectors(text):
    """mm, None for nothing, or "unseen", of each of the 72."""
    found, i = [], 0
    while i < len(text):
        if text[i] == "-":
            found += ["unseen"] * DIGITS.index(text[i + 1])
            i += 1
        else:
            found.append(None if text[i] == "." else 100 * 41 ** (DIGITS.index(text[i]) / 62))
        i += 1
    return found


class Flight:
    """Lines in the air, from the first state that is not GROUND to the next GROUND."""

    def __init__(self, place, *settings, seed=7, duration=26, walls="ON"):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            (folder / "a.place").write_text(place, encoding="utf-8")
            chosen = [word for setting in (f"WALLS={walls}", *settings) for word in ("--set", setting)]
            subprocess.run([PLOMADA, "fly", "est-60cm-ramp", "--place", folder / "a.place", "--seed", str(seed), "--duration", str(duration), *chosen,
                            "--radio", folder / "a.log", "--csv", folder / "a.csv"], stdout=subprocess.DEVNULL, check=False, timeout=120)
            log = (folder / "a.log").read_text(encoding="ascii", errors="replace").splitlines()
            with (folder / "a.csv").open(encoding="ascii") as rows:
                self.truth = list(csv.DictReader(rows))
        states = [line for line in log if line.startswith("alt:")]
        air = [i for i, line in enumerate(log) if line.startswith("alt:") and "state:GROUND" not in line]
        self.lines = log[air[0]:air[-1]]
        self.seconds = 0.2 * len([line for line in self.lines if line.startswith("alt:")])
        self.states = states

    def of(self, name):
        return [line for line in self.lines if line.startswith(name)]

    def near(self):
        return [tuple(int(n) for n in re.search(r"near:(\d+),(\d+),(\d+)", line).groups()) for line in self.of("w:") if "near:" in line]

    def drifts(self):
        return [[tuple(int(n) for n in wall.split(",")) for wall in line[6:].split("/")] for line in self.of("drift:") if line != "drift:-"]


class Walls(unittest.TestCase):
    def test_no_line_comes_that_was_not_asked_for(self):
        flight = Flight(ROOM, walls="OFF", duration=12)
        self.assertEqual(flight.of("w:") + flight.of("drift:"), [])

    def test_the_sectors_are_those_of_the_room(self):
        flight = Flight(ROOM)
        self.assertGreater(len(flight.of("w:")) / flight.seconds, 4.5)
        right_m, ahead_m = [], []
        for line in flight.of("w:")[::10]:
            told = sectors(line[2:].split(" ")[0])
            self.assertEqual(len(told), 72)
            self.assertEqual({i for i, sector in enumerate(told) if sector != "unseen"}, {*range(2, 16), *range(19, 34)})
            # to the right 1.5 m from the centre, ahead 3 m; the rest is for the sway of the vehicle
            if None not in (told[19], told[3]):  # near the ground a lean to that side sees the floor
                right_m.append(told[19] / 1000)
                ahead_m.append(told[3] / 1000)
        self.assertGreater(len(right_m), 0.9 * len(flight.of("w:")[::10]))
        self.assertTrue(all(abs(m - (1.5 - SENSOR_OUT_M)) < 0.5 for m in right_m), right_m)
        self.assertTrue(all(abs(m - 3.0 / math.cos(math.radians(17.5))) < 0.8 for m in ahead_m), ahead_m)

    def test_in_the_open_nothing_is_met_and_no_wall_tells_a_speed(self):
        flight = Flight("block 50 50 1 1 1\n", duration=14)
        for line in flight.of("w:"):
            self.assertRegex(line, r"^w:-2\.{14}-3\.{15}-c$")
        self.assertEqual(flight.drifts(), [])

    def test_it_warns_before_a_wall_that_it_flies_to_while_stopping_is_possible(self):
        for bearing, speed in ((0, 0.5), (0, 0.9), (40, 0.6), (80, 0.4)):
            x, y = math.cos(math.radians(bearing)), -math.sin(math.radians(bearing))
            wall = f"wall {4 * x - 4 * y:.3f} {4 * y + 4 * x:.3f} {4 * x + 4 * y:.3f} {4 * y - 4 * x:.3f} 2.5\n"
            flight = Flight(wall + f"go 15 {3.2 * x:.3f} {3.2 * y:.3f} {speed}\n")
            self.assertTrue(flight.near(), (bearing, speed))
            at, cm, _ = flight.near()[0]
            self.assertLess(abs((at - bearing + 180) % 360 - 180), 20, (bearing, speed))
            self.assertGreater(cm / 100 - HALF_WIDTH_M, speed * speed / (2 * 1.025), (bearing, speed))

    def test_along_a_wall_it_does_not_warn(self):
        for distance, speed in ((2.0, 0.5), (2.6, 0.9)):
            flight = Flight(f"wall -3 {-distance} 12 {-distance} 2.5\ngo 15 {8 * speed:.2f} 0 {speed}\n")
            self.assertEqual(flight.near(), [], (distance, speed))

    def test_a_wall_that_ends_beside_the_way_does_not_warn(self):
        flight = Flight("wall 5 -1.4 5 -5 2.5\ngo 15 3.4 0 0.6\n")
        self.assertTrue(flight.drifts())
        self.assertEqual(flight.near(), [])

    def test_lies_of_these_rays_warn_of_nothing_and_hide_no_wall(self):
        for lie in ("plant.around_garbage=0.1", "plant.around_lost=0.3", "plant.around_holder=150"):
            flight = Flight(ROOM.replace("-1.5", "-2.2"), lie)
            self.assertEqual(flight.near(), [], lie)
            right = [sectors(line[2:])[20] for line in flight.of("w:")]
            self.assertGreater(sum(sector is not None and abs(sector / 1000 - 2.1) < 0.5 for sector in right), 0.9 * len(right), lie)

    def test_a_holder_before_the_rays_is_told_as_something_near(self):
        flight = Flight(ROOM, "plant.around_holder=150", duration=14)
        self.assertTrue(all(sectors(line[2:])[9] < 200 for line in flight.of("w:")))

    def test_the_heights_are_those_of_a_flight_that_tells_no_walls(self):
        """Octet by octet: nothing that the firmware flies by waits for the line."""
        on, off = (Flight(ROOM, walls=walls, duration=14).truth for walls in ("ON", "OFF"))
        self.assertEqual([row["height_m"] for row in on], [row["height_m"] for row in off])


if __name__ == "__main__":
    PLOMADA = sys.argv.pop(1)
    unittest.main()
