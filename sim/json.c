#include "sim/json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define UNICODE_MOST 0x10FFFFU
#define SURROGATES 0xD800U
#define SURROGATES_END 0xE000U

/* Octets of the UTF-8 character that text begins with (RFC 3629), 0 when it begins with none. */
static int character(const unsigned char *text)
{
    static const unsigned least[] = {0U, 0U, 0x80U, 0x800U, 0x10000U}; /* that so many octets may say */
    const int length = text[0] < 0x80U                       ? 1
                       : text[0] >= 0xC0U && text[0] < 0xE0U ? 2
                       : text[0] >= 0xE0U && text[0] < 0xF0U ? 3
                       : text[0] >= 0xF0U && text[0] < 0xF8U ? 4
                                                             : 0;
    unsigned code = length > 1 ? text[0] & (0x7FU >> length) : text[0];

    for (int i = 1; i < length; i++) {
        if ((text[i] & 0xC0U) != 0x80U) {
            return 0;
        }
        code = code << 6 | (text[i] & 0x3FU);
    }
    const bool surrogate = code >= SURROGATES && code < SURROGATES_END;
    return length == 0 || code < least[length] || code > UNICODE_MOST || surrogate ? 0 : length;
}

static void quote(FILE *out, const char *text)
{
    const unsigned char *at = (const unsigned char *)text;

    fputc('"', out);
    while (*at != '\0') {
        const int length = character(at);

        if (length == 0) {
            fputs("\\ufffd", out);
        } else if (*at < 0x20U || *at == 0x7FU) {
            fprintf(out, "\\u%04x", (unsigned)*at);
        } else {
            fprintf(out, *at == '"' || *at == '\\' ? "\\%.*s" : "%.*s", length, (const char *)at);
        }
        at += length == 0 ? 1 : length;
    }
    fputc('"', out);
}

static bool has_lines(const json_t *json)
{
    return json->depth == 0 || json->level[json->depth].array;
}

static void new_line(const json_t *json, int indent)
{
    fprintf(json->out, "\n%*s", 2 * indent, "");
}

/* The comma before a member, its place and its name. */
static void member(json_t *json, const char *key)
{
    const bool first = !json->level[json->depth].any;

    json->level[json->depth].any = true;
    if (!first) {
        fputc(',', json->out);
    }
    if (has_lines(json)) {
        new_line(json, json->depth + 1);
    } else if (!first) {
        fputc(' ', json->out);
    }
    if (key != NULL) {
        quote(json->out, key);
        fputs(": ", json->out);
    }
}

static void open_level(json_t *json, const char *key, bool array)
{
    member(json, key);
    if (json->depth + 1 == JSON_DEPTH_MAX) {
        fputs("json: too deep\n", stderr);
        abort();
    }
    json->depth++;
    json->level[json->depth].array = array;
    json->level[json->depth].any = false;
    fputc(array ? '[' : '{', json->out);
}

static void end_level(const json_t *json)
{
    if (has_lines(json) && json->level[json->depth].any) {
        new_line(json, json->depth);
    }
    fputc(json->level[json->depth].array ? ']' : '}', json->out);
}

void json_begin(json_t *json, FILE *out)
{
    memset(json, 0, sizeof *json);
    json->out = out;
    fputc('{', out);
}

void json_end(json_t *json)
{
    end_level(json);
    fputc('\n', json->out);
}

void json_object(json_t *json, const char *key)
{
    open_level(json, key, false);
}

void json_array(json_t *json, const char *key)
{
    open_level(json, key, true);
}

void json_close(json_t *json)
{
    end_level(json);
    json->depth--;
}

void json_text(json_t *json, const char *key, const char *text)
{
    member(json, key);
    quote(json->out, text);
}

void json_flag(json_t *json, const char *key, bool value)
{
    member(json, key);
    fputs(value ? "true" : "false", json->out);
}

void json_whole(json_t *json, const char *key, long long value)
{
    member(json, key);
    fprintf(json->out, "%lld", value);
}

static void number(json_t *json, const char *key, double value, const char *format, int digits)
{
    member(json, key);
    if (isfinite(value)) {
        fprintf(json->out, format, digits, value);
    } else {
        fputs("null", json->out);
    }
}

void json_number(json_t *json, const char *key, double value, int digits)
{
    number(json, key, value, "%.*g", digits);
}

void json_fixed(json_t *json, const char *key, double value, int decimals)
{
    number(json, key, value, "%.*f", decimals);
}
