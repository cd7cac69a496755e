"""What every cause is given, and what it answers."""
from dataclasses import dataclass, field

import numpy

import vehicle


@dataclass
class Case:
    flight: object              # flight.Flight
    spans: list
    model: object               # vehicle.Model of nothing: the likelihood that a cause must beat
    law: object                 # law.Law

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
