#include <ti/sysbios/knl/Task.h>
#include <xdc/std.h>

#include "control/imu_axes.h"
#include "control/imu_finding.h"
#include "control/median.h"
#include "firmware/ground.h"
#include "firmware/imu_exchange.h"
#include "firmware/listing.h"
#include "firmware/servers.h"
#include "firmware/verbs.h"

#define LOOKS 3U
#define LOOK_MS 60U /* two frames later */
#define US_PER_MS 1000U

static struct {
    bool known;
    imu_raw_t raw;
    bool roll_found, pitch_found; /* since power-up, as roll and pitch say: */
    float roll, pitch;
} level;

static void add_value(answer_t *answer, const char *name, float value, uint16_t decimals)
{
    telemetry_text(&answer->line, " ");
    telemetry_text(&answer->line, name);
    telemetry_text(&answer->line, ":");
    telemetry_fixed(&answer->line, value, decimals);
}

static void add_choice(answer_t *answer, const parameters_t *parameters, parameter_id_t id)
{
    telemetry_text(&answer->line, " ");
    telemetry_text(&answer->line, parameter_table[id].name);
    telemetry_text(&answer->line, ":");
    telemetry_text(&answer->line, parameter_table[id].choices[parameters_choice(parameters, id)]);
}

static void write_raw(answer_t *answer, const imu_view_t *view)
{

    telemetry_text(&answer->line, " raw:");
    for (uint16_t i = 0U; i < view->text.length; ++i) {
        const char character = view->text.text[i];
        /* The text goes into a line of the radio, which a line end of the IMU's would cut. What cannot
         * be shown is shown as a bar. */
        const char legible = (character >= ' ' && character <= '~') ? character : '|';

        telemetry_characters(&answer->line, &legible, 1U);
    }
}

static void write_values(answer_t *answer)
{
    static imu_sample_t history[IMU_HISTORY];
    const bool any = imu_server_history(history) > 0U && history[0].ready;

    if (!any) {
        telemetry_text(&answer->line, " not level yet");
        return;
    }
    add_value(answer, "roll_deg", imu_degrees(history[0].median.roll_rad), 1U);
    add_value(answer, "pitch_deg", imu_degrees(history[0].median.pitch_rad), 1U);
    if (history[0].has_acceleration) {
        add_value(answer, "forward", history[0].forward_mps2, 2U);
        add_value(answer, "right", history[0].right_mps2, 2U);
        add_value(answer, "down", history[0].down_mps2, 2U);
    }
}

static void write_count(answer_t *answer, const imu_view_t *view)
{
    static const char *const seen[] = {
        [RAZOR_OK] = "angles", [RAZOR_MALFORMED] = "malformed", [RAZOR_OUT_OF_RANGE] = "out-of-range"};
    static parameters_t parameters;
    static imu_sample_t latest;
    flight_outputs_t flight;
    const bool none = view->status == RAZOR_OK && view->frames == 0U;
    const bool both = view->status == RAZOR_OK && view->raw.has_acceleration;

    telemetry_text(&answer->line, " seen:");
    telemetry_text(&answer->line, none ? "-" : both ? "accelerations+angles" : seen[view->status]);
    answer_count(answer, "period_ms", (view->period_us + US_PER_MS / 2U) / US_PER_MS);
    answer_count(answer, "frames", view->frames);
    imu_server_read(&latest);
    answer_count(answer, "refused", latest.malformed);
    parameter_server_read(&parameters);
    flight_status_server_read(&flight);
    add_choice(answer, &parameters, PARAMETER_IAXES);
    telemetry_text(&answer->line, " fault:");
    telemetry_text(&answer->line, imu_fault_name(flight.imu_fault));
}

static bool write_line(answer_t *answer, uint16_t number)
{
    static imu_view_t view;

    imu_exchange_look(&view);
    answer_begin(answer);
    if (number == 0U) {
        write_raw(answer, &view);
    } else if (number == 1U) {
        write_values(answer);
    } else if (number == 2U) {
        write_count(answer, &view);
    }
    return number < 3U;
}

/* The sensor has spikes: of three frames the middle one, each figure for itself. */
static void look(imu_raw_t *raw)
{
    static imu_view_t view;
    float figures[5][LOOKS];

    for (uint16_t i = 0U; i < LOOKS; ++i) {
        imu_exchange_look(&view);
        figures[0][i] = view.raw.roll_rad;
        figures[1][i] = view.raw.pitch_rad;
        figures[2][i] = view.raw.x_counts;
        figures[3][i] = view.raw.y_counts;
        figures[4][i] = view.raw.z_counts;
        Task_sleep(LOOK_MS);
    }
    *raw = view.raw;
    raw->roll_rad = median_of_angles(figures[0], LOOKS);
    raw->pitch_rad = median_of_angles(figures[1], LOOKS);
    raw->x_counts = median_of(figures[2], LOOKS);
    raw->y_counts = median_of(figures[3], LOOKS);
    raw->z_counts = median_of(figures[4], LOOKS);
}

static bool find_level(answer_t *answer)
{
    static parameters_t parameters;

    look(&level.raw);
    level.known = true;
    parameter_server_read(&parameters);
    answer_begin(answer);
    telemetry_text(&answer->line, " LEVEL");
    if (imu_find_level(&parameters, &level.raw)) {
        parameter_server_write(&parameters);
        add_value(answer, "IUNIT", parameters.value[PARAMETER_IUNIT], 2U);
        add_choice(answer, &parameters, PARAMETER_IDOWN);
    } else {
        telemetry_text(&answer->line,
                       level.raw.has_acceleration ? " accelerations in no known unit" : " no accelerations");
    }
    answer_send(answer);
    return true;
}

/* Both sides raised, and what they showed is in force: proved. */
static void remember(parameters_t *parameters, parameter_id_t id, float before)
{
    const float found = parameters->value[id];
    const bool was_proved = parameters_choice(parameters, PARAMETER_IAXES) == AXES_PROVED;

    if (id == PARAMETER_IROLL) {
        level.roll_found = true;
        level.roll = found;
    } else {
        level.pitch_found = true;
        level.pitch = found;
    }
    const bool proved = level.roll_found && level.roll == parameters->value[PARAMETER_IROLL] &&
                        level.pitch_found && level.pitch == parameters->value[PARAMETER_IPITCH];
    (void)parameters_set(parameters, PARAMETER_IAXES,
                         (float)((proved || (was_proved && found == before)) ? AXES_PROVED : AXES_ASSUMED));
}

static bool find_axis(answer_t *answer, parameter_id_t id, const char *word)
{
    static parameters_t parameters;
    imu_raw_t raw;

    if (!level.known) {
        return answer_refuse(answer, "first #IMU LEVEL");
    }
    look(&raw);
    parameter_server_read(&parameters);
    const float before = parameters.value[id];
    if (!imu_find_axis(&parameters, id, &level.raw, &raw)) {
        return answer_refuse(answer, "tilt by 8..60 deg about one axis");
    }
    remember(&parameters, id, before);
    parameter_server_write(&parameters);
    answer_begin(answer);
    telemetry_text(&answer->line, word);
    add_choice(answer, &parameters, id);
    add_choice(answer, &parameters, PARAMETER_IAXES);
    answer_send(answer);
    return true;
}

/* What changes the axes is for the ground, or for a vehicle in the hand: its height says FLOATING, nobody has
 * armed it, and the autopilot's motors stand. */
static bool find(answer_t *answer)
{
    flight_outputs_t flight;

    flight_status_server_read(&flight);
    if (flight.reference_m > 0.0F || flight.idle_n > 0.0F ||
        (flight.thrust_n > 0.0F && flight.state != FLIGHT_FLOATING)) {
        return answer_refuse(answer, "needs thrust 0 and no reference");
    }
    if (answer_argument_is(answer, "LEVEL")) {
        return find_level(answer);
    }
    if (answer_argument_is(answer, "RIGHT")) {
        return find_axis(answer, PARAMETER_IROLL, " RIGHT");
    }
    if (answer_argument_is(answer, "NOSE")) {
        return find_axis(answer, PARAMETER_IPITCH, " NOSE");
    }
    return answer_refuse(answer, "one of LEVEL|RIGHT|NOSE");
}

bool verb_imu(answer_t *answer)
{
    return (answer->command->argument_length > 0U) ? find(answer) : listing_start(answer, write_line);
}
