#include "sense/one_frame.h"

void setUp(void)
{
    begin();
}

void tearDown(void) {}

/* A spike, 0.35 rad, less two frames of the liveliest sway, 0.05 rad each. */
void test_a_quarter_of_a_radian_in_a_frame_is_a_jump_of_either_angle_to_either_side(void)
{
    for (int axis = 0; axis < 2; axis++) {
        for (float side = -1.0F; side < 2.0F; side += 2.0F) {
            setUp();
            tilt(0.0F, 0.0F);
            tilt((axis == 0) ? 0.255F * side : 0.0F, (axis == 1) ? 0.255F * side : 0.0F);
            TEST_ASSERT_EQUAL_UINT16(1U, senses.tilt.jumped);
            TEST_ASSERT_EQUAL_UINT32(2U, senses.tilt.unfit_sequence);
            tilt((axis == 0) ? 0.245F * side : 0.0F, (axis == 1) ? 0.245F * side : 0.0F);
            TEST_ASSERT_EQUAL_UINT16(0U, senses.tilt.jumped);
            TEST_ASSERT_EQUAL_FLOAT((axis == 0) ? 0.245F * side : 0.0F, senses.tilt.roll_rad);
            TEST_ASSERT_EQUAL_FLOAT((axis == 1) ? 0.245F * side : 0.0F, senses.tilt.pitch_rad);
            TEST_ASSERT_EQUAL_UINT32(2U, senses.tilt.unfit_sequence);
        }
    }
}

/* Three spikes to one side among five frames: their median is one of them, less what the vehicle has turned.
 * In an hour of hover that comes once or twice in ten, and doubted a sight that was sound. */
void test_three_spikes_of_five_frames_move_the_tilt_of_a_swaying_vehicle_by_no_spike(void)
{
    for (unsigned spiked = 0; spiked < 32U; spiked++) {
        for (int k = 0; k < 40; k++) {
            attitude_filter_t filter;
            attitude_t raw = {.pitch_rad = 0.0F};

            setUp();
            attitude_init(&filter);
            attitude_restore(&filter, &raw);
            for (unsigned i = 0; i < 40U; i++) {
                /* 5 degrees at 0.8 Hz, from any phase */
                const float truth_rad = 0.0873F * sinf(5.03F * (0.025F * (float)i + 0.031F * (float)k));
                const bool spike = i >= 20U && i < 25U && (spiked >> (i - 20U) & 1U) != 0U;

                raw.roll_rad = truth_rad + (spike ? 0.35F : 0.0F);
                (void)attitude_step(&filter, &raw, &frame.level, &frame.median);
                tilt(frame.median.roll_rad, 0.0F);
                TEST_ASSERT_FLOAT_WITHIN(0.12F, truth_rad, senses.tilt.roll_rad);
            }
        }
    }
}

void test_the_way_through_the_half_turn_is_the_short_one(void)
{
    tilt(3.03F, 0.0F);
    tilt(-3.03F, 0.0F); /* 0.223 rad */
    TEST_ASSERT_EQUAL_FLOAT(-3.03F, senses.tilt.roll_rad);
    tilt(2.98F, 0.0F); /* 0.273 rad */
    TEST_ASSERT_EQUAL_UINT16(1U, senses.tilt.jumped);
}

void test_a_jump_within_ten_frames_of_silence_is_one_and_after_them_none(void)
{
    for (uint32_t more_us = 0U; more_us < 2U; more_us++) {
        setUp();
        tilt(0.0F, 0.0F);
        frame.arrival_us += 225000U + more_us;
        tilt(1.0F, 0.0F);
        TEST_ASSERT_EQUAL_UINT16(1U - more_us, senses.tilt.jumped);
    }
}

void test_the_time_of_a_refused_tilt_counts_as_news(void)
{
    tilt(0.0F, 0.0F);
    frame.arrival_us += 200000U;
    tilt(1.0F, 0.0F);
    frame.arrival_us += 100000U;
    tilt(1.0F, 0.0F);
    TEST_ASSERT_EQUAL_UINT16(2U, senses.tilt.jumped);
    TEST_ASSERT_EQUAL_UINT32(frame.arrival_us, senses.tilt.time_us);
}

void test_six_jumps_in_a_row_are_counted_anew_after_a_good_tilt(void)
{
    tilt(0.0F, 0.0F);
    for (int burst = 0; burst < 2; burst++) {
        for (int i = 0; i < 6; i++) {
            tilt(1.0F, 0.0F);
            TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.tilt.roll_rad);
        }
        tilt(0.0F, 0.0F);
    }
}

void test_angles_beyond_seven_radians_or_without_a_number_are_refused(void)
{
    static const float bad[] = {7.1F, -7.1F, NAN};
    for (int i = 0; i < 3; i++) {
        setUp();
        tilt(bad[i], 0.0F);
        tilt(0.0F, bad[i]);
        TEST_ASSERT_FALSE(senses.tilt.levelled);
        TEST_ASSERT_EQUAL_UINT32(2U, senses.tilt.unfit_sequence);
        TEST_ASSERT_EQUAL_UINT32(0U, senses.tilt.time_us);
    }
    tilt(6.9F, -6.9F);
    TEST_ASSERT_TRUE(senses.tilt.levelled);
}

void test_tilted_are_45_degrees_of_one_angle_or_less_of_two(void)
{
    static const struct {
        float roll_deg, pitch_deg;
        uint16_t tilted;
    } rows[] = {
        {44.5F, 0.0F, 0U}, {45.5F, 0.0F, 1U}, {0.0F, -45.5F, 1U}, {34.0F, 30.0F, 0U}, {34.0F, 33.0F, 1U}};
    for (int i = 0; i < 5; i++) {
        setUp();
        tilt(rows[i].roll_deg * DEGREE_RAD, rows[i].pitch_deg * DEGREE_RAD);
        TEST_ASSERT_EQUAL_UINT16(rows[i].tilted, senses.tilt.tilted);
    }
    NEAR(0.69528F, senses.tilt.upright); /* cos 34 cos 33 */
    tilt(0.58F, 0.56F);
    TEST_ASSERT_EQUAL_UINT16(0U, senses.tilt.tilted);
    senses.tilt.tilted = 999U;
    tilt(0.8F, 0.8F);
    tilt(0.8F, 0.8F);
    TEST_ASSERT_EQUAL_UINT16(1000U, senses.tilt.tilted); /* and does not wrap */
}

void test_a_sample_or_a_frame_counts_once(void)
{
    tilt_step(&senses.tilt, NULL, 0U, 0.1F, 0.0F, 0U);
    tilt_step(&senses.tilt, NULL, 0U, 1.0F, 0.0F, 0U);
    TEST_ASSERT_EQUAL_UINT16(0U, senses.tilt.jumped);
    tilt_step(&senses.tilt, NULL, 0U, 1.0F, 0.0F, 25000U);
    TEST_ASSERT_EQUAL_UINT16(1U, senses.tilt.jumped);
    frame.arrival_us = 25000U;
    tilt(-1.0F, 0.0F);
    TEST_ASSERT_EQUAL_UINT16(2U, senses.tilt.jumped);
    tilt_step(&senses.tilt, &frame, 1U, 0.0F, 0.0F, 0U);
    TEST_ASSERT_EQUAL_UINT16(2U, senses.tilt.jumped);
    TEST_ASSERT_EQUAL_FLOAT(0.1F, senses.tilt.roll_rad);
}

/* Between the steps of an attitude that is held (0.05 rad) and those that are no turn any more (0.25 rad),
 * and within 0.25 rad of where that rate leads from the accepted tilt. */
void test_rejected_tilts_that_go_on_turning_are_a_turn(void)
{
    static const struct {
        float first_rad, second_rad;
        bool turn;
    } rows[] = {{0.40F, 0.64F, true},  {0.40F, 0.66F, false},  {0.36F, 0.42F, false}, {0.40F, 0.60F, true},
                {0.40F, 0.54F, false}, {-0.40F, -0.60F, true}, {0.60F, 0.77F, false}, {0.43F, 0.63F, true},
                {0.40F, 0.56F, true},  {0.40F, 0.40F, false},  {0.64F, 0.40F, false}};
    for (int axis = 0; axis < 2; axis++) {
        for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
            const float first_rad = rows[i].first_rad, second_rad = rows[i].second_rad;
            setUp();
            tilt(0.0F, 0.0F);
            tilt((axis == 0) ? first_rad : 0.0F, (axis == 1) ? first_rad : 0.0F);
            TEST_ASSERT_EQUAL_UINT16(1U, senses.tilt.jumped);
            tilt((axis == 0) ? second_rad : 0.0F, (axis == 1) ? second_rad : 0.0F);
            TEST_ASSERT_EQUAL_UINT16(rows[i].turn ? 0U : 2U, senses.tilt.jumped);
        }
    }
}

void test_a_slow_turn_of_the_other_angle_is_none(void)
{
    for (int turns = 0; turns < 2; turns++) {
        setUp();
        const float rate_rad = (turns != 0) ? 0.052F : 0.048F;
        tilt(0.0F, 0.0F);
        tilt(1.0F, rate_rad);
        tilt(1.0F, 2.0F * rate_rad);
        TEST_ASSERT_EQUAL_UINT16((turns != 0) ? 0U : 2U, senses.tilt.jumped);
    }
}

void test_a_turn_goes_through_the_half_turn(void)
{
    for (float side = -1.0F; side < 2.0F; side += 2.0F) {
        setUp();
        tilt(3.0F * side, 0.0F);
        tilt(-2.88F * side, 0.0F); /* 0.4 rad on */
        TEST_ASSERT_EQUAL_UINT16(1U, senses.tilt.jumped);
        tilt(-2.68F * side, 0.0F);
        TEST_ASSERT_EQUAL_UINT16(0U, senses.tilt.jumped);
        setUp();
        tilt(2.6F * side, 0.0F);
        tilt(3.05F * side, 0.0F);
        tilt(-3.033F * side, 0.0F); /* 0.2 rad on */
        TEST_ASSERT_EQUAL_UINT16(0U, senses.tilt.jumped);
    }
}

void test_frames_that_were_level_themselves_are_no_tilt(void)
{
    for (int level = 0; level < 3; level++) {
        setUp();
        frame.sequence++;
        frame.median.roll_rad = 1.0F;
        frame.level.roll_rad = (level == 1) ? 0.78F : 0.79F;
        frame.rolled = (level == 2) ? ATTITUDE_ROLLED_FRAMES : 0;
        tilt_step(&senses.tilt, &frame, 1U, 0.0F, 0.0F, 0U);
        TEST_ASSERT_EQUAL_UINT16((level == 0) ? 1U : (level == 1) ? 0U : 1000U, senses.tilt.tilted);
    }
}

/* ---- what the mirrors show */

/* Writes the slants of three mirrors of a vehicle at this tilt, over even ground: the inverse of
 * altitude_at_tilt(). */
static void show(altitude_t shown[MIRROR_COUNT], float height_mm, float roll_rad, float pitch_rad)
{
    static const struct {
        float distance_mm, arm_mm, fore_mm;
    } places[MIRROR_COUNT] = {{105.0F, 220.0F, 0.0F}, {105.0F, 115.0F, 105.0F}, {105.0F, 115.0F, -105.0F}};

    for (int m = 0; m < MIRROR_COUNT; m++) {
        altitude_t *one = &shown[m];

        *one = (altitude_t){.valid = true,
                            .distance_mm = places[m].distance_mm,
                            .leg_mm = 100.0F,
                            .arm_mm = places[m].arm_mm,
                            .fore_mm = places[m].fore_mm};
        one->slant_mm = one->distance_mm + (height_mm + one->leg_mm + one->arm_mm * sinf(roll_rad) +
                                            one->fore_mm * sinf(pitch_rad)) /
                                               (cosf(roll_rad) * cosf(pitch_rad));
    }
}

static float astray_mm; /* not 0: the height before */

/* Frames at 40 Hz that tell one tilt, scans at 10 Hz that show another. Returns whether the last was
 * accepted. */
static bool tells(const float told_deg[2], const float true_deg[2], float height_mm, uint16_t count,
                  bool aloft)
{
    for (int k = 0; k < 40; k++) {
        altitude_t shown[MIRROR_COUNT];

        tilt(told_deg[0] * DEGREE_RAD, told_deg[1] * DEGREE_RAD);
        show(shown, height_mm, true_deg[0] * DEGREE_RAD, true_deg[1] * DEGREE_RAD);
        if (k % 4 == 3) {
            tilt_scan(&senses.tilt, shown, count, (astray_mm != 0.0F) ? astray_mm : height_mm, 0.0F, aloft);
        }
    }
    return senses.tilt.jumped == 0U;
}

void test_a_jump_of_the_attitude_is_not_accepted_while_the_slants_are_those_of_a_level_vehicle(void)
{
    static const float level[2] = {0.0F, 0.0F};
    static const float jumps[][2] = {{30.0F, 0.0F},   {0.0F, -30.0F}, {60.0F, 0.0F},    {-90.0F, 20.0F},
                                     {120.0F, 10.0F}, {0.0F, 80.0F},  {-170.0F, -20.0F}};

    for (uint16_t count = 1U; count <= MIRROR_COUNT; count = (uint16_t)(count + 2U)) {
        for (size_t i = 0; i < sizeof jumps / sizeof jumps[0]; i++) {
            setUp();
            TEST_ASSERT_TRUE(tells(level, level, 800.0F, count, true));
            TEST_ASSERT_FALSE(tells(jumps[i], level, 800.0F, count, true));
            TEST_ASSERT_EQUAL_UINT16(0U, senses.tilt.tilted);
            TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.tilt.roll_rad);
            TEST_ASSERT_EQUAL_UINT32(frame.sequence, senses.tilt.unfit_sequence);
            TEST_ASSERT_TRUE(tells(level, level, 800.0F, count, true));
        }
    }
}

/* 0.8 m/s for a second: at 84 degrees the slants of the end would fit the height of the beginning. */
void test_a_jump_of_the_attitude_is_not_accepted_in_a_climb(void)
{
    for (uint16_t count = 1U; count <= MIRROR_COUNT; count = (uint16_t)(count + 2U)) {
        setUp();
        for (int k = 0; k < 80; k++) {
            altitude_t shown[MIRROR_COUNT];
            const float height_mm = 500.0F + 20.0F * (float)(k - 40);

            tilt((k >= 40) ? -71.0F * DEGREE_RAD : 0.0F, (k >= 40) ? 43.0F * DEGREE_RAD : 0.0F);
            show(shown, (height_mm > 500.0F) ? height_mm : 500.0F, 0.0F, 0.0F);
            if (k % 4 == 3) {
                tilt_scan(&senses.tilt, shown, count, (k < 44) ? 500.0F : height_mm - 80.0F,
                          (k < 44) ? 0.0F : 80.0F, true);
            }
            TEST_ASSERT_EQUAL_INT((k < 40) ? 1 : 0, (senses.tilt.jumped == 0U) ? 1 : 0);
            TEST_ASSERT_EQUAL_UINT16(0U, senses.tilt.tilted);
        }
    }
}

void test_a_vehicle_that_is_tilted_like_that_is_believed(void)
{
    static const float level[2] = {0.0F, 0.0F};
    static const float tilts[][2] = {
        {30.0F, 0.0F}, {0.0F, -30.0F}, {60.0F, 0.0F}, {-50.0F, 20.0F}, {0.0F, 70.0F}};

    for (uint16_t count = 1U; count <= MIRROR_COUNT; count = (uint16_t)(count + 2U)) {
        for (size_t i = 0; i < sizeof tilts / sizeof tilts[0]; i++) {
            setUp();
            TEST_ASSERT_TRUE(tells(level, level, 800.0F, count, true));
            TEST_ASSERT_TRUE(tells(tilts[i], tilts[i], 800.0F, count, true));
            TEST_ASSERT_EQUAL_FLOAT(tilts[i][0] * DEGREE_RAD, senses.tilt.roll_rad);
        }
    }
}

void test_on_the_ground_nothing_is_refuted(void)
{
    static const float level[2] = {0.0F, 0.0F};
    static const float over[2] = {90.0F, 0.0F};

    TEST_ASSERT_TRUE(tells(level, level, 0.0F, MIRROR_COUNT, false));
    TEST_ASSERT_TRUE(tells(over, level, 0.0F, MIRROR_COUNT, false));
    TEST_ASSERT_TRUE(senses.tilt.tilted > 3U);
}

/* Slow enough for no jump: the height before has gone astray with the tilt, and goes on doing so. Only what
 * the mirrors show together tells it. One mirror can not. */
void test_an_attitude_that_wanders_away_is_refuted_beyond_20_degrees_by_three_mirrors(void)
{
    static const float level[2] = {0.0F, 0.0F};

    for (uint16_t count = 1U; count <= MIRROR_COUNT; count = (uint16_t)(count + 2U)) {
        setUp();
        for (float deg = 0.0F; deg < 60.0F; deg += 4.0F) {
            const float told[2] = {deg, 0.0F};
            astray_mm = 900.0F * cosf(deg * DEGREE_RAD) - 100.0F - 220.0F * sinf(deg * DEGREE_RAD);
            (void)tells(told, level, 800.0F, count, true);
            astray_mm = 0.0F;
            TEST_ASSERT_EQUAL_INT((count == 1U || deg < 20.5F) ? 1 : 0, (senses.tilt.jumped == 0U) ? 1 : 0);
        }
        TEST_ASSERT_EQUAL_INT((count == 1U) ? 1 : 0, (senses.tilt.tilted > 3U) ? 1 : 0);
        TEST_ASSERT_EQUAL_INT((count == 1U) ? 0 : 1, (senses.tilt.roll_rad == 0.0F) ? 1 : 0);
    }
}

/* One scan of a vehicle at this tilt, the ground below its front mirror edge_mm higher. */
static void scan_at(const float true_deg[2], float edge_mm)
{
    altitude_t shown[MIRROR_COUNT];

    show(shown, 800.0F, true_deg[0] * DEGREE_RAD, true_deg[1] * DEGREE_RAD);
    shown[MIRROR_FRONT].slant_mm -= edge_mm;
    tilt_scan(&senses.tilt, shown, MIRROR_COUNT, 800.0F, 0.0F, true);
}

/* 0.1 m below the front mirror make a roll of 30 degrees look level for it. */
void test_an_edge_refutes_no_slow_tilt_that_the_mirrors_have_shown(void)
{
    static const float tilts[][2] = {{15.0F, 0.0F}, {30.0F, 0.0F}};

    TEST_ASSERT_TRUE(tells(tilts[0], tilts[0], 800.0F, MIRROR_COUNT, true));
    TEST_ASSERT_TRUE(tells(tilts[1], tilts[1], 800.0F, MIRROR_COUNT, true));
    for (int k = 0; k < 4; k++) {
        scan_at(tilts[1], 100.0F);
        tilt(tilts[1][0] * DEGREE_RAD, 0.0F);
        TEST_ASSERT_EQUAL_FLOAT(30.0F * DEGREE_RAD, senses.tilt.roll_rad);
    }
}

void test_one_scan_that_shows_the_tilt_does_not_cut_a_vehicle_whose_attitude_has_wandered_away(void)
{
    static const float level[2] = {0.0F, 0.0F};
    float told[2] = {0.0F, 0.0F};

    for (; told[0] < 44.0F; told[0] += 4.0F) {
        (void)tells(told, level, 800.0F, MIRROR_COUNT, true);
    }
    for (; told[0] < 60.0F; told[0] += 4.0F) {
        scan_at(told, 0.0F);
        for (int k = 0; k < 4; k++) {
            tilt(told[0] * DEGREE_RAD, 0.0F);
        }
        TEST_ASSERT_EQUAL_UINT16(0U, senses.tilt.tilted);
        (void)tells(told, level, 800.0F, MIRROR_COUNT, true);
    }
}

void test_a_level_tilt_is_accepted_at_once_after_one_that_was_refuted(void)
{
    static const float level[2] = {0.0F, 0.0F};
    float told[2] = {0.0F, 0.0F};

    for (; told[0] < 32.0F; told[0] += 4.0F) {
        (void)tells(told, level, 800.0F, MIRROR_COUNT, true);
    }
    TEST_ASSERT_TRUE(senses.tilt.jumped > 0U);
    tilt(5.0F * DEGREE_RAD, 0.0F); /* before the next scan */
    TEST_ASSERT_EQUAL_UINT16(0U, senses.tilt.jumped);
    TEST_ASSERT_EQUAL_FLOAT(5.0F * DEGREE_RAD, senses.tilt.roll_rad);
}

/* The belief doubts all mirrors for such a tilt. */
void test_what_was_refuted_stays_so_while_the_scans_show_nothing(void)
{
    static const float level[2] = {0.0F, 0.0F};
    static const altitude_t nothing[MIRROR_COUNT] = {{.valid = false}};
    float told[2] = {0.0F, 0.0F};

    for (; told[0] < 32.0F; told[0] += 4.0F) {
        (void)tells(told, level, 800.0F, MIRROR_COUNT, true);
    }
    for (int k = 0; k < 40; k++) {
        tilt_scan(&senses.tilt, nothing, MIRROR_COUNT, 800.0F, 0.0F, true);
        tilt((30.0F + (float)k) * DEGREE_RAD, 0.0F);
        TEST_ASSERT_EQUAL_UINT16(0U, senses.tilt.tilted);
        TEST_ASSERT_TRUE(senses.tilt.jumped > 0U);
    }
}

void test_without_scans_the_seventh_frame_is_accepted_ten_frames_after_the_latest(void)
{
    static const float level[2] = {0.0F, 0.0F};
    static const float over[2] = {90.0F, 0.0F};
    int frames = 0;

    (void)tells(level, level, 800.0F, MIRROR_COUNT, true);
    (void)tells(over, level, 800.0F, MIRROR_COUNT, true);
    while (senses.tilt.jumped > 0U && frames < 100) {
        tilt(90.0F * DEGREE_RAD, 0.0F);
        frames++;
    }
    TEST_ASSERT_EQUAL_INT(11, frames);
}
