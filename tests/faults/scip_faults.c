/* The parser under faults by the million: one fault a frame, then independent faults an octet, against the
 * rate of escapes that escape.c computes. Exit status 1 when a claim does not hold. */
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "escape.h"
#include "drivers/scip_layout.h"
#include "drivers/scip_parser.h"
#include "wire.h"

#define RUN_SCANS 99
#define PERIOD_MS 100
#define SURFACES 4U
#define SPREAD_MOST_MM 100
#define STEP_MOST_MM 60
#define BURST_REACH 8U
#define FAR_MM 10U

typedef struct {
    uint32_t stamp_ms;
    uint16_t distance_mm[WIRE_POINTS_MAX];
} content_t;

typedef struct {
    const wire_order_t *order;
    scip_parser_t parser;
    scip_scan_t scan;
    uint16_t points[WIRE_POINTS_MAX];
    scip_request_t request;
    content_t content[2]; /* of the frame on the line and of the one before */
    unsigned long frames;
} receiver_t;

typedef struct {
    unsigned long right, wrong, doubted;
} outcome_t;

static bool holds;

static void claim(bool kept, const char *what)
{
    if (!kept) {
        printf("FAILED: %s\n", what);
        holds = false;
    }
}

static void await(receiver_t *receiver)
{
    scip_parser_expect(&receiver->parser, &receiver->request);
}

static void open_receiver(receiver_t *receiver, const wire_order_t *order)
{
    static const char *const symbols[] = {"MS", "MD", "GS", "GD"};
    const scip_range_t range = {(uint16_t)order->first, (uint16_t)order->last, (uint16_t)order->cluster, 0,
                                (uint16_t)order->count};
    int kind = 0;

    while (strcmp(symbols[kind], order->symbol) != 0) {
        kind++;
    }
    memset(receiver, 0, sizeof *receiver);
    receiver->order = order;
    receiver->scan = (scip_scan_t){.distance_mm = receiver->points, .capacity = WIRE_POINTS_MAX};
    if (!scip_request_scan(&receiver->request, (scip_kind_t)(SCIP_STREAM_2 + kind), &range)) {
        abort();
    }
    scip_parser_init(&receiver->parser);
    scip_parser_scan_into(&receiver->parser, &receiver->scan);
    await(receiver);
}

static bool shows(const receiver_t *receiver, const content_t *content)
{
    const size_t octets = receiver->scan.points * sizeof receiver->points[0];

    return receiver->scan.timestamp_ms == content->stamp_ms &&
           memcmp(receiver->points, content->distance_mm, octets) == 0;
}

/* A scan that completes late belongs to the frame before. */
static bool is_right(const receiver_t *receiver)
{
    return shows(receiver, &receiver->content[0]) || shows(receiver, &receiver->content[1]);
}

static outcome_t receive(receiver_t *receiver, const wire_t *wire, void (*wrong)(receiver_t *))
{
    const octet_t *octets = wire->octets;
    size_t left = wire->length;
    outcome_t outcome = {0, 0, 0};

    while (left > 0) {
        scip_event_t event;
        const size_t taken = scip_parser_feed_run(&receiver->parser, octets, left, &event);
        octets += taken;
        left -= taken;
        if (event == SCIP_SCAN && is_right(receiver)) {
            outcome.right++;
        } else if (event == SCIP_SCAN) {
            outcome.wrong++;
            wrong(receiver);
        } else if (event == SCIP_DAMAGED && receiver->parser.last_damage == SCIP_DAMAGE_SEQUENCE) {
            outcome.doubted++;
        }
    }
    return outcome;
}

static content_t *next_content(receiver_t *receiver)
{
    receiver->content[1] = receiver->content[0];
    receiver->content[0].stamp_ms = (uint32_t)(receiver->frames * PERIOD_MS) & 0xFFFFFFU;
    receiver->frames++;
    return &receiver->content[0];
}

/* ---- one fault a frame ---- */

typedef struct {
    unsigned long damaged, wrong, unharmed;
} row_t;

static void ignore(receiver_t *receiver)
{
    (void)receiver;
}

/* Every other frame is any pattern, the others a surface seen with some codes among the distances. */
static void fill_any(content_t *content, const wire_order_t *order, dice_t *dice)
{
    const int points = wire_points(order);
    const uint32_t most = wire_width(order) == 2 ? 4096 : 65536;
    const uint32_t surface = 300 + dice_below(dice, 3000), pattern = dice_below(dice, 2);

    for (int i = 0; i < points; i++) {
        const uint32_t roll = dice_roll(dice);
        const uint32_t seen = (roll & 15) == 0 ? roll >> 28 : surface + (roll >> 27);
        content->distance_mm[i] = (uint16_t)(pattern == 0 ? (uint32_t)(((uint64_t)roll * most) >> 32) : seen);
    }
}

static void ask_again(receiver_t *receiver, int *remaining)
{
    if (!wire_is_stream(receiver->order)) {
        await(receiver);
    } else if (receiver->order->count > 0) {
        *remaining = *remaining == 0 ? receiver->order->count : *remaining;
        if (*remaining == receiver->order->count) {
            await(receiver);
        }
        --*remaining;
    }
}

static void damage(wire_t *damaged, const wire_t *whole, fault_t fault, dice_t *dice)
{
    const size_t first = fault == FAULT_TRUNCATION ? 1
                                                   : 0; /* something is left of a frame that is cut short */
    const size_t at = first + dice_below(dice, (uint32_t)(whole->length - first));

    damaged->length = 0;
    wire_put(damaged, whole->octets, at);
    if (wire_put_faulty(damaged, whole->octets[at], fault, dice_roll(dice))) {
        wire_put(damaged, whole->octets + at + 1, whole->length - at - 1);
    }
}

/* Damaged and whole frames in random order. Returns how many whole ones were not delivered. */
static unsigned long run_single(const wire_order_t *order, unsigned long count, dice_t *dice, row_t *rows,
                                unsigned long *whole_frames)
{
    static receiver_t receiver;
    unsigned long damaged_frames = 0, lost = 0;
    int remaining = 0;

    open_receiver(&receiver, order);
    while (damaged_frames < count) {
        wire_t whole, damaged;
        content_t *content = next_content(&receiver);
        fill_any(content, order, dice);
        ask_again(&receiver, &remaining);
        wire_frame(&whole, order, remaining, content->stamp_ms, content->distance_mm);
        if (dice_below(dice, 2) == 0) {
            const fault_t fault = (fault_t)dice_below(dice, FAULT_COUNT);
            damage(&damaged, &whole, fault, dice);
            const outcome_t outcome = receive(&receiver, &damaged, ignore);
            rows[fault].damaged++;
            rows[fault].wrong += outcome.wrong;
            rows[fault].unharmed += outcome.right;
            damaged_frames++;
        } else {
            const outcome_t outcome = receive(&receiver, &whole, ignore);
            lost += outcome.right == 0;
            rows[FAULT_COUNT].wrong += outcome.wrong;
            ++*whole_frames;
        }
    }
    return lost;
}

static void single_faults(unsigned long frames, uint64_t seed)
{
    static const struct {
        wire_order_t order;
        unsigned tenths;
    } shares[] = {
        {{"MS", 372, 406, 1, 0}, 4},         {{"MD", 372, 406, 1, 0}, 2}, {{"MS", 249, 519, 1, 0}, 1},
        {{"MS", 372, 406, 1, RUN_SCANS}, 1}, {{"GS", 372, 406, 1, 0}, 1}, {{"GD", 372, 419, 2, 0}, 1},
    };
    row_t rows[FAULT_COUNT + 1] = {{0, 0, 0}}, total = {0, 0, 0};
    unsigned long whole_frames = 0, lost = 0;
    dice_t dice = {seed};

    for (size_t i = 0; i < sizeof shares / sizeof shares[0]; i++) {
        lost += run_single(&shares[i].order, frames / 10 * shares[i].tenths, &dice, rows, &whole_frames);
    }
    printf("One fault in a frame (MS, MD, GS, GD; seed %llu)\n\n", (unsigned long long)seed);
    printf("%-12s %10s %10s %10s\n", "fault", "frames", "unharmed", "wrong");
    for (int i = 0; i <= FAULT_COUNT; i++) {
        if (i < FAULT_COUNT) {
            printf("%-12s %10lu %10lu %10lu\n", fault_names[i], rows[i].damaged, rows[i].unharmed,
                   rows[i].wrong);
        }
        total.damaged += rows[i].damaged;
        total.unharmed += rows[i].unharmed;
        total.wrong += rows[i].wrong;
    }
    printf("%-12s %10lu %10lu %10lu\n\n", "all", total.damaged, total.unharmed, total.wrong);
    printf("%lu whole frames among them, %lu not delivered\n", whole_frames, lost);
    claim(total.damaged > 0 && total.wrong == 0, "no wrong distance is delivered");
    claim(lost == 0, "every undamaged frame is delivered");
}

/* ---- independent faults ---- */

static struct {
    unsigned long far;          /* wrong scans whose mean is wrong by more than FAR_MM */
    unsigned long spread, step; /* wrong scans that the check lets pass, each after those before */
    float worst_mm;             /* of the mean, among the last */
    float true_mean_mm[SURFACES];
    int surface;
} wrongs;

static void judge(receiver_t *receiver)
{
    const scip_group_mean_t mean = scip_group_mean(&receiver->scan,
                                                   &scip_layouts[SCIP_LAYOUT_FRONT].groups[0]);

    wrongs.far += mean.valid && fabsf(mean.mean_mm - wrongs.true_mean_mm[wrongs.surface]) > FAR_MM;
    if (!mean.valid || mean.spread_mm > SPREAD_MOST_MM) {
        return;
    }
    wrongs.spread++;
    if (scip_group_step_mm(&receiver->scan, &scip_layouts[SCIP_LAYOUT_FRONT].groups[0]) <= STEP_MOST_MM) {
        const float error_mm = fabsf(mean.mean_mm - wrongs.true_mean_mm[wrongs.surface]);
        wrongs.step++;
        wrongs.worst_mm = fmaxf(wrongs.worst_mm, error_mm);
    }
}

/* Ground 0.6 to 1.8 m away with 15 mm of noise either way. */
static void fill_surface(content_t *content, const wire_order_t *order, int surface)
{
    dice_t dice = {77U + (unsigned)surface};

    for (int i = 0; i < wire_points(order); i++) {
        content->distance_mm[i] = (uint16_t)(600 + 400 * surface + i / 4 + (int)dice_below(&dice, 31) - 15);
    }
}

static const wire_order_t front = {"MS", 372, 406, 1, 0};

static float mean_of(const content_t *content)
{
    float sum = 0.0F;

    for (int i = 0; i < wire_points(&front); i++) {
        sum += content->distance_mm[i];
    }
    return sum / (float)wire_points(&front);
}

static escape_t expected_escape(double p)
{
    escape_t mean = {0.0, 0.0, 0.0};

    for (int i = 0; i < (int)SURFACES; i++) {
        wire_t wire;
        content_t content = {.stamp_ms = 0x5A31C7U * (unsigned)(i + 1) & 0xFFFFFFU};
        fill_surface(&content, &front, i);
        wrongs.true_mean_mm[i] = mean_of(&content);
        wire_frame(&wire, &front, 0, content.stamp_ms, content.distance_mm);
        const escape_t escape = escape_of(&wire, &front, p);
        mean.wrong += escape.wrong / SURFACES;
        mean.wrong_stamp += escape.wrong_stamp / SURFACES;
        mean.right += escape.right / SURFACES;
    }
    return mean;
}

static void put_noisy(wire_t *noisy, const wire_t *whole, double p, dice_t *dice)
{
    const uint32_t limit = (uint32_t)(p * 4294967296.0);

    noisy->length = 0;
    for (size_t at = 0; at < whole->length; at++) {
        if (dice_roll(dice) >= limit) {
            wire_put(noisy, whole->octets + at, 1);
        } else if (!wire_put_faulty(noisy, whole->octets[at], (fault_t)dice_below(dice, FAULT_COUNT),
                                    dice_roll(dice))) {
            return;
        }
    }
}

static outcome_t run_independent(unsigned long frames, double p, dice_t *dice)
{
    static receiver_t receiver;
    content_t surfaces[SURFACES];
    outcome_t total = {0, 0, 0};

    memset(&wrongs.spread, 0, offsetof(typeof(wrongs), true_mean_mm));
    for (int i = 0; i < (int)SURFACES; i++) {
        fill_surface(&surfaces[i], &front, i);
    }
    open_receiver(&receiver, &front);
    for (unsigned long i = 0; i < frames; i++) {
        wire_t whole, noisy;
        content_t *content = next_content(&receiver);
        wrongs.surface = (int)(i % SURFACES);
        memcpy(content->distance_mm, surfaces[wrongs.surface].distance_mm, sizeof content->distance_mm);
        wire_frame(&whole, &front, 0, content->stamp_ms, content->distance_mm);
        put_noisy(&noisy, &whole, p, dice);
        const outcome_t outcome = receive(&receiver, &noisy, judge);
        total.right += outcome.right;
        total.wrong += outcome.wrong;
        total.doubted += outcome.doubted;
    }
    return total;
}

static double sigmas(double seen, double expected)
{
    return (seen - expected) / sqrt(expected);
}

static void independent_faults(unsigned long frames, double p, uint64_t seed)
{
    const escape_t escape = expected_escape(p);
    dice_t dice = {seed};
    const outcome_t seen = run_independent(frames, p, &dice);
    const double expected = escape.wrong * (double)frames, by_sums = (double)(seen.wrong + seen.doubted);

    printf("\nFaults with a chance of %g an octet (MS, 35 points, %lu frames, seed %llu)\n\n", p, frames,
           (unsigned long long)seed);
    printf("whole and delivered: %lu, computed %.0f\n", seen.right, escape.right * (double)frames);
    printf("wrong, computed for the sums alone: %.1f = %.3g of all (%.1f in the time stamp only)\n", expected,
           escape.wrong, escape.wrong_stamp * (double)frames);
    printf("wrong, seen:\n");
    printf("  past the sums                      %6.0f  (%+.2f sigma)\n", by_sums, sigmas(by_sums, expected));
    printf("  past the time stamp's check too    %6lu\n", seen.wrong);
    printf("  with a ray spread up to %3d mm     %6lu\n", SPREAD_MOST_MM, wrongs.spread);
    printf("  with steps from ray to ray to %2d mm%6lu  (mean wrong by %.1f mm at most)\n", STEP_MOST_MM,
           wrongs.step, (double)wrongs.worst_mm);
    claim(fabs(sigmas(by_sums, expected)) <= 3.0, "the rate of escapes is the computed one within 3 sigma");
    claim(by_sums > 0.0 && (double)wrongs.step < by_sums, "plausibility lowers the rate of escapes");
}

/* ---- two faults, close together ---- */

/* The second fault up to BURST_REACH octets behind the first: a burst of noise, or a UART that slipped. */
static void put_burst(wire_t *noisy, const wire_t *whole, dice_t *dice)
{
    const size_t first = dice_below(dice, (uint32_t)(whole->length - BURST_REACH));
    const size_t second = first + 1 + dice_below(dice, BURST_REACH);

    noisy->length = 0;
    for (size_t at = 0; at < whole->length; at++) {
        if (at != first && at != second) {
            wire_put(noisy, whole->octets + at, 1);
        } else if (!wire_put_faulty(noisy, whole->octets[at], (fault_t)dice_below(dice, FAULT_TRUNCATION),
                                    dice_roll(dice))) {
            return;
        }
    }
}

static outcome_t run_bursts(unsigned long frames, dice_t *dice)
{
    static receiver_t receiver;
    outcome_t total = {0, 0, 0};

    open_receiver(&receiver, &front);
    wrongs.spread = wrongs.step = wrongs.far = 0;
    wrongs.worst_mm = 0.0F;
    for (unsigned long i = 0; i < frames; i++) {
        wire_t whole, noisy;
        content_t *content = next_content(&receiver);

        wrongs.surface = (int)(i % SURFACES);
        fill_surface(content, &front, wrongs.surface);
        wrongs.true_mean_mm[wrongs.surface] = mean_of(content);
        wire_frame(&whole, &front, 0, content->stamp_ms, content->distance_mm);
        put_burst(&noisy, &whole, dice);
        const outcome_t outcome = receive(&receiver, &noisy, judge);
        total.right += outcome.right;
        total.wrong += outcome.wrong;
        total.doubted += outcome.doubted;
    }
    return total;
}

/* Two flips of one bit in opposite directions, or an octet lost and another doubled or put in, keep line
 * lengths and may keep the sum: more pass than the 1 of 64 that a sum of 6 bits suggests. */
static void burst_faults(unsigned long frames, uint64_t seed)
{
    dice_t dice = {seed};
    const outcome_t seen = run_bursts(frames, &dice);
    const unsigned long by_sums = seen.wrong + seen.doubted;

    printf("\nTwo faults within %u octets of every frame (MS, 35 points, %lu frames, seed %llu)\n\n",
           BURST_REACH, frames, (unsigned long long)seed);
    printf("wrong, seen:\n");
    printf("  past the sums                      %6lu = %.3g of all\n", by_sums,
           (double)by_sums / (double)frames);
    printf("  past the time stamp's check too    %6lu\n", seen.wrong);
    printf("  with a ray spread up to %3d mm     %6lu\n", SPREAD_MOST_MM, wrongs.spread);
    printf("  with steps from ray to ray to %2d mm%6lu  (mean wrong by %.1f mm at most)\n", STEP_MOST_MM,
           wrongs.step, (double)wrongs.worst_mm);
    printf("  the mean wrong by more than %u mm   %6lu\n", FAR_MM, wrongs.far);
    claim((double)by_sums < 0.03 * (double)frames, "fewer than 3 of 100 pass the sums");
    claim(wrongs.step < by_sums / 10 && wrongs.far < by_sums / 100, "plausibility and the robust mean hold");
}

int main(int argc, char **argv)
{
    unsigned long frames = 1000000;
    uint64_t seed = 20260801;
    int option;

    while ((option = getopt(argc, argv, "n:s:")) != -1) {
        if (option == 'n') {
            frames = strtoul(optarg, NULL, 10);
        } else if (option == 's') {
            seed = strtoull(optarg, NULL, 10);
        } else {
            fprintf(stderr, "usage: scip_faults [-n FRAMES] [-s SEED]\n");
            return 2;
        }
    }
    holds = true;
    single_faults(frames, seed);
    independent_faults(frames, 1e-3, seed);
    independent_faults(frames, 1e-2, seed);
    burst_faults(frames, seed);
    return holds ? 0 : 1;
}
