#!/usr/bin/env bash
# unpack_cbmc.sh DIR: puts CBMC with its libraries into DIR; DIR/cbmc runs it. Not installed: unpacked from Debian's suite
# trixie (fetch_trixie.sh), and started by the loader and the libraries of its own suite.
set -euo pipefail
mkdir -p "${1:?usage: unpack_cbmc.sh DIR}"
out=$(cd "$1" && pwd)
packages=$(mktemp -d)
trap 'rm -rf "$packages"' EXIT
chmod 755 "$packages"
"$(dirname "${BASH_SOURCE[0]}")/fetch_trixie.sh" "$packages" cbmc minisat libc6 libstdc++6 libgcc-s1 zlib1g >/dev/null
for package in "$packages"/*.deb; do dpkg-deb -x "$package" "$out/tree"; done
loader=$(find "$out/tree" -name 'ld-linux*.so.*' | head -n 1)
libraries=$(dirname "$(find "$out/tree" -name 'libstdc++.so.6' | head -n 1)")
c_library=$(dirname "$(find "$out/tree" -name 'libc.so.6' | head -n 1)")
printf '#!/bin/sh\nexec "%s" --library-path "%s:%s:%s" "%s" "$@"\n' \
    "$loader" "$libraries" "$c_library" "$out/tree/usr/lib" "$out/tree/usr/bin/cbmc" > "$out/cbmc.new"
chmod +x "$out/cbmc.new"
"$out/cbmc.new" --version >/dev/null || { echo "setup: the unpacked cbmc does not run here" >&2; exit 1; }
mv "$out/cbmc.new" "$out/cbmc"
