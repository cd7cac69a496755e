"""Flights with a cause planted, and healthy ones: what the tests and acceptance.py ask `why` about.

Everything is drawn from a text of seed and number: the vehicle, the law, the references, and of a planted cause where, when and how
much. The vehicles are those of tools/fit/acceptance.py around the plant's middle; GRAV is set as an operator sets it, up to 0.6 N
off. `why` sees what the chip's recorder holds of the flight, nothing else.
"""
import math
import random
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

LAND_S, END_S = 19.0, 25.0
TRIM_N = 0.6                    # GRAV is off by so much on a healthy vehicle
PID_TUNED = {"KP": 0.0068, "KD": 0.0157, "KI": 0.0006}


@dataclass
class Plan:
    """A flight to be flown."""
    cause: str                  # the key of a cause in causes.TABLE; "nothing"
    settings: dict = field(default_factory=dict)        # of the operator
    plant: dict = field(default_factory=dict)
    lines: list = field(default_factory=list)           # of the scenario file
    seed: int = 1
    second_m: float = 0.0       # the higher reference
    csv: bool = False           # of fly --csv; else the recorder's dump


def healthy(rng):
    """A vehicle and its flight."""
    hover_n = 7.0 * rng.uniform(0.85, 1.15)
    law = rng.choice(("EST", "EST", "PIDT"))
    plant = {"hover_thrust": hover_n, "gain": rng.uniform(0.8, 1.2), "tau": rng.uniform(0.09, 0.15), "damping": rng.uniform(1.5, 3.0),
             "tdelay": rng.uniform(0.005, 0.020), "sag": rng.uniform(0.0, 0.0015), "turbulence": 0.2 * rng.uniform(0.8, 1.5),
             "ray_instant": 0.034 + rng.uniform(-0.02, 0.02), "acc_bias": rng.uniform(-0.25, 0.25), "acc_noise": 0.4 * rng.uniform(1.0, 1.5),
             "ray_noise": 5.0 * rng.uniform(1.0, 2.0), "common_noise": 3.0 * rng.uniform(1.0, 1.5),
             "attitude_rms": math.radians(2.0) * rng.uniform(0.8, 1.5)}
    settings = {"LAW": law, "GRAV": hover_n + rng.uniform(-TRIM_N, TRIM_N)}
    first_m = rng.uniform(0.4, 0.7)
    second_m = first_m + rng.uniform(0.15, 0.3)
    lines = [f"reference {first_m:.2f}", f"at {rng.uniform(6.0, 7.0):.1f} SETR {second_m:.2f}",
             f"at {rng.uniform(12.0, 13.0):.1f} SETR {first_m:.2f}"]
    return Plan("nothing", settings, plant, lines, rng.randrange(1, 10**6), second_m, rng.random() < 0.3)


def grav(plan, rng):
    sign = -1.0 if plan.settings["LAW"] == "EST" else rng.choice((-1.0, 1.0))
    plan.settings["GRAV"] = plan.plant["hover_thrust"] + sign * rng.uniform(2.3, 2.9)


def hot(plan, rng):
    more = rng.uniform(2.4, 3.2)
    if plan.settings["LAW"] == "EST":        # VELK goes to 12 only; GAIN below what is true makes each newton two or three
        plan.settings |= {"VELK": 12.0, "GAIN": 1.5 * plan.plant["gain"] / more}
    else:
        plan.settings |= {"PKP": 6.0 * more, "PKD": 2.6 * more}


def cold(plan, rng):
    less = rng.uniform(0.2, 0.35)
    for name, value in {"EST": {"POSK": 2.3, "VELK": 8.0}, "PIDT": {"PKP": 6.0, "PKD": 2.6, "PKI": 1.4}}[plan.settings["LAW"]].items():
        plan.settings[name] = value * less


def saturation(plan, rng):
    """The seed's window around GRAV, set too narrow."""
    window_n = rng.uniform(0.15, 0.3)
    plan.settings |= PID_TUNED | {"LAW": "PID", "USAT": window_n, "DSAT": window_n,
                                  "GRAV": plan.plant["hover_thrust"] + rng.uniform(-0.05, 0.1)}


def late(plan, rng):
    plan.plant["scan_late"] = rng.uniform(0.06, 0.09)


def colours(plan, rng):
    offset_mm = rng.choice((-1.0, 1.0)) * rng.uniform(28.0, 45.0)
    plan.lines += [f"place surface other 0.5 0 0 {offset_mm:.1f} 0", f"place tiles white other {rng.uniform(0.6, 1.0):.2f}",
                   f"place go 3 6 0 {rng.uniform(0.3, 0.5):.2f}"]


def rough(plan, rng):
    plan.plant |= {"floor_rms_mm": rng.uniform(20.0, 35.0), "floor_tau": rng.uniform(0.3, 0.6)}


def blocked(plan, rng):
    plan.plant |= {"sight_blocked": 1.0, "block_mm": rng.uniform(150.0, 400.0), "sight_blocked_start": rng.uniform(5.0, 12.0)}


def lost(plan, rng):
    plan.plant |= {"rays_lost": rng.uniform(0.985, 1.0), "rays_lost_start": rng.uniform(4.0, 12.0), "rays_lost_length": rng.uniform(1.0, 3.0)}


def vibration(plan, rng):
    plan.plant |= {"acc_alias": rng.uniform(1.5, 3.0), "acc_alias_hz": rng.uniform(1.5, 8.0)}


def axes(plan, rng):
    plan.plant |= rng.choice(({"imu_roll_sign": -1.0}, {"imu_swapped": 1.0}))


def ropes(plan, rng):
    """A rope that ends below the second reference, or that is caught now and then."""
    if rng.random() < 0.5:
        plan.plant["rope"] = plan.second_m - rng.uniform(0.05, 0.12)
    else:
        plan.plant |= {"tug_rate": rng.uniform(0.3, 0.6), "tug": -rng.uniform(3.0, 4.5)}


def pilot(plan, rng):
    plan.plant |= {"pilot_start": rng.uniform(4.0, 8.0), "pilot": rng.uniform(3.0, 5.0), "pilot_height": plan.second_m + rng.uniform(0.1, 0.3),
                   "pilot_trim": plan.plant["hover_thrust"] + rng.uniform(-0.3, 0.3)}


def ground(plan, rng):
    plan.plant["ground_effect"] = rng.uniform(7.0, 10.0)
    low_m = rng.uniform(0.15, 0.22)
    plan.lines[0] = f"reference {low_m:.2f}"
    plan.lines[2] = f"at 12.5 SETR {low_m:.2f}"


def battery(plan, rng):
    plan.plant["sag"] = rng.uniform(0.008, 0.013)


def mode(plan, rng):
    """PLANT THRUST is set, the autopilot is in a mode that commands a climb rate."""
    plan.settings["GRAV"] = rng.uniform(5.6, 6.4)
    plan.plant |= {"climb_rate": rng.uniform(0.7, 1.2), "climb_lag": rng.uniform(0.2, 0.35), "climb_deadband": rng.uniform(0.2, 0.5)}


def link(plan, rng):
    """Out of reach: the log comes from the memory of the vehicle on the ground, by another radio."""
    plan.csv = True
    plan.settings["LINK"] = 2
    plan.plant["radio_lost_start"] = rng.uniform(4.0, 10.0)


CAUSES = {f.__name__: f for f in (grav, hot, cold, saturation, late, colours, rough, blocked, lost, vibration, axes, ropes, pilot, ground,
                                  battery, mode, link)}


def plan_of(cause, seed, number):
    rng = random.Random(f"why {seed}/{cause}/{number}")
    plan = healthy(rng)
    if cause != "nothing":
        plan.cause = cause
        CAUSES[cause](plan, rng)
    return plan


def fly(program, plan, path):
    """Flies it; path: the CSV of the recorder's dump. True: there is one."""
    with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
        scenario = Path(scratch, "planted.scenario")
        lines = [*plan.lines, f"land {LAND_S}", f"end {END_S}"]
        scenario.write_text("\n".join(lines) + "\n", encoding="utf-8")
        console = path.with_suffix(".log")
        words = [f"{name}={value:.4f}" if isinstance(value, float) else f"{name}={value}" for name, value in plan.settings.items()]
        words += [f"plant.{name}={value:.9g}" for name, value in plan.plant.items()]
        kept = ("--csv", str(path)) if plan.csv else ("--log", str(console))
        done = subprocess.run([program, "fly", str(scenario), "--seed", str(plan.seed), *kept, *(part for word in words for part in ("--set", word))],
                              check=False, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        if done.returncode == 2:
            raise RuntimeError(f"{plan.cause}: {done.stderr}")
        if not plan.csv:
            subprocess.run([program, "log", str(console)], check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    return path.exists()
