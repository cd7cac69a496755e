"""Laboratory 2: the height from one mirror at a tilt. The product's altitude_under_mirror() is the reference."""
from criterion import Criterion, all_or_nothing, shared

TITLE = "the tilt correction"
NEAR_UM = 1000              # a millimetre: what the scanner can tell
ERROR_NEAR_UM = 2000        # a prediction on paper, rounded to millimetres on its way
CASES = 6


def geometry(draw):
    return draw.whole(95, 125, 5), draw.whole(80, 120, 5), draw.whole(200, 240, 5)


def tilts(draw, rolls, pitches):
    d, leg, arm = geometry(draw)
    return [(d, leg, arm, 0, draw.whole(400, 2000), draw.one(rolls), draw.one(pitches)) for _ in range(CASES)]


def aside(draw):
    d, leg, arm = geometry(draw)
    return [(d, leg, arm, sign, draw.whole(400, 2000), draw.one(ANGLES), draw.one(ANGLES)) for sign in (1, -1) * (CASES // 2)]


ANGLES = (-210, -140, -90, -50, 50, 90, 140, 210)      # thousandths of a radian, 3 to 12 degrees


def numbers(draw):
    d, leg, arm = geometry(draw)
    roll, height = draw.whole(90, 210, 10), draw.whole(500, 1000, 10)
    drawn = {"level": tilts(draw, (0,), (0,)), "roll": tilts(draw, ANGLES, (0,)), "pitch": tilts(draw, (0,), ANGLES),
             "both": tilts(draw, ANGLES, ANGLES), "aside": aside(draw), "foreseen": (d, leg, arm, 0, height + d + leg, roll, 0)}
    return drawn, [f"The front mirror (s = 0) has d = {d} mm, l = {leg} mm, L = {arm} mm.",
                   f"The way of the ray is {height + d + leg} mm, the roll {roll / 1000} rad, the pitch 0.",
                   "foreseen_error_mm: the height without the roll, minus the height with it."]


def heights(points, which):
    def check(answer, drawn):
        rows = answer.numbers("height", [" ".join(map(str, case)) for case in drawn[which]])
        good = sum(abs(given - right) < NEAR_UM for given, right in rows)
        wrong = next((f"; d {d} l {leg} L {arm} s {s}, ray {y} mm, roll {roll / 1000}, pitch {pitch / 1000}: {mm(given)}, not {mm(right)} mm"
                      for (d, leg, arm, s, y, roll, pitch), (given, right) in zip(drawn[which], rows) if abs(given - right) >= NEAR_UM), "")
        return shared(points, good, len(rows), f"{good} of {len(rows)}{wrong}")
    return check


def mm(um):
    """Rounded to whole millimetres, half away from zero."""
    return (abs(um) + 500) // 1000 * (1 if um >= 0 else -1)


def foreseen(answer, drawn):
    d, leg, _, _, slant, _, _ = drawn["foreseen"]
    [[_, right]] = answer.numbers("height", [" ".join(map(str, drawn["foreseen"]))])
    given, wanted = answer.foresaw("foreseen_error_mm"), (slant - d - leg) * 1000 - right
    return all_or_nothing(2, abs(given - wanted) <= ERROR_NEAR_UM, f"{mm(given)} mm is " + ("right" if abs(given - wanted) <= ERROR_NEAR_UM else "wrong"))


CRITERIA = (
    Criterion(1, "level", heights(1, "level"), "The ray goes d to the mirror, then down to the ground, l deeper than the landing gear."),
    Criterion(2, "roll alone", heights(2, "roll"), "Two things: the ray is oblique, a cosine; and the arm L goes up with its side, a sine."),
    Criterion(2, "pitch alone", heights(2, "pitch"), "The front mirror lies on the pitch axis: only the cosine."),
    Criterion(1, "both at once", heights(1, "both"), "The oblique ray gets both cosines; L sin(roll) stays as it is."),
    Criterion(2, "the side mirrors", heights(2, "aside"), "They lie d before (s = +1) or behind (s = -1) the pitch axis: one sine more."),
    Criterion(2, "the error foreseen", foreseen, "Compute the height with the roll and with roll 0 on paper. Subtract."),
)
