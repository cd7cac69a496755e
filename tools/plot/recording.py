"""What was recorded: flight CSV, flight recorder CSV, XCTU console log or telemetry text, read into one Recording.

Columns hold floats, NaN where the file has no value. No library beyond Python's own.
"""
import csv
import math
import re
from dataclasses import dataclass, field
from pathlib import Path

RECORDER_COLUMNS = ("t_s", "meas_m", "est_m", "innov_m", "ref_m", "thrust_n", "roll_rad", "pitch_rad", "state", "flags")
FLIGHT_COLUMNS = RECORDER_COLUMNS + ("height_m", "abs_m", "terrain_m", "pulse_us")     # and what only the PC board knows
OPEN_LOOP_COLUMNS = ("flown_n",)       # of `plomada replay` on a log: the thrust that the vehicle answered to
TEXT_COLUMNS = ("state", "laser")
TELEMETRY_PERIOD_S = 0.2

# 02-05-2015 11:44:56.017,-,RECV,23534554...
CONSOLE_LINE = re.compile(r"^\d+-\d+-\d+ (\d+):(\d\d):(\d\d)\.(\d{3}),[^,]*,(SENT|RECV),([0-9A-Fa-f ]*)$")
CONSOLE_START = re.compile(r"^\d+-\d+-\d+ \d+:\d\d:\d\d\.\d{3},")
FIELD = re.compile(r"(\w+):(\S+)")
ANSWER = re.compile(r"^(OK|ERR)( |$)")


class Unreadable(Exception):
    """The file is none of the four kinds, or a damaged one."""


@dataclass
class Recording:
    name: str
    kind: str                                       # "flight", "recorder", "console" or "telemetry"
    columns: dict = field(default_factory=dict)     # name -> list, all of one length
    sent: list = field(default_factory=list)        # (t_s, text) of the operator's lines, console logs only
    damaged: int = 0                                # telemetry lines that could not be read

    @property
    def t(self):
        return self.columns["t_s"]

    def has(self, name):
        return name in self.columns and any(
            value != "" if name in TEXT_COLUMNS else not math.isnan(value) for value in self.columns[name])


def number(text):
    """A float, NaN for the marks of a missing value."""
    return math.nan if text in ("", "-", None) else float(text)


DUMP_ROW = re.compile(rb"OK LOG [0-9]|4F4B204C4F47203[0-9]", re.IGNORECASE)     # text, or the same in a payload's hex


def has_dump(path):
    """Whether rows of a #LOG dump are in a file that is not CSV already."""
    raw = Path(path).read_bytes()
    return not raw.lstrip(b"\xef\xbb\xbf").startswith(b"t_s,") and DUMP_ROW.search(raw) is not None


def read(path):
    """Reads a file; its kind is found from the content. Raises Unreadable or OSError."""
    path = Path(path)
    raw = path.read_bytes().replace(b"\0", b"")     # a radio that powers up sends NULs
    lines = raw.decode("utf-8-sig", errors="replace").replace("\r\n", "\n").replace("\r", "\n").split("\n")
    first = next((line for line in lines if line.strip()), "")
    if first.startswith("t_s,"):
        flight = "height_m" in first.split(",")
        return read_csv(path, lines, "flight" if flight else "recorder", FLIGHT_COLUMNS if flight else RECORDER_COLUMNS)
    if CONSOLE_START.match(first):
        return read_console(path, lines)
    recording = Recording(path.stem, "telemetry")
    read_telemetry(recording, ((index * TELEMETRY_PERIOD_S, line) for index, line in enumerate(
        line for line in lines if line.strip() and not ANSWER.match(line.strip()))))
    if not recording.t:
        raise Unreadable(f"{path}: neither a flight CSV, an XCTU console log nor telemetry text")
    return recording


def read_csv(path, lines, kind, names):
    rows = csv.DictReader(line for line in lines if line)
    missing = [name for name in names if name not in rows.fieldnames]
    if missing:
        raise Unreadable(f"{path}: no column {', '.join(missing)}")
    names = (*names, *(name for name in OPEN_LOOP_COLUMNS if name in rows.fieldnames))
    columns = {name: [] for name in names}
    for row in rows:
        try:
            values = {name: row[name] if name in TEXT_COLUMNS else number(row[name]) for name in names}
        except ValueError as error:
            raise Unreadable(f"{path}:{rows.line_num}: {error}") from None
        for name, value in values.items():
            columns[name].append(value)
    if not columns["t_s"]:
        raise Unreadable(f"{path}: no samples")
    return Recording(path.stem, kind, columns)


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
    columns = {name: [] for name in ("t_s", "meas_m", "ref_m", "thrust_n", "state", "laser", "flags")}
    for t, line in timed_lines:
        if ANSWER.match(line.strip()):
            continue
        fields = dict(FIELD.findall(line))
        try:
            row = {
                "t_s": t,
                "meas_m": number(fields["alt"]),
                "ref_m": number(fields["ref"]),
                "thrust_n": number(fields["thr"]),
                "state": fields["state"],
                "laser": fields["laser"],
                "flags": number(fields["flags"]),
            }
        except (KeyError, ValueError):
            recording.damaged += 1
            continue
        for name, value in row.items():
            columns[name].append(value)
    recording.columns = columns
