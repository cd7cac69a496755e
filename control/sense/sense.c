/* The order of one cycle: tilt, frames, thrust, then scan and height when there is a new scan.
 * What breaks: the order. A height is judged with the tilt, the accelerations and the thrust of its own
 * cycle. */
#include "control/sense/sense.h"

#include <stddef.h>

#include "control/between.h"
#include "control/seconds.h"

#define GAP_LEAST_S 0.02F /* chosen: two scans can not be nearer; the line may deliver two at once */
#define GAP_LONG_S 10.0F  /* chosen: longer gaps count as this long; the witnesses restart after 1.5 s */

void sense_init(sense_t *sense)
{
    *sense = (sense_t){.scan_fit = false};
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
}

/* The mirrors of a new scan, each at the believed tilt. */
static void vote(sense_t *sense, const flight_inputs_t *in, float gap_s)
{
    const tilt_t *tilt = &sense->senses.tilt;
    altitude_t shown[MIRROR_COUNT];

    for (uint16_t m = 0U; m < MIRROR_COUNT; ++m) {
        shown[m] = in->mirrors[m];
        if (tilt->jumped > 0U) {
            shown[m].height_mm = altitude_at_tilt(&shown[m], tilt->roll_rad, tilt->pitch_rad);
        }
    }
    mirrors_scan(&sense->senses.mirrors, shown, at_least(gap_s, GAP_LEAST_S),
                 seconds_at_most(in->height_age_us, GAP_LONG_S), (sense->verdict.doubts & DOUBT_IMU) == 0U);
}

/* Several mirrors: what they show together takes the place of their mean. Of one: that it agrees with none.
 */
static void elect(sense_t *sense, flight_inputs_t *in, bool is_new, float gap_s)
{
    mirrors_t *mirrors = &sense->senses.mirrors;

    if (in->mirrors == NULL) {
        mirrors->agree = false;
        return;
    }
    if (is_new) {
        vote(sense, in, gap_s);
    }
    if (mirrors->altitude.valid) {
        in->height_age_us += (uint32_t)(in->altitude.later_us - mirrors->altitude.later_us);
        in->altitude = mirrors->altitude;
    }
}

static void compare_height(sense_t *sense, const command_t *command, flight_inputs_t *in)
{
    const bool is_new = in->height_valid && in->height_sequence != sense->scan_sequence;
    const float gap_s = seconds_at_most(in->height_time_us - sense->height_time_us, GAP_LONG_S);

    elect(sense, in, is_new, gap_s);
    if (!is_new) {
        return;
    }
    sense->scan_sequence = in->height_sequence;
    sense->scan_fit = senses_scan(&sense->senses, &in->altitude);
    if (sense->scan_fit) {
        const height_change_t change = senses_height(&sense->senses, in->altitude.height_mm * 0.001F, gap_s,
                                                     seconds_at_most(in->height_age_us, GAP_LONG_S),
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

static evidence_t evidence_of(const sense_t *sense)
{
    const senses_t *s = &sense->senses;
    const verdict_t *verdict = &sense->verdict;

    return (evidence_t){
        .doubts = verdict->doubts,
        .reason = (uint16_t)verdict_reason(verdict),
        .unconfirmed = s->confirmation.unconfirmed,
        .terrain_fell = s->confirmation.terrain_fell,
        .teaches = !s->confirmation.unconfirmed && !beam_is_still(&s->beam) && !verdict_apart(verdict, s),
        .sways = sway_as_in_the_air(&s->sway),
        .calm = sway_is_calm(&s->sway),
        .rocks = sway_rocks(&s->sway),
        .in_hands = accelerometer_is_in_hands(&s->accelerometer),
        .may_stand = stand_is_possible(&s->stand),
        .stands = stand_is_sure(&s->stand),
        .upright = s->tilt.upright,
        .height_m = s->heights.height_m,
        .rise_mps = s->heights.rise_mps,
        .lost_m = verdict->lost_m,
        .felt_mps = s->accelerometer.felt.speed_mps,
        .felt_valid = verdict_felt_valid(verdict, s),
        .shaken = s->accelerometer.shaken,
        .bias_mps2 = s->accelerometer.bias_mps2,
        .push_mps = s->push.pushed.speed_mps,
        .pushed_mps = push_speed_mps(&s->push, s->heights.rise_mps),
        .moved_m = push_moved_m(&s->push),
        .speed_mps = verdict_speed_mps(verdict, s),
        .held_n = verdict->held_n,
        .held_down = verdict->held_down,
    };
}

evidence_t sense_step(sense_t *sense, const command_t *command, flight_inputs_t *in)
{
    senses_t *senses = &sense->senses;

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
