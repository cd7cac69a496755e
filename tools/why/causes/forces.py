"""What pushes the vehicle beside its own thrust, or in its place."""
import numpy

import model as physics
from causes.case import Finding, even
from causes.floor import WORTH
from vehicle import G, lagged, model_of, response, whitened

TUG_S = 0.12                    # a rope's pull dies away: TUG_TAU_S of sim/devices/quadrotor.c
TUG_MPS2 = 2.0
TUG_EVERY_S = 0.05
TUG_ALIKE, TUG_SIZES = 0.35, 1.6        # one rope pulls about as hard each time: spread; five sizes could be (nats)
TUGS_PER_S, TUGS_MOST = 0.7, 25
TUGS_PER_S_TRIED = (0.2, 0.3, 0.45, 0.7, 1.0)   # how often they come, each as likely
TUG_BESIDE = 2                  # places beside the likeliest one at which the same tug may have been
ROPE_PER_S2, ROPE_SPREAD = 60.0, 25.0   # pull of a taut rope on a vehicle of 3 kg, for each metre: sim/devices/quadrotor.c
ROPE_SPAN_M, ROPE_STEP_M, ROPE_LEAST_M = 0.6, 0.03, 0.1
# Of the hover thrust, 1/s: up to 0.0015 in campaigns; of a battery that is nearly empty, up to 0.0124 (tools/why/planted.py).
GROWTH_HEALTHY, GROWTH_FAULTY = 0.0015, (0.0015, 0.0124)
CALM_MPS2, CALM_TAU_S = 0.25, 0.5       # the air of a healthy flight
EFFECT_SHARE = 0.2              # so well the thrust's effect is known
HAND_MPS2 = 10.0                # what holds the vehicle in the thrust's place, not known
PILOT_FLAG, TOLD = 64, 12.0     # the selector's pin says that he flies: no healthy flight has that
WINDOW_S = 0.5                  # places where a pilot may begin and end
WINDOW_LEAST_S = 1.0
NEARER_S = (0.25, 0.12)         # then around the likeliest of these
# The hand does not keep still: it acts on what the eye saw, against the climb and towards a height. Accelerations by speed and by height.
HAND_LATE_S = 0.45              # eye, hand, and the motors
HAND_SLOPE_S = 0.1              # half the time over which a climb is seen
HAND_PER_S, HAND_PER_S2 = 1.5, 1.5      # rms


def push_columns(span, f, pushes):
    return numpy.array([response(span, push, f["damping"]) for push in pushes]).T


def tugs_at(times):
    def columns(span, f):
        since = span.grid_s[None, :] - numpy.asarray(times)[:, None]
        return push_columns(span, f, numpy.where(since >= 0.0, -numpy.exp(-numpy.maximum(since, 0.0) / TUG_S), 0.0))
    return columns


def tug_times(spans):
    return numpy.concatenate([numpy.arange(span.begin - 0.3, span.end - 0.2, TUG_EVERY_S) for span in spans])


def calm(model):
    """The same vehicle in healthy air: what pushes it stands out."""
    usual = dict(model.figures, turbulence=min(model.figures["turbulence"], CALM_MPS2), turbulence_tau=CALM_TAU_S)
    return model_of(model.kind, model.spans, usual).solve()


def slopes(model, make):
    """Curvature and slope of the log-likelihood by the size of each column, the vehicle's own figures free."""
    z = numpy.vstack([whitened(span, gains, make(span, model.figures)) for span, gains in zip(model.spans, model.gains)])
    z = z * model.robust[:, None]
    a, rest = model.design * model.robust[:, None], model.rest * model.robust
    shared = a.T @ z
    return z.T @ z - shared.T @ numpy.linalg.solve(model.information, shared), z.T @ rest


def ropes(case):
    """Sudden pulls downwards. Pulls upwards would be gusts: as many of them speak against ropes."""
    times = tug_times(case.spans)
    usual = calm(case.model)
    curvature, slope = slopes(usual, tugs_at(times))
    down, up = (pursued(curvature, sign * slope, 1.0 / (TUGS_PER_S * TUG_EVERY_S)) for sign in (1.0, -1.0))
    at = times[down[0]]
    held = Finding(*taut(case))
    if not len(at):
        return held
    usual_mps2 = float(numpy.median(down[1]))
    nats, model = case.again(start=usual.figures, extra=[tugs_at(at)], sigmas=[TUG_ALIKE * usual_mps2] * len(at), means=[usual_mps2] * len(at))
    nats -= TUG_SIZES           # of the usual size
    seconds = sum(span.end - span.begin for span in case.spans)
    nats += poisson(len(at), seconds) + down[3] - max(up[2], 0.0)
    pulls = Finding(nats, {"count": len(at), "mps2": float(numpy.median(model.linear[-len(at):]))}, model, [(t, t + 2.0 * TUG_S) for t in at])
    return max(pulls, held, key=lambda found: found.nats)


def poisson(count, seconds):
    """Logarithm of how likely so many pulls are at just these places, whatever rate of TUGS_PER_S_TRIED they have."""
    each = [count * numpy.log(rate * TUG_EVERY_S) - rate * seconds for rate in TUGS_PER_S_TRIED]
    return float(numpy.logaddexp.reduce(each) - numpy.log(len(each)))


def rope_columns(length_m):
    """Of a rope that is taut above a height and pulls in proportion, m/s2 for each metre."""
    def columns(span, f):
        return push_columns(span, f, [-numpy.maximum(span.height_m - length_m, 0.0)])
    return columns


def taut(case):
    """One rope that ends at a height: (nats, words, model)."""
    highest = max(float(span.ray_m.max()) for span in case.spans if len(span.ray_m))
    best = (0.0, None)
    for length_m in numpy.arange(max(highest - ROPE_SPAN_M, ROPE_LEAST_M), highest - 0.02, ROPE_STEP_M):
        nats, size, _ = case.model.gain(rope_columns(length_m), ROPE_PER_S2)
        if size[0] > 0.0 and nats[0] > best[0]:
            best = (float(nats[0]), length_m)
    if best[1] is None or best[0] < WORTH:
        return 0.0, {}, None
    gained, model = case.again(extra=[rope_columns(best[1])], sigmas=[ROPE_SPREAD], means=[ROPE_PER_S2])
    return gained - numpy.log(ROPE_SPAN_M / ROPE_STEP_M), {"rope_m": best[1]}, model


def pursued(curvature, slope, looks):
    """As floor.pursue(), of pulls of one sign: (places, sizes, nats, nats of the places beside them)."""
    chosen, nats, beside, size = [], 0.0, 0.0, numpy.zeros(0)
    own, left = numpy.diag(curvature).copy(), slope.copy()
    while len(chosen) < TUGS_MOST:
        precision = numpy.maximum(own, 1e-9) + 1.0 / TUG_MPS2**2
        each = 0.5 * numpy.maximum(left, 0.0)**2 / precision - 0.5 * numpy.log(precision * TUG_MPS2**2) - numpy.log(looks)
        each[chosen] = -numpy.inf
        best = int(numpy.argmax(each))
        if each[best] < 0.0:        # likelier without it: what its place costs is in the odds already
            break
        chosen.append(best)
        nats += float(each[best])
        beside += float(numpy.logaddexp.reduce(each[max(best - TUG_BESIDE, 0):best + TUG_BESIDE + 1]) - each[best])
        inner = curvature[numpy.ix_(chosen, chosen)] + numpy.eye(len(chosen)) / TUG_MPS2**2
        outer = curvature[:, chosen]
        size = numpy.linalg.solve(inner, slope[chosen])
        left = slope - outer @ size
        own = numpy.diag(curvature) - (outer * numpy.linalg.solve(inner, outer.T).T).sum(1)
    return numpy.array(chosen, int), size, nats, beside


def growth(model):
    """(growth of the hover thrust, 1/s, its standard deviation), as the flight alone tells it: what is expected of it is taken out again."""
    place = model.names.index("growth")
    to_share = model.hover_n() / G
    variance = numpy.linalg.inv(model.information)[place, place]
    told = max(1.0 / variance - 1.0 / model.spread[place]**2, 1e-6 / variance)
    mean = (model.linear[place] / variance - model.prior[place] / model.spread[place]**2) / told
    return float(mean) * to_share, float(told**-0.5) * to_share


def battery(case):
    if case.model.kind != "THRUST":
        return Finding(-2.0)
    grew, sigma = growth(case.model)
    return Finding(even(grew, sigma, *GROWTH_FAULTY) - even(grew, sigma, 0.0, GROWTH_HEALTHY), {"percent": 100.0 * grew * 60.0})


def windows(spans):
    found = []
    for span in spans:
        edges = numpy.arange(span.begin, span.end, WINDOW_S)
        found += [(a, b) for a in edges for b in [*edges[edges >= a + WINDOW_LEAST_S], span.end + 1.0]]
    return found


def held_columns(places, acts=False):
    """In each window the thrust has no effect, and another one holds the vehicle. acts: that one acts on what is seen of height and climb."""
    def columns(span, f):
        thrust = lagged(span, f)
        air = physics.ground_effect(span.height_m) * span.upright
        inside = [(span.grid_s >= a) & (span.grid_s < b) for a, b in places]
        pushes = [*(-thrust * air * here for here in inside), *(air * here for here in inside)]
        if acts:
            before, seen, after = (numpy.interp(span.grid_s - HAND_LATE_S + more_s, span.grid_s, span.height_m)
                                   for more_s in (-HAND_SLOPE_S, 0.0, HAND_SLOPE_S))
            climb = (after - before) / (2.0 * HAND_SLOPE_S)
            pushes += [-(seen - seen[here].mean()) * here if here.any() else 0.0 * seen for here in inside] + [-climb * here for here in inside]
        return push_columns(span, f, pushes)
    return columns


def held_nats(model, places, b):
    """Of each window tried alone: how much likelier the flight is when there the thrust does nothing and a hand holds the vehicle."""
    curvature, slope = slopes(model, held_columns(places))
    count = len(places)
    own, cross = numpy.diag(curvature), numpy.diag(curvature[:count, count:])
    p, q = own[:count] + 1.0 / (EFFECT_SHARE * b)**2, own[count:] + 1.0 / HAND_MPS2**2
    u, v = slope[:count] + b / (EFFECT_SHARE * b)**2, slope[count:]
    determinant = p * q - cross**2
    return 0.5 * (u * (q * u - cross * v) + v * (p * v - cross * u)) / determinant - 0.5 * numpy.log(determinant)


def nearer(place, step_s):
    """The window and those beside it."""
    begin, end = place
    return [(begin + i * step_s, end + j * step_s) for i in (-1, 0, 1) for j in (-1, 0, 1) if end - begin + (j - i) * step_s > 0.5 * WINDOW_LEAST_S]


def pilot(case):
    """A while in which the commanded thrust does nothing, and a hand moves the vehicle."""
    if case.model.kind != "THRUST":
        return Finding(0.0)
    places = windows(case.spans)
    model = calm(case.model)
    b = case.model.linear_figure("authority")
    best = places[int(numpy.argmax(held_nats(model, places, b)))]
    for step_s in NEARER_S:
        around = nearer(best, step_s)
        best = around[int(numpy.argmax(held_nats(model, around, b)))]
    sizes = {"sigmas": [EFFECT_SHARE * b, HAND_MPS2, HAND_PER_S2, HAND_PER_S], "means": [b, 0.0, HAND_PER_S2, HAND_PER_S]}
    gained, found = case.again(start=model.figures, extra=[held_columns([best], acts=True)], loud=[best], **sizes)
    known = case.flight.column["flags"].astype(int) & PILOT_FLAG
    told = TOLD if known[case.flight.aloft()].mean() > 0.02 else 0.0
    return Finding(gained - numpy.log(len(places)) + told, {"from": best[0], "to": min(best[1], case.spans[-1].end)}, found, [best])
