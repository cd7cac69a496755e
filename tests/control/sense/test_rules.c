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
static void want(float m)
{
    flown.wanted_m = m;
}
static void rising(float mps)
{
    rises_mps(mps);
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

/* ---- DOUBT_SIGHT: both witnesses */

void test_both_witnesses_together_doubt_the_heights_one_by_half_a_metre(void)
{
    static const row_t rows[] = {
        {nothing, 0, -0.51F, -0.29F, DOUBT_SIGHT},
        {nothing, 0, -0.50F, -0.29F, 0},
        {nothing, 0, -0.29F, -0.51F, DOUBT_SIGHT},
        {nothing, 0, -0.29F, -0.50F, 0},
        {nothing, 0, -0.51F, -0.28F, 0},
        {nothing, 0, -0.28F, -0.51F, 0},
        {nothing, 0, 0.51F, 0.29F, DOUBT_SIGHT},
        {nothing, 0, 0.51F, -0.29F, 0},
        {nothing, 0, -0.51F, 0.29F, 0},
    };
    CHECK(rows);
}

static void slant_alive(float wanted_m)
{
    still_scans(0U);
    flown.wanted_m = wanted_m;
}

void test_a_slant_that_changes_with_the_tilt_asks_for_more_of_it(void)
{
    static const row_t rows[] = {
        {slant_alive, 0.5F, -0.71F, -0.40F, DOUBT_SIGHT}, {slant_alive, 0.5F, -0.69F, -0.40F, 0},
        {slant_alive, 0.5F, -0.71F, -0.38F, 0},           {slant_alive, 0.09F, -1.27F, -0.71F, DOUBT_SIGHT},
        {slant_alive, 0.09F, -1.25F, -0.71F, 0},
    };
    CHECK(rows);
}

void test_a_law_near_its_reference_asks_nearly_twice_as_much(void)
{
    static const row_t rows[] = {
        {want, 0.09F, -0.92F, -0.51F, DOUBT_SIGHT}, {want, 0.09F, -0.89F, -0.51F, 0},
        {want, 0.09F, -0.92F, -0.50F, 0},           {want, -0.09F, -0.51F, -0.29F, 0},
        {want, 0.10F, -0.51F, -0.29F, DOUBT_SIGHT}, {want, -0.11F, -0.51F, -0.29F, DOUBT_SIGHT},
        {want, NAN, -0.51F, -0.29F, DOUBT_SIGHT},
    };
    CHECK(rows);
}

void test_a_slant_that_varies_little_asks_less_also_near_the_reference(void)
{
    static const row_t rows[] = {
        {flat, 0.09F, -0.16F, -0.51F, DOUBT_SIGHT}, {flat, 0.09F, -0.14F, -0.51F, 0},
        {flat, 0.09F, -0.16F, -0.49F, 0},           {flat, 0.09F, 0.16F, -0.51F, 0},
        {flat_by_chance, 0.09F, -0.16F, -0.51F, 0}, {flat, 0.09F, 0.16F, 0.51F, DOUBT_SIGHT},
        {flat, 0.09F, -0.51F, -0.29F, DOUBT_SIGHT},
    };
    CHECK(rows);
}

void test_heights_that_move_are_not_doubted(void)
{
    static const row_t rows[] = {
        {rising, 0.199F, -0.51F, -0.29F, DOUBT_SIGHT},
        {rising, -0.199F, -0.51F, -0.29F, DOUBT_SIGHT},
        {rising, 0.20F, -0.51F, -0.29F, 0},
        {rising, -0.20F, -0.51F, -0.29F, 0},
        {last_moved_s_ago, 0.99F, -0.51F, -0.29F, 0},
        {way, 0.10F, -0.45F, -0.51F, DOUBT_SIGHT},
        {way, 0.101F, -0.45F, -0.51F, 0},
        {way, -0.101F, -0.45F, -0.51F, 0},
    };
    CHECK(rows);
}

void test_a_witness_counts_after_half_a_second(void)
{
    static const row_t rows[] = {
        {felt_for, 0.5F, -0.51F, -0.29F, 0},
        {felt_for, 0.51F, -0.51F, -0.29F, DOUBT_SIGHT},
        {pushed_for, 0.5F, -0.51F, -0.29F, 0},
        {pushed_for, 0.51F, -0.51F, -0.29F, DOUBT_SIGHT},
    };
    CHECK(rows);
}

void test_a_noisy_accelerometer_has_to_be_further_off(void)
{
    static const row_t rows[] = {
        {shaken, 2.0F, -1.02F, -0.29F, DOUBT_SIGHT},
        {shaken, 2.0F, -0.99F, -0.29F, 0},
        {shaken, 2.0F, -0.57F, -0.51F, DOUBT_SIGHT},
        {shaken, 2.0F, -0.55F, -0.51F, 0},
    };
    CHECK(rows);
}

void test_the_accelerometer_alone_doubts_the_heights_beyond_six_decimetres(void)
{
    static const row_t rows[] = {
        {pushed_for, 0.3F, -0.61F, 0, DOUBT_SIGHT},
        {pushed_for, 0.3F, 0.61F, 0, DOUBT_SIGHT},
        {pushed_for, 0.3F, -0.60F, 0, 0},
        {pushed_for, 0.3F, 0.60F, 0, 0},
    };
    CHECK(rows);
}

static void low_and_still(float scans)
{
    pushed_for(0.3F);
    at_m(0.05F);
    still_scans((uint16_t)scans);
}
void test_near_the_ground_the_accelerometer_alone_doubts_only_a_still_beam(void)
{
    static const row_t rows[] = {
        {low_and_still, 8.0F, -0.7F, 0, 0},
        {low_and_still, 8.0F, 0.7F, 0, 0},
        {low_and_still, 9.0F, -0.7F, 0, DOUBT_SIGHT},
        {low_and_still, 9.0F, 0.7F, 0, DOUBT_SIGHT},
    };
    CHECK(rows);
}

void test_the_error_of_the_height_is_the_mean_of_the_witnesses_that_count(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged(-0.52F, -0.30F));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, -0.41F, verdict.lost_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.felt.seen_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.push.pushed.off_m);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged_with(pushed_for, 0.3F, -0.7F, 5.0F));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, -0.7F, verdict.lost_m);
    setUp();
    doubted(DOUBT_IMU);
    white_scans(19U);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU | DOUBT_SIGHT, judged(0.7F, -0.3F));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-4F, -0.3F, verdict.lost_m);
}

/* ---- DOUBT_SIGHT: both run away */

static uint16_t run_away(float felt_mps, float pushed_mps, float rise_mps, float felt_m, float pushed_m)
{
    setUp();
    senses.accelerometer.felt.speed_mps = felt_mps;
    senses.push.pushed.speed_mps = pushed_mps;
    rises_mps(rise_mps);
    return judged(felt_m, pushed_m);
}

void test_both_witnesses_in_a_fast_climb_doubt_heights_that_stand(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, run_away(0.71F, 0.71F, 0.0F, -0.39F, -0.39F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, run_away(-0.71F, -0.71F, 0.0F, 0.39F, 0.39F));
    TEST_ASSERT_EQUAL_UINT16(0U, run_away(0.70F, 0.71F, 0.0F, -0.39F, -0.39F));
    TEST_ASSERT_EQUAL_UINT16(0U, run_away(0.71F, 0.70F, 0.0F, -0.39F, -0.39F));
    TEST_ASSERT_EQUAL_UINT16(0U, run_away(0.71F, 0.71F, 0.0F, -0.38F, -0.39F));
    TEST_ASSERT_EQUAL_UINT16(0U, run_away(0.71F, 0.71F, 0.0F, -0.39F, -0.38F));
    TEST_ASSERT_EQUAL_UINT16(0U, run_away(0.71F, 0.71F, 0.0F, 0.39F, 0.39F));
    TEST_ASSERT_EQUAL_UINT16(0U, run_away(0.71F, -0.71F, 0.0F, -0.39F, -0.39F));
}

void test_a_speed_is_taken_against_the_rate_of_the_heights(void)
{
    TEST_ASSERT_EQUAL_UINT16(0U, run_away(0.75F, 0.85F, 0.1F, -0.39F, -0.39F));
    TEST_ASSERT_EQUAL_UINT16(0U, run_away(0.85F, 0.75F, 0.1F, -0.39F, -0.39F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, run_away(0.85F, 0.85F, 0.1F, -0.39F, -0.39F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, run_away(0.65F, 0.65F, -0.1F, -0.39F, -0.39F));
    TEST_ASSERT_EQUAL_UINT16(0U, run_away(1.0F, 1.0F, 0.2F, -0.39F, -0.39F));
}

void test_of_a_noisy_accelerometer_a_share_of_the_speed_counts(void)
{
    setUp();
    shaken_by(2.0F);
    senses.accelerometer.felt.speed_mps = 1.39F;
    senses.push.pushed.speed_mps = 0.71F;
    TEST_ASSERT_EQUAL_UINT16(0U, judged(-0.8F, -0.39F));
    senses.accelerometer.felt.speed_mps = 1.41F;
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged(-0.8F, -0.39F));
}

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

/* speed 0.81 1/s2, bias 0.1 1/s3: FELT_PULL_PER_S2, BIAS_PULL_PER_S3 */
void test_a_doubt_of_the_heights_takes_back_what_they_have_corrected(void)
{
    setUp();
    senses.accelerometer.felt.speed_mps = 0.9F;
    bias_is_mps2(0.2F);
    was_pulled_m_s(-0.5F);
    TEST_ASSERT_EQUAL_UINT16(0U, judged(-0.4F, -0.2F));
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 0.9F, senses.accelerometer.felt.speed_mps);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, -0.5F, senses.accelerometer.pulled_m_s);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, judged(-0.6F, -0.3F));
    TEST_ASSERT_FLOAT_WITHIN(0.01F, 1.305F, senses.accelerometer.felt.speed_mps);
    TEST_ASSERT_FLOAT_WITHIN(0.001F, 0.15F, senses.accelerometer.bias_mps2);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, senses.accelerometer.pulled_m_s);
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

static uint16_t slant(uint16_t rigid, uint16_t still, float felt_m, float pushed_m)
{
    setUp();
    rigid_scans(rigid);
    still_scans(still);
    return judged(felt_m, pushed_m);
}

void test_a_rigid_slant_and_both_witnesses_by_a_decimetre_doubt_the_heights(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, slant(2U, 0U, -0.11F, -0.11F));
    TEST_ASSERT_EQUAL_UINT16(0U, slant(1U, 0U, -0.11F, -0.11F));
    TEST_ASSERT_EQUAL_UINT16(0U, slant(2U, 0U, -0.10F, -0.11F));
    TEST_ASSERT_EQUAL_UINT16(0U, slant(2U, 0U, -0.11F, -0.10F));
    TEST_ASSERT_EQUAL_UINT16(0U, slant(2U, 0U, 0.11F, -0.11F));
}

static uint16_t noisy_slant(uint16_t rigid, uint16_t white, float felt_m, float pushed_m)
{
    setUp();
    rigid_scans(rigid);
    white_scans(white);
    return judged(felt_m, pushed_m);
}

void test_a_slant_of_noise_alone_needs_the_thrust_and_a_sign_of_another(void)
{
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, noisy_slant(0U, 19U, -0.06F, -0.29F));
    TEST_ASSERT_EQUAL_UINT16(0U, noisy_slant(0U, 19U, -0.06F, -0.28F));
    TEST_ASSERT_EQUAL_UINT16(0U, noisy_slant(0U, 18U, -0.06F, -0.29F));
    TEST_ASSERT_EQUAL_UINT16(0U, noisy_slant(0U, 19U, -0.05F, -0.29F));
    TEST_ASSERT_EQUAL_UINT16(0U, noisy_slant(0U, 19U, 0.06F, -0.29F));
    TEST_ASSERT_EQUAL_UINT16(0U, noisy_slant(1U, 19U, 0.06F, -0.29F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, noisy_slant(2U, 19U, 0.06F, -0.29F));
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

void test_heights_of_nothing_but_steps_are_doubted(void)
{
    has_stepped(12.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, judged(0.0F, 0.0F));
    has_stepped(12.1F);
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

void test_unless_the_accelerometer_tells_the_contrary(void)
{
    TEST_ASSERT_EQUAL_UINT16(0U, since_step(0.3F, 0.5F, 0.21F, -0.36F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, since_step(0.3F, 0.5F, 0.20F, -0.36F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, since_step(0.3F, 0.5F, -0.21F, -0.36F));
}

static void in_vain(bool unconfirmed, bool proved, float felt_least_m, float pushed_for_s)
{
    setUp();
    is_unconfirmed(unconfirmed);
    is_proved(proved);
    felt_least_is_m(felt_least_m);
    senses.push.pushed.running_s = pushed_for_s;
    pushes_n(HOVER_N + 0.3F);
    at_m(0.10F);
    came_near_at_m(0.10F);
    (void)judged(0.0F, -0.36F);
}

void test_a_push_in_vain_needs_a_proof_and_an_old_witness(void)
{
    in_vain(true, true, 0.0F, 2.0F);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, verdict.doubts);
    in_vain(false, true, 0.0F, 2.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, verdict.doubts);
    in_vain(true, true, 0.0F, 1.9F);
    TEST_ASSERT_EQUAL_UINT16(0U, verdict.doubts);
    in_vain(true, false, -0.20F, 2.0F);
    TEST_ASSERT_EQUAL_UINT16(0U, verdict.doubts);
    in_vain(true, false, -0.21F, 2.0F);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, verdict.doubts);
}

void test_a_jump_of_the_height_after_the_lift_off_is_such_a_proof(void)
{
    for (int high = 0; high < 2; high++) {
        setUp();
        is_unconfirmed(true);
        is_proved(false);
        at_m((high == 0) ? 0.10F : 0.11F);
        came_near_at_m((high == 0) ? 0.10F : 0.11F);
        pushes_n(HOVER_N + 0.3F);
        TEST_ASSERT_EQUAL_UINT16((high == 0) ? 0U : DOUBT_SIGHT, judged(0.0F, -0.36F));
    }
}

void test_without_an_accelerometer_a_push_in_vain_after_a_step_is_enough(void)
{
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
        {true, false, -0.70F, 2.0F, 0.0F, DOUBT_SIGHT},
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
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, lift_off(0.0F, 2U, 0U, 4.1e-4F, -0.081F));
    TEST_ASSERT_EQUAL_UINT16(0U, lift_off(0.0F, 2U, 0U, 4.1e-4F, -0.080F));
    TEST_ASSERT_EQUAL_UINT16(0U, lift_off(0.0F, 2U, 0U, 4.0e-4F, -0.081F));
    TEST_ASSERT_EQUAL_UINT16(0U, lift_off(0.0F, 1U, 0U, 4.1e-4F, -0.081F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_SIGHT, lift_off(0.081F, 0U, 9U, 4.1e-4F, -0.081F));
    TEST_ASSERT_EQUAL_UINT16(0U, lift_off(0.08F, 0U, 9U, 4.1e-4F, -0.081F));
    TEST_ASSERT_EQUAL_UINT16(0U, lift_off(0.081F, 0U, 8U, 4.1e-4F, -0.081F));
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
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 1.1F, swayed_s(0.05F, 9U, 4.1e-4F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, swayed_s(0.051F, 9U, 4.1e-4F));
    TEST_ASSERT_EQUAL_FLOAT(0.051F, verdict.rules.swaying_from_m);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, swayed_s(-0.051F, 9U, 4.1e-4F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, swayed_s(0.05F, 8U, 4.1e-4F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, swayed_s(0.05F, 9U, 4.0e-4F));
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

/* ---- DOUBT_SIGHT: the thrust alone */

/* How long the law has pushed in vain, 0.1 s after 1 s of it. */
static float vain_s(float push_n, float wanted_m, float rise_mps, float pushed_m)
{
    setUp();
    flown.hover_n = 0.0F;
    pushes_n(push_n);
    flown.wanted_m = wanted_m;
    rises_mps(rise_mps * 1.5F); /* a third of a rate is forgotten within this height */
    pushed_in_vain_s(1.0F);
    senses.push.pushed.off_m = pushed_m;
    sensed_height(&flown, senses.heights.height_m, 0.1F, 0.0F);
    return verdict.rules.vain_s;
}

void test_a_push_without_any_motion_of_the_heights_is_in_vain(void)
{
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 1.1F, vain_s(0.71F, 0.5F, 0.0F, -0.01F));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 1.1F, vain_s(-0.71F, -0.5F, 0.0F, 0.01F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, vain_s(0.70F, 0.5F, 0.0F, -0.01F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, vain_s(0.71F, -0.5F, 0.0F, -0.01F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, vain_s(0.71F, 0.5F, 0.0F, 0.001F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, vain_s(0.71F, 0.5F, 0.0F, 0.0F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, vain_s(0.71F, 0.15F, 0.0F, -0.01F));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 1.1F, vain_s(0.71F, 0.16F, 0.0F, -0.01F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, vain_s(0.71F, 0.5F, 0.121F, -0.01F));
    TEST_ASSERT_EQUAL_FLOAT(0.0F, vain_s(0.71F, 0.5F, -0.121F, -0.01F));
    TEST_ASSERT_FLOAT_WITHIN(1.0e-5F, 1.1F, vain_s(0.71F, 0.5F, 0.119F, -0.01F));
}

void test_a_push_in_vain_of_three_seconds_doubts_the_heights_where_the_thrust_is_all_there_is(void)
{
    for (int other = 0; other < 2; other++) {
        setUp();
        doubted((other == 0) ? DOUBT_IMU : 0U);
        pushes_n(HOVER_N + 1.0F);
        pushed_in_vain_s(3.0F);
        TEST_ASSERT_EQUAL_UINT16((other == 0) ? DOUBT_IMU : 0U, judged(0.0F, -0.01F));
        pushed_in_vain_s(3.01F);
        TEST_ASSERT_EQUAL_UINT16((other == 0) ? (DOUBT_IMU | DOUBT_SIGHT) : 0U, judged(0.0F, -0.01F));
    }
}

void test_a_still_slant_needs_no_accelerometer(void)
{
    doubted(DOUBT_IMU);
    white_scans(19U);
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU, judged(0.0F, -0.28F));
    TEST_ASSERT_EQUAL_UINT16(DOUBT_IMU | DOUBT_SIGHT, judged(0.0F, -0.29F));
}

/* ---- DOUBT_IMU */

void test_an_accelerometer_alone_against_the_heights_is_doubted(void)
{
    static const row_t rows[] = {
        {nothing, 0, 0.61F, 0.0F, DOUBT_IMU},
        {nothing, 0, -0.61F, 0.0F, DOUBT_IMU},
        {nothing, 0, 0.60F, 0.0F, 0},
        {nothing, 0, 0.62F, 0.24F, DOUBT_IMU},
        {nothing, 0, 0.62F, 0.26F, 0},
        {nothing, 0, 0.62F, -0.26F, DOUBT_IMU},
        {pushed_for, 0.5F, 0.61F, 0, DOUBT_SIGHT},
        {without_imu, 0, 0.61F, 0, DOUBT_IMU},
        {felt_for, 0.5F, 0.61F, 0.0F, 0},
        {shaken, 2.0F, 1.22F, 0.0F, DOUBT_IMU},
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
        {way, 0.15F, -0.52F, -0.30F, 0},         {way, 0.10F, -0.52F, -0.30F, DOUBT_SIGHT},
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
