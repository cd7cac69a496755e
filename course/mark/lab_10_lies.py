"""Laboratory 10: which heights are to be believed. A lie that is believed is a danger; a true height that is not believed is harm too."""
import math

from criterion import Criterion, Refused, all_or_nothing, shared
from lab_09_estimation import START_M, STEP_S, STEPS_A_HEIGHT, accelerations

TITLE = "a sensor that lies"
HEIGHT_S = STEP_S * STEPS_A_HEIGHT
SECONDS, AT_S, UNTIL_S = 30, 15, 20
NOISE_MM, NOISE_MPS2 = 4.0, 0.05
OUTLIERS = 6
KNOWN_AFTER_S, DOUBTED_MOST, AGAIN_AFTER_S = 1.0, 3, 0.5
CODES_IN_A_ROW = 3
CODES = (0, 7, 19, 4095)    # docs/scip.md: below 20 a code, 4095 of two characters is far or unknown


def flight(draw):
    """[[time s, height mm, acceleration m/s2]] of a healthy sensor."""
    speed, height, rows = 0.0, START_M, []
    steps = accelerations(draw, SECONDS)
    for at in range(0, len(steps), STEPS_A_HEIGHT):
        for up in steps[at:at + STEPS_A_HEIGHT]:
            height, speed = height + speed * STEP_S + 0.5 * up * STEP_S * STEP_S, speed + up * STEP_S
        felt = math.fsum(steps[at:at + STEPS_A_HEIGHT]) / STEPS_A_HEIGHT + draw.noise(NOISE_MPS2)
        rows.append([len(rows) / 10, round(1000.0 * height + draw.noise(NOISE_MM)), felt])
    return rows


def index(time_s):
    return round(time_s / HEIGHT_S)


def with_heights(rows, change):
    """Another height in some rows: change(at, height)."""
    return [[time, change(at, height), up] for at, (time, height, up) in enumerate(rows)]


def numbers(draw):
    base = flight(draw)
    spots = [index(3 + 4 * at) + draw.whole(0, 20) for at in range(OUTLIERS)]
    far = {spot: draw.one((-1, 1)) * draw.whole(300, 600, 10) for spot in spots}
    step = draw.one((-250, 250))
    held = base[index(AT_S)][1]
    drawn = {"healthy": [flight(draw) for _ in range(3)], "spots": spots, "step": step,
             "outliers": with_heights(base, lambda at, mm: mm + far.get(at, 0)),
             "edge": with_heights(base, lambda at, mm: mm + step * (at >= index(AT_S))),
             "frozen": with_heights(base, lambda at, mm: held if index(AT_S) <= at < index(UNTIL_S) else mm),
             "codes": with_heights(base, lambda at, mm: CODES[at // 7 % len(CODES)] if at > 20 and at % 7 < CODES_IN_A_ROW else mm)}
    return drawn, ["Healthy heights have a noise of 4 mm, the acceleration one of 0.05 m/s2.",
                   f"Lies: single heights 300 to 600 mm off; the same height for {UNTIL_S - AT_S} s; codes. True: an edge of 250 mm."]


def judged(answer, rows):
    said = answer.ask([["new", "Judge"], *(["method", "believe", row] for row in rows)])[1:]
    if any(not isinstance(one, bool) for one in said):
        raise Refused("believe() must return True or False")
    return said


def honest(answer, drawn):
    """That everything is believed in a healthy flight is worth nothing alone."""
    if all(judged(answer, drawn["outliers"])) and all(judged(answer, drawn["frozen"])):
        raise Refused("it believes everything")


def healthy(answer, drawn):
    honest(answer, drawn)
    doubts = sum(not one for rows in drawn["healthy"] for one in judged(answer, rows))
    return all_or_nothing(2, doubts == 0, f"{doubts} of {sum(map(len, drawn['healthy']))} true heights are not believed")


def outliers(answer, drawn):
    said = judged(answer, drawn["outliers"])
    found = sum(not said[spot] for spot in drawn["spots"])
    if said.count(False) > 5 * OUTLIERS:
        return 0, f"it doubts {said.count(False)} heights, of which {OUTLIERS} are wrong"
    return shared(2, found, OUTLIERS, f"{found} of {OUTLIERS} found, {said.count(False)} doubted")


def edge(answer, drawn):
    honest(answer, drawn)
    doubts = judged(answer, drawn["edge"])[index(AT_S):].count(False)
    return all_or_nothing(2, doubts <= DOUBTED_MOST, f"{doubts} heights after the edge are not believed, at most {DOUBTED_MOST}")


def frozen(answer, drawn):
    during = judged(answer, drawn["frozen"])[index(AT_S + KNOWN_AFTER_S):index(UNTIL_S)]
    return shared(2, during.count(False), len(during), f"{during.count(False)} of {len(during)} found, after the first {KNOWN_AFTER_S} s")


def codes(answer, drawn):
    said = judged(answer, drawn["codes"])
    wrong = [row[1] for row, one in zip(drawn["codes"], said) if one and row[1] in CODES]
    return all_or_nothing(1, not wrong, f"believed: {', '.join(map(str, sorted(set(wrong))))}" if wrong else "none believed")


def again(answer, drawn):
    honest(answer, drawn)
    after = judged(answer, drawn["frozen"])[index(UNTIL_S + AGAIN_AFTER_S):]
    return all_or_nothing(1, all(after), f"{after.count(False)} of {len(after)} true heights behind it are not believed")


CRITERIA = (
    Criterion(2, "healthy flights", healthy, "Allow for the noise, and for the motion since the height before."),
    Criterion(2, "single wrong heights", outliers, "Predict the height from the one before, the speed and the acceleration. Is the difference possible?"),
    Criterion(2, "an edge of the ground", edge, "The first height behind it looks like a lie. The next ones agree with it: then it is the ground."),
    Criterion(2, "a sensor that repeats itself", frozen, "A true sensor has noise: how often does it show the same millimetre in a row?"),
    Criterion(1, "codes are no heights", codes, "The scanner says by values below 20 and by 4095 that it has no distance."),
    Criterion(1, "behind a lie it is believed again", again, "Who has doubted for long has an old speed. Let heights that agree with each other be believed."),
)
