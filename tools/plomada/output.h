/* A file that a subcommand writes: `-` is stdout, and nothing that was not written counts as done. */
#ifndef TOOLS_PLOMADA_OUTPUT_H
#define TOOLS_PLOMADA_OUTPUT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

typedef struct {
    const char *path; /* NULL: not asked for */
    FILE *file;       /* NULL: not open */
    bool made;        /* by output_open_all(): it was not there before */
} output_t;

/* Opens output->path when there is one. On failure the reason is on stderr. */
bool output_open(output_t *output);

/* All of them, or none: when one does not open, the others are as they were. */
bool output_open_all(output_t *const outputs[], size_t count);

/* Flushes and closes. False when any octet did not reach the file (a full disk, a closed pipe); the reason is
 * on stderr. */
bool output_close(output_t *output);

bool output_is_stdout(const output_t *output);

/* A file of the command line. */
typedef struct {
    const char *name; /* of the option, or of the word */
    const char *path; /* NULL: not given */
    bool written;
} output_use_t;

/* Whether each written file is no other file of these. What is read and written would be destroyed before it
 * is read. One file goes by many names: it is known by device and inode. Devices may be written twice.
 * Otherwise the reason is on stderr. Before anything is opened. */
bool output_apart(const char *command, const output_use_t *uses, size_t count);

/* Whether both paths lead to one regular file, there already or to be made; or both are `-`. */
bool output_same(const char *one, const char *other);

#endif
