"""tools/size/size.py finds what it is there for: call graphs and sections made up here, each with one fault."""
import contextlib
import io
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/size"))
import size  # noqa: E402

TABLE = """root   task  TaskA  task_a   reason
root   swi   SwiA   swi_a    reason
root   clock  Tick  tick_a   reason
root   hwi   HwiA   hwi_a    reason
root   main  main   main     reason
calls  dispatch  firmware/a.c:handlers  reason
calls  ring      listen()               reason
cells  30   library_*        reason
cells  100  Semaphore_pend   reason
"""
SOURCE = """static void (*const handlers[])(void) = {[START] = on_start, [STOP] = on_stop, NULL};
void main(void)
{
    listen(1, on_ring);
    Task_create(task_a, &params, NULL);
    Swi_create(swi_a, &params, NULL);
}
"""
CALLS = {"main": [], "task_a": ["work", "Semaphore_pend"], "swi_a": ["work"], "tick_a": [], "hwi_a": ["dispatch", "ring"],
         "work": ["library_sum"], "dispatch": ["__indirect_call"], "ring": ["__indirect_call"], "on_start": [], "on_stop": [],
         "on_ring": []}
BYTES = {"work": 40, "task_a": 20, "on_stop": 60, "on_ring": 10}


def graph(calls, sizes, kind="static"):
    """What gcc -fcallgraph-info=su writes."""
    lines = [f'node: {{ title: "{name}" label: "{name}\\na.c:1:1\\n{sizes.get(name, 0)} bytes ({kind})" }}' for name in calls]
    outside = {callee for callees in calls.values() for callee in callees} - set(calls)
    lines += [f'node: {{ title: "{name}" label: "{name}\\na.h:1:1" shape : ellipse }}' for name in outside]
    lines += [f'edge: {{ sourcename: "{name}" targetname: "{callee}" label: "a.c:1:1" }}'
              for name, callees in calls.items() for callee in callees]
    return "\n".join(lines)


class Graphs(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)
        for name, value in (("ROOT", self.dir), ("HERE", self.dir), ("product", lambda: ["firmware/a.c"])):
            self.addCleanup(setattr, size, name, getattr(size, name))
            setattr(size, name, value)

    def stacks(self, table=TABLE, source=SOURCE, sizes=None, kind="static", **calls):
        (self.dir / "stacks.txt").write_text(table, encoding="utf-8")
        (self.dir / "firmware").mkdir(exist_ok=True)
        (self.dir / "firmware/a.c").write_text(source, encoding="utf-8")
        (self.dir / "a.ci").write_text(graph({**CALLS, **calls}, sizes or BYTES, kind), encoding="utf-8")
        found = size.Stacks({"firmware/a.c": self.dir / "a.o"})
        self.worst = {kind: found.worst(kind) for kind in ("task", "swi", "clock", "hwi", "main")}
        found.check_roots()
        return found

    def problems(self, **changes):
        return list(dict.fromkeys(self.stacks(**changes).problems))

    def test_a_house_in_order_has_no_problem_and_the_deepest_path_counts(self):
        self.assertEqual(self.problems(), [])
        self.assertEqual(self.worst["task"], [("TaskA", 10 + size.CALL + 100, ("task_a", "Semaphore_pend"))])
        self.assertEqual(self.worst["swi"], [("SwiA", 20 + 30 + 2 * size.CALL, ("swi_a", "work", "library_sum"))])
        self.assertEqual(self.worst["hwi"], [("HwiA", 30 + 3 * size.CALL, ("hwi_a", "dispatch", "on_stop"))])

    def test_a_clone_goes_by_its_name(self):
        self.assertEqual(self.problems(**{"hwi_a": ["dispatch.constprop.0", "ring"], "dispatch.constprop.0": ["__indirect_call"]}), [])

    def test_what_a_library_calls_back_lies_on_its_stack(self):
        table = TABLE + "calls  library_sum  on_start  reason\n"
        self.assertEqual(self.problems(table=table, sizes={**BYTES, "on_start": 200}), [])
        self.assertEqual(self.worst["swi"],
                         [("SwiA", 20 + 30 + 100 + 3 * size.CALL, ("swi_a", "work", "library_sum", "on_start"))])
        self.assertEqual(self.problems(table=table, on_start=["Semaphore_pend"])[-1:],
                         ["hwi_a (hwi) may reach Semaphore_pend(), which blocks"])
        self.assertEqual(self.problems(table=table, work=[]), ["tools/size/stacks.txt: library_sum() calls through no pointer"])

    def test_a_recursion(self):
        self.assertEqual(self.problems(work=["task_a"])[-1:], ["swi_a (swi) may reach Semaphore_pend(), which blocks"])
        self.assertIn("task_a: recursion", self.problems(work=["task_a"]))

    def test_a_callee_that_nobody_knows(self):
        self.assertEqual(self.problems(work=["puzzle"]), ["puzzle: nobody knows its stack"])

    def test_a_call_through_a_pointer_without_a_row(self):
        self.assertEqual(self.problems(work=["__indirect_call"]), ["work(): calls through a pointer, nobody knows whom"])

    def test_a_row_for_a_pointer_that_is_gone(self):
        self.assertEqual(self.problems(ring=[]), ["tools/size/stacks.txt: ring() calls through no pointer"])

    def test_a_target_that_is_gone(self):
        self.assertEqual(self.problems(source=SOURCE.replace("on_ring", "on_bell")), ["on_bell(): no such function"])

    def test_a_frame_without_bound(self):
        self.assertEqual(self.problems(kind="dynamic")[0], "firmware/a.c: main: a stack frame without bound")

    def test_an_interrupt_that_may_block(self):
        for root, kind in (("swi_a", "swi"), ("hwi_a", "hwi"), ("tick_a", "clock")):
            with self.subTest(root=root):
                self.assertEqual(self.problems(**{root: ["Semaphore_pend"], "dispatch": ["__indirect_call"],
                                                  "task_a": ["work", "dispatch", "ring"]}),
                                 [f"{root} ({kind}) may reach Semaphore_pend(), which blocks"])

    def test_a_block_behind_a_pointer(self):
        self.assertEqual(self.problems(on_start=["Semaphore_pend"]), ["hwi_a (hwi) may reach Semaphore_pend(), which blocks"])

    def test_a_task_without_a_root(self):
        self.assertEqual(self.problems(source=SOURCE.replace("(task_a,", "(work,")),
                         ["firmware/a.c: work: no root in tools/size/stacks.txt"])

    def test_a_root_that_is_gone(self):
        self.assertEqual(self.problems(table=TABLE + "root  task  TaskB  task_b  reason\n"), ["task_b(): no such function"])


class Limits(unittest.TestCase):
    sizes = {"firmware/flight_recorder.c": 16014, "bsp/retained.c": 8, "firmware/a.c": 100}

    def ram(self, **changes):
        problems = []
        size.ram_tables({path: {"data": 0, "bss": 2 * cells} for path, cells in {**self.sizes, **changes}.items()}, problems)
        return problems

    def flash(self, cells, constant=0):
        problems = []
        sizes = {"firmware/a.c": {"code": 2 * (cells - constant) - 100, "constant": 2 * constant, "data": 100, "bss": 0}}
        size.flash_table(sizes, {"firmware/a.c": dict.fromkeys(("code", "constant", "data"), 1)}, problems)
        return problems

    def test_the_variables_fit_their_region_and_not_a_cell_more(self):
        room = size.region("RAMGS39")
        self.assertEqual(self.ram(**{"firmware/a.c": room}), [])
        self.assertEqual(self.ram(**{"firmware/a.c": room + 1}), [f".ebss: {room + 1} of {room} cells"])

    def test_what_outlives_a_reset_fits_its_region(self):
        self.assertEqual(self.ram(**{"bsp/retained.c": 17}), [".retained: 17 of 16 cells"])

    def test_the_code_fits_the_flash_twice(self):
        room = size.region("FLASH")
        self.assertEqual(self.flash(room // 2), [])
        self.assertEqual(len(self.flash(room // 2 + 1)), 1)

    def test_constants_fit_sector_a_too_and_not_more_than_it_has(self):
        room, sector = size.region("FLASH"), size.region("FLASHA")
        self.assertEqual(self.flash(room // 2 + 1000, 1000), [])
        self.assertEqual(len(self.flash(room // 2 + 1001, 1000)), 1)
        self.assertEqual(len(self.flash((room + sector) // 2 + 1, sector)), 1)

    def test_a_stack_needs_its_margin_and_its_interrupts(self):
        problems = []
        self.assertEqual(size.stack_row(problems, "TaskA", (80, 100), 75, 200), ("TaskA", 80, 100, 200, 200, 0, ""))
        self.assertEqual(problems, [])
        size.stack_row(problems, "TaskA", (101, 80), 75, 200)
        self.assertEqual(problems, ["stack of TaskA: 202 of 200 cells"])


class Document(unittest.TestCase):
    HEAD = "| stack | needed | size | free |\n|---|--:|--:|--:|\n"
    tables = {"stacks": HEAD + "| TaskA | 900 | 1000 | 100 |\n| **all** | 800 | 1000 | 200 |", "compilers": "gcc 1"}

    def setUp(self):
        handle = tempfile.NamedTemporaryFile(mode="w", suffix=".md", delete=False)
        with handle:
            handle.write(f"# Memory\n<!-- stacks -->\n{self.tables['stacks']}\n<!-- end -->\n\n<!-- compilers -->\ngcc 1\n<!-- end -->\n")
        self.addCleanup(Path(handle.name).unlink)
        self.addCleanup(setattr, size, "DOCUMENT", size.DOCUMENT)
        size.DOCUMENT = Path(handle.name)

    def wrong(self, before="", after="", write=False, compilers="gcc 1"):
        stacks = self.tables["stacks"]
        self.assertIn(before, stacks)
        with contextlib.redirect_stdout(io.StringIO()):
            return size.document({"stacks": stacks.replace(before, after, 1), "compilers": compilers}, write)

    def test_the_same_is_the_same(self):
        self.assertEqual(self.wrong(), [])

    def test_a_number_may_be_off_by_a_twentieth_of_the_largest_in_its_row_and_no_more(self):
        self.assertEqual(self.wrong("900 | 1000 | 100", "850 | 1000 | 150"), [])
        self.assertEqual(self.wrong("900 | 1000 | 100", "849 | 1000 | 151"), [["TaskA", "849", "1000", "151"]])
        self.assertEqual(self.wrong("800 | 1000 | 200", "851 | 1000 | 149"), [["**all**", "851", "1000", "149"]])

    def test_a_limit_is_said_to_the_word(self):
        self.assertEqual(self.wrong("900 | 1000", "900 | 1001"), [["TaskA", "900", "1001", "100"]])

    def test_a_row_more_one_less_or_of_another_name(self):
        self.assertEqual(self.wrong("TaskA", "TaskB"), [["TaskB", "900", "1000", "100"]])
        self.assertEqual(len(self.wrong("| TaskA | 900 | 1000 | 100 |\n")), 1)
        self.assertEqual(len(self.wrong("| TaskA", "| TaskC | 1 | 2 | 1 |\n| TaskA")), 1)
        self.assertEqual(len(self.wrong(" | 100 |", " |")), 1)

    def test_another_column_is_another_table(self):
        self.assertEqual(len(self.wrong("needed", "wanted")), 1)

    def test_with_other_compilers_nothing_is_compared(self):
        self.assertEqual(self.wrong("900", "1", compilers="gcc 2"), [])

    def test_it_is_written_on_demand(self):
        self.assertEqual(self.wrong("900", "1", write=True), [])
        self.assertEqual(self.wrong("900", "1"), [])
        self.assertEqual(len(self.wrong()), 1)

    def test_a_table_without_a_place(self):
        with self.assertRaises(SystemExit):
            size.document({**self.tables, "ram": "| 3 |"}, False)


@unittest.skipUnless(shutil.which(size.M68K[0]), "no m68k compiler")
class Compiled(unittest.TestCase):
    """That a compiler says what is read above, and that a cell is a cell."""

    def compiled(self, text):
        out = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, out)
        (out / "a.c").write_text(size.cells.convert(text, "a.c"), encoding="utf-8")
        subprocess.run([*size.M68K, *size.RELEASE, "-c", out / "a.c", "-o", out / "a.o"], check=True, cwd=out)
        return out

    def test_what_takes_a_cell_on_a_c28x_takes_two_bytes(self):
        text = ("typedef struct { bool b; char c; uint_least8_t o; uint16_t w; uint32_t l; float f; void *p; } all_t;\n"
                'all_t all[3]; char text[10]; const char *said = "four";\n')
        found = size.section_bytes("m68k-linux-gnu-size", {"a.c": self.compiled(text) / "a.o"})["a.c"]
        self.assertEqual((found["bss"], found["data"], found["constant"]), (2 * (3 * 10 + 10), 2 * 2, 2 * 5))

    def test_a_call_graph_is_read(self):
        out = self.compiled("int far_away(int *); int (*pointer)(int);\n"
                            "static int inner(int n) { int a[50]; return far_away(a) + n; }\n"
                            "int outer(int n) { return inner(n) + pointer(n) + __builtin_strlen((void *)&n); }\n")
        stacks = size.Stacks({"a.c": out / "a.o"})
        self.assertGreaterEqual(stacks.own["a.c:inner"], 100 + size.CALL)
        self.assertEqual(stacks.callees["outer"], {"a.c:inner", "__indirect_call", "strlen"})
        self.assertEqual(stacks.callees["a.c:inner"], {"far_away"})


if __name__ == "__main__":
    unittest.main(verbosity=2)
