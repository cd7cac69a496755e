#!/usr/bin/env bash
# fetch_trixie.sh DIR PACKAGE...: downloads packages of Debian's suite trixie into DIR and prints the path of each .deb, in
# their order. For suites that have no such package (bookworm): they come from the Debian mirror that this machine's apt uses
# already, through an apt state of its own. /etc/apt stays untouched, nothing is installed and no other package can come from
# that suite. Integrity is apt's: signed InRelease, then Packages, then SHA256. Needs no root.
#
# Environment: TRIXIE_MIRROR  a Debian mirror, instead of the configured one
set -euo pipefail
suite=trixie
keyring=/usr/share/keyrings/debian-archive-keyring.gpg
[ $# -ge 2 ] || { echo "usage: fetch_trixie.sh DIR PACKAGE..." >&2; exit 2; }
out=$(cd "$1" && pwd)
shift

say() { printf 'setup: %s\n' "$*" >&2; }
die() { say "$*"; exit 1; }

# Of the configured archives, the Label leaves out security and backports.
mirror=${TRIXIE_MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' \
    'Created-By: Packages' 'Origin: Debian' 'Label: Debian' 'Component: main' | head -n 1)}
[ -n "$mirror" ] || die "apt knows no Debian mirror: set TRIXIE_MIRROR to one, or install $*"
[ -r "$keyring" ] || die "$keyring is missing: apt-get install debian-archive-keyring"

state=$(mktemp -d)
trap 'rm -rf "$state"' EXIT
mkdir -p "$state/lists/partial" "$state/cache/archives/partial" "$state/packages"
chmod 755 "$state"
if [ "$(id -u)" -eq 0 ] && id _apt >/dev/null 2>&1; then
    chown _apt "$state/lists/partial" "$state/cache/archives/partial" "$state/packages"
fi
: > "$state/status"
cat > "$state/suite.sources" <<SOURCE
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
    apt-get -qq -o DPkg::Lock::Timeout=300 -o "Dir::Etc::SourceList=$state/suite.sources" -o Dir::Etc::SourceParts=/dev/null \
        -o Dir::Etc::Preferences=/dev/null -o Dir::Etc::PreferencesParts=/dev/null -o "Dir::State::Status=$state/status" \
        -o "Dir::State::Lists=$state/lists" -o "Dir::Cache=$state/cache" "$@" >&2
}
say "fetching $* from $suite"
private_apt update || die "cannot read $suite of the configured Debian mirror"
(cd "$state/packages" && private_apt download "$@") || die "no $* in $suite"
chmod 755 "$out" # apt installs from it as another user
for package in "$@"; do
    rm -f "$out/$package"_*.deb
    mv "$state/packages/$package"_*.deb "$out/"
    echo "$out/$package"_*.deb
done
