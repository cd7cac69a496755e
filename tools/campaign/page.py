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
    first, *others = [f"| {' | '.join(cells)} |\n" for cells in (head, *lines)]
    return "".join([first, f"|{'---|' * len(head)}\n", *others])


def nominal(row):
    return [mean(row, name) for name in ("rise_time_s", "overshoot_mm", "hover_rms_mm", "thrust_std_n",
                                         "terrain_rms_mm", "recovery_s", "undershoot_mm")]


NOMINAL = ["law", "rise s", "overshoot mm", "hover RMS mm", "activity N", "terrain RMS mm", "recovery s",
           "undershoot mm"]


def untrimmed(row):
    return [median(row, "hover_rms_mm"), median(row, "terrain_rms_mm"),
            str(row["failures"]), table.number(row["highest_mm"])]


UNTRIMMED = ["law", "hover RMS mm", "terrain RMS mm", "failures", "highest mm"]
DISTURBING = ("glitches", "vibration", "outages", "blind")
OTHERS = ["law", "glitches mm", "vibration mm", "outages: largest error mm", "blind: touch m/s", "climb rate mm", "recovery s",
          "climb rate, drawn mm", "failures"]


def others(of_set):
    """Disturbed flights, and the same course where the throttle commands a climb rate."""
    return [mean(of_set["glitches"], "hover_rms_mm"), mean(of_set["vibration"], "hover_rms_mm"),
            median(of_set["outages"], "max_error_mm"), median(of_set["blind"], "touch_speed_mps"),
            mean(of_set["climb"], "hover_rms_mm"), mean(of_set["climb"], "recovery_s"),
            median(of_set["climb-drawn"], "hover_rms_mm"),
            str(sum(of_set[name]["failures"] for name in (*DISTURBING, "climb-drawn")))]


def demanded(found):
    """What does not reach its aim; the command prints all demands."""
    below = [one.cells() for one in found if one.word != "aim"]
    return (f"Of {len(found)} demands (`tools/campaign/verdict.py`; the command prints them) {len(found) - len(below)} reach "
            "their aim" + (", these do not:\n\n" + markdown(verdict.HEAD, below) if below else ".\n"))


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
        "Hover RMS of the disturbed nominal vehicle, and where the throttle commands a climb rate ("
        f"{', '.join(f'{name} {plan.SETS[name].runs}' for name in (*DISTURBING, 'climb', 'climb-drawn'))} flights per law):\n",
        markdown(OTHERS, [[law, *others(sets)] for law, sets in of_law.items()]),
        demanded(verdict.verdicts(rows)),
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
