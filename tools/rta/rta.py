#!/usr/bin/env python3
"""Response-time analysis of a table of tasks, Swis and interrupts: does every task meet its deadline?

TABLE is the seed's (seed, the default), this firmware's (plomada), the same with the releases of law EST (plomada-est), or a CSV file. Per
task, times in ms: the demand W(D) up to its deadline as the seed computed it, with its horizons corrected, with the context switches of every
job; the true worst response time, and the slack it leaves before the deadline. The first three look at the table alone; --jitter and --bursts
change the response, load and growth.

A file begins with name,kind,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings and may add
accesses,burst_n,burst_period_ms,jitter_ms,blocked_by; kind is hwi, swi or task. --print shows an example.

Exit status: 0 all deadlines hold, 1 one does not, 2 usage or not a table.
"""
import argparse
import copy
import json
import math
import signal
import sys

import analysis
import measured
import table as tables
from table import Wrong

SWITCHES_MS, ACCESS_MS = "0.057", "0.0093"      # Annex IV's


def time(text):
    try:
        return tables.time(text)
    except Wrong as error:
        raise argparse.ArgumentTypeError(f"'{text}': {error}") from None


def arguments(words):
    parser = argparse.ArgumentParser(prog="rta.py", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("table", nargs="?", default="seed", metavar="TABLE")
    parser.add_argument("--switch-ms", type=time, default=SWITCHES_MS, metavar="MS", help="two context switches, per task job and per blocking "
                        "(default %(default)s; the first three as well)")
    parser.add_argument("--access-ms", type=time, default=ACCESS_MS, metavar="MS", help="one server access, for the column accesses (default "
                        "%(default)s; the first three as well)")
    parser.add_argument("--jitter", type=time, default="0", metavar="MS", help="every release may come this late (default %(default)s)")
    parser.add_argument("--bursts", action="store_true", help="rows with burst_n come in frames of burst_n every burst_period_ms, not as "
                        "endless streams")
    parser.add_argument("--chain", metavar="A,B,...,Z", help="also the worst time from what releases A to the end of task Z, when each releases "
                        "the next; with --bursts A may be an interrupt with burst_n: the last one of its frame")
    parser.add_argument("--set", action="append", default=[], metavar="ROW.COLUMN=VALUE", help="changes a number of the table; may be repeated")
    parser.add_argument("--measured", metavar="FILE", help="a saved answer to #PERF COSTS (text, or a console log of XCTU): costs, responses, "
                        "slack and growth of that board beside the table's; the other figures are then the board's")
    parser.add_argument("--json", metavar="FILE", help="the same figures")
    parser.add_argument("--print", action="store_true", help="prints the table itself, as CSV, and does nothing else")
    return parser.parse_args(words)


def chain_of(table, text):
    if text is None:
        return []
    members = [tables.find(table, name) for name in text.split(",")]
    if None in members:
        raise Wrong(f"--chain: {text}: no such row")
    if members[-1].kind != analysis.TASK or not all(analysis.goes_before(row, members[-1]) for row in members[:-1]):
        raise Wrong(f"--chain: {text}: the last must be a task, and none before it of lower priority")
    return members


# ---- report

def ms(ps):
    return f"{ps / analysis.PS_PER_MS:.4f}" if math.isfinite(ps) else "-"


def deadline(row):
    return f"{row.deadline / analysis.PS_PER_MS:8g}"


def late(row, response):
    return "  LATE" if response > row.deadline else ""


def report(name, table, options):
    yield f"{name:18} prio        D {'seed W(D)':>10} {'W(D)':>10} {'switching':>10} {'response':>10} {'slack':>10}"
    for row in analysis.tasks(table):
        response = analysis.response(table, options, row)
        times = (analysis.demand_seed(table, options, row), analysis.demand(table, options, row, switching=False),
                 analysis.demand(table, options, row), response, row.deadline - response)
        yield f"{row.name:18} {row.priority:4} {deadline(row)} " + " ".join(f"{ms(time):>10}" for time in times) + late(row, response)


def totals(table, options):
    load = analysis.load(table, options)
    yield "load: hwi {hwi:.4f}, swi {swi:.4f}, tasks {task:.4f}, switches {switches:.4f}, total {total:.4f}".format(**load)
    factor, name = analysis.growth(table, options, False)
    yield f"growth: at {factor:.2f} times these costs {name} is late; context switches too: {analysis.growth(table, options, True)[0]:.2f}"


def beside(name, table, options, found):
    """What a board measured beside what the table says."""
    costs, holds = found
    yield "longest, with server accesses and switches"
    yield f"{name:18} {'table':>10} {'board':>10}"
    for row in table:
        told = analysis.job_cost(row, options) + analysis.job_switches(row, options)
        yield f"{row.name:18} {ms(told):>10} {ms(measured.cost_of(costs, row.name) or math.inf):>10}"
    hold, gate = measured.longest(holds)
    yield f"{'hold of a gate':18} {ms(options.access):>10} {ms(hold or math.inf):>10} {gate}"
    yield ""
    yield f"{'response':18} {'D':>8} {'table':>10} {'board':>10} {'slack':>10} {'board':>10}"
    board = measured.apply(table, *found)
    for row, other in zip(analysis.tasks(table), analysis.tasks(board)):
        told, response = analysis.response(table, options, row), analysis.response(board, options, other)
        yield (f"{row.name:18} {deadline(row)} {ms(told):>10} {ms(response):>10} {ms(row.deadline - told):>10} "
               f"{ms(row.deadline - response):>10}{late(row, response)}")


def totals_beside(table, board, options):
    load = [analysis.load(rows, options)["total"] for rows in (table, board)]
    yield "load: table {:.4f}, board {:.4f}".format(*load)
    (told, name), (factor, other) = (analysis.growth(rows, options, False) for rows in (table, board))
    yield f"growth: at {told:.2f} times the table's costs {name} is late, at {factor:.2f} times the board's {other}"


def measured_of(table, path):
    """(costs, holds) of a board that measured something."""
    found = measured.read(path)
    if len(measured.missing(table, found[0])) == len(table):
        raise Wrong(f"{path}: no row of the table was measured, so there is no verdict; fly, and then ask #PERF COSTS")
    return found


def said(table, found, holds):
    """The verdict, and before it what it rests on that the board has not told."""
    left_out = measured.missing(table, found[0]) if found else []
    if left_out:
        yield f"not measured, taken from the table: {', '.join(left_out)}"
    yield f"{'all' if holds else 'NOT all'} deadlines hold{' on this board' if found else ''}"


def figure(number, digits):
    return float(f"{number:.{digits}g}") if math.isfinite(number) else None


def figures(table, options, chain, chain_text):
    """For --json. Times in ms; no bound: null."""
    def told(ps):
        return figure(ps / analysis.PS_PER_MS, 9)

    rows = []
    for row in analysis.tasks(table):
        response = analysis.response(table, options, row)
        rows.append({"name": row.name, "priority": row.priority, "period_ms": told(row.period), "deadline_ms": told(row.deadline),
                     "demand_seed_ms": told(analysis.demand_seed(table, options, row)),
                     "demand_ms": told(analysis.demand(table, options, row, switching=False)),
                     "demand_switching_ms": told(analysis.demand(table, options, row)), "response_ms": told(response),
                     "slack_ms": told(row.deadline - response)})
    load = analysis.load(table, options)
    return {"holds": analysis.late_task(table, options) is None, "tasks": rows,
            "load": {key: round(load[kind], 6) for key, kind in
                     (("hwi", "hwi"), ("swi", "swi"), ("tasks", "task"), ("switches", "switches"), ("total", "total"))},
            **({"chain": {"members": chain_text, "response_ms": told(analysis.chain(table, options, chain))}} if chain else {}),
            "growth": figure(analysis.growth(table, options, False)[0], 6),
            "growth_with_switches": figure(analysis.growth(table, options, True)[0], 6)}


def run(words):
    args = arguments(words)
    text = tables.text_of(args.table)
    table = tables.read(text, args.table)
    tables.assign(table, args.set)
    options = analysis.Options(args.switch_ms, args.access_ms, args.jitter, args.bursts)
    if args.print:
        print(text, end="")
        return 0
    found = measured_of(table, args.measured) if args.measured else None
    board = measured.apply(table, *found) if found else copy.copy(table)
    chain = chain_of(board, args.chain)
    holds = analysis.late_task(board, options) is None
    if args.json:
        with open(args.json, "w", encoding="utf-8") as file:
            json.dump(figures(board, options, chain, args.chain), file, indent=2)
            file.write("\n")
    print(*(beside(args.table, table, options, found) if found else report(args.table, board, options)), sep="\n")
    if chain:
        print(f"{args.chain}: {ms(analysis.chain(board, options, chain))}")
    print(*(totals_beside(table, board, options) if found else totals(board, options)), sep="\n")
    print(*said(table, found, holds), sep="\n")
    return 0 if holds else 1


def main():
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)      # a reader that has seen enough is no error
    try:
        status = run(sys.argv[1:])
        sys.stdout.flush()
        return status
    except (Wrong, OSError) as error:
        print(f"rta.py: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
