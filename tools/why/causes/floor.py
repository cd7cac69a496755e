"""The floor: steps of the heights that no motion explains, few or many."""
import numpy

import mirrors
from causes.case import Finding
from vehicle import whitened

STEP_M = 0.03                   # rms of a step: what a colour does, or an edge
LEAST_STEP_M = 0.008            # smaller ones harm nobody
STEPS_MOST = 10
WORTH = 4.0                     # nats of one more step
LEVELS = 0.35                   # two colours: the steps' sizes agree within this share


def step_columns(span, times):
    steps = (span.ray_s[:, None] >= numpy.asarray(times)[None, :] - 0.001).astype(float)
    return span.merged(steps, numpy.zeros((len(span.frame_s), len(times))))


def at_each_scan(span, _f):
    return step_columns(span, span.ray_s[1:])


def scans_of(model):
    """(whitened columns of a step at each scan, their instants), spans side by side."""
    blocks, times = [], []
    rows = [len(span.time_s) for span in model.spans]
    for number, (span, gains) in enumerate(zip(model.spans, model.gains)):
        z = whitened(span, gains, at_each_scan(span, None))
        blocks.append(numpy.vstack([numpy.zeros((sum(rows[:number]), z.shape[1])), z,
                                    numpy.zeros((sum(rows[number + 1:]), z.shape[1]))]))
        times.append(span.ray_s[1:])
    return numpy.hstack(blocks), numpy.concatenate(times)


def projected(model):
    """Curvature and slope of the log-likelihood by the size of a step at each scan, the vehicle's own figures free."""
    z, times = scans_of(model)
    z = z * model.robust[:, None]
    a, rest = model.design * model.robust[:, None], model.rest * model.robust
    shared = a.T @ z
    return z.T @ z - shared.T @ numpy.linalg.solve(model.information, shared), z.T @ rest, times


def pursue(curvature, slope, sigma, count_most=STEPS_MOST):
    """[(index, nats)] of the steps that are worth it, one after the other; and their sizes together."""
    chosen, total, nats = [], 0.0, 0.0
    looks = numpy.log(len(slope))
    size = numpy.zeros(0)
    while len(chosen) < count_most:
        if chosen:
            inner = curvature[numpy.ix_(chosen, chosen)] + numpy.eye(len(chosen)) / sigma**2
            outer = curvature[:, chosen]
            solved = numpy.linalg.solve(inner, outer.T)
            left = slope - outer @ numpy.linalg.solve(inner, slope[chosen])
            own = numpy.diag(curvature) - (outer * solved.T).sum(1)
        else:
            left, own = slope, numpy.diag(curvature)
        precision = numpy.maximum(own, 1e-9) + 1.0 / sigma**2
        each = 0.5 * left**2 / precision - 0.5 * numpy.log(precision * sigma**2) - looks
        each[chosen] = -numpy.inf
        best = int(numpy.argmax(each))
        if each[best] < WORTH:
            break
        chosen.append(best)
        nats += float(each[best])
    if chosen:
        inner = curvature[numpy.ix_(chosen, chosen)] + numpy.eye(len(chosen)) / sigma**2
        size = numpy.linalg.solve(inner, slope[chosen])
    order = numpy.argsort(chosen)
    return numpy.array(chosen, int)[order], size[order], nats


def floor(case):
    """The heights against the vehicle's motion, and the mirrors against each other where there are three and none of them lies."""
    found = heights(case)
    if case.liars().nats > 0.0:
        return found
    nats, mm = mirrors.terrain(mirrors.scans_of(case.flight))
    if nats > 0.0 and found.nats < WORTH:       # the heights alone say nothing; the mirrors do
        found.words |= {"count": 0, "mm": max(mm, found.words["mm"] if not found.words["count"] else 0.0)}
    found.nats += nats
    return found


def heights(case):
    """Steps, few (an edge, another colour) or many (a rough floor); the better of the two."""
    curvature, slope, times = projected(case.model)
    chosen, _, _ = pursue(curvature, slope, STEP_M)
    nats, model = case.again(terrain=True)
    found = Finding(nats, {"count": 0, "mm": 1e3 * model.figures["terrain"]}, model=model)
    if len(chosen) and 0 < len(chosen) <= STEPS_MOST:
        at = times[chosen]
        gained, model = case.again(extra=[lambda span, _f: step_columns(span, at)], sigmas=[STEP_M] * len(at))
        gained -= len(at) * numpy.log(len(times))
        size = model.linear[-len(at):]
        big = numpy.abs(size) > LEAST_STEP_M
        if gained > found.nats and big.any():
            found = Finding(gained, {"count": int(big.sum()), "mm": 1e3 * float(numpy.median(numpy.abs(size[big]))), "alternate": alternate(size[big])},
                            model=model, marks=[(t, t + 0.1) for t in at[big]])
    return found


def alternate(size):
    """Up and down in turn by about the same: two colours, rather than edges."""
    return bool(len(size) > 1 and (numpy.diff(numpy.sign(size)) != 0).mean() > 0.7
                and numpy.std(numpy.abs(size)) < LEVELS * numpy.mean(numpy.abs(size)))
