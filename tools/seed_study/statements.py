"""What the seed says of its flights, each as a question to the flights of a simulated autopilot.

A flight is named here by what the seed calls the test. `FLIGHTS` says how it is flown, `STATEMENTS` what it must look
like. Every figure is a mean over the seeds that were flown. The bounds in millimetres are a reading of words like
"exaggerated": the seed has no figures (chapter 4.2, chapter 6, Annex I).
"""
import math
from dataclasses import dataclass
from typing import Callable

WIDE = {"USAT": "11.76", "DSAT": "11.76"}

# name: (scenario, what is typed differently, is one seed enough)
FLIGHTS = {
    "no feed-forward": ("no-feedforward", {}, True),
    "GRAV alone": ("no-feedforward", {"GRAV": "7", "KP": "0", "KD": "0"}, True),
    "GRAV and a little": ("no-feedforward", {"GRAV": "8", "KP": "0", "KD": "0"}, True),
    "P": ("p-only-30cm", {}, False),
    "PD": ("pd-unsaturated-30cm", {}, False),
    "PD, KP up": ("pd-unsaturated-30cm", {"KP": "0.015"}, False),
    "PD, KP down": ("pd-unsaturated-30cm", {"KP": "0.00375"}, False),
    "PD, KD up": ("pd-unsaturated-30cm", {"KD": "0.03"}, False),
    "PD saturated": ("pd-35cm", {}, False),
    "PID": ("pid-40cm", {}, False),
    "PID, wide window": ("pid-40cm", WIDE, False),
    "PID, tugs": ("pid-40cm-tugs", {}, False),
    "PID over the ramp": ("pid-60cm-ramp", {}, False),
}


def line_s(first_step, last_step, bit_rate):
    """Time of one answer on the line, by the seed's equations 23 to 26."""
    points = last_step - first_step + 1
    return 10.0 * (26 + 2 * points + 2 * math.ceil(points / 64) + 1) / bit_rate


# The first bracket had two mirrors, whose rays took 90 degrees at 115200 bit/s (equation 27). That of the later flights has
# one mirror and 250000 bit/s (equation 28). The seed tuned PD before PID (Annex I), and does not say by which bracket.
FIRST_BRACKET_LATER_S = line_s(249, 519, 115200) - line_s(372, 406, 250000)
BY_FIRST_BRACKET = ("P", "PD", "PD, KP up", "PD, KP down", "PD, KD up", "PD saturated")
TRACKED = ("PID over the ramp",)    # its course in time is looked at, not only its metrics


def spread_mm(flight):
    """Standard deviation of the height over the hover window."""
    return math.sqrt(max(0.0, flight["hover_rms_mm"] ** 2 - flight["hover_mean_error_mm"] ** 2))


def lifts(flight):
    return flight["highest_mm"] + flight["reference_mm"] > 30.0


@dataclass(frozen=True)
class Statement:
    words: str                      # in the seed's order
    source: str
    reading: str                    # how it is judged
    holds: Callable[[dict], bool]   # of {flight: mean figures}


STATEMENTS = (
    Statement("without feed-forward it does not even lift", "Annex I", "stays below 30 mm",
              lambda f: not lifts(f["no feed-forward"])),
    Statement("the feed-forward almost lifts it, a little more does", "4.2.1", "7 N: below 30 mm; 8 N: above",
              lambda f: not lifts(f["GRAV alone"]) and lifts(f["GRAV and a little"])),
    Statement("P alone oscillates without end and bounces on the ground", "Annex I", "contacts, spread over 60 mm",
              lambda f: f["P"]["ground_contacts"] >= 0.5 and spread_mm(f["P"]) > 60.0),
    Statement("more KP: large oscillations", "Annex I", "spread grows with KP 0.0075 to 0.015",
              lambda f: spread_mm(f["PD, KP up"]) > spread_mm(f["PD"])),
    Statement("less KP: the reference is not reached", "Annex I", "mean error falls with KP 0.0075 to 0.00375",
              lambda f: f["PD, KP down"]["hover_mean_error_mm"] < f["PD"]["hover_mean_error_mm"] - 5.0),
    Statement("KD against the oscillations", "Annex I", "spread falls with KD 0 to 0.004",
              lambda f: spread_mm(f["PD"]) < spread_mm(f["P"])),
    Statement("too much KD destabilises", "Annex I", "spread grows with KD 0.004 to 0.03",
              lambda f: spread_mm(f["PD, KD up"]) > spread_mm(f["PD"])),
    Statement("the best PD without a window: exaggerated oscillations", "Annex I", "spread over 60 mm (0.2 of 30 cm)",
              lambda f: spread_mm(f["PD"]) > 60.0),
    Statement("and it does not reach the reference properly", "Annex I", "mean more than 15 mm off",
              lambda f: abs(f["PD"]["hover_mean_error_mm"]) > 15.0),
    Statement("a wide window makes it unstable", "4.2.3", "PID: spread 1.5 times that of + 1 N, or the flight fails",
              lambda f: f["PID, wide window"]["failed"] > 0.5
              or spread_mm(f["PID, wide window"]) > 1.5 * spread_mm(f["PID"])),
    Statement("the window improves PD", "4.2.3, Annex I", "spread below that without a window",
              lambda f: spread_mm(f["PD saturated"]) < spread_mm(f["PD"])),
    Statement("PD with a window hardly reaches the reference", "Annex I", "mean 15 mm or more below it",
              lambda f: f["PD saturated"]["hover_mean_error_mm"] < -15.0),
    Statement("and still oscillates too much", "Annex I", "spread over 25 mm",
              lambda f: spread_mm(f["PD saturated"]) > 25.0),
    Statement("PID oscillates less than PD", "Annex I", "spread below that of PD with a window",
              lambda f: spread_mm(f["PID"]) < spread_mm(f["PD saturated"])),
    Statement("PID reaches the reference much better", "Annex I", "mean error at most half of PD's",
              lambda f: abs(f["PID"]["hover_mean_error_mm"]) < 0.5 * abs(f["PD saturated"]["hover_mean_error_mm"])),
    Statement("PID comes back after the ropes' tugs", "Annex I", "mean within 40 mm, does not fail",
              lambda f: abs(f["PID, tugs"]["hover_mean_error_mm"]) < 40.0 and f["PID, tugs"]["failed"] < 0.5),
    Statement("it reaches 60 cm and holds it until the ramp comes", "6", "mean of 6 to 7.2 s within 100 mm of the reference",
              lambda f: abs(f["PID over the ramp"]["before_mm"]) < 100.0),
    Statement("over the ramp: a dip at about 7.5 s", "6", "lowest of 7 to 9 s within 7.3 to 8.3 s, below - 30 mm",
              lambda f: 7.3 <= f["PID over the ramp"]["dip_s"] <= 8.3 and f["PID over the ramp"]["dip_mm"] < -30.0),
    Statement("then an overshoot", "6", "above + 20 mm before the edge",
              lambda f: f["PID over the ramp"]["after_dip_mm"] > 20.0),
    Statement("a peak at about 11 s", "6", "highest of all within 10.9 to 11.4 s",
              lambda f: 10.9 <= f["PID over the ramp"]["peak_s"] <= 11.4),
    Statement("it sinks with an undershoot, and returns", "6", "below - 20 mm; mean of 15 to 20 s within 40 mm",
              lambda f: f["PID over the ramp"]["undershoot_mm"] > 20.0
              and abs(f["PID over the ramp"]["end_error_mm"]) < 40.0),
)


def course(rows, reference_m):
    """Figures of the flight over the ramp from its log: rows of (t_s, height_m), the truth at 100 Hz."""
    def part(start_s, end_s):
        return [(height_m, t_s) for t_s, height_m in rows if start_s <= t_s < end_s]

    dip_m, dip_s = min(part(7.0, 9.0))
    peak_m, peak_s = max(part(7.0, 15.0))
    before = [height_m for height_m, _ in part(6.0, 7.2)]
    end = [height_m for height_m, _ in part(15.0, 20.0)]
    return {
        "before_mm": (sum(before) / len(before) - reference_m) * 1000.0,
        "dip_s": dip_s, "dip_mm": (dip_m - reference_m) * 1000.0,
        "after_dip_mm": (max(part(dip_s, 10.95))[0] - reference_m) * 1000.0,
        "peak_s": peak_s, "peak_mm": (peak_m - reference_m) * 1000.0,
        "end_error_mm": (sum(end) / len(end) - reference_m) * 1000.0,
    }
