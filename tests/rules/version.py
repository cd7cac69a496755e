"""The CHANGELOG's newest entry is the version that the firmware tells, and each entry has its day.

Usage: version.py ROOT
"""
import datetime
import re
import sys
from pathlib import Path

import house


def is_day(text):
    try:
        return bool(datetime.date.fromisoformat(text))
    except ValueError:
        return False


def check(root):
    version = re.search(r'#define PLOMADA_VERSION "([^"]+)"', (root / "firmware/version.h").read_text(encoding="utf-8")).group(1)
    titles = re.findall(r"^## (.*)", (root / "CHANGELOG.md").read_text(encoding="utf-8"), re.M)
    entries = [title.split()[0] for title in titles]
    for title in titles:
        if not is_day((re.fullmatch(r"\S+ \((.*)\)", title) or ["", ""])[1]):
            yield f"CHANGELOG.md: ## {title}: no (YYYY-MM-DD) behind the version"
    if not entries or entries[0] != version:
        yield f"CHANGELOG.md: the newest entry is {entries[0] if entries else 'missing'}, firmware/version.h says {version}"
    if not re.fullmatch(r"0\.\d+\.\d+|[1-9]\d*\.\d+\.\d+", version):
        yield f"firmware/version.h: {version} is no version x.y.z"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    house.report(list(check(Path(sys.argv[1]))), "version")
