"""Laboratory 1, for the numbers of 0."""

SIX_BITS = 0x3F
ZERO = 0x30

time_ms = 12801908
points = 8
distance_mm = 3277
block_sum = "f"


def value(characters):
    number = 0
    for character in characters:
        number = 64 * number + ord(character) - ZERO
    return number


def line_sum(text):
    return chr((sum(ord(character) for character in text) & SIX_BITS) + ZERO)


def checked(line):
    """A line without its sum; None when the sum is wrong."""
    return line[:-1] if line and line_sum(line[:-1]) == line[-1] else None


def decode(frame):
    lines = frame.split("\n")[1:]
    lines = lines[:lines.index("")]
    parts = [checked(line) for line in lines]
    if None in parts:
        return None
    data = "".join(parts[2:])
    return [value(data[at:at + 2]) for at in range(0, len(data), 2)]
