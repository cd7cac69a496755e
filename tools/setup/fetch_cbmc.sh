#!/usr/bin/env bash
# fetch_cbmc.sh DIR: puts CBMC into DIR; DIR/cbmc runs it. For suites that have no such package (bookworm): it and the
# libraries it needs come from trixie, of the Debian mirror that this machine's apt uses already, through an apt state of
# its own, and are unpacked, not installed. /etc/apt stays untouched. Integrity is apt's: signed InRelease, then Packages,
# then SHA256. Needs no root.
#
# Environment: CBMC_MIRROR  a Debian mirror, instead of the configured one
set -euo pipefail
suite=trixie
keyring=/usr/share/keyrings/debian-archive-keyring.gpg
mkdir -p "${1:?usage: fetch_cbmc.sh DIR}"
out=$(cd "$1" && pwd)

say() { printf 'setup: %s\n' "$*" >&2; }
die() { say "$*"; exit 1; }

# Of the configured archives, the Label leaves out security and backports.
mirror=${CBMC_MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' \
    'Created-By: Packages' 'Origin: Debian' 'Label: Debian' 'Component: main' | head -n 1)}
[ -n "$mirror" ] || die "apt knows no Debian mirror: set CBMC_MIRROR to one, or install cbmc"
[ -r "$keyring" ] || die "$keyring is missing: apt-get install debian-archive-keyring"

state=$(mktemp -d)
trap 'rm -rf "$state"' EXIT
mkdir -p "$state/lists/partial" "$state/cache/archives/partial" "$state/packages"
chmod 755 "$state"
if [ "$(id -u)" -eq 0 ] && id _apt >/dev/null 2>&1; then
    chown _apt "$state/lists/partial" "$state/cache/archives/partial" "$state/packages"
fi
: > "$state/status"
cat > "$state/cbmc.sources" <<SOURCE
Types: deb
URIs: $mirror
Suites: $suite
Components: main
Architectures: $(dpkg --print-architecture)
Targets: Packages
Languages: none
Signed-By: $keyring
SOURCE
private_apt() {
    apt-get -qq -o DPkg::Lock::Timeout=300 -o "Dir::Etc::SourceList=$state/cbmc.sources" -o Dir::Etc::SourceParts=/dev/null \
        -o Dir::Etc::Preferences=/dev/null -o Dir::Etc::PreferencesParts=/dev/null -o "Dir::State::Status=$state/status" \
        -o "Dir::State::Lists=$state/lists" -o "Dir::Cache=$state/cache" "$@" >&2
}
say "fetching cbmc from $suite"
private_apt update || die "cannot read $suite of the configured Debian mirror"
(cd "$state/packages" && private_apt download cbmc minisat libc6 libstdc++6 libgcc-s1 zlib1g) || die "no cbmc in $suite"
for package in "$state"/packages/*.deb; do dpkg-deb -x "$package" "$out/tree"; done

# Started by the loader and libraries of its own suite.
loader=$(find "$out/tree" -name 'ld-linux*.so.*' | head -n 1)
libraries=$(dirname "$(find "$out/tree" -name 'libstdc++.so.6' | head -n 1)")
c_library=$(dirname "$(find "$out/tree" -name 'libc.so.6' | head -n 1)")
printf '#!/bin/sh\nexec "%s" --library-path "%s:%s:%s" "%s" "$@"\n' \
    "$loader" "$libraries" "$c_library" "$out/tree/usr/lib" "$out/tree/usr/bin/cbmc" > "$out/cbmc.new"
chmod +x "$out/cbmc.new"
"$out/cbmc.new" --version >/dev/null || die "cbmc of $suite does not run here"
mv "$out/cbmc.new" "$out/cbmc"
