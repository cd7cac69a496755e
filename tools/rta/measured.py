"""The answer to `#PERF COSTS`, from a saved text, put into a table."""
import re
from dataclasses import replace

from table import Wrong

PS_PER_NS = 1000
# A record of XCTU's console log: date time,id,TYPE,octets in hex. The radio's packets end anywhere, and so do these.
RECORD = re.compile(r"\d+-\d+-\d+ \d+:\d+:.*?,.*?,(\w+),\s*([0-9A-Fa-f ]*)")
COST = re.compile(r"OK PERF COSTS (\d+) (\S+) ([a-z]+)_ns:(\d+)")
END = re.compile(r"OK PERF END lines:(\d+)")


def lines_of(octets):
    """Of a terminal's text, or of XCTU's console log from its first record on."""
    text = octets.decode("latin-1")
    records = [match for match in map(RECORD.match, text.splitlines()) if match]
    if records:
        text = "".join(bytes.fromhex(match[2]).decode("latin-1") for match in records if match[1] == "RECV")
    return text.replace("\0", "").splitlines()      # a radio that powers up sends NULs


def read(path):
    """(costs, holds), {name: ps} each, of the last answer in the file."""
    rows, whole = {}, None
    try:
        with open(path, "rb") as file:
            lines = lines_of(file.read())
    except OSError as error:
        raise Wrong(f"{path}: {error.strerror}") from None
    for line in lines:
        cost, end = COST.match(line), END.match(line)
        if cost:
            if cost[1] == "1" or whole is not None:     # a first line begins a new answer
                rows, whole = {}, None
            rows[int(cost[1])] = cost
        elif end and 1 in rows and whole is None:
            whole = sorted(rows) == list(range(1, int(end[1]) + 1))
    if not whole:
        raise Wrong(f"{path}: no whole answer to #PERF COSTS in it; ask again")
    return ({row[2]: int(row[4]) * PS_PER_NS for row in rows.values() if row[3] != "hold"},
            {row[2]: int(row[4]) * PS_PER_NS for row in rows.values() if row[3] == "hold"})


def cost_of(costs, name):
    """Clock_swi is a job, TaskControl_height a row of TaskControl. 0: not measured, or it never ran."""
    return costs.get(name, costs.get(name.partition("_")[0], 0))


def missing(table, costs):
    """Names of the rows whose cost stays the table's."""
    return [row.name for row in table if not cost_of(costs, row.name)]


def longest(holds):
    """(ps, whose) of the gate that was held for longest."""
    return max(((time, gate) for gate, time in holds.items() if time > 0), default=(0, "-"), key=lambda hold: hold[0])


def apply(table, costs, holds):
    """A row's cost becomes the board's, with everything in it; what waits at gates, the longest hold each time. A row that was not measured
    stays."""
    hold = longest(holds)[0]
    board = [replace(row, blocking=row.blockings * hold) if hold else row for row in table]
    return [replace(row, cost=cost_of(costs, row.name), accesses=0, whole=True) if cost_of(costs, row.name) else row for row in board]
