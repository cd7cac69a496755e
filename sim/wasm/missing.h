/* What wasi-libc does not declare. No links there: a path is its own real path. */
#ifndef SIM_WASM_MISSING_H
#define SIM_WASM_MISSING_H

char *realpath(const char *path, char *resolved);

#endif
