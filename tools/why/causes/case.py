"""What every cause is given, and what it answers."""
from dataclasses import dataclass, field

import numpy
from scipy.special import log_ndtr

import mirrors
import vehicle


@dataclass
class Case:
    flight: object              # flight.Flight
    spans: list
    model: object               # vehicle.Model of nothing: the likelihood that a cause must beat
    law: object                 # law.Law
    told: object = None         # commanded.Settings, where the firmware flies this log again
    age_s: float = 0.0          # of the rays in `spans`, beside what the firmware believes: within what is usual
    shake: tuple = None         # of causes/imu.py, once it was asked for
    seen: object = None         # mirrors.Liars, once asked for

    def liars(self):
        if self.seen is None:
            self.seen = mirrors.liars(mirrors.scans_of(self.flight))
        return self.seen

    def again(self, spans=None, start=None, **with_cause):
        """The likelihood with a cause, its noises found anew, from those of nothing or from `start`: (nats gained, vehicle.Model)."""
        found = vehicle.fit(self.model.kind, self.spans if spans is None else spans, start or self.model.figures, rounds=6, **with_cause)
        return found.score - self.model.score, found


@dataclass
class Finding:
    nats: float                 # logarithm of the Bayes factor against nothing
    words: dict = field(default_factory=dict)   # for the sentences
    model: object = None        # vehicle.Model with the cause, where it is one of the heights, the forces or the IMU
    marks: list = field(default_factory=list)   # [(begin_s, end_s)] for the picture


def normal(x, sigma):
    return -0.5 * (x / sigma)**2 - numpy.log(sigma)


def wider(x, spread, healthy, faulty):
    """Log Bayes factor of a figure x, known within spread, that healthy vehicles have within `healthy` of 0 and a cause anywhere within `faulty`."""
    return float(normal(x, numpy.hypot(spread, faulty)) - normal(x, numpy.hypot(spread, healthy)))


def even(x, sigma, least, most):
    """Log density of a figure x, known within sigma, that lies anywhere between least and most, equally likely."""
    low, high = (least - x) / sigma, (most - x) / sigma
    if low > 0.0:
        low, high = -high, -low
    above, below = log_ndtr(high), log_ndtr(low)        # of the left tail, where a difference of logarithms keeps its digits
    return float(above + numpy.log1p(-numpy.exp(below - above)) - numpy.log(most - least))
