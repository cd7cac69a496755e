#!/usr/bin/env python3
"""check_trace.py FILE...: whether a schedule trace is what it claims to be. Exit 0 when it is, else 1 and the complaints.

Well-formed JSON of Chrome's trace event format, with a name for every track; spans nest on every track; one job at a time on
the processor and one task at a time in a gate; each job runs as much on its own track as on the processor's; nothing runs
while an interrupt waits, and no task while a Swi does; no job runs while it waits at a gate.
"""
import json
import sys
from bisect import bisect_left
from collections import defaultdict

PROCESSOR, JOBS, GATES = 1, 2, 3
TASK = 2
KINDS = ("Hwi", "Swi", "Task")


def kind(track):
    return track // 1000


def nanoseconds(microseconds):
    return round(microseconds * 1000)


class Span:
    def __init__(self, event):
        self.name = event["name"]
        self.begin = nanoseconds(event["ts"])
        self.end = self.begin + nanoseconds(event["dur"])
        self.event = event

    def __str__(self):
        return f"{self.name} {self.begin / 1000:.3f}..{self.end / 1000:.3f}"


def form(events):
    for event in events:
        phase = event.get("ph")
        wanted = {"X": ("ts", "dur", "name", "args"), "i": ("ts", "name", "s"), "M": ("name", "args")}.get(phase)
        if wanted is None:
            yield f"phase {phase!r}: {event}"
        elif any(field not in event for field in (*wanted, "pid", "tid")):
            yield f"a field is missing: {event}"
        elif phase == "X" and event["dur"] < 0:
            yield f"ends before it begins: {event}"


def named(events):
    processes = {event["pid"] for event in events if event["ph"] == "M" and event["name"] == "process_name"}
    threads = {(event["pid"], event["tid"]) for event in events if event["ph"] == "M" and event["name"] == "thread_name"}
    for track in sorted({(event["pid"], event["tid"]) for event in events if event["ph"] != "M"}):
        if track[0] not in processes or track not in threads:
            yield f"track {track} has no name"


def nesting(track, spans):
    stack = []
    for span in sorted(spans, key=lambda span: (span.begin, -span.end)):
        while stack and stack[-1].end <= span.begin:
            stack.pop()
        if stack and span.end > stack[-1].end:
            yield f"track {track}: {span} overlaps {stack[-1]}"
        stack.append(span)


def overlaps(what, spans):
    latest = None
    for span in sorted(spans, key=lambda span: (span.begin, span.end)):
        if latest and span.begin < latest.end and span.end > span.begin:
            yield f"{what}: {span} overlaps {latest}"
        if latest is None or span.end > latest.end:
            latest = span


def runs_of(spans):
    return [span for span in spans if span.name == "runs"]


def jobs_of(spans):
    return [span for span in spans if span.name != "runs" and not span.name.startswith("waits for")]


def processor_time(tracks, names):
    by_name = defaultdict(int)
    for span in tracks[PROCESSOR, 1]:
        by_name[span.name] += span.end - span.begin
    own = defaultdict(int)
    for (group, track), spans in tracks.items():
        if group == JOBS:
            own[names[track]] += sum(run.end - run.begin for run in runs_of(spans))
    for name in sorted(set(by_name) | set(own)):
        if by_name[name] != own[name]:
            yield f"{name}: {by_name[name]} ns on the processor, {own[name]} ns on its track"


def precedence(tracks):
    """No waiting interrupt while a Swi or task runs, no waiting Swi while a task does."""
    runs = sorted(((run.begin, run.end, kind(track), run) for (group, track), spans in tracks.items() if group == JOBS
                   for run in runs_of(spans)), key=lambda run: run[:2])
    begins = [run[0] for run in runs]
    for (group, track), spans in tracks.items():
        if group != JOBS or kind(track) == TASK:
            continue
        for job in jobs_of(spans):
            for begin, end, other, run in runs[max(0, bisect_left(begins, job.begin) - 1):bisect_left(begins, job.end)]:
                if other > kind(track) and min(end, job.end) > max(begin, job.begin):
                    yield f"a {KINDS[other]} {run} while {KINDS[kind(track)]} {job}"


def waiting(track, spans):
    yield from overlaps(f"track {track}, runs and waits",
                        [span for span in spans if span.name == "runs" or span.name.startswith("waits for")])


def complaints(text):
    try:
        events = json.loads(text)["traceEvents"]
    except (ValueError, KeyError, TypeError) as error:
        return [f"not a trace: {error}"]
    found = list(form(events))
    if found:
        return found
    found += named(events)
    if found:
        return found
    names = {event["tid"]: event["args"]["name"].split(" ", 2)[2] for event in events
             if event["ph"] == "M" and event["name"] == "thread_name" and event["pid"] == JOBS}
    tracks = defaultdict(list)
    for event in events:
        if event["ph"] == "X":
            tracks[event["pid"], event["tid"]].append(Span(event))
    if not tracks[PROCESSOR, 1]:
        return found + ["nothing runs"]
    for track, spans in sorted(tracks.items()):
        found += nesting(track, spans)
        if track[0] in (PROCESSOR, GATES):
            found += overlaps(f"track {track}", spans)
        elif track[0] == JOBS:
            found += waiting(track, spans)
    return found + list(processor_time(tracks, names)) + list(precedence(tracks))


def main():
    bad = False
    for path in sys.argv[1:]:
        with open(path, encoding="utf-8") as file:
            for complaint in complaints(file.read())[:20]:
                print(f"{path}: {complaint}")
                bad = True
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
