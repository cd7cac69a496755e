"""What the laboratories of a control law share: questions to one cycle, and flights.

A flight's figures are rounded to FLIGHT_MM before they are compared, and each bound is a whole number of them: the last digit of a cosine, in which
C libraries differ, does not reach a mark.
"""
from criterion import Refused, all_or_nothing

FLIGHT_MM = 5
NEAR_MN = 5                 # thousandths of a newton: a law in single precision has more
REFERENCE_M = 0.6
GAP_US = 100000             # the scanner's revolution
NEVER_MM = 9999             # a figure that a flight does not have


def cycle(error_mm, rate_mm_s=0, gap_us=GAP_US, new=1, gravity_n=7.0):
    """One cycle: the vehicle is so far below the reference."""
    return f"{REFERENCE_M} {REFERENCE_M * 1000 - error_mm:.0f} {rate_mm_s} {gap_us} {new} {gravity_n}"


def thrusts(answer, cycles):
    """(mN, integral mN) of each cycle, from an empty memory."""
    rows = answer.numbers("law", cycles)
    if len(rows) != len(cycles):
        raise Refused("the law did not answer")
    return rows


def alone(answer, *words, **named):
    """The thrust of a single cycle, mN."""
    return thrusts(answer, [cycle(*words, **named)])[0][0]


def newtons(mn):
    return f"{'-' * (mn < 0)}{abs(mn) // 1000}.{abs(mn) % 1000:03} N"


def near(given, wanted, by=NEAR_MN):
    return abs(given - wanted) <= by


def scenario(hover_n, gravity_n, reference_m=REFERENCE_M, platform=False, more=()):
    """A flight of `plomada fly`, in the words of docs/campaign.md, with a battery that does not sag and in calm air, so that a hover thrust is one number."""
    return "\n".join(["like pid-60cm-ramp", "name lab", "set LAW MINE", f"set GRAV {gravity_n}", f"set plant.hover_thrust {hover_n}",
                      "set plant.sag 0", "set plant.turbulence 0", f"reference {reference_m}", f"platform {'yes' if platform else 'no'}", *more, ""])


def figure_mm(flight, name):
    """Rounded; what a flight does not have is as bad as can be."""
    value = flight[name]
    return NEVER_MM if value is None else FLIGHT_MM * round(value / FLIGHT_MM)


def rises(flight):
    return flight["rise_time_s"] is not None and not flight["failed"]


def at_gravity(points):
    """At the reference, without a climb, a law asks for GRAV."""
    def check(answer, drawn):
        low, high = (alone(answer, 0, gravity_n=gravity) for gravity in (6.5, 7.25))
        return all_or_nothing(points, near(low, 6500) and near(high, 7250), f"GRAV 6.5 gives {newtons(low)}, GRAV 7.25 gives {newtons(high)}")
    return check


def holds_between(points):
    """No new height: what was asked before."""
    def check(answer, drawn):
        first, second = (row[0] for row in thrusts(answer, [cycle(100), cycle(20, new=0, gap_us=0)]))
        moved = near(first, alone(answer, 0))
        told = "no push at all" if moved else f"{newtons(first)}, then {newtons(second)}"
        return all_or_nothing(points, first == second and not moved, told)
    return check


def within(points, most_mn):
    """However large the error is."""
    def check(answer, drawn):
        up, down = alone(answer, 3000), alone(answer, -3000)
        good = up > 7000 > down and up <= 7000 + most_mn + NEAR_MN and down >= 7000 - most_mn - NEAR_MN
        return all_or_nothing(points, good, f"3 m below {newtons(up)}, 3 m above {newtons(down)}")
    return check


def proportional(points):
    """Twice the error, twice the push; as much downwards as upwards."""
    def check(answer, drawn):
        level = alone(answer, 0)
        once, twice, above = (alone(answer, error) - level for error in (50, 100, -100))
        good = once > NEAR_MN and near(twice, 2 * once) and near(above, -twice)
        return all_or_nothing(points, good, f"50 mm below {newtons(once)} more, 100 mm below {newtons(twice)}, 100 mm above {newtons(above)}")
    return check
