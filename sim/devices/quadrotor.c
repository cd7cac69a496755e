#include "sim/devices/quadrotor.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "sim/noise.h"

#define STEP ((sim_time_t)500000)
#define HIGH_M 50.0 /* above everything that a vehicle takes off from */
#define STEP_S 0.0005
#define GRAVITY_MPS2 9.80665
#define DEGREE_RAD (M_PI / 180.0)
#define SQRT_3 1.7320508075688772

#define PULSE_COUNT_NS 480.0
#define PULSE_NO_THRUST_COUNTS 4166.0
#define PULSE_COUNTS_PER_N 177.21
#define SIGNAL_LOST (100 * SIM_MS)
#define PULSES 32U /* on their way through the autopilot */
#define THROTTLE_FULL_N 11.76
#define CLIMB_INTEGRAL_S 0.4 /* of the autopilot's speed controller: about the drag's time constant */
#define BAROMETER_TAU_S 3.0
#define BAROMETER_HIGH_M 1.0
#define SPIN_UP_MPS2 (-3.0) /* its integral on the ground: 70 % of the weight */

#define MOTORS_TURN_N 1.0 /* no lift up to here */
#define ROTOR_RADIUS_M 0.127
#define ROTOR_ABOVE_GEAR_M 0.28
#define TUG_TAU_S 0.12
#define LIFT_MPS 0.2  /* chosen: a hand that lifts the vehicle */
#define ROPE_LOSS 0.3 /* chosen: of critical damping, a cord of nylon */

#define ATTITUDE_DAMPING 0.4
#define HEADING_RAD M_PI /* due south: the heading crosses the wrap all the time */
#define YAW_DRIFT_RAD (10.0 * DEGREE_RAD)
#define YAW_STEP_RAD (0.06 * DEGREE_RAD)

#define ALOFT_M 0.1
#define GEAR_HALF_M 0.15 /* chosen: of its square of feet, inside the rotors */
#define SLIPS_OFF_M \
    0.1 /* chosen: a foot on an edge so far above the ground under the centre does not carry */
#define CONTACT_ARMED_M 0.03
#define GONE_M 0.001 /* ground that is so much lower at once has been taken away */
#define CONTACT_MPS (-0.02)
#define REBOUND 0.15

const quadrotor_config_t quadrotor_default = {.gain = 1.0,
                                              .tau_s = 0.12,
                                              .damping_per_s = 2.4,
                                              .hover_thrust_n = 7.4,
                                              .sag_per_s = 0.001,
                                              .volts_power = 0.0,
                                              .hover_jump_n = 0.0,
                                              .hover_jump_start_s = 10.0,
                                              .turbulence_mps2 = 0.2,
                                              .turbulence_tau_s = 0.5,
                                              .attitude_rms_rad = 2.0 * DEGREE_RAD,
                                              .roll_sway = 1.0,
                                              .pitch_sway = 1.0,
                                              .attitude_hz = 0.6,
                                              .ground_sway = 0.15,
                                              .actuator_delay_s = 0.010,
                                              .climb_rate_mps_per_n = 0.0,
                                              .climb_neutral_n = THROTTLE_FULL_N / 2.0,
                                              .climb_deadband_n = 0.47,
                                              .climb_lag_s = 0.25,
                                              .climb_ceiling_mps = 6.0,
                                              .neutral_drift_n_per_s = 0.0,
                                              .neutral_drift_max_n = 3.5,
                                              .barometer_mps = 0.0,
                                              .naza = {NAZA_ALWAYS_ARMED},
                                              .tug_rate_per_s = 0.0,
                                              .tug_mps2 = -1.5,
                                              .rope_per_s2 = 60.0,
                                              .hang_m = 0.0,
                                              .hang = {10.0, SPAN_FOR_GOOD_S},
                                              .airframe = 0.0,
                                              .rotors = ROTORS_DEFAULT,
                                              .lag2_s = 0.0,
                                              .ground_effect = 1.0,
                                              .gust_mps2 = 0.0,
                                              .gust = {10.0, 1.0},
                                              .tumble_radps = 0.0,
                                              .tumble_start_s = 10.0,
                                              .anchored = false,
                                              .bench_height_m = 0.0,
                                              .bench_roll_rad = 0.0,
                                              .bench_pitch_rad = 0.0,
                                              .bench_roll_start_s = 0.0};

static const place_t endless_floor; /* even */

typedef struct {
    sim_time_t active;
    double thrust_n;
} demand_t;

typedef struct {
    double angle_rad, rate_radps;
    noise_t noise;
} axis_t;

struct quadrotor {
    quadrotor_config_t config;
    sim_time_t clock, origin;
    quadrotor_state_t state;

    demand_t demand[PULSES];
    size_t head, waiting;
    sim_time_t last_pulse;
    double demand_n, lag;
    double volts;            /* share, of the battery */
    double followed_n, lag2; /* the demand behind the autopilot's second lag */
    rotors_t rotors;
    const place_t *place;
    travel_t travel;
    double tumble_rad;
    double climb_integral_mps2; /* of the autopilot's speed controller */
    naza_t naza;
    bool manual, corners, pulses;
    double barometer_mps, barometer_keep; /* the climb that it makes up, for an rms of 1 */
    noise_t barometer_noise;

    double turbulence_mps2, turbulence_keep, turbulence_drive;
    double tug_mps2, tug_keep, tug_probability;
    bool hangs;
    double hook_m; /* end of the rope from above */
    noise_t turbulence_noise, tug_noise;

    axis_t roll, pitch;
    double roll_cosine, pitch_cosine;
    struct {
        double cosine, sine;
    } heading; /* as the feet are asked for */
    double attitude_radps, attitude_drive, yaw_drift_rad;
    noise_t yaw_noise;

    bool counting, was_above;
};

static void prepare_noise(quadrotor_t *q, unsigned long seed)
{
    noise_init(&q->turbulence_noise, seed, "quadrotor turbulence");
    noise_init(&q->tug_noise, seed, "quadrotor tug");
    noise_init(&q->roll.noise, seed, "quadrotor roll");
    noise_init(&q->pitch.noise, seed, "quadrotor pitch");
    noise_init(&q->yaw_noise, seed, "quadrotor yaw");
    noise_init(&q->barometer_noise, seed, "quadrotor barometer");
    q->turbulence_mps2 = q->config.turbulence_mps2 * noise_gauss(&q->turbulence_noise);
}

/* x'' + 2 z w x' + w^2 x = white noise of intensity S has the stationary variance S / (4 z w^3). */
static void prepare_steps(quadrotor_t *q)
{
    const quadrotor_config_t *c = &q->config;
    q->lag = 1.0 - exp(-STEP_S / c->tau_s);
    q->lag2 = c->lag2_s > 0.0 ? 1.0 - exp(-STEP_S / c->lag2_s) : 1.0;
    q->turbulence_keep = exp(-STEP_S / c->turbulence_tau_s);
    q->turbulence_drive = c->turbulence_mps2 * sqrt(1.0 - q->turbulence_keep * q->turbulence_keep);
    q->barometer_keep = exp(-STEP_S / BAROMETER_TAU_S);
    q->tug_keep = exp(-STEP_S / TUG_TAU_S);
    q->tug_probability = 1.0 - exp(-c->tug_rate_per_s * STEP_S);
    q->attitude_radps = 2.0 * M_PI * c->attitude_hz;
    q->attitude_drive = c->attitude_rms_rad *
                        sqrt(4.0 * ATTITUDE_DAMPING * pow(q->attitude_radps, 3.0) * STEP_S);
}

/* After each change of the tilt. */
static void tilted(quadrotor_t *q)
{
    q->roll_cosine = cos(q->state.roll_rad);
    q->pitch_cosine = cos(q->state.pitch_rad);
}

quadrotor_t *quadrotor_create(const quadrotor_config_t *config, const place_t *place, const course_t *course,
                              unsigned long seed)
{
    quadrotor_t *q = calloc(1, sizeof *q);
    if (q == NULL) {
        abort();
    }
    q->config = *config;
    q->place = place != NULL ? place : &endless_floor;
    q->clock = timeline_now();
    q->last_pulse = q->clock;
    q->origin = SIM_NEVER;
    q->volts = 1.0;
    q->counting = true;
    q->state.altitude_m = config->anchored ? config->bench_height_m
                                           : place_below(q->place, 0.0, 0.0, HIGH_M, 0.0).at.z;
    q->state.height_m = config->anchored ? config->bench_height_m : 0.0;
    q->state.on_ground = !config->anchored;
    q->state.yaw_rad = config->anchored ? 0.0 : HEADING_RAD;
    naza_init(&q->naza, &config->naza);
    q->state.motors = q->naza.running;
    tilted(q);
    rotors_init(&q->rotors, &config->rotors);
    travel_init(&q->travel, course);
    q->travel.pace = fmin(1.0, config->attitude_hz / quadrotor_default.attitude_hz);
    prepare_noise(q, seed);
    prepare_steps(q);
    return q;
}

void quadrotor_destroy(quadrotor_t *quadrotor)
{
    free(quadrotor);
}

const place_t *quadrotor_place(const quadrotor_t *quadrotor)
{
    return quadrotor->place;
}

static double scenario_s(const quadrotor_t *q)
{
    return (double)(q->clock - q->origin) / 1e9;
}

double quadrotor_scenario_s(const quadrotor_t *quadrotor)
{
    return (double)(timeline_now() - quadrotor->origin) / 1e9;
}

static void hear_throttle(quadrotor_t *q)
{
    while (q->waiting > 0 && q->demand[q->head].active <= q->clock) {
        q->demand_n = q->demand[q->head].thrust_n;
        q->head = (q->head + 1) % PULSES;
        q->waiting--;
    }
    q->pulses = q->clock - q->last_pulse <= SIGNAL_LOST;
    if (!q->pulses) {
        q->demand_n = 0.0;
    }
}

static void follow_rules(quadrotor_t *q)
{
    const quadrotor_state_t *s = &q->state;
    const naza_inputs_t in = {.throttle = q->demand_n / THROTTLE_FULL_N,
                              .pulses = q->pulses,
                              .corners = q->corners,
                              .manual = q->manual,
                              .on_ground = s->on_ground,
                              .tilt_rad = acos(q->roll_cosine * q->pitch_cosine)};

    naza_step(&q->naza, &in, STEP_S);
    q->state.motor_stops += s->motors && !q->naza.running && s->height_m > ALOFT_M;
    q->state.motors = q->naza.running;
}

/* The propellers' own air on the barometer: a wandering climb that is not there. */
static double barometer_mps(quadrotor_t *q)
{
    const double near = fmax(1.0 - q->state.height_m / BAROMETER_HIGH_M, 0.0);

    if (q->config.barometer_mps <= 0.0) {
        return 0.0;
    }
    q->barometer_mps = q->barometer_mps * q->barometer_keep +
                       sqrt(1.0 - q->barometer_keep * q->barometer_keep) * noise_gauss(&q->barometer_noise);
    return q->config.barometer_mps * near * q->barometer_mps;
}

static double climb_wanted_mps(const quadrotor_t *q)
{
    const quadrotor_config_t *c = &q->config;
    const double drift_n = c->neutral_drift_n_per_s * fmax(scenario_s(q), 0.0);
    const double off_n = q->demand_n - c->climb_neutral_n - fmin(drift_n, c->neutral_drift_max_n);
    const double beyond_n = copysign(fmax(fabs(off_n) - c->climb_deadband_n, 0.0), off_n);
    return fmin(fmax(c->climb_rate_mps_per_n * beyond_n, -c->climb_ceiling_mps), c->climb_ceiling_mps);
}

/* What the autopilot demands of the motors. */
static double autopilot_n(quadrotor_t *q)
{
    const quadrotor_config_t *c = &q->config;
    double wanted_mps;
    if (!q->naza.running) {
        q->climb_integral_mps2 = SPIN_UP_MPS2;
        return 0.0;
    }
    const bool failsafe = naza_failsafe(&q->naza, &wanted_mps);
    if (!failsafe && (c->climb_rate_mps_per_n <= 0.0 || naza_is_manual(&q->naza, q->manual))) {
        q->climb_integral_mps2 = GRAVITY_MPS2 * (q->demand_n / c->hover_thrust_n - 1.0);
        return q->demand_n;
    }
    wanted_mps = failsafe ? wanted_mps : climb_wanted_mps(q);
    if (q->state.on_ground && wanted_mps <= 0.0) {
        q->climb_integral_mps2 = SPIN_UP_MPS2;
        return MOTORS_TURN_N;
    }
    const double push_mps2 = (wanted_mps - q->state.speed_mps - barometer_mps(q)) / c->climb_lag_s;
    const double thrust_n = c->hover_thrust_n * (1.0 + (push_mps2 + q->climb_integral_mps2) / GRAVITY_MPS2);
    const double given_n = fmin(fmax(thrust_n, MOTORS_TURN_N), THROTTLE_FULL_N);
    if (given_n == thrust_n) {
        q->climb_integral_mps2 += STEP_S * push_mps2 / CLIMB_INTEGRAL_S;
    }
    return given_n;
}

/* White, deviation 1. Uniform draws are cheap, and what they drive adds up hundreds of them: it is Gaussian
 * all the same. */
static double white(noise_t *noise)
{
    return noise_uniform(noise, -SQRT_3, SQRT_3);
}

static double gust_mps2(const quadrotor_t *q)
{
    return q->config.gust_mps2 != 0.0 && span_holds(&q->config.gust, scenario_s(q)) ? q->config.gust_mps2
                                                                                    : 0.0;
}

/* A taut rope is a spring with some loss; it never pushes. So much longer it is than slack, and grows so
 * fast. */
static double pull_mps2(const quadrotor_t *q, double longer_m, double grows_mps)
{
    const double loss_mps2 = 2.0 * ROPE_LOSS * sqrt(q->config.rope_per_s2) * grows_mps;

    return longer_m > 0.0 ? fmax(q->config.rope_per_s2 * longer_m + loss_mps2, 0.0) : 0.0;
}

/* By the rope to the floor, and by that from above: it catches the vehicle where it is, and lifts it. */
static double rope_mps2(quadrotor_t *q)
{
    const quadrotor_config_t *config = &q->config;
    const double z_m = q->state.altitude_m;
    const double speed_mps = q->state.speed_mps;
    const bool tied = config->rope_m > 0.0;
    const bool hangs = config->hang_m > 0.0 && span_holds(&config->hang, scenario_s(q));

    q->hook_m = fmin(q->hangs ? q->hook_m + LIFT_MPS * STEP_S : z_m, config->hang_m);
    q->hangs = hangs;
    const double lifts_mps = q->hook_m < config->hang_m ? LIFT_MPS : 0.0;
    return (hangs ? pull_mps2(q, q->hook_m - z_m, lifts_mps - speed_mps) : 0.0) -
           (tied ? pull_mps2(q, z_m - config->rope_m, speed_mps) : 0.0);
}

static double disturbance_mps2(quadrotor_t *q)
{
    q->turbulence_mps2 = q->turbulence_mps2 * q->turbulence_keep +
                         q->turbulence_drive * white(&q->turbulence_noise);
    if (q->config.tug_rate_per_s <= 0.0) {
        return q->turbulence_mps2 + rope_mps2(q);
    }
    q->tug_mps2 *= q->tug_keep;
    if (noise_uniform(&q->tug_noise, 0.0, 1.0) < q->tug_probability) {
        q->tug_mps2 += q->config.tug_mps2;
    }
    return q->turbulence_mps2 + q->tug_mps2 + rope_mps2(q);
}

static void swing(axis_t *axis, double w, double drive, double rest_rad)
{
    axis->rate_radps += STEP_S * (w * w * (rest_rad - axis->angle_rad) -
                                  2.0 * ATTITUDE_DAMPING * w * axis->rate_radps);
    axis->rate_radps += drive * white(&axis->noise);
    axis->angle_rad += STEP_S * axis->rate_radps;
}

static void rotate(quadrotor_t *q, double t_s)
{
    const double share = q->state.on_ground ? q->config.ground_sway : 1.0;
    const double steered = q->state.on_ground ? 0.0 : 1.0;
    travel_steer(&q->travel, t_s, STEP_S, q->state.heading_rad);
    const double drive = share * q->attitude_drive;
    swing(&q->roll, q->attitude_radps, q->config.roll_sway * drive, steered * q->travel.roll_rad);
    swing(&q->pitch, q->attitude_radps, q->config.pitch_sway * drive, steered * q->travel.pitch_rad);
    if (q->config.tumble_radps != 0.0 && t_s >= q->config.tumble_start_s && !q->state.on_ground &&
        fabs(q->tumble_rad) < M_PI) {
        q->tumble_rad += STEP_S * q->config.tumble_radps;
    }
    q->state.roll_rad = q->roll.angle_rad + q->tumble_rad;
    q->state.pitch_rad = q->pitch.angle_rad;
    tilted(q);

    const double turn_rad = noise_uniform(&q->yaw_noise, -YAW_STEP_RAD, YAW_STEP_RAD);
    const double wander = q->yaw_drift_rad + (q->state.on_ground ? 0.0 : turn_rad); /* its feet stick */
    q->yaw_drift_rad = fmin(fmax(wander, -YAW_DRIFT_RAD), YAW_DRIFT_RAD);
    q->state.heading_rad = q->travel.wanted.heading_rad - q->yaw_drift_rad;
    q->state.yaw_rad = remainder(HEADING_RAD - q->state.heading_rad, 2.0 * M_PI);
}

static double ground_effect(const quadrotor_t *q)
{
    const double ratio = ROTOR_RADIUS_M / (4.0 * (q->state.height_m + ROTOR_ABOVE_GEAR_M));
    return 1.0 / (1.0 - 2.0 * q->config.ground_effect * ratio * ratio);
}

static double hover_n(const quadrotor_t *q, double t_s)
{
    const quadrotor_config_t *c = &q->config;
    const double jump_n = t_s >= c->hover_jump_start_s ? c->hover_jump_n : 0.0;
    return c->hover_thrust_n * (1.0 + c->sag_per_s * fmax(t_s, 0.0)) + jump_n;
}

static double lift_mps2(const quadrotor_t *q, double t_s)
{
    const quadrotor_state_t *s = &q->state;
    if (s->thrust_n <= MOTORS_TURN_N) {
        return 0.0;
    }
    const double excess = q->config.gain * (s->thrust_n - hover_n(q, t_s)) / q->config.hover_thrust_n;
    return GRAVITY_MPS2 * (1.0 + excess) * ground_effect(q) * q->roll_cosine * q->pitch_cosine;
}

/* Lift less drag. */
static double air_mps2(quadrotor_t *q, double t_s)
{
    const quadrotor_state_t *s = &q->state;
    if (q->config.airframe < 0.5) {
        return lift_mps2(q, t_s) - GRAVITY_MPS2 - q->config.damping_per_s * s->speed_mps;
    }
    const double upright = q->roll_cosine * q->pitch_cosine;
    return GRAVITY_MPS2 * (rotors_thrust(&q->rotors, s->speed_mps) * ground_effect(q) * upright - 1.0) -
           rotors_drag_mps2(&q->rotors, s->speed_mps, upright);
}

/* Newtons that lift as much with a full battery as what the autopilot gives does with this one. */
static double with_volts(const quadrotor_t *q, double given_n)
{
    const double power = q->config.volts_power;
    if (power == 0.0 || q->volts == 1.0) {
        return given_n;
    }
    return given_n * pow(q->volts, q->config.airframe < 0.5 ? power : power / q->config.rotors.exponent);
}

/* The motors one step later. */
static void spin(quadrotor_t *q, double t_s)
{
    quadrotor_state_t *s = &q->state;
    const double given_n = with_volts(q, autopilot_n(q));
    q->followed_n = q->lag2 < 1.0 ? q->followed_n + q->lag2 * (given_n - q->followed_n) : given_n;
    if (q->config.airframe < 0.5) {
        s->thrust_n += q->lag * (q->followed_n - s->thrust_n);
        return;
    }
    rotors_step(&q->rotors, STEP_S, q->followed_n <= MOTORS_TURN_N ? 0.0 : q->followed_n / hover_n(q, t_s),
                s->speed_mps);
    s->thrust_n = q->config.hover_thrust_n * rotors_thrust(&q->rotors, s->speed_mps);
}

static void touch(quadrotor_t *q, double terrain_m, double terrain_mps)
{
    quadrotor_state_t *s = &q->state;
    const double closing_mps = s->speed_mps - terrain_mps;
    const bool impact = closing_mps < CONTACT_MPS;
    if (impact && q->was_above && q->counting) {
        s->contacts++;
    }
    q->was_above = false;
    s->altitude_m = terrain_m;
    s->speed_mps = impact ? terrain_mps - REBOUND * closing_mps : 0.0;
    s->on_ground = !impact;
}

static void rise_or_rest(quadrotor_t *q, double acceleration_mps2, double terrain_m, double terrain_mps)
{
    quadrotor_state_t *s = &q->state;
    const bool carried = terrain_mps >= 0.0 && s->altitude_m - terrain_m < GONE_M;
    if (s->on_ground && acceleration_mps2 <= 0.0 && carried) {
        s->altitude_m = terrain_m;
        s->acceleration_mps2 = 0.0;
        return;
    }
    s->on_ground = false;
    s->acceleration_mps2 = acceleration_mps2;
    s->speed_mps += STEP_S * acceleration_mps2;
    s->altitude_m += STEP_S * s->speed_mps;
    if (s->altitude_m - terrain_m > CONTACT_ARMED_M) {
        q->was_above = true;
    }
    if (s->altitude_m <= terrain_m) {
        touch(q, terrain_m, terrain_mps);
    }
}

/* The ground under the centre, what carries the gear (the highest under its feet), and how fast that rises
 * under a vehicle that moves. A bar's or a block's edge has no speed: it is not what throws a vehicle up. */
typedef struct {
    double centre_m, carries_m, rises_mps;
} ground_t;

static place_hit_t below(const quadrotor_t *q, double fore_m, double right_m, double t_s)
{
    const double c = q->heading.cosine, s = q->heading.sine;

    return place_below(q->place, q->travel.x_m + c * fore_m + s * right_m,
                       q->travel.y_m + s * fore_m - c * right_m, q->state.altitude_m, t_s);
}

/* How fast a slope carries a vehicle up that moves onto it: what is left of its speed along the slope after
 * the impact, upwards. v s / (1 + s^2) for slope s: v / 2 at most, so that no edge of a rough floor gives
 * more than the vehicle had. */
static double climb_mps(const place_hit_t *hit, double vx_mps, double vy_mps)
{
    const double rise_mps = hit->slope_x * vx_mps + hit->slope_y * vy_mps;
    const double speed_m2ps2 = vx_mps * vx_mps + vy_mps * vy_mps;

    return speed_m2ps2 > 0.0 ? rise_mps * speed_m2ps2 / (speed_m2ps2 + rise_mps * rise_mps) : 0.0;
}

static ground_t ground_below(quadrotor_t *q, double t_s)
{
    q->heading.cosine = cos(q->state.heading_rad);
    q->heading.sine = sin(q->state.heading_rad);

    place_hit_t highest = below(q, 0.0, 0.0, t_s);
    const double centre_m = highest.at.z;
    const bool far = q->state.altitude_m > centre_m + SLIPS_OFF_M + CONTACT_ARMED_M; /* nothing carries */

    for (int foot = 0; foot < 4 && !far; foot++) {
        const place_hit_t hit = below(q, foot & 1 ? GEAR_HALF_M : -GEAR_HALF_M,
                                      foot & 2 ? GEAR_HALF_M : -GEAR_HALF_M, t_s);
        if (hit.at.z > highest.at.z && hit.at.z < centre_m + SLIPS_OFF_M) {
            highest = hit;
        }
    }
    return (ground_t){centre_m, highest.at.z,
                      highest.rises_mps + climb_mps(&highest, q->travel.vx_mps, q->travel.vy_mps)};
}

static void collide(quadrotor_t *q, double t_s)
{
    const place_vector_t centre = {q->travel.x_m, q->travel.y_m, q->state.altitude_m};

    if (place_inside(q->place, centre, t_s)) {
        q->state.collided = true;
    }
}

/* Lift along the rotors' axis is what holds the vehicle up, over the cosine of its tilt. */
static void advance(quadrotor_t *q, double t_s, double air_mps2)
{
    quadrotor_state_t *s = &q->state;
    const double upright = q->roll_cosine * q->pitch_cosine;
    const double lift_mps2 = fmax(air_mps2 + GRAVITY_MPS2, 0.0) / fmax(upright, 0.1);

    travel_step(&q->travel, STEP_S, s->heading_rad, s->roll_rad, s->pitch_rad, lift_mps2, s->on_ground);
    s->x_m = q->travel.x_m;
    s->y_m = q->travel.y_m;
    collide(q, t_s);
}

/* In somebody's hands, or on the bench. */
static void hold(quadrotor_t *q)
{
    quadrotor_state_t *s = &q->state;

    s->altitude_m = q->config.bench_height_m;
    s->speed_mps = s->acceleration_mps2 = 0.0;
    s->on_ground = false;
    if ((double)q->clock * 1e-9 >= q->config.bench_roll_start_s) {
        s->roll_rad = q->config.bench_roll_rad;
        s->pitch_rad = q->config.bench_pitch_rad;
        tilted(q);
    }
}

static void step(quadrotor_t *q)
{
    quadrotor_state_t *s = &q->state;
    hear_throttle(q);
    follow_rules(q);
    q->clock += STEP;
    const double t_s = scenario_s(q);
    const ground_t ground = ground_below(q, t_s);
    spin(q, t_s);
    if (!q->config.anchored) {
        rotate(q, t_s);
        const double air = air_mps2(q, t_s);
        const double acceleration_mps2 = air + disturbance_mps2(q) + gust_mps2(q);
        rise_or_rest(q, acceleration_mps2, ground.carries_m, ground.rises_mps);
        advance(q, t_s, air);
    } else {
        hold(q);
    }
    s->terrain_m = ground.centre_m;
    s->height_m = s->altitude_m - ground.centre_m;
    s->clearance_m = s->altitude_m - ground.carries_m;
}

static void bring_up(quadrotor_t *q)
{
    while (q->clock + STEP <= timeline_now()) {
        step(q);
    }
}

void quadrotor_set_origin(quadrotor_t *quadrotor, sim_time_t origin)
{
    bring_up(quadrotor);
    quadrotor->origin = origin;
}

void quadrotor_change(quadrotor_t *quadrotor, const quadrotor_config_t *config)
{
    bring_up(quadrotor);
    quadrotor->config = *config;
    quadrotor->rotors.config = config->rotors;
    prepare_steps(quadrotor);
}

void quadrotor_follow(quadrotor_t *quadrotor, const course_t *course)
{
    bring_up(quadrotor);
    travel_follow(&quadrotor->travel, course);
}

void quadrotor_set_volts(quadrotor_t *quadrotor, double share)
{
    bring_up(quadrotor);
    quadrotor->volts = share;
}

void quadrotor_pulse(quadrotor_t *quadrotor, sim_time_t high_ns)
{
    quadrotor_t *q = quadrotor;
    bring_up(q);
    const double counts = (double)high_ns / PULSE_COUNT_NS;
    if (q->waiting < PULSES) {
        q->waiting++;
    }
    q->demand[(q->head + q->waiting - 1) % PULSES] = (demand_t){
        .active = timeline_now() + (sim_time_t)llround(q->config.actuator_delay_s * 1e9),
        .thrust_n = fmax((PULSE_NO_THRUST_COUNTS - counts) / PULSE_COUNTS_PER_N, 0.0)};
    q->last_pulse = timeline_now();
}

void quadrotor_set_manual(quadrotor_t *quadrotor, bool manual)
{
    bring_up(quadrotor);
    quadrotor->manual = manual;
}

void quadrotor_hold_corners(quadrotor_t *quadrotor, bool held)
{
    bring_up(quadrotor);
    quadrotor->corners = held;
}

const quadrotor_state_t *quadrotor_state(quadrotor_t *quadrotor)
{
    bring_up(quadrotor);
    return &quadrotor->state;
}

void quadrotor_stop_counting_contacts(quadrotor_t *quadrotor)
{
    bring_up(quadrotor);
    quadrotor->counting = false;
}
