"""Laboratory 9: height and speed from an accelerometer and late heights. The world is played in whole steps of IEEE arithmetic: no library
function whose last digit depends on the machine."""
import math

from criterion import Criterion, all_or_nothing

TITLE = "estimation"
STEP_S, STEPS_A_HEIGHT = 0.025, 4
START_M = 2.0               # it moves about this height, within the reach of the scanner
AGE_STEPS = 4               # a height is 0.1 s old when it comes
SECONDS = 40
SETTLED_S = 20
OUTAGES_S = (25, 30, 35)
OUTAGE_MOST_MM = 150


def accelerations(draw, seconds):
    """Pieces of half a second that keep the vehicle between the floor and the ceiling."""
    speed, away, found = 0.0, 0.0, []
    for _ in range(2 * seconds):
        wish = draw.whole(-12, 12) / 10.0 - 0.8 * speed - 0.6 * away
        for _ in range(20):
            found.append(wish)
            away, speed = away + speed * STEP_S + 0.5 * wish * STEP_S * STEP_S, speed + wish * STEP_S
    return found


def world(draw, seconds, bias, noise_mps2, noise_m):
    """[(acceleration shown, height shown or None, true height, true speed)] of each step."""
    speed, height, heights, rows = 0.0, START_M, [], []
    for at, up in enumerate(accelerations(draw, seconds)):
        height, speed = height + speed * STEP_S + 0.5 * up * STEP_S * STEP_S, speed + up * STEP_S
        heights.append(height)
        seen = at % STEPS_A_HEIGHT == 0 and at >= AGE_STEPS
        shown = round(1000.0 * (heights[at - AGE_STEPS] + draw.noise(noise_m))) / 1000.0 if seen else None
        rows.append((up + bias + draw.noise(noise_mps2), shown, height, speed))
    return rows


def numbers(draw):
    bias = draw.one((-0.4, -0.3, 0.3, 0.4))
    drawn = {"still": [(0.0, 0.8 if at % 4 == 0 else None, 0.8, 0.0) for at in range(400)], "plain": world(draw, 10, 0.0, 0.0, 0.0),
             "noisy": world(draw, SECONDS, 0.0, 0.15, 0.012), "biased": world(draw, SECONDS, bias, 0.15, 0.012)}
    return drawn, ["A height comes every 0.1 s, is 0.1 s old, and has a noise of 12 mm.", "The accelerometer has a noise of 0.15 m/s2.",
                   f"In the last flight it shows {bias} m/s2 too much."]


def flown(answer, rows, blind=()):
    """[(height, speed)] that the answer holds after each step; no height comes in the steps of blind."""
    steps = [["new", "Estimator"]]
    for at, (up, shown, _, _) in enumerate(rows):
        steps.append(["method", "predict", [up, STEP_S]])
        if shown is not None and not any(begin <= at < end for begin, end in blind):
            steps.append(["method", "correct", [shown, AGE_STEPS * STEP_S]])
        steps += [["member", "height_m"], ["member", "speed_mps"]]
    members = [found for step, found in zip(steps, answer.ask(steps)) if step[0] == "member"]
    good = all(isinstance(one, (int, float)) and abs(one) < 1e6 for one in members)
    return list(zip(members[::2], members[1::2])) if good else [(999.0, 999.0)] * len(rows)


def rms_mm(errors):
    """In whole thousandths."""
    return round(1000.0 * math.sqrt(math.fsum(one * one for one in errors) / len(errors)))


def late(rows):
    return int(SETTLED_S / STEP_S) if len(rows) > SETTLED_S / STEP_S else len(rows) // 2


def errors_mm(answer, rows, which, blind=()):
    """Root mean square of the error of height (2) or speed (3), once it has settled."""
    begin = late(rows)
    return rms_mm([one[which - 2] - row[which] for one, row in list(zip(flown(answer, rows, blind), rows))[begin:]])


def most(points, flight, which, limit, unit):
    def check(answer, drawn):
        found = errors_mm(answer, drawn[flight], which)
        return all_or_nothing(points, found <= limit, f"{found} {unit}, at most {limit} {unit}")
    return check


def starts(answer, drawn):
    """The first height is believed, however far off the beginning was."""
    found = [round(1000.0 * (height - 0.8)) for height, _ in flown(answer, drawn["still"])][-1]
    return all_or_nothing(1, abs(found) <= 5, f"after 10 s at 800 mm it is {found} mm off")


def outage(answer, drawn):
    """The worst of three."""
    rows, second = drawn["noisy"], round(1 / STEP_S)
    outages = [(begin * second, (begin + 1) * second) for begin in OUTAGES_S]
    found = flown(answer, rows, outages)
    off = max(round(1000.0 * abs(found[end - 1][0] - rows[end - 1][2])) for _, end in outages)
    moved = max(round(1000.0 * abs(rows[end - 1][2] - rows[begin - 1][2])) for begin, end in outages)
    return all_or_nothing(2, off <= OUTAGE_MOST_MM, f"{off} mm off, at most {OUTAGE_MOST_MM} mm, while it moved up to {moved} mm")


CRITERIA = (
    Criterion(1, "a vehicle that stands still", starts, "Take over the first height as it is."),
    Criterion(1, "the height, nothing noisy", most(1, "plain", 2, 15, "mm"), "Compare a height with what you held when it was true, not with what you hold now."),
    Criterion(1, "the speed, nothing noisy", most(1, "plain", 3, 40, "mm/s"), "predict() must integrate: the speed by the acceleration, the height by the speed."),
    Criterion(1, "the height, noisy", most(1, "noisy", 2, 15, "mm"), "Correct only a share of the difference: the smaller, the less noise."),
    Criterion(1, "the speed, noisy", most(1, "noisy", 3, 35, "mm/s"), "The speed learns from the same difference. Too large a share makes noise of it."),
    Criterion(2, "three times a second without heights", outage, "predict() alone must carry the estimate."),
    Criterion(1, "the height with a biased accelerometer", most(1, "biased", 2, 20, "mm"), "A lasting difference has a cause: the bias learns from it, a little each time."),
    Criterion(2, "the speed with a biased accelerometer", most(2, "biased", 3, 40, "mm/s"), "Subtract the bias before you integrate. Give it a third, small share."),
)
