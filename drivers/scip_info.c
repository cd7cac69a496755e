#include "drivers/scip_info.h"

#include <stddef.h>

#define TURN_MDEG ((int32_t)360000L) /* 360 degrees */
#define STEP_MAX 4095U               /* a step times the turn stays within 31 bits */
#define DMIN_MOST_MM 1000U           /* chosen: no sensor has a larger blind zone */
#define DIGITS_MAX 9U                /* chosen: fits 32 bits */
#define TIME_DIGITS_MAX 6U           /* 24 bits in hexadecimal */

typedef struct {
    const octet_t *text;
    uint16_t length;
} slice_t;

const scip_limits_t scip_limits_urg04lx = {20U, 5600U, 1024U, 44U, 725U, 384U, 600U};
const scip_limits_t scip_limits_utm30lx = {23U, 60000U, 1440U, 0U, 1080U, 540U, 2400U};

static slice_t without_first(slice_t slice, uint16_t count)
{
    return (slice_t){&slice.text[count], (uint16_t)(slice.length - count)};
}

/* Without blanks at both ends, in one pass. */
static slice_t trimmed(slice_t slice)
{
    uint16_t begin = 0U;
    uint16_t end = 0U;
    for (uint16_t i = 0U; i < slice.length; ++i) {
        if (slice.text[i] != (octet_t)' ') {
            begin = end == 0U ? i : begin;
            end = (uint16_t)(i + 1U);
        }
    }
    return (slice_t){&slice.text[begin], (uint16_t)(end - begin)};
}

static octet_t lower(octet_t character)
{
    const bool capital = character >= (octet_t)'A' && character <= (octet_t)'Z';
    return capital ? octet_of((uint16_t)(character + 32U)) : character;
}

static bool begins_with(slice_t slice, const char *words)
{
    uint16_t i = 0U;
    while (words[i] != '\0' && i < slice.length && lower(slice.text[i]) == lower((octet_t)words[i])) {
        ++i;
    }
    return words[i] == '\0';
}

/* Texts are short and come once: the plain search is enough. */
static bool contains(slice_t slice, const char *words)
{
    while (!begins_with(slice, words)) {
        if (slice.length == 0U) {
            return false;
        }
        slice = without_first(slice, 1U);
    }
    return true;
}

/* Value of a digit of either base; 16 and more for anything else. */
static uint16_t digit_of(octet_t character)
{
    const octet_t letter = lower(character);
    if (letter >= (octet_t)'a' && letter <= (octet_t)'f') {
        return (uint16_t)((uint16_t)(letter - (octet_t)'a') + 10U);
    }
    return letter >= (octet_t)'0' && letter <= (octet_t)'9' ? (uint16_t)(letter - (octet_t)'0') : 16U;
}

/* Reads the digits a slice begins with. Returns how many; 0 when there are none or more than most. */
static uint16_t read_digits(slice_t slice, uint16_t base, uint16_t most, uint32_t *number)
{
    uint16_t i = 0U;
    *number = 0U;
    while (i < slice.length && digit_of(slice.text[i]) < base) {
        if (i == most) {
            return 0U;
        }
        *number = *number * base + digit_of(slice.text[i]);
        ++i;
    }
    return i;
}

/* "19200[bps]<-Default setting by user". Sensors on USB or Ethernet tell other things: "100 [Mbps]". */
static bool read_bit_rate(slice_t slice, uint32_t *number)
{
    const uint16_t digits = read_digits(slice, 10U, DIGITS_MAX, number);
    return digits > 0U && begins_with(trimmed(without_first(slice, digits)), "[bps]");
}

/* The first decimal number in the slice: "20", "Initial(600[rpm])". */
static bool read_number(slice_t slice, uint32_t *number)
{
    while (slice.length > 0U && digit_of(slice.text[0]) >= 10U) {
        slice = without_first(slice, 1U);
    }
    return read_digits(slice, 10U, DIGITS_MAX, number) > 0U;
}

static void read_small(slice_t slice, uint16_t *number)
{
    uint32_t wide;
    if (read_number(slice, &wide) && wide <= UINT16_MAX) {
        *number = (uint16_t)wide;
    }
}

/* What is too long is cut; the last cell keeps its zero. */
static void copy(char *text, slice_t value)
{
    uint16_t i = 0U;
    while (i < value.length && i < SCIP_INFO_TEXT - 1U) {
        text[i] = (char)value.text[i];
        ++i;
    }
    text[i] = '\0';
}

static scip_health_t health_of(slice_t state)
{
    static const struct {
        const char *words;
        scip_health_t health;
    } rows[] = {
        {"abnormal", SCIP_HEALTH_TROUBLE}, {"unstable", SCIP_HEALTH_TROUBLE},
        {"works well", SCIP_HEALTH_GOOD},  {"normal", SCIP_HEALTH_GOOD},
        {"stable", SCIP_HEALTH_GOOD},      {"no error", SCIP_HEALTH_GOOD},
        {"error", SCIP_HEALTH_TROUBLE},    {"trouble", SCIP_HEALTH_TROUBLE},
        {"fault", SCIP_HEALTH_TROUBLE},    {"malfunction", SCIP_HEALTH_TROUBLE},
        {"fail", SCIP_HEALTH_TROUBLE},
    };
    for (size_t i = 0U; i < sizeof rows / sizeof rows[0]; ++i) {
        if (contains(state, rows[i].words)) {
            return rows[i].health;
        }
    }
    return SCIP_HEALTH_UNKNOWN;
}

/* Texts are taken as told, also with a wrong sum: a person reads them. */
static bool take_text(scip_info_t *info, slice_t key, slice_t value)
{
    const struct {
        const char *key;
        char *text;
    } rows[] = {
        {"VEND", info->vendor}, {"PROD", info->product}, {"FIRM", info->firmware}, {"PROT", info->protocol},
        {"SERI", info->serial}, {"MODL", info->model},   {"MESM", info->mode},     {"STAT", info->state},
    };
    for (size_t i = 0U; i < sizeof rows / sizeof rows[0]; ++i) {
        if (begins_with(key, rows[i].key)) {
            copy(rows[i].text, value);
            return true;
        }
    }
    return false;
}

/* Numbers decide what is asked of the sensor, so one that damage may have changed is left as it was. The key
 * is known all the same. */
static bool take_small(scip_info_t *info, slice_t key, slice_t value, bool believed)
{
    scip_limits_t *told = &info->told;
    const struct {
        const char *key;
        uint16_t *number;
    } rows[] = {
        {"DMIN", &told->dmin_mm},  {"DMAX", &told->dmax_mm},   {"ARES", &told->ares},
        {"AMIN", &told->amin},     {"AMAX", &told->amax},      {"AFRT", &told->afrt},
        {"SCAN", &told->scan_rpm}, {"SCSP", &info->speed_rpm},
    };
    for (size_t i = 0U; i < sizeof rows / sizeof rows[0]; ++i) {
        if (begins_with(key, rows[i].key)) {
            if (believed) {
                read_small(value, rows[i].number);
            }
            return true;
        }
    }
    return false;
}

static bool take_other(scip_info_t *info, slice_t key, slice_t value, bool believed)
{
    uint32_t number;
    if (begins_with(key, "LASR")) {
        info->laser_on = believed ? begins_with(value, "ON") : info->laser_on;
    } else if (begins_with(key, "SBPS")) {
        info->bit_rate = believed && read_bit_rate(value, &number) ? number : info->bit_rate;
    } else if (begins_with(key, "TIME")) {
        info->time_ms = believed && read_digits(value, 16U, TIME_DIGITS_MAX, &number) > 0U ? number
                                                                                           : info->time_ms;
    } else {
        return false;
    }
    return true;
}

void scip_info_init(scip_info_t *info)
{
    *info = (scip_info_t){.health = SCIP_HEALTH_UNKNOWN};
}

/* "KEY:value". False without a colon. */
static bool divide(slice_t line, slice_t *key, slice_t *value)
{
    uint16_t colon = 0U;
    while (colon < line.length && line.text[colon] != (octet_t)':') {
        ++colon;
    }
    if (colon == line.length) {
        return false;
    }
    *key = trimmed((slice_t){line.text, colon});
    *value = trimmed(without_first(line, (uint16_t)(colon + 1U)));
    return true;
}

void scip_info_take(scip_info_t *info, const scip_parser_t *parser)
{
    const slice_t line = {parser->line, parser->text_length};
    /* A line without a sum at all is of a sensor that sends none. */
    const bool believed = parser->text_proved || parser->text_length == parser->line_length;
    slice_t key;
    slice_t value;
    if (!divide(line, &key, &value) || key.length != 4U ||
        !(take_text(info, key, value) || take_small(info, key, value, believed) ||
          take_other(info, key, value, believed))) {
        ++info->unknown;
        return;
    }
    if (begins_with(key, "STAT")) {
        info->health = health_of(value);
    }
    ++info->known;
    info->unproved = (uint16_t)(info->unproved + (believed ? 0U : 1U));
}

/* Limits are believed all or none: a mix of two sensors would give wrong directions. */
static bool fit_together(const scip_limits_t *limits)
{
    const bool distances = limits->dmin_mm > 0U && limits->dmin_mm <= DMIN_MOST_MM &&
                           limits->dmin_mm < limits->dmax_mm;
    const bool steps = limits->amin <= limits->afrt && limits->afrt <= limits->amax &&
                       limits->amax <= limits->ares;
    return distances && steps && limits->ares > 0U && limits->ares <= STEP_MAX && limits->scan_rpm > 0U;
}

scip_limits_t scip_info_limits(const scip_info_t *info)
{
    return fit_together(&info->told) ? info->told : scip_limits_urg04lx;
}

/* Nearest quotient, halves away from zero. divisor > 0. */
static int32_t divided_by(int32_t number, int32_t divisor)
{
    const int32_t half = divisor / 2;
    return (number < 0 ? number - half : number + half) / divisor;
}

int32_t scip_limits_mdeg(const scip_limits_t *limits, uint16_t step)
{
    return divided_by(((int32_t)step - (int32_t)limits->afrt) * TURN_MDEG, (int32_t)limits->ares);
}

uint16_t scip_limits_step(const scip_limits_t *limits, int32_t mdeg)
{
    const int32_t within = mdeg > TURN_MDEG ? TURN_MDEG : (mdeg < -TURN_MDEG ? -TURN_MDEG : mdeg);
    const int32_t step = (int32_t)limits->afrt + divided_by(within * (int32_t)limits->ares, TURN_MDEG);
    const int32_t least = (int32_t)limits->amin;
    const int32_t most = (int32_t)limits->amax;
    const int32_t from_least = (step > least) ? step : least;
    return (uint16_t)((from_least < most) ? from_least : most);
}
