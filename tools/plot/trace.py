#!/usr/bin/env python3
"""trace.py TRACE [-o PNG]: draws one scan's way to the throttle pulse.

TRACE is a schedule of `plomada fly --trace`. Of the scans that changed the pulse, the one whose answer took longest is
drawn: above, from the frame on the wire to the new pulse; below, what the processor did between the frame's last octet and
the new compare value. The path of the picture is printed. Exit 2 when TRACE cannot be read or holds no such scan.
"""
import argparse
import json
import os
import sys
from pathlib import Path

os.environ.setdefault("MPLCONFIGDIR", os.path.join(sys.prefix, "matplotlib"))

PROCESSOR, JOBS, GATES, WIRES = 1, 2, 3, 4
FRAMES, COMPARES, PULSES = 1, 2, 3
TRACKS_PER_KIND = 1000
COLOURS = {"Hwi": "#8a8a8a", "Laser_SWI": "#e07a1f", "TaskReceiveLaser": "#1f5fa8", "TaskControl": "#a0303f"}
OTHER_COLOUR = "#b9c4cf"
WAITS, GATE, WIRE = "#f2d9a0", "#5fa8a8", "#333333"
WRITTEN = "#a0303f"


class Unreadable(Exception):
    pass


class Trace:
    def __init__(self, path):
        try:
            events = json.loads(Path(path).read_text(encoding="utf-8"))["traceEvents"]
            self.spans = [event for event in events if event["ph"] == "X"]
            self.answers = [event for event in events
                            if event["ph"] == "i" and (event["pid"], event["tid"]) == (WIRES, COMPARES)]
            self.names = {(event["pid"], event["tid"]): event["args"]["name"] for event in events
                          if event["ph"] == "M" and event["name"] == "thread_name"}
        except (ValueError, KeyError, TypeError) as error:
            raise Unreadable(f"{path}: not a trace of `plomada fly --trace`") from error

    def on(self, group, track=None):
        return [span for span in self.spans if span["pid"] == group and track in (None, span["tid"])]


def end(span):
    return span["ts"] + span["dur"]


def scan_to_draw(trace):
    """(frame, answer, the last old pulse and the first new one) of the longest way."""
    frames = {round(end(frame), 3): frame for frame in trace.on(WIRES, FRAMES)}
    pulses = sorted(trace.on(WIRES, PULSES), key=lambda pulse: pulse["ts"])
    for answer in sorted(trace.answers, key=lambda answer: -answer["args"]["after_scan_us"]):
        frame = frames.get(round(answer["ts"] - answer["args"]["after_scan_us"], 3))
        new = next((place for place, pulse in enumerate(pulses) if pulse["ts"] >= answer["ts"]), 0)
        if frame and new and pulses[new]["args"]["changed"]:
            return frame, answer, pulses[new - 1:new + 1]
    raise Unreadable("no scan that changed the pulse")


def colour_of(name, is_hwi):
    return COLOURS["Hwi"] if is_hwi else COLOURS.get(name, OTHER_COLOUR)


def bar(axis, row, begin, finish, colour, height=0.64, linewidth=0.0):
    axis.broken_barh([(begin, finish - begin)], (row - height / 2, height), color=colour, linewidth=linewidth)


def within(spans, window):
    return [span for span in spans if end(span) > window[0] and span["ts"] < window[1]]


def draw_overview(axis, trace, zero, frame, answer, pulses, window):
    """Frame, processor and pin; times in ms from the frame's last octet."""
    def ms(microseconds):
        return (microseconds - zero) / 1000

    hwis = {name.split(" ", 2)[2] for (group, track), name in trace.names.items()
            if group == JOBS and track < TRACKS_PER_KIND}
    bar(axis, 3, ms(frame["ts"]), ms(end(frame)), WIRE)
    axis.text(ms(frame["ts"]) + (ms(end(frame)) - ms(frame["ts"])) / 2, 3, f"{frame['args']['octets']} octets", color="white",
              ha="center", va="center", fontsize=8.5)
    for run in within(trace.on(PROCESSOR), window):
        bar(axis, 2, ms(run["ts"]), ms(end(run)), colour_of(run["name"], run["name"] in hwis),
            linewidth=0.3 if run["name"] in hwis else 0.0)   # else too thin for a pixel
    axis.plot([ms(answer["ts"])] * 2, [-0.5, 3.6], color=WRITTEN, linewidth=1, linestyle="--")
    axis.text(ms(answer["ts"]) + 0.12, 2.55, f"{answer['name']} written", color=WRITTEN, fontsize=8.5, va="center")
    levels_t, levels = [ms(window[0])], [0]
    for pulse in pulses:
        for when, level in ((pulse["ts"], 1), (end(pulse), 0)):
            levels_t += [ms(when)] * 2
            levels += [levels[-1], level]
    axis.plot(levels_t + [ms(window[1])], [0.1 + 0.9 * level for level in levels + [0]], color=WIRE, linewidth=1.4)
    for pulse in pulses:
        axis.text(ms(end(pulse)) + 0.15, 0.72, pulse["name"].replace("us", "µs"), fontsize=8.5, va="center",
                  color=WRITTEN if pulse is pulses[-1] else WIRE,
                  fontweight="bold" if pulse is pulses[-1] else "normal")
    axis.set_yticks([3, 2, 0.5], ["scanner's wire", "processor", "throttle pin"])
    axis.set_ylim(-0.2, 3.6)
    axis.set_xlim(ms(window[0]), ms(window[1]))


def rows_of(trace, window):
    """Label and spans of each row: all interrupts in one, then the Swis and tasks that ran, then the gates they held."""
    jobs = [span for span in within(trace.on(JOBS), window)]
    rows = [("interrupts", JOBS, [span for span in jobs if span["tid"] < TRACKS_PER_KIND and span["name"] == "runs"])]
    tracks = sorted({span["tid"] for span in jobs if span["tid"] >= TRACKS_PER_KIND and span["dur"] > 0},
                    key=lambda track: (track // TRACKS_PER_KIND, -int(trace.names[JOBS, track].split(" ")[1])))
    for track in tracks:
        rows.append((trace.names[JOBS, track].split(" ", 2)[2], JOBS, [span for span in jobs if span["tid"] == track]))
    held = within(trace.on(GATES), window)
    for track in sorted({span["tid"] for span in held}):
        rows.append((trace.names[GATES, track], GATES, [span for span in held if span["tid"] == track]))
    return rows


def draw_row(axis, row, label, group, spans, zero, zoom_end):
    for span in sorted(spans, key=lambda span: -span["dur"]):
        begin, finish = (span["ts"] - zero) / 1000, (end(span) - zero) / 1000
        if group == GATES:
            bar(axis, row, begin, finish, COLOURS.get(span["name"], GATE), 0.5)
        elif span["name"] == "runs":
            bar(axis, row, begin, finish, colour_of(label, label == "interrupts"))
        elif span["name"].startswith("waits for"):
            bar(axis, row, begin, finish, WAITS)
        else:
            axis.plot([begin, finish], [row - 0.4] * 2, color="#555555", linewidth=0.9)
            axis.plot([begin, begin], [row - 0.4, row - 0.28], color="#555555", linewidth=0.9)
            axis.plot([finish, finish], [row - 0.4, row - 0.28], color="#555555", linewidth=0.9)
            if label in COLOURS and finish < (zoom_end - zero) / 1000:
                axis.text(finish + 0.015, row, f"{finish - begin:.3f} ms", va="center", fontsize=8, color="#333333")


def draw_zoom(axis, trace, zero, answer, window):
    rows = rows_of(trace, window)
    for index, (label, group, spans) in enumerate(rows):
        draw_row(axis, -index, label, group, spans, zero, window[1])
    written = (answer["ts"] - zero) / 1000
    axis.axvline(0, color=WIRE, linewidth=1, linestyle="--")
    axis.axvline(written, color=WRITTEN, linewidth=1, linestyle="--")
    axis.annotate("", (written, 0.75), (0, 0.75), arrowprops={"arrowstyle": "<->", "color": WRITTEN, "linewidth": 1})
    axis.text(written / 2, 0.82, f"{written:.3f} ms to the compare value", ha="center", va="bottom", fontsize=9, color=WRITTEN)
    axis.set_yticks(range(0, -len(rows), -1), [label for label, _, _ in rows])
    axis.set_ylim(-len(rows) + 0.4, 1.3)
    axis.set_xlim((window[0] - zero) / 1000, (window[1] - zero) / 1000)
    axis.set_xlabel("ms from the last octet of the scan; brackets go from a job's release to its end", fontsize=9)


def draw(trace, path):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    frame, answer, pulses = scan_to_draw(trace)
    zero = end(frame)
    overview = (min(frame["ts"], pulses[0]["ts"]) - 700, end(pulses[1]) + 2600)
    zoom = (zero - 150, answer["ts"] + 250)
    plt.rcParams.update({"font.size": 9, "axes.spines.top": False, "axes.spines.right": False})
    rows = len(rows_of(trace, zoom))
    figure, (above, below) = plt.subplots(2, 1, figsize=(9.5, 3.6 + 0.34 * rows), dpi=130,
                                          gridspec_kw={"height_ratios": [2.0, 0.28 * rows + 0.7]}, layout="constrained")
    figure.suptitle("From a scan's last octet to the changed pulse", fontsize=11)
    draw_overview(above, trace, zero, frame, answer, pulses, overview)
    draw_zoom(below, trace, zero, answer, zoom)
    for axis in (above, below):
        axis.tick_params(axis="y", length=0, labelsize=8.5)
        axis.grid(axis="x", color="#e4e4e4", linewidth=0.6)
        axis.set_axisbelow(True)
    figure.savefig(path)
    plt.close(figure)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("trace", metavar="TRACE")
    parser.add_argument("-o", "--output", metavar="PNG")
    options = parser.parse_args(arguments)
    path = Path(options.output or Path(options.trace).with_suffix(".png"))
    try:
        draw(Trace(options.trace), path)
    except (Unreadable, OSError) as error:
        print(f"trace: {error}", file=sys.stderr)
        return 2
    print(path.resolve())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
