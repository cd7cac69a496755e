#!/usr/bin/env python3
"""campaign.py [--law L,L] [--set S,S] [--runs N] [--page] ...: flies each law on many vehicles.
campaign.py --healthy [N] | --lies [N] | --battery [N] [--law L,L] [--only SITUATION,ROW] [--held-out] [--page] ...: flies them in many situations.
campaign.py --fly SITUATION/NUMBER/LAW: flies one of those again, and says what it did.
campaign.py --resume [--out DIR]: goes on with the campaign in DIR, else with the last one begun in build/campaign, with the options it was begun with.

The vehicle of a run depends on the campaign's seed and the run's number alone, so all laws fly the same vehicles.
Flights run in processes of their own through Dask, on this machine or on the cluster of --scheduler. Each result is
kept at once in DIR/flights.jsonl, with the command that flies it again, seed, program and vehicle; a rerun flies only what is missing there, and what another program or other draws
would fly anew. A folder has one campaign, and one with options has its own. Then come the table and the verdicts on stdout, and in DIR campaign.csv, campaign.json and campaign.png.
The campaign without options is the one in docs/control.md: its tables must be these, or --page writes them.
With --healthy, --lies or --battery the laws fly N times in each situation of tools/campaign/healthy.toml, lies.toml or battery.toml: law EST, the others N / 4 times. Then
come the rates by situation, by row and by law; docs/reliability.md has the rows, and --page writes them. --held-out draws from
those parts of the ranges that nothing may be tuned on.
docs/campaign.md tells more. Exit status: 0; 1 a law does not reach what it must, or the page says otherwise; 2 usage or a program that does not fly; 130 interrupted.
"""
import argparse
import contextlib
import hashlib
import json
import os
import re
import sys
from pathlib import Path

import fleet
import page
import plan
import situations
import survey
import table
import verdict

ROOT = Path(__file__).resolve().parents[2]

BEGUN = "arguments.json"        # of --out: {"words": the command line, "files": {path: its sum}}
CAMPAIGNS = ROOT / "build/campaign"
# Options that name a file. Their names are kept whole: a campaign is gone on with from another directory too.
FILES = ("--plan", "--vehicle", "--program")

# Options that change neither what is flown nor what is told of it: how many words each takes. And how far a campaign goes.
ASIDE = {"--out": 1, "--resume": 0, "--page": 0, "--program": 1, "--scheduler": 1}
LENGTH = {"--runs": 1}
OF_RESUME = {"--resume": 0, "--out": 1}
NAME_MAX = 80                   # octets of a folder's name


def without(words, aside):
    """A command line less some options and their words."""
    found, words = [], list(words)
    while words:
        name, _, value = words.pop(0).partition("=")
        if name in aside:
            del words[:0 if value else aside[name]]
        else:
            found.append(f"{name}={value}" if value else name)
    return found


def absolute(words):
    """The same command line with the whole names of its files."""
    found = []
    for word in words:
        name, _, value = word.partition("=")
        if found and found[-1] in FILES:
            word = os.path.abspath(word)
        elif name in FILES and value:
            word = f"{name}={os.path.abspath(value)}"
        found.append(word)
    return found


def identity(words):
    """The words of a command line that make the campaign what it is: one of more flights is the same, gone on with."""
    found = without(absolute(words), ASIDE | LENGTH)
    for at, word in enumerate(found):
        if word.startswith(tuple(f"--{name}=" for name in survey.RUNS)):
            found[at] = word.partition("=")[0]
        elif word.isdigit() and found[at - 1].lstrip("-") in survey.RUNS:
            del found[at]
    return found


def folder_of(words):
    """Where a campaign goes that names no folder: one with options has its own, so that none overwrites another."""
    own = " ".join(without(words, ASIDE))
    name = re.sub(r"[^\w.=+]+", "-", own).strip("-")
    if len(name) > NAME_MAX:
        name = f"{name[:NAME_MAX - 9]}-{hashlib.sha256(own.encode()).hexdigest()[:8]}"
    return CAMPAIGNS / name


def refuse_pairs(parser, arguments):
    """Options of which one alone would be obeyed, without a word about the other."""
    named = [f"--{name}" for name in survey.RUNS if getattr(arguments, name)]
    if len(named) > 1:
        parser.error(f"one of --healthy, --lies and --battery, not {' and '.join(named)}")
    beside = {"--law": arguments.law_words, "--set": arguments.set_words, "--vehicle": arguments.vehicle, "--runs": arguments.runs,
              "--only": arguments.only, "--held-out": arguments.held_out, "--page": arguments.page} | dict.fromkeys(named, True)
    beside = [name for name, given in beside.items() if given]
    if arguments.fly and beside:
        parser.error(f"--fly flies a flight as it was, without {', '.join(beside)}; `plomada fly`, which it prints, takes --set")
    if any(word.upper().startswith("LAW=") for word in arguments.set_words):
        parser.error("--set LAW=: the law of a flight comes from --law")


def surveyed(arguments):
    """(Name of the table, flights in each situation), or None."""
    return next(((name, getattr(arguments, name)) for name in survey.RUNS if getattr(arguments, name)), None)


def whole(arguments):
    """Whether this is a run that a page shows: nothing that was typed leaves flights out, adds some, or changes them."""
    other = (arguments.law_words, arguments.set_words, arguments.plan, arguments.vehicle, arguments.runs, arguments.only, arguments.fly)
    elsewhere = arguments.held_out and (arguments.healthy or arguments.battery)     # the page has lies alone of that part
    return arguments.seed == 1 and not any(other) and not elsewhere


def names(known):
    def read(text):
        wanted = list(known) if text == "all" else text.split(",")
        for name in wanted:
            if name not in known:
                raise argparse.ArgumentTypeError(f"'{name}' is none of {', '.join(known)}")
        return list(dict.fromkeys(wanted))
    return read


def positive(text):
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError("at least 1")
    return value


def last_begun():
    """The folder of the campaign that was begun or resumed last, of those that named no --out. Raises Broken."""
    found = [*CAMPAIGNS.glob(BEGUN), *CAMPAIGNS.glob(f"*/{BEGUN}")]
    if not found:
        raise fleet.Broken(f"--resume: no campaign was begun in {CAMPAIGNS}; --out DIR names another folder")
    return max(found, key=lambda path: path.stat().st_mtime_ns).parent


def resumed(parser, arguments, words):
    """The arguments that the campaign in --out, or the last one, was begun with. Options beside would be dropped, so they are refused."""
    more = without(words, OF_RESUME)
    if more:
        parser.error(f"--resume takes the options that the campaign was begun with, and none beside --out: {' '.join(more)}. "
                     "To change some, type all of them without --resume")
    out = arguments.out or last_begun()
    path = out / BEGUN
    if not path.exists():
        parser.error(f"--resume: no campaign was begun in {out}")
    begun, files = begun_with(path)
    changed = changed_of(files)
    if changed:
        raise fleet.Broken(f"--resume: changed since the campaign in {out} was begun: {', '.join(changed)}; to fly it as it is now, "
                           f"type its options without --resume: {' '.join(begun)}")
    path.touch()
    print(f"goes on with {out}, begun with: {' '.join(begun) or 'no options'}", file=sys.stderr)
    again = parser.parse_args([*begun, "--out", str(out)])
    again.resume = True
    return again


def begun_with(path):
    """The command line of a campaign, and {path: sum} of the files that it names. Raises Broken."""
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        if isinstance(found, list):         # of before the sums of its files were kept
            found = {"words": found, "files": {}}
        return [str(word) for word in found["words"]], dict(found["files"])
    except (ValueError, TypeError, KeyError) as error:
        raise fleet.Broken(f"{path}: not the arguments of a campaign: {error}") from None


def changed_of(files):
    return [name for name, known in files.items() if not Path(name).is_file() or fleet.digest(name) != known]


def words_of_laws(arguments):
    """What is named where a law belongs."""
    laws = arguments.law_words.split(",") if arguments.law_words else []
    return laws + (arguments.fly or "").split("/")[2:3]


def choose(parser, arguments):
    """Laws, sets and assignments; what --plan adds, and the program's own laws that are named, are known from here on."""
    refuse_pairs(parser, arguments)
    if arguments.plan:
        try:
            plan.extend(json.loads(arguments.plan.read_text(encoding="utf-8")), plan.of_program(arguments.program))
        except (OSError, ValueError, TypeError, KeyError) as error:
            parser.error(f"--plan {arguments.plan}: {error}")
    if not set(words_of_laws(arguments)) <= {*plan.LAWS, "all"}:
        plan.take_from(arguments.program)
    words = [word for word in arguments.set_words if "=" not in word]
    arguments.typed = dict(word.split("=", 1) for word in arguments.set_words if "=" in word)
    try:
        arguments.laws = names(plan.LAWS)(arguments.law_words) if arguments.law_words else list(plan.LAWS)
        arguments.sets = names(plan.SETS)(",".join(words)) if words else plan.DEFAULT_SETS
    except argparse.ArgumentTypeError as error:
        parser.error(str(error))
    if surveyed(arguments) and (arguments.set_words or arguments.vehicle or arguments.runs):
        parser.error("--healthy, --lies and --battery go without --set, --vehicle and --runs")
    if (arguments.only or arguments.held_out) and not surveyed(arguments):
        parser.error("--only and --held-out go with --healthy, --lies or --battery")


def read_arguments(argv):
    sets = "; ".join(f"{name} ({s.runs}): {s.summary}" for name, s in plan.SETS.items()).replace("%", "%%")
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     allow_abbrev=False)     # folders and --resume go by the words
    parser.add_argument("--law", dest="law_words", help="default: " + ", ".join(plan.LAWS))
    parser.add_argument("--set", action="append", default=[], dest="set_words",
                        help=f"or all (default: {','.join(plan.DEFAULT_SETS)}); {sets}; or NAME=VALUE, a parameter or a "
                             "figure of the plant in every flight; may be given again")
    parser.add_argument("--plan", type=Path, metavar="FILE", help="own laws and sets, JSON; docs/campaign.md")
    parser.add_argument("--vehicle", type=Path, metavar="FILE", help="of make fit: in place of the nominal vehicle")
    parser.add_argument("--resume", action="store_true", help="with the options of the campaign in DIR, or of the last one begun")
    parser.add_argument("--runs", type=positive, help="flights per law in each set (default: in brackets above)")
    for name, runs in survey.RUNS.items():
        parser.add_argument(f"--{name}", type=positive, nargs="?", const=runs, metavar="N",
                            help=f"in the situations of {name}.toml, each N times ({runs}) instead of the sets")
    parser.add_argument("--only", type=lambda text: text.split(","), default=[], metavar="S,S", help="of them these situations or rows alone")
    parser.add_argument("--held-out", action="store_true", help="from the parts of the ranges that are kept out of every tuning")
    parser.add_argument("--fly", metavar="FLIGHT", help="one of them again: SITUATION/NUMBER/LAW")
    parser.add_argument("--seed", type=positive, default=1, help="of the draws (1)")
    parser.add_argument("--page", action="store_true", help="writes the tables of docs/control.md and its picture; with --healthy, --lies or --battery one of "
                             "docs/reliability.md")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster (default: this machine's processors)")
    parser.add_argument("--program", type=Path, default=ROOT / "build/plomada", help="default: build/plomada")
    parser.add_argument("--out", type=Path, metavar="DIR",
                        help="default: build/campaign, and in it a folder for each campaign with options")
    arguments = parser.parse_args(argv)
    words = sys.argv[1:] if argv is None else list(argv)
    if arguments.resume:
        arguments = resumed(parser, arguments, words)
    arguments.out = arguments.out or folder_of(words)
    choose(parser, arguments)
    if arguments.page and not whole(arguments):
        parser.error("--page writes what a whole run found: it goes alone, or with --healthy, --lies, --lies --held-out or --battery. Leave the other "
                     "options, or leave --page")
    return arguments


def with_own(words, typed, vehicle):
    """The same flight with the vehicle of a file, and with own assignments, which win."""
    own = [word for name, value in typed.items() for word in ("--set", f"{name}={value}")]
    return [words[0], *(["--vehicle", str(vehicle.resolve())] if vehicle else []), *words[1:], *own]


def redrawn(sets, vehicle):
    """{set: the figures of the vehicle's file that it draws anew}, of those that do."""
    known = set(re.findall(r'"plant\.(\w+)"', vehicle.read_text(encoding="utf-8")))
    found = {name: sorted(known & set(plan.plant(name, 1, 1))) for name in sets}
    return {name: figures for name, figures in found.items() if figures}


def flights(program, laws, sets, seed, runs, typed=None, vehicle=None):
    """{key: (label, arguments)} of the whole campaign."""
    digest = fleet.digest(program) + (fleet.digest(vehicle) if vehicle else "")
    planned = {}
    for set_name in sets:
        for law_name, law in laws.items():
            for run in range(1, (runs or plan.SETS[set_name].runs) + 1):
                words = with_own(plan.arguments(law, set_name, seed, run), typed or {}, vehicle)
                label = {"law": law_name, "set": set_name, "run": run}
                planned[fleet.key(digest, [law_name, set_name, *words])] = (label, words)
    return planned


def fly_missing(program, planned, store, scheduler=None):
    """How many had to be flown."""
    missing = [(key, words) for key, (_, words) in planned.items() if key not in store.known]
    if not missing:
        return 0
    store.tell_of_another(program, {key: label for key, (label, _) in planned.items()})
    progress, provenance = fleet.Progress(len(missing)), fleet.provenance(program)
    with fleet.fleet(scheduler) as client:
        for key, figures in fleet.fly_all(client, program, missing):
            label, words = planned[key]
            store.add(key, label | provenance | {"command": fleet.command(program, words)}, figures)
            progress.step()
    return len(missing)


def grouped(planned, known):
    groups = {}
    for key, (label, _) in planned.items():
        groups.setdefault(label["set"], {}).setdefault(label["law"], []).append(known[key])
    return groups


def worst(program, planned, known):
    """The flight that one wants to see first, and what flies it again."""
    def badness(key):
        figures = known[key]
        return table.failed(figures, plan.SETS[planned[key][0]["set"]].lands), figures["hover_rms_mm"] or 0.0

    key = max(planned, key=badness)
    label, words = planned[key]
    return (f"the worst flight ({label['law']}, {label['set']}, run {label['run']}); flights.jsonl has the command of every other:\n"
            f"{fleet.command(program, words)}")


def rows_of(groups):
    return [table.row(law, set_name, flown, plan.SETS[set_name].lands)
            for set_name, laws in groups.items() for law, flown in laws.items()]


def write(arguments, groups, rows):
    import picture

    out = arguments.out
    table.write_csv(out / "campaign.csv", rows)
    fleet.write_whole(out / "campaign.json", json.dumps({"seed": arguments.seed, "rows": table.plain(rows)}, indent=1) + "\n")
    lands = {name: plan.SETS[name].lands for name in groups}
    picture.draw(out / "campaign.png", groups, lands)
    if arguments.page:
        picture.draw(page.PICTURE, {name: groups[name] for name in page.PICTURED}, lands)
    for name in ("campaign.csv", "campaign.json", "campaign.png"):
        print(out / name)


def compare_page(rows, rewrite):
    """What docs/control.md has otherwise, once it is written if it is to be."""
    import bound

    rendered = page.render(rows, list(zip(bound.ACTIVITIES_N, bound.bounds(bound.ACTIVITIES_N), strict=True)))
    if rewrite:
        page.write(rendered)
    return page.compare(rendered, page.PAGE.read_text(encoding="utf-8"))


def run_survey(arguments):
    """The exit status."""
    name, runs = surveyed(arguments)
    return survey.run(name, arguments.laws, arguments.seed, runs, arguments.held_out, arguments.only, str(arguments.program.resolve()),
                      arguments.out, whole(arguments), arguments.scheduler, arguments.page)


def fly_one(arguments):
    flight = survey.find(arguments.fly, arguments.seed)
    survey.fly_one(flight, str(arguments.program.resolve()), ROOT / "build/campaign/single")
    return 0


def run(arguments):
    """The exit status."""
    program = str(arguments.program.resolve())
    for name, figures in redrawn(arguments.sets, arguments.vehicle).items() if arguments.vehicle else ():
        print(f"set {name} is not around {arguments.vehicle}: it has figures of its own for {', '.join(figures)}")
    laws = {name: plan.LAWS[name] for name in arguments.laws}
    planned = flights(program, laws, arguments.sets, arguments.seed, arguments.runs, arguments.typed, arguments.vehicle)
    with fleet.Store(arguments.out / "flights.jsonl") as store:
        flown = fly_missing(program, planned, store, arguments.scheduler)
    print(f"{flown} flights flown, {len(planned) - flown} known", file=sys.stderr)
    groups = grouped(planned, store.known)
    rows = rows_of(groups)
    print(f"median [p95] of the flights that did not fail; seed {arguments.seed}\n\n{table.text(rows)}\n")
    found = verdict.verdicts(rows)
    print(verdict.text(found), end="\n\n")
    print(worst(program, planned, store.known), end="\n\n")
    write(arguments, groups, rows)
    otherwise = compare_page(rows, arguments.page) if whole(arguments) else []
    if otherwise:
        print("docs/control.md is otherwise; --page writes it:", *otherwise, sep="\n")
    return 1 if otherwise or any(one.missed for one in found) else 0


def remember(arguments, argv):
    """For --resume. A folder has one campaign: its arguments, tables and picture are not those of another."""
    if arguments.resume:
        return
    words = absolute(sys.argv[1:] if argv is None else argv)
    path = arguments.out / BEGUN
    if path.exists():
        begun, files = begun_with(path)
        if identity(begun) != identity(words):
            raise fleet.Broken(f"{arguments.out} has another campaign, begun with: {' '.join(begun) or 'no options'}; give this one its own "
                               "--out DIR")
        for name in changed_of(files):
            print(f"{name} was changed: what it changes is flown anew", file=sys.stderr)
    files = {os.path.abspath(name): fleet.digest(name) for name in (arguments.plan, arguments.vehicle) if name}
    arguments.out.mkdir(parents=True, exist_ok=True)
    fleet.write_whole(path, json.dumps({"words": words, "files": files}))


def forget(out):
    """Of a campaign that could not fly: without a flight that is kept there is nothing to go on with."""
    if not any(out.glob("*.jsonl")):
        (out / BEGUN).unlink(missing_ok=True)
        with contextlib.suppress(OSError):      # of other campaigns, or not there
            out.rmdir()


def main(argv=None):
    try:
        arguments = read_arguments(argv)
        if arguments.fly:
            return fly_one(arguments)
        remember(arguments, argv)
        try:
            return run_survey(arguments) if surveyed(arguments) else run(arguments)
        except Exception:
            if not arguments.resume:
                forget(arguments.out)
            raise
    except (fleet.Broken, situations.Wrong, OSError) as error:
        print(f"campaign: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("campaign: interrupted; what was flown is kept, run it again to go on", file=sys.stderr)
        return 130


if __name__ == "__main__":
    sys.exit(main())
