"""Laboratory 7: response times. `tools/rta` is the reference, without context switches."""
import sys
from pathlib import Path

from criterion import Criterion, Refused, all_or_nothing, shared

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools/rta"))
import analysis  # noqa: E402

TITLE = "response times"
US = 1000                   # a millisecond
PS_PER_US = 10 ** 6
BY_HAND = ("A", "B", "C")
FIVE = ("red", "blue", "green", "white", "black")
CASES = 8


def task(name, cost_us, period_us, deadline_us, blocking_us=0):
    return {"name": name, "cost_us": cost_us, "period_us": period_us, "deadline_us": deadline_us, "blocking_us": blocking_us}


def rta(tasks):
    """{name: response in us, None: late}, of tasks in the order of their priorities."""
    table = [analysis.Row(one["name"], analysis.TASK, len(tasks) - at, *(one[of] * PS_PER_US for of in ("period_us", "deadline_us", "cost_us", "blocking_us")),
                          blockings=1 if one["blocking_us"] else 0) for at, one in enumerate(tasks)]
    responses = {row.name: (analysis.response(table, analysis.Options(), row), row.deadline) for row in table}
    return {name: response // PS_PER_US if response <= deadline else None for name, (response, deadline) in responses.items()}


def holds(tasks):
    """The same by the formula, to draw tasks with: all deadlines hold in this order."""
    for at, one in enumerate(tasks):
        response, before = one["cost_us"], 0
        while response != before and response <= one["deadline_us"]:
            before = response
            response = one["cost_us"] + sum(-(-before // other["period_us"]) * other["cost_us"] for other in tasks[:at])
        if response > one["deadline_us"]:
            return False
    return True


def drawn_task(draw, name, blocked):
    period = draw.whole(10, 60) * US
    return task(name, draw.whole(8, 40) * US // 10, period, period - draw.whole(0, 4) * US, draw.whole(1, 9) * US // 10 if blocked else 0)


def drawn_three(draw):
    """Three periods that interfere more than once."""
    while True:
        a, b, c = draw.whole(4, 6), draw.whole(9, 13), draw.whole(24, 30)
        three = [task("A", draw.whole(1, 2) * US, a * US, a * US), task("B", draw.whole(2, 3) * US, b * US, b * US),
                 task("C", draw.whole(3, 5) * US, c * US, c * US)]
        if holds(three):
            return three


def drawn_five(draw):
    """Five tasks whose deadlines hold in the order of the deadlines, not in that of the periods."""
    while True:
        periods = draw.order([10, 16, 25, 40, 60])
        five = [task(name, draw.whole(2, 6) * US, period * US, max(6, period - draw.whole(0, 45)) * US) for name, period in zip(FIVE, periods)]
        if holds(sorted(five, key=lambda one: one["deadline_us"])) and not holds(sorted(five, key=lambda one: one["period_us"])):
            return five


def numbers(draw):
    three, five = drawn_three(draw), drawn_five(draw)
    drawn = {"three": three, "five": five}
    for kind, blocked in (("plain", False), ("blocked", True)):
        drawn[kind] = [[drawn_task(draw, f"t{at}", blocked) for at in range(draw.whole(2, 6))] for _ in range(CASES)]
    drawn["late"] = [[task(f"t{at}", draw.whole(30, 60) * US // 10, draw.whole(9, 12) * US, 9 * US) for at in range(5)] for _ in range(CASES // 2)]
    told = ["Part 1. The most important first; the deadline is the period:"]
    told += [f"  {one['name']}: cost {one['cost_us'] // US} ms, period {one['period_us'] // US} ms" for one in three]
    told += ["Part 3. In no order:"]
    told += [f"  {one['name']}: cost {one['cost_us'] // US} ms, period {one['period_us'] // US} ms, deadline {one['deadline_us'] // US} ms" for one in five]
    return drawn, told


def by_hand(name):
    def check(answer, drawn):
        given = answer.value("by_hand_ms")
        said = given.get(name) if isinstance(given, dict) else None
        if said is None:
            return 0, "not filled in"
        good = said * US == rta(drawn["three"])[name] if isinstance(said, (int, float)) else False
        return all_or_nothing(1, good, f"{said!r} ms is " + ("right" if good else "wrong"))
    return check


def load(answer, drawn):
    said = answer.value("load_percent")
    if not isinstance(said, (int, float)):
        return 0, "not filled in"
    # In hundredths of a percent, in whole numbers.
    exact = sum(one["cost_us"] * 10000 // one["period_us"] for one in drawn["three"])
    return all_or_nothing(1, abs(said * 100 - exact) <= 100, f"{said!r} % is " + ("right" if abs(said * 100 - exact) <= 100 else "wrong"))


def responses(points, kind):
    def check(answer, drawn):
        asked = [(table[at], table[:at]) for table in drawn[kind] for at in range(len(table))]
        given = answer.calls("response_us", [[one, higher] for one, higher in asked])
        if kind == "late" and all(one is None for one in given):
            raise Refused("never a number")
        wanted = [right for table in drawn[kind] for right in rta(table).values()]
        good = sum(one == other for one, other in zip(given, wanted))
        wrong = next((f"; a cost of {one['cost_us']} us below {len(higher)} tasks: {said!r}, not {right!r}"
                      for (one, higher), said, right in zip(asked, given, wanted) if said != right), "")
        return shared(points, good, len(wanted), f"{good} of {len(wanted)} as tools/rta{wrong}")
    return check


def ordered(answer, drawn):
    given = answer.value("order")
    if not isinstance(given, list) or sorted(map(str, given)) != sorted(FIVE):
        return 0, "not the five names, each once"
    found = rta([next(one for one in drawn["five"] if one["name"] == name) for name in given])
    late = [name for name, response in found.items() if response is None]
    return all_or_nothing(2, not late, f"late: {', '.join(late)}" if late else "all deadlines hold")


CRITERIA = (
    *(Criterion(1, f"the response time of {name} by hand", by_hand(name), hint) for name, hint in (
        ("A", "Nobody is more important: it needs its own cost."),
        ("B", "Its cost, and each job of A that is released before it ends."),
        ("C", "Begin with the sum of all costs. Count the releases of A and B until then; the sum grows; repeat until it does not."))),
    Criterion(1, "the load by hand", load, "Each task takes cost divided by period. Add them."),
    Criterion(2, "response_us() without blocking", responses(2, "plain"), "A release at the very instant of the end no longer disturbs: round up, do not add 1."),
    Criterion(1, "response_us() with a blocking", responses(1, "blocked"), "A lower task may hold a gate: its blocking counts once, like the own cost."),
    Criterion(1, "response_us() of tasks that are late", responses(1, "late"), "Stop when the response passes the deadline: above a load of 1 the sum never rests."),
    Criterion(2, "the order", ordered, "The shortest period is not always the most urgent. Look at the deadlines."),
)
