"""The scanner's rays: older than the firmware believes, or gone, or stopped by something near."""
import numpy

import vehicle
from causes.case import Finding

LATE_S = (0.055, 0.075, 0.1)
LATE_USUAL_S = 0.03             # campaigns draw the instant of the rays within 30 ms: that is no fault
ARM_M = 0.3                     # height per radian: as causes/imu.py
HEIGHT_FLAG = 1
BEFORE_S = (0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0)  # before the firmware gave the heights up: they may have been wrong already
STILL_M, MAD = 0.003, 0.674     # noise of the mean of 35 rays; median of the absolute deviation, in standard deviations
METRES = 1.0                    # a height that tells nothing is anywhere within that
LOST_S = 0.3
# Rules that say that the thrust does not do what it should: too little of it does the same. Then the heights themselves must tell.
PUSHES_IN_VAIN, IN_VAIN = ("SIGHT/noclimb", "SIGHT/vain", "SIGHT/aloft"), 1.0
SIGHT, GONE = 6.0, 6.0          # nats: 1 healthy flight of 400 shows either (docs/reliability.md), most of these causes do


def tilt_of_another_instant(late_s):
    """Columns: the tilt by which the firmware corrected the heights was that of another instant."""
    def columns(span, _f):
        now = span.ray_s + late_s
        tilt = [numpy.interp(now, span.tilt_s, angle) - numpy.interp(span.ray_s, span.tilt_s, angle) for angle in (span.roll_all, span.pitch_all)]
        return span.merged(numpy.array(tilt).T, numpy.zeros((len(span.frame_s), 2)))
    return columns


def late(case):
    """The heights, had their rays been older: the likelihood of each age."""
    def aged(late_s):
        spans = [vehicle.changed(span, late_s) for span in case.spans]
        return case.again(spans, extra=[tilt_of_another_instant(late_s)], sigmas=[ARM_M] * 2)
    usual = max(0.0, aged(LATE_USUAL_S)[0])
    (nats, model), best = max(((aged(late_s), late_s) for late_s in LATE_S), key=lambda one: one[0][0])
    return Finding(nats - usual - numpy.log(len(LATE_S)), {"ms": 1e3 * best}, model)


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
        return 0.0
    spread_m = max(float(numpy.median(numpy.abs(heights_m - numpy.median(heights_m)))) / MAD, STILL_M)
    off = numpy.minimum(numpy.abs(heights_m - numpy.median(heights_m)) / spread_m, vehicle.HUBER)
    still = -count * numpy.log(spread_m) - 0.5 * float((off**2).sum()) - numpy.log(METRES / spread_m)
    return max(still, -count * numpy.log(METRES)) - numpy.log(len(BEFORE_S))


def rays(case):
    """Heights that are gone, or that something else than the ground made."""
    flight = case.flight
    lost = lost_spans(flight)
    doubts = sorted({word for word in flight.column["doubt"] if word.startswith("SIGHT")})
    if not lost:
        return Finding(-3.0)
    seconds = sum(b - a for a, b in lost)
    in_vain = bool(doubts) and case.model is not None and set(doubts) <= set(PUSHES_IN_VAIN)
    told = IN_VAIN if in_vain else (SIGHT if doubts else 0.0) + (GONE if seconds > LOST_S else 0.0)
    found = Finding(told, {"seconds": seconds, "doubts": doubts, "from": lost[0][0]}, None, lost)
    if case.model is None:
        return found
    begin, end = lost[0][0], max(b for _, b in lost)
    gained, chosen = 0.0, None
    for before_s in BEFORE_S:
        spans = [vehicle.changed(span, blind=[(begin - before_s, end + 60.0)]) for span in case.spans]
        wrong = numpy.concatenate([span.ray_m[span.ray_s >= begin - before_s] for span in case.spans])
        if not any(len(span.ray_s) for span in spans):
            continue
        nats, model = case.again(spans) if len(wrong) else (0.0, None)
        nats += of_something_near(wrong)
        if nats > gained:
            gained, chosen = nats, model
    found.nats += gained
    found.model = chosen
    found.words["wrong"] = gained > 3.0 or bool(doubts)
    return found
