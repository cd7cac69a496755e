#!/usr/bin/env python3
"""campaign.py [--law L,L] [--set S,S] [--runs N] [--seed N] [--scheduler ADDRESS] ...: flies each law on many vehicles.

The vehicle of a run depends on the campaign's seed and the run's number alone, so all laws fly the same vehicles. Flights
run in processes of their own through Dask, on this machine or on the cluster of --scheduler. Each result is kept at
once in DIR/flights.jsonl; a rerun flies only what is missing there, and what another program or other draws would fly
anew. Then come the table on stdout, and in DIR campaign.csv, campaign.json and campaign.png. docs/campaign.md tells more.
Exit status: 0; 2 usage or a program that does not fly; 130 interrupted.
"""
import argparse
import json
import sys
from pathlib import Path

import fleet
import plan
import table

ROOT = Path(__file__).resolve().parents[2]


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


def read_arguments(argv):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--law", type=names(plan.LAWS), help="default: all that the program offers; "
                        + ", ".join(plan.LAWS))
    parser.add_argument("--set", type=names(plan.SETS), default=["nominal", "untrimmed"], dest="sets",
                        help="or all (default: nominal,untrimmed); "
                        + "; ".join(f"{name}: {s.summary}" for name, s in plan.SETS.items()).replace("%", "%%"))
    parser.add_argument("--runs", type=positive, default=200, help="flights per law and set (200)")
    parser.add_argument("--seed", type=positive, default=1, help="of the draws (1)")
    parser.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster (default: this machine's processors)")
    parser.add_argument("--program", type=Path, default=ROOT / "build/plomada", help="default: build/plomada")
    parser.add_argument("--out", type=Path, default=ROOT / "build/campaign", metavar="DIR", help="default: build/campaign")
    return parser.parse_args(argv)


def offered(program):
    """The laws that this program can fly, by trying each for once."""
    laws = {}
    reason = None
    for name, law in plan.LAWS.items():
        try:
            fleet.fly(program, plan.arguments(law, "nominal", 1, 1))
            laws[name] = law
        except fleet.Broken as error:
            reason = error
    if not laws:
        raise reason
    return laws


def flights(program, laws, sets, seed, runs):
    """{key: (label, arguments)} of the whole campaign."""
    digest = fleet.digest(program)
    planned = {}
    for set_name in sets:
        for law_name, law in laws.items():
            for run in range(1, runs + 1):
                words = plan.arguments(law, set_name, seed, run)
                label = {"law": law_name, "set": set_name, "run": run}
                planned[fleet.key(digest, [law_name, set_name, *words])] = (label, words)
    return planned


def fly_missing(program, planned, store, scheduler=None):
    """How many had to be flown."""
    missing = [(key, words) for key, (_, words) in planned.items() if key not in store.known]
    if not missing:
        return 0
    progress = fleet.Progress(len(missing))
    with fleet.fleet(scheduler) as client:
        for key, figures in fleet.fly_all(client, program, missing):
            store.add(key, planned[key][0], figures)
            progress.step()
    return len(missing)


def grouped(planned, known):
    groups = {}
    for key, (label, _) in planned.items():
        groups.setdefault(label["set"], {}).setdefault(label["law"], []).append(known[key])
    return groups


def report(out, arguments, groups):
    import picture

    lands = {name: plan.SETS[name].lands for name in groups}
    rows = [table.row(law, set_name, of_law, lands[set_name])
            for set_name, laws in groups.items() for law, of_law in laws.items()]
    table.write_csv(out / "campaign.csv", rows)
    (out / "campaign.json").write_text(json.dumps({"seed": arguments.seed, "runs": arguments.runs,
                                                   "rows": table.plain(rows)}, indent=1) + "\n", encoding="utf-8")
    picture.draw(out / "campaign.png", groups, lands)
    print(f"median [p95] of the flights that did not fail; {arguments.runs} flights per row, seed {arguments.seed}\n")
    print(table.text(rows))
    print()
    for name in ("campaign.csv", "campaign.json", "campaign.png"):
        print(out / name)


def run(arguments):
    program = str(arguments.program.resolve())
    laws = {name: plan.LAWS[name] for name in arguments.law} if arguments.law else offered(program)
    planned = flights(program, laws, arguments.sets, arguments.seed, arguments.runs)
    with fleet.Store(arguments.out / "flights.jsonl") as store:
        flown = fly_missing(program, planned, store, arguments.scheduler)
    print(f"{flown} flights flown, {len(planned) - flown} known", file=sys.stderr)
    report(arguments.out, arguments, grouped(planned, store.known))


def main(argv=None):
    arguments = read_arguments(argv)
    try:
        run(arguments)
    except (fleet.Broken, OSError) as error:
        print(f"campaign: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        print("campaign: interrupted; what was flown is kept, run it again to go on", file=sys.stderr)
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
