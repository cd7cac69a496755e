#!/usr/bin/env python3
"""moving.py FLIGHT.csv... -o SVG: a moving picture of flights over one course, one below the other.

Each FLIGHT is a CSV of `plomada fly --csv`. A vehicle goes from left to right as time goes by; its red beam ends on the terrain, a
dashed line lies the reference above the terrain. The picture moves in any browser by itself, without a program in it.
Titles are the files' names, or those of --title, in their order. The path of the picture is printed. Exit 2 when a FILE cannot be read.
"""
import argparse
import sys
from html import escape
from pathlib import Path

import recording

WIDTH, LANE, MARGIN, TITLE = 860, 190, 28, 30    # pixels
PX_PER_M = 125.0
SAMPLE_S = 0.1
FASTER = 2.0                # than the flight
BEFORE_S, AFTER_S = 0.5, 2.0
COLOURS = ("#e07a1f", "#1f5fa8", "#2a8f4f", "#7550a8")
TERRAIN, REFERENCE, BEAM, INK = "#b79268", "#555555", "#d1495b", "#222222"


def window(recordings):
    """(start, end), the same for all: from just before the first reference until the last vehicle is down."""
    starts, ends = [], []
    for rec in recordings:
        with_reference = [time for time, value in zip(rec.t, rec.columns["ref_m"]) if value > 0]
        if not with_reference:
            raise recording.Unreadable(f"{rec.name}: nothing to show, no reference was ever in force")
        aloft = [time for time, height in zip(rec.t, rec.columns["height_m"]) if height > 0.02]
        starts.append(with_reference[0] - BEFORE_S)
        ends.append(max([with_reference[-1], *aloft]) + AFTER_S)
    return min(starts), max(ends)


def shown(rec, span):
    """The indices of the samples to draw."""
    found, due = [], span[0]
    for index, time in enumerate(rec.t):
        if due - 1e-6 <= time <= span[1]:
            found.append(index)
            due = time + SAMPLE_S
    if len(found) < 2:
        raise recording.Unreadable(f"{rec.name}: has nothing between {span[0]:g} s and {span[1]:g} s, where the flights are")
    return found


def number(value):
    return f"{value:.1f}".rstrip("0").rstrip(".")


def points(pairs):
    return " ".join(f"{number(x)},{number(y)}" for x, y in pairs)


def animate(attribute, values, seconds, kind="animate", more=""):
    return (f'<{kind} attributeName="{attribute}" {more}dur="{number(seconds)}s" repeatCount="indefinite" '
            f'values="{";".join(values)}"/>')


def vehicle(colour, path, heights, seconds):
    """Two arms with rotors, and below them the beam, which is as long as the vehicle is high."""
    moves = animate("transform", [f"{number(x)} {number(y)}" for x, y in path], seconds, "animateTransform", 'type="translate" ')
    grows = animate("y2", [number(height * PX_PER_M) for height in heights], seconds)
    return (f'<g>{moves}<line y2="0" stroke="{BEAM}" stroke-width="1.6">{grows}</line>'
            f'<path d="M-15-8H15M-15-8V-12M15-8V-12M-7 0L-4-8H4L7 0" fill="none" stroke="{INK}" stroke-width="2.2"/>'
            f'<path d="M-24-12H-6M6-12H24" stroke="{colour}" stroke-width="3" stroke-linecap="round"/></g>')


def lane(rec, span, title, colour, top, number_of):
    """One flight: title, terrain, reference, the course flown, which is uncovered as time goes by, and the vehicle."""
    indices = shown(rec, span)
    column = {name: [rec.columns[name][index] for index in indices] for name in ("height_m", "abs_m", "terrain_m", "ref_m")}
    seconds = (span[1] - span[0]) / FASTER
    floor = top + LANE - 10
    xs = [MARGIN + (WIDTH - 2 * MARGIN) * (rec.t[index] - span[0]) / (span[1] - span[0]) for index in indices]

    def course(heights):
        return [(x, floor - PX_PER_M * height) for x, height in zip(xs, heights)]

    terrain = [*course(column["terrain_m"]), (xs[-1], floor + 8), (xs[0], floor + 8)]
    wanted = [(x, floor - PX_PER_M * (ground + ref)) for x, ground, ref in zip(xs, column["terrain_m"], column["ref_m"]) if ref > 0]
    flown = course(column["abs_m"])
    uncovers = animate("width", [number(x) for x in xs], seconds)
    return (f'<text x="{MARGIN}" y="{top + 18}" font-size="15" fill="{colour}" font-weight="bold">{escape(title)}</text>'
            f'<polygon points="{points(terrain)}" fill="{TERRAIN}"/>'
            f'<polyline points="{points(wanted)}" fill="none" stroke="{REFERENCE}" stroke-width="1.2" stroke-dasharray="5 4"/>'
            f'<clipPath id="past{number_of}"><rect y="{top}" height="{LANE}" width="{WIDTH}">{uncovers}</rect></clipPath>'
            f'<polyline points="{points(flown)}" fill="none" stroke="{colour}" stroke-width="2.2" clip-path="url(#past{number_of})"/>'
            + vehicle(colour, flown, column["height_m"], seconds))


def picture(recordings, titles):
    height, span = TITLE + LANE * len(recordings), window(recordings)
    lanes = "\n".join(lane(rec, span, title, COLOURS[k % len(COLOURS)], TITLE + k * LANE, k)
                      for k, (rec, title) in enumerate(zip(recordings, titles)))
    legend = f"red: the laser's beam   dashed: the height to hold   brown: the terrain   {number(FASTER)} times as fast as flown"
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" font-family="sans-serif">'
            f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>'
            f'<text x="{MARGIN}" y="20" font-size="12" fill="{REFERENCE}" xml:space="preserve">{legend}</text>\n{lanes}\n</svg>\n')


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("files", metavar="FLIGHT.csv", nargs="+")
    parser.add_argument("-o", "--output", metavar="SVG", required=True)
    parser.add_argument("--title", action="append", metavar="TEXT")
    options = parser.parse_args(arguments)
    titles = options.title or [Path(file).stem for file in options.files]
    if len(titles) != len(options.files):
        parser.error("as many --title as files")
    try:
        recording.apart([options.output], options.files, "-o")
        recordings = [recording.read(file) for file in options.files]
        for file, rec in zip(options.files, recordings):
            if rec.kind != "flight":
                raise recording.Unreadable(f"{file}: no CSV of plomada fly --csv, which alone knows the terrain")
        Path(options.output).write_text(picture(recordings, titles), encoding="utf-8")
    except (recording.Unreadable, OSError) as error:
        print(f"moving: {error}", file=sys.stderr)
        return 2
    print(Path(options.output).resolve())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
