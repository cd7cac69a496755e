#include "sim/devices/line_fault.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "sim/devices/urg04lx.h"
#include "unity.h"

#define BIT_NS (1e9 / 250000.0)
#define OCTET ((sim_time_t)40000) /* 10 bits at 250000 */
#define MAX 40000

static struct {
    unsigned octet[MAX];
    sim_time_t at[MAX];
    size_t count;
} wire;

static line_fault_t *fault;
static unsigned restarts, status;

static void take(void *context, unsigned octet, double bit_ns)
{
    TEST_ASSERT_EQUAL_PTR(&wire, context);
    TEST_ASSERT_DOUBLE_WITHIN(1e-9, BIT_NS, bit_ns);
    TEST_ASSERT_TRUE(wire.count < MAX);
    wire.octet[wire.count] = octet;
    wire.at[wire.count++] = timeline_now();
}

static void count_restart(void *context)
{
    TEST_ASSERT_EQUAL_PTR(&restarts, context);
    restarts++;
}

static void note_status(void *context, unsigned code)
{
    TEST_ASSERT_EQUAL_PTR(&restarts, context);
    status = code;
}

static void create(const char *const *texts, unsigned long seed)
{
    const line_fault_ends_t ends = {take, &wire, count_restart, note_status, &restarts};
    line_fault_spec_t specs[8];
    int count = 0;

    for (; texts[count] != NULL; count++) {
        TEST_ASSERT_NULL_MESSAGE(line_fault_parse(&specs[count], texts[count]), texts[count]);
    }
    line_fault_destroy(fault);
    timeline_reset();
    wire.count = 0;
    restarts = status = 0;
    fault = line_fault_create(specs, count, seed, &ends);
}

static void create_one(const char *text)
{
    const char *const texts[] = {text, NULL};

    create(texts, 1);
}

void setUp(void)
{
    fault = NULL;
    timeline_reset();
}

void tearDown(void)
{
    line_fault_destroy(fault);
    fault = NULL;
}

static void run_until(sim_time_t end)
{
    while (timeline_next() <= end) {
        timeline_move_to(timeline_next());
        timeline_run_due();
    }
    timeline_move_to(end);
}

static unsigned pattern(size_t k)
{
    return (unsigned)(k * 7U + k / 251U) & 0xFFU;
}

/* `count` octets, one octet time apart, from `first` on; then all that is still on its way. */
static void send(size_t first, size_t count)
{
    for (size_t k = first; k < first + count; k++) {
        run_until(timeline_now() + OCTET);
        line_fault_octet(fault, pattern(k), BIT_NS);
    }
    while (timeline_next() != SIM_NEVER) {
        run_until(timeline_next());
    }
}

static void octets_are(size_t from, size_t count, size_t first_of_pattern)
{
    for (size_t k = 0; k < count; k++) {
        TEST_ASSERT_EQUAL_UINT32(pattern(first_of_pattern + k), wire.octet[from + k]);
    }
}

/* ---- specifications ---- */

void test_good_specifications_are_understood(void)
{
    line_fault_spec_t spec;

    TEST_ASSERT_NULL(line_fault_parse(&spec, "drop@1234"));
    TEST_ASSERT_EQUAL_INT(LINE_FAULT_DROP, spec.kind);
    TEST_ASSERT_FALSE(spec.by_probability);
    TEST_ASSERT_EQUAL_UINT64(1234, spec.position);
    TEST_ASSERT_NULL(line_fault_parse(&spec, "dup:1e-3"));
    TEST_ASSERT_EQUAL_INT(LINE_FAULT_DUPLICATE, spec.kind);
    TEST_ASSERT_TRUE(spec.by_probability);
    TEST_ASSERT_EQUAL_DOUBLE(1e-3, spec.probability);
    TEST_ASSERT_NULL(line_fault_parse(&spec, "mute@7:500"));
    TEST_ASSERT_EQUAL_INT(LINE_FAULT_MUTE, spec.kind);
    TEST_ASSERT_EQUAL_UINT(500, spec.argument);
    TEST_ASSERT_NULL(line_fault_parse(&spec, "delay:0.5:20"));
    TEST_ASSERT_EQUAL_INT(LINE_FAULT_DELAY, spec.kind);
    TEST_ASSERT_EQUAL_DOUBLE(0.5, spec.probability);
    TEST_ASSERT_EQUAL_UINT(20, spec.argument);
    TEST_ASSERT_NULL(line_fault_parse(&spec, "status@0:55"));
    TEST_ASSERT_EQUAL_INT(LINE_FAULT_STATUS, spec.kind);
    TEST_ASSERT_EQUAL_UINT(55, spec.argument);
    TEST_ASSERT_NULL(line_fault_parse(&spec, "flip@18446744073709551615"));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, spec.position);
    TEST_ASSERT_NULL(line_fault_parse(&spec, "stray:1"));
    TEST_ASSERT_NULL(line_fault_parse(&spec, "restart:0"));
}

void test_bad_specifications_are_refused(void)
{
    static const char *const bad[] = {
        "",
        "drop",
        "@1",
        ":0.1",
        "drops@1",
        "dro@1",
        "drop@",
        "drop@x",
        "drop@-1",
        "drop@ 1",
        "drop@1x",
        "drop@1:5",
        "drop:",
        "drop:x",
        "drop:1.1",
        "drop:-0.1",
        "drop:nan",
        "flip:0.1:3",
        "mute@1",
        "mute@1:",
        "mute@1:0",
        "mute@1:600001",
        "mute@1:1.5",
        "mute@1:-1",
        "delay:0.1",
        "delay:0.1:x",
        "status@1",
        "status@1:20",
        "status@1:99",
        "status@1:5x",
        "restart@1:1",
        "DROP@1",
    };
    line_fault_spec_t spec;

    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        TEST_ASSERT_NOT_NULL_MESSAGE(line_fault_parse(&spec, bad[i]), bad[i]);
    }
}

void test_the_help_shows_every_kind(void)
{
    for (int i = 0; i < LINE_FAULT_KIND_COUNT; i++) {
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(line_fault_help, line_fault_names[i]), line_fault_names[i]);
    }
}

/* ---- the filter ---- */

void test_without_faults_every_octet_passes_at_its_own_time(void)
{
    static const char *const none[] = {NULL};

    create(none, 1);
    send(0, 1000);
    TEST_ASSERT_EQUAL_size_t(1000, wire.count);
    octets_are(0, 1000, 0);
    for (size_t k = 0; k < 1000; k++) {
        TEST_ASSERT_EQUAL_INT64((sim_time_t)(k + 1) * OCTET, wire.at[k]);
    }
    TEST_ASSERT_EQUAL_UINT64(1000, line_fault_octets(fault));
}

void test_a_drop_loses_its_octet_alone(void)
{
    create_one("drop@10");
    send(0, 30);
    TEST_ASSERT_EQUAL_size_t(29, wire.count);
    octets_are(0, 10, 0);
    octets_are(10, 19, 11);
    TEST_ASSERT_EQUAL_UINT(1, line_fault_strikes(fault, LINE_FAULT_DROP));
}

void test_positions_count_from_0(void)
{
    create_one("drop@0");
    send(0, 3);
    TEST_ASSERT_EQUAL_size_t(2, wire.count);
    octets_are(0, 2, 1);
}

void test_a_flip_changes_one_bit_of_its_octet_and_seeds_choose_which(void)
{
    unsigned seen = 0;

    for (unsigned long seed = 0; seed < 100; seed++) {
        static const char *const texts[] = {"flip@5", NULL};

        create(texts, seed);
        send(0, 10);
        TEST_ASSERT_EQUAL_size_t(10, wire.count);
        octets_are(0, 5, 0);
        octets_are(6, 4, 6);
        TEST_ASSERT_EQUAL_INT(1, __builtin_popcount(wire.octet[5] ^ pattern(5)));
        TEST_ASSERT_TRUE(wire.octet[5] < 256);
        seen |= wire.octet[5] ^ pattern(5);
    }
    TEST_ASSERT_EQUAL_UINT32(0xFF, seen);
}

void test_a_duplicate_comes_behind_its_octet_and_takes_its_time_on_the_line(void)
{
    create_one("dup@5");
    send(0, 10);
    TEST_ASSERT_EQUAL_size_t(11, wire.count);
    octets_are(0, 6, 0);
    octets_are(6, 5, 5);
    for (size_t k = 1; k < wire.count; k++) {
        TEST_ASSERT_TRUE(wire.at[k] - wire.at[k - 1] >= OCTET);
    }
    TEST_ASSERT_EQUAL_INT64(wire.at[9] + OCTET, wire.at[10]);
}

void test_a_stray_octet_comes_before_its_octet(void)
{
    create_one("stray@5");
    send(0, 10);
    TEST_ASSERT_EQUAL_size_t(11, wire.count);
    octets_are(0, 5, 0);
    octets_are(6, 5, 5);
    for (size_t k = 1; k < wire.count; k++) {
        TEST_ASSERT_TRUE(wire.at[k] - wire.at[k - 1] >= OCTET);
    }
}

void test_a_gap_in_the_line_absorbs_what_was_put_in(void)
{
    create_one("dup@0");
    send(0, 3);
    run_until(timeline_now() + SIM_MS);
    send(3, 1);
    TEST_ASSERT_EQUAL_INT64(timeline_now(), wire.at[4]);
}

void test_a_delay_holds_everything_back_and_then_goes_on_at_line_speed_in_order(void)
{
    create_one("delay@10:3");
    send(0, 300);
    TEST_ASSERT_EQUAL_size_t(300, wire.count);
    octets_are(0, 300, 0);
    TEST_ASSERT_EQUAL_INT64(10 * OCTET, wire.at[9]);
    TEST_ASSERT_EQUAL_INT64(11 * OCTET + 3 * SIM_MS, wire.at[10]);
    for (size_t k = 11; k < 300; k++) {
        TEST_ASSERT_EQUAL_INT64(wire.at[k - 1] + OCTET, wire.at[k]);
    }
}

void test_long_delays_lose_nothing(void)
{
    create_one("delay@3:1000");
    send(0, 30000);
    TEST_ASSERT_EQUAL_size_t(30000, wire.count);
    octets_are(0, 30000, 0);
}

void test_a_mute_loses_what_comes_for_its_time(void)
{
    create_one("mute@10:2");
    send(0, 100);
    TEST_ASSERT_EQUAL_size_t(50, wire.count);
    octets_are(0, 10, 0);
    octets_are(10, 40, 60);
}

void test_no_stray_octet_passes_a_muted_line(void)
{
    static const char *const texts[] = {"mute@10:2", "stray@30", NULL};

    create(texts, 1);
    send(0, 100);
    TEST_ASSERT_EQUAL_size_t(50, wire.count);
}

void test_restart_and_status_reach_the_device(void)
{
    static const char *const texts[] = {"restart@4", "status@6:55", NULL};

    create(texts, 1);
    send(0, 5);
    TEST_ASSERT_EQUAL_UINT(1, restarts);
    TEST_ASSERT_EQUAL_UINT(0, status);
    TEST_ASSERT_EQUAL_size_t(4, wire.count);
    send(5, 5);
    TEST_ASSERT_EQUAL_UINT(55, status);
    TEST_ASSERT_EQUAL_UINT(1, restarts);
    TEST_ASSERT_EQUAL_size_t(9, wire.count);
}

void test_a_device_that_cannot_restart_is_left_alone(void)
{
    const line_fault_ends_t ends = {take, &wire, NULL, NULL, NULL};
    line_fault_spec_t specs[2];

    TEST_ASSERT_NULL(line_fault_parse(&specs[0], "restart@1"));
    TEST_ASSERT_NULL(line_fault_parse(&specs[1], "status@2:50"));
    wire.count = 0;
    fault = line_fault_create(specs, 2, 1, &ends);
    send(0, 5);
    TEST_ASSERT_EQUAL_UINT(1, line_fault_strikes(fault, LINE_FAULT_RESTART));
    TEST_ASSERT_EQUAL_UINT(1, line_fault_strikes(fault, LINE_FAULT_STATUS));
    TEST_ASSERT_EQUAL_size_t(4, wire.count);
}

void test_a_fault_that_is_added_strikes_the_next_octet_alone(void)
{
    const char *const none[] = {NULL};
    line_fault_spec_t drop;

    TEST_ASSERT_NULL(line_fault_parse(&drop, "drop@0"));
    create(none, 1);
    for (unsigned k = 0; k < 30; k++) {
        run_until((sim_time_t)(k + 1) * OCTET);
        if (k == 10 || k == 20) {
            line_fault_add(fault, &drop);
        }
        line_fault_octet(fault, k, BIT_NS);
    }
    TEST_ASSERT_EQUAL_size_t(28, wire.count);
    TEST_ASSERT_EQUAL_UINT(9, wire.octet[9]);
    TEST_ASSERT_EQUAL_UINT(11, wire.octet[10]);
    TEST_ASSERT_EQUAL_UINT(19, wire.octet[18]);
    TEST_ASSERT_EQUAL_UINT(21, wire.octet[19]);
    TEST_ASSERT_EQUAL_UINT(2, line_fault_strikes(fault, LINE_FAULT_DROP));
}

void test_probabilities_strike_as_often_as_they_say(void)
{
    static const double probabilities[] = {0.001, 0.01, 0.2, 0.9};

    for (size_t i = 0; i < 4; i++) {
        const double expected = 30000.0 * probabilities[i];
        const double sigma = sqrt(expected * (1.0 - probabilities[i]));
        char text[32];

        snprintf(text, sizeof text, "drop:%g", probabilities[i]);
        create_one(text);
        send(0, 30000);
        TEST_ASSERT_DOUBLE_WITHIN(4.0 * sigma, expected, line_fault_strikes(fault, LINE_FAULT_DROP));
        TEST_ASSERT_EQUAL_size_t(30000, wire.count + line_fault_strikes(fault, LINE_FAULT_DROP));
    }
}

void test_two_faults_on_one_octet_both_strike(void)
{
    static const char *const texts[] = {"flip@2", "dup@2", "drop@4", "dup@4", NULL};

    create(texts, 1);
    send(0, 6);
    TEST_ASSERT_EQUAL_size_t(6, wire.count);
    TEST_ASSERT_EQUAL_UINT32(wire.octet[2], wire.octet[3]);
    TEST_ASSERT_EQUAL_INT(1, __builtin_popcount(wire.octet[2] ^ pattern(2)));
    octets_are(4, 1, 3);
    octets_are(5, 1, 5);
}

void test_the_same_seed_strikes_the_same_octets_and_another_seed_others(void)
{
    static const char *const texts[] = {"drop:0.01", "flip:0.01", "stray:0.01", NULL};
    static unsigned first[MAX];
    size_t count;

    create(texts, 7);
    send(0, 5000);
    count = wire.count;
    memcpy(first, wire.octet, count * sizeof first[0]);
    create(texts, 7);
    send(0, 5000);
    TEST_ASSERT_EQUAL_size_t(count, wire.count);
    TEST_ASSERT_EQUAL_MEMORY(first, wire.octet, count * sizeof first[0]);
    create(texts, 8);
    send(0, 5000);
    TEST_ASSERT_TRUE(wire.count != count || memcmp(first, wire.octet, count * sizeof first[0]) != 0);
}

void test_a_filter_may_be_destroyed_while_it_holds_octets_back(void)
{
    create_one("delay@0:1000");
    run_until(OCTET);
    line_fault_octet(fault, 'x', BIT_NS);
    line_fault_destroy(fault);
    fault = NULL;
    run_until(2 * SIM_S);
    TEST_ASSERT_EQUAL_size_t(0, wire.count);
}

/* ---- the scanner's own trouble ---- */

static urg04lx_t *urg;
static char heard[200000];
static size_t heard_count;

static void hear(void *context, unsigned octet, double bit_ns)
{
    (void)context;
    (void)bit_ns;
    TEST_ASSERT_TRUE(heard_count < sizeof heard - 1);
    heard[heard_count++] = (char)octet;
    heard[heard_count] = '\0';
}

static void world(void *context, const urg_rays_t *rays, int *distance_mm)
{
    (void)context;
    for (int i = 0; i <= rays->to_step - rays->from_step; i++) {
        distance_mm[i] = 700;
    }
}

static void say(const char *text)
{
    for (; *text != '\0'; text++) {
        run_until(timeline_now() + 86806);
        urg04lx_receive(urg, (unsigned char)*text, 1e9 / 115200.0);
    }
    run_until(timeline_now() + 50 * SIM_MS);
}

static void begin_scanner(const char *measurement)
{
    timeline_reset();
    urg = urg04lx_create(&urg04lx_default, world, NULL, hear, NULL);
    urg04lx_power(urg, true);
    run_until(9 * SIM_S);
    say("SCIP2.0\n");
    say("BM\n");
    say(measurement);
    heard_count = 0;
    heard[0] = '\0';
}

static void end_scanner(void)
{
    urg04lx_destroy(urg);
}

static unsigned count_of(const char *text)
{
    unsigned count = 0;

    for (const char *p = heard; (p = strstr(p, text)) != NULL; p++) {
        count++;
    }
    return count;
}

/* Sums: facts of the protocol, "50U" and "21S". */
void test_hardware_trouble_ends_a_stream_with_a_frame_without_data(void)
{
    begin_scanner("MS0380038901000\n");
    run_until(timeline_now() + 500 * SIM_MS);
    TEST_ASSERT_TRUE(count_of("99b\n") >= 4);
    urg04lx_trouble(urg, 50);
    heard_count = 0;
    run_until(timeline_now() + SIM_S);
    TEST_ASSERT_NOT_NULL(strstr(heard, "MS0380038901000\n50U\n\n"));
    TEST_ASSERT_EQUAL_STRING("\n50U\n\n", heard + heard_count - 6);
    TEST_ASSERT_FALSE(urg04lx_state(urg).streaming);
    TEST_ASSERT_FALSE(urg04lx_state(urg).laser_on);
    heard_count = 0;
    say("MS0380038901000\n");
    run_until(timeline_now() + 500 * SIM_MS);
    TEST_ASSERT_TRUE(count_of("99b\n") >= 4);
    end_scanner();
}

void test_a_verified_error_pauses_a_stream_for_a_second(void)
{
    begin_scanner("MS0380038901000\n");
    urg04lx_trouble(urg, 21);
    run_until(timeline_now() + 900 * SIM_MS);
    TEST_ASSERT_EQUAL_STRING("MS0380038901000\n21S\n\n", heard);
    run_until(timeline_now() + 2100 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT(1, count_of("MS0380038901000\n98a\n\n"));
    TEST_ASSERT_UINT_WITHIN(2, 19, count_of("99b\n"));
    end_scanner();
}

void test_a_verified_error_may_turn_out_to_be_trouble(void)
{
    begin_scanner("MS0380038901000\n");
    urg04lx_trouble(urg, 49);
    run_until(timeline_now() + 500 * SIM_MS);
    urg04lx_trouble(urg, 97);
    run_until(timeline_now() + 3 * SIM_S);
    TEST_ASSERT_EQUAL_STRING("MS0380038901000\n49]\n\nMS0380038901000\n97`\n\n", heard);
    end_scanner();
}

void test_stopping_forgets_a_verification(void)
{
    begin_scanner("MS0380038901000\n");
    urg04lx_trouble(urg, 30);
    run_until(timeline_now() + 300 * SIM_MS);
    say("QT\n");
    say("MS0380038901002\n");
    run_until(timeline_now() + SIM_S);
    TEST_ASSERT_EQUAL_UINT(0, count_of("98a"));
    TEST_ASSERT_EQUAL_UINT(2, count_of("99b\n"));
    end_scanner();
}

void test_a_counted_run_counts_no_trouble(void)
{
    begin_scanner("MS0380038901003\n");
    urg04lx_trouble(urg, 98);
    run_until(timeline_now() + SIM_S);
    TEST_ASSERT_EQUAL_STRING_LEN("MS0380038901003\n98a\n\nMS0380038901002\n99b\n", heard, 41);
    TEST_ASSERT_EQUAL_UINT(3, count_of("99b\n"));
    end_scanner();
}

void test_a_single_scan_answers_trouble(void)
{
    begin_scanner("\n");
    urg04lx_trouble(urg, 50);
    say("GS0380038901\n");
    run_until(timeline_now() + 300 * SIM_MS);
    TEST_ASSERT_EQUAL_STRING("GS0380038901\n50U\n\n", heard);
    TEST_ASSERT_FALSE(urg04lx_state(urg).laser_on);
    end_scanner();
}

void test_power_forgets_trouble(void)
{
    begin_scanner("\n");
    urg04lx_trouble(urg, 50);
    urg04lx_power(urg, false);
    urg04lx_power(urg, true);
    urg04lx_trouble(urg, 51);
    run_until(timeline_now() + 9 * SIM_S);
    say("SCIP2.0\n");
    say("MS0380038901002\n");
    run_until(timeline_now() + SIM_S);
    TEST_ASSERT_EQUAL_UINT(2, count_of("99b\n"));
    end_scanner();
}
