/* A file that a subcommand reads. */
#ifndef TOOLS_PLOMADA_INPUT_H
#define TOOLS_PLOMADA_INPUT_H

#include <stdio.h>

/* As fopen() for reading, but a folder does not open: it would read as an empty file. */
FILE *input_open(const char *path);

#endif
