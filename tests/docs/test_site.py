"""The site of the pages: it is built without a warning, has every page, no dead link, a search, and loads nothing from elsewhere.

Usage: test_site.py ROOT
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote


class Page(HTMLParser):
    """What a page links to and can be linked at, what it loads, and how many items its lists have."""

    def __init__(self, path):
        super().__init__()
        self.links, self.loads, self.names, self.items = [], [], set(), 0
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.items += tag == "li"
        if values.get("id"):
            self.names.add(values["id"])
        if tag == "a" and values.get("href"):
            self.links.append(values["href"])
        for name in ("src", "href"):
            if (tag, name) in (("script", "src"), ("img", "src"), ("link", "href")) and values.get(name) and values.get("rel") != "canonical":
                self.loads.append(values[name])


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.scratch.cleanup)
        cls.folder = Path(cls.scratch.name) / "site"
        cls.built = cls.build(cls.folder)
        cls.pages = {path: Page(path) for path in cls.folder.rglob("*.html") if path.name != "404.html"}

    @staticmethod
    def build(folder, **more):
        return subprocess.run([ROOT / "build/site-tools/bin/mkdocs", "--quiet", "build", "--strict", "--site-dir", folder, "--config-file",
                               ROOT / "tools/site/mkdocs.yml"], capture_output=True, text=True, check=False,
                              env=os.environ | {"NO_MKDOCS_2_WARNING": "1"} | more)

    def test_it_is_built_without_a_warning(self):
        self.assertEqual((self.built.returncode, self.built.stderr), (0, ""))

    def test_each_page_is_in_it_and_in_its_navigation(self):
        first = {unquote(link) for link in self.pages[self.folder / "index.html"].links}
        there_are = [path.relative_to(ROOT / "docs").with_suffix(".html").as_posix() for path in (ROOT / "docs").rglob("*.md")]
        for name in (*there_are, "contributing.html", "changelog.html", "driver.html", "course.html",
                     *(f"course_{path.parent.name}.html" for path in (ROOT / "course").glob("*/README.md"))):
            self.assertTrue((self.folder / name).is_file(), name)
            self.assertIn(name, first, "docs/pages.md does not list it")

    def test_no_link_leads_nowhere(self):
        for path, page in self.pages.items():
            for link in (*page.links, *page.loads):
                if re.match(r"\w+:", link):
                    continue
                file, _, name = unquote(link).partition("#")
                target = (path.parent / file).resolve() if file else path
                with self.subTest(page=path.name, link=link):
                    self.assertTrue(target.exists())
                    if name and not name.startswith("__") and target in self.pages:
                        self.assertIn(name, self.pages[target].names)

    def test_nothing_is_loaded_from_elsewhere(self):
        for path, page in self.pages.items():
            for link in page.loads:
                self.assertNotRegex(link, r"^(\w+:)?//", path.name)

    def test_a_diagram_is_read_as_its_ways(self):
        built = (self.folder / "architecture.html").read_text(encoding="utf-8")
        self.assertNotIn("flowchart", built)
        self.assertIn("<li>URG-04LX → <em>(SCIA RX Hwi)</em> Laser_SWI → TaskReceiveLaser 5</li>", built)
        drawn = re.search(r"```mermaid\n(.*?)```", (ROOT / "docs/architecture.md").read_text(encoding="utf-8"), re.DOTALL).group(1)
        self.assertEqual(built.count("→"), len(re.findall(r"->", drawn)) + (ROOT / "docs/architecture.md").read_text(encoding="utf-8").count("→"))

    def test_lists_are_lists_there_too(self):
        for page in (ROOT / "docs").rglob("*.md"):
            if "```mermaid" in page.read_text(encoding="utf-8"):
                continue    # its diagram is a list there
            text = re.sub(r"^ *```.*?^ *```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
            written = len(re.findall(r"^ *(?:[-*]|\d+\.) \S", text, re.MULTILINE))
            built = (self.folder / page.relative_to(ROOT / "docs")).with_suffix(".html").read_text(encoding="utf-8")
            article = re.search(r"<article.*?</article>", built, re.DOTALL).group(0)
            with self.subTest(page=page.name):
                self.assertEqual(article.count("<li>") + article.count("<li "), written, "sub-lists and what belongs to an item: four blanks")

    def test_a_reader_who_searches_finds(self):
        index = json.loads((self.folder / "search/search_index.json").read_text(encoding="utf-8"))
        found = {place["location"].split("#")[0] for place in index["docs"] if "overtaken by a stop" in place["text"]}
        self.assertEqual(found, {"operator.html"})

    def test_the_browser_page_is_offered_where_it_is_published(self):
        with tempfile.TemporaryDirectory() as name:
            self.assertEqual(self.build(name, FLY="fly/index.html").stderr, "")
            for page, link in (("index.html", 'href="fly/index.html"'), ("es/index.html", 'href="../fly/index.html"')):
                built = (Path(name) / page).read_text(encoding="utf-8")
                self.assertIn(link, built)
                self.assertIn("admonition-title", built)
                self.assertNotIn("!!!", built)
        self.assertNotIn("fly/index.html", (self.folder / "index.html").read_text(encoding="utf-8"))


if __name__ == "__main__":
    ROOT = Path(sys.argv.pop(1)).resolve()
    unittest.main()
