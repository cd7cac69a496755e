#include "firmware/surroundings.h"

#include <math.h>

#include "control/approach.h"
#include "control/around.h"
#include "control/flight.h"
#include "control/seconds.h"
#include "control/imu_mapping.h"
#include "control/walls.h"
#include "drivers/around_line.h"
#include "drivers/scip_free.h"
#include "firmware/geometry.h"
#include "firmware/laser_port.h"
#include "firmware/servers.h"

typedef char every_sector_is_told[(AROUND_SECTORS == AROUND_LINE_SECTORS) ? 1 : -1];
typedef char every_ray_has_room[(AROUND_RAYS_MAX >= SCIP_LAYOUT_POINTS_MAX) ? 1 : -1];
typedef char codes_are_the_same[(AROUND_NOTHING == SCIP_FREE_NOTHING && AROUND_UNSEEN == SCIP_FREE_UNSEEN &&
                                 AROUND_NOTHING == AROUND_LINE_NOTHING && AROUND_UNSEEN == AROUND_LINE_UNSEEN)
                                    ? 1
                                    : -1];

#define FORGET_US 1000000UL /* five looks were missed: a vehicle at 1 m/s is elsewhere */

static laser_message_t message;
static around_look_t looks[2]; /* the latest, and the one before it */
static around_look_t confirmed;
static uint16_t latest;
static uint32_t looked_us;
static approach_t approach;
static bool fresh;
static bool warns;

static void look(around_look_t *view, const parameters_t *parameters)
{
    geometry_t geometry;
    const scip_scan_t *const scan = &message.scan;

    geometry_mounted(&geometry);
    around_begin(view, parameters, scip_free_step(scan, 0U), scip_free_every(scan), scan->points);
    scip_free_ranges(view->mm, scan, &geometry.layout);
}

/* The tilt while the rays were taken, which were under way for a tenth of a second and more: of the first
 * frame since then, or the latest. */
static attitude_t tilt_of_rays(void)
{
    static imu_sample_t frames[IMU_HISTORY];
    const uint16_t count = imu_server_history(frames);
    const uint32_t taken_us = message.arrival_us - scip_rays_age_us(&message.scan, message.bit_rate);
    uint16_t at = count;

    while (at > 0U && (int32_t)(frames[at - 1U].arrival_us - taken_us) >= 0) {
        --at;
    }
    if (count == 0U) {
        return (attitude_t){.roll_rad = 0.0F};
    }
    return frames[(at < count) ? at : (uint16_t)(count - 1U)].level;
}

static void place_of(around_place_t *place, const parameters_t *parameters, const flight_outputs_t *flight)
{
    const attitude_t tilt = tilt_of_rays();
    const bool known = (flight->flags & FLIGHT_FLAG_HEIGHT) == 0U;

    *place = around_place(parameters, known ? flight->height_mm : NAN, tilt.roll_rad, tilt.pitch_rad);
}

static around_line_wall_t told_of(const approach_wall_t *wall)
{
    return (around_line_wall_t){.bearing_deg = imu_degrees(wall->bearing_rad),
                                .mm = wall->mm,
                                .mmps = wall->mmps,
                                .sigma_mmps = wall->sigma_mmps};
}

/* Walls of another time are others. */
static void follow_walls(const parameters_t *parameters)
{
    wall_t walls[WALLS_MAX];
    const uint32_t since_us = message.arrival_us - looked_us;
    const uint16_t count = walls_find(walls, &confirmed,
                                      parameters->value[PARAMETER_L] - parameters->value[PARAMETER_DF]);

    if (since_us > FORGET_US) {
        approach_reset(&approach);
    }
    looked_us = message.arrival_us;
    approach_step(&approach, walls, count, seconds_at_most(since_us, 1.0e-6F * (float)FORGET_US));
}

/* The latest two looks become the confirmed one. */
static void look_round(const parameters_t *parameters, const flight_outputs_t *flight)
{
    around_place_t place;
    const around_look_t *const before = &looks[latest];

    latest ^= 1U;
    look(&looks[latest], parameters);
    place_of(&place, parameters, flight);
    around_level(&looks[latest], &place);
    around_confirm(&confirmed, &looks[latest], before);
}

/* On the ground nothing comes near in the direction of flight. */
static void tell(telemetry_line_t *line, const flight_outputs_t *flight)
{
    static uint16_t sectors[AROUND_SECTORS];
    const approach_wall_t *const coming = approach_warning(&approach);

    around_sectors(sectors, &confirmed);
    warns = coming != NULL && flight->state != FLIGHT_GROUND;
    if (warns) {
        const around_line_wall_t told = told_of(coming);

        around_line(line, sectors, &told);
    } else {
        around_line(line, sectors, NULL);
    }
}

bool surroundings_line(telemetry_line_t *line, const flight_outputs_t *flight)
{
    static parameters_t parameters;

    parameter_server_read(&parameters);
    fresh = parameters_choice(&parameters, PARAMETER_WALLS) == (uint16_t)WALLS_ON &&
            laser_port_newer(&message);
    if (fresh) {
        look_round(&parameters, flight);
        follow_walls(&parameters);
        tell(line, flight);
    }
    return fresh;
}

bool surroundings_warn(void)
{
    return fresh && warns;
}

bool surroundings_drift(telemetry_line_t *line)
{
    const approach_wall_t *known[APPROACH_KNOWN_MAX];
    around_line_wall_t walls[APPROACH_KNOWN_MAX];
    const uint16_t count = approach_known(&approach, known);

    for (uint16_t i = 0U; i < count; ++i) {
        walls[i] = told_of(known[i]);
    }
    around_line_drift(line, walls, count);
    return fresh;
}
