/* The Benewake TFmini Plus on a UART at 115200 bit/s: one ray, 100 readings a second, without being asked.
 *
 * A reading is nine octets: 59 59, distance, strength and temperature with the low octet first, and the low
 * octet of the sum of these eight (manual SJ-PM-TFmini Plus-T-01 A04, table 7). A strength below 100 or of
 * 65535 means that the distance is not reliable (section 5.4).
 *
 * Delivered, the distance is in centimetres, and nothing in a frame says so. That is too coarse: control/
 * takes a height that repeats itself for a copy. So the sensor is told to use millimetres and to keep that
 * (manual SJ-PM-TFmini-S A01, table 12), and no reading counts before it has repeated the order. A sensor
 * that fell silent may have lost its supply: then the same again. One that repeats the order and goes on in
 * centimetres is seen on the ground: what it tells there lies in its own blind zone, and counts as no
 * distance.
 *
 * What breaks: the sum has eight bits, so one of 256 damaged frames counts. Pure; the caller owns the state,
 * all zero at first. */
#ifndef ONE_RAY_TFMINI_H
#define ONE_RAY_TFMINI_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/octet.h"

#define TFMINI_RATE UINT32_C(115200)     /* bits per second, section 5.2 */
#define TFMINI_FRAME_US UINT32_C(782)    /* nine octets of ten bits */
#define TFMINI_SILENT_US UINT32_C(50000) /* five readings; shorter than any power-up */

typedef struct {
    octet_t octets[9]; /* of the frame that is coming */
    uint16_t count;
    uint32_t latest_us; /* end of the latest good frame */
    bool millimetres;   /* the sensor has repeated the order */
    bool seen;          /* the latest reading: a distance that counts */
    uint16_t distance_mm;
    uint32_t readings, damaged;
} tfmini_t;

/* To be sent while `millimetres` is false. */
#define TFMINI_ORDER 9U
extern const char tfmini_order[TFMINI_ORDER];

/* Processes one octet, which ended at now_us. Returns true when a reading is complete, in millimetres: then
 * `seen` and `distance_mm` are its own, until the next octet. */
bool tfmini_feed(tfmini_t *sensor, octet_t octet, uint32_t now_us);

/* Call this when the UART lost octets. */
void tfmini_line_broken(tfmini_t *sensor);

/* Call this now and then: forgets the order of a sensor that has been silent. */
void tfmini_watch(tfmini_t *sensor, uint32_t now_us);

/* Octets up to the end of the present frame; 1..9. */
uint16_t tfmini_expected(const tfmini_t *sensor);

#endif
