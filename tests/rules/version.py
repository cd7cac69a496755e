"""The CHANGELOG's newest entry is the version that the firmware tells.

Usage: version.py ROOT
"""
import re
import sys
from pathlib import Path

import house


def check(root):
    version = re.search(r'#define PLOMADA_VERSION "([^"]+)"', (root / "firmware/version.h").read_text(encoding="utf-8")).group(1)
    entries = re.findall(r"^## (\S+)", (root / "CHANGELOG.md").read_text(encoding="utf-8"), re.M)
    if not entries or entries[0] != version:
        yield f"CHANGELOG.md: the newest entry is {entries[0] if entries else 'missing'}, firmware/version.h says {version}"
    if not re.fullmatch(r"0\.\d+\.\d+|[1-9]\d*\.\d+\.\d+", version):
        yield f"firmware/version.h: {version} is no version x.y.z"


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    house.report(list(check(Path(sys.argv[1]))), "version")
