#include "cell_library.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#define CELL 2U
#define NUMBER_MAX 40U
#define FIELD_MAX 60U

void *cell_memcpy(void *to, const void *from, size_t cells)
{
    return memcpy(to, from, cells * CELL);
}

void *cell_memmove(void *to, const void *from, size_t cells)
{
    return memmove(to, from, cells * CELL);
}

void *cell_memset(void *to, int value, size_t cells)
{
    int *cell = to;

    while (cells-- > 0U) {
        *cell++ = value;
    }
    return to;
}

int cell_memcmp(const void *one, const void *other, size_t cells)
{
    const unsigned *a = one, *b = other;

    for (; cells > 0U; cells--, a++, b++) {
        if (*a != *b) {
            return *a > *b ? 1 : -1;
        }
    }
    return 0;
}

void *cell_memchr(const void *in, int wanted, size_t cells)
{
    const int *cell = in;

    for (; cells > 0U; cells--, cell++) {
        if (*cell == wanted) {
            return (void *)cell;
        }
    }
    return NULL;
}

size_t cell_strlen(const int *text)
{
    size_t length = 0U;

    while (text[length] != 0) {
        length++;
    }
    return length;
}

int *cell_strcpy(int *to, const int *from)
{
    return memcpy(to, from, (cell_strlen(from) + 1U) * CELL);
}

int cell_strcmp(const int *one, const int *other)
{
    return cell_strncmp(one, other, SIZE_MAX);
}

int cell_strncmp(const int *one, const int *other, size_t most)
{
    for (; most > 0U; most--, one++, other++) {
        if (*one != *other || *one == 0) {
            return *one - *other;
        }
    }
    return 0;
}

int *cell_strchr(const int *text, int wanted)
{
    return cell_memchr(text, wanted, cell_strlen(text) + 1U);
}

int *cell_strstr(const int *text, const int *wanted)
{
    for (; *text != 0; text++) {
        if (cell_strncmp(text, wanted, cell_strlen(wanted)) == 0) {
            return (int *)text;
        }
    }
    return *wanted == 0 ? (int *)text : NULL;
}

static void narrow(char *to, size_t capacity, const int *from)
{
    size_t i;

    for (i = 0U; i + 1U < capacity && from[i] != 0; i++) {
        to[i] = (char)from[i];
    }
    to[i] = '\0';
}

unsigned long cell_strtoul(const int *text, int **end, int base)
{
    char number[NUMBER_MAX];
    char *behind;
    unsigned long value;

    narrow(number, sizeof number, text);
    value = strtoul(number, &behind, base);
    if (end != NULL) {
        *end = (int *)text + (behind - number);
    }
    return value;
}

long cell_atol(const int *text)
{
    char number[NUMBER_MAX];

    narrow(number, sizeof number, text);
    return atol(number);
}

int cell_atoi(const int *text)
{
    return (int)cell_atol(text);
}

typedef struct {
    int *text; /* NULL: to the console */
    size_t capacity;
    size_t length; /* of the whole text, also of what did not fit */
} sink_t;

static void put(sink_t *sink, int character)
{
    if (sink->text == NULL) {
        (void)putchar(character);
    } else if (sink->length + 1U < sink->capacity) {
        sink->text[sink->length] = character;
    }
    sink->length++;
}

static void put_string(sink_t *sink, const int *text, int most)
{
    for (; *text != 0 && most != 0; text++, most--) {
        put(sink, *text);
    }
}

/* Copies one conversion, stars replaced by their arguments, and returns where it ends. */
static const int *take_conversion(const int *format, char *conversion, va_list *arguments)
{
    size_t length = 0U;

    do {
        if (*format == '*') {
            length += (size_t)snprintf(&conversion[length], NUMBER_MAX - length, "%d",
                                       va_arg(*arguments, int));
        } else {
            conversion[length++] = (char)*format;
        }
        format++;
    } while (strchr("diouxXcsfeg%", conversion[length - 1U]) == NULL || length == 1U);
    conversion[length] = '\0';
    return format;
}

static void put_conversion(sink_t *sink, const char *conversion, va_list *arguments)
{
    const char kind = conversion[strlen(conversion) - 1U];
    const char *point = strchr(conversion, '.');
    char field[FIELD_MAX];
    const char *c;

    if (kind == 's') {
        put_string(sink, va_arg(*arguments, const int *), point == NULL ? -1 : atoi(point + 1));
        return;
    }
    if (strchr("feg", kind) != NULL) {
        (void)snprintf(field, sizeof field, conversion, va_arg(*arguments, double));
    } else if (strchr(conversion, 'l') != NULL) {
        (void)snprintf(field, sizeof field, conversion, va_arg(*arguments, unsigned long));
    } else {
        (void)snprintf(field, sizeof field, conversion, va_arg(*arguments, unsigned));
    }
    for (c = field; *c != '\0'; c++) {
        put(sink, *c);
    }
}

static void format_into(sink_t *sink, const int *format, va_list *arguments)
{
    char conversion[NUMBER_MAX];

    while (*format != 0) {
        if (*format != '%') {
            put(sink, *format++);
        } else if (format[1] == '%') {
            put(sink, '%');
            format += 2;
        } else {
            format = take_conversion(format, conversion, arguments);
            put_conversion(sink, conversion, arguments);
        }
    }
    if (sink->capacity > 0U) {
        sink->text[sink->length < sink->capacity ? sink->length : sink->capacity - 1U] = 0;
    }
}

int cell_snprintf(int *text, size_t capacity, const int *format, ...)
{
    sink_t sink = {text, capacity, 0U};
    va_list arguments;

    va_start(arguments, format);
    format_into(&sink, format, &arguments);
    va_end(arguments);
    return (int)sink.length;
}

int cell_printf(const int *format, ...)
{
    sink_t sink = {NULL, 0U, 0U};
    va_list arguments;

    va_start(arguments, format);
    format_into(&sink, format, &arguments);
    va_end(arguments);
    return (int)sink.length;
}

FILE *cell_fopen(const int *path, const int *mode)
{
    char name[256];

    (void)mode;
    narrow(name, sizeof name, path);
    return fopen(name, "rb");
}

int *cell_fgets(int *text, int capacity, FILE *stream)
{
    int length = 0;
    int octet = 0;

    while (length + 1 < capacity && octet != '\n' && (octet = fgetc(stream)) != EOF) {
        text[length++] = octet;
    }
    text[length] = 0;
    return length > 0 ? text : NULL;
}

void cell_qsort(void *items, size_t count, size_t cells, int (*compare)(const void *one, const void *other))
{
    qsort(items, count, cells * CELL, compare);
}
