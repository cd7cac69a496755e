"""tools/plot/moving.py: the picture of the first page is what its flights give, and what is no flight is refused.

Usage: test_moving.py PLOMADA
"""
import re
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SVG = "{http://www.w3.org/2000/svg}"
OCTETS_MOST = 60_000    # a page that loads at once; chosen
ALIKE_PX = 12.5         # 0.1 m: a better law is another picture, another noise is none; chosen


class Moving(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def flight(self, scenario, *options):
        path = self.folder / f"{scenario}.csv"
        subprocess.run([PROGRAM, "fly", scenario, "--csv", str(path), *options], capture_output=True, check=False)
        return path

    @staticmethod
    def words(svg):
        return re.findall(r">([^<>\n]+)<", svg)

    @staticmethod
    def courses(svg):
        """The heights of each line, in pixels."""
        return [[float(point.split(",")[1]) for point in line.split()] for line in re.findall(r'polyline points="([^"]+)"', svg)]

    def draw(self, *words):
        return subprocess.run([sys.executable, "-B", ROOT / "tools/plot/moving.py", *words, "-o", self.folder / "out.svg"],
                              capture_output=True, text=True, check=False)

    def test_the_first_page_shows_what_make_fly_draws(self):
        recipe = (ROOT / "Makefile").read_text(encoding="utf-8")
        flights = re.search(r"^flights := (.*)$", recipe, re.MULTILINE).group(1).split()
        titles = re.findall(r'--title "([^"]+)"', re.search(r"^fly:(?:.*\n)(?:\t.*\n)+", recipe, re.MULTILINE).group(0))
        words = [str(self.flight(name)) for name in flights] + [word for title in titles for word in ("--title", title)]
        self.assertEqual(self.draw(*words).returncode, 0)
        drawn = (self.folder / "out.svg").read_text(encoding="utf-8")
        shown = (ROOT / "docs/images/flight.svg").read_text(encoding="utf-8")
        renew = "the page shows other flights: make fly; cp build/fly.svg docs/images/flight.svg"
        self.assertEqual(self.words(drawn), self.words(shown), renew)
        for there, here in zip(self.courses(drawn), self.courses(shown), strict=True):
            self.assertLess(abs(len(there) - len(here)), 10, renew)
            self.assertLess(max(abs(y - before) for y, before in zip(there, here)), ALIKE_PX, renew)
        self.assertIn("(docs/images/flight.svg)", (ROOT / "README.md").read_text(encoding="utf-8"))
        self.assertLess(len(drawn), OCTETS_MOST)

    def test_vehicle_beam_and_course_move_together_and_the_beam_ends_on_the_terrain(self):
        self.draw(str(self.flight("est-60cm-ramp")))
        root = ElementTree.parse(self.folder / "out.svg").getroot()
        moves = root.find(f".//{SVG}g/{SVG}animateTransform").get("values").split(";")
        lengths = root.find(f".//{SVG}g/{SVG}line/{SVG}animate").get("values").split(";")
        widths = root.find(f".//{SVG}clipPath/{SVG}rect/{SVG}animate").get("values").split(";")
        self.assertEqual(len(moves), len(lengths))
        self.assertEqual([move.split()[0] for move in moves], widths)
        terrain = root.find(f".//{SVG}polygon").get("points").split()
        for move, length, ground in zip(moves, lengths, terrain):
            self.assertAlmostEqual(float(move.split()[1]) + float(length), float(ground.split(",")[1]), delta=0.2)
        self.assertEqual(len({animation.get("dur") for animation in root.iter(f"{SVG}animate")}), 1)

    def test_what_is_no_flight_is_refused_in_a_line(self):
        never = self.flight("bench")
        (self.folder / "text").write_text("alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0\n" * 20, encoding="utf-8")
        for file in (never, self.folder / "text", self.folder / "none.csv"):
            done = self.draw(str(file))
            self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
            self.assertFalse((self.folder / "out.svg").exists())

    def test_a_picture_never_lies_over_the_flight_that_it_shows(self):
        flight = self.flight("est-60cm-ramp")
        before = flight.read_bytes()
        (self.folder / "a-link.svg").symlink_to(flight)
        for output in (flight, self.folder / "a-link.svg"):
            done = subprocess.run([sys.executable, "-B", ROOT / "tools/plot/moving.py", flight, "-o", output], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(f"{output}: is read here; another -o", done.stderr)
        self.assertEqual(flight.read_bytes(), before)


if __name__ == "__main__":
    PROGRAM = sys.argv.pop(1)
    unittest.main()
