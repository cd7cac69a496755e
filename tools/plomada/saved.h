/* What people save of the radio: a terminal's text, or the console log of XCTU with its payloads in hex. */
#ifndef TOOLS_PLOMADA_SAVED_H
#define TOOLS_PLOMADA_SAVED_H

#include <stdio.h>

#define SAVED_LINE 4096 /* characters of a line, terminator included; longer ones are cut */

/* Calls `take` for every line, without its end. rest: what the file ends with, when that is no whole line. */
void saved_read(FILE *in, void (*take)(void *context, const char *line), void *context,
                char rest[SAVED_LINE]);

#endif
