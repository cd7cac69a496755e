#!/usr/bin/env bash
# fetch_cmock.sh DIR: downloads Debian's `cmock` package (CMock with Unity, for all architectures) and prints the path of
# the .deb in DIR. For suites that have no such package (bookworm): it comes from trixie, of the Debian mirror that this
# machine's apt uses already, through an apt state of its own. /etc/apt stays untouched and no other package can come from
# that suite. Integrity is apt's: signed InRelease, then Packages, then SHA256. Needs no root.
#
# Environment: CMOCK_MIRROR  a Debian mirror, instead of the configured one
set -euo pipefail
suite=trixie
keyring=/usr/share/keyrings/debian-archive-keyring.gpg
out=$(cd "${1:?usage: fetch_cmock.sh DIR}" && pwd)

say() { printf 'setup: %s\n' "$*" >&2; }
die() { say "$*"; exit 1; }

# Of the configured archives, the Label leaves out security and backports.
mirror=${CMOCK_MIRROR:-$(apt-get indextargets --format '$(REPO_URI)' \
    'Created-By: Packages' 'Origin: Debian' 'Label: Debian' 'Component: main' | head -n 1)}
[ -n "$mirror" ] || die "apt knows no Debian mirror: set CMOCK_MIRROR to one, or CMOCK_ROOT to a CMock tree with vendor/unity"
[ -r "$keyring" ] || die "$keyring is missing: apt-get install debian-archive-keyring"

state=$(mktemp -d)
trap 'rm -rf "$state"' EXIT
chmod 755 "$state" "$out"
mkdir -p "$state/lists/partial" "$state/cache/archives/partial"
if [ "$(id -u)" -eq 0 ] && id _apt >/dev/null 2>&1; then
    chown _apt "$state/lists/partial" "$state/cache/archives/partial" "$out"
fi
cat > "$state/cmock.sources" <<SOURCE
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
    apt-get -qq -o DPkg::Lock::Timeout=300 \
        -o "Dir::Etc::SourceList=$state/cmock.sources" -o Dir::Etc::SourceParts=/dev/null \
        -o Dir::Etc::Preferences=/dev/null -o Dir::Etc::PreferencesParts=/dev/null \
        -o "Dir::State::Lists=$state/lists" -o "Dir::Cache=$state/cache" "$@" >&2
}
say "fetching cmock from $suite"
private_apt update || die "cannot read $suite of the configured Debian mirror"
rm -f "$out"/cmock_*_all.deb
(cd "$out" && private_apt download cmock) || die "no cmock in $suite"
echo "$out"/cmock_*_all.deb
