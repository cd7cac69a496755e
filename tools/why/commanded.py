"""What was set, told by the firmware itself: `plomada replay` gives its control what the log holds, and the settings are changed until
it commands what was commanded.

No equations of the laws are repeated here, so their limits, their calming and their integrals are those of the firmware. Newton's steps
with numerical slopes find the settings; what the log does not hold (the hover thrust that EST had learned before) is slow, and is left
to straight lines between knots.
"""
import csv
import io
import math
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy

import begun
import flight as flights

KNOT_S = 4.0                    # the slow thrust: straight lines between knots
SLOW_N = {True: 0.1, False: 0.01}       # rms of it: what EST learned from accelerations that a log has in part; of PIDT all is in the log, to a millimetre
# Of each law: (setting, delivered value, spread of its logarithm without news). Least and most: control/parameters.c.
GAINS = {True: {"VELK": (8.0, 0.6, 0.5, 12.0), "GAIN": (1.0, 0.3, 0.4, 2.5), "POSK": (2.3, 0.3, 0.25, 6.0)},
         False: {"PKP": (6.0, 0.8, 0.01, 50.0), "PKD": (2.6, 0.8, 0.01, 50.0), "PKI": (1.4, 0.8, 0.01, 50.0)}}
LAWS = {True: "EST", False: "PIDT"}
GRAV_N, GRAV_SPREAD_N = 7.0, 2.0
DIFFERENCE = -0.03              # of a logarithm, and of newtons; downwards, so that a setting at its most can be tried
REACH = 0.5                     # of one step
ROUNDS, ENOUGH = 8, 0.003
ALIKE = 5.0                     # neighbouring rows are alike: so many count as one
HUBER = 3.0
LEAST_N = 0.005                 # a log has thrusts to a millinewton, and heights to a millimetre
LEAST_ROWS = 60
COLUMNS = ("t_s", "meas_m", "ref_m", "thrust_n", "roll_rad", "pitch_rad", "up_mps2", "age_s")


@dataclass
class Settings:
    law: str
    value: dict                 # name: what was set, most likely
    sigma: dict                 # of the logarithm; GRAV: N
    fits: float                 # share of the thrust's motion that the firmware's law explains
    rest_n: float               # rms of the rest
    above_n: float              # so much more than was commanded the firmware commands again: EST has learned another hover thrust


def text_of(flight):
    """With each mirror's slant: the mean of three heights is known to less than the millimetre of a log, and the vote leaves one out."""
    column = {name: flight.column[name] for name in COLUMNS} | flight.beams
    rows = numpy.column_stack(list(column.values()))
    lines = [",".join("" if numpy.isnan(cell) else f"{cell:.4f}" for cell in row) for row in rows]
    return "\n".join([",".join(column), *lines]) + "\n"


class Replayed:
    """The firmware's control on one log."""

    def __init__(self, flight, program, path, estimator):
        self.flight, self.program, self.path, self.law = flight, program, path, LAWS[estimator]
        path.write_text(text_of(flight), encoding="utf-8")

    def thrust_n(self, settings):
        """(commanded thrust, whether it flew) of each row; None: the firmware does not take these settings."""
        words = [word for name, value in settings.items() for word in ("--set", f"{name}={value:.6g}")]
        done = subprocess.run([self.program, "replay", self.path, "--set", f"LAW={self.law}", *words], check=False, capture_output=True,
                              stdin=subprocess.DEVNULL, text=True)
        rows = list(csv.reader(io.StringIO(done.stdout)))
        if done.returncode != 0 or len(rows) != len(self.flight.t_s) + 1:
            return None
        thrust, state = rows[0].index("thrust_n"), rows[0].index("state")
        return numpy.array([float(row[thrust]) for row in rows[1:]]), numpy.array([row[state] == "FLYING" for row in rows[1:]])


def usable(flight):
    """Rows whose thrust is that of the law alone."""
    c = flight.column
    thrust = c["thrust_n"]
    flying = (c["state"] == "FLYING") & (c["ref_m"] > 0.0) & (c["limit"] == "") & (c["doubt"] == "")
    if not flying.any():
        return flying
    low, high = thrust[flying].min(), thrust[flying].max()
    return flying & (thrust > low + 0.02) & (thrust < high - 0.02)


def of(flight, program, law):
    """Settings; None: the log does not tell, or another law flew it, whose gains the thrusts tell better. Of a PIDT that flew before the
    log begins, the integral and the swings until then are not known; EST's own memory is short."""
    rows = usable(flight)
    if rows.sum() < LEAST_ROWS:
        return None
    if not law.estimator and numpy.isfinite(flights.commands_since(flight, flight.t_s[rows][0])):
        return None
    with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
        told = found(Replayed(flight, program, Path(scratch, "flight.csv"), law.estimator), rows, law)
    return told if told is not None and told.fits > law.fits else None


def found(replayed, rows, law):
    estimator = law.estimator
    flight = replayed.flight
    table = GAINS[estimator]
    names = [*table, "GRAV"]
    middle = numpy.array([*(math.log(of[0]) for of in table.values()), GRAV_N])
    spread = numpy.array([*(of[1] for of in table.values()), GRAV_SPREAD_N])
    first = begun.grav_n(flight, law) if estimator else None
    if first is not None:
        middle[-1], spread[-1] = first
    least = numpy.array([*(math.log(of[2]) for of in table.values()), 0.5])
    most = numpy.array([*(math.log(of[3]) for of in table.values()), 11.0])
    t_s = flight.t_s[rows]
    knots = numpy.arange(t_s[0], t_s[-1] + KNOT_S, KNOT_S)
    slow = numpy.array([numpy.interp(t_s, knots, row) for row in numpy.eye(len(knots))]).T
    wanted = flight.column["thrust_n"][rows]

    def commanded(place):
        settings = {name: value if name == "GRAV" else math.exp(value) for name, value in zip(names, place)}
        answer = replayed.thrust_n(settings)
        return None if answer is None else (answer[0][rows], answer[1][rows])

    def solved(place, answer, slopes):
        """One robust least-squares step from place: (step, its information, rms of what is left)."""
        rest, flew = wanted - answer[0], answer[1]
        design = numpy.hstack([slopes, slow])
        prior = numpy.concatenate([1.0 / spread**2, numpy.full(slow.shape[1], 1.0 / SLOW_N[estimator]**2)])
        pull = numpy.concatenate([(middle - place) / spread**2, numpy.zeros(slow.shape[1])])
        weight, step = flew.astype(float), numpy.zeros(design.shape[1])
        rms = max(float(numpy.median(numpy.abs(rest[flew] - numpy.median(rest[flew])))) / 0.674, LEAST_N)
        for _ in range(4):
            scaled = design * (weight / (rms**2 * ALIKE))[:, None]
            information = scaled.T @ design + numpy.diag(prior)
            step = numpy.linalg.solve(information, scaled.T @ rest + pull)
            left = rest - design @ step
            rms = max(float(numpy.median(numpy.abs(left[flew]))) / 0.674, LEAST_N)
            weight = flew * numpy.minimum(1.0, HUBER * rms / numpy.maximum(numpy.abs(left), 1e-9))
        return step[:len(place)], information, rms

    place, answer = middle.copy(), commanded(middle)
    for _ in range(ROUNDS):
        if answer is None or answer[1].sum() < LEAST_ROWS:
            return None
        near = [commanded(place + DIFFERENCE * one) for one in numpy.eye(len(place))]
        if any(each is None for each in near):
            return None
        slopes = numpy.array([(each[0] - answer[0]) / DIFFERENCE for each in near]).T
        step, information, rms = solved(place, answer, slopes)
        place = numpy.clip(place + step * min(1.0, REACH / max(float(numpy.abs(step).max()), 1e-9)), least, most)
        answer = commanded(place)
        if numpy.abs(step).max() < ENOUGH:
            break
    sigma = numpy.sqrt(numpy.diag(numpy.linalg.inv(information)))
    moves = wanted - slow @ numpy.linalg.lstsq(slow, wanted, rcond=None)[0]
    above_n = float(numpy.median(answer[0] - wanted))
    left = wanted - answer[0]
    left = left - slow @ numpy.linalg.lstsq(slow, left, rcond=None)[0]
    value = {name: float(at) if name == "GRAV" else math.exp(at) for name, at in zip(names, place)}
    return Settings(replayed.law, value, dict(zip(names, sigma.tolist())), 1.0 - float((left**2).mean() / max((moves**2).mean(), 1e-12)),
                    rms, above_n)
