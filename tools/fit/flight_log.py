"""A flight's CSV, of `plomada log` or of `fly --csv`, as stretches in the air."""
import math
import sys
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "plot"))
import recording  # noqa: E402

import model

NEEDED = ("t_s", "meas_m", "thrust_n", "roll_rad", "pitch_rad", "state", "up_mps2", "age_s")
FLYING = ("FLYING", "HOLDING")
ALOFT = (*FLYING, "LANDING", "LOWERING", "DESCENDING")   # whoever commands it, the thrust is in the log
SETTLED_S = 0.5                 # after the take-off
LEAST_S = 5.0                   # of a stretch
GAP_S = 0.3                     # between two heights: what is behind it is another stretch
ALOFT_M = 0.08
BELIEVED = ("GOOD", "LOW", "EMPTY")     # words of the battery: its voltage is one
PC_ROW_S = 0.010                # of fly --csv: what is new in a row came within it


Unfit = recording.Unreadable    # the file does not hold what is needed; the text says what is missing


def columns(path):
    """Raises Unfit."""
    found = recording.read(path)
    if found.kind not in ("flight", "recorder"):
        raise Unfit(f"{path}: no CSV of a flight; `plomada log {path}` makes one of the dumps in it")
    missing = [name for name in NEEDED if name not in found.columns]
    if missing:
        raise Unfit(f"{path}: no column {', '.join(missing)}")
    if found.cut:
        print(f"{path}: ends within a row, which is left out; the flight may have gone on", file=sys.stderr)
    return {name: values if name == "state" else numpy.array(values) for name, values in found.columns.items()}


def filled(t_s, values):
    there = ~numpy.isnan(values)
    return numpy.interp(t_s, t_s[there], values[there])


def spans(t_s, aloft, rays):
    """[(begin, end)] in the air without a gap of heights."""
    found, begin = [], None
    last_ray = -math.inf
    for k, now_s in enumerate(t_s):
        last_ray = now_s if rays[k] else last_ray
        good = aloft[k] and now_s - last_ray < GAP_S
        if begin is not None and now_s - t_s[k - 1] > GAP_S:        # rows are missing
            found.append((begin, t_s[k - 1]))
            begin = None
        if good and begin is None:
            begin = now_s
        elif not good and begin is not None:
            found.append((begin, t_s[k - 1]))
            begin = None
    if begin is not None:
        found.append((begin, t_s[-1]))
    return [(a + SETTLED_S, b) for a, b in found if b - a - SETTLED_S >= LEAST_S]


def stretches(path):
    """Raises Unfit."""
    c = columns(path)
    for name, what in (("meas_m", "heights"), ("age_s", "ages of the heights"), ("roll_rad", "roll"), ("pitch_rad", "pitch")):
        if numpy.isnan(c[name]).all():
            raise Unfit(f"{path}: no {what}: {name} is empty")
    if numpy.isnan(c["thrust_n"]).any():
        raise Unfit(f"{path}: {int(numpy.isnan(c['thrust_n']).sum())} rows have no thrust_n")
    t_s = c["t_s"]
    late_s = PC_ROW_S / 2.0 if "height_m" in c else 0.0     # a row of the PC board shows what came up to 10 ms before it
    instant = t_s - c["age_s"]
    there = ~numpy.isnan(instant) & ~numpy.isnan(c["meas_m"])
    new = numpy.zeros(len(t_s), bool)
    latest = -math.inf
    for k in numpy.flatnonzero(there):
        if instant[k] > latest + 0.02:
            new[k], latest = True, instant[k]
    frames = ~numpy.isnan(c["up_mps2"])
    if not frames.any():
        raise Unfit(f"{path}: no accelerations, as from a Razor as it comes; without them the kind of throttle cannot be told "
                    "(docs/fit.md)")
    if numpy.median(numpy.diff(t_s[frames])) > 0.04:
        raise Unfit(f"{path}: accelerations {1e3 * numpy.median(numpy.diff(t_s[frames])):.0f} ms apart; type #LOG RATE FAST "
                    "before the flight")
    flying = numpy.array([state in ALOFT for state in c["state"]])
    aloft = flying & (filled(t_s, c["meas_m"]) > ALOFT_M)
    found = [stretch_of(c, t_s, late_s, instant, new, frames, span) for span in spans(t_s, aloft, new)]
    if not found:
        raise Unfit(f"{path}: nowhere {LEAST_S:g} s in the air without a gap")
    return found


def volts_of(c, t_s, grid):
    """The line through a stretch's voltages: they fall with the charge, and what a load makes of them passes. None: not measured."""
    if "bat_v" not in c or "bat" not in c:
        return None
    told = numpy.array([word in BELIEVED for word in c["bat"]]) & ~numpy.isnan(c["bat_v"])
    within = told & (t_s >= grid[0]) & (t_s <= grid[-1])
    if within.sum() < 0.5 * ((t_s >= grid[0]) & (t_s <= grid[-1])).sum():
        return None
    slope, level = numpy.polyfit(t_s[within] - grid[0], c["bat_v"][within], 1)
    return level + slope * (grid - grid[0])


def stretch_of(c, t_s, late_s, instant, new, frames, span):
    begin, end = span
    grid = numpy.arange(begin - 0.5, end, model.STEP_S)
    at = numpy.clip(numpy.searchsorted(t_s - late_s, grid + model.STEP_S / 2, "right") - 1, 0, len(t_s) - 1)
    rays = new & (instant >= begin) & (instant < end - 0.01)
    felt_s = t_s - late_s - model.FRAME_AGE_S
    felt = frames & (felt_s >= begin) & (felt_s < end - 0.01)
    upright = numpy.cos(filled(t_s, c["roll_rad"])) * numpy.cos(filled(t_s, c["pitch_rad"]))
    return model.Stretch(grid, c["thrust_n"][at], numpy.interp(grid, t_s - 0.05, upright),
                         numpy.interp(grid, instant[new], c["meas_m"][new]), instant[rays], c["meas_m"][rays],
                         felt_s[felt], c["up_mps2"][felt], float(t_s[0]), volts=volts_of(c, t_s, grid))
