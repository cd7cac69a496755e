#!/usr/bin/env python3
"""why.py LOG [--out FILE]: why did it fly so?

LOG is a CSV of `plomada log` or of `plomada fly --csv`, a saved console with a dump of #LOG, or the directory of `fly --record`. The
vehicle is found in its own flight. Then each cause is tried: how much more likely is the flight with it than without? The causes
come in the order of that, in nats; two sentences say what happened and what to do, and FILE (build/why.png; or a folder) shows it. It says so when it
does not know, or when nothing is wrong. docs/why.md tells more. Exit status: 0; 2 usage, or a log that does not hold what is needed.
"""
import argparse
import math
import os
import sys
from pathlib import Path

os.environ.setdefault("OMP_NUM_THREADS", "1")       # matrices of four rows

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[1] / "fit")]
import causes  # noqa: E402
import commanded  # noqa: E402
import flight  # noqa: E402
import law  # noqa: E402
import vehicle  # noqa: E402
import without  # noqa: E402
from say import say  # noqa: E402  on the path by flight
from causes.case import Case  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
PICTURE = ROOT / "build/why.png"
WORTH = 3.5                     # nats: what is less than 33 times as likely as nothing is not named
HINT = math.log(2.0)            # what is less than twice as likely as nothing is not even mentioned
NOISES, FAR = ("turbulence", "acc_noise", "height_noise"), 3.0  # standard deviations of what healthy flights have


class Silent:
    def step(self, name):
        pass


class Progress:
    """On stderr, what is tried."""

    def step(self, name):
        print(f"{name} ...", file=sys.stderr, flush=True)


def ask(path, program, progress=None):
    """(flight, case, {cause: Finding} in the order of their likelihood). Raises flight.Unfit, OSError."""
    progress = progress or Silent()
    seen = flight.read(path, program)
    spans = vehicle.spans_of(seen)
    flew = seen.seconds() >= flight.LEAST_S and sum(len(span.ray_s) for span in spans) >= flight.LEAST_HEIGHTS
    progress.step("the vehicle in its flight")
    age_s, spans, model = vehicle.fit_aged("THRUST", spans) if flew else (0.0, spans, None)
    progress.step("what was set")
    flown = law.of(seen)
    case = Case(seen, spans, model, flown, commanded.of(seen, program, flown) if flew else None, age_s)
    found = {}
    for key, cause in causes.TABLE.items():
        if flew or cause.without_flight:
            progress.step(cause.name)
            found[key] = cause.try_it(case)
    return case, dict(sorted(found.items(), key=lambda pair: -pair[1].nats))


def verdict(found):
    """The keys that are worth naming, the most likely one first."""
    return [key for key, finding in found.items() if finding.nats > WORTH]


def guesses(found):
    """What it says first, second and so on; None: nothing found. Behind that stands a cause that is likelier than nothing, though not by WORTH."""
    return (verdict(found) or [None, *(key for key, finding in found.items() if finding.nats > HINT)])[:2]


def hint(found):
    """Of the cause behind `nothing found`. "": there is none."""
    told = guesses(found)
    if told[0] is not None or len(told) < 2:
        return ""
    return (f"If there is anything, it is this: {causes.TABLE[told[1]].name}, {math.exp(found[told[1]].nats):.0f} times as likely as nothing. "
            f"To be named takes {math.exp(WORTH):.0f} times.")


def sentences(case, found):
    named = verdict(found)
    if named:
        return [causes.TABLE[named[0]].what(found[named[0]]), causes.TABLE[named[0]].do(found[named[0]])]
    pieces = flight.pieces_of(case.flight)
    if case.model is None and pieces:
        heights = sum(len(span.ray_s) for span in case.spans)
        return [f"It does not know: the piece of flight is too short. Of {max(b - a for a, b in pieces):.1f} s in the air {heights} heights can be used; it takes "
                f"{flight.LEAST_S:g} s in one piece, and {flight.LEAST_HEIGHTS} heights."]
    if case.model is None:
        return ["It does not know: the vehicle did not fly, and nothing in the log says why."]
    if unwell(case):
        return ["It does not know: the vehicle moved as no healthy one does, and none of the causes tells why."]
    return ["Nothing found: the flight is as likely as that of a healthy vehicle."]


def unwell(case):
    """Whether what the equations leave is more than a healthy flight has."""
    return any(abs(math.log(case.model.figures[name] / vehicle.FIGURES[name][0])) > FAR * vehicle.FIGURES[name][1] for name in NOISES)


def which(case):
    return f"This is {case.flight.dump}, the longest; `plomada log` makes a CSV of each." if case.flight.dump else ""


def without_it(case, found):
    """(the flight without the likeliest cause, a sentence of it). (None, ""): there is none, or it cannot be told."""
    named = verdict(found)
    if not named or case.model is None:
        return None, ""
    flown = without.fly(case, named[0], found[named[0]])
    was, would = without.hover_rms_mm(case), without.rms_mm(flown) if flown is not None else None
    if was is None or would is None:
        return flown, ""
    hovered = f"It hovered {was:.0f} mm rms off its reference"
    if would >= was:
        return flown, f"{hovered}; without this the same vehicle would not have been nearer."
    return flown, f"{hovered}; without this the same vehicle would have been {would:.0f} mm off."


def table(found):
    named = verdict(found)
    lines = ["", "nats  cause (* likelier than nothing)"]
    lines += [f"{finding.nats:6.1f} {'*' if key in named else ' '} {causes.TABLE[key].name}" for key, finding in found.items()]
    return "\n".join(lines)


def picture_path(out):
    """In a folder it has the name it always has. Without an ending it gets one: Matplotlib gives it one too, and tells nobody."""
    if out.is_dir():
        return out / PICTURE.name
    return out if out.suffix else out.with_name(f"{out.name}.png")


def read_arguments(argv):
    parser = argparse.ArgumentParser(prog="plomada why", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", type=Path, metavar="LOG")
    parser.add_argument("--out", type=Path, default=PICTURE, metavar="FILE")
    parser.add_argument("--program", type=Path, default=ROOT / "build/plomada", help=argparse.SUPPRESS)
    arguments = parser.parse_args(argv)
    arguments.out = picture_path(arguments.out)
    return arguments


def check_out(arguments):
    """A name that was typed is no reason to make folders."""
    if arguments.out == PICTURE:
        PICTURE.parent.mkdir(exist_ok=True)
    if not arguments.out.parent.is_dir():
        raise OSError(f"{arguments.out}: {arguments.out.parent} is no folder")
    if arguments.out.exists() and arguments.log.exists() and arguments.out.samefile(arguments.log):
        raise OSError(f"{arguments.out}: is read here; another --out")


def main(argv=None):
    arguments = read_arguments(argv)
    try:
        check_out(arguments)        # said before the work
        case, found = ask(arguments.log, arguments.program, Progress())
    except (flight.Unfit, OSError) as error:
        print(f"why: {error}", file=sys.stderr)
        return 2
    flown, would = without_it(case, found)
    said = [*sentences(case, found), *filter(None, [hint(found), which(case)])]
    say("\n".join([*said, *([would] if would else []), table(found)]))
    import picture  # noqa: PLC0415  Matplotlib takes its second: what is wrong with a log is told before
    try:
        picture.draw(arguments.out, " ".join(said), case, [(causes.TABLE[key].name, finding) for key, finding in found.items()], flown)
    except (OSError, ValueError) as error:
        print(f"why: {arguments.out}: {error}", file=sys.stderr)
        return 2
    say(f"\n{arguments.out}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
