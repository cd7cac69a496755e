"""Which mirrors show something else than the ground, and since when: all sets of liars and all windows of time, compared.

The words are those of control/sense/belief.h, in hindsight. A liar's slant stays what it is: a thing stands before the mirror. The
slants of honest mirrors go together, but for what the tilt and the instants of their rays make of them; each moves as a vehicle does.
No length of the vehicle is needed: what the tilt makes of the slants is found in the flight itself.
"""
import itertools
import math
from dataclasses import dataclass

import numpy

from flight import GROUNDED

NAMES = {"mf": "front", "m1": "aft", "m2": "fore"}
GRID_S = 0.5                    # places where a window may begin and end
LEAST_S = 1.0                   # of a window; shorter ones are the cause's that asks for lost heights
# Noise of a mean of 8 rays that meet a thing, and with the noises of the noisiest healthy vehicle: 4.5 mm of all, 10 of each ray.
STILL_MM, STILL_MOST_MM = 3.0, 6.5
APART_MM = 6.0                  # of honest slants, one about the others: BELIEF_NOISE_MM of control/sense/belief.h
KNOWN_SCANS = 4.0               # so many scans count what is known of a noise before
ROOM_MM = 1000.0                # a thing stands anywhere within that
LEAST_SCANS = 20                # of a flight
AS_STILL = 1.3                  # times the noise of a liar: a mirror that sees the ground moves with the vehicle and its tilt
USUAL_AGE_S, GAP_LEAST_S = 0.08, 0.05
# What one mirror shows about the others, in healthy flights of three: white noise, and what is left of tilt and motion.
NOISE_MM, NOISE_SPREAD, LEFT_MM = 3.3, 0.35, 1.5
NOISES_MM = NOISE_MM * numpy.exp(numpy.linspace(-1.0, 1.0, 9))
WANDER_MM, WANDER_SPREAD, WANDER_S = 8.0, 0.8, 0.4      # of a floor with heights of its own under each: docs/campaign.md, a place's `rough`
WANDERS_MM = WANDER_MM * numpy.exp(numpy.linspace(-1.6, 1.6, 9))
REGRESSORS = 4                  # one, roll, pitch, speed
RIDGE = 1e-6


@dataclass
class Scans:
    """Those in the air in which the mirrors told something."""
    time_s: numpy.ndarray       # of the latest rays of each
    names: list                 # of the mirrors that the vehicle reads
    slant_mm: numpy.ndarray     # (mirrors, scans), NaN where a mirror told none
    tilt: numpy.ndarray         # (scans, 2)
    lie: numpy.ndarray          # (mirrors, scans): what the firmware thought, 0 .. 1


@dataclass
class Liars:
    nats: float
    mirrors: tuple = ()         # names
    begin_s: float = 0.0
    end_s: float = 0.0
    slant_mm: tuple = ()        # at which each stood still


def scans_of(flight, everywhere=False):
    """None: the log tells nothing of single mirrors. everywhere: also where the height is that of the ground, or gone."""
    beams, t_s = flight.beams, flight.t_s
    flies = numpy.array([state not in GROUNDED for state in flight.column["state"]])      # LAYOUT is typed before
    there = [mirror for mirror in NAMES if f"{mirror}_rays" in beams and not numpy.isnan(beams[f"{mirror}_rays"][flies]).all()]
    if not there:
        return None
    rows = numpy.any([~numpy.isnan(beams[f"{mirror}_rays"]) for mirror in there], axis=0)
    rows &= flies if everywhere else flight.aloft()
    tilt = numpy.array([numpy.interp(t_s[rows], t_s[~numpy.isnan(angle)], angle[~numpy.isnan(angle)])
                        for angle in (flight.column["roll_rad"], flight.column["pitch_rad"])]).T
    slant, lie = (numpy.array([beams[f"{mirror}_{what}"][rows] for mirror in there]) for what in ("mm", "lie"))
    age_s = numpy.array([beams[f"{mirror}_ms"][rows] for mirror in there]) / 1e3
    first = numpy.where(numpy.isnan(age_s).all(axis=0), USUAL_AGE_S, numpy.nanmin(numpy.where(numpy.isnan(age_s), numpy.inf, age_s), axis=0))
    return Scans(t_s[rows] - first, [NAMES[mirror] for mirror in there], slant, tilt, numpy.nan_to_num(lie) / 100.0)


def running(values):
    """Sums before each place: (count + 1, ...)."""
    return numpy.concatenate([numpy.zeros((1, *values.shape[1:])), numpy.cumsum(values, axis=0)])


def profile(count, squares, known_mm):
    """Log-likelihood of normal errors whose standard deviation is found too, about known_mm before."""
    return -0.5 * (count + KNOWN_SCANS) * numpy.log((squares + KNOWN_SCANS * known_mm**2) / (count + KNOWN_SCANS)) - 0.5 * count \
        + KNOWN_SCANS * numpy.log(known_mm)


def still(slant_mm, begin, end):
    """Log-likelihood of each window that a thing stands there."""
    count, first, second = (of[end] - of[begin] for of in (running(numpy.ones(len(slant_mm))), running(slant_mm), running(slant_mm**2)))
    squares = numpy.maximum(second - first**2 / count, 0.0)
    free = (squares + KNOWN_SCANS * STILL_MM**2) / (count + KNOWN_SCANS)
    most = -count * numpy.log(STILL_MOST_MM) - 0.5 * squares / STILL_MOST_MM**2
    return numpy.where(free < STILL_MOST_MM**2, profile(count, squares, STILL_MM), most) - numpy.log(ROOM_MM / STILL_MM)


def about_nothing(apart, regressors, begin, end):
    """Log-likelihood of a difference of honest mirrors: in all scans, and in those outside of each window."""
    sums = [running(of) for of in (numpy.ones(len(apart)), regressors[:, :, None] * regressors[:, None, :], regressors * apart[:, None], apart**2)]
    found = []
    for count, xx, xy, yy in ([of[-1] for of in sums], [of[-1] - (of[end] - of[begin]) for of in sums]):
        solved = numpy.linalg.solve(xx + RIDGE * numpy.eye(REGRESSORS), xy[..., None])[..., 0]
        found.append(profile(count, numpy.maximum(yy - (solved * xy).sum(-1), 0.0), APART_MM))
    return found


def differences(slant_mm):
    """[(a difference of the others, one of this mirror and the others)] of each mirror, all of one noise; of two mirrors the same one twice."""
    found = []
    for m, own in enumerate(slant_mm):
        others = [slant for other, slant in enumerate(slant_mm) if other != m]
        share = math.sqrt(len(others) / (len(others) + 1.0))
        found.append(((others[0] - others[-1]) / math.sqrt(2.0), (own - sum(others) / len(others)) * share))
    return found


def windows(time_s):
    edges = numpy.unique(numpy.searchsorted(time_s, numpy.arange(time_s[0], time_s[-1], GRID_S)))
    edges = [*edges.tolist(), len(time_s)]
    pairs = [(a, b) for a, b in itertools.combinations(edges, 2) if time_s[b - 1] - time_s[a] >= LEAST_S]
    return numpy.array(pairs, int).reshape(-1, 2).T


def complete(scans):
    """Those in which every mirror told something."""
    known = ~numpy.isnan(scans.slant_mm).any(axis=0)
    return Scans(scans.time_s[known], scans.names, scans.slant_mm[:, known], scans.tilt[known], scans.lie[:, known])


def liars(scans):
    """The likeliest set of mirrors that stand still in a window while at least one does not, against none. Nats below 0: none is likelier."""
    best = Liars(-3.0)
    if scans is None or len(scans.names) < 2:
        return best
    scans = complete(scans)
    if len(scans.time_s) < LEAST_SCANS:
        return best
    begin, end = windows(scans.time_s)
    if not len(begin):
        return best
    count = len(scans.names)
    slant_mm = scans.slant_mm - scans.slant_mm.mean(axis=1)[:, None]     # digits
    regressors = numpy.column_stack([numpy.ones(len(scans.time_s)), scans.tilt, speed_of(scans) / 1e3])
    stands = [still(slant, begin, end) for slant in slant_mm]
    of_others, own = zip(*([about_nothing(of, regressors, begin, end) for of in pair] for pair in differences(slant_mm)))
    three = 1.0 if count > 2 else 0.0       # two mirrors have one difference only
    usual = max(three * others[0] + mine[0] for others, mine in zip(of_others, own))
    outside = numpy.max([three * others[1] + mine[1] for others, mine in zip(of_others, own)], axis=0)
    sets = [chosen for size in range(1, count) for chosen in itertools.combinations(range(count), size)]
    for chosen in sets:
        rest = three * of_others[chosen[0]][0] + own[chosen[0]][1] if len(chosen) == 1 else outside
        nats = rest + sum(stands[m] for m in chosen) - usual
        # A millimetre of a slant is less of a difference.
        nats += 0.5 * math.log(count / (count - len(chosen))) * (end - begin)
        at = int(numpy.argmax(nats))
        value = float(nats[at]) * independent(slant_mm, regressors, begin[at], end[at]) - math.log(len(begin)) - math.log(len(sets))
        if value > best.nats:
            best = Liars(value, tuple(scans.names[m] for m in chosen), float(scans.time_s[begin[at]]), float(scans.time_s[end[at] - 1]),
                         tuple(float(scans.slant_mm[m, begin[at]:end[at]].mean()) for m in chosen))
    return best if not best.mirrors else with_those_that_stand_too(scans, best)


def independent(slant_mm, regressors, begin, end):
    """How many of the scans count, 0 .. 1: over a rough floor neighbours are alike."""
    outside = numpy.ones(len(regressors), bool)
    outside[begin:end] = False
    if outside.sum() < LEAST_SCANS:
        outside[:] = True
    alike = 0.0
    for _, apart in differences(slant_mm):
        rest = apart[outside] - regressors[outside] @ numpy.linalg.lstsq(regressors[outside], apart[outside], rcond=None)[0]
        alike = max(alike, float((rest[1:] * rest[:-1]).sum() / max(float((rest**2).sum()), 1e-9)))
    return (1.0 - min(alike, 0.9)) / (1.0 + min(alike, 0.9))


def with_those_that_stand_too(scans, found):
    """Where the other mirrors stand as still as the liars, none of them saw the ground."""
    inside = (scans.time_s >= found.begin_s) & (scans.time_s <= found.end_s)
    noise = {name: float(numpy.std(slant)) for name, slant in zip(scans.names, scans.slant_mm[:, inside])}
    most = AS_STILL * max(noise[name] for name in found.mirrors)
    if any(noise[name] > most for name in scans.names):
        return found
    return Liars(found.nats, tuple(scans.names), found.begin_s, found.end_s, tuple(float(slant[inside].mean()) for slant in scans.slant_mm))


def speed_of(scans):
    """mm/s, of the middle one of the mirrors in each scan that has any."""
    known = ~numpy.isnan(scans.slant_mm).all(axis=0)
    if known.sum() < 2:
        return numpy.zeros(len(known))
    middle = numpy.interp(scans.time_s, scans.time_s[known], numpy.nanmedian(scans.slant_mm[:, known], axis=0))
    return numpy.gradient(middle) / numpy.maximum(numpy.gradient(scans.time_s), GAP_LEAST_S)


def unseeing(scans):
    """Of each mirror [(begin, end)] in which it told nothing and another did."""
    known = ~numpy.isnan(scans.slant_mm)
    found = {}
    for m, name in enumerate(scans.names):
        alone = ~known[m] & known.any(axis=0)
        edges = numpy.flatnonzero(numpy.diff(numpy.concatenate(([0], alone.astype(int), [0]))))
        last = len(scans.time_s) - 1
        found[name] = [(float(scans.time_s[a]), float(scans.time_s[min(b, last)])) for a, b in zip(edges[::2], edges[1::2])]
    return found


def who(scans, begin, end):
    """(mirrors that told nothing or stood still between these times, whether most of them told nothing): of a loss of the height."""
    inside = (scans.time_s >= begin) & (scans.time_s <= end)
    blind, still_ones = [], []
    for name, slant in zip(scans.names, scans.slant_mm[:, inside]):
        known = slant[~numpy.isnan(slant)]
        if len(known) < 0.5 * len(slant):
            blind.append(name)
        elif len(known) > 2 and numpy.std(known) < STILL_MOST_MM:
            still_ones.append(name)
    named = [name for name in scans.names if name in blind or name in still_ones]
    return tuple(named or scans.names), len(blind) > len(still_ones)


def terrain(scans):
    """(nats, rms in mm): how much likelier the mirrors see heights of their own that wander, than one floor and noise."""
    if scans is None or len(scans.names) < 3:
        return 0.0, 0.0
    front, aft, fore = scans.slant_mm
    apart = numpy.array([aft - fore, (front - 0.5 * (aft + fore)) * numpy.sqrt(4.0 / 3.0)]).T / numpy.sqrt(2.0)     # of one noise each
    known = ~numpy.isnan(apart).any(axis=1)
    if known.sum() < LEAST_SCANS:
        return 0.0, 0.0
    regressors = numpy.column_stack([numpy.ones(len(known)), scans.tilt, numpy.gradient(scans.tilt, axis=0), speed_of(scans) / 1e3])[known]
    rest = apart[known] - regressors @ numpy.linalg.lstsq(regressors, apart[known], rcond=None)[0]
    gap_s = numpy.abs(scans.time_s[known][:, None] - scans.time_s[known][None, :])
    alike = numpy.exp(-gap_s / WANDER_S)
    usual = evidence(rest, alike, LEFT_MM)
    weights = numpy.exp(-0.5 * (numpy.log(WANDERS_MM / WANDER_MM) / WANDER_SPREAD)**2)
    each = numpy.array([evidence(rest, alike, wanders_mm) for wanders_mm in WANDERS_MM])
    most = each.max()
    return float(most + numpy.log((weights / weights.sum()) @ numpy.exp(each - most)) - usual), float(WANDERS_MM[int(numpy.argmax(each))])


def evidence(rest, alike, wanders_mm):
    """Log-likelihood of columns that wander so much, their white noise integrated out over what healthy ones have."""
    found = []
    values, vectors = numpy.linalg.eigh(alike)
    turned = (vectors.T @ rest)**2
    for noise_mm in NOISES_MM:
        variance = noise_mm**2 + wanders_mm**2 * numpy.maximum(values, 0.0)
        found.append(-0.5 * rest.shape[1] * float(numpy.log(variance).sum()) - 0.5 * float((turned / variance[:, None]).sum())
                     - 0.5 * (math.log(noise_mm / NOISE_MM) / NOISE_SPREAD)**2)
    most = max(found)
    return most + math.log(sum(math.exp(value - most) for value in found) / len(found))
