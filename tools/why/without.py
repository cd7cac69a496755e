"""What the flight would have been without its cause: the vehicle as it was found, in calm air, flown by the law as it was found.

The law gives the hover thrust, and what its gains make of the error and of the climb, within the range that it used. EST acts on the
present height, the other laws on the latest scan's."""
import numpy

from causes import settings

STEP_S = 0.005
SCAN_S = 0.1
RAYS_OLD_S = 0.07               # of the front mirror's rays when their scan arrives
SETTLED_S = 3.0                 # after a new reference
SLEW_MPS = 0.7                  # VUP: the law follows a new reference so fast
RANGE_N = 3.0                   # of the thrust, where its limits were the cause


def settled(case):
    """Rows of the flight in which a reference had been held for a while."""
    c, t_s = case.flight.column, case.flight.t_s
    flying = numpy.array([state in ("FLYING", "HOLDING") for state in c["state"]]) & (c["ref_m"] > 0.0) & case.flight.new
    changes = t_s[1:][numpy.diff(c["ref_m"]) != 0.0]
    for change in [*changes, *t_s[:1]]:
        flying &= (t_s < change) | (t_s > change + SETTLED_S)
    return flying


def hover_rms_mm(case):
    rows = settled(case)
    if rows.sum() < 20:
        return None
    c = case.flight.column
    return 1e3 * float(numpy.sqrt(numpy.mean((c["meas_m"][rows] - c["ref_m"][rows])**2)))


def gains_of(case, key):
    """(thrust per metre, per metre per second) of the law; where the gains were the cause, the usual ones."""
    law, b = case.law, case.model.linear_figure("authority")
    if key in ("hot", "cold", "saturation", "mode") or law.p_n_per_m <= 0.0:
        return tuple(usual / b for usual in settings.USUAL[law.estimator])
    return law.p_n_per_m, max(law.d_n_s_per_m, 0.0)


def fly(case, key, found, seed=1):
    """(times, heights, references) of the flight's own references, from the first height that follows a reference."""
    model = found.model or case.model
    f, b = model.figures, case.model.linear_figure("authority")
    c, t_s = case.flight.column, case.flight.t_s
    flying = numpy.flatnonzero(case.flight.aloft() & (c["ref_m"] > 0.0))
    if not len(flying):
        return None
    grid = numpy.arange(t_s[flying[0]], t_s[flying[-1]], STEP_S)
    reference = c["ref_m"][numpy.clip(numpy.searchsorted(t_s, grid, "right") - 1, 0, len(t_s) - 1)]
    p, d = gains_of(case, key)
    law = case.law
    most = law.range_n[1] if key not in ("saturation", "hot", "grav") and law.rows else case.model.hover_n() + RANGE_N
    least = law.range_n[0] if key not in ("saturation", "hot", "grav") and law.rows else case.model.hover_n() - RANGE_N
    rng = numpy.random.default_rng(seed)
    rms = min(f["turbulence"], 0.3)
    keep = numpy.exp(-STEP_S / f["turbulence_tau"])
    gust = rms * rng.standard_normal()
    speed, thrust, height = 0.0, 0.0, float(numpy.interp(grid[0], t_s[case.flight.new], c["meas_m"][case.flight.new]))
    delay, old = int(f["tdelay"] / STEP_S) + 2, int(RAYS_OLD_S / STEP_S)
    heights, commands = [height] * (old + 1), [0.0] * (delay + 1)
    scan, seen, climb, aim = int(SCAN_S / STEP_S), height, 0.0, height
    follow = 1.0 - numpy.exp(-STEP_S / f["tau"])
    for k in range(len(grid)):
        aim += float(numpy.clip(reference[k] - aim, -SLEW_MPS * STEP_S, SLEW_MPS * STEP_S))
        if law.estimator:
            seen, climb = height, speed
        elif k % scan == 0:
            latest = heights[-old - 1] + f["height_noise"] * rng.standard_normal()
            climb, seen = (latest - seen) / SCAN_S if k else 0.0, latest
        commands.append(float(numpy.clip(p * (aim - seen) - d * climb, least - case.model.hover_n(), most - case.model.hover_n())))
        thrust += follow * (commands[-delay - 1] - thrust)
        gust = gust * keep + rms * float(numpy.sqrt(1.0 - keep**2)) * rng.standard_normal()
        speed += STEP_S * (b * thrust + gust - f["damping"] * speed)
        height = max(height + STEP_S * speed, 0.0)
        heights.append(height)
    return grid, numpy.array(heights[old + 1:]), reference


def rms_mm(flown):
    """In the hover, as hover_rms_mm() of the log."""
    grid, height, reference = flown
    rows = numpy.ones(len(grid), bool)
    for change in [grid[0], *grid[1:][numpy.diff(reference) != 0.0]]:
        rows &= (grid < change) | (grid > change + SETTLED_S)
    return 1e3 * float(numpy.sqrt(numpy.mean((height[rows] - reference[rows])**2))) if rows.sum() > 100 else None
