#include "sim/devices/pilot.h"

#include <math.h>
#include <stdlib.h>

#include "sim/noise.h"

#define FRAME (20 * SIM_MS) /* of the receiver */
#define FRAME_S 0.02
#define VIEWS 64U /* seen and not yet acted on: at most 1.28 s */
#define HAND_LAG_S 0.1
#define CLIMB_PER_M 0.8 /* wanted, m/s for each metre that is missing */
#define CLIMB_MPS 0.7
#define SINK_MPS (-0.5)
#define STICK_N_PER_MPS 2.0
#define TRIM_N_PER_M 0.8 /* how fast the stick's middle is moved when the climb stays wrong */
#define LANDED_M 0.05
#define CORNERS_S 1.0
#define OPENED_N 2.35 /* a fifth of the stick: over the 10 % that keep motors running */
#define PREPARE_S 1.0
#define FULL_N 11.76
#define MIDDLE_N 5.88
#define PUSHED_N 3.76 /* 80 % of the stick's way */
#define NEAR_M 0.08   /* as well as he sees it */

/* The autopilot's throttle channel. */
#define NO_THRUST_NS (4166.0 * 480.0)
#define NS_PER_N (177.21 * 480.0)

struct pilot {
    pilot_config_t config;
    pilot_hands_t hands;
    noise_t unrest;
    timeline_id_t event;
    pilot_view_t views[VIEWS];
    unsigned seen, late; /* looks taken; frames between eye and hand */
    bool flying;
    double trim_n, hand_n;
};

static bool my_turn(const pilot_config_t *config, double t_s)
{
    const double since_s = t_s - config->turn.start_s;
    const double into_s = config->every_s > 0.0 ? fmod(since_s, config->every_s) : since_s;

    return since_s >= 0.0 && into_s < config->turn.length_s && t_s - into_s < config->until_s;
}

static double wanted_n(pilot_t *pilot, const pilot_view_t *view)
{
    const double missing_m = pilot->config.height_m - view->height_m;
    const double error_mps = fmin(fmax(CLIMB_PER_M * missing_m, SINK_MPS), CLIMB_MPS) - view->climb_mps;

    if (pilot->config.height_m <= 0.0 && view->height_m < LANDED_M) {
        return 0.0;
    }
    pilot->trim_n += FRAME_S * TRIM_N_PER_M * error_mps;
    return pilot->trim_n + STICK_N_PER_MPS * error_mps + pilot->config.unrest_n * noise_gauss(&pilot->unrest);
}

static void take_over(pilot_t *pilot)
{
    pilot->flying = true;
    pilot->trim_n = pilot->hand_n = pilot->config.trim_n;
    pilot->hands.take(pilot->hands.context, true);
}

static void move_stick(pilot_t *pilot)
{
    const unsigned latest = pilot->seen - 1U;
    const pilot_view_t *view = &pilot->views[(latest < pilot->late ? 0U : latest - pilot->late) % VIEWS];
    const double hand_n = pilot->hand_n + FRAME_S / HAND_LAG_S * (wanted_n(pilot, view) - pilot->hand_n);

    pilot->hand_n = fmin(fmax(hand_n, 0.0), FULL_N);
    pilot->hands.stick(pilot->hands.context, (sim_time_t)llround(NO_THRUST_NS - NS_PER_N * pilot->hand_n));
}

static double day_stick_n(pilot_t *pilot, const pilot_view_t *view, double t_s)
{
    if (t_s < PILOT_DAY_START_S + CORNERS_S || t_s >= PILOT_DAY_STOP_S) {
        return 0.0;
    }
    if (t_s < PILOT_DAY_TAKE_S) {
        pilot->trim_n = pilot->config.trim_n;
        return t_s < PILOT_DAY_TAKE_S - PREPARE_S ? OPENED_N : pilot->config.trim_n;
    }
    pilot->config.height_m = t_s < PILOT_DAY_LAND_S ? pilot->config.height_m : 0.0;
    return wanted_n(pilot, view);
}

static bool holds_corners(const pilot_t *pilot, double t_s)
{
    const double stop_s = (pilot->config.by_stick ? PILOT_STICK_TAKE_S : PILOT_DAY_STOP_S) + 1.0;
    const bool starts = t_s >= PILOT_DAY_START_S && t_s < PILOT_DAY_START_S + CORNERS_S;

    return starts || (pilot->config.stops_by_sticks && t_s >= stop_s && t_s < stop_s + CORNERS_S);
}

/* By stick: pushes it until the vehicle is where he wants it. */
static double push_n(const pilot_t *pilot, const pilot_view_t *view, double t_s)
{
    const double missing_m = pilot->config.height_m - view->height_m;

    if (t_s < PILOT_STICK_MIDDLE_S) {
        return OPENED_N;
    }
    if (t_s >= PILOT_STICK_LAND_S) {
        return 0.0;
    }
    return t_s < PILOT_STICK_FLY_S || fabs(missing_m) < NEAR_M ? MIDDLE_N
                                                               : MIDDLE_N + copysign(PUSHED_N, missing_m);
}

/* His stick goes on while the firmware has the throttle: the multiplexer drops it. */
static void live_the_day(pilot_t *pilot, double t_s)
{
    const unsigned latest = pilot->seen - 1U;
    const pilot_view_t *view = &pilot->views[(latest < pilot->late ? 0U : latest - pilot->late) % VIEWS];
    const bool alone = pilot->config.by_stick && t_s >= PILOT_DAY_GIVE_S;
    const bool mine = t_s < PILOT_DAY_GIVE_S ||
                      t_s >= (pilot->config.by_stick ? PILOT_STICK_TAKE_S : PILOT_DAY_TAKE_S);
    const double wanted = alone ? push_n(pilot, view, t_s) : day_stick_n(pilot, view, t_s);

    if (pilot->seen == 1U || mine != pilot->flying) {
        pilot->flying = mine;
        pilot->hands.take(pilot->hands.context, mine);
    }
    pilot->hands.corners(pilot->hands.context, holds_corners(pilot, t_s));
    pilot->hand_n = fmin(fmax(pilot->hand_n + FRAME_S / HAND_LAG_S * (wanted - pilot->hand_n), 0.0), FULL_N);
    pilot->hands.stick(pilot->hands.context, (sim_time_t)llround(NO_THRUST_NS - NS_PER_N * pilot->hand_n));
}

static void frame(void *context)
{
    pilot_t *pilot = context;
    const pilot_view_t view = pilot->hands.look(pilot->hands.context);
    const bool mine = my_turn(&pilot->config, view.t_s);

    pilot->event = timeline_after(FRAME, frame, pilot);
    pilot->views[pilot->seen++ % VIEWS] = view;
    if (pilot->config.field_day) {
        live_the_day(pilot, view.t_s);
        return;
    }
    if (mine && !pilot->flying) {
        take_over(pilot);
    } else if (!mine && pilot->flying) {
        pilot->flying = false;
        pilot->hands.take(pilot->hands.context, false);
    }
    if (pilot->flying) {
        move_stick(pilot);
    }
}

pilot_t *pilot_create(const pilot_config_t *config, const pilot_hands_t *hands, unsigned long seed)
{
    pilot_t *pilot = calloc(1, sizeof *pilot);

    if (pilot == NULL) {
        abort();
    }
    pilot->config = *config;
    pilot->hands = *hands;
    pilot->late = (unsigned)lround(fmin(config->delay_s / FRAME_S, VIEWS - 1U));
    noise_init(&pilot->unrest, seed, "pilot");
    if (config->turn.length_s > 0.0 || config->field_day) {
        pilot->event = timeline_after(FRAME, frame, pilot);
    }
    return pilot;
}

void pilot_destroy(pilot_t *pilot)
{
    if (pilot != NULL) {
        timeline_cancel(pilot->event);
        free(pilot);
    }
}
