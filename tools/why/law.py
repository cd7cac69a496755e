"""What the law did: its gains as the log shows them, and where it could not go on.

Every law gives, for small errors, a thrust that falls with the height's error and with the climb, around a thrust that moves
slowly (an integral, or what EST has learned). So the gains are found by least squares from the log alone, whoever set them. PIDT
lowers its gains while the loop swings, which hides what was set: this share is computed again from the log, as the firmware does it.
"""
from dataclasses import dataclass

import numpy

import flight as flights
from flight import flight_log

KNOT_S = 4.0                    # the slow thrust: straight lines between knots
SPEED_S = 0.05                  # half the time over which an estimate's speed is taken
CUT_N = 0.02                    # so near to its extreme the thrust is at a limit
PERIOD_S = 0.13                 # of the slowest law, 108 ms, and a row
LEAST = 60                      # rows
WITHIN_M = 0.15                 # the cascade is no straight line farther off
SWING_N, SWINGS_FREE, SWINGS_TIME_S, FAR_M = 0.8, 3.0, 10.0, 0.4    # control/laws/pidt.c
ROUNDS = 4                      # gains and PIDT's calming tell each other


@dataclass
class Law:
    estimator: bool             # the estimator flew it
    rows: int
    p_n_per_m: float            # 0 where it could not be found
    d_n_s_per_m: float
    sigma: tuple                # standard deviations of the logarithms of both
    fits: float                 # share of the thrust's motion that these gains explain
    at_most: float              # share of the rows at the greatest thrust of the flight, and at the least
    at_least: float
    range_n: tuple
    stays_s: list               # how long the thrust stayed at either, each time
    first_n: float              # thrust as the take-off begins; NaN: the log does not hold that
    begun_n: float              # slow thrust as the flight begins


def runs_at(values, extreme):
    return float(numpy.mean(numpy.abs(values - extreme) < CUT_N))


def stays_at(t_s, there):
    """A law that acts on a noisy slope leaves its limit for one period and comes back: that is one stay."""
    edges = numpy.flatnonzero(numpy.diff(numpy.concatenate(([0], there.astype(int), [0]))))
    stays = []
    for begin, end in ((t_s[a], t_s[min(b, len(t_s) - 1)]) for a, b in zip(edges[::2], edges[1::2])):
        if stays and begin - stays[-1][1] < PERIOD_S:
            stays[-1][1] = end
        else:
            stays.append([begin, end])
    return [float(end - begin) for begin, end in stays]


def of(flight):
    c, t_s = flight.column, flight.t_s
    flying = (c["state"] == "FLYING") & (c["ref_m"] > 0.0)
    estimator = bool(numpy.mean(~numpy.isnan(c["innov_m"][flying])) > 0.5) if flying.any() else True
    takeoff = numpy.flatnonzero(flights.takeoffs(flight) & (c["thrust_n"] > 0.5))
    first_n = float(c["thrust_n"][takeoff[0]]) if len(takeoff) else numpy.nan
    law = Law(estimator, int(flying.sum()), 0.0, 0.0, (9.0, 9.0), 0.0, 0.0, 0.0, (0.0, 0.0), [], first_n, numpy.nan)
    if law.rows < LEAST:
        return law
    thrust = c["thrust_n"][flying]
    law.range_n = float(thrust.min()), float(thrust.max())
    law.at_least, law.at_most = runs_at(thrust, thrust.min()), runs_at(thrust, thrust.max())
    law.stays_s = [stay for extreme in law.range_n for stay in stays_at(t_s, flying & (numpy.abs(c["thrust_n"] - extreme) < CUT_N))]
    height, speed, use = motion(flight, estimator)
    error = c["ref_m"] - height
    free = flying & use & (c["limit"] == "") & (c["doubt"] == "") & (numpy.abs(error) < WITHIN_M)
    free &= (c["thrust_n"] > law.range_n[0] + CUT_N) & (c["thrust_n"] < law.range_n[1] - CUT_N)
    if free.sum() < LEAST:
        return law
    knots = numpy.arange(t_s[flying][0], t_s[flying][-1] + KNOT_S, KNOT_S)
    slow = numpy.array([numpy.interp(t_s[free], knots, row) for row in numpy.eye(len(knots))]).T
    share = numpy.ones(len(t_s))
    for _ in range(1 if estimator else ROUNDS):
        design = numpy.column_stack([(share * error)[free], -(share * speed)[free], slow])
        ridge = 1e-3 * numpy.eye(design.shape[1])
        information = design.T @ design + ridge
        found = numpy.linalg.solve(information, design.T @ (c["thrust_n"][free]))
        if not estimator:
            share = pidt_calm(flight, flying, found[0] * numpy.clip(error, -FAR_M, FAR_M) - found[1] * speed)
    rest = c["thrust_n"][free] - design @ found
    moves = c["thrust_n"][free] - slow @ numpy.linalg.lstsq(slow, c["thrust_n"][free], rcond=None)[0]
    law.fits = 1.0 - float((rest**2).mean() / max((moves**2).mean(), 1e-12))
    law.p_n_per_m, law.d_n_s_per_m = float(found[0]), float(found[1])
    spread = numpy.sqrt(numpy.diag(numpy.linalg.inv(information))[:2] * (rest**2).mean() * 5.0)     # neighbours are alike
    law.sigma = tuple(spread / numpy.maximum(numpy.abs(found[:2]), 1e-3))
    law.begun_n = float(found[2])
    return law


def pidt_calm(flight, flying, action_n):
    """calm() of control/laws/pidt.c, of each row."""
    share, now, swings, peak, before = numpy.ones(len(action_n)), 1.0, 0.0, 0.0, None
    for k in numpy.flatnonzero(flying):
        if flight.new[k]:
            action, at = action_n[k], flight.rays_s[k]
            swings *= 1.0 - min((at - before) / SWINGS_TIME_S, 1.0) if before is not None else 1.0
            turned = action * peak < 0.0
            swings += 1.0 if turned and abs(peak) > SWING_N else 0.0
            peak = action if turned or abs(action) > abs(peak) else peak
            now, before = SWINGS_FREE / max(swings, SWINGS_FREE), at
        share[k] = now
    return share


def motion(flight, estimator):
    """Height and speed as the law saw them, and which rows tell both."""
    c, t_s = flight.column, flight.t_s
    if estimator:
        known = ~numpy.isnan(c["est_m"])
        height = flight_log.filled(t_s, c["est_m"])
        speed = (numpy.interp(t_s + SPEED_S, t_s, height) - numpy.interp(t_s - SPEED_S, t_s, height)) / (2.0 * SPEED_S)
        return height, speed, known
    at = numpy.flatnonzero(flight.new)
    slope = numpy.zeros(len(at))
    gap = numpy.diff(flight.rays_s[at])
    slope[1:] = numpy.diff(c["meas_m"][at]) / numpy.maximum(gap, 0.02)
    latest = numpy.clip(numpy.searchsorted(at, numpy.arange(len(t_s)), "right") - 1, 0, len(at) - 1)
    return c["meas_m"][at][latest], slope[latest], t_s - t_s[at][latest] < 0.12
