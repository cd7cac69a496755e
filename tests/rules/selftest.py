"""Each rule is fed a good house, where it must be silent, and bad ones, where it must name the fault and nothing else."""
import json
import shutil
import tempfile
import unittest
from pathlib import Path

import chosen
import commands
import house
import includes
import inside
import length
import mirror
import pages
import places
import published
import room
import sources
import state
import version
import walk
import words

REPOSITORY = Path(__file__).resolve().parents[2]

GOOD = {
    "cmake/sources.cmake": "set(CONTROL_SOURCES control/a.c)\nset(DRIVERS_SOURCES drivers/b.c)\n"
                           "set(BSP_SOURCES bsp/c.c)\nset(FIRMWARE_SOURCES\n    firmware/d.c) # all\n",
    "control/a.h": "#include <stdint.h>\n/* 8 ticks, no task, a double look */\n",
    "control/a.c": '#include <math.h>\n#include "control/a.h"\nint16_t a(void)\n{\n    return 1;\n}\n',
    "drivers/b.h": "#include <stdbool.h>\n",
    "drivers/b.c": '#include "drivers/b.h"\nconst char *const b = "no /* comment, \\" malloc(1)";\n',
    "bsp/c.h": "#include <stdint.h>\n",
    "bsp/c.c": '#include "driverlib.h"\n#include "bsp/c.h"\n#include "inc/hw_memmap.h"\n',
    "firmware/d.c": '#include <xdc/std.h>\n#include <ti/sysbios/knl/Task.h>\n#include "control/a.h"\n#include "drivers/b.h"\n#include "bsp/c.h"\n',
    "sim/devices/e.h": "",
    "sim/devices/e.c": '#include "sim/devices/e.h"\n#include <stdio.h>\n',
    **{f"tests/{name}.c": "void test_it_works(void)\n{\n    TEST_ASSERT_TRUE(works());\n}\n"
       for name in ("control/test_a", "drivers/test_b", "bsp/test_c", "firmware/test_d")},
    "tests/rules/excuses.txt": "# none\n",
    "tests/fixtures/stream.txt": "as recorded \n",
}


class Sample(unittest.TestCase):
    def setUp(self):
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        for path, text in GOOD.items():
            self.write(path, text)
        self.write("cmake/poison.txt", (REPOSITORY / "cmake/poison.txt").read_text(encoding="utf-8"))

    def write(self, path, text):
        (self.root / path).parent.mkdir(parents=True, exist_ok=True)
        (self.root / path).write_text(text, encoding="utf-8")

    def complaints(self, rule):
        return rule.check(house.House(self.root))

    def assert_one(self, rule, start, *mentioned):
        found = self.complaints(rule)
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith(start), found[0])
        for word in mentioned:
            self.assertIn(word, found[0])


class Circles(Sample):
    def test_calls_that_come_back_are_one(self):
        self.write("control/b.h", "void b(void);\n")
        self.write("control/b.c", '#include "control/b.h"\nvoid b(void)\n{\n    (void)a();\n}\n')
        self.assertEqual(room.circles(room.called(house.House(self.root))), [])
        self.write("control/a.c", '#include "control/a.h"\nint16_t a(void)\n{\n    b();\n    return 1;\n}\n')
        self.assertEqual(room.circles(room.called(house.House(self.root))), ["control/a -> control/b -> control/a"])

    def test_a_function_of_the_file_alone_is_no_call_of_another(self):
        self.write("control/b.c", "static int16_t a(void)\n{\n    return 2;\n}\n")
        self.assertEqual(room.circles(room.called(house.House(self.root))), [])

    def test_includes_that_come_back_are_one(self):
        self.write("control/b.h", '#include "control/a.h"\n')
        self.write("control/a.h", '#include "control/b.h"\n')
        self.assertEqual(room.circles(room.included(house.House(self.root))), ["control/a -> control/b -> control/a"])


class Origins(Sample):
    def test_a_constant_that_is_as_one_that_is_not_there_is_named(self):
        self.write("drivers/b.h", "#define LEAST_M 1\n")
        self.write("control/a.c", "#define MOST_M 2 /* as LEAST_M in b.h */\n")
        self.assertEqual(room.origins(house.House(self.root)), [])
        self.write("control/a.c", "#define MOST_M 2 /* as GONE_M in b.h */\n")
        self.assertEqual(len(room.origins(house.House(self.root))), 1)
        self.write("control/a.c", "#define MOST_M 2 /* as MOST_M in a.c */\n")
        self.assertEqual(len(room.origins(house.House(self.root))), 1)


class Chosen(Sample):
    def count(self, text):
        self.write("control/a.c", text)
        return [name for _, _, name in chosen.choices(house.House(self.root))]

    def test_a_constant_that_says_chosen_or_tried_counts(self):
        self.assertEqual(self.count("#define A_M 0.5F /* chosen: half */\n#define B_M 2U /* Tried 1 to 3 */\n"), ["A_M", "B_M"])

    def test_a_comment_that_goes_on_or_stands_above_or_below_counts(self):
        self.assertEqual(self.count("#define A_M \\\n    0.5F /* a length,\n          * chosen */\n"), ["A_M"])
        self.assertEqual(self.count("/* chosen: half of it,\n * about */\n#define A_M 0.5F\n"), ["A_M"])
        self.assertEqual(self.count("int16_t a; /* chosen */\n#define A_M 5\n"), [])

    def test_a_measure_without_a_comment_counts_and_a_flag_does_not(self):
        self.assertEqual(self.count("#define A_M 0.5F\n#define B_US UINT32_C(300000)\n#define FLAG 4U\n"), ["A_M", "B_US"])

    def test_a_source_or_a_formula_does_not_count(self):
        self.assertEqual(self.count("#define A_M 0.5F /* data sheet, 3.1 */\n#define B_M (3.0F * NOISE_M)\n#define C_M NOISE_M\n"), [])

    def test_a_formula_with_a_factor_that_is_chosen_counts(self):
        self.assertEqual(self.count("#define B_M (3.3F * NOISE_M) /* chosen */\n"), ["B_M"])

    def test_a_table_counts_once(self):
        self.assertEqual(self.count("/* Chosen. */\nstatic const float most[2] = {1.0F, 2.0F};\n"), ["most"])

    def test_a_word_in_the_code_is_no_source(self):
        self.assertEqual(self.count("int16_t chosen = 0;\n/* the chosen law */\nint16_t b;\n"), [])

    def test_one_more_than_excused_is_named_and_far_fewer_are(self):
        self.write("tests/rules/excuses.txt", "chosen control:constants 1 made by hand\n")
        self.write("control/a.c", "#define A_M 0.5F /* chosen */\n#define B_M 0.5F /* chosen */\n")
        self.assert_one(chosen, "control:constants: 2 ")
        self.write("tests/rules/excuses.txt", "chosen control:constants 9 made by hand\n")
        self.assert_one(chosen, "tests/rules/excuses.txt: ")


class Walk(Sample):
    """Calls as (file, function); None ends one."""
    STEP, A, B, C = ("flight.c", "step"), ("a.c", "a"), ("b.c", "b"), ("c.c", "c")

    def returns(self, *cycle):
        return walk.returns(cycle, {self.STEP, self.A, self.B, self.C, ("a.c", "later")})

    def test_a_file_that_was_left_counts_when_the_walk_comes_back(self):
        self.assertEqual(self.returns(self.STEP, self.A, None, self.B, None, ("a.c", "later"), None, None), 1)

    def test_a_file_is_not_left_while_a_function_of_it_is_open(self):
        self.assertEqual(self.returns(self.STEP, self.A, self.B, None, ("a.c", "later"), None, None, None), 0)

    def test_one_visit_after_another_is_none(self):
        self.assertEqual(self.returns(self.STEP, self.A, self.B, None, None, self.C, None, None), 0)

    def test_a_loop_is_read_once(self):
        self.assertEqual(self.returns(self.STEP, self.A, None, self.B, None, self.A, None, self.B, None, None), 0)

    def test_a_question_is_no_place(self):
        self.assertEqual(self.returns(self.STEP, self.A, None, self.B, None, ("a.c", "is_so"), None, None), 0)

    def test_what_gets_a_pointer_that_is_not_const_changes_something(self):
        self.write("control/a.c", "static float most_n(const a_t *a, float b)\n{\n}\n\nvoid a_step(a_t *a, const b_t *b)\n{\n}\n")
        self.assertEqual(walk.changing(house.House(self.root)), {("control/a.c", "a_step")})


class GoodHouse(Sample):
    def test_no_rule_complains(self):
        for rule in (includes, words, sources, mirror, length, state):
            self.assertEqual(self.complaints(rule), [], rule.__name__)


class Includes(Sample):
    def test_each_room_refuses_what_is_not_its_own(self):
        for path, line in (
                ("control/a.c", '#include "b.h"'),
                ("control/a.c", '#include "drivers/b.h"'),
                ("control/a.c", '#include "a.h"'),
                ("control/a.c", "#include <stdio.h>"),
                ("control/a.c", '#include "../drivers/b.h"'),
                ("control/a.h", "#  include  <ti/sysbios/BIOS.h>"),
                ("drivers/b.c", '#include "a.h"'),
                ("drivers/b.c", "#include <stdlib.h>"),
                ("drivers/b.c", '#include "driverlib.h"'),
                ("bsp/c.c", '#include "a.h"'),
                ("bsp/c.c", "#include <xdc/std.h>"),
                ("bsp/c.h", '#include "driverlib.h"'),
                ("bsp/c.c", '#include "chip.h"'),
                ("firmware/d.c", '#include "driverlib.h"'),
                ("firmware/d.c", '#include "kernel.h"'),
                ("firmware/d.c", '#include "a.h"'),
                ("firmware/d.c", '#include "sim/devices/e.h"'),
                ("firmware/d.c", "#include <pthread.h>"),
                ("firmware/d.c", "#include HEADER"),
                ("sim/devices/e.c", '#include "drivers/b.h"'),
                ("sim/devices/e.c", '#include "b.h"'),
        ):
            with self.subTest(path=path, line=line):
                self.write(path, "\n" + line + "\n")
                self.assert_one(includes, f"{path}:2:")
                self.write(path, GOOD[path])

    def test_a_comment_includes_nothing(self):
        self.write("control/a.c", '/*\n#include "b.h"\n*/\n// #include <stdio.h>\n')
        self.assertEqual(self.complaints(includes), [])


class Words(Sample):
    def test_each_room_refuses_its_poison(self):
        for path, line, word in (
                ("control/a.c", "/* an uint8_t */", "uint8_t"),
                ("drivers/b.h", "int8_t x;", "int8_t"),
                ("bsp/c.c", "double x;", "double"),
                ("firmware/d.c", "x = sprintf(y);", "sprintf"),
                ("drivers/b.c", "strtod(p, 0);", "strtod"),
                ("drivers/b.c", "void *p = malloc(3);", "malloc"),
                ("drivers/b.c", "free (p);", "free"),
                ("control/a.c", "#ifdef UNIT_TEST", "UNIT_TEST"),
                ("control/a.c", "#ifdef SIM", "SIM"),
                ("control/a.c", "#if defined(__linux__)", "__linux__"),
                ("control/a.c", "x = sqrt(y);", "sqrt"),
                ("control/a.c", "unsigned char c;", "unsigned char"),
                ("bsp/c.c", "chip_reset();", "chip_reset("),
                ("control/a.c", "octet_t x;", "octet_t"),
                ("control/a.c", "int taskPeriod;", "taskPeriod"),
                ("control/a.c", "#define MAX_TICKS 3", "MAX_TICKS"),
                ("drivers/b.c", "float kp_gain;", "kp_gain"),
                ("drivers/b.c", "Task_create();", "Task_create"),
                ("bsp/c.c", "int scan_count;", "scan_count"),
                ("firmware/d.c", "SCI_writeCharArray(x);", "SCI_writeCharArray"),
                ("firmware/d.c", "HWREGH(x) = 1;", "HWREGH"),
                ("firmware/d.c", "height_mm * 0.001F", "0.001F"),
                ("docs/x.md", "see /home/me/file", "/home/m"),
                ("docs/x.md", "as issue 12 says", "issue 12"),
                ("docs/x.md", "ends in blanks  ", "blank"),
        ):
            with self.subTest(path=path, line=line):
                self.write(path, "\n" + line + "\n")
                self.assert_one(words, f"{path}:2:", word)
                if path in GOOD:
                    self.write(path, GOOD[path])
                else:
                    (self.root / path).unlink()

    def test_only_whole_words_are_meant(self):
        self.write("control/a.c", "doubled, sine, printing, free_fall_m, blocked, asin_table, x = 0.5F;\n")
        self.write("firmware/d.c", "x = 0.0F; height_mm = altitude.height_mm; Swi_post(laser_swi);\n")
        self.write("docs/x.md", "the net/{0}/{1} page, ~/{1}/x, https://x.org/{2}/\n".format("work", "home", "root"))
        self.assertEqual([text for text in self.complaints(words) if "docs" not in text], [])

    def test_a_row_that_cannot_be_read_is_an_error(self):
        self.write("cmake/poison.txt", "product  sounds  code  boom  why\n")
        with self.assertRaises(ValueError):
            self.complaints(words)


class Sources(Sample):
    def test_an_unlisted_file(self):
        self.write("drivers/sub/f.c", "")
        self.assert_one(sources, "drivers/sub/f.c: not in")

    def test_a_file_that_does_not_exist(self):
        (self.root / "bsp/c.c").unlink()
        self.assert_one(sources, "cmake/sources.cmake: bsp/c.c does not exist")

    def test_a_file_listed_twice(self):
        self.write("cmake/sources.cmake", GOOD["cmake/sources.cmake"].replace("control/a.c", "control/a.c control/a.c"))
        self.assert_one(sources, "cmake/sources.cmake: control/a.c twice")

    def test_a_file_in_a_comment_is_not_listed(self):
        self.write("cmake/sources.cmake", GOOD["cmake/sources.cmake"].replace("bsp/c.c", "# bsp/c.c\n"))
        self.assert_one(sources, "bsp/c.c: not in")

    def test_a_list_that_is_missing(self):
        self.write("cmake/sources.cmake", GOOD["cmake/sources.cmake"].replace("BSP_SOURCES", "OTHER_SOURCES"))
        self.assertIn("cmake/sources.cmake: no list BSP_SOURCES", self.complaints(sources))

    def test_a_source_file_in_the_ccs_project(self):
        self.write("ccs_project/main.c", "")
        self.assert_one(sources, "ccs_project/main.c:")


class Mirror(Sample):
    def test_a_source_without_a_test(self):
        (self.root / "tests/drivers/test_b.c").unlink()
        self.assert_one(mirror, "drivers/b.c: no test_b.c")

    def test_a_test_in_another_room_does_not_count(self):
        (self.root / "tests/drivers/test_b.c").rename(self.root / "tests/control/test_b.c")
        self.assert_one(mirror, "drivers/b.c: no test_b.c")

    def test_an_excuse_is_heard_only_for_its_own_rule(self):
        (self.root / "tests/drivers/test_b.c").unlink()
        self.write("tests/rules/excuses.txt", "mirror drivers/b.c trivial\n")
        self.assertEqual(self.complaints(mirror), [])
        self.write("tests/rules/excuses.txt", "length drivers/b.c trivial\n")
        self.assert_one(mirror, "drivers/b.c: no test_b.c")

    def test_stale_excuses(self):
        self.write("tests/rules/excuses.txt", "mirror drivers/b.c trivial\n")
        self.assert_one(mirror, "tests/rules/excuses.txt: drivers/b.c has a test")
        self.write("tests/rules/excuses.txt", "mirror drivers/z.c trivial\n")
        self.assert_one(mirror, "tests/rules/excuses.txt: drivers/z.c does not exist")

    def test_an_empty_test_file(self):
        for text in ("", "void setUp(void) {}\n", "/* void test_x(void) { TEST_PASS(); } */\n", "void test_x(void)\n{\n}\n"):
            with self.subTest(text=text):
                self.write("tests/bsp/test_c.c", text)
                self.assert_one(mirror, "tests/bsp/test_c.c: tests nothing")
        self.write("tests/bsp/test_c.c", GOOD["tests/bsp/test_c.c"])
        self.write("tests/tools/test_x.py", "import unittest\n")
        self.assert_one(mirror, "tests/tools/test_x.py: tests nothing")

    def test_a_test_that_ctest_does_not_run(self):
        listing = {"tests": [{"name": f"test_{stem}"} for stem in "abc"]}
        self.assertEqual(mirror.check_registered(house.House(self.root), json.dumps(listing)),
                         ["tests/firmware/test_d.c: ctest does not run it"])


class Length(Sample):
    @staticmethod
    def function(lines, name="long_one"):
        return f"static void {name}(const float *x,\n        int y)\n{{\n" + "    if (x) { y = '{'; }\n" * lines + "}\n"

    def test_forty_lines_are_enough(self):
        self.write("control/a.c", "struct s {\n" + "    int x;\n" * 50 + "};\n#define M(x) \\\n    { x\n" + self.function(40))
        self.assertEqual(self.complaints(length), [])

    def test_forty_one_are_not(self):
        self.write("control/a.c", self.function(3, "short_one") + self.function(41))
        self.assert_one(length, "control/a.c:8: long_one has 41 lines")

    def test_an_excuse_and_a_stale_one(self):
        self.write("tests/rules/excuses.txt", "length control/a.c:long_one a table\n")
        self.assert_one(length, "tests/rules/excuses.txt: control/a.c:long_one")
        self.write("control/a.c", self.function(41))
        self.assertEqual(self.complaints(length), [])


class State(Sample):
    def test_each_room_refuses_what_hides_or_remembers(self):
        for path, line, word in (
                ("control/a.c", "#ifdef PLOMADA_FAST", "PLOMADA_FAST"),
                ("control/a.c", "#if FAST", "FAST"),
                ("drivers/b.h", "#ifndef LARGE", "LARGE"),
                ("control/a.c", "static int16_t count;", "count"),
                ("control/a.c", "static uint16_t seen[3] = {1U, 2U};", "seen"),
                ("control/a.c", "void f(void) { static bool first = true; }", "first"),
                ("control/a.c", "static const char *name;", "name"),
                ("drivers/b.c", "static int16_t (*handler)(void);", "static int16_t"),
                ("drivers/b.c", "int16_t count;", "count"),
                ("drivers/b.c", "struct s state = {0};", "state"),
                ("control/a.c", "extern int16_t b;", "b: declared"),
                ("control/a.c", "void f(void) { extern const int16_t b; }", "b: declared"),
                ("control/a.c", "int16_t b_read(void);", "b_read: declared"),
                ("firmware/d.c", "extern void bsp_c(uint16_t n);", "bsp_c: declared"),
                ("control/a.h", "extern const int16_t b[3];", "b: control/ does not define it"),
        ):
            with self.subTest(path=path, line=line):
                self.write(path, "\n" + line + "\n")
                self.assert_one(state, f"{path}:2:", word)
                self.write(path, GOOD[path])

    def test_what_is_constant_or_the_rooms_own_is_allowed(self):
        self.write("control/a.h", "#ifndef A_H\n#define A_H\nextern const int16_t table[2];\nint16_t a(void);\n#endif\n")
        self.write("control/a.c", "static const char *const names[] = {\"static int x;\"};\nconst int16_t table[2] = {1, 2};\n"
                   "static int16_t (*const steps[])(void) = {a};\n"
                   "static int16_t sum(const int16_t *x)\n{\n    static const int16_t by[] = {1};\n    int16_t y = 0;\n\n"
                   "    return (int16_t)(y + x[0] * by[0]);\n}\n\nint16_t a(void)\n{\n    return sum(table);\n}\n"
                   "typedef struct {\n    int16_t x;\n} point_t;\nstruct pair {\n    int16_t x;\n};\n")
        self.write("firmware/d.c", "#ifdef FAST\nstatic int16_t count;\n#endif\n")
        self.assertEqual(self.complaints(state), [])

    def test_an_excuse_and_a_stale_one(self):
        self.write("tests/rules/excuses.txt", "state bsp/c.c:edge the linker's\n")
        self.assert_one(state, "tests/rules/excuses.txt: bsp/c.c:edge")
        self.write("bsp/c.c", "extern uint16_t edge[];\n")
        self.assertEqual(self.complaints(state), [])


class Inside(Sample):
    """control/where.h keeps where_t, of which other files read `kind` and write `told`; facts.h publishes what is no secret."""

    def setUp(self):
        super().setUp()
        self.write("control/facts.h", "typedef struct {\n    float height_m;\n} evidence_t;\n")
        self.write("control/where.h", "typedef struct {\n    float since_s;\n} hold_t;\ntypedef struct {\n    int kind, told;\n    hold_t hold[2];\n"
                   "} where_t;\ntypedef struct {\n    int sign;\n} sign_t;\nvoid where_step(where_t *where, const sign_t *sign, const evidence_t *evidence);\n"
                   "where_t where_made(void);\nvoid evidence_write(evidence_t *evidence);\n")
        self.write("control/where.c", "void where_step(where_t *where, const sign_t *sign)\n{\n    where->kind = where->hold[0].since_s > 1;\n}\n")
        self.write("control/a.c", "int a(where_t *where)\n{\n    where->told = 1;\n    return where->kind;\n}\n")

    def counted(self, body, before=""):
        self.write("tests/control/test_a.c", before + "void test_it(void)\n{\n" + body + "\n}\n")
        return sorted(set(sum(inside.lines(house.House(self.root)).values(), [])))

    def test_what_only_its_own_file_names_is_inner(self):
        for body in ("where_t w;\n    w.hold[1].since_s = 2;", "where_t w = {.hold = {{.since_s = 1}}};", "where_t *w;\n    check((*w).hold[0].since_s);",
                     "check(where_made().hold[0].since_s);", "where_t many[2];\n    many[0].hold[0].since_s = 1;",
                     "where_t w;\n    w = (where_t){.kind = 1};", "where_t w;\n    w.kind = 3;", "where_t w;\n    w.kind++;", "HIDDEN.since_s = 1;"):
            with self.subTest(body=body):
                self.assertNotEqual(self.counted(body), [])

    def test_what_the_product_does_a_test_may_do(self):
        for body in ("where_t w;\n    check(w.kind == 3);", "where_t w;\n    w.told = 3;", "evidence_t e;\n    e.height_m = 1;",
                     "sign_t s = {.sign = 1};", "evidence_t e = {.height_m = 1};", "struct {\n    float since_s;\n    } row;\n    row.since_s = 1;",
                     "/* w.hold.since_s */", 'puts("w.hold");'):
            with self.subTest(body=body):
                self.assertEqual(self.counted(body), [])

    def test_a_struct_within_a_tests_own_struct_or_header_is_seen(self):
        self.write("tests/control/case.h", "typedef struct {\n    where_t where;\n} case_t;\nstatic case_t c;\n")
        self.assertEqual(self.counted("c.where.hold[0].since_s = 1;", '#include "case.h"\n'), ["hold_t.since_s", "where_t.hold"])
        self.assertEqual(self.counted("c.where.kind;", "static where_t w;\nstatic struct {\n    where_t where;\n} c;\n"), [])

    def test_a_name_counts_for_the_struct_of_its_own_function(self):
        self.assertEqual(self.counted("evidence_t w;\n    w.height_m = 1;", "void f(where_t *w)\n{\n    use(w);\n}\n"), [])

    def test_more_lines_than_are_excused_and_an_excuse_that_is_too_large(self):
        line = "    w.hold[0].since_s = 1;\n"
        self.counted("where_t w;\n" + line * inside.LIMIT)
        self.assertEqual(self.complaints(inside), [])
        self.counted("where_t w;\n" + line * (inside.LIMIT + 1))
        self.assert_one(inside, f"tests/control:lines: {inside.LIMIT + 1} ")
        self.write("tests/rules/excuses.txt", f"inside {inside.THING} {inside.LIMIT + 1} to fall\n")
        self.assertEqual(self.complaints(inside), [])
        self.write("tests/rules/excuses.txt", f"inside {inside.THING} {inside.LIMIT + 2 + inside.SLACK} to fall\n")
        self.assert_one(inside, "tests/rules/excuses.txt: ")


class Commands(unittest.TestCase):
    PARAMS = "name  unit  limits  default\nKP    N/mm  0..1    0.015\nLAW   -     PD|PID  PID\n"
    PAGE = ("| Command | Unit | Meaning | Limits |\n|---|:--|---|---|\n| `#KP 0.015` | N/mm | gain | 0 … 1 |\n"
              "| `#LAW PD` |  | law | PD\\|PID |\n| `#GET` | | all | |\n| `#HELP` | | | |\n| `#PING n` | | | |\n")
    PACKETS = "<data>" + "".join(f"<packet><payload>{text.encode().hex()}0A</payload></packet>" for text in (
        "#KP 1", "#LAW PD", "#GET", "#GET KP", "#HELP", "#PING 1")) + "</data>"

    VERBS = 'static const verb_t verbs[] = {\n    {"GET", get, ""},\n    {"HELP", help, ""},\n    {"PING", ping, ""},\n};\n'

    def check(self, params=PARAMS, verbs=VERBS, page=PAGE, packets=PACKETS):
        return commands.check(params, verbs, page, packets)

    def test_agreement(self):
        self.assertEqual(self.check(), [])

    def test_each_disagreement_is_named(self):
        self.assertEqual(self.check(page=self.PAGE.replace("#KP", "#KQ")),
                         ["page: no row for #KP", "page: #KQ is no command"])
        self.assertEqual(self.check(page=self.PAGE.replace("N/mm", "N/m")),
                         ["page: #KP unit is 'N/m', the program says 'N/mm'"])
        self.assertEqual(self.check(page=self.PAGE.replace("0 … 1", "0 … 2")),
                         ["page: #KP limits is '0..2', the program says '0..1'"])
        self.assertEqual(self.check(page=self.PAGE.replace("Unit", "Einheit")),
                         ["page: #KP has no column 'unit'", "page: #LAW has no column 'unit'"])
        self.assertEqual(self.check(params=self.PARAMS + "KI    N/mm  0..1   0\n"),
                         ["page: no row for #KI", "packets: none for #KI"])
        self.assertEqual(self.check(packets=self.PACKETS.replace("#LAW".encode().hex(), "#LOW".encode().hex())),
                         ["packets: none for #LAW", "packets: #LOW is no command"])
        self.assertEqual(self.check(page=self.PAGE.replace("| `#HELP` | | | |\n", "")), ["page: no row for #HELP"])
        self.assertEqual(self.check(verbs=self.VERBS.replace("PING", "PONG")),
                         ["page: no row for #PONG", "page: #PING is no command", "packets: none for #PONG",
                          "packets: #PING is no command"])

    def test_subcommands_and_targets_are_those_of_the_page(self):
        told, makefile = "usage:\n\n  fly      flies\n  log      finds\n", "fly: build ## Flies\nhidden:\n"
        page = "| `plomada fly` | flies |\n| `plomada log` | finds |\n| `make fly` | flies |\n"
        self.assertEqual(commands.check_others(told, makefile, page), [])
        self.assertEqual(commands.check_others(told, makefile + "size: ## Measures\n", page.replace("plomada log", "plomada lag")),
                         ["page: no row for plomada log", "page: plomada lag is no command", "page: no row for make size"])


class Published(unittest.TestCase):
    HEADER = ('#define PUBLISHED(NUMBER, STATE, FLAGS, TEXT) \\\n    NUMBER("alt", 3U, "meas_m", 3U, 4U, height_mm, FLIGHT_LOG_MILLI) \\\n'
              '    NUMBER(NULL, 0U, "roll_rad", 4U, 4U, roll_rad, FLIGHT_LOG_4) \\\n    TEXT("laser", laser) \\\n'
              '    STATE("state", "state") \\\n    DERIVED("pulse_us", 1U, 2U, flight.pulse_us, to_pulse, flight.thrust_n) \\\n'
              '    NAME("limit", flight.bound, bound_name, 7U, 5U) \\\n    BEAM("mf", MIRROR_FRONT) \\\n    BEAM("m1", MIRROR_AFT) \\\n'
              '    SET("out", beams.left_out)\n/* clang-format on */\n')
    REASONS = 'static const char *const reason_names[] = {\n    [NONE] = "-", [STEPS] = "SIGHT/steps", [REST] = "IMU/rest",\n};\n'
    BOUNDS = 'static const char *const names[] = {\n    [NONE] = "-",\n    [CLIMB] = "CLIMB",\n};\n'
    PAGE = ("| field | unit | decimals | meaning |\n|---|---|---|---|\n| `alt` | m | 3 | height |\n| `laser` | - | - | status |\n"
            "| `state` | - | - | state |\n\n| column | unit | decimals | meaning |\n|---|---|---|---|\n| `t_s` | s | 3 | time |\n"
            "| `meas_m` | m | 3 | height |\n| `roll_rad` | rad | 4 | roll |\n| `state` | - | - | state |\n"
            "| `pulse_us` | us | 1 | pulse |\n| `limit` | - | - | limit |\n| `mf_rays`, `m1_rays` | - | 0 | rays |\n"
            "| `mf_mm`, `m1_mm` | mm | 0 | slant |\n| `mf_spread_mm`, `m1_spread_mm` | mm | 0 | spread |\n"
            "| `mf_ms`, `m1_ms` | ms | 0 | age |\n| `mf_lie`, `m1_lie` | % | 0 | liar |\n| `out` | - | - | left out |\n\n"
            "| doubt | what |\n|---|---|\n| `SIGHT/steps` | steps |\n| `IMU/rest` | rest |\n\n| limit | holds |\n|---|---|\n| `CLIMB` | climb |\n")

    def complaints(self, header=HEADER, page=PAGE):
        with tempfile.TemporaryDirectory() as name:
            root = Path(name)
            for path, text in (("firmware/published.h", header), ("docs/operator.md", page), ("control/sense/verdict.c", self.REASONS),
                               ("control/bounds.c", self.BOUNDS)):
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text, encoding="utf-8")
            return published.check(root)

    def test_a_page_that_tells_the_table_is_good(self):
        self.assertEqual(self.complaints(), [])

    def assert_one(self, found, *mentioned):
        self.assertEqual(len(found), 1, found)
        for word in mentioned:
            self.assertIn(word, found[0])

    def test_a_field_or_a_column_without_a_row_is_named(self):
        self.assert_one(self.complaints(page=self.PAGE.replace("| `laser` | - | - | status |\n", "")), "field", "laser")
        self.assert_one(self.complaints(page=self.PAGE.replace("| `roll_rad` | rad | 4 | roll |\n", "")), "column", "roll_rad")

    def test_another_unit_or_number_of_decimals_is_named(self):
        self.assert_one(self.complaints(page=self.PAGE.replace("`alt` | m |", "`alt` | mm |")), "alt", "'m'")
        self.assert_one(self.complaints(page=self.PAGE.replace("rad | 4", "rad | 3")), "roll_rad", "'4'")

    def test_a_row_that_is_not_published_is_named(self):
        self.assert_one(self.complaints(page=self.PAGE.replace("| `laser`", "| `vz` | m/s | 2 | climb |\n| `laser`")), "vz")

    def test_another_order_is_named(self):
        self.assert_one(self.complaints(page=self.PAGE.replace("| `laser` | - | - | status |\n| `state` | - | - | state |\n",
                                                               "| `state` | - | - | state |\n| `laser` | - | - | status |\n", 1)), "order")

    def test_a_part_of_a_beam_without_a_row_or_with_another_unit_is_named(self):
        self.assert_one(self.complaints(page=self.PAGE.replace("| `mf_ms`, `m1_ms` |", "| `mf_ms` |")), "column", "m1_ms")
        self.assertEqual(len(self.complaints(page=self.PAGE.replace("| % | 0 | liar", "| - | 0 | liar"))), 2)

    def test_a_doubt_or_a_limit_without_a_row_and_a_row_without_one_are_named(self):
        self.assert_one(self.complaints(page=self.PAGE.replace("| `IMU/rest` | rest |\n", "")), "doubt", "IMU/rest")
        self.assert_one(self.complaints(page=self.PAGE.replace("`CLIMB`", "`CLIMBS`")), "limit", "CLIMBS")
        self.assert_one(self.complaints(page=self.PAGE.replace("| limit | holds |", "| bound | holds |")), "limit")

    def test_a_row_that_is_none_ends_the_rule(self):
        with self.assertRaises(ValueError):
            self.complaints(header=self.HEADER.replace("TEXT(", "TEXTS("))



class Pages(unittest.TestCase):
    GOOD = {"Makefile": "fly: ## flies\n", "firmware/a.c": "static void take(void)\n{\n}\n", "docs/other.md": "# Other\n\n> **For** you. **At the end** you know.\n\n## A part\n",
            "README.md": "[x](docs/other.md#a-part) `firmware/a.c` `make fly` `take` (`firmware/a.c`)\n"}

    KINDS = {"front": ("README.md",), "how-to": ("docs/other.md",)}

    def complaints(self, readme, kinds=None):
        with tempfile.TemporaryDirectory() as name:
            root = Path(name).resolve()
            for path, text in (self.GOOD | {"README.md": readme}).items():
                (root / path).parent.mkdir(exist_ok=True)
                (root / path).write_text(text, encoding="utf-8")
            return list(pages.check(root, kinds=kinds or self.KINDS))

    def test_a_page_that_names_what_exists_is_good(self):
        self.assertEqual(self.complaints(self.GOOD["README.md"]), [])

    def test_what_is_missing_is_named(self):
        for old, new in (("other.md#", "none.md#"), ("#a-part", "#b-part"), ("`firmware/a.c` ", "`firmware/b.c` "), ("make fly", "make fry"),
                         ("`take`", "`give`")):
            found = self.complaints(self.GOOD["README.md"].replace(old, new))
            self.assertEqual(len(found), 1, (new, found))
            self.assertTrue(found[0].startswith("README.md: "), found)

    def test_a_page_has_as_many_words_of_text_as_its_kind_may_have(self):
        most = pages.WORDS["front"]
        self.assertEqual(self.complaints("word " * most), [])
        self.assertEqual(self.complaints("word " * (most + 1)),
                         [f"README.md: {most + 1} words of text; a page of its kind, front, has at most {most}"])
        self.assertEqual(self.complaints("word " * (most + 1), {"how-to": ("README.md", "docs/other.md")}), [])

    def test_code_and_tables_are_not_text(self):
        kinds = {"how-to": ("README.md", "docs/other.md")}
        looked_up = "```\n" + "word " * 5000 + "\n```\n" + "| word | word |\n" * 5000
        self.assertEqual(self.complaints(looked_up + "word " * pages.WORDS["how-to"], kinds), [])
        self.assertEqual(len(self.complaints(looked_up + "word " * (pages.WORDS["how-to"] + 1), kinds)), 1)

    def test_but_for_the_front_page_which_is_one_screen(self):
        self.assertEqual(len(self.complaints("| word | word |\n" * 101)), 1)

    def test_a_page_says_for_whom_it_is(self):
        said = self.GOOD["docs/other.md"]
        for page in (said.replace("**For**", "For"), said.replace("**At the end**", "then"), said.replace("> ", "")):
            self.assertEqual(list(pages.for_nobody("docs/other.md", page)),
                             ["does not say below its title > **For** whom it is, **At the end** what he has"])
        self.assertEqual(list(pages.for_nobody("docs/es/index.md", "# Uno\n\n> **Para** ti.\n> **Al final** vuelas.\n")), [])

    def test_a_list_begins_behind_an_empty_line(self):
        self.assertEqual(list(pages.glued_lists("so:\n\n- one\n- two\n  goes on\n- three\n\n```\nx\n- y\n```\n")), [])
        self.assertEqual(list(pages.glued_lists("so:\n- one\n")), ["line 2: a list begins right behind a line of text"])

    def test_a_page_of_no_kind_is_named(self):
        found = self.complaints("", {"front": ("README.md",)})
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith("docs/other.md: of no kind"), found)


class Places(unittest.TestCase):
    def complaints(self, **changed):
        told = {"control/flight_io.h": "float innovation_mm;", "control/outputs.c": "out->innovation_mm = 0;",
                "firmware/published.h": "flight.innovation_mm", "control/parameters.c": '{"VUP", "m/s"}',
                "sim/scenarios/scenarios.c": '.name = "climb-rate"', "firmware/b.c": "int b; /* innovation_mm */"}
        with tempfile.TemporaryDirectory() as name:
            root = Path(name)
            for path, text in {**told, **changed}.items():
                (root / path).parent.mkdir(parents=True, exist_ok=True)
                (root / path).write_text(text, encoding="utf-8")
            return list(places.check(root))

    def test_the_places_of_the_recipes_are_good(self):
        self.assertEqual(self.complaints(), [])

    def test_a_place_more_is_named(self):
        found = self.complaints(**{"firmware/b.c": "b = now.innovation_mm;"})
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith("firmware/b.c: "), found)

    def test_a_place_less_is_named(self):
        found = self.complaints(**{"control/parameters.c": ""})
        self.assertEqual(len(found), 1, found)
        self.assertTrue(found[0].startswith("control/parameters.c: "), found)



class Version(unittest.TestCase):
    def complaints(self, told, entry):
        with tempfile.TemporaryDirectory() as name:
            root = Path(name)
            (root / "firmware").mkdir()
            (root / "firmware/version.h").write_text(f'#define PLOMADA_VERSION "{told}"\n', encoding="utf-8")
            (root / "CHANGELOG.md").write_text(f"# Changes\n\n{entry}\n\n## 0.1.0 (2026-11-22)\n", encoding="utf-8")
            return list(version.check(root))

    def test_the_newest_entry_is_the_version(self):
        self.assertEqual(self.complaints("0.2.0", "## 0.2.0 (2026-12-01)"), [])

    def test_another_newest_entry_is_named(self):
        self.assertEqual(len(self.complaints("0.2.0", "## 0.3.0 (2026-12-01)")), 1)
        self.assertEqual(len(self.complaints("0.2.0", "")), 1)

    def test_a_version_that_is_none_is_named(self):
        self.assertEqual(len(self.complaints("0.2", "## 0.2 (2026-12-01)")), 1)

    def test_an_entry_without_its_day_is_named(self):
        for title in ("## 0.2.0", "## 0.2.0 (soon)", "## 0.2.0 (2026-13-01)", "## 0.2.0 2026-12-01"):
            self.assertEqual(len(self.complaints("0.2.0", title)), 1, title)


if __name__ == "__main__":
    unittest.main()
