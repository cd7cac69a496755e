"""Laboratory 8, for the numbers of 0."""

without_inheritance_ms = {"high": 21, "middle": 15, "low": 22}
with_inheritance_ms = {"high": 11, "middle": 21, "low": 22}


def blockings(tasks, at):
    above = {gate for gates in tasks[:at + 1] for gate in gates}
    lower = [set(gates) & above for gates in tasks[at + 1:]]
    return min(sum(bool(gates) for gates in lower), len(set().union(*lower)))
