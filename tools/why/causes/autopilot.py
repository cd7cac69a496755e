"""The autopilot behind the throttle, and the link to the operator."""
import numpy

import vehicle
from causes import imu
from causes.case import Finding

SURE = 3.0                      # nats: few vehicles are set up so
LINK_FLAG = 16
TOLD = 12.0                     # nats: no healthy flight shows that


def mode(case):
    """A climb rate in place of thrust: the same flight by the other equations. What shakes the accelerometer alone is taken out of both:
    a loop that rings would explain that too."""
    if case.model.kind != "THRUST":
        return Finding(0.0)
    nats, hz, _ = imu.shake(case)
    line = {"extra": [imu.lines_of(numpy.array([hz]))], "sigmas": [imu.SHAKE_MPS2] * 2} if nats > 0.0 else {}
    usual = case.again(**line)[1] if line else case.model
    climb = vehicle.fit("CLIMB", case.spans, **line)
    return Finding(climb.score - usual.score - SURE, {"rate": climb.linear_figure("rate"), "neutral": climb.figures["neutral"]}, climb)


def link(case):
    flight = case.flight
    flags = flight.column["flags"].astype(int)
    silent = ((flags & LINK_FLAG) > 0) & (flight.column["state"] != "GROUND")
    if not silent.any():
        return Finding(-5.0)
    at = flight.t_s[silent]
    return Finding(TOLD, {"from": float(at[0])}, None, [(float(at[0]), float(at[-1]))])
