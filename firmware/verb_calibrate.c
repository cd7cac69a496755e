#include "firmware/calibrator.h"
#include "drivers/decimal.h"
#include "firmware/ground.h"
#include "firmware/servers.h"
#include "firmware/verbs.h"
#include "firmware/xbee_port.h"

#define THRUST_DECIMALS 2U
#define SEQUENCE_AHEAD_MAX 0x7FFFU /* more is behind */

static const char *const ends[] = {
    [CALIBRATION_NONE] = "-",      [CALIBRATION_RUNNING] = "-", [CALIBRATION_STOPPED] = "COMMAND",
    [CALIBRATION_LIMIT] = "LIMIT", [CALIBRATION_LINK] = "LINK", [CALIBRATION_LIFTED] = "HEIGHT",
    [CALIBRATION_STATE] = "STATE",
};

static struct {
    bool open;         /* started, and its end not reported */
    uint16_t sequence; /* of the request */
    uint16_t steps;    /* reported */
} report;

/* Reads a whole number from 1 to `most` up to the next blank; none leaves *value. Moves *at behind it. */
static bool read_whole(const telecommand_t *command, uint16_t *at, uint16_t most, uint16_t *value)
{
    uint16_t from = *at;
    float number;

    while (from < command->argument_length && telecommand_is_blank(command->argument[from])) {
        ++from;
    }
    *at = from;
    while (*at < command->argument_length && !telecommand_is_blank(command->argument[*at])) {
        (*at)++;
    }
    if (from == *at) {
        return true;
    }
    if (!decimal_read(&command->argument[from], (size_t)(*at - from), &number) || !(number > 0.0F) ||
        number > (float)most || number != (float)(uint16_t)number) {
        return false;
    }
    *value = (uint16_t)number;
    return true;
}

static bool start(answer_t *answer, float idle_percent, uint16_t step_counts, uint16_t period_s)
{
    report.open = true;
    report.sequence = calibrator_start(idle_percent, step_counts, period_s);
    report.steps = 0U;
    answer_begin(answer);
    answer_count(answer, "counts", step_counts);
    answer_count(answer, "seconds", period_s);
    answer_send(answer);
    return true;
}

bool verb_calibrate(answer_t *answer)
{
    static parameters_t parameters;
    uint16_t step_counts = CALIBRATION_STEP_COUNTS;
    uint16_t period_s = CALIBRATION_PERIOD_S;
    uint16_t at = 0U;

    if (!read_whole(answer->command, &at, CALIBRATION_STEP_COUNTS_MAX, &step_counts) ||
        !read_whole(answer->command, &at, CALIBRATION_PERIOD_MAX_S, &period_s) ||
        at != answer->command->argument_length) {
        return answer_refuse(answer, "1..200 counts, 1..60 s");
    }
    if (!ground_waits()) {
        return answer_refuse(answer, "not on the ground");
    }
    parameter_server_read(&parameters);
    /* The vehicle is tied down, and its thrust rises by itself. If the operator's radio fails, only
     * the link's time-out ends that. */
    if (!(parameters.value[PARAMETER_LINK] > 0.0F)) {
        return answer_refuse(answer, "link not armed, see #LINK");
    }
    return start(answer, parameters.value[PARAMETER_IDLE], step_counts, period_s);
}

static void add_advice(telemetry_line_t *line, float thrust_n)
{
    static parameters_t parameters;

    parameter_server_read(&parameters);
    telemetry_text(line, " grav:");
    telemetry_fixed(line, calibration_gravity_n(&parameters, thrust_n), THRUST_DECIMALS);
}

static void send_progress(const calibration_t *progress, bool ended)
{
    static telemetry_line_t line;

    telemetry_begin(&line);
    telemetry_text(&line, "OK CALIBRATE ");
    if (ended) {
        telemetry_text(&line, "end:");
        telemetry_text(&line, ends[progress->end]);
        telemetry_text(&line, " ");
    }
    telemetry_text(&line, "thr:");
    telemetry_fixed(&line, progress->thrust_n, THRUST_DECIMALS);
    telemetry_text(&line, " compare:");
    telemetry_count(&line, progress->compare_counts);
    /* Only when the operator stopped it: he did so at the thrust that just carries the vehicle, which
     * is the figure that he came for. */
    if (progress->end == CALIBRATION_STOPPED) {
        add_advice(&line, progress->thrust_n);
    }
    telemetry_end(&line);
    xbee_port_answer(&line);
}

bool verb_calibrate_more(void)
{
    calibration_t progress;

    if (!report.open) {
        return false;
    }
    calibrator_look(&progress);
    /* TaskControl has not seen this request yet: the progress is that of the one before. */
    if ((uint16_t)(progress.sequence - report.sequence) > SEQUENCE_AHEAD_MAX) {
        return true;
    }
    report.open = progress.end == CALIBRATION_RUNNING;
    if (!report.open || progress.steps != report.steps) {
        report.steps = progress.steps;
        send_progress(&progress, !report.open);
    }
    return report.open;
}
