#!/usr/bin/env python3
"""noise.py PLOMADA [--flights N] [--seed N] [--fit]: what the noises of control/sense/belief_world.c are worth on healthy flights.

Each situation of tools/campaign/healthy.toml but *hours* is flown by N drawn vehicles with LAYOUT THREE: half of them with noise that
the mirrors share, half with noise of each mirror's own. The belief's own C is asked, in the world in which no mirror lies, how likely
each scan is. Printed: the mean log likelihood of a scan, and the normalised innovation, that is the mean of the squared innovations over
what the belief expects of them (1 is a noise that is neither too small nor too large), for each row of situations and for all. With
--fit the noises are searched that make the flights likeliest, and stand beside those in the source.
"""
import argparse
import csv
import ctypes
import math
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy
from scipy.optimize import minimize
from scipy.stats import t as student

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tools/campaign"))
import fleet  # noqa: E402
import plan  # noqa: E402
import situations  # noqa: E402
import survey  # noqa: E402

OWN_NOISE = ("--set", "plant.mirror_noise=3", "--set", "plant.common_noise=0")
FITTED = {"BELIEF_NOISE_MM": (1, 15), "STEP_SHARE": (1e-3, 0.3), "STEP_MM": (50, 1000), "STEP_NEAR_SHARE": (0, 0.95),
          "STEP_NEAR_MM": (3, 80), "STEP_FAR_SHARE": (1e-4, 0.04), "MOTION_CHANGES": (0.005, 0.9), "SHARED_GAIN": (0.05, 1),
          "BELIEF_RATE_GAIN": (0.02, 1.5), "OWN_GAIN": (0.01, 1), "STRANGE_MPS2": (0.1, 5), "UNDELIVERED_SHARE": (0.01, 2), "REST_MPS2": (0.1, 5)}
MOTIONS = {"stands, share": (0.01, 0.8), "calm, share": (0.01, 0.8), "pushed, share": (0.01, 0.8), "calm, mm": (0.5, 6),
           "pushed, mm": (6, 300), "flies, mm": (2, 40)}
NAMES = list(FITTED)
DRAWN = 100_000
ON_GROUND_M = 0.01    # the ground carries it, whatever the thrust says
STANDS_M, STANDS_S = 0.001, 0.5     # it has stood there for several scans
SHARES = (50, 68, 95, 99)
FAR_MM = 4000.0     # STEP_FAR_PER_MM's
HARNESS = r"""
void noise_set(const float *p)
{
%(sets)s
    PER_MM = 0.39894228F / BELIEF_NOISE_MM;
    p += %(count)d;
    motions[3].share = 1.0F - motions[BELIEF_HELD].share - motions[BELIEF_FELT_LIES].share;
    for (int k = 0; k < 3; ++k) {
        motions[k].share = p[k];
        motions[3].share -= p[k];
        motions[k + 1].sigma_mm = p[3 + k];
    }
}

/* Log likelihood of one flight's scans: gap, gained, pushed, undelivered, dragged, then valid, slant, height of each mirror. told[0]: scans, [1]:
 * squared own innovations of mirrors without a step over their variance, [2]: their number. strange: for each scan, what the
 * accelerometer tells beyond the thrust, and how far it may. */
double noise_of(const float *v, long scans, double *told, float *strange)
{
    belief_t b = {.known = 0U};
    double sum = 0.0;
    start(&b);
    for (long i = 0; i < scans; ++i, v += 14) {
        belief_beam_t beams[MIRROR_COUNT];
        belief_scan_t scan = {.beams = beams, .gap_s = v[0], .motion = b.motion, .felt = {false, v[1], v[2], v[3], v[4]}};
        loosen(&b, v[0]);
        for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
            beams[m] = (belief_beam_t){v[5 + 3 * m] != 0.0F, v[6 + 3 * m], v[7 + 3 * m]};
            scan.told |= (beams[m].valid && belief_has(b.known, m) && v[0] <= HEIGHT_LOST_S) ? (uint16_t)(1U << m) : 0U;
        }
        belief_world_look(&scan, b.slant, b.height);
        belief_world_t foretold = b.worlds[0];
        ways_t ways = {.honest = scan.told};
        feel(&foretold, &ways, &scan);
        strange[2 * i] = ways.strange_mps2;
        strange[2 * i + 1] = scan.strange_mps2;
        predict(&foretold, &ways, &scan);
        float off[MIRROR_COUNT], mean = 0.0F;
        for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
            off[m] = beams[m].height_mm - foretold.level_mm[m];
            mean += off[m] / (float)MIRROR_COUNT;
        }
        if (scan.told == (1U << MIRROR_COUNT) - 1U && fabsf(off[0] - mean) < 4.0F * BELIEF_NOISE_MM &&
            fabsf(off[1] - mean) < 4.0F * BELIEF_NOISE_MM && fabsf(off[2] - mean) < 4.0F * BELIEF_NOISE_MM) {
            for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
                told[1] += (double)((off[m] - mean) * (off[m] - mean) / (BELIEF_NOISE_MM * BELIEF_NOISE_MM));
            }
            told[2] += MIRROR_COUNT - 1.0;
        }
        const float density = belief_world_scan(&b.worlds[0], &scan, 0U);
        if (scan.told != 0U) {
            sum += log(density > 1e-30F ? (double)density : 1e-30);
            told[0] += 1.0;
        }
        for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
            if (beams[m].valid && !belief_has(scan.told, m)) {
                meet(&b, m, beams[m].height_mm);
            }
            if (beams[m].valid) {
                keep_means(&b.slant[m], &b.height[m], &beams[m]);
            }
        }
    }
    return sum;
}
"""


def expected_square(values):
    """Of one mirror's innovation about the others', over its noise, as noise_of() sums it: what belief_world.c's own mixture gives. Among the
    innovations within four noises are small steps, which no scan tells from noise, so this is more than 1."""
    noise_mm, share, mm, near_share, near_mm, far_share = values[:6]
    random, size = numpy.random.default_rng(1), (DRAWN, 3)
    kind = random.random(size)
    step = numpy.where(kind < near_share, random.laplace(0.0, near_mm, size), random.laplace(0.0, mm, size))
    step = numpy.where(kind > 1.0 - far_share, random.uniform(-FAR_MM, FAR_MM, size), step)
    off = numpy.where(random.random(size) < share, step, random.normal(0.0, noise_mm, size))
    off -= off.mean(axis=1, keepdims=True)
    near = (numpy.abs(off) < 4.0 * noise_mm).all(axis=1)
    return (off[near] ** 2).sum() / (2 * near.sum() * noise_mm * noise_mm)


class Belief:
    """belief.c, belief_world.c and belief_density.h with the noises as variables."""

    def __init__(self):
        room = ROOT / "control/sense"
        density = (room / "belief_density.h").read_text(encoding="utf-8").partition("#include <math.h>\n")[2].rpartition("#endif")[0]
        source = ("#define CONTROL_SENSE_BELIEF_DENSITY_H\n#include <math.h>\n" + density +
                  "#include \"control/sense/belief_world.h\"\n#undef BELIEF_RATE_GAIN\n" +
                  "".join((room / name).read_text(encoding="utf-8") for name in ("belief_world.c", "belief.c")))
        header = (room / "belief_world.h").read_text(encoding="utf-8")
        self.start, text = [], source
        for name in FITTED:
            self.start.append(float(re.search(rf"#define {name} ([\d.e-]+)F", source + header)[1]))
            text = re.sub(rf"#define {name} .*\n", "", text)
        text = re.sub(r"#define PER_MM .*\n", "", text)
        rows = re.findall(r"^    \{([\d.]+)F, ([\d.]+)F\},", source, re.M)
        self.start += [float(row[0]) for row in rows[:3]] + [float(row[1]) for row in rows[1:4]]
        text = text.replace("static const struct {\n    float share", "static struct {\n    float share")
        variables = "static float " + ", ".join([*FITTED, "PER_MM"]) + ";\n"
        text = text.replace("#include <math.h>\n", "#include <math.h>\n" + variables, 1)
        sets = "\n".join(f"    {name} = p[{i}];" for i, name in enumerate(FITTED))
        with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
            Path(scratch, "belief.c").write_text(text + HARNESS % {"sets": sets, "count": len(FITTED)}, encoding="utf-8")
            library = Path(scratch, "belief.so")
            subprocess.run(["cc", "-O2", "-std=gnu99", "-shared", "-fPIC", f"-I{ROOT}", "-o", library, Path(scratch, "belief.c"), "-lm"],
                           check=True)
            self.library = ctypes.CDLL(str(library))
        self.library.noise_of.restype = ctypes.c_double

    def likelihood(self, values, flights):
        """Mean log likelihood of a scan, and the normalised innovation."""
        figures = numpy.asarray(values, dtype=numpy.float32)
        self.library.noise_set(figures.ctypes.data_as(ctypes.c_void_p))
        told = numpy.zeros(3)
        self.strange_mps2 = [numpy.zeros((len(scans), 2), dtype=numpy.float32) for scans in flights]
        total = sum(self.library.noise_of(scans.ctypes.data_as(ctypes.c_void_p), ctypes.c_long(len(scans)),
                                          told.ctypes.data_as(ctypes.c_void_p), strange.ctypes.data_as(ctypes.c_void_p))
                    for scans, strange in zip(flights, self.strange_mps2, strict=True))
        return total / told[0], told[1] / told[2] / expected_square(values)


def mirrors_of(program):
    """By default: column of the log, sensor to mirror, mirror to gear, arm, fore or aft, and how far its rays point to the fore of its axis."""
    words = [line.split() for line in subprocess.run([program, "params"], check=True, capture_output=True, text=True).stdout.splitlines()]
    mm = {row[0]: float(row[4]) for row in words if row[1:2] == ["mm"]}
    middle = {row[0]: float(row[4]) for row in words if row[1:2] == ["step"]}
    aside = (middle["SF"] - 384) * math.tau / 1024      # the others' rays stand square, by default
    side = mm["L"] - mm["DF"]
    return (("mf", mm["DF"], mm["LF"], mm["L"], 0.0, aside), ("m2", mm["D2"], mm["L2"], side, 1.0, 0.0), ("m1", mm["D1"], mm["L1"], side, -1.0, 0.0))


def values_of(program):
    """The parameters' values."""
    rows = (line.split() for line in subprocess.run([program, "params"], check=True, capture_output=True, text=True).stdout.splitlines())
    return {row[0]: float(row[4]) for row in rows if row[0] in ("GAIN", "GRAV", "DAMP", "LAG", "DELAY")}


def height_mm(slant_mm, mirror, roll_rad, pitch_rad):
    """control/altitude.h's equation."""
    _, distance, leg, arm, fore, aside = mirror
    return ((slant_mm - distance) * math.cos(pitch_rad) * math.cos(roll_rad) - arm * math.sin(roll_rad)
            - (fore * distance + aside * slant_mm) * math.sin(pitch_rad) - leg)


class Thrust:
    """What the thrust and the vehicle's model tell of the vertical speed: control/sense/push.c's equations."""

    def __init__(self, rows, values):
        self.authority = values["GAIN"] * 9.81 / values["GRAV"]     # m/s2 per N
        self.damping = values["DAMP"]
        self.lag_s = values["LAG"] + values["DELAY"]
        flown = [float(row["thrust_n"]) for row in rows if row["state"] == "FLYING"]
        self.hover_n = float(numpy.median(flown)) if flown else values["GRAV"]
        self.lagged_n = 0.0

    def pushed(self, row, dt_s):
        """In the time since the row before: change of the speed in m/s, the same by thrust that is not delivered yet, and the share of the speed that the
        drag takes."""
        self.lagged_n += dt_s / (self.lag_s + dt_s) * (float(row["thrust_n"]) - self.lagged_n)
        if row["state"] in ("GROUND", "ARMED") or float(row["height_m"]) < ON_GROUND_M:
            return 0.0, 0.0, 0.0
        upright = math.cos(float(row["roll_rad"])) * math.cos(float(row["pitch_rad"]))
        undelivered_n = abs(float(row["thrust_n"]) - self.lagged_n) * upright
        return self.authority * (self.lagged_n * upright - self.hover_n) * dt_s, self.authority * undelivered_n * dt_s, self.damping * dt_s


class Motion:
    """A change of the speed, as control/sense/mirrors.c holds it against the rays' time."""

    def __init__(self):
        self.gained = self.left = 0.0

    def shown(self, late):
        shown, self.left, self.gained = (1 - late) * self.gained + self.left, late * self.gained, 0.0
        return shown


def bias_mps2(rows):
    """Of the accelerometer, at rest before the take-off."""
    rest = []
    for row in rows:
        if row["state"] not in ("GROUND", "ARMED"):
            break
        rest += [float(row["up_mps2"])] if row["up_mps2"] else []
    return float(numpy.mean(rest)) if rest else 0.0


def scans_of(path, mirrors, values):
    """The scans of a flight's CSV, as noise_of() takes them, from the take-off on; and what the accelerometer tells on the ground, a scan each."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    scans, rest_mps2, scan_s, frame_s, row_s, flown, grounded_s = [], [], None, None, 0.0, False, 0.0
    thrust, felt, pushed, undelivered, dragged, bias = Thrust(rows, values), Motion(), Motion(), Motion(), Motion(), bias_mps2(rows)
    for row in rows:
        now_s = float(row["t_s"])
        by_thrust, to_come, by_drag = thrust.pushed(row, now_s - row_s)
        pushed.gained += by_thrust
        undelivered.gained += to_come
        dragged.gained += by_drag
        grounded_s = grounded_s + now_s - row_s if float(row["height_m"]) < STANDS_M else 0.0
        row_s = now_s
        if row["up_mps2"]:
            felt.gained += (float(row["up_mps2"]) - bias) * (now_s - frame_s if frame_s is not None else 0.0)
            frame_s = now_s
        if not row["mf_rays"]:
            continue
        flown = flown or row["state"] not in ("GROUND", "ARMED")
        gap_s = now_s - scan_s if scan_s is not None else 1e3
        scan_s = now_s
        late = min(float(row["age_s"]) / gap_s, 1.0)
        scan = [gap_s, felt.shown(late), pushed.shown(late), undelivered.shown(late), dragged.shown(late)]
        for mirror in mirrors:
            slant = row[mirror[0] + "_mm"]
            scan += ([1.0, float(slant), height_mm(float(slant), mirror, float(row["roll_rad"]), float(row["pitch_rad"]))]
                     if slant else [0.0, 0.0, 0.0])
        if flown:
            scans.append(scan)
        if grounded_s > STANDS_S and gap_s < STANDS_S:
            rest_mps2.append(scan[1] / gap_s)
    return numpy.ascontiguousarray(scans, dtype=numpy.float32).reshape(-1, 14), rest_mps2


def fly(program, planned, own, mirrors, values):
    """The scans of one flight."""
    with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
        path = Path(scratch, "flight.csv")
        fleet.fly(program, [*planned.flight.words, *(OWN_NOISE if own else ()), "--csv", str(path)], planned.flight.text)
        return scans_of(path, mirrors, values)


def fit(belief, flights):
    """The noises under which the flights are likeliest."""
    bounds = [*FITTED.values(), *MOTIONS.values()]

    def clipped(logs):
        return [min(max(math.exp(value), low), high) for value, (low, high) in zip(logs, bounds)]

    def cost(logs):
        values = clipped(logs)
        near, far = values[3], values[5]
        return 1e3 if sum(values[len(FITTED):len(FITTED) + 3]) > 0.99 or near + far > 0.99 else -belief.likelihood(values, flights)[0]

    best = numpy.log(belief.start)
    for turn in range(3):
        best = minimize(cost, best, method="Nelder-Mead", options={"maxfev": 350, "adaptive": True}).x
        print(f"turn {turn + 1} of 3: {-cost(best):.3f}", file=sys.stderr)
    return clipped(best)


def percentiles(values):
    """Of sorted ones."""
    return ", ".join(f"{share:g} % {values[int(share / 100 * (len(values) - 1))]:.2f}" for share in SHARES)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--flights", type=int, default=4, help="of each situation (default 4)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--fit", action="store_true")
    options = parser.parse_args()
    if not os.access(options.program, os.X_OK) or not Path(options.program).is_file():
        parser.error(f"{options.program}: no program; make build")

    plan.extend({"laws": {"EST-THREE": {"scenario": "est-60cm-ramp", "settings": {"LAYOUT": "THREE"}}}})
    healthy = situations.load(situations.HEALTHY)
    rows = [row for row in healthy.rows() if row != "hours"]
    planned = survey.planned(healthy, ["EST-THREE"], options.seed, options.flights, False, rows)
    mirrors, values = mirrors_of(options.program), values_of(options.program)
    with ThreadPoolExecutor() as pool:
        told = list(pool.map(lambda job: fly(options.program, job[1], job[0] % 2 == 1, mirrors, values), enumerate(planned)))
    flown = [scans for scans, _ in told]
    belief = Belief()
    for row in rows:
        of_row = [scans for one, scans in zip(planned, flown, strict=True) if one.situation.row == row and len(scans)]
        print(f"{row:18} normalised innovation {belief.likelihood(belief.start, of_row)[1]:.2f}")
    flights = [scans for scans in flown if len(scans)]
    likelihood, innovation = belief.likelihood(belief.start, flights)
    print(f"{len(flights)} flights, {sum(map(len, flights))} scans: log likelihood {likelihood:.3f} a scan, "
          f"normalised innovation {innovation:.2f}")
    strange = numpy.concatenate(belief.strange_mps2)
    scales = numpy.sort(numpy.abs(strange[:, 0] / strange[:, 1]))
    print(f"the accelerometer beyond the thrust, over its scale: {percentiles(scales)}; Student's t: "
          + ", ".join(f"{student.ppf(0.5 + 0.005 * share, 3):.2f}" for share in SHARES))
    for low, high in ((0.0, 0.7), (0.7, 1.0), (1.0, 1.5), (1.5, 9.0)):
        of_scale = strange[(strange[:, 1] >= low) & (strange[:, 1] < high)]
        if len(of_scale):
            print(f"  scale {low:.1f} to {high:.1f} m/s2, {len(of_scale):6} scans: {percentiles(numpy.sort(numpy.abs(of_scale[:, 0])))} m/s2")
    rest = numpy.sort(numpy.abs(numpy.concatenate([rest_mps2 for _, rest_mps2 in told]))) / belief.start[NAMES.index("REST_MPS2")]
    print(f"the accelerometer on the ground, {len(rest)} scans, over its scale: {percentiles(rest)}")
    if options.fit:
        found = fit(belief, flights)
        likelihood, innovation = belief.likelihood(found, flights)
        print(f"fitted: log likelihood {likelihood:.3f} a scan, normalised innovation {innovation:.2f}")
        for name, used, value in zip([*FITTED, *MOTIONS], belief.start, found):
            print(f"{name:16} {used:9.4g} {value:9.4g}")


if __name__ == "__main__":
    main()
