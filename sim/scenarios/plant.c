#include "sim/scenarios/plant.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#define LARGE 1e9
#define DEG (M_PI / 180.0)

typedef struct {
    const char *name, *unit;
    double least, most;
    size_t field; /* a double in a plant_t */
    double scale; /* the field's unit in the figure's */
    const char *meaning;
} figure_t;

#define AT(field) offsetof(plant_t, field)
#define QUAD(field) offsetof(plant_t, board.quadrotor.field)
#define SCENE(field) offsetof(plant_t, board.scene.field)
#define IMU(field) offsetof(plant_t, board.imu.field)
#define PILOT(field) offsetof(plant_t, board.pilot.field)
#define STICK(field) offsetof(plant_t, board.stick.field)
#define BATTERY(field) offsetof(plant_t, board.battery.field)

static const figure_t figures[] = {
    {"airframe", "-", 0, 1, QUAD(airframe), 1,
     "0: thrust in proportion, one lag; 1: by momentum theory, two lags"},
    {"gain", "-", 0, 100, QUAD(gain), 1, "thrust effectiveness (airframe 0)"},
    {"tau", "s", 1e-4, 100, QUAD(tau_s), 1, "motor time constant (airframe 0)"},
    {"damping", "1/s", 0, 100, QUAD(damping_per_s), 1, "vertical damping D (airframe 0)"},
    {"exponent", "-", 0.2, 5, QUAD(rotors.exponent), 1,
     "thrust goes with the throttle to the power of it (airframe 1)"},
    {"spin_up", "s", 1e-3, 100, QUAD(rotors.spin_up_s), 1, "the rotors' lag upwards (airframe 1)"},
    {"slow_down", "s", 1e-3, 100, QUAD(rotors.slow_down_s), 1, "and downwards (airframe 1)"},
    {"inflow_lag", "s", 1e-2, 100, QUAD(rotors.inflow_lag_s), 1,
     "of the air through the rotors (airframe 1)"},
    {"drag", "1/m", 0, 100, QUAD(rotors.drag_per_m), 1,
     "deceleration by the square of the climb (airframe 1)"},
    {"tilt_drag", "-", 0, 100, QUAD(rotors.tilt_drag), 1,
     "that much more by the square of the tilt's sine (airframe 1)"},
    {"hover_thrust", "N", 0.1, 100, QUAD(hover_thrust_n), 1, "hover thrust per motor TH0"},
    {"sag", "1/s", -1, 1, QUAD(sag_per_s), 1, "battery sag: growth of the hover thrust's command"},
    {"volts_power", "-", 0, 4, QUAD(volts_power), 1,
     "thrust goes with the battery's voltage to the power of it; 0: compensated"},
    {"hover_jump", "N", -100, 100, QUAD(hover_jump_n), 1,
     "and that much more from then on: a load, a lost blade; < 0: a load let go"},
    {"hover_jump_start", "s", -LARGE, LARGE, QUAD(hover_jump_start_s), 1, "scenario time at which"},
    {"turbulence", "m/s2", 0, 100, QUAD(turbulence_mps2), 1, "rms"},
    {"turbulence_tau", "s", 1e-3, 1000, QUAD(turbulence_tau_s), 1, "correlation time"},
    {"gust", "m/s2", -100, 100, QUAD(gust_mps2), 1, "one gust, upwards"},
    {"gust_start", "s", -LARGE, LARGE, QUAD(gust.start_s), 1, "scenario time at which it begins"},
    {"gust_length", "s", 0, LARGE, QUAD(gust.length_s), 1, "and how long it blows"},
    {"ground_effect", "-", 0, 10, QUAD(ground_effect), 1, "times that of Cheeseman and Bennett"},
    {"attitude_rms", "rad", 0, 1, QUAD(attitude_rms_rad), 1, "roll and pitch motion"},
    {"attitude_hz", "Hz", 0.05, 5, QUAD(attitude_hz), 1, "its natural frequency"},
    {"roll_sway", "-", 0, 1, QUAD(roll_sway), 1, "share of it about the roll axis"},
    {"pitch_sway", "-", 0, 1, QUAD(pitch_sway), 1, "and about the pitch axis"},
    {"ground_sway", "-", 0, 1, QUAD(ground_sway), 1, "share of it on the ground"},
    {"tumble", "deg/s", -10000, 10000, QUAD(tumble_radps), DEG,
     "roll rate of a vehicle that turns on its back"},
    {"tumble_start", "s", -LARGE, LARGE, QUAD(tumble_start_s), 1, "scenario time at which it begins"},
    {"tdelay", "s", 0, 0.3, QUAD(actuator_delay_s), 1, "autopilot delay behind the pulse"},
    {"lag2", "s", 0, 100, QUAD(lag2_s), 1, "a second lag, of the autopilot; 0: none"},
    {"climb_rate", "m/s/N", 0, 100, QUAD(climb_rate_mps_per_n), 1,
     "climb rate that the throttle commands; 0: thrust"},
    {"climb_neutral", "N", 0, 100, QUAD(climb_neutral_n), 1, "throttle that commands no climb"},
    {"climb_deadband", "N", 0, 100, QUAD(climb_deadband_n), 1, "to either side of it"},
    {"climb_lag", "s", 1e-3, 100, QUAD(climb_lag_s), 1, "of the autopilot's speed loop"},
    {"climb_ceiling", "m/s", 0, 100, QUAD(climb_ceiling_mps), 1,
     "fastest climb and descent of the autopilot"},
    {"stop_type", "-", -1, 1, QUAD(naza.stop_type), 1,
     "-1: motors always armed; 0: stop Immediately; 1: Intelligent"},
    {"attitude_throttle", "-", 0, 1, AT(attitude_throttle), 1,
     "1: in Attitude the throttle commands a climb rate; 0: thrust"},
    {"neutral_drift", "N/s", -1, 1, QUAD(neutral_drift_n_per_s), 1,
     "that fast the middle of the stick goes up, low battery"},
    {"barometer", "m/s", 0, 10, QUAD(barometer_mps), 1,
     "climb that the barometer makes up at the ground, rms"},
    {"tug_rate", "1/s", 0, 1000, QUAD(tug_rate_per_s), 1, "rope tugs"},
    {"tug", "m/s2", -100, 100, QUAD(tug_mps2), 1, "of one rope tug"},
    {"rope", "m", 0, 10, QUAD(rope_m), 1, "length of a rope to the floor, taut above it; 0: none"},
    {"rope_pull", "1/s2", 0, 5000, QUAD(rope_per_s2), 1, "what it pulls then, m/s2 for each metre"},
    {"hang", "m", 0, 10, QUAD(hang_m), 1,
     "a hand, or a rope from above, lifts it to there and holds it; 0: none"},
    {"hang_start", "s", -LARGE, LARGE, QUAD(hang.start_s), 1, "scenario time from which on it holds"},
    {"hang_length", "s", 0, LARGE, QUAD(hang.length_s), 1, "and for how long"},
    {"platform", "m", -10, 10, AT(ground.platform_m), 1, "height of the ramp's platform; < 0: a pit"},
    {"course_speed", "m/s", 0.05, 2, AT(ground.speed_mps), 1,
     "over that ramp; its edge comes at 11 s all the same"},
    {"course_nose_deg", "deg", -180, 180, AT(ground.nose_rad), M_PI / 180.0,
     "from that way to the nose; 180: tail first"},
    {"floor_rms_mm", "mm", 0, 10000, AT(ground.rough_rms_m), 1e-3,
     "uneven floor under the flight, which then advances"},
    {"floor_tau", "s", 1e-2, 1000, AT(ground.rough_s), 1, "its correlation time at that speed"},
    {"bars_mm", "mm", -1000, 1000, AT(ground.bars_m), 1e-3, "bars on the floor"},
    {"bars_period", "s", 1e-2, 1000, AT(ground.bars_s), 1, "from bar to bar at that speed"},
    {"bars_share", "-", 0, 1, AT(ground.bars_share), 1, "of that is a bar"},
    {"edge_m", "m", -10, 10, SCENE(edge_m), 1,
     "the beam's ground lies that much higher than the gear's; < 0: lower"},
    {"edge_start", "s", -LARGE, LARGE, SCENE(edge_start_s), 1, "scenario time from which on"},
    {"ray_noise", "mm", 0, 1000, SCENE(ray_sigma_mm), 1, "of each ray, rms"},
    {"ray_correlation", "-", 0, 0.99, SCENE(ray_correlation), 1,
     "of neighbouring rays' noise; recorded: 0.5"},
    {"common_noise", "mm", 0, 1000, SCENE(common_sigma_mm), 1, "of all rays of a scan, rms"},
    {"mirror_noise", "mm", 0, 1000, SCENE(mirror_sigma_mm), 1,
     "of all rays of a mirror in a scan, each mirror its own, rms"},
    {"wander", "mm", 0, 1000, SCENE(wander_sigma_mm), 1, "slow drift of all rays, rms; recorded: 2"},
    {"wander_tau", "s", 0.1, 10000, SCENE(wander_tau_s), 1, "its correlation time"},
    {"warm_up_mm", "mm", -1000, 1000, SCENE(warm_up_mm), 1, "that much too far at power-on, then less"},
    {"warm_up_tau", "s", 1, 100000, SCENE(warm_up_s), 1, "by 1/e in each such time"},
    {"spot", "rad", 0, 0.1, SCENE(spot_rad), 1,
     "half the width of what a ray lights: mixed at edges; recorded: 0.006"},
    {"sunlight", "-", 0, 1, SCENE(sunlight), 1, "on everything; 1: straight from the sun"},
    {"glitches", "-", 0, 1, SCENE(glitch_probability), 1, "probability of a broken scan"},
    {"outlier_mm", "mm", -4000, 4000, SCENE(outlier_mm), 1,
     "too far, in outlier_run scans on end of each outlier_every"},
    {"outlier_run", "scans", 1, 1000, SCENE(outlier_run), 1, "on end"},
    {"outlier_every", "scans", 1, 1000, SCENE(outlier_every), 1,
     "from the first of a run to that of the next"},
    {"outlier_start", "s", -LARGE, LARGE, SCENE(outlier_start_s), 1, "scenario time from which on"},
    {"rays_lost", "-", 0, 1, SCENE(rays_lost), 1,
     "share of the rays, each scan others, that are codes below 20"},
    {"rays_lost_start", "s", -LARGE, LARGE, SCENE(rays_lost_span.start_s), 1,
     "scenario time from which on; -1000: from power-on"},
    {"rays_lost_length", "s", 0, LARGE, SCENE(rays_lost_span.length_s), 1, "for how long"},
    {"around_lost", "-", 0, 1, SCENE(around_lost), 1,
     "share of the rays between the mirrors that find too little light"},
    {"around_garbage", "-", 0, 1, SCENE(around_garbage), 1, "share of them that tell any distance"},
    {"around_holder", "mm", 0, 4000, SCENE(around_holder_mm), 1,
     "a holder stands so far off before a third of those ahead; 0: none"},
    {"sight_blocked", "-", 0, 1, SCENE(sight_blocked), 1,
     "share of the rays that see a thing in front of the mirror"},
    {"block_mm", "mm", 20, 4000, SCENE(block_mm), 1, "at that distance, with ray_noise"},
    {"sight_blocked_start", "s", -LARGE, LARGE, SCENE(sight_blocked_span.start_s), 1,
     "scenario time from which on; -1000: from power-on"},
    {"sight_blocked_length", "s", 0, LARGE, SCENE(sight_blocked_span.length_s), 1, "for how long"},
    {"scan_frozen_start", "s", -LARGE, LARGE, SCENE(frozen.start_s), 1,
     "scenario time from which scans repeat, with new time stamps"},
    {"scan_frozen_length", "s", 0, LARGE, SCENE(frozen.length_s), 1, "for how long"},
    {"struck_beam", "-", 0, 6, SCENE(struck_beam), 1,
     "beams so struck: 0 all, 1 front, 2 aft, 3 fore; 4, 5, 6: not 3, 2, 1"},
    {"missing_mirror", "-", 0, 6, SCENE(missing_mirror), 1,
     "not there: 0 none, 1 front, 2 aft, 3 fore; 4, 5, 6: not 3, 2, 1"},
    {"ray_instant", "s", 0, 0.1, AT(ray_instant_s), 1,
     "of step 389, the front's middle, after the start of a revolution"},
    {"scan_late", "s", 0, 0.09, AT(scan_late_s), 1,
     "each scan comes so much later, as a longer answer would"},
    {"scanner_answers", "-", 0, 1, AT(scanner_answers), 1,
     "0: 8 ms after a command; 1: as recorded, once a revolution"},
    {"scanner_rate", "bit/s", 19200, 750000, AT(board.laser.power_up_rate), 1,
     "at power-up, as stored in it; from the factory 19200"},
    {"scanner_boot", "s", 0.1, 30, AT(scanner_boot_s), 1, "from its power to the first octet that it hears"},
    {"clock_ppm", "ppm", -10000, 10000, AT(clock_ppm), 1, "the scanner's clock against true time"},
    {"outage_start", "s", -LARGE, LARGE, AT(outage_start_s), 1,
     "scenario time from which the scanner's line is mute"},
    {"outage", "s", 0, 600, AT(outage_s), 1, "for how long, from the first octet lost; 0: not at all"},
    {"scanner_restart_start", "s", -LARGE, LARGE, AT(restart_start_s), 1,
     "scenario time at which the scanner loses its power for a moment"},
    {"radio_lost_start", "s", -LARGE, LARGE, AT(radio_lost_start_s), 1,
     "scenario time from which the radio is out of reach"},
    {"pin_stuck", "-", -1, 1, AT(pin_stuck), 1,
     "the selector's pin (SEL PIN) says 0: pilot; 1: firmware; -1: truth"},
    {"pin_stuck_start", "s", -LARGE, LARGE, AT(pin_stuck_start_s), 1, "scenario time from which on"},
    {"pin_stuck_length", "s", 0, LARGE, AT(pin_stuck_length_s), 1, "for how long"},
    {"imu_noise", "rad", 0, 1, IMU(angle_noise_rad), 1, "of roll and pitch, rms"},
    {"imu_spikes", "-", 0, 1, IMU(spike_probability), 1, "probability of a spike per angle"},
    {"imu_spike_deg", "deg", 0, 180, IMU(spike_rad), DEG, "how far it is off, to either side"},
    {"attitude_burst_deg", "deg", -180, 180, IMU(attitude_burst_rad), DEG,
     "added to the attitude that the IMU tells"},
    {"attitude_burst_degps", "deg/s", -10000, 10000, IMU(attitude_burst_radps), DEG,
     "and that grows so fast meanwhile"},
    {"attitude_burst_turned", "deg", -180, 180, IMU(attitude_burst_turned_rad), DEG,
     "to which side: 0 roll, 90 pitch, between them both"},
    {"attitude_burst_start", "s", -LARGE, LARGE, IMU(attitude_burst.start_s), 1,
     "scenario time from which on"},
    {"attitude_burst_length", "s", 0, LARGE, IMU(attitude_burst.length_s), 1,
     "for how long; a frame is 0.025"},
    {"acc_noise", "m/s2", 0, 100, IMU(acceleration_noise_mps2), 1, "accelerometer, rms"},
    {"acc_bias", "m/s2", -100, 100, IMU(acceleration_bias_mps2), 1, "accelerometer"},
    {"acc_scale", "-", 0, 1000, IMU(acceleration_scale), 1,
     "counts for each 1/256 g; 0.00390625: it tells g"},
    {"acc_sign", "-", -1, 1, IMU(acceleration_sign), 1, "-1: all its axes the other way round"},
    {"acc_jump", "m/s2", -100, 100, IMU(acceleration_jump_mps2), 1, "bias that comes in flight"},
    {"acc_jump_start", "s", -LARGE, LARGE, IMU(acceleration_jump_start_s), 1, "scenario time at which"},
    {"acc_alias", "m/s2", 0, 100, IMU(acceleration_alias_mps2), 1,
     "amplitude of a vibration that sampling makes a slow one"},
    {"acc_alias_hz", "Hz", 0, 1000, IMU(acceleration_alias_hz), 1, "of so many oscillations"},
    {"imu_stock", "-", 0, 1, IMU(stock), 1, "1: a Razor as it comes: angles alone, every 20 ms"},
    {"imu_period", "s", 0, 0.2, AT(imu_period_s), 1,
     "from frame to frame; 0: 0.025, stock 0.02; least 0.011"},
    {"imu_age", "s", 0, 0.15, AT(imu_age_s), 1, "of a frame's content as its first octet leaves"},
    {"imu_roll_sign", "-", -1, 1, IMU(roll_sign), 1, "-1: it tells roll the other way round"},
    {"imu_pitch_sign", "-", -1, 1, IMU(pitch_sign), 1, "-1: it tells pitch the other way round"},
    {"imu_swapped", "-", 0, 1, IMU(swapped), 1, "1: it tells roll and pitch in each other's place"},
    {"imu_angle_scale", "-", 0, 1, IMU(angle_scale), 1, "for each degree; 0.0174533: it tells radians"},
    {"imu_turned", "-", 0, 1, IMU(turned), 1, "1: mounted with its nose to the tail"},
    {"imu_mount_roll_deg", "deg", -20, 20, IMU(mount_roll_rad), DEG, "it lies so on a level vehicle"},
    {"imu_mount_pitch_deg", "deg", -20, 20, IMU(mount_pitch_rad), DEG, "likewise"},
    {"imu_mute_start", "s", -LARGE, LARGE, IMU(mute.start_s), 1,
     "scenario time from which the IMU sends nothing"},
    {"imu_mute", "s", 0, LARGE, IMU(mute.length_s), 1, "for how long; 0: not at all"},
    {"imu_frozen_start", "s", -LARGE, LARGE, IMU(frozen.start_s), 1,
     "scenario time from which it repeats its latest frame"},
    {"imu_frozen", "s", 0, LARGE, IMU(frozen.length_s), 1, "for how long; 0: not at all"},
    {"imu_garbled_start", "s", -LARGE, LARGE, IMU(garbled.start_s), 1,
     "scenario time from which octets of it have a wrong bit"},
    {"imu_garbled", "s", 0, LARGE, IMU(garbled.length_s), 1, "for how long; 0: not at all"},
    {"imu_garbled_share", "-", 0, 1, IMU(garbled_share), 1, "share of those octets"},
    {"pilot_start", "s", -LARGE, LARGE, PILOT(turn.start_s), 1,
     "scenario time at which the pilot takes the throttle"},
    {"pilot", "s", 0, LARGE, PILOT(turn.length_s), 1, "for how long; 0: never (see also parameter SEL)"},
    {"pilot_every", "s", 0, LARGE, PILOT(every_s), 1,
     "and again, so long after the start of the turn before; 0: once"},
    {"pilot_until", "s", -LARGE, LARGE, PILOT(until_s), 1, "scenario time after which none of these begins"},
    {"pilot_height", "m", 0, 10, PILOT(height_m), 1, "height that the pilot holds; 0: lands it"},
    {"pilot_trim", "N", 0, 12, PILOT(trim_n), 1, "where the stick is when the turn begins"},
    {"pilot_delay", "s", 0, 1.2, PILOT(delay_s), 1, "from the pilot's eye to the hand"},
    {"stick", "-", 0, 1, STICK(connected), 1, "1: the receiver's throttle channel is wired to the firmware"},
    {"stick_offset", "us", -1000, 1000, STICK(offset_us), 1, "added to each pulse of that wire: trim"},
    {"stick_noise", "us", 0, 1000, STICK(noise_us), 1, "of each pulse, rms"},
    {"stick_spikes", "-", 0, 1, STICK(spikes), 1, "probability that a pulse has any length up to 3 ms"},
    {"stick_stuck_us", "us", 1, 3000, STICK(stuck_us), 1, "the pulse is that, whatever the pilot does"},
    {"stick_stuck_start", "s", -LARGE, LARGE, STICK(stuck.start_s), 1, "scenario time from which on"},
    {"stick_stuck_length", "s", 0, LARGE, STICK(stuck.length_s), 1, "for how long"},
    {"stick_frozen_start", "s", -LARGE, LARGE, STICK(frozen.start_s), 1,
     "scenario time from which the pulse of that moment is repeated"},
    {"stick_frozen_length", "s", 0, LARGE, STICK(frozen.length_s), 1, "for how long"},
    {"stick_lost_start", "s", -LARGE, LARGE, STICK(lost.start_s), 1,
     "scenario time from which that wire has no pulses"},
    {"stick_lost_length", "s", 0, LARGE, STICK(lost.length_s), 1, "for how long"},
    {"battery", "-", 0, 1, BATTERY(connected), 1, "1: the power module's voltage is wired to the firmware"},
    {"battery_cells", "-", 1, 8, BATTERY(cells), 1, "in series"},
    {"battery_charge", "-", 0, 1, BATTERY(charge), 1, "at power-on"},
    {"battery_capacity", "Ah", 0.05, 50, BATTERY(capacity_ah), 1, "when full"},
    {"battery_ohm", "Ohm", 0, 0.5, BATTERY(resistance_ohm), 1,
     "of all cells and leads: what the voltage sags by"},
    {"battery_amps", "A", 0, 200, BATTERY(hover_a), 1, "in a hover; with the thrust to the power of 1.5"},
    {"battery_divider", "-", 1, 100, BATTERY(divider), 1, "the power module's, truly"},
    {"battery_noise", "V", 0, 20, BATTERY(noise_v), 1, "of each reading, rms"},
    {"battery_loose", "-", 0, 1, BATTERY(loose), 1, "probability that a reading finds that wire open"},
    {"battery_stuck_v", "V", 0, 50, BATTERY(stuck_v), 1, "the voltage is told as that, with its noise"},
    {"battery_stuck_start", "s", -LARGE, LARGE, BATTERY(stuck.start_s), 1, "scenario time from which on"},
    {"battery_stuck_length", "s", 0, LARGE, BATTERY(stuck.length_s), 1, "for how long"},
    {"battery_frozen_start", "s", -LARGE, LARGE, BATTERY(frozen.start_s), 1,
     "scenario time from which the reading of that moment is repeated"},
    {"battery_frozen_length", "s", 0, LARGE, BATTERY(frozen.length_s), 1, "for how long"},
    {"battery_lost_start", "s", -LARGE, LARGE, BATTERY(lost.start_s), 1,
     "scenario time from which that wire is open"},
    {"battery_lost_length", "s", 0, LARGE, BATTERY(lost.length_s), 1, "for how long"},
};
#define FIGURE_COUNT (sizeof figures / sizeof figures[0])

static const figure_t *find(const char *name)
{
    for (size_t i = 0; i < FIGURE_COUNT; i++) {
        if (strncmp(name, "plant.", 6) == 0 && strcmp(figures[i].name, name + 6) == 0) {
            return &figures[i];
        }
    }
    return NULL;
}

static double *field_of(plant_t *plant, const figure_t *figure)
{
    return (double *)(void *)((char *)plant + figure->field);
}

void plant_init(plant_t *plant, unsigned long seed)
{
    *plant = (plant_t){.board = board_config(seed), .ground = seed_course_flat};
    plant->ray_instant_s = (double)plant->board.laser.ray_instant * 1e-9;
    plant->scanner_boot_s = (double)plant->board.laser.boot * 1e-9;
    plant->scanner_answers = plant->board.laser.answers_in_turn;
    plant->imu_age_s = (double)plant->board.imu.age * 1e-9;
    plant->outage_start_s = 10.0;
    plant->restart_start_s = SPAN_FOR_GOOD_S;
    plant->radio_lost_start_s = SPAN_FOR_GOOD_S;
    plant->pin_stuck = -1.0;
    plant->pin_stuck_start_s = 10.0;
    plant->pin_stuck_length_s = SPAN_FOR_GOOD_S;
}

bool plant_known(const char *name)
{
    return find(name) != NULL;
}

const char *plant_check(const char *name, const char *text)
{
    const figure_t *figure = find(name);
    char *end;
    const double value = strtod(text, &end);

    if (*text == '\0' || *end != '\0' || !isfinite(value)) {
        return "not a number";
    }
    return value < figure->least || value > figure->most ? "out of range, see `plomada list --plant`" : NULL;
}

void plant_set(plant_t *plant, const char *name, double value)
{
    const figure_t *figure = find(name);

    *field_of(plant, figure) = value * figure->scale;
}

static void complete_imu(plant_t *plant)
{
    razor_config_t *imu = &plant->board.imu;

    imu->age = (sim_time_t)llround(plant->imu_age_s * 1e9);
    if (plant->imu_period_s > 0.0) {
        imu->period = (sim_time_t)llround(fmax(plant->imu_period_s, 0.011) * 1e9);
    } else if (imu->stock >= 0.5) {
        imu->period = 20 * SIM_MS;
    }
}

void plant_complete(plant_t *plant)
{
    plant->board.laser.ray_instant = (sim_time_t)llround(plant->ray_instant_s * 1e9);
    plant->board.laser.clock_ratio = 1.0 + plant->clock_ppm * 1e-6;
    plant->board.laser.boot = (sim_time_t)llround(plant->scanner_boot_s * 1e9);
    plant->board.laser.late = (sim_time_t)llround(plant->scan_late_s * 1e9);
    plant->board.laser.answers_in_turn = plant->scanner_answers >= 0.5;
    complete_imu(plant);
    seed_course_lay(&plant->ground, plant->board.seed, &plant->place, &plant->course);
    plant->board.place = &plant->place;
    plant->board.course = &plant->course;
    if (plant->attitude_throttle >= 0.5 && plant->board.quadrotor.climb_rate_mps_per_n <= 0.0) {
        plant->board.quadrotor.climb_rate_mps_per_n = 1.0;
    }
    plant->board.pilot.stops_by_sticks = plant->board.quadrotor.naza.stop_type == NAZA_INTELLIGENT;
}

static void lose_radio(void *context)
{
    (void)context;
    board_radio_reach(false);
}

static void stick_pin(void *tells)
{
    board_pin((board_pin_t)(uintptr_t)tells);
}

static void strike_scanner(void *fault)
{
    line_fault_add(board_laser_faults(), fault);
}

static bool concerns(const char *name, const char *event)
{
    return name == NULL || strncmp(name + strlen("plant."), event, strlen(event)) == 0;
}

static sim_time_t at(sim_time_t origin, double t_s)
{
    const sim_time_t when = origin + (sim_time_t)llround(fmax(t_s, 0.0) * 1e9);

    return when > timeline_now() ? when : timeline_now();
}

static void plan_pin(const plant_t *plant, sim_time_t origin)
{
    const board_pin_t stuck = plant->pin_stuck >= 0.5 ? BOARD_PIN_FIRMWARE : BOARD_PIN_PILOT;

    timeline_at(at(origin, plant->pin_stuck_start_s), stick_pin, (void *)(uintptr_t)stuck);
    if (plant->pin_stuck_length_s < SPAN_FOR_GOOD_S) {
        timeline_at(at(origin, plant->pin_stuck_start_s + plant->pin_stuck_length_s), stick_pin,
                    (void *)(uintptr_t)BOARD_PIN_HONEST);
    }
}

void plant_plan(const plant_t *plant, const char *name, sim_time_t origin)
{
    static line_fault_spec_t restart = {.kind = LINE_FAULT_RESTART};
    static line_fault_spec_t outage;

    if (concerns(name, "radio_lost") && plant->radio_lost_start_s < SPAN_FOR_GOOD_S) {
        timeline_at(at(origin, plant->radio_lost_start_s), lose_radio, NULL);
    }
    if (concerns(name, "outage") && plant->outage_s > 0.0) {
        outage = (line_fault_spec_t){.kind = LINE_FAULT_MUTE,
                                     .argument = (unsigned)lround(plant->outage_s * 1e3)};
        timeline_at(at(origin, plant->outage_start_s), strike_scanner, &outage);
    }
    if (concerns(name, "scanner_restart") && plant->restart_start_s < SPAN_FOR_GOOD_S) {
        timeline_at(at(origin, plant->restart_start_s), strike_scanner, &restart);
    }
    if (concerns(name, "pin_stuck") && plant->pin_stuck > -0.5) {
        plan_pin(plant, origin);
    }
}

bool plant_figure(const plant_t *plant, size_t row, plant_figure_t *figure)
{
    plant_t copy = *plant;

    if (row >= FIGURE_COUNT) {
        return false;
    }
    *figure = (plant_figure_t){figures[row].name,    figures[row].unit,
                               figures[row].meaning, figures[row].least,
                               figures[row].most,    *field_of(&copy, &figures[row]) / figures[row].scale};
    return true;
}

void plant_print(FILE *out)
{
    plant_t plant;

    plant_init(&plant, 1);
    for (size_t i = 0; i < FIGURE_COUNT; i++) {
        const figure_t *figure = &figures[i];
        char value[32];

        snprintf(value, sizeof value, "%.4g", *field_of(&plant, figure) / figure->scale);
        fprintf(out, "  plant.%-22s %-6s %8s  %s\n", figure->name, figure->unit,
                strcmp(value, "1e+09") == 0 ? "never" : value, figure->meaning);
    }
}
