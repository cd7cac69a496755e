/* The order of the start, and what the scanner's driver is told. */
#include <string.h>

#include "firmware/mounting.h"
#include "mock_BIOS.h"
#include "mock_board.h"
#include "mock_boot.h"
#include "mock_geometry.h"
#include "mock_servers.h"
#include "mock_tasks.h"
#include "mock_parameter_store.h"
#include "mock_uart_port.h"
#include "mock_verbs.h"
#include "mock_watchdog.h"
#include "unity.h"

int firmware_main(void);

static char order[200];
static urg_config_t config;
static bool restart, booted;

#define NOTE(function, word) \
    static void function(int calls) \
    { \
        (void)calls; \
        (void)strcat(order, word " "); \
    }
NOTE(board, "board")
NOTE(servers, "servers")
NOTE(task_imu, "imu")
NOTE(task_control, "control")
NOTE(task_send_laser, "send_laser")
NOTE(task_send_comm, "send_comm")
NOTE(task_receive_comm, "receive_comm")
NOTE(ports, "ports")
NOTE(load, "load")
NOTE(watchdog, "watchdog")
NOTE(bios, "bios")

static void boot(int calls)
{
    (void)calls;
    (void)strcat(order, "boot ");
    booted = true;
}

static bool is_restart(int calls)
{
    (void)calls;
    TEST_ASSERT_TRUE_MESSAGE(booted, "nobody has looked why it starts");
    return restart;
}

static void task_receive_laser(const urg_config_t *given, int calls)
{
    (void)calls;
    (void)strcat(order, "receive_laser ");
    config = *given;
}

static uint32_t stored_rate;

static uint32_t laser_rate(int calls)
{
    (void)calls;
    TEST_ASSERT_TRUE_MESSAGE(booted, "the storage is read before the board is up");
    return stored_rate;
}

/* Mirrors aft and fore. */
static void geometry(geometry_t *mounted, int calls)
{
    static const uint16_t middles[] = {128U, 640U};

    (void)calls;
    mounted->layout = scip_layout_around(middles, 2U, 17U);
}

void setUp(void)
{
    order[0] = '\0';
    booted = restart = false;
    bsp_board_init_Stub(board);
    boot_init_Stub(boot);
    boot_is_restart_Stub(is_restart);
    servers_create_Stub(servers);
    task_imu_create_Stub(task_imu);
    task_receive_laser_create_Stub(task_receive_laser);
    task_control_create_Stub(task_control);
    task_send_laser_create_Stub(task_send_laser);
    task_send_comm_create_Stub(task_send_comm);
    task_receive_comm_create_Stub(task_receive_comm);
    uart_port_start_Stub(ports);
    verb_load_at_start_Stub(load);
    stored_rate = 0U;
    parameter_store_laser_rate_Stub(laser_rate);
    bsp_watchdog_start_Stub(watchdog);
    BIOS_start_Stub(bios);
    geometry_mounted_Stub(geometry);
}

void tearDown(void) {}

void test_the_board_comes_first_the_tasks_before_the_ports_and_the_kernel_last(void)
{
    TEST_ASSERT_EQUAL_INT(0, firmware_main());
    TEST_ASSERT_EQUAL_STRING(
        "board boot servers imu receive_laser control send_laser send_comm receive_comm ports load "
        "watchdog bios ",
        order);
}

void test_the_scanner_has_its_rates_and_streams_the_mirrors(void)
{
    (void)firmware_main();
    TEST_ASSERT_EQUAL_UINT32(LASER_FIRST_RATE, config.first_rate);
    TEST_ASSERT_EQUAL_UINT32(LASER_STREAM_RATE, config.fastest_rate);
    TEST_ASSERT_EQUAL_UINT32(LASER_STREAM_RATE, config.stream_rate);
    TEST_ASSERT_EQUAL(SCIP_STREAM_2, config.stream);
    TEST_ASSERT_EQUAL_UINT16(111, config.range.first_step);
    TEST_ASSERT_EQUAL_UINT16(654, config.range.last_step); /* 136 points of 4 steps */
    TEST_ASSERT_EQUAL_UINT16(4, config.range.cluster);
}

void test_a_stored_power_up_rate_is_where_the_scanner_is_looked_for_first(void)
{
    static const uint32_t rates[] = {0U, 19200U, LASER_STREAM_RATE, 500000U};

    for (uint16_t i = 0U; i < 4U; i++) {
        const bool usable = rates[i] > 0U && rates[i] <= LASER_STREAM_RATE;

        stored_rate = rates[i];
        booted = false;
        order[0] = '\0';
        (void)firmware_main();
        TEST_ASSERT_EQUAL(usable, config.first_rate_known);
        TEST_ASSERT_EQUAL_UINT32(usable ? rates[i] : LASER_FIRST_RATE, config.first_rate);
    }
}

/* Its motor turns already then, and the vehicle may be in the air. */
void test_after_a_restart_the_scanner_is_not_waited_for(void)
{
    (void)firmware_main();
    TEST_ASSERT_EQUAL_UINT32(LASER_WAIT_US, config.wait_us);
    TEST_ASSERT_TRUE(LASER_WAIT_US > 0U);
    order[0] = '\0';
    restart = true;
    (void)firmware_main();
    TEST_ASSERT_EQUAL_UINT32(0U, config.wait_us);
}
