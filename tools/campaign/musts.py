#!/usr/bin/env python3
"""musts.py [--only MUST,..] [--share S] [--seed N] [--page] ...: what law EST must keep, measured on drawn flights.
musts.py --fly SITUATION/NUMBER/LAW [--seed N]: flies one of them again, says what it did, and prints its `plomada fly`.

musts.toml has each must: its situations, and its bound. EST flies with three mirrors, EST-FRONT with one. A flight misses a must when it does
what it must not, or when its figure is beyond the bound. The rate of these is told with bounds of 95 % confidence (Clopper and Pearson 1934):

  kept     none missed it, where none may
  SHOWN    the upper bound is not above what the must allows
  MISSED   the lower bound is above it, or one missed it where none may
  OPEN     so many flights do not tell

--share 0.1 flies a tenth of the flights. Each flight is kept in build/campaign/musts, by program and draw: a rerun flies what is missing there.
--page, of all musts and flights, writes the table of docs/reliability.md. Exit status: 0; 1 a must is MISSED; 2 usage or a program that does not fly.
"""
import argparse
import hashlib
import json
import math
import random
import statistics
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import fleet
import harm
import plan
import rate
import situations
import survey
import table

FILE = situations.HERE / "musts.toml"
BLOCK = "musts"
ERROR = rate.ERROR / 2
AWAY_MM = 2000.0
KEPT = "kept"

# What a flight may do wrong, by what musts.toml calls it.
COUNTED = {
    "doubted": harm.doubted,
    "contacts": lambda f: f["ground_contacts"] > 0,
    "harmed": harm.harmed,
    "flew away": lambda f: harm.above(f, "highest_mm", AWAY_MM),
}


def three_digits(value):
    """1190, not 1.19e+03."""
    return f"{float(f'{value:.3g}'):.10g}"


@dataclass(frozen=True)
class Must:
    name: str
    says: str
    share: float                # of the flights may miss it
    flights: int                # of each law
    counts: tuple = ()
    figure: str = ""
    most: float = 0.0
    aim: float = 0.0
    aim_share: float = 0.0
    same: str = ""              # it judges the flights of that must

    def misses(self, figures, most):
        """A figure that is missing is not within its bound; but a vehicle that never left the ground has touched it at no speed."""
        if self.counts:
            return any(COUNTED[name](figures) for name in self.counts)
        if figures[self.figure] is None:
            return self.figure != "touch_speed_mps" or figures["aloft_s"] > 0
        return figures[self.figure] > most

    def missed(self, figures):
        return self.misses(figures, self.most)

    def beyond_aim(self, figures):
        return self.misses(figures, self.aim)


@dataclass(frozen=True)
class Planned:
    must: Must
    situation: situations.Situation
    law: str
    number: int
    seed: int
    flight: situations.Flight

    @property
    def name(self):
        return f"{self.situation.slug}/{self.number}/{self.law}"

    @property
    def label(self):
        return {"flight": self.name, "seed": self.seed}

    @property
    def command(self):
        return f"build/venv/bin/python tools/campaign/musts.py --seed {self.seed} --fly {self.name}"

    def key(self, digest):
        text = hashlib.sha256(self.flight.text.encode()).hexdigest()
        return fleet.key(digest, [text, *self.flight.words])


def load(text=None):
    """({name: Must}, the Table of their situations). Raises situations.Wrong."""
    found = tomllib.loads(FILE.read_text(encoding="utf-8") if text is None else text)
    musts = {name: Must(name, **{key: tuple(value) if isinstance(value, list) else value for key, value in words.items()})
             for name, words in found.pop("must").items()}
    base = situations.situation_of("base", found.pop("base"), "musts.toml: base")
    of = {name: situations.situation_of(name, {"row": words["of"], **words}, f"musts.toml: {name}") for name, words in found.items()}
    unknown = {one.row for one in of.values()} - set(musts)
    if unknown:
        raise situations.Wrong(f"musts.toml: of: {', '.join(sorted(unknown))}: no such must")
    return musts, situations.Table("musts", base, of)


def front():
    """The plan of EST-FRONT, for plan.extend()."""
    return json.loads((situations.HERE / "front.json").read_text(encoding="utf-8"))


def draw(of_table, situation, law, seed, number):
    """One flight. The same for every law but for what the law types."""
    if not situation.any_of:
        return situations.flight(of_table, situation, plan.LAWS[law], seed, number)
    healthy = situations.load(situations.HEALTHY)
    rng = random.Random(f"musts {situation.name} {seed}/{number}")
    chosen = rng.choice([one for one in healthy.situations.values() if one.row in situation.any_of])
    draft = situations.Draft(f"musts {situation.name}", seed, number, False)
    for one in (healthy.base, chosen, situation):
        draft.add(one, rng, f"musts.toml: {situation.name}: {chosen.name}")
    words = ["--seed", str((seed - 1) * plan.RUNS_PER_SEED + number), "--until-down", str(situations.DOWN_WITHIN_S)]
    return situations.Flight(draft.text(f"{situation.slug}-{number}", plan.LAWS[law]), words, ())


def planned(musts, of_table, only, share, seed):
    """The flights of all musts, situations in turn. Those of a must that says `same` are another's."""
    found = []
    for must in musts.values():
        if must.same or (only and not {must.name, *(one.name for one in musts.values() if one.same == must.name)} & set(only)):
            continue
        rows = [one for one in of_table.situations.values() if one.row == must.name]
        for law in plan_laws(rows):
            of_law = [one for one in rows if law in one.laws]
            each = -(-round(max(must.flights * share, len(of_law))) // len(of_law))
            found += [Planned(must, one, law, number, seed, draw(of_table, one, law, seed, number)) for number in range(1, each + 1) for one in of_law]
    return found


def plan_laws(rows):
    return [law for law in plan.LAWS if any(law in one.laws for one in rows)]


def fly(program, flights, store):
    """[(Planned, figures)], in the order of the flights."""
    digest = fleet.digest(program)
    keys = {flight.name: flight.key(digest) for flight in flights}
    missing = {keys[flight.name]: flight for flight in flights if keys[flight.name] not in store.known}
    if missing:
        store.tell_of_another(program, {keys[flight.name]: flight.label for flight in flights})
        progress, provenance = fleet.Progress(len(missing)), fleet.provenance(program)
        with fleet.fleet() as client:
            for key, figures in fleet.fly_all(client, program, [(key, flight.flight.words, flight.flight.text) for key, flight in missing.items()]):
                store.add(key, missing[key].label | provenance | {"command": missing[key].command}, figures)
                progress.step()
    return [(flight, store.known[keys[flight.name]]) for flight in flights]


def told(must, count, of):
    if must.share == 0.0:
        return rate.MISSED if count else KEPT
    return rate.told(count, of, must.share, ERROR)


@dataclass(frozen=True)
class Row:
    must: Must
    law: str
    situation: str              # of it alone; "": all of them
    flown: list

    @property
    def count(self):
        return sum(self.must.missed(figures) for _, figures in self.flown)

    @property
    def verdict(self):
        return told(self.must, self.count, len(self.flown))

    def cells(self):
        m = self.must
        bound = f"{m.figure} {m.most:g}" if m.figure else ", ".join(m.counts)
        values = sorted(figures[m.figure] for _, figures in self.flown if figures[m.figure] is not None) if m.figure else []
        spread = "; ".join(map(three_digits, (statistics.median(values), table.percentile(values, 0.95), values[-1]))) if values else ""
        aim = (survey.share(self.flown, lambda _, figures: m.beyond_aim(figures)) + f", aim {m.aim:g}" if m.figure else
               f"aim {100 * m.aim_share:g} %" if m.aim_share else "")
        return [f"- {self.situation}" if self.situation else m.says, self.law, str(len(self.flown)), str(self.count),
                survey.share(self.flown, lambda _, figures: m.missed(figures)), f"{bound}: {100 * m.share:g} %", spread, aim,
                "" if self.situation else self.verdict]


HEAD = ["must", "law", "flights", "missed it", "% [95 %]", "may miss", "median; p95; worst", "beyond the aim", ""]


def rows_of(musts, flown, only, parts=True):
    found = []
    for must in musts.values():
        of_must = [one for one in flown if one[0].must.name == (must.same or must.name)]
        if not of_must or (only and must.name not in only):
            continue
        for law in dict.fromkeys(flight.law for flight, _ in of_must):
            of_law = [one for one in of_must if one[0].law == law]
            found.append(Row(must, law, "", of_law))
            names = list(dict.fromkeys(flight.situation.name for flight, _ in of_law))
            if parts and len(names) > 1:
                found += [Row(must, law, name, [one for one in of_law if one[0].situation.name == name]) for name in names]
    return found


def missing_it(rows):
    """What missed a must, the worst first, and its command."""
    for row in rows:
        if row.situation:
            continue
        bad = [one for one in row.flown if row.must.missed(one[1])]
        if row.must.figure:
            bad.sort(key=lambda one: -(one[1][row.must.figure] or 1e9))
        for flight, figures in bad:
            yield f"{row.must.name}: {flight.name}: {figures[row.must.figure] if row.must.figure else ', '.join(harm.wrong(figures))}\n  {flight.command}"


def render(rows, seed):
    return (f"\nBy version {fleet.version()}, `build/venv/bin/python tools/campaign/musts.py --seed {seed} --page`.\n\n"
            f"{survey.markdown(HEAD[:-1] + ['told'], [row.cells() for row in rows])}\n")


def fly_one(name, of_table, musts, seed, program):
    slug, number, law, _ = survey.parts_of(name)
    known = {one.slug: one for one in of_table.situations.values()}
    if slug not in known:
        raise situations.Wrong(f"{name}: no situation {slug}: one of {', '.join(known)}")
    if law not in plan.LAWS:
        raise situations.Wrong(f"{name}: no law {law}: one of {', '.join(plan.LAWS)}")
    situation = known[slug]
    one = Planned(musts[situation.row], situation, law, number, seed, draw(of_table, situation, law, seed, number))
    path = fleet.ROOT / "build/campaign/single" / f"{name.replace('/', '-')}.scenario"
    path.parent.mkdir(parents=True, exist_ok=True)
    fleet.write_whole(path, one.flight.text)
    figures = fleet.fly(program, [str(path), *one.flight.words])
    print(*(f"  {key:20} {'-' if value is None else value}" for key, value in figures.items()), sep="\n")
    missed = [must.says for must in musts.values() if situation.row in (must.name, must.same) and must.missed(figures)]
    print(f"\nmissed: {'; '.join(missed) or 'nothing'}\n{fleet.command(program, [str(path), *one.flight.words])}")


def share_of(text):
    value = float(text)
    if not 0.0 < value < math.inf:
        raise argparse.ArgumentTypeError("more than 0")
    return value


def list_of(arguments):
    """Where the flights are listed that missed a must. A run of some musts, or of a share, is not the whole one: it has a file of its own."""
    part = [*(["only", *sorted(arguments.only)] if arguments.only else []), *(["share", f"{arguments.share:g}"] if arguments.share != 1.0 else [])]
    return arguments.out / f"{'-'.join(['missed', str(arguments.seed), *part])}.txt"


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", type=lambda text: text.split(","), default=[], metavar="MUST,MUST", help="these alone")
    parser.add_argument("--share", type=share_of, default=1.0, help="of the flights (1)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--fly", metavar="FLIGHT", help="one of them again: SITUATION/NUMBER/LAW")
    parser.add_argument("--page", action="store_true", help="writes the table of docs/reliability.md")
    parser.add_argument("--program", type=Path, default=fleet.ROOT / "build/plomada")
    parser.add_argument("--out", type=Path, default=fleet.ROOT / "build/campaign/musts", metavar="DIR")
    arguments = parser.parse_args(argv)
    if arguments.page and (arguments.only or arguments.share != 1.0 or arguments.fly):
        parser.error("--page writes what a whole run found: leave --only, --share and --fly, or leave --page")
    program = str(arguments.program.resolve())
    try:
        if "EST-FRONT" not in plan.LAWS:
            plan.extend(front())
        musts, of_table = load()
        if set(arguments.only) - set(musts):
            parser.error(f"--only: of {', '.join(musts)}")
        if arguments.fly:
            fly_one(arguments.fly, of_table, musts, arguments.seed, program)
            return 0
        flights = planned(musts, of_table, arguments.only, arguments.share, arguments.seed)
        with fleet.Store(arguments.out / "flights.jsonl") as store:
            flown = fly(program, flights, store)
    except (fleet.Broken, situations.Wrong, OSError) as error:
        print(f"musts: {error}", file=sys.stderr)
        return 2
    rows = rows_of(musts, flown, arguments.only)
    print(table.columns([HEAD, *(row.cells() for row in rows)], left=2))
    listed = list_of(arguments)
    fleet.write_whole(listed, "".join(f"{line}\n" for line in missing_it(rows)))
    print(f"\nwhat missed a must, the worst first, and the command of each: {listed}")
    if arguments.page:
        survey.write(BLOCK, render(rows, arguments.seed))
    return 1 if any(row.verdict == rate.MISSED for row in rows if not row.situation) else 0


if __name__ == "__main__":
    sys.exit(main())
