#include "drivers/telecommand.h"

#include <string.h>

#include "drivers/line_sum.h"

#define CTRL_C '\x03'
#define BACKSPACE '\x08'
#define DELETE '\x7F'
#define SUM_MARK '*'

/* Not the characters: length says how many count. */
static void restart(telecommand_collector_t *collector)
{
    collector->line.length = 0U;
    collector->line.overlong = false;
    collector->line.damaged = false;
    collector->line.bare = false;
}

void telecommand_collector_init(telecommand_collector_t *collector)
{
    *collector = (telecommand_collector_t){.previous = '\0'};
}

bool telecommand_is_blank(char character)
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
        --collector->line.length;
        collector->started = collector->line.length > 0U;
    }
}

static void gather(telecommand_collector_t *collector, char character)
{
    telecommand_line_t *line = &collector->line;

    if (!collector->started) {
        collector->strays += telecommand_is_blank(character) ? 0U : 1U;
    } else if (line->length == TELECOMMAND_LINE_MAX) {
        line->overlong = line->overlong || !telecommand_is_blank(character);
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

/* Octets were lost. Outside of a line nothing is harmed; within one nobody knows which. */
void telecommand_collector_broken(telecommand_collector_t *collector)
{
    collector->line.damaged = collector->started;
}

/* After telecommand_upper(). */
static bool is_name(char character)
{
    return (character >= 'A' && character <= 'Z') || (character >= '0' && character <= '9') ||
           character == '_';
}

char telecommand_upper(char character)
{
    return character >= 'a' && character <= 'z' ? (char)(character - 'a' + 'A') : character;
}

static bool is_legible(char character)
{
    return (character >= ' ' && character <= '~') || character == '\t';
}

/* Behind the last of so many characters of a line that is not blank; behind the `#` at the least. */
static uint16_t end_of(const telecommand_line_t *line, uint16_t length)
{
    uint16_t end = 1U;

    for (uint16_t i = 1U; i < length; ++i) {
        end = telecommand_is_blank(line->text[i]) ? end : (uint16_t)(i + 1U);
    }
    return end;
}

/* A name that is too long is cut: no command has such a name, and the answer quotes what was understood. */
static telecommand_status_t take_name(const telecommand_line_t *line, uint16_t *at, uint16_t end,
                                      telecommand_t *command)
{
    uint16_t length = 0U;

    for (; *at < end && !telecommand_is_blank(line->text[*at]); (*at)++) {
        char character = telecommand_upper(line->text[*at]);

        if (!is_name(character)) {
            return TELECOMMAND_CHARACTER;
        }
        if (length < TELECOMMAND_NAME_MAX) {
            command->name[length++] = character;
        }
    }
    command->name_length = length;
    return TELECOMMAND_OK;
}

static bool is_named(const telecommand_t *command, const char *name)
{
    return strlen(name) == command->name_length && strncmp(name, command->name, command->name_length) == 0;
}

/* Zeros, at most one point among them, a sign before them. */
static bool is_zero(const char *text, uint16_t length)
{
    bool any = false;
    uint16_t points = 0U;

    for (uint16_t i = 0U; i < length; ++i) {
        if (text[i] == '0') {
            any = true;
        } else if (text[i] == '.') {
            ++points;
        } else if (i > 0U || (text[i] != '-' && text[i] != '+')) {
            return false;
        }
    }
    return any && points <= 1U;
}

/* By the name alone, whatever stands behind it: in trouble people type anything. */
static bool stops_by_name(const telecommand_t *command)
{
    return is_named(command, "STOP") || is_named(command, "LAND");
}

/* Which nothing may hold up. */
static bool stops(const telecommand_t *command)
{
    return stops_by_name(command) ||
           (is_named(command, "SETR") && is_zero(command->argument, command->argument_length));
}

static bool is_hexadecimal(char character)
{
    const char digit = telecommand_upper(character);

    return (digit >= '0' && digit <= '9') || (digit >= 'A' && digit <= 'F');
}

/* Where `*` and the sum begin; end when the line has none. */
static uint16_t find_sum(const telecommand_line_t *line, uint16_t end)
{
    uint16_t digits = end;

    while (digits > 1U && is_hexadecimal(line->text[digits - 1U])) {
        --digits;
    }
    return end - digits == LINE_SUM_DIGITS && line->text[digits - 1U] == SUM_MARK ? (uint16_t)(digits - 1U)
                                                                                  : end;
}

static bool sum_is_right(const telecommand_line_t *line, uint16_t sum_at)
{
    char digits[LINE_SUM_DIGITS];

    line_sum_write(digits, line_sum(line->text, sum_at));
    for (uint16_t i = 0U; i < LINE_SUM_DIGITS; ++i) {
        if (telecommand_upper(line->text[sum_at + 1U + i]) != digits[i]) {
            return false;
        }
    }
    return true;
}

/* A refused line leaves no name behind that a careless reader might obey. */
static telecommand_status_t reject(telecommand_t *command, telecommand_status_t status)
{
    command->name_length = 0U;
    command->argument_length = 0U;
    return status;
}

/* What is left of the line, without blanks around it. */
static telecommand_status_t take_argument(const telecommand_line_t *line, uint16_t at, uint16_t end,
                                          telecommand_t *command)
{
    for (; at < end; ++at) {
        const char character = line->text[at];

        if (!is_legible(character)) {
            return reject(command, TELECOMMAND_CHARACTER);
        }
        if (command->argument_length > 0U || !telecommand_is_blank(character)) {
            command->argument[command->argument_length++] = character;
        }
    }
    return TELECOMMAND_OK;
}

/* Name and argument, which end where the sum begins. */
static telecommand_status_t split(const telecommand_line_t *line, uint16_t sum_at, telecommand_t *command)
{
    const uint16_t end = end_of(line, sum_at);
    uint16_t at = 1U;

    if (end == 1U) {
        return TELECOMMAND_EMPTY;
    }
    while (telecommand_is_blank(line->text[at])) {
        ++at;
    }
    const telecommand_status_t status = take_name(line, &at, end, command);

    if (status == TELECOMMAND_OK && stops_by_name(command)) {
        return TELECOMMAND_OK;
    }
    if (line->overlong) {
        return reject(command, TELECOMMAND_OVERLONG);
    }
    return status == TELECOMMAND_OK ? take_argument(line, at, end, command) : status;
}

/* Name and argument of a line that can be read, whatever its sum. */
static telecommand_status_t understand(const telecommand_line_t *line, uint16_t sum_at,
                                       telecommand_t *command)
{
    (void)reject(command, TELECOMMAND_OK);
    if (line->damaged) {
        return TELECOMMAND_DAMAGED;
    }
    if (line->bare) {
        return TELECOMMAND_BARE;
    }
    return split(line, sum_at, command);
}

telecommand_status_t telecommand_parse(const telecommand_line_t *line, bool sum_required,
                                       telecommand_t *command)
{
    const uint16_t end = end_of(line, line->length);
    const uint16_t sum_at = find_sum(line, end);
    const telecommand_status_t status = understand(line, sum_at, command);

    /* A stop is obeyed whatever its sum: a wrong one says that something is damaged, not that the motors may
     * go on. */
    if (status != TELECOMMAND_OK || stops(command)) {
        return status;
    }
    if (sum_at == end) {
        return sum_required ? reject(command, TELECOMMAND_SUM_MISSING) : TELECOMMAND_OK;
    }
    return sum_is_right(line, sum_at) ? TELECOMMAND_OK : reject(command, TELECOMMAND_SUM_WRONG);
}

/* By the same parser as the command itself, so that no line is urgent and then not a stop. */
bool telecommand_is_urgent(const telecommand_line_t *line)
{
    const uint16_t sum_at = find_sum(line, end_of(line, line->length));
    telecommand_t command;

    return understand(line, sum_at, &command) == TELECOMMAND_OK && stops(&command);
}
