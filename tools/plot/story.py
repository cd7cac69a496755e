#!/usr/bin/env python3
"""story.py FILE: what happened in a flight, as JSON: [{"t": seconds, "kind": ..., "text": a sentence}, ...].

Take-off and landing, references, edges of the ground, doubts, limits, states, and mirrors that the vote left out. The sentences
stand in ground/src/story.json. The page has the same rules in ground/src/story.ts; ground/tests/unit/story.test.ts holds both to the same words.
FILE is what plot.py reads. Exit 2 when it cannot be read.
"""
import json
import math
import sys
from pathlib import Path

import recording

TEXTS = Path(__file__).resolve().parents[2] / "ground/src/story.json"
# An edge is a height that changes by more than noise and the vehicle's own way since the height before: ten times the noise of a
# group of rays, and VDN, the faster of the two limits of its speed. Telemetry, five times a second, shows edges from 0.27 m on.
EDGE_M, EDGE_MPS = 0.05, 1.1
SCANS_LOST_S = 0.35             # a height after a longer gap is compared with nothing
TOGETHER_S = 0.5                # what pauses for less goes on: a moving reference, steps of an edge, a doubt, a limit
MOVED_M = 0.1                   # a stick moves the reference by less from row to row; by more it is a command
LIMIT_LEAST_S = 0.5             # a shorter one is no more than a flicker
SCAN_S = 0.1                    # a scan comes every 0.1 s; rows between two scans repeat its height
OUT_TOGETHER_S, OUT_LEAST_S = 0.35, 0.25    # mirrors are told once for each scan
LOW_M = 0.005                   # smaller changes of a reference are rounding


def texts(language="en"):
    return json.loads(TEXTS.read_text(encoding="utf-8"))[language]


def rounded(value, digits):
    """As text; ties go up, in each language of the two."""
    scale = 10 ** digits
    return f"{math.floor(value * scale + 0.5) / scale:.{digits}f}"


def changes(values):
    """(index, before, now) of each change; before the first value is that value."""
    return [(i, values[i - 1], values[i]) for i in range(1, len(values)) if values[i] != values[i - 1]]


def states(rec, words):
    t, state, ref = rec.t, rec.columns["state"], rec.columns["ref_m"]
    first = [(0, "GROUND", state[0])] if state[0] == "TAKEOFF" else []   # a recorder begins with the take-off
    for i, before, now in first + changes(state):
        if now == "GROUND":
            yield t[i], "landed", words["landed"]
        elif before == "GROUND" and ref[i] > 0:
            yield t[i], "takeoff", words["takeoff"].replace("{ref}", rounded(ref[i], 2))
        elif before == "GROUND":
            yield t[i], "airborne", words["airborne"]
        elif now == "LANDING" and i > 0 and ref[i - 1] > 0 and ref[i] == 0:
            yield t[i], "land", words["land"]
        elif now in words["states"]:
            yield t[i], "state", words["states"][now]


def references(rec, words):
    """A stick moves the reference step by step: that is one event."""
    t, state, ref = rec.t, rec.columns["state"], rec.columns["ref_m"]
    found = []      # [start, end, metres]
    for i, before, now in changes(ref):
        if not now > 0 or not before >= 0 or state[i - 1] == "GROUND" or abs(now - before) <= LOW_M:
            continue
        if found and abs(now - before) < MOVED_M and t[i] - found[-1][1] <= TOGETHER_S:
            found[-1][1:] = [t[i], now]
        else:
            found.append([t[i], t[i], now])
    for start, _, metres in found:
        yield start, "command", words["command"].replace("{ref}", rounded(metres, 2))


def steps(rec):
    """(time, metres) of each edge; what follows in the same direction is the same."""
    t, state, height = rec.t, rec.columns["state"], rec.columns["meas_m"]
    found, last, last_t = [], math.nan, math.nan
    for i, now in enumerate(height):
        if math.isnan(now):
            continue
        gap, step = max(t[i] - last_t, SCAN_S), now - last
        if state[i] != "GROUND" and gap <= SCANS_LOST_S and abs(step) > EDGE_M + EDGE_MPS * gap:
            if found and t[i] - found[-1][2] <= TOGETHER_S and found[-1][1] * step > 0:
                found[-1] = (found[-1][0], found[-1][1] + step, t[i])
            else:
                found.append((t[i], step, t[i]))
        last, last_t = now, t[i]
    return found


def edges(rec, words):
    for t, step, _ in steps(rec):
        kind = "down" if step > 0 else "up"
        yield t, kind, words[kind].replace("{step}", rounded(abs(step), 2))


def stretches(t, values, together_s, least_s=0.0):
    """(start, end, value) of what stands there, each row for so long at least; the same again after a short pause is one."""
    found = []
    for i, value in enumerate(values):
        if value == "":
            continue
        end = max(t[i + 1] if i + 1 < len(t) else t[i], t[i] + least_s)
        if found and found[-1][2] == value and t[i] - found[-1][1] <= together_s:
            found[-1] = (found[-1][0], end, value)
        else:
            found.append((t[i], end, value))
    return found


def told(sentence, start, end, what):
    return sentence.replace("{s}", rounded(end - start, 1)).replace("{what}", what)


def named(rec, words):
    """Doubts, limits in the air, and mirrors that were left out."""
    t, state = rec.t, rec.columns["state"]
    for start, end, reason in stretches(t, rec.columns.get("doubt", []), TOGETHER_S):
        yield start, "doubt", told(words["doubt"], start, end, words["reasons"].get(reason, reason))
    limits = [limit if state[i] != "GROUND" else "" for i, limit in enumerate(rec.columns.get("limit", []))]
    for start, end, limit in stretches(t, limits, TOGETHER_S):
        if end - start >= LIMIT_LEAST_S:
            yield start, "limit", told(words["limit"], start, end, words["limits"].get(limit, limit))
    for start, end, out in stretches(t, rec.columns.get("out", []), OUT_TOGETHER_S, SCAN_S):
        if end - start >= OUT_LEAST_S:
            yield start, "out", told(words["out"], start, end, words["and"].join(words["mirrors"][mirror] for mirror in out.split("+")))


def story(rec, language="en"):
    """[(seconds, kind, sentence)] in the order of time."""
    words = texts(language)
    events = [*states(rec, words), *references(rec, words), *edges(rec, words), *named(rec, words)]
    return sorted(events, key=lambda event: event[0])


def main(arguments):
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        rec = recording.read(arguments[0])
    except (recording.Unreadable, OSError) as error:
        print(f"story: {error}", file=sys.stderr)
        return 2
    print(json.dumps([{"t": t, "kind": kind, "text": text} for t, kind, text in story(rec)], ensure_ascii=False))
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
