"""One picture: the flight with its cause marked, what it would have been without, what is not explained, and how the causes rank."""
import os
import sys

os.environ.setdefault("MPLCONFIGDIR", os.path.join(sys.prefix, "matplotlib"))

import matplotlib
import numpy

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  the backend comes first

MEASURED, REFERENCE, WITHOUT, BEFORE, AFTER = "#1f5fa8", "#333333", "#2a8f4f", "#9aa5b1", "#a0303f"
SHOWN = 6                       # causes


def unexplained(model):
    """(times, standard deviations) of the heights."""
    time_s = numpy.concatenate([span.time_s for span in model.spans])
    high = numpy.concatenate([span.is_height for span in model.spans])
    return time_s[high], model.rest[high]


def draw(path, title, case, ranked, flown):
    """ranked: [(name, Finding)], the likeliest first; flown: of without.fly(), or None."""
    figure, axes = pyplot.subplots(3, 1, figsize=(10, 9), height_ratios=(3, 2, 2), constrained_layout=True)
    c, new, t_s = case.flight.column, case.flight.new, case.flight.t_s
    best = ranked[0][1] if ranked else None
    axes[0].plot(t_s, c["ref_m"], color=REFERENCE, linewidth=0.8, label="reference")
    axes[0].plot(t_s[new], c["meas_m"][new], ".-", markersize=3, linewidth=0.8, color=MEASURED, label="height as measured")
    if flown is not None:
        axes[0].plot(flown[0], flown[1], color=WITHOUT, linewidth=1.2, label="without the cause, by the vehicle as found")
    for begin, end in (best.marks if best else []):
        for axis in axes[:2]:
            axis.axvspan(begin, end, color="#f2c14e", alpha=0.4)
    axes[0].set_title(title, fontsize=10, wrap=True)
    axes[0].set_ylabel("height / m")
    axes[0].legend(loc="lower right", fontsize=8)
    if case.model is not None:
        axes[1].plot(*unexplained(case.model), ".", markersize=4, color=BEFORE, label="without a cause")
        if best and best.model is not None:
            axes[1].plot(*unexplained(best.model), ".", markersize=3, color=AFTER, label="with it")
        axes[1].legend(loc="lower right", fontsize=8)
    axes[1].set_ylim(-8.0, 8.0)
    axes[1].set_ylabel("height not foreseen / \u03c3")
    axes[1].set_xlabel("time of the log / s")
    axes[1].sharex(axes[0])
    names = [name for name, _ in ranked[:SHOWN]][::-1]
    axes[2].barh(names, [max(found.nats, 0.0) for _, found in ranked[:SHOWN]][::-1], color=MEASURED)
    axes[2].set_xscale("symlog", linthresh=10.0)
    axes[2].set_xlabel("how much likelier the flight is with it, nats")
    figure.savefig(path, dpi=110)
    pyplot.close(figure)
