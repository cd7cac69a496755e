"""The scanner's rays: older than the firmware believes, or gone, or stopped by something near."""
import numpy

import mirrors
import vehicle
from causes.case import Finding, even

LATE_S = (0.045, 0.06, 0.08)
LATE_STEP_S, LATE_LEAST_S, LATE_MOST_S = 0.01, 0.025, 0.15      # then around the best of these
METHOD_S = 0.005                # what the equations' own lags leave open, beside the noise
SCAN_S = 0.1                    # older rays than those of a whole scan are another scan's
FAR = 4.0                       # standard deviations: so far from what is usual there is nothing to look at more closely
ARM_M = 0.3                     # height per radian: as causes/imu.py
HEIGHT_FLAG = 1
BEFORE_S = (0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0)  # before the firmware gave the heights up: they may have been wrong already
STILL_M, MAD = 0.003, 0.674     # noise of the mean of 35 rays; median of the absolute deviation, in standard deviations
JUST_S = 0.02
METRES = 1.0                    # a height that tells nothing is anywhere within that
LOST_S = 0.3
LIES = 0.5                      # over it the vote leaves a mirror out
BLIND_SPOT_S, BLIND_FAULTY_S = 0.15, 3.0        # mean stay without a slant (exponential): a spot on the floor passes a mirror; a fault stays
SIGHT, GONE = 6.0, 6.0          # nats: 1 healthy flight of 400 shows either (docs/reliability.md), most of these causes do


def tilt_of_another_instant(late_s):
    """Columns: the tilt by which the firmware corrected the heights was that of another instant."""
    def columns(span, _f):
        now = span.ray_s + late_s
        tilt = [numpy.interp(now, span.tilt_s, angle) - numpy.interp(span.ray_s, span.tilt_s, angle) for angle in (span.roll_all, span.pitch_all)]
        return span.merged(numpy.array(tilt).T, numpy.zeros((len(span.frame_s), 2)))
    return columns


def late(case):
    """The heights, had their rays been older than is usual: how old they are, by the likelihood of each age, and how surely."""
    def aged(late_s):
        more_s = late_s - case.age_s
        spans = [vehicle.changed(span, more_s) for span in case.spans]
        return case.again(spans, extra=[tilt_of_another_instant(late_s)], sigmas=[ARM_M] * 2)
    known = {late_s: aged(late_s) for late_s in LATE_S}
    best = max(known, key=lambda late_s: known[late_s][0])
    usual_s = vehicle.AGE_MOST_S
    age_s, sigma_s = peak(known, best)
    for sign in (-1.0, 1.0):
        while age_s > usual_s - FAR * sigma_s and (nearby := round(best + sign * LATE_STEP_S, 3)) not in known and LATE_LEAST_S <= nearby <= LATE_MOST_S:
            known[nearby] = aged(nearby)
            if known[nearby][0] < known[best][0]:
                break
            best = nearby
    age_s, sigma_s = peak(known, best)
    return Finding(even(age_s, sigma_s, usual_s, SCAN_S) - even(age_s, sigma_s, -usual_s, usual_s), {"ms": 1e3 * age_s}, known[best][1])


def peak(known, best):
    """(where a parabola through the best place and its neighbours has its top, the standard deviation that its curvature tells)."""
    places = sorted(known, key=lambda place: abs(place - best))[:3]
    curvature, slope, _ = numpy.polyfit([place - best for place in places], [known[place][0] for place in places], 2)
    if curvature >= 0.0:
        return best, METHOD_S
    return float(numpy.clip(best - 0.5 * slope / curvature, -LATE_MOST_S, LATE_MOST_S)), float(numpy.hypot((-0.5 / curvature)**0.5, METHOD_S))


def lost_spans(flight):
    """[(begin, end)] in the air in which the firmware had no heights, or did not believe them."""
    c, t_s = flight.column, flight.t_s
    flags = c["flags"].astype(int)
    doubted = numpy.array([word.startswith("SIGHT") for word in c["doubt"]])
    bad = ((flags & HEIGHT_FLAG) > 0) | doubted | (c["state"] == "COASTING")
    bad &= c["state"] != "GROUND"
    edges = numpy.flatnonzero(numpy.diff(numpy.concatenate(([0], bad.astype(int), [0]))))
    return [(float(t_s[a]), float(t_s[min(b, len(t_s) - 1)])) for a, b in zip(edges[::2], edges[1::2])]


def of_something_near(heights_m):
    """Nats of heights that have nothing to do with the ground: of a thing that stays before the mirror, or anywhere within METRES."""
    count = len(heights_m)
    if count < 2:
        return -count * numpy.log(METRES) - numpy.log(len(BEFORE_S))
    spread_m = max(float(numpy.median(numpy.abs(heights_m - numpy.median(heights_m)))) / MAD, STILL_M)
    off = numpy.minimum(numpy.abs(heights_m - numpy.median(heights_m)) / spread_m, vehicle.HUBER)
    still = -count * numpy.log(spread_m) - 0.5 * float((off**2).sum()) - numpy.log(METRES / spread_m)
    return max(still, -count * numpy.log(METRES)) - numpy.log(len(BEFORE_S))


def rays(case):
    """Mirrors that show something else than the ground, or nothing: some of them, or all, whose heights are then wrong or gone."""
    scans = mirrors.scans_of(case.flight)
    found = max(heights(case), stands_before(case.liars(), scans), sees_nothing(scans), key=lambda each: each.nats)
    if "mirrors" not in found.words and "from" in found.words:
        there = mirrors.scans_of(case.flight, everywhere=True)
        if there is not None:
            found.words["mirrors"], found.words["blind"] = mirrors.who(there, found.words["from"], found.words["to"])
            found.words["of"] = len(there.names)
    return found


def stands_before(liars, scans):
    """A thing before one of several mirrors, or before some."""
    if not liars.mirrors:
        return Finding(liars.nats)
    thought = numpy.array([scans.lie[scans.names.index(name)] for name in liars.mirrors])
    words = {"mirrors": liars.mirrors, "of": len(scans.names), "blind": False, "mm": liars.slant_mm, "from": liars.begin_s, "to": liars.end_s,
             "seconds": liars.end_s - liars.begin_s, "told": bool((thought > LIES).mean(axis=1).min() > 0.0), "doubts": [], "wrong": True}
    return Finding(liars.nats, words, None, [(liars.begin_s, liars.end_s)])


def sees_nothing(scans):
    """A mirror tells nothing for longer than a dark spot lasts, while others do."""
    if scans is None or len(scans.names) < 2:
        return Finding(-3.0)
    best = Finding(-3.0)
    for name, stays in mirrors.unseeing(scans).items():
        stay_s = numpy.array([b - a for a, b in stays])
        nats = float((stay_s * (1.0 / BLIND_SPOT_S - 1.0 / BLIND_FAULTY_S) - numpy.log(BLIND_FAULTY_S / BLIND_SPOT_S)).sum())
        if len(stays) and nats > best.nats:
            best = Finding(nats, {"mirrors": (name,), "of": len(scans.names), "blind": True, "from": stays[0][0], "to": stays[-1][1],
                                  "seconds": float(stay_s.sum()), "doubts": [], "wrong": False}, None, stays)
    return best


def heights(case):
    """Heights that are gone, or that something else than the ground made."""
    flight = case.flight
    lost = lost_spans(flight)
    doubts = sorted({word for word in flight.column["doubt"] if word.startswith("SIGHT")})
    if not lost:
        return Finding(-3.0)
    seconds = sum(b - a for a, b in lost)
    told = (SIGHT if doubts else 0.0) + (GONE if seconds > LOST_S else 0.0)
    found = Finding(told, {"seconds": seconds, "doubts": doubts, "from": lost[0][0], "to": lost[-1][1]}, None, lost)
    if case.model is None:
        return found
    begin, end = lost[0][0], max(b for _, b in lost)
    spans, usual = beyond(case, begin)
    gained, chosen = 0.0, None
    last_s = max(span.ray_s[-1] for span in spans if len(span.ray_s))
    for before_s in sorted({*BEFORE_S, max(begin - last_s, 0.0)}):
        blind = [vehicle.changed(span, blind=[(begin - before_s, end + 60.0)]) for span in spans]
        wrong = numpy.concatenate([span.ray_m[span.ray_s >= begin - before_s] for span in spans])
        if not any(len(span.ray_s) for span in blind) or not len(wrong):
            continue
        model = vehicle.fit(case.model.kind, blind, case.model.figures, rounds=6)
        nats = model.score - usual + of_something_near(wrong)
        if nats > gained:
            gained, chosen = nats, model
    found.nats += gained
    found.model = chosen
    found.words["wrong"] = gained > 3.0 or bool(doubts)
    return found


def beyond(case, lost_s):
    """(spans, their score without a cause): those that end before lost_s with the height on the ground, and that height too. What stands
    before the mirror may seem to be the ground; a vehicle that comes down does not get there within a scan."""
    flight = case.flight
    spans = list(case.spans)
    for place, span in enumerate(spans):
        after = numpy.flatnonzero(flight.new & (flight.t_s > span.end))
        if lost_s - BEFORE_S[-1] < span.end < lost_s + LOST_S and len(after) and flight.column["state"][after[0]] != "GROUND":
            end = max(span.end, flight.rays_s[after[0]] + JUST_S)
            spans[place] = vehicle.changed(vehicle.span_of(flight, span.begin, end), case.age_s)
    if all(a is b for a, b in zip(spans, case.spans)):
        return spans, case.model.score
    return spans, vehicle.fit(case.model.kind, spans, case.model.figures, rounds=6).score
