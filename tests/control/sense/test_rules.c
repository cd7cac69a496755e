/* Every limit of the rules, from both sides. A limit that moves, or a condition that falls out, changes what
 * a flight doubts; it has to be changed here on purpose. */
#include "sense/judged.h"

void setUp(void)
{
    evidence_begin();
}

void tearDown(void) {}

/* The same on the evidence that setUp() makes and `change` changes. */
static uint16_t judged_with(void (*change)(float), float value, float felt_m, float pushed_m)
{
    setUp();
    change(value);
    return judged(felt_m, pushed_m);
}

static void nothing(float value)
{
    (void)value;
}
static void felt_for(float s)
{
    senses.accelerometer.felt.running_s = s;
}
static void pushed_for(float s)
{
    senses.push.pushed.running_s = s;
}
static void shaken(float times)
{
    shaken_by(times);
}
static void without_imu(float value)
{
    (void)value;
    doubted(DOUBT_IMU);
}
static void way(float m)
{
    has_moved_m(m);
}

typedef struct {
    void (*change)(float);
    float value, felt_m, pushed_m;
    uint16_t doubts;
} row_t;

static void check(const row_t *rows, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        char which[24] = "row ";
        which[4] = (char)('0' + i / 10U);
        which[5] = (char)('0' + i % 10U);
        TEST_ASSERT_EQUAL_UINT16_MESSAGE(
            rows[i].doubts, judged_with(rows[i].change, rows[i].value, rows[i].felt_m, rows[i].pushed_m),
            which);
    }
}
#define CHECK(rows) check(rows, sizeof(rows) / sizeof((rows)[0]))

/* ---- DOUBT_SIGHT: a climb that the heights do not show */

/* The heights moved a moment ago. */
static uint16_t climb(float slower_mps, float rise_mps, float felt_m, float pushed_m)
{
    setUp();
    last_moved_s_ago(0.0F);
    slower_is_mps(slower_mps);
    rises_mps(rise_mps);
    return judged(felt_m, pushed_m);
}

void test_a_climb_of_both_witnesses_doubts_heights_that_have_stopped_at_once(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, climb(0.61F, 0.0F, -0.26F, -0.11F));
    TEST_ASSERT_EQUAL_UINT16(0U, climb(0.60F, 0.0F, -0.26F, -0.11F));
    TEST_ASSERT_EQUAL_UINT16(0U, climb(-0.61F, 0.0F, -0.26F, -0.11F));
    TEST_ASSERT_EQUAL_UINT16(0U, climb(0.61F, 0.0F, -0.25F, -0.11F));
    TEST_ASSERT_EQUAL_UINT16(0U, climb(0.61F, 0.0F, -0.26F, -0.10F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, climb(0.80F, 0.19F, -0.26F, -0.11F));
    TEST_ASSERT_EQUAL_UINT16(0U, climb(0.78F, 0.19F, -0.26F, -0.11F));
    TEST_ASSERT_EQUAL_UINT16(0U, climb(1.00F, 0.21F, -0.26F, -0.11F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, climb(0.42F, -0.19F, -0.26F, -0.11F));
    TEST_ASSERT_EQUAL_UINT16(0U, climb(1.00F, -0.21F, -0.26F, -0.11F));
}

/* A slant that is noise doubts the heights, whatever the witnesses tell. */
static uint16_t judged_with_white(float felt_m, float pushed_m, float pushed_s, uint16_t doubts)
{
    setUp();
    white_scans(40U);
    doubted(doubts);
    senses.push.pushed.running_s = pushed_s;
    return judged(felt_m, pushed_m);
}

static uint16_t climb_with(uint16_t doubts, float shaken, float felt_s, float pushed_s)
{
    setUp();
    last_moved_s_ago(0.0F);
    slower_is_mps(1.0F);
    doubted(doubts);
    shaken_by(shaken);
    senses.accelerometer.felt.running_s = felt_s;
    senses.push.pushed.running_s = pushed_s;
    return (uint16_t)(judged(-0.3F, -0.2F) & DOUBT_SIGHT);
}

void test_a_climb_unseen_needs_both_witnesses_and_a_quiet_accelerometer(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, climb_with(0U, 1.0F, 2.0F, 2.0F));
    TEST_ASSERT_EQUAL_UINT16(0U, climb_with(DOUBT_IMU, 1.0F, 2.0F, 2.0F));
    TEST_ASSERT_EQUAL_UINT16(0U, climb_with(0U, 1.3F, 2.0F, 2.0F));
    TEST_ASSERT_EQUAL_UINT16(0U, climb_with(0U, 1.0F, 0.5F, 2.0F));
    TEST_ASSERT_EQUAL_UINT16(0U, climb_with(0U, 1.0F, 2.0F, 0.5F));
}

void test_the_error_of_the_height_is_the_mean_of_the_witnesses_that_count(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, climb(1.0F, 0.0F, -0.52F, -0.30F));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, -0.41F, verdict.lost_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.seen_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.push.pushed.off_m);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged_with_white(-0.7F, 5.0F, 0.3F, 0U));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, -0.7F, verdict.lost_m);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU | DOUBT_SIGHT, judged_with_white(0.7F, -0.3F, 2.0F, DOUBT_IMU));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, -0.3F, verdict.lost_m);
}

/* ---- DOUBT_SIGHT: below the ground */

void test_three_heights_below_the_ground_doubt_the_heights_of_a_law_that_wants_to_climb(void)
{
    static const struct {
        float height_m, wanted_m;
        uint16_t doubts;
    } rows[] = {{-0.036F, 0.6F, DOUBT_SIGHT}, {-0.034F, 0.6F, 0U}, {-0.036F, 0.1F, 0U}, {-0.036F, NAN, 0U}};
    for (int i = 0; i < 4; i++) {
        setUp();
        ground_is_m(-0.01F);
        at_m(rows[i].height_m);
        flown.wanted_m = rows[i].wanted_m;
        TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, 0.0F));
        TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, 0.0F));
        TEST_ASSERT_EQUAL_UINT16(rows[i].doubts, judged(0.0F, 0.0F));
    }
    setUp();
    senses.confirmation.sunk = 2U;
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, 0.0F)); /* a good one between starts the count again */
    TEST_ASSERT_EQUAL_UINT16(0U, senses.confirmation.sunk);
}

/* ---- DOUBT_SIGHT: a still slant */

static void flat(float wanted_m)
{
    senses.beam.flat = true;
    white_scans(6U);
    flown.wanted_m = wanted_m;
}
static void flat_by_chance(float wanted_m)
{
    flat(wanted_m);
    white_scans(5U);
}

static void flat_and_moved(float unmoved_s)
{
    flat(0.09F);
    last_moved_s_ago(unmoved_s);
}

void test_a_slant_that_varies_little_doubts_heights_near_the_reference(void)
{
    static const row_t rows[] = {
        {flat, 0.09F, -0.16F, -0.51F, DOUBT_SIGHT}, {flat, 0.09F, -0.14F, -0.51F, 0},
        {flat, 0.09F, -0.16F, -0.49F, 0},           {flat, 0.09F, 0.16F, -0.51F, 0},
        {flat_by_chance, 0.09F, -0.16F, -0.51F, 0}, {flat, 0.09F, 0.16F, 0.51F, DOUBT_SIGHT},
        {flat_and_moved, 0.9F, -0.16F, -0.51F, 0},  {flat_and_moved, 1.0F, -0.16F, -0.51F, DOUBT_SIGHT},
    };
    CHECK(rows);
}

static uint16_t slant(uint16_t rigid, uint16_t still, float felt_m, float pushed_m)
{
    setUp();
    rigid_scans(rigid);
    still_scans(still);
    return judged(felt_m, pushed_m);
}

static uint16_t noisy_slant(uint16_t rigid, uint16_t white, float felt_m, float pushed_m)
{
    setUp();
    rigid_scans(rigid);
    white_scans(white);
    return judged(felt_m, pushed_m);
}

void test_a_slant_of_noise_for_four_seconds_is_a_blocked_beam(void)
{
    TEST_ASSERT_EQUAL_UINT16(0U, noisy_slant(0U, 39U, 0.0F, 0.0F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, noisy_slant(0U, 40U, 0.0F, 0.0F));
}

void test_a_swaying_tilt_and_a_rigid_slant_are_a_blocked_beam(void)
{
    setUp();
    rigid_scans(16U);
    sways_rad2(4.0e-4F);
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, 0.0F));
    sways_rad2(4.1e-4F);
    rigid_scans(15U);
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, 0.0F));
    rigid_scans(16U);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged(0.0F, 0.0F));
}

/* ---- DOUBT_SIGHT: unconfirmed */

/* A step towards the vehicle was seen; the law pushes push_n towards wanted_m. */
static uint16_t since_step(float push_n, float wanted_m, float felt_m, float pushed_m)
{
    setUp();
    is_unconfirmed(true);
    flown.hover_n = 0.0F; /* so that the difference is exact */
    pushes_n(push_n);
    flown.wanted_m = wanted_m;
    return judged(felt_m, pushed_m);
}

void test_a_push_in_vain_after_a_step_towards_the_vehicle_doubts_the_heights(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, since_step(0.21F, 0.5F, 0.0F, -0.36F));
    TEST_ASSERT_EQUAL_UINT16(0U, since_step(0.20F, 0.5F, 0.0F, -0.36F));
    TEST_ASSERT_EQUAL_UINT16(0U, since_step(0.21F, 0.5F, 0.0F, -0.35F));
    TEST_ASSERT_EQUAL_UINT16(0U, since_step(0.21F, 0.5F, 0.0F, 0.36F));
    TEST_ASSERT_EQUAL_UINT16(0U, since_step(0.21F, -0.5F, 0.0F, -0.36F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, since_step(-0.21F, -0.5F, 0.0F, 0.36F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, since_step(0.21F, 0.003F, 0.0F, -0.36F));
    TEST_ASSERT_EQUAL_UINT16(0U, since_step(0.21F, 0.0F, 0.0F, -0.36F));
}

void test_that_needs_no_accelerometer_but_an_old_witness_and_heights_that_do_not_move(void)
{
    static const struct {
        float pushed_for_s, unmoved_s;
        uint16_t doubts;
    } rows[] = {{2.0F, 1.0F, DOUBT_SIGHT}, {1.9F, 1.0F, 0U}, {2.0F, 0.9F, 0U}};
    for (int i = 0; i < 3; i++) {
        setUp();
        is_unconfirmed(true);
        pushes_n(HOVER_N + 0.3F);
        senses.push.pushed.running_s = rows[i].pushed_for_s;
        last_moved_s_ago(rows[i].unmoved_s);
        TEST_ASSERT_EQUAL_UINT16(rows[i].doubts, judged(0.0F, -0.36F));
    }
    setUp();
    is_unconfirmed(true);
    doubted(DOUBT_IMU);
    pushes_n(HOVER_N + 0.3F);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, judged(0.0F, -0.35F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU | DOUBT_SIGHT, judged(0.0F, -0.36F));
}

void test_the_first_climb_is_the_accelerometers_to_tell(void)
{
    static const struct {
        bool unconfirmed, proved;
        float felt_m, running_s, way_m;
        uint16_t doubts;
    } rows[] = {
        {true, false, -0.36F, 2.0F, 0.0F, DOUBT_SIGHT},
        {true, false, -0.35F, 2.0F, 0.0F, 0},
        {true, false, 0.36F, 2.0F, 0.0F, 0},
        {false, false, -0.36F, 2.0F, 0.0F, 0},
        {true, true, -0.36F, 2.0F, 0.0F, 0},
        {true, false, -0.36F, 0.5F, 0.0F, 0},
        {true, false, -0.36F, 2.0F, 0.16F, 0},
        {true, false, -0.59F, 2.0F, 0.0F, DOUBT_SIGHT},
        {true, false, -0.70F, 2.0F, 0.16F, DOUBT_IMU},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        setUp();
        is_unconfirmed(rows[i].unconfirmed);
        is_proved(rows[i].proved);
        senses.accelerometer.felt.running_s = rows[i].running_s;
        has_moved_m(rows[i].way_m);
        TEST_ASSERT_EQUAL_UINT16(rows[i].doubts, judged(rows[i].felt_m, 0.0F));
    }
}

/* ---- DOUBT_SIGHT: on the ground by the heights alone */

static uint16_t lift_off(float height_m, uint16_t rigid, uint16_t still, float sway_rad2, float felt_m)
{
    setUp();
    flown.standing = senses.standing = true;
    at_m(height_m);
    swayed_from_m(height_m);
    rigid_scans(rigid);
    still_scans(still);
    sways_rad2(sway_rad2);
    return judged(felt_m, 0.0F);
}

void test_a_climb_felt_before_an_odd_beam_shows_it_doubts_the_heights(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, lift_off(0.0F, 2U, 0U, 4.1e-4F, -0.091F));
    TEST_ASSERT_EQUAL_UINT16(0U, lift_off(0.0F, 2U, 0U, 4.1e-4F, -0.090F));
    TEST_ASSERT_EQUAL_UINT16(0U, lift_off(0.0F, 2U, 0U, 4.0e-4F, -0.091F));
    TEST_ASSERT_EQUAL_UINT16(0U, lift_off(0.0F, 1U, 0U, 4.1e-4F, -0.091F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, lift_off(0.091F, 0U, 9U, 4.1e-4F, -0.091F));
    TEST_ASSERT_EQUAL_UINT16(0U, lift_off(0.09F, 0U, 9U, 4.1e-4F, -0.091F));
    TEST_ASSERT_EQUAL_UINT16(0U, lift_off(0.091F, 0U, 8U, 4.1e-4F, -0.091F));
}

void test_a_vehicle_that_is_off_the_ground_is_not_asked_about_its_lift_off(void)
{
    rigid_scans(2U);
    is_unconfirmed(true);
    sways_rad2(4.1e-4F);
    TEST_ASSERT_EQUAL_UINT16(0U, judged(-0.09F, 0.0F));
    has_swayed_s(1.6F);
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, 0.0F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, verdict.rules.swaying_s);
}

/* One height 0.1 s after the last; how long the tilt has swayed then. */
static float swayed_s(float height_m, uint16_t still, float sway_rad2)
{
    setUp();
    flown.standing = senses.standing = true;
    at_m(height_m);
    still_scans(still);
    sways_rad2(sway_rad2);
    has_swayed_s(1.0F);
    sensed_height(&flown, height_m, 0.1F, 0.0F);
    return verdict.rules.swaying_s;
}

void test_a_sway_counts_while_the_beam_is_still_and_the_height_the_same(void)
{
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 1.1F, swayed_s(0.04F, 9U, 4.1e-4F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, swayed_s(0.041F, 9U, 4.1e-4F));
    TEST_ASSERT_EQUAL_FLOAT(0.041F, verdict.rules.swaying_from_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, swayed_s(-0.041F, 9U, 4.1e-4F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, swayed_s(0.04F, 8U, 4.1e-4F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, swayed_s(0.04F, 9U, 4.0e-4F));
}

void test_the_height_of_a_sway_is_measured_from_its_start(void)
{
    flown.standing = senses.standing = true;
    at_m(0.34F);
    swayed_from_m(0.30F);
    still_scans(9U);
    sways_rad2(4.1e-4F);
    has_swayed_s(1.0F);
    (void)judged(0.0F, 0.0F);
    TEST_ASSERT_EQUAL_FLOAT(1.0F, verdict.rules.swaying_s);
    TEST_ASSERT_EQUAL_FLOAT(0.30F, verdict.rules.swaying_from_m);
}

void test_a_sway_of_more_than_a_second_and_a_half_is_a_flight(void)
{
    flown.standing = senses.standing = true;
    at_m(0.0F);
    still_scans(9U);
    sways_rad2(4.1e-4F);
    has_swayed_s(1.5F);
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, 0.0F));
    has_swayed_s(1.51F);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged(0.0F, 0.0F));
}

/* ---- DOUBT_IMU */

void test_an_accelerometer_alone_against_the_heights_is_doubted(void)
{
    static const row_t rows[] = {
        {nothing, 0, 0.61F, 0.0F, DOUBT_IMU}, {nothing, 0, -0.61F, 0.0F, DOUBT_IMU},
        {nothing, 0, 0.60F, 0.0F, 0},         {nothing, 0, 0.62F, 0.27F, DOUBT_IMU},
        {nothing, 0, 0.62F, 0.29F, 0},        {nothing, 0, 0.62F, -0.29F, DOUBT_IMU},
        {pushed_for, 0.5F, 0.61F, 0, 0},      {without_imu, 0, 0.61F, 0, DOUBT_IMU},
        {felt_for, 0.5F, 0.61F, 0.0F, 0},     {shaken, 2.0F, 1.22F, 0.0F, DOUBT_IMU},
        {shaken, 2.0F, 1.18F, 0.0F, 0},
    };
    CHECK(rows);
    TEST_ASSERT_EQUAL_UINT16(0U, slant(0U, 9U, 0.61F, 0.0F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, slant(0U, 8U, 0.61F, 0.0F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.seen_m);
}

void test_heights_that_move_are_right_against_both_witnesses(void)
{
    static const row_t rows[] = {
        {way, 0.16F, -0.52F, -0.30F, DOUBT_IMU}, {way, -0.16F, 0.52F, 0.30F, DOUBT_IMU},
        {way, 0.16F, -0.50F, -0.52F, 0},         {way, 0.16F, -0.52F, -0.28F, 0},
        {way, 0.15F, -0.52F, -0.30F, 0},         {nothing, 0, -0.62F, -0.30F, 0},
    };
    CHECK(rows);
}

/* ---- DOUBT_THRUST */

static uint16_t powerless(float push_n, float wanted_m, float felt_m, float pushed_m)
{
    setUp();
    flown.hover_n = 0.0F;
    pushes_n(push_n);
    flown.wanted_m = wanted_m;
    return judged(felt_m, pushed_m);
}

void test_a_thrust_without_effect_is_doubted_where_heights_and_accelerometer_agree(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, powerless(0.71F, 0.5F, 0.0F, -1.31F));
    TEST_ASSERT_FALSE(verdict.held_down);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.push.pushed.seen_m);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, powerless(-0.71F, -0.16F, 0.0F, 1.31F));
    TEST_ASSERT_TRUE(verdict.held_down);
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, 0.5F, 0.0F, -1.30F));
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.70F, 0.5F, 0.0F, -1.31F));
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, 0.15F, 0.0F, -1.31F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, powerless(0.71F, 0.5F, 0.20F, -1.31F));
    TEST_ASSERT_EQUAL_UINT16(0U, powerless(0.71F, 0.5F, 0.21F, -1.31F));
}

void test_a_thrust_that_was_never_proved_or_has_no_second_witness_is_not_doubted(void)
{
    pushes_n(HOVER_N + 1.0F);
    is_proved(false);
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, -1.4F));
    is_proved(true);
    senses.accelerometer.felt.running_s = 0.5F;
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, -1.4F));
    senses.accelerometer.felt.running_s = 2.0F;
    TEST_ASSERT_EQUAL_UINT16(DOUBT_THRUST, judged(0.0F, -1.4F));
    TEST_ASSERT_EQUAL_FLOAT(HOVER_N, verdict.held_n);
}

void test_a_thrust_that_lifts_any_vehicle_makes_a_sway_count_three_times(void)
{
    for (int strong = 0; strong < 2; strong++) {
        setUp();
        flown.standing = senses.standing = true;
        at_m(0.0F);
        swayed_from_m(0.0F);
        sways_rad2(4.1e-4F);
        has_swayed_s(1.0F);
        pushes_n(HOVER_N * ((strong != 0) ? 1.301F : 1.299F));
        sensed_height(&flown, 0.0F, 0.1F, 0.0F);
        TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, (strong != 0) ? 1.3F : 0.0F, verdict.rules.swaying_s);
    }
}
