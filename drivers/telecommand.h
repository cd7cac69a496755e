/* Operator's lines: `#NAME value` LF (CR LF, blanks and lower case accepted). A '#' restarts the line, backspace and delete
 * take back a character, Ctrl-C the line. A line may end with the sum of all characters before it, `#SETR 0.6*9383`
 * (drivers/line_sum.h; upper or lower case). Pure.
 *
 * The collector runs in the receive interrupt; parsing is the task's. */
#ifndef DRIVERS_TELECOMMAND_H
#define DRIVERS_TELECOMMAND_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "drivers/octet.h"

#define TELECOMMAND_LINE_MAX 32U    /* characters from '#' to before the line end */
#define TELECOMMAND_NAME_MAX 12U

/* A letter in upper case; any other character as it is. */
char telecommand_upper(char character);

typedef struct {
    char text[TELECOMMAND_LINE_MAX];    /* from '#', without the line end */
    uint16_t length;
    bool overlong;                      /* more came than fit; the text is the beginning */
    bool damaged;                       /* the UART lost or mangled some of it */
    bool bare;                          /* without a '#', perhaps empty: there is no text */
} telecommand_line_t;

typedef struct {
    telecommand_line_t line;
    bool started;           /* a '#' has come */
    char previous;          /* character, NUL not counted */
    uint32_t strays;        /* octets outside a line, except blank, tab, line ends and NUL */
} telecommand_collector_t;

void telecommand_collector_init(telecommand_collector_t *collector);
/* True at a LF, CR or Ctrl-C: collector->line is complete and valid until the next call. CR LF and LF CR end one line. NUL
 * is ignored. */
bool telecommand_collect(telecommand_collector_t *collector, octet_t octet);

/* The UART lost or mangled octets: the line in reception is not to be believed. */
void telecommand_collector_broken(telecommand_collector_t *collector);

typedef enum {
    TELECOMMAND_OK,
    TELECOMMAND_DAMAGED,
    TELECOMMAND_BARE,
    TELECOMMAND_EMPTY,      /* '#' alone, or blanks behind it */
    TELECOMMAND_OVERLONG,
    TELECOMMAND_SUM_WRONG,  /* `*` and four hexadecimal digits at the end, which are not the sum */
    TELECOMMAND_SUM_MISSING,
    TELECOMMAND_CHARACTER   /* a control character (other than a tab) or one above 7EH, or a name with other than A-Z 0-9 _ */
} telecommand_status_t;

typedef struct {
    char name[TELECOMMAND_NAME_MAX];    /* upper case, no terminator; longer names are cut (and match nothing) */
    uint16_t name_length;
    char argument[TELECOMMAND_LINE_MAX];/* rest without outer blanks and tabs, as typed */
    uint16_t argument_length;           /* 0 = none */
} telecommand_t;

/* A line as collected. Always writes *command; name and argument are empty unless the result is OK. A sum that is there
 * must be right. sum_required: and it must be there, but for what telecommand_is_urgent() names. */
telecommand_status_t telecommand_parse(const telecommand_line_t *line, bool sum_required, telecommand_t *command);

/* An undamaged `#STOP`, `#LAND` or `#SETR 0` (however the zero is written), which nothing may hold up: neither does its
 * sum, be it wrong or missing. Any context. */
bool telecommand_is_urgent(const telecommand_line_t *line);

#endif
