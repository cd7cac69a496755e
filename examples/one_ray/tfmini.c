#include "tfmini.h"

#define READING 0x59U
#define REPLY 0x5AU
#define READING_OCTETS 9U
#define REPLY_OCTETS 5U
#define LEAST_MM 100U  /* below is the sensor's own blind zone, section 3 */
#define MOST_MM 12000U /* its range; FFFF and FFFE tell of a fault */
#define WEAK 100U      /* section 5.4 */
#define SATURATED 0xFFFFU

/* Standard frames in millimetres, which the sensor repeats; then: save. */
const char tfmini_order[TFMINI_ORDER] = {0x5A, 0x05, 0x05, 0x06, 0x6A, 0x5A, 0x04, 0x11, 0x6F};

static uint16_t pair(const octet_t *octets)
{
    return (uint16_t)(octets[0] | (uint16_t)octets[1] << 8);
}

static uint16_t frame_octets(const tfmini_t *sensor)
{
    return (sensor->octets[0] == REPLY) ? REPLY_OCTETS : READING_OCTETS;
}

/* Neither a reading begins like that, nor the only reply that is awaited. */
static bool is_nonsense(const tfmini_t *sensor)
{
    const octet_t first = sensor->octets[0];

    if (first != READING && first != REPLY) {
        return true;
    }
    return sensor->count > 1U && sensor->octets[1] != (first == READING ? READING : REPLY_OCTETS);
}

/* A frame may begin inside what was taken for one. */
static void drop_first(tfmini_t *sensor)
{
    do {

        --sensor->count;
        for (uint16_t i = 0U; i < sensor->count; ++i) {
            sensor->octets[i] = sensor->octets[i + 1U];
        }
    } while (sensor->count > 0U && is_nonsense(sensor));
}

static bool sum_is_right(const tfmini_t *sensor)
{
    uint16_t sum = 0U;
    for (uint16_t i = 0U; i + 1U < sensor->count; ++i) {
        sum = (uint16_t)(sum + sensor->octets[i]);
    }
    return octet_of(sum) == sensor->octets[sensor->count - 1U];
}

static bool take_reading(tfmini_t *sensor)
{
    const uint16_t strength = pair(&sensor->octets[4]);

    sensor->distance_mm = pair(&sensor->octets[2]);
    sensor->seen = strength >= WEAK && strength != SATURATED && sensor->distance_mm >= LEAST_MM &&
                   sensor->distance_mm <= MOST_MM;
    ++sensor->readings;
    return sensor->millimetres;
}

static void take_reply(tfmini_t *sensor)
{
    for (uint16_t i = 0U; i < REPLY_OCTETS; ++i) {
        if (sensor->octets[i] != octet_of((uint16_t)tfmini_order[i])) {
            return;
        }
    }
    sensor->millimetres = true;
}

static bool take_frame(tfmini_t *sensor, uint32_t now_us)
{
    bool complete = false;

    tfmini_watch(sensor, now_us);
    sensor->latest_us = now_us;
    if (sensor->octets[0] == REPLY) {
        take_reply(sensor);
    } else {
        complete = take_reading(sensor);
    }
    sensor->count = 0U;
    return complete;
}

bool tfmini_feed(tfmini_t *sensor, octet_t octet, uint32_t now_us)
{
    sensor->octets[sensor->count++] = octet;
    if (is_nonsense(sensor)) {
        drop_first(sensor);
    }
    if (sensor->count == 0U || sensor->count < frame_octets(sensor)) {
        return false;
    }
    if (sum_is_right(sensor)) {
        return take_frame(sensor, now_us);
    }
    ++sensor->damaged;
    drop_first(sensor);
    return false;
}

void tfmini_line_broken(tfmini_t *sensor)
{
    sensor->count = 0U;
}

void tfmini_watch(tfmini_t *sensor, uint32_t now_us)
{
    if (now_us - sensor->latest_us > TFMINI_SILENT_US) {
        sensor->millimetres = false;
    }
}

uint16_t tfmini_expected(const tfmini_t *sensor)
{
    return (sensor->count == 0U) ? READING_OCTETS : (uint16_t)(frame_octets(sensor) - sensor->count);
}
