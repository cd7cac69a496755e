"""check_trace.py finds what is wrong with a trace, and nothing with a right one."""
import json
import unittest

import check_trace


def label(pid, tid, name):
    return [{"ph": "M", "pid": pid, "tid": 0, "name": "process_name", "args": {"name": "group"}},
            {"ph": "M", "pid": pid, "tid": tid, "name": "thread_name", "args": {"name": name}}]


def span(pid, tid, name, begin, end):
    return {"ph": "X", "pid": pid, "tid": tid, "name": name, "ts": begin, "dur": end - begin, "args": {}}


def run(tid, name, begin, end):
    return [span(1, 1, name, begin, end), span(2, tid, "runs", begin, end)]


LABELS = (label(1, 1, "runs") + label(2, 96, "Hwi 96 RX") + label(2, 1001, "Swi 2 Swi") + label(2, 2000, "Task 1 low")
          + label(2, 2001, "Task 9 high") + label(3, 1, "server"))
# low 0..10, a Hwi, low in the gate, high waits for it, low, high.
GOOD = (LABELS
        + run(2000, "low", 0, 10) + run(96, "RX", 10, 12.5) + [span(2, 96, "RX", 10, 12.5)]
        + run(2000, "low", 12.5, 20) + run(2001, "high", 20, 25) + [span(2, 2001, "waits for server", 25, 30)]
        + run(2000, "low", 25, 30) + [span(3, 1, "low", 15, 30), span(3, 1, "high", 30, 40)]
        + run(2001, "high", 30, 40) + [span(2, 2001, "high", 20, 40)]
        + run(2000, "low", 40, 45) + [span(2, 2000, "low", 0, 45)]
        + run(1001, "Swi", 45, 50) + [span(2, 1001, "Swi", 45, 50)])


def complaints(events):
    return check_trace.complaints(json.dumps({"traceEvents": events}))


class CheckTrace(unittest.TestCase):
    def refuse(self, events, wanted):
        found = complaints(events)
        self.assertTrue(any(wanted in complaint for complaint in found), found)

    def test_a_right_trace(self):
        self.assertEqual([], complaints(GOOD))

    def test_what_is_no_json(self):
        self.assertTrue(check_trace.complaints('{"traceEvents":[,]}')[0].startswith("not a trace"))
        self.assertTrue(check_trace.complaints('[]')[0].startswith("not a trace"))

    def test_an_empty_trace(self):
        self.refuse(LABELS, "nothing runs")

    def test_a_missing_field(self):
        self.refuse(GOOD + [{"ph": "X", "pid": 1, "tid": 1, "name": "low", "ts": 100, "args": {}}], "field is missing")

    def test_an_unknown_phase(self):
        self.refuse(GOOD + [{"ph": "B", "pid": 1, "tid": 1, "name": "low", "ts": 100}], "phase 'B'")

    def test_a_negative_length(self):
        self.refuse(GOOD + run(2000, "low", 100, 99), "ends before it begins")

    def test_a_track_without_a_name(self):
        self.refuse(GOOD + run(2002, "mid", 100, 101), "track (2, 2002) has no name")

    def test_two_jobs_on_the_processor(self):
        self.refuse(GOOD + run(2001, "high", 49.999, 60), "track (1, 1)")

    def test_two_tasks_in_a_gate(self):
        self.refuse(GOOD + [span(3, 1, "low", 39, 41)], "track (3, 1)")

    def test_spans_that_cross(self):
        self.refuse(GOOD + [span(2, 2000, "low", 44, 60)], "track (2, 2000)")

    def test_a_run_that_the_processor_does_not_know(self):
        self.refuse(GOOD + [span(2, 2000, "runs", 60, 61)], "low: 27500 ns on the processor, 28500 ns on its track")

    def test_a_task_that_runs_while_an_interrupt_waits(self):
        self.refuse(GOOD + run(2000, "low", 60, 70) + run(96, "RX", 70, 72) + [span(2, 96, "RX", 69, 72)], "while Hwi RX")

    def test_a_task_that_runs_while_a_swi_waits(self):
        self.refuse(GOOD + run(2000, "low", 60, 70) + run(1001, "Swi", 70, 72) + [span(2, 1001, "Swi", 61, 72)],
                    "while Swi Swi")

    def test_a_swi_that_runs_while_an_interrupt_waits(self):
        self.refuse(GOOD + run(1001, "Swi", 60, 70) + run(96, "RX", 70, 72) + [span(2, 96, "RX", 69, 72)], "while Hwi RX")

    def test_a_task_that_runs_while_it_waits(self):
        self.refuse(GOOD + [span(2, 2000, "waits for server", 8, 11)], "runs and waits")


if __name__ == "__main__":
    unittest.main()
