#include "sim/devices/urg04lx.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "unity.h"

/* Replies and sums: the protocol's documents and what a URG-04LX of firmware 3.1.04 (H0706400) sent, typed in
 * by hand. */

#define HEARD_N 40000
#define STEPS_N 769

typedef struct {
    char text[HEARD_N + 1];
    sim_time_t at[HEARD_N];
    double bit_ns[HEARD_N];
    size_t count;
} heard_t;

static urg04lx_t *urg;
static urg04lx_config_t config;
static heard_t heard;
static double host_rate;
static int world_mm[STEPS_N];
static sim_time_t world_called_at; /* for step 389 */
static sim_time_t step_at[STEPS_N];
static int world_first, world_last;
static unsigned world_calls, instants;

static void world(void *context, const urg_rays_t *rays, int *distance_mm)
{
    TEST_ASSERT_EQUAL_PTR(world_mm, context);
    world_first = rays->first_step;
    world_last = rays->last_step;
    world_calls += rays->from_step == rays->first_step;
    for (int step = rays->from_step; step <= rays->to_step; step++) {
        distance_mm[step - rays->from_step] = world_mm[step];
        step_at[step] = timeline_now();
    }
    world_called_at = step_at[389];
}

static void listen(void *context, unsigned octet, double bit_ns)
{
    heard_t *ear = context;

    TEST_ASSERT_TRUE_MESSAGE(ear->count < HEARD_N, "more octets than the test expects");
    ear->text[ear->count] = (char)octet;
    ear->at[ear->count] = timeline_now();
    ear->bit_ns[ear->count] = bit_ns;
    ear->count++;
    ear->text[ear->count] = '\0';
}

static void run_until(sim_time_t end)
{
    while (timeline_next() <= end) {
        timeline_move_to(timeline_next());
        timeline_run_due();
        instants++;
    }
    timeline_move_to(end);
}

static void run_for(sim_time_t span)
{
    run_until(timeline_now() + span);
}

static void forget(void)
{
    heard.count = 0;
    heard.text[0] = '\0';
}

static void host_octets(const char *octets, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        run_for((sim_time_t)(1e10 / host_rate));
        urg04lx_receive(urg, (unsigned char)octets[i], 1e9 / host_rate);
    }
}

static void host(const char *text)
{
    host_octets(text, strlen(text));
}

static void expect(const char *reply)
{
    TEST_ASSERT_EQUAL_STRING(reply, heard.text);
    TEST_ASSERT_EQUAL_UINT(strlen(reply), heard.count);
}

/* Only for a sensor that does not stream. */
static void ask(const char *command, const char *reply)
{
    forget();
    host(command);
    run_for(700 * SIM_MS);
    expect(reply);
}

static void create(void)
{
    if (urg != NULL) {
        urg04lx_destroy(urg);
    }
    timeline_reset();
    forget();
    urg = urg04lx_create(&config, world, world_mm, listen, &heard);
    host_rate = config.power_up_rate;
    urg04lx_power(urg, true);
    run_for(config.boot);
}

static void create_scip2(void)
{
    create();
    ask("SCIP2.0\n", "SCIP2.0\n0\n\n");
}

void setUp(void)
{
    urg = NULL;
    timeline_reset();
    config = urg04lx_default;
    config.boot = 10 * SIM_MS;
    for (int step = 0; step < STEPS_N; step++) {
        world_mm[step] = 1000 + step;
    }
    world_calls = 0;
    create();
}

void tearDown(void)
{
    if (urg != NULL) {
        urg04lx_destroy(urg);
    }
    urg = NULL;
}

/* ---- an independent reading of replies ---- */

static void check_sum(const char *line, size_t count, char sum)
{
    int rest = 0;

    while (count-- > 0) {
        rest = (rest + *line++) % 64;
    }
    TEST_ASSERT_EQUAL_INT(48 + rest, sum);
}

static long digits64(const char *text, int count)
{
    long value = 0;

    for (int i = 0; i < count; i++) {
        TEST_ASSERT_TRUE(text[i] >= '0' && text[i] <= 'o');
        value = 64 * value + (text[i] - '0');
    }
    return value;
}

typedef struct {
    const char *end;
    char echo[40];
    long time_ms;
    int values[STEPS_N], count;
} frame_t;

static const char *line_end(const char *text)
{
    const char *end = strchr(text, '\n');

    TEST_ASSERT_NOT_NULL(end);
    return end;
}

static const char *read_blocks(const char *at, int width, frame_t *frame)
{
    static char data[3 * STEPS_N];
    size_t length = 0;

    while (*at != '\n') {
        const char *end = line_end(at);
        size_t block = (size_t)(end - at) - 1;
        TEST_ASSERT_TRUE(block >= 1 && block <= 64);
        TEST_ASSERT_TRUE_MESSAGE(length % 64 == 0, "a short block that is not the last");
        check_sum(at, block, end[-1]);
        memcpy(data + length, at, block);
        length += block;
        at = end + 1;
    }
    TEST_ASSERT_EQUAL_UINT(0, length % (size_t)width);
    frame->count = (int)length / width;
    for (int i = 0; i < frame->count; i++) {
        frame->values[i] = (int)digits64(data + i * width, width);
    }
    return at + 1;
}

/* One data frame that begins at `at`. */
static frame_t read_frame(const char *at, const char *status)
{
    frame_t frame;
    const char *end = line_end(at);
    int width = at[1] == 'D' ? 3 : 2;

    TEST_ASSERT_TRUE((size_t)(end - at) < sizeof frame.echo);
    memset(frame.echo, 0, sizeof frame.echo);
    memcpy(frame.echo, at, (size_t)(end - at));
    at = end + 1;
    TEST_ASSERT_EQUAL_STRING_LEN(status, at, 4);
    at += 4;
    check_sum(at, 4, at[4]);
    frame.time_ms = digits64(at, 4);
    TEST_ASSERT_EQUAL_INT('\n', at[5]);
    frame.end = read_blocks(at + 6, width, &frame);
    return frame;
}

static const char *after_ack(const char *ack)
{
    TEST_ASSERT_EQUAL_STRING_LEN(ack, heard.text, strlen(ack));
    return heard.text + strlen(ack);
}

/* ---- power and SCIP1.1 ---- */

void test_without_power_and_while_booting_nothing_is_heard_or_counted(void)
{
    urg04lx_power(urg, false);
    host("QT\n");
    urg04lx_power(urg, true);
    TEST_ASSERT_TRUE(urg04lx_state(urg).powered);
    TEST_ASSERT_FALSE(urg04lx_state(urg).laser_on);
    host("V\nL0\n");
    run_for(SIM_S);
    expect("");
    TEST_ASSERT_EQUAL_UINT(0, urg04lx_state(urg).commands);
    TEST_ASSERT_EQUAL_UINT(0, urg04lx_state(urg).octets_mismatched);
    ask("L0\n", "L0\n0\n\n");
}

void test_the_boot_time_is_exact(void)
{
    urg04lx_power(urg, false);
    urg04lx_power(urg, true);
    run_for(config.boot - 1);
    TEST_ASSERT_FALSE(urg04lx_state(urg).laser_on);
    run_for(1);
    TEST_ASSERT_TRUE(urg04lx_state(urg).laser_on);
    TEST_ASSERT_FALSE(urg04lx_state(urg).scip2);
    TEST_ASSERT_EQUAL_DOUBLE(115200.0, urg04lx_state(urg).rate);
}

void test_switching_on_what_is_on_does_not_restart_it(void)
{
    ask("SCIP2.0\n", "SCIP2.0\n0\n\n");
    urg04lx_power(urg, true);
    TEST_ASSERT_TRUE(urg04lx_state(urg).scip2);
    ask("QT\n", "QT\n00P\n\n");
}

void test_a_silent_sensor_leaves_the_timeline_empty(void)
{
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
    ask("SCIP2.0\n", "SCIP2.0\n0\n\n");
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
}

void test_scip1_laser_switch(void)
{
    ask("L1\n", "L1\n2\n\n");
    ask("L0\n", "L0\n0\n\n");
    TEST_ASSERT_FALSE(urg04lx_state(urg).laser_on);
    ask("L0\n", "L0\n0\n\n");
    ask("L1\n", "L1\n0\n\n");
    TEST_ASSERT_TRUE(urg04lx_state(urg).laser_on);
    TEST_ASSERT_EQUAL_UINT(4, urg04lx_state(urg).commands);
    TEST_ASSERT_EQUAL_UINT(1, urg04lx_state(urg).refused);
}

/* 206 octets on firmware 3.1.04. */
void test_scip1_version(void)
{
    ask("V\n", "V\n0\nVEND:Hokuyo Automatic Co.,Ltd.\nPROD:SOKUIKI Sensor URG-04LX\n"
               "FIRM:3.1.04,07/08/02(20-4095[mm],240[deg],44-725[step],600[rpm])\nPROT:00003,(SCIP 1.0)\n"
               "SERI:H0706400\nSTAT:FW Normal[FinalDist with shadow  ]\n\n");
    TEST_ASSERT_EQUAL_UINT(206, heard.count);
}

void test_scip1_refuses_what_it_does_not_know_with_an_E(void)
{
    static const char *const unknown[] = {
        "QT",
        "VV",
        "RS;",
        "RS",
        "BM",
        "SCIP2.1",
        "SCIP2.0 ",
        "scip2.0",
        "L2",
        "L",
        "L00",
        "V1",
        "S115200",
        "S115201.......",
        "SABCDEF.......",
        "S115200......",
        "S038400.......",
        "G0000010",
        "G000769010",
        "G38403840",
        "G00076901",
        "G38438300",
        "G0a038401",
        "G0000x001",
        "G0000000-",
        "X",
        "MS0372040601000",
    };
    unsigned refused_n = 0;
    char command[40], reply[48];

    for (size_t i = 0; i < sizeof unknown / sizeof unknown[0]; i++) {
        snprintf(command, sizeof command, "%s\n", unknown[i]);
        snprintf(reply, sizeof reply, "%s\nE\n\n", unknown[i]);
        ask(command, reply);
        TEST_ASSERT_EQUAL_UINT(++refused_n, urg04lx_state(urg).refused);
    }
    ask("RS;\n", "RS;\nE\n\n");
    TEST_ASSERT_EQUAL_UINT(7, heard.count);
    TEST_ASSERT_FALSE(urg04lx_state(urg).scip2);
}

void test_scip1_scan_without_the_laser_is_6(void)
{
    ask("L0\n", "L0\n0\n\n");
    ask("G04472501\n", "G04472501\n6\n\n");
    TEST_ASSERT_EQUAL_UINT(0, world_calls);
}

/* 12 + 2n + ceil(2n/64) + 1 */
static void check_scip1_scan(int first, int last, int cluster)
{
    char command[16], reply[16];
    int width = cluster > 0 ? cluster : 1;
    int n = (last - first + width) / width, at = 12;

    snprintf(command, sizeof command, "G%03d%03d%02d\n", first, last, cluster);
    snprintf(reply, sizeof reply, "G%03d%03d%02d\n0\n", first, last, cluster);
    forget();
    host(command);
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_UINT(12 + 2 * n + (2 * n + 63) / 64 + 1, heard.count);
    TEST_ASSERT_EQUAL_STRING_LEN(reply, heard.text, 12);
    for (int i = 0; i < n; i++) {
        int step = first + i * width;
        TEST_ASSERT_EQUAL_INT(step < 44 || step > 725 ? 19 : world_mm[step], digits64(heard.text + at, 2));
        at += 2;
        if (i % 32 == 31 || i == n - 1) {
            TEST_ASSERT_EQUAL_INT('\n', heard.text[at++]);
        }
    }
    TEST_ASSERT_EQUAL_STRING("\n", heard.text + at);
}

void test_scip1_scan_has_blocks_without_sums(void)
{
    check_scip1_scan(384, 384, 1);
    check_scip1_scan(372, 406, 1);
    check_scip1_scan(100, 131, 1);
    check_scip1_scan(100, 132, 0);
    check_scip1_scan(100, 163, 1);
    check_scip1_scan(44, 725, 1);
    check_scip1_scan(60, 725, 3);
}

void test_scip1_says_16_beyond_its_4095_mm(void)
{
    world_mm[384] = 4095;
    world_mm[385] = 4096;
    world_mm[386] = 5242;
    world_mm[387] = 7;
    ask("G38438701\n", "G38438701\n0\noo0@0@07\n\n");
}

void test_scip1_rate_changes_after_the_reply(void)
{
    ask("S250000.......\n", "S250000.......\n0\n\n");
    TEST_ASSERT_EQUAL_DOUBLE(250000.0, urg04lx_state(urg).rate);
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 8680.6, heard.bit_ns[heard.count - 1]);
    ask("L0\n", "");
    host_rate = 250000.0;
    ask("L0\n", "L0\n0\n\n");
    TEST_ASSERT_EQUAL_DOUBLE(4000.0, heard.bit_ns[0]);
    ask("S250000.......\n", "S250000.......\n0\n\n");
    TEST_ASSERT_EQUAL_DOUBLE(250000.0, urg04lx_state(urg).rate);
}

/* ---- the switch ---- */

void test_the_switch_is_acknowledged_with_11_octets_and_turns_the_laser_off(void)
{
    TEST_ASSERT_TRUE(urg04lx_state(urg).laser_on);
    ask("SCIP2.0\n", "SCIP2.0\n0\n\n");
    TEST_ASSERT_EQUAL_UINT(11, heard.count);
    TEST_ASSERT_TRUE(urg04lx_state(urg).scip2);
    TEST_ASSERT_FALSE(urg04lx_state(urg).laser_on);
}

void test_a_second_switch_is_an_undefined_command_of_13_octets(void)
{
    create_scip2();
    ask("SCIP2.0\n", "SCIP2.0\n0Ee\n\n");
    TEST_ASSERT_EQUAL_UINT(13, heard.count);
    TEST_ASSERT_TRUE(urg04lx_state(urg).scip2);
}

void test_the_first_octet_of_a_reply_ends_one_latency_and_one_octet_behind_the_line_feed(void)
{
    static const sim_time_t latencies[] = {0, 950 * SIM_US, 8 * SIM_MS, 110 * SIM_MS};

    for (size_t i = 0; i < sizeof latencies / sizeof latencies[0]; i++) {
        config.latency = latencies[i];
        create();
        host("SCIP2.0\n");
        sim_time_t sent = timeline_now();
        run_for(SIM_S);
        expect("SCIP2.0\n0\n\n");
        for (size_t octet = 0; octet < 11; octet++) { /* 10 / 115200 s = 86805.56 ns */
            TEST_ASSERT_EQUAL_INT64(sent + latencies[i] + (sim_time_t)(octet + 1) * 86806, heard.at[octet]);
        }
    }
}

void test_the_factory_sensor_speaks_at_19200(void)
{
    config.power_up_rate = 19200.0;
    create();
    ask("SCIP2.0\n", "SCIP2.0\n0\n\n");
    TEST_ASSERT_EQUAL_INT64(520833, heard.at[1] - heard.at[0]);
    host_rate = 115200.0;
    ask("QT\n", "");
    TEST_ASSERT_EQUAL_UINT(3, urg04lx_state(urg).octets_mismatched);
}

/* ---- information ---- */

void test_vv_is_132_octets_as_the_sensor_sends_it(void)
{
    create_scip2();
    ask("VV\n", "VV\n00P\nVEND:Hokuyo Automatic Co.,Ltd.;[\nPROD:SOKUIKI Sensor URG-04LX;[\n"
                "FIRM:3.1.04(02/Aug./2007);a\nPROT:SCIP 2.0;N\nSERI:H0706400;F\n\n");
    TEST_ASSERT_EQUAL_UINT(132, heard.count);
}

void test_pp_is_128_octets_as_the_sensor_sends_it(void)
{
    create_scip2();
    ask("PP\n", "PP\n00P\nMODL:URG-04LX(Hokuyo Automatic "
                "Co.,Ltd.);N\nDMIN:20;4\nDMAX:5600;_\nARES:1024;\\\nAMIN:44;7\n"
                "AMAX:725;o\nAFRT:384;6\nSCAN:600;e\n\n");
    TEST_ASSERT_EQUAL_UINT(128, heard.count);
}

/* Sent at 19200: 00173B ms is the answer's instant, pinned sum V; 0036C8 has ]. */
static void check_ii(sim_time_t clock, const char *time_line)
{
    char reply[300];

    config.power_up_rate = 19200.0;
    config.latency = 0;
    create_scip2();
    forget();
    run_until(clock - 3 * 520833);
    host("II\n");
    run_for(SIM_S);
    snprintf(reply, sizeof reply,
             "II\n00P\nMODL:URG-04LX(Hokuyo Automatic Co.,Ltd.);N\nLASR:OFF;7\n"
             "SCSP:Initial(600[rpm])<-Default setting by user;A\nMESM:IDLE;:\n"
             "SBPS:19200[bps]<-Default setting by user;A\n%s\nSTAT:Sensor works well.;8\n\n",
             time_line);
    expect(reply);
    TEST_ASSERT_EQUAL_UINT(207, heard.count);
}

void test_ii_is_207_octets_as_the_sensor_sends_it(void)
{
    check_ii(0x173B * SIM_MS + 900, "TIME:00173B;V");
    check_ii(0x36C8 * SIM_MS + SIM_MS - 1, "TIME:0036C8;]");
    check_ii(0x2AA9 * SIM_MS + 500 * SIM_US, "TIME:002AA9;f");
}

void test_ii_tells_that_the_laser_is_on_in_209_octets(void)
{
    config.power_up_rate = 19200.0;
    create_scip2();
    ask("BM\n", "BM\n00P\n\n");
    forget();
    host("II\n");
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_UINT(209, heard.count);
    TEST_ASSERT_NOT_NULL(strstr(heard.text, "\nLASR:ON;9\n"));
    TEST_ASSERT_NOT_NULL(strstr(heard.text, "\nMESM:CLASSIC;^\n"));
}

/* ---- statuses ---- */

void test_bm_qt_and_their_statuses(void)
{
    create_scip2();
    ask("QT\n", "QT\n00P\n\n");
    ask("BM\n", "BM\n00P\n\n");
    TEST_ASSERT_TRUE(urg04lx_state(urg).laser_on);
    ask("BM\n", "BM\n02R\n\n");
    TEST_ASSERT_TRUE(urg04lx_state(urg).laser_on);
    ask("QT\n", "QT\n00P\n\n");
    TEST_ASSERT_FALSE(urg04lx_state(urg).laser_on);
    ask("QT\n", "QT\n00P\n\n");
    ask("BM\n", "BM\n00P\n\n");
}

void test_every_status_of_ss(void)
{
    create_scip2();
    ask("SS115200\n", "SS115200\n03S\n\n");
    ask("SS11520x\n", "SS11520x\n01Q\n\n");
    ask("SS 19200\n", "SS 19200\n01Q\n\n");
    ask("SS115201\n", "SS115201\n02R\n\n");
    ask("SS009600\n", "SS009600\n02R\n\n");
    ask("SS000000\n", "SS000000\n02R\n\n");
    ask("SS038400\n", "SS038400\n04T\n\n");
    ask("SS19200\n", "SS19200\n0Cc\n\n");
    ask("SS0019200\n", "SS0019200\n0Dd\n\n");
    TEST_ASSERT_EQUAL_DOUBLE(115200.0, urg04lx_state(urg).rate);
    TEST_ASSERT_EQUAL_UINT(9, urg04lx_state(urg).refused);
}

void test_every_rate_of_ss_from_every_other(void)
{
    static const int rates[] = {19200,  57600, 250000, 500000, 750000, 115200,
                                750000, 19200, 250000, 57600,  115200};
    char command[16], reply[24];

    create_scip2();
    for (size_t i = 0; i < sizeof rates / sizeof rates[0]; i++) {
        snprintf(command, sizeof command, "SS%06d\n", rates[i]);
        snprintf(reply, sizeof reply, "SS%06d\n00P\n\n", rates[i]);
        ask(command, reply);
        TEST_ASSERT_EQUAL_UINT(14, heard.count);
        TEST_ASSERT_DOUBLE_WITHIN(0.06, 1e9 / host_rate, heard.bit_ns[13]);
        host_rate = rates[i];
        TEST_ASSERT_EQUAL_DOUBLE(host_rate, urg04lx_state(urg).rate);
        ask("QT\n", "QT\n00P\n\n");
        TEST_ASSERT_DOUBLE_WITHIN(0.06, 1e9 / host_rate, heard.bit_ns[0]);
    }
    TEST_ASSERT_EQUAL_UINT(0, urg04lx_state(urg).octets_mismatched);
}

void test_every_status_of_cr_and_hs(void)
{
    create_scip2();
    ask("CR00\n", "CR00\n03S\n\n");
    ask("CR99\n", "CR99\n00P\n\n");
    ask("CR01\n", "CR01\n04T\n\n");
    ask("CR10\n", "CR10\n04T\n\n");
    ask("CR11\n", "CR11\n02R\n\n");
    ask("CR98\n", "CR98\n02R\n\n");
    ask("CRx0\n", "CRx0\n01Q\n\n");
    ask("HS0\n", "HS0\n0Cc\n\n");
    ask("HS1\n", "HS1\n0Cc\n\n");
}

void test_every_status_of_time_mode(void)
{
    create_scip2();
    ask("TM1\n", "TM1\n04T\n\n");
    ask("TM2\n", "TM2\n03S\n\n");
    ask("TM3\n", "TM3\n01Q\n\n");
    ask("TMx\n", "TMx\n01Q\n\n");
    ask("BM\n", "BM\n00P\n\n");
    ask("TM0\n", "TM0\n00P\n\n");
    TEST_ASSERT_TRUE(urg04lx_state(urg).time_mode);
    TEST_ASSERT_FALSE(urg04lx_state(urg).laser_on);
    ask("TM0\n", "TM0\n02R\n\n");
    ask("TM9\n", "TM9\n01Q\n\n");
    ask("TM2\n", "TM2\n00P\n\n");
    TEST_ASSERT_FALSE(urg04lx_state(urg).time_mode);
    ask("QT\n", "QT\n00P\n\n");
}

void test_time_mode_refuses_all_other_commands_and_still_tells_malformed_ones(void)
{
    create_scip2();
    ask("TM0\n", "TM0\n00P\n\n");
    ask("QT\n", "QT\n0Ee\n\n");
    ask("RS\n", "RS\n0Ee\n\n");
    ask("VV\n", "VV\n0Ee\n\n");
    ask("BM\n", "BM\n0Ee\n\n");
    ask("SS250000\n", "SS250000\n0Ee\n\n");
    ask("MS0372040601000\n", "MS0372040601000\n0Ee\n\n");
    ask("SCIP2.0\n", "SCIP2.0\n0Ee\n\n");
    ask("QT1\n", "QT1\n0Dd\n\n");
    ask("TM\n", "TM\n0Cc\n\n");
    TEST_ASSERT_TRUE(urg04lx_state(urg).time_mode);
    TEST_ASSERT_FALSE(urg04lx_state(urg).streaming);
}

void test_tm1_tells_the_clock_at_the_answer_in_15_octets(void)
{
    create_scip2();
    ask("TM0\n", "TM0\n00P\n\n");
    forget();
    host("TM1\n");
    sim_time_t answered = timeline_now() + config.latency;
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_UINT(15, heard.count);
    TEST_ASSERT_EQUAL_STRING_LEN("TM1\n00P\n", heard.text, 8);
    TEST_ASSERT_EQUAL_INT64(answered / SIM_MS, digits64(heard.text + 8, 4));
    check_sum(heard.text + 8, 4, heard.text[12]);
    TEST_ASSERT_EQUAL_STRING("\n\n", heard.text + 13);
}

void test_every_refusal_of_ms_and_md_has_21_octets_and_no_scan(void)
{
    static const char *const bad[][2] = {
        {"MSx372040601000", "01Q"}, {"MS037 040601000", "01Q"}, {"MS0372 40601000", "02R"},
        {"MS0372040x01000", "02R"}, {"MS037204060x000", "03S"}, {"MS0372076901000", "04T"},
        {"MS0372999901000", "04T"}, {"MS0406037201000", "05U"}, {"MS0800076801000", "05U"},
        {"MS0372040601x00", "06V"}, {"MS03720406010x0", "07W"}, {"MS037204060100-", "07W"},
        {"MDx372040601000", "01Q"}, {"MD0372076901000", "04T"}, {"MD0406040501000", "05U"},
        {"MD03720406010 1", "07W"},
    };
    char command[24], reply[32];

    create_scip2();
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        snprintf(command, sizeof command, "%s\n", bad[i][0]);
        snprintf(reply, sizeof reply, "%s\n%s\n\n", bad[i][0], bad[i][1]);
        ask(command, reply);
        TEST_ASSERT_EQUAL_UINT(21, heard.count);
        TEST_ASSERT_FALSE(urg04lx_state(urg).streaming);
        TEST_ASSERT_FALSE(urg04lx_state(urg).laser_on);
    }
    TEST_ASSERT_EQUAL_UINT(0, world_calls);
}

void test_every_refusal_of_gs_and_gd_has_18_octets(void)
{
    static const char *const bad[][2] = {
        {"GSx372040601", "01Q"}, {"GS0372x40601", "02R"}, {"GS03720406x1", "03S"}, {"GS0372076901", "04T"},
        {"GS0406037201", "05U"}, {"GDx372040601", "01Q"}, {"GD0372076901", "04T"}, {"GD0406040501", "05U"},
    };
    char command[24], reply[32];

    create_scip2();
    ask("GS0372040601\n", "GS0372040601\n10Q\n\n");
    ask("GD0372040601\n", "GD0372040601\n10Q\n\n");
    TEST_ASSERT_EQUAL_UINT(18, heard.count);
    ask("BM\n", "BM\n00P\n\n");
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        snprintf(command, sizeof command, "%s\n", bad[i][0]);
        snprintf(reply, sizeof reply, "%s\n%s\n\n", bad[i][0], bad[i][1]);
        ask(command, reply);
    }
    TEST_ASSERT_EQUAL_UINT(0, world_calls);
}

/* ---- malformed commands ---- */

void test_malformed_commands_are_told_apart(void)
{
    static const char *const bad[][2] = {
        {"X", "0Dd"},
        {"Q", "0Dd"},
        {";abc", "0Dd"},
        {"XX", "0Ee"},
        {"qt", "0Ee"},
        {"DB00", "0Ee"},
        {" QT", "0Ee"},
        {"QT ", "0Dd"},
        {"QT0", "0Dd"},
        {"CR0", "0Cc"},
        {"CR", "0Cc"},
        {"CR000", "0Dd"},
        {"MS037204060100", "0Cc"},
        {"MS03720406010000", "0Dd"},
        {"MS", "0Cc"},
        {"GS037204060", "0Cc"},
        {"GD03720406010", "0Dd"},
        {"TM", "0Cc"},
        {"TM00", "0Dd"},
        {"HS", "0Cc"},
        {"Q$", "0Hh"},
        {"QT$", "0Hh"},
        {"QT;a$", "0Hh"},
        {"Q\t", "0Hh"},
        {"QT\x7f", "0Hh"},
        {"QT\x80", "0Hh"},
        {"\xff\xffQT", "0Hh"},
        {"QT;", "0Cc"},
        {"QT;abc-def", "0Hh"},
        {"QT;a;b", "0Hh"},
        {"QT;12345678901234567", "0Gg"},
        {"MS0372040601000;12345678901234567", "0Gg"},
        {"MS0372040601000;a,b", "0Hh"},
        {"QT012345678901234567890123456789012345678901234567890123456789", "0Dd"},
    };
    char command[100], reply[110];

    create_scip2();
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        snprintf(command, sizeof command, "%s\n", bad[i][0]);
        snprintf(reply, sizeof reply, "%s\n%s\n\n", bad[i][0], bad[i][1]);
        ask(command, reply);
        TEST_ASSERT_EQUAL_UINT(i + 1, urg04lx_state(urg).refused);
    }
    ask("QT\n", "QT\n00P\n\n");
    TEST_ASSERT_EQUAL_UINT(0, world_calls);
}

void test_a_nul_octet_does_not_hide_behind_a_good_command(void)
{
    forget();
    host_octets("L0\0\n", 4);
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_UINT(7, heard.count);
    TEST_ASSERT_EQUAL_MEMORY("L0\0\nE\n\n", heard.text, 7);
    create_scip2();
    forget();
    host_octets("BM\0\n", 4);
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_UINT(9, heard.count);
    TEST_ASSERT_EQUAL_MEMORY("BM\0\n0Hh\n\n", heard.text, 9);
}

void test_an_endless_line_is_refused_once_and_then_all_is_well(void)
{
    create_scip2();
    forget();
    for (int i = 0; i < 500; i++) {
        host("MS03720406");
    }
    run_for(SIM_S);
    expect("");
    forget();
    host("\n");
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_STRING_LEN("MS03720406MS03720406", heard.text, 20);
    TEST_ASSERT_NOT_NULL(strstr(heard.text, "\n0Dd\n\n"));
    TEST_ASSERT_EQUAL_UINT(80 + 6, heard.count);
    ask("QT\n", "QT\n00P\n\n");
}

void test_without_a_terminator_there_is_no_answer(void)
{
    create_scip2();
    ask("QT", "");
    ask("\n", "QT\n00P\n\n");
}

void test_empty_lines_are_silent(void)
{
    ask("\n\r\n\n", "");
    create_scip2();
    ask("\n\r\n\n\r\r", "");
    TEST_ASSERT_EQUAL_UINT(1, urg04lx_state(urg).commands);
}

void test_commands_end_with_a_line_feed_a_carriage_return_or_both(void)
{
    ask("L0\r", "L0\n0\n\n");
    ask("L0\r\n", "L0\n0\n\n");
    create_scip2();
    ask("QT\r", "QT\n00P\n\n");
    ask("QT\r\n", "QT\n00P\n\n");
    ask("QT\n\r", "QT\n00P\n\n");
}

void test_a_string_is_repeated_with_its_semicolon(void)
{
    create_scip2();
    ask("QT;a\n", "QT;a\n00P\n\n");
    ask("QT;aZ09 ._+@\n", "QT;aZ09 ._+@\n00P\n\n");
    ask("QT;1234567890123456\n", "QT;1234567890123456\n00P\n\n");
    ask("SS115200;x y\n", "SS115200;x y\n03S\n\n");
    forget();
    host("MS0384038401001;scan@1\n");
    run_for(SIM_S);
    const char *at = after_ack("MS0384038401001;scan@1\n00P\n\n");
    frame_t frame = read_frame(at, "99b\n");
    TEST_ASSERT_EQUAL_STRING("MS0384038401000;scan@1", frame.echo);
    TEST_ASSERT_EQUAL_INT(31 + 7, frame.end - at);
    TEST_ASSERT_EQUAL_STRING("", frame.end);
}

/* ---- queue ---- */

void test_queued_commands_are_answered_in_order_one_latency_apart(void)
{
    create_scip2();
    forget();
    host("BM\nCR00\nQT\nSS115200\n");
    run_for(SIM_S);
    expect("BM\n00P\n\nCR00\n03S\n\nQT\n00P\n\nSS115200\n03S\n\n");
    TEST_ASSERT_EQUAL_INT64(config.latency, heard.at[8] - heard.at[0]);
    TEST_ASSERT_EQUAL_INT64(config.latency, heard.at[18] - heard.at[8]);
}

void test_the_same_symbol_right_behind_itself_is_answered_once(void)
{
    create_scip2();
    ask("QT\nQT\n", "QT\n00P\n\nQT\n0Bb\n\n");
    ask("QT\nQT\nQT\nBM\nQT\n", "QT\n00P\n\nQT\n0Bb\n\nQT\n0Bb\n\nBM\n00P\n\nQT\n00P\n\n");
    ask("QT\n", "QT\n00P\n\n");
    ask("QT\n", "QT\n00P\n\n");
}

void test_a_repeated_scan_command_is_refused_until_the_first_is_answered(void)
{
    create_scip2();
    ask("BM\n", "BM\n00P\n\n");
    forget();
    host("GS0384038401\n");
    run_for(20 * SIM_MS);
    host("GS0384038401\n");
    run_for(SIM_S);
    frame_t frame = read_frame(heard.text, "00P\n");
    TEST_ASSERT_EQUAL_STRING("GS0384038401\n0Bb\n\n", frame.end);
}

void test_the_switch_twice_in_one_breath_is_answered_in_both_protocols(void)
{
    ask("SCIP2.0\nSCIP2.0\n", "SCIP2.0\n0\n\nSCIP2.0\n0Ee\n\n");
}

void test_a_flood_of_commands_loses_some_and_harms_nothing(void)
{
    create_scip2();
    forget();
    for (int i = 0; i < 100; i++) {
        host(i % 2 == 0 ? "QT\n" : "BM\n");
    }
    run_for(5 * SIM_S);
    TEST_ASSERT_EQUAL_STRING_LEN("QT\n00P\n\nBM\n00P\n\nQT\n00P\n\n", heard.text, 24);
    TEST_ASSERT_TRUE(heard.count < 8 * 100);
    TEST_ASSERT_EQUAL_UINT(0, heard.count % 8);
    ask("QT\n", "QT\n00P\n\n");
}

/* ---- rates ---- */

void test_ss_is_answered_at_the_old_rate_and_frames_follow_at_the_new_one(void)
{
    create_scip2();
    run_until(SIM_S);
    forget();
    host("SS250000\n");
    sim_time_t sent = timeline_now();
    sim_time_t left = sent + 8 * SIM_MS + 14 * 86806;
    TEST_ASSERT_EQUAL_INT64(SIM_S + 9 * 86805, sent);
    run_until(left - 1);
    TEST_ASSERT_EQUAL_UINT(13, heard.count);
    TEST_ASSERT_EQUAL_DOUBLE(115200.0, urg04lx_state(urg).rate);
    run_until(left);
    expect("SS250000\n00P\n\n");
    TEST_ASSERT_EQUAL_DOUBLE(250000.0, urg04lx_state(urg).rate);
    for (size_t i = 0; i < 14; i++) {
        TEST_ASSERT_EQUAL_INT64(sent + 8 * SIM_MS + (sim_time_t)(i + 1) * 86806, heard.at[i]);
        TEST_ASSERT_DOUBLE_WITHIN(0.1, 8680.6, heard.bit_ns[i]);
    }
    host_rate = 250000.0;
    forget();
    host("MS0372040601000\n");
    sent = timeline_now();
    run_until(1250 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT(21 + 101, heard.count);
    for (size_t i = 0; i < 21; i++) {
        TEST_ASSERT_EQUAL_INT64(sent + 8 * SIM_MS + (sim_time_t)(i + 1) * 40000, heard.at[i]);
    }
    for (size_t i = 0; i < 101; i++) { /* the revolution of 1.1 .. 1.2 s */
        TEST_ASSERT_EQUAL_INT64(1200 * SIM_MS + (sim_time_t)(i + 1) * 40000, heard.at[21 + i]);
        TEST_ASSERT_EQUAL_DOUBLE(4000.0, heard.bit_ns[21 + i]);
    }
}

void test_a_command_queued_behind_ss_is_answered_at_the_new_rate(void)
{
    create_scip2();
    ask("SS250000\nQT\n", "SS250000\n00P\n\nQT\n00P\n\n");
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 8680.6, heard.bit_ns[13]);
    for (size_t i = 14; i < 22; i++) {
        TEST_ASSERT_EQUAL_DOUBLE(4000.0, heard.bit_ns[i]);
    }
}

void test_a_command_behind_ss_waits_until_the_rate_has_changed(void)
{
    config.latency = 0;
    create_scip2();
    run_until(SIM_S);
    forget();
    host("SS019200\nBM\n"); /* the last three octets take 0.26 ms, the reply to SS 1.2 ms */
    run_for(SIM_S);
    expect("SS019200\n00P\n\nBM\n00P\n\n");
    TEST_ASSERT_DOUBLE_WITHIN(0.1, 8680.6, heard.bit_ns[13]);
    TEST_ASSERT_EQUAL_INT64(heard.at[13] + 520833, heard.at[14]);
}

void test_octets_at_another_rate_are_counted_and_ignored(void)
{
    create_scip2();
    ask("SS250000\n", "SS250000\n00P\n\n");
    ask("QT\n", "");
    TEST_ASSERT_EQUAL_UINT(3, urg04lx_state(urg).octets_mismatched);
    host_rate = 57600.0;
    ask("SCIP2.0\n", "");
    TEST_ASSERT_EQUAL_UINT(11, urg04lx_state(urg).octets_mismatched);
    host_rate = 250000.0;
    ask("QT\n", "QT\n00P\n\n");
    TEST_ASSERT_EQUAL_UINT(11, urg04lx_state(urg).octets_mismatched);
}

void test_a_real_divider_is_close_enough_and_a_wrong_one_is_not(void)
{
    create_scip2();
    host_rate = 115200.0 * 1.02;
    ask("QT\n", "QT\n00P\n\n");
    host_rate = 115200.0 * 0.98;
    ask("QT\n", "QT\n00P\n\n");
    host_rate = 115200.0 * 1.06;
    ask("QT\n", "");
    host_rate = 115200.0 * 0.94;
    ask("QT\n", "");
    TEST_ASSERT_EQUAL_UINT(6, urg04lx_state(urg).octets_mismatched);
}

void test_rs_falls_back_to_the_power_up_rate_after_its_reply(void)
{
    create_scip2();
    ask("SS250000\n", "SS250000\n00P\n\n");
    host_rate = 250000.0;
    ask("BM\n", "BM\n00P\n\n");
    ask("RS\n", "RS\n00P\n\n");
    for (size_t i = 0; i < 8; i++) {
        TEST_ASSERT_EQUAL_DOUBLE(4000.0, heard.bit_ns[i]);
    }
    TEST_ASSERT_EQUAL_DOUBLE(115200.0, urg04lx_state(urg).rate);
    TEST_ASSERT_FALSE(urg04lx_state(urg).laser_on);
    TEST_ASSERT_TRUE(urg04lx_state(urg).scip2);
    ask("QT\n", "");
    host_rate = 115200.0;
    ask("QT\n", "QT\n00P\n\n");
}

void test_rs_sets_the_clock_to_zero(void)
{
    create_scip2();
    run_until(50 * SIM_S);
    forget();
    host("RS\nTM0\n");
    run_for(SIM_S);
    expect("RS\n00P\n\nTM0\n00P\n\n");
    sim_time_t zero = heard.at[0] - 86806;
    forget();
    host("TM1\n");
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_INT64((heard.at[0] - 86806 - zero) / SIM_MS, digits64(heard.text + 8, 4));
}

void test_rs_stops_a_stream(void)
{
    create_scip2();
    host("MS0372040601000\n");
    run_for(SIM_S);
    host("RS\n");
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_STRING("RS\n00P\n\n", heard.text + heard.count - 8);
    TEST_ASSERT_FALSE(urg04lx_state(urg).streaming);
    ask("QT\n", "QT\n00P\n\n");
}

void test_ss_during_a_stream_changes_the_rate_between_frames(void)
{
    create_scip2();
    host("MS0372040601000\n");
    run_until(2303 * SIM_MS); /* a frame of 8.8 ms is on the line when the command is handled */
    forget();
    run_until(2395 * SIM_MS);
    host("SS250000\n");
    forget();
    host_rate = 250000.0;
    run_until(2750 * SIM_MS);
    frame_t frame = read_frame(heard.text, "99b\n");
    TEST_ASSERT_EQUAL_STRING_LEN("SS250000\n00P\n\n", frame.end, 14);
    const char *next = frame.end + 14;
    for (const char *octet = heard.text; octet < next; octet++) {
        TEST_ASSERT_DOUBLE_WITHIN(0.1, 8680.6, heard.bit_ns[octet - heard.text]);
    }
    for (int i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_DOUBLE(4000.0, heard.bit_ns[next - heard.text]);
        frame = read_frame(next, "99b\n");
        next = frame.end;
    }
    TEST_ASSERT_EQUAL_STRING("", next);
}

/* ---- lengths and contents ---- */

/* 27 + kn + 2 ceil(kn/64) for M, 24 + ... for G; n, expected lengths of MS, MD, GS, GD worked out by hand. */
void test_lengths_of_the_table_in_the_documents(void)
{
    static const int table[][5] = {
        {1, 31, 32, 28, 29},           {21, 71, 92, 68, 89},          {22, 73, 97, 70, 94},
        {31, 91, 124, 88, 121},        {32, 93, 127, 90, 124},        {33, 97, 130, 94, 127},
        {35, 101, 136, 98, 133},       {64, 159, 225, 156, 222},      {65, 163, 230, 160, 227},
        {271, 587, 866, 584, 863},     {677, 1425, 2122, 1422, 2119}, {682, 1435, 2137, 1432, 2134},
        {769, 1615, 2408, 1612, 2405},
    };
    static const char *const verbs[] = {"MS", "MD", "GS", "GD"};
    char command[24];

    create_scip2();
    for (size_t row = 0; row < sizeof table / sizeof table[0]; row++) {
        for (int verb = 0; verb < 4; verb++) {
            ask("QT\n", "QT\n00P\n\n");
            ask("BM\n", "BM\n00P\n\n");
            forget();
            snprintf(command, sizeof command, "%s0000%04d01%s\n", verbs[verb], table[row][0] - 1,
                     verb < 2 ? "001" : "");
            host(command);
            run_for(SIM_S);
            TEST_ASSERT_EQUAL_UINT_MESSAGE(table[row][1 + verb] + (verb < 2 ? 21 : 0), heard.count, command);
        }
    }
}

static void check_values(const frame_t *frame, int first, int last, int cluster, int limit)
{
    TEST_ASSERT_EQUAL_INT((last - first) / cluster + 1, frame->count);
    for (int i = 0; i < frame->count; i++) {
        int from = first + i * cluster, best = -1;
        int lead = from < 44 || from > 725 ? 19 : world_mm[from];
        for (int step = from; step < from + cluster && step <= last; step++) {
            int mm = step < 44 || step > 725 ? 19 : world_mm[step];
            if (mm >= 20 && (best < 0 || mm < best)) {
                best = mm;
            }
        }
        best = best < 0 ? lead : best;
        TEST_ASSERT_EQUAL_INT(best > limit ? limit : best, frame->values[i]);
    }
}

void test_distances_come_back_from_any_range_and_cluster(void)
{
    const unsigned seed = 20240u;
    char command[24], note[64];

    printf("seed %u\n", seed);
    srand(seed);
    create_scip2();
    ask("SS750000\n", "SS750000\n00P\n\n");
    host_rate = 750000.0;
    for (int round = 0; round < 300; round++) {
        int first = rand() % STEPS_N, last = first + rand() % (STEPS_N - first);
        int cluster = rand() % 3 == 0 ? rand() % 100 : rand() % 4;
        int wide = rand() % 2, single = rand() % 2, used = cluster > 1 ? cluster : 1;
        for (int step = 0; step < STEPS_N; step++) {
            world_mm[step] = rand() % 8 == 0 ? rand() % 20 : rand() % 5601;
        }
        host("BM\n");
        run_for(20 * SIM_MS);
        forget();
        snprintf(command, sizeof command, "%c%c%04d%04d%02d%s\n", single ? 'G' : 'M', wide ? 'D' : 'S', first,
                 last, cluster, single ? "" : "001");
        snprintf(note, sizeof note, "round %d: %s", round, command);
        host(command);
        run_for(320 * SIM_MS);
        const char *at = single ? heard.text : heard.text + 21;
        frame_t frame = read_frame(at, single ? "00P\n" : "99b\n");
        int k = wide ? 3 : 2, n = (last - first) / used + 1;
        TEST_ASSERT_EQUAL_INT_MESSAGE((single ? 24 : 27) + k * n + 2 * ((k * n + 63) / 64), frame.end - at,
                                      note);
        check_values(&frame, first, last, used, wide ? 262143 : 4095);
        TEST_ASSERT_EQUAL_INT(first, world_first);
        TEST_ASSERT_EQUAL_INT(last, world_last);
    }
}

/* 547 steps by two: the last one fills no cluster. */
void test_steps_that_fill_no_cluster_make_a_point_or_none(void)
{
    for (unsigned down = 0; down < 2; down++) {
        config.rounds_down = down == 1;
        create_scip2();
        ask("SS250000\n", "SS250000\n00P\n\n");
        host_rate = 250000.0;
        forget();
        host("MS0111065702001\n");
        run_for(320 * SIM_MS);
        const char *at = heard.text + 21;
        frame_t frame = read_frame(at, "99b\n");
        TEST_ASSERT_EQUAL_INT(down == 1 ? 273 : 274, frame.count);
        TEST_ASSERT_EQUAL_INT(27 + 2 * frame.count + 2 * 9, frame.end - at);
        check_values(&frame, 111, down == 1 ? 656 : 657, 2, 4095);
        urg04lx_destroy(urg);
        urg = NULL;
    }
}

/* Frames worked out by hand from the coding rules; small times lie behind the wrap of the 24-bit clock. */
static void check_pinned(sim_time_t phase_ms, sim_time_t turn_ms, const char *command, const char *frame,
                         const char *ack)
{
    config.phase = phase_ms * SIM_MS;
    create_scip2();
    ask("BM\n", "BM\n00P\n\n");
    run_until((turn_ms - 40) * SIM_MS);
    forget();
    host(command);
    run_until((turn_ms + 195) * SIM_MS);
    TEST_ASSERT_EQUAL_STRING_LEN(ack, heard.text, strlen(ack));
    TEST_ASSERT_EQUAL_STRING(frame, heard.text + strlen(ack));
}

void test_pinned_frame_of_one_point(void)
{
    world_mm[384] = 1234;
    check_pinned(17, 16777217, "MS0384038401000\n", "MS0384038401000\n99b\n00011\nCB5\n\n",
                 "MS0384038401000\n00P\n\n");
}

void test_pinned_frame_of_exactly_one_block(void)
{
    for (int i = 0; i < 32; i++) {
        world_mm[369 + i] = 1000 + i;
    }
    check_pinned(
        15, 16777215, "MS0369040001000\n",
        "MS0369040001000\n99b\nooool\n?X?Y?Z?[?\\?]?^?_?`?a?b?c?d?e?f?g?h?i?j?k?l?m?n?o@0@1@2@3@4@5@6@7H\n\n",
        "MS0369040001000\n00P\n\n");
}

void test_pinned_frame_of_35_points_in_64_and_6_characters(void)
{
    for (int i = 0; i < 35; i++) {
        world_mm[372 + i] = 20 + 100 * i;
    }
    check_pinned(
        0, 16000000, "MS0372040601000\n",
        "MS0372040601000\n99b\nm2@0?\n0D1h3L506T889\\;@<d>H?lAPC4DXF<G`IDJhLLN0OTQ8R\\T@UdWHXlZP\\4]X_<``2\n"
        "bDcheLR\n\n",
        "MS0372040601000\n00P\n\n");
}

void test_pinned_frame_with_a_value_split_over_two_blocks(void)
{
    for (int i = 0; i < 22; i++) {
        world_mm[384 + i] = 5000 + i;
    }
    check_pinned(16, 16777316, "MD0384040501000\n",
                 "MD0384040501000\n99b\n001TU\n"
                 "1>81>91>:1>;1><1>=1>>1>?1>@1>A1>B1>C1>D1>E1>F1>G1>H1>I1>J1>K1>L1f\n>M;\n\n",
                 "MD0384040501000\n00P\n\n");
}

void test_pinned_frame_with_all_codes(void)
{
    for (int i = 0; i <= 20; i++) {
        world_mm[384 + i] = i;
    }
    check_pinned(23, 16777223, "GS0384040401\n",
                 "GS0384040401\n00P\n00077\n000102030405060708090:0;0<0=0>0?0@0A0B0C0Db\n\n", "");
}

void test_two_characters_hold_4095_at_most_and_three_hold_all(void)
{
    world_mm[384] = 4094;
    world_mm[385] = 4095;
    world_mm[386] = 4096;
    world_mm[387] = 5242;
    create_scip2();
    ask("BM\n", "BM\n00P\n\n");
    forget();
    host("GS0384038701\nGD0384038701\n");
    run_for(SIM_S);
    frame_t narrow = read_frame(heard.text, "00P\n");
    frame_t wide = read_frame(narrow.end, "00P\n");
    static const int two[] = {4094, 4095, 4095, 4095}, three[] = {4094, 4095, 4096, 5242};
    TEST_ASSERT_EQUAL_INT(4, narrow.count);
    TEST_ASSERT_EQUAL_INT_ARRAY(two, narrow.values, 4);
    TEST_ASSERT_EQUAL_INT(4, wide.count);
    TEST_ASSERT_EQUAL_INT_ARRAY(three, wide.values, 4);
    TEST_ASSERT_EQUAL_STRING("", wide.end);
}

/* 3059, 3055, 3062 -> 3055 is the specification's example. */
void test_a_cluster_gives_its_smallest_good_value(void)
{
    static const int rays[] = {3059, 3055, 3062, 7, 500, 0, 9, 0, 16, 19, 20, 18, 20, 21, 4000, 4000};
    static const int expected[] = {3055, 500, 9, 20, 20, 4000};

    for (int i = 0; i < 16; i++) {
        world_mm[384 + i] = rays[i];
    }
    create_scip2();
    forget();
    host("MS0384039903001\n");
    run_for(SIM_S);
    frame_t frame = read_frame(after_ack("MS0384039903001\n00P\n\n"), "99b\n");
    TEST_ASSERT_EQUAL_INT(6, frame.count);
    TEST_ASSERT_EQUAL_INT_ARRAY(expected, frame.values, 6);
}

void test_steps_that_the_mirror_cannot_see_are_19(void)
{
    create_scip2();
    ask("BM\n", "BM\n00P\n\n");
    forget();
    host("GS0042004501\n");
    run_for(SIM_S);
    frame_t frame = read_frame(heard.text, "00P\n");
    static const int low[] = {19, 19, 1044, 1045}, high[] = {1724, 1725, 19, 19};
    TEST_ASSERT_EQUAL_INT_ARRAY(low, frame.values, 4);
    forget();
    host("GS0724072701\n");
    run_for(SIM_S);
    frame = read_frame(heard.text, "00P\n");
    TEST_ASSERT_EQUAL_INT_ARRAY(high, frame.values, 4);
}

/* ---- streams ---- */

void test_a_stream_begins_with_the_first_revolution_that_starts_after_the_command(void)
{
    config.phase = 30 * SIM_MS;
    create_scip2();
    run_until(1075 * SIM_MS);
    forget();
    host("MS0372040601000\n");
    sim_time_t handled = timeline_now() + config.latency;
    run_until(1229 * SIM_MS);
    TEST_ASSERT_TRUE(handled > 1030 * SIM_MS && handled < 1130 * SIM_MS);
    expect("MS0372040601000\n00P\n\n");
    TEST_ASSERT_EQUAL_INT64(handled + 86806, heard.at[0]);
    TEST_ASSERT_EQUAL_UINT(1, world_calls);
    TEST_ASSERT_EQUAL_INT64((1130 + 34) * SIM_MS, world_called_at);
    run_until(1250 * SIM_MS);
    TEST_ASSERT_EQUAL_INT64(1230 * SIM_MS + 86806, heard.at[21]);
    frame_t frame = read_frame(heard.text + 21, "99b\n");
    TEST_ASSERT_EQUAL_INT64(1130, frame.time_ms);
    TEST_ASSERT_EQUAL_STRING("MS0372040601000", frame.echo);
    TEST_ASSERT_TRUE(urg04lx_state(urg).streaming);
    TEST_ASSERT_TRUE(urg04lx_state(urg).laser_on);
}

void test_an_endless_stream_sends_one_frame_per_revolution(void)
{
    create_scip2();
    forget();
    host("MS0372040601000\n");
    run_for(30 * SIM_S + 50 * SIM_MS);
    const char *at = after_ack("MS0372040601000\n00P\n\n");
    long time_ms = 0;
    unsigned frames = 0;
    for (; *at != '\0'; frames++) {
        frame_t frame = read_frame(at, "99b\n");
        TEST_ASSERT_EQUAL_STRING("MS0372040601000", frame.echo);
        TEST_ASSERT_TRUE(frames == 0 || frame.time_ms == time_ms + 100);
        TEST_ASSERT_EQUAL_INT64((time_ms = frame.time_ms) + 100, heard.at[at - heard.text] / SIM_MS);
        at = frame.end;
    }
    TEST_ASSERT_UINT_WITHIN(1, 299, frames);
    TEST_ASSERT_EQUAL_UINT(frames, urg04lx_state(urg).scans_sent);
    TEST_ASSERT_EQUAL_UINT(0, urg04lx_state(urg).revolutions_skipped);
}

/* 97.65625 us from step to step, at most two steps from the middle of those that are measured together: the
 * mirrors of the seed's bracket are looked into 25 ms apart. */
void test_each_step_is_measured_as_the_mirror_turns_past_it(void)
{
    config.phase = 30 * SIM_MS;
    create_scip2();
    run_until(1075 * SIM_MS);
    host("MS0044072500001\n");
    run_until(1229 * SIM_MS);
    for (int step = 44; step <= 725; step++) {
        const double due_ms = 1130.0 + 34.0 + (step - 389) * 0.09765625;

        TEST_ASSERT_DOUBLE_WITHIN(0.196, due_ms, (double)step_at[step] * 1e-6);
        TEST_ASSERT_TRUE(step == 44 || step_at[step] >= step_at[step - 1]);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.4, 25.0, (double)(step_at[384] - step_at[128]) * 1e-6);
}

/* Where the front is looked at so early or late that other steps would fall into other revolutions. */
TEST_CASE(0)
TEST_CASE(100)
void test_no_step_is_measured_outside_its_revolution_and_the_mirror_turns_evenly(int front_ms)
{
    config.phase = 30 * SIM_MS;
    config.ray_instant = front_ms * SIM_MS;
    create_scip2();
    run_until(1075 * SIM_MS);
    host("MS0044072500001\n");
    run_until(1400 * SIM_MS);
    for (int step = 44; step <= 725; step++) {
        TEST_ASSERT_TRUE(step_at[step] >= 1130 * SIM_MS && step_at[step] <= 1230 * SIM_MS);
    }
    TEST_ASSERT_DOUBLE_WITHIN(0.4, 50.0, (double)(step_at[640] - step_at[128]) * 1e-6);
}

/* 35 steps in groups of five. */
void test_a_stream_costs_one_event_per_octet_and_eight_per_revolution(void)
{
    create_scip2();
    forget();
    host("MS0372040601000\n");
    instants = 0;
    run_for(10 * SIM_S);
    TEST_ASSERT_TRUE(instants <= heard.count + 8 * 101 + 2);
}

void test_a_counted_stream_counts_down_and_turns_the_laser_off(void)
{
    static const char *const echoes[] = {"MD0372040601003", "MD0372040601002", "MD0372040601001",
                                         "MD0372040601000"};

    create_scip2();
    forget();
    host("MD0372040601004\n");
    run_for(SIM_S);
    const char *at = after_ack("MD0372040601004\n00P\n\n");
    for (int i = 0; i < 4; i++) {
        frame_t frame = read_frame(at, "99b\n");
        TEST_ASSERT_EQUAL_STRING(echoes[i], frame.echo);
        at = frame.end;
    }
    TEST_ASSERT_EQUAL_STRING("", at);
    TEST_ASSERT_FALSE(urg04lx_state(urg).streaming);
    TEST_ASSERT_FALSE(urg04lx_state(urg).laser_on);
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
}

void test_the_remaining_counter_has_two_digits(void)
{
    create_scip2();
    forget();
    host("MS0384038401099\n");
    run_for(11 * SIM_S);
    const char *at = after_ack("MS0384038401099\n00P\n\n");
    for (int left = 98; left >= 0; left--) {
        frame_t frame = read_frame(at, "99b\n");
        TEST_ASSERT_EQUAL_INT(left, atoi(frame.echo + 13));
        at = frame.end;
    }
    TEST_ASSERT_EQUAL_STRING("", at);
}

void test_the_interval_is_the_number_of_revolutions_left_out(void)
{
    char command[32];

    for (int interval = 0; interval <= 9; interval++) {
        create_scip2();
        forget();
        snprintf(command, sizeof command, "MS0372040601%d03\n", interval);
        host(command);
        run_for(4 * SIM_S);
        frame_t first = read_frame(heard.text + 21, "99b\n");
        frame_t second = read_frame(first.end, "99b\n");
        frame_t third = read_frame(second.end, "99b\n");
        TEST_ASSERT_EQUAL_INT64(100 * (interval + 1), second.time_ms - first.time_ms);
        TEST_ASSERT_EQUAL_INT64(100 * (interval + 1), third.time_ms - second.time_ms);
        TEST_ASSERT_EQUAL_STRING("", third.end);
        TEST_ASSERT_EQUAL_UINT(3, world_calls);
        world_calls = 0;
    }
}

/* On the wire: 1435 octets 124.6 ms at 115200 and 747 ms at 19200; 587 octets 51.0 ms at 115200, 101.9 ms at
 * 57600. */
static void check_spacing(double rate, const char *command, long expected_ms)
{
    config.power_up_rate = rate;
    create_scip2();
    forget();
    host(command);
    run_for(4 * SIM_S);
    frame_t frame = read_frame(heard.text + 21, "99b\n");
    for (int i = 0; i < 3; i++) {
        frame_t next = read_frame(frame.end, "99b\n");
        TEST_ASSERT_EQUAL_INT64(expected_ms, next.time_ms - frame.time_ms);
        frame = next;
    }
    unsigned sent = urg04lx_state(urg).scans_sent, skipped = urg04lx_state(urg).revolutions_skipped;
    TEST_ASSERT_UINT_WITHIN((unsigned)expected_ms / 100, sent * ((unsigned)expected_ms / 100 - 1), skipped);
}

void test_revolutions_are_skipped_while_the_line_is_busy(void)
{
    check_spacing(115200.0, "MS0044072501000\n", 200);
    check_spacing(19200.0, "MS0044072501000\n", 800);
    check_spacing(115200.0, "MS0249051901000\n", 100);
    check_spacing(57600.0, "MS0249051901000\n", 200);
    check_spacing(19200.0, "MS0372040601000\n", 100);
}

void test_behind_a_skipped_revolution_the_very_next_one_is_tried(void)
{
    config.power_up_rate = 19200.0;
    create_scip2();
    forget();
    host("MS0044072501203\n");
    run_for(4 * SIM_S);
    frame_t first = read_frame(after_ack("MS0044072501203\n00P\n\n"), "99b\n");
    frame_t second = read_frame(first.end, "99b\n");
    TEST_ASSERT_EQUAL_INT64(800,
                            second.time_ms - first.time_ms); /* 300 when the line is fast, 900 in threes */
}

void test_a_skipped_revolution_does_not_count_as_sent(void)
{
    create_scip2();
    forget();
    host("MS0044072501003\n");
    run_for(2 * SIM_S);
    frame_t frame = read_frame(after_ack("MS0044072501003\n00P\n\n"), "99b\n");
    TEST_ASSERT_EQUAL_STRING("MS0044072501002", frame.echo);
    frame = read_frame(frame.end, "99b\n");
    TEST_ASSERT_EQUAL_STRING("MS0044072501001", frame.echo);
    frame = read_frame(frame.end, "99b\n");
    TEST_ASSERT_EQUAL_STRING("MS0044072501000", frame.echo);
    TEST_ASSERT_EQUAL_STRING("", frame.end);
}

/* The line feed arrives and the latency ends while octet `k` of the frame is on the line. */
void test_qt_at_any_octet_of_a_frame_lets_it_finish_and_nothing_follows(void)
{
    for (sim_time_t k = -12; k <= 105; k += 3) {
        create_scip2();
        host("MS0372040601000\n");
        run_until(1990 * SIM_MS + k * 86806 - 3 * 86805);
        forget();
        host("QT\n");
        run_for(SIM_S);
        if (timeline_now() - SIM_S + config.latency < 2000 * SIM_MS) {
            expect("QT\n00P\n\n");
        } else {
            frame_t frame = read_frame(heard.text, "99b\n");
            TEST_ASSERT_EQUAL_INT64(1900, frame.time_ms);
            TEST_ASSERT_EQUAL_STRING("QT\n00P\n\n", frame.end);
        }
        TEST_ASSERT_FALSE(urg04lx_state(urg).streaming);
        TEST_ASSERT_FALSE(urg04lx_state(urg).laser_on);
        TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
    }
}

void test_qt_in_the_middle_of_a_long_frame_is_answered_right_behind_it(void)
{
    create_scip2();
    host("MD0044072501000\n");
    run_until(1940 * SIM_MS); /* 40 ms into a frame of 185.5 ms */
    forget();
    host("QT\n");
    run_for(SIM_S);
    const char *echo = strstr(heard.text, "QT\n00P\n\n");
    TEST_ASSERT_NOT_NULL(echo);
    TEST_ASSERT_TRUE(echo > heard.text + 1000);
    TEST_ASSERT_EQUAL_STRING_LEN("\n\n", echo - 2, 2);
    TEST_ASSERT_EQUAL_STRING("", echo + 8);
    for (size_t i = 1; i < heard.count; i++) {
        TEST_ASSERT_EQUAL_INT64(86806, heard.at[i] - heard.at[i - 1]);
    }
}

void test_a_command_during_a_stream_is_answered_between_frames(void)
{
    create_scip2();
    host("MS0372040601000\n");
    run_until(1995 * SIM_MS);
    forget();
    host("PP\n"); /* handled while the frame of 2000 .. 2008.8 ms leaves */
    run_until(2350 * SIM_MS);
    frame_t frame = read_frame(heard.text, "99b\n");
    TEST_ASSERT_EQUAL_INT64(1900, frame.time_ms);
    TEST_ASSERT_EQUAL_STRING_LEN("PP\n00P\nMODL:", frame.end, 12);
    for (int i = 0; i < 3; i++) {
        frame = read_frame(i == 0 ? frame.end + 128 : frame.end, "99b\n");
        TEST_ASSERT_EQUAL_INT64(2000 + 100 * i, frame.time_ms);
    }
    TEST_ASSERT_EQUAL_STRING("", frame.end);
}

void test_a_new_stream_replaces_the_old_one(void)
{
    create_scip2();
    host("MS0372040601000\n");
    run_until(2050 * SIM_MS);
    forget();
    host("MD0384038501002\n"); /* the revolution of 2000 ms is given up */
    run_until(3 * SIM_S);
    frame_t frame = read_frame(after_ack("MD0384038501002\n00P\n\n"), "99b\n");
    TEST_ASSERT_EQUAL_STRING("MD0384038501001", frame.echo);
    TEST_ASSERT_EQUAL_INT64(2100, frame.time_ms);
    frame = read_frame(frame.end, "99b\n");
    TEST_ASSERT_EQUAL_STRING("MD0384038501000", frame.echo);
    TEST_ASSERT_EQUAL_STRING("", frame.end);
}

void test_a_refused_stream_leaves_the_running_one_alone(void)
{
    create_scip2();
    host("MS0372040601000\n");
    run_until(2050 * SIM_MS);
    forget();
    host("MS0372076901000\n");
    run_until(2250 * SIM_MS);
    frame_t frame = read_frame(after_ack("MS0372076901000\n04T\n\n"), "99b\n");
    TEST_ASSERT_EQUAL_INT64(2000, frame.time_ms);
    frame = read_frame(frame.end, "99b\n");
    TEST_ASSERT_EQUAL_INT64(2100, frame.time_ms);
    TEST_ASSERT_EQUAL_STRING("", frame.end);
}

void test_time_mode_ends_a_stream(void)
{
    create_scip2();
    host("MS0372040601000\n");
    run_until(2050 * SIM_MS);
    ask("TM0\n", "TM0\n00P\n\n");
    TEST_ASSERT_FALSE(urg04lx_state(urg).streaming);
}

void test_a_single_scan_is_of_the_next_revolution_and_holds_up_the_commands_behind_it(void)
{
    create_scip2();
    ask("BM\n", "BM\n00P\n\n");
    run_until(2050 * SIM_MS);
    forget();
    host("GD0372040601\nQT\n");
    run_until(2200 * SIM_MS);
    expect("");
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_INT64(2200 * SIM_MS + 86806, heard.at[0]);
    frame_t frame = read_frame(heard.text, "00P\n");
    TEST_ASSERT_EQUAL_STRING("GD0372040601", frame.echo);
    TEST_ASSERT_EQUAL_INT64(2100, frame.time_ms);
    TEST_ASSERT_EQUAL_STRING("QT\n00P\n\n", frame.end);
    TEST_ASSERT_EQUAL_INT64(2134 * SIM_MS, world_called_at);
    TEST_ASSERT_EQUAL_UINT(1, urg04lx_state(urg).scans_sent);
}

void test_a_single_scan_during_a_stream_takes_the_place_of_a_frame_at_most(void)
{
    create_scip2();
    host("MS0372040601000\n");
    run_until(2050 * SIM_MS);
    forget();
    host("GD0300040001\n");
    run_until(2450 * SIM_MS);
    const char *reply = strstr(heard.text, "GD0300040001\n00P\n");
    TEST_ASSERT_NOT_NULL(reply);
    frame_t single = read_frame(reply, "00P\n");
    TEST_ASSERT_EQUAL_INT64(2100, single.time_ms);
    TEST_ASSERT_EQUAL_INT(101, single.count);
    unsigned frames = 0;
    for (const char *at = heard.text; *at != '\0'; frames++) {
        frame_t frame = read_frame(at, at == reply ? "00P\n" : "99b\n");
        at = frame.end;
    }
    TEST_ASSERT_UINT_WITHIN(1, 5, frames);
}

/* ---- time ---- */

void test_time_stamps_wrap_at_24_bits(void)
{
    static const long expected[] = {16777000, 16777100, 16777200, 84, 184}; /* 2^24 = 16777216 */

    create_scip2();
    run_until(16776950 * SIM_MS);
    forget();
    host("MS0384038401005\n");
    run_for(SIM_S);
    const char *at = heard.text + 21;
    for (int i = 0; i < 5; i++) {
        frame_t frame = read_frame(at, "99b\n");
        TEST_ASSERT_EQUAL_INT64(expected[i], frame.time_ms);
        at = frame.end;
    }
}

void test_the_sensors_clock_runs_at_its_own_rate(void)
{
    config.clock_ratio = 1.003;
    config.phase = SIM_MS;
    create_scip2();
    run_until(1000 * SIM_S - 50 * SIM_MS);
    forget();
    host("MS0384038401002\n");
    run_for(SIM_S);
    frame_t frame = read_frame(heard.text + 21, "99b\n");
    TEST_ASSERT_EQUAL_INT64(1003001, frame.time_ms); /* 1000.001 s: 1003001.003 ms */
    frame = read_frame(frame.end, "99b\n");
    TEST_ASSERT_EQUAL_INT64(1003101, frame.time_ms); /* 1000.101 s: 1003101.303 ms */
}

void test_the_clock_starts_with_the_power(void)
{
    create_scip2();
    run_until(100 * SIM_S + 7 * SIM_MS);
    urg04lx_power(urg, false);
    run_for(SIM_S);
    urg04lx_power(urg, true); /* 101.007 s */
    run_for(SIM_S);
    ask("SCIP2.0\n", "SCIP2.0\n0\n\n");
    forget();
    host("MS0389038901001\n");
    run_for(SIM_S);
    frame_t frame = read_frame(heard.text + 21, "99b\n");
    TEST_ASSERT_EQUAL_INT64(1800, frame.time_ms);
    TEST_ASSERT_EQUAL_INT64(101007 + 1800 + 34, world_called_at / SIM_MS);
}

/* Its rays, its time stamp and its octets' rate stay. */
void test_a_late_frame_ends_so_much_later_and_no_revolution_is_lost(void)
{
    sim_time_t ends[2], seen[2];
    int64_t stamps[2];

    for (int late = 0; late < 2; late++) {
        config.late = late * 46300 * SIM_US;
        create_scip2();
        forget();
        host("MS0372040601001\n");
        run_for(SIM_S);
        stamps[late] = read_frame(heard.text + 21, "99b\n").time_ms;
        seen[late] = world_called_at;
        ends[late] = heard.at[heard.count - 1];
        host("MS0372040601010\n");
        run_for(2 * SIM_S);
        TEST_ASSERT_EQUAL_UINT(0, urg04lx_state(urg).revolutions_skipped);
        tearDown();
        setUp();
    }
    TEST_ASSERT_EQUAL_INT64(stamps[0], stamps[1]);
    TEST_ASSERT_EQUAL_INT64(seen[0], seen[1]);
    TEST_ASSERT_EQUAL_INT64(46300 * SIM_US, ends[1] - ends[0]);
}

void test_the_revolution_is_configurable(void)
{
    config.revolution = 99 * SIM_MS;
    config.ray_instant = 20 * SIM_MS;
    create_scip2();
    forget();
    host("MS0389038901002\n");
    run_for(SIM_S);
    frame_t first = read_frame(heard.text + 21, "99b\n");
    frame_t second = read_frame(first.end, "99b\n");
    TEST_ASSERT_EQUAL_INT64(0, first.time_ms % 99);
    TEST_ASSERT_EQUAL_INT64(99, second.time_ms - first.time_ms);
    TEST_ASSERT_EQUAL_INT64((second.time_ms + 20) * SIM_MS, world_called_at);
}

/* ---- loss of power ---- */

void test_a_restart_at_every_octet_of_a_frame_ends_in_scip1_at_the_power_up_rate(void)
{
    for (int octet = 0; octet <= 101; octet++) {
        create_scip2();
        ask("SS250000\n", "SS250000\n00P\n\n");
        host_rate = 250000.0;
        host("MS0372040601000\n");
        run_until(2 * SIM_S);
        forget();
        run_until(2 * SIM_S + octet * 40 * SIM_US + 39999);
        TEST_ASSERT_EQUAL_INT(octet, heard.count);
        urg04lx_power(urg, false);
        TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
        TEST_ASSERT_FALSE(urg04lx_state(urg).powered);
        TEST_ASSERT_FALSE(urg04lx_state(urg).streaming);
        run_for(3 * SIM_MS);
        urg04lx_power(urg, true);
        run_for(SIM_S);
        TEST_ASSERT_EQUAL_INT(octet, heard.count);
        ask("QT\n", "");
        host_rate = 115200.0;
        ask("QT\n", "QT\nE\n\n");
        TEST_ASSERT_TRUE(urg04lx_state(urg).laser_on);
    }
}

void test_a_half_command_does_not_survive_a_restart(void)
{
    host("SCIP");
    urg04lx_power(urg, false);
    urg04lx_power(urg, true);
    run_for(SIM_S);
    ask("2.0\n", "2.0\nE\n\n");
}

void test_a_restart_forgets_waiting_commands_scans_and_rates(void)
{
    create_scip2();
    host("SS250000\nBM\nTM0\n");
    urg04lx_power(urg, false);
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
    urg04lx_power(urg, true);
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_DOUBLE(115200.0, urg04lx_state(urg).rate);
    ask("L1\n", "L1\n2\n\n");
    host("G38438401\n");
    run_for(10 * SIM_MS);
    urg04lx_power(urg, false);
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
    urg04lx_power(urg, true);
    run_for(SIM_S);
    ask("L0\n", "L0\n0\n\n");
}

void test_power_lost_while_the_rate_is_about_to_change_leaves_the_power_up_rate(void)
{
    create_scip2();
    host("SS250000\n");
    run_for(config.latency + 5 * 86806);
    urg04lx_power(urg, false);
    urg04lx_power(urg, true);
    run_for(SIM_S);
    ask("L0\n", "L0\n0\n\n");
    ask("L0\n", "L0\n0\n\n");
}

void test_a_destroyed_sensor_leaves_nothing_behind(void)
{
    create_scip2();
    host("MS0372040601000\nGD0372040601\nQT\n");
    run_for(250 * SIM_MS);
    urg04lx_destroy(urg);
    urg = NULL;
    TEST_ASSERT_EQUAL_INT64(SIM_NEVER, timeline_next());
}

void test_two_sensors_do_not_know_of_each_other(void)
{
    static heard_t other_heard;
    urg04lx_config_t slow = config;

    slow.power_up_rate = 19200.0;
    other_heard.count = 0;
    urg04lx_t *other = urg04lx_create(&slow, world, world_mm, listen, &other_heard);
    urg04lx_power(other, true);
    run_for(SIM_S);
    ask("SCIP2.0\n", "SCIP2.0\n0\n\n");
    TEST_ASSERT_EQUAL_UINT(0, other_heard.count);
    TEST_ASSERT_FALSE(urg04lx_state(other).scip2);
    TEST_ASSERT_EQUAL_DOUBLE(19200.0, urg04lx_state(other).rate);
    urg04lx_receive(other, 'L', 1e9 / 19200.0);
    urg04lx_receive(other, '0', 1e9 / 19200.0);
    urg04lx_receive(other, '\n', 1e9 / 19200.0);
    forget();
    run_for(SIM_S);
    expect("");
    TEST_ASSERT_EQUAL_STRING("L0\n0\n\n", other_heard.text);
    urg04lx_destroy(other);
}

/* ---- garbage ---- */

void test_random_octets_break_nothing(void)
{
    static const char letters[] = "MSGDQTRVPIBCHL0123456789;\n\r\n $x";
    const unsigned seed = 77u;

    printf("seed %u\n", seed);
    srand(seed);
    create_scip2();
    for (int i = 0; i < 20000; i++) {
        char octet = (char)(rand() % 4 == 0 ? rand() % 256 : letters[rand() % (int)(sizeof letters - 1)]);
        host_octets(&octet, 1);
        forget();
    }
    run_for(2 * SIM_S);
    forget();
    host("\nTM2\nQT\n");
    run_for(2 * SIM_S);
    TEST_ASSERT_NOT_NULL(strstr(heard.text, "QT\n00P\n\n"));
    TEST_ASSERT_TRUE(urg04lx_state(urg).scip2);
    TEST_ASSERT_FALSE(urg04lx_state(urg).streaming);
}

/* ---- answers as recorded ---- */

/* The recording: V after 380 ms, the switch after 7, then VV, PP, II, BM one after the other at once: 96, 98,
 * 99, 98 ms; GD within 174; TM1 within 1. Revolutions begin at 30 ms and every 100. */
void test_a_sensor_as_recorded_answers_once_a_revolution(void)
{
    config.answers_in_turn = true;
    config.phase = 30 * SIM_MS;
    create();
    urg04lx_power(urg, true);
    run_until(config.boot + 5 * SIM_MS);
    forget();
    host("V\n");
    const sim_time_t asked = timeline_now();
    run_for(SIM_S);
    TEST_ASSERT_EQUAL_INT64(asked + 381 * SIM_MS + 86806, heard.at[0]);
    ask("SCIP2.0\n", "SCIP2.0\n0\n\n");
    run_until(12020 * SIM_MS);
    forget();
    host("VV\nPP\nII\n");
    run_until(12600 * SIM_MS);
    TEST_ASSERT_EQUAL_INT64(12030 * SIM_MS + 86806, heard.at[0]);
    TEST_ASSERT_EQUAL_INT64(12130 * SIM_MS + 86806, heard.at[strstr(heard.text, "\nPP\n") + 1 - heard.text]);
    TEST_ASSERT_EQUAL_INT64(12230 * SIM_MS + 86806, heard.at[strstr(heard.text, "\nII\n") + 1 - heard.text]);
}

void test_a_sensor_as_recorded_answers_time_and_single_scans_at_once(void)
{
    config.answers_in_turn = true;
    create_scip2();
    run_for(SIM_S);
    forget();
    host("TM0\n");
    const sim_time_t asked = timeline_now();
    run_for(50 * SIM_MS);
    TEST_ASSERT_EQUAL_INT64(asked + config.latency + 86806, heard.at[0]);
}

/* After a loss of power the first answer is late again. */
void test_a_sensor_as_recorded_is_slow_after_each_power_up(void)
{
    config.answers_in_turn = true;
    create_scip2();
    urg04lx_power(urg, false);
    urg04lx_power(urg, true);
    run_for(config.boot + SIM_MS);
    forget();
    host("V\n");
    run_for(380 * SIM_MS);
    TEST_ASSERT_EQUAL_UINT(0, heard.count);
    run_for(50 * SIM_MS);
    TEST_ASSERT_TRUE(heard.count > 0);
}
