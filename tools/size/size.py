"""Memory of the product: flash, static RAM and stacks, against the limits of the TMS320F28377S; docs/memory.md says how.

The exit status is 1 when a limit is exceeded, when something on a stack is not known (tools/size/stacks.txt), when an
interrupt may block, or when the tables of docs/memory.md are far from those printed here (--write puts them there); it is 77
when a cross compiler is missing.
"""
import argparse
import concurrent.futures
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HERE = ROOT / "tools/size"
DOCUMENT = ROOT / "docs/memory.md"
sys.path[:0] = [str(ROOT / "tests/port/avr"), str(ROOT / "tests/rules")]
import cells  # noqa: E402
import house  # noqa: E402
import sources  # noqa: E402

M68K = ("m68k-linux-gnu-gcc", "-std=gnu99", "-m68040", "-malign-int", "-fno-math-errno", "-fshort-wchar", "-w", "-include",
        HERE / "cells.h")
# A function of an AVR saves up to 18 registers of 8 bits (avr-gcc's ABI), one of a C28x up to 7 (SPRU514, tables 7-2 and 7-3). So a routine
# saves them here: else each function would seem to cost what only an AVR pays.
AVR = ("avr-gcc", "-mmcu=atmega2560", "-std=gnu99", "-Os", "-mcall-prologues", "-w")
GRAPH = ("-fstack-usage", "-fcallgraph-info=su")
RELEASE = ("-O2", "-fno-inline", *GRAPH)    # inlined or not, the frames of a path add up; apart they have names
DEBUG = ("-O0", *GRAPH)
NOT_AVR = ("bsp/storage.c",)    # two flash sectors of 64 KB are beyond its 16-bit size_t
TI = ["sim/ti/sysbios", "sim/ti/driverlib", "sim/ti/f021/include", "."]

# Cells on a stack that no compiler here can measure; docs/memory.md has their sources.
CALL = 4            # return address and frame pointer or alignment: gcc's figures hold neither
CONTEXT = 44        # of an interrupt: 14 pushed by the C28x, 26 by the dispatcher with FPU32, return address, alignment
DISPATCH = 40       # Hwi_dispatchC(), Hwi_switchAndDispatch(), Hwi_dispatchCore()
SWI = 40            # Swi_restoreHwi(), Swi_run()
SWITCH = 64         # Task_restoreHwi(), Task_schedule(), the load's hook, the swap of tasks
TASK = 2 * (CONTEXT + DISPATCH) + SWITCH    # an interrupt, and one more while the switch that it ended in calls the hook
IDLE = 64           # the idle loop and the load's idle function
HWI_GROUPS = 3      # PIE groups 1 (tick), 8 and 9: a Hwi masks its own group
TICK = 96           # the tick's own Hwi, which posts the Clock Swi
SPILL = 1.25        # what TI's compiler may need more than the one measured
CLONE = re.compile(r"\.(?:constprop|isra|part|cold)\b.*")
BLOCKING = re.compile(r"(?:Semaphore_pend|Event_pend|GateMutexPri_enter|Task_sleep|Task_yield|\w+_create)$")
TOLERANCE = 0.05    # of a row's largest number: what the page may be off; enough for some dozen commits, too little to mislead a plan
SET = ("size", "of")        # columns that are set in the sources, not measured: they are what the page says
CHIP_RAM = 82 * 1024        # cells: 164 KB
CHIP_FLASH = 512 * 1024     # cells: 1 MB


def run(command):
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{done.stderr}")
    return done.stdout


def product():
    return [path for paths in sources.listed(house.House(ROOT)).values() for path in paths]


def to_cells(out):
    """Copies of the product's files, converted; the tree is as in the repository."""
    for room in house.PRODUCT:
        for file in (ROOT / room).rglob("*.[ch]"):
            target = out / file.relative_to(ROOT)
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(cells.convert(file.read_text(encoding="utf-8"), file), encoding="utf-8")


def compile_all(compiler, base, out, without=()):
    """{source: object}, each compiled apart."""
    include = [f"-I{base}"] + [f"-I{ROOT / path}" for path in TI]
    objects = {path: out / path.replace("/", "-").replace(".c", ".o") for path in product() if path not in without}
    out.mkdir(parents=True, exist_ok=True)
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(lambda item: run([*compiler, *include, "-c", base / item[0], "-o", item[1]]), objects.items()))
    return objects


def section_bytes(tool, objects):
    """{source: {"code", "constant", "data", "bss"}} in bytes; what is placed by name counts as its kind."""
    found = {}
    for path, file in objects.items():
        kinds = dict.fromkeys(("code", "constant", "data", "bss"), 0)
        for name, size in re.findall(r"^(\.\S+)\s+(\d+)", run([tool, "-A", file]), re.MULTILINE):
            kind = next((kind for start, kind in ((".text", "code"), (".rodata", "constant"), (".data", "data"), (".bss", "bss"),
                                                 (".retained", "bss")) if name.startswith(start)), None)
            if kind:
                kinds[kind] += int(size)
        found[path] = kinds
    return found


class Stacks:
    """The call graph of the product, and what is on the stack along its paths, in cells."""

    def __init__(self, objects):
        self.own, self.callees, self.problems = {}, {}, []
        self.read_table()
        for path, file in objects.items():
            self.read_graph(path, file.with_suffix(".ci").read_text(encoding="utf-8"))
        self.deepest = {}

    def read_table(self):
        self.roots, self.calls, self.allowed = [], {}, []
        for line in (HERE / "stacks.txt").read_text(encoding="utf-8").splitlines():
            if not line.strip() or line.startswith("#"):
                continue
            kind, *rest = re.split(r"\s{2,}", line.strip())
            if kind == "root":
                self.roots.append(tuple(rest[:3]))
            elif kind == "calls":
                self.calls[rest[0]] = self.targets(rest[1])
            elif kind == "cells":
                self.allowed += [(name, int(rest[0])) for name in rest[1].split()]
            else:
                raise ValueError(f"tools/size/stacks.txt: {line}")

    @staticmethod
    def targets(text):
        """The names of a row: given, the last argument of every call of a function, or what a table holds."""
        if text.endswith("()"):
            code = "".join(house.code_only((ROOT / path).read_text(encoding="utf-8")) for path in product())
            return re.findall(rf"\b{text[:-2]}\([^;{{]*?(\w+)\);", code)
        if ":" not in text:
            return text.split()
        path, table = text.split(":")
        code = house.code_only((ROOT / path).read_text(encoding="utf-8"))
        held = re.search(rf"\b{table}\[\]\)?(?:\([^)]*\))?\s*=\s*\{{(.*?)\}};", code, re.DOTALL).group(1)
        return [name for name in re.findall(r"[A-Za-z_]\w*", re.sub(r"\[\w+\]", "", held)) if not name.isupper()]

    def read_graph(self, path, text):
        for title, label, outside in re.findall(r'node: \{ title: "([^"]+)" label: "([^"]*)"( shape : ellipse)?', text):
            if not outside:
                size, kind = re.search(r"\\n(\d+) bytes \(([^)]*)\)", label).groups()
                key = self.key(path, title)
                self.own[key] = max((int(size) + 1) // 2 + CALL, self.own.get(key, 0))
                if kind not in ("static", "dynamic,bounded"):
                    self.problems.append(f"{path}: {title.split(':')[-1]}: a stack frame without bound")
        for source, target in re.findall(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"', text):
            self.callees.setdefault(self.key(path, source), set()).add(self.key(path, target))

    @staticmethod
    def key(path, title):
        """A function with its file if it is static; what gcc made of it for certain arguments goes by its name."""
        name = CLONE.sub("", title.split(":")[-1])
        return f"{path}:{name}" if ":" in title else name

    def named(self, name):
        return [key for key in self.own if key.split(":")[-1] == name]

    def allowance(self, name):
        for known, size in self.allowed:
            if name == known or (known.endswith("*") and name.startswith(known[:-1])):
                return size
        self.problems.append(f"{name}: nobody knows its stack")
        return 0

    def below(self, key):
        if key not in self.own:
            return {each for target in self.calls.get(key, ()) for each in self.known(target)}
        found = set()
        for callee in self.callees.get(key, ()):
            if callee != "__indirect_call":
                found.add(callee)
                continue
            function = key.split(":")[-1]
            if function not in self.calls:
                self.problems.append(f"{function}(): calls through a pointer, nobody knows whom")
            for target in self.calls.get(function, ()):
                found.update(self.known(target))
        return found

    def known(self, function):
        keys = self.named(function)
        if not keys:
            self.problems.append(f"{function}(): no such function")
        return keys

    def path(self, key, above=()):
        """(cells, functions) of the deepest path from a function on; a recursion is a problem."""
        if key in above:
            self.problems.append(f"{key}: recursion")
            return 0, ()
        if key not in self.deepest:
            own = self.own[key] if key in self.own else self.allowance(key)
            size, way = max((self.path(callee, (*above, key)) for callee in self.below(key)), default=(0, ()))
            self.deepest[key] = own + size, (key.split(":")[-1], *way)
        return self.deepest[key]

    def reachable(self, key, seen):
        if key not in seen:
            seen.add(key)
            for callee in self.below(key):
                self.reachable(callee, seen)
        return seen

    def root(self, function):
        return max((self.path(key) for key in self.known(function)), default=(0, ()))

    def check_roots(self):
        """Every function that is handed to the kernel is a root; what runs in interrupts never blocks; no row is stale."""
        handed = re.compile(r"\b(?:Task_create|Swi_create|Clock_create)\(\s*(\w+)|\bhwi_create\([^;]*?,\s*(\w+),")
        for path in product():
            text = house.code_only((ROOT / path).read_text(encoding="utf-8"))
            for names in handed.findall(text):
                for name in filter(None, names):
                    if self.named(name) and name not in [function for _, _, function in self.roots]:
                        self.problems.append(f"{path}: {name}: no root in tools/size/stacks.txt")
        for kind, _, function in self.roots:
            if kind in ("swi", "clock", "hwi"):
                for key in self.named(function):
                    self.problems += [f"{function} ({kind}) may reach {callee}(), which blocks"
                                      for callee in sorted(self.reachable(key, set())) if BLOCKING.match(callee)]

        pointers = {key.split(":")[-1] for key, callees in self.callees.items() if "__indirect_call" in callees}
        pointers |= {callee for callees in self.callees.values() for callee in callees if callee not in self.own}
        self.problems += [f"tools/size/stacks.txt: {function}() calls through no pointer"
                          for function in sorted(set(self.calls) - pointers)]

    def worst(self, kind):
        """[(name, cells, path)] of the roots of a kind."""
        return [(name, *self.root(function)) for root, name, function in self.roots if root == kind]


def defined(path, name):
    value = re.search(rf"{name}\s*=?\s*(0x[\dA-Fa-f]+|\d+)", (ROOT / path).read_text(encoding="utf-8"))
    return int(value.group(1), 0)


def region(name):
    return int(re.search(rf"^\s*{name}\s*:.*length = (0x[\dA-F]+)", (ROOT / "ccs_project/plomada.cmd").read_text(encoding="utf-8"),
                         re.MULTILINE).group(1), 16)


def table(head, rows):
    first, *others = ["| " + " | ".join(map(str, row)) + " |" for row in (head, *rows)]
    return "\n".join([first, "|---" + "|--:" * (len(head) - 1) + "|", *others])


def limit(problems, what, used, available):
    if used > available:
        problems.append(f"{what}: {used} of {available} cells")
    return used, available


def spilled(size):
    return -int(-size * SPILL // 1)


def stack_row(problems, name, sizes, reserve, available, path=""):
    """A row for the sizes measured as Release and as Debug: the larger one counts."""
    needed = spilled(max(sizes)) + reserve
    limit(problems, f"stack of {name}", needed, available)
    return name, *sizes, needed, available, available - needed, path


def arrows(way):
    return " → ".join(f"`{step}`" for step in way)


def nested(stacks):
    """Cells of the Hwis and Swis: every Swi, each preempting the one before, and on them a Hwi of every group."""
    swis = stacks.worst("swi") + [max(stacks.worst("clock"), key=lambda item: item[1])]
    hwi = max(size for _, size, _ in stacks.worst("hwi"))
    return len(swis), sum(size for _, size, _ in swis) + (HWI_GROUPS - 1) * hwi + TICK


def stack_of(task):
    """Cells of a task's stack: its own, or that of all others."""
    return defined("firmware/schedule.h", "TASK_CONTROL_STACK_CELLS" if task == "TaskControl" else "TASK_STACK_CELLS")


def stack_tables(release, debug, problems):
    """The stacks as the page shows them; with their deepest paths, and what lies on the stack of the interrupts."""
    program = defined("ccs_project/app.cfg", "Program.stack")
    rows = []
    for (name, size, way), (_, debug_size, debug_way) in zip(release.worst("task"), debug.worst("task")):
        rows.append(stack_row(problems, name, (size, debug_size), TASK, stack_of(name), arrows(way if size > debug_size else debug_way)))
    rows.append(stack_row(problems, "idle task", (IDLE, IDLE), TASK, defined("ccs_project/app.cfg", "Task.idleTaskStackSize")))
    (levels, size), (_, debug_size) = nested(release), nested(debug)
    contexts = DISPATCH + SWI + (levels - 1) * (CONTEXT + DISPATCH + SWI) + HWI_GROUPS * (CONTEXT + DISPATCH)
    rows.append(stack_row(problems, "Hwis and Swis", (size, debug_size), contexts, program,
                          f"{levels} Swis on one another, {HWI_GROUPS} Hwis on them"))
    (_, size, way), = release.worst("main")
    (_, debug_size, debug_way), = debug.worst("main")
    rows.append(stack_row(problems, "main()", (size, debug_size), 0, program, arrows(way if size > debug_size else debug_way)))
    singles = [(f"{name} ({kind})", size, debug_size) for kind in ("swi", "clock", "hwi")
               for (name, size, _), (_, debug_size, _) in zip(release.worst(kind), debug.worst(kind))]
    return (table(("stack", "needed", "size", "free"), [(name, *cells_n) for name, _, _, *cells_n, _ in rows]),
            table(("stack", "Release", "Debug", "needed", "size", "free", "deepest path"), rows),
            table(("on the stack of the Hwis and Swis", "Release", "Debug"), singles))


def ram_tables(sizes, problems):
    """The regions as the page shows them; the modules."""
    def static(kinds):
        return (kinds["data"] + kinds["bss"] + 1) // 2

    modules = sorted(((path, static(kinds)) for path, kinds in sizes.items() if static(kinds)), key=lambda item: -item[1])
    rows = [(f"`{path}`", size) for path, size in modules if size >= 64]
    small = [size for _, size in modules if size < 64]
    rows.append((f"{len(small)} others, each under 64", sum(small)))
    everything = sum(size for _, size in modules)
    ring = static(sizes["firmware/flight_recorder.c"])
    kept = static(sizes["bsp/retained.c"])
    heap, stack = defined("ccs_project/app.cfg", "BIOS.heapSize"), defined("ccs_project/app.cfg", "Program.stack")
    idle = defined("ccs_project/app.cfg", "Task.idleTaskStackSize")
    tasks = 5 * stack_of("the others") + stack_of("TaskControl")
    limits = [("variables (`.ebss`)", *limit(problems, ".ebss", everything - ring - kept, region("RAMGS39"))),
              ("flight recorder (`.flight_log`)", *limit(problems, ".flight_log", ring, region("RAMGS915"))),
              ("kept over a reset (`.retained`)", *limit(problems, ".retained", kept, region("RETAINED"))),
              ("six task stacks, of the heap", *limit(problems, "heap", tasks, heap)),
              ("heap and idle task, below 10000H", *limit(problems, ".ebss:taskStackSection", heap + idle, region("RAMGS02"))),
              ("stack of Hwis, Swis and main()", *limit(problems, ".stack", stack, region("LS45SARAM"))),
              ("all of it, of the chip's RAM", *limit(problems, "RAM", everything + heap + idle + stack, CHIP_RAM))]
    return table(("region", "used", "of"), limits), table(("module", "cells"), rows + [("**all**", everything)])


def flash_table(m68k, avr, problems):
    def flash(kinds):
        return kinds["code"] + kinds["constant"] + kinds["data"]

    rows = []
    for room in house.PRODUCT:
        row = [sum(flash(kinds) for path, kinds in sizes.items() if path.startswith(room + "/")) for sizes in (m68k, avr)]
        rows.append((f"`{room}/`", *row, max(row) // 2))
    both = [sum(row[column] for row in rows) for column in (1, 2, 3)]
    constant = max(sum(kinds["constant"] for kinds in sizes.values()) for sizes in (m68k, avr)) // 2
    rows.append(("**all**", *both))
    available = region("FLASH") + min(region("FLASHA"), 2 * constant)    # .econst begins in FLASHA
    limit(problems, "flash", 2 * both[2], available)
    limit(problems, "flash of the chip", 2 * both[2], CHIP_FLASH)
    return table(("room", "m68k, bytes", "AVR, bytes", "the larger, as cells"), rows)


def rows_of(text):
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines()]


def near(column, said, measured, allowed):
    if column in SET or not measured.lstrip("-").isdigit() or not said.lstrip("-").isdigit():
        return said == measured
    return abs(int(said) - int(measured)) <= allowed


def differing(said, measured):
    """The rows of a measured table that the page does not have."""
    head, *rows = rows_of(measured)
    said_head, *said_rows = rows_of(said)
    if said_head != head or len(said_rows) != len(rows):
        return [head]
    wrong = []
    for row, said_row in zip(rows, said_rows):
        allowed = TOLERANCE * max((int(cell) for cell in row if cell.isdigit()), default=0)
        if len(said_row) != len(row) or not all(near(*cells, allowed) for cells in zip(head, said_row, row)):
            wrong.append(row)
    return wrong


def document(tables, write):
    """The rows of docs/memory.md that are not as measured, none after --write; other compilers than those it names measure
    something else."""
    text = DOCUMENT.read_text(encoding="utf-8")
    put, wrong = text, []
    for name, content in tables.items():
        place = re.compile(rf"(?<=<!-- {name} -->\n).*?(?=\n<!-- end -->)", re.DOTALL)
        if len(place.findall(text)) != 1:
            sys.exit(f"docs/memory.md has no place for {name}")
        wrong += differing(place.search(text).group(), content)
        put = place.sub(lambda _, content=content: content, put)
    if write:
        DOCUMENT.write_text(put, encoding="utf-8")
        return []
    if tables["compilers"] not in text:
        print("docs/memory.md was written with other compilers: not compared\n")
        return []
    return wrong


def version(compiler):
    return f"{compiler} {run([compiler, '-dumpfullversion', '-dumpversion']).strip()}"


def allowance_table(stacks):
    known = (("each call: return address, and frame pointer or alignment", CALL),
             ("context of an interrupt", CONTEXT),
             ("the dispatcher's functions in C", DISPATCH),
             ("the scheduler that runs a Swi behind an interrupt", SWI),
             ("the switch of tasks behind an interrupt, with the load's hook", SWITCH),
             ("two interrupts and a switch, on every task's stack", TASK),
             ("idle loop", IDLE),
             ("the tick's own Hwi", TICK))
    names = {}
    for name, cells_n in stacks.allowed:
        names.setdefault(cells_n, []).append(f"`{name}`")
    return table(("what", "cells"), [*known, *((", ".join(group), cells_n) for cells_n, group in sorted(names.items()))])


def measure(out, problems):
    """({name: table of the page}, tables that are only printed)"""
    copy = out / "cells"
    to_cells(copy)
    sizes = section_bytes("m68k-linux-gnu-size", compile_all((*M68K, "-O2"), copy, out / "m68k"))
    avr = section_bytes("avr-size", compile_all(AVR, ROOT, out / "avr", without=NOT_AVR))
    graphs = [Stacks(compile_all((*M68K, *options), copy, out / name))
              for name, options in (("release", RELEASE), ("debug", DEBUG))]
    stacks, *ways = stack_tables(*graphs, problems)
    regions, modules = ram_tables(sizes, problems)
    tables = {"compilers": f"Measured with {version(M68K[0])} and {version(AVR[0])}.",
              "flash": flash_table(sizes, avr, problems), "ram": regions, "stacks": stacks}
    for graph in graphs:
        graph.check_roots()
        problems += graph.problems
    return tables, [*ways, allowance_table(graphs[0]), modules]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "build/size", help="where to compile")
    parser.add_argument("--write", action="store_true", help="put the tables into docs/memory.md")
    options = parser.parse_args()
    missing = [tool for tool in (M68K[0], AVR[0]) if not shutil.which(tool)]
    if missing:
        print(f"no {' and no '.join(missing)}: tools/setup/setup.sh size")
        sys.exit(77)
    problems = []
    tables, details = measure(options.out.resolve(), problems)
    for content in (*tables.values(), *details):
        print(content, end="\n\n")
    problems += [f"docs/memory.md is more than {TOLERANCE:.0%} off, make size ARGS=--write: {' | '.join(row)}"
                 for row in document(tables, options.write)]
    for problem in dict.fromkeys(problems):
        print(problem)
    sys.exit(1 if problems else 0)


if __name__ == "__main__":
    main()
