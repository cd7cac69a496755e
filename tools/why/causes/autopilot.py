"""The autopilot behind the throttle, and the link to the operator."""
import numpy

import model as physics
import vehicle
from causes.case import Finding, wider
from vehicle import G

STEEP, STEEP_FAULTY = 0.16, 0.6 # logarithm of the throttle's effect, 1: as its hover thrust tells
LOOK_AGAIN = 0.12               # beyond that both kinds of throttle are fitted
FAR_OFF = 5.0                   # nats by which a quick look at a climb rate may be worse
SURE = 3.0
LINK_FLAG = 16
TOLD = 12.0                     # nats: no healthy flight shows that


def stretch_of(span):
    return physics.Stretch(span.grid_s, span.thrust_n, span.upright, span.height_m, span.ray_s, span.ray_m, span.frame_s, span.up, span.begin)


def mode(case):
    """A climb rate in place of thrust: the prediction-error fit of both kinds (tools/fit)."""
    model = case.model
    if model.kind != "THRUST":
        return Finding(0.0)
    effect = float(numpy.log(max(model.linear_figure("authority") * model.hover_n() / G, 0.05)))
    steep = wider(effect, 0.08, STEEP, STEEP_FAULTY)
    if effect < LOOK_AGAIN and vehicle.fit("CLIMB", case.spans).score < model.score - FAR_OFF:
        return Finding(-3.0)
    stretches = [stretch_of(span) for span in case.spans if len(span.ray_s) > 20 and len(span.frame_s) > 100]
    if not stretches:
        return Finding(steep)
    thrust, climb = (physics.fit(kind, stretches) for kind in ("THRUST", "CLIMB"))
    better = 0.5 * (thrust.loss - climb.loss)
    found = Finding(better - SURE, {"rate": climb.figures["climb_rate"], "neutral": climb.figures["climb_neutral"], "effect": float(numpy.exp(effect))})
    return found


def link(case):
    flight = case.flight
    flags = flight.column["flags"].astype(int)
    silent = ((flags & LINK_FLAG) > 0) & (flight.column["state"] != "GROUND")
    if not silent.any():
        return Finding(-5.0)
    at = flight.t_s[silent]
    return Finding(TOLD, {"from": float(at[0])}, None, [(float(at[0]), float(at[-1]))])
