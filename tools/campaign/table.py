"""What a campaign says: one row per set and law."""
import csv
import math
import statistics

DISTRIBUTIONS = (("rise_time_s", "rise s"), ("hover_rms_mm", "hover RMS mm"), ("overshoot_mm", "overshoot mm"),
                 ("terrain_rms_mm", "terrain RMS mm"), ("recovery_s", "recovery s"), ("undershoot_mm", "undershoot mm"),
                 ("max_error_mm", "largest error mm"), ("touch_speed_mps", "touch m/s"), ("thrust_std_n", "activity N"))
PRINTED = ("hover_rms_mm", "overshoot_mm", "terrain_rms_mm", "recovery_s", "max_error_mm", "touch_speed_mps",
           "thrust_std_n")


def failed(figures, lands=False):
    """A take-over by the supervisor is a failure of the law, but where it is to land the vehicle."""
    if figures["halted"] or not figures["started"]:
        return True
    if lands:
        return figures["touch_speed_mps"] is None
    return figures["failed"] or figures["takeovers"] > 0


def percentile(values, share):
    """Linear between neighbours; NaN of nothing."""
    if not values:
        return math.nan
    ordered = sorted(values)
    place = share * (len(ordered) - 1)
    low = math.floor(place)
    high = min(low + 1, len(ordered) - 1)
    return ordered[low] + (place - low) * (ordered[high] - ordered[low])


def row(law, set_name, flights, lands=False):
    """One row of [figures]. Medians, 95 % quantiles, means and largest values are of the flights that did not fail."""
    good = [figures for figures in flights if not failed(figures, lands)]
    result = {"set": set_name, "law": law, "flights": len(flights), "failures": len(flights) - len(good),
              "contacts": sum(figures["ground_contacts"] > 0 for figures in flights),
              "takeovers": sum(figures["takeovers"] > 0 for figures in flights),
              "cuts": sum(figures["cuts"] > 0 for figures in flights),
              "highest_mm": max((figures["highest_mm"] for figures in flights if figures["highest_mm"] is not None),
                                default=math.nan)}
    for name, _ in DISTRIBUTIONS:
        values = [figures[name] for figures in good if figures[name] is not None]
        result[f"{name}_median"] = percentile(values, 0.5)
        result[f"{name}_p95"] = percentile(values, 0.95)
        result[f"{name}_mean"] = statistics.fmean(values) if values else math.nan
        result[f"{name}_max"] = max(values, default=math.nan)
    return result


def number(value):
    if math.isnan(value):
        return "-"
    return f"{value:.2f}" if abs(value) < 10 else f"{value:.1f}" if abs(value) < 100 else f"{value:.0f}"


def columns(lines, left):
    """Lines of cells as text; the first `left` columns are flush left, the others flush right."""
    widths = [max(len(line[k]) for line in lines) for k in range(len(lines[0]))]
    return "\n".join("  ".join(cell.ljust(width) if k < left else cell.rjust(width)
                               for k, (cell, width) in enumerate(zip(line, widths, strict=True))).rstrip()
                     for line in lines)


def text(rows):
    """The table as it is printed: median [p95]; the counts are of flights."""
    titles = dict(DISTRIBUTIONS)
    counts = ("flights", "failures", "contacts", "takeovers", "cuts")
    lines = [["set", "law", *counts, "highest mm", *(titles[name] for name in PRINTED)]]
    for r in rows:
        lines.append([r["set"], r["law"], *(str(r[name]) for name in counts), number(r["highest_mm"]),
                      *(f"{number(r[name + '_median'])} [{number(r[name + '_p95'])}]" for name in PRINTED)])
    return columns(lines, left=2)


def write_csv(path, rows):
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys(), lineterminator="\n")
        writer.writeheader()
        writer.writerows({name: "" if isinstance(value, float) and math.isnan(value) else value
                          for name, value in r.items()} for r in rows)


def plain(rows):
    """Rows for JSON: NaN becomes null."""
    return [{name: None if isinstance(value, float) and math.isnan(value) else value for name, value in r.items()}
            for r in rows]
