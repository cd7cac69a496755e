/* What is written is JSON, whatever the texts and numbers are. */
#include "sim/json.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unity.h"

static char *text;
static size_t size;
static FILE *out;
static json_t json;

void setUp(void)
{
    out = open_memstream(&text, &size);
    json_begin(&json, out);
}

static void finish(void)
{
    if (out != NULL) {
        fclose(out);
    }
    out = NULL;
}

void tearDown(void)
{
    finish();
    free(text);
    text = NULL;
}

static void written(const char *expected)
{
    json_end(&json);
    finish();
    TEST_ASSERT_EQUAL_STRING(expected, text);
}

static void quoted(const char *plain, const char *expected)
{
    char line[128];

    json_text(&json, "a", plain);
    snprintf(line, sizeof line, "{\n  \"a\": \"%s\"\n}\n", expected);
    written(line);
    tearDown();
    setUp();
}

void test_nothing_is_an_object(void)
{
    written("{}\n");
}

void test_members_stand_on_lines_and_objects_in_arrays_on_one(void)
{
    json_text(&json, "name", "est");
    json_flag(&json, "met", true);
    json_array(&json, "tasks");
    json_object(&json, NULL);
    json_whole(&json, "n", -3);
    json_fixed(&json, "t", 1.0 / 3.0, 3);
    json_close(&json);
    json_object(&json, NULL);
    json_close(&json);
    json_close(&json);
    json_array(&json, "none");
    json_close(&json);
    json_object(&json, "load");
    json_number(&json, "total", 1e-9, 6);
    json_flag(&json, "full", false);
    json_close(&json);
    written("{\n  \"name\": \"est\",\n  \"met\": true,\n  \"tasks\": [\n    {\"n\": -3, \"t\": 0.333},\n    "
            "{}\n  ],\n"
            "  \"none\": [],\n  \"load\": {\"total\": 1e-09, \"full\": false}\n}\n");
}

void test_quotes_and_control_characters_are_escaped(void)
{
    quoted("a\"b\\c", "a\\\"b\\\\c");
    quoted("\n\t\x01\x7F", "\\u000a\\u0009\\u0001\\u007f");
    quoted("", "");
}

void test_utf_8_stays_and_what_is_none_is_replaced(void)
{
    quoted("45\xC2\xB0 \xE2\x82\xAC \xF0\x9F\x9A\x81", "45\xC2\xB0 \xE2\x82\xAC \xF0\x9F\x9A\x81");
    quoted("\xFFz", "\\ufffdz");
    quoted("\xC2", "\\ufffd");                                  /* cut off */
    quoted("\xC0\xAF", "\\ufffd\\ufffd");                       /* a slash, longer than it need be */
    quoted("\xED\xA0\x80", "\\ufffd\\ufffd\\ufffd");            /* half of a pair of UTF-16 */
    quoted("\xF4\x90\x80\x80", "\\ufffd\\ufffd\\ufffd\\ufffd"); /* beyond Unicode */
    quoted("\x80", "\\ufffd");
}

void test_a_key_is_escaped_too(void)
{
    json_whole(&json, "a\"b", 1);
    written("{\n  \"a\\\"b\": 1\n}\n");
}

void test_a_number_that_is_none_is_null(void)
{
    json_number(&json, "a", NAN, 6);
    json_fixed(&json, "b", INFINITY, 3);
    json_number(&json, "c", -INFINITY, 6);
    written("{\n  \"a\": null,\n  \"b\": null,\n  \"c\": null\n}\n");
}
