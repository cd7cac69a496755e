"""Laboratory 6: the windup, and an end of it."""
from criterion import Criterion, all_or_nothing
from law import alone, cycle, figure_mm, near, newtons, rises, scenario, thrusts

TITLE = "the windup"
GRAVITY_N = 7.0
LIMIT_MN = 1000             # ASCENSION_N and DESCENSION_N of the file
WOUND_MOST_MN = 500         # what may be added before the limit is reached
OVERSHOOT_MOST_MM, MEAN_MOST_MM = 100, 25


def numbers(draw):
    hover, reference = draw.whole(715, 740, 5), draw.one((1.4, 1.5, 1.6))
    drawn = {"scenario": scenario(hover / 100, GRAVITY_N, reference), "seconds": draw.whole(4, 9)}
    return drawn, [f"Your vehicle hovers with {hover / 100} N, GRAV is {GRAVITY_N} N, the reference is {reference} m.",
                   f"In the questions the error is too large for {drawn['seconds']} s."]


def adds(answer, drawn):
    rows = thrusts(answer, [cycle(20)] * 5)
    grown = rows[-1][0] - rows[0][0]
    return all_or_nothing(1, near(grown, 24), f"20 mm below for 0.4 s {newtons(grown)} more, wanted {newtons(24)}")


def wound(answer, drawn, error_mm):
    return thrusts(answer, [cycle(error_mm)] * (10 * drawn["seconds"]))[-1][1]


def full(points, error_mm):
    def check(answer, drawn):
        held = wound(answer, drawn, error_mm)
        return all_or_nothing(points, abs(held) <= WOUND_MOST_MN, f"the integral holds {newtons(held)}, at most {newtons(WOUND_MOST_MN)} to either side")
    return check


def leaves(answer, drawn):
    """The error has changed its sign: the thrust leaves the limit in the same cycle."""
    last = thrusts(answer, [cycle(400)] * (10 * drawn["seconds"]) + [cycle(-100)])[-1][0]
    return all_or_nothing(1, last < 7000 + LIMIT_MN - 100, f"100 mm above the reference it asks for {newtons(last)}")


def comes_back(answer, drawn):
    """The thrust is at its upper limit by the D; the error is negative, so the integral must shrink."""
    rows = thrusts(answer, [cycle(60)] * 4 + [cycle(-30, rate_mm_s=-900)] * 10)
    lost = rows[3][1] - rows[-1][1]
    return all_or_nothing(1, lost > 50, f"at the upper limit, 30 mm above the reference, in 1 s the integral loses {newtons(lost)}")


def limited(answer, drawn):
    up, down = alone(answer, 3000), alone(answer, -3000)
    return all_or_nothing(1, near(up, 7000 + LIMIT_MN) and near(down, 7000 - LIMIT_MN), f"3 m below {newtons(up)}, 3 m above {newtons(down)}")


def overshoot(answer, drawn):
    flight = answer.fly(drawn["scenario"])
    over = figure_mm(flight, "overshoot_mm")
    return all_or_nothing(2, rises(flight) and over <= OVERSHOOT_MOST_MM, f"{over} mm, at most {OVERSHOOT_MOST_MM} mm"
                          if rises(flight) else "it did not fly up to it")


def mean(answer, drawn):
    flight = answer.fly(drawn["scenario"])
    off = figure_mm(flight, "hover_mean_error_mm")
    return all_or_nothing(1, rises(flight) and abs(off) <= MEAN_MOST_MM, f"{off} mm, at most {MEAN_MOST_MM} mm")


CRITERIA = (
    Criterion(1, "inside the limits the integral adds up as ever", adds, "Only at a limit may it stand still."),
    Criterion(1, "the thrust keeps its limits", limited, "between(GRAV - DESCENSION_N, ..., GRAV + ASCENSION_N)."),
    Criterion(2, "at the upper limit it does not grow", full(2, 400), "Ask first: is the thrust beyond the limit, and would the integral push it further?"),
    Criterion(1, "at the lower limit it does not grow", full(1, -400), "The same with the other sign."),
    Criterion(1, "it leaves the limit at once", leaves, "When the integral has wound up, it takes seconds until the error has unwound it."),
    Criterion(1, "at a limit it may come back", comes_back, "An integral that stands still at a limit in both directions cannot shrink there."),
    Criterion(2, "the overshoot in flight", overshoot, "Draw the flight by make mine FILE=course/06_windup/law.c, before and after."),
    Criterion(1, "the mean error in flight", mean, "Without any integral the thrust that GRAV lacks is missing."),
)
