#include "unity.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/scip_info.h"
#include "drivers/scip_parser.h"

static scip_parser_t parser;
static scip_info_t info;

void setUp(void)
{
    scip_parser_init(&parser);
    scip_info_init(&info);
}

void tearDown(void) {}

static void feed(const char *octets)
{
    while (*octets != '\0') {
        if (scip_parser_feed(&parser, (octet_t)*octets++) == SCIP_TEXT) {
            scip_info_take(&info, &parser);
        }
    }
}

static void ask(scip_kind_t kind)
{
    scip_request_t request;
    TEST_ASSERT_TRUE(scip_request(&request, kind));
    scip_parser_expect(&parser, &request);
}

/* A line of PP with its sum, worked out here, or the one after it. */
static void tell(const char *text, bool right)
{
    char line[80] = "";
    uint16_t sum = 0;
    size_t length = strlen(text);
    for (size_t i = 0; i < length; i++) {
        sum = (uint16_t)(sum + (uint16_t)text[i]);
    }
    memcpy(line, text, length);
    line[length] = ';';
    line[length + 1] = (char)(((sum + (right ? 0 : 1)) & 63) + 48);
    line[length + 2] = '\n';
    feed(line);
}

static void begin_pp(void)
{
    ask(SCIP_PARAMETERS);
    feed("PP\n00P\n");
}

static void tell_all_limits_but(const char *left_out)
{
    static const char *const lines[] = {"DMIN:21",   "DMAX:4000", "ARES:1440", "AMIN:0",
                                        "AMAX:1080", "AFRT:540",  "SCAN:2400"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        if (strncmp(lines[i], left_out, 4) != 0) {
            tell(lines[i], true);
        }
    }
}

static bool same(const scip_limits_t *a, const scip_limits_t *b)
{
    return a->dmin_mm == b->dmin_mm && a->dmax_mm == b->dmax_mm && a->ares == b->ares && a->amin == b->amin &&
           a->amax == b->amax && a->afrt == b->afrt && a->scan_rpm == b->scan_rpm;
}

static bool limits_are_default(void)
{
    const scip_limits_t limits = scip_info_limits(&info);
    return same(&limits, &scip_limits_urg04lx);
}

/* --- what real sensors send
 * --------------------------------------------------------------------------------------- */

/* The replies of a URG-04LX, firmware 3.1.04, as its owners published them; the sums are the sensor's. */
void test_a_real_sensor_is_understood(void)
{
    ask(SCIP_VERSION);
    feed("VV\n00P\nVEND:Hokuyo Automatic Co.,Ltd.;[\nPROD:SOKUIKI Sensor "
         "URG-04LX;[\nFIRM:3.1.04(02/Aug./2007);a\n"
         "PROT:SCIP 2.0;N\nSERI:H0706400;F\n\n");
    TEST_ASSERT_EQUAL_STRING("Hokuyo Automatic Co.,Ltd.", info.vendor);
    TEST_ASSERT_EQUAL_STRING("SOKUIKI Sensor URG-04LX", info.product);
    TEST_ASSERT_EQUAL_STRING("3.1.04(02/Aug./2007)", info.firmware);
    TEST_ASSERT_EQUAL_STRING("SCIP 2.0", info.protocol);
    TEST_ASSERT_EQUAL_STRING("H0706400", info.serial);
    ask(SCIP_PARAMETERS);
    feed("PP\n00P\nMODL:URG-04LX(Hokuyo Automatic "
         "Co.,Ltd.);N\nDMIN:20;4\nDMAX:5600;_\nARES:1024;\\\nAMIN:44;7\nAMAX:725;o\n"
         "AFRT:384;6\nSCAN:600;e\n\n");
    TEST_ASSERT_EQUAL_STRING("URG-04LX(Hokuyo Automatic Co.,Ltd.)", info.model);
    TEST_ASSERT_TRUE(same(&info.told, &scip_limits_urg04lx));
    ask(SCIP_STATE);
    feed("II\n00P\nMODL:URG-04LX(Hokuyo Automatic Co.,Ltd.);N\nLASR:ON;9\nSCSP:Initial(600[rpm])<-Default "
         "setting by user;A\n"
         "MESM:CLASSIC;^\nSBPS:19200[bps]<-Default setting by user;A\nTIME:00173B;V\nSTAT:Sensor works "
         "well.;8\n\n");
    TEST_ASSERT_TRUE(info.laser_on);
    TEST_ASSERT_EQUAL_UINT16(600, info.speed_rpm);
    TEST_ASSERT_EQUAL_STRING("CLASSIC", info.mode);
    TEST_ASSERT_EQUAL_UINT32(19200, info.bit_rate);
    TEST_ASSERT_EQUAL_UINT32(0x173B, info.time_ms);
    TEST_ASSERT_EQUAL_STRING("Sensor works well.", info.state);
    TEST_ASSERT_EQUAL(SCIP_HEALTH_GOOD, info.health);
    TEST_ASSERT_EQUAL_UINT16(20, info.known);
    TEST_ASSERT_EQUAL_UINT16(0, info.unknown);
    TEST_ASSERT_EQUAL_UINT16(0, info.unproved);
}

/* The replies of a UTM-30LX, firmware P.1.05, as its owners published them; the sums are the sensor's. */
void test_a_real_sensor_of_1081_steps_is_understood(void)
{
    scip_limits_t limits;
    ask(SCIP_PARAMETERS);
    feed("PP\n00P\nMODL:UTM-30LX(Hokuyo Automatic Co.,Ltd.);U\nDMIN:23;7\nDMAX:60000;J\nARES:1440;^\n"
         "AMIN:0;?\nAMAX:1080;Z\nAFRT:540;0\nSCAN:2400;U\n\n");
    limits = scip_info_limits(&info);
    TEST_ASSERT_TRUE(same(&limits, &scip_limits_utm30lx));
    TEST_ASSERT_EQUAL_INT32(-135000, scip_limits_mdeg(&limits, 0));
    TEST_ASSERT_EQUAL_INT32(135000, scip_limits_mdeg(&limits, 1080));
    ask(SCIP_STATE);
    feed("II\n00P\nMODL:UTM-30LX(Hokuyo Automatic Co.,Ltd.);U\nLASR:ON;9\n"
         "SCSP:Initial(2400[rpm])<-Default setting by user;1\nMESM:CLASSIC;^\nSBPS:USB Full Speed;P\n"
         "TIME:4991D0;d\nSTAT:Sensor works well.;8\n\n");
    TEST_ASSERT_EQUAL_UINT16(2400, info.speed_rpm);
    TEST_ASSERT_EQUAL_UINT32(0, info.bit_rate);
    TEST_ASSERT_EQUAL_UINT32(0x4991D0, info.time_ms);
    TEST_ASSERT_EQUAL_UINT16(0, info.unproved);
}

/* The UST-10LX is on Ethernet: its 100 are megabits, and no rate of a UART. */
void test_a_rate_that_is_not_in_bits_per_second_is_none(void)
{
    ask(SCIP_STATE);
    feed("II\n00P\n");
    tell("SBPS:Ethernet 100 [Mbps]", true);
    TEST_ASSERT_EQUAL_UINT32(0, info.bit_rate);
    tell("SBPS:115200", true);
    TEST_ASSERT_EQUAL_UINT32(0, info.bit_rate);
    tell("SBPS:57600a[bps]", true);
    TEST_ASSERT_EQUAL_UINT32(0, info.bit_rate);
    tell("SBPS:4000000000[bps]", true);
    TEST_ASSERT_EQUAL_UINT32(0, info.bit_rate);
    tell("SBPS:999999999[BPS]", true);
    TEST_ASSERT_EQUAL_UINT32(999999999, info.bit_rate);
    tell("SBPS:115200 [bps]", true);
    TEST_ASSERT_EQUAL_UINT32(115200, info.bit_rate);
    tell("SBPS:5[bps]", true);
    TEST_ASSERT_EQUAL_UINT32(5, info.bit_rate);
    TEST_ASSERT_EQUAL_UINT16(7, info.known);
}

/* Some firmware adds a line to VV, sends a wrong sum behind SERI, or sums an II line only up to "<-". */
void test_the_known_oddities_of_firmware_do_no_harm(void)
{
    ask(SCIP_VERSION);
    feed("VV\n00P\nI\nIserial number;X\nSERI:H1100676;0\n\n");
    TEST_ASSERT_EQUAL_STRING("H1100676", info.serial);
    TEST_ASSERT_EQUAL_UINT16(1, info.known);
    TEST_ASSERT_EQUAL_UINT16(2, info.unknown);
    TEST_ASSERT_EQUAL_UINT16(1, info.unproved);
    ask(SCIP_STATE);
    feed("II\n00P\nSTAT:Stable 000 no error.<-Latest;0\n\n");
    TEST_ASSERT_EQUAL(SCIP_HEALTH_GOOD, info.health);
}

void test_nothing_is_known_at_first(void)
{
    TEST_ASSERT_EQUAL_STRING("", info.vendor);
    TEST_ASSERT_EQUAL_STRING("", info.state);
    TEST_ASSERT_EQUAL(SCIP_HEALTH_UNKNOWN, info.health);
    TEST_ASSERT_EQUAL_UINT32(0, info.bit_rate);
    TEST_ASSERT_FALSE(info.laser_on);
    TEST_ASSERT_TRUE(limits_are_default());
}

/* --- tolerance
 * ---------------------------------------------------------------------------------------------------- */

void test_blanks_and_small_letters_do_not_matter(void)
{
    begin_pp();
    tell("  dmin :  21  ", true);
    tell("MODL:  A  B ", true);
    tell("SERI:   ", true);
    tell("VEND: ", true);
    TEST_ASSERT_EQUAL_STRING("", info.vendor);
    TEST_ASSERT_EQUAL_UINT16(21, info.told.dmin_mm);
    TEST_ASSERT_EQUAL_STRING("A  B", info.model);
    TEST_ASSERT_EQUAL_STRING("", info.serial);
    TEST_ASSERT_EQUAL_UINT16(4, info.known);
}

/* The memory of the line still holds the longer one. */
void test_a_line_ends_where_it_ends(void)
{
    begin_pp();
    feed("TIME:123456\nTIME:12\nLASR:ON\nLASR:O\nDMIN:204\nDMIN:20\n");
    TEST_ASSERT_EQUAL_UINT32(0x12, info.time_ms);
    TEST_ASSERT_FALSE(info.laser_on);
    TEST_ASSERT_EQUAL_UINT16(20, info.told.dmin_mm);
}

/* Alone in its memory: sanitizers see a look beyond it. Of the second line there is only ';' and its sum. */
void test_a_line_without_a_colon_is_looked_at_no_further(void)
{
    scip_parser_t *alone = malloc(sizeof *alone);
    TEST_ASSERT_NOT_NULL(alone);
    scip_parser_init(alone);
    memset(alone->line, 'x', sizeof alone->line);
    alone->text_length = alone->line_length = SCIP_LINE_MAX;
    scip_info_take(&info, alone);
    TEST_ASSERT_EQUAL_UINT16(1, info.unknown);
    alone->text_length = 0;
    alone->line_length = 2;
    scip_info_take(&info, alone);
    TEST_ASSERT_EQUAL_UINT16(2, info.unknown);
    free(alone);
}

void test_a_line_without_a_sum_is_believed_and_one_with_a_wrong_sum_only_as_text(void)
{
    begin_pp();
    feed("DMAX:4000\nMODL:X\nARES:1440\n");
    TEST_ASSERT_EQUAL_UINT16(4000, info.told.dmax_mm);
    TEST_ASSERT_EQUAL_UINT16(1440, info.told.ares);
    tell("DMAX:9999", false);
    tell("MODL:Y", false);
    tell("TIME:000001", false);
    tell("SBPS:1", false);
    tell("LASR:ON", false);
    TEST_ASSERT_EQUAL_UINT16(4000, info.told.dmax_mm);
    TEST_ASSERT_EQUAL_STRING("Y", info.model);
    TEST_ASSERT_EQUAL_UINT32(0, info.time_ms);
    TEST_ASSERT_EQUAL_UINT32(0, info.bit_rate);
    TEST_ASSERT_FALSE(info.laser_on);
    TEST_ASSERT_EQUAL_UINT16(5, info.unproved);
    TEST_ASSERT_EQUAL_UINT16(8, info.known);
}

void test_what_is_no_known_key_is_counted_and_left_alone(void)
{
    static const char *const lines[] = {"XXXX:1", "DMI:1",  "DMINI:1", ":1",     "DMIN",
                                        "LAS:ON", "UDST:0", "ZZZZ:",   "[\\]^:1"};
    begin_pp();
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        tell(lines[i], true);
        TEST_ASSERT_EQUAL_UINT16(i + 1, info.unknown);
    }
    TEST_ASSERT_EQUAL_UINT16(0, info.known);
    TEST_ASSERT_EQUAL_UINT16(0, info.told.dmin_mm);
}

void test_a_number_that_is_none_or_too_large_changes_nothing(void)
{
    static const char *const lines[] = {"DMIN:", "DMIN:abc", "DMIN:65536", "DMIN:9999999999",
                                        "DMIN:123456789012345"};
    begin_pp();
    tell("DMIN:33", true);
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        tell(lines[i], true);
        TEST_ASSERT_EQUAL_UINT16(33, info.told.dmin_mm);
    }
    tell("DMIN:65535", true);
    TEST_ASSERT_EQUAL_UINT16(65535, info.told.dmin_mm);
    tell("DMIN:0020[mm]", true);
    TEST_ASSERT_EQUAL_UINT16(20, info.told.dmin_mm);
}

void test_the_clock_is_up_to_six_hexadecimal_digits(void)
{
    begin_pp();
    tell("TIME:ffFFff", true);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFFF, info.time_ms);
    tell("TIME:1000000", true);
    tell("TIME:G", true);
    tell("TIME:@", true);
    tell("TIME:", true);
    TEST_ASSERT_EQUAL_UINT32(0xFFFFFF, info.time_ms);
    tell("TIME:7a", true);
    TEST_ASSERT_EQUAL_UINT32(0x7A, info.time_ms);
    tell("TIME:5", true);
    TEST_ASSERT_EQUAL_UINT32(5, info.time_ms);
    tell("TIME:1:2", true);
    TEST_ASSERT_EQUAL_UINT32(1, info.time_ms);
    tell("SBPS:none", true);
    TEST_ASSERT_EQUAL_UINT32(0, info.bit_rate);
}

void test_the_laser_is_told_on_and_off(void)
{
    begin_pp();
    tell("LASR:ON", true);
    TEST_ASSERT_TRUE(info.laser_on);
    tell("LASR:OFF", true);
    TEST_ASSERT_FALSE(info.laser_on);
}

void test_a_long_text_is_cut(void)
{
    begin_pp();
    tell("MODL:0123456789012345678901234567890123456789abcdef", true);
    TEST_ASSERT_EQUAL_STRING("012345678901234567890123456789012345678", info.model);
    TEST_ASSERT_EQUAL_STRING("", info.mode);
    tell("MODL:short", true);
    TEST_ASSERT_EQUAL_STRING("short", info.model);
}

void test_the_state_is_understood_by_words_within_it(void)
{
    static const struct {
        const char *line;
        scip_health_t health;
    } rows[] = {
        {"STAT:Sensor works well.", SCIP_HEALTH_GOOD},
        {"STAT:FW Normal[FinalDist with shadow  ]", SCIP_HEALTH_GOOD},
        {"STAT:Stable 000 no error.", SCIP_HEALTH_GOOD},
        {"STAT:no error", SCIP_HEALTH_GOOD},
        {"STAT:Unstable 011", SCIP_HEALTH_TROUBLE},
        {"STAT:ABNORMAL", SCIP_HEALTH_TROUBLE},
        {"STAT:Laser malfunction", SCIP_HEALTH_TROUBLE},
        {"STAT:motor trouble", SCIP_HEALTH_TROUBLE},
        {"STAT:internal Fault 3", SCIP_HEALTH_TROUBLE},
        {"STAT:APD fail", SCIP_HEALTH_TROUBLE},
        {"STAT:Error 50", SCIP_HEALTH_TROUBLE},
        {"STAT:works", SCIP_HEALTH_UNKNOWN},
        {"STAT:", SCIP_HEALTH_UNKNOWN},
    };
    begin_pp();
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        tell(rows[i].line, true);
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].health, info.health, rows[i].line);
    }
}

/* --- limits
 * ------------------------------------------------------------------------------------------------------- */

void test_limits_come_from_the_sensor_when_it_told_them_all(void)
{
    static const scip_limits_t utm = {21, 4000, 1440, 0, 1080, 540, 2400};
    begin_pp();
    tell_all_limits_but("none");
    const scip_limits_t limits = scip_info_limits(&info);
    TEST_ASSERT_TRUE(same(&utm, &limits));
}

/* AMIN 0 is a good value, so its absence does not show. */
void test_one_missing_limit_makes_all_of_them_the_defaults(void)
{
    static const char *const keys[] = {"DMIN", "DMAX", "ARES", "AMAX", "AFRT", "SCAN"};
    for (size_t i = 0; i < sizeof keys / sizeof keys[0]; i++) {
        setUp();
        begin_pp();
        tell("AMIN:1", true);
        tell_all_limits_but(keys[i]);
        tell("AMIN:1", true);
        TEST_ASSERT_TRUE_MESSAGE(limits_are_default(), keys[i]);
    }
}

void test_limits_that_do_not_fit_together_are_not_used(void)
{
    static const char *const lines[] = {"DMIN:1001", "DMIN:0",   "DMAX:21",   "ARES:1079", "ARES:4096",
                                        "AMIN:541",  "AMAX:539", "AFRT:1081", "SCAN:0"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        setUp();
        begin_pp();
        tell_all_limits_but("none");
        TEST_ASSERT_FALSE(limits_are_default());
        tell(lines[i], true);
        TEST_ASSERT_TRUE_MESSAGE(limits_are_default(), lines[i]);
    }
}

void test_a_turn_of_no_steps_is_not_used(void)
{
    begin_pp();
    tell_all_limits_but("none");
    tell("AMAX:0", true);
    tell("AFRT:0", true);
    tell("ARES:1", true);
    TEST_ASSERT_FALSE(limits_are_default());
    tell("ARES:0", true);
    TEST_ASSERT_TRUE(limits_are_default());
}

void test_limits_at_their_edges_are_used(void)
{
    static const char *const lines[] = {"DMIN:1",   "DMIN:1000", "DMAX:22",   "ARES:1080", "ARES:4095",
                                        "AMIN:540", "AMAX:540",  "AMAX:1080", "SCAN:1"};
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        setUp();
        begin_pp();
        tell_all_limits_but("none");
        tell(lines[i], true);
        TEST_ASSERT_FALSE_MESSAGE(limits_are_default(), lines[i]);
    }
}

/* --- directions
 * --------------------------------------------------------------------------------------------------- */

/* 360/1024 degrees a step; hand-worked: 372 -> -4.21875, 406 -> +7.734375, 44 -> -119.53125, 725 ->
 * +119.8828125. */
void test_steps_have_directions_in_thousandths_of_a_degree(void)
{
    static const struct {
        uint16_t step;
        int32_t mdeg;
    } rows[] = {{384, 0},      {385, 352},    {383, -352},  {372, -4219}, {406, 7734},  {44, -119531},
                {725, 119883}, {128, -90000}, {640, 90000}, {0, -135000}, {768, 135000}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_EQUAL_INT32(rows[i].mdeg, scip_limits_mdeg(&scip_limits_urg04lx, rows[i].step));
    }
}

void test_every_step_comes_back_from_its_direction_and_from_a_third_of_a_step_beside_it(void)
{
    const int32_t third = 117;
    for (uint16_t step = 44; step <= 725; step++) {
        const int32_t mdeg = scip_limits_mdeg(&scip_limits_urg04lx, step);
        TEST_ASSERT_EQUAL_UINT16(step, scip_limits_step(&scip_limits_urg04lx, mdeg));
        TEST_ASSERT_EQUAL_UINT16(step, scip_limits_step(&scip_limits_urg04lx, mdeg + third));
        TEST_ASSERT_EQUAL_UINT16(step, scip_limits_step(&scip_limits_urg04lx, mdeg - third));
    }
}

void test_directions_beyond_the_window_end_at_its_edges(void)
{
    static const int32_t left[] = {119884, 180000, 360000, 360001, INT32_MAX};
    static const int32_t right[] = {-119532, -180000, -360000, -360001, INT32_MIN};
    for (size_t i = 0; i < sizeof left / sizeof left[0]; i++) {
        TEST_ASSERT_EQUAL_UINT16(725, scip_limits_step(&scip_limits_urg04lx, left[i]));
        TEST_ASSERT_EQUAL_UINT16(44, scip_limits_step(&scip_limits_urg04lx, right[i]));
    }
}

void test_another_sensor_has_other_directions(void)
{
    static const scip_limits_t utm = {23, 30000, 1440, 0, 1080, 540, 2400};
    static const scip_limits_t finest = {20, 5600, 4095, 0, 4095, 0, 600};
    TEST_ASSERT_EQUAL_INT32(135000, scip_limits_mdeg(&utm, 1080));
    TEST_ASSERT_EQUAL_INT32(-250, scip_limits_mdeg(&utm, 539));
    TEST_ASSERT_EQUAL_UINT16(1, scip_limits_step(&utm, -134750));
    TEST_ASSERT_EQUAL_INT32(360000, scip_limits_mdeg(&finest, 4095));
    TEST_ASSERT_EQUAL_UINT16(4095, scip_limits_step(&finest, 360000));
}
