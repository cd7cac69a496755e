#include "sensor.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LINE 80
#define QUEUE 6
#define BLOCK 64
#define RATE_NONE 0U
#define OTHER_LAST 500
#define OTHER_ECHO "0500"

typedef struct {
    char text[LINE + 1];
    bool again; /* the same symbol as the one before, which has no answer yet */
} order_t;

struct sensor {
    sensor_config_t config;
    uart_t *from_host, *to_host;
    bool on, ready, scip2, laser, streaming, timing;
    bool counted; /* a run that ends */
    int left, first, last, group, width, skip;
    ns_t on_at, zero, measured_at, answer_at, rate_at;
    uint32_t rate, next_rate;
    char echo[16];
    char line[LINE + 1];
    size_t length;
    order_t queue[QUEUE];
    size_t head, queued;
    bool answered; /* since power-up */
    uint32_t dice;
};

/* ---- speech ---- */

static void say(sensor_t *sensor, const char *text)
{
    uart_send(sensor->to_host, text, strlen(text));
}

static char check_sum(const char *text, size_t count)
{
    unsigned sum = 0;
    while (count-- > 0) {
        sum += (unsigned char)*text++;
    }
    return (char)(0x30 + sum % 64);
}

static void say_with_sum(sensor_t *sensor, const char *text)
{
    char line[BLOCK + 3];
    snprintf(line, sizeof line, "%s%c\n", text, check_sum(text, strlen(text)));
    say(sensor, line);
}

static void reply(sensor_t *sensor, const order_t *order, const char *status)
{
    say(sensor, order->text);
    say(sensor, "\n");
    say_with_sum(sensor, status);
    say(sensor, "\n");
}

static void reply_1(sensor_t *sensor, const order_t *order, const char *status)
{
    say(sensor, order->text);
    say(sensor, "\n");
    say(sensor, status);
    say(sensor, "\n\n");
}

static void digits(char *out, uint32_t value, int width)
{
    for (int i = 0; i < width; i++) {
        out[i] = (char)(0x30 + (value >> 6 * (width - 1 - i)) % 64);
    }
    out[width] = '\0';
}

unsigned sensor_distance_mm(unsigned step)
{
    return 500 + 11 * (step % 53);
}

static unsigned of_group(const sensor_t *sensor, int from)
{
    unsigned least = sensor_distance_mm((unsigned)from);
    for (int step = from; step < from + sensor->group && step <= sensor->last; step++) {
        const unsigned mm = sensor_distance_mm((unsigned)step);
        least = mm < least ? mm : least;
    }
    return least;
}

static void say_frame(sensor_t *sensor, ns_t began)
{
    char data[3 * 769 + 1], block[BLOCK + 1], stamp[5];
    size_t n = 0;
    snprintf(sensor->echo + 13, 3, "%02d", sensor->counted ? sensor->left : 0);
    say(sensor, sensor->echo);
    say(sensor, "\n");
    say_with_sum(sensor, "99");
    digits(stamp, (uint32_t)((began - sensor->zero) / MS) & 0xFFFFFF, 4);
    say_with_sum(sensor, stamp);
    for (int step = sensor->first; step <= sensor->last; step += sensor->group) {
        digits(data + n, of_group(sensor, step), sensor->width);
        n += (size_t)sensor->width;
    }
    for (size_t at = 0; at < n; at += BLOCK) {
        snprintf(block, sizeof block, "%.*s", BLOCK, data + at);
        say_with_sum(sensor, block);
    }
    say(sensor, "\n");
}

/* ---- revolutions ---- */

static ns_t turn_after(const sensor_t *sensor, ns_t when)
{
    const ns_t zero = sensor->on_at + sensor->config.phase;
    return when < zero ? zero : zero + ((when - zero) / sensor->config.turn + 1) * sensor->config.turn;
}

/* ---- orders ---- */

static bool number(const char *text, int count, int *value)
{
    *value = 0;
    for (int i = 0; i < count; i++) {
        if (text[i] < '0' || text[i] > '9') {
            return false;
        }
        *value = 10 * *value + text[i] - '0';
    }
    return true;
}

static void quit(sensor_t *sensor)
{
    sensor->streaming = sensor->laser = false;
}

static void measure(sensor_t *sensor, const order_t *order, ns_t now)
{
    int first, last, group, skip, count;
    const char *text = order->text;
    if (strlen(text) != 15) {
        reply(sensor, order, strlen(text) < 15 ? "0C" : "0D");
        return;
    }
    const char *fault = !number(text + 2, 4, &first)    ? "01"
                        : !number(text + 6, 4, &last)   ? "02"
                        : !number(text + 10, 2, &group) ? "03"
                        : !number(text + 12, 1, &skip)  ? "06"
                        : !number(text + 13, 2, &count) ? "07"
                        : last > 768                    ? "04"
                        : last < first                  ? "05"
                                                        : "00";
    reply(sensor, order, fault);
    if (strcmp(fault, "00") != 0) {
        return;
    }
    sensor->measured_at = turn_after(sensor, now) + (sensor->laser ? 1 : 2) * sensor->config.turn;
    sensor->first = first;
    sensor->last = last;
    sensor->group = group == 0 ? 1 : group;
    sensor->skip = skip;
    sensor->left = count;
    sensor->counted = count > 0;
    sensor->width = text[1] == 'S' ? 2 : 3;
    sensor->laser = sensor->streaming = true;
    memcpy(sensor->echo, text, 16);
}

static uint32_t known_rate(const char *text)
{
    static const uint32_t rates[] = {19200, 57600, 115200, 250000, 500000, 750000};
    int rate;
    if (!number(text, 6, &rate)) {
        return RATE_NONE;
    }
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        if (rates[i] == (uint32_t)rate) {
            return rates[i];
        }
    }
    return RATE_NONE;
}

static void change_rate(sensor_t *sensor, const order_t *order)
{
    const uint32_t rate = strlen(order->text) == 8 ? known_rate(order->text + 2) : RATE_NONE;
    reply(sensor, order, rate == RATE_NONE ? "02" : rate == sensor->rate ? "03" : "00");
    sensor->next_rate = rate == sensor->rate ? RATE_NONE : rate;
}

static void time_mode(sensor_t *sensor, const order_t *order)
{
    if (strcmp(order->text, "TM0") == 0) {
        reply(sensor, order, sensor->timing ? "02" : "00");
        quit(sensor);
        sensor->timing = true;
    } else if (strcmp(order->text, "TM2") == 0) {
        reply(sensor, order, sensor->timing ? "00" : "03");
        sensor->timing = false;
    } else {
        reply(sensor, order, "01");
    }
}

static void reset(sensor_t *sensor, ns_t now)
{
    quit(sensor);
    sensor->zero = now;
    sensor->next_rate = sensor->rate == sensor->config.power_up_rate ? RATE_NONE
                                                                     : sensor->config.power_up_rate;
}

static bool symbol_is(const order_t *order, const char *symbol)
{
    return strncmp(order->text, symbol, 2) == 0;
}

static void obey_2(sensor_t *sensor, const order_t *order, ns_t now)
{
    if (order->again) {
        reply(sensor, order, "0B");
    } else if (symbol_is(order, "TM")) {
        time_mode(sensor, order);
    } else if (sensor->timing) {
        reply(sensor, order, "0E");
    } else if (symbol_is(order, "MS") || symbol_is(order, "MD")) {
        measure(sensor, order, now);
    } else if (symbol_is(order, "SS")) {
        change_rate(sensor, order);
    } else if (strcmp(order->text, "QT") == 0) {
        quit(sensor);
        reply(sensor, order, "00");
    } else if (strcmp(order->text, "RS") == 0) {
        reset(sensor, now);
        reply(sensor, order, "00");
    } else if (strcmp(order->text, "BM") == 0) {
        reply(sensor, order, sensor->laser ? "02" : "00");
        sensor->laser = true;
    } else {
        reply(sensor, order, "0E");
    }
}

static void obey_1(sensor_t *sensor, const order_t *order)
{
    if (strcmp(order->text, "SCIP2.0") == 0) {
        reply_1(sensor, order, "0");
        sensor->scip2 = true;
        sensor->laser = false;
    } else if (strcmp(order->text, "L0") == 0 || strcmp(order->text, "L1") == 0) {
        reply_1(sensor, order, "0");
    } else {
        reply_1(sensor, order, "E");
    }
}

/* ---- when it answers ---- */

/* From the end of a command to the first octet of its answer, of a URG-04LX of 2008, in 0.1 ms: three logs of
 * hokuyo_aist, without the answer that came at the end of the sensor's start. */
static const uint16_t recorded_1[] = {84, 640, 980};
static const uint16_t recorded_2[] = {840, 970, 986, 996, 987, 1148, 989, 996, 996};
#define RECORDED(times) (times[draw(sensor, sizeof times / sizeof times[0])] * (MS / 10))
#define HEARD_EARLY (381 * MS)

static uint32_t draw(sensor_t *sensor, uint32_t below)
{
    sensor->dice = sensor->dice * 1664525U + 1013904223U;
    return (uint32_t)((uint64_t)sensor->dice * below >> 32);
}

static ns_t slow_first(sensor_t *sensor)
{
    return sensor->config.answers == ANSWERS_LATEST ? 381 * MS : 90 * MS + draw(sensor, 310000) * US;
}

static ns_t answer_time(sensor_t *sensor, ns_t now)
{
    switch (sensor->config.answers) {
    case ANSWERS_AT_TURN:
        return sensor->scip2 ? turn_after(sensor, now + 8 * MS) : now + 8 * MS;
    case ANSWERS_RECORDED:
        return now + (sensor->scip2 ? RECORDED(recorded_2) : RECORDED(recorded_1));
    case ANSWERS_DRAWN:
    case ANSWERS_LATEST:
        return now + (sensor->answered ? 90 * MS + draw(sensor, 25000) * US : slow_first(sensor));
    case ANSWERS_HEARS:
    case ANSWERS_LATE:
        return now + 90 * MS + draw(sensor, 25000) * US;
    default:
        return now + 8 * MS;
    }
}

static void attend(sensor_t *sensor, ns_t now)
{
    if (sensor->ready && sensor->queued > 0 && sensor->answer_at == 0 && sensor->next_rate == RATE_NONE) {
        sensor->answer_at = answer_time(sensor, now);
    }
}

static ns_t booted_at(const sensor_t *sensor)
{
    return sensor->on_at + sensor->config.boot;
}

static bool hears(const sensor_t *sensor, ns_t now)
{
    const bool early = sensor->config.answers == ANSWERS_HEARS || sensor->config.answers == ANSWERS_RECORDED;
    return sensor->on && (sensor->ready || (early && now >= booted_at(sensor) - HEARD_EARLY));
}

/* What it has heard before is answered at once. */
static void get_ready(sensor_t *sensor, ns_t now)
{
    sensor->ready = true;
    sensor->answer_at = sensor->queued > 0 ? now : 0;
}

static void take_line(sensor_t *sensor, ns_t now)
{
    order_t *order = &sensor->queue[(sensor->head + sensor->queued) % QUEUE];
    if (sensor->length > 0 && sensor->queued < QUEUE) {
        const order_t *before = &sensor->queue[(sensor->head + sensor->queued + QUEUE - 1) % QUEUE];
        sensor->line[sensor->length] = '\0';
        memcpy(order->text, sensor->line, sizeof order->text);
        order->again = sensor->queued > 0 && memcmp(before->text, order->text, 2) == 0;
        sensor->queued++;
    }
    sensor->length = 0;
    attend(sensor, now);
}

void sensor_hears(sensor_t *sensor, unsigned octet, bool framing_error, ns_t now)
{
    if (!hears(sensor, now) || framing_error) {
        return;
    }
    if (octet == '\n' || octet == '\r') {
        take_line(sensor, now);
    } else if (sensor->length < LINE) {
        sensor->line[sensor->length++] = (char)octet;
    }
}

static void answer(sensor_t *sensor, ns_t now)
{
    const order_t order = sensor->queue[sensor->head];
    sensor->head = (sensor->head + 1) % QUEUE;
    sensor->queued--;
    sensor->answer_at = 0;
    sensor->answered = true;
    if (sensor->scip2) {
        obey_2(sensor, &order, now);
    } else {
        obey_1(sensor, &order);
    }
    attend(sensor, now);
}

static void take_rate(sensor_t *sensor, ns_t now)
{
    if (!uart_idle(sensor->to_host, now)) {
        sensor->rate_at = now + sensor->config.settles;
    } else if (now >= sensor->rate_at) {
        sensor->rate = sensor->next_rate;
        sensor->next_rate = RATE_NONE;
        uart_sender_rate(sensor->to_host, sensor->rate);
        uart_receiver_rate(sensor->from_host, sensor->rate, now);
        attend(sensor, now);
    }
}

static void end_revolution(sensor_t *sensor, ns_t now)
{
    const ns_t began = sensor->measured_at - sensor->config.turn;
    if (!uart_idle(sensor->to_host, now)) {
        sensor->measured_at += sensor->config.turn;
        return;
    }
    sensor->left -= sensor->counted;
    say_frame(sensor, began);
    sensor->measured_at += (1 + sensor->skip) * sensor->config.turn;
    if (sensor->counted && sensor->left == 0) {
        quit(sensor);
    }
}

void sensor_run(sensor_t *sensor, ns_t now)
{
    if (!sensor->on) {
        return;
    }
    if (!sensor->ready && now >= booted_at(sensor)) {
        get_ready(sensor, now);
    }
    if (sensor->streaming && now >= sensor->measured_at) {
        end_revolution(sensor, now);
    }
    if (sensor->answer_at != 0 && now >= sensor->answer_at) {
        answer(sensor, now);
    }
    if (sensor->next_rate != RATE_NONE) {
        take_rate(sensor, now);
    }
}

static ns_t sooner(ns_t one, bool other_counts, ns_t other)
{
    return other_counts && other < one ? other : one;
}

ns_t sensor_due(const sensor_t *sensor, ns_t now)
{
    ns_t due = NEVER;
    if (sensor->on) {
        due = sooner(due, !sensor->ready, booted_at(sensor));
        due = sooner(due, sensor->streaming, sensor->measured_at);
        due = sooner(due, sensor->answer_at != 0, sensor->answer_at);
        due = sooner(due, sensor->next_rate != RATE_NONE, now); /* it looks whether its line is free */
    }
    return due;
}

/* ---- life ---- */

static void forget(sensor_t *sensor)
{
    sensor->ready = sensor->scip2 = sensor->laser = sensor->streaming = sensor->timing = sensor->answered =
        false;
    sensor->queued = sensor->length = 0;
    sensor->answer_at = 0;
    sensor->next_rate = RATE_NONE;
}

void sensor_power(sensor_t *sensor, bool on, ns_t now)
{
    forget(sensor);
    uart_flush(sensor->to_host, now);
    sensor->on = on;
    sensor->on_at = sensor->zero = now;
    sensor->rate = sensor->config.power_up_rate;
    uart_sender_rate(sensor->to_host, sensor->rate);
    uart_receiver_rate(sensor->from_host, sensor->rate, now);
}

void sensor_stop(sensor_t *sensor, stop_t how, ns_t now)
{
    if (how == STOP_OTHER) {
        sensor->last = OTHER_LAST;
        memcpy(sensor->echo + 6, OTHER_ECHO, 4);
        return;
    }
    quit(sensor);
    sensor->timing = how == STOP_TIME;
    if (how == STOP_RESET) {
        reset(sensor, now);
    }
}

void sensor_leave_in_scip2(sensor_t *sensor, uint32_t rate, ns_t now)
{
    sensor->scip2 = true;
    sensor->answered = true;
    sensor->rate = rate;
    uart_sender_rate(sensor->to_host, rate);
    uart_receiver_rate(sensor->from_host, rate, now);
}

bool sensor_streams(const sensor_t *sensor)
{
    return sensor->streaming;
}

sensor_t *sensor_create(const sensor_config_t *config, uart_t *from_host, uart_t *to_host)
{
    sensor_t *sensor = calloc(1, sizeof *sensor);
    if (sensor == NULL) {
        abort();
    }
    sensor->config = *config;
    sensor->from_host = from_host;
    sensor->to_host = to_host;
    sensor->dice = 12345U + config->seed * 2654435761U; /* Knuth: neighbours differ in all bits */
    return sensor;
}

void sensor_destroy(sensor_t *sensor)
{
    free(sensor);
}
