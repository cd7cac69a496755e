#!/usr/bin/env python3
"""release.py [--out DIR] [--url URL]: packs what a release consists of, checks it, and says what a person must still do.

Needed before: build/plomada, build-ground/ and build-site/ (make release builds them). Written into DIR (build-release/):

  plomada-VERSION-page.zip   the browser page with the simulated vehicle: unpack, open index.html
  plomada-VERSION-site.zip   all pages as a site, the browser page in it
  plomada-VERSION.tar.gz     the sources of this commit
  plomada_scip-*.zip         the scanner's driver, for Arduino and PlatformIO
  SHA256SUMS                 of all of them
  RELEASE.md                 what has changed, and what a person must still do

The same commit gives the same files, octet for octet, by the same tools. Exit status 1: a check failed; it says which.
"""
import argparse
import hashlib
import re
import subprocess
import sys
import time
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BEFORE_1980 = (1980, 1, 1, 0, 0, 0)     # the first day of a zip


class Refused(Exception):
    """The release cannot be made so."""


def run(*words, **more):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, check=False, **more)
    if done.returncode != 0:
        raise Refused(f"{' '.join(map(str, words))}: {(done.stdout + done.stderr).strip()}")
    return done.stdout.strip()


def told_version(root):
    return re.search(r'#define PLOMADA_VERSION "([^"]+)"', (root / "firmware/version.h").read_text(encoding="utf-8")).group(1)


def newest_entry(root):
    """(version, text) of the CHANGELOG's first entry."""
    entry = re.search(r"^## (\S+).*\n((?:(?!## ).*\n?)*)", (root / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    if not entry:
        raise Refused("CHANGELOG.md has no entry")
    return entry.group(1), entry.group(2).strip()


def still_to_do(root):
    """The list of CONTRIBUTING.md, "Release": what runs for hours, and what needs hands."""
    text = (root / "CONTRIBUTING.md").read_text(encoding="utf-8")
    section = re.search(r"^## Release\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)
    items = re.findall(r"^- (.*)$", section.group(1) if section else "", re.MULTILINE)
    if len(items) < 3:
        raise Refused('CONTRIBUTING.md: no list under "Release"')
    return items


def check_source(root, program):
    """The version, the same wherever it is told; nothing that is not committed."""
    version, (entry, changes) = told_version(root), newest_entry(root)
    told = run(program, "--version").split()[-1]
    for where, said in (("CHANGELOG.md", entry), (f"{Path(program).name} --version", told)):
        if said != version:
            raise Refused(f"{where} says {said}, firmware/version.h says {version}")
    if not changes:
        raise Refused(f"CHANGELOG.md: nothing stands under {version}")
    changed = run("git", "status", "--porcelain", cwd=root)
    if changed:
        raise Refused(f"not committed: {', '.join(line.split()[-1] for line in changed.splitlines()[:5])}")
    if f"v{version}" in run("git", "tag", cwd=root).split() and run("git", "rev-list", "-1", f"v{version}", cwd=root) != run("git", "rev-parse", "HEAD", cwd=root):
        raise Refused(f"v{version} is another commit already: a new version in firmware/version.h and CHANGELOG.md")
    return version, changes


def write_zip(target, contents, moment):
    """[(name, octets)] in order, one time for all: the same files make the same zip."""
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, octets in contents:
            entry = zipfile.ZipInfo(name, moment)
            entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
            archive.writestr(entry, octets)


def repack(source, target, moment):
    """A zip by another program, whose times are those of its making."""
    with zipfile.ZipFile(source) as archive:
        write_zip(target, [(name, archive.read(name)) for name in sorted(archive.namelist()) if not name.endswith("/")], moment)


def pack(folder, target, needed, moment):
    """A zip of a folder."""
    files = sorted(path for path in Path(folder).rglob("*") if path.is_file())
    names = {path.relative_to(folder).as_posix() for path in files}
    for name in needed:
        if name not in names:
            raise Refused(f"{folder} has no {name}")
    write_zip(target, [(f"{target.stem}/{path.relative_to(folder).as_posix()}", path.read_bytes()) for path in files], moment)
    with zipfile.ZipFile(target) as archive:
        if archive.testzip() is not None:
            raise Refused(f"{target} is damaged")


def pack_sources(root, target, version):
    run("git", "archive", "--format=tar.gz", f"--prefix=plomada-{version}/", "-o", target.resolve(), "HEAD", cwd=root)


def address(root, given):
    """Of the repository, which Arduino and PlatformIO want in the driver's package."""
    url = given or run("git", "config", "--default", "", "--get", "remote.origin.url", cwd=root)
    url = re.sub(r"\.git$", "", re.sub(r"^git@([^:]+):", r"https://\1/", url))
    if not re.fullmatch(r"https?://[^ \"]+", url):
        raise Refused("the driver's package wants the repository's address, and git does not know it: make release URL=https://...")
    return url


def pack_driver(root, out, moment, url):
    """By the driver's own project."""
    build = out / "driver"
    run("cmake", "-S", root / "tools/scip_package", "-B", build, f"-DPLOMADA_SCIP_URL={url}")
    run("cmake", "--build", build)
    run("cmake", "--build", build, "--target", "package")
    made = sorted(build.glob("plomada_scip-*.zip"))
    if not made:
        raise Refused("the driver's project made no package")
    for path in made:
        repack(path, out / path.name, moment)


def report(version, changes, files, items):
    rows = "".join(f"| {path.name} | {path.stat().st_size} | {sum_of(path)} |\n" for path in files)
    return (f"# Plomada {version}\n\n{changes}\n\n## Files\n\n| file | octets | SHA-256 |\n|---|---|---|\n{rows}\n"
            "## What a person must still do\n\nThis command has built and packed; it has not flown, and it has no board.\n\n"
            + "".join(f"- [ ] {item}\n" for item in items)
            + f"- [ ] `git tag v{version}`, push it, and add these files to the release\n")


def sum_of(path):
    return hashlib.sha256(path.read_bytes()).hexdigest()


def make(root, program, out, given_url=None):
    version, changes = check_source(root, program)
    url = address(root, given_url)
    items = still_to_do(root)
    moment = max(BEFORE_1980, time.gmtime(int(run("git", "log", "-1", "--format=%ct", cwd=root)))[:6])
    out.mkdir(parents=True, exist_ok=True)
    for old in out.glob("plomada*"):
        old.unlink()
    pack(root / "build-ground", out / f"plomada-{version}-page.zip", ("index.html", "vehicle.js"), moment)
    pack(root / "build-site", out / f"plomada-{version}-site.zip", ("index.html", "control.html", "search/search_index.json", "fly/index.html"), moment)
    pack_sources(root, out / f"plomada-{version}.tar.gz", version)
    pack_driver(root, out, moment, url)
    files = sorted(out.glob("plomada*"))
    (out / "SHA256SUMS").write_text("".join(f"{sum_of(path)}  {path.name}\n" for path in files), encoding="utf-8")
    (out / "RELEASE.md").write_text(report(version, changes, files, items), encoding="utf-8")
    return version, files, items


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "build-release")
    parser.add_argument("--url", help="address of the repository; default: that of git's origin")
    options = parser.parse_args(arguments)
    try:
        version, files, items = make(ROOT, ROOT / "build/plomada", options.out, options.url)
    except (Refused, OSError) as error:
        print(f"release: {error}", file=sys.stderr)
        return 1
    print(f"Plomada {version}")
    for path in (*files, options.out / "SHA256SUMS", options.out / "RELEASE.md"):
        print(f"  {path}")
    print("A person must still do:")
    for item in items:
        print(f"  - {item}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
