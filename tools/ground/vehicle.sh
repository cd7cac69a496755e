#!/usr/bin/env bash
# vehicle.sh: builds build-wasm/plomada.wasm, the PC board as one WebAssembly module (sim/wasm/vehicle.h).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
[ -f "$root/build-wasm/CMakeCache.txt" ] ||
    cmake --toolchain "$root/cmake/wasi.cmake" -S "$root" -B "$root/build-wasm" -DCMAKE_BUILD_TYPE=Release -DPLOMADA_TESTS=OFF
cmake --build "$root/build-wasm" --target plomada_wasm -j"$(nproc)"
