/* A place and the way through it, as text: a line for a thing or a leg of the way, # begins a remark.
 *
 *   rough   RMS_MM CORRELATION_M              the floor between the things
 *   bars    HEIGHT_MM PERIOD SHARE            bars across the floor along x from 0.5 m on; < 0: grooves
 *   block   X Y LENGTH WIDTH HEIGHT           a box on the floor, its middle at X Y
 *   ramp    X Y LENGTH WIDTH NEAR FAR         rises evenly along its length, or falls
 *   stairs  X Y STEPS RUN RISE WIDTH          X Y: middle of the first step's near edge
 *   table   X Y LENGTH WIDTH HEIGHT           a board on four legs
 *   post    X Y THICKNESS HEIGHT              a chair's leg
 *   wall    X1 Y1 X2 Y2 HEIGHT
 *   lift    X Y LENGTH WIDTH TRAVEL SPEED START STAY   level with the floor; rises, stays, and sinks again
 *   foot    X Y LENGTH WIDTH HEIGHT START SECONDS      a block that is there for a while
 *   go      START X Y SPEED                   a leg of the way
 *   carried                                   along the way exactly, as on a rail; else a pilot flies it
 *   floor   NAME                              its surface
 *   tiles   NAME NAME SIZE                    the floor in squares of two surfaces, a corner at 0 0
 *   sun     X Y LENGTH WIDTH STRENGTH         sunlight on everything over there, 0 to 1
 *   surface NAME REFLECTANCE GLOSS CLEAR OFFSET_MM DEPTH_MM   one more, or another one of that name
 * (surface.h)
 *
 * `turned DEG` behind a thing turns it about its X Y, counter-clockwise from above; behind a leg it is where
 * the nose turns to on the way. `of NAME` behind a thing is its surface. Metres, seconds, degrees. The
 * vehicle stands at 0 0, nose along x. */
#ifndef SIM_SCENARIOS_PLACE_FILE_H
#define SIM_SCENARIOS_PLACE_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "sim/devices/course.h"
#include "sim/devices/place.h"

#define PLACE_FILE_SURFACES_MAX 16

typedef struct {
    place_t place;
    course_t course;
    surface_t surfaces[PLACE_FILE_SURFACES_MAX]; /* of its own */
    int surface_count;
    unsigned line;     /* of the fault */
    char message[160]; /* what is wrong with it */
} place_file_t;

/* The waves of a rough floor by the seed. False: *file says which line is wrong, and how. */
bool place_file_read(place_file_t *file, const char *text, unsigned long seed);

#endif
