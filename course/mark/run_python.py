"""Runs an answer in Python, in a process that has nothing of the marker in it.

Usage: run_python.py ANSWER RESULTS < CALLS. CALLS is a list of steps in JSON: ["value", NAME], ["call", NAME, ARGUMENTS], ["new", CLASS],
["method", NAME, ARGUMENTS] and ["member", NAME] of the last one made. RESULTS becomes the list of what came back, or what went wrong, in words.
"""
import json
import sys
import traceback
from pathlib import Path


def plain(value):
    """What JSON has a word for, else what it is."""
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    return value if isinstance(value, (int, float, str, bool, type(None))) else f"a {type(value).__name__}"


def step(space, made, kind, name, arguments=()):
    if kind == "new":
        made[:] = [space[name]()]
        return None
    if kind == "value":
        return space[name]
    if kind == "member":
        return getattr(made[0], name)
    return (space[name] if kind == "call" else getattr(made[0], name))(*arguments)


def run(path, steps):
    space, made, results, one = {"__name__": "answer"}, [], [], ("", "the file")
    try:
        exec(compile(Path(path).read_bytes(), str(path), "exec"), space)    # octets: Python knows their code. A program: see course/README.md
        for one in steps:
            results.append(plain(step(space, made, *one)))
    except SyntaxError as error:
        return f"Python does not understand line {error.lineno}" if error.lineno else f"Python does not understand the file: {error.msg}"
    except Exception as error:  # an answer may fail in any way
        traceback.print_exc()
        lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == str(path)]
        return f"{type(error).__name__} in line {lines[-1]}" if lines else f"{type(error).__name__}: {one[1]}"
    return results


if __name__ == "__main__":
    sys.stdout = sys.stderr
    told = run(sys.argv[1], json.load(sys.stdin))
    Path(sys.argv[2]).write_text(json.dumps(told), encoding="utf-8")
