#!/usr/bin/env python3
"""verdict.py LOG [--forecast FILE]: did the forecast of tune hold, and if not, what in the model was wrong?

Compares the log's own figures with the 90 % intervals of build/forecast.json. A figure breaks it only by being worse. What the
flight does not have is named. Where the log allows it, the vehicle is found anew, and each figure that is now somewhere else is
named. Exit status: 0 the forecast held, as far as it was flown; 1 it did not; 2 usage, or a flight that has none of its figures.
"""
import argparse
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import fit  # noqa: E402
import flight_log  # noqa: E402
import forecast  # noqa: E402
from say import say  # noqa: E402  on the path by flight_log

FAR = 2.0                       # standard deviations
WIDTH = 2.0 * 1.645             # of a 90 % interval, in standard deviations


def spread(f):
    return (f["high"] - f["low"]) / WIDTH


def moved(old, new):
    """Sentences: what is not where it was."""
    if old["throttle"] != new["throttle"] and new["throttle_told"]:
        yield f"the throttle commands {new['throttle']}, not {old['throttle']}"
        return
    for key, f in new.items():
        if isinstance(f, dict) and "told" in f and key in old:
            off = abs(f["value"] - old[key]["value"])
            if off > FAR * math.hypot(spread(f), spread(old[key])):
                yield f"{key} is {f['value']:.3g}, not {old[key]['value']:.3g}: {fit.MEANING[key.removeprefix('plant.')][0]}"


def compared(f, value):
    """Each figure is an error: the less, the better."""
    if value is None:
        return "not in this flight"
    value, low, high = (float(f"{number:.3g}") for number in (value, f["low"], f["high"]))      # as they are printed
    return "NOT HELD" if value > high else "better than forecast" if value < low else "held"


def told(words):
    """(the last sentence, exit status). words: {figure: compared()}."""
    missing = [name for name, word in words.items() if word == "not in this flight"]
    flown = len(words) - len(missing)
    if flown == 0:
        return f"nothing was compared: this flight has no {', '.join(missing) or 'figure of a forecast'}", 2
    part = f"; not in this flight: {', '.join(missing)}" if missing else ""
    if "NOT HELD" in words.values():
        chance = forecast.fails_by_chance(flown)
        return f"the forecast did not hold{part}\nby chance one that is right fails in up to {100 * chance:.0f} of 100 flights, {flown} figures compared", 1
    return f"the forecast held as far as it was flown, {flown} of {len(words)} figures{part}" if missing else "the forecast held", 0


def main(argv=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("log", type=Path)
    parser.add_argument("--forecast", type=Path, default=forecast.ROOT / "build/forecast.json")
    arguments = parser.parse_args(argv)
    try:
        if not arguments.forecast.exists():
            raise flight_log.Unfit(f"{arguments.forecast}: no forecast; `make tune VEHICLE=build/vehicle.json` makes one")
        expected, old = forecast.load_forecast(arguments.forecast)
        seen = forecast.quality(arguments.log)
    except (flight_log.Unfit, OSError, ValueError) as error:
        print(f"verdict: {error}", file=sys.stderr)
        return 2
    words = {name: compared(f, seen[name]) for name, f in expected["expected"].items()}
    for name, f in expected["expected"].items():
        shown = "none" if seen[name] is None else f"{seen[name]:.3g}"
        say(f"{name:14} {shown}, forecast {f['value']:.3g} [{f['low']:.3g} .. {f['high']:.3g}] {words[name]}")
    try:
        if forecast.has_edges(arguments.log):
            raise flight_log.Unfit("the ground steps under this flight; fly over flat ground")
        new, _, _ = fit.fit_logs([arguments.log])
        wrong = list(moved(old, new))
        say("\n".join(wrong) if wrong else "the vehicle is the one that was found: the rest is chance, or not in the model")
    except flight_log.Unfit as error:
        say(f"what in the model is wrong cannot be told: {error}")
    sentence, status = told(words)
    if status == 2:
        print(f"verdict: {sentence}", file=sys.stderr)
    else:
        say(sentence)
    return status


if __name__ == "__main__":
    sys.exit(main())
