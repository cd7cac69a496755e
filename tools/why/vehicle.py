"""How likely a flight is by the equations of a vehicle, and by those with one thing more.

The equations are those of tools/fit/model.py: thrust behind a dead time and a lag, damping, turbulence. What is linear in them
(effect of a newton, hover thrust, its growth, the accelerometer's offset) is a regressor, so a cause is tried by adding columns: the
heights and accelerations that it would have made. A Kalman filter whitens data and columns alike; its gains depend on the noises
only. Then the gain in likelihood of any column is one least-squares step, and hundreds of places in time can be tried at once.

Log-likelihoods are in nats. `Model.gain()` is exact for given noises, `fit()` finds those by maximum likelihood.
"""
import math
from dataclasses import dataclass, field, replace

import numpy
from scipy.linalg import expm
from scipy.signal import cont2discrete, lfilter, ss2tf

import flight as flights
import model

G, STEP_S = model.GRAVITY_MPS2, model.STEP_S
LEAD_S = 1.0                    # of the commands before a span: seven lags of the slowest motors that are drawn, 0.15 s (tools/why/planted.py)
EVENT_S = 0.0025
FIRST = (1.0, 1.0)              # height and speed at the beginning of a span are not known, rms
LOUD = 2.0                      # times the turbulence: what a pilot's hand does
TERRAIN_TAU_S = 0.4             # of a floor that wanders under the beam: docs/campaign.md, a place's `rough`
DIFFERENCE = 1e-3               # of a figure, in its prior's spread
REACH, FARTHEST = 2.0, 5.0      # of one step, and of all, in the same
ENOUGH = 0.05                   # nats that a step still gains
# Of the rays, beside what the firmware believes: campaigns draw their instant within 20 ms of it, and that is no fault.
AGE_SPREAD_S, AGE_STEP_S, AGE_MOST_S = 0.012, 0.01, 0.03
MOVES = ("tau", "tdelay", "damping", "neutral", "deadband")     # the figures that the columns depend on
HUBER = 4.0                     # standard deviations from which on one datum counts no more than that

# name: (median, spread of the logarithm) of healthy vehicles: tools/campaign/plan.py, a little wider
FIGURES = {"tau": (0.115, 0.2), "tdelay": (0.012, 0.5), "damping": (2.2, 0.25), "turbulence": (0.22, 0.3), "turbulence_tau": (0.5, 0.3),
           "acc_noise": (0.5, 0.35), "height_noise": (0.0045, 0.3)}
TERRAIN = {"terrain": (0.012, 0.6)}     # m rms: gravel of 3 to 20 mm, a pile of 30 mm (tools/why/planted.py), a little wider
# Standard deviations of the linear figures around what they are without news.
GROWTH, OFFSET = 0.0012, 0.3
AUTHORITY = 0.25                # m/s2 for each newton: mass and effect, +-20 % each, in tools/campaign/plan.py


@dataclass
class Span:
    begin: float
    end: float
    grid_s: numpy.ndarray
    thrust_n: numpy.ndarray
    upright: numpy.ndarray
    height_m: numpy.ndarray
    ray_s: numpy.ndarray
    ray_m: numpy.ndarray
    roll: numpy.ndarray         # at the rays
    pitch: numpy.ndarray
    frame_s: numpy.ndarray
    up: numpy.ndarray
    tilt_s: numpy.ndarray       # the tilt of the whole flight
    roll_all: numpy.ndarray
    pitch_all: numpy.ndarray
    time_s: numpy.ndarray = None        # of the events
    is_height: numpy.ndarray = None
    steps: numpy.ndarray = None
    sorted: numpy.ndarray = None
    log_middle: float = 0.0             # middle of the flight: growth counts from there
    first: tuple = FIRST                # height and speed as the span begins, rms
    free_s: float = -math.inf           # no push from before it is counted: what it made is in `first`, or the ground carried the vehicle

    def order(self):
        times = numpy.concatenate((self.ray_s, self.frame_s))
        self.sorted = numpy.argsort(times, kind="stable")
        self.time_s = times[self.sorted]
        self.is_height = (numpy.arange(len(times)) < len(self.ray_s))[self.sorted]
        rounded = numpy.round(self.time_s / EVENT_S).astype(int)
        self.steps = numpy.diff(rounded, prepend=rounded[:1])

    def merged(self, heights, felts):
        """Columns of heights and of accelerations in the order of the events."""
        return numpy.concatenate((heights, felts))[self.sorted]


def span_of(flight, begin, end):
    """It begins where the commands of LEAD_S before it are known. Which height and speed the vehicle has there is not known, wherever that is."""
    c, t_s = flight.column, flight.t_s
    begin = min(max(begin, flights.commands_since(flight, begin) + LEAD_S), end)
    grid = numpy.arange(begin - LEAD_S, end + STEP_S, STEP_S)
    at = numpy.clip(numpy.searchsorted(t_s - flight.late_s, grid + STEP_S / 2, "right") - 1, 0, len(t_s) - 1)
    thrust = numpy.where(grid < t_s[0], 0.0, c["thrust_n"][at])
    filled = flights.flight_log.filled
    roll, pitch = filled(t_s, c["roll_rad"]), filled(t_s, c["pitch_rad"])
    rays = flight.new & (flight.rays_s >= begin) & (flight.rays_s < end - 0.01)
    felt_s = t_s - flight.late_s - model.FRAME_AGE_S
    felt = flight.felt & (felt_s >= begin) & (felt_s < end - 0.01)
    ray_s = flight.rays_s[rays]
    new = flight.new
    span = Span(begin, end, grid, thrust, numpy.interp(grid, t_s - 0.05, numpy.cos(roll) * numpy.cos(pitch)),
                numpy.interp(grid, flight.rays_s[new], c["meas_m"][new]), ray_s, c["meas_m"][rays],
                numpy.interp(ray_s, t_s - 0.05, roll), numpy.interp(ray_s, t_s - 0.05, pitch), felt_s[felt], c["up_mps2"][felt], t_s - 0.05, roll, pitch)
    span.order()
    span.free_s = begin - STEP_S        # a push is a straight line between two steps: the first event lies behind the first step
    return span


def changed(span, late_s=0.0, blind=()):
    """The span as it was if its rays are older by late_s, and without the heights of the times `blind`."""
    kept = numpy.ones(len(span.ray_s), bool)
    for begin, end in blind:
        kept &= (span.ray_s < begin) | (span.ray_s >= end)
    other = replace(span, ray_s=span.ray_s[kept] - late_s, ray_m=span.ray_m[kept], roll=span.roll[kept], pitch=span.pitch[kept])
    other.order()
    other.log_middle = span.log_middle
    other.free_s = min([span.free_s, *(other.time_s[:1] - STEP_S)])     # older rays: the motion that they saw begins sooner
    return other


def spans_of(flight):
    found = [span_of(flight, begin, end) for begin, end in flight.spans]
    return [span for span in found if len(span.ray_s) >= 8 or len(span.frame_s) >= 40]


def response(span, push, damping):
    """What a push of the vehicle (m/s2 on the grid) makes of its heights and accelerations, at the span's events."""
    push = numpy.where(span.grid_s < span.free_s, 0.0, push)
    keep = math.exp(-STEP_S * damping)
    half = (1.0 - keep) / damping / 2.0
    speed = lfilter([half, half], [1.0, -keep], push)
    path = numpy.concatenate(([0.0], numpy.cumsum(0.5 * (speed[1:] + speed[:-1])) * STEP_S))
    heights = numpy.interp(span.ray_s, span.grid_s, path)
    felts = numpy.interp(span.frame_s, span.grid_s, push - damping * speed)
    return span.merged(heights, felts)


def lagged(span, f, thrust=None):
    thrust = span.thrust_n if thrust is None else thrust
    return model.lagged(model.delayed(span.grid_s, thrust, f["tdelay"] + model.PULSE_S), f["tau"])


def errors_of(f, begins=FIRST):
    """(rate of change, noise, first variance, what an acceleration sees, what a height sees) of the errors'
    states: height, speed, turbulence, and the floor's own height where the floor wanders; or those of an autopilot's loop."""
    if "neutral" in f:
        loop = {"climb_lag": 1.0 / f["damping"], "damping": AIR_DAMPING, "climb_rate": CLIMB_RATE, "climb_wander": CLIMB_WANDER_MPS}
        a, q, first, felt = model.climb_errors(f | loop)
        first[[0, 1], [0, 1]] = numpy.square(begins)        # no better known than with THRUST
        return a, q, first, felt, numpy.eye(len(a))[0]
    d, decay, terrain = f["damping"], 1.0 / f["turbulence_tau"], f.get("terrain", 0.0)
    a = numpy.array([[0.0, 1.0, 0.0, 0.0], [0.0, -d, 1.0, 0.0], [0.0, 0.0, -decay, 0.0], [0.0, 0.0, 0.0, -1.0 / TERRAIN_TAU_S]])
    q = numpy.diag([0.0, 0.0, 2.0 * f["turbulence"]**2 * decay, 2.0 * terrain**2 / TERRAIN_TAU_S])
    first = numpy.diag([*begins, f["turbulence"], terrain])**2
    return a, q, first, numpy.array([0.0, -d, 1.0, 0.0]), numpy.array([1.0, 0.0, 0.0, 1.0])


def discrete(a, q):
    """Transition and noise over a time (Van Loan). loud: the air pushes LOUD times as much."""
    n = len(a)
    pair = numpy.zeros((2 * n, 2 * n))

    def over(step_s, loud):
        noise = q.copy()
        noise[2, 2] *= LOUD**2 if loud else 1.0
        pair[:n, :n], pair[:n, n:], pair[n:, n:] = -a, noise, a.T
        e = expm(pair * step_s)
        transition = e[n:, n:].T
        return transition, transition @ e[:n, n:]
    return over


def gains_of(span, f, loud=()):
    """Of the filter: for each event the transition, the row, the gain and the standard deviation of the prediction. loud: [(begin, end)]
    in which something else than the turbulence pushes, LOUD times as much."""
    a, q, p, *rows = errors_of(f, span.first)
    over = discrete(a, q)
    inside = numpy.zeros(len(span.time_s), bool)
    for begin, end in loud:
        inside |= (span.time_s >= begin) & (span.time_s < end)
    known = {key: over(key[0] * EVENT_S, key[1]) for key in set(zip(span.steps.tolist(), inside.tolist())) if key[0] > 0}
    noise = (f["acc_noise"]**2, f["height_noise"]**2)
    found = []
    for step, high, noisy in zip(span.steps.tolist(), span.is_height.tolist(), inside.tolist()):
        transition = None
        if step > 0:
            transition, q = known[step, noisy]
            p = transition @ p @ transition.T + q
        row = rows[high]
        seen = p @ row
        variance = float(row @ seen) + noise[high]
        gain = seen / variance
        p = p - gain[:, None] * seen
        found.append((transition, row, gain, math.sqrt(variance)))
    return found


def whitened(span, gains, columns, weights=None):
    """columns: (events, any). Prediction errors in standard deviations."""
    x = numpy.zeros((len(gains[0][1]) if gains else 4, columns.shape[1]))
    result = numpy.empty_like(columns)
    for k, (transition, row, gain, sigma) in enumerate(gains):
        if transition is not None:
            x = transition @ x
        error = columns[k] - row @ x
        result[k] = error
        result[k] /= sigma
        x += gain[:, None] * error
    return result


@dataclass
class Model:
    """A flight with figures: whitened data, and what they leave."""
    kind: str                   # THRUST, CLIMB
    spans: list
    figures: dict
    names: list                 # of the linear figures
    prior: numpy.ndarray        # mean of each, and its standard deviation
    spread: numpy.ndarray
    extra: list = field(default_factory=list)   # functions (span, figures) -> (events, any): columns of a cause
    sigmas: list = field(default_factory=list)  # standard deviation of each extra column's size
    means: list = field(default_factory=list)   # and what it is expected to be; empty: 0
    loud: tuple = ()

    def columns(self, span):
        return numpy.hstack([BASE[self.kind](span, self.figures), *(make(span, self.figures) for make in self.extra)])

    def data_and_columns(self, span):
        return numpy.hstack([measured(self.kind, span, self.figures)[:, None], self.columns(span)])

    def solve(self):
        """Least squares; keeps what later columns need."""
        self.gains = [gains_of(span, self.figures, self.loud) for span in self.spans]
        white = [whitened(span, gains, self.data_and_columns(span)) for span, gains in zip(self.spans, self.gains)]
        return self.solve_white(numpy.vstack(white), numpy.array([sigma for gains in self.gains for *_, sigma in gains]))

    def solve_white(self, white, sigma):
        self.data, self.design, self.log_sigmas = white[:, 0], white[:, 1:], numpy.log(sigma)
        log_sigma = float(self.log_sigmas.sum())
        count = self.design.shape[1]
        prior = numpy.concatenate([self.prior, self.means or numpy.zeros(count - len(self.prior))])
        spread = numpy.concatenate([self.spread, self.sigmas])
        self.weight = 1.0 / spread**2
        self.refine(prior)
        self.log_likelihood = -0.5 * self.loss - log_sigma
        return self

    def refine(self, prior):
        """Robust: a datum that is HUBER standard deviations off counts as that. Two rounds of weights."""
        robust = numpy.ones(len(self.data))
        for _ in range(3):
            a = self.design * robust[:, None]
            information = a.T @ a + numpy.diag(self.weight)
            self.linear = numpy.linalg.solve(information, a.T @ (self.data * robust) + self.weight * prior)
            self.rest = self.data - self.design @ self.linear
            size = numpy.maximum(numpy.abs(self.rest), 1e-9)
            robust = numpy.sqrt(numpy.minimum(1.0, HUBER / size))
        self.robust = robust
        self.information = information
        rho = numpy.where(size <= HUBER, size**2, 2.0 * HUBER * size - HUBER**2)
        self.loss = float(rho.sum() + (self.weight * (self.linear - prior)**2).sum())
        self.log_volume = -0.5 * numpy.linalg.slogdet(information)[1] + 0.5 * float(numpy.log(self.weight).sum())

    def evidence(self):
        """Marginal: the linear figures integrated out."""
        return self.log_likelihood + self.log_volume

    def gain(self, make, sigma):
        """(nats, size, its standard deviation) of each column of make(span, figures), tried alone; sigma: how large a size is
        expected, rms. The nats are those of the marginal likelihood: a size that is free costs its Occam factor."""
        z = numpy.vstack([whitened(span, gains, make(span, self.figures)) for span, gains in zip(self.spans, self.gains)])
        z = z * self.robust[:, None]
        a, rest = self.design * self.robust[:, None], self.rest * self.robust
        shared = a.T @ z
        own = (z**2).sum(0) - (shared * numpy.linalg.solve(self.information, shared)).sum(0)
        score = z.T @ rest
        precision = numpy.maximum(own, 1e-12) + 1.0 / sigma**2
        size = score / precision
        nats = 0.5 * score * size - 0.5 * numpy.log(precision * sigma**2)
        return nats, size, 1.0 / numpy.sqrt(precision)

    def linear_figure(self, name):
        return float(self.linear[self.names.index(name)])

    def hover_n(self):
        """At the middle of the flight."""
        if self.kind == "CLIMB":
            return self.figures["neutral"]
        b, rest = self.linear_figure("authority"), self.linear_figure("rest")
        return (G - rest) / b


def measured(kind, span, f):
    """What the columns explain: of thrust, all that pushes beside the weight."""
    data = span.merged(span.ray_m, span.up)
    return data if kind == "CLIMB" else data + response(span, numpy.full(len(span.grid_s), G), f["damping"])


def thrust_columns(span, f):
    air = model.ground_effect(span.height_m) * span.upright
    thrust = lagged(span, f)
    pushes = (thrust * air, air, -(span.grid_s - span.log_middle) * thrust * air)
    columns = [response(span, push, f["damping"]) for push in pushes]
    columns.append(span.merged(numpy.zeros(len(span.ray_s)), numpy.ones(len(span.frame_s))))
    return numpy.array(columns).T


def climb_response(span, wanted, f):
    """What an autopilot makes of the climb rate that it is asked for: the loop of model.climb_motion(), within the motors' limits."""
    loop = model.climb_loop({"climb_lag": 1.0 / f["damping"], "tau": f["tau"], "damping": AIR_DAMPING})
    lag_s = 1.0 / f["damping"]
    command = numpy.array([0.0, 1.0 / (lag_s * f["tau"]), 1.0 / (lag_s * model.CLIMB_INTEGRAL_S)])
    discrete_loop = cont2discrete((loop, command[:, None], numpy.eye(3), numpy.zeros((3, 1))), STEP_S)
    over, under = ss2tf(*discrete_loop[:4])
    speed, motors = (lfilter(over[row], under, wanted) for row in (0, 1))
    path = numpy.concatenate(([0.0], numpy.cumsum(0.5 * (speed[1:] + speed[:-1])) * STEP_S))
    return span.merged(numpy.interp(span.ray_s, span.grid_s, path), numpy.interp(span.frame_s, span.grid_s, motors - AIR_DAMPING * speed))


def climb_columns(span, f):
    off = model.delayed(span.grid_s, span.thrust_n, f["tdelay"] + model.PULSE_S) - f["neutral"]
    beyond = numpy.sign(off) * numpy.maximum(numpy.abs(off) - f["deadband"], 0.0)
    beyond[span.grid_s < span.begin] = 0.0      # on the ground the motors' limits hold: what is wrong with that the first variance has
    return numpy.array([climb_response(span, beyond, f), span.merged(numpy.zeros(len(span.ray_s)), numpy.ones(len(span.frame_s)))]).T


BASE = {"THRUST": thrust_columns, "CLIMB": climb_columns}
LINEAR = {"THRUST": (["authority", "rest", "growth", "offset"], (1.4, 0.0, 0.0007, 0.0), (AUTHORITY, 3.0, GROWTH, OFFSET)),
          "CLIMB": (["rate", "offset"], (0.8, 0.0), (0.5, OFFSET))}
# `damping` is one by the lag of the autopilot's loop: so fast it holds its climb rate against the air.
CLIMB_FIGURES = FIGURES | {"damping": (2.8, 0.3), "neutral": (6.5, 0.15), "deadband": (0.25, 0.7)}
AIR_DAMPING, CLIMB_RATE, CLIMB_WANDER_MPS = 2.0, 0.8, 0.02      # medians of tools/fit/model.py


def model_of(kind, spans, figures, extra=(), sigmas=(), means=(), loud=()):
    names, prior, spread = LINEAR[kind]
    return Model(kind, spans, figures, list(names), numpy.array(prior), numpy.array(spread), list(extra), list(sigmas), list(means), tuple(loud))


def solve_together(models):
    """As solve() of each, in one pass of the filter: the models differ in their figures only."""
    first = models[0]
    whites, sigmas = [], []
    known = {}

    def prepared(span, model):
        key = (id(span), *(model.figures[name] for name in MOVES if name in model.figures))
        if key not in known:
            known[key] = model.data_and_columns(span)
        return known[key]

    for span in first.spans:
        data = numpy.stack([prepared(span, model) for model in models], axis=1)
        white, sigma = whitened_together(span, [model.figures for model in models], first.loud, data)
        whites.append(white)
        sigmas.append(sigma)
    white, sigma = numpy.concatenate(whites), numpy.concatenate(sigmas)
    for place, model in enumerate(models):
        model.solve_white(white[:, place], sigma[:, place])
    return models


def whitened_together(span, batch, loud, data):
    """(prediction errors in standard deviations (events, batch, columns), the deviations (events, batch))."""
    errors = [errors_of(f, span.first) for f in batch]
    overs = [discrete(a, q) for a, q, *_ in errors]
    inside = numpy.zeros(len(span.time_s), bool)
    for begin, end in loud:
        inside |= (span.time_s >= begin) & (span.time_s < end)
    known = {}
    for key in set(zip(span.steps.tolist(), inside.tolist())):
        if key[0] > 0:
            pairs = [over(key[0] * EVENT_S, key[1]) for over in overs]
            known[key] = numpy.array([t for t, _ in pairs]), numpy.array([q for _, q in pairs])
    count = len(batch)
    p, felt_row, height_row = (numpy.array([each[place] for each in errors]) for place in (2, 3, 4))
    noise = [numpy.array([f[name]**2 for f in batch]) for name in ("acc_noise", "height_noise")]
    x = numpy.zeros((count, p.shape[1], data.shape[2]))
    white, sigmas = numpy.empty_like(data), numpy.empty((len(data), count))
    for k, (step, high, noisy) in enumerate(zip(span.steps.tolist(), span.is_height.tolist(), inside.tolist())):
        if step > 0:
            transition, q = known[step, noisy]
            x = transition @ x
            p = transition @ p @ transition.transpose(0, 2, 1) + q
        row = height_row if high else felt_row
        seen = (p @ row[:, :, None])[:, :, 0]
        variance = (seen * row).sum(1) + noise[high]
        error = data[k] - (row[:, None, :] @ x)[:, 0, :]
        gain = seen / variance[:, None]
        x = x + gain[:, :, None] * error[:, None, :]
        p = p - gain[:, :, None] * seen[:, None, :]
        sigmas[k] = numpy.sqrt(variance)
        white[k] = error / sigmas[k][:, None]
    return white, sigmas


def fit(kind, spans, start=None, rounds=8, terrain=False, **with_cause):
    """The most likely noises and lags, by Newton's steps with the curvature that the model expects of itself (Fisher's information).
    `score` is the logarithm of the evidence there. with_cause: as model_of()."""
    table = (FIGURES if kind == "THRUST" else CLIMB_FIGURES) | (TERRAIN if terrain else {})
    middle = 0.5 * (spans[0].begin + spans[-1].end)
    for span in spans:
        span.log_middle = middle
    medians = numpy.array([math.log(median) for median, _ in table.values()])
    widths = numpy.array([width for _, width in table.values()])

    def made(units):
        return model_of(kind, spans, dict(zip(table, numpy.exp(medians + widths * units).tolist())), **with_cause)

    units = numpy.array([(math.log(start[name]) - m) / w if start and name in start else 0.0 for name, m, w in zip(table, medians, widths)])
    step, reach = DIFFERENCE * numpy.eye(len(units)), REACH
    best_units, best_cost = None, math.inf
    for _ in range(rounds):
        models = solve_together([made(units), *(made(units + one) for one in step)])
        cost = 0.5 * float(units @ units) - models[0].evidence()
        if cost >= best_cost:       # too far: half of it
            reach, units = 0.5 * reach, best_units + 0.5 * (units - best_units)
            continue
        gained, best_units, best_cost = best_cost - cost, units, cost
        if gained < ENOUGH:
            break
        slope = units - numpy.array([model.evidence() - models[0].evidence() for model in models[1:]]) / DIFFERENCE
        weight = models[0].robust[:, None]
        errors = numpy.array([model.rest - models[0].rest for model in models[1:]]).T / DIFFERENCE * weight
        sigmas = numpy.array([model.log_sigmas - models[0].log_sigmas for model in models[1:]]).T / DIFFERENCE
        errors += sigmas * models[0].rest[:, None] * weight         # what a larger deviation alone does is no news of the errors
        move = -numpy.linalg.solve(errors.T @ errors + 2.0 * sigmas.T @ sigmas + numpy.eye(len(units)), slope)
        units = numpy.clip(units + move * min(1.0, reach / float(numpy.linalg.norm(move))), -FARTHEST, FARTHEST)
    best = made(best_units).solve()
    best.score = -best_cost
    return best


def fit_aged(kind, spans):
    """(age, spans, their fit): the flight without a cause, its rays as much older or younger as is usual and likely."""
    def aged(age_s):
        older = [changed(span, age_s) for span in spans]
        found = fit(kind, older, known[0.0][1].figures if known else None)
        return older, found, found.score - 0.5 * (age_s / AGE_SPREAD_S)**2
    known = {}
    known[0.0] = aged(0.0)
    best = 0.0
    for sign in (1.0, -1.0):
        while abs(nearby := round(best + sign * AGE_STEP_S, 3)) <= AGE_MOST_S and nearby not in known:
            known[nearby] = aged(nearby)
            if known[nearby][2] < known[best][2]:
                break
            best = nearby
    return best, *known[best][:2]
