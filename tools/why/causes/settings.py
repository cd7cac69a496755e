"""What was set: gains, the thrust GRAV, the window of the thrust."""
import math

import numpy

import begun
from causes.case import Finding, even
from causes.forces import GROWTH_FAULTY, growth
from vehicle import G

# Of delivered gains on a vehicle whose throttle has the effect that its hover thrust tells: acceleration per metre and per metre per
# second, as the thrusts of a log show it (the cascade acts on more than what is logged).
USUAL = {True: (14.5, 3.5), False: (8.0, 3.2)}
SEEN = 0.2                      # rms error of the logarithm of gains that were read off the thrusts alone
# What flies well: the delivered gains on the vehicle in the middle. PIDT's newtons are not divided by the vehicle's mass.
CASCADE = {"VELK": 8.0, "POSK": 2.3}
PIDT, MIDDLE_N = {"PKP": 6.0, "PKD": 2.6}, 7.0
KNOWN = 0.03                    # rms error of the logarithm of the gains that the firmware told: VELK / GAIN 0.02, POSK 0.02, of PIDT less
# What is drawn of healthy vehicles and of others (tools/why/planted.py): a newton's effect, +-20 % and a little more; masses, +-15 % (rms);
# gains that somebody set, 1.2 to 3.2 times too hot or too cold.
EFFECT_WITHIN, MASS, FAULTY = math.log(1.25), 0.087, (math.log(1.2), math.log(3.2))
EFFECTS = numpy.linspace(-EFFECT_WITHIN, EFFECT_WITHIN, 41)
EFFECT_METHOD = 0.04            # rms, of the logarithm: what the equations leave out, beside what the noise makes of the effect
TRIM_N, TRIM_FAULTY_N = 0.6, 2.8
HOVER_KNOWN_N = 0.1             # the thrust that a flight of some seconds hovers with: 0.25 m/s2 of turbulence for half a second each
STAY_SWING_S, STAY_FAULTY_S = 0.25, 1.0 # mean stay at a limit (exponential): of a loop that swings twice a second, of a window too narrow
REFUSED_S = 3.0


def gains(case):
    """(how much hotter the gains are than those of a vehicle that flies well, on one whose newton has the effect that its hover thrust tells: a
    logarithm; its standard deviation). None: not known."""
    if case.model is None or case.model.kind != "THRUST":
        return None
    hover_n = case.model.hover_n()
    if case.told is None:
        return seen_gains(case.law, hover_n)
    value = case.told.value
    if case.law.estimator:          # EST divides by the hover thrust that it has learned
        return (math.log(value["VELK"] / CASCADE["VELK"] / value["GAIN"] * (1.0 + case.told.above_n / hover_n))
                + 0.5 * math.log(value["POSK"] / CASCADE["POSK"]), KNOWN)
    return sum(0.5 * math.log(value[name] * MIDDLE_N / (usual * hover_n)) for name, usual in PIDT.items()), KNOWN


def seen_gains(law, hover_n):
    """By the thrusts alone: of a law that the firmware does not fly again."""
    if law.p_n_per_m <= 0.0 and law.d_n_s_per_m <= 0.0 or law.fits < 0.2:
        return None
    known = [(math.log(max(G / hover_n * value, 0.05 * usual) / usual), max(sigma, SEEN))
             for value, usual, sigma in zip((law.p_n_per_m, law.d_n_s_per_m), USUAL[law.estimator], law.sigma)]
    weight = [1.0 / sigma**2 for _, sigma in known]
    return sum(w * value for w, (value, _) in zip(weight, known)) / sum(weight), SEEN


def effects(model):
    """Log-likelihood of each of EFFECTS by the flight alone: of what a newton does, by what the hover thrust tells. What is expected of it is taken
    out again: every vehicle has one of EFFECTS, whatever was set."""
    place = model.names.index("authority")
    variance = numpy.linalg.inv(model.information)[place, place]
    told = max(1.0 / variance - 1.0 / model.spread[place]**2, 1e-3 / variance)
    mean = (model.linear[place] / variance - model.prior[place] / model.spread[place]**2) / told
    expected = G / model.hover_n() * numpy.exp(EFFECTS)
    return -0.5 * (mean - expected)**2 / (1.0 / told + (EFFECT_METHOD * expected)**2)


def too(case, sign):
    """The loop's gain on its vehicle, the newton's effect integrated out: of a loop that somebody set so, against a healthy one."""
    known = gains(case)
    if known is None:
        return Finding(-1.0)
    (value, spread), by_effect = known, effects(case.model)
    healthy_spread = math.hypot(spread, 0.0 if case.law.estimator else MASS)
    faulty, healthy = (numpy.logaddexp.reduce(by_effect + each) for each in (
        [even(sign * (value + effect), spread, *FAULTY) for effect in EFFECTS],
        [even(value + effect, healthy_spread, -EFFECT_WITHIN, EFFECT_WITHIN) for effect in EFFECTS]))
    likely = numpy.exp(by_effect - by_effect.max())
    return Finding(float(faulty - healthy), {"times": math.exp(value + float(likely @ EFFECTS / likely.sum()))})


def hot(case):
    return too(case, 1.0)


def cold(case):
    return too(case, -1.0)


def saturation(case):
    """The thrust rests at its greatest or its least. A law that swings comes there too, but not for longer than half a swing."""
    law = case.law
    stays = numpy.array(law.stays_s)
    nats = float((stays * (1.0 / STAY_SWING_S - 1.0 / STAY_FAULTY_S) - numpy.log(STAY_FAULTY_S / STAY_SWING_S)).sum())
    return Finding(nats, {"percent": 100.0 * (law.at_most + law.at_least), "range": law.range_n, "width": law.range_n[1] - law.range_n[0]})


def grav(case):
    if case.model is None:
        return on_the_ground(case)
    known = grav_n(case) if case.model.kind == "THRUST" else None
    if known is None:
        return Finding(-1.0)
    (set_n, sigma_n), (hover_n, hover_sigma_n) = known, hover_at_first(case)
    off_n, spread_n = set_n - hover_n, math.hypot(sigma_n, hover_sigma_n)
    nats = even(off_n, spread_n, -TRIM_FAULTY_N, TRIM_FAULTY_N) - even(off_n, spread_n, -TRIM_N, TRIM_N)
    return Finding(nats, {"grav": set_n, "hover": hover_n})


def hover_at_first(case):
    """(hover thrust as the flight begins, its standard deviation): there GRAV was set for it. Where it grows, its middle is another."""
    grew, sigma = growth(case.model)
    grew = min(max(grew, 0.0), GROWTH_FAULTY[1])
    before_s = case.model.spans[0].log_middle - case.model.spans[0].begin
    hover_n = case.model.hover_n()
    return hover_n * (1.0 - grew * before_s), math.hypot(HOVER_KNOWN_N, hover_n * sigma * before_s)


def grav_n(case):
    """(GRAV, its standard deviation). EST uses it at the beginning only; PIDT adds it to every thrust."""
    if case.told is not None and not case.law.estimator:
        return case.told.value["GRAV"], case.told.sigma["GRAV"]
    return begun.grav_n(case.flight, case.law)


def rose(flight):
    """Nearer to the reference than to the ground, although not for long enough to tell its vehicle: no vehicle that cannot lift off."""
    c = flight.column
    return bool(numpy.nanmax(c["meas_m"][c["state"] != "GROUND"], initial=0.0) > 0.5 * c["ref_m"].max())


def on_the_ground(case):
    """It never flew, although it was told to."""
    c, t_s = case.flight.column, case.flight.t_s
    if rose(case.flight):
        return Finding(0.0)
    wants = (c["ref_m"] > 0.0) & (c["thrust_n"] > 1.0)
    seconds = float(numpy.diff(t_s, append=t_s[-1])[wants].sum())
    most_n = float(c["thrust_n"].max())
    return Finding(15.0 if seconds > REFUSED_S else 0.0, {"grav": None, "hover": None, "most": most_n, "seconds": seconds})
