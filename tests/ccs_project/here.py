"""Paths and parsers that the tests of this directory share."""
import re
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(REPOSITORY / "tools" / "ti"), str(REPOSITORY / "tests" / "rules")]

from ccs_project import Project  # noqa: E402,F401
import house  # noqa: E402

PRODUCT = house.PRODUCT
CCS = REPOSITORY / "ccs_project"


def text(path):
    return (REPOSITORY / path).read_text(encoding="utf-8")


def code(path):
    return house.without_comments(text(path))


def cmake_sources():
    return re.findall(r"\b(?:" + "|".join(PRODUCT) + r")/[\w/]+\.c\b", re.sub(r"#.*", "", text("cmake/sources.cmake")))


def product_files(*suffixes):
    return [path for room in PRODUCT for path in house.House(REPOSITORY).sources(room, *suffixes)]


def constant(path, name):
    """The integer that a header #defines, e.g. 108 or 250000."""
    return int(re.search(rf"#define {name} (\d+)U?L?\b", text(path)).group(1))


def tables(page):
    """Every table row of a Markdown page as a list of cells."""
    return [[cell.strip() for cell in line.strip().strip("|").split("|")]
            for line in text(page).splitlines() if line.lstrip().startswith("|")]
