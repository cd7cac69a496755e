"""Flights with a cause planted, and healthy ones: what the tests and acceptance.py ask `why` about.

Everything is drawn from a text of seed and number: the vehicle, the law, the layout, the references, and of a planted cause where,
when and how strong. Each cause has a range of strengths with its source, and the whole of it is drawn. What healthy vehicles have too
is not to be found: Plan.shown is False there. The vehicles are those of tools/fit/acceptance.py around the plant's middle; GRAV is set
as an operator sets it, up to 0.6 N off. `why` sees what the chip's recorder holds of the flight, nothing else.
"""
import math
import random
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

LAND_S, LANDED_S = 19.0, 6.0
DARK_TILE_S = 1.2               # `healthy`: tiles of 0.6 m at 0.5 m/s
TRIM_N = 0.6                    # GRAV is off by so much on a healthy vehicle
PID_TUNED = {"KP": 0.0068, "KD": 0.0157, "KI": 0.0006}


@dataclass(frozen=True)
class Range:
    """How strong a cause is: from the weakest to the strongest that a user would have."""
    what: str
    unit: str
    weak: float
    strong: float
    healthy: float              # up to here, from the weak end, healthy vehicles have it, or their air makes it look so
    source: str
    even: bool = False          # drawn evenly; else each factor as often as every other

    def at(self, share):
        return self.weak + share * (self.strong - self.weak) if self.even else self.weak * (self.strong / self.weak)**share

    def share(self, value):
        """Where at() gives the value."""
        return (value - self.weak) / (self.strong - self.weak) if self.even else math.log(value / self.weak) / math.log(self.strong / self.weak)

    def shown(self, value):
        return (value - self.healthy) * (self.strong - self.weak) > 0.0


# What the sources are: `seed`, the thesis; `plan`, tools/campaign/plan.py, vehicles of which none is broken; `lies` and `healthy`, the
# tables of situations beside it.
RANGES = {
    "grav": Range("GRAV off the hover thrust", "N", 0.3, 2.8, 0.9, "2.8 N: GRAV of the heaviest vehicle of `plan` on the lightest; healthy: 0.6 N, found within 0.15 N", even=True),
    "hot": Range("gains, times the delivered ones", "", 1.2, 3.2, 1.6, "KP of the seed's own flights: 0.00466 to 0.015; healthy: an effect of ±20 %, found within 15 %"),
    "cold": Range("gains, times the delivered ones", "", 1.0 / 1.2, 1.0 / 3.2, 1.0 / 1.6, "as gains too hot"),
    "saturation": Range("window of the thrust, half", "N", 0.5, 0.1, 0.4, "seed: 1 N wide; what laws ask for in a hover: 0.25 to 0.45 N rms", even=True),
    "late": Range("rays older", "s", 0.02, 0.09, 0.044, "seed, eq. 27 and 28: 46 ms; a whole scan: 100 ms; healthy: ±30 ms in `plan`, found within 7 ms"),
    "colours": Range("two colours, or tiles of two heights", "mm", 5.0, 40.0, 10.0, "accuracy of the sensor: ±10 mm (surface.h); a sheet of wood: 40 mm"),
    "rough": Range("floor's height, rms", "mm", 3.0, 30.0, 5.0, "`healthy`: gravel of 3 to 20 mm, a pile of 30 mm; noise of a ray: 5 mm"),
    "blocked": Range("mirrors blocked", "", 1.0, 3.0, 0.0, "`lies`: one beam, two, or all, at 60 to 3000 mm"),
    "lost": Range("no rays", "s", 0.2, 10.0, 0.3, "`lies`: 0.1 to 20 s; the firmware waits for 0.3 s"),
    "vibration": Range("line in the accelerations", "m/s2", 0.4, 5.0, 0.8, "`lies`: 0.2 to 8 m/s2; noise in `plan`: up to 0.8 m/s2 rms"),
    "axes": Range("sway, rms", "deg", 1.6, 3.0, 0.0, "`plan`: 1.6 to 3 deg; a sign or both axes wrong"),
    "rope": Range("reference above the rope's end", "m", 0.02, 0.15, 0.0, "a hand's breadth too short at most", even=True),
    "tugs": Range("tug", "m/s2", 1.0, 4.5, 1.0, "1.5 m/s2 in tug runs (control.md), three times that; turbulence and noise of a healthy flight: 1 m/s2"),
    "pilot": Range("the pilot's turn", "s", 1.0, 6.0, 0.0, "`healthy`, pilot's turns"),
    "ground": Range("ground effect, times", "", 1.7, 4.4, 3.6,
                    "Sanchez-Cuevas et al. 2017: four rotors of this size, without and with what the body gets; healthy: air of 0.25 m/s2 for 6 s"),
    "battery": Range("growth of the hover thrust", "1/s", 0.0012, 0.0124, 0.0039,
                     "sim/devices/lipo.c: cells' voltage by charge, squared: 0.0017 at 10 % of 5 Ah, 0.0074 at 5 %; 0.0124 with 3 Ah; healthy: 0.0015, found within 0.0012"),
    "mode": Range("climb rate of a newton", "m/s/N", 0.48, 1.26, 0.0, "`plan`: 0.48 to 0.86; the NAZA's 6 m/s at full stick: 1.26"),
    "link": Range("radio lost before the landing", "s", 3.0, 15.0, 2.0, "LINK of 2 s; any time of the flight", even=True),
}
THIRDS = ("weak", "middle", "strong")
MIRRORS = ("front", "aft", "fore")
STRUCK = {1: {"front"}, 2: {"aft"}, 3: {"fore"}, 4: {"front", "aft"}, 5: {"front", "fore"}, 6: {"aft", "fore"}, 0: set(MIRRORS)}


def third_of(share):
    return THIRDS[min(max(int(3.0 * share), 0), 2)]


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
    land_s: float = LAND_S
    share: float = 0.0          # of the range of strengths
    value: float = 0.0          # the strength
    shown: bool = True          # stronger than what healthy vehicles have
    mirrors: set = field(default_factory=set)           # that are blocked, or lost their rays

    def third(self):
        return third_of(self.share)


def healthy(rng):
    """A vehicle and its flight."""
    hover_n = 7.0 * rng.uniform(0.85, 1.15)
    law = rng.choice(("EST", "EST", "PIDT"))
    plant = {"hover_thrust": hover_n, "gain": rng.uniform(0.8, 1.2), "tau": rng.uniform(0.09, 0.15), "damping": rng.uniform(1.5, 3.0),
             "tdelay": rng.uniform(0.005, 0.020), "sag": rng.uniform(0.0, 0.0015), "turbulence": 0.2 * rng.uniform(0.8, 1.5),
             "ray_instant": 0.034 + rng.uniform(-0.02, 0.02), "acc_bias": rng.uniform(-0.25, 0.25), "acc_noise": 0.4 * rng.uniform(1.0, 1.5),
             "ray_noise": 5.0 * rng.uniform(1.0, 2.0), "common_noise": 3.0 * rng.uniform(1.0, 1.5),
             "attitude_rms": math.radians(2.0) * rng.uniform(0.8, 1.5)}
    settings = {"LAW": law, "GRAV": hover_n + rng.uniform(-TRIM_N, TRIM_N), "LAYOUT": rng.choice(("THREE", "THREE", "THREE", "FRONT"))}
    first_m = rng.uniform(0.4, 0.7)
    second_m = first_m + rng.uniform(0.15, 0.3)
    lines = [f"reference {first_m:.2f}", f"at {rng.uniform(6.0, 7.0):.1f} SETR {second_m:.2f}",
             f"at {rng.uniform(12.0, 13.0):.1f} SETR {first_m:.2f}"]
    return Plan("nothing", settings, plant, lines, rng.randrange(1, 10**6), second_m, rng.random() < 0.3)


def grav(plan, rng):
    plan.settings["GRAV"] = plan.plant["hover_thrust"] + rng.choice((-1.0, 1.0)) * plan.value


def gains(plan, times):
    """The loop acts so many times as hard as on the vehicle in the middle."""
    if plan.settings["LAW"] == "EST":        # VELK goes to 12 only; GAIN below what is true makes each newton more
        times /= plan.plant["gain"]
        plan.settings |= {"VELK": 8.0 * min(times, 1.5), "GAIN": max(min(1.5 / times, 1.0), 0.4)}
    else:
        times *= plan.plant["hover_thrust"] / 7.0 / plan.plant["gain"]
        plan.settings |= {"PKP": 6.0 * times, "PKD": 2.6 * times, "PKI": 1.4 * times}


def hot(plan, _rng):
    gains(plan, plan.value)


def cold(plan, _rng):
    gains(plan, plan.value)


def saturation(plan, rng):
    """The seed's window around GRAV, set too narrow."""
    plan.settings |= PID_TUNED | {"LAW": "PID", "USAT": plan.value, "DSAT": plan.value,
                                  "GRAV": plan.plant["hover_thrust"] + rng.uniform(-0.05, 0.1)}


def late(plan, _rng):
    plan.plant |= {"scan_late": plan.value, "ray_instant": 0.034}       # as the firmware believes: all of the strength is lateness


def colours(plan, rng):
    offset_mm = rng.choice((-1.0, 1.0)) * plan.value
    plan.lines += [f"place surface other 0.5 0 0 {offset_mm:.1f} 0", f"place tiles white other {rng.uniform(0.6, 1.0):.2f}",
                   f"place go 3 6 0 {rng.uniform(0.3, 0.5):.2f}"]


def rough(plan, rng):
    plan.plant |= {"floor_rms_mm": plan.value, "floor_tau": rng.uniform(0.3, 0.6)}


def struck(plan, rng, count):
    """So many mirrors; of a vehicle with one that one."""
    if plan.settings["LAYOUT"] == "FRONT":
        plan.mirrors = {"front"}
    else:
        beam = rng.choice([number for number, mirrors in STRUCK.items() if len(mirrors) == count])
        plan.plant["struck_beam"] = float(beam)
        plan.mirrors = STRUCK[beam]


def blocked(plan, rng):
    plan.plant |= {"sight_blocked": 1.0, "block_mm": 60.0 * 50.0**rng.random(), "sight_blocked_start": rng.uniform(2.0, 16.0)}
    plan.settings["LAYOUT"] = "THREE"
    plan.value = 1.0 + THIRDS.index(plan.third())
    if plan.value == 3.0 and rng.random() < 0.3:
        plan.settings["LAYOUT"] = "FRONT"
    struck(plan, rng, int(plan.value))


def lost(plan, rng):
    plan.plant |= {"rays_lost": rng.uniform(0.95, 1.0), "rays_lost_start": rng.uniform(2.0, 16.0), "rays_lost_length": plan.value}
    struck(plan, rng, rng.choice((1, 3)))
    if plan.settings["LAYOUT"] == "THREE" and len(plan.mirrors) == 1:       # the others hold the height, and dark tiles do that too
        plan.shown = plan.value > DARK_TILE_S


def vibration(plan, rng):
    plan.plant |= {"acc_alias": plan.value, "acc_alias_hz": 1.0 * 15.0**rng.random()}


def axes(plan, rng):
    plan.plant |= rng.choice(({"imu_roll_sign": -1.0}, {"imu_swapped": 1.0}))
    plan.plant["attitude_rms"] = math.radians(plan.value)


def rope(plan, _rng):
    plan.plant["rope"] = plan.second_m - plan.value


def tugs(plan, rng):
    plan.plant |= {"tug_rate": rng.uniform(0.3, 0.6), "tug": -plan.value}


def pilot(plan, rng):
    plan.plant |= {"pilot_start": rng.uniform(4.0, 11.0), "pilot": plan.value, "pilot_height": plan.second_m + rng.uniform(0.0, 0.3),
                   "pilot_trim": plan.plant["hover_thrust"] + rng.uniform(-0.3, 0.3)}


def ground(plan, rng):
    plan.plant["ground_effect"] = plan.value
    low_m = rng.uniform(0.10, 0.15)
    plan.lines[0] = f"reference {low_m:.2f}"
    plan.lines[2] = f"at 12.5 SETR {low_m:.2f}"


def battery(plan, _rng):
    plan.plant["sag"] = plan.value


def mode(plan, rng):
    """PLANT THRUST is set, the autopilot is in a mode that commands a climb rate."""
    plan.settings["GRAV"] = rng.uniform(5.6, 6.4)
    plan.plant |= {"climb_rate": plan.value, "climb_lag": rng.uniform(0.23, 0.56), "climb_deadband": rng.uniform(0.0, 0.5)}


def link(plan, _rng):
    """Out of reach: the log comes from the memory of the vehicle on the ground, by another radio."""
    plan.csv = True
    plan.settings["LINK"] = 2
    plan.plant["radio_lost_start"] = LAND_S - plan.value


CAUSES = {f.__name__: f for f in (grav, hot, cold, saturation, late, colours, rough, blocked, lost, vibration, axes, rope, tugs, pilot, ground,
                                  battery, mode, link)}


def plan_of(cause, seed, number, share=None):
    """share: of the range of strengths, 0 .. 1; drawn where it is None."""
    rng = random.Random(f"why {seed}/{cause}/{number}")
    plan = healthy(rng)
    if cause != "nothing":
        drawn = rng.random()
        plan.cause, plan.share = cause, drawn if share is None else share
        plan.value = RANGES[cause].at(plan.share)
        plan.shown = RANGES[cause].shown(plan.value)
        CAUSES[cause](plan, rng)
    return plan


def fly(program, plan, path):
    """Flies it; path: the CSV of the recorder's dump. True: there is one."""
    with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
        scenario = Path(scratch, "planted.scenario")
        lines = [*plan.lines, f"land {plan.land_s}", f"end {plan.land_s + LANDED_S}"]
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
            subprocess.run([program, "log", str(console), "--force"], check=False, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    return path.exists()


def cut(path, after_s):
    """Leaves out all rows until after_s after the take-off's first row, as a ring does that was too small for the flight."""
    titles, *rows = path.read_text(encoding="utf-8").splitlines()
    time_at, state_at = (titles.split(",").index(name) for name in ("t_s", "state"))
    begin_s = next((float(row.split(",")[time_at]) for row in rows if row.split(",")[state_at] == "TAKEOFF"), 0.0)
    kept = [row for row in rows if float(row.split(",")[time_at]) >= begin_s + after_s]
    path.write_text("\n".join([titles, *kept]) + "\n", encoding="utf-8")
