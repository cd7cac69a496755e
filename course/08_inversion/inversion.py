"""Laboratory 8: priority inversion. Fill in the instants of `make lab N=8`, and the function."""

# Part 1: when does each task end? In ms from the beginning.
without_inheritance_ms = {"high": None, "middle": None, "low": None}
with_inheritance_ms = {"high": None, "middle": None, "low": None}


# Part 2.
def blockings(tasks, at):
    """How often tasks[at] can be delayed by lower ones, with priority inheritance: the bound of the page.

    tasks is a list, the most important first. Each is the list of the names of the gates that it uses.
    """
    return None
