"""What a campaign of lies flies: one to three conditions of the world at once, on drawn vehicles of both airframes."""
import math
import random

import plan

SETS_PER_SEED = plan.RUNS_PER_SEED
POWER_ON_S = -1000.0
IN_FLIGHT_S = (2.0, 16.0)       # the reference comes at 1 s, the landing command at 12 to 16 s
OCTETS_PER_S, OCTETS_AT_START = 1010, 2500  # of the scanner: its scans, and what it has sent when the scenario begins
DOWN_WITHIN_S = 60


def somewhen(rng):
    return rng.uniform(*IN_FLIGHT_S)


def lasting(rng, least, most):
    """For good one time in three."""
    return None if rng.random() < 1 / 3 else rng.uniform(least, most)


def wide(rng, least, most):
    """Each factor of the range as likely as the other."""
    return math.exp(rng.uniform(math.log(least), math.log(most)))


def sign(rng):
    return rng.choice((-1.0, 1.0))


def during(rng, name, least, most):
    """Start and length; one time in four since power-on."""
    length = lasting(rng, least, most)
    figures = {f"{name}_start": POWER_ON_S if length is None and rng.random() < 0.75 else somewhen(rng)}
    return figures if length is None else figures | {f"{name}_length": length}


def rays_lost(rng):
    return {"rays_lost": rng.uniform(0.3, 1.0), **during(rng, "rays_lost", 0.3, 6.0)}


def sight_blocked(rng):
    share = 1.0 if rng.random() < 0.5 else rng.uniform(0.1, 1.0)
    return {"sight_blocked": share, "block_mm": rng.uniform(60.0, 900.0), **during(rng, "sight_blocked", 0.3, 6.0)}


def scan_frozen(rng):
    length = lasting(rng, 0.3, 6.0)
    figures = {"scan_frozen_start": somewhen(rng)}
    return figures if length is None else figures | {"scan_frozen_length": length}


def outage(rng):
    return {"outage_start": somewhen(rng), "outage": wide(rng, 0.2, 8.0)}


def scanner_restart(rng):
    return {"scanner_restart_start": somewhen(rng)}


def line_noise(rng):
    return [f"{rng.choice(('drop', 'flip', 'dup', 'stray'))}:{wide(rng, 1e-4, 3e-2):.3g}"]


def octet(rng):
    return OCTETS_AT_START + round(OCTETS_PER_S * somewhen(rng))


def line_delay(rng):
    return [f"delay@{octet(rng)}:{wide(rng, 20.0, 2000.0):.0f}"]


def scanner_trouble(rng):
    return [f"status@{octet(rng)}:{rng.randrange(21, 99)}"]


def imu(name):
    def draw(rng):
        return {f"imu_{name}_start": somewhen(rng), f"imu_{name}": wide(rng, 0.2, 8.0)}
    return draw


def imu_garbled(rng):
    return {**imu("garbled")(rng), "imu_garbled_share": wide(rng, 0.005, 0.3)}


def acc_unit(rng):
    return {"acc_scale": rng.choice((1 / 256, 0.102, 0.5, 2.0, 9.80665))}


def acc_sign(_):
    return {"acc_sign": -1.0}


def acc_bias(rng):
    return {"acc_bias": rng.uniform(0.5, 3.0) * sign(rng)}


def acc_jump(rng):
    return {"acc_jump": rng.uniform(0.5, 5.0) * sign(rng), "acc_jump_start": somewhen(rng)}


def acc_alias(rng):
    return {"acc_alias": wide(rng, 0.3, 5.0), "acc_alias_hz": wide(rng, 0.1, 8.0)}


def attitude_burst(rng):
    return {"attitude_burst_deg": rng.uniform(20.0, 170.0) * sign(rng), "attitude_burst_start": somewhen(rng),
            "attitude_burst_length": 0.025 * rng.randrange(1, 7)}


def rough_floor(rng):
    return {"floor_rms_mm": rng.uniform(5.0, 40.0), "floor_tau": wide(rng, 0.2, 2.0)}


def bars(rng):
    return {"bars_mm": rng.uniform(20.0, 80.0), "bars_period": wide(rng, 0.2, 1.5), "bars_share": rng.uniform(0.15, 0.6)}


def edge(rng):
    return {"edge_m": rng.uniform(0.1, 1.0) * rng.choice((-1.0, -1.0, 0.4)), "edge_start": somewhen(rng)}


def gust(rng):
    return {"gust": rng.uniform(1.0, 6.0) * sign(rng), "gust_start": somewhen(rng), "gust_length": wide(rng, 0.1, 2.0)}


def load(rng):
    return {"hover_jump": rng.uniform(0.3, 1.2) * sign(rng), "hover_jump_start": somewhen(rng)}


def lag2(rng):
    return {"lag2": rng.uniform(0.02, 0.15)}


def ground_effect(rng):
    return {"ground_effect": rng.uniform(0.0, 3.0)}


def pilot(rng):
    return {"pilot_start": somewhen(rng), "pilot": rng.uniform(1.0, 8.0), "pilot_height": rng.uniform(0.3, 1.2),
            "SEL": rng.choice(("NONE", "PIN"))}


def pin_stuck(rng):
    return {"SEL": "PIN", "pin_stuck": rng.randrange(2), **during(rng, "pin_stuck", 0.3, 6.0)}


# Figures of the plant (and parameters in capitals), or faults of the scanner's line.
KINDS = {
    "rays lost": rays_lost, "sight blocked": sight_blocked, "scan frozen": scan_frozen, "scanner silent": outage,
    "scanner restarts": scanner_restart, "scanner's trouble": scanner_trouble, "line noise": line_noise,
    "line delay": line_delay, "IMU silent": imu("mute"), "IMU frozen": imu("frozen"), "IMU garbled": imu_garbled,
    "accelerometer's unit": acc_unit, "accelerometer's sign": acc_sign, "accelerometer's bias": acc_bias,
    "accelerometer jumps": acc_jump, "aliased vibration": acc_alias, "attitude burst": attitude_burst,
    "uneven floor": rough_floor, "bars": bars, "edge": edge, "gust": gust, "load": load, "second lag": lag2,
    "ground effect": ground_effect, "pilot": pilot, "selector's pin stuck": pin_stuck,
}


def conditions(seed, number):
    """{kind: figures or faults} of the flights of this number: of each law one. One in thirteen has none, to compare."""
    rng = random.Random(f"faults {seed}/{number}")
    return {kind: KINDS[kind](rng) for kind in rng.sample(list(KINDS), rng.choices((0, 1, 2, 3), (1, 6, 4, 2))[0])}


def vehicle(seed, number):
    """As the operator has set it up: GRAV trimmed by hand for a mass that may be anything."""
    rng = random.Random(f"vehicle {seed}/{number}")
    drawn = plan.draws(f"faults {seed}", number)
    figures = {name: drawn[name] for name in plan.VEHICLE}
    figures |= {"airframe": float(rng.randrange(2)), "hover_thrust": drawn["hover_untrimmed"]}
    if rng.random() < 0.8:
        figures["platform"] = 0.0
    gravity = drawn["hover_untrimmed"] - rng.uniform(0.25, 0.55)
    return figures, {"GRAV": f"{gravity:.2f}", "SETR": f"{rng.uniform(0.4, 1.0):.2f}"}, f"{rng.uniform(12.0, 16.0):.1f}"


def assignments(law, seed, number):
    """Parameters, plant figures and faults of one flight."""
    figures, typed, _ = vehicle(seed, number)
    typed, faults = {**law.settings, **typed}, []
    for condition in conditions(seed, number).values():
        if isinstance(condition, list):
            faults += condition
            continue
        for name, value in condition.items():
            (typed if name.isupper() else figures)[name] = value
    return typed, figures, faults


def arguments(law, seed, number):
    """The command line behind `plomada fly`. law is a plan.Law; numbers count from 1."""
    typed, figures, faults = assignments(law, seed, number)
    words = [law.scenario, "--seed", str((seed - 1) * SETS_PER_SEED + number), "--duration", vehicle(seed, number)[2],
             "--until-down", str(DOWN_WITHIN_S)]
    for name, value in typed.items():
        words += ["--set", f"{name}={value}"]
    for name, value in figures.items():
        words += ["--set", f"plant.{name}={value:.6g}"]
    for fault in faults:
        words += ["--fault", fault]
    return words
