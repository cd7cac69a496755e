"""Distributions per law, one column of panels per set."""
import os
import sys

os.environ.setdefault("MPLCONFIGDIR", os.path.join(sys.prefix, "matplotlib"))

import table  # noqa: E402

PANELS = (("hover_rms_mm", "hover RMS, mm"), ("overshoot_mm", "overshoot, mm"), ("terrain_rms_mm", "terrain RMS, mm"))
BODY, FAILURE = "#1f5fa8", "#a0303f"


def distribution(axes, groups, name):
    for place, flights in enumerate(groups):
        values = [figures[name] for figures in flights if figures[name] is not None]
        if values:
            axes.boxplot(values, positions=[place], widths=0.6, whis=(5, 95), sym=".", patch_artist=True,
                         boxprops={"facecolor": BODY, "alpha": 0.35}, medianprops={"color": BODY, "linewidth": 2},
                         flierprops={"markersize": 3, "markeredgecolor": BODY})
    axes.set_ylim(bottom=0)
    axes.grid(axis="y", alpha=0.3)


def draw(path, groups, lands):
    """groups: {set: {law: [figures]}}; lands: {set: whether its flights are to land}."""
    import matplotlib
    matplotlib.use("Agg")
    from matplotlib import pyplot

    rows = len(PANELS) + 1
    figure, grid = pyplot.subplots(rows, len(groups), figsize=(1.5 + 4.5 * len(groups), 2.6 * rows), squeeze=False,
                                   sharex="col", layout="constrained")
    for column, (set_name, laws) in enumerate(groups.items()):
        good = [[f for f in flights if not table.failed(f, lands[set_name])] for flights in laws.values()]
        for (name, title), axes in zip(PANELS, grid[:, column], strict=False):
            distribution(axes, good, name)
            axes.set_ylabel(title if column == 0 else "")
        count = next(iter(laws.values()), [])
        grid[0, column].set_title(f"{set_name}, {len(count)} flights per law")
        bottom = grid[-1, column]
        bottom.bar(range(len(laws)), [100.0 * (1 - len(g) / len(f)) for g, f in zip(good, laws.values(), strict=True)],
                   color=FAILURE)
        bottom.set_ylim(0, 100)
        bottom.set_ylabel("failures, %" if column == 0 else "")
        bottom.set_xticks(range(len(laws)), laws.keys(), rotation=30, ha="right")
    figure.savefig(path, dpi=100)
    pyplot.close(figure)
