/* What the pilot orders by his throttle stick while the firmware has the throttle, as PX4's altitude mode has
 * it: the middle holds the height, up and down move the reference by a rate. On the ground an armed vehicle
 * takes off by stick up; the stick held down at the lowest reference lands it. A stick that the pilot opens
 * before he hands over arms (arming.h), as #ARM does. Commands by radio go on to count: the latest order
 * wins.
 *
 * A stick may lie, so four things limit what it can do. It counts only after it was in the middle for a
 * second: not when it hangs at an end at power-on or at a hand-over. One push up raises the reference by a
 * metre at most. The reference stays within 0.3 m of the height. And it counts only where a pin tells who has
 * the throttle, because else it is the pilot's thrust.
 *
 * Pure; the caller owns the state, all zero at first. */
#ifndef CONTROL_STICK_ORDERS_H
#define CONTROL_STICK_ORDERS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/credible.h"
#include "control/flight_io.h"
#include "control/parameters.h"
#include "control/stick.h"

/* Lowest reference: what a hover is off by keeps above the heights that may be the ground's. */
#define STICK_LEAST_M (LOW_M + CONTENT_M)

/* Requests of one kind. Their sum is the sequence that the flight sees. */
typedef struct {
    uint32_t by_radio; /* sequence of the latest */
    uint32_t by_stick;
} stick_requests_t;

typedef struct {
    stick_requests_t references, arms;
    float reference_m;
    bool arm;
    bool counts;     /* it was in the middle, and sets the height since then */
    bool pushed;     /* an order that one push gives once was given, or refused */
    bool opened;     /* the pilot had it open when he last had the throttle on the ground */
    bool landing;    /* LANDING was ordered by the stick */
    float middle_s;  /* how long it has been in the middle */
    float held_s;    /* how long it has been held for such an order */
    float open_s;    /* how long it has been otherwise than `opened` says */
    float raised_m;  /* by this push */
    uint32_t now_us; /* of the cycle before */
} stick_orders_t;

/* One cycle, before flight_step(): puts what the stick orders into the references and arms of *in, whose
 * requests by radio it reads there. before: outputs of the cycle before. */
void stick_orders_step(stick_orders_t *orders, const parameters_t *parameters, const stick_t *stick,
                       const flight_outputs_t *before, flight_inputs_t *in);

/* FLIGHT_FLAG_STICK while the stick should set the height and does not, or is not to be believed. */
uint16_t stick_orders_flag(const stick_orders_t *orders, const parameters_t *parameters, const stick_t *stick,
                           bool has_throttle);

#endif
