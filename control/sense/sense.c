/* The order of one cycle: tilt, frames, thrust, then scan and height when there is a new scan.
 * What breaks: the order. A height is judged with the tilt, the accelerations and the thrust of its own
 * cycle. */
#include "control/sense/sense.h"

#include "control/seconds.h"

#define GAP_LONG_S 10.0F /* chosen: longer gaps count as this long; the witnesses restart after 1.5 s */

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

static void compare_height(sense_t *sense, const command_t *command, const flight_inputs_t *in)
{
    const bool is_new = in->height_valid && in->height_sequence != sense->scan_sequence;

    if (!is_new) {
        return;
    }
    sense->scan_sequence = in->height_sequence;
    sense->scan_fit = senses_scan(&sense->senses, &in->altitude);
    if (sense->scan_fit) {
        const height_change_t change = senses_height(
            &sense->senses, in->altitude.height_mm * 0.001F,
            seconds_at_most(in->height_time_us - sense->height_time_us, GAP_LONG_S),
            seconds_at_most(in->height_age_us, GAP_LONG_S), (sense->verdict.doubts & DOUBT_SIGHT) == 0U);
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
