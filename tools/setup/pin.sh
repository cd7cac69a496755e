#!/usr/bin/env bash
# pin.sh: writes each requirements.txt anew from its requirements.in: all that it needs, with the sums of all files of a version.
# What is pinned there stays; take its lines out to have it renewed. By Debian 12's Python or one of its version: a newer one
# would leave out what only that one needs.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
python3 -m venv "$scratch"
"$scratch/bin/python" -m pip --quiet install pip-tools
cd "$root"
for folder in tools/plot tools/campaign tools/format tools/scip_package tools/site tools/ground ground; do
    "$scratch/bin/pip-compile" --quiet --generate-hashes --allow-unsafe --strip-extras --no-annotate --no-header \
        "$folder/requirements.in" -o "$folder/requirements.txt"
    # From where packages come is the machine's own business.
    sed -i -e '/^--/d' -e '/^$/d' "$folder/requirements.txt"
    sed -i '1i # Of requirements.in, by tools/setup/pin.sh.' "$folder/requirements.txt"
done
