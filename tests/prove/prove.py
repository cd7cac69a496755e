#!/usr/bin/env python3
"""prove.py [NAME ...]: proves drivers/ with CBMC, file by file; docs/portability.md says what. 77: no CBMC.

CBMC bounds an array inside a structure that is reached by a pointer only by the whole structure. So what is proved is a
copy of drivers/ in which each index of such an array goes through prove_at(), which asserts the array's own bound."""
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
SKIPPED = 77
# Of the C28x: int 16 bits, long and pointers 32.
WIDTHS = ["--LP32", "-I", os.path.join(HERE, "inc16"), "-I", HERE]
CHECKS = ["--bounds-check", "--pointer-check", "--div-by-zero-check", "--signed-overflow-check", "--undefined-shift-check",
          "--unwinding-assertions", "--verbosity", "4"]

MEMBER = re.compile(r"\b\w+->\w+(?:(?:\.|->)\w+)*\[")
POINTERS = ("distance_mm",)     # members that are no arrays

# Harness, sources besides it, rounds of a loop at most (proved too), functions. A harness that includes its source has none.
PROOFS = [
    ("telecommand", ["telecommand", "line_sum"], 34,
     ["collector_starts_sound", "collector_stays_sound", "any_line_is_parsed", "any_line_may_be_urgent"]),
    ("line_sum", ["line_sum"], 65, ["any_text_has_a_sum"]),
    ("razor", ["razor"], 7, ["collector_starts_sound", "collector_stays_sound", "any_frame_is_parsed"]),
    ("parameter_image", ["parameter_image"], 136, ["any_cells_are_read", "any_set_is_written"]),
    ("flight_log", ["flight_log"], 4, ["any_number_has_a_cell", "any_cell_has_a_number"]),
    ("decimal", [], 71, ["a_digit_more_fits", "scaling_up_fits", "raising_fits", "dividing_fits", "division_leaves_enough",
                         "any_number_is_rounded", "any_text_is_read", "any_value_is_written"]),
    ("scip_info", [], 14,
     ["any_slice_is_trimmed", "any_slice_is_searched", "any_slice_is_read", "any_line_is_divided", "any_limits_give_directions"]),
    ("scip_info", [], 42, ["any_slice_is_copied"]),
    ("urg_link", ["scip_request"], 21,
     ["starts_sound", "steps_in_wait", "steps_in_a_stream", "steps_in_a_dialogue", "octets_are_counted"]),
    ("scip_parser", ["scip_request"], 130,
     ["starts_sound", "orders_leave_it_sound", "octets_leave_it_sound", "line_ends_in_hunt", "line_ends_in_echo",
      "line_ends_in_status", "line_ends_in_time", "line_ends_in_text", "line_ends_in_reply", "line_ends_in_legacy",
      "line_ends_in_data", "line_ends_in_scan", "octets_are_gathered", "echo_in_place_leaves_it_sound",
      "status_in_place_leaves_it_sound", "time_in_place_leaves_it_sound", "block_in_place_leaves_it_sound"]),
]


def find_cbmc():
    own = os.path.join(ROOT, "build", "cbmc", "cbmc")
    return own if os.path.exists(own) else shutil.which("cbmc")


def with_bounds(text):
    out = ""
    match = MEMBER.search(text)
    while match:
        at, depth = match.end(), 1
        while depth > 0:
            depth += {"[": 1, "]": -1}.get(text[at], 0)
            at += 1
        array, index = match.group()[:-1], text[match.end():at - 1]
        out += text[:match.start()]
        if array.endswith(POINTERS):
            out += array + "[" + with_bounds(index) + "]"
        else:
            out += f"{array}[prove_at((size_t)({with_bounds(index)}), sizeof {array} / sizeof {array}[0])]"
        text = text[at:]
        match = MEMBER.search(text)
    return out + text


def copy_drivers(tree):
    os.mkdir(os.path.join(tree, "drivers"))
    for name in os.listdir(os.path.join(ROOT, "drivers")):
        if name.endswith((".c", ".h")):
            with open(os.path.join(ROOT, "drivers", name), encoding="utf-8") as source:
                text = source.read()
            with open(os.path.join(tree, "drivers", name), "w", encoding="utf-8") as copy:
                copy.write('#include "prove.h"\n' + with_bounds(text))


def prove(cbmc, tree, name, sources, rounds, function):
    command = [cbmc, *WIDTHS, "-I", tree, *CHECKS, "--unwind", str(rounds), "--function", function, os.path.join(HERE, name + ".c")]
    command += [os.path.join(tree, "drivers", source + ".c") for source in sources]
    began = time.monotonic()
    run = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    lines = run.stdout.splitlines()
    proved = sum(line.endswith(": SUCCESS") for line in lines)
    good = run.returncode == 0 and "VERIFICATION SUCCESSFUL" in lines and proved > 0
    return good, proved, time.monotonic() - began, lines


def report(name, function, good, proved, seconds, lines):
    print(f"{'proved' if good else 'FAILED'}  {name}: {function}, {proved} properties, {seconds:.0f} s", flush=True)
    if not good:
        print("\n".join([line for line in lines if line.endswith(": FAILURE")] or lines[-20:]))
    return good


def notices(cbmc, tree):
    """An index one too far, which only prove_at() can see, must not pass."""
    with open(os.path.join(HERE, "too_far.c"), encoding="utf-8") as source:
        text = with_bounds(source.read())
    with open(os.path.join(tree, "drivers", "too_far.c"), "w", encoding="utf-8") as copy:
        copy.write(text)
    good, _, _, lines = prove(cbmc, tree, "too_far_harness", ["too_far"], 2, "one_too_far")
    failures = [line for line in lines if line.endswith(": FAILURE")]
    if good or len(failures) != 1 or "within its own array" not in failures[0]:
        print("FAILED  an index that is one too far is not noticed")
        return False
    return True


def main(wanted):
    cbmc = find_cbmc()
    if cbmc is None:
        print("CBMC is missing: tools/setup/setup.sh prove")
        return SKIPPED
    ran = 0
    with tempfile.TemporaryDirectory() as tree:
        copy_drivers(tree)
        good = notices(cbmc, tree)
        for name, sources, rounds, functions in PROOFS:
            for function in functions if not wanted or name in wanted else []:
                good = report(name, function, *prove(cbmc, tree, name, sources, rounds, function)) and good
                ran += 1
    return 0 if good and ran > 0 else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
