#!/usr/bin/env python3
"""verdict.py LOG [--forecast FILE]: did the forecast of tune hold, and if not, what in the model was wrong?

Compares the log's own figures with the 90 % intervals of build/forecast.json. Where the log allows it, the vehicle is found
anew, and each figure that is now somewhere else is named. Exit status: 0 the forecast held; 1 it did not; 2 usage.
"""
import argparse
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))
import fit  # noqa: E402
import flight_log  # noqa: E402
import forecast  # noqa: E402

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
    held = True
    for name, f in expected["expected"].items():
        value = seen[name]
        good = value is None or f["low"] <= value <= f["high"]
        held = held and good
        shown = "not in this flight" if value is None else f"{value:.3g}"
        print(f"{name:14} {shown}, forecast {f['value']:.3g} [{f['low']:.3g} .. {f['high']:.3g}] {'' if good else 'NOT HELD'}")
    try:
        if forecast.has_edges(arguments.log):
            raise flight_log.Unfit("the ground steps under this flight; fly over flat ground")
        new, _, _ = fit.fit_logs([arguments.log])
        wrong = list(moved(old, new))
        print("\n".join(wrong) if wrong else "the vehicle is the one that was found: the rest is chance, or not in the model")
    except flight_log.Unfit as error:
        print(f"what in the model is wrong cannot be told: {error}")
    print("the forecast held" if held else "the forecast did not hold")
    return 0 if held else 1


if __name__ == "__main__":
    sys.exit(main())
