/* The order of the parts. What breaks: the order. The sway of a frame counts for that frame already, and the
 * lift-off of a pilot is noticed before the frame moves the witness. */
#include "control/sense/senses.h"

#include <math.h>

#include "control/between.h"
#include "control/credible.h"
#include "control/laws/descent.h"

void senses_init(senses_t *senses)
{
    tilt_init(&senses->tilt);
    accelerometer_init(&senses->accelerometer);
}

void senses_forget(senses_t *senses)
{
    witness_forget(&senses->accelerometer.felt);
    witness_forget(&senses->push.pushed);
}

/* A pilot has lifted it, or somebody carries it. A foot below a mirror moves its height too, but not to the
 * air. */
static bool is_carried(const senses_t *s)
{
    return s->mirrors.stirs && s->heights.height_m > LOW_M;
}

/* One frame in state GROUND. What is carried is not at rest. */
static void watch_ground(senses_t *s, float mean_mps2, float dt_s)
{
    if (is_carried(s)) {
        accelerometer_was_lifted(&s->accelerometer, s->heights.rise_mps);
        accelerometer_move(&s->accelerometer, mean_mps2, false, dt_s);
    } else if (s->mirrors.unseen_s > HEIGHT_LOST_S && sway_as_in_the_air(&s->sway) && sway_rocks(&s->sway)) {
        accelerometer_in_hands(&s->accelerometer, mean_mps2, sway_is_no_hand(&s->sway), dt_s);
    } else {
        accelerometer_rest(&s->accelerometer, dt_s);
    }
}

/* One frame off the ground, or with a take-off commanded. */
static void watch_flight(senses_t *s, float mean_mps2, bool standing, float dt_s)
{
    if (!standing) {
        accelerometer_was_lifted(&s->accelerometer, s->heights.rise_mps);
    }
    stand_frame(&s->stand, &s->accelerometer.felt, &s->push.pushed, sway_is_calm(&s->sway), dt_s);
    accelerometer_move(&s->accelerometer, mean_mps2, standing, dt_s);
}

/* One accepted frame. up_mps2: what its accelerometer measures. */
static void take_frame(senses_t *s, const command_t *command, const imu_sample_t *frame, float up_mps2)
{
    uint32_t gap_us;
    const float mean_mps2 = accelerometer_mean_mps2(&s->accelerometer, frame->arrival_us, up_mps2, &gap_us);
    const float dt_s = (float)gap_us * 1.0e-6F;

    if (gap_us > FRAME_GAP_US) {
        accelerometer_restart(&s->accelerometer, push_speed_mps(&s->push, s->heights.rise_mps));
        return;
    }
    mirrors_frame(&s->mirrors, (mean_mps2 - s->accelerometer.bias_mps2) * dt_s, dt_s);
    sway_frame(&s->sway, frame, s->heights.height_m, dt_s);
    if (command->grounded) {
        watch_ground(s, mean_mps2, dt_s);
    } else {
        watch_flight(s, mean_mps2, command->standing, dt_s);
    }
}

void senses_frames(senses_t *senses, const command_t *command, const imu_sample_t *frames, uint16_t count)
{
    for (uint16_t k = imu_first_after(frames, count, senses->accelerometer.sequence); k < count; ++k) {
        const imu_sample_t *frame = &frames[k];
        const bool fit = (int32_t)(frame->sequence - senses->tilt.unfit_sequence) > 0;

        if (!fit || !frame->ready) {
            continue;
        }
        if (!frame->has_acceleration) {
            senses->accelerometer.sequence = frame->sequence;
            sway_frame_alone(&senses->sway, frame, senses->heights.height_m);
            continue;
        }
        const float up_mps2 = imu_up_mps2(frame);
        if (fabsf(up_mps2) < UP_MAX_MPS2) {
            senses->accelerometer.sequence = frame->sequence;
            take_frame(senses, command, frame, up_mps2);
        }
    }
}

/* The belief hears of it also where the heights show no lift-off, but not while the vehicle may stand there
 * without power: it has to sway, or to feel a climb that is no drift. */
static void tell_thrust(senses_t *senses, const command_t *command, bool carries, float felt_mps)
{
    const bool lifts = sway_as_in_the_air(&senses->sway) || felt_mps > LAND_MAX_MPS;

    if (command->grounded && is_carried(senses)) { /* its own thrust is 0 */
        mirrors_carried(&senses->mirrors, command->step_s);
    } else if (!command->grounded && (carries || lifts)) {
        mirrors_thrust(&senses->mirrors, push_lift_mps(&senses->push, command, senses->tilt.upright),
                       push_undelivered_mps(&senses->push, command, senses->tilt.upright),
                       push_dragged(command));
    }
}

static void rest(senses_t *senses, const command_t *command)
{
    if (command->grounded && !accelerometer_is_in_hands(&senses->accelerometer)) {
        mirrors_rest(&senses->mirrors, senses->mirrors.unseen_s > HEIGHT_LOST_S);
    }
}

void senses_thrust(senses_t *senses, const command_t *command, bool felt_valid)
{
    const witness_t *felt = &senses->accelerometer.felt;
    const bool low = senses->heights.known && senses->heights.height_m < LOW_M;
    const bool carries = command->off_ground && !(low && !sway_as_in_the_air(&senses->sway));
    const bool felt_tells = !command->grounded && felt_valid && witness_counts(felt);

    accelerometer_set_noise(&senses->accelerometer, command->noise_mps2);
    senses->standing = command->grounded || command->standing;
    push_lag(&senses->push, command);
    if (carries) {
        push_move(&senses->push, command, senses->tilt.upright);
    } else {
        witness_start(&senses->push.pushed, felt_tells ? felt->speed_mps : 0.0F);
    }
    tell_thrust(senses, command, carries, felt_tells ? felt->speed_mps : 0.0F);
    rest(senses, command);
}

/* What a height means for the witnesses. At the first climb the hover thrust was not known well until now, so
 * the witness of the thrust restarts from the rate of the heights. */
static void confirm(senses_t *s, height_change_t *change)
{
    change->first_climb = confirmation_height(&s->confirmation, change, s->standing);
    if (change->first_climb) {
        s->push.pushed.speed_mps = s->heights.rise_mps;
        senses_forget(s);
    }
}

/* A step says nothing about the witnesses: it counts as the change that each of them predicts. */
static void compare(senses_t *s, const height_change_t *change, bool believed)
{
    const witness_t *felt = &s->accelerometer.felt;
    const witness_t *pushed = &s->push.pushed;
    const float gap_s = change->gap_s;

    accelerometer_compare(&s->accelerometer, change->step ? felt->speed_mps * gap_s : change->rise_m, gap_s,
                          change->age_s, believed);
    push_compare(&s->push, change->step ? pushed->speed_mps * gap_s : change->rise_m, gap_s, change->age_s);
}

height_change_t senses_height(senses_t *senses, float height_m, float gap_s, float age_s, bool believed)
{
    witness_t *felt = &senses->accelerometer.felt;
    witness_t *pushed = &senses->push.pushed;
    height_change_t change = heights_change(&senses->heights, height_m, gap_s, age_s);

    change.step = change.step && !witness_follows(felt, change.rise_m, gap_s) &&
                  !witness_follows(pushed, change.rise_m, gap_s);
    confirm(senses, &change);
    heights_update(&senses->heights, &change);
    if (change.fresh) {
        compare(senses, &change, believed);
    } else {
        felt->off_m = 0.0F;
        pushed->off_m = 0.0F;
    }
    return change;
}
