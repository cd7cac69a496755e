"""What law EST must reach, and what no law may do."""
import math
from dataclasses import dataclass

import plan
import table

HIGHEST_MM = 1200.0
# Laws that were tuned for thrust, on an autopilot whose throttle commands a climb rate: what the supervisor leaves of them.
HIGHEST_CLIMB_MM = 1500.0


@dataclass(frozen=True)
class Criterion:
    what: str
    set: str
    figure: str             # a column of table.row()
    unit: str
    must: float             # at most
    aim: float


EST = (
    Criterion("hover RMS, nominal", "nominal", "hover_rms_mm_mean", "mm", 13.5, 11.0),
    Criterion("thrust activity of it", "nominal", "thrust_std_n_mean", "N", 0.5, 0.5),
    Criterion("hover RMS, drawn vehicles, median", "untrimmed", "hover_rms_mm_median", "mm", 19.0, 16.0),
    Criterion("hover RMS, drawn vehicles, p95", "untrimmed", "hover_rms_mm_p95", "mm", 27.0, 22.0),
    Criterion("failures, drawn vehicles", "untrimmed", "failures", "", 0.0, 0.0),
    Criterion("flights with contacts, drawn vehicles", "untrimmed", "contacts", "", 0.0, 0.0),
    Criterion("within 50 mm after the edge", "nominal", "recovery_s_mean", "s", 0.9, 0.75),
    Criterion("undershoot after the edge", "nominal", "undershoot_mm_mean", "mm", 30.0, 20.0),
    Criterion("hover RMS, 3 % of the scans broken", "glitches", "hover_rms_mm_mean", "mm", 14.0, 12.0),
    Criterion("hover RMS, 4 x accelerometer noise", "vibration", "hover_rms_mm_mean", "mm", 26.0, 15.0),
    Criterion("largest error, 0.5 s without heights, p95", "outages", "max_error_mm_p95", "mm", 90.0, 60.0),
    Criterion("not landed, 3 s without heights", "blind", "failures", "", 0.0, 0.0),
    Criterion("touch, 3 s without heights, p95", "blind", "touch_speed_mps_p95", "m/s", 0.5, 0.5),
)


@dataclass(frozen=True)
class Verdict:
    what: str
    value: float
    unit: str
    must: float
    aim: float

    @property
    def missed(self):
        return not self.value <= self.must      # NaN is missed

    @property
    def word(self):
        return "MISSED" if self.missed else "aim" if self.value <= self.aim else "must"

    def cells(self):
        unit = f" {self.unit}" if self.unit else ""
        shown = "-" if math.isnan(self.value) else f"{self.value:.4g}" if self.unit else f"{self.value:.0f}"
        return [self.what, shown + unit, f"{self.must:g}{unit}", f"{self.aim:g}{unit}", self.word]


def of_est(rows):
    """The verdicts on EST, of those sets that were flown often enough to tell."""
    found = {row["set"]: row for row in rows if row["law"] == "EST"}
    for c in EST:
        if c.set in found and found[c.set]["flights"] >= plan.SETS[c.set].runs:
            yield Verdict(f"EST: {c.what}", found[c.set][c.figure], c.unit, c.must, c.aim)


def highest(rows, what, limit_mm):
    if rows:
        most = max(rows, key=lambda row: -math.inf if math.isnan(row["highest_mm"]) else row["highest_mm"])
        yield Verdict(f"{what} ({most['law']}, {most['set']})", most["highest_mm"], "mm", limit_mm, limit_mm)


def of_all(rows):
    """The verdicts on every law in every set, however few the flights."""
    by_climb = [row["set"].startswith("climb") for row in rows]
    yield from highest([row for row, climb in zip(rows, by_climb, strict=True) if not climb],
                       "any law: highest above the reference", HIGHEST_MM)
    yield from highest([row for row, climb in zip(rows, by_climb, strict=True) if climb],
                       "any law: the same where the throttle commands a climb rate", HIGHEST_CLIMB_MM)
    cuts = max(rows, key=lambda row: row["cuts"])
    where = f" (most: {cuts['law']}, {cuts['set']})" if cuts["cuts"] else ""
    yield Verdict(f"any law: flights with idle thrust in the air{where}", sum(row["cuts"] for row in rows), "",
                  0.0, 0.0)


def verdicts(rows):
    return [*of_est(rows), *of_all(rows)]


HEAD = ["", "found", "must, at most", "aim", "reached"]


def text(found):
    return table.columns([HEAD, *(verdict.cells() for verdict in found)], left=1)
