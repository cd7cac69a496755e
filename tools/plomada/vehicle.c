#include "vehicle.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "input.h"

#define SIZE_MAX_OCTETS (1 << 20)

/* Zero-terminated, to be freed; NULL with errno set. */
static char *text_of(const char *path)
{
    FILE *in = input_open(path);
    char *text = in == NULL ? NULL : malloc(SIZE_MAX_OCTETS + 1);
    size_t length;

    if (text == NULL) {
        return NULL;
    }
    length = fread(text, 1, SIZE_MAX_OCTETS, in);
    text[length] = '\0';
    fclose(in);
    return text;
}

static const char *skip(const char *text, const char *what)
{
    text += strspn(text, " \t\r\n");
    return strncmp(text, what, strlen(what)) == 0 ? text + strlen(what) : NULL;
}

/* Behind a name: `" : { "value" : V`. NULL where it is not so. */
static const char *value_at(const char *text)
{
    static const char *const words[] = {"\"", ":", "{", "\"value\"", ":"};

    for (size_t i = 0; text != NULL && i < sizeof words / sizeof words[0]; i++) {
        text = skip(text, words[i]);
    }
    return text == NULL ? NULL : text + strspn(text, " \t\r\n");
}

static const char *take(flight_options_t *options, const char *name)
{
    char assignment[96];
    const size_t length = strcspn(name, "\"");
    const char *value = value_at(name + length);
    char *end = NULL;
    const double figure = value == NULL ? NAN : strtod(value, &end);

    if (value == NULL || length > 40 || end == value || !isfinite(figure)) {
        return "a figure of the plant without its value";
    }
    snprintf(assignment, sizeof assignment, "%.*s=%.9g", (int)length, name, figure);
    return flight_override(options, assignment);
}

const char *vehicle_read(flight_options_t *options, const char *path)
{
    char *text = text_of(path);
    const char *error = text == NULL ? strerror(errno) : NULL;
    const char *at = text;
    int found = 0;

    while (error == NULL && (at = strstr(at, "\"plant.")) != NULL) {
        at++;
        error = take(options, at);
        found++;
    }
    free(text);
    return error == NULL && found == 0 ? "no figure of the plant in it" : error;
}
