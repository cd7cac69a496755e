#include <stdint.h>
#include <string.h>
#include <ti/sysbios/utils/Load.h>

#include "bsp/timebase.h"
#include "firmware/boot.h"
#include "firmware/cpu_time.h"
#include "firmware/listing.h"
#include "firmware/monitor.h"
#include "firmware/verbs.h"

static const char *const servers[] = {
    [MONITOR_ALTITUDE] = "altitude",     [MONITOR_IMU_SAMPLE] = "imu",
    [MONITOR_LASER_STATUS] = "laser",    [MONITOR_REFERENCE] = "reference",
    [MONITOR_PARAMETERS] = "parameters", [MONITOR_FLIGHT_STATUS] = "flight",
};
typedef char every_server_has_a_name[(sizeof servers / sizeof servers[0] == MONITOR_SERVERS) ? 1 : -1];

static void write_run(answer_t *answer)
{
    telemetry_text(&answer->line, " reset:");
    telemetry_text(&answer->line, boot_cause());
    answer_count(answer, "load", (uint32_t)Load_getCPULoad());
}

static void write_task(answer_t *answer, monitor_task_t task)
{
    monitor_report_t report;

    monitor_report(task, &report);
    telemetry_text(&answer->line, " ");
    telemetry_text(&answer->line, report.name);
    answer_count(answer, "worst_us", report.longest_us);
    answer_count(answer, "late", report.late);
    answer_count(answer, "stack", report.stack_used);
    telemetry_text(&answer->line, "/");
    telemetry_count(&answer->line, report.stack_size);
}

static void write_waits(answer_t *answer)
{

    telemetry_text(&answer->line, " wait_us");
    for (uint16_t i = 0U; i < (uint16_t)MONITOR_SERVERS; ++i) {
        answer_count(answer, servers[i], monitor_longest_wait_us((monitor_server_t)i));
    }
}

/* The run, each task, the servers' waits. */
bool verb_perf_line(answer_t *answer, uint16_t number)
{
    const uint16_t last = (uint16_t)MONITOR_TASKS + 1U;

    answer_begin(answer);
    if (number == 0U) {
        write_run(answer);
    } else if (number < last) {
        write_task(answer, (monitor_task_t)(number - 1U));
    } else if (number == last) {
        write_waits(answer);
    }
    return number <= last;
}

/* Each job, then each gate, numbered from 1: `rta.py --measured` reads them. */
static bool write_cost(answer_t *answer, uint16_t number)
{
    answer_begin(answer);
    if (number >= (uint16_t)CPU_TIME_JOBS + (uint16_t)MONITOR_SERVERS) {
        return false;
    }
    telemetry_text(&answer->line, " COSTS ");
    telemetry_count(&answer->line, (uint32_t)number + 1U);
    telemetry_text(&answer->line, " ");
    if (number < (uint16_t)CPU_TIME_JOBS) {
        const cpu_time_job_t job = (cpu_time_job_t)number;

        telemetry_text(&answer->line, cpu_time_name(job));
        answer_count(answer, "longest_ns", cpu_time_longest(job) * BSP_CYCLE_NS);
    } else {
        const uint16_t server = (uint16_t)(number - (uint16_t)CPU_TIME_JOBS);

        telemetry_text(&answer->line, servers[server]);
        answer_count(answer, "hold_ns", monitor_longest_hold((monitor_server_t)server) * BSP_CYCLE_NS);
    }
    return true;
}

static bool reset(answer_t *answer)
{
    monitor_reset();
    answer_begin(answer);
    telemetry_text(&answer->line, " RESET");
    answer_send(answer);
    return true;
}

bool verb_perf(answer_t *answer)
{
    if (answer_argument_is(answer, "RESET")) {
        return reset(answer);
    }
    if (answer_argument_is(answer, "COSTS")) {
        return listing_start(answer, write_cost);
    }
    if (answer->command->argument_length > 0U) {
        return answer_refuse(answer, "one of COSTS|RESET");
    }
    return listing_start(answer, verb_perf_line);
}
