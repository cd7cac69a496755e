#!/bin/sh
# fuzz.sh DIRECTORY SECONDS: builds the fuzz target of the SCIP parser with libFuzzer, ASan and UBSan in DIRECTORY and runs
# it. The corpus stays there and is taken up again; an input that breaks a promise is written there as crash-*.
# 77 when there is no clang with libFuzzer.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
drivers=$here/../../drivers
mkdir -p "$1/corpus" "$1/good"
cd "$1"
for clang in clang clang-19 clang-18 clang-17 clang-16 clang-15 clang-14 none; do
    printf '#include <stddef.h>\nint LLVMFuzzerTestOneInput(const char *d, size_t n); int LLVMFuzzerTestOneInput(const char *d, size_t n) { return d && n > 9; }\n' |
        "$clang" -x c -fsanitize=fuzzer,address - -o probe 2>/dev/null && break
done
[ "$clang" != none ] || { echo "no clang with libFuzzer: tools/setup/setup.sh fuzz" >&2; exit 77; }
"$clang" -std=gnu99 -g -O1 -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined -I"$drivers/.." \
    "$here"/fuzz_scip.c "$drivers"/scip_*.c -o fuzz_scip
"${CC:-cc}" -std=gnu99 -O1 -I"$drivers/.." "$here"/fuzz_scip.c "$here"/corpus.c "$drivers"/scip_*.c -o corpus_scip
./corpus_scip -w good
./fuzz_scip -max_total_time="$2" -max_len=1024 -use_value_profile=1 -print_final_stats=1 -verbosity=0 corpus good
