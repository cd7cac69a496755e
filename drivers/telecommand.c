#include "drivers/telecommand.h"

#include <string.h>

#include "drivers/line_sum.h"

#define CTRL_C '\x03'
#define BACKSPACE '\x08'
#define DELETE '\x7F'
#define SUM_MARK '*'

static void restart(telecommand_collector_t *collector)
{
    collector->line.length = 0U;
    collector->line.overlong = false;
    collector->line.damaged = false;
    collector->line.bare = false;
}

void telecommand_collector_init(telecommand_collector_t *collector)
{
    restart(collector);
    collector->started = false;
    collector->previous = '\0';
    collector->strays = 0U;
}

static bool is_blank(char character)
{
    return character == ' ' || character == '\t';
}

static bool is_end(char character)
{
    return character == '\r' || character == '\n' || character == CTRL_C;
}

/* False for the second character of a line end of two. */
static bool end_line(telecommand_collector_t *collector, char character, char previous)
{
    /* Not LF CR: behind a line of a packet list, which ends with LF, Enter sends CR, and must be a line. */
    if (character == '\n' && previous == '\r') {
        return false;
    }
    if (!collector->started || character == CTRL_C) {
        restart(collector);
        collector->line.bare = true;
    }
    collector->started = false;
    return true;
}

/* One that did not fit cannot be taken back. */
static void take_back(telecommand_collector_t *collector)
{
    if (collector->started && !collector->line.overlong) {
        collector->line.length--;
        collector->started = collector->line.length > 0U;
    }
}

static void gather(telecommand_collector_t *collector, char character)
{
    telecommand_line_t *line = &collector->line;

    if (!collector->started) {
        collector->strays += is_blank(character) ? 0U : 1U;
    } else if (line->length == TELECOMMAND_LINE_MAX) {
        line->overlong = true;
    } else {
        line->text[line->length++] = character;
    }
}

bool telecommand_collect(telecommand_collector_t *collector, octet_t octet)
{
    const char character = (char)octet;
    const char previous = collector->previous;

    if (character == '\0') {
        return false;
    }
    collector->previous = character;
    if (is_end(character)) {
        return end_line(collector, character, previous);
    }
    if (character == BACKSPACE || character == DELETE) {
        take_back(collector);
        return false;
    }
    if (character == '#') {
        restart(collector);
        collector->started = true;
    }
    gather(collector, character);
    return false;
}

void telecommand_collector_broken(telecommand_collector_t *collector)
{
    collector->line.damaged = collector->started;
}

static bool is_name(char character)
{
    return (character >= 'A' && character <= 'Z') || (character >= '0' && character <= '9') ||
           character == '_';
}

char telecommand_upper(char character)
{
    return character >= 'a' && character <= 'z' ? (char)(character - 'a' + 'A') : character;
}

static bool is_legible(const telecommand_line_t *line)
{
    for (uint16_t i = 0U; i < line->length; i++) {
        char character = line->text[i];

        if ((character < ' ' || character > '~') && character != '\t') {
            return false;
        }
    }
    return true;
}

static uint16_t skip_blanks(const telecommand_line_t *line, uint16_t at, uint16_t end)
{
    while (at < end && is_blank(line->text[at])) {
        at++;
    }
    return at;
}

static telecommand_status_t take_name(const telecommand_line_t *line, uint16_t *at, uint16_t end,
                                      telecommand_t *command)
{
    uint16_t length = 0U;

    for (; *at < end && !is_blank(line->text[*at]); (*at)++) {
        char character = telecommand_upper(line->text[*at]);

        if (!is_name(character)) {
            return TELECOMMAND_CHARACTER;
        }
        if (length < TELECOMMAND_NAME_MAX) {
            command->name[length++] = character;
        }
    }
    command->name_length = length;
    return length > 0U ? TELECOMMAND_OK : TELECOMMAND_EMPTY;
}

static bool is_named(const telecommand_t *command, const char *name)
{
    return strlen(name) == command->name_length && strncmp(name, command->name, command->name_length) == 0;
}

/* Zeros, at most one point among them, a sign before them. */
static bool is_zero(const char *text, uint16_t length)
{
    uint16_t at = (length > 0U && (text[0] == '-' || text[0] == '+')) ? 1U : 0U;
    uint16_t zeros = 0U;
    uint16_t points = 0U;

    for (; at < length && (text[at] == '0' || text[at] == '.'); at++) {
        if (text[at] == '0') {
            zeros++;
        } else {
            points++;
        }
    }
    return at == length && zeros > 0U && points <= 1U;
}

/* Which nothing may hold up. */
static bool stops(const telecommand_t *command)
{
    return is_named(command, "STOP") || is_named(command, "LAND") ||
           (is_named(command, "SETR") && is_zero(command->argument, command->argument_length));
}

/* Where `*` and the sum begin; end when the line carries none. */
static uint16_t find_sum(const telecommand_line_t *line, uint16_t end)
{
    const uint16_t length = LINE_SUM_DIGITS + 1U;
    uint16_t at = (end > length) ? (uint16_t)(end - length) : end;

    if (at == end || line->text[at] != SUM_MARK) {
        return end;
    }
    for (uint16_t i = (uint16_t)(at + 1U); i < end; i++) {
        const char digit = telecommand_upper(line->text[i]);

        if (!((digit >= '0' && digit <= '9') || (digit >= 'A' && digit <= 'F'))) {
            return end;
        }
    }
    return at;
}

static bool sum_is_right(const telecommand_line_t *line, uint16_t sum_at)
{
    char digits[LINE_SUM_DIGITS];

    line_sum_write(digits, line_sum(line->text, sum_at));
    for (uint16_t i = 0U; i < LINE_SUM_DIGITS; i++) {
        if (telecommand_upper(line->text[sum_at + 1U + i]) != digits[i]) {
            return false;
        }
    }
    return true;
}

/* Name and argument out of the first `end` characters. */
static telecommand_status_t split(const telecommand_line_t *line, uint16_t end, telecommand_t *command)
{
    telecommand_status_t status;
    uint16_t at;

    while (end > 1U && is_blank(line->text[end - 1U])) {
        end--;
    }
    at = skip_blanks(line, 1U, end);
    status = take_name(line, &at, end, command);
    if (status == TELECOMMAND_OK) {
        for (at = skip_blanks(line, at, end); at < end; at++) {
            command->argument[command->argument_length++] = line->text[at];
        }
    }
    return status;
}

static telecommand_status_t reject(telecommand_t *command, telecommand_status_t status)
{
    command->name_length = 0U;
    command->argument_length = 0U;
    return status;
}

telecommand_status_t telecommand_parse(const telecommand_line_t *line, bool sum_required,
                                       telecommand_t *command)
{
    uint16_t end = line->length;
    telecommand_status_t status;

    (void)reject(command, TELECOMMAND_OK);
    if (line->damaged) {
        return TELECOMMAND_DAMAGED;
    }
    if (line->bare) {
        return TELECOMMAND_BARE;
    }
    if (line->overlong) {
        return TELECOMMAND_OVERLONG;
    }
    if (!is_legible(line)) {
        return TELECOMMAND_CHARACTER;
    }
    while (end > 1U && is_blank(line->text[end - 1U])) {
        end--;
    }
    const uint16_t sum_at = find_sum(line, end);

    status = split(line, sum_at, command);
    if (status != TELECOMMAND_OK || stops(command)) {
        return status;
    }
    if (sum_at == end) {
        return sum_required ? reject(command, TELECOMMAND_SUM_MISSING) : TELECOMMAND_OK;
    }
    return sum_is_right(line, sum_at) ? TELECOMMAND_OK : reject(command, TELECOMMAND_SUM_WRONG);
}

bool telecommand_is_urgent(const telecommand_line_t *line)
{
    telecommand_t command;

    return telecommand_parse(line, false, &command) == TELECOMMAND_OK && stops(&command);
}
