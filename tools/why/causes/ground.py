"""Ground effect: more lift near the ground than a healthy vehicle has there.

Low over the ground the air pushes as much as this effect does. It is strongest as the vehicle lifts off. So this cause looks at more of
the flight than the others: from the instant at which the thrust must have carried the weight, to the last height before the touch-down.
That instant is another one for each strength of the effect, and from it on the vehicle rises from rest.
"""
from dataclasses import replace

import numpy

import flight as flights
import model as physics
import vehicle
from causes.case import Finding
from vehicle import G

NEAR_M = 0.02                   # heights below are those of the ground: noise of 5 mm, its slope, and the rays' age
TAKEOFF_S = 4.0                 # from the first thrust to a height of NEAR_M, at most
AT_REST = (0.01, 0.05)          # height and speed at the lift-off, rms: the ground's noise; what a tenth of a second of turbulence makes
STAYS_S = 0.05                  # the push upwards lasts
# Times that of Cheeseman and Bennett: 1 on a healthy vehicle, up to 4.4 with what a quadrotor's body gets (docs/why.md).
HEALTHY, SPREAD = 1.0, 0.4
FAULTY = (1.7, 2.16, 2.73, 3.47, 4.4)   # each factor as often as every other
MIDDLE, ROUNDS = FAULTY[2], 3   # the noises are found for one strength, from those of nothing
BETWEEN = 0.11                  # of the logarithm, rms: half of the way from one to the next, even


def effect_pushes(span):
    """m/s2, of one more time the ground effect."""
    ratio = physics.ROTOR_RADIUS_M / (4.0 * (numpy.maximum(span.height_m, 0.0) + physics.ROTOR_ABOVE_GEAR_M))
    return G * 2.0 * ratio**2 / (1.0 - 2.0 * ratio**2)**2 * span.upright


def effect_columns(span, f):
    return vehicle.response(span, effect_pushes(span), f["damping"])[:, None]


def takeoff_s(flight, span_begin_s):
    """When the thrust of this take-off began; None: the log has it not."""
    rows = numpy.flatnonzero(flights.takeoffs(flight) & (flight.t_s > span_begin_s - TAKEOFF_S) & (flight.t_s < span_begin_s))
    return float(flight.t_s[rows[0]]) if len(rows) else None


def pushes(span, model, times):
    """m/s2 on the grid, by the figures of a model and so many times the ground effect."""
    f = model.figures
    air = physics.ground_effect(span.height_m) * span.upright
    authority, rest = (model.linear_figure(name) for name in ("authority", "rest"))
    return (vehicle.lagged(span, f) * authority + rest) * air - G + (times - HEALTHY) * effect_pushes(span)


def lift_off_s(span, begun_s, model, times):
    up = (pushes(span, model, times) > 0.0) & (span.grid_s >= begun_s)
    stays = int(STAYS_S / vehicle.STEP_S)
    lasting = numpy.convolve(up, numpy.ones(stays), "full")[stays - 1:] >= stays - 0.5
    return float(span.grid_s[numpy.argmax(lasting)]) if lasting.any() else None


class Low:
    """The flight down to the ground."""

    def __init__(self, case):
        self.usual = case.model
        flight = case.flight
        found = flights.spans_of(flight, NEAR_M)
        self.spans, self.begun_s = [], []
        for begin, end in found:
            begun_s = takeoff_s(flight, begin)
            span = vehicle.changed(vehicle.span_of(flight, begin if begun_s is None else begun_s, end), case.age_s)
            if begun_s is not None:
                offs = [lift_off_s(span, begun_s, case.model, times) for times in (HEALTHY, *FAULTY)]
                begun_s = None if None in offs else begun_s
                span = vehicle.changed(vehicle.span_of(flight, begin if begun_s is None else max(offs), end), case.age_s)
            self.spans.append(span)
            self.begun_s.append(begun_s)

    def at(self, times):
        """The spans, with the lift-off of this strength."""
        found = []
        for span, begun_s in zip(self.spans, self.begun_s):
            free_s = None if begun_s is None else lift_off_s(span, begun_s, self.usual, times)
            found.append(span if free_s is None else replace(span, free_s=free_s, first=AT_REST))
        return found

    def model(self, times, figures):
        return vehicle.model_of("THRUST", self.at(times), figures, **of_strength(times, BETWEEN * times)).solve()

    def fit(self, times, sigma, figures):
        return vehicle.fit("THRUST", self.at(times), figures, rounds=ROUNDS, **of_strength(times, sigma))


def of_strength(times, sigma):
    return {"extra": [effect_columns], "sigmas": [sigma], "means": [times - HEALTHY]}


def ground(case):
    """As much beside the equations' own ground effect as a healthy vehicle does not have; the noises found anew for both."""
    if case.model.kind != "THRUST":
        return Finding(-2.0)
    low = Low(case)
    usual = low.fit(HEALTHY, SPREAD, case.model.figures)
    some = low.fit(MIDDLE, BETWEEN * MIDDLE, usual.figures)
    tried = {times: some if times == MIDDLE else low.model(times, some.figures) for times in FAULTY}
    evidence = numpy.array([model.evidence() for model in tried.values()])
    best = tried[FAULTY[int(numpy.argmax(evidence))]]
    mean = float(numpy.logaddexp.reduce(evidence) - numpy.log(len(FAULTY)))
    return Finding(some.score - some.evidence() + mean - usual.score, {"times": HEALTHY + float(best.linear[-1])}, best)
