"""The tables of docs/control.md: what a default campaign found, between two marks."""
import difflib
import re
import sys
from pathlib import Path

import plan
import table
import verdict

PAGE = Path(__file__).resolve().parents[2] / "docs/control.md"
PICTURE = PAGE.parent / "images/campaign.png"
PICTURED = ("nominal", "untrimmed")
BLOCK = re.compile(r"(?<=<!-- by make campaign ARGS=--page -->\n).*?(?=<!-- end -->)", re.DOTALL)


def median(row, name):
    return f"{table.number(row[name + '_median'])} [{table.number(row[name + '_p95'])}]"


def mean(row, name):
    return table.number(row[name + "_mean"])


def markdown(head, lines):
    return "".join(f"| {' | '.join(cells)} |\n" for cells in (head, ["---"] * len(head), *lines))


def nominal(row):
    return [mean(row, name) for name in ("rise_time_s", "overshoot_mm", "hover_rms_mm", "thrust_std_n",
                                         "terrain_rms_mm", "recovery_s", "undershoot_mm")]


NOMINAL = ["law", "rise s", "overshoot mm", "hover RMS mm", "activity N", "terrain RMS mm", "recovery s",
           "undershoot mm"]


def untrimmed(row):
    return [median(row, "hover_rms_mm"), median(row, "terrain_rms_mm"), table.number(row["thrust_std_n_median"]),
            *(str(row[name]) for name in ("failures", "takeovers", "contacts")), table.number(row["highest_mm"])]


UNTRIMMED = ["law", "hover RMS mm", "terrain RMS mm", "activity N", "failures", "take-overs", "contacts", "highest mm"]
DISTURBED = ["law", "glitches: hover RMS mm", "failures", "vibration: hover RMS mm", "outages: largest error mm",
             "failures", "blind: not landed", "touch m/s"]


DISTURBING = ("glitches", "vibration", "outages", "blind")


def disturbed(of_set):
    return [mean(of_set["glitches"], "hover_rms_mm"), str(of_set["glitches"]["failures"]),
            mean(of_set["vibration"], "hover_rms_mm"), median(of_set["outages"], "max_error_mm"),
            str(of_set["outages"]["failures"]), str(of_set["blind"]["failures"]),
            median(of_set["blind"], "touch_speed_mps")]


BOTH = ["law", "thrust: hover RMS mm", "terrain RMS mm", "recovery s", "climb rate: hover RMS mm", "terrain RMS mm",
        "recovery s", "drawn climb rates: hover RMS mm", "failures"]


def both(of_set):
    """The same course on either kind of autopilot."""
    shown = ("hover_rms_mm", "terrain_rms_mm", "recovery_s")
    return [*(mean(of_set["nominal"], name) for name in shown), *(mean(of_set["climb"], name) for name in shown),
            median(of_set["climb-drawn"], "hover_rms_mm"), str(of_set["climb-drawn"]["failures"])]


def complete(rows, seed):
    """Whether these rows are those of the default campaign."""
    flown = {(row["set"], row["law"]): row["flights"] for row in rows}
    return seed == 1 and all(flown.get((name, law)) == plan.SETS[name].runs
                             for name in plan.DEFAULT_SETS for law in plan.LAWS)


def flights_of(name):
    return f"{plan.SETS[name].runs} flights per law"


def render(rows, bounds):
    """The text between the marks. bounds: [(activity in N, hover RMS in mm)]."""
    rows = [row for row in rows if row["set"] in plan.DEFAULT_SETS]
    cell = {(row["set"], row["law"]): row for row in rows}
    of_law = {law: {name: cell[name, law] for name in plan.DEFAULT_SETS} for law in plan.LAWS}
    limits = [[f"{activity:.2f} N" for activity, _ in bounds], [f"{bound:.1f} mm" for _, bound in bounds]]
    parts = [
        f"Nominal vehicle, means of {flights_of('nominal')}:\n",
        markdown(NOMINAL, [[law, *nominal(sets["nominal"])] for law, sets in of_law.items()]),
        "The least hover RMS that any law can have, by its thrust activity:\n",
        markdown(["activity", *limits[0]], [["bound", *limits[1]]]),
        f"Drawn vehicles, mass ± 20 % and not trimmed, {flights_of('untrimmed')}:\n",
        markdown(UNTRIMMED, [[law, *untrimmed(sets["untrimmed"])] for law, sets in of_law.items()]),
        f"Disturbed nominal vehicle ({', '.join(f'{name} {plan.SETS[name].runs}' for name in DISTURBING)} "
        "flights per law):\n",
        markdown(DISTURBED, [[law, *disturbed(sets)] for law, sets in of_law.items()]),
        f"Both kinds of autopilot: the throttle commands thrust, or a climb rate ({flights_of('climb')}; drawn "
        f"{plan.SETS['climb-drawn'].runs}):\n",
        markdown(BOTH, [[law, *both(sets)] for law, sets in of_law.items()]),
        "What was demanded:\n",
        markdown(verdict.HEAD, [found.cells() for found in verdict.verdicts(rows)]),
    ]
    return "\n" + "\n".join(parts)


def compare(rendered, text):
    """What the page has otherwise, as lines of a diff."""
    shown = BLOCK.search(text).group()
    return list(difflib.unified_diff(shown.splitlines(), rendered.splitlines(), "docs/control.md", "this campaign",
                                     n=0, lineterm=""))


def write(rendered):
    text = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(BLOCK.sub(lambda _: rendered, text), encoding="utf-8")
    print(f"{PAGE}\n{PICTURE}", file=sys.stderr)
