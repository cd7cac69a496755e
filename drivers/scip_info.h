/* What the sensor tells of itself: the text lines of VV, PP and II gathered into one structure, and the
 * geometry that follows from PP. Pure.
 *
 * Tolerant, because firmware differs: unknown keys are counted and left alone, keys may come in any order and
 * under any of the three commands, blanks around key and value do not matter, a line may have no sum. A text
 * is taken even when its sum is wrong (known of SERI); a number is not, because a wrong limit does harm and a
 * missing one does not. */
#ifndef DRIVERS_SCIP_INFO_H
#define DRIVERS_SCIP_INFO_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/octet.h"
#include "drivers/scip_parser.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SCIP_INFO_TEXT 40U /* characters of a text, its final 0 included; the rest is cut */

/* PP. Steps are numbered from 0, `ares` of them to the turn; the front is `afrt`. */
typedef struct {
    uint16_t dmin_mm, dmax_mm;
    uint16_t ares;             /* steps to the turn */
    uint16_t amin, amax, afrt; /* first and last step that is measured, and the front */
    uint16_t scan_rpm;
} scip_limits_t;

/* 20..5600 mm, 1024 steps, 44..725, front 384, 600 a minute. */
extern const scip_limits_t scip_limits_urg04lx;

typedef enum {
    SCIP_HEALTH_UNKNOWN, /* no STAT yet, or none that is understood */
    SCIP_HEALTH_GOOD,    /* "Sensor works well." "FW Normal" "Stable 000 no error." */
    SCIP_HEALTH_TROUBLE
} scip_health_t;

typedef struct {
    /* VV */
    char vendor[SCIP_INFO_TEXT], product[SCIP_INFO_TEXT], firmware[SCIP_INFO_TEXT];
    char protocol[SCIP_INFO_TEXT], serial[SCIP_INFO_TEXT];
    /* PP, PP and II */
    char model[SCIP_INFO_TEXT];
    scip_limits_t told; /* PP as sent; 0 where nothing was. Use scip_info_limits() */
    /* II */
    bool laser_on;
    uint16_t speed_rpm;         /* SCSP; 0: not told */
    char mode[SCIP_INFO_TEXT];  /* MESM */
    char state[SCIP_INFO_TEXT]; /* STAT */
    scip_health_t health;
    uint32_t bit_rate; /* 0: not told */
    uint32_t time_ms;  /* sensor clock, 24 bits; 0: not told */
    /* lines seen */
    uint16_t known, unknown;
    uint16_t unproved; /* of the known ones: with a wrong sum */
} scip_info_t;

/* Nothing is known. */
void scip_info_init(scip_info_t *info);

/* The parser's line; call on SCIP_TEXT. */
void scip_info_take(scip_info_t *info, const scip_parser_t *parser);

/* PP's limits when all of them came and fit together (dmin < dmax, amin <= afrt <= amax <= ares <= 4095),
 * else the URG-04LX's. */
scip_limits_t scip_info_limits(const scip_info_t *info);

/* Direction of a step in thousandths of a degree, positive to the left of the front, nearest; step: 0..4095.
 */
int32_t scip_limits_mdeg(const scip_limits_t *limits, uint16_t step);

/* The step nearest to a direction, kept within amin..amax. */
uint16_t scip_limits_step(const scip_limits_t *limits, int32_t mdeg);

#ifdef __cplusplus
}
#endif

#endif
