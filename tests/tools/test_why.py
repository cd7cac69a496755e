"""tools/why on flights of simulated vehicles. Usage: test_why.py PLOMADA"""
import contextlib
import dataclasses
import io
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")
sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools/why"), str(ROOT / "tools/fit")]
import flight  # noqa: E402
import numpy  # noqa: E402
import planted  # noqa: E402
import vehicle  # noqa: E402
import why  # noqa: E402
from causes import case as cases  # noqa: E402

PROGRAM = None
SEED = "test_why"


class Flights(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)

    def flown(self, cause, number=0, **changes):
        path = self.dir / f"{cause}-{number}.csv"
        self.assertTrue(planted.fly(PROGRAM, dataclasses.replace(planted.plan_of(cause, SEED, number), **changes), path))
        return path

    def plomada(self, *words):
        return subprocess.run([PROGRAM, "why", *map(str, words)], check=False, capture_output=True, text=True, cwd=self.dir)

    def refused(self, path, reason, out="no.png"):
        told = io.StringIO()
        with contextlib.redirect_stderr(told):
            status = why.main([str(path), "--out", str(self.dir / out), "--program", PROGRAM])
        self.assertEqual(status, 2)
        self.assertIn(reason, told.getvalue())
        self.assertFalse((self.dir / out).exists())

    def test_a_rope_and_a_lost_link_are_named_first(self):
        for cause in ("ropes", "link"):
            with self.subTest(cause):
                _, found = why.ask(self.flown(cause), PROGRAM)
                self.assertEqual(why.verdict(found)[:1], [cause])

    def test_of_a_healthy_flight_nothing_is_named(self):
        case, found = why.ask(self.flown("nothing"), PROGRAM)
        self.assertEqual(why.verdict(found), [])
        self.assertIn("Nothing found", why.sentences(case, found)[0])

    def test_the_columns_of_the_truth_are_not_looked_at(self):
        path = self.flown("axes", csv=True)
        lines = path.read_text(encoding="utf-8").splitlines()
        titles = lines[0].split(",")
        places = [titles.index(name) for name in ("height_m", "abs_m", "terrain_m")]
        wrong = self.dir / "untold.csv"
        rows = [lines[0]]
        for line in lines[1:]:
            cells = line.split(",")
            for place in places:
                cells[place] = "9.0"
            rows.append(",".join(cells))
        wrong.write_text("\n".join(rows) + "\n", encoding="utf-8")
        one, other = (flight.read(each, PROGRAM) for each in (path, wrong))
        self.assertEqual(set(one.column), {*flight.NEEDED, *flight.WORDS, "innov_m", "est_m"})
        for name in one.column:
            numpy.testing.assert_array_equal(one.column[name], other.column[name])

    def test_two_sentences_and_a_picture_come_of_a_saved_console(self):
        self.flown("vibration", csv=False)
        console = self.dir / "vibration-0.log"
        self.assertTrue(console.exists())
        done = self.plomada(console, "--out", self.dir / "shown.png")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("The accelerometer", done.stdout.splitlines()[0])
        self.assertIn("Balance the propellers", done.stdout.splitlines()[1])
        self.assertIn("vibration ...", done.stderr)
        self.assertEqual((self.dir / "shown.png").read_bytes()[:4], b"\x89PNG")

    def test_what_is_no_flight_is_refused_with_a_reason(self):
        self.refused(self.dir / "none.csv", "No such file")
        done = self.plomada(self.dir / "none.csv", "--out", self.dir / "no.png")
        self.assertEqual(done.returncode, 2)
        self.assertIn("No such file", done.stderr)
        text = self.dir / "text.csv"
        text.write_text("dear diary\n", encoding="utf-8")
        self.refused(text, "neither a flight CSV")
        telemetry = self.dir / "telemetry.txt"
        telemetry.write_text("alt:0.598 ref:0.600 laser:OK thr:7.12 state:FLYING flags:0\r\n" * 50, encoding="utf-8")
        self.refused(telemetry, "type #LOG after the flight")
        bench = self.dir / "bench.csv"
        bench.write_text("t_s,meas_m,est_m,innov_m,ref_m,thrust_n,roll_rad,pitch_rad,state,flags,up_mps2,pulse_us,age_s,doubt,limit\n"
                         + "".join(f"{0.025 * k:.3f},0.000,0.000,,0.000,0.000,0.0,0.0,GROUND,0,0.0,2000,0.07,,\n" for k in range(400)), encoding="utf-8")
        self.refused(bench, "no flight")

    def test_a_picture_that_cannot_be_written_is_status_2(self):
        path = self.dir / "any.csv"
        path.touch()
        self.refused(path, "any.csv", "any.csv/no.png")


class Likelihood(unittest.TestCase):
    """The filter and the regression, on data that are drawn from their own equations."""

    FIGURES = {name: median for name, (median, _) in vehicle.FIGURES.items()}

    def span(self, seed=1, seconds=12.0):
        rng = numpy.random.default_rng(seed)
        grid = numpy.arange(-1.0, seconds, vehicle.STEP_S)
        thrust = 7.0 + 0.6 * numpy.sin(2.0 * grid) + 0.4 * numpy.sign(numpy.sin(0.7 * grid))
        ray_s, frame_s = numpy.arange(0.0, seconds - 0.1, 0.1), numpy.arange(0.0, seconds - 0.1, 0.025)
        level = numpy.ones(len(grid))
        span = vehicle.Span(0.0, seconds, grid, thrust, level, 0.6 * level, ray_s, numpy.zeros(len(ray_s)), 0.03 * rng.standard_normal(len(ray_s)),
                            0.03 * rng.standard_normal(len(ray_s)), frame_s, numpy.zeros(len(frame_s)), grid, 0.0 * grid, 0.0 * grid)
        span.order()
        span.log_middle = 0.5 * seconds
        f = self.FIGURES
        steps = int(seconds / vehicle.STEP_S)
        keep = math.exp(-vehicle.STEP_S / f["turbulence_tau"])
        gust = numpy.zeros(len(grid))
        for k in range(len(grid) - steps, len(grid)):
            gust[k] = keep * gust[k - 1] + f["turbulence"] * math.sqrt(1.0 - keep**2) * rng.standard_normal()
        air = vehicle.model.ground_effect(span.height_m)
        push = 1.4 * vehicle.lagged(span, f) * air - vehicle.G + gust
        made = vehicle.response(span, push, f["damping"])
        noise = numpy.where(span.is_height, f["height_noise"], f["acc_noise"]) * rng.standard_normal(len(made))
        unsorted = numpy.empty_like(made)
        unsorted[span.sorted] = made + noise
        span.ray_m, span.up = unsorted[:len(ray_s)], unsorted[len(ray_s):]
        return span

    def test_what_the_equations_leave_is_white_and_of_one_standard_deviation(self):
        found = vehicle.model_of("THRUST", [self.span()], dict(self.FIGURES)).solve()
        self.assertAlmostEqual(float((found.rest**2).mean()), 1.0, delta=0.12)
        self.assertLess(abs(float((found.rest[1:] * found.rest[:-1]).mean())), 0.12)

    def test_a_batch_of_figures_gives_what_each_gives_alone(self):
        span = self.span()
        others = [dict(self.FIGURES, turbulence=value, damping=value * 10.0) for value in (0.15, 0.3)]
        together = vehicle.solve_together([vehicle.model_of("THRUST", [span], f) for f in others])
        for one, f in zip(together, others):
            self.assertAlmostEqual(one.evidence(), vehicle.model_of("THRUST", [span], f).solve().evidence(), places=6)

    def test_a_column_that_is_there_is_found_and_one_that_is_not_costs(self):
        span = self.span()
        span.ray_m = span.ray_m + 0.25 * span.roll

        def tilt(of):
            return lambda each, _f: each.merged(getattr(each, of)[:, None], numpy.zeros((len(each.frame_s), 1)))
        found = vehicle.model_of("THRUST", [span], dict(self.FIGURES)).solve()
        nats, size, spread = found.gain(tilt("roll"), 0.3)
        self.assertGreater(float(nats[0]), 10.0)
        self.assertLess(abs(float(size[0]) - 0.25), 3.0 * float(spread[0]))
        self.assertLess(float(found.gain(tilt("pitch"), 0.3)[0][0]), 0.5)

    def test_a_column_tried_alone_gains_what_the_model_with_it_gains(self):
        span = self.span()
        span.ray_m = span.ray_m + 0.1 * span.roll

        def tilt(each, _f):
            return each.merged(each.roll[:, None], numpy.zeros((len(each.frame_s), 1)))
        plain = vehicle.model_of("THRUST", [span], dict(self.FIGURES)).solve()
        wide = vehicle.model_of("THRUST", [span], dict(self.FIGURES), [tilt], [0.3]).solve()
        self.assertAlmostEqual(float(plain.gain(tilt, 0.3)[0][0]), wide.evidence() - plain.evidence(), delta=0.5)     # robust weights differ

    def test_a_figure_within_what_healthy_vehicles_have_speaks_against_a_cause(self):
        self.assertLess(cases.wider(0.0, 0.1, 0.3, 2.0), 0.0)
        self.assertGreater(cases.wider(2.0, 0.1, 0.3, 2.0), 10.0)
        self.assertAlmostEqual(cases.wider(2.0, 50.0, 0.3, 2.0), 0.0, places=1)     # not known: no news


class Reader(unittest.TestCase):
    def test_spans_in_the_air_end_where_rows_are_missing(self):
        t_s = numpy.concatenate((numpy.arange(0.0, 5.0, 0.025), numpy.arange(7.0, 12.0, 0.025)))
        count = len(t_s)
        column = {"t_s": t_s, "meas_m": numpy.full(count, 0.6), "state": numpy.array(["FLYING"] * count)}
        seen = flight.Flight("x", column, numpy.ones(count, bool), t_s - 0.07, numpy.ones(count, bool), 0.0, [])
        self.assertEqual(len(flight.spans_of(seen)), 2)


if __name__ == "__main__":
    PROGRAM = str(Path(sys.argv.pop(1)).resolve())
    unittest.main()
