#include "firmware/laser_port.h"
#include "firmware/servers.h"
#include "firmware/verbs.h"

static const char *const causes[] = {
    [SCIP_DAMAGE_NONE] = "-",    [SCIP_DAMAGE_SUM] = "sum",        [SCIP_DAMAGE_LENGTH] = "length",
    [SCIP_DAMAGE_ECHO] = "echo", [SCIP_DAMAGE_CHARACTER] = "char", [SCIP_DAMAGE_SEQUENCE] = "seq",
};
typedef char every_cause_has_a_name[(sizeof causes / sizeof causes[0] == SCIP_DAMAGE_COUNT) ? 1 : -1];

static laser_sample_t laser;

static void add_stream(answer_t *answer, const laser_statistics_t *statistics)
{
    telemetry_text(&answer->line, " state:");
    telemetry_text(&answer->line, urg_status_name(laser.status));
    answer_count(answer, "rate", laser.rate);
    answer_count(answer, "frames", statistics->urg.seen.scan_count);
    answer_count(answer, "timeout", laser.timeouts);
    answer_count(answer, "restart", laser.restarts);
    answer_count(answer, "overrun", statistics->overruns);
    answer_count(answer, "framing", statistics->urg.seen.framing_count);
}

static void add_damages(answer_t *answer, const laser_statistics_t *statistics)
{

    for (uint16_t i = (uint16_t)SCIP_DAMAGE_SUM; i < (uint16_t)SCIP_DAMAGE_COUNT; ++i) {
        answer_count(answer, causes[i], statistics->urg.scip.damaged[i]);
    }
    telemetry_text(&answer->line, " last:");
    telemetry_text(&answer->line, causes[statistics->urg.last_damage]);
}

bool verb_laser(answer_t *answer)
{
    static laser_statistics_t statistics;

    laser_port_statistics(&statistics);
    laser_server_read(&laser);
    answer_begin(answer);
    add_stream(answer, &statistics);
    /* Its counters would all be those of a protocol that it does not speak. What helps is one
     * sentence. */
    if (laser.status == URG_OLD) {
        telemetry_text(&answer->line, " do:update the sensor's firmware to 3.0 or later");
    } else {
        add_damages(answer, &statistics);
    }
    answer_send(answer);
    return true;
}
