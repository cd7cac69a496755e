#!/usr/bin/env bash
# vehicle.sh [LAW]: builds build-wasm/plomada.wasm, the PC board as one WebAssembly module (sim/wasm/vehicle.h). LAW: a file with a law of
# one's own (docs/my_law.md).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
[ -f "$root/build-wasm/CMakeCache.txt" ] ||
    cmake --toolchain "$root/cmake/wasi.cmake" -S "$root" -B "$root/build-wasm" -DCMAKE_BUILD_TYPE=Release -DPLOMADA_TESTS=OFF
cmake -S "$root" -B "$root/build-wasm" -DPLOMADA_LAW="${1:-}"
cmake --build "$root/build-wasm" --target plomada_wasm -j"$(nproc)"
