"""What was recorded: flight CSV, flight recorder CSV, XCTU console log or telemetry text, read into one Recording.

Columns hold floats, NaN where the file has no value. Every tool reads its flights here, so that none believes what cannot be:
a number that is none, a time that goes back, a height that no scanner of 4 m sees, an angle in degrees. What is wrong in a CSV
is told with its line; of telemetry, which a radio may damage, such a line is left out and counted. No library beyond Python's own.
"""
import math
import re
from dataclasses import dataclass, field
from pathlib import Path

RECORDER_COLUMNS = ("t_s", "meas_m", "est_m", "innov_m", "ref_m", "thrust_n", "roll_rad", "pitch_rad", "state", "flags")
FLIGHT_COLUMNS = RECORDER_COLUMNS + ("height_m", "abs_m", "terrain_m", "pulse_us")     # and what only the PC board knows
PLACE_COLUMNS = ("x_m", "y_m", "heading_rad")           # of logs since the ground is a place
OPEN_LOOP_COLUMNS = ("flown_n",)       # of `plomada replay` on a log: the thrust that the vehicle answered to
FIT_COLUMNS = ("up_mps2", "age_s")     # of logs since #LOG RATE FAST
BATTERY_COLUMNS = ("bat_v",)
# Of logs that say what is doubted, which limit holds, how the battery is, and which mirrors the vote left out.
NAME_COLUMNS = ("doubt", "limit", "bat", "out")
# Of logs since all mirrors are told: of each its good rays, slant, their spread, age and probability to lie (docs/operator.md).
BEAM_COLUMNS = tuple(f"{mirror}_{what}" for mirror in ("mf", "m1", "m2") for what in ("rays", "mm", "spread_mm", "ms", "lie"))
KNOWN_COLUMNS = (*FLIGHT_COLUMNS, *PLACE_COLUMNS, *OPEN_LOOP_COLUMNS, *FIT_COLUMNS, *BATTERY_COLUMNS, *NAME_COLUMNS, *BEAM_COLUMNS)
TEXT_COLUMNS = ("state", "laser", *NAME_COLUMNS)
TELEMETRY_PERIOD_S = 0.2

# 02-05-2015 11:44:56.017,-,RECV,23534554...
CONSOLE_LINE = re.compile(r"^\d+-\d+-\d+ (\d+):(\d\d):(\d\d)\.(\d{3}),[^,]*,(SENT|RECV),([0-9A-Fa-f ]*)$")
CONSOLE_START = re.compile(r"^\d+-\d+-\d+ \d+:\d\d:\d\d\.\d{3},")
FIELD = re.compile(r"(\w+):(\S+)")
ANSWER = re.compile(r"^(OK|ERR)( |$)|^mf:")       # or the line of the beams: neither takes one of the 200 ms


NUMBER = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d{1,3})?")
WORD = re.compile(r"[A-Z_]*(/[a-z]+)?|m[f12](\+m[f12])*")
MARK = "\ufeff"                 # some programs begin a text with it
OCTETS_MAX = 200_000_000        # a flight of an hour has 50 million
# What a column can hold. Heights: the scanner sees 4.095 m, its code has twelve bits (docs/scip.md); the reference is 0 to 3 m,
# full throttle 11.76 N, an angle of the Razor at most half a turn, its accelerometer's range 16 g.
LIMITS = {"t_s": (-1e6, 1e6, "seconds"), "meas_m": (-5.0, 5.0, "metres"), "ref_m": (0.0, 3.0, "metres"),
          "thrust_n": (0.0, 20.0, "newtons per motor"), "roll_rad": (-3.2, 3.2, "radians"), "pitch_rad": (-3.2, 3.2, "radians"),
          "up_mps2": (-200.0, 200.0, "m/s2"), "flags": (0.0, 65535.0, "flags"), "age_s": (0.0, 5000.0, "seconds")}
SPACING_MOST_S = 1.0            # the slowest record of a flight comes every 0.15 s


class Unreadable(Exception):
    """The file is none of the four kinds, or a damaged one."""


def apart(written, files, option):
    """Raises Unreadable when what is to be written is one of the files that are read. One file goes by many names: links too."""
    for path in map(Path, written):
        if any(path.exists() and Path(file).exists() and path.samefile(file) for file in files):
            raise Unreadable(f"{path}: is read here; another {option}")


@dataclass
class Recording:
    name: str
    kind: str                                       # "flight", "recorder", "console" or "telemetry"
    columns: dict = field(default_factory=dict)     # name -> list, all of one length
    sent: list = field(default_factory=list)        # (t_s, text) of the operator's lines, console logs only
    damaged: int = 0                                # telemetry lines that could not be read
    cut: bool = False                               # a CSV that ends within a row, which is left out

    @property
    def t(self):
        return self.columns["t_s"]

    def has(self, name):
        return name in self.columns and any(
            value != "" if name in TEXT_COLUMNS else not math.isnan(value) for value in self.columns[name])


def number(text, name=None):
    """A float, NaN for the marks of a missing value. ValueError: no number, or none that column `name` can hold."""
    if text in ("", "-"):
        return math.nan
    value = float(text) if NUMBER.fullmatch(text) else math.nan
    if not math.isfinite(value):
        raise ValueError(f"'{text[:40]}' is no number")
    low, high, unit = LIMITS.get(name, (-math.inf, math.inf, ""))
    if not low <= value <= high:
        raise ValueError(f"{text[:40]} is not in {unit}: {low:g} to {high:g}")
    return value


DUMP_ROW = re.compile(rb"OK LOG [0-9]|4F4B204C4F47203[0-9]", re.IGNORECASE)     # text, or the same in a payload's hex


def has_dump(path):
    """Whether rows of a #LOG dump are in a file that is not CSV already."""
    raw = octets_of(path).replace(b"\0", b"")       # of a text in UTF-16, too
    return not raw.lstrip(b"\xef\xbb\xbf").startswith(b"t_s,") and DUMP_ROW.search(raw) is not None


def octets_of(path):
    with Path(path).open("rb") as file:
        octets = file.read(OCTETS_MAX + 1)
    if len(octets) > OCTETS_MAX:
        raise Unreadable(f"{path}: more than {OCTETS_MAX // 1_000_000} million octets are no flight")
    return octets


def read(path):
    """Reads a file; its kind is found from the content. Raises Unreadable or OSError."""
    path = Path(path)
    raw = octets_of(path)
    text = raw.decode("utf-8", errors="replace").removeprefix(MARK).replace("\r\n", "\n").replace("\r", "\n")
    first = next((line for line in text.lstrip("\0").split("\n", 50) if line.strip("\0 \t")), "")
    if first.replace('"', "").startswith("t_s,"):
        return read_csv(path, text)
    if first.replace('"', "").startswith(("t_s;", "t_s\t")):
        raise Unreadable(f"{path}:1: cells are separated by '{first.replace(chr(34), '')[3]}', not by a comma")
    lines = text.replace("\0", "").split("\n")        # a radio that powers up sends NULs
    if any(CONSOLE_START.match(line) for line in lines):     # whatever stands before its first record
        return read_console(path, lines)
    recording = Recording(path.stem, "telemetry")
    read_telemetry(recording, ((index * TELEMETRY_PERIOD_S, line) for index, line in enumerate(
        line for line in lines if line.strip() and not ANSWER.match(line.strip()))))
    if not recording.t:
        raise Unreadable(f"{path}: neither a flight CSV, an XCTU console log nor telemetry text")
    return recording


def read_csv(path, text):
    """All known columns of a flight's CSV. Raises Unreadable."""
    *lines, rest = text.split("\n")
    titles, rows = None, []
    for at, line in enumerate([*lines, rest] if not lines else lines, 1):
        if not line:
            continue
        cells = cells_of(path, at, line)
        if titles is None:
            titles = cells
        elif len(cells) != len(titles):
            raise Unreadable(f"{path}:{at}: {len(cells)} cells, the titles are {len(titles)}")
        else:
            rows.append((at, cells))
    flight = "height_m" in titles
    names = FLIGHT_COLUMNS if flight else RECORDER_COLUMNS
    wrong = [f"no column {', '.join(name for name in names if name not in titles)}"] if set(names) - set(titles) else []
    wrong += [f"two columns {name}" for name in KNOWN_COLUMNS if titles.count(name) > 1]
    if wrong:
        raise Unreadable(f"{path}: {wrong[0]}")
    if not rows:
        raise Unreadable(f"{path}: no samples")
    columns = columns_of(path, titles, rows)
    return Recording(path.stem, "flight" if flight else "recorder", columns, cut=rest != "")


def cells_of(path, at, line):
    """Cells of a row; a spreadsheet may have put quotes around them."""
    cells = [cell[1:-1] if len(cell) > 1 and cell[0] == cell[-1] == '"' else cell for cell in line.split(",")]
    if '"' in "".join(cells):
        raise Unreadable(f"{path}:{at}: a quote within a row")
    return cells


def cell_of(name, text):
    if name not in TEXT_COLUMNS:
        return number(text, name)
    if not WORD.fullmatch(text):
        raise ValueError(f"'{text[:40]}' is no {name}")
    return text


def columns_of(path, titles, rows):
    places = [(name, titles.index(name)) for name in KNOWN_COLUMNS if name in titles]
    columns = {name: [] for name, _ in places}
    before = -math.inf
    for at, cells in rows:
        for name, place in places:
            try:
                columns[name].append(cell_of(name, cells[place]))
            except ValueError as error:
                raise Unreadable(f"{path}:{at}: {name}: {error}") from None
        now = columns["t_s"][-1]
        if not now >= before:       # NaN neither
            raise Unreadable(f"{path}:{at}: t_s: {cells[titles.index('t_s')] or 'nothing'} does not come after {before:g}")
        before = now
    spacing_s = (columns["t_s"][-1] - columns["t_s"][0]) / len(rows)
    if spacing_s > SPACING_MOST_S:
        at = max(range(1, len(rows)), key=lambda k: columns["t_s"][k] - columns["t_s"][k - 1])
        raise Unreadable(f"{path}:{rows[at][0]}: t_s: from {columns['t_s'][at - 1]:g} to {columns['t_s'][at]:g}, and rows {spacing_s:.3g} s apart on "
                         "average: no time of a flight in seconds")
    return columns


def read_console(path, lines):
    recording = Recording(path.stem, "console")
    received, sent = Assembler(), Assembler()
    timed = []
    start = previous = None
    for line in lines:
        match = CONSOLE_LINE.match(line.strip())
        if not match:
            continue
        hours, minutes, seconds, milliseconds, direction, payload = match.groups()
        try:
            octets = bytes.fromhex(payload)
        except ValueError:
            recording.damaged += 1
            continue
        t = int(hours) * 3600 + int(minutes) * 60 + int(seconds) + int(milliseconds) / 1000
        if previous is not None and t < previous - 43200:
            t += 86400
        start = t if start is None else start
        previous = t
        if direction == "RECV":
            timed += [(t - start, text) for text in received.feed(octets)]
        else:
            recording.sent += [(t - start, text) for text in sent.feed(octets) if text.startswith("#")]
    read_telemetry(recording, timed)
    if not recording.t:
        raise Unreadable(f"{path}: an XCTU console log without a line of telemetry")
    return recording


class Assembler:
    """Radio packets are no lines: joins them and splits at line ends."""

    def __init__(self):
        self.rest = b""

    def feed(self, octets):
        *lines, self.rest = re.split(rb"[\r\n]+", self.rest + octets)
        return [line.decode("ascii", errors="replace") for line in lines if line]


def read_telemetry(recording, timed_lines):
    columns = {name: [] for name in ("t_s", "meas_m", "ref_m", "thrust_n", "state", "laser", "flags", "doubt", "limit")}
    for t, line in timed_lines:
        if ANSWER.match(line.strip()):
            continue
        fields = dict(FIELD.findall(line))
        try:
            row = {
                "t_s": t,
                "meas_m": number(fields["alt"], "meas_m"),
                "ref_m": number(fields["ref"], "ref_m"),
                "thrust_n": number(fields["thr"], "thrust_n"),
                "state": cell_of("state", fields["state"]),
                "laser": cell_of("laser", fields["laser"]),
                "flags": number(fields["flags"], "flags"),
                "doubt": cell_of("doubt", fields.get("doubt", "")),
                "limit": cell_of("limit", fields.get("limit", "")),
            }
        except (KeyError, ValueError):
            recording.damaged += 1
            continue
        for name, value in row.items():
            columns[name].append(value)
    recording.columns = columns
