"""Laboratory 8: priority inversion, played on paper; and how often a gate can delay a task. `tools/rta` has the firmware's own table."""
import csv
from pathlib import Path

from criterion import Criterion, Refused, all_or_nothing, shared

TABLE = Path(__file__).resolve().parents[2] / "tools/rta/plomada.csv"
TITLE = "priority inversion"
NAMES = ("high", "middle", "low")
GATES = ("imu", "altitude", "laser", "status", "reference", "parameters")
CASES = 12
# Which server each task of the firmware reads or writes, the most important first: tests/course/ compares it with the sources.
FIRMWARE = {"TaskIMU": ["imu"], "TaskReceiveLaser": ["imu", "altitude"], "TaskControl": ["imu", "altitude", "reference", "parameters", "status"],
            "TaskSendLaser": ["laser"], "TaskSendComm": ["laser", "status"],
            "TaskReceiveComm": ["imu", "laser", "reference", "parameters", "status"]}


def play(jobs, inherits):
    """{name: when it ends}, millisecond by millisecond. A job is (name, release, before, held, after), the most important first; held is
    the time with the one gate."""
    done, ends, holder = {job[0]: 0 for job in jobs}, {}, None
    for now in range(1000):
        able = [job for job in jobs if job[1] <= now and job[0] not in ends]
        if not able:
            if len(ends) == len(jobs):
                return ends
            continue
        wants = [job for job in able if job[3] and job[2] <= done[job[0]] < job[2] + job[3] and holder not in (None, job[0])]
        free = [job for job in able if job not in wants]
        runs = free[0]
        if inherits and wants and jobs.index(wants[0]) < jobs.index(runs):
            runs = next(job for job in able if job[0] == holder)
        name, _, before, held, after = runs
        if held and done[name] == before:
            holder = name
        done[name] += 1
        if name == holder and done[name] == before + held:
            holder = None
        if done[name] == before + held + after:
            ends[name] = now + 1
    raise ValueError("a job that never ends")


def drawn_jobs(draw):
    low = ("low", 0, draw.whole(1, 3), draw.whole(4, 7), draw.whole(1, 4))
    high_at = low[2] + draw.whole(1, 2)
    high = ("high", high_at, draw.whole(1, 2), draw.whole(1, 3), draw.whole(1, 2))
    return [high, ("middle", high_at + high[2] + draw.whole(0, 1), draw.whole(6, 12), 0, 0), low]


def bound(tasks, at):
    """Each lower task once, each gate once: the smaller of the two numbers."""
    above = {gate for gates in tasks[:at + 1] for gate in gates}
    lower = [set(gates) & above for gates in tasks[at + 1:]]
    return min(sum(bool(gates) for gates in lower), len(set().union(*lower)))


def numbers(draw):
    jobs = drawn_jobs(draw)
    cases = [([[gate for gate in GATES if draw.whole(0, 2) == 0] for _ in range(draw.whole(2, 6))]) for _ in range(CASES)]
    told = ["Three tasks share one gate. Times in ms; a task that is released runs at once when nobody more important wants to."]
    for name, release, before, held, after in jobs:
        way = f"{before} ms, then {held} ms with the gate, then {after} ms" if held else f"{before} ms without the gate"
        told.append(f"  {name}: released at {release}; needs {way}")
    return {"without": play(jobs, False), "with": play(jobs, True), "cases": cases}, told


def ends(name, which):
    def check(answer, drawn):
        given = answer.value(f"{which}_inheritance_ms")
        said = given.get(name) if isinstance(given, dict) else None
        if said is None:
            return 0, "not filled in"
        good = said == drawn[which][name]
        return all_or_nothing(1, good, f"{said!r} ms is " + ("right" if good else "wrong"))
    return check


def drawn_cases(answer, drawn):
    asked = [(tasks, at) for tasks in drawn["cases"] for at in range(len(tasks))]
    given = answer.calls("blockings", [[tasks, at] for tasks, at in asked])
    if len(set(map(repr, given))) == 1:
        raise Refused(f"always {given[0]!r}")
    wanted = [bound(tasks, at) for tasks, at in asked]
    good = sum(one == other for one, other in zip(given, wanted))
    wrong = next((f"; {tasks[at]} above {tasks[at + 1:]}: {one!r}, not {other}" for (tasks, at), one, other in zip(asked, given, wanted) if one != other), "")
    return shared(3, good, len(wanted), f"{good} of {len(wanted)}{wrong}"[:150])


def firmware(answer, drawn):
    """As the product's own table says, which its tests compare with its sources."""
    with open(TABLE, encoding="ascii") as file:
        rows = {row["name"]: int(row["blockings"]) for row in csv.DictReader(file) if row["kind"] == "task"}
    given = answer.calls("blockings", [[list(FIRMWARE.values()), at] for at in range(len(FIRMWARE))])
    good = sum(one == rows[name] for one, name in zip(given, FIRMWARE))
    wrong = next((f"; {name} {one!r}, not {rows[name]}" for one, name in zip(given, FIRMWARE) if one != rows[name]), "")
    return all_or_nothing(2, good == len(FIRMWARE), f"{good} of {len(FIRMWARE)} as tools/rta{wrong}")


PLAY = "Draw a line for each task, a square for each millisecond. Ask in each square: who is able to run, and who is the most important of them?"
CRITERIA = (
    Criterion(1, "without inheritance high ends", ends("high", "without"), PLAY),
    Criterion(1, "without inheritance middle ends", ends("middle", "without"), PLAY),
    Criterion(1, "with inheritance high ends", ends("high", "with"), "While high waits for the gate, low runs as if it were high."),
    Criterion(1, "with inheritance middle ends", ends("middle", "with"), "When low gives the gate back, it is low again."),
    Criterion(1, "with inheritance low ends", ends("low", "with"), PLAY),
    Criterion(3, "blockings() of drawn tasks", drawn_cases, "Which gates does the task use, or a more important one? Which lower tasks use those?"),
    Criterion(2, "blockings() of the firmware", firmware, "The least important task has nobody below it. A gate that only lower tasks use delays nobody above."),
)
