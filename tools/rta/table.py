"""A table of tasks, Swis and interrupts as CSV.

First line: name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings and then any of
accesses,burst_n,burst_period_ms,jitter_ms,blocked_by. kind is hwi, swi or task. Times in ms, 0..100000, plain decimals. Priority, deadline,
blocking, blockings and blocked_by concern tasks and are not looked at in other rows; blocking, blockings and the further columns may be
empty or "-"; burst_n and burst_period_ms go together; blocked_by is names of rows with + between. Blank lines and lines that begin with '#'
are skipped.
"""
import re
from pathlib import Path

import analysis

FIXED = "name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings"
BUILT_IN = ("seed", "plomada", "plomada-est")
TIME_MAX_MS, COUNT_MAX = 100_000, 100_000
NAME = re.compile(r'[^\x00-\x1f\x7f"\\=]+')


class Wrong(Exception):
    """Not a table, and why."""


def time(text):
    if not re.fullmatch(r"[0-9]+(\.[0-9]+)?", text):
        raise Wrong("not a time in ms")
    if float(text) > TIME_MAX_MS:
        raise Wrong(f"over {TIME_MAX_MS} ms")
    return round(float(text) * analysis.PS_PER_MS)


def positive_time(text):
    ps = time(text)
    if ps == 0:
        raise Wrong("must be over 0")
    return ps


def count(text):
    if not re.fullmatch(r"[0-9]{1,6}", text) or int(text) > COUNT_MAX:
        raise Wrong(f"not a whole number of 0..{COUNT_MAX}")
    return int(text)


def name(text):
    if not NAME.fullmatch(text):
        raise Wrong("holds a character that names have not" if text else "missing")
    return text


def kind(text):
    if text.lower() not in analysis.KINDS:
        raise Wrong("not hwi, swi or task")
    return text.lower()


def names(text):
    return tuple(filter(None, text.split("+")))


# column: (member of the row, how its cell is read, concerns tasks alone, may be blank)
COLUMNS = {
    "name": ("name", name, False, False),
    "kind": ("kind", kind, False, False),
    "priority": ("priority", count, True, False),
    "period_ms": ("period", positive_time, False, False),
    "deadline_ms": ("deadline", positive_time, True, False),
    "cost_ms": ("cost", positive_time, False, False),
    "blocking_ms": ("blocking", time, True, True),
    "blockings": ("blockings", count, True, True),
    "accesses": ("accesses", count, False, True),
    "burst_n": ("burst_n", count, False, True),
    "burst_period_ms": ("burst_period", positive_time, False, True),
    "jitter_ms": ("jitter", time, False, True),
    "blocked_by": ("blocked_by", names, True, True),
}
WORDS = ("name", "kind", "blocked_by")      # columns that are no numbers


def header_of(cells):
    if cells[:8] != FIXED.split(","):
        raise Wrong(f"the first line must be {FIXED}")
    for at, column in enumerate(cells):
        if column not in COLUMNS:
            raise Wrong(f"{column}: no such column")
        if column in cells[:at]:
            raise Wrong(f"{column}: twice")
    return cells


def put(row, column, text):
    member, read, tasks_only, may_be_blank = COLUMNS[column]
    if (tasks_only and row.kind != analysis.TASK) or (may_be_blank and text in ("", "-")):
        return
    try:
        setattr(row, member, read(text))
    except Wrong as error:
        raise Wrong(f"{column}: {error}") from None


def checked(row):
    if (row.burst_n is None) != (row.burst_period == 0):
        raise Wrong(f"{row.name}: burst_n and burst_period_ms go together")
    return row


def row_of(header, cells, table):
    if len(cells) != len(header):
        raise Wrong(f"{len(cells)} cells, not {len(header)}")
    row = analysis.Row("", analysis.HWI)
    for column, text in zip(header, cells):
        put(row, column, text)
    if find(table, row.name):
        raise Wrong(f"{row.name}: twice")
    return checked(row)


def find(table, wanted):
    """The row of that name, None when there is none."""
    return next((row for row in table if row.name == wanted), None)


def read(text, source="table"):
    """The rows. Wrong, with source and line, when the text is not a table."""
    header, table, at = None, [], 1
    try:
        for at, line in enumerate(text.splitlines(), 1):
            cells = [cell.strip() for cell in line.split(",")]
            if line.startswith("#") or not line.strip():
                continue
            if header is None:
                header = header_of(cells)
            else:
                table.append(row_of(header, cells, table))
        header_of(header or [])
        if not analysis.tasks(table):
            raise Wrong("no task in the table")
        for row in table:
            if not all(find(table, other) for other in row.blocked_by):
                raise Wrong(f"{row.name}: blocked_by: no such row")
    except Wrong as error:
        raise Wrong(f"{source}:{at}: {error}") from None
    return table


def text_of(source):
    """The text of a table by its name, or of a file."""
    path = Path(__file__).with_name(f"{source}.csv") if source in BUILT_IN else Path(source)
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Wrong(f"{source}: no table of that name, and no file that can be read ({error})") from None


def load(source):
    return read(text_of(source), source)


def assign(table, assignments):
    """Puts assignments such as "TaskControl.period_ms=25", each one number of one row, in this order."""
    for text in assignments:
        match = re.fullmatch(r"(.+)\.([^.=]*)=(.*)", text)
        if not match:
            raise Wrong(f"{text}: not ROW.COLUMN=VALUE")
        row, column = find(table, match[1]), match[2]
        if row is None:
            raise Wrong(f"{text}: no such row")
        if column not in COLUMNS or column in WORDS or (COLUMNS[column][2] and row.kind != analysis.TASK):
            raise Wrong(f"{text}: no such number in that row")
        put(row, column, match[3])
    for row in table:
        checked(row)
