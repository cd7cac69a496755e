#include "saved.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* Octets joined to lines: a radio's packets end anywhere. */
typedef struct {
    void (*take)(void *context, const char *line);
    void *context;
    char *text;
    size_t length;
} assembler_t;

static void take_octet(assembler_t *assembler, int octet)
{
    if (octet == '\n' || octet == '\r') {
        assembler->text[assembler->length] = '\0';
        assembler->take(assembler->context, assembler->text);
        assembler->length = 0;
    } else if (octet != '\0' && assembler->length < SAVED_LINE - 1) { /* a radio that powers up sends NULs */
        assembler->text[assembler->length++] = (char)octet;
    }
}

static int hex_digit(int c)
{
    return isdigit(c) ? c - '0' : isxdigit(c) ? toupper(c) - 'A' + 10 : -1;
}

/* A record of XCTU's: date time,id,TYPE,rest. Returns where the type begins, NULL for another line. */
static const char *record_type(const char *line)
{
    const char *first = strchr(line, ','), *second = first == NULL ? NULL : strchr(first + 1, ',');
    int day, month, year, hour, minute;

    return second != NULL && sscanf(line, "%d-%d-%d %d:%d:", &day, &month, &year, &hour, &minute) == 5
               ? second + 1
               : NULL;
}

static void take_hex(assembler_t *assembler, const char *hex)
{
    while (hex_digit((unsigned char)hex[0]) >= 0 && hex_digit((unsigned char)hex[1]) >= 0) {
        take_octet(assembler, 16 * hex_digit((unsigned char)hex[0]) + hex_digit((unsigned char)hex[1]));
        hex += hex[2] == ' ' ? 3 : 2;
    }
}

void saved_read(FILE *in, void (*take)(void *context, const char *line), void *context, char rest[SAVED_LINE])
{
    assembler_t assembler = {.take = take, .context = context, .text = rest};
    char *line = NULL;
    size_t room = 0;
    ssize_t length;
    bool console = false; /* from its first record on, whatever stands before it */

    while ((length = getline(&line, &room, in)) > 0) {
        const char *type = record_type(line);

        console = console || type != NULL;
        if (type != NULL && strncmp(type, "RECV,", 5) == 0) {
            take_hex(&assembler, type + 5);
        } else if (!console) {
            for (ssize_t i = 0; i < length; i++) {
                take_octet(&assembler, (unsigned char)line[i]);
            }
        }
    }
    free(line);
    rest[assembler.length] = '\0';
}
