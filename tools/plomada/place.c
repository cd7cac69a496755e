#include "place.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "input.h"
#include "sim/scenarios/place_file.h"

#define TEXT_N 65536 /* 200 blocks, and as much in remarks */

const char *place_read(const char *path)
{
    static place_file_t file;
    static char text[TEXT_N];
    FILE *in = input_open(path);

    if (in == NULL) {
        fprintf(stderr, "plomada fly: %s: %s\n", path, strerror(errno));
        return NULL;
    }
    const size_t length = fread(text, 1, sizeof text - 1, in);
    const bool failed = ferror(in) != 0, rest = fgetc(in) != EOF;

    fclose(in);
    text[length] = '\0';
    if (failed || rest || memchr(text, '\0', length) != NULL) {
        fprintf(stderr, "plomada fly: %s: %s\n", path,
                failed ? "cannot be read"
                : rest ? "longer than 64 KB"
                       : "not a text");
        return NULL;
    }
    if (!place_file_read(&file, text, 1)) {
        fprintf(stderr, "plomada fly: %s:%u: %s\n", path, file.line, file.message);
        return NULL;
    }
    return text;
}
