#include "terminal.h"

#include <stdio.h>
#include <string.h>

#include "world.h"

#define TRIES 3
#define PATIENCE (1500 * SIM_MS)
#define LOOK (10 * SIM_MS)

static struct {
    char telemetry[160];
    sim_time_t telemetry_at;
    char reset[16];
    sim_time_t reset_at;
    char name[32]; /* of the command that waits for its answer */
    char answer[160];
    char rest[8192];
} terminal;

void terminal_begin(void)
{
    memset(&terminal, 0, sizeof terminal);
}

static bool answers(const char *text, const char *verdict)
{
    const size_t length = strlen(verdict);

    return strncmp(text, verdict, length) == 0 &&
           strncmp(text + length, terminal.name, strlen(terminal.name)) == 0 &&
           (text[length + strlen(terminal.name)] == ' ' || text[length + strlen(terminal.name)] == '\0');
}

void terminal_line(const char *text)
{
    if (strncmp(text, "alt:", 4) == 0) {
        snprintf(terminal.telemetry, sizeof terminal.telemetry, "%s", text);
        terminal.telemetry_at = timeline_now();
        if (strstr(text, "reset:") != NULL) {
            terminal_field("reset:", terminal.reset, sizeof terminal.reset);
            terminal.reset_at = timeline_now();
        }
        return;
    }
    if (strlen(terminal.rest) + strlen(text) + 2 < sizeof terminal.rest) {
        strcat(strcat(terminal.rest, text), "\n");
    }
    if (terminal.answer[0] == '\0' && terminal.name[0] != '\0' &&
        (answers(text, "OK ") || answers(text, "ERR "))) {
        snprintf(terminal.answer, sizeof terminal.answer, "%s", text);
    }
}

static bool wait_for_answer(void)
{
    const sim_time_t end = timeline_now() + PATIENCE;

    while (terminal.answer[0] == '\0' && timeline_now() < end) {
        if (!world_run_until(timeline_now() + LOOK)) {
            return false;
        }
    }
    return terminal.answer[0] != '\0';
}

bool terminal_ask(const char *command, char *answer, size_t size)
{
    char line[80];

    snprintf(line, sizeof line, "#%s", command);
    if (strncmp(command, "GET ", 4) == 0) {
        command += 4; /* answered by the parameter's name */
    }
    snprintf(terminal.name, sizeof terminal.name, "%.*s", (int)strcspn(command, " "), command);
    terminal.answer[0] = terminal.rest[0] = '\0';
    for (int try = 0; try < TRIES; try++) {
        world_type(line);
        if (wait_for_answer()) {
            break;
        }
    }
    terminal.name[0] = '\0';
    snprintf(answer, size, "%s", terminal.answer);
    return strncmp(terminal.answer, "OK ", 3) == 0;
}

const char *terminal_rest(sim_time_t patience)
{
    (void)world_run_until(timeline_now() + patience);
    return terminal.rest;
}

const char *terminal_telemetry(sim_time_t *when)
{
    *when = terminal.telemetry_at;
    return terminal.telemetry;
}

const char *terminal_reset(sim_time_t since)
{
    return terminal.reset_at > since ? terminal.reset : "";
}

void terminal_field(const char *name, char *value, size_t size)
{
    const char *at = strstr(terminal.telemetry, name);

    at = at != NULL ? at + strlen(name) : "";
    snprintf(value, size, "%.*s", (int)strcspn(at, " "), at);
}
