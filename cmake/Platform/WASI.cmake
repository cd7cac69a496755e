# CMake has no such system of its own; there is nothing to say about it beyond cmake/wasi.cmake.
