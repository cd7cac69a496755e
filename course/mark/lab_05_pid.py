"""Laboratory 5: a PID law, whose I finds the thrust that GRAV lacks."""
from criterion import Criterion, all_or_nothing
from law import GAP_US, alone, cycle, figure_mm, holds_between, near, newtons, rises, scenario, thrusts, within

TITLE = "a PID law"
GRAVITY_N = 7.0
MEAN_MOST_MM, OVERSHOOT_MOST_MM = 25, 100
RECOVERY_MOST_S = 3.0


def numbers(draw):
    hovers = [draw.whole(665, 685, 5), draw.whole(695, 710, 5), draw.whole(730, 750, 5)]    # hundredths of a newton
    drawn = {"flights": [scenario(hover / 100, GRAVITY_N) for hover in hovers], "hovers": hovers,
             "edge": scenario(hovers[2] / 100, GRAVITY_N, platform=True)}
    return drawn, [f"Three vehicles: they hover with {hovers[0] / 100}, {hovers[1] / 100} and {hovers[2] / 100} N. GRAV is {GRAVITY_N} N for all.",
                   f"Each may be {MEAN_MOST_MM} mm off in the mean. The last two may rise {OVERSHOOT_MOST_MM} mm above the reference."]


def grown(answer, gap_us, error_mm=50, cycles=10):
    """By how much the thrust grows while the error stays, from the first cycle to the last."""
    rows = thrusts(answer, [cycle(error_mm, gap_us=gap_us)] * cycles)
    return rows[-1][0] - rows[0][0]


def grows(answer, drawn):
    up, down = grown(answer, GAP_US), grown(answer, GAP_US, error_mm=-50)
    return all_or_nothing(2, up > 20 and near(up, -down), f"50 mm below for 0.9 s {newtons(up)} more, 50 mm above {newtons(down)}")


def by_time(answer, drawn):
    once, twice = grown(answer, 50000), grown(answer, 100000)
    return all_or_nothing(1, once > 10 and near(twice, 2 * once), f"ten times 0.05 s {newtons(once)}, ten times 0.1 s {newtons(twice)}")


def kept(answer, drawn):
    """What the firmware clears is the integral: after that the first thrust comes again."""
    lines = [cycle(50)] * 10
    rows = answer.numbers("law", [*lines, "again", *lines])
    cleared = len(rows) == 20 and rows[9][1] != 0 and rows[:10] == rows[10:]
    return all_or_nothing(1, cleared, f"after 1 s it holds {newtons(rows[9][1])}" if len(rows) == 20 else "no answer")


def means(answer, drawn):
    flights = [answer.fly(text) for text in drawn["flights"]]
    offs = [figure_mm(flight, "hover_mean_error_mm") for flight in flights]
    good = all(rises(flight) and abs(off) <= MEAN_MOST_MM for flight, off in zip(flights, offs))
    return all_or_nothing(2, good, ", ".join(f"{hover / 100} N {off} mm" for hover, off in zip(drawn["hovers"], offs)))


def overshoots(answer, drawn):
    flights = [answer.fly(text) for text in drawn["flights"][1:]]
    overs = [figure_mm(flight, "overshoot_mm") for flight in flights]
    good = all(rises(flight) for flight in flights) and max(overs) <= OVERSHOOT_MOST_MM
    return all_or_nothing(1, good, ", ".join(f"{hover / 100} N {over} mm" for hover, over in zip(drawn["hovers"][1:], overs)))


def recovers(answer, drawn):
    flight = answer.fly(drawn["edge"])
    tenths = 999 if flight["recovery_s"] is None or not rises(flight) else round(10 * flight["recovery_s"])
    return all_or_nothing(1, tenths <= 10 * RECOVERY_MOST_S, f"{tenths / 10} s, at most {RECOVERY_MOST_S} s")


CRITERIA = (
    Criterion(2, "a lasting error adds up, in both directions", grows, "Each new height adds KI times error times gap_s."),
    Criterion(1, "it adds up by time, not by cycles", by_time, "Multiply by gap_s: heights may be lost, and gaps may differ."),
    Criterion(1, "the integral is kept where the firmware clears it", kept, "Keep it in laws->pid.integral_n, not in a static variable."),
    Criterion(1, "between two heights it asks for what it asked before", holds_between(1), "Given with the file: keep it."),
    Criterion(1, "it stays within 3 N of GRAV", within(1, 3000), "Limit the sum of all parts."),
    Criterion(2, "the error is gone in the hover", means, "A larger KI finds the missing thrust sooner."),
    Criterion(1, "the overshoot", overshoots, "On the way up the error is large for a second. Let the integral wait until the vehicle is near."),
    Criterion(1, "after the edge of 25 cm it is back", recovers, "The edge is a sudden error: what the integral adds then must be taken away again."),
)
