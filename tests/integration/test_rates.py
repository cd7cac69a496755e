"""How often law EST, and whoever flies by it, misses what is required of a flight: over seeds, conditions and vehicles drawn anew.

Usage: test_rates.py PLOMADA soak [NAME ...]    as many flights as tell (tools/campaign/rate.py); NAME: these requirements only
       test_rates.py PLOMADA short              that each can be flown, and missed; no rate

The bounds were required before anything flew by them: what a lie may cost, how a healthy flight must look. They were given for 20
flights, all of which must keep them: so at most one flight of twenty may miss one. What must never happen to a healthy vehicle was
given for 400 flights: at most one of a hundred.
"""
import random
import sys
import unittest
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.append(str(ROOT / "tools/campaign"))
import fleet  # noqa: E402
import harm  # noqa: E402
import plan  # noqa: E402
import rate  # noqa: E402

PROGRAM, NAMES = "", []
OF_TWENTY, OF_FOUR_HUNDRED = 0.05, 0.01
FLAT = {"platform": 0.0}
SIMPLE, ROTORS = 0.0, 1.0       # airframes
DOWN_WITHIN_S = "60"


@dataclass(frozen=True)
class Requirement:
    draw: callable              # random.Random -> {plant figure: value, PARAMETER: value}
    most: dict                  # {metric: its bound}
    must: float = OF_TWENTY
    lands: bool = True          # and is down, as ordered or by itself, when all is over
    scenario: str = "est-60cm-ramp"
    met: bool = False           # the scenario's own expectations too
    options: list = field(default_factory=lambda: ["--until-down", DOWN_WITHIN_S])


def nominal(draw):
    return lambda rng: FLAT | draw(rng)


def drawn(draw):
    """Vehicles of both airframes, GRAV trimmed by hand, as a survey draws them."""
    def vehicle(rng):
        figures, typed = plan.vehicle(rng.randrange(1, 1_000_000), rng.randrange(1, 1_000_000))
        return figures | FLAT | typed | draw(rng)
    return vehicle


def sign(rng):
    return rng.choice((-1.0, 1.0))


def healthy(set_name):
    """Vehicles of a set of the campaign, over the ramp and the platform."""
    return lambda rng: plan.plant(set_name, rng.randrange(1, 1_000_000), rng.randrange(1, 1_000_000))


def blocked_from_the_start(rng):
    return {"sight_blocked": 1.0, "block_mm": rng.uniform(60.0, 900.0)}


def blocked_in_flight(rng):
    return blocked_from_the_start(rng) | {"sight_blocked_start": rng.uniform(2.0, 16.0)}


def two_gaps(rng):
    start_s, silent_s = rng.uniform(4.0, 12.0), rng.uniform(0.3, 4.0)
    return {"imu_mute_start": start_s, "imu_mute": silent_s, "outage_start": start_s + silent_s + rng.uniform(-0.1, 0.5),
            "outage": rng.uniform(2.0, 8.0)}


def burst(rng):
    return {"attitude_burst_deg": rng.uniform(30.0, 170.0) * sign(rng), "attitude_burst_start": rng.uniform(2.0, 16.0),
            "attitude_burst_length": 0.025 * rng.randrange(1, 7)}


def pilots_turn(pin):
    return lambda rng: {"SEL": pin, "pilot_start": rng.uniform(6.0, 9.0), "pilot": rng.uniform(4.0, 8.0),
                        "pilot_height": rng.uniform(0.5, 1.0), "hover_thrust": rng.uniform(6.0, 8.4)}


def field_day(rng):
    return {"stop_type": rng.randrange(2), "SEL": rng.choice(("NONE", "PIN")), "attitude_throttle": rng.randrange(2)}


HARM = {"highest_mm": harm.HIGH_MM, "touch_speed_mps": harm.TOUCH_MPS}      # where nothing more was required
LOST = {"highest_mm": 800.0, "touch_speed_mps": 0.8}
UNDISTURBED = {"takeovers": 0, "ground_contacts": 0, "failed": 0}
# Not flagged_s: over an edge the mirrors do disagree, and the flag DISAGREE says so.
CALM = UNDISTURBED | {"sight_doubts": 0, "imu_doubts": 0, "thrust_doubts": 0}
NO_CONTACT = {"takeovers": 0, "ground_contacts": 0}
REQUIREMENTS = {
    # One sensor lies.
    "rays lost": Requirement(nominal(lambda rng: {"rays_lost": rng.uniform(0.3, 1.0), "rays_lost_start": rng.choice((-1000.0, rng.uniform(2.0, 16.0)))}), LOST),
    "scan frozen in flight": Requirement(nominal(lambda rng: {"scan_frozen_start": rng.uniform(2.0, 16.0)}), LOST),
    "beam blocked from the start": Requirement(nominal(blocked_from_the_start), {"highest_mm": 1500.0, "touch_speed_mps": 1.0}),
    "beam blocked in flight": Requirement(nominal(blocked_in_flight), {"highest_mm": 1500.0, "touch_speed_mps": 1.0}),
    "beam blocked from the start, drawn": Requirement(drawn(blocked_from_the_start), {"highest_mm": 3000.0, "touch_speed_mps": 1.8}),
    "beam blocked in flight, drawn": Requirement(drawn(blocked_in_flight), {"highest_mm": 3000.0, "touch_speed_mps": 1.8}),
    "IMU silent, then the scanner": Requirement(nominal(two_gaps), {"highest_mm": 1000.0}),
    "IMU silent, then the scanner, drawn": Requirement(drawn(two_gaps), {"highest_mm": 1000.0}),
    "accelerometer's offset": Requirement(nominal(lambda rng: {"acc_bias": rng.uniform(0.5, 2.5) * sign(rng)}), {"hover_rms_mm": 60.0}),
    "accelerometer's unit": Requirement(nominal(lambda rng: {"acc_scale": rng.choice((1 / 256, 0.102, 0.5, 2.0, 9.80665))}), {"hover_rms_mm": 60.0}),
    "accelerometer's sign": Requirement(nominal(lambda _: {"acc_sign": -1.0}), {"hover_rms_mm": 60.0}),
    "accelerometer jumps": Requirement(nominal(lambda rng: {"acc_jump": rng.uniform(0.5, 4.0) * sign(rng), "acc_jump_start": rng.uniform(2.0, 25.0)}),
                                       {"hover_rms_mm": 60.0}),
    "accelerometer jumps, drawn": Requirement(drawn(lambda rng: {"acc_jump": rng.uniform(0.5, 4.0) * sign(rng), "acc_jump_start": rng.uniform(2.0, 25.0)}),
                                              HARM),
    "attitude burst of up to six frames": Requirement(nominal(burst), {"cuts": 0}, OF_FOUR_HUNDRED),
    "bars of 6 cm": Requirement(nominal(lambda rng: {"bars_mm": 60.0, "bars_period": 0.4}), {"hover_rms_mm": 40.0}),
    "floor of 30 mm": Requirement(nominal(lambda rng: {"floor_rms_mm": 30.0, "floor_tau": rng.uniform(0.2, 2.0)}), {"hover_rms_mm": 90.0}),
    "leg in 45 % of the rays": Requirement(nominal(lambda rng: {"sight_blocked": 0.45, "block_mm": rng.uniform(60.0, 400.0)}),
                                           {"hover_mean_error_mm": 15.0}),
    "edge at the landing": Requirement(nominal(lambda rng: {"edge_m": rng.uniform(-0.8, -0.3), "edge_start": rng.uniform(19.5, 22.0)}),
                                       {"stopped_after_s": 12.0} | HARM),
    "pilot's turn that no pin tells": Requirement(nominal(pilots_turn("NONE")), {"ground_contacts": 0}),
    "pilot's turn that the pin tells": Requirement(nominal(pilots_turn("PIN")), NO_CONTACT),
    "load comes or goes": Requirement(nominal(lambda rng: {"hover_jump": rng.uniform(0.3, 1.2) * sign(rng), "hover_jump_start": rng.uniform(2.0, 16.0)}), HARM),
    # Nothing is wrong.
    "healthy, drawn": Requirement(healthy("untrimmed"), CALM, OF_FOUR_HUNDRED),
    "healthy, drawn: hover": Requirement(healthy("untrimmed"), {"hover_rms_mm": 27.0}),
    "healthy, drawn, by rotors": Requirement(healthy("rotors"), CALM, OF_FOUR_HUNDRED),
    "healthy, drawn, stock Razor": Requirement(healthy("stock-drawn"), UNDISTURBED, OF_FOUR_HUNDRED),     # which has a flag of its own
    "healthy, drawn, throttle commands a climb": Requirement(healthy("climb-drawn"), NO_CONTACT, OF_FOUR_HUNDRED),
    "healthy, trimmed, by PIDT": Requirement(lambda rng: healthy("trimmed")(rng) | {"LAW": "PIDT"}, {"takeovers": 0}, OF_FOUR_HUNDRED,
                                             scenario=plan.SCENARIO),
    "field day": Requirement(field_day, {"motor_stops": 0}, met=True, scenario="field-day", lands=False, options=[]),
    **{f"scenario {name}": Requirement(lambda rng: {}, {}, met=True, scenario=name, lands=False, options=[])
       for name in ("pid-60cm-ramp", "est-60cm-ramp", "climb-rate", "step-thrust", "step-climb", "experiment", "pd-35cm", "pid-40cm",
                    "pid-40cm-tugs", "p-only-30cm", "pd-unsaturated-30cm", "first-gains", "first-pid", "hover-60s")},
}


def words(requirement, rng):
    """The command line behind `plomada fly`."""
    asked = requirement.draw(rng)
    words_of = [requirement.scenario, "--seed", str(rng.randrange(1, 2**31)), *requirement.options]
    for name, value in asked.items():
        words_of += ["--set", f"{name}={value}" if name.isupper() else f"plant.{name}={value:.6g}"]
    return words_of


def missed(requirement, figures):
    """What of it a flight missed, or None."""
    stopped_s, down_s = figures["stopped_s"], figures["down_s"]
    seen = figures | {"stopped_after_s": None if stopped_s is None else stopped_s - max(down_s or 0.0, 0.0)}
    if figures["halted"] or figures["off_aloft"] > 0:
        return "halted" if figures["halted"] else "motors off in the air"
    if requirement.lands and down_s is None:
        return "never came down"
    if requirement.met and not figures["met"]:
        return "not as its scenario says"
    for name, most in requirement.most.items():
        if seen[name] is not None and abs(seen[name]) > most:
            return f"{name} {seen[name]:.4g}, at most {most:g}"
    return None


def flown(requirement, name, seed):
    """What rate.judge asks of each number."""
    def wrong(number):
        arguments = words(requirement, random.Random(f"{seed} {name} {number}"))
        complaint = missed(requirement, fleet.fly(PROGRAM, arguments))
        return complaint and f"{complaint}: {fleet.command(PROGRAM, arguments)}"
    return wrong


class Soak(unittest.TestCase):
    def test_each_requirement_is_shown(self):
        seed = rate.drawn_seed()
        for name in NAMES or REQUIREMENTS:
            requirement = REQUIREMENTS[name]
            found = rate.judge(requirement.must, flown(requirement, name, seed))
            print(f"{name}: {found}", *found.wrong, sep="\n    ", flush=True)
            with self.subTest(name):
                self.assertEqual(found.verdict, rate.SHOWN, str(found))


class Short(unittest.TestCase):
    def test_each_can_be_flown(self):
        for name, requirement in REQUIREMENTS.items():
            flown(requirement, name, seed=1)(0)     # raises what the program says

    def test_each_can_be_missed(self):
        good = {"halted": False, "off_aloft": 0, "down_s": 2.0, "stopped_s": 3.0, "met": True}
        good |= {name: 0.0 for requirement in REQUIREMENTS.values() for name in requirement.most if name != "stopped_after_s"}
        worse = {"stopped_after_s": {"stopped_s": 14.1}}
        for name, requirement in REQUIREMENTS.items():
            self.assertIsNone(missed(requirement, good), name)
            self.assertIsNotNone(missed(requirement, good | {"off_aloft": 1}), name)
            self.assertEqual(missed(requirement, good | {"met": False}) is not None, requirement.met, name)
            self.assertEqual(missed(requirement, good | {"down_s": None}) is not None, requirement.lands, name)
            for metric, most in requirement.most.items():
                self.assertIn(metric, missed(requirement, good | worse.get(metric, {metric: most + 0.01})), name)


if __name__ == "__main__":
    PROGRAM, mode, *NAMES = sys.argv[1:]
    unknown = set(NAMES) - set(REQUIREMENTS)
    if unknown or mode not in ("soak", "short"):
        sys.exit(f"{__doc__}\nrequirements: {', '.join(REQUIREMENTS)}")
    suite = unittest.defaultTestLoader.loadTestsFromTestCase({"soak": Soak, "short": Short}[mode])
    sys.exit(not unittest.TextTestRunner(verbosity=2).run(suite).wasSuccessful())
