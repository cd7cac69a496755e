/* Command lines of the operator: `#NAME value` LF. CR LF, blanks and lower case are accepted. A '#'
 * restarts the line. Backspace and delete remove the last character; Ctrl-C drops the line. A line may end
 * with the sum of all characters before it: `#SETR 0.6*9383` (drivers/line_sum.h; upper or lower case).
 *
 * Pure; the caller owns the state. Calling context in the firmware: the receive Hwi runs the collector, a
 * Task runs telecommand_parse(). */
#ifndef DRIVERS_TELECOMMAND_H
#define DRIVERS_TELECOMMAND_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drivers/octet.h"

#define TELECOMMAND_LINE_MAX \
    32U /* characters from '#' to before the line end; blanks behind them are dropped */
#define TELECOMMAND_NAME_MAX 12U

/* A letter in upper case; any other character as it is. */
char telecommand_upper(char character);

/* A blank or a tab. */
bool telecommand_is_blank(char character);

typedef struct {
    char text[TELECOMMAND_LINE_MAX]; /* from '#', without the line end */
    uint16_t length;
    bool overlong; /* the line was too long; the text is its beginning */
    bool damaged;  /* the UART lost or damaged some of its octets */
    bool bare;     /* no '#', perhaps an empty line: there is no text */
} telecommand_line_t;

typedef struct {
    telecommand_line_t line;
    bool started;    /* a '#' was received */
    char previous;   /* previous character, NUL not counted */
    uint32_t strays; /* octets outside a line, except blank, tab, line ends and NUL */
} telecommand_collector_t;

void telecommand_collector_init(telecommand_collector_t *collector);
/* Processes one octet. Returns true at a LF, CR or Ctrl-C: then collector->line is complete, and valid
 * until the next call. CR LF ends one line, LF CR two. NUL is ignored. */
bool telecommand_collect(telecommand_collector_t *collector, octet_t octet);

/* Call this when the UART lost or damaged octets. The present line is then marked as damaged. */
void telecommand_collector_broken(telecommand_collector_t *collector);

typedef enum {
    TELECOMMAND_OK,
    TELECOMMAND_DAMAGED,
    TELECOMMAND_BARE,
    TELECOMMAND_EMPTY, /* '#' alone, or with blanks only */
    TELECOMMAND_OVERLONG,
    TELECOMMAND_SUM_WRONG, /* the line ends with `*` and four hexadecimal digits, but they are not its sum */
    TELECOMMAND_SUM_MISSING,
    TELECOMMAND_CHARACTER /* a control character (except tab), a character above 7EH, or a name with
                           * others than A-Z 0-9 _ */
} telecommand_status_t;

typedef struct {
    char name[TELECOMMAND_NAME_MAX]; /* upper case, no terminator; a longer name is cut, and matches no
                                      * command */
    uint16_t name_length;
    char argument[TELECOMMAND_LINE_MAX]; /* the rest without outer blanks and tabs, as typed */
    uint16_t argument_length;            /* 0 = none */
} telecommand_t;

/* Parses one collected line. Always writes *command; name and argument are empty unless the result is
 * TELECOMMAND_OK. `STOP` and `LAND` have no argument: what stands behind them is not read. A sum that is
 * present must be right. sum_required: a sum must be present, except for urgent lines. */
telecommand_status_t telecommand_parse(const telecommand_line_t *line, bool sum_required,
                                       telecommand_t *command);

/* True for an undamaged `#STOP`, `#LAND` or `#SETR 0` (the zero may be written in any way). Nothing may
 * delay such a line, so a wrong or missing sum is accepted; and behind the first two names any text, of any
 * length. Any context. */
bool telecommand_is_urgent(const telecommand_line_t *line);

#endif
