#include "control/imu_repeat.h"

/* Of the Razors whose lines their users published (mobotware, Robotic_Tang, SignalK: 15 frames), no two
 * frames that follow each other are alike. If one in ten were, five repeats in a row would be chance once in
 * 100 000 frames, 40 minutes, and cost one frame. */
#define REPEATS_MOST 5U

static bool is_same(const imu_raw_t *a, const imu_raw_t *b)
{
    const bool angles = a->yaw_rad == b->yaw_rad && a->pitch_rad == b->pitch_rad &&
                        a->roll_rad == b->roll_rad;
    const bool counts = a->x_counts == b->x_counts && a->y_counts == b->y_counts &&
                        a->z_counts == b->z_counts;

    return angles && a->has_acceleration == b->has_acceleration && (counts || !a->has_acceleration);
}

bool imu_repeats(imu_repeat_t *repeat, const imu_raw_t *frame)
{
    if (!is_same(&repeat->latest, frame)) {
        *repeat = (imu_repeat_t){.latest = *frame};
        return false;
    }
    repeat->times = (uint16_t)(repeat->times + (repeat->times < REPEATS_MOST));
    return repeat->times == REPEATS_MOST;
}
