/* An answer of many lines, one at a time as the radio has room, and a line at its end that says how many they were: `OK
 * NAME END lines:21`. One at a time: commands are not taken meanwhile, but for urgent ones. TaskReceiveComm only. */
#ifndef FIRMWARE_LISTING_H
#define FIRMWARE_LISTING_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/answer.h"

/* Writes that line of the answer, from 0 on, between its begin and its end; false: there are no more. */
typedef bool (*listing_line_t)(answer_t *answer, uint16_t number);

/* Begins the answer to a command. Returns true, so that a verb can return it. */
bool listing_start(const answer_t *answer, listing_line_t line);

/* Sends what fits. True: there is more to come. */
bool listing_more(void);

#endif
