/* The law of a student, as law MINE (cmake/own_law.cmake). */
#ifndef COURSE_MARK_GIVEN_LAW_H
#define COURSE_MARK_GIVEN_LAW_H

#include "control/laws/laws.h"

/* To be called before the first step. */
void given_law_set(law_step_t law);

#endif
