#!/usr/bin/env python3
"""ablate.py [--part P,P] [--lies N] [--seed S] [--page]: what each part of the firmware is worth, by flights without it.

parts.toml has each part as a change of the source that takes it away. Of a copy of the tree in build/ablate, a program is built without the
part. It flies the same flights as the program with it: lies and healthy ones of tools/campaign, by EST with three mirrors and with one, by PID and PIDT.
Each part's line has how many flights differ at all, and of these how many are worse without it and how many better: harmed, mishandled,
wrong (healthy flights: any verdict; lies: a doubt of the truth, or deceived). The sign test's p tells how probable so uneven a split of the flights is
by chance (Dixon and Mood 1946). A part that changes no flight, or whose loss makes none worse, may go, after more flights.

--page writes the table of docs/ablation.md. Each flight is kept in build/ablate. Exit status: 0; 1 a part that is not in the source any more, or does not build; 2 usage.
"""
import argparse
import dataclasses
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
for place in ("tools/campaign", "tools/mutants"):
    sys.path.insert(0, str(ROOT / place))
import fleet       # noqa: E402
import harm        # noqa: E402
import musts       # noqa: E402
import mutants     # noqa: E402
import plan        # noqa: E402
import situations  # noqa: E402
import survey      # noqa: E402

PARTS = Path(__file__).with_name("parts.toml")
OUT = ROOT / "build/ablate"
PAGE = ROOT / "docs/ablation.md"
BLOCK = re.compile(r"(?<=<!-- ablation: by make ablate -->\n).*?(?=<!-- end -->)", re.DOTALL)
WHOLE = "whole"             # the program with all its parts
FRONT = "EST-FRONT"
OTHERS = ("PID", "PIDT")
HEALTHY_SHARE = 0.5         # of the lies' flights in each situation
LONG = "hours"              # a row of healthy.toml: half of all the time, for six flights


@dataclasses.dataclass(frozen=True)
class Part:
    name: str
    file: str
    says: str
    before: str
    after: str

    def away(self, text):
        """The source without it. Raises ValueError."""
        if text.count(self.before) != 1:
            raise ValueError(f"{self.name}: {text.count(self.before)} times in {self.file}: {self.before!r}")
        return text.replace(self.before, self.after)


def load():
    return [Part(name, **words) for name, words in tomllib.loads(PARTS.read_text(encoding="utf-8")).items()]


# Programs

def build(tree, name):
    """The program of the tree, kept under this name."""
    directory, program = OUT / "build", OUT / name
    commands = ([] if (directory / "build.ninja").exists() else
                [["cmake", "-G", "Ninja", "-S", tree, "-B", directory, "-DCMAKE_BUILD_TYPE=Release",
                  "-DCMAKE_C_FLAGS=-Wno-error=unused-function -Wno-error=unused-variable -Wno-error=unused-parameter -Wno-error=unused-const-variable"]])
    for command in [*commands, ["cmake", "--build", directory, "--target", "plomada"]]:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise fleet.Broken(f"ablate: {name} does not build:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    shutil.copyfile(directory / "plomada", program)
    program.chmod(0o755)
    return program


def built(parts):
    """{name: program}, the whole one first."""
    tree = OUT / "tree"
    mutants.copy_of_the_tree(tree)
    programs = {WHOLE: build(tree, WHOLE)}
    for part in parts:
        source, whole = tree / part.file, (ROOT / part.file).read_text(encoding="utf-8")
        try:
            source.write_text(part.away(whole), encoding="utf-8")
            programs[part.name] = build(tree, part.name)
        finally:
            source.write_text(whole, encoding="utf-8")
    return programs


# Flights

def planned(seed, lies):
    found = []
    for name, runs in ((situations.LIES, lies), (situations.HEALTHY, max(1, round(HEALTHY_SHARE * lies)))):
        table = situations.load(name)
        only = [situation.slug for situation in table.situations.values() if situation.row != LONG]
        for laws, of_laws in ((("EST",), runs), ((FRONT,), runs), (OTHERS, max(1, runs // survey.OTHERS))):
            found += survey.planned(table, laws, seed, of_laws, False, only)
    return found


VERDICTS = {
    "harmed": lambda flight, figures: harm.harmed(figures),
    "mishandled": lambda flight, figures: harm.mishandled(figures),
    "wrong": lambda flight, figures: any(title not in harm.GENTLE and title != "mishandled" for title in flight.verdicts(figures)),
}


def split(flights, whole, without, is_so):
    """(worse, better) without the part."""
    pairs = [(is_so(flight, whole[flight.name]), is_so(flight, without[flight.name])) for flight in flights]
    return sum(after and not before for before, after in pairs), sum(before and not after for before, after in pairs)


def sign_test(worse, better):
    """How probable so many worse ones, or more, are where worse and better are as likely."""
    from scipy import stats

    return float(stats.binom.sf(worse - 1, worse + better, 0.5)) if worse + better else 1.0


def changed(flights, whole, without):
    """(worse, better) without the part: flights with a verdict that got worse and none that got better, and the other way round."""
    worse = better = 0
    for flight in flights:
        signs = {(split([flight], whole, without, is_so)) for is_so in VERDICTS.values()} - {(0, 0)}
        worse += signs == {(1, 0)}
        better += signs == {(0, 1)}
    return worse, better


def compared(part, flights, whole, without):
    """A line of the table."""
    differ = sum(whole[flight.name] != without[flight.name] for flight in flights)
    splits = [split(flights, whole, without, is_so) for is_so in VERDICTS.values()]
    return [part.name, part.says, f"{differ}", *(f"{worse}; {better}" for worse, better in splits), f"{sign_test(*changed(flights, whole, without)):.2g}"]


HEAD = ["part", "what it does", "differ", *(f"{name}: worse; better" for name in VERDICTS), "p"]


def commit():
    """Of the sources: " (1a2b3c4)", or nothing where they are no clone."""
    done = subprocess.run(["git", "-C", ROOT, "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False)
    return f" ({done.stdout.strip()})" if done.returncode == 0 else ""


def rendered(lines, flights, options):
    words = f"--lies {options.lies}" + (f" --seed {options.seed}" if options.seed != 1 else "") + (f" --part {','.join(options.part)}" if options.part else "")
    return f"\nBy version {fleet.version()}{commit()}, `make ablate ARGS=\"{words} --page\"`; {flights} flights for each line.\n\n{survey.markdown(HEAD, lines)}\n"


def run(options, parts):
    OUT.mkdir(parents=True, exist_ok=True)
    plan.extend(musts.front())
    programs = built(parts)
    flights = planned(options.seed, options.lies)
    lines, whole = [], {}
    with fleet.Store(OUT / "flights.jsonl") as store:
        for name, program in programs.items():
            figures, _ = survey.fly_missing(str(program), flights, store)
            if name == WHOLE:
                whole = figures
                continue
            lines.append(compared(next(part for part in parts if part.name == name), flights, whole, figures))
            print(" | ".join(lines[-1]), flush=True)
    if options.page:
        page = PAGE.read_text(encoding="utf-8")
        fleet.write_whole(PAGE, BLOCK.sub(lambda _: rendered(lines, len(flights), options), page, count=1))
        print(PAGE, file=sys.stderr)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--part", type=lambda text: text.split(","), default=[], metavar="P,P", help="these alone (default: all)")
    parser.add_argument("--lies", type=int, default=4, metavar="N", help="flights in each situation of lies.toml; half as many of healthy.toml (4)")
    parser.add_argument("--seed", type=int, default=1, help="of the draws (1)")
    parser.add_argument("--page", action="store_true", help="writes the table of docs/ablation.md, of these parts")
    options = parser.parse_args()
    parts = load()
    unknown = set(options.part) - {part.name for part in parts}
    if unknown:
        parser.error(f"--part: {', '.join(sorted(unknown))}: none of {', '.join(part.name for part in parts)}")
    try:
        run(options, [part for part in parts if not options.part or part.name in options.part])
    except (fleet.Broken, ValueError, OSError) as error:
        sys.exit(f"ablate: {error}" if not str(error).startswith("ablate:") else str(error))
    except KeyboardInterrupt:
        sys.exit("ablate: interrupted; what was flown is kept, run it again to go on")


if __name__ == "__main__":
    main()
