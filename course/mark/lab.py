"""Marks one laboratory of the course.

Usage: lab.py N [--id ID] [--file FILE] [--plomada PROGRAM] [--marker PROGRAM]

Prints the student's numbers, the points of each criterion with what was measured, and the mark. The same answer gets the same lines on each
machine: nothing of time, place or language is in them. What a compiler or Python says goes to stderr. Exit status 2: nothing could be marked.
"""
import argparse
import hashlib
import importlib
import sys
from pathlib import Path

from answer_c import AnswerC
from answer_python import AnswerPython
from draw import ID, Draw

COURSE = Path(__file__).resolve().parents[1]
LABORATORIES = {int(path.name[:2]): path.name for path in sorted(COURSE.glob("[0-9][0-9]_*"))}


def shipped(number):
    """The file that the student fills in."""
    return next(path for path in sorted((COURSE / LABORATORIES[number]).iterdir()) if path.suffix in (".c", ".py"))


def report(number, student, path, plomada, marker):
    """The lines that are printed, and the mark."""
    laboratory = importlib.import_module(f"lab_{LABORATORIES[number]}")
    numbers, told = laboratory.numbers(Draw(number, student))
    lines = [f"Laboratory {number}: {laboratory.TITLE}. Numbers of {student}:", *(f"  {line}" for line in told), "",
             f"{path.name}, SHA-256 {hashlib.sha256(path.read_bytes()).hexdigest()[:16]}"]
    answer = AnswerC(path, marker) if path.suffix == ".c" else AnswerPython(path, plomada)
    mark = 0
    try:
        for criterion in laboratory.CRITERIA:
            earned, rows = criterion.row(answer, numbers)
            mark += earned
            lines += rows
    finally:
        sys.stderr.write(answer.complaints)
        answer.close()
    return [*lines, f"Mark: {mark} of 10"], mark


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("number", type=int, choices=sorted(LABORATORIES))
    parser.add_argument("--id", default="0", help="of the student: letters, digits, . _ and -")
    parser.add_argument("--file", type=Path, help="the answer; without it the file in the laboratory's folder")
    parser.add_argument("--plomada", type=Path, default=COURSE.parent / "build/plomada")
    parser.add_argument("--marker", type=Path, default=COURSE.parent / "build/course_marker")
    options = parser.parse_args()
    path = options.file or shipped(options.number)
    if not ID.fullmatch(options.id):
        parser.error(f"ID {options.id!r}: 1 to 32 letters, digits, . _ and -")
    if not path.is_file():
        parser.error(f"no file {path}")
    if path.suffix != shipped(options.number).suffix:
        parser.error(f"{path.name}: laboratory {options.number} wants a {shipped(options.number).suffix} file")
    program = options.marker if path.suffix == ".c" else options.plomada
    if not program.is_file():
        parser.error(f"{program}: not there; `make lab N={options.number}` builds it")
    lines, _ = report(options.number, options.id, path, options.plomada.resolve(), options.marker.resolve())
    print("\n".join(lines))


if __name__ == "__main__":
    main()
