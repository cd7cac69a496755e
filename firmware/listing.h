/* Answer with many lines. The lines are sent one at a time, as the radio has room. The last line tells
 * their number: `OK NAME END lines:21`. Only one listing can run at a time. Until it ends, only urgent
 * commands are accepted. Context: Task, TaskReceiveComm only. */
#ifndef FIRMWARE_LISTING_H
#define FIRMWARE_LISTING_H

#include <stdbool.h>
#include <stdint.h>

#include "firmware/answer.h"

/* Writes line `number` of the answer, from 0 on, between its begin and its end. Returns false when there
 * are no more lines. */
typedef bool (*listing_line_t)(answer_t *answer, uint16_t number);

/* Begins the listing for a command. Returns true, so a verb can return this call. */
bool listing_start(const answer_t *answer, listing_line_t line);

/* Sends the lines that fit now. Returns true when there are more. */
bool listing_more(void);

#endif
