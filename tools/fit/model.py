"""The vehicle as a few differential equations, and how likely a flight is with a set of figures.

Prediction-error method (Ljung, System Identification, chapters 7 and 9). The equations are those of docs/control.md. The
throttle gives thrust, behind a dead time and a lag; or it gives a climb rate, by the autopilot's own speed loop. What the
commands alone would do is simulated; what is left of heights and accelerations goes through a Kalman filter, whose states
are the errors of height and speed and the turbulence. Its one-step prediction errors are white, so their likelihood is that
of the figures, and its curvature gives intervals. Noises and turbulence are figures like the others.

Parameters are searched as logarithms where they are positive. A weak prior (median, spread) keeps a figure that the flight
says nothing about where vehicles of this kind have it; `excited` tells those apart.
"""
import math
from dataclasses import dataclass, field

import numpy
from scipy.linalg import expm
from scipy.optimize import minimize
from scipy.signal import lfilter
from scipy.stats import t as student

GRAVITY_MPS2 = 9.80665
STEP_S = 0.005                  # of the simulation of the model
EVENT_STEP_S = 0.0025           # to which the filter rounds the time between two measurements
ROTOR_RADIUS_M = 0.127          # 10 inch propellers, seed chapter 2
ROTOR_ABOVE_GEAR_M = 0.28
MOTORS_TURN_N, THROTTLE_FULL_N = 1.0, 11.76
CLIMB_INTEGRAL_S = 0.4          # of an autopilot's speed loop, assumed as in sim/devices/quadrotor.c
# The pulse is latched every 13.6 ms and acts at its own end, 1.4 ms at hover: half a period and the pulse, on average.
PULSE_S = 0.0068 + 0.0014
ROUNDED_S = 0.003               # chosen: a pulse's place within its period, 3.9 ms rms, does not quite average out over a flight
FRAME_AGE_S = 0.0236            # of an acceleration when its frame is complete: control/est/estimator.c
COMMAND_NOISE_N = 0.01          # per root of a hertz: steps of 0.3 N, each 4 ms sooner or later, 40 a second
WANDER_S = 10.0
SOFT_LIMIT_MPS2 = 0.3           # beyond a limit the integral waits, little by little: the likelihood must not jump
FIRST = {"height": 0.1, "speed": 0.5, "push": 2.0}     # what is not known at the start of a stretch, rms
OUTLIER = 4.0                   # standard deviations of a height's prediction error
DIFFERENCE = 1e-4
BLOCK_S = 1.0                   # scores within it may be correlated
FREE_LEAST = 0.5                # share of the blocks: of a short log the prior holds what the flight does not
AT_REST, IDLE_MAX, REFUSED_MAX = 0.05, 2, 7
STARTS = {"THRUST": ({}, {"gain": 0.8, "tau": 0.06}), "CLIMB": ({}, {"climb_deadband": 0.08, "climb_rate": 0.6})}
INTERVAL = 1.645                # standard deviations of 90 %


@dataclass(frozen=True)
class Figure:
    """A parameter of the model. Logarithmic: median and spread are those of the logarithm."""
    median: float
    spread: float
    unit: str
    logarithmic: bool = True

    def to(self, value):
        return math.log(value) if self.logarithmic else value

    def back(self, place):
        return math.exp(place) if self.logarithmic else place

    def prior(self):
        return self.to(self.median), self.spread


NOISES = {
    "turbulence": Figure(0.2, 0.7, "m/s2"),
    "turbulence_tau": Figure(0.5, 0.4, "s"),
    "acc_noise": Figure(0.5, 0.7, "m/s2"),
    "height_noise": Figure(0.004, 0.5, "m"),
    "acc_bias": Figure(0.0, 0.5, "m/s2", logarithmic=False),
}
THRUST = {
    "hover_thrust": Figure(7.0, 0.3, "N"),
    "gain": Figure(1.0, 0.4, "-"),
    "tau": Figure(0.10, 0.5, "s"),
    "tdelay": Figure(0.015, 0.015, "s", logarithmic=False),
    "damping": Figure(2.0, 0.5, "1/s"),
    "sag": Figure(0.0008, 0.0006, "1/s", logarithmic=False),
} | NOISES
CLIMB = {
    "climb_neutral": Figure(7.0, 0.3, "N"),
    "climb_rate": Figure(0.8, 0.6, "m/s/N"),
    "climb_deadband": Figure(0.3, 0.3, "N", logarithmic=False),
    "climb_lag": Figure(0.3, 0.6, "s"),
    "hover_thrust": Figure(7.0, 0.1, "N"),
    "tau": Figure(0.10, 0.3, "s"),
    "tdelay": Figure(0.015, 0.015, "s", logarithmic=False),
    "damping": Figure(2.0, 0.3, "1/s"),
    "climb_wander": Figure(0.02, 0.5, "m/s"),
} | NOISES
KINDS = {"THRUST": THRUST, "CLIMB": CLIMB}
# What the equations leave out and a flight may show: rotors that slow down later than they spin up (logarithm of the lags'
# ratio; tau is their geometric mean), thrust that grows faster than the throttle (of the square of its relative change), and more
# of it at first than what stays, until the air through the rotors follows.
BEYOND = {"THRUST": {"slower": Figure(0.0, 0.5, "-", logarithmic=False), "curve": Figure(0.0, 0.5, "-", logarithmic=False),
                     "inflow": Figure(0.0, 0.5, "-", logarithmic=False), "inflow_lag": Figure(0.07, 0.4, "s")},
          "CLIMB": {}}
# With logs that have the battery's voltage: the thrust at one throttle goes with it to the power of this. 0: the autopilot
# compensates. 1.65 by ArduPilot's MOT_THST_EXPO (sim/devices/quadrotor.h), 2 by a thrust that goes with the square of the speed.
VOLTS = {"THRUST": {"volts_power": Figure(1.0, 0.8, "-", logarithmic=False)}, "CLIMB": {}}
TABLES = {kind: table | BEYOND[kind] | VOLTS[kind] for kind, table in KINDS.items()}
TELLS = 16.0                    # twice a log-likelihood, expected and reached: less is no proof of a figure of BEYOND


@dataclass
class Stretch:
    """A part of a flight in the air, without gaps. Times in seconds of the log."""
    grid_s: numpy.ndarray
    thrust_n: numpy.ndarray     # commanded, on the grid
    upright: numpy.ndarray      # cos roll cos pitch, on the grid
    height_m: numpy.ndarray     # on the grid, for the ground effect alone
    ray_s: numpy.ndarray        # instants of the rays
    ray_height_m: numpy.ndarray
    frame_s: numpy.ndarray      # instants of the accelerations
    up_mps2: numpy.ndarray      # upwards, gravity removed
    begin_s: float = 0.0        # of the log: sag counts from there
    kept: numpy.ndarray = field(default=None)   # which heights are no outliers
    volts: numpy.ndarray = field(default=None)  # of the battery, on the grid; None: not measured
    volts_share: numpy.ndarray = field(default=None)    # of the mean of all stretches


def lagged(signal, lag_s):
    """First-order lag, at rest at its first value: of a signal given by the means of the steps, at the steps' beginnings."""
    keep = math.exp(-STEP_S / lag_s)
    return lfilter([0.0, 1.0 - keep], [1.0, -keep], signal, zi=[signal[0]])[0]


def lagged_both_ways(signal, lag_s, slower):
    """A lag upwards and a longer one downwards."""
    up, down = (1.0 - math.exp(-STEP_S / (lag_s * math.exp(sign * slower / 2.0))) for sign in (-1.0, 1.0))
    result, now = [], float(signal[0])
    for wanted in signal.tolist():
        result.append(now)
        now += (up if wanted > now else down) * (wanted - now)
    return numpy.array(result)


def delayed(grid_s, signal, delay_s):
    """By the mean of each step, so that the result changes smoothly with the delay."""
    total = numpy.concatenate(([0.0], numpy.cumsum(signal))) * STEP_S
    edges = numpy.concatenate((grid_s, [grid_s[-1] + STEP_S]))
    shifted = numpy.interp(numpy.concatenate((grid_s, [grid_s[-1] + STEP_S])) - delay_s, edges, total)
    result = numpy.diff(shifted) / STEP_S
    result[grid_s < grid_s[0] + delay_s + STEP_S] = signal[0]
    return result


def ground_effect(height_m):
    ratio = ROTOR_RADIUS_M / (4.0 * (numpy.maximum(height_m, 0.0) + ROTOR_ABOVE_GEAR_M))
    return 1.0 / (1.0 - 2.0 * ratio**2)


def compare_volts(stretches):
    """Sets each stretch's share of their mean voltage, and returns that mean. None: not all have been measured."""
    for stretch in stretches:
        stretch.volts_share = None
    if any(stretch.volts is None for stretch in stretches):
        return None
    mean_v = float(numpy.mean([stretch.volts.mean() for stretch in stretches]))
    for stretch in stretches:
        stretch.volts_share = stretch.volts / mean_v
    return mean_v


def thrust_motion(stretch, batch):
    """Speeds and accelerations by the commands alone, (batch, grid)."""
    both = [one_thrust_motion(stretch, f) for f in batch]
    return numpy.array([speed for speed, _ in both]), numpy.array([push for _, push in both])


def one_thrust_motion(stretch, f):
    command_n = delayed(stretch.grid_s, stretch.thrust_n, f["tdelay"] + PULSE_S)
    if "slower" in f:
        thrust_n = lagged_both_ways(command_n, f["tau"], f["slower"])
        thrust_n = thrust_n + f["inflow"] * (thrust_n - lagged(thrust_n, f["inflow_lag"]))
    else:
        thrust_n = lagged(command_n, f["tau"])
    hover_n = f["hover_thrust"] * (1.0 + f["sag"] * (stretch.grid_s - stretch.begin_s))
    if "volts_power" in f:
        thrust_n = thrust_n * stretch.volts_share**f["volts_power"]
    change = (thrust_n - hover_n) / f["hover_thrust"]
    share = 1.0 + f["gain"] * change + f.get("curve", 0.0) * change**2
    push = GRAVITY_MPS2 * (share * ground_effect(stretch.height_m) * stretch.upright - 1.0)
    keep = math.exp(-STEP_S * f["damping"])
    half = (1.0 - keep) / f["damping"] / 2.0
    speed = lfilter([half, half], [1.0, -keep], push)
    return speed, push - f["damping"] * speed


def climb_loop(f):
    """A PI loop of the speed around the motors' lag and the damped mass. States: speed, push of the motors, integral."""
    lag, tau = f["climb_lag"], f["tau"]
    return numpy.array([[-f["damping"], 1.0, 0.0], [-1.0 / (lag * tau), -1.0 / tau, 1.0 / tau],
                     [-1.0 / (lag * CLIMB_INTEGRAL_S), 0.0, 0.0]])


def column(batch, name):
    return numpy.array([f[name] for f in batch])


def climb_motion(stretch, batch):
    """Speeds and accelerations by the commands alone, (batch, grid). The loop is simulated step by step, because the motors
    can give neither less than nothing nor more than all, and the autopilot's integral waits meanwhile."""
    commands = numpy.array([delayed(stretch.grid_s, stretch.thrust_n, f["tdelay"] + PULSE_S) for f in batch])
    off_n = commands - column(batch, "climb_neutral")[:, None]
    beyond_n = numpy.sign(off_n) * numpy.maximum(numpy.abs(off_n) - column(batch, "climb_deadband")[:, None], 0.0)
    wanted = (column(batch, "climb_rate")[:, None] * beyond_n).T
    lag, damping, hover_n = column(batch, "climb_lag"), column(batch, "damping"), column(batch, "hover_thrust")
    follow = 1.0 - numpy.exp(-STEP_S / column(batch, "tau"))
    least, most = GRAVITY_MPS2 * (MOTORS_TURN_N / hover_n - 1.0), GRAVITY_MPS2 * (THROTTLE_FULL_N / hover_n - 1.0)
    speed, push, integral = numpy.zeros((3, len(batch)))
    speeds, felt = numpy.zeros_like(wanted), numpy.zeros_like(wanted)
    for k, wanted_mps in enumerate(wanted):
        asked = (wanted_mps - speed) / lag
        free = asked + integral
        given = numpy.clip(free, least, most)
        waits = numpy.minimum(numpy.abs(free - given) / SOFT_LIMIT_MPS2, 1.0)
        integral = integral + (1.0 - waits) * asked * (STEP_S / CLIMB_INTEGRAL_S)
        before, push = push, push + follow * (given - push)
        felt[k], speeds[k] = before - damping * speed, speed
        speed = speed + STEP_S * (0.5 * (before + push) - damping * speed)
    return speeds.T, felt.T


def thrust_errors(f):
    """(transition rate, noise intensity, first spread, what an accelerometer sees) of what the commands do not explain:
    height, speed, turbulence."""
    a = numpy.array([[0.0, 1.0, 0.0], [0.0, -f["damping"], 1.0], [0.0, 0.0, -1.0 / f["turbulence_tau"]]])
    q = numpy.diag([0.0, 0.0, 2.0 * f["turbulence"]**2 / f["turbulence_tau"]])
    return a, q, numpy.diag([FIRST["height"], FIRST["speed"], f["turbulence"]])**2, numpy.array([0.0, -f["damping"], 1.0])


def climb_errors(f):
    """The same, of a loop that works against the turbulence; and what the autopilot's own speed is off (a barometer wanders)."""
    a, q = numpy.zeros((6, 6)), numpy.zeros((6, 6))
    command = numpy.array([0.0, 1.0 / (f["climb_lag"] * f["tau"]), 1.0 / (f["climb_lag"] * CLIMB_INTEGRAL_S)])
    a[0, 1] = 1.0
    a[1:4, 1:4] = climb_loop(f)
    a[1, 4], a[4, 4] = 1.0, -1.0 / f["turbulence_tau"]
    a[1:4, 5], a[5, 5] = command, -1.0 / WANDER_S
    # The pulse is latched every 13.6 ms: when exactly, the log does not say. The loop forgives a turbulence, not this.
    q[1:4, 1:4] = (f["climb_rate"] * COMMAND_NOISE_N)**2 * numpy.outer(command, command)
    q[4, 4] = 2.0 * f["turbulence"]**2 / f["turbulence_tau"]
    q[5, 5] = 2.0 * f["climb_wander"]**2 / WANDER_S
    first = numpy.diag([FIRST["height"], FIRST["speed"], FIRST["push"], FIRST["push"], f["turbulence"], f["climb_wander"]])**2
    return a, q, first, numpy.array([0.0, -f["damping"], 1.0, 0.0, 1.0, 0.0])


MOTION = {"THRUST": thrust_motion, "CLIMB": climb_motion}
ERRORS = {"THRUST": thrust_errors, "CLIMB": climb_errors}


def discrete(a, q, step_s):
    """Transition and noise covariance over a step (Van Loan)."""
    n = len(a)
    pair = numpy.zeros((2 * n, 2 * n))
    pair[:n, :n], pair[:n, n:], pair[n:, n:] = -a, q, a.T
    e = expm(pair * step_s)
    transition = e[n:, n:].T
    return transition, transition @ e[:n, n:]


@dataclass
class Events:
    """Heights and accelerations in the order of their instants."""
    time_s: numpy.ndarray
    is_height: numpy.ndarray
    index: numpy.ndarray
    steps: numpy.ndarray        # EVENT_STEP_S since the one before


def events_of(stretch):
    times = numpy.concatenate((stretch.ray_s, stretch.frame_s))
    is_height = numpy.concatenate((numpy.ones(len(stretch.ray_s), bool), numpy.zeros(len(stretch.frame_s), bool)))
    index = numpy.concatenate((numpy.arange(len(stretch.ray_s)), numpy.arange(len(stretch.frame_s))))
    order = numpy.argsort(times, kind="stable")
    rounded = numpy.round(times[order] / EVENT_STEP_S).astype(int)
    return Events(times[order], is_height[order], index[order], numpy.diff(rounded, prepend=rounded[0]))


def unexplained(stretch, f, speed, push):
    """Heights and accelerations less what the commands do."""
    path = numpy.concatenate(([0.0], numpy.cumsum(0.5 * (speed[1:] + speed[:-1])) * STEP_S))
    heights = stretch.ray_height_m - numpy.interp(stretch.ray_s, stretch.grid_s, path)
    felt = stretch.up_mps2 - numpy.interp(stretch.frame_s, stretch.grid_s, push) - f["acc_bias"]
    heights = heights - heights[0]
    return heights, felt


def innovations(stretch, kind, batch):
    """Prediction errors and their variances, (events, batch) each, for a batch of figures."""
    events = events_of(stretch)
    residual = numpy.empty((len(events.time_s), len(batch)))
    models = []
    for place, (f, speed, push) in enumerate(zip(batch, *MOTION[kind](stretch, batch), strict=True)):
        heights, felt = unexplained(stretch, f, speed, push)
        residual[:, place] = numpy.where(events.is_height, heights[numpy.minimum(events.index, len(heights) - 1)],
                                         felt[numpy.minimum(events.index, len(felt) - 1)])
        models.append(ERRORS[kind](f))
    steps = {int(step): [discrete(a, q, step * EVENT_STEP_S) for a, q, _, _ in models] for step in set(events.steps)}
    steps = {step: (numpy.array([one[0] for one in pairs]), numpy.array([one[1] for one in pairs]))
             for step, pairs in steps.items()}
    p = numpy.array([model[2] for model in models])
    felt_row = numpy.array([model[3] for model in models])
    height_row = numpy.zeros_like(felt_row)
    height_row[:, 0] = 1.0
    height_variance = numpy.array([f["height_noise"]**2 for f in batch])
    felt_variance = numpy.array([f["acc_noise"]**2 for f in batch])
    x = numpy.zeros_like(felt_row)
    errors, variances = numpy.zeros_like(residual), numpy.ones_like(residual)
    kept = stretch.kept if stretch.kept is not None else numpy.ones(len(stretch.ray_s), bool)
    for k, (step, is_height, index) in enumerate(zip(events.steps, events.is_height, events.index, strict=True)):
        if step > 0:
            transition, noise = steps[int(step)]
            x = numpy.matmul(transition, x[:, :, None])[:, :, 0]
            p = transition @ p @ transition.transpose(0, 2, 1) + noise
        row = height_row if is_height else felt_row
        seen = numpy.matmul(p, row[:, :, None])[:, :, 0]
        variance = (seen * row).sum(1) + (height_variance if is_height else felt_variance)
        error = residual[k] - (x * row).sum(1)
        errors[k], variances[k] = error, variance
        if is_height and not kept[index]:
            variances[k] = numpy.nan
            continue
        gain = seen / variance[:, None]
        x = x + gain * error[:, None]
        p = p - gain[:, :, None] * seen[:, None, :]
    return events, errors, variances


class Likelihood:
    """Twice the negative logarithm of the likelihood (and of the prior) of the figures, with its gradient and the
    curvature that is expected (Fisher's information)."""

    def __init__(self, kind, stretches, held=None, beyond=False):
        """held: figures that are not searched; beyond: whether those of BEYOND are, too."""
        self.kind, self.stretches, self.held = kind, stretches, held or {}
        measured = all(stretch.volts_share is not None for stretch in stretches)
        self.table = KINDS[kind] | (BEYOND[kind] if beyond else {}) | (VOLTS[kind] if measured else {})
        self.names = [name for name in self.table if name not in self.held]
        self.center = numpy.array([self.table[name].prior()[0] for name in self.names])
        self.weight = numpy.array([1.0 / self.table[name].prior()[1]**2 for name in self.names])
        self.scale = numpy.array([self.table[name].prior()[1] for name in self.names])
        self.at = None

    def figures(self, units):
        """The search is in units of each prior's spread around its median."""
        return self.held | {name: self.table[name].back(c + u * s)
                            for name, c, u, s in zip(self.names, self.center, units, self.scale, strict=True)}

    def units(self, figures):
        return numpy.array([(self.table[name].to(figures[name]) - c) / s
                            for name, c, s in zip(self.names, self.center, self.scale, strict=True)])

    def look(self, units):
        if self.at is not None and numpy.array_equal(self.at, units):
            return
        self.at = numpy.array(units)
        steps = DIFFERENCE * numpy.eye(len(units))
        batch = [self.figures(units)] + [self.figures(units + step) for step in steps]
        self.value, self.gradient = float(self.at @ self.at), 2.0 * self.at
        self.information = 2.0 * numpy.eye(len(units))
        self.scores, self.count = [], 0
        for stretch in self.stretches:
            self.add(stretch, *innovations(stretch, self.kind, batch))

    def add(self, stretch, events, errors, variances):
        good = ~numpy.isnan(variances[:, 0])
        e, v, t = errors[good], variances[good], events.time_s[good]
        each = e**2 / v + numpy.log(v)
        slope = (each[:, 1:] - each[:, :1]) / DIFFERENCE
        self.value += float(each[:, 0].sum())
        self.gradient = self.gradient + slope.sum(0)
        e_slope = (e[:, 1:] - e[:, :1]) / DIFFERENCE / numpy.sqrt(v[:, :1])
        v_slope = (v[:, 1:] - v[:, :1]) / DIFFERENCE / v[:, :1]
        self.information = self.information + 2.0 * e_slope.T @ e_slope + v_slope.T @ v_slope
        block = ((t - t[0]) / BLOCK_S).astype(int)
        self.scores += [slope[block == b].sum(0) for b in range(block.max() + 1)]
        self.count += len(t)

    def fun(self, units):
        self.look(units)
        return self.value

    def jac(self, units):
        self.look(units)
        return self.gradient

    def hess(self, units):
        self.look(units)
        return self.information

    def covariance(self, units):
        """In units. The larger, figure by figure, of what the model expects of its own errors and of what the scores of
        the flight's seconds show (sandwich). The seconds are few: what the figures took of their freedom is given back
        (MacKinnon and White, J. Econometrics 29, 1985), and the spread is that whose normal 90 % interval is Student's."""
        self.look(units)
        bread = numpy.linalg.inv(self.information)
        expected = 2.0 * bread
        scores = numpy.array(self.scores)
        meat = scores.T @ scores + 4.0 * numpy.eye(len(units))
        shown = bread @ meat @ bread
        taken = float(numpy.sum(1.0 - numpy.minimum(numpy.diag(expected), 1.0)))
        free = max(len(scores) - taken, FREE_LEAST * len(scores))
        widen = numpy.sqrt(numpy.maximum(len(scores) / free * numpy.diag(shown) / numpy.diag(expected), 1.0))
        found = expected * numpy.outer(widen, widen) * (student.ppf(0.95, free) / INTERVAL)**2
        rounded = numpy.where(numpy.array(self.names) == "tdelay", ROUNDED_S / self.scale, 0.0)
        return found + numpy.diag(rounded**2)


@dataclass
class Fit:
    kind: str
    table: dict
    figures: dict               # name: value
    units: numpy.ndarray
    covariance: numpy.ndarray   # in units
    loss: float                 # twice the negative log-likelihood
    likelihood: Likelihood
    outliers: int
    simple: dict                # figures without those of BEYOND, where a flight shows these; else the same

    def interval(self, name):
        """90 %."""
        place = list(self.table).index(name)
        spread = math.sqrt(self.covariance[place, place])
        return tuple(self.likelihood.figures(self.units + sign * INTERVAL * spread * numpy.eye(len(self.units))[place])[name]
                     for sign in (-1.0, 1.0))

    def excited(self, name):
        """Share of what is known of this figure that comes from the flight, 0 to 1."""
        place = list(self.table).index(name)
        return 1.0 - min(self.covariance[place, place], 1.0)

    def draw(self, rng):
        return self.likelihood.figures(rng.multivariate_normal(self.units, self.covariance))


def start_of(kind, stretches):
    """Figures to begin with: the thrust that was needed on average hovers."""
    mean_n = float(numpy.mean(numpy.concatenate([stretch.thrust_n for stretch in stretches])))
    figures = {name: figure.median for name, figure in (KINDS[kind] | VOLTS[kind]).items()}
    figures["hover_thrust" if kind == "THRUST" else "climb_neutral"] = mean_n
    return figures


def mark_outliers(stretch, kind, figures):
    """Heights whose prediction error no noise explains. Returns how many."""
    events, errors, variances = innovations(stretch, kind, [figures])
    off = numpy.abs(errors[:, 0]) > OUTLIER * numpy.sqrt(variances[:, 0])
    kept = numpy.ones(len(stretch.ray_s), bool)
    kept[events.index[events.is_height & off]] = False
    stretch.kept = kept
    return int((~kept).sum())


def search(kind, stretches, start, held=None, beyond=False):
    likelihood = Likelihood(kind, stretches, held, beyond)
    state = {"best": math.inf, "idle": 0, "refused": 0}

    def progress(units):
        """Enough: the intervals are far wider than what is still to be gained. A step that was refused makes the next one
        shorter; that is no rest yet."""
        value = likelihood.fun(units)
        gained, state["best"] = state["best"] - value, min(state["best"], value)
        state["refused"] = state["refused"] + 1 if gained == 0.0 else 0
        state["idle"] += 0.0 < gained < AT_REST
        if state["idle"] >= IDLE_MAX or state["refused"] >= REFUSED_MAX:
            raise StopIteration

    found = minimize(likelihood.fun, likelihood.units(start), jac=likelihood.jac, hess=likelihood.hess, method="trust-exact",
                     callback=progress, options={"gtol": 0.05, "maxiter": 60, "initial_trust_radius": 1.0,
                                                 "max_trust_radius": 4.0})
    return likelihood, found.x, float(found.fun)


def best_of(kind, stretches):
    """The most likely of what several starts lead to: there are valleys, and a strong, slow vehicle in thick air looks much
    like a weak, quick one."""
    starts = [start_of(kind, stretches) | other for other in STARTS[kind]]
    return min((search(kind, stretches, start) for start in starts), key=lambda one: one[2])


def beyond(likelihood, units, loss):
    """The same, or a fit with the figures of BEYOND where the slope and the curvature of the likelihood promise much of them
    (a score test) and a search keeps the promise."""
    kind, stretches = likelihood.kind, likelihood.stretches
    if not BEYOND[kind]:
        return likelihood, units, loss
    figures = likelihood.figures(units) | {name: figure.median for name, figure in BEYOND[kind].items()}
    wide = Likelihood(kind, stretches, beyond=True)
    wide.look(wide.units(figures))
    if 0.5 * wide.gradient @ numpy.linalg.solve(wide.information, wide.gradient) < TELLS:
        return likelihood, units, loss
    found = search(kind, stretches, figures, beyond=True)
    return found if found[2] < loss - TELLS else (likelihood, units, loss)


def response_s(f):
    """Lag and dead time together; of two lags their mean."""
    return f["tau"] * math.cosh(f.get("slower", 0.0) / 2.0) + f["tdelay"]


def fit(kind, stretches):
    for stretch in stretches:
        stretch.kept = None
    likelihood, units, loss = best_of(kind, stretches)
    outliers = sum(mark_outliers(stretch, kind, likelihood.figures(units)) for stretch in stretches)
    if outliers > 0:
        likelihood, units, loss = search(kind, stretches, likelihood.figures(units))
    simple = likelihood.figures(units)
    likelihood, units, loss = beyond(likelihood, units, loss)
    return Fit(kind, likelihood.table, likelihood.figures(units), units, likelihood.covariance(units), loss, likelihood, outliers,
               simple)
