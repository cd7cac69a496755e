"""mutants.py --room control|drivers|firmware|bsp [--file PART] [--sample N] [--seed S] [--least PERCENT]

Do the unit tests notice a change of the product? Draws N small faults (another operator, another constant, a condition turned
round, a statement left out) from the room's .c files, by seed; builds and runs the room's unit tests with each under ASan and
UBSan, in a copy of the tree (build/mutants), the file's own test first. A fault that makes the same object code, or none, is not counted.
Prints the survivors as lines of a diff, then the score. Exit status 1 when the score is below --least.
"""
import argparse
import os
import random
import re
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests/rules"))
import house  # noqa: E402

os.environ.pop("CCACHE_BASEDIR", None)    # tests find pages by __FILE__
SECONDS = 60    # a test that does not end notices too
OPERATORS = (
    (r"(?<=\s)\+(?=\s)", "-"), (r"(?<=[\w)]\s)-(?=\s)", "+"), (r"(?<=\s)\*(?=\s)", "/"), (r"(?<=\s)/(?=\s)", "*"),
    (r"\+=", "-="), (r"-=", "+="), (r"\+\+", "--"), (r"(?<=\s)<(?=\s)", "<="), (r"(?<=\s)<=(?=\s)", "<"), (r"(?<=\s)>(?=\s)", ">="),
    (r"(?<=\s)>=(?=\s)", ">"), (r"==", "!="), (r"!=", "=="), (r"&&", "||"), (r"\|\|", "&&"), (r"(?<=\s)&(?=\s)", "|"),
    (r"(?<=\s)\|(?=\s)", "&"), (r"<<", ">>"), (r">>", "<<"), (r"\btrue\b", "false"), (r"\bfalse\b", "true"),
    (r"!(?=[\w(])", ""), (r"(?<=if \()(?=.*\) \{$)", "!"), (r"(?<![\w.])\d+U\b", "{}+1U"), (r"(?<![\w.])\d+\.\d*F\b", "(1.3F*{}+0.001F)"),
)
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
                fault = f"({other.format(match.group())})" if "{}" in other else other
                yield number, lines[number][:match.start()] + fault + lines[number][match.end():]
        if depth and STATEMENT.match(line):
            yield number, re.sub(r"\S.*", ";", line, count=1)


class Copy:
    """The tree in build/mutants, built once."""

    def __init__(self, room):
        self.room, self.root = room, ROOT / "build/mutants/tree"
        self.build = self.root.parent / "build"
        self.root.mkdir(parents=True, exist_ok=True)
        listing = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True, text=True)
        for path in listing.stdout.splitlines():
            source, target = ROOT / path, self.root / path
            if source.is_file() and (not target.exists() or source.read_bytes() != target.read_bytes()):
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(source, target)
                target.chmod(source.stat().st_mode)
        generator = ["-G", "Ninja"] if shutil.which("ninja") else []
        subprocess.run(["cmake", "-S", self.root, "-B", self.build, "-DCMAKE_BUILD_TYPE=Debug", "-DPLOMADA_TESTS=ON", "-DSANITIZE=ON", *generator],
                       check=True, stdout=subprocess.DEVNULL)
        self.tests = sorted(path.stem for path in (self.root / "tests" / room).rglob("test_*.c"))
        if not self.make(self.tests):
            sys.exit("mutants: the tree does not build")
        for test in self.tests:
            if not self.passes(test):
                sys.exit(f"mutants: {test} fails without a fault")

    def make(self, targets):
        return subprocess.run(["cmake", "--build", self.build, f"-j{os.cpu_count()}", "--target", *targets],
                              capture_output=True, check=False).returncode == 0

    def passes(self, test):
        program = next(self.build.glob(f"tests/{self.room}/**/{test}"))
        try:
            return subprocess.run([program], cwd=program.parent, capture_output=True, check=False, timeout=SECONDS).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def object(self, path):
        file = next(self.build.glob(f"CMakeFiles/{self.room}.dir/{path}.o"))
        code = file.with_suffix(".mutant")
        subprocess.run(["objcopy", "-O", "binary", "-j", ".text", "-j", ".rodata", "-j", ".data", file, code], check=True)
        relocations = subprocess.run(["objdump", "-drs", "-j", ".text", "-j", ".rodata", "--no-show-raw-insn", file],
                                     capture_output=True, check=False).stdout
        return code.read_bytes() if code.exists() else b"", relocations

    def verdict(self, path, number, line):
        """None: not counted; else whether a test notices."""
        file, own = self.root / path, f"test_{Path(path).stem}"
        text = file.read_text(encoding="utf-8")
        lines = text.splitlines()
        before = self.object(path)
        lines[number] = line
        try:
            file.write_text("\n".join(lines) + "\n", encoding="utf-8")
            if not self.make([self.room]) or self.object(path) == before:
                return None
            first = [own] if own in self.tests else []
            for tests in (first, [test for test in self.tests if test != own]):
                if tests and (not self.make(tests) or not all(self.passes(test) for test in tests)):
                    return True
            return False
        finally:
            file.write_text(text, encoding="utf-8")
            self.make([self.room])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--room", choices=house.PRODUCT, required=True)
    parser.add_argument("--file", default="", help="only files whose path contains this")
    parser.add_argument("--sample", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--least", type=float, default=0.0, help="percent")
    options = parser.parse_args()
    home = house.House(ROOT)
    every = [(path, number, line) for path in home.sources(options.room, ".c") if options.file in path
             for number, line in mutants(home.text(path))]
    random.Random(options.seed).shuffle(every)
    copy = Copy(options.room)
    counted = noticed = 0
    for path, number, line in every:
        if counted == options.sample:
            break
        verdict = copy.verdict(path, number, line)
        if verdict is not None:
            counted, noticed = counted + 1, noticed + verdict
        if verdict is False:
            print(f"{path}:{number + 1}\n-{home.text(path).splitlines()[number]}\n+{line}", flush=True)
    score = 100.0 * noticed / max(1, counted)
    print(f"{options.room}: {noticed} of {counted} noticed, {score:.0f} % ({len(every)} faults are possible; seed {options.seed})")
    sys.exit(score < options.least)


if __name__ == "__main__":
    main()
