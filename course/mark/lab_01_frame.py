"""Laboratory 1: a frame of SCIP2.0 (Hokuyo C-42-03320B), decoded by hand and by a program. The product's driver is the reference."""
import csv
import io
import subprocess

from criterion import Criterion, all_or_nothing, shared

TITLE = "a frame by hand"
FIRST_STEP = 380
BY_HAND = 8                 # points: two lines of paper
LONG = 60                   # points, so that the data take two blocks
NEAR_MM, FAR_MM = 20, 4094  # what two characters can say of a distance; below are codes, 4095 is far
CLOCK_MS = 1 << 24


def characters(number, count):
    return "".join(chr(0x30 + (number >> 6 * place & 0x3F)) for place in reversed(range(count)))


def summed(text):
    return text + chr(0x30 + (sum(map(ord, text)) & 0x3F))


def frame(time_ms, distances_mm):
    """What the sensor sends for one scan of a stream that was asked for by MS."""
    data = "".join(characters(mm, 2) for mm in distances_mm)
    blocks = [summed(data[at:at + 64]) for at in range(0, len(data), 64)]
    return "\n".join([f"MS{FIRST_STEP:04}{FIRST_STEP + len(distances_mm) - 1:04}01000", summed("99"), summed(characters(time_ms, 4)), *blocks, "", ""])


def flipped(text, at):
    """With the lowest bit of one character changed, as a line with noise does it."""
    return text[:at] + chr(ord(text[at]) ^ 1) + text[at + 1:]


def numbers(draw):
    distances = [draw.whole(NEAR_MM, FAR_MM) for _ in range(BY_HAND)]
    time_ms, asked = draw.whole(100, CLOCK_MS - 1), draw.whole(1, BY_HAND - 2)
    text = frame(time_ms, distances)
    lines = text.split("\n")
    block = lines[3]
    more = [frame(draw.whole(0, CLOCK_MS - 1), [draw.whole(NEAR_MM, FAR_MM) for _ in range(count)]) for count in (1, BY_HAND, 32, 33, LONG)]
    damaged = [flipped(frame_, frame_.index("\n", 16) + 2 + draw.whole(1, 8)) for frame_ in more[1:]] + [flipped(more[-1], len(more[-1]) - 5)]
    drawn = {"time_ms": time_ms, "points": BY_HAND, "step": FIRST_STEP + asked, "distance_mm": distances[asked], "block_sum": block[-1],
             "frames": more, "damaged": damaged,
             "words": ["0", "00", "oo", "1Dh", "0CB"] + [characters(draw.whole(0, CLOCK_MS - 1), 4) for _ in range(5)],
             "texts": ["99", "00", "0C"] + [characters(draw.whole(0, CLOCK_MS - 1), 4) for _ in range(5)]}
    return drawn, [*lines[:3], block[:-1] + "?", f"Which distance has step {drawn['step']}?"]


def by_hand(name, digest=repr):
    def check(answer, drawn):
        given = answer.value(name)
        if given is None:
            return 0, "not filled in"
        return all_or_nothing(POINTS[name], given == drawn[name] and type(given) is type(drawn[name]), f"{digest(given)} is "
                              + ("right" if given == drawn[name] else "wrong"))
    return check


POINTS = {"time_ms": 1, "points": 1, "distance_mm": 2, "block_sum": 1}


def number_of(word):
    found = 0
    for character in word:
        found = found << 6 | ord(character) - 0x30
    return found


def compared(points, name, asked, right):
    def check(answer, drawn):
        questions = asked(drawn)
        given = answer.calls(name, [[question] for question in questions])
        wanted = [right(question) for question in questions]
        good = sum(one == other for one, other in zip(given, wanted))
        wrong = next((f"; {name}({question!r}) gives {one!r}, not {other!r}" for question, one, other in zip(questions, given, wanted)
                      if one != other), "")
        return shared(points, good, len(questions), f"{good} of {len(questions)}{wrong}")
    return check


def driver(plomada, text):
    """The distances as the product's driver reads them; None: it refuses the frame."""
    done = subprocess.run([plomada, "scip", "decode", "-"], input=text, capture_output=True, text=True, check=False)
    rows = list(csv.reader(io.StringIO(done.stdout)))
    return [int(cell) for cell in rows[1][1:]] if len(rows) == 2 else None


def decoded(points, which):
    def check(answer, drawn):
        if which == "damaged" and answer.calls("decode", [[drawn["frames"][0]]])[0] is None:
            return 0, "not asked before a whole frame is decoded"
        given = answer.calls("decode", [[text] for text in drawn[which]])
        wanted = [driver(answer.plomada, text) for text in drawn[which]]
        good = sum(one == other for one, other in zip(given, wanted))
        return shared(points, good, len(wanted), f"{good} of {len(wanted)} as the driver")
    return check


CRITERIA = (
    Criterion(1, "the time stamp", by_hand("time_ms"), "Four characters, six bits each, the first one counts most. See: What a character says."),
    Criterion(1, "the number of points", by_hand("points"), "Count the characters of the data. How many stand for one point?"),
    Criterion(2, "the distance at the step", by_hand("distance_mm"), "The first point belongs to the first step of the echo."),
    Criterion(1, "the sum of the block", by_hand("block_sum"), "Add the codes of all characters of the line, keep six bits, add 30 hexadecimal."),
    Criterion(2, "value()", compared(2, "value", lambda drawn: drawn["words"], number_of), "Each character is a digit of base 64."),
    Criterion(1, "line_sum()", compared(1, "line_sum", lambda drawn: drawn["texts"], lambda text: summed(text)[-1]),
              'The sum of "99" is 72 hexadecimal. Its six bits are 32 hexadecimal. Plus 30 hexadecimal this is 62, "b".'),
    Criterion(1, "decode() of whole frames", decoded(1, "frames"), "From 33 points on there is a second block, with a sum of its own."),
    Criterion(1, "decode() of damaged frames", decoded(1, "damaged"), "Each line behind the echo has a sum. One wrong sum spoils the frame."),
)
