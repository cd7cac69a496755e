#!/usr/bin/env python3
"""scan.py FILE|DEVICE [-o PNG]: draws what a scanner saw.

FILE is a recording (`plomada scip record`, or a log of flexiport, .logr); DEVICE a scanner on a serial port, which is then
recorded for --seconds first. One picture: the latest scan as the sensor sees the room, its front up, and behind it the
median of all scans; and the distance in every direction over time. The path of the picture is printed. Exit 2 when FILE or
DEVICE cannot be read, or has no scan.
"""
import argparse
import io
import math
import os
import stat
import subprocess
import sys
import tempfile
from pathlib import Path

os.environ.setdefault("MPLCONFIGDIR", os.path.join(sys.prefix, "matplotlib"))
import numpy  # noqa: E402

import recording  # noqa: E402

PROGRAM = Path(__file__).resolve().parents[2] / "build/plomada"
CODE_LIMIT_MM = 20      # smaller values are codes
FAR_MM = 4095           # two characters end here: far or unknown
PICTURES = (".png", ".svg", ".pdf")
COLUMNS_MAX = 2000      # of the image; a longer recording shows every n-th scan


class NoScan(Exception):
    """What to say."""


class Scans:
    """time_s[scan], angle_deg[step], distance_m[scan, step]; NaN where there is no distance."""

    def __init__(self, table):
        time, step, angle, distance = table
        distance = numpy.where((distance < CODE_LIMIT_MM) | (distance == FAR_MM), numpy.nan, distance / 1000)
        begins = numpy.flatnonzero(numpy.diff(time, prepend=-1.0) != 0)
        steps, first = numpy.unique(step, return_index=True)
        self.angle_deg = angle[first]
        self.time_s = time[begins]
        self.distance_m = numpy.full((len(begins), len(steps)), numpy.nan)
        row = numpy.repeat(numpy.arange(len(begins)), numpy.diff(begins, append=len(time)))
        self.distance_m[row, numpy.searchsorted(steps, step)] = distance

    def median_m(self):
        seen = ~numpy.all(numpy.isnan(self.distance_m), axis=0)
        median = numpy.full(len(self.angle_deg), numpy.nan)
        median[seen] = numpy.nanmedian(self.distance_m[:, seen], axis=0)
        return median


def record(program, device, seconds, directory):
    path = os.path.join(directory, "scan")
    done = subprocess.run([program, "scip", "record", device, path, "--seconds", str(seconds)], check=False)
    if done.returncode != 0:
        raise NoScan(f"{device}: no recording")
    return path


def decode(program, path):
    done = subprocess.run([program, "scip", "decode", path, "--long"], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True, check=False)
    if done.returncode == 1:
        raise NoScan(f"{path}: no scan in it; it is to be a recording of `plomada scip record`, or a log of flexiport (.logr)\n{done.stderr.strip()}")
    if done.returncode != 0:
        raise NoScan(done.stderr.strip())
    table = numpy.loadtxt(io.StringIO(done.stdout), delimiter=",", skiprows=1, ndmin=2, unpack=True)
    sensor = [line[8:] for line in done.stderr.splitlines() if line.startswith("sensor: ")]
    return Scans(table), sensor[0] if sensor else ""


def read(program, source, seconds):
    with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
        if os.path.exists(source) and stat.S_ISCHR(os.stat(source).st_mode):
            source = record(program, source, seconds, scratch)
        return decode(program, source)


def reach_m(scans):
    """A little beyond nearly everything seen."""
    good = scans.distance_m[~numpy.isnan(scans.distance_m)]
    return 1.05 * float(numpy.percentile(good, 99)) if len(good) else 1.0


def draw_polar(axis, scans):
    theta = numpy.radians(scans.angle_deg)
    axis.set_theta_zero_location("N")
    axis.plot(theta, scans.median_m(), ".", markersize=3, color="#bbbbbb", label="median")
    axis.plot(theta, scans.distance_m[-1], ".", markersize=3, color="#1f5fa8", label=f"scan at {scans.time_s[-1]:.1f} s")
    axis.set_ylim(0, reach_m(scans))
    axis.set_thetagrids(range(0, 360, 45), [f"{angle - 360 * (angle > 180)}°" for angle in range(0, 360, 45)])
    axis.set_title("front up, distances in m", fontsize=10)
    axis.legend(loc="lower center", bbox_to_anchor=(0.5, -0.14), ncol=2, frameon=False)


def draw_image(figure, axis, scans):
    every = math.ceil(len(scans.time_s) / COLUMNS_MAX)
    time, distance = scans.time_s[::every] - scans.time_s[0], scans.distance_m[::every]
    if len(time) == 1:
        time, distance = numpy.array([0.0, 0.1]), numpy.repeat(distance, 2, axis=0)
    if len(scans.angle_deg) == 1:
        axis.plot(time, distance[:, 0], ".-", color="#1f5fa8")
        axis.set_ylabel("distance (m)")
    else:
        mesh = axis.pcolormesh(time, scans.angle_deg, distance.T, shading="nearest", cmap="viridis", vmin=0,
                               vmax=reach_m(scans))
        figure.colorbar(mesh, ax=axis, label="distance (m); white: none")
        axis.set_ylabel("direction (degrees, positive to the left)")
    axis.set_xlabel("time (s, the sensor's clock)")


def draw(scans, title, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    figure = plt.figure(figsize=(14, 6.5), dpi=100)
    draw_polar(figure.add_subplot(1, 2, 1, projection="polar"), scans)
    draw_image(figure, figure.add_subplot(1, 2, 2), scans)
    figure.subplots_adjust(left=0.04, right=1.0, wspace=0.18)
    figure.suptitle(title)
    figure.savefig(path)
    plt.close(figure)


def picture_path(output, source):
    if output is None:
        return Path(source + ".png")
    if output.endswith("/") or Path(output).is_dir():
        return Path(output) / (Path(source).name + ".png")
    return Path(output)


def check_picture(path, source):
    """A picture is no other kind of file, and not the one that is read."""
    if path.suffix.lower() not in PICTURES:
        raise NoScan(f"{path}: no name of a picture: it ends in {', '.join(PICTURES)}, or is a folder with its /")
    recording.apart([path], [source], "-o")


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("source", metavar="FILE|DEVICE")
    parser.add_argument("-o", "--output", metavar="PNG", help="or a directory; default: beside FILE")
    parser.add_argument("--seconds", type=float, default=5.0, help="of a DEVICE; default 5")
    parser.add_argument("--program", metavar="PLOMADA", default=str(PROGRAM), help="default: build/plomada")
    options = parser.parse_args(arguments)
    path = picture_path(options.output, options.source)
    try:
        check_picture(path, options.source)
        scans, sensor = read(options.program, options.source, options.seconds)
        path.parent.mkdir(parents=True, exist_ok=True)
        draw(scans, f"{Path(options.source).name}: {len(scans.time_s)} scans   {sensor}", path)
    except (NoScan, recording.Unreadable) as error:
        print(f"scan: {error}", file=sys.stderr)
        return 2
    except OSError as error:
        print(f"scan: {error.filename}: {error.strerror}", file=sys.stderr)
        return 2
    print(path.resolve())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
