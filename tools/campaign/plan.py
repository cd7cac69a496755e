"""What a campaign flies: the laws, the sets of vehicles, and the vehicle of each run."""
import math
import random
import re
import subprocess
from dataclasses import dataclass

SCENARIO = "pid-60cm-ramp"
RUNS_PER_SEED = 1_000_000


@dataclass(frozen=True)
class Law:
    """A line of the tables: a scenario, and what is typed differently from its settings."""
    settings: dict
    scenario: str = SCENARIO


# GRAV stays at 7 N, as the scenario pins it: what a vehicle really needs is drawn. The gains of the rows TUNED come
# from tools/tune with --set trimmed, those of ROBUST from the same with --set untrimmed.
LAWS = {
    "PD": Law({"LAW": "PD", "KP": "0.01", "KD": "0.004", "KI": "0"}),
    "PID": Law({"LAW": "PID"}),
    "PID-SCAN": Law({"LAW": "PID", "RELEASE": "SCAN"}),
    "PID-TUNED": Law({"LAW": "PID", "KP": "0.00563", "KD": "0.027", "KI": "0.000175", "USAT": "1.23", "DSAT": "4"}),
    "PID-TUNED-SCAN": Law({"LAW": "PID", "RELEASE": "SCAN", "KP": "0.00745", "KD": "0.0332", "KI": "0.000187",
                           "USAT": "1.52", "DSAT": "3.87"}),
    "PID-ROBUST-SCAN": Law({"LAW": "PID", "RELEASE": "SCAN", "KP": "0.006", "KD": "0.0267", "KI": "0.000336",
                            "USAT": "1.72", "DSAT": "3.97"}),
    "PIDT": Law({"LAW": "PIDT"}),
    "EST": Law({}, "est-60cm-ramp"),
}


@dataclass(frozen=True)
class Set:
    summary: str
    runs: int               # flights per law, unless told otherwise
    figures: tuple          # names of draws() that the vehicle takes; the others stay nominal
    fixed: dict             # plant figures of every run
    lands: bool = False     # the supervisor is to land the vehicle: it fails when it never touches the ground


VEHICLE = ("gain", "tau", "damping", "ray_noise", "common_noise", "ray_instant", "acc_bias", "acc_noise",
           "attitude_rms", "imu_noise", "turbulence", "tdelay")
# The climb-rate autopilot that explains most of the seed's statements: tools/seed_study, docs/control.md.
CLIMB = {"climb_rate": 0.644, "climb_neutral": 7.53, "climb_deadband": 0.195, "climb_lag": 0.463}
CLIMB_VEHICLE = ("ray_noise", "common_noise", "ray_instant", "acc_bias", "acc_noise", "attitude_rms", "imu_noise",
                 "turbulence", "tdelay", "climb_rate", "climb_neutral", "climb_deadband", "climb_lag")
SETS = {
    "nominal": Set("the nominal vehicle", 20, (), {}),
    "trimmed": Set("drawn vehicles, GRAV trimmed by hand", 200, VEHICLE + ("hover_trimmed",), {}),
    "untrimmed": Set("drawn vehicles, mass +-20 %, not trimmed", 200, VEHICLE + ("hover_untrimmed",), {}),
    "rotors": Set("the same, of the second airframe", 200, VEHICLE + ("hover_untrimmed",), {"airframe": 1.0}),
    "glitches": Set("nominal, 3 % of the scans broken", 20, (), {"glitches": 0.03}),
    "vibration": Set("nominal, four times the accelerometer noise", 20, (), {"acc_noise": 1.6}),
    "outages": Set("nominal, flat ground, scanner silent for 0.5 s", 100, ("outage_start",),
                   {"outage": 0.5, "platform": 0.0}),
    "blind": Set("nominal, flat ground, scanner silent for 3 s: must land", 50, ("outage_start",),
                 {"outage": 3.0, "platform": 0.0}, lands=True),
    "climb": Set("an autopilot whose throttle commands a climb rate", 20, (), CLIMB),
    "climb-drawn": Set("drawn ones, mid-point 7.25 to 7.8 N", 100, CLIMB_VEHICLE, {}),
    "stock": Set("nominal, a Razor as it comes: no accelerations", 20, (), {"imu_stock": 1.0}),
    "stock-drawn": Set("untrimmed, a Razor as it comes", 200, VEHICLE + ("hover_untrimmed",), {"imu_stock": 1.0}),
    "stock-climb": Set("climb, a Razor as it comes", 20, (), CLIMB | {"imu_stock": 1.0}),
}
DEFAULT_SETS = [name for name in SETS if name not in ("trimmed", "rotors") and not name.startswith("stock")]


def extend(own, of_program=()):
    """Adds laws and sets of a file: {"laws": {NAME: {"settings": {}, "scenario": ""}}, "sets": {NAME: {"summary": "",
    "runs": 20, "figures": [], "fixed": {}, "lands": false}}}. A name that is known already, here or to the program, is refused."""
    for name, law in own.get("laws", {}).items():
        if name in of_program:
            raise ValueError(f"law {name} is one of the program's own; give it another name")
        if name in LAWS:
            raise ValueError(f"law {name} is there already")
        LAWS[name] = Law({key: str(value) for key, value in law.get("settings", {}).items()}, law.get("scenario", SCENARIO))
    for name, words in own.get("sets", {}).items():
        if name in SETS:
            raise ValueError(f"set {name} is there already")
        unknown = set(words.get("figures", ())) - set(draws(1, 1))
        if unknown:
            raise ValueError(f"set {name}: no draw of {', '.join(sorted(unknown))}")
        SETS[name] = Set(words.get("summary", name), words.get("runs", 20), tuple(words.get("figures", ())),
                         dict(words.get("fixed", {})), bool(words.get("lands", False)))


def of_program(program):
    """The names of the laws that the program has (control/laws/table.h). One that does not tell has none: what is wrong with it, the first flight tells."""
    try:
        told = subprocess.run([program, "params", "LAW"], stdin=subprocess.DEVNULL, capture_output=True, text=True, check=False).stdout
    except OSError:
        return []
    choices = re.search(r"^one of: (.*)$", told, re.MULTILINE)
    return choices.group(1).split("|") if choices else []


def take_from(program):
    """Adds the laws that the program has and LAWS does not."""
    for name in of_program(program):
        LAWS.setdefault(name, Law({"LAW": name}))


HOVER = {"hover_trimmed", "hover_untrimmed"}


def draws(seed, run):
    """Every figure that may vary, of this run. Nothing but seed and run counts, so laws and sets share their vehicles.
    The order of the draws is part of the result."""
    rng = random.Random(f"{seed}/{run}")
    noise = rng.uniform(1.0, 2.0)
    return {
        "ray_noise": 5.0 * noise,
        "common_noise": 3.0 * noise,
        "gain": rng.uniform(0.8, 1.2),
        "tau": rng.uniform(0.09, 0.15),
        "damping": rng.uniform(1.5, 3.0),
        "ray_instant": 0.034 + rng.uniform(-0.030, 0.030),
        "acc_bias": rng.uniform(-0.25, 0.25),
        "acc_noise": 0.4 * rng.uniform(1.0, 2.0),
        "attitude_rms": math.radians(2.0) * rng.uniform(0.8, 1.5),
        "imu_noise": math.radians(0.25) * rng.uniform(1.0, 2.0),
        "turbulence": 0.2 * rng.uniform(0.8, 1.5),
        "tdelay": rng.uniform(0.005, 0.020),
        "hover_trimmed": 7.0 + rng.uniform(0.25, 0.55),
        "hover_untrimmed": 7.0 * rng.uniform(0.8, 1.2),
        "outage_start": rng.uniform(8.0, 14.0),
        "climb_rate": CLIMB["climb_rate"] * rng.uniform(0.75, 1.33),
        "climb_neutral": 7.0 + rng.uniform(0.25, 0.8),
        "climb_deadband": rng.uniform(0.0, 0.5),
        "climb_lag": CLIMB["climb_lag"] * rng.uniform(0.5, 1.2),
    }


def vehicle(seed, number):
    """As an operator has set it up: a vehicle of either airframe, one in five over the ramp, GRAV trimmed by hand for a mass that may be
    anything. Figures of the plant, and what is typed."""
    rng = random.Random(f"vehicle {seed}/{number}")
    drawn = draws(f"faults {seed}", number)
    figures = {name: drawn[name] for name in VEHICLE}
    figures |= {"airframe": float(rng.randrange(2)), "hover_thrust": drawn["hover_untrimmed"]}
    if rng.random() < 0.8:
        figures["platform"] = 0.0
    gravity = drawn["hover_untrimmed"] - rng.uniform(0.25, 0.55)
    return figures, {"GRAV": f"{gravity:.2f}", "SETR": f"{rng.uniform(0.4, 1.0):.2f}"}


def plant(set_name, seed, run):
    """The plant figures that are set for this run: name -> value."""
    drawn = draws(seed, run)
    figures = {"hover_thrust" if name in HOVER else name: drawn[name] for name in SETS[set_name].figures}
    return figures | SETS[set_name].fixed


def arguments(law, set_name, seed, run):
    """The command line behind `plomada fly`. law is a Law; runs count from 1."""
    words = [law.scenario, "--seed", str((seed - 1) * RUNS_PER_SEED + run)]
    for name, value in law.settings.items():
        words += ["--set", f"{name}={value}"]
    for name, value in plant(set_name, seed, run).items():
        words += ["--set", f"plant.{name}={value:.9g}"]
    return words
