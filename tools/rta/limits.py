#!/usr/bin/env python3
"""The bounds of this firmware as `plomada fly --limits FILE` reads them, on stdout: of each task, and of the way from a scan's last octet to
the compare value under each release of TaskControl. All from plomada-est, whose control task is released most often; but for the releases
FREE and SCAN, which plomada.csv describes. Costs count in whole nanoseconds, as the simulation consumes them.
"""
import argparse
import math
import signal
from dataclasses import replace

import analysis
import table as tables
from rta import ACCESS_MS, SWITCHES_MS

PS_PER_NS = 1000


def nearest(ns):
    return math.floor(ns + 0.5)


def scaled(name, scale):
    """A blocking may be half a nanosecond longer by the rounding of each access."""
    return [replace(row, cost=PS_PER_NS * nearest(row.cost / PS_PER_NS * scale),
                    blocking=PS_PER_NS * math.ceil(row.blocking / PS_PER_NS * scale + 0.5 * row.blockings)) for row in tables.load(name)]


def ns(ps):
    return analysis.ceil_of(ps, PS_PER_NS) if math.isfinite(ps) else -1


def lines(table, options):
    """name,response_ns,deadline_ns,inversion_ns,blockings of each task. -1: no bound."""
    for row in analysis.tasks(table):
        yield f"{row.name},{ns(analysis.response(table, options, row))},{ns(row.deadline)},{ns(row.blocking)},{row.blockings}"


def latencies(scale, options):
    """Free-running, a height may have to wait for a whole period, then for the job."""
    scan, est = scaled("plomada", scale), scaled("plomada-est", scale)
    received = [tables.find(scan, name) for name in ("Laser_SWI", "TaskReceiveLaser", "TaskControl")]
    control = received[-1]
    yield "FREE", analysis.chain(scan, options, received[:-1]) + control.period + analysis.response(scan, options, control)
    yield "SCAN", analysis.chain(scan, options, received)
    yield "FRAME", analysis.chain(est, options, [tables.find(est, name) for name in ("Laser_SWI", "TaskReceiveLaser", "TaskControl_height")])


def main():
    signal.signal(signal.SIGPIPE, signal.SIG_DFL)      # a reader that has seen enough is no error
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--cost-scale", type=float, default=1.0, metavar="X", help="as that of the flight (default 1)")
    scale = parser.parse_args().cost_scale
    switches, access = (PS_PER_NS * nearest(tables.time(ms) / PS_PER_NS * scale) for ms in (SWITCHES_MS, ACCESS_MS))
    options = analysis.Options(switches, access)
    print(*lines(scaled("plomada-est", scale), options), sep="\n")
    for name, bound in latencies(scale, options):
        print(f"{name},{ns(bound)},-1,-1,-1")


if __name__ == "__main__":
    main()
