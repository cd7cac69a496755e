/* A file that a subcommand writes: `-` is stdout, and nothing that was not written counts as done. */
#ifndef TOOLS_PLOMADA_OUTPUT_H
#define TOOLS_PLOMADA_OUTPUT_H

#include <stdbool.h>
#include <stdio.h>

typedef struct {
    const char *path; /* NULL: not asked for */
    FILE *file;       /* NULL: not open */
} output_t;

/* Opens output->path when there is one. On failure the reason is on stderr. */
bool output_open(output_t *output);

/* Flushes and closes. False when any octet did not reach the file (a full disk, a closed pipe); the reason is
 * on stderr. */
bool output_close(output_t *output);

bool output_is_stdout(const output_t *output);

#endif
