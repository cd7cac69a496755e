"""What the fitted model says of the flight: acceleration from the commands beside the measured one, and the heights that it did
not foresee, in standard deviations."""
import os
import sys

os.environ.setdefault("MPLCONFIGDIR", os.path.join(sys.prefix, "matplotlib"))

import matplotlib
import numpy

import model

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402  the backend comes first

SMOOTH = 5                      # frames: the accelerometer shakes far more than the vehicle


def smooth(values):
    return numpy.convolve(values, numpy.ones(SMOOTH) / SMOOTH, mode="same") if len(values) > SMOOTH else values


def draw_stretch(axes, stretch, found, label):
    """The three rows of one stretch. label: only the first stretch names its lines."""
    names = {"measured": "measured", "model": "by the commands alone", "height": "height"} if label else {}
    speed, push = (rows[0] for rows in model.MOTION[found.kind](stretch, [found.figures]))
    events, errors, variances = model.innovations(stretch, found.kind, [found.figures])
    sigmas = errors[:, 0] / numpy.sqrt(variances[:, 0])
    heights = events.is_height & numpy.isfinite(sigmas)

    axes[0].plot(stretch.ray_s, stretch.ray_height_m, ".", markersize=2, color="#1d3557", label=names.get("height"))
    axes[1].plot(stretch.frame_s, smooth(stretch.up_mps2 - found.figures["acc_bias"]), color="#9aa5b1", linewidth=0.8,
                 label=names.get("measured"))
    axes[1].plot(stretch.grid_s, push, color="#d1495b", linewidth=1.0, label=names.get("model"))
    axes[2].plot(events.time_s[heights], sigmas[heights], ".", markersize=3, color="#1d3557")
    return speed


def draw(path, vehicle, found, stretches):
    """path: PNG. vehicle, found, stretches: as fit.fit_logs() gives them."""
    figure, axes = pyplot.subplots(3, 1, figsize=(10, 8), sharex=True, constrained_layout=True)
    for number, stretch in enumerate(stretches):
        draw_stretch(axes, stretch, found, number == 0)
    gain, response = vehicle["authority"], vehicle["response"]
    axes[0].set_title(f"The throttle commands {vehicle['throttle']}: authority {gain['value']:.2f} [{gain['low']:.2f} .. "
                      f"{gain['high']:.2f}], lag and dead time {1e3 * response['value']:.0f} [{1e3 * response['low']:.0f} .. "
                      f"{1e3 * response['high']:.0f}] ms")
    axes[0].set_ylabel("height / m")
    axes[1].set_ylabel("acceleration / m/s²")
    axes[1].legend(loc="upper right", fontsize=8)
    axes[2].axhspan(-1.64, 1.64, color="#e9ecef", label="90 % of the heights belong here")
    axes[2].set_ylim(-5.0, 5.0)
    axes[2].set_ylabel("height not foreseen / σ")
    axes[2].set_xlabel("time of the log / s")
    axes[2].legend(loc="upper right", fontsize=8)
    figure.savefig(path, dpi=110)
    pyplot.close(figure)
