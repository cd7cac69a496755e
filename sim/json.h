/* JSON as it is written: the one place that knows its commas, its quotes and what it cannot say. Any text is
 * valid JSON then: what must be escaped is, and octets that are no UTF-8 become U+FFFD. A number that is none
 * (NAN, INFINITY) is null. The root and every array have a line for each member, an object within them has
 * one line.
 *
 * Whether everything reached the file is the file's own business (ferror). */
#ifndef SIM_JSON_H
#define SIM_JSON_H

#include <stdbool.h>
#include <stdio.h>

#define JSON_DEPTH_MAX 8

typedef struct {
    FILE *out;
    int depth;
    struct {
        bool array, any;
    } level[JSON_DEPTH_MAX];
} json_t;

/* The root, an object. json_end() ends it, and the line. */
void json_begin(json_t *json, FILE *out);
void json_end(json_t *json);

/* key: NULL in an array. Each is ended by json_close(). */
void json_object(json_t *json, const char *key);
void json_array(json_t *json, const char *key);
void json_close(json_t *json);

void json_text(json_t *json, const char *key, const char *text);
void json_flag(json_t *json, const char *key, bool value);
void json_whole(json_t *json, const char *key, long long value);
/* With so many significant digits. */
void json_number(json_t *json, const char *key, double value, int digits);
/* With so many decimals. */
void json_fixed(json_t *json, const char *key, double value, int decimals);

#endif
