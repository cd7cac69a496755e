/* Servers: the shared values and their locks. Each server owns one value and one GateMutexPri (priority
 * inheritance). Values are copied in and copied out. While a gate is held, no other module is called.
 *
 * Each value has one writing task, named here. Any task may read. Context: Task or main(), never Hwi or
 * Swi. */
#ifndef FIRMWARE_SERVERS_H
#define FIRMWARE_SERVERS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/flight_io.h"
#include "control/imu_sample.h"
#include "control/parameters.h"
#include "control/signal.h"
#include "drivers/urg_link.h"

/* Creates all gates. Call once from main(). */
void servers_create(void);

/* Altitude server, written by TaskReceiveLaser. */
typedef struct {
    altitude_t altitude;              /* latest scan that gave a height: mean of its mirrors */
    altitude_t mirrors[MIRROR_COUNT]; /* each of them, by mirror_t */
    uint16_t mirror_count;            /* of LAYOUT; 1: altitude tells all */
    bool scan_valid;                  /* the latest scan gave a height */
    uint32_t sensor_time_ms;          /* of that height: the sensor's 24-bit clock */
    uint32_t arrival_us;              /* last octet of that scan, bsp_time_us() */
    uint32_t age_us;                  /* from its rays to that octet, when nothing delays it */
    uint32_t sequence;                /* heights so far; 0 = none yet */
    uint32_t heightless;              /* scans without a height */
    scan_signal_t signal;             /* of the latest scan, with a height or without one */
} altitude_sample_t;

void altitude_server_write(const altitude_sample_t *sample);
void altitude_server_read(altitude_sample_t *sample);

/* IMU server, written by TaskIMU. */
#define IMU_HISTORY 16U

void imu_server_write(const imu_sample_t *sample);
void imu_server_read(imu_sample_t *sample);
/* Copies the latest samples, oldest first. Returns their number, 0 .. IMU_HISTORY. */
uint16_t imu_server_history(imu_sample_t history[IMU_HISTORY]);

/* LaserStatus server, written by TaskSendLaser. */
typedef struct {
    urg_status_t status;
    uint32_t rate;          /* bits per second */
    uint32_t power_up_rate; /* of the sensor, bits per second; 0: it was not seen to power up */
    uint32_t restarts;      /* how often the stream was lost */
    uint32_t timeouts;      /* commands that got no answer */
    urg_seen_t seen;        /* counters at that time */
} laser_sample_t;

void laser_server_write(const laser_sample_t *sample);
void laser_server_read(laser_sample_t *sample);

/* Reference server, written by TaskReceiveComm: the operator's requests. */
typedef struct {
    float reference_m;      /* 0 = none, or land */
    uint32_t sequence;      /* accepted #SETR commands so far */
    bool arm;               /* true after #ARM, false after #STOP */
    uint32_t arm_sequence;  /* #ARM and #STOP commands so far */
    uint32_t link_time_us;  /* arrival of the latest valid line */
    uint32_t link_sequence; /* valid lines so far; 0 = none yet */
} reference_sample_t;

void reference_server_write(const reference_sample_t *sample);
void reference_server_read(reference_sample_t *sample);

/* Parameter server, written by TaskReceiveComm. All parameters are behind one gate, so no reader sees half
 * a change. */
void parameter_server_write(const parameters_t *parameters);
void parameter_server_read(parameters_t *parameters);

/* FlightStatus server, written by TaskControl: the outputs of the latest control cycle. */
void flight_status_server_write(const flight_outputs_t *status);
void flight_status_server_read(flight_outputs_t *status);

#endif
