"""Laboratory 3: a P law, and the error that it cannot get rid of."""
from criterion import Criterion, all_or_nothing
from law import FLIGHT_MM, at_gravity, figure_mm, holds_between, proportional, rises, scenario, within

TITLE = "a P law"
GRAVITY_N = 7.0
FORESEEN_NEAR_MM = 20       # the flight still swings when it is measured, and a vehicle that tilts lacks a little more


def numbers(draw):
    missing = draw.whole(35, 55, 5)                         # hundredths of a newton
    most = draw.one((90, 100, 110))
    drawn = {"scenario": scenario(f"{GRAVITY_N + missing / 100:.2f}", GRAVITY_N, draw.one((0.7, 0.8, 0.9))), "most_mm": most}
    return drawn, [f"Your vehicle hovers with {GRAVITY_N + missing / 100:.2f} N per motor. GRAV is {GRAVITY_N:.2f} N.",
                   f"It may hover at most {most} mm too low."]


def flies(answer, drawn):
    return all_or_nothing(1, rises(answer.fly(drawn["scenario"])), "it does" if rises(answer.fly(drawn["scenario"])) else "it does not")


def low_mm(answer, drawn):
    return -figure_mm(answer.fly(drawn["scenario"]), "hover_mean_error_mm")


def small(answer, drawn):
    low = low_mm(answer, drawn)
    return all_or_nothing(1, rises(answer.fly(drawn["scenario"])) and -drawn["most_mm"] <= low <= drawn["most_mm"], f"{low} mm too low, at most {drawn['most_mm']} mm")


def foreseen(answer, drawn):
    said, low = FLIGHT_MM * ((answer.foresaw("foreseen_error_mm") // 1000 + FLIGHT_MM // 2) // FLIGHT_MM), low_mm(answer, drawn)
    good = rises(answer.fly(drawn["scenario"])) and abs(said - low) <= FORESEEN_NEAR_MM
    return all_or_nothing(2, good, f"foreseen {said} mm, flown {low} mm, at most {FORESEEN_NEAR_MM} mm apart")


CRITERIA = (
    Criterion(2, "at the reference it asks for GRAV", at_gravity(2), "GRAV is now->parameters->value[PARAMETER_GRAV]: read it, do not write 7."),
    Criterion(2, "the push is in proportion to the error", proportional(2), "Below the reference the error is positive, and more thrust is needed."),
    Criterion(1, "between two heights it asks for what it asked before", holds_between(1), "Look at height->is_new. laws->setpoint_n is what was asked before."),
    Criterion(1, "it stays within 3 N of GRAV", within(1, 3000), "between(least, wanted, most) of control/between.h."),
    Criterion(1, "it flies up to the reference", flies, "make mine FILE=course/03_p/law.c draws the flight."),
    Criterion(1, "the gain is large enough", small, "In the hover the push of the error gives the thrust that GRAV lacks."),
    Criterion(2, "the error is foreseen", foreseen,
              "The thrust that GRAV lacks, divided by your gain; newtons by newtons per metre are metres."),
)
