"""What a flight has done to its vehicle, and how often that happens: rates with bounds, by kind of condition and law."""
import difflib
import math
import re
import shlex
import sys
from dataclasses import dataclass
from pathlib import Path

import faults
import plan
import table

PAGE = Path(__file__).resolve().parents[2] / "docs/reliability.md"
BLOCK = r"(?<=<!-- {}: by make campaign -->\n).*?(?=<!-- end -->)"
CONFIDENCE_Z = 1.959963985      # 95 %, both sides
HIGH_MM, TOUCH_MPS, DECEIVED_S = 1200.0, 1.2, 2.0


def rose(figures):
    return figures["highest_mm"] is not None and figures["highest_mm"] > HIGH_MM


def struck(figures):
    return figures["touch_speed_mps"] is not None and figures["touch_speed_mps"] > TOUCH_MPS


def cut(figures):
    return figures["off_aloft"] > 0


def stayed(figures):
    return figures["started"] and (figures["down_s"] is None or figures["down_s"] > faults.DOWN_WITHIN_S)


def deceived(figures):
    return figures["deceived_s"] > DECEIVED_S


def halted(figures):
    return figures["halted"]


# Title of the column, what it means, and when a flight is one.
HARMS = {
    "flew up": (f"more than {HIGH_MM / 1000:g} m above the reference", rose),
    "struck": (f"touched the ground faster than {TOUCH_MPS:g} m/s", struck),
    "cut": ("motors off above 0.3 m though nothing ordered it", cut),
    "not down": (f"in the air {faults.DOWN_WITHIN_S} s after the landing command", stayed),
    "deceived": (f"a height wrong by 0.3 m for {DECEIVED_S:g} s without a flag", deceived),
    "halted": ("the firmware stopped", halted),
}
PHYSICAL = [name for name in HARMS if name != "deceived"]


def harms(figures):
    return [name for name, (_, found) in HARMS.items() if found(figures)]


def harmed(figures):
    """Something happened to the vehicle; to be deceived is not yet that."""
    return any(HARMS[name][1](figures) for name in PHYSICAL)


def wilson(count, flights):
    """Bounds of the rate, 95 % (Wilson 1927)."""
    if flights == 0:
        return 0.0, 1.0
    z2, share = CONFIDENCE_Z**2, count / flights
    middle = (share + z2 / (2 * flights)) / (1 + z2 / flights)
    half = CONFIDENCE_Z / (1 + z2 / flights) * math.sqrt(share * (1 - share) / flights + z2 / (4 * flights**2))
    return max(0.0, middle - half), min(1.0, middle + half)


def percent(share):
    return f"{100 * share:.2g}" if share < 0.0995 else f"{100 * share:.0f}"


def rate(count, flights):
    """'1.3 [0.6-2.8]', in percent."""
    if flights == 0:
        return "-"
    low, high = wilson(count, flights)
    low = 0.0 if count == 0 else low
    return f"{percent(count / flights)} [{percent(low)}-{percent(high)}]"


@dataclass(frozen=True)
class Flight:
    law: str
    number: int
    kinds: tuple
    words: tuple
    figures: dict

    def command(self, program="build/plomada"):
        return shlex.join([program, "fly", *self.words])


def worst(flights, name):
    return max((f.figures[name] for f in flights if f.figures[name] is not None), default=math.nan)


BY_LAW = ["law", "flights", "harmed %", *(f"{name} %" for name in HARMS), "highest m", "hardest m/s"]


def by_law(flown):
    laws = list(dict.fromkeys(flight.law for flight in flown))
    for law in [*laws, "all"]:
        of_law = [flight for flight in flown if law in ("all", flight.law)]
        yield [law, str(len(of_law)), rate(sum(harmed(f.figures) for f in of_law), len(of_law)),
               *(rate(sum(found(f.figures) for f in of_law), len(of_law)) for _, found in HARMS.values()),
               table.number(worst(of_law, "highest_mm") / 1000), table.number(worst(of_law, "touch_speed_mps"))]


def groups(flown):
    """(title, flights): nothing wrong, each kind alone, then how many at once, then by airframe."""
    yield "nothing", [f for f in flown if not f.kinds]
    for kind in faults.KINDS:
        yield kind, [f for f in flown if f.kinds == (kind,)]
    for count, word in ((2, "two kinds"), (3, "three kinds")):
        yield word, [f for f in flown if len(f.kinds) == count]
    for airframe in (0, 1):
        yield f"airframe {airframe}", [f for f in flown if f"plant.airframe={airframe}" in f.words]


def by_kind(flown):
    """Head and lines: harmed flights of each law and of all, deceived ones of all."""
    laws = list(dict.fromkeys(flight.law for flight in flown))
    lines = []
    for title, of_kind in groups(flown):
        by = {law: [f for f in of_kind if f.law == law] for law in laws}
        lines.append([title, *(rate(sum(harmed(f.figures) for f in by[law]), len(by[law])) for law in laws),
                      rate(sum(harmed(f.figures) for f in of_kind), len(of_kind)),
                      rate(sum(deceived(f.figures) for f in of_kind), len(of_kind))])
    return ["alone", *laws, "all", "deceived"], lines


def failing(flown, program="build/plomada"):
    """A line on each flight that did harm or was deceived, and the command that repeats it."""
    for flight in flown:
        found = harms(flight.figures)
        if found:
            f = flight.figures
            yield (f"{flight.law} {flight.number}: {', '.join(found)} ({' + '.join(flight.kinds) or 'nothing wrong'}; highest "
                   f"{table.number((f['highest_mm'] or math.nan) / 1000)} m, touch "
                   f"{table.number(f['touch_speed_mps'] if f['touch_speed_mps'] is not None else math.nan)} m/s)\n"
                   f"  {flight.command(program)}")


def text(flown):
    head, lines = by_kind(flown)
    meanings = "\n".join(f"{name}: {meaning}" for name, (meaning, _) in HARMS.items())
    return f"{meanings}\n\n{table.columns([BY_LAW, *by_law(flown)], left=1)}\n\n{table.columns([head, *lines], left=1)}"


def markdown(head, lines):
    first, *others = [f"| {' | '.join(cells)} |\n" for cells in (head, *lines)]
    return "".join([first, f"|{'---|' * len(head)}\n", *others])


def plain(cell):
    """A rate without its bounds."""
    return cell.partition(" [")[0]


def page_by_law(flown, laws):
    """Fewer columns than the command prints: no count, no halts, and bounds only of harmed and of all laws together."""
    halted_at = BY_LAW.index("halted %")
    for cells in by_law(flown):
        if cells[0] not in laws:
            continue
        others = [cell if cells[0] == "all" else plain(cell) for cell in cells[3:halted_at]]
        yield [cells[0], cells[2], *others, *cells[halted_at + 1:]]


def page_by_kind(flown):
    """The rows with a harmed flight, for EST and all laws; and the names of the other rows."""
    head, lines = by_kind(flown)
    columns = [0, head.index("EST"), head.index("all")]
    found = [line for line in lines if plain(line[columns[2]]) not in ("0", "-")]
    harmless = [line[0] for line in lines if line not in found and line[columns[2]] != "-"]
    return [[line[k] for k in columns] for line in found], harmless


def kinds_of_page(flown):
    lines, harmless = page_by_kind(flown)
    return (f"Harmed flights by what was wrong. No flight was harmed with: {', '.join(harmless) or '-'}.\n\n"
            f"{markdown(['alone', 'EST %', 'all laws %'], lines)}\n")


def render(flown, count, with_kinds):
    """The text between the page's marks; each law and each kind where there are flights enough for their rates."""
    laws = [*plan.LAWS, "all"] if with_kinds else ["EST", "all"]
    halts = rate(sum(halted(flight.figures) for flight in flown), len(flown))
    titles = [f"{name} %" for name in HARMS if name != "halted"]
    return (f"\n`make campaign ARGS=\"--faults {count} --page\"`, {count // len(plan.LAWS)} flights per law; firmware halted: "
            f"{halts} %.\n\n"
            f"{markdown(['law', 'harmed %', *titles, 'highest m', 'hardest m/s'], page_by_law(flown, laws))}\n"
            + (kinds_of_page(flown) if with_kinds else ""))


def compare(block, rendered):
    """What the page has otherwise between the marks of that block, as lines of a diff."""
    shown = re.search(BLOCK.format(block), PAGE.read_text(encoding="utf-8"), re.DOTALL).group()
    return list(difflib.unified_diff(shown.splitlines(), rendered.splitlines(), "docs/reliability.md", "this campaign",
                                     n=0, lineterm=""))


def write(block, rendered):
    page_text = PAGE.read_text(encoding="utf-8")
    PAGE.write_text(re.sub(BLOCK.format(block), lambda _: rendered, page_text, count=1, flags=re.DOTALL),
                    encoding="utf-8")
    print(PAGE, file=sys.stderr)
