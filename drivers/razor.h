/* Razor 9DOF text frames: `#A-C=x,y,z` CR LF `#YPR=yaw,pitch,roll` CR LF, or both joined on one line, with nothing, one
 * comma or one blank between. A YPR line alone is a frame without acceleration. Degrees on the wire,
 * radians out; signs, axes and the accelerometer's counts are the sensor's own (docs/razor.md). Pure.
 *
 * The frame collector runs in the receive interrupt and only gathers characters; reading numbers is the task's. */
#ifndef DRIVERS_RAZOR_H
#define DRIVERS_RAZOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drivers/octet.h"

#define RAZOR_FRAME_MAX 96U

/* One frame's text: from '#' of A-C (or of YPR, when it comes alone) to the end of YPR, without its line end; a line end
 * between the two is kept as one LF. */
typedef struct {
    char text[RAZOR_FRAME_MAX];
    uint16_t length;
} razor_text_t;

typedef struct {
    razor_text_t gathered;
    uint16_t state;         /* private */
    uint16_t part_start;    /* private: where the '#' of the present part stands */
    uint32_t overlong;      /* frames dropped: no end within RAZOR_FRAME_MAX */
    uint32_t cut;           /* frames dropped: a '#' came before the line end of YPR */
} razor_collector_t;

/* Finds frames in anything: other lines (boot texts, "!ANG:", "#M-C=", "#G-C=" ...) and octets between lines are passed
 * over without being counted, also between the two parts of a frame; a new A-C starts a new frame. Octets inside a frame
 * are kept as they come, NUL too, for razor_parse to refuse. CR, LF and CR LF end a line. */

void razor_collector_init(razor_collector_t *collector);
/* True at the line end of YPR: collector->gathered holds a complete frame, valid until the next call. */
bool razor_collect(razor_collector_t *collector, octet_t octet);
/* The UART lost octets: drop what is gathered. */
void razor_collector_broken(razor_collector_t *collector);

typedef struct {
    float yaw_rad, pitch_rad, roll_rad;
    bool has_acceleration;                          /* the A-C part was there; else its counts are 0 */
    float x_counts, y_counts, z_counts;
} razor_frame_t;

typedef enum { RAZOR_OK, RAZOR_MALFORMED, RAZOR_OUT_OF_RANGE } razor_status_t;

/* OK writes *frame; otherwise it is untouched. nan, inf, ovf, a wrong number of fields, |angle| > 360 deg and
 * an acceleration over 4096 counts are refused. */
razor_status_t razor_parse(const razor_text_t *text, razor_frame_t *frame);

#endif
