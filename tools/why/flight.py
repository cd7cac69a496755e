"""A flight as evidence: what the columns of its log hold, without the columns of the truth that a simulated flight has.

Every reader is that of tools/plot/recording.py; dumps within a console are taken out by `plomada log`, a recording of the pins is
flown again by `plomada replay`.
"""
import math
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tools/plot"), str(ROOT / "tools/fit")]
import flight_log  # noqa: E402
import recording  # noqa: E402

Unfit = recording.Unreadable
NEEDED = ("t_s", "meas_m", "ref_m", "thrust_n", "roll_rad", "pitch_rad", "state", "flags", "up_mps2", "age_s")
WORDS = ("state", "doubt", "limit")
GROUNDED = ("GROUND", "")
ALOFT_M = 0.07
LEAST_S, LEAST_HEIGHTS = 1.5, 12        # of a flight: less tells nothing of the vehicle
SPAN_S = 1.5                    # of a span
GAP_S = 0.5                     # rows are missing
RING_ROWS = 1250                # of the recorder: docs/operator.md, flight recorder


@dataclass
class Flight:
    name: str
    column: dict                # name: array, of NEEDED, innov_m, est_m and WORDS
    new: numpy.ndarray          # rows with a height that was not there before
    rays_s: numpy.ndarray       # instant of the rays of each row's height, as the firmware believes
    felt: numpy.ndarray         # rows with an acceleration
    late_s: float               # a row shows what came up to twice so long before it
    spans: list                 # [(begin, end)] in the air
    beams: dict = field(default_factory=dict)   # columns of single mirrors, where the log has them
    ring: bool = False          # of the chip's recorder, which keeps flights only, and the latest rows
    dump: str = ""              # which of several it is

    @property
    def t_s(self):
        return self.column["t_s"]

    def aloft(self):
        inside = numpy.zeros(len(self.t_s), bool)
        for begin, end in self.spans:
            inside |= (self.t_s >= begin) & (self.t_s <= end)
        return inside

    def seconds(self):
        return sum(end - begin for begin, end in self.spans)


def dumps_of(path, program, scratch):
    """(the CSV of its longest dump, which of several that is, or "")"""
    copy = Path(scratch, path.name)
    copy.write_bytes(recording.octets_of(path))
    done = subprocess.run([program, "log", str(copy)], check=False, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    found = [Path(line.rsplit(": ", 1)[0]) for line in done.stdout.splitlines()]
    if not found:
        raise Unfit(done.stderr.strip().replace(str(copy), str(path)).removeprefix("plomada log: ")[:300] or f"{path}: no dump of #LOG")
    longest = max(found, key=lambda file: file.stat().st_size)
    return longest, f"dump {found.index(longest) + 1} of {len(found)}" if len(found) > 1 else ""


def replayed(path, program, scratch):
    csv = Path(scratch, "replay.csv")
    done = subprocess.run([program, "replay", str(path), "--csv", str(csv)], check=False, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode == 2 or not csv.exists():
        raise Unfit(f"{path}: {done.stderr.strip()[:200]}")
    for line in done.stderr.splitlines():
        if line.startswith("plomada replay: "):     # it is cut, or the firmware stopped
            print(line, file=sys.stderr)
    return csv


def read(path, program):
    """Raises Unfit, or OSError."""
    path = Path(path)
    with tempfile.TemporaryDirectory(prefix="plomada-") as scratch:
        csv, dump = path, ""
        if path.is_dir():
            csv = replayed(path, program, scratch)
        elif recording.has_dump(path):
            csv, dump = dumps_of(path, program, scratch)
        found = recording.read(csv)
    if found.kind not in ("flight", "recorder"):
        raise Unfit(f"{path}: telemetry alone, five lines a second, does not tell why; type #LOG after the flight and save it "
                    "(docs/operator.md, flight recorder)")
    flight = flight_of(path, found)
    flight.dump = dump
    return flight


def flight_of(path, found):
    missing = [name for name in NEEDED if name not in found.columns]
    if missing:
        raise Unfit(f"{path}: no column {', '.join(missing)}")
    column = {name: numpy.array(found.columns[name]) for name in (*NEEDED, "innov_m", "est_m")}
    for name in WORDS:
        column[name] = numpy.array(found.columns.get(name, [""] * len(found.t)))
    for name, what in (("meas_m", "heights"), ("thrust_n", "thrust"), ("roll_rad", "roll"), ("pitch_rad", "pitch")):
        if numpy.isnan(column[name]).all():
            raise Unfit(f"{path}: no {what}: {name} is empty")
    for name in ("thrust_n", "ref_m", "flags"):
        column[name] = flight_log.filled(column["t_s"], column[name])
    t_s = column["t_s"]
    rays_s = t_s - column["age_s"]
    new = scans_of(rays_s, column["meas_m"])
    late_s = flight_log.PC_ROW_S / 2.0 if found.kind == "flight" else 0.0
    felt = ~numpy.isnan(column["up_mps2"])
    beams = {name: numpy.array(found.columns[name]) for name in recording.BEAM_COLUMNS if name in found.columns}
    flight = Flight(Path(path).stem, column, new, rays_s, felt, late_s, [], beams, found.kind == "recorder")
    flight.spans = spans_of(flight)
    if flight.seconds() < LEAST_S and not (column["ref_m"] > 0.0).any():
        raise Unfit(f"{path}: no flight: {flight.seconds():.1f} s in the air, and no reference")
    return flight


def scans_of(rays_s, meas_m):
    """The first row of each scan that has its height: a CSV of 100 Hz may tell the age of a scan a row before its height."""
    new, latest, scan = numpy.zeros(len(rays_s), bool), -math.inf, []
    known = numpy.flatnonzero(~numpy.isnan(rays_s) & ~numpy.isnan(meas_m))
    for k in [*known, None]:
        if k is not None and rays_s[k] <= latest + 0.02:
            scan.append(k)
            continue
        if scan:
            new[next(row for row in scan if meas_m[row] == meas_m[scan[-1]])] = True
        if k is not None:
            latest, scan = rays_s[k], [k]
    return new


def spans_of(flight, aloft_m=ALOFT_M):
    """In the air, and long enough to tell something."""
    return [(a, b) for a, b in pieces_of(flight, aloft_m) if b - a >= SPAN_S]


def pieces_of(flight, aloft_m=ALOFT_M):
    """In the air: neither state GROUND nor a height of the ground, and no rows missing. Heights may be missing."""
    t_s, c = flight.t_s, flight.column
    height_m = flight_log.filled(t_s, c["meas_m"])
    good = numpy.array([state not in GROUNDED for state in c["state"]]) & (height_m > aloft_m)
    found, begin = [], None
    for k in range(len(t_s)):
        torn = k > 0 and t_s[k] - t_s[k - 1] > GAP_S
        if begin is not None and (torn or not good[k]):
            found.append((begin, t_s[k - 1]))
            begin = None
        if begin is None and good[k]:
            begin = t_s[k]
    if begin is not None:
        found.append((begin, t_s[-1]))
    return found


def begins_takeoff(flight, k):
    """Whether row k is the first one of a take-off. Such a row stands behind one of the ground, or the recorder begins with it: it keeps
    no rows of the ground. A full ring has lost its first row, and a log may be cut. So the row must show what the recorder's first row
    always shows (firmware/flight_recorder.c): the latest scan and the latest frame, whenever they came. A few rows elsewhere show both too
    (docs/why.md, logs that begin in the air): so often a cut within a take-off is not seen."""
    state, t_s = flight.column["state"], flight.t_s
    if state[k] != "TAKEOFF" or k > 0 and state[k - 1] != "GROUND":
        return False
    if k > 0 and t_s[k] - t_s[k - 1] <= GAP_S:
        return True
    scanned = any(not math.isnan(rays[k]) for name, rays in flight.beams.items() if name.endswith("_rays"))
    return bool(flight.ring and (k > 0 or len(t_s) < RING_ROWS) and flight.felt[k] and scanned)


def takeoffs(flight):
    """Rows of those take-offs whose beginning is in the log."""
    begun = numpy.zeros(len(flight.t_s), bool)
    for k in numpy.flatnonzero(flight.column["state"] == "TAKEOFF"):
        begun[k] = k > 0 and begun[k - 1] or begins_takeoff(flight, k)
    return begun


def commands_since(flight, at_s):
    """Since when the log has every command until at_s. -inf: since the vehicle stood on the ground, where none is given."""
    torn = numpy.flatnonzero(numpy.diff(flight.t_s[flight.t_s <= at_s]) > GAP_S)
    first = int(torn[-1]) + 1 if len(torn) else 0
    grounded = flight.column["state"][first] == "GROUND" or begins_takeoff(flight, first)
    return -math.inf if grounded else float(flight.t_s[first])
