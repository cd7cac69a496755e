#!/usr/bin/env python3
"""bound.py [NEWTONS ...]: the least hover RMS that any law can have, by how much thrust it spends.

Prints, for each thrust activity (standard deviation of the commanded thrust per motor; default 0.30 0.40 0.45 0.50
1.00), the hover RMS of the optimal linear regulator and estimator (LQG) on the nominal vehicle: thrust through the
motors' lag and all of its delay, damping, turbulence; heights every 100 ms with their noise and age; accelerations
every 25 ms with theirs. Known exactly by that regulator, and so no cost to it: mass, hover thrust, tilt, the vehicle's
own figures. It may change the thrust at any time. Exit status: 0; 2 usage.
"""
import sys

import numpy
from scipy.linalg import expm, solve_discrete_are, solve_discrete_lyapunov
from scipy.optimize import brentq

STEP_S = 0.0025
GRAVITY, HOVER_N, DAMPING, LAG_S, TURBULENCE, TURBULENCE_S = 9.80665, 7.4, 2.4, 0.12, 0.2, 0.5
THRUST_STEPS = 7                # half a PWM period of 13.6 ms, 1.4 ms of pulse, 10 ms in the autopilot
HEIGHT_STEPS, HEIGHT_EVERY = 29, 40     # rays 72.5 ms old when decoded, every 100 ms
FELT_STEPS, FELT_EVERY = 6, 10  # accelerations 15 ms old, every 25 ms
HEIGHT_M = 0.0032               # rms: 3 mm common, 5 mm each of 35 rays, 220 mm times the tilt's error
FELT_MPS2 = 0.4                 # rms
CHANGE = 1e-9                   # of a covariance from period to period, taken for none
ACTIVITIES_N = (0.30, 0.40, 0.45, 0.50, 1.00)
FELT = numpy.array([0.0, -DAMPING, GRAVITY / HOVER_N, 1.0])


def sampled():
    """Height, speed, thrust and turbulence over one step: transition, what the command adds, noise covariance."""
    plant = numpy.zeros((5, 5))     # the fifth is the command
    plant[0, 1] = 1.0
    plant[1, :4] = FELT
    plant[2, 2], plant[2, 4] = -1.0 / LAG_S, 1.0 / LAG_S
    plant[3, 3] = -1.0 / TURBULENCE_S
    step = expm(plant * STEP_S)
    # Van Loan: the covariance of white noise through the plant.
    pair = numpy.zeros((8, 8))
    pair[:4, :4], pair[4:, 4:] = -plant[:4, :4], plant[:4, :4].T
    pair[3, 7] = 2.0 * TURBULENCE**2 / TURBULENCE_S
    loan = expm(pair * STEP_S)
    return step[:4, :4], step[:4, 4], loan[4:, 4:].T @ loan[:4, 4:]


class Model:
    """The vehicle and its delay lines: commands on their way, heights and accelerations on theirs."""

    def __init__(self):
        transition, command, noise = sampled()
        heights = 4 + THRUST_STEPS
        felt = heights + HEIGHT_STEPS
        size = felt + FELT_STEPS
        self.a, self.b, self.noise = numpy.zeros((size, size)), numpy.zeros(size), numpy.zeros((size, size))
        self.a[:4, :4], self.a[:4, heights - 1], self.noise[:4, :4] = transition, command, noise
        self.b[4] = 1.0
        self.a[heights, 0] = 1.0
        self.a[felt, :4] = FELT
        for begin, end in ((4, heights), (heights, felt), (felt, size)):
            for place in range(begin + 1, end):
                self.a[place, place - 1] = 1.0
        self.controlled = heights       # the states that the regulator needs
        self.height_seen, self.felt_seen = felt - 1, size - 1


def estimator(model):
    """What the measurements of each step add to the estimate's covariance, and the mean square error of the height."""
    def measure(error, place, rms):
        gain = error[:, place] / (error[place, place] + rms**2)
        return numpy.outer(gain, gain) * (error[place, place] + rms**2)

    def step(error, k):
        error = model.a @ error @ model.a.T + model.noise
        learnt = numpy.zeros_like(error)
        for place, rms, due in ((model.height_seen, HEIGHT_M, k == 0),
                                (model.felt_seen, FELT_MPS2, k % FELT_EVERY == 3)):
            if due:
                gained = measure(error, place, rms)
                error, learnt = error - gained, learnt + gained
        return (error + error.T) / 2.0, learnt

    def period(error):
        for k in range(HEIGHT_EVERY):
            error, _ = step(error, k)
        return error

    error, before = numpy.eye(len(model.b)) * 0.01, numpy.zeros(1)
    while numpy.abs(error - before).max() > CHANGE:
        error, before = period(error), error
    learnt, squares = [], []
    for k in range(HEIGHT_EVERY):
        error, gained = step(error, k)
        learnt.append(gained)
        squares.append(error[0, 0])
    return learnt, numpy.mean(squares)


def regulated(model, learnt, price):
    """Mean squares of the estimated height and of the command, when a square newton costs that many square metres."""
    n = model.controlled
    a, b, weight = model.a[:n, :n], model.b[:n, None], numpy.zeros((n, n))
    weight[0, 0] = 1.0
    worth = solve_discrete_are(a, b, weight, numpy.array([[price]]))
    gain = numpy.zeros(len(model.b))
    gain[:n] = (b.T @ worth @ a / (price + b.T @ worth @ b))[0]
    closed = model.a - numpy.outer(model.b, gain)

    def period(state):
        for gained in learnt:
            state = closed @ state @ closed.T + gained
        return state

    # What a period adds to nothing, and all that is left of the periods before.
    added = period(numpy.zeros_like(closed))
    state = solve_discrete_lyapunov(numpy.linalg.matrix_power(closed, HEIGHT_EVERY), added)
    heights, commands = [], []
    for gained in learnt:
        state = closed @ state @ closed.T + gained
        heights.append(state[0, 0])
        commands.append(gain @ state @ gain)
    return numpy.mean(heights), numpy.mean(commands)


def bounds(activities_n):
    """[hover RMS in mm] for each thrust activity."""
    model = Model()
    learnt, unknown = estimator(model)
    found = []
    for activity_n in activities_n:
        exponent = brentq(lambda x, wanted=activity_n: regulated(model, learnt, 10.0**x)[1] ** 0.5 - wanted, -10.0, 0.0,
                          xtol=1e-3)
        found.append(1000.0 * (regulated(model, learnt, 10.0**exponent)[0] + unknown) ** 0.5)
    return found


def main(argv):
    if "--help" in argv or "-h" in argv:
        print(__doc__, end="")
        return 0
    try:
        activities_n = [float(word) for word in argv] or ACTIVITIES_N
        found = bounds(activities_n)
    except ValueError as error:
        print(f"bound: {error}", file=sys.stderr)
        return 2
    for activity_n, bound_mm in zip(activities_n, found, strict=True):
        print(f"{activity_n:.2f} N: {bound_mm:.1f} mm")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
