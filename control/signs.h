/* What each part of the control room is shown of the others: the sensors, of the previous command; the
 * supervisor, contact, pilot and hover thrust, of evidence and estimate. One function each, without a state
 * and without a decision of its own. */
#ifndef CONTROL_SIGNS_H
#define CONTROL_SIGNS_H

#include "control/facts.h"
#include "control/flight_io.h"
#include "control/guard.h"
#include "control/situation.h"

/* For sense_step(): what was commanded in the previous cycle. in: of this one. wanted_m: reference minus
 * height; NAN: no height is held. */
command_t signs_of_command(const situation_t *now, const flight_inputs_t *in, float wanted_m);

/* For est_law_predict(): the same for the estimate. */
est_before_t signs_of_before(const situation_t *now);

/* For supervisor_step(). hands_over: arming.h. */
vertical_estimate_t signs_of_vertical(const situation_t *now, bool hands_over);

contact_signs_t signs_of_contact(const situation_t *now);

landing_signs_t signs_of_landing(const situation_t *now);

pilot_signs_t signs_of_pilot(const situation_t *now, bool has_throttle);

/* For modes_select(). */
mode_choice_t signs_of_mode(const situation_t *now, bool has_throttle);

/* wanted_n: the bounded thrust. */
guard_case_t signs_of_guard(const situation_t *now, float wanted_n);

hover_lesson_t signs_of_hover(const situation_t *now);

#endif
