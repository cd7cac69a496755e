"""The course: each laboratory marks its solution with 10, what is shipped with little, and a wrong answer for what is wrong.

Usage: test_labs.py [--write] PLOMADA MARKER [CLASS...]    --write: the tables of the pages, and the reports that are pinned
Wrong: every wrong answer of each laboratory; Marks has the first of each.
"""
import functools
import importlib
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.dont_write_bytecode = True
ROOT = Path(__file__).resolve().parents[2]
COURSE = ROOT / "course"
sys.path[:0] = [str(COURSE / "mark"), str(Path(__file__).parent)]
import answer_c             # noqa: E402
import answer_python        # noqa: E402
import lab                  # noqa: E402
from draw import Draw       # noqa: E402
from wrong import WRONG     # noqa: E402

SHIPPED_MOST = 3            # an answer that nobody has filled in
UNFLOWN = (1, 2, 7, 8, 9, 10)
DRAW_NOISE = (9, 10)      # a hundred thousand numbers for each student
REPORTS = Path(__file__).with_name("reports.txt")
TABLE = re.compile(r"(?<=<!-- by tests/course/test_labs.py --write -->\n\n).*?(?=\n\n<!-- end -->)", re.DOTALL)


def solution(number):
    return next((COURSE / "solutions").glob(f"{number:02}_*"))


def laboratory(number):
    return importlib.import_module(f"lab_{lab.LABORATORIES[number]}")


def marked(number, path, student="0"):
    lines, mark = lab.report(number, student, Path(path), PLOMADA, MARKER)
    return "\n".join(lines), mark


@functools.cache
def solved(number):
    """Of the course's own solution, which several tests look at."""
    return marked(number, solution(number))


def lost(report, number):
    """The criteria without all of their points."""
    rows = re.findall(r"^(\d+) of (\d+)  (.*)$", report, re.MULTILINE)
    return {criterion.says for criterion, (earned, most, _) in zip(laboratory(number).CRITERIA, rows, strict=True) if earned != most}


def changed(number, changes, folder):
    text = solution(number).read_text(encoding="utf-8")
    for old, new in changes:
        found = re.compile(re.escape(old).replace(r"\ ", r"\s+"))       # lines are broken and columns aligned as clang-format wants it
        assert found.search(text), f"the solution of {number} has no {old}"
        text = found.sub(lambda _, new=new: new, text)
    path = Path(folder) / solution(number).name
    path.write_text(text, encoding="utf-8")
    return path


def pinned():
    """The reports of the solutions that fly nothing: no word of these may depend on a machine."""
    return "\n\n".join(re.sub(r"SHA-256 \w+", "SHA-256 ...", solved(number)[0]) for number in UNFLOWN) + "\n"


def page(number):
    return COURSE / lab.LABORATORIES[number] / "README.md"


def table(number):
    return "\n".join(["| points | for |", "|---|---|", *(f"| {one.points} | {one.says} |" for one in laboratory(number).CRITERIA)])


class Marks(unittest.TestCase):
    WRONG_OF_EACH = 1

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_each_laboratory_has_ten_points(self):
        self.assertEqual(sorted(lab.LABORATORIES), list(range(1, 11)))
        for number in lab.LABORATORIES:
            self.assertEqual(sum(one.points for one in laboratory(number).CRITERIA), 10, number)

    def test_each_solution_gets_ten(self):
        for number in lab.LABORATORIES:
            with self.subTest(laboratory=number):
                report, mark = solved(number)
                self.assertEqual(mark, 10, report)

    def test_what_is_shipped_gets_little_and_says_what_to_do(self):
        for number in lab.LABORATORIES:
            with self.subTest(laboratory=number):
                report, mark = marked(number, lab.shipped(number))
                self.assertLessEqual(mark, SHIPPED_MOST, report)
                for one in laboratory(number).CRITERIA:
                    if one.says in lost(report, number):
                        self.assertIn(one.hint, report)

    def test_a_wrong_answer_loses_what_is_wrong_and_keeps_the_rest(self):
        self.assertEqual(sorted(WRONG), sorted(lab.LABORATORIES))
        for number, answers in WRONG.items():
            self.assertEqual(len(answers), 3)
            for name, (changes, wanted) in [*answers.items()][:self.WRONG_OF_EACH]:
                with self.subTest(laboratory=number, wrong=name):
                    report, mark = marked(number, changed(number, changes, self.folder))
                    self.assertEqual(lost(report, number), wanted, report)
                    self.assertTrue(0 < mark < 10, report)

    def test_the_reports_are_the_pinned_ones(self):
        self.assertEqual(pinned(), REPORTS.read_text(encoding="utf-8"))

    def test_compiler_language_time_and_place_do_not_show(self):
        careless = self.folder / "cc"
        careless.write_text('#!/bin/sh\nexec /usr/bin/env cc "$@" -O0\n', encoding="ascii")
        careless.chmod(0o755)
        for number in (3, 9):
            command = [sys.executable, "-B", COURSE / "mark/lab.py", str(number), "--id", "x-1", "--file", solution(number), "--plomada", PLOMADA, "--marker", MARKER]
            plain = subprocess.run(command, capture_output=True, check=True).stdout
            elsewhere = {**os.environ, "CC": str(careless), "LC_ALL": "es_ES.UTF-8", "TZ": "Asia/Tokyo", "PYTHONHASHSEED": "7", "COLUMNS": "20"}
            self.assertEqual(subprocess.run(command, capture_output=True, check=True, env=elsewhere, cwd=self.folder).stdout, plain)
            self.assertIn(b"Mark: ", plain)


class Wrong(Marks):
    WRONG_OF_EACH = 3


class Students(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def test_two_students_have_different_numbers(self):
        for number in lab.LABORATORIES:
            students = 4 if number in DRAW_NOISE else 12
            found = {repr(laboratory(number).numbers(Draw(number, str(student)))) for student in range(students)}
            self.assertGreater(len(found), 2 * students // 3, number)
            self.assertEqual(repr(laboratory(number).numbers(Draw(number, "ana"))), repr(laboratory(number).numbers(Draw(number, "ana"))))

    def test_each_student_can_get_ten(self):
        """One of two, in turn: an ID of letters, and one with a digit first."""
        for number in lab.LABORATORIES:
            for student in (("ana", "2027-12345")[number % 2],):
                with self.subTest(laboratory=number, student=student):
                    report, mark = marked(number, self.solved(number, student), student)
                    self.assertEqual(mark, 10, report)

    def test_the_answer_of_another_student_does_not_get_ten_where_numbers_are_asked(self):
        for number in (1, 2, 7, 8):
            report, mark = marked(number, self.solved(number, "ana"), "juan")
            self.assertLess(mark, 10, report)

    def solved(self, number, student):
        """The solution with the numbers of this student in place of those of 0."""
        drawn = laboratory(number).numbers(Draw(number, student))[0]
        zero = laboratory(number).numbers(Draw(number, "0"))[0]
        return changed(number, {1: self.frame, 2: self.tilt, 3: self.p, 7: self.response, 8: self.inversion}.get(number, lambda *_: [])(drawn, zero),
                       self.folder)

    @staticmethod
    def frame(drawn, zero):
        return [(f"{name} = {zero[name]}", f"{name} = {drawn[name]}") for name in ("time_ms", "points", "distance_mm")] + [
            (f'block_sum = "{zero["block_sum"]}"', f'block_sum = {drawn["block_sum"]!r}')]

    @staticmethod
    def tilt(drawn, zero):
        import math
        d, leg, arm, _, slant, roll, _ = drawn["foreseen"]
        error = (slant - d) * (1 - math.cos(roll / 1000)) + arm * math.sin(roll / 1000)
        return [("foreseen_error_mm = 57.0F", f"foreseen_error_mm = {error:.1f}F")]

    @staticmethod
    def p(drawn, zero):
        missing = float(re.search(r"hover_thrust ([\d.]+)", drawn["scenario"]).group(1)) - 7.0
        return [("KP_N_PER_M 6.0F", "KP_N_PER_M 7.0F"), ("66.7F", f"{missing / 7.0 * 1000:.1f}F")]

    @staticmethod
    def response(drawn, zero):
        three = laboratory(7).rta(drawn["three"])
        load = sum(100 * one["cost_us"] / one["period_us"] for one in drawn["three"])
        order = [one["name"] for one in sorted(drawn["five"], key=lambda one: one["deadline_us"])]
        return [('{"A": 1, "B": 4, "C": 10}', repr({name: us // 1000 for name, us in three.items()})), ("64.5", f"{load:.1f}"),
                ('["green", "white", "blue", "red", "black"]', repr(order))]

    @staticmethod
    def inversion(drawn, zero):
        return [('{"high": 21, "middle": 15, "low": 22}', repr(drawn["without"])), ('{"high": 11, "middle": 21, "low": 22}', repr(drawn["with"]))]


class Misfortunes(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def answer(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def test_an_answer_that_cannot_be_run_gets_nothing_and_a_reason(self):
        for number, name, text, reason in (
                (1, "a.py", "def value(:\n", "Python does not understand line 1"),
                (1, "a.py", "import sys\nsys.exit(0)\n", "Python cannot run the file"),
                (1, "a.py", "time_ms = 1 / 0\n", "ZeroDivisionError in line 1"),
                (1, "a.py", "", "KeyError: time_ms"),
                (2, "a.c", "int main(", "could not be built"),
                (2, "a.c", "int x;", "has no student_height"),
                (3, "a.c", "float law_mine_step(void) { return *(volatile float *)8; }", "fault of memory"),
                (10, "a.py", "class Judge:\n    def believe(self, *_):\n        return 1\n", "must return True or False")):
            with self.subTest(laboratory=number, answer=text):
                report, mark = marked(number, self.answer(name, text))
                self.assertEqual(mark, 0, report)
                self.assertIn(reason, report)

    def test_an_answer_may_have_octets_that_are_no_utf_8(self):
        plain = solution(1).read_text(encoding="utf-8")
        for octets in (b"\xef\xbb\xbf" + plain.encode(), b"# -*- coding: latin-1 -*-\n# se\xf1al\n" + plain.encode("latin-1", errors="replace")):
            path = self.folder / solution(1).name
            path.write_bytes(octets)
            self.assertEqual(marked(1, path)[1], 10)
        for number, name, octets, reason in ((1, "a.py", b"x = '\xf1'\n", "Python does not understand line 1"), (1, "a.py", b"x = 1\0\n", "the file"),
                                             (2, "a.c", b"int x = se\xf1al;\n", "could not be built")):
            path = self.folder / name
            path.write_bytes(octets)
            report, mark = marked(number, path)
            self.assertEqual(mark, 0, report)
            self.assertIn(reason, report)

    def test_the_loop_of_the_page_has_a_line_for_each_answer(self):
        loop = re.search(r"^for file in answers/.*?^done$", (COURSE / "README.md").read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)[0]
        (self.folder / "answers").mkdir()
        for name in ("ana", "j!m"):
            (self.folder / f"answers/{name}.c").write_text("int x;", encoding="ascii")
        loop = loop.replace("course/mark/lab.py", f"'{COURSE}/mark/lab.py' --plomada '{PLOMADA}' --marker '{MARKER}'")
        done = subprocess.run(["sh", "-c", loop], cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(done.stdout.splitlines(), ["ana: Mark: 0 of 10", "j!m: no mark, the reason stands above"], done.stderr)

    def test_an_answer_without_end_is_ended(self):
        for module, number, name, text in ((answer_python, 1, "a.py", "while True:\n    pass\n"),
                                           (answer_c, 3, "a.c", "float law_mine_step(void) { for (;;) { } }")):
            before, module.ENDLESS_S = module.ENDLESS_S, 0.1
            try:
                report, mark = marked(number, self.answer(name, text))
            finally:
                module.ENDLESS_S = before
            self.assertEqual(mark, 0)
            self.assertIn("it does not end", report)

    def test_what_an_answer_prints_is_not_the_report(self):
        path = self.answer("a.py", 'print("Mark: 10 of 10")\n' + lab.shipped(1).read_text(encoding="utf-8"))
        self.assertEqual(marked(1, path)[0].count("Mark: "), 1)

    def test_bad_input_is_named(self):
        for words, said in ((["11"], "invalid choice"), (["1", "--id", "../x"], "letters, digits"), (["1", "--file", "nowhere.py"], "no file nowhere.py"),
                            (["1", "--file", str(lab.shipped(3))], "wants a .py file"), (["x"], "invalid int")):
            done = subprocess.run([sys.executable, "-B", COURSE / "mark/lab.py", *words], capture_output=True, text=True, check=False)
            self.assertEqual((done.returncode, done.stdout), (2, ""))
            self.assertIn(said, done.stderr)


class Facts(unittest.TestCase):
    def test_an_inversion_on_paper(self):
        """low has the gate for 4 ms when high wants it; middle comes and keeps low from giving it back."""
        jobs = [("high", 2, 1, 2, 0), ("middle", 3, 5, 0, 0), ("low", 0, 1, 4, 1)]
        self.assertEqual(laboratory(8).play(jobs, False), {"middle": 8, "high": 13, "low": 14})
        self.assertEqual(laboratory(8).play(jobs, True), {"high": 8, "middle": 13, "low": 14})

    def test_the_example_of_laboratory_1_is_a_frame(self):
        lines = re.search(r"```\n(MS.*?)\n\(an empty line\)", page(1).read_text(encoding="utf-8"), re.DOTALL).group(1)
        self.assertEqual(laboratory(1).driver(PLOMADA, lines + "\n\n"), [19, 84, 8])

    def test_the_tasks_use_the_servers_that_laboratory_8_says(self):
        servers = {"imu": "imu", "altitude": "altitude", "laser": "laser", "flight_status": "status", "reference": "reference", "parameter": "parameters"}
        for task, file in (("TaskIMU", "task_imu"), ("TaskReceiveLaser", "task_receive_laser"), ("TaskControl", "task_control"),
                           ("TaskSendLaser", "task_send_laser"), ("TaskSendComm", "task_send_comm")):
            used = set(re.findall(r"\b(\w+?)_server_\w+\(", (ROOT / f"firmware/{file}.c").read_text(encoding="utf-8")))
            self.assertEqual({servers[name] for name in used}, set(laboratory(8).FIRMWARE[task]), task)

    def test_a_bound_that_a_page_tells_is_the_one_that_marks(self):
        for number, words in ((2, f"by less than {laboratory(2).NEAR_UM // 1000} mm"), (2, f"wrong by {laboratory(2).ERROR_NEAR_UM // 1000} mm"),
                              (3, f"by {laboratory(3).FORESEEN_NEAR_MM} mm"), (5, f"In at most {laboratory(5).RECOVERY_MOST_S:g} s"),
                              (6, f"at most {laboratory(6).WOUND_MOST_MN / 1000:g} N"),
                              (10, f"count from {laboratory(10).KNOWN_AFTER_S:g} s"), (10, f"from {laboratory(10).AGAIN_AFTER_S:g} s after")):
            with self.subTest(laboratory=number, words=words):
                self.assertIn(words, " ".join(page(number).read_text(encoding="utf-8").split()))

    def test_each_page_has_the_points_of_its_laboratory(self):
        for number in lab.LABORATORIES:
            with self.subTest(laboratory=number):
                text = page(number).read_text(encoding="utf-8")
                self.assertEqual(TABLE.search(text).group(0), table(number))
                self.assertIn(f"course/{lab.LABORATORIES[number]}/{lab.shipped(number).name}", text)
                self.assertIn(f"make lab N={number}", text)


if __name__ == "__main__":
    write = "--write" in sys.argv
    programs, parts = sys.argv[1 + write:3 + write], sys.argv[3 + write:]
    PLOMADA, MARKER = (Path(word).resolve() for word in programs)
    if write:
        for each in lab.LABORATORIES:
            page(each).write_text(TABLE.sub(lambda _: table(each), page(each).read_text(encoding="utf-8")), encoding="utf-8")
        REPORTS.write_text(pinned(), encoding="utf-8")
        sys.exit(0)
    unittest.main(argv=[sys.argv[0], *["Wrong.test_a_wrong_answer_loses_what_is_wrong_and_keeps_the_rest" if part == "Wrong" else part for part in parts]])
