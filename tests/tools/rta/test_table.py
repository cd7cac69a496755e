"""A table is read to the picosecond, or refused with the line and the reason."""
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[3] / "tools/rta"))
import table as tables  # noqa: E402
from analysis import HWI, SWI, TASK  # noqa: E402

HEADER = tables.FIXED + "\n"
LONG_HEADER = tables.FIXED + ",accesses,burst_n,burst_period_ms\n"
A = "A,task,2,10,9.5,0.0024,0.0093,1\n"


class Table(unittest.TestCase):
    def bad(self, line, reason, text):
        with self.assertRaises(tables.Wrong, msg=text) as caught:
            tables.read(text, "t")
        self.assertRegex(str(caught.exception), rf"^t:{line}: .*{reason}", text)

    def test_a_row_is_read_to_the_picosecond(self):
        [row] = tables.read(HEADER + A)
        self.assertEqual((row.name, row.kind, row.priority, row.period, row.deadline), ("A", TASK, 2, 10 ** 10, 95 * 10 ** 8))
        self.assertEqual((row.cost, row.blocking, row.blockings, row.accesses, row.burst_period), (2_400_000, 9_300_000, 1, 0, 0))

    def test_what_interrupts_do_not_have_is_not_looked_at(self):
        first, second, _ = tables.read(HEADER + "I,hwi,HW,0.04,-,0.0024,-,-\nS,Swi,,25,none,0.1,?,-1\n" + A)
        self.assertEqual((first.kind, second.kind, first.blocking, second.blockings), (HWI, SWI, 0, 0))

    def test_blanks_comments_cr_lf_and_a_missing_last_line_end_are_fine(self):
        [row] = tables.read("# mine\r\n\r\nname, kind ,priority,period_ms,deadline_ms,cost_ms,blocking_ms,blockings\r\n"
                            "\t\n A , task , 1 , 10 , 10 , 1 , , - ")
        self.assertEqual(row.name, "A")

    def test_further_columns_are_found_by_name(self):
        interrupt, task = tables.read(tables.FIXED + ",burst_period_ms,accesses,burst_n\nI,hwi,,1,,0.1,,,100,,99\nA,task,1,10,10,1,0,0,,3,\n")
        self.assertEqual((interrupt.burst_n, interrupt.burst_period, task.accesses, task.burst_period), (99, 100 * 10 ** 9, 3, 0))

    def test_jitter_and_who_blocks_are_further_columns_too(self):
        header = tables.FIXED + ",jitter_ms,blocked_by\n"
        table = tables.read(header + "I,hwi,,1,,0.1,,,0.25,\nA,task,2,10,10,1,0.1,1,,B+C\nB,task,1,10,10,1,0,0,,-\nC,task,1,10,10,1,0,0,,\n")
        self.assertEqual(([row.jitter for row in table][0], [row.blocked_by for row in table]), (25 * 10 ** 7, [(), ("B", "C"), (), ()]))
        tables.assign(table, ["I.jitter_ms=0.5"])
        self.assertEqual(table[0].jitter, 5 * 10 ** 8)
        with self.assertRaises(tables.Wrong):
            tables.assign(table, ["A.blocked_by=B"])
        self.bad(2, "A: blocked_by: no such row", tables.FIXED + ",blocked_by\nA,task,2,10,10,1,0.1,1,A+D\n")

    def test_a_wrong_header_is_refused(self):
        for line, text in ((1, ""), (1, A), (2, "\nname,kind,priority\n"), (1, "kind,name" + HEADER[9:] + A)):
            self.bad(line, "the first line must be name,kind", text)
        self.bad(1, "colour: no such column", tables.FIXED + ",colour\n")
        self.bad(1, "cost_ms: twice", tables.FIXED + ",cost_ms\n")

    def test_a_table_without_tasks_is_refused(self):
        self.bad(1, "no task", HEADER)
        self.bad(2, "no task", HEADER + "I,hwi,,1,,0.1,,\n")

    def test_bad_rows_name_their_line_and_column(self):
        self.bad(3, "period_ms: not a time", HEADER + A + "B,task,1,ten,10,1,0,0\n")
        for reason, row in (
                ("priority: not a whole number", "B,task,,10,10,1,0,0"), ("priority", "B,task,-1,10,10,1,0,0"),
                ("priority", "B,task,1000001,10,10,1,0,0"), ("deadline_ms: not a time", "B,task,1,10,,1,0,0"),
                ("cost_ms: must be over 0", "B,task,1,10,10,0,0,0"), ("period_ms: must be over 0", "B,task,1,0.0,10,1,0,0"),
                ("deadline_ms: over 100000", "B,task,1,10,100001,1,0,0"), ("blockings: not a whole number", "B,task,1,10,10,1,0,1.5"),
                ("kind: not hwi, swi or task", "B,thread,1,10,10,1,0,0"), ("name: missing", ",task,1,10,10,1,0,0"),
                ("name: holds", 'B"x,task,1,10,10,1,0,0'), ("7 cells, not 8", "B,task,1,10,10,1,0"), ("9 cells, not 8", "B,task,1,10,10,1,0,0,"),
                *(("cost_ms: not a time", f"B,task,1,10,10,{cost},0,0") for cost in ("nan", "1e3", "-1", "1.", ".5", "1.2.3", "١"))):
            self.bad(2, reason, HEADER + row + "\n")
        self.bad(3, "A: twice", HEADER + A + A)
        for frames, reason in ((",5,", "go together"), (",,5", "go together"), (",5,0", "burst_period_ms: must be over 0")):
            self.bad(2, reason, LONG_HEADER + f"I,hwi,,1,,0.1,,,{frames}\n" + A)

    def test_any_cut_of_a_table_is_read_or_refused(self):
        whole = tables.text_of("plomada")
        for length in range(0, len(whole), 3):
            try:
                tables.read(whole[:length])
            except tables.Wrong as error:
                self.assertRegex(str(error), r"^table:\d+: .")

    def test_one_number_of_one_row_can_be_set(self):
        interrupt, task = table = tables.read(HEADER + "I.x,hwi,,1,,0.1,,\n" + A)
        tables.assign(table, ["A.period_ms=25.5", "I.x.cost_ms=0.2", "A.burst_period_ms=50", "A.burst_n=4"])
        self.assertEqual((task.period, interrupt.cost, task.burst_n, task.burst_period), (255 * 10 ** 8, 2 * 10 ** 8, 4, 50 * 10 ** 9))

    def test_what_cannot_be_set_says_why(self):
        for assignment, reason in (
                ("A", "ROW.COLUMN=VALUE"), ("A=3", "ROW.COLUMN=VALUE"), ("=", "ROW.COLUMN=VALUE"), ("B.cost_ms=1", "no such row"),
                ("A.colour=1", "no such number"), ("A.name=C", "no such number"), ("A.kind=hwi", "no such"), ("I.deadline_ms=3", "no such"),
                ("A.cost_ms=", "not a time"), ("A.cost_ms=0", "over 0"), ("A.priority=x", "whole number"), ("A.burst_n=3", "go together")):
            with self.assertRaises(tables.Wrong, msg=assignment) as caught:
                tables.assign(tables.read(HEADER + "I,hwi,,1,,0.1,,\n" + A), [assignment])
            self.assertIn(reason, str(caught.exception))


if __name__ == "__main__":
    unittest.main()
