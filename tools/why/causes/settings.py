"""What was set: gains, the thrust GRAV, the window of the thrust."""
import numpy

from causes.case import Finding, wider

# Of delivered gains on a vehicle whose throttle has the effect that its hover thrust tells: acceleration per metre and per metre per
# second, as the log shows it (the cascade acts on more than what is logged).
USUAL = {True: (14.5, 3.5), False: (8.0, 3.2)}
SPREAD, FAULTY = 0.30, 1.0      # logarithms: healthy vehicles' own effect and damping vary by a fifth
TRIM_N, TRIM_FAULTY_N, TRIM_KNOWN_N = 0.5, 2.0, 0.3
RELEASED = 0.68                 # of GRAV: where EST's take-off begins, docs/control.md
NEAR_M = 0.4                    # PIDT counts an error as that at most
NARROW_N = 2.0                  # the seed's window is GRAV + 1 N
STUCK = 0.12                    # share of a flight at its greatest or least thrust
STUCK_HEALTHY, STUCK_FAULTY = 0.04, 0.35
REFUSED_S, REFUSED_FLAG = 3.0, 128


def gains(case):
    """(how much hotter than usual, in logarithms; its standard deviation). None: not known."""
    law = case.law
    if law.p_n_per_m <= 0.0 and law.d_n_s_per_m <= 0.0 or case.model is None or case.model.kind != "THRUST" or law.fits < 0.2:
        return None
    b = case.model.linear_figure("authority")
    p, d = (max(b * value, 0.05 * usual) / usual for value, usual in zip((law.p_n_per_m, law.d_n_s_per_m), USUAL[law.estimator]))
    known = [(numpy.log(p), max(law.sigma[0], 0.1)), (numpy.log(d), max(law.sigma[1], 0.1))]
    weight = [1.0 / (SPREAD**2 + sigma**2) for _, sigma in known]
    return sum(w * value for w, (value, _) in zip(weight, known)) / sum(weight), 1.0 / numpy.sqrt(sum(weight)), p, d


def heat(case, sign):
    found = gains(case)
    if found is None:
        return Finding(-1.0)
    value, spread, p, d = found
    nats = wider(value, 0.5 * spread, 0.5 * SPREAD, FAULTY) if sign * value > 0.0 else -3.0
    return Finding(nats, {"times": float(numpy.exp(value)), "p": p, "d": d})


def hot(case):
    return heat(case, 1.0)


def cold(case):
    return heat(case, -1.0)


def saturation(case):
    """The thrust is at one of its limits for much of the flight, and stays between two that are near."""
    law = case.law
    share = law.at_most + law.at_least
    if law.range_n[1] - law.range_n[0] > NARROW_N:      # a law that swings reaches the limits of any window
        return Finding(-3.0)
    nats = wider(max(share - STUCK_HEALTHY, 0.0), 0.02, STUCK_HEALTHY, STUCK_FAULTY) if share > STUCK else -3.0
    return Finding(nats * min(law.rows / 100.0, 5.0) if nats > 0.0 else nats,
                   {"percent": 100.0 * share, "range": law.range_n, "width": law.range_n[1] - law.range_n[0]})


def set_grav_n(case):
    """(GRAV, its standard deviation), as the beginning of the flight tells it."""
    law, c = case.law, case.flight.column
    if not numpy.isfinite(law.first_n):
        return None
    if law.estimator:
        return law.first_n / RELEASED, TRIM_KNOWN_N
    near_m = min(float(c["ref_m"][numpy.flatnonzero(c["ref_m"] > 0.0)[0]]), NEAR_M)
    if law.p_n_per_m > 0.0:
        return law.first_n - law.p_n_per_m * near_m, TRIM_KNOWN_N
    usual = USUAL[False][0] / case.model.linear_figure("authority")
    return law.first_n - usual * near_m, SPREAD * usual * near_m


def grav(case):
    if case.model is None:
        return on_the_ground(case)
    told = set_grav_n(case) if case.model.kind == "THRUST" else None
    if told is None:
        return Finding(-1.0)
    (grav_n, known_n), hover_n = told, case.model.hover_n()
    return Finding(wider(grav_n - hover_n, known_n, TRIM_N, TRIM_FAULTY_N), {"grav": grav_n, "hover": hover_n})


def on_the_ground(case):
    """It never flew, although it was told to."""
    c, t_s = case.flight.column, case.flight.t_s
    wants = (c["ref_m"] > 0.0) & (c["thrust_n"] > 1.0)
    seconds = float(numpy.diff(t_s, append=t_s[-1])[wants].sum())
    most_n = float(c["thrust_n"].max())
    return Finding(15.0 if seconds > REFUSED_S else 0.0, {"grav": None, "hover": None, "most": most_n, "seconds": seconds})
