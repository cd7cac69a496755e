/* The sensor's side of SCIP 2.0, written from its specification and apart from the product, so that a mistake
 * in the product is not made here too. A header alone: the tests of the other machines are made of one file
 * each. */
#ifndef TESTS_SUPPORT_SCIP_FRAMES_H
#define TESTS_SUPPORT_SCIP_FRAMES_H

#include <stddef.h>
#include <string.h>

#define SCIP_FRAMES_BLOCK 64 /* characters of data in a line */

/* Characters of six bits each, the high ones first; no end of text. */
static inline void scip_frames_encode(char *text, unsigned long value, unsigned width)
{
    while (width-- > 0) {
        text[width] = (char)(48 + (value & 63));
        value >>= 6;
    }
}

/* The characters, their sum and the line's end. Returns their number, without the text's end. */
static inline size_t scip_frames_summed(char *to, const char *from, size_t length)
{
    unsigned sum = 0;

    for (size_t i = 0; i < length; i++) {
        sum += (unsigned)from[i];
        to[i] = from[i];
    }
    to[length] = (char)(48 + (sum & 63));
    to[length + 1] = '\n';
    to[length + 2] = '\0';
    return length + 2;
}

/* A frame with data that is encoded already. echo: without the line's end; its first letter says whether the
 * frame is one of a stream (M) or a single one (G). Returns its length, without the text's end. */
static inline size_t scip_frames_frame(char *to, const char *echo, unsigned long stamp_ms, const char *data,
                                       size_t length)
{
    char stamp[4];
    size_t end = strlen(echo);

    memcpy(to, echo, end);
    to[end++] = '\n';
    end += scip_frames_summed(to + end, echo[0] == 'M' ? "99" : "00", 2);
    scip_frames_encode(stamp, stamp_ms, 4);
    end += scip_frames_summed(to + end, stamp, 4);
    for (size_t at = 0; at < length; at += SCIP_FRAMES_BLOCK) {
        const size_t left = length - at;

        end += scip_frames_summed(to + end, data + at, left < SCIP_FRAMES_BLOCK ? left : SCIP_FRAMES_BLOCK);
    }
    to[end++] = '\n';
    to[end] = '\0';
    return end;
}

#endif
