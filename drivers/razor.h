/* Razor 9DOF text frames: `#A-C=x,y,z` CR LF `#YPR=yaw,pitch,roll` CR LF. Both parts may also stand on one
 * line, with nothing, one comma or one blank between them. A YPR line alone is a frame without
 * acceleration. Angles are degrees on the wire and radians in the results. Signs, axes and the
 * accelerometer's counts are the sensor's own (docs/razor.md).
 *
 * Pure; the caller owns the state. Calling context in the firmware: the receive Hwi runs the collector,
 * which only collects characters. A Task runs razor_parse(), which reads the numbers. */
#ifndef DRIVERS_RAZOR_H
#define DRIVERS_RAZOR_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drivers/octet.h"

#define RAZOR_FRAME_MAX 96U

/* Text of one frame, from the '#' of A-C to the end of YPR, without its line end. When YPR comes alone,
 * the text begins with its '#'. A line end between the two parts is kept as one LF. */
typedef struct {
    char text[RAZOR_FRAME_MAX];
    uint16_t length;
} razor_text_t;

typedef struct {
    razor_text_t gathered;
    uint16_t state;      /* private */
    uint16_t part_start; /* private: index of the '#' of the present part */
    uint32_t overlong;   /* dropped frames: no end within RAZOR_FRAME_MAX */
    uint32_t cut;        /* dropped frames: a '#' came before the line end of YPR */
} razor_collector_t;

/* The collector finds frames in any stream. It skips other lines (boot texts, "!ANG:", "#M-C=", "#G-C="
 * ...) and octets between lines, also between the two parts of a frame; it does not count them. A new A-C
 * starts a new frame. All octets inside a frame are kept, also NUL; razor_parse() rejects the bad ones.
 * CR, LF and CR LF end a line. */

void razor_collector_init(razor_collector_t *collector);
/* Processes one octet. Returns true at the line end of YPR: then collector->gathered is a complete frame,
 * valid until the next call. */
bool razor_collect(razor_collector_t *collector, octet_t octet);
/* Call this when the UART lost octets. Drops the present frame. */
void razor_collector_broken(razor_collector_t *collector);

typedef struct {
    float yaw_rad, pitch_rad, roll_rad;
    bool has_acceleration; /* the A-C part was present; else the counts are 0 */
    float x_counts, y_counts, z_counts;
} razor_frame_t;

typedef enum { RAZOR_OK, RAZOR_MALFORMED, RAZOR_OUT_OF_RANGE } razor_status_t;

/* Reads the numbers of one frame. RAZOR_OK: *frame is written. Otherwise *frame does not change. Rejected
 * are: nan, inf, ovf, a wrong number of fields, |angle| > 360 deg, and an acceleration over 4096 counts. */
razor_status_t razor_parse(const razor_text_t *text, razor_frame_t *frame);

#endif
