#!/usr/bin/env python3
"""prove.py [--faults] [NAME ...]: proves drivers/ and the guard of control/ with CBMC, file by file; docs/portability.md says what. 77: no CBMC.
--faults: each proof must fail when the fault of its own in faults.py is in the code.

CBMC bounds an array inside a structure that is reached by a pointer only by the whole structure. So what is proved is a
copy of drivers/ in which each index of such an array goes through prove_at(), which asserts the array's own bound."""
import concurrent.futures
import os
import re
import shutil
import subprocess
import sys
import tempfile

from faults import FAULTS

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
SKIPPED = 77
# Of the C28x: int 16 bits, long and pointers 32.
WIDTHS = ["--LP32", "-I", os.path.join(HERE, "inc16"), "-I", HERE]
CHECKS = ["--bounds-check", "--pointer-check", "--div-by-zero-check", "--signed-overflow-check", "--undefined-shift-check",
          "--unwinding-assertions", "--verbosity", "4"]

MEMBER = re.compile(r"\b\w+->\w+(?:(?:\.|->)\w+)*\[")
POINTERS = ("distance_mm",)     # members that are no arrays

# Proved by themselves, as NAME_itself(). A call of NAME() goes to the harness: it proves what NAME needs and gives any answer
# that NAME_itself() was proved to give.
APART = {
    "guard": ["impulse_ns", "faded_n"],
    "decimal": ["wide_multiply_add", "wide_divide", "wide_raise_to", "make_binary", "round_to_float", "to_float", "decimal_read",
                "scaled", "write_backwards", "write_decimals"],
    "scip_info": ["trimmed", "begins_with", "contains", "read_digits", "read_small", "copy", "health_of", "divide"],
    "scip_parser": ["gather", "line_in_place", "line_by_copy", "scip_parser_end_line", "decode_pairs", "decode_triples", "pass",
                    "strange_in", "block_in_place", "blocks_in_place"],
    "scip_request": ["scip_request_end_line_first", "scip_request_leave_time_first"],
    "urg_link": ["build_request", "probe_index", "next_probe", "wire_us", "frame_us", "scan_period_us", "past_us", "late_us"],
}

# Harness, sources besides it, rounds of a loop at most (proved too), functions. A harness that includes its source has none.
# They begin in this order: the longest first, or one processor waits for the other at the end.
PROOFS = [
    ("urg_link", ["scip_request"], 21, ["steps_in_a_dialogue"]),
    ("telecommand", ["telecommand", "line_sum"], 34,
     ["collector_starts_sound", "collector_stays_sound", "any_line_is_parsed", "any_line_may_be_urgent"]),
    ("line_sum", ["line_sum"], 65, ["any_text_has_a_sum"]),
    ("razor", ["razor"], 7, ["collector_starts_sound", "collector_stays_sound", "any_frame_is_parsed"]),
    ("parameter_image", ["parameter_image"], 136, ["any_cells_are_read", "any_set_is_written"]),
    ("flight_log", ["flight_log"], 4, ["any_number_has_a_cell", "any_cell_has_a_number"]),
    ("decimal", [], 71, ["a_digit_more_fits", "scaling_up_fits", "raising_fits", "dividing_fits", "division_leaves_enough",
                         "any_number_is_made_binary", "any_number_is_rounded", "any_number_is_converted"]),
    ("decimal", [], 42, ["any_text_is_read"]),
    ("decimal", [], 24, ["any_value_is_scaled", "any_digits_are_written", "any_decimals_are_written", "any_value_is_written",
                         "any_value_is_written_shortest"]),
    ("scip_info", [], 66, ["any_slice_is_trimmed", "any_slice_is_searched", "any_number_is_found", "any_line_is_divided"]),
    ("scip_info", [], 130,
     ["any_slice_may_begin_with_words", "any_decimal_digits_are_read", "any_hexadecimal_digits_are_read", "any_slice_is_copied",
      "any_state_has_a_health", "any_line_is_taken", "any_limits_give_directions"]),
    ("urg_link", ["scip_request"], 21,
     ["starts_sound", "steps_in_wait", "steps_in_a_stream", "any_request_is_built", "any_request_has_a_line_end_first",
      "any_request_leaves_time_mode_first", "any_rate_has_its_place", "any_place_has_a_next_one", "any_octets_have_their_time", "any_stream_has_its_times"]),
    ("scip_parser", ["scip_request"], 258, ["strange_octets_are_counted", "line_ends_in_text"]),
    ("scip_parser", ["scip_request"], 130,
     ["starts_sound", "orders_leave_it_sound", "octets_leave_it_sound", "line_ends_in_hunt", "line_ends_in_echo",
      "line_ends_in_status", "line_ends_in_time", "line_ends_in_reply", "line_ends_in_legacy",
      "line_ends_in_data", "line_ends_in_scan", "octets_are_gathered", "head_in_place_leaves_it_sound",
      "status_in_place_leaves_it_sound", "time_in_place_leaves_it_sound", "block_in_place_leaves_it_sound",
      "any_line_is_copied"]),
    ("scip_parser", ["scip_request"], 67,
     ["any_block_is_passed", "any_pairs_are_decoded", "any_triples_are_decoded", "any_triples_are_decoded_behind_one",
      "any_triples_are_decoded_behind_two"]),
    ("scip_parser", ["scip_request"], 14, ["any_burst_is_taken_apart", "blocks_are_taken_one_by_one"]),
    ("guard", [], 2, ["any_thrust_is_within_idle_and_full", "no_order_is_no_thrust", "any_unseen_impulse_is_bounded", "any_fall_is_bounded", "any_thrust_fades_slowly",
                      "any_impulse_is_one"]),
]
# Of control/ what the guard is made of.
GUARD = ("guard.c", "guard.h", "between.h", "seconds.h", "thrust.h")


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


def with_apart(text, names):
    for name in names:
        head = re.compile(rf"^((?:static )?\w+ ){name}(\([^;{{}}]*\))\n{{", re.MULTILINE)
        text, found = head.subn(rf"\1{name}\2;\n\1{name}_itself\2\n{{", text)
        if found != 1:
            sys.exit(f"prove: {name}() is not found")
    return text


def copy_drivers(tree, changed=("", "", "")):
    """changed: file, text, the fault that stands there instead."""
    file, old, new = changed
    for room in ("drivers", "control"):
        os.mkdir(os.path.join(tree, room))
        for name in os.listdir(os.path.join(ROOT, room)):
            if not name.endswith((".c", ".h")) or (room == "control" and name not in GUARD):
                continue
            with open(os.path.join(ROOT, room, name), encoding="utf-8") as source:
                text = source.read()
            if name == file:
                if text.count(old) != 1:
                    sys.exit(f"prove: {file} has '{old}' {text.count(old)} times")
                text = text.replace(old, new)
            text = with_apart(text, APART.get(name[:-2], []) if name.endswith(".c") else [])
            with open(os.path.join(tree, room, name), "w", encoding="utf-8") as copy:
                copy.write('#include "prove.h"\n' + with_bounds(text))


def prove(cbmc, tree, name, sources, rounds, function, more=()):
    command = [cbmc, *WIDTHS, "-I", tree, *CHECKS, *more, "--unwind", str(rounds), "--function", function, os.path.join(HERE, name + ".c")]
    command += [os.path.join(tree, "drivers", source + ".c") for source in sources]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as run:
        lines = run.stdout.read().splitlines()
        _, status, used = os.wait4(run.pid, 0)
        run.returncode = os.waitstatus_to_exitcode(status)
    proved = sum(line.endswith(": SUCCESS") for line in lines)
    good = run.returncode == 0 and "VERIFICATION SUCCESSFUL" in lines and proved > 0
    return good, proved, used.ru_utime + used.ru_stime, lines


def failures_of(lines):
    return [line for line in lines if line.endswith(": FAILURE")]


def violation_of(lines):
    """Of a run that stops at the first: where, and what. None: there is none."""
    if "VERIFICATION FAILED" not in lines or "Violated property:" not in lines:
        return None
    at = lines.index("Violated property:")
    return " ".join(line.strip() for line in lines[at + 1:at + 3])


def prove_one(cbmc, name, sources, rounds, function):
    """(good, what to print)"""
    with tempfile.TemporaryDirectory() as tree:
        copy_drivers(tree)
        good, proved, seconds, lines = prove(cbmc, tree, name, sources, rounds, function)
    text = f"{'proved' if good else 'FAILED'}  {name}: {function}, {proved} properties, {seconds:.0f} s"
    return good, "\n".join([text] + ([] if good else failures_of(lines) or lines[-20:])), seconds


def prove_fault(cbmc, name, sources, rounds, function):
    found = [fault[2:] for fault in FAULTS if fault[:2] == (name, function)]
    if len(found) != 1:
        return False, f"FAILED  {name}: {function} has no fault of its own in faults.py", 0.0
    with tempfile.TemporaryDirectory() as tree:
        copy_drivers(tree, found[0])
        _, _, seconds, lines = prove(cbmc, tree, name, sources, rounds, function, ["--stop-on-fail"])
    noticed = violation_of(lines)
    text = noticed.replace(tree + os.sep, "").replace(ROOT + os.sep, "") if noticed else "with its fault in the code it does not fail\n" + "\n".join(lines[-5:])
    return bool(noticed), f"{'noticed' if noticed else 'FAILED'}  {name}: {function}, {seconds:.0f} s: {text}", seconds


def notices(cbmc, tree):
    """An index one too far, which only prove_at() can see, must not pass."""
    with open(os.path.join(HERE, "too_far.c"), encoding="utf-8") as source:
        text = with_bounds(source.read())
    with open(os.path.join(tree, "drivers", "too_far.c"), "w", encoding="utf-8") as copy:
        copy.write(text)
    good, _, _, lines = prove(cbmc, tree, "too_far_harness", ["too_far"], 2, "one_too_far")
    failures = failures_of(lines)
    if good or len(failures) != 1 or "within its own array" not in failures[0]:
        print("FAILED  an index that is one too far is not noticed")
        return False
    return True


def main(arguments):
    cbmc = find_cbmc()
    if cbmc is None:
        print("CBMC is missing: tools/setup/setup.sh prove")
        return SKIPPED
    with tempfile.TemporaryDirectory() as tree:
        copy_drivers(tree)
        good = notices(cbmc, tree)
    wanted = [name for name in arguments if name != "--faults"]
    step = prove_fault if "--faults" in arguments else prove_one
    steps = [(cbmc, name, sources, rounds, function) for name, sources, rounds, functions in PROOFS
             for function in functions if not wanted or name in wanted]
    total = 0.0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for done in concurrent.futures.as_completed([pool.submit(step, *one) for one in steps]):
            fine, text, seconds = done.result()
            print(text, flush=True)
            good, total = good and fine, total + seconds
    print(f"{len(steps)} proofs, {total:.0f} s of processor time")
    return 0 if good and steps else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
