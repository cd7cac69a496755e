"""tools/setup/setup.sh on machines that lack something, played by stand-ins on PATH."""
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BASICS = ("bash", "env", "dirname", "cmp", "cat", "mkdir", "mktemp", "rm", "cp", "grep", "head", "chmod", "touch")


class Names(unittest.TestCase):
    """What make gives to its tools when a file's name has blanks. The tools are a stand-in that notes its words."""

    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)
        self.noted = self.dir / "noted"
        self.tool = self.dir / "cmake"
        self.tool.write_text(f'#!/bin/sh\nprintf "%s\\n" "$@" >>{self.noted}\n[ "$1" != --build ]\n', encoding="utf-8")     # stops before a program is run
        self.tool.chmod(0o755)
        self.file = self.dir / "a b" / "my file.c"
        self.file.parent.mkdir()
        self.file.touch()

    def make(self, *typed):
        """Neither make nor setup is run again."""
        return subprocess.run(["make", "-C", ROOT, *typed, "MAKE=true", "setup=true", f"python={self.tool}"], check=False, capture_output=True, text=True,
                              env=os.environ | {"PATH": f"{self.dir}:{os.environ['PATH']}"})

    def words(self, *typed):
        """Those of all tools that it ran."""
        self.noted.unlink(missing_ok=True)
        self.make(*typed)
        return self.noted.read_text(encoding="utf-8").splitlines()

    def test_a_name_with_blanks_is_one_word(self):
        for goal in ("plot", "scan", "fit", "verdict"):
            self.assertIn(str(self.file), self.words(goal, f"LOG={self.file}"), goal)
        self.assertIn("a b/v.json", self.words("fit", "LOG=x.csv", "OUT=a b/v.json"))
        self.assertIn("a b/v.json", self.words("tune", "VEHICLE=a b/v.json"))
        self.assertIn(f"-DPLOMADA_LAW={self.file}", self.words("mine", f"FILE={self.file}"))

    def test_a_law_in_a_file_whose_name_has_blanks_is_built(self):
        """By what `make mine` gives to CMake, in another tree and without its optimizer."""
        shutil.copy(ROOT / "examples/my_law/law_mine.c", self.file)
        words = self.words("mine", f"FILE={self.file}")
        words = [word.replace("build-mine", str(self.dir / "tree")) for word in words[:words.index("--build")]]
        subprocess.run(["cmake", *words, "-DCMAKE_BUILD_TYPE=Debug"], cwd=ROOT, check=True, capture_output=True)
        subprocess.run(["cmake", "--build", self.dir / "tree", "--target", "control"], check=True, capture_output=True)
        self.assertIn(b"law_mine_step", (self.dir / "tree/libcontrol.a").read_bytes())
        self.assertEqual(len(list((self.dir / "tree").rglob("my_file.c.o")) + list((self.dir / "tree").rglob("my file.c.o"))), 1)

    def test_several_logs_are_several_words(self):
        logs = [str(self.dir / name) for name in ("x.csv", "y.csv")]
        for log in logs:
            Path(log).touch()
        for goal in ("plot", "fit"):
            self.assertIn(logs, [words[at:at + 2] for words in [self.words(goal, f"LOG={' '.join(logs)}")] for at in range(len(words))], goal)

    def test_a_name_with_blanks_among_several_is_refused_and_one_that_a_pattern_finds_is_not(self):
        other = self.dir / "x.csv"
        other.touch()
        for goal in ("plot", "scan", "fit", "verdict"):
            done = self.make(goal, f"LOG={other} {self.file}")
            self.assertEqual((done.returncode, self.noted.exists()), (2, False), goal)
            self.assertIn(f"make {goal}: LOG: no file {self.dir}/a. Where LOG names several files, none of them may have a blank in its name", done.stderr)
        self.assertIn(str(self.file), self.words("plot", f"LOG={other} {self.dir}/a?b/*.c"))

    def test_a_law_that_is_not_there_is_named_and_one_that_was_flown_is_too(self):
        done = subprocess.run(["make", "-C", ROOT, "ground-vehicle", "FILE=nope.c", "setup=true"], check=False, capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("make ground: no file nope.c\n", done.stderr)
        self.tool.write_text("#!/bin/sh\n", encoding="utf-8")      # what builds is run by make -n too
        for typed, law in (("FILE=my.c", "my.c"), ("file=my.c", "examples/my_law/law_mine.c")):
            recipe = subprocess.run(["make", "-n", "-C", ROOT, "mine", typed, "MAKE=true"], check=False, capture_output=True, text=True,
                                    env=os.environ | {"PATH": f"{self.dir}:{os.environ['PATH']}"}).stdout
            self.assertIn(f'echo "your law: {law}"', recipe)


class Setup(unittest.TestCase):
    def setUp(self):
        self.dir = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.dir)
        self.bin = self.dir / "bin"
        self.log = self.dir / "log"
        self.project = self.dir / "project"
        shutil.copytree(ROOT / "tools/setup", self.project / "tools/setup")
        shutil.copytree(ROOT / "tools/plot", self.project / "tools/plot")
        shutil.copytree(ROOT / "tools/format", self.project / "tools/format")
        ready = self.project / "build/format"
        (ready / "bin").mkdir(parents=True)
        (ready / "bin/clang-format").touch(0o755)
        shutil.copy(ROOT / "tools/format/requirements.txt", ready)
        cmock = self.dir / "cmock"
        for file in ("lib/cmock.rb", "vendor/unity/src/unity.c"):
            (cmock / file).parent.mkdir(parents=True)
            (cmock / file).touch()
        self.bin.mkdir()
        for name in BASICS:
            (self.bin / name).symlink_to(shutil.which(name))
        for name in ("gcc", "cmake", "ninja", "ruby", "python3", "gcovr"):
            self.stand_in(name, "exit 0")
        self.stand_in("id", '[ "$1" = -u ] && echo 1000 || echo joe')
        self.stand_in("apt-cache", 'echo "Package: $3"')
        self.stand_in("apt-get", f'echo "apt-get $*" >> {self.log}')

    def stand_in(self, name, body):
        (self.bin / name).unlink(missing_ok=True)
        (self.bin / name).write_text(f"#!/bin/sh\n{body}\n", encoding="utf-8")
        (self.bin / name).chmod(0o755)

    def lack(self, *names):
        for name in names:
            (self.bin / name).unlink()

    def run_setup(self, *jobs):
        done = subprocess.run([self.project / "tools/setup/setup.sh", *jobs], capture_output=True, text=True,
                              stdin=subprocess.DEVNULL, check=False,
                              env={"PATH": str(self.bin), "HOME": str(self.dir), "CMOCK_ROOT": str(self.dir / "cmock")})
        self.calls = self.log.read_text(encoding="utf-8").splitlines() if self.log.exists() else []
        return done

    def test_nothing_is_said_or_called_when_nothing_is_missing(self):
        done = self.run_setup("build", "test", "coverage")
        self.assertEqual((done.returncode, done.stdout, done.stderr, self.calls), (0, "", "", []))

    def test_root_installs_everything_missing_in_one_call(self):
        self.stand_in("id", "echo 0")
        self.lack("cmake", "ruby", "gcovr")
        done = self.run_setup("build", "test", "coverage")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(self.calls), 1, self.calls)
        self.assertTrue(self.calls[0].endswith("install --no-install-recommends cmake ruby gcovr"), self.calls)
        self.assertIn("DPkg::Lock::Timeout=300", self.calls[0])

    def test_lists_are_read_first_when_apt_knows_nothing(self):
        self.stand_in("id", "echo 0")
        self.stand_in("apt-cache", "exit 100")
        self.lack("cmake")
        self.assertEqual(self.run_setup("build").returncode, 0)
        self.assertEqual([call.split()[-1] for call in self.calls], ["update", "cmake"])

    def test_lists_are_read_once_more_when_they_are_stale(self):
        self.stand_in("id", "echo 0")
        self.stand_in("apt-get", f'echo "apt-get $*" >> {self.log}\n'
                                 f'case "$*" in *update) touch {self.dir}/fresh;; *) [ -e {self.dir}/fresh ];; esac')
        self.lack("cmake")
        self.assertEqual(self.run_setup("build").returncode, 0)
        self.assertEqual([call.split()[-1] for call in self.calls], ["cmake", "update", "cmake"])

    def test_a_failed_installation_is_a_failure(self):
        self.stand_in("id", "echo 0")
        self.stand_in("apt-get", "exit 100")
        self.lack("cmake")
        self.assertNotEqual(self.run_setup("build").returncode, 0)

    def test_sudo_is_used_where_it_needs_no_password(self):
        self.stand_in("sudo", f'echo sudo >> {self.log}; [ "$1" = -n ] && shift; exec "$@"')
        self.stand_in("true", "exit 0")
        self.lack("cmake")
        self.assertEqual(self.run_setup("build").returncode, 0)
        self.assertTrue(self.calls[-1].endswith("install --no-install-recommends cmake"), self.calls)

    def test_without_root_one_line_says_what_to_install(self):
        self.stand_in("sudo", "exit 1")
        self.lack("cmake", "ruby")
        done = self.run_setup("build", "test")
        self.assertEqual((done.returncode, self.calls), (1, []))
        self.assertEqual(done.stderr, "setup: not root and no sudo; first run as root: "
                                      "apt-get install -y --no-install-recommends cmake ruby\n")

    def test_ninja_is_installed_by_root_and_not_worth_a_failure_without(self):
        self.lack("ninja")
        done = self.run_setup("test")
        self.assertEqual((done.returncode, done.stderr, self.calls), (0, "", []))
        self.stand_in("id", "echo 0")
        self.assertEqual(self.run_setup("test").returncode, 0)
        self.assertTrue(self.calls[0].endswith("install --no-install-recommends ninja-build"), self.calls)

    def test_the_fuzzer_is_that_of_the_systems_clang(self):
        self.stand_in("id", "echo 0")
        self.stand_in("apt-cache", 'echo "  Depends: clang-19"')
        (self.bin / "sed").symlink_to(shutil.which("sed"))
        self.assertEqual(self.run_setup("bench", "fuzz").returncode, 0)
        self.assertTrue(self.calls[-1].endswith("install --no-install-recommends valgrind clang-19 libclang-rt-19-dev"),
                        self.calls)

    def test_cross_compilers_come_with_their_libraries(self):
        self.stand_in("id", "echo 0")
        self.stand_in("gcc", "exit 1")
        self.assertEqual(self.run_setup("port", "size").returncode, 0)
        wanted = self.calls[-1].split("--no-install-recommends ")[1].split()
        self.assertEqual(set(wanted), {"gcc-avr", "avr-libc", "libsimavr-dev", "gcc-m68k-linux-gnu", "libc6-dev-m68k-cross"})

    def test_cross_compilers_that_are_there_are_enough(self):
        for name in ("avr-gcc", "m68k-linux-gnu-gcc"):
            self.stand_in(name, "exit 0")
        done = self.run_setup("port", "size")
        self.assertEqual((done.returncode, done.stderr, self.calls), (0, "", []))

    def test_an_unknown_job_is_refused(self):
        for jobs in ((), ("biuld",), ("build", "")):
            self.assertEqual(self.run_setup(*jobs).returncode, 2, jobs)
        self.assertEqual(self.calls, [])


if __name__ == "__main__":
    unittest.main()
