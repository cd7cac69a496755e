#!/usr/bin/env python3
"""chapter_4_1.py [-o PNG]: the seed's simulations of chapter 4.1, before it flew anything.

The seed took the `sl_quadrotor` model of P. Corke's Robotics Toolbox, gave it a step of 1 m and changed the two gains of
its height controller: 20/0, 20/10, 150/140 (figures 4.2 to 4.4). It does not say what the controller's output is. The
toolbox has had both, so both are flown: newtons of the whole vehicle, and radians per second of each rotor. The
controller is the parallel one of the seed's equation 6, demand = feed-forward + kp e - kd z'; the toolbox's own has D
within P, with which 20/10 would not oscillate at all.

Model: z'' = T/m - g, T = 4 b w^2 (Corke's mdl_quadrotor: m 4 kg, Ct 0.0048, rotor radius 0.165 m, air 1.184 kg/m3); thrust
cannot pull down. Runge-Kutta of fourth order, 1 ms. Prints the table of docs/control.md; -o draws the six courses.
"""
import argparse
import math
import sys
from dataclasses import dataclass
from pathlib import Path

MASS_KG = 4.0
GRAVITY_MPS2 = 9.81
LIFT_COEFFICIENT = 0.0048
ROTOR_RADIUS_M = 0.165
AIR_KG_PER_M3 = 1.184
# T = Ct rho A r^2 w^2 of one rotor, equation 1 of the seed solved for T.
THRUST_PER_RADPS2 = LIFT_COEFFICIENT * AIR_KG_PER_M3 * math.pi * ROTOR_RADIUS_M**4
HOVER_RADPS = math.sqrt(MASS_KG * GRAVITY_MPS2 / (4.0 * THRUST_PER_RADPS2))
STEP_S = 0.001
SHOWN_S = 15.0
JUDGED_S = 60.0

GAINS = ((20.0, 0.0), (20.0, 10.0), (150.0, 140.0))
SAYS = {
    (20.0, 0.0): "oscillates for ever (figure 4.2)",
    (20.0, 10.0): "settles, with oscillations (figure 4.3)",
    (150.0, 140.0): "no overshoot, no error (figure 4.4)",
}


def thrust_newtons(demand):
    return max(MASS_KG * GRAVITY_MPS2 + demand, 0.0)


def thrust_rotors(demand):
    return 4.0 * THRUST_PER_RADPS2 * max(HOVER_RADPS + demand, 0.0) ** 2


OUTPUTS = {"newtons": thrust_newtons, "rotor rad/s": thrust_rotors}


def simulate(kp, kd, thrust_of, duration_s=JUDGED_S):
    """[z in metres] of a step to 1 m, every STEP_S."""
    def slope(z_m, speed_mps):
        return speed_mps, thrust_of(kp * (1.0 - z_m) - kd * speed_mps) / MASS_KG - GRAVITY_MPS2

    z, v, course = 0.0, 0.0, [0.0]
    for _ in range(round(duration_s / STEP_S)):
        a1, b1 = slope(z, v)
        a2, b2 = slope(z + 0.5 * STEP_S * a1, v + 0.5 * STEP_S * b1)
        a3, b3 = slope(z + 0.5 * STEP_S * a2, v + 0.5 * STEP_S * b2)
        a4, b4 = slope(z + STEP_S * a3, v + STEP_S * b3)
        z += STEP_S / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
        v += STEP_S / 6.0 * (b1 + 2.0 * b2 + 2.0 * b3 + b4)
        course.append(z)
    return course


@dataclass(frozen=True)
class Response:
    rise_s: float           # 10 to 90 %
    overshoot_percent: float
    settled_s: float        # within 5 % from then on; infinity: never
    error_mm: float         # mean of the last 10 s


def respond(course):
    first = {share: next(at for at, z in enumerate(course) if z >= share) * STEP_S for share in (0.1, 0.9)}
    outside = max((at for at, z in enumerate(course) if abs(z - 1.0) > 0.05), default=0)
    last = course[-round(10.0 / STEP_S):]
    return Response(first[0.9] - first[0.1], 100.0 * (max(course) - 1.0),
                    (outside + 1) * STEP_S if outside + 1 < len(course) - len(last) else math.inf,
                    1000.0 * (sum(last) / len(last) - 1.0))


def table(responses):
    """responses: {(output, gains): Response}; a cell has a value for each unit of the output."""
    def cells(gains):
        both = [responses[output, gains] for output in OUTPUTS]
        never = [math.isinf(r.settled_s) for r in both]
        yield [f"{r.rise_s:.2f}" for r in both]
        yield [f"{max(r.overshoot_percent, 0):.1f}" for r in both]
        yield ["never" if n else f"{r.settled_s:.1f}" for r, n in zip(both, never, strict=True)]
        yield ["-" if n else f"{abs(r.error_mm):.0f}" for r, n in zip(both, never, strict=True)]

    lines = [f"Values for an output in {', then in '.join(OUTPUTS)}:", "",
             "| kp / kd | the seed says | rise s | overshoot % | within 5 % after s | error mm |", "|---|---|---|---|---|---|"]
    for kp, kd in GAINS:
        lines.append(f"| {kp:.0f} / {kd:.0f} | {SAYS[kp, kd]} | {' | '.join('; '.join(each) for each in cells((kp, kd)))} |")
    return "\n".join(lines)


def draw(courses, path):
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(1, len(GAINS), figsize=(11, 3.2), sharey=True, layout="constrained")
    shown = round(SHOWN_S / STEP_S)
    times_s = [at * STEP_S for at in range(shown)]
    for axis, gains in zip(axes, GAINS, strict=True):
        for output, style in zip(OUTPUTS, ("-", "--"), strict=True):
            axis.plot(times_s, courses[output, gains][:shown], style, label=output)
        axis.axhline(1.0, color="0.5", linewidth=0.8)
        axis.set_title(f"kp {gains[0]:.0f}, kd {gains[1]:.0f}: {SAYS[gains]}", fontsize=9)
        axis.set_xlabel("s")
    axes[0].set_ylabel("height, m")
    axes[-1].legend(title="controller's output", fontsize=8, loc="lower right")
    figure.savefig(path, dpi=110, metadata={"Software": None})


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", type=Path, metavar="PNG", help="draws the courses there")
    arguments = parser.parse_args(argv)
    courses = {(output, gains): simulate(*gains, thrust_of) for gains in GAINS for output, thrust_of in OUTPUTS.items()}
    print(table({key: respond(course) for key, course in courses.items()}))
    if arguments.o:
        draw(courses, arguments.o)
        print(arguments.o)
    return 0


if __name__ == "__main__":
    sys.exit(main())
