/* The shared values and their locks. A server owns one value and one GateMutexPri (priority inheritance): copy in, copy
 * out, never a call outward while the gate is held. Task context or main(), never Hwi or Swi.
 *
 * Every value has one writing task, named here; any task may read. */
#ifndef FIRMWARE_SERVERS_H
#define FIRMWARE_SERVERS_H

#include <stdbool.h>
#include <stdint.h>

#include "control/altitude.h"
#include "control/flight_io.h"
#include "control/imu_sample.h"
#include "control/parameters.h"
#include "drivers/urg_link.h"

/* All gates. Call once from main(). */
void servers_create(void);

/* Altitude server, written by TaskReceiveLaser. */
typedef struct {
    altitude_t altitude;        /* the latest scan that gave a height */
    bool scan_valid;            /* the very latest scan gave one */
    uint32_t sensor_time_ms;    /* of that height, 24-bit sensor clock */
    uint32_t arrival_us;        /* last octet of that scan, bsp_time_us() */
    uint32_t age_us;            /* from its rays to that octet, when nothing hinders it */
    uint32_t sequence;          /* heights so far; 0 = never one */
    uint32_t heightless;        /* scans that gave none */
} altitude_sample_t;

void altitude_server_write(const altitude_sample_t *sample);
void altitude_server_read(altitude_sample_t *sample);

/* IMU server, written by TaskIMU. */
#define IMU_HISTORY 16U

void imu_server_write(const imu_sample_t *sample);
void imu_server_read(imu_sample_t *sample);
/* The latest samples, oldest first; returns how many (0..IMU_HISTORY). */
uint16_t imu_server_history(imu_sample_t history[IMU_HISTORY]);

/* LaserStatus server, written by TaskSendLaser. */
typedef struct {
    urg_status_t status;
    uint32_t rate;              /* bits per second */
    uint32_t restarts;          /* times that the stream was lost */
    uint32_t timeouts;          /* commands without an answer */
    urg_seen_t seen;            /* at that time */
} laser_sample_t;

void laser_server_write(const laser_sample_t *sample);
void laser_server_read(laser_sample_t *sample);

/* Reference server: what the operator wants, written by TaskReceiveComm. */
typedef struct {
    float reference_m;          /* 0 = none, or land */
    uint32_t sequence;          /* accepted #SETR so far */
    bool arm;                   /* #ARM, until #STOP */
    uint32_t arm_sequence;      /* both so far */
    uint32_t link_time_us;      /* arrival of the latest valid line */
    uint32_t link_sequence;     /* valid lines so far; 0 = never one */
} reference_sample_t;

void reference_server_write(const reference_sample_t *sample);
void reference_server_read(reference_sample_t *sample);

/* Parameter server, written by TaskReceiveComm: Kp, Kd, Ki, AscensionSat, DescensionSat, GravityCompensation and the
 * later ones, behind one gate, so that no reader sees half a change. */
void parameter_server_write(const parameters_t *parameters);
void parameter_server_read(parameters_t *parameters);

/* FlightStatus server, written by TaskControl: what the latest control cycle decided. */
void flight_status_server_write(const flight_outputs_t *status);
void flight_status_server_read(flight_outputs_t *status);

#endif
