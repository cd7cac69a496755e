"""The causes. Each file has those of one part of the vehicle; TABLE has them all."""
from dataclasses import dataclass
from typing import Callable

from causes import autopilot, floor, forces, imu, rays, settings
from causes import ground as ground_effect


@dataclass(frozen=True)
class Cause:
    name: str
    try_it: Callable            # Case -> Finding
    what: Callable              # Finding -> the first sentence: what happened
    do: Callable                # Finding -> the second: what to do
    without_flight: bool = False        # can also be told of a vehicle that never flew


def said(text):
    return lambda found: text


def late_what(found):
    return f"The rays are {found.words['ms']:.0f} ms older than the firmware believes."


def grav_what(found):
    if found.words["grav"] is None:
        return f"It never lifted off: {found.words['most']:.1f} N were the most that it was given."
    return f"GRAV is {found.words['grav']:.1f} N, and the vehicle hovers with {found.words['hover']:.1f} N."


def grav_do(found):
    if found.words["grav"] is None:
        return "Set GRAV to the hover thrust: #CALIBRATE finds it."
    return f"Set GRAV to {found.words['hover']:.1f}."


def floor_what(found):
    w = found.words
    if not w["count"]:
        return f"The floor under the beam wanders by {w['mm']:.0f} mm rms: it is rough, or has spots of other colours."
    if w.get("alternate"):
        return f"The heights jump {w['count']} times up and down by about {w['mm']:.0f} mm, and the vehicle does not: two colours, or tiles of two heights."
    return f"The heights jump {w['count']} times by about {w['mm']:.0f} mm, and the vehicle does not: edges, or colours of the floor."


def mirrors_of(w):
    """"the aft mirror", "the front and the aft mirror", "all mirrors", "the beam"."""
    names = w.get("mirrors")
    if names is None:
        return "the beam"
    if len(names) == w["of"] > 1:
        return "all mirrors"
    return " and ".join(f"the {name}" for name in names) + " mirror"


def rays_what(found):
    w = found.words
    who = mirrors_of(w)
    if "mm" in w:
        at = " and ".join(f"{mm / 1e3:.2f}" for mm in sorted({round(mm, -1) for mm in w["mm"]}))
        honest = "no mirror saw it" if len(w["mirrors"]) == w["of"] else "the others outvoted it" if w["told"] else "the vote did not find it"
        return (f"From {w['from']:.1f} to {w['to']:.1f} s {who} showed a thing {at} m along its rays, and not the ground; {honest}.")
    if w["blind"] and len(w["mirrors"]) < w["of"]:
        return f"From {w['from']:.1f} s on {who} saw nothing, {w['seconds']:.1f} s in all, while the others did."
    how = f"did not believe its heights ({w['doubts'][0]})" if w["doubts"] else "had no heights"
    seen = "" if "mirrors" not in w else f"; {who} saw nothing" if w["blind"] else f"; {who} showed something else than the ground"
    return f"From {w['from']:.1f} s on the firmware {how}, {w['seconds']:.1f} s in all{seen}."


def rays_do(found):
    w = found.words
    return (f"Look for what stands before {mirrors_of(w)}: a cable, a leg, dirt." if w.get("wrong") else
            "Look at the floor (black, wet, glass), at the mirror and at the scanner's line; type #LASER and #MIRRORS.")


def vibration_what(found):
    w = found.words
    return (f"The accelerometer swings with {w['mps2']:.1f} m/s2 at {w['hz']:.1f} Hz, and the vehicle does not." if w["line"] else
            f"The accelerometer shakes with {w['noise']:.1f} m/s2 rms.")


def ropes_what(found):
    w = found.words
    return (f"Above {w['rope_m']:.2f} m something pulls the vehicle down, as a rope that is too short." if "rope_m" in w else
            f"{w['count']} times something pulled the vehicle down by {w['mps2']:.1f} m/s2, never up.")


TABLE = {
    "late": Cause("rays late", rays.late, late_what, said("Look for what holds the scanner's line back: an adapter, a radio, a lower bit rate.")),
    "grav": Cause("GRAV off", settings.grav, grav_what, grav_do, without_flight=True),
    "hot": Cause("gains too hot", settings.hot, lambda found: f"The loop acts {found.words['times']:.1f} times as hard as on a vehicle that flies well.",
                 said("Lower the gains, or let `make tune VEHICLE=` find them; look whether GAIN is right.")),
    "cold": Cause("gains too cold", settings.cold, lambda found: f"The loop acts only {found.words['times']:.2f} times as hard as on a vehicle that flies well.",
                  said("Raise the gains, or let `make tune VEHICLE=` find them.")),
    "saturation": Cause("thrust at its limits", settings.saturation,
                        lambda found: f"For {found.words['percent']:.0f} % of the time the thrust was at {found.words['range'][0]:.1f} or {found.words['range'][1]:.1f} N.",
                        said("Raise USAT and DSAT.")),
    "floor": Cause("floor", floor.floor, floor_what, said("Fly over another floor; `#TERRAIN IGNORE` lets EST pass over steps.")),
    "rays": Cause("rays blocked or lost", rays.rays, rays_what, rays_do, without_flight=True),
    "vibration": Cause("vibration", imu.vibration, vibration_what, said("Balance the propellers, and mount the IMU softly.")),
    "axes": Cause("IMU axes", imu.axes, lambda found: (f"The heights follow the tilt: {found.words['roll_mm']:.0f} mm for each radian of roll, "
                  f"{found.words['pitch_mm']:.0f} of pitch."), said("Type #IMU RIGHT and #IMU NOSE as it asks: they find IROLL and IPITCH; then see that #SF is the front mirror's middle.")),
    "ropes": Cause("ropes", forces.ropes, ropes_what, said("Give the ropes more slack, and see what else may hold the vehicle.")),
    "pilot": Cause("a pilot", forces.pilot, lambda found: f"From {found.words['from']:.1f} to {found.words['to']:.1f} s the commanded thrust did nothing: somebody else had the throttle.",
                   said("Ask the pilot; wire the selector's pin and set #SEL PIN.")),
    "ground": Cause("ground effect", ground_effect.ground, lambda found: f"Near the ground the thrust carries more: {found.words['times']:.1f} times what is usual.",
                    said("Fly higher, above two rotor diameters.")),
    "battery": Cause("battery", forces.battery, lambda found: f"The hover thrust grew by {found.words['percent']:.0f} % a minute.",
                     said("Charge the battery, or take one that is less worn.")),
    "mode": Cause("autopilot's mode", autopilot.mode, lambda found: f"The throttle commands a climb rate, {found.words['rate']:.2f} m/s for each newton beyond {found.words['neutral']:.1f} N.",
                  lambda found: f"Set #PLANT CLIMB, #CRATE {found.words['rate']:.2f}, #GRAV {found.words['neutral']:.1f}; or put the autopilot in the mode whose throttle is thrust."),
    "link": Cause("link", autopilot.link, lambda found: f"At {found.words['from']:.1f} s the link was silent for longer than #LINK.",
                  said("Fly nearer, or give #LINK more time."), without_flight=True),
}
