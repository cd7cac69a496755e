"""Whoever follows one cycle of flight_step() call by call seldom turns back to a file that he had left.

The control room is built with the compiler's hooks at each entry and exit of a function, and flies (walk.c). Of each cycle this takes the
calls of functions that may change something: one of their arguments is a pointer that is not const. A question, a calculation and what
stands in a header are no place to walk to: they are answered where they are asked, whatever they call. A call into a file counts as a
return when the walk has been in that file, has gone to another since, and no function of the file is open. The same call in a loop counts
once.

The cycle of a flight with most returns must have fewer than LIMIT, whichever law flies. `walk.py --show LAW` prints that cycle.
"""
import argparse
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import house
import sources

LIMIT = 30
FLAGS = ("-std=gnu99", "-O0", "-g", "-fno-pie", "-finstrument-functions", "-I.", "-Itests/control")
HEAD = re.compile(r"^\w[\w ]*?[ *](\w+)\(([^;{}()]*(?:\([^()]*\)[^;{}()]*)*)\)\s*\{", re.MULTILINE)
LAW = re.compile(r"^\s*LAW\((\w+),", re.MULTILINE)


def changing(the_house):
    """(file, function) of each function of control/ that may change what its arguments point to."""
    found = set()
    for path in the_house.sources("control", ".c"):
        for name, arguments in HEAD.findall(house.code_only(the_house.text(path))):
            if any("*" in argument and not argument.strip().startswith("const ") for argument in arguments.split(",")):
                found.add((path, name))
    return found


def steps(cycle, counts):
    """(depth, function, whether the walk turned back to its file) of each call of a cycle. A cycle has a function for each entry, None
    for each exit; counts: the functions that count."""
    open_calls, seen, known, latest = [], set(), set(), None
    for function in cycle:
        if function is None:
            open_calls.pop()
            continue
        followed = function in counts and None not in open_calls
        if followed:
            call = (open_calls[-1] if open_calls else None, function)
            back = function[0] in seen - {latest} - {file for file, _ in open_calls} and call not in known
            yield len(open_calls), function, back
            seen.add(function[0])
            known.add(call)
            latest = function[0]
        open_calls.append(function if followed else None)


def returns(cycle, counts):
    return sum(back for _, _, back in steps(cycle, counts))


def flown(the_house, compiler, addr2line, work):
    """{law: its cycles, each walk once however often it is flown}"""
    program = f"{work}/walk"
    files = [*sources.listed(the_house)["control"], "tests/rules/walk.c"]
    objects = []
    for file in files:
        objects.append(f"{work}/{file.replace('/', '_')}.o")
        subprocess.run([compiler, *FLAGS, "-c", file, "-o", objects[-1]], cwd=the_house.root, check=True)
    subprocess.run([compiler, "-no-pie", *objects, "-o", program, "-lm"], check=True)
    laws = LAW.findall(the_house.text("control/laws/table.h"))
    told = {}
    for number, law in enumerate(laws):
        out = subprocess.run([program, str(number)], check=True, capture_output=True, text=True).stdout
        told[law] = dict.fromkeys(line.partition(" ")[2] for line in out.split("\n")[:-1])
    addresses = sorted({word[1:] for walks in told.values() for walk in walks for word in walk.split() if word[0] == ">"})
    names = subprocess.run([addr2line, "-f", "-e", program], input="\n".join(f"0x{address}" for address in addresses), check=True,
                           capture_output=True, text=True).stdout.split("\n")
    functions = {}
    for number, address in enumerate(addresses):
        file = names[2 * number + 1].rsplit(":", 1)[0]
        functions[">" + address] = (file[file.find("control/"):], names[2 * number])
    return {law: [[functions.get(word) for word in walk.split()] for walk in walks] for law, walks in told.items()}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", nargs="?", default=Path(__file__).resolve().parents[2])
    parser.add_argument("--compiler", default="cc")
    parser.add_argument("--addr2line", default="addr2line")
    parser.add_argument("--show", metavar="LAW", help="print the cycle of that law with most returns")
    options = parser.parse_args()
    the_house = house.House(options.root)
    laws = LAW.findall(the_house.text("control/laws/table.h"))
    if options.show and options.show not in laws:
        parser.error(f"{options.show}: no such law; one of {', '.join(laws)}")
    with tempfile.TemporaryDirectory() as work:
        cycles = flown(the_house, options.compiler, options.addr2line, work)
    counts = changing(the_house)
    worst = {law: max(cycles[law], key=lambda cycle: returns(cycle, counts)) for law in cycles}
    complaints = []
    if options.show:
        for depth, (file, function), back in steps(worst[options.show], counts):
            print(f"{'<-' if back else '  '} {'  ' * depth}{function}  {file}")
    for law, cycle in worst.items():
        taken = list(steps(cycle, counts))
        back = sum(back for _, _, back in taken)
        print(f"{law}: {len(taken)} calls, {back} returns")
        if back >= LIMIT:
            complaints.append(f"control/flight.c: a cycle with law {law} returns {back} times, fewer than {LIMIT} are enough")
    house.report(complaints, "walk")


if __name__ == "__main__":
    if sys.platform != "linux":
        print("the walk is built with GCC's hooks and read with addr2line: on Linux")
        sys.exit(77)
    main()
