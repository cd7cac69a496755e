/* The names that urg_library 1.2.7 gives to whoever includes its headers, declared only: a program may use it
 * beside this driver. Types stand as far as a name needs one. */
#ifndef URG_LIBRARY_NAMES_H
#define URG_LIBRARY_NAMES_H

typedef struct {
    int is_active;
} urg_t;
typedef struct {
    int fd;
} urg_serial_t, urg_tcpclient_t, urg_connection_t, ring_buffer_t;
typedef enum { URG_SERIAL, URG_ETHERNET } urg_connection_type_t;
typedef enum { URG_COMMUNICATION_3_BYTE, URG_COMMUNICATION_2_BYTE } urg_range_data_byte_t;
typedef enum {
    URG_DISTANCE,
    URG_DISTANCE_INTENSITY,
    URG_DISTANCE_IO,
    URG_DISTANCE_INTENSITY_IO,
    URG_MULTIECHO,
    URG_MULTIECHO_INTENSITY,
    URG_STOP,
    URG_UNKNOWN
} urg_measurement_type_t;
enum {
    URG_NO_ERROR,
    URG_UNKNOWN_ERROR,
    URG_NOT_CONNECTED,
    URG_NOT_IMPLEMENTED,
    URG_INVALID_RESPONSE,
    URG_NO_RESPONSE,
    URG_SEND_ERROR,
    URG_RECEIVE_ERROR,
    URG_CHECKSUM_ERROR,
    URG_INVALID_PARAMETER,
    URG_MEASUREMENT_TYPE_MISMATCH,
    URG_SERIAL_OPEN_ERROR,
    URG_NOT_DETECT_BAUDRATE_ERROR,
    URG_ETHERNET_OPEN_ERROR,
    URG_SCANNING_PARAMETER_ERROR,
    URG_DATA_SIZE_PARAMETER_ERROR,
    URG_CONNECTION_TIMEOUT,
    URG_COMMON_ERROR_LAST,
    URG_SCAN_INFINITY,
    URG_MAX_ECHO,
    URG_MAX_IO
};
typedef void (*urg_error_handler)(const char *status, void *urg);

int urg_open(void), urg_close(void), urg_start_measurement(void), urg_stop_measurement(void),
    urg_get_distance(void), urg_get_distance_intensity(void), urg_get_distance_io(void),
    urg_get_distance_intensity_io(void), urg_get_multiecho(void), urg_get_multiecho_intensity(void),
    urg_set_scanning_parameter(void), urg_set_measurement_data_size(void), urg_set_timeout_msec(void),
    urg_set_error_handler(void), urg_laser_on(void), urg_laser_off(void), urg_reboot(void), urg_sleep(void),
    urg_wakeup(void), urg_is_stable(void), urg_start_time_stamp_mode(void), urg_time_stamp(void),
    urg_stop_time_stamp_mode(void), urg_sensor_status(void), urg_sensor_state(void),
    urg_sensor_serial_id(void), urg_sensor_product_type(void), urg_sensor_firmware_version(void),
    urg_error(void), urg_step_min_max(void), urg_distance_min_max(void), urg_scan_usec(void),
    urg_max_data_size(void), urg_index2deg(void), urg_index2rad(void), urg_rad2index(void),
    urg_deg2index(void), urg_rad2step(void), urg_deg2step(void), urg_step2rad(void), urg_step2deg(void),
    urg_step2index(void), urg_t_initialize(void), urg_delay(void), urg_scip_decode(void),
    connection_open(void), connection_close(void), connection_write(void), connection_read(void),
    connection_readline(void), serial_open(void), serial_close(void), serial_write(void), serial_read(void),
    tcpclient_open(void), ring_initialize(void);

#endif
