"""Laboratory 4: a PD law, whose D ends the swinging."""
from criterion import Criterion, all_or_nothing
from law import NEAR_MN, alone, at_gravity, figure_mm, holds_between, near, newtons, proportional, rises, scenario, within

TITLE = "a PD law"
OVERSHOOT_MOST_MM, SWING_MOST_MM = 50, 30
THRUST_MOST_MN = 350        # the deviation of the thrust: a D that is too large turns the noise of the heights into noise of the motors


def numbers(draw):
    hover = draw.whole(700, 740, 5)
    drawn = {"scenario": scenario(hover / 100, hover / 100, draw.one((0.7, 0.8, 0.9, 1.0)))}
    return drawn, [f"Your vehicle hovers with {hover / 100} N per motor, and GRAV is so much.",
                   f"It may rise at most {OVERSHOOT_MOST_MM} mm above the reference, and swing by {SWING_MOST_MM} mm (rms)."]


def push(answer, rate):
    return alone(answer, 0, rate) - alone(answer, 0)


def brakes(answer, drawn):
    once, twice = push(answer, 100), push(answer, 200)
    return all_or_nothing(2, once < -NEAR_MN and near(twice, 2 * once), f"0.1 m/s upwards {newtons(once)}, 0.2 m/s {newtons(twice)}")


def carries(answer, drawn):
    up, down = push(answer, 100), push(answer, -100)
    return all_or_nothing(1, down > NEAR_MN and near(down, -up), f"0.1 m/s downwards {newtons(down)}")


def overshoot(answer, drawn):
    flight = answer.fly(drawn["scenario"])
    over = figure_mm(flight, "overshoot_mm")
    return all_or_nothing(1, rises(flight) and over <= OVERSHOOT_MOST_MM, f"{over} mm" if rises(flight) else "it did not fly up to it")


def swing(answer, drawn):
    flight = answer.fly(drawn["scenario"])
    rms = figure_mm(flight, "hover_rms_mm")
    return all_or_nothing(1, rises(flight) and rms <= SWING_MOST_MM, f"{rms} mm" if rises(flight) else "it did not fly up to it")


def quiet(answer, drawn):
    flight = answer.fly(drawn["scenario"])
    mn = 10 * round(100 * flight["thrust_std_n"])
    return all_or_nothing(1, rises(flight) and mn <= THRUST_MOST_MN, f"{newtons(mn)}, at most {newtons(THRUST_MOST_MN)}" if rises(flight)
                          else "it did not fly up to it")


CRITERIA = (
    Criterion(1, "at the reference it asks for GRAV", at_gravity(1), "As in laboratory 3, when it does not climb."),
    Criterion(1, "the push is in proportion to the error", proportional(1), "As in laboratory 3."),
    Criterion(2, "a climb takes thrust away, in proportion", brakes, "climb_mps is positive upwards. So its push has a minus."),
    Criterion(1, "a descent adds as much", carries, "One formula for both directions; no if."),
    Criterion(1, "between two heights it asks for what it asked before", holds_between(1), "As in laboratory 3."),
    Criterion(1, "it stays within 3 N of GRAV", within(1, 3000), "Limit the sum, not the parts."),
    Criterion(1, "the overshoot in flight", overshoot, "More KD brakes earlier."),
    Criterion(1, "the swing in flight", swing, "Too little KD swings. Too much swings too, because the climb is old when it comes."),
    Criterion(1, "the motors are quiet: deviation of the thrust", quiet, "The D multiplies the noise of the climb. Take no more of it than you need."),
)
