/* The servers on mocked gates. The values outlive a test, as they outlive servers_create() in the product:
 * the test of the first values stands first. */
#include "firmware/servers.h"

#include <string.h>

#include "firmware/geometry.h"
#include "kernel.h"
#include "mock_monitor.h"
#include "unity.h"
#include "firmware/probe.h"

#define ALTITUDE "Altitude_server"
#define IMU "IMU_server"
#define LASER "LaserStatus_server"
#define REFERENCE "Reference_server"
#define PARAMETER "Parameter_server"
#define FLIGHT "FlightStatus_server"

static altitude_sample_t altitude;
static imu_sample_t imu;
static imu_sample_t history[IMU_HISTORY];
static laser_sample_t laser;
static reference_sample_t reference;
static parameters_t parameters;
static flight_outputs_t flight;

static uint16_t entries[MONITOR_SERVERS];
static uint32_t asks;
static monitor_access_t told; /* to monitor_entered(), and given back by monitor_leaving() */

static bool any_held(void)
{
    for (uint16_t i = 0; i < kernel.gates.count; i++) {
        if (kernel.gates.made[i].held) {
            return true;
        }
    }
    return false;
}

static void asking(monitor_server_t server, monitor_access_t *access, int calls)
{
    (void)calls;
    (void)server;
    TEST_ASSERT_FALSE(any_held());
    access->asked_us = ++asks;
}

static void entered(monitor_server_t server, const monitor_access_t *access, int calls)
{
    (void)calls;
    TEST_ASSERT_TRUE(any_held());
    TEST_ASSERT_EQUAL_UINT32(asks, access->asked_us);
    entries[server]++;
    told = *access;
}

static monitor_access_t leaving(monitor_server_t server, int calls)
{
    (void)calls;
    TEST_ASSERT_TRUE(any_held());
    entries[server] = (uint16_t)(entries[server] + 10U);
    return told;
}

static void left(monitor_server_t server, const monitor_access_t *access, int calls)
{
    (void)calls;
    TEST_ASSERT_FALSE(any_held());
    TEST_ASSERT_EQUAL_UINT32(asks, access->asked_us);
    entries[server] = (uint16_t)(entries[server] + 100U);
}

void setUp(void)
{
    kernel_reset();
    (void)memset(entries, 0, sizeof entries);
    monitor_asking_Stub(asking);
    monitor_entered_Stub(entered);
    monitor_leaving_Stub(leaving);
    monitor_left_Stub(left);
    servers_create();
}

void tearDown(void)
{
    kernel_check();
}

static imu_sample_t frame(uint32_t sequence)
{
    imu_sample_t sample;

    (void)memset(&sample, 0, sizeof sample);
    sample.sequence = sequence;
    sample.arrival_us = 25000U * sequence;
    sample.level.roll_rad = 0.001F * (float)sequence;
    return sample;
}

static void all_filled_with(int value)
{
    (void)memset(&altitude, value, sizeof altitude);
    (void)memset(&imu, value, sizeof imu);
    (void)memset(&laser, value, sizeof laser);
    (void)memset(&reference, value, sizeof reference);
    (void)memset(&parameters, value, sizeof parameters);
    (void)memset(&flight, value, sizeof flight);
}

static void read_all(void)
{
    altitude_server_read(&altitude);
    imu_server_read(&imu);
    laser_server_read(&laser);
    reference_server_read(&reference);
    parameter_server_read(&parameters);
    flight_status_server_read(&flight);
}

void test_before_anything_is_written_nothing_is_known_and_the_vehicle_is_on_the_ground(void)
{
    all_filled_with(0x5A);
    read_all();
    TEST_ASSERT_EQUAL_UINT32(0, altitude.sequence);
    TEST_ASSERT_EQUAL_UINT32(0, altitude.heightless);
    TEST_ASSERT_FALSE(altitude.scan_valid);
    TEST_ASSERT_EQUAL_UINT32(0, imu.sequence);
    TEST_ASSERT_FALSE(imu.ready);
    TEST_ASSERT_EQUAL(URG_WAIT, laser.status);
    TEST_ASSERT_EQUAL_UINT32(0, laser.seen.reply_count);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, reference.reference_m);
    TEST_ASSERT_EQUAL_UINT32(0, reference.sequence);
    TEST_ASSERT_EQUAL_UINT32(0, reference.link_sequence);
    TEST_ASSERT_EQUAL(FLIGHT_GROUND, flight.state);
    TEST_ASSERT_EQUAL_HEX16(FLIGHT_FLAG_HEIGHT | FLIGHT_FLAG_ATTITUDE, flight.flags);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, flight.thrust_n);
    TEST_ASSERT_EQUAL_FLOAT(0.0F, flight.reference_m);
}

void test_without_a_frame_the_history_is_empty_and_the_callers_memory_untouched(void)
{
    (void)memset(history, 0x5A, sizeof history);
    TEST_ASSERT_EQUAL_UINT16(0, imu_server_history(history));
    TEST_ASSERT_EQUAL_HEX32(0x5A5A5A5AU, history[0].sequence);
    TEST_ASSERT_EQUAL_HEX32(0x5A5A5A5AU, history[IMU_HISTORY - 1U].sequence);
}

void test_frames_refused_before_the_first_good_one_leave_the_history_empty(void)
{
    imu_sample_t sample = frame(0U);

    sample.malformed = 7U;
    imu_server_write(&sample);
    imu_server_write(&sample);
    TEST_ASSERT_EQUAL_UINT16(0, imu_server_history(history));
}

void test_the_history_has_the_oldest_first_and_holds_the_latest_sixteen(void)
{
    for (uint32_t n = 1; n <= 3U * IMU_HISTORY + 5U; n++) {
        const imu_sample_t sample = frame(n);
        const uint32_t held = n < IMU_HISTORY ? n : IMU_HISTORY;

        imu_server_write(&sample);
        TEST_ASSERT_EQUAL_UINT16(held, imu_server_history(history));
        for (uint32_t i = 0; i < held; i++) {
            const uint32_t number = n - held + 1U + i;

            TEST_ASSERT_EQUAL_UINT32(number, history[i].sequence);
            TEST_ASSERT_EQUAL_UINT32(25000U * number, history[i].arrival_us);
            TEST_ASSERT_EQUAL_FLOAT(0.001F * (float)number, history[i].level.roll_rad);
        }
        imu_server_read(&imu);
        TEST_ASSERT_EQUAL_UINT32(n, imu.sequence);
    }
}

/* TaskIMU publishes again, with the same sequence number, when it refuses a frame. */
void test_a_refused_frame_is_not_in_the_history(void)
{
    imu_sample_t sample;
    uint32_t first;

    imu_server_read(&sample);
    first = sample.sequence + 1U;
    kernel_random_seed(8U);
    for (uint32_t n = first; n < first + 200U; n++) {
        sample = frame(n);
        imu_server_write(&sample);
        for (uint16_t refused = kernel_random(4U); refused > 0U; refused--) {
            sample.malformed++;
            imu_server_write(&sample);
        }
        imu_server_read(&imu);
        TEST_ASSERT_EQUAL_UINT32(sample.malformed, imu.malformed);
        TEST_ASSERT_EQUAL_UINT16(IMU_HISTORY, imu_server_history(history));
        for (uint32_t i = 0; i < IMU_HISTORY; i++) {
            TEST_ASSERT_EQUAL_UINT32(n - IMU_HISTORY + 1U + i, history[i].sequence);
        }
    }
}

void test_the_parameters_begin_with_the_tables_values(void)
{
    parameter_server_read(&parameters);
    for (uint16_t i = 0; i < PARAMETER_COUNT; i++) {
        TEST_ASSERT_EQUAL_FLOAT(parameter_table[i].initial, parameters.value[i]);
    }
    TEST_ASSERT_EQUAL_UINT32(0, parameters.generation);
    TEST_ASSERT_EQUAL_FLOAT(0.015F, parameters.value[PARAMETER_KP]); /* the best flown ones */
    TEST_ASSERT_EQUAL_FLOAT(7.0F, parameters.value[PARAMETER_GRAV]);
}

void test_the_mirrors_have_their_places_from_the_start_and_from_every_writing(void)
{
    geometry_t geometry;

    geometry_mounted(&geometry);
    TEST_ASSERT_EQUAL_FLOAT(parameter_table[PARAMETER_LF].initial,
                            geometry.places.mirror[MIRROR_FRONT].leg_mm);
    parameters_init(&parameters);
    parameters.value[PARAMETER_LF] = 77.0F;
    parameter_server_write(&parameters);
    geometry_mounted(&geometry);
    TEST_ASSERT_EQUAL_FLOAT(77.0F, geometry.places.mirror[MIRROR_FRONT].leg_mm);
}

void test_each_server_has_a_gate_of_its_own_with_its_name(void)
{
    const char *const names[] = {ALTITUDE, IMU, LASER, REFERENCE, PARAMETER, FLIGHT};

    TEST_ASSERT_EQUAL_UINT16(6, kernel.gates.count);
    for (uint16_t i = 0; i < 6U; i++) {
        TEST_ASSERT_NOT_NULL_MESSAGE(kernel_gate(names[i]), names[i]);
    }
}

static void write_altitude(void)
{
    altitude_server_write(&altitude);
}
static void read_altitude(void)
{
    altitude_server_read(&altitude);
}
static void write_imu(void)
{
    imu_server_write(&imu);
}
static void read_imu(void)
{
    imu_server_read(&imu);
}
static void read_history(void)
{
    (void)imu_server_history(history);
}
static void write_laser(void)
{
    laser_server_write(&laser);
}
static void read_laser(void)
{
    laser_server_read(&laser);
}
static void write_reference(void)
{
    reference_server_write(&reference);
}
static void read_reference(void)
{
    reference_server_read(&reference);
}
static void write_parameters(void)
{
    parameter_server_write(&parameters);
}
static void read_parameters(void)
{
    parameter_server_read(&parameters);
}
static void write_flight(void)
{
    flight_status_server_write(&flight);
}
static void read_flight(void)
{
    flight_status_server_read(&flight);
}

static const struct {
    void (*access)(void);
    const char *gate;
    bool writes;
    void *copy; /* the caller's side */
    size_t size;
} accesses[] = {
    {write_altitude, ALTITUDE, true, &altitude, sizeof altitude},
    {read_altitude, ALTITUDE, false, &altitude, sizeof altitude},
    {write_imu, IMU, true, &imu, sizeof imu},
    {read_imu, IMU, false, &imu, sizeof imu},
    {read_history, IMU, false, history, sizeof history},
    {write_laser, LASER, true, &laser, sizeof laser},
    {read_laser, LASER, false, &laser, sizeof laser},
    {write_reference, REFERENCE, true, &reference, sizeof reference},
    {read_reference, REFERENCE, false, &reference, sizeof reference},
    {write_parameters, PARAMETER, true, &parameters, sizeof parameters},
    {read_parameters, PARAMETER, false, &parameters, sizeof parameters},
    {write_flight, FLIGHT, true, &flight, sizeof flight},
    {read_flight, FLIGHT, false, &flight, sizeof flight},
};
#define ACCESSES (sizeof accesses / sizeof accesses[0])

/* The server's side. */
static const void *served(size_t access)
{
    const void *const values[ACCESSES] = {
        probe_altitude,   probe_altitude, probe_imu,       probe_imu,       probe_imu,
        probe_laser,      probe_laser,    probe_reference, probe_reference, probe_parameters,
        probe_parameters, probe_flight,   probe_flight,
    };

    return values[access];
}

void test_every_access_enters_its_own_gate_once_and_no_other(void)
{
    read_all();
    for (size_t a = 0; a < ACCESSES; a++) {
        uint32_t before[KERNEL_GATES_MAX];

        for (uint16_t g = 0; g < kernel.gates.count; g++) {
            before[g] = kernel.gates.made[g].entered;
        }
        accesses[a].access();
        for (uint16_t g = 0; g < kernel.gates.count; g++) {
            const bool own = strcmp(kernel.gates.made[g].name, accesses[a].gate) == 0;

            TEST_ASSERT_EQUAL_UINT32(before[g] + (own ? 1U : 0U), kernel.gates.made[g].entered);
            TEST_ASSERT_FALSE(kernel.gates.made[g].held);
        }
    }
}

/* What the other side looks like at the moment the gate opens and at the moment it closes. */
static size_t under_test;
static char at_enter[sizeof history];
static char at_leave[sizeof history];

static void look(char *seen)
{
    const size_t a = under_test;

    (void)memcpy(seen, accesses[a].writes ? served(a) : accesses[a].copy, accesses[a].size);
}

static void look_at_enter(void)
{
    look(at_enter);
}

static void look_at_leave(void)
{
    look(at_leave);
}

void test_every_copy_is_made_while_the_gate_is_held(void)
{
    kernel.gates.on_enter = look_at_enter;
    kernel.gates.on_leave = look_at_leave;
    for (size_t a = 0; a < ACCESSES; a++) {
        static char before[sizeof history];
        static char after[sizeof history];
        const size_t size = accesses[a].size;

        under_test = a;
        read_all();
        if (accesses[a].writes) {
            (void)memset(accesses[a].copy, 0x11, size);
        } else {
            (void)memset(accesses[a].copy, 0x22, size);
        }
        (void)memcpy(before, accesses[a].writes ? served(a) : accesses[a].copy, size);
        accesses[a].access();
        (void)memcpy(after, accesses[a].writes ? served(a) : accesses[a].copy, size);
        TEST_ASSERT_EQUAL_MEMORY(before, at_enter, size);
        TEST_ASSERT_EQUAL_MEMORY(after, at_leave, size);
        TEST_ASSERT_NOT_EQUAL(0, memcmp(before, after, size));
    }
}

void test_what_is_written_is_what_is_read_and_what_the_debugger_sees(void)
{
    for (int value = 1; value <= 3; value++) {
        all_filled_with(value);
        write_altitude();
        write_imu();
        write_laser();
        write_reference();
        write_parameters();
        write_flight();
        all_filled_with(0x77); /* the servers hold copies, not the callers' memory */
        read_all();
        TEST_ASSERT_EQUAL_HEX16(value * 0x101, altitude.altitude.good_rays);
        TEST_ASSERT_EQUAL_HEX32(value * 0x1010101, altitude.heightless);
        TEST_ASSERT_EQUAL_HEX32(value * 0x1010101, imu.malformed);
        TEST_ASSERT_EQUAL_HEX32(value * 0x1010101, laser.seen.damage_count);
        TEST_ASSERT_EQUAL_HEX32(value * 0x1010101, laser.status);
        TEST_ASSERT_EQUAL_HEX32(value * 0x1010101, laser.timeouts);
        TEST_ASSERT_EQUAL_HEX32(value * 0x1010101, reference.link_sequence);
        TEST_ASSERT_EQUAL_HEX32(value * 0x1010101, parameters.generation);
        TEST_ASSERT_EQUAL_HEX16(value * 0x101, flight.flags);
        TEST_ASSERT_EQUAL_MEMORY(probe_altitude, &altitude, sizeof altitude);
        TEST_ASSERT_EQUAL_MEMORY(probe_imu, &imu, sizeof imu);
        TEST_ASSERT_EQUAL_MEMORY(probe_laser, &laser, sizeof laser);
        TEST_ASSERT_EQUAL_MEMORY(probe_reference, &reference, sizeof reference);
        TEST_ASSERT_EQUAL_MEMORY(probe_parameters, &parameters, sizeof parameters);
        TEST_ASSERT_EQUAL_MEMORY(probe_flight, &flight, sizeof flight);
    }
}

void test_every_access_is_told_with_its_server_before_and_after_it_enters_and_leaves(void)
{
    static const monitor_server_t servers[ACCESSES] = {
        MONITOR_ALTITUDE,      MONITOR_ALTITUDE,     MONITOR_IMU_SAMPLE,   MONITOR_IMU_SAMPLE,
        MONITOR_IMU_SAMPLE,    MONITOR_LASER_STATUS, MONITOR_LASER_STATUS, MONITOR_REFERENCE,
        MONITOR_REFERENCE,     MONITOR_PARAMETERS,   MONITOR_PARAMETERS,   MONITOR_FLIGHT_STATUS,
        MONITOR_FLIGHT_STATUS,
    };

    read_all();
    (void)memset(entries, 0, sizeof entries);
    for (size_t a = 0; a < ACCESSES; a++) {
        const uint16_t before = entries[servers[a]];

        accesses[a].access();
        TEST_ASSERT_EQUAL_UINT16(before + 111U, entries[servers[a]]);
    }
}
