"""Laboratory 1. Fill in what is None, then the two functions, then decode()."""

# Part 1, by hand: the frame that `make lab N=1` prints.
time_ms = None              # the sensor's clock
points = None               # how many distances the frame holds
distance_mm = None          # of the step that is asked for
block_sum = None            # the character that stands at the question mark, such as "k"


# Part 2.
def value(characters):
    """The number that some characters stand for: value("0C") is 19."""
    return None


def line_sum(text):
    """The character that stands behind a text: line_sum("99") is "b"."""
    return None


# Part 3.
def decode(frame):
    """The distances of a frame of MS, a list of numbers. None when a sum is wrong."""
    return None
