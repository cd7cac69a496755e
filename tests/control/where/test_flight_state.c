#include "control/where/flight_state.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "unity.h"

void setUp(void) {}

void tearDown(void) {}

static const char *const condition_names[] = {
    "REFERENCE", "READY",          "HEIGHT",       "LOST",        "OFF_GROUND",      "ALOFT",
    "AT_REST",   "TOO_HIGH",       "RECOVERED",    "LAND",        "DESCENT_TIMEOUT", "TILTED",
    "LEVEL",     "LOWERING_LIMIT", "HAS_THROTTLE", "HANDED_OVER",
};
#define CONDITION_COUNT (sizeof condition_names / sizeof condition_names[0])

/* Appends " CONDITION !CONDITION: STATE". */
static size_t add_transition(const flight_transition_t *row, char *text, size_t used, size_t size)
{
    for (unsigned i = 0; i < CONDITION_COUNT; i++) {
        const unsigned mask = 1U << i;
        if (((row->all_of | row->none_of) & mask) != 0U) {
            used += (size_t)snprintf(text + used, size - used, " %s%s",
                                     (row->none_of & mask) != 0U ? "!" : "", condition_names[i]);
        }
    }
    return used + (size_t)snprintf(text + used, size - used, ": %s", flight_state_name(row->to));
}

/* All transitions from the state of row *first, in a line; *first is then the next state's. */
static void state_text(unsigned *first, char *text, size_t size)
{
    const flight_state_t from = flight_transitions[*first].from;
    size_t used = (size_t)snprintf(text, size, "| %s |", flight_state_name(from));
    bool more = true;

    while (more) {
        used = add_transition(&flight_transitions[(*first)++], text, used, size);
        more = *first < FLIGHT_TRANSITION_COUNT && flight_transitions[*first].from == from;
        used += (size_t)snprintf(text + used, size - used, "%s", more ? ";" : " |\n");
    }
}

static FILE *open_document(void)
{
    return fopen(FIXTURES "/../../docs/flight_states.md", "r");
}

void test_the_document_shows_the_same_table(void)
{
    char expected[600], found[600] = "";
    FILE *document = open_document();
    TEST_ASSERT_NOT_NULL(document);
    while (strcmp(found, "| from | the first that holds, and where it leads |\n") != 0) {
        TEST_ASSERT_NOT_NULL(fgets(found, sizeof found, document));
    }
    TEST_ASSERT_EQUAL_STRING("|---|---|\n", fgets(found, sizeof found, document));
    for (unsigned i = 0; i < FLIGHT_TRANSITION_COUNT;) {
        state_text(&i, expected, sizeof expected);
        TEST_ASSERT_EQUAL_STRING(expected, fgets(found, sizeof found, document));
    }
    TEST_ASSERT_EQUAL_STRING("\n", fgets(found, sizeof found, document));
    fclose(document);
}

/* What the table must say, written as sentences of another kind. c has a bit per condition. */
static flight_state_t expected_next(flight_state_t from, unsigned c)
{
    const bool reference = c & FLIGHT_IF_REFERENCE, height = c & FLIGHT_IF_HEIGHT;
    const bool tilted = c & FLIGHT_IF_TILTED;
    const bool ours = c & FLIGHT_IF_HAS_THROTTLE;
    const bool go = reference && height && (c & FLIGHT_IF_READY);
    if (!ours && from != FLIGHT_GROUND && from != FLIGHT_FLOATING && from != FLIGHT_CUT) {
        return FLIGHT_FLOATING;
    }
    if (tilted && from != FLIGHT_GROUND && from != FLIGHT_FLOATING && from != FLIGHT_CUT) {
        return FLIGHT_CUT;
    }
    switch (from) {
    case FLIGHT_GROUND:
        if (!(c & FLIGHT_IF_ALOFT) && (c & FLIGHT_IF_HANDED_OVER)) {
            return FLIGHT_DESCENDING;
        }
        return (c & FLIGHT_IF_ALOFT) ? FLIGHT_FLOATING : (go && ours && !tilted) ? FLIGHT_TAKEOFF : from;
    case FLIGHT_TAKEOFF:
    case FLIGHT_FLYING:
        if (!height) {
            return FLIGHT_COASTING;
        }
        if (!reference) {
            return FLIGHT_LANDING;
        }
        if (c & FLIGHT_IF_TOO_HIGH) {
            return FLIGHT_LOWERING;
        }
        return (c & FLIGHT_IF_OFF_GROUND) ? FLIGHT_FLYING : from;
    case FLIGHT_FLOATING:
        if (go && ours && !tilted) {
            return FLIGHT_FLYING;
        }
        if (ours && (c & FLIGHT_IF_LAND)) {
            return height ? FLIGHT_LANDING : FLIGHT_DESCENDING;
        }
        if (ours && (c & FLIGHT_IF_LOST)) {
            return FLIGHT_DESCENDING;
        }
        return (c & FLIGHT_IF_AT_REST) ? FLIGHT_GROUND : from;
    case FLIGHT_COASTING:
        if (!reference) {
            return FLIGHT_DESCENDING;
        }
        return height ? FLIGHT_FLYING : (c & FLIGHT_IF_LOST) ? FLIGHT_DESCENDING : from;
    case FLIGHT_DESCENDING:
        return go                                                      ? FLIGHT_FLYING
               : height                                                ? FLIGHT_LANDING
               : (c & (FLIGHT_IF_DESCENT_TIMEOUT | FLIGHT_IF_AT_REST)) ? FLIGHT_GROUND
                                                                       : from;
    case FLIGHT_LANDING:
        return go                        ? FLIGHT_FLYING
               : !height                 ? FLIGHT_DESCENDING
               : (c & FLIGHT_IF_AT_REST) ? FLIGHT_GROUND
                                         : from;
    case FLIGHT_CUT:
        if ((c & FLIGHT_IF_ALOFT) && !ours && !tilted) {
            return FLIGHT_FLOATING;
        }
        return ((c & FLIGHT_IF_AT_REST) && (c & FLIGHT_IF_LEVEL)) ? FLIGHT_GROUND : from;
    default:
        if (!height) {
            return FLIGHT_COASTING;
        }
        return (!reference || (c & FLIGHT_IF_LOWERING_LIMIT)) ? FLIGHT_LANDING
               : (c & FLIGHT_IF_RECOVERED)                    ? FLIGHT_FLYING
                                                              : from;
    }
}

void test_every_state_under_every_set_of_conditions_goes_where_it_must(void)
{
    for (int from = 0; from < FLIGHT_STATE_COUNT; from++) {
        /* A bit more than the conditions: with all 16 used, an unsigned of 16 bits would never pass the last.
         */
        for (uint32_t c = 0; c <= FLIGHT_IF_ALL; c++) {
            if (flight_next_state((flight_state_t)from, (uint16_t)c) !=
                expected_next((flight_state_t)from, (unsigned)c)) {
                char where[64];
                snprintf(where, sizeof where, "%s under %u", flight_state_name((flight_state_t)from),
                         (unsigned)c);
                TEST_FAIL_MESSAGE(where);
            }
        }
    }
}

static unsigned first_row(flight_state_t from, unsigned c)
{
    unsigned i = 0;
    while (i < FLIGHT_TRANSITION_COUNT &&
           (flight_transitions[i].from != from ||
            (c & flight_transitions[i].all_of) != flight_transitions[i].all_of ||
            (c & flight_transitions[i].none_of) != 0U)) {
        i++;
    }
    return i;
}

static bool row_is_first_for_some_conditions(unsigned row)
{
    uint32_t c = 0;
    while (c <= FLIGHT_IF_ALL && first_row(flight_transitions[row].from, (unsigned)c) != row) {
        c++;
    }
    return c <= FLIGHT_IF_ALL;
}

void test_every_row_of_the_table_is_the_first_for_some_conditions(void)
{
    for (unsigned i = 0; i < FLIGHT_TRANSITION_COUNT; i++) {
        TEST_ASSERT_TRUE(row_is_first_for_some_conditions(i));
        TEST_ASSERT_TRUE(flight_transitions[i].to != flight_transitions[i].from);
    }
}

void test_the_rows_of_a_state_stand_together(void)
{
    unsigned seen = 0U;

    for (uint16_t i = 0; i < FLIGHT_TRANSITION_COUNT; i++) {
        const flight_state_t from = flight_transitions[i].from;

        if (i == 0 || flight_transitions[i - 1].from != from) {
            TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, seen >> from & 1U, flight_state_name(from));
            seen |= 1U << from;
        }
    }
}
