"""Laboratory 7: response times. Fill in the numbers of `make lab N=7`, the function and the order."""

# Part 1, by hand: the worst response time of each task, in ms; and the load of the processor in percent.
by_hand_ms = {"A": None, "B": None, "C": None}
load_percent = None


# Part 2. All times are whole microseconds. task and each of the higher ones is a dictionary with "cost_us", "period_us",
# "deadline_us" and "blocking_us". The task has one blocking at most, and its deadline is not longer than its period.
def response_us(task, higher):
    """The worst response time; None when it is longer than the deadline."""
    return None


# Part 3: the names of the five tasks, the most important first, so that every deadline holds.
order = []
