"""Response-time analysis of one processor under fixed priorities: any interrupt before any Swi before any task, tasks by
priority, all preemptive. Pure functions of their arguments.

For task i, with S two context switches (per job and per blocking), B_i and n_i time and number of blockings, the q-th job of a
busy window (q = 0, 1, ...) ends at the least w with

    w = (q + 1) (C_i + S) + B_i + n_i S + sum over interrupts and Swis N(w) C + sum over tasks before i N_j(w) (C_j + S)

and R_i is the largest J + w - q P_i, up to the first job that ends before the next is released (Joseph and Pandya 1986; Lehoczky
1990 for q > 0). N(w), the releases in a window, is ceil((w + J) / P), J the jitter of all rows and the row's own j. For a stream in
frames of n, one per F, with f = floor((w + J) / F): min(ceil((w + j) / P), f n + min(n, ceil((w + J - f F) / P))).

A chain, each member releasing the next, ends with its last task, with the blockings of all; each lower task blocks the whole chain
once at most where the table says by whom; after the last octet of a frame nothing comes of that stream before the next frame. Growth
is found by bisection.

Times are whole picoseconds.
"""
import math
from dataclasses import dataclass, replace

PS_PER_MS = 10 ** 9
HWI, SWI, TASK = KINDS = ("hwi", "swi", "task")
# A response is given up beyond so many of the longest periods or deadlines, jobs of a busy window, or steps of one.
SEARCH_PERIODS, SEARCH_JOBS, SEARCH_STEPS = 16, 10_000, 100_000
GROWTH_STEP = 1e-6


@dataclass
class Row:
    name: str
    kind: str
    priority: int = 0       # tasks: the larger goes first; equals count against each other
    period: int = 0         # > 0, least time between releases
    deadline: int = 0       # tasks: > 0, from the release; may exceed the period
    cost: int = 0           # > 0, worst execution time
    blocking: int = 0       # tasks: sum of the lower tasks' critical sections that may come first
    blockings: int = 0      # tasks: their number, each worth two context switches
    accesses: int = 0       # server accesses per job that cost does not contain
    burst_n: int = None     # a stream that comes in frames: releases per frame,
    burst_period: int = 0   # one frame per so long; 0: endless
    jitter: int = 0         # every release may come this late, beside that of the options
    blocked_by: tuple = ()  # tasks: names of the lower tasks; (): not told
    whole: bool = False     # tasks: cost contains the job's context switches


@dataclass
class Options:
    switches: int = 0       # two context switches: to a job and back
    access: int = 0         # one server access
    jitter: int = 0         # every release may come this late
    bursts: bool = False    # streams come in their frames; otherwise each is endless, at its period


def tasks(table):
    """Highest priority first."""
    return sorted((row for row in table if row.kind == TASK), key=lambda row: -row.priority)


def job_cost(row, options):
    return row.cost + row.accesses * options.access


def job_switches(row, options):
    return options.switches if row.kind == TASK and not row.whole else 0


def blocking(row, options):
    return row.blocking + row.blockings * options.switches


def goes_before(row, task):
    return row is not task and (row.kind != TASK or row.priority >= task.priority)


def ceil_of(time, period):
    return -(-time // period)


# ---- demand W(D): what a task and everything before it may ask for in [0, its deadline], with its blocking; jitter and bursts are not
# looked at

def frozen_horizons(table):
    """Of each interrupt: Annex IV counts its k-th up to the k-th task's deadline at most (the first up to the second's, those after the
    last task's up to the last's)."""
    deadlines = [task.deadline for task in tasks(table)]
    interrupts = [row for row in table if row.kind == HWI]
    return {row.name: deadlines[min(max(k, 1), len(deadlines) - 1)] for k, row in enumerate(interrupts)}


def demand(table, options, task, horizons=None, switching=True):
    counted = [row for row in table if row is task or goes_before(row, task)]
    return blocking(task, options) + sum(
        ceil_of(min(task.deadline, (horizons or {}).get(row.name, task.deadline)), row.period) *
        (job_cost(row, options) + (job_switches(row, options) if switching else 0)) for row in counted)


def demand_seed(table, options, task):
    """As Annex IV computed it."""
    return demand(table, options, task, frozen_horizons(table), switching=False)


# ---- response

def comes_in_frames(row, options):
    return options.bursts and row.burst_period > 0


def arrivals(row, options, window):
    """Octets of a frame keep their distance on the wire, and wait before they interrupt for the row's jitter at most; whole frames may
    come late."""
    waited = window + row.jitter
    wide = waited + options.jitter
    if not comes_in_frames(row, options):
        return ceil_of(wide, row.period)
    frames, rest = divmod(wide, row.burst_period)
    return min(ceil_of(waited, row.period), frames * row.burst_n + min(row.burst_n, ceil_of(rest, row.period)))


def arrivals_after_frame(row, options, window):
    """The same for a stream whose frame ends as the window begins: what waited of it, then nothing until the next frame."""
    last = min(row.burst_n, 1 + row.jitter // row.period)
    gap = row.burst_period - row.burst_n * row.period - row.jitter - options.jitter
    return last if window <= gap else last + arrivals(row, options, window - gap)


def completion(before, options, frame, own, limit):
    """The smallest window with window = own + interference(window); infinity beyond the limit."""
    endless = [(row.jitter + options.jitter, row.period, cost) for row, cost in before if not comes_in_frames(row, options)]
    framed = [(arrivals_after_frame if row is frame else arrivals, row, cost) for row, cost in before if comes_in_frames(row, options)]
    window = own
    for _ in range(SEARCH_STEPS):
        if window > limit:
            break
        total = own + sum(cost * count(row, options, window) for count, row, cost in framed)
        for late, period, cost in endless:
            total -= -(window + late) // period * cost
        if total <= window:
            return window
        window = total
    return math.inf


def search(table, options, task, blocked, limit, frame=None):
    """The response of a task's job, or of a chain that ends with it, if it is at most `limit`, else infinity."""
    before = [(row, job_cost(row, options) + job_switches(row, options)) for row in table if goes_before(row, task)]
    cost = job_cost(task, options) + job_switches(task, options)
    late = options.jitter + task.jitter
    worst = 0
    for q in range(SEARCH_JOBS):
        release = q * task.period
        done = completion(before, options, frame, blocked + (q + 1) * cost, release + limit)
        worst = max(worst, late + done - release)
        if worst > limit:
            return math.inf
        if late + done <= release + task.period:
            return worst
    return math.inf


def search_limit(table):
    return SEARCH_PERIODS * max(max(row.period, row.deadline) for row in table)


def response(table, options, task):
    """Worst response time, jitter included, over all jobs of the task's longest busy window. Infinity: no bound found."""
    return search(table, options, task, blocking(task, options), search_limit(table))


def chain_blocking(options, members):
    total = sum(blocking(row, options) for row in members)
    if any(blocking(row, options) > 0 and not row.blocked_by for row in members):
        return total
    longest = max((row.blocking / row.blockings + options.switches for row in members if row.blockings > 0), default=0)
    return min(total, math.ceil(len({name for row in members for name in row.blocked_by}) * longest))


def chain(table, options, members):
    """Worst time from the event that releases the first member to the end of the last, a task, each releasing the next. All before the
    last go before it. If the first is an interrupt of a stream in frames, it is the last one of a frame."""
    first, last = members[0], members[-1]
    frame = first if first.kind == HWI and comes_in_frames(first, options) else None
    return search(table, options, last, chain_blocking(options, members), search_limit(table), frame)


# ---- load and growth

def rate(row, options):
    """Releases per ps."""
    endless = 1 / row.period
    return min(endless, row.burst_n / row.burst_period) if comes_in_frames(row, options) else endless


def load(table, options):
    """Shares of the processor: of each kind, of the context switches, and the total."""
    shares = {kind: sum(job_cost(row, options) * rate(row, options) for row in table if row.kind == kind) for kind in KINDS}
    shares["switches"] = sum(job_switches(row, options) * rate(row, options) for row in table)
    return {**shares, "total": sum(shares.values())}


def late_task(table, options):
    """The first task whose response is not within its deadline, or None: all deadlines hold."""
    return next((row for row in table if row.kind == TASK and search(table, options, row, blocking(row, options), row.deadline) > row.deadline),
                None)


def late_task_scaled(table, options, factor, switches_too):
    """The same with every cost, critical section and server access times `factor`; switches as well if switches_too."""
    grown = [replace(row, cost=math.ceil(row.cost * factor), blocking=math.ceil(row.blocking * factor)) for row in table]
    return late_task(grown, replace(options, access=math.ceil(options.access * factor),
                                    switches=math.ceil(options.switches * factor) if switches_too else options.switches))


def growth(table, options, switches_too):
    """(factor, name): all deadlines hold up to the factor, and not at 1.000001 times it; then the task of that name is late. 0: not even
    with costs near 0."""
    holds, breaks = 0.0, GROWTH_STEP
    while late_task_scaled(table, options, breaks, switches_too) is None:
        holds, breaks = breaks, 2 * breaks
    while holds > 0.0 and breaks - holds > 0.5 * GROWTH_STEP * holds:
        middle = 0.5 * (holds + breaks)
        if late_task_scaled(table, options, middle, switches_too) is None:
            holds = middle
        else:
            breaks = middle
    return holds, late_task_scaled(table, options, breaks, switches_too).name
