"""What runs in continuous integration: actions and packages are those that were looked at, nothing is skipped or tried twice in silence.

By a parser of YAML (build/venv). What this holds is said in CONTRIBUTING.md, "The workshop".
"""
import json
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import yaml

ROOT = Path(__file__).resolve().parents[2]
WORKFLOWS = sorted((ROOT / ".github/workflows").glob("*.y*ml"))
FOLDERS = [ROOT / name for name in ("tools/plot", "tools/campaign", "tools/format", "tools/scip_package", "tools/site", "tools/ground", "ground")]
PINNED = re.compile(r"[\w.-]+/[\w./-]+@[0-9a-f]{40}")
REQUIREMENT = re.compile(r"^([\w.-]+)==(\S+)((?: \\\n    --hash=sha256:[0-9a-f]{64})*)$", re.MULTILINE)
# Where a second try, or a failure that nobody hears of, would stand.
SECOND_TRY = re.compile(r"\bretry\b\s*[:=(]|\bretries\b|--repeat\b|--reruns?\b|continue-on-error|\|\| true\b", re.IGNORECASE)
PUBLISHES = {"pages": "write", "id-token": "write"}
PINS = "tools/setup/pin.sh"     # asks for the newest pip-tools, which then writes the sums


def tracked():
    """Text files of the project but for its pages and lock files."""
    listed = subprocess.run(["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\0")
    for name in filter(None, listed):
        path = ROOT / name
        if path.is_file() and path.suffix in ("", ".py", ".sh", ".yml", ".ts", ".json", ".cmake", ".txt") and path.name != "package-lock.json":
            yield name, path.read_text(encoding="utf-8", errors="replace")


def jobs():
    for path in WORKFLOWS:
        for name, job in yaml.safe_load(path.read_text(encoding="utf-8"))["jobs"].items():
            yield f"{path.name}: {name}", job


def steps():
    for where, job in jobs():
        for step in job["steps"]:
            yield where, step


def normal(name):
    return re.sub(r"[-_.]+", "-", name).lower()


def pins(path):
    return {normal(name): version for name, version, _ in REQUIREMENT.findall(path.read_text(encoding="utf-8"))}


def recipe(target):
    text = (ROOT / "Makefile").read_text(encoding="utf-8")
    found = re.search(rf"^{target}:.*\n((?:\t.*\n)+)", text, re.MULTILINE)
    return found and found.group(1)


class Workflows(unittest.TestCase):
    def test_there_is_one_and_each_may_only_read_but_for_the_job_that_publishes(self):
        self.assertTrue(WORKFLOWS)
        for path in WORKFLOWS:
            self.assertEqual(yaml.safe_load(path.read_text(encoding="utf-8")).get("permissions"), {"contents": "read"}, path.name)
        for where, job in jobs():
            if "permissions" in job:
                self.may_publish(where, job)

    def may_publish(self, where, job):
        """It runs nothing of the repository: what it publishes was built by a job that may only read, from the branch main."""
        self.assertEqual(job["permissions"], PUBLISHES, where)
        self.assertEqual([step.get("uses", "").split("@")[0] for step in job["steps"]], ["actions/deploy-pages"], where)
        workflow = yaml.safe_load((ROOT / ".github/workflows" / where.split(":")[0]).read_text(encoding="utf-8"))
        self.assertEqual(workflow[True], {"push": {"branches": ["main"]}}, where)    # YAML takes `on` for true

    def test_the_pages_and_the_browser_page_are_published(self):
        told = (ROOT / ".github/workflows/site.yml").read_text(encoding="utf-8")
        self.assertIn("- run: make publish\n", told)
        self.assertIn("          path: build-site\n", told)
        self.assertRegex(recipe("publish"), r"FLY=fly/index.html .*\n.*build-site/fly")

    def test_each_action_is_a_commit_with_its_version_beside_it(self):
        used = [(where, step["uses"]) for where, step in steps() if "uses" in step]
        self.assertTrue(used)
        for where, action in used:
            self.assertRegex(action, rf"^{PINNED.pattern}$", where)
        for path in WORKFLOWS:
            for line in re.findall(r"^.*\buses:.*$", path.read_text(encoding="utf-8"), re.MULTILINE):
                self.assertRegex(line, rf"uses: {PINNED.pattern} # v\d+\.\d+\.\d+$", path.name)

    def test_each_job_ends_and_none_fails_in_silence(self):
        for where, job in jobs():
            self.assertGreater(job.get("timeout-minutes", 0), 0, where)
            self.assertNotIn("continue-on-error", job, where)
        for where, step in steps():
            self.assertNotIn("continue-on-error", step, where)
            self.assertNotIn("|| true", step.get("run", ""), where)

    def test_what_a_job_runs_exists(self):
        for where, job in jobs():
            for command in (step["run"] for step in job["steps"] if step.get("run", "").startswith("make ")):
                drawn = re.fullmatch(r"make \$\{\{ matrix\.(\w+) \}\}", command)
                for target in job["strategy"]["matrix"][drawn.group(1)] if drawn else command.split()[1:]:
                    self.assertIsNotNone(recipe(target), f"{where}: make {target}")
            for command in (step["run"] for step in job["steps"] if step.get("run", "").startswith(".")):
                self.assertTrue((ROOT / command.split()[0]).is_file(), f"{where}: {command}")

    def test_a_job_that_exists_to_run_something_skips_nothing(self):
        self.assertIn("\nexport NOTHING_SKIPPED=1\n", (ROOT / ".ci/run").read_text(encoding="utf-8"))
        for target in ("soak", "port", "package", "others"):
            for line in recipe(target).splitlines():
                if "$(ctest)" in line:
                    self.assertIn("NOTHING_SKIPPED=1 $(ctest)", line, target)
        self.assertRegex(recipe("soak"), r"\$\(setup\) .*\bprove\b")


class Subjects(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = scratch.name
        self.git("init", "-q")

    def git(self, *words):
        identity = ["-c", "user.name=x", "-c", "user.email=x@example.org"]
        return subprocess.run(["git", *identity, *words], cwd=self.folder, capture_output=True, text=True, check=True).stdout.strip()

    def commit(self, subject):
        self.git("commit", "-q", "--allow-empty", "-m", subject)
        return self.git("rev-parse", "HEAD")

    def told(self, *words):
        done = subprocess.run([ROOT / ".ci/subjects", *words], cwd=self.folder, capture_output=True, text=True, check=False)
        return done.returncode, done.stdout

    def test_a_subject_has_at_most_72_characters(self):
        base = self.commit("y" * 100)
        self.assertEqual(self.told()[0], 1)
        self.commit("x" * 72)
        self.assertEqual(self.told(base), (0, ""))
        self.commit("x" * 73)
        self.commit("short")
        self.assertEqual(self.told(base)[0], 1)
        self.assertIn("x" * 73, self.told(base)[1])
        self.assertEqual(self.told("0" * 40), (0, ""), "the first push of a branch: its last commit")


class Packages(unittest.TestCase):
    def test_python_and_node_take_only_what_has_a_sum(self):
        for name, text in tracked():
            for line in text.splitlines():
                if re.search(r"\bpip3?( --?[\w-]+)* install ", line) and name not in (PINS, "tests/tools/test_workflows.py"):
                    self.assertIn("--require-hashes", line, name)
                self.assertNotRegex(line, r"\bnpm (install|i|add|update)\b(?! could)(?!\|)", name)

    def test_each_package_of_a_requirements_file_is_pinned_with_its_sums(self):
        self.assertEqual(sorted(path.parent for path in ROOT.glob("**/requirements.txt") if not {"build", "node_modules"} & set(path.parts)),
                         sorted(FOLDERS))
        for folder in FOLDERS:
            text = re.sub(r"^#.*\n", "", (folder / "requirements.txt").read_text(encoding="utf-8"), flags=re.MULTILINE)
            self.assertEqual(REQUIREMENT.sub("", text).strip(), "", folder)
            for name, _, sums in REQUIREMENT.findall(text):
                self.assertTrue(sums, f"{folder}: {name}")

    def test_what_is_wanted_is_pinned_as_it_is_wanted_and_one_version_of_it(self):
        everywhere = {}
        for folder in FOLDERS:
            found = pins(folder / "requirements.txt")
            for name, version in pins(folder / "requirements.in").items():
                self.assertEqual(found.get(name), version, f"{folder}: {name}, {PINS} was not run")
            if folder.name not in ("format", "scip_package", "site"):     # environments of their own
                for name, version in found.items():
                    self.assertEqual(everywhere.setdefault(name, version), version, name)

    def test_each_package_of_the_page_is_locked_with_its_sum(self):
        locked = json.loads((ROOT / "ground/package-lock.json").read_text(encoding="utf-8"))["packages"]
        wanted = {name for package in locked.values() for name in (*package.get("dependencies", {}), *package.get("optionalDependencies", {}))}
        self.assertEqual({name for name in wanted if not any(path.endswith(f"node_modules/{name}") for path in locked)}, set())
        for path, package in locked.items():
            if path:
                self.assertRegex(package.get("integrity", ""), r"^sha512-", path)


class SecondTries(unittest.TestCase):
    def test_no_test_is_tried_twice_in_silence(self):
        for name, text in tracked():
            if re.match(r"(tests|ground|\.ci|\.github)/|Makefile", name) and name != "tests/tools/test_workflows.py":
                self.assertNotRegex(text, SECOND_TRY, name)


if __name__ == "__main__":
    unittest.main()
