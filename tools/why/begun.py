"""GRAV, as the beginning of a flight tells it: no integral has moved the thrust yet.

EST begins its take-off with a share of GRAV. The other laws give GRAV, what their gains make of the error and of the climb, and what an
integral has gathered since: three figures, found by least squares from the first heights. What was cut off by a limit tells nothing.
"""
import numpy

import flight as flights
from law import CUT_N, FAR_M

RELEASED, RAMP_N_PER_S = 0.68, 4.0      # of GRAV: where EST's take-off begins, and how fast it goes on (control/est/lift_off.c)
CYCLE_S, FIRST_S, FIRST_SIGMA_S = 0.025, 0.022, 0.006   # the ramp's first step: a frame of the IMU, or what a height left of it
EVEN = 12.0**0.5                # of an interval in which all is as likely: its width by the standard deviation
BEGINNING_S = 2.0
RATE_SHARE = 0.83               # of a new slope that PIDT's low pass takes in one scan: control/laws/pidt.c
APPROACH_MPS = 0.1              # from here on its integral rests, far from the reference: the same
INTEGRAL_PER_S = 0.23           # PKI by PKP, as delivered
GRAV_N, P_N_PER_M, D_N_S_PER_M = (7.0, 5.0), (6.0, 3.0), (2.6, 1.3)     # without news: middle, standard deviation
P_KNOWN = 0.1                   # the flight tells the gain within that share
NOISE_N = 0.03                  # a log has heights to a millimetre: of two, as a slope, times the gain
FAST_N_S_PER_M = 0.3            # a quick climb's slope is not that of its end: an eighth of the gain PKD
MODEL_N = 0.2                   # other laws than PIDT have no such integral


def grav_n(flight, law):
    """(GRAV, its standard deviation); None: the log has no beginning."""
    if not numpy.isfinite(law.first_n):
        return None
    if law.estimator:
        more_s = max(float(numpy.median(numpy.diff(flight.t_s))) - CYCLE_S, 0.0)    # somewhere within it the ramp began
        off_n, sigma_n = RAMP_N_PER_S * (FIRST_S + 0.5 * more_s), RAMP_N_PER_S * float(numpy.hypot(FIRST_SIGMA_S, more_s / EVEN))
        return (law.first_n - off_n) / RELEASED, sigma_n / RELEASED
    return by_least_squares(flight, law)


def by_least_squares(flight, law):
    c, t_s = flight.column, flight.t_s
    starts = flights.takeoffs(flight) & (c["thrust_n"] > 0.5)
    first = t_s[starts][0]
    early = flight.new & numpy.isin(c["state"], ("TAKEOFF", "FLYING")) & (t_s >= first) & (t_s < first + BEGINNING_S) & (c["ref_m"] > 0.0)
    at = numpy.flatnonzero(early)
    if len(at) < 2:
        return None
    error = (c["ref_m"] - c["meas_m"])[at]
    near = numpy.clip(error, -FAR_M, FAR_M)
    gap_s = numpy.diff(flight.rays_s[at])
    slope = numpy.diff(c["meas_m"][at]) / numpy.maximum(gap_s, 0.02)
    rate = numpy.zeros(len(at))
    for k in range(1, len(at)):
        rate[k] = rate[k - 1] + RATE_SHARE * (slope[k - 1] - rate[k - 1])
    arrives = (near != error) & (near * rate > FAR_M * APPROACH_MPS)
    gathered = INTEGRAL_PER_S * numpy.concatenate(([0.0], numpy.cumsum(numpy.where(arrives, 0.0, near)[1:] * gap_s)))
    thrust = c["thrust_n"][at]
    inside = (c["limit"][at] == "") & (c["doubt"][at] == "") & ~at_its_limit(thrust)
    design = numpy.column_stack([numpy.ones(len(at)), near + gathered, -rate])[inside]
    p = (law.p_n_per_m, P_KNOWN * law.p_n_per_m) if law.p_n_per_m > 0.0 else P_N_PER_M
    means, spreads = numpy.array([GRAV_N, p, D_N_S_PER_M]).T
    weight = 1.0 / (NOISE_N**2 + (FAST_N_S_PER_M * rate[inside])**2)
    information = design.T @ (weight[:, None] * design) + numpy.diag(spreads**-2.0)
    found = numpy.linalg.solve(information, design.T @ (weight * thrust[inside]) + means / spreads**2)
    return float(found[0]), float(numpy.hypot(numpy.sqrt(numpy.linalg.inv(information)[0, 0]), MODEL_N))


def at_its_limit(thrust_n):
    """Where the thrust rests at its greatest or its least, for more than one scan."""
    rests = numpy.zeros(len(thrust_n), bool)
    for extreme in (thrust_n.max(), thrust_n.min()):
        there = numpy.abs(thrust_n - extreme) < CUT_N
        rests |= there if there.sum() > 1 else False
    return rests
