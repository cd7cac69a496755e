"""mutants.py --room control|drivers|firmware|bsp [--file PART] [--sample N] [--seed S] [--least PERCENT] [--sanitize]

Do the unit tests notice a change of the product? Draws N small faults (another operator, another constant, a condition turned
round, a statement left out) from the room's .c files, by seed. Of a copy of the tree in build/mutants, only the file with the
fault is compiled again, and only the tests that contain it are linked and run, its own first, until one fails. They run as
released: what only ASan and UBSan notice counts as survived, unless --sanitize tries the survivors there too. A fault that makes
the same code, or none, is not counted. Prints the survivors as lines of a diff, then the score. Exit status 1 when the score is
below --least.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/rules"))
import house  # noqa: E402

os.environ.pop("CCACHE_BASEDIR", None)    # tests find pages by __FILE__
FLAVOURS = (("released", ("-DCMAKE_BUILD_TYPE=Release",)), ("sanitized", ("-DCMAKE_BUILD_TYPE=Debug", "-DSANITIZE=ON")))
OPERATORS = (
    (r"(?<=\s)\+(?=\s)", "-"), (r"(?<=[\w)]\s)-(?=\s)", "+"), (r"(?<=\s)\*(?=\s)", "/"), (r"(?<=\s)/(?=\s)", "*"),
    (r"\+=", "-="), (r"-=", "+="), (r"\+\+", "--"), (r"(?<=\s)<(?=\s)", "<="), (r"(?<=\s)<=(?=\s)", "<"), (r"(?<=\s)>(?=\s)", ">="),
    (r"(?<=\s)>=(?=\s)", ">"), (r"==", "!="), (r"!=", "=="), (r"&&", "||"), (r"\|\|", "&&"), (r"(?<=\s)&(?=\s)", "|"),
    (r"(?<=\s)\|(?=\s)", "&"), (r"<<", ">>"), (r">>", "<<"), (r"\btrue\b", "false"), (r"\bfalse\b", "true"),
    (r"!(?=[\w(])", ""), (r"(?<=if \()(?=.*\) \{$)", "!"), (r"(?<![\w.])\d+U\b", "{}+1U"), (r"(?<![\w.])\d+\.\d*F\b", "(1.3F*{}+0.001F)"),
)
# The smaller or the larger of two: where they are equal, either.
BOUND = re.compile(r"\((\S+) [<>]=? (\S+)\) \? (?:\1 : \2|\2 : \1)(?!\w)")
# A statement that is no declaration, no jump.
STATEMENT = re.compile(r"^\s+(?!return\b|break\b|continue\b|const\b|static\b)[\w\[\]>.()*&-]+(?:\s*[-+*/|&]?=[^=].*|\(.*\)|\+\+|--);$")


def mutants(text):
    """(line number, the line with one fault) of a source file."""
    lines, code = text.splitlines(), house.code_only(text).splitlines()
    inside = 0
    for number, line in enumerate(code):
        depth, inside = inside, inside + line.count("{") - line.count("}")
        if line.lstrip().startswith("#") and not line.lstrip().startswith("#define"):
            continue
        for pattern, other in OPERATORS:
            for match in re.finditer(pattern, line):
                if other.strip("=") in ("<", ">") and BOUND.search(line):
                    continue
                fault = f"({other.format(match.group())})" if "{}" in other else other
                yield number, lines[number][:match.start()] + fault + lines[number][match.end():]
        if depth and STATEMENT.match(line):
            yield number, re.sub(r"\S.*", ";", line, count=1)


def quiet(command, where, **more):
    """Whether a program, or a shell's command, ends well."""
    return subprocess.run(command, cwd=where, shell=isinstance(command, str), stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          check=False, **more).returncode == 0


def copy_of_the_tree(target):
    listing = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True, text=True)
    for path in listing.stdout.splitlines():
        source, copy = ROOT / path, target / path
        if source.is_file() and (not copy.exists() or source.read_bytes() != copy.read_bytes()):
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, copy)
            copy.chmod(source.stat().st_mode)


class Build:
    """The room's unit tests, built once in one flavour; then each again with one object exchanged."""

    def __init__(self, tree, build, room, flags):
        self.tree, self.build = tree, build
        subprocess.run(["cmake", "-G", "Ninja", "-S", tree, "-B", build, "-DPLOMADA_TESTS=ON", *flags], check=True, stdout=subprocess.DEVNULL)
        names = sorted(path.stem for path in (tree / "tests" / room).rglob("test_*.c"))
        if not quiet(["cmake", "--build", build, "--target", *names], build):
            sys.exit("mutants: the tree does not build")
        self.compiled = {re.search(r" -o (\S+) ", entry["command"]).group(1): entry
                         for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))}
        self.read_by = self.sources_of_objects()
        self.tests = {name: self.link(name) for name in names}
        self.seconds = {name: self.time(name) for name in names}
        self.faultless = {}

    def sources_of_objects(self):
        """{file of the tree: [object that is made of it]}"""
        found, name = collections.defaultdict(list), ""
        for line in subprocess.run(["ninja", "-t", "deps"], cwd=self.build, check=True, capture_output=True, text=True).stdout.splitlines():
            if line and not line.startswith(" "):
                name = line.split(":")[0]
            elif line.endswith(".c"):
                found[os.path.relpath(os.path.join(self.build, line.strip()), self.tree)].append(name)
        return found

    def link(self, name):
        """(program, the command that links it, what is linked into it)"""
        commands = subprocess.run(["ninja", "-t", "commands", name], cwd=self.build, check=True, capture_output=True, text=True).stdout
        command = next(line for line in reversed(commands.splitlines()) if f"/{name} " in line and " -o " in line)
        program = re.search(rf"-o (\S*/{name})\b", command).group(1)
        if not quiet(command.replace(f"-o {program} ", f"-o {program} -Wl,-Map={program}.map "), self.build):
            sys.exit(f"mutants: {name} does not link")
        return program, command, (self.build / f"{program}.map").read_text(encoding="utf-8")

    def time(self, name):
        start = time.monotonic()
        if not self.passes(self.build / self.tests[name][0], name, 60.0):
            sys.exit(f"mutants: {name} fails without a fault")
        return time.monotonic() - start

    def passes(self, program, name, seconds):
        try:
            return quiet([program], (self.build / self.tests[name][0]).parent, timeout=seconds)
        except subprocess.TimeoutExpired:
            return False    # a test that does not end notices too

    def objects(self, path):
        """Those that are made of a file, and are linked into a test of the room; the product's first."""
        for name in sorted(self.read_by[path]):
            member = f"({Path(name).name})"    # of a room's archive
            tests = [test for test, (_, _, linked) in self.tests.items() if f"LOAD {name}\n" in linked or member in linked]
            if tests:
                yield name, tests

    def assembly(self, name, path, directory):
        """The code of an object with the file as it is in directory; "" if that does not compile."""
        source, file = self.tree / path, directory / "mutant.s"
        command = self.compiled[name]["command"]
        command = re.sub(r" -o \S+ -c ", f" -g0 -S -o {file} -c ", command.replace("ccache ", "", 1))
        if self.compiled[name]["file"] == str(source):
            command = command.replace(f" -c {source}", f" -iquote {source.parent} -c {directory / path}")
        else:    # a test that includes it
            command = command.replace(" -I", f" -I{directory} -I", 1)
        if not quiet(command, self.build):
            return ""
        return "".join(line for line in file.read_text(encoding="utf-8").splitlines(True) if not line.startswith("\t.file"))

    def notices(self, name, tests, own, directory):
        """Whether a test fails with the object of the code that was made last."""
        changed = directory / "mutant.o"
        subprocess.run(["cc", "-c", directory / "mutant.s", "-o", changed], check=True)
        for test in sorted(tests, key=lambda test: (test != own, self.seconds[test])):
            program, command, _ = self.tests[test]
            at = directory / test
            command = command.replace(f" {name} ", f" {changed} ") if f" {name} " in command else command.replace(" -o ", f" {changed} -o ", 1)
            if not quiet(command.replace(f"-o {program} ", f"-o {at} "), self.build):
                sys.exit(f"mutants: {test} does not link")
            if not self.passes(at, test, 2.0 + 20.0 * self.seconds[test]):
                return True
        return False


def verdict(builds, path, number, line):
    """None: not counted; else whether a test notices."""
    lines = (builds[0].tree / path).read_text(encoding="utf-8").splitlines()
    with tempfile.TemporaryDirectory(dir=builds[0].build) as place:
        directory = Path(place)
        (directory / path).parent.mkdir(parents=True)

        def code(build, name, text):
            (directory / path).write_text("\n".join(text) + "\n", encoding="utf-8")
            return build.assembly(name, path, directory)

        for build in builds:
            for name, tests in build.objects(path):
                if name not in build.faultless:
                    build.faultless[name] = code(build, name, lines)
                before = build.faultless[name]
                after = code(build, name, lines[:number] + [line] + lines[number + 1:])
                if not before:
                    sys.exit(f"mutants: {path} does not compile")
                if not after or (after == before and build is builds[0] and name == next(build.objects(path))[0]):
                    return None
                if after != before and build.notices(name, tests, f"test_{Path(path).stem}", directory):
                    return True
    return False


def verdicts(builds, faults, jobs):
    """Those of the faults in their order, some at once."""
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        waiting = collections.deque()
        try:
            for fault in faults:
                waiting.append((fault, pool.submit(verdict, builds, *fault)))
                if len(waiting) > 2 * jobs:
                    fault, job = waiting.popleft()
                    yield fault, job.result()
            for fault, job in waiting:
                yield fault, job.result()
        finally:
            for _, job in waiting:
                job.cancel()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--room", choices=house.PRODUCT, required=True)
    parser.add_argument("--file", default="", help="only files whose path contains this")
    parser.add_argument("--sample", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--least", type=float, default=0.0, help="percent")
    parser.add_argument("--sanitize", action="store_true", help="try the survivors also under ASan and UBSan")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args()
    place = ROOT / "build/mutants"
    copy_of_the_tree(place / "tree")
    builds = [Build(place / "tree", place / name, options.room, flags) for name, flags in FLAVOURS[:1 + options.sanitize]]
    home = house.House(place / "tree")
    every = [(path, number, line) for path in home.sources(options.room, ".c") if options.file in path
             for number, line in mutants(home.text(path))]
    random.Random(options.seed).shuffle(every)
    counted = noticed = 0
    for (path, number, line), noted in verdicts(builds, every, options.jobs):
        if noted is not None:
            counted, noticed = counted + 1, noticed + noted
        if noted is False:
            print(f"{path}:{number + 1}\n-{home.text(path).splitlines()[number]}\n+{line}", flush=True)
        if counted == options.sample:
            break
    score = 100.0 * noticed / max(1, counted)
    print(f"{options.room}: {noticed} of {counted} noticed, {score:.0f} % ({len(every)} faults are possible; seed {options.seed})")
    sys.exit(score < options.least)


if __name__ == "__main__":
    main()
