/* Information about the sensor: collects the text lines of VV, PP and II in one structure, and computes
 * angles from the geometry in PP. Pure; the caller owns the structure. Context: one at a time per structure.
 *
 * The reader is tolerant, because the sensors' firmware differs. Unknown keys are counted and ignored. Keys
 * may come in any order and with any of the three commands. Blanks around key and value are ignored. A line
 * may have no sum. A text is stored even when its sum is wrong (real sensors send SERI so). A number with a
 * wrong sum is not stored: a wrong limit does harm, a missing one does not. */
#ifndef DRIVERS_SCIP_INFO_H
#define DRIVERS_SCIP_INFO_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/octet.h"
#include "drivers/scip_parser.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCIP_INFO_TEXT 40U /* characters of a text with its terminator; the rest is cut off */

/* Limits from PP. Steps are numbered from 0. */
typedef struct {
    uint16_t dmin_mm, dmax_mm;
    uint16_t ares;             /* steps per revolution */
    uint16_t amin, amax, afrt; /* first and last measured step, and the step to the front */
    uint16_t scan_rpm;
} scip_limits_t;

/* Data sheet of the URG-04LX: 20..5600 mm, 1024 steps, steps 44..725 measured, front 384, 600 rpm. */
extern const scip_limits_t scip_limits_urg04lx;

/* The UTM-30LX's own PP: 23..60000 mm, 1440 steps, steps 0..1080 measured, front 540, 2400 rpm. The UST-10LX
 * differs in its distances only: 20..30000 mm. */
extern const scip_limits_t scip_limits_utm30lx;

typedef enum {
    SCIP_HEALTH_UNKNOWN, /* no STAT was received, or an unknown one */
    SCIP_HEALTH_GOOD,    /* "Sensor works well." "FW Normal" "Stable 000 no error." */
    SCIP_HEALTH_TROUBLE
} scip_health_t;

typedef struct {
    /* VV */
    char vendor[SCIP_INFO_TEXT], product[SCIP_INFO_TEXT], firmware[SCIP_INFO_TEXT];
    char protocol[SCIP_INFO_TEXT], serial[SCIP_INFO_TEXT];
    /* PP, or PP and II */
    char model[SCIP_INFO_TEXT];
    scip_limits_t told; /* as received in PP, 0: not received. Use scip_info_limits() */
    /* II */
    bool laser_on;
    uint16_t speed_rpm;         /* SCSP; 0: not received */
    char mode[SCIP_INFO_TEXT];  /* MESM */
    char state[SCIP_INFO_TEXT]; /* STAT */
    scip_health_t health;
    uint32_t bit_rate; /* bits per second; 0: not received */
    uint32_t time_ms;  /* sensor clock, 24 bits; 0: not received */
    /* counters of lines, since scip_info_init() */
    uint16_t known, unknown;
    uint16_t unproved; /* known lines with a wrong sum */
} scip_info_t;

/* Clears the structure: nothing received. */
void scip_info_init(scip_info_t *info);

/* Processes the parser's line. Call on the event SCIP_TEXT. */
void scip_info_take(scip_info_t *info, const scip_parser_t *parser);

/* Limits from PP, when all were received and are consistent (dmin < dmax, amin <= afrt <= amax <= ares <=
 * 4095). Otherwise scip_limits_urg04lx. */
scip_limits_t scip_info_limits(const scip_info_t *info);

/* Direction of a step (0..4095) in thousandths of a degree, rounded to the nearest; > 0 is left of the front.
 */
int32_t scip_limits_mdeg(const scip_limits_t *limits, uint16_t step);

/* Step nearest to a direction in thousandths of a degree, limited to amin..amax. */
uint16_t scip_limits_step(const scip_limits_t *limits, int32_t mdeg);

#ifdef __cplusplus
}
#endif

#endif
