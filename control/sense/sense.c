/* The order of one cycle: tilt, frames, thrust, then scan and height when there is a new scan.
 * What breaks: the order. A height is judged with the tilt, the accelerations and the thrust of its own
 * cycle. */
#include "control/sense/sense.h"

#include <stddef.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/seconds.h"

#define HELD_UP_S (0.5F * SCAN_S) /* the frames of the scan's time are then those of another scan */

void sense_init(sense_t *sense)
{
    ray_clock_init(&sense->ray_clock);
    senses_init(&sense->senses);
}

/* A height with a tilt that was rejected is computed again with the believed one. */
static void believe_tilt(const tilt_t *tilt, flight_inputs_t *in)
{
    if (tilt->jumped > 0U) {
        in->altitude.height_mm = altitude_at_tilt(&in->altitude, tilt->roll_rad, tilt->pitch_rad);
    }
    in->roll_rad = tilt->roll_rad;
    in->pitch_rad = tilt->pitch_rad;
    in->tilted_frames = tilt->tilted;
    if (tilt->against_nats > 0.0F && tilt->jumped > 0U) {
        in->attitude_time_us = tilt->accepted_us;
    }
}

/* When the rays of a new scan were taken, by the sensor's own clock. Returns how long the scan was held up on
 * its way. */
static float held_up_s(sense_t *sense, const flight_inputs_t *in, float *gap_s)
{
    const uint32_t before_us = sense->rays_us;
    const uint32_t at_once_us = in->height_time_us - in->height_age_us;

    sense->rays_us = ray_clock_step(&sense->ray_clock, in->height_stamp_ms, in->height_time_us,
                                    in->height_age_us);
    *gap_s = seconds_at_most(sense->rays_us - before_us, MIRRORS_GAP_MOST_S);
    if (*gap_s < HELD_UP_S) { /* no scanner is so fast: several have waited together */
        *gap_s = SCAN_S;
        return SCAN_S;
    }
    return seconds_at_most(at_once_us - sense->rays_us, MIRRORS_GAP_MOST_S);
}

/* The mirrors of a new scan, each at the believed tilt. Layout FRONT has one. A shaken accelerometer predicts
 * no motion: one mirror alone would then be disbelieved. Nor does one whose frames are of another time than
 * the scan. */
static bool vote(sense_t *sense, const flight_inputs_t *in)
{
    float gap_s;
    const bool held_up = held_up_s(sense, in, &gap_s) > HELD_UP_S;
    const tilt_t *tilt = &sense->senses.tilt;
    altitude_t shown[MIRROR_COUNT] = {{.valid = false}};

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        if (in->mirrors != NULL) {
            shown[m] = in->mirrors[m];
        } else if (m == (uint16_t)MIRROR_FRONT) {
            shown[m] = in->altitude;
            shown[m].valid = true; /* in->height_valid tells it */
        }
        if (tilt->jumped > 0U) {
            shown[m].height_mm = altitude_at_tilt(&shown[m], tilt->roll_rad, tilt->pitch_rad);
        }
    }
    return mirrors_scan(
        &sense->senses.mirrors, shown, gap_s, seconds_at_most(in->height_age_us, MIRRORS_GAP_MOST_S),
        (sense->verdict.doubts & DOUBT_IMU) == 0U && sense->senses.accelerometer.shaken <= 1.0F, held_up);
}

/* What several mirrors show together takes the place of their mean. */
static void elect(const mirrors_t *mirrors, flight_inputs_t *in)
{
    if (in->mirrors != NULL && mirrors->altitude.valid) {
        in->height_age_us += (uint32_t)(in->altitude.later_us - mirrors->altitude.later_us);
        in->altitude = mirrors->altitude;
    }
}

static bool is_new_scan(const sense_t *sense, const flight_inputs_t *in)
{
    return in->height_valid && in->height_sequence != sense->scan_sequence;
}

static void compare_height(sense_t *sense, const command_t *command, flight_inputs_t *in)
{
    const bool is_new = is_new_scan(sense, in);
    const float gap_s = seconds_at_most(in->height_time_us - sense->height_time_us, MIRRORS_GAP_MOST_S);

    const bool tells = is_new && vote(sense, in);

    elect(&sense->senses.mirrors, in);
    in->altitude.ground = sense->senses.mirrors.ground;
    if (!is_new) {
        mirrors_wait(&sense->senses.mirrors, command->step_s);
        return;
    }
    sense->scan_sequence = in->height_sequence;
    sense->scan_fit = tells && heights_can_be(&sense->senses.heights, in->altitude.height_mm);
    if (sense->scan_fit) {
        const height_change_t change = senses_height(&sense->senses, in->altitude.height_mm * 0.001F, gap_s,
                                                     seconds_at_most(in->height_age_us, MIRRORS_GAP_MOST_S),
                                                     (sense->verdict.doubts & DOUBT_SIGHT) == 0U);
        verdict_height(&sense->verdict, &sense->senses, command, &change);
        sense->height_time_us = in->height_time_us;
    }
}

static void drop_unfit(const tilt_t *tilt, flight_inputs_t *in)
{
    while (in->frame_count > 0U && (int32_t)(in->frames[0].sequence - tilt->unfit_sequence) <= 0) {
        ++in->frames;
        --in->frame_count;
    }
}

/* A step of the terrain needs no climb to confirm it when the mirrors agree on it. A take-off does: what
 * blocks all of them at one length blocks them from there on. A climb that may be none is slow: that costs
 * little, so little suspicion is enough. */
static bool is_unconfirmed(const senses_t *s)
{
    const bool unshown = s->confirmation.unconfirmed && !(s->confirmation.proved && s->mirrors.agree);

    return unshown || s->mirrors.suspected;
}

/* With heights the belief tells whether it moves. Without them it cannot stand before it has come down, by
 * the thrust: calm air is as calm as the ground. */
static bool may_stand(const senses_t *s)
{
    const bool lost = s->mirrors.unseen_s > HEIGHT_LOST_S;
    const bool down = s->heights.height_m + push_moved_m(&s->push) < LOW_M;

    return stand_is_possible(&s->stand) && (lost ? down : !s->mirrors.moves);
}

static evidence_t evidence_of(const sense_t *sense)
{
    const senses_t *s = &sense->senses;
    const verdict_t *verdict = &sense->verdict;

    return (evidence_t){
        .doubts = verdict->doubts,
        .reason = (uint16_t)verdict_reason(verdict),
        .unshown = {.climb = is_unconfirmed(s),
                    .first_climb = !s->confirmation.proved,
                    .descent = s->confirmation.terrain_fell},
        .teaches = !s->confirmation.unconfirmed && !s->mirrors.suspected,
        .sways = sway_as_in_the_air(&s->sway),
        .calm = sway_is_calm(&s->sway),
        .rocks = sway_rocks(&s->sway),
        .in_hands = accelerometer_is_in_hands(&s->accelerometer),
        .may_stand = may_stand(s),
        .stands = stand_is_sure(&s->stand),
        .upright = s->tilt.upright,
        .mirrors = {.agree = s->mirrors.agree,
                    .no_effect = s->mirrors.no_effect,
                    .suspected = s->mirrors.suspected,
                    .doubted = mirrors_liars(&s->mirrors, false),
                    .liars = mirrors_liars(&s->mirrors, true)},
        .height_m = s->heights.height_m,
        .stepped = s->heights.stepped,
        .rise_mps = s->heights.rise_mps,
        .blind_height_m = verdict->blind_height_m,
        .felt_mps = s->accelerometer.felt.speed_mps,
        .felt_valid = verdict_felt_valid(verdict, s),
        .shaken = s->accelerometer.shaken,
        .bias_mps2 = s->accelerometer.bias_mps2,
        .push_mps = s->push.pushed.speed_mps,
        .pushed_mps = push_speed_mps(&s->push, s->heights.rise_mps),
        .moved_m = push_moved_m(&s->push),
        .speed_mps = mirrors_blind_mps(&s->mirrors, (verdict->doubts & DOUBT_IMU) == 0U),
        .held = {verdict->held_n, verdict->held_down},
    };
}

/* Do the slants refute the tilt? Those of mirrors that are doubted tell nothing. */
static void scan_tilt(sense_t *sense, const flight_inputs_t *in)
{
    senses_t *senses = &sense->senses;
    const float gap_s = seconds_at_most(in->height_time_us - sense->height_time_us, MIRRORS_GAP_MOST_S);
    const uint16_t liars = mirrors_liars(&senses->mirrors, false);
    altitude_t shown[MIRROR_COUNT] = {in->altitude};

    for (uint16_t m = 0U; m < MIRROR_COUNT && in->mirrors != NULL; ++m) {
        shown[m] = in->mirrors[m];
        shown[m].valid = shown[m].valid && (liars & (1U << m)) == 0U;
    }
    tilt_scan(&senses->tilt, shown, (in->mirrors != NULL) ? MIRROR_COUNT : 1U,
              senses->heights.height_m * 1000.0F, senses->heights.rise_mps * gap_s * 1000.0F,
              !senses->standing);
}

evidence_t sense_step(sense_t *sense, const command_t *command, flight_inputs_t *in)
{
    senses_t *senses = &sense->senses;

    if (is_new_scan(sense, in)) {
        scan_tilt(sense, in);
    }
    tilt_step(&senses->tilt, in->frames, in->frame_count, in->roll_rad, in->pitch_rad, in->attitude_time_us);
    believe_tilt(&senses->tilt, in);
    senses_frames(senses, command, in->frames, in->frame_count);
    if (command->grounded) {
        verdict_rest(&sense->verdict, &senses->accelerometer);
    }
    if (command->ordered && command->grounded) {
        verdict_order(&sense->verdict, senses);
    }
    senses_thrust(senses, command, (sense->verdict.doubts & DOUBT_IMU) == 0U);
    compare_height(sense, command, in);
    in->height_valid = in->height_valid && sense->scan_fit && (sense->verdict.doubts & DOUBT_SIGHT) == 0U;
    drop_unfit(&senses->tilt, in);
    return evidence_of(sense);
}
