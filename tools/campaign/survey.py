"""Surveys: every law in every situation of a table, healthy.toml, lies.toml or battery.toml; and what is said of them."""
import contextlib
import difflib
import hashlib
import math
import re
import resource
import sys
from dataclasses import dataclass
from pathlib import Path

import fleet
import harm
import plan
import rate
import situations
import table
from scipy import stats

PAGE = Path(__file__).resolve().parents[2] / "docs/reliability.md"
FIRST = "EST"               # flies every number of a situation, the other laws one in OTHERS
OTHERS = 4
RUNS = {situations.HEALTHY: 20, situations.LIES: 40, situations.BATTERY: 40}
ERROR = rate.ERROR / 2      # on each side: bounds of 95 % confidence
HELD_OUT = "held-out"


@dataclass(frozen=True)
class Planned:
    """A flight, before and after it was flown."""
    table: str
    situation: situations.Situation
    law: str
    number: int
    seed: int
    held_out: bool
    flight: situations.Flight

    @property
    def name(self):
        return "/".join([self.situation.slug, str(self.number), self.law, *[HELD_OUT] * self.held_out])

    @property
    def label(self):
        """What names it among the flights that are kept."""
        return {"flight": self.name, "seed": self.seed}

    @property
    def command(self):
        """What flies it again, and says what it did."""
        seed = f"--seed {self.seed} " if self.seed != 1 else ""
        return f'make campaign ARGS="{seed}--fly {self.name}"'

    def key(self, digest):
        text = hashlib.sha256(self.flight.text.encode()).hexdigest()
        return fleet.key(digest, [text, *self.flight.words])

    def verdicts(self, figures):
        judge = harm.lied_to if self.table == situations.LIES else harm.wrong
        found = judge(figures, self.flight.sources)
        return [title for title in found if title not in self.situation.may]


def one(of_table, situation, law, number, seed=1, held_out=False):
    """Planned; law: its name."""
    flight = situations.flight(of_table, situation, plan.LAWS[law], seed, number, held_out)
    return Planned(of_table.name, situation, law, number, seed, held_out, flight)


def chosen(of_table, only):
    """Situations by the names of some, or of their rows. Raises situations.Wrong."""
    wanted = {re.sub(r"\W+", "-", name) for name in only}
    slugs = {situation.slug: situation for situation in of_table.situations.values()}
    rows = {re.sub(r"\W+", "-", row): of_row for row, of_row in of_table.rows().items()}
    unknown = wanted - set(slugs) - set(rows)
    if unknown:
        raise situations.Wrong(f"{', '.join(sorted(unknown))}: none of {', '.join([*rows, *slugs])}")
    return [situation for situation in of_table.situations.values()
            if not only or situation.slug in wanted or re.sub(r"\W+", "-", situation.row) in wanted]


def planned(of_table, laws, seed, runs, held_out, only=()):
    """All flights of a survey. A situation's flights take turns with the others', so that one that is cut off has some of each."""
    found = []
    for situation in chosen(of_table, only):
        count = max(1, round(runs * situation.runs))
        for law in laws:
            of_law = count if law == FIRST or FIRST not in laws else math.ceil(count / OTHERS)
            found += [one(of_table, situation, law, number, seed, held_out) for number in range(1, of_law + 1)]
    return sorted(found, key=lambda flight: flight.number)


def find(name, seed=1):
    """Planned, by its name. Raises situations.Wrong."""
    slug, number, law, rest = parts_of(name, (HELD_OUT,))
    if law not in plan.LAWS:
        raise situations.Wrong(f"{name}: no law {law}: one of {', '.join(plan.LAWS)}")
    tables = [situations.load(of) for of in situations.TABLES]
    for of_table in tables:
        for situation in of_table.situations.values():
            if situation.slug == slug:
                return one(of_table, situation, law, number, seed, bool(rest))
    raise situations.Wrong(f"{name}: no situation {slug}: one of {', '.join(one.slug for of in tables for one in of.situations.values())}")


def parts_of(name, ends=()):
    """(Situation, number, law, end or "") of SITUATION/NUMBER/LAW; one of `ends` may follow. Raises situations.Wrong."""
    form = "SITUATION/NUMBER/LAW"
    found = re.fullmatch(r"([^/]+)/([0-9]+)/([^/]+)(?:/([^/]+))?", name)
    if not found or int(found[2]) < 1 or (found[4] or "") not in ("", *ends):
        raise situations.Wrong(f"{name}: not of the form {' or '.join([form, *(f'{form}/{end}' for end in ends)])}")
    return found[1], int(found[2]), found[3], found[4] or ""


# Flying

def of_children_s():
    """Processor time of the flights that have ended on this machine."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def fly_missing(program, flights, store, scheduler=None):
    """{name: figures}, and how many had to be flown."""
    digest = fleet.digest(program)
    keys = {flight.key(digest): flight for flight in flights}
    missing = [(key, flight.flight.words, flight.flight.text) for key, flight in keys.items() if key not in store.known]
    if missing:
        progress, provenance = fleet.Progress(len(missing)), fleet.provenance(program)
        with fleet.fleet(scheduler) as client:
            for key, figures in fleet.fly_all(client, program, missing):
                flight = keys[key]
                store.add(key, flight.label | provenance | {"command": flight.command}, figures)
                progress.step()
    return {flight.name: store.known[key] for key, flight in keys.items()}, len(missing)


def fly_one(flight, program, out):
    """Flies one again, with all its files to look at; prints what it did. The command of its own is for a CSV, a trace, a debugger."""
    out.mkdir(parents=True, exist_ok=True)
    path = out / f"{flight.name.replace('/', '-')}.scenario"
    fleet.write_whole(path, flight.flight.text)
    figures = fleet.fly(program, [str(path), *flight.flight.words])
    print(f"{flight.name}: {flight.situation.says}\n")
    print(*(f"  {name:20} {'-' if value is None else value}" for name, value in figures.items()), sep="\n")
    print(f"\n{', '.join(flight.verdicts(figures)) or 'nothing wrong'}\n{fleet.command(program, [str(path), *flight.flight.words])}")


# Saying

def percent(share):
    return f"{100 * share:.2g}" if share < 0.0995 else f"{100 * share:.0f}"


def share(flown, is_so):
    """'1.3 [0.6-2.8]', in percent, with bounds of 95 % confidence (Clopper and Pearson 1934)."""
    if not flown:
        return "-"
    count = sum(bool(is_so(*one)) for one in flown)
    low, high = rate.bounds(count, len(flown), ERROR)
    return f"{percent(count / len(flown))} [{percent(low)}-{percent(high)}]"


def hours(flown):
    return sum(figures["aloft_s"] for _, figures in flown) / 3600


def hourly(flown, count):
    """Times an hour of flight, with the bounds of a Poisson count (Garwood 1936)."""
    of = hours(flown)
    if of <= 0.0:
        return "-"
    low = stats.chi2.ppf(ERROR, 2 * count) / 2 if count else 0.0
    high = stats.chi2.ppf(1 - ERROR, 2 * count + 2) / 2
    return f"{table.number(count / of)} [{table.number(low / of)}-{table.number(high / of)}]"


def doubts_of(flown, source):
    return sum(harm.doubts(figures, flight.flight.sources)[source] for flight, figures in flown)


def worst(flown, name):
    return max((figures[name] for _, figures in flown if figures[name] is not None), default=math.nan)


def worst_flight(flown):
    """Its name, or '-' when none did anything wrong."""
    def badness(one):
        flight, figures = one
        return len(flight.verdicts(figures)), figures["highest_mm"] or 0.0, figures["touch_speed_mps"] or 0.0

    flight, figures = max(flown, key=badness)
    return f"`{flight.name}`" if flight.verdicts(figures) else "-"


def is_one(found):
    return lambda _, figures: found(figures)


def healthy_cells(first, others):
    """Of the first law, but for the last."""
    return [str(len(first)), f"{hours(first):.1f}",
            share(first, lambda flight, figures: flight.verdicts(figures)),
            *(share(first, is_one(found)) for found in harm.UNASKED.values()),
            share(first, is_one(harm.mishandled)), share(first, is_one(harm.harmed)),
            *(hourly(first, doubts_of(first, source)) for source in situations.SOURCES),
            share(others, lambda flight, figures: flight.verdicts(figures))]


HEALTHY_HEAD = ["flights", "hours", "wrong %", *(f"{title} %" for title in harm.UNASKED), "mishandled %", "harmed %",
                *(f"{source} doubted, an hour" for source in situations.SOURCES), "other laws wrong %"]


def lies_cells(first, others):
    return [str(len(first)), share(first, is_one(harm.harmed)), share(first, is_one(harm.mishandled)),
            *(share(first, is_one(harm.HARMS[name])) for name in ("flew up", "struck")),
            share(first, is_one(harm.deceived)),
            share(first, lambda flight, figures: harm.doubted(figures, flight.flight.sources)),
            table.number(worst(first, "highest_mm") / 1000), table.number(worst(first, "touch_speed_mps")),
            share(others, is_one(harm.harmed)), share(others, is_one(harm.mishandled))]


LIES_HEAD = ["flights", "harmed %", "mishandled %", "flew up %", "struck %", "deceived %", "doubted the truth %", "highest m",
             "hardest m/s", "other laws harmed %", "other laws mishandled %"]
CELLS = {situations.HEALTHY: (HEALTHY_HEAD, healthy_cells), situations.LIES: (LIES_HEAD, lies_cells),
         situations.BATTERY: (HEALTHY_HEAD, healthy_cells)}


def lines_of(name, flown, by):
    """Head and lines: a line for each group of by(situation), and one of all."""
    head, cells = CELLS[name]
    groups = {}
    for one_flown in flown:
        groups.setdefault(by(one_flown[0].situation), []).append(one_flown)
    laws = list(dict.fromkeys(flight.law for flight, _ in flown))
    leading = FIRST if FIRST in laws else laws[0]
    lines = []
    for title, of_group in [*groups.items(), ("all", flown)]:
        first = [one for one in of_group if one[0].law == leading]
        others = [one for one in of_group if one[0].law != leading]
        lines.append([title, *cells(first, others), worst_flight(first) if title != "all" else "-"])
    return [name, *head, "worst flight"], lines


def by_law(name, flown):
    head, cells = CELLS[name]
    laws = list(dict.fromkeys(flight.law for flight, _ in flown))
    others = sum(title.startswith("other laws") for title in head)
    return ["law", *head[:-others]], [[law, *cells([one for one in flown if one[0].law == law], [])[:-others]] for law in laws]


def failing(flown):
    for flight, figures in flown:
        found = flight.verdicts(figures)
        if found:
            yield f"{flight.name}: {', '.join(found)}\n  {flight.command}"


def text(name, flown):
    tables = [lines_of(name, flown, lambda situation: situation.name), lines_of(name, flown, lambda situation: situation.row),
              by_law(name, flown)]
    return "\n\n".join(table.columns([head, *lines], left=1) for head, lines in tables)


# The page

def markdown(head, lines):
    first, *others = [f"| {' | '.join(cells)} |\n" for cells in (head, *lines)]
    return "".join([first, f"|{'---|' * len(head)}\n", *others])


def block_of(name, held_out):
    return HELD_OUT if held_out else name


def render(name, flown, runs, held_out):
    """The text between the page's marks."""
    option = f"--{name} {runs}{' --held-out' * held_out}"
    rows, of_laws = lines_of(name, flown, lambda situation: situation.row), by_law(name, flown)
    return (f"\nBy version {fleet.version()}, `make campaign ARGS=\"{option} --page\"`; {len(flown)} flights.\n\n"
            f"{markdown(*rows)}\n" + ("" if held_out else f"Laws:\n\n{markdown(*of_laws)}\n"))


def pattern(block):
    return re.compile(rf"(?<=<!-- {block}: by make campaign -->\n).*?(?=<!-- end -->)", re.DOTALL)


def compare(block, rendered):
    """What the page has otherwise, as lines of a diff, when it is of the same version and as many flights."""
    shown = pattern(block).search(PAGE.read_text(encoding="utf-8")).group()
    if shown.split("\n\n")[0] != rendered.split("\n\n")[0]:
        return []
    return list(difflib.unified_diff(shown.splitlines(), rendered.splitlines(), "docs/reliability.md", "this campaign", n=0, lineterm=""))


def write(block, rendered):
    PAGE.write_text(pattern(block).sub(lambda _: rendered, PAGE.read_text(encoding="utf-8"), count=1), encoding="utf-8")
    print(PAGE, file=sys.stderr)


def run(name, laws, seed, runs, held_out, only, program, out, whole, scheduler=None, page=False):
    """Flies it and says so. whole: it is compared with the page. The exit status."""
    flights = planned(situations.load(name), laws, seed, runs, held_out, only)
    before_s, digest = of_children_s(), fleet.digest(program)
    with fleet.Store(out / f"{block_of(name, held_out)}.jsonl") as store:
        store.tell_of_another(program, {flight.key(digest): flight.label for flight in flights})
        figures, new = fly_missing(program, flights, store, scheduler)
    cost = f"; {(of_children_s() - before_s) / new:.2f} s of processor each" if new and not scheduler else ""
    print(f"{new} flights flown, {len(flights) - new} known{cost}", file=sys.stderr)
    flown = [(flight, figures[flight.name]) for flight in flights]
    listed = out / "wrong.txt"
    fleet.write_whole(listed, "".join(f"{line}\n" for line in failing(flown)))
    with contextlib.suppress(BrokenPipeError):
        print(f"{text(name, flown)}\n\nwhat went wrong, and the command of each: {listed}")
    if not whole:
        return 0
    rendered = render(name, flown, runs, held_out)
    if page:
        write(block_of(name, held_out), rendered)
    otherwise = compare(block_of(name, held_out), rendered)
    if otherwise:
        print("docs/reliability.md is otherwise; --page writes it:", *otherwise, sep="\n")
    return 1 if otherwise else 0
