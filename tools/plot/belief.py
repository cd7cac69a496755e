#!/usr/bin/env python3
"""belief.py CSV [-o PNG] [--from S] [--to S] [--mark "S TEXT"]...: draws which mirrors the firmware believes.

CSV is a flight of `plomada fly --csv` with LAYOUT THREE. Three pictures below each other have one time: the height above the ground, true and
as believed; the slants of the three mirrors; how probably each of them lies. Each --mark is a line with its text. The path of the picture is printed. Exit 2 when the CSV cannot be read, or tells of one mirror alone.
"""
import argparse
import math
import os
import sys
from pathlib import Path

import recording

os.environ.setdefault("MPLCONFIGDIR", os.path.join(sys.prefix, "matplotlib"))

MIRRORS = (("mf", "front", "#1f5fa8"), ("m1", "aft (mirror 1)", "#e07a1f"), ("m2", "fore (mirror 2)", "#2a8f4f"))
TRUE, BELIEVED, TERRAIN, MARK = "#333333", "#a0303f", "#b79268", "#777777"
LEFT_OUT_ABOVE = 50.0       # percent: docs/control.md


def told(rec, name):
    """(times, values) where the column has one: a beam is told once a scan."""
    found = [(t, value) for t, value in zip(rec.t, rec.columns[name], strict=True) if not math.isnan(value)]
    return [t for t, _ in found], [value for _, value in found]


def mark(text):
    seconds, _, words = text.partition(" ")
    try:
        return recording.number(seconds), words
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from None


def draw_height(axis, rec):
    ground = rec.columns["terrain_m"]
    axis.fill_between(rec.t, ground, min(0.0, min(ground)), color=TERRAIN, alpha=0.7, linewidth=0, label="ground")
    axis.plot(rec.t, rec.columns["height_m"], color=TRUE, linewidth=1.6, label="height above it")
    axis.plot(rec.t, rec.columns["est_m"], color=BELIEVED, linewidth=1.0, label="as believed")
    axis.set_ylabel("height (m)")
    axis.set_ylim(bottom=0.0)


def draw_mirrors(slants, lies, rec):
    for name, label, colour in MIRRORS:
        slants.plot(*told(rec, f"{name}_mm"), color=colour, linewidth=1.2, label=label)
        lies.plot(*told(rec, f"{name}_lie"), color=colour, linewidth=1.5, marker=".", markersize=4, label=label)
    slants.set_ylabel("slant (mm)")
    slants.set_ylim(bottom=0.0)
    lies.axhline(LEFT_OUT_ABOVE, color=MARK, linewidth=0.9, linestyle="--")
    lies.set_ylim(-4, 104)
    lies.set_ylabel("lies with (%)")
    lies.set_xlabel("time (s)")


def draw(rec, span, marks, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({"font.size": 10, "axes.grid": True, "grid.color": "#e3e3e3", "axes.axisbelow": True, "axes.spines.top": False,
                         "axes.spines.right": False, "legend.fontsize": 9, "legend.framealpha": 0.9, "legend.edgecolor": "none"})
    figure, (height, slants, lies) = plt.subplots(3, 1, figsize=(11, 7.5), dpi=100, sharex=True, layout="constrained",
                                                  gridspec_kw={"height_ratios": [1.15, 1.0, 1.0]})
    draw_height(height, rec)
    draw_mirrors(slants, lies, rec)
    height.legend(loc="lower right", ncol=3)
    slants.legend(loc="lower left", ncol=3)
    for at, (seconds, words) in enumerate(marks):
        for axis in (height, slants, lies):
            axis.axvline(seconds, color=MARK, linewidth=1.0, linestyle=":")
        height.annotate(words, (seconds, 1.0), xycoords=("data", "axes fraction"), xytext=(3, 3 + 12 * (at % 2)), textcoords="offset points",
                        fontsize=9, color="#333333")
    lies.set_xlim(span)
    figure.savefig(path)
    plt.close(figure)


def read(path):
    rec = recording.read(path)
    lacking = [label for name, label, _ in MIRRORS if not rec.has(f"{name}_lie")]
    if rec.kind != "flight" or lacking:
        raise recording.Unreadable(f"{path}: no flight that tells how probably the mirrors lie: {', '.join(lacking) or 'not of plomada fly'}")
    return rec


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("file", metavar="CSV")
    parser.add_argument("-o", "--output", metavar="PNG")
    parser.add_argument("--from", dest="start", type=float, metavar="S")
    parser.add_argument("--to", dest="end", type=float, metavar="S")
    parser.add_argument("--mark", type=mark, action="append", default=[], metavar="'S TEXT'")
    options = parser.parse_args(arguments)
    path = Path(options.output or Path(options.file).with_suffix(".png"))
    try:
        rec = read(options.file)
        span = (rec.t[0] if options.start is None else options.start, rec.t[-1] if options.end is None else options.end)
        draw(rec, span, options.mark, path)
    except recording.Unreadable as error:
        print(f"belief: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"belief: {error.filename or path}: {error.strerror or error}", file=sys.stderr)
        return 2
    print(path.resolve())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
