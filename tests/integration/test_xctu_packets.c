/* Every packet of docs/xctu_packets.xml, sent to the running firmware, is understood. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "child.h"
#include "unity.h"

void setUp(void) {}
void tearDown(void) {}

static char xml[100000];

static size_t unhex(const char *hex, char *octets, size_t capacity)
{
    size_t count = 0;
    unsigned value;

    while (count < capacity && sscanf(hex, "%2X", &value) == 1) {
        octets[count++] = (char)value;
        hex += 2;
    }
    return count;
}

static void send_all(void *argument, void *result)
{
    board_config_t config = board_config(1);
    const char *next = argument;
    char octets[64];

    board_power_on(&config, child_terminal_take, result);
    kernel_run_until(100 * SIM_MS);
    while ((next = strstr(next, "<payload>")) != NULL) {
        next += strlen("<payload>");
        board_type(octets, unhex(next, octets, sizeof octets));
        kernel_run_until(timeline_now() + 2 * SIM_S);
    }
}

void test_every_packet_is_answered_ok(void)
{
    static child_terminal_t terminal;
    FILE *file = fopen(XCTU_PACKETS, "r");
    int packets = 0, lines = 0;

    TEST_ASSERT_NOT_NULL(file);
    xml[fread(xml, 1, sizeof xml - 1, file)] = '\0';
    fclose(file);
    for (const char *p = xml; (p = strstr(p, "<packet ")) != NULL; p++) {
        packets++;
    }
    TEST_ASSERT_TRUE(packets >= 15);
    child_run(send_all, xml, &terminal, sizeof terminal);
    TEST_ASSERT_NULL(strstr(terminal.text, "ERR "));
    for (const char *p = terminal.text; (p = strstr(p, "\nOK ")) != NULL; p++) {
        lines++;
    }
    TEST_ASSERT_TRUE_MESSAGE(lines >= packets, "a packet went unanswered");
}
