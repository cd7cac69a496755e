/* Levenshtein's distance, one row of its table at a time. */
#include "nearest.h"

#include <ctype.h>
#include <stdbool.h>
#include <string.h>

#define LETTERS 64U

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

static bool same(char a, char b)
{
    return tolower((unsigned char)a) == tolower((unsigned char)b);
}

static size_t distance(const char *a, const char *b)
{
    const size_t length = strlen(b);
    size_t row[LETTERS];

    if (strlen(a) >= LETTERS || length >= LETTERS) {
        return LETTERS;
    }
    for (size_t j = 0; j <= length; j++) {
        row[j] = j;
    }
    for (size_t i = 1; a[i - 1] != '\0'; i++) {
        size_t diagonal = row[0];

        row[0] = i;
        for (size_t j = 1; j <= length; j++) {
            const size_t above = row[j];

            row[j] = least(least(row[j], row[j - 1]) + 1, diagonal + (same(a[i - 1], b[j - 1]) ? 0 : 1));
            diagonal = above;
        }
    }
    return row[length];
}

const char *nearest(const char *typed, const char *const words[], size_t count)
{
    const char *best = NULL;
    size_t best_distance = LETTERS;

    for (size_t i = 0; i < count; i++) {
        const size_t here = distance(typed, words[i]);

        if (here < best_distance && 2 * here < strlen(words[i])) {
            best = words[i];
            best_distance = here;
        }
    }
    return best;
}
