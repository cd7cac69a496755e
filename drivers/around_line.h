/* The line that tells what stands around: the nearest distance of each of 72 sectors, from the nose
 * clockwise.
 *
 * A sector takes one character. Digits, then capital, then small letters are 62 steps of distance, each 6.2 %
 * further than the one before, from 100 to 4100 mm: the character tells the near end of its step, so nothing
 * is told further than it is. `.` is a sector in which nothing was met. `-` and a character behind it are so
 * many sectors in a row into which nobody looks: 1 to 61. Pure; any context. */
#ifndef DRIVERS_AROUND_LINE_H
#define DRIVERS_AROUND_LINE_H

#include <stdint.h>

#include "drivers/telemetry.h"

#define AROUND_LINE_SECTORS 72U
#define AROUND_LINE_NOTHING 0U
#define AROUND_LINE_UNSEEN 0xFFFFU

/* Something that comes near, or a wall: where it is, and how fast it comes. */
typedef struct {
    float bearing_deg; /* clockwise from the nose, -360 .. 360 */
    float mm;
    float mmps;       /* below 0: it goes away */
    float sigma_mmps; /* mean error of that; around_line() does not tell it */
} around_line_wall_t;

/* Builds "w:-2GGGGG.5-a" CR LF from millimetres, or one of the two above. The line fits a radio packet as
 * long as the sectors with a character of their own and twice the rows of the others are 91 at most; the
 * scanner's 240 degrees are 48 sectors. coming: adds " near:45,120,60", its bearing in degrees, cm and cm/s;
 * NULL: nothing comes. */
void around_line(telemetry_line_t *line, const uint16_t sectors[AROUND_LINE_SECTORS],
                 const around_line_wall_t *coming);

/* Builds "drift:95,132,-3,2/5,220,12,4" CR LF: of each wall its bearing in degrees, 0 to 359, its distance in
 * cm, how fast it comes nearer in cm/s, and the mean error of that, at least 1. Without a wall: "drift:-".
 * count: at most 3, which fit a packet. */
void around_line_drift(telemetry_line_t *line, const around_line_wall_t walls[], uint16_t count);

#endif
