#!/usr/bin/env python3
"""plot.py FILE... [-o PNG]: draws a flight.

FILE is a flight CSV of `plomada fly --csv`, the flight recorder's (`#LOG`, docs/operator.md), a console log saved by
XCTU, or telemetry text as a terminal captured it; the kind is found from the content. Several flight CSVs are drawn over
one another. PNG may be a directory; by default the picture lies beside the first FILE. Where FILE.json of `plomada fly --json` lies beside a CSV, its metrics are quoted.
The path of the picture is printed. Of one flight its events are numbered, and a page beside the picture, of the same name, says each in a
sentence: its path is printed below. Exit 2 when a FILE cannot be read.
"""
import argparse
import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import recording
import told

os.environ.setdefault("MPLCONFIGDIR", os.path.join(sys.prefix, "matplotlib"))

PROGRAM = Path(__file__).resolve().parents[2] / "build/plomada"
STATE_COLOURS = {
    "GROUND": "#c9c9c9",
    "TAKEOFF": "#f2c14e",
    "FLYING": "#7bc47f",
    "FLOATING": "#8ecae6",
    "COASTING": "#f4a261",
    "DESCENDING": "#d1495b",
    "LANDING": "#9d8df1",
    "LOWERING": "#e07be0",
    "CUT": "#222222",
}
LASER_COLOURS = {"OK": "#7bc47f", "WAIT": "#c9c9c9"}
OTHER_COLOURS = ("#5fa8a8", "#b08968", "#a3b18a", "#cdb4db", "#6d8fb3")
FLAG_NAMES = {1: "height", 2: "attitude", 4: "disagree", 8: "too high", 16: "link", 32: "tilt", 64: "pilot", 128: "out of reach", 256: "sight in doubt",
              512: "IMU in doubt", 1024: "thrust in doubt", 2048: "stick does not count", 4096: "mirrors, or the height at rest"}

HEIGHT, MEASURED, ESTIMATE, REFERENCE, TERRAIN, THRUST = "#1f5fa8", "#e07a1f", "#2a8f4f", "#333333", "#b79268", "#a0303f"
FLIGHT_COLOURS = ("#1f5fa8", "#e07a1f", "#2a8f4f", "#a0303f", "#7550a8", "#5a5a5a", "#1a9aa0", "#b3589a")
STEP_M, STAYS_M = 0.05, 0.5     # chosen: a hover sways by less; a shorter way needs no picture
QUOTED = (
    ("rise_time_s", "rise", "{:.2f} s"),
    ("overshoot_mm", "overshoot", "{:.0f} mm"),
    ("hover_rms_mm", "hover RMS", "{:.0f} mm"),
    ("terrain_rms_mm", "terrain RMS", "{:.0f} mm"),
    ("recovery_s", "recovery", "{:.2f} s"),
)


def runs(t, values):
    """(start, end, value) of each stretch of equal values; the last one ends a sample after its last."""
    step = (t[-1] - t[0]) / (len(t) - 1) if len(t) > 1 else 1.0
    start = 0
    for index in range(1, len(values) + 1):
        if index == len(values) or values[index] != values[start]:
            yield t[start], t[index] if index < len(t) else t[-1] + step, values[start]
            start = index


def colour_of(value, known, others):
    return known.get(value) or others.setdefault(value, OTHER_COLOURS[len(others) % len(OTHER_COLOURS)])


def window(recordings):
    """The span to show: from 1 s before the first reference, so that the wait for the sensor does not squeeze the flight."""
    first = min(rec.t[0] for rec in recordings)
    last = max(rec.t[-1] for rec in recordings)
    references = [t for rec in recordings for t, ref in zip(rec.t, rec.columns["ref_m"]) if ref > 0]
    return max(first, min(references) - 1.0) if references else first, last if last > first else first + 1.0


def without_zero(values):
    return [value if value > 0 else math.nan for value in values]


def metrics_text(path):
    """The metrics that `plomada fly --json` wrote beside the CSV, in one line; empty when there are none."""
    try:
        report = json.loads(Path(path).with_suffix(".json").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return ""
    metrics = report.get("metrics", report) if isinstance(report, dict) else {}
    return "   ".join(f"{label} {form.format(metrics[name])}" for name, label, form in QUOTED
                      if isinstance(metrics.get(name), (int, float)))


def draw_band(axis, row, t, values, span, known, others):
    """One row of coloured stretches, each labelled where the label fits."""
    width = span[1] - span[0]
    for start, end, value in runs(t, values):
        start, end = max(start, span[0]), min(end, span[1])
        if end <= start or value == "":
            continue
        axis.broken_barh([(start, end - start)], (row - 0.4, 0.8), color=colour_of(value, known, others), linewidth=0)
        if (end - start) / width > 0.0115 * len(value) + 0.005:
            axis.text((start + end) / 2, row, value, ha="center", va="center", fontsize=8.5, color="#222222")


def draw_flags(axis, row, t, flags, span):
    """Red marks, one thin line per raised flag; the row is labelled with the names of those that were raised."""
    raised = [bit for bit in FLAG_NAMES if any(int(value) & bit for value in flags if not math.isnan(value))]
    height = 0.8 / len(raised)
    for index, bit in enumerate(raised):
        low = row - 0.4 + index * height
        for start, end, up in runs(t, [not math.isnan(value) and bool(int(value) & bit) for value in flags]):
            if up and end > span[0]:
                axis.broken_barh([(start, end - start)], (low, height * 0.85), color="#d1495b", linewidth=0)
    return ", ".join(FLAG_NAMES[bit] for bit in reversed(raised))


def draw_bands(axis, recordings, span, labelled):
    names, others, row, used = [], {}, 0, {}

    def add(rec, name, known, title):
        nonlocal row
        draw_band(axis, row, rec.t, rec.columns[name], span, known, others)
        for start, end, value in runs(rec.t, rec.columns[name]):
            if end > span[0] and value not in ("", "OK"):
                used[value] = colour_of(value, known, others)
        names.append(title)
        row -= 1

    for rec in recordings:
        add(rec, "state", STATE_COLOURS, rec.name if labelled else "state")
        if not labelled and rec.has("laser"):
            add(rec, "laser", LASER_COLOURS, "laser")
        flags = rec.columns["flags"]
        if not labelled and any(int(value) for value in flags if not math.isnan(value)):
            names.append("flags: " + draw_flags(axis, row, rec.t, flags, span))
            row -= 1
    axis.set_yticks(range(0, row, -1), names, fontsize=8.5)
    axis.set_ylim(row + 0.5, 0.5)
    axis.tick_params(left=False)
    axis.grid(False)
    axis.figure.legend(handles=[patch(colour, label) for label, colour in used.items()], loc="lower center",
                       bbox_to_anchor=(0.545, 0.0), ncol=len(used), frameon=False, fontsize=8.5)


def patch(colour, label):
    from matplotlib.patches import Patch
    return Patch(color=colour, label=label)


def draw_height(axis, recordings, overlay):
    for index, rec in enumerate(recordings):
        columns = rec.columns
        colour = FLIGHT_COLOURS[index % len(FLIGHT_COLOURS)] if overlay else HEIGHT
        if rec.has("height_m"):
            axis.plot(rec.t, columns["height_m"], color=colour, linewidth=1.8, label=rec.name if overlay else "height")
        style = {"marker": ".", "markersize": 3} if rec.kind != "flight" else {}
        if not overlay and rec.has("meas_m"):
            axis.plot(rec.t, columns["meas_m"], color=MEASURED, linewidth=1.0, label="height as measured", **style)
        if not overlay and rec.has("innov_m"):
            axis.plot(rec.t, columns["est_m"], color=ESTIMATE, linewidth=1.0, label="estimate", **style)
        if not overlay and rec.has("ref_m"):
            axis.plot(rec.t, without_zero(columns["ref_m"]), color=REFERENCE, linestyle="--", linewidth=1.3,
                      label="reference", drawstyle="steps-post")
    if overlay:
        for number, reference in enumerate({tuple(without_zero(rec.columns["ref_m"])): rec for rec in recordings}.values()):
            axis.plot(reference.t, without_zero(reference.columns["ref_m"]), color=REFERENCE, linestyle="--",
                      linewidth=1.3, label=None if number else "reference", drawstyle="steps-post")
    axis.set_ylabel("height above\nground (m)")
    axis.set_ylim(bottom=min(0.0, axis.get_ylim()[0]))


def draw_sent(axis, sent, span):
    for t, text in sent:
        if span[0] <= t <= span[1]:
            axis.axvline(t, color="#777777", linewidth=0.8, linestyle=":")
            axis.annotate(text, (t, 1.0), xycoords=("data", "axes fraction"), xytext=(2, -3), textcoords="offset points",
                          rotation=90, ha="left", va="top", fontsize=8, color="#555555")


def way_flown(rec):
    """Metres along the ground up to each sample, in steps of STEP_M: less is the sway of one that stays. None: it stays, or no log of places."""
    if not rec.has("x_m"):
        return None
    xs, ys = rec.columns["x_m"], rec.columns["y_m"]
    way, last = [0.0] * len(xs), 0
    for index in range(1, len(xs)):
        gone = math.hypot(xs[index] - xs[last], ys[index] - ys[last])
        if gone >= STEP_M:
            for between in range(last + 1, index + 1):
                way[between] = way[last] + gone * (between - last) / (index - last)
            last = index
    way[last + 1:] = [way[last]] * (len(xs) - last - 1)
    return way if way[-1] >= STAYS_M else None


def draw_absolute(axis, recordings, ways, overlay):
    """Terrain and vehicle, against the ways flown; None: against the time."""
    rec = recordings[0]
    across = ways or [flight.t for flight in recordings]
    axis.fill_between(across[0], rec.columns["terrain_m"], min(0.0, min(rec.columns["terrain_m"])) - 0.05, color=TERRAIN,
                      alpha=0.7, linewidth=0, label="terrain")
    axis.plot(across[0], rec.columns["terrain_m"], color=TERRAIN, linewidth=1.2)
    for index, flight in enumerate(recordings):
        colour = FLIGHT_COLOURS[index % len(FLIGHT_COLOURS)] if overlay else HEIGHT
        axis.plot(across[index], flight.columns["abs_m"], color=colour, linewidth=1.8,
                  label=None if overlay else "vehicle")
    axis.set_ylabel("absolute\nheight (m)")
    axis.set_ylim(bottom=min(0.0, min(rec.columns["terrain_m"])) - 0.05)
    if ways:
        axis.set_xlim(0.0, max(way[-1] for way in ways))
        axis.set_xlabel("way flown (m)", labelpad=1)


def ways_flown(recordings):
    """Of all of them, or None: one stays where it is, or its log tells no places."""
    ways = [way_flown(rec) for rec in recordings]
    return None if None in ways else ways


def draw_thrust(axis, recordings, overlay):
    for index, rec in enumerate(recordings):
        colour = FLIGHT_COLOURS[index % len(FLIGHT_COLOURS)] if overlay else THRUST
        if rec.has("flown_n"):
            axis.plot(rec.t, rec.columns["flown_n"], color="#999999", linewidth=1.0, drawstyle="steps-post", label="as flown")
        axis.plot(rec.t, rec.columns["thrust_n"], color=colour, linewidth=1.2, drawstyle="steps-post",
                  label="as this law would" if rec.has("flown_n") else None)
        if rec.has("flown_n"):
            axis.legend(loc="upper right", ncol=2)
    axis.set_ylabel("thrust per\nmotor (N)")
    axis.set_ylim(bottom=0)
    axis.margins(y=0.15)


PICTURES = (".png", ".svg", ".pdf")


def draw(recordings, title, subtitle, path):
    """Draws recordings (several: flights only) into the PNG `path`, 1200 x 900. Returns the page that tells of one; several: None."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    plt.rcParams.update({
        "font.size": 10.5, "axes.grid": True, "grid.color": "#e3e3e3", "axes.axisbelow": True, "axes.edgecolor": "#888888",
        "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": True, "legend.framealpha": 0.9,
        "legend.edgecolor": "none", "legend.fontsize": 9.5,
    })
    overlay = len(recordings) > 1
    flights = recordings[0].kind == "flight"
    span = window(recordings)
    bands = len(recordings) if overlay else 1 + recordings[0].has("laser") + any(
        value > 0 for value in recordings[0].columns["flags"])

    ratios = [5.0] + ([3.0] if flights else []) + [2.4, 0.42 * bands]
    ways = ways_flown(recordings) if flights else None
    figure, axes = plt.subplots(len(ratios), 1, figsize=(12, 9), dpi=100,
                                gridspec_kw={"height_ratios": ratios, "hspace": 0.3 if ways else 0.12})
    axes = list(axes)
    figure.subplots_adjust(left=0.115, right=0.975, top=0.915, bottom=0.1)
    figure.align_ylabels(axes[:-1])
    figure.text(0.115, 0.962, title, fontsize=15, fontweight="bold")
    figure.text(0.115, 0.934, subtitle, fontsize=10.5, color="#555555")

    draw_height(axes[0], recordings, overlay)
    draw_sent(axes[0], recordings[0].sent, span)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="upper right", bbox_to_anchor=(0.98, 0.99), ncol=4)
    in_time = [axis for axis in axes if not ways or axis is not axes[1]]
    for axis in in_time[:-1]:
        axis.sharex(axes[-1])
        axis.tick_params(labelbottom=ways is not None and axis is axes[0])
    if flights:
        draw_absolute(axes[1], recordings, ways, overlay)
        if not overlay:
            axes[1].legend(loc="upper right", ncol=2)
    draw_thrust(axes[-2], recordings, overlay)
    draw_bands(axes[-1], recordings, span, overlay)
    for spine in ("left", "bottom"):
        axes[-1].spines[spine].set_visible(False)
    axes[-1].set_xlabel("time (s)")
    axes[-1].set_xlim(span)
    found = [] if overlay else told.draw(axes[0], recordings[0], span)
    figure.savefig(path)
    page = None if overlay else told.write(path, title, figure.canvas.get_width_height()[0], told.places(figure, axes[0], found))
    plt.close(figure)
    return page


def describe(paths, recordings):
    if len(recordings) > 1:
        return "Flights compared", ""
    rec = recordings[0]
    if rec.has("flown_n"):
        return f"{rec.name}: open loop", "the vehicle did not answer to this law's thrust; its heights are those of the flight as flown"
    cut = "the file ends within a row" if rec.cut else ""
    if rec.kind == "flight":
        return rec.name, "   ".join(filter(None, (metrics_text(paths[0]), cut)))
    source = {"console": "XCTU console log", "recorder": "flight recorder"}.get(rec.kind, "telemetry text")
    damaged = f", {rec.damaged} damaged lines left out" if rec.damaged else ""
    return rec.name, f"{source}: {len(rec.t)} lines{damaged}{', ' + cut if cut else ''}"


def picture_path(output, first):
    if output is None:
        return Path(first).with_suffix(".png")
    if output.endswith("/") or Path(output).is_dir():
        return Path(output) / (Path(first).stem + ".png")
    return Path(output)


def with_dumps_converted(files, program, directory):
    """files, those with dumps of #LOG in them replaced by the CSVs that `plomada log` makes of them in a directory."""
    found = []
    for number, file in enumerate(files):
        if not recording.has_dump(file):
            found.append(file)
            continue
        own = Path(directory, str(number))      # two consoles may have one name
        own.mkdir()
        if not Path(program).exists():
            raise recording.Unreadable(f"{file}: has a dump of #LOG, which {program} reads: make build")
        done = subprocess.run([program, "log", file, "-o", str(own)], capture_output=True, text=True, check=False)
        if done.returncode == 2:
            raise recording.Unreadable(done.stderr.strip().removeprefix("plomada log: ") or f"{file}: its dump of #LOG cannot be read")
        print(done.stderr, end="", file=sys.stderr)
        found += [line.rsplit(": ", 1)[0] for line in done.stdout.splitlines()]
    return found


def check_output(output, files):
    """A picture is no other kind of file, and neither it nor its page is one that is read."""
    path = picture_path(output, files[0])
    if path.suffix.lower() not in PICTURES:
        raise recording.Unreadable(f"{path}: no name of a picture: it ends in {', '.join(PICTURES)}, or is a folder with its /")
    recording.apart([path, path.with_suffix(".html")], files, "-o")


def draw_files(files, output):
    """One picture; prints its path."""
    recordings = [recording.read(path) for path in files]
    for file, rec in zip(files, recordings, strict=True):
        if rec.cut:
            print(f"plot: {file}: ends within a row, which is left out; the flight may have gone on", file=sys.stderr)
    path = picture_path(output, files[0])
    path.parent.mkdir(parents=True, exist_ok=True)
    page = draw(recordings, *describe(files, recordings), path)
    print(path.resolve())
    if page:
        print(page.resolve())


def groups(files):
    """Flights are drawn over one another, everything else by itself."""
    kinds = [recording.read(path).kind for path in files]
    return [files] if all(kind == "flight" for kind in kinds) else [[path] for path in files]


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", metavar="FILE", nargs="+")
    parser.add_argument("-o", "--output", metavar="PNG")
    parser.add_argument("--program", metavar="PLOMADA", default=str(PROGRAM), help="default: build/plomada")
    options = parser.parse_args(arguments)
    output = options.output or str(Path(options.files[0]).parent) + "/"
    try:
        check_output(output, options.files)
        with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
            pictures = groups(with_dumps_converted(options.files, options.program, scratch))
            if len(pictures) > 1 and len(options.files) > 1:
                raise recording.Unreadable("only CSVs of `plomada fly --csv` can be drawn together; draw each of these alone")
            if len(pictures) > 1 and not Path(output).is_dir():
                raise recording.Unreadable(f"{options.files[0]}: {len(pictures)} dumps make as many pictures: -o DIRECTORY/")
            for group in pictures:
                draw_files(group, output)
    except recording.Unreadable as error:
        print(f"plot: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"plot: {error.filename or output}: {error.strerror or error}", file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
