/* How often a frame with independent faults passes a receiver that believes echo, status, line lengths, the
 * range of characters and the 6-bit sums, and nothing else; computed, not tried out. docs/scip.md says how.
 */
#ifndef TESTS_FAULTS_ESCAPE_H
#define TESTS_FAULTS_ESCAPE_H

#include "wire.h"

typedef struct {
    double wrong;       /* probability that a frame passes with a wrong distance or time stamp */
    double wrong_stamp; /* of these: with only the time stamp wrong */
    double right;       /* probability that it passes unharmed */
} escape_t;

/* p: each octet's chance of one fault; the five kinds are equally likely. whole: a frame of `order`. */
escape_t escape_of(const wire_t *whole, const wire_order_t *order, double p);

#endif
