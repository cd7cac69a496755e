#!/bin/bash
# same.sh [COMMIT..COMMIT]: proves that two commits fly the same. Without a range: HEAD against the files as they are.
#
# Builds the program of both, flies every scenario that the first one lists, seeds 1 to 3, and compares the CSVs octet by
# octet. A scenario that only the second one has is not flown.
# Exit status: 0 all the same; 1 some differ, each is named; 2 usage, or one does not build.
set -euo pipefail
usage() { sed -n '2,6s/^# \{0,1\}//p' "$0" >&2; exit 2; }
[ $# -le 1 ] || usage
root=$(git -C "$(dirname "$0")" rev-parse --show-toplevel)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

build() { # SOURCE NAME
    { cmake -S "$1" -B "$work/$2-build" -DCMAKE_BUILD_TYPE=Release -DPLOMADA_TESTS=OFF &&
        cmake --build "$work/$2-build" --target plomada -j "$(nproc)"; } >"$work/$2.log" 2>&1 ||
        { tail -n 20 "$work/$2.log" >&2; exit 2; }
}

commit() { # COMMIT NAME
    mkdir "$work/$2"
    git -C "$root" archive --format=tar "$1^{commit}" 2>"$work/$2.log" | tar -x -C "$work/$2" ||
        { cat "$work/$2.log" >&2; exit 2; }
    build "$work/$2" "$2"
}

case "${1-}" in
'') commit HEAD old; build "$root" new ;;
?*..?*) commit "${1%%..*}" old; commit "${1##*..}" new ;;
*) usage ;;
esac

fly() { # NAME SCENARIO SEED
    "$work/$1-build/plomada" fly "$2" --seed "$3" --csv "$work/$1.csv" >"$work/$1.txt" 2>&1 || [ $? -eq 1 ] ||
        { cat "$work/$1.txt" >&2; exit 2; }
}

flights=0 differ=0
for scenario in $("$work/old-build/plomada" list | awk '/^[a-z]/ {print $1}'); do
    for seed in 1 2 3; do
        fly old "$scenario" "$seed"
        fly new "$scenario" "$seed"
        flights=$((flights + 1))
        cmp -s "$work/old.csv" "$work/new.csv" || { differ=$((differ + 1)); echo "differs: $scenario --seed $seed"; }
    done
done
echo "$flights flights, $differ differ"
[ "$differ" -eq 0 ]
