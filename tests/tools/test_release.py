"""tools/release: versions that differ, what is not committed and what was not built are refused; the files are whole and repeat."""
import os
import re
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools/release"))
import release  # noqa: E402

CHANGES = "# Changes\n\n## 1.2.3 (2020-01-02)\n\n- a thing\n\n## 1.2.2 (2020-01-01)\n\n- another\n"
LIST = "# Changing\n\n## Release\n\nOn the PC:\n\n- all tests\n- the campaign\n\nOn the bench:\n\n- first power-up\n"


class Releasing(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.root, self.out = Path(scratch.name) / "project", Path(scratch.name) / "out"
        self.write("firmware/version.h", '#define PLOMADA_VERSION "1.2.3"\n')
        self.write("CHANGELOG.md", CHANGES)
        self.write("CONTRIBUTING.md", LIST)
        self.write(".gitignore", "/build*\n")
        self.write("build/plomada", "#!/bin/sh\necho plomada 1.2.3\n").chmod(0o755)
        for name in ("build-ground/index.html", "build-ground/vehicle.js", "build-site/index.html", "build-site/control.html",
                     "build-site/search/search_index.json", "build-site/fly/index.html"):
            self.write(name, name)
        self.write("tools/scip_package/CMakeLists.txt", "cmake_minimum_required(VERSION 3.21)\nproject(p NONE)\n"
                   "file(WRITE ${PROJECT_BINARY_DIR}/urg.h \"a driver\")\n"
                   "add_custom_target(package COMMAND ${CMAKE_COMMAND} -E tar cf plomada_scip-0.2.0.zip --format=zip urg.h)\n")
        self.git("init", "-q")
        self.git("remote", "add", "origin", "git@example.org:people/plomada.git")
        self.commit()

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    def git(self, *words):
        identity = ["-c", "user.name=x", "-c", "user.email=x@example.org"]
        subprocess.run(["git", *identity, *words], cwd=self.root, capture_output=True, check=True)

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "--allow-empty", "-m", "x")

    def make(self):
        return release.make(self.root, self.root / "build/plomada", self.out)

    def refused(self, words):
        with self.assertRaisesRegex(release.Refused, words):
            self.make()
        self.assertFalse(self.out.exists() and list(self.out.glob("*.md")))

    def test_its_files_are_whole_and_have_their_sums(self):
        version, files, items = self.make()
        self.assertEqual(version, "1.2.3")
        self.assertEqual([path.name for path in files], ["plomada-1.2.3-page.zip", "plomada-1.2.3-site.zip", "plomada-1.2.3.tar.gz",
                                                         "plomada_scip-0.2.0.zip"])
        with zipfile.ZipFile(files[0]) as page:
            self.assertEqual(page.read("plomada-1.2.3-page/index.html"), b"build-ground/index.html")
        done = subprocess.run(["sha256sum", "-c", "SHA256SUMS"], cwd=self.out, capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout.count(": OK"), 4)
        self.assertEqual(items, ["all tests", "the campaign", "first power-up"])

    def test_it_says_what_has_changed_and_what_a_person_must_still_do(self):
        self.make()
        told = (self.out / "RELEASE.md").read_text(encoding="utf-8")
        self.assertIn("- a thing", told)
        self.assertNotIn("another", told)
        self.assertEqual(re.findall(r"- \[ \] (.*)", told)[:3], ["all tests", "the campaign", "first power-up"])

    def test_the_same_commit_gives_the_same_octets(self):
        first = {path.name: path.read_bytes() for path in self.make()[1]}
        for path in (self.root / "build-ground/index.html", self.out / "driver/urg.h"):
            os.utime(path, (1e9, 1e9))
        self.assertEqual({path.name: path.read_bytes() for path in self.make()[1]}, first)

    def test_versions_that_differ_are_refused(self):
        self.write("build/plomada", "#!/bin/sh\necho plomada 1.2.2\n")
        self.refused("plomada --version says 1.2.2, firmware/version.h says 1.2.3")
        self.write("build/plomada", "#!/bin/sh\necho plomada 1.2.3\n")
        self.write("CHANGELOG.md", CHANGES.replace("1.2.3", "1.2.4"))
        self.commit()
        self.refused("CHANGELOG.md says 1.2.4")

    def test_an_empty_entry_is_refused(self):
        self.write("CHANGELOG.md", CHANGES.replace("- a thing\n", ""))
        self.commit()
        self.refused("nothing stands under 1.2.3")

    def test_what_is_not_committed_is_refused(self):
        self.write("control/new.c", "int x;\n")
        self.refused("not committed: ")

    def test_a_version_that_is_another_commit_is_refused(self):
        self.git("tag", "v1.2.3")
        self.make()
        self.commit()
        (self.out / "RELEASE.md").unlink()
        self.refused("v1.2.3 is another commit already")

    def test_what_was_not_built_is_refused(self):
        (self.root / "build-site/fly/index.html").unlink()
        self.refused("has no fly/index.html")

    def test_an_address_is_never_made_up(self):
        self.assertEqual(release.address(self.root, None), "https://example.org/people/plomada")
        self.assertEqual(release.address(self.root, "https://example.org/other"), "https://example.org/other")
        self.git("remote", "remove", "origin")
        self.refused("make release URL=https://")

    def test_the_projects_own_list_is_found(self):
        items = release.still_to_do(ROOT)
        self.assertTrue(any("plomada accept" in item for item in items), items)


if __name__ == "__main__":
    unittest.main()
